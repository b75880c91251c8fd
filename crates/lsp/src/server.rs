//! The loop: a message in, what it asks for out. All state belongs to this thread; runs go on beside it.

use super::actions::actions;
use super::check::{check_document, lesson};
use super::complete::completions;
use super::course::{Arounds, Opened, uri_of};
use super::diagnostic::diagnostic;
use super::documents::Document;
use super::hints::hints;
use super::hover::hover;
use super::names::{self, Ground, Name, Places};
use super::places;
use super::rename::rename;
use super::runs::{Job, Ran};
use super::wire::{self, Incoming};
use labspec::finding::Finding;
use labspec::lint::{ModelFolder, links_to};
use labspec::source::MAX_FILE;
use labspec::spec::{FileKind, Lesson, Other, kind_of};
use labspec::threads;
use lsp_server::{ErrorCode, Message, Notification, Request, RequestId};
use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::io::{self, BufRead, Write};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::mpsc::{Receiver, Sender, channel};

/// What the program knows of a course: where its models are, and which findings it wants to be told.
pub struct Course<'c> {
    /// The models of a lesson.
    pub models: &'c dyn Fn(&Path) -> ModelFolder,
    /// Takes out what is not to be told of a file.
    pub policy: &'c mut dyn FnMut(&Path, &mut Vec<Finding>),
    /// Files may have changed: cached settings are read again.
    pub refresh: &'c dyn Fn(),
}

/// What wakes the server.
enum Event {
    Incoming(Incoming),
    Ran(Ran),
}

/// Serves an editor until it says `exit`, or says nothing more. `true` when it did so by the protocol.
///
/// # Errors
/// The answers cannot be written.
pub fn serve<'c>(
    course: Course<'c>,
    mut input: impl BufRead + Send + 'static,
    output: &'c mut dyn Write,
) -> io::Result<bool> {
    let (sender, events) = channel();
    let incoming = sender.clone();
    // It ends with the input, or with the program.
    threads::checking().spawn(move || {
        loop {
            let read = wire::read(&mut input).unwrap_or(Incoming::End);
            let last = matches!(read, Incoming::End);
            if incoming.send(Event::Incoming(read)).is_err() || last {
                return;
            }
        }
    })?;
    Server {
        course,
        output,
        sender,
        state: State::New,
        documents: BTreeMap::new(),
        arounds: Arounds::default(),
        folders: Vec::new(),
        settings: EditorSettings::default(),
        job: None,
        jobs: 0,
    }
    .run(&events)
}

/// Where the conversation is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum State {
    New,
    Open,
    Shut,
}

/// What the person wants.
#[derive(Clone, Copy, Debug)]
struct EditorSettings {
    /// Units behind what texts name.
    units: bool,
    /// Labs are run when a lesson is saved.
    run_on_save: bool,
}

impl Default for EditorSettings {
    fn default() -> EditorSettings {
        EditorSettings { units: false, run_on_save: true }
    }
}

impl EditorSettings {
    /// Takes what is said, and leaves the rest.
    fn take(&mut self, said: &Value) {
        let said = said.get("labspec").unwrap_or(said);
        let flag = |path: &str| said.pointer(path).and_then(Value::as_bool);
        self.units = flag("/inlayHints/units").unwrap_or(self.units);
        self.run_on_save = flag("/runOnSave").unwrap_or(self.run_on_save);
    }
}

/// Why a request is not answered.
struct Refused(ErrorCode, String);

type Answer = Result<Value, Refused>;

fn invalid(what: &str) -> Refused {
    Refused(ErrorCode::InvalidParams, what.to_string())
}

struct Server<'c> {
    course: Course<'c>,
    output: &'c mut dyn Write,
    sender: Sender<Event>,
    state: State,
    documents: BTreeMap<String, Document>,
    arounds: Arounds,
    /// The folders that the editor opened.
    folders: Vec<Opened>,
    settings: EditorSettings,
    job: Option<Job>,
    /// How many checks were started.
    jobs: u64,
}

impl Server<'_> {
    fn run(mut self, events: &Receiver<Event>) -> io::Result<bool> {
        loop {
            // What waits is done first: of many changes that follow each other only the last is looked at.
            let event = match events.try_recv() {
                Ok(event) => event,
                Err(_) => {
                    self.check_documents()?;
                    match events.recv() {
                        Ok(event) => event,
                        Err(_) => return Ok(false),
                    }
                }
            };
            match event {
                Event::Ran(ran) => self.ran(ran)?,
                Event::Incoming(Incoming::End) => return Ok(self.state == State::Shut),
                Event::Incoming(Incoming::Bad(why)) => {
                    let error = json!({"code": ErrorCode::ParseError as i32, "message": why});
                    self.send(json!({"id": null, "error": error}))?;
                }
                Event::Incoming(Incoming::Message(Message::Request(request))) => self.request(request)?,
                Event::Incoming(Incoming::Message(Message::Notification(n))) if n.method == "exit" => {
                    return Ok(self.state == State::Shut);
                }
                Event::Incoming(Incoming::Message(Message::Notification(n))) => {
                    // What is before or behind the conversation is dropped, as the protocol asks.
                    if self.state == State::Open {
                        let told = catch_unwind(AssertUnwindSafe(|| self.notification(&n)));
                        told.unwrap_or(Ok(()))?;
                    }
                }
                // Nothing was asked.
                Event::Incoming(Incoming::Message(Message::Response(_))) => {}
            }
        }
    }

    fn send(&mut self, mut message: Value) -> io::Result<()> {
        message["jsonrpc"] = "2.0".into();
        wire::write(self.output, &message)
    }

    fn notify(&mut self, method: &str, params: &Value) -> io::Result<()> {
        self.send(json!({"method": method, "params": params}))
    }

    fn request(&mut self, request: Request) -> io::Result<()> {
        let Request { id, method, params } = request;
        // Nothing is known that panics. If something does, one answer is lost, and not the editor's work.
        let answer = catch_unwind(AssertUnwindSafe(|| self.answer(&method, &params)));
        let answer = answer.unwrap_or_else(|_| {
            Err(Refused(ErrorCode::InternalError, format!("`{method}` failed; please report this")))
        });
        let id: Value = id_of(&id);
        self.send(match answer {
            Ok(result) => json!({"id": id, "result": result}),
            Err(Refused(code, message)) => {
                json!({"id": id, "error": {"code": code as i32, "message": message}})
            }
        })
    }

    fn answer(&mut self, method: &str, params: &Value) -> Answer {
        match (self.state, method) {
            (State::New, "initialize") => {
                self.initialize(params);
                return Ok(capabilities());
            }
            (State::New, _) => {
                return Err(Refused(ErrorCode::ServerNotInitialized, "`initialize` must come first".into()));
            }
            (State::Shut, _) => {
                return Err(Refused(ErrorCode::InvalidRequest, "the server is shutting down".into()));
            }
            (State::Open, "initialize") => {
                return Err(Refused(ErrorCode::InvalidRequest, "`initialize` can be sent only once".into()));
            }
            (State::Open, "shutdown") => {
                self.state = State::Shut;
                self.stop();
                return Ok(Value::Null);
            }
            (State::Open, _) => {}
        }
        match method {
            "textDocument/completion" => self.completion(params),
            "textDocument/hover" => self.hover(params),
            "textDocument/definition" => self.definition(params),
            "textDocument/references" => self.references(params),
            "textDocument/prepareRename" => self.prepare_rename(params),
            "textDocument/rename" => self.rename(params),
            "textDocument/codeAction" => self.code_action(params),
            "textDocument/inlayHint" => self.inlay_hint(params),
            _ => Err(Refused(ErrorCode::MethodNotFound, format!("unknown method `{method}`"))),
        }
    }

    fn initialize(&mut self, params: &Value) {
        self.state = State::Open;
        let many = params.get("workspaceFolders").and_then(Value::as_array).into_iter().flatten();
        let uris = many.filter_map(|folder| folder.get("uri")?.as_str());
        let opened = |named: PathBuf| Opened { real: places::real(&named), named };
        self.folders = uris.filter_map(places::path_of).map(opened).collect();
        if self.folders.is_empty() {
            let one = params.get("rootUri").and_then(Value::as_str).and_then(places::path_of);
            self.folders.extend(one.map(opened));
        }
        if let Some(said) = params.get("initializationOptions") {
            self.settings.take(said);
        }
    }

    fn notification(&mut self, n: &Notification) -> io::Result<()> {
        let document = n.params.get("textDocument").unwrap_or(&Value::Null);
        let uri = document.get("uri").and_then(Value::as_str).unwrap_or_default();
        let version = document.get("version").and_then(Value::as_i64).unwrap_or_default();
        match n.method.as_str() {
            "textDocument/didOpen" => {
                if let (Some(path), Some(text)) =
                    (places::path_of(uri), document.get("text").and_then(Value::as_str))
                {
                    self.stop_for(uri);
                    let document = Document::new(uri, places::real(&path), text, version);
                    self.refresh();
                    let (path, text) = (document.path.clone(), document.file.text().to_string());
                    self.documents.insert(uri.to_string(), document);
                    self.hold(&path, Some(&text));
                }
            }
            "textDocument/didChange" => {
                self.stop_for(uri);
                let changes = n.params.get("contentChanges").and_then(Value::as_array);
                if let (Some(document), Some(changes)) = (self.documents.get_mut(uri), changes) {
                    document.change(changes, version);
                    let (path, text) = (document.path.clone(), document.file.text().to_string());
                    self.hold(&path, Some(&text));
                }
            }
            "textDocument/didSave" => self.saved(uri),
            "textDocument/didClose" => {
                self.stop_for(uri);
                if let Some(document) = self.documents.remove(uri) {
                    self.refresh();
                    self.hold(&document.path, None);
                    let empty: [Value; 0] = [];
                    return self.notify(
                        "textDocument/publishDiagnostics",
                        &json!({"uri": uri, "diagnostics": empty}),
                    );
                }
            }
            "workspace/didChangeWatchedFiles" => self.changed(&n.params),
            "workspace/didChangeConfiguration" => {
                if let Some(said) = n.params.get("settings") {
                    self.settings.take(said);
                }
            }
            _ => {}
        }
        Ok(())
    }

    /// The text that the editor holds of a file now, or that it holds none; whoever rests on the file is looked at again.
    fn hold(&mut self, path: &Path, text: Option<&str>) {
        let sources = self.arounds.sources();
        let now = || sources.text(path, MAX_FILE, "a lesson or a model").ok();
        let before = now();
        match text {
            Some(text) => self.arounds.overlay.put(path, text),
            None => self.arounds.overlay.close(path),
        }
        if before == now() {
            return;
        }
        match kind_of(path) {
            FileKind::Model => self.forget(),
            _ => self.renew_readers(path),
        }
    }

    /// Lessons that name labs of this one, or link to it, are read again.
    fn renew_readers(&mut self, path: &Path) {
        let sources = self.arounds.sources();
        for document in self.documents.values_mut() {
            let rests = |o: &Other| {
                let other = Path::new(&o.path);
                sources.real(other).as_deref().unwrap_or(other) == path
            };
            let names = |lesson: &Arc<Lesson>| lesson.others.iter().any(rests) || links_to(lesson, path);
            if document.path != path && document.lesson.as_ref().is_some_and(names) {
                document.lesson = None;
                document.stale = true;
            }
        }
    }

    /// The disk is asked again for what is there.
    fn refresh(&mut self) {
        self.arounds.refresh();
        (self.course.refresh)();
    }

    /// Files that somebody else changed. Of one that is open, the editor's text counts.
    fn changed(&mut self, params: &Value) {
        self.refresh();
        let changes = params.get("changes").and_then(Value::as_array).into_iter().flatten();
        let uris = changes.filter_map(|change| change.get("uri")?.as_str());
        let paths: Vec<PathBuf> = uris.filter_map(places::path_of).map(|path| places::real(&path)).collect();
        let is_lesson = |path: &PathBuf| matches!(kind_of(path), FileKind::Lesson | FileKind::Json);
        if paths.is_empty() || !paths.iter().all(is_lesson) {
            return self.forget();
        }
        for path in paths {
            if !self.documents.values().any(|document| document.path == path) {
                self.renew_readers(&path);
            }
        }
    }

    /// Models are compiled anew, and everything is looked at again.
    fn forget(&mut self) {
        self.stop();
        self.arounds.forget();
        for document in self.documents.values_mut() {
            document.blocks.clear();
            document.lesson = None;
            document.stale = true;
        }
    }

    fn saved(&mut self, uri: &str) {
        self.refresh();
        let Some(document) = self.documents.get(uri) else { return };
        match document.kind {
            FileKind::Model => self.forget(),
            FileKind::Lesson | FileKind::Json if self.settings.run_on_save => {
                self.stop();
                let Some(document) = self.documents.get(uri) else { return };
                let around = self.arounds.of(&document.path, self.course.models);
                let around = (around.models.clone(), around.sources.clone());
                let text = (document.file.clone(), document.path.clone());
                let sender = self.sender.clone();
                // Nobody listens any more when the server has ended.
                let done = move |ran| drop(sender.send(Event::Ran(ran)));
                self.jobs += 1;
                self.job = Job::start(self.jobs, uri, document.version, text, around, done);
            }
            _ => {}
        }
    }

    /// What runs found, unless the text is another one by now.
    fn ran(&mut self, ran: Ran) -> io::Result<()> {
        // One that was stopped may have ended just before.
        if self.job.as_ref().is_none_or(|job| job.number != ran.job) {
            return Ok(());
        }
        self.job = None;
        let Some(document) =
            self.documents.get_mut(&ran.uri).filter(|d| d.version == ran.version && !d.stale)
        else {
            return Ok(());
        };
        document.findings = ran.findings;
        (self.course.policy)(&document.path, &mut document.findings);
        self.publish(&ran.uri)
    }

    fn stop(&mut self) {
        if let Some(job) = self.job.take() {
            job.stop();
        }
    }

    fn stop_for(&mut self, uri: &str) {
        if self.job.as_ref().is_some_and(|job| job.uri == uri) {
            self.stop();
        }
    }

    /// Looks at every document that was changed.
    fn check_documents(&mut self) -> io::Result<()> {
        let stale: Vec<String> = self.documents.values().filter(|d| d.stale).map(|d| d.uri.clone()).collect();
        for uri in stale {
            let Some(document) = self.documents.get_mut(&uri) else { continue };
            let around = self.arounds.of(&document.path, self.course.models);
            let looked = catch_unwind(AssertUnwindSafe(|| check_document(document, around)));
            document.stale = false;
            if looked.is_err() {
                document.findings.clear();
            }
            (self.course.policy)(&document.path, &mut document.findings);
            self.publish(&uri)?;
        }
        Ok(())
    }

    fn publish(&mut self, uri: &str) -> io::Result<()> {
        let Some(document) = self.documents.get(uri) else { return Ok(()) };
        let told: Vec<Value> = document.findings.iter().map(|f| diagnostic(f, &document.file, uri)).collect();
        let params = json!({"uri": uri, "version": document.version, "diagnostics": told});
        self.notify("textDocument/publishDiagnostics", &params)
    }

    /// The document that a request is about, and the byte of its place.
    fn place(&mut self, params: &Value) -> Result<(String, usize), Refused> {
        let document = self.document(params)?;
        let place = params.get("position").and_then(|p| places::byte(document.file.text(), p));
        let byte = place.ok_or_else(|| invalid("there is no such position"))?;
        Ok((document.uri.clone(), byte))
    }

    fn document(&self, params: &Value) -> Result<&Document, Refused> {
        let uri = params.pointer("/textDocument/uri").and_then(Value::as_str);
        uri.and_then(|uri| self.documents.get(uri)).ok_or_else(|| invalid("this document is not open"))
    }

    fn completion(&mut self, params: &Value) -> Answer {
        let (uri, byte) = self.place(params)?;
        let Some(document) = self.documents.get_mut(&uri) else { return Ok(Value::Null) };
        let around = self.arounds.of(&document.path, self.course.models);
        Ok(completions(document, around, byte))
    }

    fn hover(&mut self, params: &Value) -> Answer {
        let (uri, byte) = self.place(params)?;
        let Some(document) = self.documents.get_mut(&uri) else { return Ok(Value::Null) };
        let around = self.arounds.of(&document.path, self.course.models);
        Ok(hover(document, around, byte).unwrap_or_default())
    }

    /// The name at a place; and whether the place is where the element gets it.
    fn name(&mut self, uri: &str, byte: usize) -> Option<(Name, bool)> {
        let document = self.documents.get_mut(uri)?;
        if names::is_model(document) {
            return names::name_in_model(&document.file, &document.path, byte);
        }
        let around = self.arounds.of(&document.path, self.course.models);
        let lesson = lesson(document, around)?;
        names::name_in_lesson(&lesson, &document.path, &around.models, byte).map(|name| (name, false))
    }

    fn ground(&self) -> Ground<'_> {
        let (open, overlay) = (&self.documents, &self.arounds.overlay);
        Ground { open, folders: &self.folders, models_of: self.course.models, overlay }
    }

    fn places_of(&self, name: &Name) -> Places {
        names::places_of(name, &self.ground())
    }

    fn definition(&mut self, params: &Value) -> Answer {
        let (uri, byte) = self.place(params)?;
        if let Some((name, defines)) = self.name(&uri, byte) {
            // From where the element gets its name, the way leads back to those who use it.
            let places = self.places_of(&name);
            return Ok(names::locations(
                places.spots.iter().filter(|spot| spot.defines != defines),
                &self.ground(),
            ));
        }
        let Some(document) = self.documents.get_mut(&uri) else { return Ok(Value::Null) };
        let around = self.arounds.of(&document.path, self.course.models);
        let Some(lesson) = lesson(document, around) else { return Ok(Value::Null) };
        let named = names::model_named(&lesson, &around.models, byte);
        let uri = |path: PathBuf| uri_of(&path, &self.documents, &self.folders);
        Ok(named.map_or(Value::Null, |path| names::beginning(&uri(path))))
    }

    fn references(&mut self, params: &Value) -> Answer {
        let (uri, byte) = self.place(params)?;
        let Some((name, _)) = self.name(&uri, byte) else { return Ok(Value::Null) };
        let also = params.pointer("/context/includeDeclaration").and_then(Value::as_bool).unwrap_or(true);
        let places = self.places_of(&name);
        Ok(names::locations(places.spots.iter().filter(|spot| also || !spot.defines), &self.ground()))
    }

    fn prepare_rename(&mut self, params: &Value) -> Answer {
        let (uri, byte) = self.place(params)?;
        let Some((name, _)) = self.name(&uri, byte) else { return Ok(Value::Null) };
        let document = self.document(params)?;
        Ok(json!({"range": places::range(&document.file, &name.span), "placeholder": name.name}))
    }

    fn rename(&mut self, params: &Value) -> Answer {
        let (uri, byte) = self.place(params)?;
        let new = params
            .get("newName")
            .and_then(Value::as_str)
            .ok_or_else(|| invalid("the new name is missing"))?;
        let Some((name, _)) = self.name(&uri, byte) else {
            return Err(Refused(ErrorCode::RequestFailed, "there is no name of the model here".into()));
        };
        let failed = |why: String| Refused(ErrorCode::RequestFailed, why);
        let taken = Name { name: new.to_string(), ..name.clone() };
        if new != name.name && self.places_of(&taken).spots.iter().any(|spot| spot.defines) {
            return Err(failed(format!("a {} `{new}` already exists", name.noun)));
        }
        rename(&name, &self.places_of(&name), new, &self.ground()).map_err(failed)
    }

    fn code_action(&mut self, params: &Value) -> Answer {
        let document = self.document(params)?;
        let span = params.get("range").and_then(|range| places::span(document.file.text(), range));
        let span = span.ok_or_else(|| invalid("there is no such range"))?;
        let only = params.pointer("/context/only").and_then(Value::as_array).into_iter().flatten();
        let only: Vec<String> = only.filter_map(|kind| kind.as_str().map(String::from)).collect();
        // What is offered belongs to the text as it is.
        if document.stale {
            let uri = document.uri.clone();
            self.check_documents().map_err(|e| Refused(ErrorCode::InternalError, format!("{uri}: {e}")))?;
        }
        let uri = self.document(params)?.uri.clone();
        let Some(document) = self.documents.get_mut(&uri) else { return Ok(Value::Null) };
        let around = self.arounds.of(&document.path, self.course.models);
        let lesson = lesson(document, around);
        Ok(actions(document, lesson.as_deref(), &span, &only, &around.models))
    }

    fn inlay_hint(&mut self, params: &Value) -> Answer {
        let empty: [Value; 0] = [];
        if !self.settings.units {
            return Ok(json!(empty));
        }
        let document = self.document(params)?;
        let span = params.get("range").and_then(|range| places::span(document.file.text(), range));
        let span = span.ok_or_else(|| invalid("there is no such range"))?;
        let uri = document.uri.clone();
        let Some(document) = self.documents.get_mut(&uri) else { return Ok(Value::Null) };
        let around = self.arounds.of(&document.path, self.course.models);
        Ok(hints(document, around, &span))
    }
}

/// An id as it came.
fn id_of(id: &RequestId) -> Value {
    serde_json::to_value(id).unwrap_or_default()
}

/// What this server can do.
fn capabilities() -> Value {
    json!({
        "capabilities": {
            "positionEncoding": "utf-16",
            "textDocumentSync": {"openClose": true, "change": 2, "save": {"includeText": false}},
            "completionProvider": {"triggerCharacters": [".", "\"", "'", "("]},
            "hoverProvider": true,
            "definitionProvider": true,
            "referencesProvider": true,
            "renameProvider": {"prepareProvider": true},
            "codeActionProvider": {"codeActionKinds": ["quickfix", "source.fixAll"]},
            "inlayHintProvider": true,
        },
        "serverInfo": {"name": "labspec", "version": env!("CARGO_PKG_VERSION")},
    })
}
