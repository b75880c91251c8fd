//! Names of pages in addresses, and the way from one to another.

use crate::text::address;
use std::collections::BTreeSet;
use std::path::{Component, Path};

/// Names of pages that are not lessons.
const RESERVED: [&str; 4] = ["index", "labs", "404", "offline"];

/// The parts of a path inside a folder; `None` where it leaves the folder or is not text.
pub(crate) fn parts_inside(folder: &Path, path: &Path) -> Option<Vec<String>> {
    let inside = path.strip_prefix(folder).ok()?;
    let part = |c: Component<'_>| match c {
        Component::Normal(name) => Some(name.to_str()?.to_string()),
        _ => None,
    };
    inside.components().filter(|c| *c != Component::CurDir).map(part).collect()
}

/// Gives every lesson a name of its own: its path with the ending `.html`.
#[derive(Debug, Default)]
pub(crate) struct PageNames {
    /// In lower case, because some file systems do not distinguish case.
    used: BTreeSet<String>,
}

impl PageNames {
    /// Keeps a name for a page that is not a lesson, or for a lesson with a name of its own.
    pub(crate) fn reserve(&mut self, name: &str) {
        self.used.insert(name.to_lowercase());
    }

    /// The name for a path of these parts.
    pub(crate) fn name(&mut self, parts: &[String]) -> String {
        let (file, folders) =
            parts.split_last().map_or(("lesson", &[][..]), |(file, folders)| (file.as_str(), folders));
        let stem = file.rsplit_once('.').map_or(file, |(stem, _)| stem);
        let folders: String = folders.iter().map(|folder| format!("{folder}/")).collect();
        let is_reserved = folders.is_empty() && RESERVED.iter().any(|name| stem.eq_ignore_ascii_case(name));
        let stem = if is_reserved { format!("{stem}-lesson") } else { stem.to_string() };
        let mut name = format!("{folders}{stem}.html");
        let mut number = 2;
        while !self.used.insert(name.to_lowercase()) {
            name = format!("{folders}{stem}-{number}.html");
            number += 1;
        }
        name
    }
}

/// The address of the site's root from a page: empty, or `../` for each folder.
pub(crate) fn root_from(page: &str) -> String {
    "../".repeat(page.matches('/').count())
}

/// The address of a file of the site from a page.
pub(crate) fn address_from(page: &str, file: &str) -> String {
    format!("{}{}", root_from(page), address(file))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_unique_whatever_the_file_system() {
        let mut names = PageNames::default();
        let mut name = |path: &str| names.name(&path.split('/').map(String::from).collect::<Vec<_>>());
        assert_eq!(name("a.md"), "a.html");
        assert_eq!(name("A.markdown"), "A-2.html");
        assert_eq!(name("week 1/index.md"), "week 1/index.html");
        assert_eq!(name("index.md"), "index-lesson.html");
        assert_eq!(address_from("week 1/index.html", "b c.html"), "../b%20c.html");
    }

    #[test]
    fn parts_stay_inside() {
        let folder = Path::new("/course");
        assert_eq!(parts_inside(folder, Path::new("/course/a/b.md")), Some(vec!["a".into(), "b.md".into()]));
        assert_eq!(parts_inside(folder, Path::new("/course/../b.md")), None);
        assert_eq!(parts_inside(folder, Path::new("/other/b.md")), None);
    }
}
