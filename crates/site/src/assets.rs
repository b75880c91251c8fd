//! The scripts and styles that every page needs: the elements, the engine, the page's own script, KaTeX. They are built by npm and
//! installed beside the program.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// The files that every page needs.
const REQUIRED: [&str; 8] =
    ["site.js", "site.css", "sw.js", "elements.js", "engine.js", "labspec.wasm", "katex.js", "katex.css"];
/// The files that only the preview needs.
const OF_PREVIEW: [&str; 3] = ["preview.js", "editor.js", "preview.css"];
/// Files of KaTeX, which a course without formulas does not need.
const OF_MATH: &str = "katex";

/// The commands that build the files.
const HELP: &str = "build it with `cargo run --manifest-path bindings/xtask/Cargo.toml -- page`, or name a folder with it: --page DIR";

/// The scripts and styles of pages: names from the folder `page` of a site, and the files.
#[derive(Clone, Debug, Default)]
pub struct PageFiles {
    files: BTreeMap<String, PathBuf>,
}

impl PageFiles {
    /// Finds the folder: the named one, the one that the environment names, `page` beside the program, or `web/site/dist` in a
    /// folder around the program.
    ///
    /// # Errors
    /// There is no such folder, or a file is missing: a sentence with the next step.
    pub fn find(
        named: Option<&Path>,
        environment: Option<PathBuf>,
        program: Option<&Path>,
    ) -> Result<PageFiles, String> {
        if let Some(folder) = named.map(Path::to_path_buf).or(environment) {
            return PageFiles::read(&folder);
        }
        let beside = program.and_then(Path::parent).map(|folder| folder.join("page"));
        let around =
            program.into_iter().flat_map(Path::ancestors).skip(1).map(|folder| folder.join("web/site/dist"));
        match beside.into_iter().chain(around).find(|folder| folder.join("site.js").is_file()) {
            Some(folder) => PageFiles::read(&folder),
            None => Err(format!("the scripts of the page are missing; {HELP}")),
        }
    }

    /// Lists a folder.
    fn read(folder: &Path) -> Result<PageFiles, String> {
        let displayed = folder.display();
        let real = folder.canonicalize().map_err(|e| format!("cannot read {displayed}: {e}; {HELP}"))?;
        let mut files = BTreeMap::new();
        for (inside, prefix) in [(real.clone(), ""), (real.join("fonts"), "fonts/")] {
            for entry in std::fs::read_dir(&inside).into_iter().flatten().flatten() {
                let Ok(name) = entry.file_name().into_string() else { continue };
                if entry.path().is_file() {
                    files.insert(format!("{prefix}{name}"), entry.path());
                }
            }
        }
        match REQUIRED.iter().chain(&OF_PREVIEW).find(|name| !files.contains_key(**name)) {
            Some(name) => {
                Err(format!("{displayed} has no {name}, so it is not the scripts of the page; {HELP}"))
            }
            None => Ok(PageFiles { files }),
        }
    }

    /// Writes files that stand for the scripts of pages into a folder, each with its name many times, and lists them.
    #[cfg(test)]
    pub(crate) fn of_names(folder: &Path) -> PageFiles {
        for name in REQUIRED.iter().chain(&OF_PREVIEW) {
            std::fs::write(folder.join(name), name.repeat(99)).unwrap();
        }
        PageFiles::read(folder).unwrap()
    }

    /// The path of a file.
    pub(crate) fn path(&self, name: &str) -> Option<&PathBuf> {
        self.files.get(name)
    }

    /// The files that a site needs, with their names in it.
    pub(crate) fn needed(
        &self,
        with_math: bool,
        for_author: bool,
    ) -> impl Iterator<Item = (String, &PathBuf)> {
        let is_needed = move |name: &str| {
            let is_math = name.starts_with(OF_MATH) || name.starts_with("fonts/");
            let is_preview = OF_PREVIEW.contains(&name);
            name != "sw.js" && (with_math || !is_math) && (for_author || !is_preview)
        };
        self.files
            .iter()
            .filter(move |(name, _)| is_needed(name))
            .map(|(name, path)| (format!("page/{name}"), path))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_missing_folder_says_what_to_do() {
        let folder = tempfile::tempdir().unwrap();
        let program = folder.path().join("bin/labspec");
        for (named, environment) in
            [(Some(folder.path()), None), (None, Some(folder.path().to_path_buf())), (None, None)]
        {
            let why = PageFiles::find(named, environment, Some(&program)).unwrap_err();
            assert!(why.contains("xtask") && why.contains("--page"), "{why}");
        }
        std::fs::create_dir_all(folder.path().join("web/site/dist/fonts")).unwrap();
        for name in REQUIRED.iter().chain(&OF_PREVIEW).chain(&["fonts/a.woff2"]) {
            std::fs::write(folder.path().join("web/site/dist").join(name), "x").unwrap();
        }
        let files = PageFiles::find(None, None, Some(&program)).unwrap();
        let names =
            |math, author| files.needed(math, author).map(|(name, _)| name).collect::<Vec<_>>().join(" ");
        assert_eq!(
            names(false, false),
            "page/elements.js page/engine.js page/labspec.wasm page/site.css page/site.js"
        );
        assert!(
            names(true, true).contains("page/fonts/a.woff2") && names(true, true).contains("page/preview.js")
        );
    }
}
