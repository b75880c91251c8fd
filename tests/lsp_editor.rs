//! An editor for the tests of `labspec lsp`: it starts the real program, and sends and receives messages.

#![allow(clippy::unwrap_used)]

use crate::program::program;
use serde_json::{Value, json};
use std::io::{BufRead, BufReader, Read, Write};
use std::path::Path;
use std::process::{Child, ChildStdin, ChildStdout, Stdio};

/// An editor that sends and receives messages.
pub(crate) struct Editor {
    pub(crate) child: Child,
    pub(crate) to: ChildStdin,
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

    pub(crate) fn raw(&mut self, bytes: &[u8]) {
        self.to.write_all(bytes).unwrap();
        self.to.flush().unwrap();
    }

    pub(crate) fn send(&mut self, message: &Value) {
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
