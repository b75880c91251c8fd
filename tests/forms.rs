//! Report formats of other programs, compared with their specifications: SARIF 2.1.0, GitLab's code quality, JUnit as Jenkins
//! reads it, and the commands of GitHub's workflows. The requirements of the standards are written here in our own words. The
//! contents are compared with our own report.

#![allow(clippy::unwrap_used, clippy::panic)]

use crate::program::{CLEAN, folder, run_in, wrong};
use crate::support::schema::problems;
use crate::support::{read_json, workspace};
use roxmltree::{Document, Node};
use serde_json::{Value, json};
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;
use tempfile::TempDir;

/// The input: findings of every severity, with fixes, in files with unusual names, characters and line ends.
const ARGUMENTS: [&str; 9] = [
    "check",
    "wrong.md",
    "./odd/ä [1] 100%#a:b.md",
    "clean.md",
    "bad.md",
    "nowhere.md",
    "broken",
    "notes.md",
    "--models=models",
];

fn course() -> TempDir {
    let folder = folder();
    let write = |name: &str, bytes: &[u8]| {
        let path = folder.path().join(name);
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(path, bytes).unwrap();
    };
    let odd = "\u{feff}# 𝄞 ä\r\n\r\n```lab simlab\r\n{\"model\": \"ball_drop\", \"title\": \"𝄞👩‍🔬ä <&>\", \"modle\": 1, \"setup\": \"data.qpso[2] = 1; ctx.a = 30 * Math.sin(30)\",}\r\n```\r\n";
    write("odd/ä [1] 100%#a:b.md", odd.as_bytes());
    write("bad.md", b"# \xe9\n```lab simlab\n{\"modle\": \"free_fall\"}\n```\n");
    let quiz = "```quiz\n{\"id\": \"long\", \"questions\": [{\"q\": \"Does mass matter?\", \"options\": [\"yes\", \"no: a heavy ball is pulled harder, and is harder to move by as much\"], \"answer\": 1}]}\n```\n";
    let twice = CLEAN.replace("\"digits\": 4", "\"digits\": 4, \"digits\": 3");
    write("notes.md", format!("{twice}\n{quiz}").as_bytes());
    folder
}

/// The output of the program for the course in a format.
fn form(folder: &Path, name: &str) -> String {
    let arguments: Vec<&str> = ARGUMENTS.into_iter().chain(["--format", name]).collect();
    let done = run_in(folder, &arguments);
    assert_eq!(done.code, 1, "{}", done.stderr);
    done.stdout
}

/// The findings of our own report.
fn findings(folder: &Path) -> Vec<Value> {
    let report: Value = serde_json::from_str(&form(folder, "json")).unwrap();
    let all = report["findings"].as_array().unwrap().clone();
    let with = |key: &str, value: &str| all.iter().any(|f| f[key] == value);
    assert!(with("severity", "error") && with("severity", "warning") && with("severity", "note"), "{all:#?}");
    assert!(all.iter().filter(|f| f["fix"].is_object()).count() > 2, "{all:#?}");
    all
}

/// The byte of a position, counted as SARIF and our report do: lines and characters from 1.
fn at(text: &str, line: &Value, column: &Value) -> usize {
    let (line, column) = (line.as_u64().unwrap() as usize, column.as_u64().unwrap() as usize);
    let start: usize = text.split_inclusive('\n').take(line - 1).map(str::len).sum();
    start + text[start..].chars().take(column - 1).map(char::len_utf8).sum::<usize>()
}

/// The path of a URI: only the path characters of RFC 3986, which stand for bytes of UTF-8, and no scheme,
/// because the path is relative.
fn path_of(uri: &str) -> String {
    assert!(!uri.split('/').next().unwrap().contains(':'), "{uri} begins with a scheme");
    let mut bytes = Vec::new();
    let mut left = uri.bytes();
    while let Some(b) = left.next() {
        assert!(b.is_ascii_alphanumeric() || b"/-._~!$&'()*+,;=:@%".contains(&b), "{uri}");
        if b == b'%' {
            let digits = [left.next().unwrap(), left.next().unwrap()];
            bytes.push(u8::from_str_radix(std::str::from_utf8(&digits).unwrap(), 16).unwrap());
        } else {
            bytes.push(b);
        }
    }
    String::from_utf8(bytes).unwrap()
}

/// The objects of SARIF 2.1.0 that a linter writes: their required properties and types, and no others (sections 3.13
/// to 3.58 of the standard).
fn sarif_schema() -> Value {
    let closed = |required: &[&str], properties: Value| json!({"type": "object", "required": required, "properties": properties, "additionalProperties": false});
    let to = |name: &str| json!({"$ref": format!("#/$defs/{name}")});
    let list = |name: &str, least: u64| json!({"type": "array", "items": to(name), "minItems": least});
    let text = json!({"type": "string"});
    let from_one = json!({"type": "integer", "minimum": 1});
    let level = json!({"enum": ["none", "note", "warning", "error"]});
    let log = closed(
        &["version", "runs"],
        json!({"$schema": text, "version": {"const": "2.1.0"}, "runs": list("run", 0)}),
    );
    let mut schema = log;
    schema["$defs"] = json!({
        "run": closed(&["tool"], json!({
            "tool": to("tool"), "results": list("result", 0),
            "columnKind": {"enum": ["utf16CodeUnits", "unicodeCodePoints"]},
        })),
        "tool": closed(&["driver"], json!({"driver": to("component")})),
        "component": closed(&["name"], json!({
            "name": text, "version": text, "informationUri": text, "rules": list("rule", 0),
        })),
        "rule": closed(&["id"], json!({
            "id": text, "helpUri": text, "shortDescription": to("words"), "fullDescription": to("words"),
            "defaultConfiguration": closed(&[], json!({"level": level})),
        })),
        "words": closed(&["text"], json!({"text": text, "markdown": text})),
        "result": closed(&["message"], json!({
            "ruleId": text, "ruleIndex": {"type": "integer", "minimum": 0}, "level": level, "message": to("words"),
            "locations": list("location", 0), "fixes": list("fix", 0),
            "partialFingerprints": {"type": "object", "additionalProperties": text},
        })),
        "location": closed(&[], json!({
            "physicalLocation": closed(&["artifactLocation"], json!({
                "artifactLocation": to("artifact"), "region": to("region"),
            })),
        })),
        "artifact": closed(&["uri"], json!({"uri": text})),
        "region": closed(&["startLine"], json!({
            "startLine": from_one, "startColumn": from_one, "endLine": from_one, "endColumn": from_one,
        })),
        "fix": closed(&["artifactChanges"], json!({"description": to("words"), "artifactChanges": list("change", 1)})),
        "change": closed(&["artifactLocation", "replacements"], json!({
            "artifactLocation": to("artifact"), "replacements": list("replacement", 1),
        })),
        "replacement": closed(&["deletedRegion"], json!({
            "deletedRegion": to("region"), "insertedContent": closed(&[], json!({"text": text})),
        })),
    });
    schema
}

#[test]
fn sarif_follows_its_schema() {
    let folder = course();
    let log: Value = serde_json::from_str(&form(folder.path(), "sarif")).unwrap();
    let schemas = BTreeMap::from([("sarif".to_string(), sarif_schema())]);
    assert_eq!(problems(&schemas, "sarif", &log), [""; 0]);
    // The schema can be violated.
    for (place, value) in [
        ("/version", json!("2.0.0")),
        ("/runs/0/tool/driver/name", json!(1)),
        ("/runs/0/results/0/level", json!("info")),
        ("/runs/0/results/0/message", json!({})),
        ("/runs/0/results/0/locations/0/physicalLocation/region/startLine", json!(0)),
        ("/runs/0/results/0/ruleIndex", json!(-1)),
    ] {
        let mut bad = log.clone();
        *bad.pointer_mut(place).unwrap() = value;
        assert!(!problems(&schemas, "sarif", &bad).is_empty(), "{place}");
    }
    let run = &log["runs"][0];
    let rules = run["tool"]["driver"]["rules"].as_array().unwrap();
    let ids: BTreeSet<&str> = rules.iter().map(|r| r["id"].as_str().unwrap()).collect();
    assert_eq!(ids.len(), rules.len());
    assert_eq!(run["columnKind"], "unicodeCodePoints");
    let results = run["results"].as_array().unwrap();
    let findings_of_labspec = findings(folder.path());
    assert_eq!(results.len(), findings_of_labspec.len());
    let (mut marks, mut repaired) = (BTreeSet::new(), 0);
    for (result, f) in results.iter().zip(&findings_of_labspec) {
        assert_eq!((&result["ruleId"], &result["level"]), (&f["code"], &f["severity"]));
        let index = result["ruleIndex"].as_u64().unwrap() as usize;
        assert_eq!(rules[index]["id"], f["code"]);
        assert!(marks.insert(result["partialFingerprints"]["labspec/v1"].to_string()), "{result}");
        let place = &result["locations"][0]["physicalLocation"];
        let uri = place["artifactLocation"]["uri"].as_str().unwrap();
        let path = f["file"].as_str().unwrap();
        assert_eq!(path_of(uri), path.strip_prefix("./").unwrap_or(path));
        let region = &place["region"];
        for (sarif_key, key) in [
            ("startLine", "line"),
            ("startColumn", "column"),
            ("endLine", "endLine"),
            ("endColumn", "endColumn"),
        ] {
            // A file that cannot be read has no locations.
            assert_eq!(region[sarif_key], f[key], "{result}");
        }
        // The replacement of a fix is the same as in our report.
        let Ok(text) = std::fs::read_to_string(folder.path().join(path)) else { continue };
        for fix in result["fixes"].as_array().into_iter().flatten() {
            let change = &fix["artifactChanges"][0];
            assert_eq!(change["artifactLocation"]["uri"], uri);
            let [replacement] = &change["replacements"].as_array().unwrap()[..] else { panic!("{change}") };
            let gone = &replacement["deletedRegion"];
            let span = at(&text, &gone["startLine"], &gone["startColumn"])
                ..at(&text, &gone["endLine"], &gone["endColumn"]);
            let span_of_fix =
                f["fix"]["start"].as_u64().unwrap() as usize..f["fix"]["end"].as_u64().unwrap() as usize;
            assert_eq!(
                (span, &replacement["insertedContent"]["text"]),
                (span_of_fix, &f["fix"]["text"]),
                "{result}"
            );
            repaired += 1;
        }
    }
    assert!(repaired > 2, "{repaired}");
}

#[test]
fn gitlab_can_read_its_report() {
    let folder = course();
    let report: Value = serde_json::from_str(&form(folder.path(), "gitlab")).unwrap();
    let schema = json!({
        "type": "array",
        "items": {
            "type": "object",
            "required": ["description", "check_name", "fingerprint", "severity", "location"],
            "properties": {
                "description": {"type": "string"}, "check_name": {"type": "string"}, "fingerprint": {"type": "string"},
                "severity": {"enum": ["info", "minor", "major", "critical", "blocker"]},
                "location": {
                    "type": "object", "required": ["path", "lines"],
                    "properties": {
                        "path": {"type": "string"},
                        "lines": {
                            "type": "object", "required": ["begin"],
                            "properties": {
                                "begin": {"type": "integer", "minimum": 1}, "end": {"type": "integer", "minimum": 1},
                            },
                            "additionalProperties": false,
                        },
                    },
                    "additionalProperties": false,
                },
            },
            "additionalProperties": false,
        },
    });
    let schemas = BTreeMap::from([("gitlab".to_string(), schema)]);
    assert_eq!(problems(&schemas, "gitlab", &report), [""; 0]);
    let findings_of_labspec = findings(folder.path());
    let all = report.as_array().unwrap();
    assert_eq!(all.len(), findings_of_labspec.len());
    let marks: BTreeSet<String> = all.iter().map(|f| f["fingerprint"].to_string()).collect();
    assert_eq!(marks.len(), all.len(), "a fingerprint stands twice");
    for (issue, finding) in all.iter().zip(&findings_of_labspec) {
        let path = issue["location"]["path"].as_str().unwrap();
        // Relative to the repository, without a leading dot.
        assert!(!path.starts_with("./") && !path.starts_with('/'), "{path}");
        assert_eq!(path, finding["file"].as_str().unwrap().trim_start_matches("./"));
        assert_eq!((&issue["check_name"], &issue["description"]), (&finding["code"], &finding["message"]));
        let lines = &issue["location"]["lines"];
        let whole = json!({"line": 1, "endLine": 1});
        let finding = if finding["line"].is_null() { &whole } else { finding };
        assert_eq!((&lines["begin"], &lines["end"]), (&finding["line"], &finding["endLine"]));
    }
    // Fingerprints do not change when text moves.
    let lesson = folder.path().join("wrong.md");
    std::fs::write(&lesson, format!("# Before\n\nSome words.\n\n{}", wrong())).unwrap();
    let moved: Value = serde_json::from_str(&form(folder.path(), "gitlab")).unwrap();
    let again: BTreeSet<String> =
        moved.as_array().unwrap().iter().map(|f| f["fingerprint"].to_string()).collect();
    assert_eq!(marks, again);
}

/// The attributes of an element in the schema of Jenkins, and those that are required.
fn allowed_attributes(element: &str) -> (&'static [&'static str], &'static [&'static str]) {
    match element {
        "testsuites" => (&["name", "time", "tests", "failures", "disabled", "errors"], &[]),
        "testsuite" => (
            &[
                "name",
                "tests",
                "failures",
                "errors",
                "time",
                "disabled",
                "skipped",
                "timestamp",
                "hostname",
                "id",
                "package",
            ],
            &["name", "tests"],
        ),
        "testcase" => (&["name", "assertions", "time", "classname", "status"], &["name"]),
        "failure" | "error" | "skipped" => (&["type", "message"], &[]),
        other => panic!("there is no element {other}"),
    }
}

#[test]
fn junit_has_the_elements_that_jenkins_knows() {
    let folder = course();
    let text = form(folder.path(), "junit");
    let tree = Document::parse(&text).unwrap();
    let root = tree.root_element();
    assert!(root.has_tag_name("testsuites"));
    let elements = |node: Node<'_, '_>| node.children().filter(Node::is_element).count();
    for node in tree.descendants().filter(Node::is_element) {
        let name = node.tag_name().name();
        let (may, must) = allowed_attributes(name);
        for attribute in node.attributes() {
            assert!(may.contains(&attribute.name()), "{name} has no attribute {}", attribute.name());
        }
        must.iter().for_each(|a| assert!(node.has_attribute(*a), "{name} lacks {a}"));
        let inside = match name {
            "testsuites" => Some("testsuite"),
            "testsuite" => Some("testcase"),
            _ => None,
        };
        for child in node.children().filter(Node::is_element) {
            let child = child.tag_name().name();
            let of_case = name == "testcase" && matches!(child, "failure" | "error" | "skipped");
            assert!(inside == Some(child) || of_case, "{child} stands in {name}");
        }
        let words =
            node.children().filter(|c| c.is_text()).filter_map(|c| c.text()).any(|t| !t.trim().is_empty());
        assert!(!words || matches!(name, "failure" | "error" | "skipped"), "{name} has text");
        if name == "testcase" {
            assert!(elements(node) <= 1, "a case ends in one way");
        }
    }
    // The counts equal the numbers of elements below.
    for node in tree.descendants().filter(|n| n.has_tag_name("testsuites") || n.has_tag_name("testsuite")) {
        for (attribute, element) in
            [("tests", "testcase"), ("failures", "failure"), ("errors", "error"), ("skipped", "skipped")]
        {
            let Some(number) = node.attribute(attribute) else { continue };
            let there = node.descendants().filter(|n| n.has_tag_name(element)).count();
            assert_eq!(number, there.to_string(), "{attribute}");
        }
    }
    // There is a test case for every claim, and every error and warning is part of a failed case.
    let report: Value = serde_json::from_str(&form(folder.path(), "json")).unwrap();
    let cases = tree.descendants().filter(|n| n.has_tag_name("testcase")).count();
    assert_eq!(cases, report["ledger"].as_array().unwrap().len());
    let failed: String = tree
        .descendants()
        .filter(|n| n.has_tag_name("failure") || n.has_tag_name("error"))
        .filter_map(|n| n.text())
        .collect();
    for line in form(folder.path(), "concise").lines().filter(|l| !l.contains(": note[")) {
        // XML normalizes line ends.
        assert!(failed.contains(line), "{line}\n{failed}");
    }
}

#[test]
fn github_shows_every_finding_at_its_place() {
    let folder = course();
    let text = form(folder.path(), "github");
    let findings_of_labspec = findings(folder.path());
    let plain = |text: &str, more: bool| {
        let text = text.replace("%0A", "\n").replace("%0D", "\r");
        let text = if more { text.replace("%3A", ":").replace("%2C", ",") } else { text };
        text.replace("%25", "%")
    };
    // A line for each finding, and the summary.
    assert_eq!(text.lines().count(), findings_of_labspec.len() + 1);
    for (line, f) in text.lines().zip(&findings_of_labspec) {
        // `::name key=value,key=value::message`, as the runner parses it.
        let rest = line.strip_prefix("::").unwrap();
        let (head, words) = rest.split_once("::").unwrap();
        let (name, properties) = head.split_once(' ').unwrap();
        let expected_name = match f["severity"].as_str().unwrap() {
            "error" => "error",
            "warning" => "warning",
            _ => "notice",
        };
        assert_eq!(name, expected_name);
        let properties: BTreeMap<&str, String> = properties
            .split(',')
            .map(|pair| pair.split_once('=').map(|(key, value)| (key, plain(value, true))).unwrap())
            .collect();
        let properties_allowed = ["file", "line", "endLine", "col", "endColumn", "title"];
        assert!(properties.keys().all(|key| properties_allowed.contains(key)), "{line}");
        assert_eq!(properties["file"], f["file"].as_str().unwrap().trim_start_matches("./"));
        assert_eq!(properties["title"], format!("labspec {}", f["code"].as_str().unwrap()));
        if f["line"].is_null() {
            // The finding of a file that cannot be read is at its beginning.
            assert_eq!(properties["line"], "1");
            continue;
        }
        assert_eq!(properties["line"], f["line"].to_string());
        assert_eq!(properties["endLine"], f["endLine"].to_string());
        // Columns only if the finding is on one line.
        let columns = properties.get("col").cloned().zip(properties.get("endColumn").cloned());
        let one_line = f["line"] == f["endLine"];
        assert_eq!(columns, one_line.then(|| (f["column"].to_string(), f["endColumn"].to_string())));
        assert!(plain(words, false).starts_with(f["message"].as_str().unwrap()), "{line}");
    }
}

/// The formats of all our lessons and of all wrong lessons, so that nothing holds only for the examples.
#[test]
fn every_lesson_of_ours_has_its_forms() {
    let here = workspace();
    let lessons = ["check", "specs/lessons", "tests/lessons", "--no-run", "--format"];
    let of = |name: &str| run_in(&here, &[&lessons[..], &[name]].concat()).stdout;
    let sarif: Value = serde_json::from_str(&of("sarif")).unwrap();
    let schemas = BTreeMap::from([("sarif".to_string(), sarif_schema())]);
    assert_eq!(problems(&schemas, "sarif", &sarif), [""; 0]);
    let results = sarif["runs"][0]["results"].as_array().unwrap().len();
    assert!(results > 20, "{results}");
    // A line for each finding, and the summary.
    assert_eq!(of("github").lines().count(), results + 1);
    let junit = of("junit");
    let tree = Document::parse(&junit).unwrap();
    for node in tree.descendants().filter(Node::is_element) {
        let (may, _) = allowed_attributes(node.tag_name().name());
        assert!(node.attributes().all(|a| may.contains(&a.name())));
    }
}

/// The schema of settings accepts what the program accepts, and refuses what it refuses.
#[test]
fn the_schema_of_settings_accepts_valid_settings() {
    let schema = read_json(&workspace().join("docs/schema/labspec-toml.json"));
    let schemas = BTreeMap::from([("settings".to_string(), schema)]);
    let good = json!({"select": ["all"], "widgets": ["playground"], "paths": [{"match": ["drafts/**"], "deny": ["warnings"]}]});
    assert_eq!(problems(&schemas, "settings", &good), [""; 0]);
    for bad in [
        json!({"selct": []}),
        json!({"paths": [{"ignore": []}]}),
        json!({"widgets": "x"}),
        json!({"deny": [1]}),
    ] {
        assert!(!problems(&schemas, "settings", &bad).is_empty(), "{bad}");
    }
}
