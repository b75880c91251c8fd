//! `labspec lsp` as editors use it: the real program, over its standard input and output.

#![allow(clippy::unwrap_used)]

use crate::program::{CLEAN, folder, program};
use serde_json::{Value, json};
use std::io::{BufRead, BufReader, Read, Write};
use std::path::Path;
use std::process::{Child, ChildStdin, ChildStdout, Stdio};
use std::time::{Duration, Instant};

/// An editor that sends and receives messages.
pub(crate) struct Editor {
    child: Child,
    to: ChildStdin,
    from: BufReader<ChildStdout>,
    pub(crate) root: String,
    next: u64,
    /// Received notifications that have not been processed.
    pub(crate) heard: Vec<Value>,
}

impl Editor {
    /// Starts the program without sending a message.
    pub(crate) fn start_editor(folder: &Path) -> Editor {
        let mut command = program(folder, &["lsp", "--stdio"]);
        let mut child =
            command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::null()).spawn().unwrap();
        let (to, from) = (child.stdin.take().unwrap(), BufReader::new(child.stdout.take().unwrap()));
        let root = format!("file://{}", folder.canonicalize().unwrap().display());
        Editor { child, to, from, root, next: 0, heard: Vec::new() }
    }

    pub(crate) fn open(folder: &Path) -> Editor {
        let mut editor = Editor::start_editor(folder);
        let options = json!({"inlayHints": {"units": true}, "runOnSave": true});
        let root = editor.root.clone();
        editor.ask("initialize", json!({"rootUri": root, "initializationOptions": options})).unwrap();
        editor.notify("initialized", json!({}));
        editor
    }

    /// An editor without an open folder: each lesson is a course of its own.
    pub(crate) fn open_without_folder(folder: &Path) -> Editor {
        let mut editor = Editor::start_editor(folder);
        editor
            .ask("initialize", json!({"rootUri": null, "initializationOptions": {"runOnSave": true}}))
            .unwrap();
        editor.notify("initialized", json!({}));
        editor
    }

    fn raw(&mut self, bytes: &[u8]) {
        self.to.write_all(bytes).unwrap();
        self.to.flush().unwrap();
    }

    fn send(&mut self, message: &Value) {
        let text = message.to_string();
        self.raw(format!("Content-Length: {}\r\n\r\n{text}", text.len()).as_bytes());
    }

    pub(crate) fn notify(&mut self, method: &str, params: Value) {
        self.send(&json!({"jsonrpc": "2.0", "method": method, "params": params}));
    }

    /// The next message, or `None` at the end of the output.
    pub(crate) fn receive(&mut self) -> Option<Value> {
        let mut length = 0;
        loop {
            let mut line = String::new();
            if self.from.read_line(&mut line).unwrap() == 0 {
                return None;
            }
            match line.trim().split_once(": ") {
                Some(("Content-Length", n)) => length = n.parse().unwrap(),
                Some(_) => {}
                None => break,
            }
        }
        let mut body = vec![0; length];
        self.from.read_exact(&mut body).unwrap();
        let message: Value = serde_json::from_slice(&body).unwrap();
        assert_eq!(message["jsonrpc"], "2.0");
        Some(message)
    }

    /// Sends a request, and returns its result or error.
    pub(crate) fn ask(&mut self, method: &str, params: Value) -> Result<Value, Value> {
        self.next += 1;
        let id = json!(self.next);
        self.send(&json!({"jsonrpc": "2.0", "id": id, "method": method, "params": params}));
        self.answer(&id)
    }

    fn answer(&mut self, id: &Value) -> Result<Value, Value> {
        loop {
            let message = self.receive().unwrap();
            if message.get("method").is_none() && message["id"] == *id {
                return match message.get("error") {
                    Some(error) => Err(error.clone()),
                    None => Ok(message["result"].clone()),
                };
            }
            self.heard.push(message);
        }
    }

    pub(crate) fn uri(&self, file: &str) -> String {
        format!("{}/{file}", self.root)
    }

    pub(crate) fn did_open(&mut self, file: &str, text: &str) -> Value {
        let document = json!({"uri": self.uri(file), "languageId": "markdown", "version": 1, "text": text});
        self.notify("textDocument/didOpen", json!({"textDocument": document}));
        self.found(file, 1)
    }

    /// Replaces a part of a document with a change notification.
    pub(crate) fn change(
        &mut self,
        file: &str,
        version: u64,
        before: &str,
        part: std::ops::Range<usize>,
        text: &str,
    ) {
        let range = json!({"start": place(before, part.start), "end": place(before, part.end)});
        let document = json!({"uri": self.uri(file), "version": version});
        let changes = json!([{"range": range, "text": text}]);
        self.notify("textDocument/didChange", json!({"textDocument": document, "contentChanges": changes}));
    }

    /// The next findings for a version of a document.
    pub(crate) fn found(&mut self, file: &str, version: u64) -> Value {
        let uri = self.uri(file);
        let about = |m: &Value| {
            m["method"] == "textDocument/publishDiagnostics"
                && m["params"]["uri"] == uri.as_str()
                && m["params"]["version"] == version
        };
        loop {
            if let Some(at) = self.heard.iter().position(about) {
                return self.heard.remove(at)["params"]["diagnostics"].clone();
            }
            let message = self.receive().unwrap();
            self.heard.push(message);
        }
    }

    /// Sends a request for a position in a document.
    pub(crate) fn at(&mut self, what: &str, file: &str, text: &str, byte: usize) -> Value {
        self.try_at(what, file, text, byte, json!({})).unwrap()
    }

    pub(crate) fn try_at(
        &mut self,
        what: &str,
        file: &str,
        text: &str,
        byte: usize,
        more: Value,
    ) -> Result<Value, Value> {
        let mut params = json!({"textDocument": {"uri": self.uri(file)}, "position": place(text, byte)});
        for (key, value) in more.as_object().unwrap() {
            params[key] = value.clone();
        }
        self.ask(&format!("textDocument/{what}"), params)
    }

    /// Ends the session according to the protocol, and returns the exit code.
    pub(crate) fn end(mut self) -> i32 {
        self.ask("shutdown", Value::Null).unwrap();
        self.notify("exit", Value::Null);
        self.child.wait().unwrap().code().unwrap()
    }
}

/// The editor position of a byte.
pub(crate) fn place(text: &str, byte: usize) -> Value {
    let before = &text[..byte];
    let line = before.rfind('\n').map_or(0, |at| at + 1);
    json!({"line": before.matches('\n').count(), "character": before[line..].encode_utf16().count()})
}

pub(crate) fn codes(found: &Value) -> Vec<&str> {
    found.as_array().unwrap().iter().map(|d| d["code"].as_str().unwrap()).collect()
}

/// Applies all edits of one document to a text.
pub(crate) fn edited(text: &str, edits: &Value) -> String {
    let byte = |at: &Value| {
        let line = at["line"].as_u64().unwrap() as usize;
        let start = text.split_inclusive('\n').take(line).map(str::len).sum::<usize>();
        let mut units = at["character"].as_u64().unwrap() as usize;
        let rest = text[start..].chars();
        let inside: usize = rest
            .take_while(|c| {
                let goes_on = units > 0;
                units = units.saturating_sub(c.len_utf16());
                goes_on
            })
            .map(char::len_utf8)
            .sum();
        start + inside
    };
    let mut all: Vec<_> = edits.as_array().unwrap().iter().collect();
    all.sort_by_key(|e| std::cmp::Reverse(byte(&e["range"]["start"])));
    let mut new = text.to_string();
    for edit in all {
        let span = byte(&edit["range"]["start"])..byte(&edit["range"]["end"]);
        new.replace_range(span, edit["newText"].as_str().unwrap());
    }
    new
}

/// The text without the `|`, and its position.
pub(crate) fn marked(text: &str) -> (String, usize) {
    (text.replace('|', ""), text.find('|').unwrap())
}

pub(crate) fn lab(inside: &str) -> String {
    format!("# Ein Würfel 𝄞\n\n```lab simlab\n{{\"model\": \"ball_drop\", {inside}}}\n```\n")
}

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

#[test]
fn completions_know_the_language_the_model_and_the_format() {
    let folder = folder();
    let mut editor = Editor::open(folder.path());
    for (inside, expected, not) in [
        ("\"setup\": \"data.joint('|')\"", "heavy_free", "heavy"),
        ("\"setup\": \"data.body(\\\"he|\\\")\"", "heavy", "heavy_free"),
        ("\"setup\": \"data.|\"", "qpos", "geom_size"),
        ("\"setup\": \"model.opt.|\"", "timestep", "qpos"),
        ("\"setup\": \"ctx.peak = 1\", \"controller\": \"ctx.|\"", "peak", "qpos"),
        ("\"setup\": \"const v = data.qvel; v.|\"", "length", "qpos"),
        ("\"setup\": \"Math.|\"", "hypot", "qpos"),
        ("\"setup\": \"lib.|\"", "energy", "ncon"),
        ("\"setup\": \"const speed = 1; |\"", "speed", "qpos"),
        ("\"con|\"", "controls", "model"),
        ("\"readouts\": [{\"label\": \"a\", |}]", "expr", "label"),
        ("\"dock\": |", "true", "model"),
        ("\"verify\": {\"measure\": {\"top\": \"max(data.|)\"}}", "qpos", "geom_size"),
        ("\"verify\": {\"measure\": {\"top\": \"1\"}, \"options\": [\"|\"]}", "top", "qpos"),
    ] {
        let (text, byte) = marked(&lab(inside));
        editor.did_open("c.md", &text);
        let all = editor.at("completion", "c.md", &text, byte);
        let labels: Vec<&str> =
            all.as_array().unwrap().iter().map(|i| i["label"].as_str().unwrap()).collect();
        assert!(labels.contains(&expected) && !labels.contains(&not), "{inside}: {labels:?}");
        // Applying the completion keeps the JSON valid.
        let item = all.as_array().unwrap().iter().find(|i| i["label"] == expected).unwrap();
        if item.get("textEdit").is_some() {
            let new = edited(&text, &json!([item["textEdit"]]));
            assert!(new.contains(expected) && new.ends_with("}\n```\n"), "{new}");
        }
    }
    // Also in a claim in a comment.
    for (inside, expected, not) in [
        ("{\"lab\": \"#1\", \"mea|\"}", "measure", "model"),
        ("{\"lab\": \"#1\", \"measure\": {\"top\": \"max(data.|)\"}}", "qpos", "geom_size"),
        ("{\"lab\": \"#1\", \"measure\": {\"top\": \"1\"}, \"says\": [[\"2\", \"|\"]]}", "top", "qpos"),
    ] {
        let lesson =
            format!("{}\n<!-- labspec verify {inside} -->\nIt falls for 2 s.\n", lab("\"dock\": true"));
        let (text, byte) = marked(&lesson);
        editor.did_open("c.md", &text);
        let all = editor.at("completion", "c.md", &text, byte);
        let labels: Vec<&str> =
            all.as_array().unwrap().iter().map(|i| i["label"].as_str().unwrap()).collect();
        assert!(labels.contains(&expected) && !labels.contains(&not), "{inside}: {labels:?}");
    }
    // In a model, the schema and its own names are completed and explained.
    let (text, byte) = marked("<mujoco><worldbody><geom type='|'/></worldbody></mujoco>");
    editor.did_open("models/new.xml", &text);
    let all = editor.at("completion", "models/new.xml", &text, byte);
    let capsule = all.as_array().unwrap().iter().find(|i| i["label"] == "capsule").unwrap();
    assert_eq!(edited(&text, &json!([capsule["textEdit"]])), text.replace("''", "'capsule'"));
    let hover = editor.at("hover", "models/new.xml", &text, byte);
    assert!(hover["contents"]["value"].as_str().unwrap().starts_with("**type**: one of"), "{hover}");
    // There are no completions in prose.
    editor.did_open("c.md", "# Title\n\nSome data.qpos\n");
    assert_eq!(editor.at("completion", "c.md", "# Title\n\nSome data.qpos\n", 15), json!([]));
    assert_eq!(editor.end(), 0);
}

#[test]
fn a_lab_that_compares_integrators_is_known_to_the_editor() {
    let folder = folder();
    let mut editor = Editor::open(folder.path());
    let fence = |inside: &str| format!("# Ein Würfel 𝄞\n\n```lab integrators\n{{{inside}}}\n```\n");
    let claim =
        "\"model\": \"ball_drop\", \"verify\": {\"measure\": {\"top\": \"1\"}, \"says\": [[\"1\", \"|\"]]}";
    for (inside, expected, not) in [
        ("\"model\": \"ball_drop\", \"|\"", "integrators", "model"),
        ("\"model\": \"ball_drop\", \"time|\"", "timestep", "model"),
        ("\"model\": \"ball_drop\", \"integrators\": [\"|\"]", "implicitfast", "timestep"),
        ("\"model\": \"ball_drop\", \"setup\": \"data.|\"", "qpos", "geom_size"),
        (claim, "RK4", "qpos"),
    ] {
        let (text, byte) = marked(&fence(inside));
        editor.did_open("i.md", &text);
        let all = editor.at("completion", "i.md", &text, byte);
        let labels: Vec<&str> =
            all.as_array().unwrap().iter().map(|i| i["label"].as_str().unwrap()).collect();
        assert!(labels.contains(&expected) && !labels.contains(&not), "{inside}: {labels:?}");
    }
    let hovered = |editor: &mut Editor, inside: &str| {
        let (text, byte) = marked(&fence(inside));
        editor.did_open("i.md", &text);
        editor.at("hover", "i.md", &text, byte)["contents"]["value"].as_str().unwrap_or("").to_string()
    };
    let key = hovered(&mut editor, "\"model\": \"ball_drop\", \"integ|rators\": [\"RK4\"]");
    assert!(key.starts_with("**integrators**: list of words"), "{key}");
    let name = hovered(&mut editor, "\"model\": \"ball_drop\", \"integrators\": [\"R|K4\"]");
    assert!(name.starts_with("**RK4**") && name.contains("Runge-Kutta"), "{name}");
    let found = editor.did_open("i.md", &fence("\"model\": \"ball_drop\", \"integrators\": [\"rk4\"]"));
    assert!(codes(&found).contains(&"integrators-list"), "{found}");
    assert_eq!(editor.end(), 0);
}

#[test]
fn a_hover_states_the_initial_value() {
    let folder = folder();
    let mut editor = Editor::open(folder.path());
    for (inside, expected) in [
        ("\"setup\": \"data.qpos[|2] = 7\"", "z position, m"),
        ("\"setup\": \"data.qpos[2] = 7\", \"controller\": \"ctx.z = data.qpos[|2]\"", "= **7**"),
        ("\"setup\": \"data.qpos[2] = 7\", \"controller\": \"ctx.z = data.q|pos\"", "= **[-0.2, 0, 7"),
        ("\"readouts\": [{\"label\": \"a\", \"expr\": \"model.opt.time|step\"}]", "= **0.002**"),
        ("\"readouts\": [{\"label\": \"a\", \"expr\": \"lib.bodyPos('heavy')[|2]\"}]", "= **"),
        ("\"set|up\": \"data.qpos[2] = 7\"", "code: statements"),
        ("\"key\": 99, \"setup\": \"while (true) {}\", \"controller\": \"data.q|vel[2] = 0\"", "velocities"),
    ] {
        let (text, byte) = marked(&lab(inside));
        editor.did_open("h.md", &text);
        let hover = editor.at("hover", "h.md", &text, byte);
        let hover = hover["contents"]["value"].as_str().unwrap_or("").to_string();
        assert!(hover.contains(expected), "{inside}: {hover}");
    }
    assert_eq!(editor.end(), 0);
}

#[test]
fn a_name_leads_to_the_model_and_back() {
    let folder = folder();
    let mut editor = Editor::open(folder.path());
    editor.did_open("clean.md", CLEAN);
    let model = std::fs::read_to_string(folder.path().join("models/ball_drop.xml")).unwrap();
    let byte = CLEAN.find("'heavy_geom'").unwrap() + 3;
    let there = editor.at("definition", "clean.md", CLEAN, byte);
    assert_eq!(there[0]["uri"], editor.uri("models/ball_drop.xml").as_str());
    let at = model.find("\"heavy_geom\"").unwrap() + 1;
    assert_eq!(there[0]["range"]["start"], place(&model, at));
    let uri = editor.uri("models/ball_drop.xml");
    let document = json!({"uri": uri, "languageId": "xml", "version": 1, "text": model});
    editor.notify("textDocument/didOpen", json!({"textDocument": document}));
    let back = editor.at("definition", "models/ball_drop.xml", &model, at + 2);
    let uris: Vec<&str> = back.as_array().unwrap().iter().map(|l| l["uri"].as_str().unwrap()).collect();
    assert!(
        uris.contains(&editor.uri("clean.md").as_str()) && uris.contains(&editor.uri("course/a.md").as_str()),
        "{uris:?}"
    );
    // The name of a model leads to its file.
    let byte = CLEAN.find("\"ball_drop\"").unwrap() + 3;
    assert_eq!(editor.at("definition", "clean.md", CLEAN, byte)["uri"], uri.as_str());
    assert_eq!(editor.end(), 0);
}

/// Claims in comments, and claims about labs of other lessons, are renamed and checked like all others.
#[test]
fn claims_in_comments_are_code() {
    let folder = folder();
    let mut editor = Editor::open(folder.path());
    let claim = |lab: &str, name: &str| {
        format!(
            "<!-- labspec verify {{\"lab\": \"{lab}\", \"runs\": {{\"fall\": {{}}}}, \"measure\": {{\"top\": \"max(data.body('{name}').xpos[2])\"}}, \"says\": [[\"high\", \"top > 0.2\"]]}} -->\nIt is high.\n"
        )
    };
    let text =
        format!("{}\n{}\n{}", lab("\"dock\": true"), claim("#1", "heavy"), claim("clean.md#1", "heavy"));
    std::fs::write(folder.path().join("said.md"), &text).unwrap();
    assert_eq!(codes(&editor.did_open("said.md", &text)), [""; 0]);
    let byte = text.find("heavy').xpos").unwrap() + 2;
    let hover = editor.at("hover", "said.md", &text, byte);
    assert!(hover["contents"]["value"].as_str().unwrap_or("").contains("heavy"), "{hover}");
    let answer = editor.try_at("rename", "said.md", &text, byte, json!({"newName": "iron"})).unwrap();
    let edits = &answer["changes"][editor.uri("said.md").as_str()];
    let new = edited(&text, edits);
    assert_eq!(new.matches("'iron'").count(), 2, "{new}");
    // An unknown name is reported in both.
    let wrong = text.replace("'heavy'", "'haevy'");
    editor.did_open("said.md", &wrong);
    let found = editor.did_open("said.md", &wrong);
    assert_eq!(codes(&found), ["unknown-object"; 2], "{found}");
    assert_eq!(editor.end(), 0);
}

/// After a rename, the program reports the same about the whole course; if it would not, nothing is renamed.
#[test]
fn a_rename_keeps_the_course_true() {
    let folder = folder();
    let mut editor = Editor::open(folder.path());
    editor.did_open("clean.md", CLEAN);
    let byte = CLEAN.find("'heavy_geom'").unwrap() + 3;
    let range = editor.at("prepareRename", "clean.md", CLEAN, byte);
    assert_eq!(range["placeholder"], "heavy_geom");
    let answer = editor.try_at("rename", "clean.md", CLEAN, byte, json!({"newName": "iron_geom"})).unwrap();
    let changes = answer["changes"].as_object().unwrap();
    let files: Vec<&str> =
        changes.keys().map(|uri| uri.strip_prefix(&format!("{}/", editor.root)).unwrap()).collect();
    // The lesson next to other models is not changed.
    assert_eq!(files, ["clean.md", "course/a.md", "models/ball_drop.xml", "wrong.md"]);
    for (uri, edits) in changes {
        let path = folder.path().join(uri.strip_prefix(&format!("{}/", editor.root)).unwrap());
        let text = std::fs::read_to_string(&path).unwrap();
        let new = edited(&text, edits);
        assert!(new.contains("iron_geom") && !new.contains("heavy_geom"), "{new}");
        std::fs::write(path, new).unwrap();
    }
    for lesson in ["clean.md", "course/a.md"] {
        let done = crate::program::run_in(folder.path(), &["check", lesson, "--models", "models"]);
        assert_eq!(done.code, 0, "{}", done.stdout);
    }
    assert_eq!(editor.end(), 0);
}

#[test]
fn a_rename_that_is_not_certain_is_refused() {
    let folder = folder();
    let mut editor = Editor::open(folder.path());
    let heavy = "data.body('he|avy').xpos[2]";
    for (inside, new, why) in [
        (format!("\"setup\": \"ctx.z = {heavy}\""), "light", "already"),
        (format!("\"setup\": \"ctx.z = {heavy}\""), "a b\"", "escape"),
        (format!("\"setup\": \"ctx.z = {heavy}\""), "", "at least one character"),
        (format!("\"setup\": \"ctx.z = {heavy}; ctx.name = 'heavy'\""), "iron", "or something else"),
        (
            format!("\"setup\": \"ctx.z = {heavy}; ctx.w = data.body('h\\u0065avy').xpos[2]\""),
            "iron",
            "escapes",
        ),
    ] {
        let (text, byte) = marked(&lab(&inside));
        editor.did_open("r.md", &text);
        let refused = editor.try_at("rename", "r.md", &text, byte, json!({"newName": new})).unwrap_err();
        assert!(refused["message"].as_str().unwrap().contains(why), "{inside}: {refused}");
    }
    assert_eq!(editor.end(), 0);
}

#[test]
fn repairs_are_offered_and_made() {
    let folder = folder();
    let mut editor = Editor::open(folder.path());
    let text = lab(
        "\"titel\": \"A\", \"readouts\": [{\"label\": \"a\", \"expr\": \"data.qpos[2]\"}, {\"label\": \"a\", \"expr\": \"data.qpos[9]\"}]",
    );
    let found = editor.did_open("f.md", &text);
    assert!(
        codes(&found).contains(&"unknown-key") && codes(&found).contains(&"duplicate-readout"),
        "{found}"
    );
    let whole = json!({"start": place(&text, 0), "end": place(&text, text.len())});
    let ask = |only: Value| json!({"textDocument": {"uri": ""}, "range": whole, "context": {"diagnostics": [], "only": only}});
    let mut asked = ask(json!(["quickfix"]));
    asked["textDocument"]["uri"] = editor.uri("f.md").into();
    let all = editor.ask("textDocument/codeAction", asked).unwrap();
    let offered = |title: &str| {
        let found = all.as_array().unwrap().iter().find(|a| a["title"].as_str().unwrap().contains(title));
        found.unwrap_or_else(|| panic!("{title} in {all}")).clone()
    };
    let made = |action: &Value| edited(&text, &action["edit"]["documentChanges"][0]["edits"]);
    assert!(made(&offered("title")).contains("\"title\": \"A\""));
    let suppressed = made(&offered("suppress `duplicate-readout`"));
    assert!(
        suppressed.contains("\"lint\": {\"allow\": [\"duplicate-readout\"], \"why\": \"\"}"),
        "{suppressed}"
    );
    // With a reason, the finding is suppressed.
    let suppressed = suppressed.replace("\"why\": \"\"", "\"why\": \"on purpose\"");
    assert!(!codes(&editor.did_open("f.md", &suppressed)).contains(&"duplicate-readout"));
    let mut asked = ask(json!(["source.fixAll"]));
    editor.did_open("f.md", &text);
    asked["textDocument"]["uri"] = editor.uri("f.md").into();
    let all = editor.ask("textDocument/codeAction", asked).unwrap();
    assert!(all.as_array().unwrap().iter().all(|a| a["kind"] == "source.fixAll.labspec"), "{all}");
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

/// If the dimension is known, it is displayed, also for variables and functions, which have no declared unit.
#[test]
fn a_hover_states_the_dimension() {
    let folder = folder();
    let mut editor = Editor::open(folder.path());
    for (inside, expected) in [
        (
            "\"controller\": \"ctx.v = Math.hypot(data.qvel[0], data.qvel[1]); ctx.w = ctx.|v\"",
            Some("is in m/s"),
        ),
        (
            "\"controller\": \"ctx.v = 1000 * data.qvel[0]\", \"setup\": \"ctx.w = ctx.|v\"",
            Some("is in mm/s"),
        ),
        ("\"readouts\": [{\"label\": \"a\", \"expr\": \"model.body_mass[|1]\"}]", Some("is in kg")),
        ("\"readouts\": [{\"label\": \"a\", \"expr\": \"data.ti|me\"}]", Some("is in s")),
        // If it is uncertain, or the value is dimensionless, nothing is displayed.
        ("\"controller\": \"ctx.v = data.time > 1 ? data.qvel[0] : data.qpos[0]; ctx.w = ctx.|v\"", None),
        ("\"readouts\": [{\"label\": \"a\", \"expr\": \"data.nc|on\"}]", None),
    ] {
        let (text, byte) = marked(&lab(inside));
        editor.did_open("d.md", &text);
        let hover = editor.at("hover", "d.md", &text, byte);
        let hover = hover["contents"]["value"].as_str().unwrap_or("").to_string();
        match expected {
            Some(expected) => assert!(hover.contains(expected), "{inside}: {hover}"),
            None => assert!(!hover.contains("dimension"), "{inside}: {hover}"),
        }
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
    for (what, times) in kinds.into_iter().zip(&mut durations) {
        times.sort();
        let (median, slowest) = (times[times.len() / 2], times[times.len() - 1]);
        println!("{what}: {median:?}, at most {slowest:?}");
        assert!(times.len() > 5 && median < Duration::from_millis(50), "{what}: {median:?}");
        assert!(slowest < Duration::from_secs(1), "{what}: {slowest:?}");
    }
    assert_eq!(editor.end(), 0);
}

/// The rules and lines of the findings in the editor.
pub(crate) fn shown_in_editor(found: &Value) -> Vec<(String, u64)> {
    let one = |f: &Value| {
        let line = f["range"]["start"]["line"].as_u64().unwrap() + 1;
        (f["code"].as_str().unwrap().to_string(), line)
    };
    let mut all: Vec<(String, u64)> = found.as_array().unwrap().iter().map(one).collect();
    all.sort();
    all
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
