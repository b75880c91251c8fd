//! For build scripts: a folder of rules, a page each, as a list. A new rule is so one file.

use std::fmt::Write as _;
use std::io;
use std::path::PathBuf;

/// Writes `rules.rs` into the folder of what is built: every file in the folder `pages` of the crate as a module, the rule that it declares
/// (`pub const NAME: &Rule`), and all of them as `list`. Pages that declare `const CHECK: Check` are listed in `CHECKS`, too.
///
/// To be called from a build script; a `mod.rs` and pages without a rule are left out.
///
/// # Errors
/// What the system says: the folder cannot be read, the list not be written.
pub fn list_rules(pages: &str, list: &str) -> io::Result<()> {
    let folder = |name: &str| std::env::var_os(name).map(PathBuf::from).ok_or(io::ErrorKind::NotFound);
    let rules = folder("CARGO_MANIFEST_DIR")?.join(pages);
    println!("cargo::rerun-if-changed={}", rules.display());
    let mut pages = Vec::new();
    for entry in std::fs::read_dir(&rules)? {
        let path = entry?.path();
        if path.extension().is_some_and(|e| e == "rs") {
            pages.push((path.clone(), std::fs::read_to_string(path)?));
        }
    }
    pages.sort();
    std::fs::write(folder("OUT_DIR")?.join("rules.rs"), listed(list, &pages))
}

/// The text of the list.
fn listed(list: &str, pages: &[(PathBuf, String)]) -> String {
    let (mut text, mut rules, mut checks) = (String::new(), Vec::new(), Vec::new());
    for (path, page) in pages {
        let Some((name, module)) = declared(page).zip(path.file_stem().and_then(|s| s.to_str())) else {
            continue;
        };
        let _ = writeln!(
            text,
            "#[path = {:?}]\nmod {module};\npub use {module}::{name};",
            path.display().to_string()
        );
        rules.push(name);
        if page.contains("const CHECK: Check ") {
            checks.push(format!("{module}::CHECK"));
        }
    }
    let _ = writeln!(text, "/// Every rule that is declared here, in the order of their pages.");
    let _ = writeln!(text, "pub const {list}: &[&Rule] = &[{}];", rules.join(", "));
    if !checks.is_empty() {
        let _ = writeln!(
            text,
            "/// The checks of a lesson's structure. Other rules are told by whoever reads, binds or runs."
        );
        let _ = writeln!(text, "pub(crate) const CHECKS: &[Check] = &[{}];", checks.join(", "));
    }
    text
}

/// The name of the rule that a page declares.
fn declared(page: &str) -> Option<&str> {
    let (before, _) = page.split_once(": &Rule = ")?;
    before.rsplit_once("pub const ").map(|(_, name)| name)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::Path;

    #[test]
    fn a_page_with_a_rule_is_listed() {
        let page = |name: &str, text: &str| (Path::new("/r").join(name), text.to_string());
        let pages = [
            page("mod.rs", "mod a;"),
            page("one.rs", "/// A.\npub const ONE: &Rule = &Rule {};"),
            page(
                "two.rs",
                "pub const TWO: &Rule = &Rule {};\npub(super) const CHECK: Check = Check::Lab(check);",
            ),
        ];
        let text = listed("ALL", &pages);
        assert!(text.contains("mod one;\npub use one::ONE;") && !text.contains("mod mod"), "{text}");
        assert!(text.contains("pub const ALL: &[&Rule] = &[ONE, TWO];"), "{text}");
        assert!(text.contains("CHECKS: &[Check] = &[two::CHECK];"), "{text}");
    }
}
