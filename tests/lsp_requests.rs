//! Outline, folds, formatting, signatures, lenses and claims for numbers, as an editor receives them.

#![allow(clippy::unwrap_used)]

use crate::lsp_editor::{Editor, edited, lab, marked, place};
use crate::program::{CLEAN, folder, run_in};
use crate::support::{sorted_files, workspace};
use serde_json::{Value, json};
use std::path::Path;
use std::time::{Duration, Instant};

/// An editor that applies edits and asks for lenses again.
fn able_editor(folder: &Path, options: Value) -> Editor {
    let mut editor = Editor::start_editor(folder);
    let can = json!({"workspace": {"applyEdit": true, "codeLens": {"refreshSupport": true}}});
    let root = editor.root.clone();
    let hello = json!({"rootUri": root, "capabilities": can, "initializationOptions": options});
    editor.ask("initialize", hello).unwrap();
    editor.notify("initialized", json!({}));
    editor
}

/// The next request or notification of the server with a method.
fn next_message(editor: &mut Editor, method: &str) -> Value {
    loop {
        if let Some(at) = editor.heard.iter().position(|m| m["method"] == method) {
            return editor.heard.remove(at)["params"].clone();
        }
        let message = editor.receive().unwrap();
        editor.heard.push(message);
    }
}

fn about(editor: &Editor, file: &str) -> Value {
    json!({"textDocument": {"uri": editor.uri(file)}, "options": {"tabSize": 2, "insertSpaces": true}})
}

fn ask(editor: &mut Editor, what: &str, file: &str) -> Value {
    let about = about(editor, file);
    editor.ask(&format!("textDocument/{what}"), about).unwrap()
}

/// The names of symbols with their depth. A selection is inside of its range.
fn names(symbols: &Value, depth: usize, all: &mut Vec<String>) {
    let key = |at: &Value| (at["line"].as_u64().unwrap(), at["character"].as_u64().unwrap());
    for symbol in symbols.as_array().into_iter().flatten() {
        let (range, selection) = (&symbol["range"], &symbol["selectionRange"]);
        assert!(key(&range["start"]) <= key(&selection["start"]), "{symbol}");
        assert!(key(&selection["end"]) <= key(&range["end"]), "{symbol}");
        all.push(format!("{}{}", "  ".repeat(depth), symbol["name"].as_str().unwrap()));
        names(&symbol["children"], depth + 1, all);
    }
}

#[test]
fn the_outline_and_the_folds_of_a_lesson() {
    let folder = folder();
    let mut editor = Editor::open(folder.path());
    editor.did_open("clean.md", CLEAN);
    let mut all = Vec::new();
    names(&ask(&mut editor, "documentSymbol", "clean.md"), 0, &mut all);
    let expected = [
        "A drop",
        "  1. A drop",
        "    gravity",
        "    Kick",
        "    heavy",
        "    light, say",
        "    contacts",
        "    time (s)",
        "    height (m)",
        "  Knowledge check",
        "    1. Which ball lands first?",
        "      lab",
        "      drop",
        "      heavy",
        "      light",
    ];
    assert_eq!(all, expected);
    let folds = ask(&mut editor, "foldingRange", "clean.md");
    let lines: Vec<(u64, u64)> = folds
        .as_array()
        .unwrap()
        .iter()
        .map(|f| (f["startLine"].as_u64().unwrap(), f["endLine"].as_u64().unwrap()))
        .collect();
    // The section, the fence, the lab, its controls, its plots.
    assert_eq!(lines[..5], [(0, 38), (4, 19), (5, 17), (9, 11), (13, 15)], "{lines:?}");
    // A model has neither.
    editor.did_open("models/ball_drop.xml", "<mujoco/>");
    assert_eq!(ask(&mut editor, "documentSymbol", "models/ball_drop.xml"), json!([]));
    assert_eq!(ask(&mut editor, "formatting", "models/ball_drop.xml"), Value::Null);
    assert_eq!(editor.end(), 0);
}

/// The edits give the file that `labspec fmt` writes.
#[test]
fn formatting_is_that_of_the_program() {
    let folder = folder();
    let mut editor = Editor::open(folder.path());
    let specs = sorted_files(&workspace().join("specs/lessons"));
    let specs = specs.into_iter().filter(|p| p.extension().is_some_and(|e| e == "md"));
    let mut texts: Vec<String> = specs.map(|path| std::fs::read_to_string(path).unwrap()).collect();
    texts.push(CLEAN.to_string());
    let mut changed = 0;
    let loose: Vec<String> = texts.iter().map(|text| text.replace(" * ", "*").replace(", ", ",  ")).collect();
    for text in texts.into_iter().chain(loose).chain(["```lab\n{\"setup\": \"a=1\"\n```\n".to_string()]) {
        let path = folder.path().join("format.md");
        std::fs::write(&path, &text).unwrap();
        run_in(folder.path(), &["fmt", "format.md"]);
        let expected = std::fs::read_to_string(&path).unwrap();
        editor.did_open("format.md", &text);
        let edits = ask(&mut editor, "formatting", "format.md");
        assert_eq!(edited(&text, &edits), expected);
        assert_eq!(edits.as_array().unwrap().is_empty(), expected == text);
        changed += usize::from(expected != text);
    }
    assert!(changed > 3, "{changed}");
    // A range has only its own edits.
    let text = [lab("\"setup\": \"data.qpos[2]=1\""), lab("\"controller\": \"ctx.a=2\"")].join("\n");
    editor.did_open("format.md", &text);
    let at = text.find("ctx.a").unwrap();
    let mut params = about(&editor, "format.md");
    params["range"] = json!({"start": place(&text, at), "end": place(&text, at + 1)});
    let edits = editor.ask("textDocument/rangeFormatting", params).unwrap();
    assert_eq!(edited(&text, &edits), text.replace("ctx.a=2", "ctx.a = 2"));
    assert_eq!(editor.end(), 0);
}

#[test]
fn signatures_are_those_of_the_call_around_the_cursor() {
    let folder = folder();
    let mut editor = Editor::open(folder.path());
    for (inside, label, parameter) in [
        ("\"setup\": \"ctx.a = Math.atan2(1, |)\"", "Math.atan2(y, x)", Some("x")),
        (
            "\"setup\": \"ctx.a = \\\"𝄞\\\"; ctx.b = lib.bodyPos(\\\"he|\")\"",
            "lib.bodyPos(\"name of a body\")",
            Some("\"name of a body\""),
        ),
        (
            "\"setup\": \"mj.mj_resetDataKeyframe(model, data, |\"",
            "mj.mj_resetDataKeyframe(model, data, x)",
            Some("x"),
        ),
        (
            "\"verify\": {\"measure\": {\"a\": \"first(contact('heavy_geom', |))\"}}",
            "contact(\"name of a geom\", \"name of a geom\")",
            Some("\"name of a geom\""),
        ),
        ("\"verify\": {\"measure\": {\"a\": \"max(|)\"}}", "max(x)", Some("x")),
        ("\"setup\": \"Math.sqrt(1, |)\"", "Math.sqrt(x)", None),
    ] {
        let (text, byte) = marked(&lab(inside));
        editor.did_open("s.md", &text);
        let found = editor.at("signatureHelp", "s.md", &text, byte);
        let signature = &found["signatures"][0];
        assert_eq!(signature["label"], label, "{inside}: {found}");
        let named = found["activeParameter"].as_u64().map(|i| {
            let ends = &signature["parameters"][i as usize]["label"];
            let units: Vec<u16> = label.encode_utf16().collect();
            let [start, end] = [0, 1].map(|i: usize| ends[i].as_u64().unwrap() as usize);
            String::from_utf16(&units[start..end]).unwrap()
        });
        assert_eq!(named.as_deref(), parameter, "{inside}");
    }
    for inside in ["\"setup\": \"ctx.a = 1|\"", "\"title\": \"f(|\""] {
        let (text, byte) = marked(&lab(inside));
        editor.did_open("s.md", &text);
        assert_eq!(editor.at("signatureHelp", "s.md", &text, byte), Value::Null, "{inside}");
    }
    assert_eq!(editor.end(), 0);
}

/// The titles of the lenses, each with its line.
fn lenses(editor: &mut Editor, file: &str) -> Vec<(u64, String)> {
    let all = ask(editor, "codeLens", file);
    let one = |lens: &Value| {
        (
            lens["range"]["start"]["line"].as_u64().unwrap() + 1,
            lens["command"]["title"].as_str().unwrap().to_string(),
        )
    };
    all.as_array().unwrap().iter().map(one).collect()
}

fn titles(editor: &mut Editor, file: &str) -> Vec<String> {
    lenses(editor, file).into_iter().map(|(_, title)| title).collect()
}

/// Values appear after a check, stay with the text of their block, and go with it.
#[test]
fn lenses_have_the_values_of_the_last_check() {
    let folder = folder();
    let mut editor = able_editor(folder.path(), json!({}));
    editor.did_open("clean.md", CLEAN);
    assert_eq!(titles(&mut editor, "clean.md"), ["run", "run", "run"]);
    let uri = editor.uri("clean.md");
    let run = json!({"command": "labspec.check", "arguments": [uri]});
    editor.ask("workspace/executeCommand", run).unwrap();
    // Other lessons of the folder have the same quiz.
    let found = editor.found("clean.md", 1);
    assert!(found.as_array().unwrap().iter().all(|f| f["code"] == "duplicate-id"), "{found}");
    next_message(&mut editor, "workspace/codeLens/refresh");
    let all = titles(&mut editor, "clean.md");
    assert!(all[0].ends_with(" runs") && all[1].ends_with(" runs"), "{all:?}");
    assert_eq!(all[2], "drop: heavy 0.440 s, light 0.440 s");
    // A change of the prose, and one in the lab, whose values are no longer true.
    editor.change("clean.md", 2, CLEAN, 2..3, "B");
    editor.found("clean.md", 2);
    assert_eq!(titles(&mut editor, "clean.md"), all);
    let changed = CLEAN.replacen("# A", "# B", 1);
    let at = changed.find("= 1\"").unwrap() + 2;
    editor.change("clean.md", 3, &changed, at..at + 1, "2");
    editor.found("clean.md", 3);
    assert_eq!(titles(&mut editor, "clean.md"), ["run".to_string(), all[1].clone(), all[2].clone()]);
    // A model that changed.
    let model = editor.uri("models/ball_drop.xml");
    editor.notify("workspace/didChangeWatchedFiles", json!({"changes": [{"uri": model, "type": 2}]}));
    editor.found("clean.md", 3);
    assert_eq!(titles(&mut editor, "clean.md"), ["run", "run", "run"]);
    assert_eq!(editor.end(), 0);
}

/// While a long check runs, requests are answered at once.
#[test]
fn lenses_wait_for_no_run() {
    let folder = folder();
    let mut editor = able_editor(folder.path(), json!({}));
    let slow = lab(
        "\"stopAt\": 20000, \"setup\": \"data.qpos[2] = 1\", \"readouts\": [{\"label\": \"a\", \"expr\": \"data.qpos[2]\"}]",
    );
    let slow = format!("It falls for 0.442 s.\n\n{slow}");
    editor.did_open("slow.md", &slow);
    let uri = editor.uri("slow.md");
    for (command, arguments) in [("labspec.check", json!([uri])), ("labspec.prove", json!([uri, 0]))] {
        let start = Instant::now();
        editor.ask("workspace/executeCommand", json!({"command": command, "arguments": arguments})).unwrap();
        assert_eq!(titles(&mut editor, "slow.md"), ["prove this number", "run"]);
        assert!(start.elapsed() < Duration::from_secs(2), "{command}: {:?}", start.elapsed());
    }
    assert_eq!(editor.end(), 0);
}

const FALLING: &str = r##"# A fall

The ball is let go, and touches
the floor after 0.440 s.

Nothing gives 77.7 kN.

```lab simlab
{"model": "ball_drop", "title": "A drop", "stopAt": 1,
 "readouts": [{"label": "height (m)", "expr": "data.qpos[2]"}, {"label": "speed (m/s)", "expr": "data.qvel[2]"}]}
```
"##;

/// A number without a claim gets one from a run of the lab, which a check then proves.
#[test]
fn a_number_is_proved_by_a_command() {
    let folder = folder();
    let mut editor = able_editor(folder.path(), json!({}));
    editor.did_open("f.md", FALLING);
    let prove = |line: u64| (line, "prove this number".to_string());
    assert_eq!(lenses(&mut editor, "f.md"), [prove(4), prove(6), (9, "run".into())]);
    // The same as a code action at the number.
    let at = place(FALLING, FALLING.find("0.440").unwrap());
    let actions = json!({"textDocument": {"uri": editor.uri("f.md")}, "range": {"start": at, "end": at}, "context": {"diagnostics": []}});
    let actions = editor.ask("textDocument/codeAction", actions).unwrap();
    let action = actions.as_array().unwrap().iter().find(|a| a["title"] == "prove this number").unwrap();
    let command = action["command"].clone();
    editor.ask("workspace/executeCommand", command).unwrap();
    let asked = next_message(&mut editor, "workspace/applyEdit");
    let edit = &asked["edit"]["documentChanges"][0];
    assert_eq!(edit["textDocument"]["version"], 1);
    let new = edited(FALLING, &edit["edits"]);
    assert!(new.contains("# A fall\n\n<!-- labspec verify {\n  \"lab\": \"#1\","), "{new}");
    assert!(new.contains("} -->\nThe ball is let go"), "{new}");
    std::fs::write(folder.path().join("f.md"), &new).unwrap();
    let done = run_in(folder.path(), &["check", "f.md"]);
    assert!(done.stdout.contains("1 quoted number verified"), "{}{}", done.stdout, new);
    // What no run gives.
    let uri = editor.uri("f.md");
    let command = json!({"command": "labspec.prove", "arguments": [uri, 5]});
    editor.ask("workspace/executeCommand", command).unwrap();
    let message = next_message(&mut editor, "window/showMessage");
    assert!(message["message"].as_str().unwrap().contains("no run of a lab gives 77.7 kN"), "{message}");
    let command = json!({"command": "labspec.prove", "arguments": [uri, 0]});
    assert!(editor.ask("workspace/executeCommand", command).is_err());
    assert_eq!(editor.end(), 0);
}

#[test]
fn lenses_can_be_turned_off() {
    let folder = folder();
    for (options, expected) in [
        (json!({"codeLens": {"proofs": false}}), &["run"][..]),
        (json!({"codeLens": {"values": false}}), &["prove this number", "prove this number"]),
        (json!({"codeLens": {"values": false, "proofs": false}}), &[]),
    ] {
        let mut editor = able_editor(folder.path(), options);
        editor.did_open("f.md", FALLING);
        assert_eq!(titles(&mut editor, "f.md"), expected);
        assert_eq!(editor.end(), 0);
    }
    // An editor that applies no edits is offered none.
    let mut editor = Editor::open(folder.path());
    editor.did_open("f.md", FALLING);
    assert_eq!(titles(&mut editor, "f.md"), ["run"]);
    assert_eq!(editor.end(), 0);
}

/// In a claim, the measures and runs come before everything else.
#[test]
fn measures_come_first() {
    let folder = folder();
    let mut editor = Editor::open(folder.path());
    let claim = |runs: &str, rest: &str| {
        format!(
            "\"readouts\": [{{\"label\": \"a\", \"expr\": \"data.qpos[2]\"}}], \"verify\": {{\"runs\": {{{runs}}}, \"measure\": {{\"touch\": \"max(data.time)\", \"depth\": \"min(data.qpos[2])\"}}, {rest}}}"
        )
    };
    let (one, two) = ("\"go\": {\"until\": 1}", "\"fine\": {\"until\": 1}, \"coarse\": {\"until\": 1}");
    for (inside, expected) in [
        (claim(one, "\"says\": [[\"1 s\", \"|\"]]"), &["touch", "depth", "warnings", "go"][..]),
        (claim(one, "\"says\": [[\"1 s\", \"1 + |touch\"]]"), &["touch", "depth"]),
        (claim(one, "\"options\": [\"to|\"]"), &["touch", "depth"]),
        (claim(one, "\"table\": [{\"column\": \"t\", \"row\": \"a\", \"is\": \"|\"}]"), &["touch", "depth"]),
        (
            claim(two, "\"says\": [[\"1 s\", \"|\"]]"),
            &["fine.touch", "fine.depth", "coarse.touch", "coarse.depth", "fine", "coarse"],
        ),
        (claim(two, "\"says\": [[\"1 s\", \"fine.|\"]]"), &["touch", "depth", "warnings"]),
    ] {
        let (text, byte) = marked(&lab(&inside));
        editor.did_open("c.md", &text);
        let all = editor.at("completion", "c.md", &text, byte);
        let labels: Vec<&str> =
            all.as_array().unwrap().iter().map(|i| i["label"].as_str().unwrap()).collect();
        assert!(labels.starts_with(expected), "{inside}: {labels:?}");
    }
    // A closed form reads the time, and no measure.
    let (text, byte) = marked(&lab(&claim(one, "\"exact\": {\"a\": \"|\"}")));
    editor.did_open("c.md", &text);
    let all = editor.at("completion", "c.md", &text, byte);
    let labels: Vec<&str> = all.as_array().unwrap().iter().map(|i| i["label"].as_str().unwrap()).collect();
    assert!(labels.contains(&"data") && !labels.contains(&"touch"), "{labels:?}");
    assert_eq!(editor.end(), 0);
}
