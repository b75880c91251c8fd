//! The editor's documents: unsaved texts take precedence over files, and files and documents may go away.

#![allow(clippy::unwrap_used)]

use crate::lsp_editor::{Editor, codes, edited, place, shown_in_editor};
use crate::program::{CLEAN, folder};
use serde_json::{Value, json};
use std::time::Duration;

/// The texts of the editor take precedence, saved or not. Files are named as the editor names them, through links or not.
#[cfg(unix)]
#[test]
fn unsaved_texts_and_linked_folders_are_those_of_the_editor() {
    let folder = folder();
    let link = tempfile::tempdir().unwrap();
    let link = link.path().canonicalize().unwrap().join("linked");
    std::os::unix::fs::symlink(folder.path().canonicalize().unwrap(), &link).unwrap();
    let mut editor = Editor::start_editor(folder.path());
    editor.root = format!("file://{}", link.display());
    let root = editor.root.clone();
    editor.ask("initialize", json!({"rootUri": root})).unwrap();
    // Not as saved: words before it, and one more occurrence of the body's name.
    let unsaved =
        format!("Not saved.\n\n{}", CLEAN.replace("\"data.ncon\"", "\"data.body('heavy').xpos[2]\""));
    editor.did_open("clean.md", &unsaved);
    let model = std::fs::read_to_string(folder.path().join("models/ball_drop.xml")).unwrap();
    let model = format!("<!-- not saved -->\n{model}");
    let uri = editor.uri("models/ball_drop.xml");
    let document = json!({"uri": uri, "languageId": "xml", "version": 1, "text": model});
    editor.notify("textDocument/didOpen", json!({"textDocument": document}));
    let byte = unsaved.find("'heavy')").unwrap() + 2;
    let there = editor.at("definition", "clean.md", &unsaved, byte);
    assert_eq!(there[0]["uri"], uri.as_str(), "{there}");
    let at = model.find("\"heavy\"").unwrap() + 1;
    assert_eq!(there[0]["range"]["start"], place(&model, at));
    let back = editor.at("definition", "models/ball_drop.xml", &model, at);
    let uses: Vec<&Value> = back.as_array().unwrap().iter().map(|l| &l["uri"]).collect();
    assert!(uses.contains(&&json!(editor.uri("clean.md"))), "{back}");
    assert!(uses.iter().all(|uri| uri.as_str().unwrap().starts_with(&editor.root)), "{back}");
    let renamed =
        editor.try_at("rename", "models/ball_drop.xml", &model, at, json!({"newName": "iron"})).unwrap();
    let changes = renamed["changes"].as_object().unwrap();
    assert!(changes.keys().all(|uri| uri.starts_with(&editor.root)), "{changes:?}");
    let new = edited(&unsaved, &changes[&editor.uri("clean.md")]);
    assert_eq!(new, unsaved.replace("'heavy')", "'iron')"));
    assert!(edited(&model, &changes[&uri]).starts_with("<!-- not saved -->"));
    let byte = unsaved.find("\"ball_drop\"").unwrap() + 2;
    assert_eq!(editor.at("definition", "clean.md", &unsaved, byte)["uri"], uri.as_str());
    assert_eq!(editor.end(), 0);
}

/// Files that are deleted, before and during requests about them.
#[test]
fn files_may_go_away() {
    let folder = folder();
    let mut editor = Editor::open(folder.path());
    editor.did_open("clean.md", CLEAN);
    std::fs::remove_file(folder.path().join("clean.md")).unwrap();
    let byte = CLEAN.find("'heavy_geom'").unwrap() + 3;
    assert!(editor.at("definition", "clean.md", CLEAN, byte).is_array());
    let model = editor.uri("models/ball_drop.xml");
    std::fs::remove_dir_all(folder.path().join("models")).unwrap();
    editor.notify("workspace/didChangeWatchedFiles", json!({"changes": [{"uri": model, "type": 3}]}));
    let codes_now = |found: Value| codes(&found).iter().map(|c| c.to_string()).collect::<Vec<_>>();
    assert!(codes_now(editor.found("clean.md", 1)).contains(&"no-model-folder".to_string()));
    for what in ["definition", "hover", "completion", "references", "prepareRename"] {
        assert!(editor.try_at(what, "clean.md", CLEAN, byte, json!({})).is_ok(), "{what}");
    }
    assert!(editor.try_at("rename", "clean.md", CLEAN, byte, json!({"newName": "x"})).is_err());
    // The folder that contains all files.
    std::fs::remove_dir_all(folder.path()).unwrap();
    let mut text = CLEAN.to_string();
    text.insert(0, 'x');
    editor.change("clean.md", 2, CLEAN, 0..0, "x");
    editor.found("clean.md", 2);
    assert!(editor.try_at("hover", "clean.md", &text, byte, json!({})).is_ok());
    assert_eq!(editor.end(), 0);
}

/// No findings are reported for a document that is closed during its runs, even if it is opened again with the same version.
#[test]
fn a_closed_document_gets_no_further_diagnostics() {
    let folder = folder();
    let mut editor = Editor::open(folder.path());
    let text = crate::program::wrong();
    let uri = editor.uri("wrong.md");
    for _ in 0..5 {
        editor.did_open("wrong.md", &text);
        editor.notify("textDocument/didSave", json!({"textDocument": {"uri": uri}}));
        editor.notify("textDocument/didClose", json!({"textDocument": {"uri": uri}}));
        let found = editor.did_open("wrong.md", "# Only words\n");
        assert_eq!(found, json!([]));
        editor.notify("textDocument/didClose", json!({"textDocument": {"uri": uri}}));
        // The cancelled check has no effect: only the opening and the closing are reported.
        std::thread::sleep(Duration::from_millis(50));
        let _ = editor.ask("textDocument/nothing", json!({}));
        let notifications = std::mem::take(&mut editor.heard);
        let notifications: Vec<_> =
            notifications.iter().filter(|m| m["params"]["uri"] == uri.as_str()).collect();
        assert!(notifications.iter().all(|m| m["params"]["diagnostics"] == json!([])), "{notifications:?}");
    }
    assert_eq!(editor.end(), 0);
}

/// In a lesson that uses another one, the findings while typing are those of `check --no-run`, and the findings after
/// saving are those of `check`.
#[test]
fn editor_and_program_report_the_same_for_a_lesson_with_neighbours() {
    let folder = crate::ledger::with_neighbours();
    let text = crate::ledger::READER;
    let codes_of = |more: &[&str]| {
        let arguments = [&["check", "reader.md", "--format", "json"], more].concat();
        let done = crate::program::run_in(folder.path(), &arguments);
        crate::ledger::found(&serde_json::from_str(&done.stdout).unwrap())
    };
    let (typed, saved) = (codes_of(&["--no-run"]), codes_of(&[]));
    assert!(typed != saved && typed.iter().any(|(code, _)| code == "dead-link"), "{typed:?}");
    let mut editor = Editor::open(folder.path());
    assert_eq!(shown_in_editor(&editor.did_open("reader.md", text)), typed);
    editor.change("reader.md", 2, text, 2..2, "");
    assert_eq!(shown_in_editor(&editor.found("reader.md", 2)), typed);
    let document = json!({"textDocument": {"uri": editor.uri("reader.md")}});
    editor.notify("textDocument/didSave", document);
    assert_eq!(shown_in_editor(&editor.found("reader.md", 2)), saved);
    assert_eq!(editor.end(), 0);
}

/// Unsaved contents of other documents are used: labs, headings, models, and files that do not exist yet.
#[test]
fn unsaved_neighbours_are_read() {
    let folder = crate::ledger::with_neighbours();
    let mut editor = Editor::open(folder.path());
    let labs = crate::ledger::LABS;
    let has = |found: &Value, code: &str| codes(found).contains(&code);
    let first = editor.did_open("reader.md", crate::ledger::READER);
    assert!(has(&first, "dead-link") && !has(&first, "unknown-lab"), "{first}");
    // An unsaved heading, and a removed lab.
    editor.did_open("labs.md", labs);
    let at = labs.len();
    editor.change("labs.md", 2, labs, at..at, "\n## Elsewhere\n");
    let reported = editor.found("reader.md", 1);
    assert!(!has(&reported, "dead-link") && !has(&reported, "unknown-lab"), "{reported}");
    let now = format!("{labs}\n## Elsewhere\n");
    let lab = now.find("```lab").unwrap();
    editor.change("labs.md", 3, &now, lab..now.len(), "");
    assert!(has(&editor.found("reader.md", 1), "unknown-lab"));
    let document = json!({"textDocument": {"uri": editor.uri("labs.md")}});
    editor.notify("textDocument/didClose", document);
    let closed = editor.found("reader.md", 1);
    assert!(!has(&closed, "unknown-lab") && has(&closed, "dead-link"), "{closed}");
    // The model while it is typed.
    let model = std::fs::read_to_string(folder.path().join("models/free_fall.xml")).unwrap();
    let open =
        json!({"uri": editor.uri("models/free_fall.xml"), "languageId": "xml", "version": 1, "text": model});
    editor.notify("textDocument/didOpen", json!({"textDocument": open}));
    let body = model.find("<body").unwrap();
    editor.change("models/free_fall.xml", 2, &model, body + 1..body + 5, "bodi");
    assert!(has(&editor.found("reader.md", 1), "model-broken"));
    let broken = model.replacen("<body", "<bodi", 1);
    editor.change("models/free_fall.xml", 3, &broken, body + 1..body + 5, "body");
    assert!(!has(&editor.found("reader.md", 1), "model-broken"));
    // A model and a linked lesson that do not exist, and then do.
    let text = "# New\n\nSee [it](soon.md).\n\n```lab simlab\n{\"model\": \"soon\", \"stopAt\": 0.1}\n```\n";
    let new = editor.did_open("new.md", text);
    assert!(has(&new, "unknown-model") && has(&new, "dead-link"), "{new}");
    let open =
        json!({"uri": editor.uri("models/soon.xml"), "languageId": "xml", "version": 1, "text": model});
    editor.notify("textDocument/didOpen", json!({"textDocument": open}));
    let reported = editor.found("new.md", 1);
    assert!(!has(&reported, "unknown-model"), "{reported}");
    editor.did_open("soon.md", "# Soon\n");
    assert!(!has(&editor.found("new.md", 1), "dead-link"));
    assert_eq!(editor.end(), 0);
}

/// While the author types, no files are read: cached information is used until a file is saved, opened or closed.
#[test]
fn a_keystroke_causes_no_disk_access() {
    let folder = crate::ledger::with_neighbours();
    let text = crate::ledger::READER;
    let mut editor = Editor::open(folder.path());
    let first = shown_in_editor(&editor.did_open("reader.md", text));
    std::fs::remove_file(folder.path().join("labs.md")).unwrap();
    std::fs::remove_dir_all(folder.path().join("models")).unwrap();
    editor.change("reader.md", 2, text, 2..2, "");
    assert_eq!(shown_in_editor(&editor.found("reader.md", 2)), first);
    let changed = json!({"changes": [{"uri": editor.uri("labs.md"), "type": 3}]});
    editor.notify("workspace/didChangeWatchedFiles", changed);
    let now = editor.found("reader.md", 2);
    for code in ["unknown-lab", "no-model-folder"] {
        assert!(codes(&now).contains(&code), "{code}: {now}");
    }
    // The same applies to the settings.
    let counts = |found: &Value| codes(found).contains(&"duplicate-readout");
    std::fs::write(folder.path().join("labspec.toml"), "ignore = [\"duplicate-readout\"]\n").unwrap();
    editor.change("reader.md", 3, text, 2..2, "");
    assert!(counts(&editor.found("reader.md", 3)));
    let changed = json!({"changes": [{"uri": editor.uri("labspec.toml"), "type": 1}]});
    editor.notify("workspace/didChangeWatchedFiles", changed);
    assert!(!counts(&editor.found("reader.md", 3)));
    assert_eq!(editor.end(), 0);
}
