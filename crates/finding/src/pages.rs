//! Support for build scripts: lists a folder of rules with one page each, so that a new rule is one file.

use std::fmt::Write as _;
use std::io;
use std::path::PathBuf;

/// Writes `rules.rs` into the output folder of the build: every file in the folder `pages` of the crate as a module, the
/// rule that it declares (`pub const NAME: &Rule`), and all rules as `list`. Pages that declare `const CHECK: Check` are
/// also listed in `CHECKS`.
///
/// Must be called from a build script. Modules that the folder's `mod.rs` declares itself are not pages.
///
/// # Errors
/// A page does not declare exactly one rule, and would silently be left out; the folder cannot be read; or
/// the list cannot be written.
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
    let text = listed(list, &pages).map_err(|why| {
        println!("cargo::error={why}");
        io::Error::other(why)
    })?;
    std::fs::write(folder("OUT_DIR")?.join("rules.rs"), text)
}

/// Returns the text of the list, or the error of a page and how to correct it.
fn listed(list: &str, pages: &[(PathBuf, String)]) -> Result<String, String> {
    let (mut text, mut rules, mut checks) = (String::new(), Vec::new(), Vec::new());
    let module = |path: &PathBuf| path.file_stem().and_then(|s| s.to_str()).unwrap_or_default().to_string();
    let head = pages.iter().find(|(path, _)| module(path) == "mod").map_or("", |(_, text)| text.as_str());
    for (path, page) in pages {
        let module = module(path);
        if module == "mod" || names(head, &module) {
            continue;
        }
        let name = match declared(page).as_slice() {
            [name] => *name,
            [] => {
                return Err(format!(
                    "{} declares no rule, so it would never be compiled: write `pub const NAME: &Rule = &Rule {{ … }};` there, or, if it \
                     is no rule, `mod {module};` in the mod.rs beside it",
                    path.display()
                ));
            }
            [first, second, ..] => {
                return Err(format!(
                    "{} declares {first} and {second}, and a page is one rule: move one of them to a page of its own",
                    path.display()
                ));
            }
        };
        let _ = writeln!(
            text,
            "#[path = {:?}]\npub(crate) mod {module};\npub use {module}::{name};",
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
    Ok(text)
}

/// The names of the rules that a page declares.
fn declared(page: &str) -> Vec<&str> {
    let constants = page.lines().filter_map(|line| line.strip_prefix("pub const "));
    constants.filter_map(|rest| Some(rest.split_once(": &Rule =")?.0)).collect()
}

/// Whether a `mod.rs` declares this module itself.
fn names(head: &str, module: &str) -> bool {
    let named =
        |line: &str| line.trim().strip_suffix(';')?.rsplit_once("mod ").map(|(_, name)| name == module);
    head.lines().filter(|line| !line.trim_start().starts_with("//")).any(|line| named(line) == Some(true))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::Path;

    fn page(name: &str, text: &str) -> (PathBuf, String) {
        (Path::new("/r").join(name), text.to_string())
    }

    /// A page that declares no rule, or two, would silently be left out; the build fails instead.
    #[test]
    fn a_page_that_is_no_rule_is_refused() {
        let rule = "pub const ONE: &Rule = &Rule {};";
        for no_rule in ["fn help() {}", "const ONE: &Rule = &Rule {};", "pub const ONE: Rule = Rule {};", ""]
        {
            let with = |head: &str| listed("ALL", &[page("help.rs", no_rule), page("mod.rs", head)]);
            for unnamed in ["", "mod helper;", "// mod help;", "use help;"] {
                let why = with(unnamed).unwrap_err();
                assert!(why.contains("/r/help.rs declares no rule") && why.contains("`mod help;`"), "{why}");
            }
            for named in ["mod help;", "mod a;\npub(crate) mod help;\n"] {
                let text = with(named).unwrap();
                assert!(!text.contains("help") && text.contains("ALL: &[&Rule] = &[];"), "{text}");
            }
        }
        let two = format!("{rule}\npub const TWO: &Rule =\n    &Rule {{}};");
        let why = listed("ALL", &[page("a.rs", &two)]).unwrap_err();
        assert!(why.contains("/r/a.rs declares ONE and TWO"), "{why}");
    }

    #[test]
    fn a_page_with_a_rule_is_listed() {
        let pages = [
            page("mod.rs", "mod a;"),
            page("one.rs", "/// A.\npub const ONE: &Rule = &Rule {};"),
            page(
                "two.rs",
                "pub const TWO: &Rule = &Rule {};\npub(super) const CHECK: Check = Check::Lab(check);",
            ),
        ];
        let text = listed("ALL", &pages).unwrap();
        assert!(text.contains("mod one;\npub use one::ONE;") && !text.contains("mod mod"), "{text}");
        assert!(text.contains("pub const ALL: &[&Rule] = &[ONE, TWO];"), "{text}");
        assert!(text.contains("CHECKS: &[Check] = &[two::CHECK];"), "{text}");
    }
}
