//! Which findings are reported and count: selected and ignored rules, settings, suppressions, baselines; report formats; fixes.

#![allow(clippy::unwrap_used, clippy::panic)]

use crate::program::{Done, run_in};
use crate::support::report;
use serde_json::{Value, json};
use std::path::Path;
use tempfile::TempDir;

/// Two readouts with the same name: a warning, and no other finding.
const TWICE: &str = r##"# Fall

```lab simlab
{
  "xml": "<mujoco><worldbody><body name='ball' pos='0 0 1'><freejoint/><geom name='ball' size='.05'/></body></worldbody></mujoco>",
  "title": "Fall",
  "readouts": [{"label": "z", "expr": "data.qpos[2]", "digits": 2},
    {"label": "z", "expr": "data.qvel[2]", "digits": 2}]
}
```
"##;

fn folder(files: &[(&str, &str)]) -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    for (name, text) in files {
        write(folder.path(), name, text);
    }
    folder
}

fn write(folder: &Path, name: &str, text: &str) {
    let path = folder.join(name);
    std::fs::create_dir_all(path.parent().unwrap()).unwrap();
    std::fs::write(path, text).unwrap();
}

fn check(folder: &TempDir, arguments: &[&str]) -> Done {
    let all: Vec<&str> = ["check"].into_iter().chain(arguments.iter().copied()).collect();
    run_in(folder.path(), &all)
}

fn parsed(done: &Done) -> Value {
    serde_json::from_str(&done.stdout).unwrap_or_else(|e| panic!("{e}: {}{}", done.stdout, done.stderr))
}

/// The exit code and the reported codes.
fn reported_codes(folder: &TempDir, arguments: &[&str]) -> (i32, Vec<String>) {
    let all: Vec<&str> = arguments.iter().copied().chain(["--format", "json"]).collect();
    let done = check(folder, &all);
    report::hold(&done.stdout);
    let codes = parsed(&done)["findings"].as_array().unwrap().clone();
    (done.code, codes.iter().map(|f| f["code"].as_str().unwrap().to_string()).collect())
}

fn codes(list: &[&str]) -> Vec<String> {
    list.iter().map(|s| (*s).to_string()).collect()
}

#[test]
fn rules_are_selected_and_ignored() {
    let folder = folder(&[("a.md", TWICE)]);
    let twice = codes(&["duplicate-readout"]);
    assert_eq!(reported_codes(&folder, &["a.md"]), (1, twice.clone()));
    assert_eq!(reported_codes(&folder, &["a.md", "--select", "structure"]), (1, twice.clone()));
    assert_eq!(reported_codes(&folder, &["a.md", "--select", "run"]), (0, vec![]));
    assert_eq!(reported_codes(&folder, &["a.md", "--ignore", "duplicate-readout"]), (0, vec![]));
    assert_eq!(reported_codes(&folder, &["a.md", "--ignore", "structure,model"]), (0, vec![]));
    assert_eq!(reported_codes(&folder, &["a.md", "--ignore", "warnings"]), (0, vec![]));
    let done = check(&folder, &["a.md", "--ignore", "duplicate-readout"]);
    assert!(done.stdout.contains("(1 warning ignored)"), "{}", done.stdout);
    let denied = parsed(&check(&folder, &["a.md", "--deny", "warnings", "--format", "json"]));
    assert_eq!(denied["findings"][0]["severity"], "error");
    let wrong = check(&folder, &["a.md", "--ignore", "duplicate-readouts"]);
    assert_eq!(wrong.code, 2);
    assert!(wrong.stderr.contains("did you mean `duplicate-readout`"), "{}", wrong.stderr);
}

/// Ignoring an error does not make a broken lesson clean.
#[test]
fn an_ignored_error_is_omitted_but_not_a_success() {
    let broken = TWICE.replace("data.qvel[2]", "data.qvle[2]").replacen("\"z\"", "\"v\"", 1);
    let folder = folder(&[("a.md", &broken)]);
    assert_eq!(reported_codes(&folder, &["a.md"]).0, 1);
    let done = check(&folder, &["a.md", "--ignore", "unknown-field"]);
    assert_ne!(done.code, 0, "{}", done.stdout);
    assert!(!done.stdout.contains("no problems found"), "{}", done.stdout);
}

#[test]
fn settings_of_the_nearest_file_count() {
    let folder = folder(&[
        ("labspec.toml", "[[paths]]\nmatch = [\"drafts/**\"]\nignore = [\"duplicate-readout\"]\n"),
        ("a.md", TWICE),
        ("drafts/b.md", TWICE),
    ]);
    assert_eq!(reported_codes(&folder, &["."]), (1, codes(&["duplicate-readout"])));
    assert_eq!(reported_codes(&folder, &["drafts"]), (0, vec![]));
    write(folder.path(), "labspec.toml", "ignore = [\"nonsense\"]\n");
    let done = check(&folder, &["."]);
    assert_eq!(done.code, 2);
    assert!(done.stderr.contains("labspec.toml: ignore: `nonsense` is not a rule"), "{}", done.stderr);
    write(folder.path(), "other.toml", "ignore = [\"structure\"]\n");
    assert_eq!(reported_codes(&folder, &[".", "--config", "other.toml"]), (0, vec![]));
}

#[test]
fn an_author_allows_with_a_reason() {
    let with = |lint: &str| TWICE.replace("  \"title\"", &format!("  {lint},\n  \"title\""));
    let folder = folder(&[
        ("a.md", &with(r#""lint": {"allow": ["duplicate-readout"], "why": "both are read aloud"}"#)),
        (
            "b.md",
            &TWICE.replace("```lab", "<!-- labspec allow duplicate-readout: both are read -->\n\n```lab"),
        ),
        ("c.md", &with(r#""lint": {"allow": ["unknown-key", "nonsense"], "why": "because"}"#)),
        ("d.md", &TWICE.replace("```lab", "<!-- labspec allow duplicate-readout -->\n\n```lab")),
        ("e.md", &with(r#""lint": {"allow": ["duplicate-readout"]}"#)),
    ]);
    assert_eq!(reported_codes(&folder, &["a.md"]), (0, vec![]));
    assert_eq!(reported_codes(&folder, &["b.md"]), (0, vec![]));
    assert_eq!(
        reported_codes(&folder, &["c.md"]),
        (1, codes(&["unused-allowance", "unknown-rule", "duplicate-readout"]))
    );
    assert_eq!(
        reported_codes(&folder, &["d.md"]),
        (1, codes(&["allowance-without-reason", "duplicate-readout"]))
    );
    assert!(reported_codes(&folder, &["e.md"]).1.contains(&"missing-key".to_string()));
    let done = check(&folder, &["a.md", "--show-allowed"]);
    assert!(done.stdout.contains("suppressed: both are read aloud"), "{}", done.stdout);
    assert!(done.stdout.contains("1 finding suppressed by the lessons"), "{}", done.stdout);
    let suppressed = &parsed(&check(&folder, &["a.md", "--format", "json"]))["aside"];
    assert_eq!(
        (&suppressed["allowed"][0]["code"], &suppressed["ignored"]),
        (&json!("duplicate-readout"), &json!(0))
    );
}

#[test]
fn baselined_findings_are_not_reported() {
    let broken = TWICE.replace("data.qvel[2]", "data.qvle[2]");
    let folder = folder(&[("lessons/a.md", &broken)]);
    let written = check(&folder, &["lessons", "--baseline", "known.json", "--update-baseline"]);
    assert_eq!(written.code, 0, "{}", written.stderr);
    assert_eq!(reported_codes(&folder, &["lessons", "--baseline", "known.json"]), (0, vec![]));
    let done = check(&folder, &["lessons", "--baseline", "known.json"]);
    assert!(done.stdout.contains("no problems outside the baseline"), "{}", done.stdout);
    assert!(!done.stdout.contains("no problems found"), "{}", done.stdout);
    // Moved text is still recognized by the baseline; new findings are reported.
    let moved = broken.replace("# Fall", "# Fall\n\nA ball falls.\n\nIt falls fast.");
    write(folder.path(), "lessons/a.md", &moved);
    assert_eq!(reported_codes(&folder, &["lessons", "--baseline", "known.json"]), (0, vec![]));
    write(folder.path(), "lessons/a.md", &moved.replace("data.qpos[2]", "data.qops[2]"));
    let (code, found) = reported_codes(&folder, &["lessons", "--baseline", "known.json"]);
    assert_eq!((code, found), (1, codes(&["unknown-field"])));
    assert_eq!(check(&folder, &["lessons", "--baseline", "none.json"]).code, 2);
}

#[test]
fn reports_have_the_forms_of_other_programs() {
    let folder = folder(&[("a.md", TWICE)]);
    let form = |name: &str| check(&folder, &["a.md", "--format", name]);
    let concise = form("concise").stdout;
    assert!(concise.starts_with("a.md:8:16: warning[duplicate-readout]: "), "{concise}");
    let lines = form("jsonl").stdout;
    let lines: Vec<Value> = lines.lines().map(|l| serde_json::from_str(l).unwrap()).collect();
    assert_eq!(
        (&lines[0]["code"], &lines[1]["summary"]["warnings"]),
        (&json!("duplicate-readout"), &json!(1))
    );
    let github = form("github").stdout;
    let start = "::warning file=a.md,line=8,endLine=8,col=16,endColumn=17,title=labspec duplicate-readout::";
    assert!(github.starts_with(start), "{github}");
    let gitlab = parsed(&form("gitlab"));
    assert_eq!(gitlab[0]["location"], json!({"path": "a.md", "lines": {"begin": 8, "end": 8}}));
    assert_eq!(gitlab[0]["fingerprint"].as_str().unwrap().len(), 32);
    let sarif = parsed(&form("sarif"));
    let result = &sarif["runs"][0]["results"][0];
    assert_eq!((&sarif["version"], &result["ruleId"]), (&json!("2.1.0"), &json!("duplicate-readout")));
    let region = &result["locations"][0]["physicalLocation"]["region"];
    assert_eq!(region, &json!({"startLine": 8, "startColumn": 16, "endLine": 8, "endColumn": 17}));
    assert_eq!(sarif["runs"][0]["tool"]["driver"]["rules"][0]["id"], "duplicate-readout");
    let junit = form("junit").stdout;
    let tree = roxmltree::Document::parse(&junit).unwrap();
    let cases = tree.descendants().filter(|n| n.has_tag_name("testcase")).count();
    let root = tree.root_element();
    assert_eq!(root.attribute("tests"), Some(cases.to_string().as_str()));
    assert_eq!((root.attribute("failures"), cases), (Some("1"), 2));
    let counted = check(&folder, &["a.md", "--statistics"]).stdout;
    assert!(counted.contains("     1  warning  duplicate-readout"), "{counted}");
}

#[test]
fn repairs_are_checked_before_they_are_written() {
    // A superfluous comma and a misspelt key, in an unusual layout.
    let odd =
        TWICE.replacen("\"z\"", "\"v\"", 1).replace("2}]\n}", "2}],\n}").replace("  \"read", " \t\"read");
    let odd = odd.replace("\"title\"", "\"titel\"");
    let folder = folder(&[("a.md", &odd)]);
    let read = || std::fs::read_to_string(folder.path().join("a.md")).unwrap();
    let diff = check(&folder, &["a.md", "--diff"]);
    assert_eq!(diff.code, 1, "{}{}", diff.stdout, diff.stderr);
    assert!(diff.stdout.contains("2}],\n") && diff.stdout.contains("2}]\n"), "{}", diff.stdout);
    assert_eq!(read(), odd);
    let done = check(&folder, &["a.md", "--fix"]);
    assert_eq!(done.code, 1, "{}{}", done.stdout, done.stderr);
    assert!(done.stderr.contains("fixed 1 finding in 1 file"), "{}", done.stderr);
    let safe = odd.replace("2}],\n", "2}]\n");
    assert_eq!(read(), safe);
    // A guess is applied only on request.
    let done = check(&folder, &["a.md", "--unsafe-fixes"]);
    assert_eq!(done.code, 0, "{}{}", done.stdout, done.stderr);
    assert_eq!(read(), safe.replace("titel", "title"));
    assert_eq!(check(&folder, &["a.md", "--diff"]).code, 0);
}

#[test]
fn standard_input_has_a_name() {
    let folder = folder(&[("lessons/x.md", "")]);
    let done = crate::program::run_with_input(
        folder.path(),
        &["check", "-", "--stdin-name", "lessons/a.md", "--format", "concise"],
        TWICE,
    );
    assert_eq!(done.code, 1, "{}", done.stderr);
    assert!(done.stdout.starts_with("lessons/a.md:8:16: warning"), "{}", done.stdout);
}

#[test]
fn files_ignored_by_git_are_not_lessons() {
    let folder = folder(&[("a.md", "# A\n"), ("build/b.md", TWICE), (".gitignore", "build/\n")]);
    assert!(!check(&folder, &["."]).stdout.contains("duplicate-readout"));
    // A file that is named directly is checked.
    assert_eq!(check(&folder, &["build/b.md"]).code, 1);
}

/// An unknown widget is in the ledger as not checked, and is counted. If the page provides it, the ledger states this.
#[test]
fn an_unknown_widget_is_listed_as_not_checked() {
    let folder = crate::program::folder();
    let lesson = format!(
        "{}\n```lab gearbox\n{{\"model\": \"ball_drop\"}}\n```\n\n```lab playground\n{{}}\n```\n",
        crate::program::CLEAN
    );
    std::fs::write(folder.path().join("clean.md"), lesson).unwrap();
    let check = |arguments: &[&str]| check(&folder, &[&["clean.md"], arguments].concat());
    let done = check(&[]);
    assert_eq!(done.code, 3, "{}", done.stdout);
    assert!(done.stdout.contains("unknown    widget gearbox: not checked; "), "{}", done.stdout);
    assert!(done.stdout.contains("2 other widgets not checked"), "{}", done.stdout);
    let report: Value = parsed(&check(&["--format", "json"]));
    let entries = report["ledger"].as_array().unwrap().iter();
    let widgets: Vec<_> = entries.filter(|e| e["subject"] == "otherWidget").map(|e| &e["owner"]).collect();
    assert_eq!(widgets, ["widget gearbox", "widget playground"]);
    assert_eq!(report["summary"]["claims"]["otherWidget"]["leftOut"], 2);
    assert_eq!(report["summary"]["outcome"], "partial");
    // If only claims are verified, widgets are not mentioned.
    assert_eq!(run_in(folder.path(), &["verify", "clean.md"]).code, 0);
    let settings = folder.path().join("labspec.toml");
    std::fs::write(&settings, "widgets = [\"gearbox\"]\n").unwrap();
    let done = check(&[]);
    assert_eq!(done.code, 3);
    assert!(done.stdout.contains("1 other widget not run, 1 other widget not checked"), "{}", done.stdout);
    std::fs::write(&settings, "widgets = [\"gearbox\", \"playground\"]\n").unwrap();
    assert_eq!(check(&[]).code, 0);
    // A misspelt name denotes another widget.
    std::fs::write(&settings, "widgets = [\"gear\", \"playground\"]\n").unwrap();
    assert_eq!(check(&[]).code, 3);
}

/// For any number of suppressions, only a limited number of their errors is listed, and the report states that there are more.
#[test]
fn mistakes_in_allowances_are_listed_up_to_a_limit() {
    let text = "x <!-- labspec allow nonsense: why -->".repeat(100_000);
    let checked = crate::support::check_text("a.md", &text);
    let codes = crate::support::codes(&checked);
    let count = |code: &str| codes.iter().filter(|c| **c == code).count();
    assert_eq!((count("unknown-rule"), count("lesson-limit")), (labspec::lint::MAX_FINDINGS, 1));
    assert_eq!(codes.len(), labspec::lint::MAX_FINDINGS + 1);
}
