//! The pages of a single-page site: `routes` in labspec.toml states which file a link such as `#/lesson/0.1` denotes.

use labspec::finding::Finding;
use labspec::report::printable;
use labspec::rules;
use std::path::{Path, PathBuf};

/// Which files the links of one form denote.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Route {
    /// The form of the links: `#/lesson/{}`. `{}` is the name of the page.
    link: String,
    /// The file, relative to the folder of the settings: `lessons/{}-*.md`. `*` in its name is any text.
    file: String,
}

/// The routes of a settings file.
#[derive(Clone, Debug, Default)]
pub(super) struct Routes {
    folder: PathBuf,
    list: Vec<Route>,
}

/// The target of a link.
#[derive(Debug, PartialEq, Eq)]
enum Target {
    Exists,
    /// No file has this name.
    Missing(String),
    /// No route has the form of the link.
    Unknown,
}

/// The place of the name of a page.
const NAME: &str = "{}";

impl Routes {
    /// The routes of a settings file in this folder.
    ///
    /// # Errors
    /// The value is not a table of texts, or a file uses the name of the page and the link does not contain it.
    pub(super) fn read(folder: &Path, value: Option<&toml::Value>) -> Result<Routes, String> {
        let mut routes = Routes { folder: folder.to_path_buf(), list: Vec::new() };
        let Some(value) = value else { return Ok(routes) };
        let wrong =
            || "`routes` must be a table of links and files: \"#/lesson/{}\" = \"lessons/{}.md\"".to_string();
        for (link, file) in value.as_table().ok_or_else(wrong)? {
            let file = file.as_str().ok_or_else(wrong)?;
            if !link.starts_with("#/") {
                return Err(format!("routes: `{}` must begin with `#/`", printable(link)));
            }
            let names = [link.as_str(), file].map(|text| text.matches(NAME).count());
            if names[0] > 1 || names[1] > 0 && names[0] == 0 {
                return Err(format!("routes: `{}` must contain {NAME} once", printable(link)));
            }
            let is_inside = |part: &str| !matches!(part, ".." | "");
            let (folder, _) = file.rsplit_once('/').unwrap_or(("", file));
            if file.is_empty() || !file.split('/').all(is_inside) || folder.contains('*') {
                return Err(format!(
                    "routes: `{}` must be a file in or below this folder, with `*` only in its name",
                    printable(file)
                ));
            }
            routes.list.push(Route { link: link.clone(), file: file.to_string() });
        }
        Ok(routes)
    }

    /// The forms of links and their files, for people.
    pub(super) fn lines(&self) -> impl Iterator<Item = String> + '_ {
        self.list.iter().map(|route| format!("{} = {}", route.link, route.file))
    }

    /// Removes the findings about links to files that exist, and states which file is missing in the others.
    pub(super) fn resolve(&self, findings: &mut Vec<Finding>) {
        if self.list.is_empty() {
            return;
        }
        findings.retain_mut(|f| {
            let Some(link) = f.link.as_deref().filter(|_| f.code == rules::DEAD_LINK.code) else {
                return true;
            };
            match self.target(link) {
                Target::Exists => return false,
                Target::Missing(file) => {
                    f.message = format!("`{}`: there is no file `{}`", printable(link), printable(&file));
                    f.help = Some("correct the link, or add its target".into());
                }
                Target::Unknown => {}
            }
            true
        });
    }

    fn target(&self, link: &str) -> Target {
        // The rest is a query, or a heading of the page.
        let end = link.get(1..).and_then(|rest| rest.find(['?', '#'])).map_or(link.len(), |i| i + 1);
        let link = link.get(..end).unwrap_or(link);
        let Some((route, name)) =
            self.list.iter().find_map(|route| Some((route, name_in(&route.link, link)?)))
        else {
            return Target::Unknown;
        };
        let file = route.file.replace(NAME, name);
        let is_name = !name.contains(['/', '\\', '*']) && name != "..";
        if is_name && self.exists(&file) { Target::Exists } else { Target::Missing(file) }
    }

    fn exists(&self, file: &str) -> bool {
        let (folder, pattern) = file.rsplit_once('/').unwrap_or(("", file));
        if !pattern.contains('*') {
            return self.folder.join(file).is_file();
        }
        let Ok(entries) = std::fs::read_dir(self.folder.join(folder)) else { return false };
        entries.flatten().any(|entry| matches(pattern, &entry.file_name().to_string_lossy()))
    }
}

/// The name of the page in a link of this form; empty for a form without a name.
fn name_in<'l>(form: &str, link: &'l str) -> Option<&'l str> {
    match form.split_once(NAME) {
        Some((before, after)) => {
            link.strip_prefix(before)?.strip_suffix(after).filter(|name| !name.is_empty())
        }
        None => (form == link).then_some(""),
    }
}

/// Whether a name has the form of a pattern, in which `*` is any text.
fn matches(pattern: &str, name: &str) -> bool {
    let mut parts = pattern.split('*');
    let Some(mut rest) = name.strip_prefix(parts.next().unwrap_or("")) else { return false };
    let mut parts: Vec<&str> = parts.collect();
    let Some(last) = parts.pop() else { return rest.is_empty() };
    for part in parts {
        let Some(index) = rest.find(part) else { return false };
        rest = rest.get(index + part.len()..).unwrap_or("");
    }
    rest.ends_with(last)
}

#[cfg(test)]
#[allow(clippy::unwrap_used)] // a panic is the report of a failed test
mod tests {
    use super::*;

    #[test]
    fn links_to_pages_of_a_site_denote_files() {
        let folder = tempfile::tempdir().unwrap();
        std::fs::create_dir(folder.path().join("lessons")).unwrap();
        for name in ["lessons/0.1-falling.md", "home.md"] {
            std::fs::write(folder.path().join(name), "").unwrap();
        }
        let value: toml::Table = toml::from_str(
            "r = { \"#/lesson/{}\" = \"lessons/{}-*.md\", \"#/home\" = \"home.md\", \"#/p/{}\" = \"{}.md\" }",
        )
        .unwrap();
        let routes = Routes::read(folder.path(), value.get("r")).unwrap();
        let missing = |file: &str| Target::Missing(file.to_string());
        for (link, target) in [
            ("#/lesson/0.1", Target::Exists),
            ("#/lesson/0.1?tab=2", Target::Exists),
            ("#/lesson/0.1#heading", Target::Exists),
            ("#/lesson/0", missing("lessons/0-*.md")),
            ("#/lesson/", Target::Unknown),
            ("#/home", Target::Exists),
            ("#/p/home", Target::Exists),
            ("#/p/../x/home", missing("../x/home.md")),
            ("#/p/*", missing("*.md")),
            ("#/other", Target::Unknown),
        ] {
            assert_eq!(routes.target(link), target, "{link}");
        }
    }

    #[test]
    fn wrong_routes_are_refused() {
        for routes in [
            "7",
            "{ \"#/a\" = 7 }",
            "{ \"a\" = \"a.md\" }",
            "{ \"#/a\" = \"{}.md\" }",
            "{ \"#/{}/{}\" = \"{}.md\" }",
            "{ \"#/{}\" = \"../{}.md\" }",
            "{ \"#/{}\" = \"/{}.md\" }",
            "{ \"#/{}\" = \"*/{}.md\" }",
        ] {
            let table: toml::Table = toml::from_str(&format!("r = {routes}")).unwrap();
            assert!(Routes::read(Path::new("."), table.get("r")).is_err(), "{routes}");
        }
    }

    #[test]
    fn a_pattern_matches_names() {
        for (pattern, name, fits) in [
            ("a-*.md", "a-b.md", true),
            ("a-*.md", "a-.md", true),
            ("a-*.md", "a.md", false),
            ("*b*c", "abxc", true),
            ("*b*c", "acb", false),
            ("a*a", "a", false),
            ("a", "a", true),
        ] {
            assert_eq!(matches(pattern, name), fits, "{pattern} {name}");
        }
    }
}
