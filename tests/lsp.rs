//! `labspec lsp` as editors use it: the real program, over its standard input and output.

#![allow(clippy::unwrap_used)]

use crate::lsp_editor::{Editor, codes, edited, lab, place};
use crate::program::{CLEAN, folder};
use serde_json::{Value, json};
use std::time::{Duration, Instant};

/// A complete session, as it was recorded.
#[test]
fn a_session_as_it_was_recorded() {
    let folder = folder();
    let mut editor = Editor::start_editor(folder.path());
    let root = editor.root.clone();
    let mut transcript = String::new();
    let mut note = |what: &str, answer: &Value| {
        let text = serde_json::to_string_pretty(answer).unwrap().replace(&root, "file:///course");
        transcript.push_str(&format!("## {what}\n{text}\n\n"));
    };
    let hello = json!({"rootUri": editor.root, "initializationOptions": {"inlayHints": {"units": true}}});
    note("initialize", &editor.ask("initialize", hello).unwrap()["capabilities"].clone());
    editor.notify("initialized", json!({}));
    let text = lab(
        "\"setup\": \"data.qpos[2] = 1\", \"readouts\": [{\"label\": \"speed\", \"exprr\": \"data.qvel[2]\"}, {\"label\": \"height\", \"expr\": \"data.body('heavy').xpso[2]\"}]",
    );
    note("findings of a lesson that was opened", &editor.did_open("a.md", &text));
    let byte = text.find("qpos[2]").unwrap() + 5;
    note("hover over `qpos[2]`", &editor.at("hover", "a.md", &text, byte));
    let byte = text.find("\"exprr\"").unwrap() + 3;
    note("hover over a key that there is not", &editor.at("hover", "a.md", &text, byte));
    let byte = text.find("heavy'").unwrap() + 2;
    note("completion of `heavy`", &editor.at("completion", "a.md", &text, byte));
    note("definition of `heavy`", &editor.at("definition", "a.md", &text, byte));
    note(
        "rename of `heavy`",
        &editor.try_at("rename", "a.md", &text, byte, json!({"newName": "iron"})).unwrap(),
    );
    let whole = json!({"start": place(&text, 0), "end": place(&text, text.len())});
    let about =
        json!({"textDocument": {"uri": editor.uri("a.md")}, "range": whole, "context": {"diagnostics": []}});
    note("code actions", &editor.ask("textDocument/codeAction", about.clone()).unwrap());
    note("inlay hints", &editor.ask("textDocument/inlayHint", about).unwrap());
    let at = text.find("exprr").unwrap();
    editor.change("a.md", 2, &text, at..at + 5, "expr");
    note("findings after a change", &editor.found("a.md", 2));
    note("shutdown", &editor.ask("shutdown", Value::Null).unwrap());
    editor.notify("exit", Value::Null);
    assert_eq!(editor.child.wait().unwrap().code(), Some(0));
    insta::with_settings!({prepend_module_to_snapshot => false, omit_expression => true}, {
        insta::assert_snapshot!("lsp-session", transcript);
    });
}

/// A lesson that is typed letter by letter ends with the same findings as the whole text.
#[test]
fn typing_a_lesson_ends_where_opening_it_does() {
    let folder = folder();
    let mut editor = Editor::open(folder.path());
    let whole = crate::program::wrong();
    let mut text = String::from("# Title\n");
    editor.did_open("typed.md", &text);
    let mut version = 1;
    let part = &whole[..whole.find("```quiz").unwrap()];
    for piece in part.as_bytes().chunks(17).map(|c| String::from_utf8(c.to_vec()).unwrap()) {
        version += 1;
        editor.change("typed.md", version, &text, text.len()..text.len(), &piece);
        text.push_str(&piece);
    }
    let typed = editor.found("typed.md", version);
    let opened = editor.did_open("opened.md", &text);
    assert_eq!(codes(&typed), codes(&opened));
    assert!(codes(&opened).contains(&"unknown-field"), "{opened}");
    assert_eq!(editor.end(), 0);
}

/// Findings that require runs are reported when the lesson is saved, unless it changes before the runs end.
#[test]
fn runs_continue_in_the_background_until_the_text_changes() {
    let folder = folder();
    let mut editor = Editor::open(folder.path());
    let text = crate::program::wrong();
    let typed = editor.did_open("wrong.md", &text);
    assert!(!codes(&typed).contains(&"quote-wrong"), "{typed}");
    editor.notify("textDocument/didSave", json!({"textDocument": {"uri": editor.uri("wrong.md")}}));
    let ran = editor.found("wrong.md", 1);
    assert!(
        codes(&ran).contains(&"control-without-effect")
            || ran.as_array().unwrap().len() > typed.as_array().unwrap().len(),
        "{ran}"
    );
    // A change cancels long runs: the next findings are those of the new text, without delay.
    let slow = lab(
        "\"stopAt\": 20000, \"setup\": \"data.qpos[2] = 1\", \"readouts\": [{\"label\": \"a\", \"expr\": \"data.qpos[2]\"}]",
    );
    editor.did_open("slow.md", &slow);
    editor.notify("textDocument/didSave", json!({"textDocument": {"uri": editor.uri("slow.md")}}));
    let at = slow.find("qpos[2]\"}").unwrap();
    editor.change("slow.md", 2, &slow, at..at + 4, "qpso");
    assert!(codes(&editor.found("slow.md", 2)).contains(&"unknown-field"));
    assert_eq!(editor.end(), 0);
}

/// The client is not trusted: messages may have any content and any order.
#[test]
fn no_message_stops_the_server() {
    let folder = folder();
    let mut editor = Editor::start_editor(folder.path());
    let code = |answer: Result<Value, Value>| answer.unwrap_err()["code"].as_i64().unwrap();
    assert_eq!(code(editor.ask("textDocument/hover", json!({}))), -32002);
    editor.notify(
        "textDocument/didOpen",
        json!({"textDocument": {"uri": "file:///x.md", "text": "", "version": 1}}),
    );
    let root = editor.root.clone();
    editor.ask("initialize", json!({"rootUri": root})).unwrap();
    assert_eq!(code(editor.ask("initialize", json!({}))), -32600);
    assert_eq!(code(editor.ask("textDocument/somethingElse", json!({}))), -32601);
    for bad in ["{", "[]", "3", "{\"jsonrpc\":\"2.0\"}", "\u{1}"] {
        editor.raw(format!("Content-Length: {}\r\n\r\n{bad}", bad.len()).as_bytes());
        let answer = editor.receive().unwrap();
        assert_eq!((&answer["id"], &answer["error"]["code"]), (&Value::Null, &json!(-32700)), "{bad}");
    }
    editor.raw(b"Nonsense\r\n");
    assert_eq!(editor.receive().unwrap()["error"]["code"], -32700);
    // Parameters of all shapes for all requests.
    editor.did_open("b.md", &lab("\"setup\": \"data.qpos[\", \"trail\": \"“"));
    let uri = editor.uri("b.md");
    for method in [
        "completion",
        "hover",
        "definition",
        "references",
        "prepareRename",
        "rename",
        "codeAction",
        "inlayHint",
        "signatureHelp",
        "documentSymbol",
        "foldingRange",
        "formatting",
        "rangeFormatting",
        "codeLens",
    ] {
        for params in [
            json!(null),
            json!([]),
            json!({"textDocument": 3}),
            json!({"textDocument": {"uri": "untitled:1"}, "position": {"line": 0, "character": 0}}),
            json!({"textDocument": {"uri": uri}}),
            json!({"textDocument": {"uri": uri}, "position": {"line": -1, "character": 1e300}}),
            json!({"textDocument": {"uri": uri}, "position": {"line": 4_294_967_295_u64, "character": 4_294_967_295_u64}, "newName": "x"}),
            json!({"textDocument": {"uri": uri}, "range": {"start": {"line": 9, "character": 9}, "end": {"line": 0, "character": 0}}}),
        ] {
            // A response or an error; only its arrival matters.
            let _ = editor.ask(&format!("textDocument/{method}"), params);
        }
    }
    for (command, arguments) in [
        ("labspec.check", json!([])),
        ("labspec.check", json!([3])),
        ("labspec.check", json!(["file:///nowhere.md"])),
        ("labspec.check", json!(["not a URI %"])),
        ("labspec.prove", json!([uri])),
        ("labspec.prove", json!([uri, -1])),
        ("labspec.prove", json!([uri, 4_294_967_295_u64])),
        ("labspec.prove", json!(["\u{0}", 0])),
        ("labspec.other", json!([uri])),
    ] {
        let params = json!({"command": command, "arguments": arguments});
        assert!(editor.ask("workspace/executeCommand", params).is_err(), "{command} {arguments}");
    }
    for params in [json!(null), json!({"command": 3}), json!({"command": "labspec.check", "arguments": {}})] {
        assert!(editor.ask("workspace/executeCommand", params).is_err());
    }
    for params in [
        json!(null),
        json!({"textDocument": {"uri": uri, "version": "x"}, "contentChanges": [3, {"text": 1}, {"range": {}, "text": "x"}]}),
    ] {
        for method in [
            "textDocument/didChange",
            "textDocument/didOpen",
            "textDocument/didClose",
            "textDocument/didSave",
            "workspace/didChangeConfiguration",
            "$/cancelRequest",
            "workspace/didChangeWatchedFiles",
        ] {
            editor.notify(method, params.clone());
        }
    }
    // All positions of a damaged lesson.
    let text = "> ```lab simlab\n> {“model”: \"ball_drop\", 'é': [\n> \"setup\": \"data.joint('𝄞\n\n```quiz {\"q\n```lab simlab\n{\"model\": \"ball_drop\", \"setup\": \"const f = (x => f(x)); ctx.a = `${\"\n";
    editor.did_open("b.md", text);
    for (byte, _) in text.char_indices() {
        for what in ["completion", "hover", "definition", "prepareRename", "signatureHelp"] {
            let answer = editor.try_at(what, "b.md", text, byte, json!({}));
            assert!(answer.is_ok(), "{what} at {byte}: {answer:?}");
        }
    }
    for what in ["documentSymbol", "foldingRange", "formatting", "codeLens"] {
        let about = json!({"textDocument": {"uri": uri}, "options": {"tabSize": 2, "insertSpaces": true}});
        let answer = editor.ask(&format!("textDocument/{what}"), about);
        assert!(answer.is_ok(), "{what}: {answer:?}");
    }
    editor.ask("shutdown", Value::Null).unwrap();
    assert_eq!(code(editor.ask("textDocument/hover", json!({}))), -32600);
    editor.notify("exit", Value::Null);
    assert_eq!(editor.child.wait().unwrap().code(), Some(0));
}

/// An end without `shutdown`, or by the end of the input, gives a non-zero exit code.
#[test]
fn the_server_ends_with_its_editor() {
    let folder = folder();
    let mut editor = Editor::open(folder.path());
    editor.notify("exit", Value::Null);
    assert_eq!(editor.child.wait().unwrap().code(), Some(1));
    let Editor { mut child, to, .. } = Editor::open(folder.path());
    drop(to);
    assert_eq!(child.wait().unwrap().code(), Some(1));
}

/// Positions count UTF-16 code units, on lines with non-ASCII characters and with any line end.
#[test]
fn places_are_those_of_editors() {
    let folder = folder();
    let mut editor = Editor::open(folder.path());
    let lab = "\"title\": \"𝄞ä👩‍🔬 \u{fe0f}\", \"note\": \"\\u00e4 \\\"\", \"setup\": \"/* 𝄞 */ data.qpos[2] = 1; ctx.h = data.body('heavy').xpso[2]\"";
    for end in ["\n", "\r\n"] {
        for before in ["", "> ", "\u{feff}"] {
            let quote = if before == "> " { before } else { "" };
            let text = format!(
                "{before}𝄞 Würfel\n\n{quote}```lab simlab\n{quote}{{\"model\": \"ball_drop\", {lab}}}\n{quote}```\n"
            );
            let text = text.replace('\n', end);
            // The editor's text has no byte-order mark.
            let displayed = text.trim_start_matches('\u{feff}');
            let found = editor.did_open("u.md", &text);
            let at = displayed.find("xpso").unwrap();
            let wrong = found.as_array().unwrap().iter().find(|d| d["code"] == "unknown-field").unwrap();
            assert_eq!(
                wrong["range"],
                json!({"start": place(displayed, at), "end": place(displayed, at + 4)}),
                "{found}"
            );
            let byte = displayed.find("qpos[2]").unwrap();
            let hover = editor.at("hover", "u.md", displayed, byte + 1);
            let whole = byte - "data.".len();
            assert_eq!(hover["range"]["start"], place(displayed, whole), "{hover}");
            let all = editor.at("completion", "u.md", displayed, byte + 2);
            let item = all.as_array().unwrap().iter().find(|i| i["label"] == "qpos").unwrap();
            let range = json!({"start": place(displayed, byte), "end": place(displayed, byte + 4)});
            assert_eq!(item["textEdit"]["range"], range, "{item}");
            let name = displayed.find("heavy'").unwrap();
            let renamed = editor.try_at("rename", "u.md", displayed, name, json!({"newName": "Fe"})).unwrap();
            let new = edited(displayed, &renamed["changes"][editor.uri("u.md")]);
            assert_eq!(new, displayed.replace("heavy'", "Fe'"));
            // An edit in the middle of the line, with the editor's positions.
            editor.change("u.md", 2, displayed, at..at + 4, "xpos");
            assert!(!codes(&editor.found("u.md", 2)).contains(&"unknown-field"));
            // The suppression is on a separate line with the same line end as the others.
            let about = json!({"textDocument": {"uri": editor.uri("u.md")}, "range": wrong["range"], "context": {"diagnostics": []}});
            editor.ask("textDocument/codeAction", about).unwrap();
        }
    }
    assert_eq!(editor.end(), 0);
}

/// A request that is cancelled, before or after it is read, gets exactly one response, and later requests are answered as well.
#[test]
fn a_cancelled_request_is_answered_once() {
    let folder = folder();
    let mut editor = Editor::open(folder.path());
    editor.did_open("clean.md", CLEAN);
    let about =
        json!({"textDocument": {"uri": editor.uri("clean.md")}, "position": {"line": 9, "character": 20}});
    let ask =
        |id: Value| json!({"jsonrpc": "2.0", "id": id, "method": "textDocument/completion", "params": about});
    let mut answered = Vec::new();
    for i in 0..20 {
        let id = if i % 2 == 0 { json!(1000 + i) } else { json!(format!("text {i}")) };
        if i % 3 == 0 {
            editor.notify("$/cancelRequest", json!({"id": id}));
        }
        editor.send(&ask(id.clone()));
        editor.notify("$/cancelRequest", json!({"id": id}));
        answered.push(id);
    }
    editor.notify("$/cancelRequest", json!({"id": "nobody"}));
    for id in &answered {
        let message = editor.receive().unwrap();
        assert_eq!(message["id"], *id);
        assert!(message.get("result").is_some() != message.get("error").is_some(), "{message}");
    }
    assert_eq!(editor.end(), 0);
}

/// Documents of excessive size get findings, and requests are answered.
#[test]
fn huge_documents_are_answered() {
    let folder = folder();
    let mut editor = Editor::open(folder.path());
    for (text, byte) in [
        (format!("{}\n", "word ".repeat(3_400_000)), 40),
        ("$".repeat(1_000_000), 1000),
        ("\\left( ".repeat(100_000), 1000),
        ("```lab simlab\n{\"model\": \"ball_drop\"}\n```\n\n".repeat(5_000), 20),
        (format!("```lab simlab\n{}\n```\n", "[".repeat(100_000)), 60),
        (lab(&format!("\"setup\": \"{}\"", "ctx.a = data.qpos[2]; ".repeat(2_000))), 70),
        ("<!-- labspec allow label-unit: x -->\n".repeat(20_000), 10),
    ] {
        editor.did_open("h.md", &text);
        for what in [
            "completion",
            "hover",
            "definition",
            "signatureHelp",
            "documentSymbol",
            "foldingRange",
            "codeLens",
        ] {
            assert!(editor.try_at(what, "h.md", &text, byte, json!({})).is_ok(), "{what}");
        }
        editor.change("h.md", 2, &text, 0..1, "#");
        editor.found("h.md", 2);
    }
    assert_eq!(editor.end(), 0);
}

/// In a lesson with a hundred labs, the median response time to a keystroke is below 50 ms, even in a test build and next to
/// other tests; no single response may take much longer.
#[test]
fn a_hundred_labs_answer_at_once() {
    let folder = folder();
    let mut editor = Editor::open(folder.path());
    let fence = &CLEAN[CLEAN.find("```lab").unwrap()..CLEAN.find("```quiz").unwrap()];
    let mut text = String::from("# A lesson\n\n");
    for i in 0..100 {
        text.push_str(&format!(
            "## Part {i}\n\nWhat is seen in part {i}.\n\n{}\n",
            fence.replace("A drop", &format!("Drop {i}"))
        ));
    }
    editor.did_open("100.md", &text);
    let mut durations: [Vec<Duration>; 6] = Default::default();
    for (round, (at, _)) in text.clone().match_indices("data.ncon").step_by(9).enumerate() {
        let version = round as u64 + 2;
        let start = Instant::now();
        editor.change("100.md", version, &text, at + 5..at + 9, if round % 2 == 0 { "ncno" } else { "qqqq" });
        text.replace_range(at + 5..at + 9, if round % 2 == 0 { "ncno" } else { "qqqq" });
        let found = editor.found("100.md", version);
        durations[0].push(start.elapsed());
        assert_eq!(found.as_array().unwrap().len(), round + 1, "{found}");
        let start = Instant::now();
        assert!(editor.at("completion", "100.md", &text, at + 5).as_array().unwrap().len() > 50);
        durations[1].push(start.elapsed());
        let start = Instant::now();
        assert!(editor.at("hover", "100.md", &text, at + 2).is_object());
        durations[2].push(start.elapsed());
        for (what, times) in ["documentSymbol", "foldingRange", "codeLens"].iter().zip(&mut durations[3..]) {
            let start = Instant::now();
            let all = editor.at(what, "100.md", &text, at);
            times.push(start.elapsed());
            let all = all.to_string();
            assert!(all.matches("\"range\"").count() + all.matches("\"startLine\"").count() > 50, "{all}");
        }
    }
    let kinds = ["findings", "completion", "hover", "outline", "folds", "lenses"];
    for (what, times) in kinds.into_iter().zip(&durations) {
        // The tests beside this one only make an answer take longer. The text has most mistakes in the last rounds.
        let shortest = times[times.len() / 2..].iter().min().unwrap();
        let slowest = times.iter().max().unwrap();
        println!("{what}: {shortest:?}, at most {slowest:?}");
        assert!(times.len() > 5 && *shortest < Duration::from_millis(50), "{what}: {shortest:?}");
        assert!(*slowest < Duration::from_secs(1), "{what}: {slowest:?}");
    }
    assert_eq!(editor.end(), 0);
}
