//! The order of modules: which modules a module may import, and that files form no import cycles.

// A failing test states the reason.
#![allow(clippy::panic, clippy::unwrap_used)]

use crate::support::workspace;
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

/// The files of a folder by module, and the modules that each of them imports.
struct ModuleGraph {
    text: BTreeMap<String, String>,
    uses: BTreeMap<String, BTreeSet<String>>,
}

/// Rust code without comments and tests.
fn code(path: &Path) -> String {
    let text = std::fs::read_to_string(path).unwrap();
    let text = text.split("#[cfg(test)]").next().unwrap_or_default();
    text.lines().map(|line| line.split("//").next().unwrap_or("")).collect::<Vec<_>>().join("\n")
}

/// The paths of all `use` declarations, with braces expanded: `a::{b, c::d}` gives `a::b` and `a::c::d`.
fn imports(code: &str) -> Vec<String> {
    fn expand_imports(prefix: &str, rest: &str, out: &mut Vec<String>) {
        let Some(open) = rest.find('{') else { return out.push(format!("{prefix}{rest}")) };
        let (head, body) = (format!("{prefix}{}", &rest[..open]), &rest[open + 1..rest.len() - 1]);
        let (mut depth, mut start) = (0, 0);
        for (i, c) in body.char_indices().chain([(body.len(), ',')]) {
            match c {
                '{' => depth += 1,
                '}' => depth -= 1,
                ',' if depth == 0 => {
                    if start < i {
                        expand_imports(&head, &body[start..i], out);
                    }
                    start = i + 1;
                }
                _ => {}
            }
        }
    }
    let mut out = Vec::new();
    for part in code.split("use ").skip(1) {
        // `a::b as c` gives `a::b`.
        let mut words = part.split(';').next().unwrap_or("").split_whitespace();
        let mut path = String::new();
        while let Some(word) = words.next() {
            match word {
                "as" => {
                    path.extend(words.next().and_then(|name| name.find([',', '}']).map(|at| &name[at..])))
                }
                word => path.push_str(word),
            }
        }
        expand_imports("", &path, &mut out);
    }
    // Items that are named by their full path where they are used.
    for (at, _) in code.match_indices("crate::") {
        let path: String =
            code[at..].chars().take_while(|c| c.is_alphanumeric() || matches!(c, '_' | ':')).collect();
        if !code[..at].ends_with("use ") {
            out.push(path.trim_end_matches(':').into());
        }
    }
    out
}

impl ModuleGraph {
    /// A folder of crates that form one, its subfolders included; their modules are named by their paths.
    fn read(crates: &[&str], folder: &str) -> ModuleGraph {
        let root = |krate: &&str| workspace().join("crates").join(krate).join("src").join(folder);
        let inside = if folder.is_empty() { 1 } else { 2 };
        let mut text: BTreeMap<String, String> = BTreeMap::new();
        let mut folders: Vec<_> = crates.iter().map(|krate| (root(krate), String::new())).collect();
        while let Some((dir, prefix)) = folders.pop() {
            for entry in std::fs::read_dir(dir).unwrap() {
                let path = entry.unwrap().path();
                let name = path.file_stem().unwrap().to_string_lossy().into_owned();
                if name == "tests" || name == "golden" {
                    continue;
                }
                if path.is_dir() {
                    folders.push((path, format!("{prefix}{name}::")));
                } else if path.extension().is_some_and(|e| e == "rs") {
                    let module = if name == "mod" || name == "lib" && prefix.is_empty() {
                        prefix.trim_end_matches("::").into()
                    } else {
                        format!("{prefix}{name}")
                    };
                    text.entry(module).or_default().push_str(&code(&path));
                }
            }
        }
        let mut graph = ModuleGraph { text, uses: BTreeMap::new() };
        for (module, text) in &graph.text {
            let mut used = BTreeSet::new();
            let is_folder =
                module.is_empty() || graph.text.keys().any(|k| k.starts_with(&format!("{module}::")));
            for path in imports(text) {
                let mut parts: Vec<&str> = path.split("::").collect();
                let mut at: Vec<&str> = module.split("::").filter(|p| !p.is_empty()).collect();
                match parts.first() {
                    Some(&"super") if !(is_folder && at.is_empty()) => {
                        while parts.first() == Some(&"super") {
                            at.pop();
                            parts.remove(0);
                        }
                    }
                    Some(&"crate") if inside == 1 || parts.get(1) == Some(&folder) => {
                        at.clear();
                        parts.drain(..inside);
                    }
                    _ => continue,
                }
                at.extend(parts);
                used.extend(graph.owner(&at));
            }
            // Drivers call the checks of rules by their pages.
            for (at, _) in text.match_indices("rules::") {
                let name = text[at + 7..].split(|c: char| !c.is_alphanumeric() && c != '_').next();
                used.extend(name.and_then(|name| graph.owner(&["rules", name])).filter(|m| !m.is_empty()));
            }
            used.remove(module);
            graph.uses.insert(module.clone(), used);
        }
        graph
    }

    /// The module to which a path refers: the longest prefix that is a module, or the module from which
    /// that one imports the name.
    fn owner(&self, path: &[&str]) -> Option<String> {
        let (module, name) = (0..=path.len()).rev().find_map(|n| {
            let module = path[..n].join("::");
            self.text.contains_key(&module).then(|| (module, path.get(n).copied()))
        })?;
        let Some(name) = name else { return Some(module) };
        // A rule is on the page with its name; the build script writes the list of pages.
        let page = format!("{module}::{}", name.to_lowercase());
        if module == "rules" && name.to_uppercase() == name && self.text.contains_key(&page) {
            return Some(page);
        }
        let from = imports(&self.text[&module]).into_iter().find_map(|p| {
            let parts: Vec<&str> = p.split("::").collect();
            (parts.last() == Some(&name) && !matches!(parts[0], "crate" | "super" | "std")).then(|| {
                let mut whole: Vec<String> =
                    module.split("::").filter(|p| !p.is_empty()).map(Into::into).collect();
                whole.extend(parts[..parts.len() - 1].iter().map(|p| (*p).to_string()));
                whole.join("::")
            })
        });
        Some(from.filter(|m| self.text.contains_key(m)).unwrap_or(module))
    }

    /// A cycle of modules, not counting parents and their children.
    fn cycle(&self) -> Option<Vec<String>> {
        let kin = |a: &str, b: &str| {
            a.is_empty()
                || b.is_empty()
                || a.starts_with(&format!("{b}::"))
                || b.starts_with(&format!("{a}::"))
        };
        let mut done = BTreeSet::new();
        for start in self.uses.keys() {
            let mut path = vec![(start.clone(), self.uses[start].iter().cloned().collect::<Vec<_>>())];
            while let Some((at, next)) = path.last_mut() {
                let Some(to) = next.pop() else {
                    done.insert(at.clone());
                    path.pop();
                    continue;
                };
                if kin(at, &to) || done.contains(&to) {
                    continue;
                }
                if let Some(k) = path.iter().position(|(m, _)| *m == to) {
                    return Some(path[k..].iter().map(|(m, _)| m.clone()).collect());
                }
                let after = self.uses.get(&to).map_or(Vec::new(), |u| u.iter().cloned().collect());
                path.push((to, after));
            }
        }
        None
    }
}

/// Shapes, rays, distances and contacts use only numbers and kinds of shapes; they do not depend on models, data or dynamics.
#[test]
fn geometry_takes_shapes() {
    let graph = ModuleGraph::read(&["engine"], "geometry");
    assert!(graph.text.len() > 20 && graph.uses.values().map(BTreeSet::len).sum::<usize>() > 40);
    for (module, text) in &graph.text {
        for path in imports(text).iter().filter(|p| p.starts_with("crate::")) {
            let allowed = ["crate::math", "crate::kinds", "crate::geometry"];
            assert!(allowed.iter().any(|k| path.starts_with(k)), "geometry::{module} uses {path}");
        }
        let rest = text.split(';').filter(|s| !s.trim_start().starts_with("use ")).collect::<String>();
        assert!(!rest.contains("crate::Model") && !rest.contains("crate::Data"), "geometry::{module}");
    }
}

/// What steps, and what reads models and is the interface: two crates, so that only the first is built for speed in pages.
const ENGINE: [&str; 2] = ["engine", "core"];

/// The modules of the engine, from the lowest to the highest. A file imports only its own module and lower ones.
const MODULES: [&str; 16] = [
    "math",
    "kinds",
    "geometry",
    "model",
    "dynamics",
    "forces",
    "collision",
    "query",
    "constraint",
    "sensor",
    "step",
    "setup",
    "source",
    "mjcf",
    "no_mjcf",
    "api",
];

#[test]
fn engine_modules_import_only_lower_modules() {
    let graph = ModuleGraph::read(&ENGINE, "");
    assert!(graph.text.len() > 150 && graph.uses.values().map(BTreeSet::len).sum::<usize>() > 600);
    let place = |module: &str| {
        let top = module.split("::").next().unwrap_or_default();
        MODULES
            .iter()
            .position(|r| *r == top)
            .unwrap_or_else(|| panic!("{module} is not in the order of modules"))
    };
    for (module, uses) in graph.uses.iter().filter(|(module, _)| !module.is_empty()) {
        for used in uses {
            assert!(!used.is_empty(), "{module} imports from the crate's root what a module has");
            assert!(place(used) <= place(module), "{module} imports the higher module {used}");
        }
    }
}

/// What runs, and what compiles and is the interface: two crates, so that only the first is built for speed in pages.
const LANGUAGE_CRATES: [&str; 2] = ["machine", "expr"];

/// The modules of the language, from the lowest to the highest. Binding comes after programs, because the arguments of
/// an aggregate are programs.
const LANGUAGE: [&str; 40] = [
    "host_terms",
    "rules",
    "number",
    "operators",
    "dimension",
    "global_names",
    "lex",
    "ast",
    "parse",
    "print",
    "types",
    "math",
    "operation",
    "value",
    "tables",
    "schema",
    "globals",
    "chain",
    "ir",
    "effects",
    "ssa",
    "formula",
    "watch",
    "row",
    "code",
    "lower",
    "heap",
    "host",
    "runtime_event",
    "context",
    "natives",
    "source_functions",
    "analysis",
    "vm",
    "program",
    "bind",
    "columnar",
    "complete",
    "signature",
    "reference",
];

/// A module of the language uses only modules before it.
#[test]
fn a_module_of_the_language_uses_those_before_it() {
    let mut graph = ModuleGraph::read(&LANGUAGE_CRATES, "");
    // The test host uses everything.
    graph.uses.remove("mock");
    assert!(graph.text.len() > 120 && graph.uses.values().map(BTreeSet::len).sum::<usize>() > 400);
    let place = |module: &str| {
        let top = module.split("::").next().unwrap_or_default();
        LANGUAGE.iter().position(|r| *r == top).unwrap_or_else(|| panic!("{module} is not in the language"))
    };
    for (module, uses) in graph.uses.iter().filter(|(module, _)| !module.is_empty()) {
        for used in uses {
            assert!(!used.is_empty(), "{module} asks the crate's root for what a module has");
            assert!(place(used) <= place(module), "{module} imports the later module {used}");
        }
    }
}

#[test]
fn files_of_the_language_form_no_import_cycles() {
    assert_eq!(ModuleGraph::read(&LANGUAGE_CRATES, "").cycle(), None);
}

/// The pipeline of a lesson, in order: its text, its contents, the rules, the meaning for the engine, runs, verification of
/// claims, and reports. Facades come last.
const PIPELINE: [&str; 28] = [
    "printable",
    "interrupt",
    "threads",
    "pairwise",
    "source",
    "finding",
    "markdown",
    "json",
    "language",
    "spec",
    "rules",
    "models",
    "lint",
    "ledger",
    "listings",
    "bind",
    "format",
    "reference",
    "run",
    "verify",
    "stress",
    "check",
    "repair",
    "report",
    "error",
    "player",
    "checker",
    "engine",
];

/// A module uses only modules before it. The page of a rule, which contains its check, has the position of the highest
/// module that the check uses.
#[test]
fn a_module_of_the_pipeline_uses_those_before_it() {
    let graph = ModuleGraph::read(&["labspec"], "");
    assert!(graph.text.len() > 150 && graph.uses.values().map(BTreeSet::len).sum::<usize>() > 600);
    let mut places: BTreeMap<&str, usize> = BTreeMap::new();
    let place = |places: &BTreeMap<&str, usize>, module: &str| {
        let top = module.split("::").next().unwrap_or_default();
        let of_module = || PIPELINE.iter().position(|r| *r == top);
        places
            .get(module)
            .copied()
            .or_else(of_module)
            .unwrap_or_else(|| panic!("{module} is not in the pipeline"))
    };
    let pages: Vec<_> = graph.uses.iter().filter(|(module, _)| module.starts_with("rules::")).collect();
    // The highest module may be reached through several pages.
    for (page, uses) in pages.iter().flat_map(|_| &pages) {
        let highest = uses.iter().map(|used| place(&places, used)).max();
        places.insert(page, highest.unwrap_or(0).max(place(&places, page)));
    }
    let place = |module: &str| place(&places, module);
    for (module, uses) in graph.uses.iter().filter(|(module, _)| !module.is_empty()) {
        for used in uses.iter().filter(|used| !used.is_empty()) {
            assert!(place(used) <= place(module), "{module} imports the later module {used}");
        }
    }
}

#[test]
fn files_of_the_engine_form_no_import_cycles() {
    assert_eq!(ModuleGraph::read(&ENGINE, "").cycle(), None);
}

/// The crates in which no two files use each other.
const WITHOUT_CYCLES: [&str; 15] = [
    "assist",
    "bind",
    "cli",
    "developer",
    "engine",
    "expr",
    "finding",
    "labspec",
    "lsp",
    "machine",
    "monitors",
    "numerics",
    "plot",
    "proposals",
    "site",
];

#[test]
fn files_of_a_crate_form_no_import_cycles() {
    for krate in WITHOUT_CYCLES {
        let graph = ModuleGraph::read(&[krate], "");
        assert!(!graph.text.is_empty(), "there is no crate {krate}");
        assert_eq!(graph.cycle(), None, "in the crate {krate}");
    }
}

/// A file name is unique: `contact.rs` is one file. (`mod.rs` and `tests.rs` are identified by their folder.)
#[test]
fn no_two_files_of_the_engine_have_one_name() {
    let folder = |krate: &str| workspace().join("crates").join(krate).join("src");
    let (mut seen, mut folders) = (BTreeMap::new(), ENGINE.map(folder).to_vec());
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            let name = path.file_name().unwrap().to_owned();
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|e| e == "rs")
                && !matches!(name.to_str(), Some("mod.rs" | "tests.rs" | "lib.rs"))
            {
                let other = seen.insert(name, path.clone());
                assert_eq!(other, None, "{} has the same name", path.display());
            }
        }
    }
    assert!(seen.len() > 150);
}

/// The language does not depend on its host: the terms for the objects of a lab in messages come from the host.
#[test]
fn the_language_has_no_words_of_labs() {
    const WORDS: [&str; 16] = [
        "mj_",
        "mj.",
        "mujoco",
        "qpos",
        "qvel",
        "xpos",
        "ctrl",
        "slider",
        "readout",
        "joint",
        "simulation",
        "physics",
        "quaternion",
        "timestep",
        "`controller`",
        "`setup`",
    ];
    let folder = |krate: &str| workspace().join("crates").join(krate).join("src");
    let (mut texts, mut folders) = (0, LANGUAGE_CRATES.map(folder).to_vec());
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            let name = path.file_name().unwrap().to_string_lossy().into_owned();
            if path.is_dir() && !matches!(name.as_str(), "tests" | "snapshots") {
                folders.push(path);
            } else if name.ends_with(".rs") && !matches!(name.as_str(), "mock.rs" | "tests.rs") {
                // The examples of a rule are source texts of labs. Every second part between quotes is a string.
                let code = code(&path);
                let outside_examples = code.split("bad: Example::").next().unwrap_or("");
                for text in outside_examples.split('"').skip(1).step_by(2) {
                    texts += 1;
                    let text = text.to_lowercase();
                    let found = WORDS.iter().find(|word| text.contains(*word));
                    assert_eq!(found, None, "{}: {text}", path.display());
                }
            }
        }
    }
    assert!(texts > 1000, "{texts}");
}
