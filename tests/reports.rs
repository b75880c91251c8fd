//! Reports are contracts: all output for programs, in any test, must be valid according to `docs/reports.md` and the
//! schemas of `docs/schema`.

use crate::program::{folder, json_of, run_in};
use crate::support::report::check_report_value;
use crate::support::schema::schemas;
use crate::support::workspace;
use serde_json::{Value, json};
use std::collections::BTreeSet;
use std::path::Path;

/// All keys of a schema have one style and a description, and each schema is for one report.
#[test]
fn schemas_describe_every_key() {
    fn check_properties(file: &str, schema: &Value, keys: &mut BTreeSet<String>) {
        for (key, value) in schema["properties"].as_object().into_iter().flatten() {
            let plain = key.starts_with(|c: char| c.is_ascii_lowercase())
                && key.chars().all(|c| c.is_ascii_alphanumeric());
            assert!(plain, "{file}: `{key}` is not in camelCase");
            let documentation = value.get("description").or(value.get("$ref")).or(value.get("const"));
            assert!(documentation.is_some(), "{file}: nothing is said of `{key}`");
            keys.insert(key.clone());
        }
        for value in schema.as_object().into_iter().flat_map(|o| o.values()) {
            check_properties(file, value, keys);
        }
        schema.as_array().into_iter().flatten().for_each(|value| check_properties(file, value, keys));
    }
    let all = schemas();
    let names = [
        "bench",
        "check",
        "plan",
        "precision",
        "record",
        "run",
        "scaffold",
        "snapshot",
        "stability",
        "trace",
        "verify",
    ];
    assert_eq!(all.keys().cloned().collect::<Vec<_>>(), names.map(|n| format!("report-{n}.json")));
    let mut keys = BTreeSet::new();
    all.iter().for_each(|(file, schema)| check_properties(file, schema, &mut keys));
    assert!(keys.len() > 80, "{}", keys.len());
}

/// The schemas are those that the command derives from the types of the reports.
#[test]
fn the_schemas_are_up_to_date() {
    let folder = tempfile::tempdir().unwrap();
    let done = run_in(folder.path(), &["reference", "reference"]);
    assert_eq!(done.code, 0, "{}", done.stderr);
    let written: Vec<String> = (std::fs::read_dir(folder.path().join("schema")).unwrap())
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    let of_reports = written.iter().filter(|name| name.starts_with("report-")).count();
    assert_eq!(of_reports, schemas().len());
    for name in written {
        let read = |at: &Path| std::fs::read_to_string(at.join("schema").join(&name)).unwrap_or_default();
        let is_same = read(folder.path()) == read(&workspace().join("docs"));
        assert!(is_same, "docs/schema/{name} is stale: cargo run -p labspec-cli -- reference docs/reference");
    }
}

/// The schemas can be violated: each of these reports is refused.
#[test]
fn a_report_that_breaks_its_promise_is_refused() {
    let good = json_of(&["check", "clean.md", "--format", "json"]);
    let table = json_of(&["run", "clean.md#1", "--steps", "1", "--format", "json"]);
    let with = |report: &Value, at: &str, value: Value| {
        let mut report = report.clone();
        *report.pointer_mut(at).unwrap() = value;
        report
    };
    let mut lost = table.clone();
    lost["nonfinite"] = json!({"rows": [[0, 0, "NaN"]]});
    let mut late = json!({"report": "plan", "schemaVersion": 1});
    late["reads"] = json!([]);
    check_report_value(&good);
    check_report_value(&table);
    for bad in [
        with(&good, "/schemaVersion", json!(2)),
        with(&good, "/report", json!("plan")),
        with(&good, "/ledger/0/start", json!(-1)),
        with(&good, "/ledger/0/range/start/character", json!(null)),
        with(&good, "/summary/claims/lab/notClaimed", json!("0")),
        with(&table, "/rows/0/1", json!("1")),
        with(&table, "/rows/1", json!([0.0])),
        with(&table, "/types/0", json!("text")),
        lost,
        late,
    ] {
        let refused = std::panic::catch_unwind(|| check_report_value(&bad)).is_err();
        assert!(refused, "{bad:.500}");
    }
}

/// A lab with values that are NaN, next to strings and booleans, and with a program that fails.
fn odd_lab() -> String {
    json!({
        "model": "free_fall",
        "readouts": [
            {"label": "none", "expr": "0 / (data.time - data.time)"},
            {"label": "far", "expr": "(data.time > 0.001 ? -1 : 1) / 0"},
            {"label": "mixed", "expr": "data.time > 0.001 ? 'down' : data.time"},
            {"label": "yes", "expr": "data.time > 0.001"},
            {"label": "throws", "expr": "data.body('b' + data.time).xpos[0]"},
        ],
    })
    .to_string()
}

/// A lab that fails, with a prediction about it.
fn broken_lab() -> String {
    json!({"model": "free_fall", "stopAt": 0.1, "setup": "data.qvel[2] = 1e11",
        "plots": [{"traces": [{"label": "height", "expr": "data.qpos[2]"}]}],
        "verify": {"runs": {"r": {"until": 0.05}}, "measure": {"m": "0 / final(data.qpos[2] - data.qpos[2])"},
            "exact": {"height": "1"}}})
    .to_string()
}

/// Every report once with findings, once without, and once for a lab that fails. Each is validated by [`hold`] in `run_in`.
#[test]
fn every_report_keeps_its_promise() {
    let folder = folder();
    let here = folder.path();
    std::fs::write(here.join("odd.json"), odd_lab()).unwrap();
    std::fs::write(here.join("breaks.json"), broken_lab()).unwrap();
    std::fs::write(here.join("empty.md"), "# Words\n").unwrap();
    std::fs::write(
        here.join("bad.md"),
        b"\xef\xbb\xbf# \xe9\r\n```lab simlab\r\n{\"modle\": \"free_fall\"}\r\n```\r\n",
    )
    .unwrap();
    let states = json!({
        "sizes": {"nq": 0}, "model": {"body_mass": []},
        "forward": [{"qpos": [0.0, 0.0, null, 1.0, 0.0, 0.0, 0.0], "qvel": vec![0.0; 6], "xpos": [], "contact": [], "M": []}],
    });
    std::fs::write(here.join("states.json"), states.to_string()).unwrap();
    let bench = ["--steps", "20", "--warm", "1", "--repeat", "2"];
    let mut seen = BTreeSet::new();
    for (arguments, code) in [
        (&["check", "clean.md", "fall.json", "models/ball_drop.xml", "--format", "json"][..], 0),
        (&["check", "wrong.md", "bad.md", "broken", "nowhere.md", "--format", "json"], 1),
        (&["check", "breaks.json", "odd.json", "--format", "json"], 1),
        (&["check", "broken/models/ball_drop.xml", "--format", "json"], 1),
        (&["verify", "clean.md", "--format", "json"], 0),
        (&["verify", "wrong.md", "--format", "json"], 1),
        (&["verify", "breaks.json", "--format", "json"], 1),
        (&["verify", "models/free_fall.xml", "--format", "json"], 2),
        (&["check", "empty.md", "--format", "json"], 2),
        (&["run", "clean.md#1", "--steps", "3", "--format", "json"], 0),
        (&["run", "odd.json", "--steps", "3", "--format", "json"], 1),
        (&["run", "breaks.json", "--format", "json"], 1),
        (&["run", "fall.json", "--steps", "3", "--json", "table.json"], 0),
        (&["plan", "clean.md#1", "--format", "json"], 0),
        (&["plan", "clean.md#1", "--no-run", "--format", "json"], 0),
        (&["plan", "breaks.json", "--read", "data.energy", "--read", "data.xpos[5]", "--format", "json"], 0),
        (&["precision", "fall.json", "--until", "0.1", "--format", "json"], 0),
        (&["precision", "clean.md#1", "--until", "0.05", "--format", "json"], 0),
        (&["precision", "breaks.json", "--until", "0.05", "--format", "json"], 1),
        (&["stability", "clean.md#1", "--until", "2", "--format", "json"], 0),
        (&["stability", "odd.json", "--until", "0.1", "--format", "json"], 0),
        (&["stability", "breaks.json", "--format", "json"], 1),
        (&["scaffold", "odd.json", "--format", "json"], 1),
        (&["trace", "clean.md", "--format", "json"], 0),
        (&["trace", "odd.json", "--format", "json"], 3),
        (&["trace", "breaks.json", "--format", "json"], 3),
        (&["snapshot", "clean.md", "--review", "--format", "json"], 1),
        (&["snapshot", "odd.json", "--review", "--format", "json"], 1),
        (&["snapshot", "breaks.json", "--review", "--format", "json"], 1),
        (&[&["bench", "models/free_fall.xml"], &bench[..]].concat(), 0),
        (&[&["bench", "breaks.json"], &bench[..]].concat(), 0),
        (&["record", "models/free_fall.xml", "--states", "states.json", "--steps", "20"], 0),
    ] {
        let done = run_in(here, arguments);
        assert_eq!(done.code, code, "{arguments:?}\n{}{}", done.stdout, done.stderr);
        seen.insert(arguments[0]);
        if matches!(arguments[0], "check" | "verify") {
            let report: Value = serde_json::from_str(&done.stdout).unwrap();
            let outcome = ["clean", "findings", "nothing"][code as usize];
            assert_eq!(report["summary"]["outcome"], outcome, "{arguments:?}");
        }
        // The output does not depend on the machine: relative paths remain relative.
        let place = here.to_string_lossy().into_owned();
        let real = here.canonicalize().unwrap().to_string_lossy().into_owned();
        assert!(
            !done.stdout.contains(&place) && !done.stdout.contains(&real),
            "{arguments:?}\n{}",
            done.stdout
        );
        // The output does not depend on the time, unless times are measured.
        let measures =
            matches!(arguments[0], "bench" | "precision" | "plan") && !arguments.contains(&"--no-run");
        if !measures {
            assert_eq!(run_in(here, arguments).stdout, done.stdout, "{arguments:?}");
        }
    }
    assert_eq!(seen.len(), schemas().len());
}

#[test]
fn nonfinite_numbers_are_named() {
    let folder = folder();
    std::fs::write(folder.path().join("odd.json"), odd_lab()).unwrap();
    let run =
        |format: &str| run_in(folder.path(), &["run", "odd.json", "--steps", "1", "--format", format]).stdout;
    let table: Value = serde_json::from_str(&run("json")).unwrap();
    assert_eq!(table["types"], json!(["number", "number", "number", "text", "boolean", "number"]));
    let rows = json!([[0.0, null, null, "0", false, null], [0.002, null, null, "down", true, null]]);
    assert_eq!(table["rows"], rows);
    let lost = json!({"rows": [[0, 1, "NaN"], [0, 2, "Infinity"], [1, 1, "NaN"], [1, 2, "-Infinity"]]});
    assert_eq!(table["nonfinite"], lost);
    let lines: Vec<String> = run("csv").lines().skip(1).map(Into::into).collect();
    assert_eq!(lines, ["0,NaN,Infinity,0,false,", "0.002,NaN,-Infinity,down,true,"]);
}

/// Bytes, lines and editor ranges identify the same text of a lesson, for any encoding of characters and line ends.
#[test]
fn places_lead_to_their_text() {
    let folder = folder();
    let lesson = "\u{feff}# 𝄞 ä\r\n\r\n```lab simlab\r\n{\"model\": \"free_fall\", \"title\": \"𝄞👩‍🔬ä\",\t\"modle\": 1}\r\n```\r\n";
    std::fs::write(folder.path().join("odd.md"), lesson).unwrap();
    let done = run_in(folder.path(), &["check", "odd.md", "--format", "json"]);
    let report: Value = serde_json::from_str(&done.stdout).unwrap();
    let finding = report["findings"].as_array().unwrap().iter().find(|f| f["code"] == "unknown-key").unwrap();
    let number = |at: &str| finding.pointer(at).and_then(Value::as_u64).unwrap() as usize;
    let text = &lesson[number("/start")..number("/end")];
    assert!(text.contains("modle"), "{text}");
    // The editor's text has no byte-order mark, and counts UTF-16 code units.
    let lines: Vec<Vec<u16>> = lesson[3..].split("\r\n").map(|l| l.encode_utf16().collect()).collect();
    let line = &lines[number("/range/start/line")];
    let part = &line[number("/range/start/character")..number("/range/end/character")];
    assert_eq!(String::from_utf16(part).unwrap(), text);
    let characters: Vec<char> = lesson.lines().nth(number("/line") - 1).unwrap().chars().collect();
    let part: String = characters[number("/column") - 1..number("/endColumn") - 1].iter().collect();
    assert_eq!(part, text);
}

/// The guide for programs that read reports: its files, its commands, and their output.
#[test]
fn the_examples_of_the_guide_are_real() {
    let guide = std::fs::read_to_string(workspace().join("docs/reports.md")).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let (mut lines, mut before, mut command) = (guide.lines(), "", "");
    let mut documented = BTreeSet::new();
    while let Some(line) = lines.next() {
        let ticks = line.len() - line.trim_start_matches('`').len();
        if ticks < 3 {
            before = if line.is_empty() { before } else { line };
            continue;
        }
        let inside: Vec<&str> = lines.by_ref().take_while(|l| *l != &line[..ticks]).collect();
        match &line[ticks..] {
            "text" => {
                let name = before.rsplit('`').nth(1).unwrap();
                let path = folder.path().join(name);
                std::fs::create_dir_all(path.parent().unwrap()).unwrap();
                std::fs::write(path, inside.join("\n") + "\n").unwrap();
            }
            "sh" => command = inside[0],
            "json" => {
                let (words, code) = command.split_once("   # exit code ").unwrap();
                let arguments: Vec<&str> = words.split_whitespace().skip(1).collect();
                let done = run_in(folder.path(), &arguments);
                assert_eq!(done.code.to_string(), code, "{command}\n{}", done.stderr);
                let comparable = |text: &str| {
                    let mut report: Value = serde_json::from_str(text).unwrap();
                    unmeasured(&mut report);
                    serde_json::to_string_pretty(&report).unwrap()
                };
                // Compared as text, because the order of keys is part of the format.
                similar(command, &comparable(&inside.join("\n")), &comparable(&done.stdout));
                documented.insert(arguments[0].to_string());
            }
            other => panic!("a block of {other}"),
        }
    }
    let all: BTreeSet<String> = schemas().keys().map(|f| f[7..f.len() - 5].to_string()).collect();
    assert_eq!(documented, all);
}

/// Removes run times and the version, which depend on the machine and the date.
fn unmeasured(value: &mut Value) {
    for (key, value) in value.as_object_mut().into_iter().flatten() {
        match key.as_str() {
            "minNs" | "medianNs" | "microsecondsPerSecond" | "timeRatio" => *value = json!(0),
            "ns" | "lowNs" | "highNs" | "fullNs" | "forcedNs" | "share" if value.is_number() => {
                *value = json!(0)
            }
            "version" => *value = json!(""),
            // Values that depend on run times.
            "repeats" | "front" => *value = json!([]),
            _ => unmeasured(value),
        }
    }
    value.as_array_mut().into_iter().flatten().for_each(unmeasured);
}

/// Compares two texts, and reports the first line that differs.
fn similar(what: &str, documented: &str, real: &str) {
    let mut lines = documented.lines().zip(real.lines());
    let differ = lines.find(|(documented, real)| documented != real);
    assert!(documented == real, "{what}: the guide shows {differ:?}, in\n{real}");
}

/// Numbers with arbitrary bits, written as literals into a lab, are preserved by the program.
#[test]
fn every_bit_survives_the_program() {
    let folder = folder();
    let mut bits = 0x1234_5678_9abc_def1_u64;
    let mut next = || {
        // xorshift64
        bits ^= bits << 13;
        bits ^= bits >> 7;
        bits ^= bits << 17;
        f64::from_bits(bits)
    };
    let numbers: Vec<f64> =
        std::iter::repeat_with(&mut next).filter(|x| x.is_finite()).take(10_000).collect();
    for some in numbers.chunks(1000) {
        let readout = |(i, x): (usize, &f64)| json!({"label": format!("r{i}"), "expr": format!("{x:?}")});
        let readouts: Vec<Value> = some.iter().enumerate().map(readout).collect();
        let lab = json!({"model": "free_fall", "readouts": readouts});
        std::fs::write(folder.path().join("many.json"), lab.to_string()).unwrap();
        let done = run_in(folder.path(), &["run", "many.json", "--steps", "0", "--format", "json"]);
        let table: Value = serde_json::from_str(&done.stdout).unwrap();
        let row = table["rows"][0].as_array().unwrap();
        let read: Vec<u64> = row.iter().skip(1).map(|x| x.as_f64().unwrap().to_bits()).collect();
        assert!(read == some.iter().map(|x| x.to_bits()).collect::<Vec<_>>());
    }
}
