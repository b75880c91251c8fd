//! Where the links and images of a lesson lead: to pages of the course, to files that the site copies, to the sources of the course on
//! the web, to other addresses of the web, or nowhere.

use crate::html::Addresses;
use crate::names::{address_from, parts_inside};
use crate::text::{address, letters};
use percent_encoding::percent_decode_str;
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

/// Pictures that a page shows.
const PICTURES: [&str; 7] = ["png", "jpg", "jpeg", "gif", "webp", "avif", "svg"];
/// Other files that a site copies where a lesson links to them. None of them runs in a browser as a page.
const DOCUMENTS: [&str; 20] = [
    "pdf", "csv", "tsv", "txt", "py", "m", "jl", "r", "ipynb", "zip", "stl", "obj", "mjcf", "urdf", "mp4",
    "webm", "mp3", "wav", "ogg", "toml",
];
/// Addresses of the web that a link may have.
const SCHEMES: [&str; 3] = ["http", "https", "mailto"];
/// The maximum size of a copied file in bytes, and their number.
const MAX_SIZE: u64 = 64 << 20;
const MAX_FILES: usize = 2000;

/// The anchors of a page: each id by its letters. A link finds its heading as a check does.
#[derive(Debug, Default, Clone)]
pub(crate) struct Anchors {
    ids: BTreeSet<String>,
    by_letters: BTreeMap<String, String>,
}

impl Anchors {
    /// Adds an id that no element has; a taken one gets a number.
    pub(crate) fn add(&mut self, requested: &str, text: &str) -> String {
        let stem = if requested.is_empty() { "section" } else { requested };
        let mut id = stem.to_string();
        let mut number = 1;
        while !self.ids.insert(id.clone()) {
            id = format!("{stem}-{number}");
            number += 1;
        }
        for name in [
            letters(&id),
            letters(text),
            letters(text).trim_start_matches(|c: char| c.is_ascii_digit()).into(),
        ] {
            self.by_letters.entry(name).or_insert_with(|| id.clone());
        }
        id
    }

    /// The id that an anchor means.
    pub(crate) fn find(&self, anchor: &str) -> Option<&str> {
        if let Some(id) = self.ids.get(anchor) {
            return Some(id);
        }
        self.by_letters.get(&letters(anchor)).map(String::as_str)
    }
}

/// The pages of the course, and the files that are copied.
#[derive(Debug, Default)]
pub(crate) struct Places {
    /// The folder of the course, with links resolved.
    pub(crate) folder: PathBuf,
    /// The root below which files may be read.
    pub(crate) root: PathBuf,
    /// The address of the root on the web, ending in `/`: there, a link finds a file that the site does not have.
    pub(crate) sources: Option<String>,
    /// The name of the page of each lesson, by its real path.
    pub(crate) pages: BTreeMap<PathBuf, String>,
    /// The anchors of each page.
    pub(crate) anchors: BTreeMap<String, Anchors>,
    /// The copied files: the name in the site, and the file.
    pub(crate) copied: BTreeMap<String, PathBuf>,
}

/// The links of one page.
pub(crate) struct PageLinks<'p> {
    pub(crate) places: &'p mut Places,
    /// The name of the page.
    pub(crate) page: &'p str,
    /// The folder of the lesson.
    pub(crate) folder: &'p Path,
}

impl Addresses for PageLinks<'_> {
    fn link(&mut self, target: &str) -> Option<String> {
        let target = visible(target);
        if let Some(anchor) = target.strip_prefix('#') {
            return Some(format!("#{}", address(&self.anchor(self.page, anchor))));
        }
        if let Some(scheme) = scheme_of(&target) {
            return SCHEMES.contains(&scheme.as_str()).then_some(target);
        }
        if target.starts_with("//") {
            return Some(format!("https:{target}"));
        }
        // A path of the server that the site is on.
        if target.starts_with('/') && !target.contains('\\') {
            return Some(target);
        }
        let (file, anchor) =
            target.split_once('#').map_or((target.as_str(), ""), |(file, anchor)| (file, anchor));
        let real = self.real(file)?;
        if let Some(page) = self.places.pages.get(&real) {
            let anchor = if anchor.is_empty() {
                String::new()
            } else {
                format!("#{}", address(&self.anchor(page, anchor)))
            };
            return Some(format!("{}{anchor}", address_from(self.page, page)));
        }
        let copied = self.copied(&real, &DOCUMENTS).or_else(|| self.copied(&real, &PICTURES));
        copied.filter(|_| !is_vector(&real)).or_else(|| self.source(&real, anchor))
    }

    fn image(&mut self, target: &str) -> Option<String> {
        let target = visible(target);
        if let Some((head, data)) = target.split_once(";base64,") {
            let is_picture =
                ["png", "jpeg", "gif", "webp"].iter().any(|kind| head == format!("data:image/{kind}"));
            let is_data = data.bytes().all(|b| b.is_ascii_alphanumeric() || matches!(b, b'+' | b'/' | b'='));
            return (is_picture && is_data).then_some(target);
        }
        if scheme_of(&target).is_some() || target.starts_with('/') {
            return None;
        }
        let real = self.real(&target)?;
        self.copied(&real, &PICTURES)
    }

    fn id(&mut self, id: &str) -> Option<String> {
        let is_plain = !id.is_empty() && id.len() < 100 && !id.contains(char::is_whitespace);
        let anchors = self.places.anchors.entry(self.page.to_string()).or_default();
        (is_plain && !anchors.ids.contains(id)).then(|| anchors.add(id, id))
    }
}

impl PageLinks<'_> {
    /// The id of an anchor; the anchor itself where the page has none like it.
    fn anchor(&self, page: &str, anchor: &str) -> String {
        let decoded = percent_decode_str(anchor).decode_utf8_lossy();
        let anchors = self.places.anchors.get(page);
        anchors.and_then(|all| all.find(&decoded)).unwrap_or(&decoded).to_string()
    }

    /// The real path of a file that a lesson names; `None` where there is none below the root.
    fn real(&self, file: &str) -> Option<PathBuf> {
        let file = file.split('?').next().unwrap_or(file);
        let decoded = percent_decode_str(file).decode_utf8().ok()?;
        if decoded.is_empty() || decoded.contains(['\0', '\\']) || Path::new(&*decoded).is_absolute() {
            return None;
        }
        let real = self.folder.join(&*decoded).canonicalize().ok()?;
        real.starts_with(&self.places.root).then_some(real)
    }

    /// The address of a file among the sources of the course.
    fn source(&self, real: &Path, anchor: &str) -> Option<String> {
        let parts = parts_inside(&self.places.root, real)?;
        let anchor = if anchor.is_empty() { String::new() } else { format!("#{}", address(anchor)) };
        Some(format!("{}{}{anchor}", self.places.sources.as_ref()?, address(&parts.join("/"))))
    }

    /// The address of a file that the site copies, if it has one of these endings.
    fn copied(&mut self, real: &Path, endings: &[&str]) -> Option<String> {
        let ending = real.extension()?.to_str()?.to_ascii_lowercase();
        let meta = real.metadata().ok()?;
        if !endings.contains(&ending.as_str()) || !meta.is_file() || meta.len() > MAX_SIZE {
            return None;
        }
        // Hidden files and folders are no part of a course.
        if parts_inside(&self.places.root, real)?.iter().any(|part| part.starts_with('.')) {
            return None;
        }
        let inside = parts_inside(&self.places.folder, real).map(|parts| parts.join("/"));
        let outside = || parts_inside(&self.places.root, real).map(|parts| parts.join("/"));
        let name = format!("files/{}", inside.or_else(outside)?);
        if !self.places.copied.contains_key(&name) && self.places.copied.len() >= MAX_FILES {
            return None;
        }
        self.places.copied.insert(name.clone(), real.to_path_buf());
        Some(address_from(self.page, &name))
    }
}

/// An address as a browser reads it: without control characters and spaces around it.
fn visible(target: &str) -> String {
    target.chars().filter(|c| !c.is_control()).collect::<String>().trim().to_string()
}

/// The scheme of an address in lower case: everything before a colon that comes before any other separator.
fn scheme_of(target: &str) -> Option<String> {
    let head = target.split(['/', '?', '#']).next()?;
    head.split_once(':').map(|(scheme, _)| scheme.trim().to_ascii_lowercase())
}

/// Whether a picture may contain scripts: it is shown, but never opened as a page.
fn is_vector(path: &Path) -> bool {
    path.extension().is_some_and(|e| e.eq_ignore_ascii_case("svg"))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn places(folder: &Path) -> Places {
        let folder = folder.canonicalize().unwrap();
        let mut places = Places { folder: folder.clone(), root: folder.clone(), ..Places::default() };
        places.pages.insert(folder.join("a b.md"), "a b.html".into());
        let mut anchors = Anchors::default();
        anchors.add("1-falling", "1. Falling");
        places.anchors.insert("a b.html".into(), anchors);
        places
    }

    #[test]
    fn links_lead_to_pages_files_the_web_or_nowhere() {
        let outside = tempfile::tempdir().unwrap();
        std::fs::write(outside.path().join("secret.txt"), "s").unwrap();
        let folder = outside.path().join("course");
        std::fs::create_dir(&folder).unwrap();
        for name in ["a b.md", "data.csv", "x.html", "p.svg", "p.png", ".hidden.txt"] {
            std::fs::write(folder.join(name), "x").unwrap();
        }
        #[cfg(unix)]
        std::os::unix::fs::symlink(outside.path().join("secret.txt"), folder.join("link.txt")).unwrap();
        let mut places = places(&folder);
        let real = folder.canonicalize().unwrap();
        let mut links = PageLinks { places: &mut places, page: "week/c.html", folder: &real };
        for (target, address) in [
            ("a%20b.md", Some("../a%20b.html")),
            ("a b.md#Falling", Some("../a%20b.html#1-falling")),
            ("data.csv", Some("../files/data.csv")),
            ("https://example.org/?a=b", Some("https://example.org/?a=b")),
            ("//example.org", Some("https://example.org")),
            ("java\nscript:alert(1)", None),
            (" javascript:alert(1)", None),
            ("data:text/html,x", None),
            ("file:///etc/passwd", None),
            ("/etc/passwd", Some("/etc/passwd")),
            ("../secret.txt", None),
            ("link.txt", None),
            ("x.html", None),
            ("p.svg", None),
            ("none.csv", None),
            (".hidden.txt", None),
        ] {
            assert_eq!(links.link(target).as_deref(), address, "{target}");
        }
        for (target, address) in [
            ("p.svg", Some("../files/p.svg")),
            ("p.png", Some("../files/p.png")),
            ("data:image/png;base64,AAAA", Some("data:image/png;base64,AAAA")),
            ("data:image/svg+xml;base64,AAAA", None),
            ("https://example.org/p.png", None),
            ("../secret.txt", None),
        ] {
            assert_eq!(links.image(target).as_deref(), address, "{target}");
        }
        let copied: Vec<&String> = links.places.copied.keys().collect();
        assert_eq!(copied, ["files/data.csv", "files/p.png", "files/p.svg"]);
        // With the address of the sources, other files below the root are there.
        links.places.sources = Some("https://example.org/tree/".into());
        for (target, address) in [
            ("x.html#L3", Some("https://example.org/tree/x.html#L3")),
            ("p.svg", Some("https://example.org/tree/p.svg")),
            (".hidden.txt", Some("https://example.org/tree/.hidden.txt")),
            ("data.csv", Some("../files/data.csv")),
            ("none.csv", None),
            ("../secret.txt", None),
        ] {
            assert_eq!(links.link(target).as_deref(), address, "{target}");
        }
    }
}
