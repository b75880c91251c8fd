//! The state of the server: documents, the models around them, settings, and the check in progress. It belongs to one thread.

use super::context::{ModelContexts, WorkspaceRoot};
use super::convert;
use super::course::{self, CourseFiles};
use super::diagnostic::diagnostic;
use super::documents::OpenDocument;
use super::edits::workspace_edit;
use super::initialize::{EditorSettings, EditorSupport};
use super::proofs::{FinishedProof, ProofRequest, RunningProof};
use super::runs::{FinishedJob, RunningCheck};
use super::wire::{self, Incoming};
use labspec::finding::Finding;
use labspec::lint::{ModelFolder, links_to};
use labspec::source::MAX_FILE;
use labspec::spec::{Conventions, FileKind, Lesson, kind_of};
use labspec_assist::{Context, RunValues};
use lsp_types::notification::{LogMessage, Notification, PublishDiagnostics, ShowMessage};
use lsp_types::request::{ApplyWorkspaceEdit, CodeLensRefresh, Request};
use lsp_types::{
    ApplyWorkspaceEditParams, LogMessageParams, MessageType, PublishDiagnosticsParams, ShowMessageParams, Uri,
};
use serde::Serialize;
use serde_json::Value;
use std::collections::BTreeMap;
use std::io::{self, Write};
use std::ops::Range;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;
use std::sync::Arc;
use std::sync::mpsc::Sender;

/// The callbacks that define a course: the folders of models, and which findings are reported.
pub struct CourseConfig<'c> {
    /// Returns the folder of models of a lesson.
    pub models: &'c dyn Fn(&Path) -> ModelFolder,
    /// Removes the findings of a file that are not reported.
    pub policy: &'c mut dyn FnMut(&Path, &mut Vec<Finding>),
    /// Returns how the texts of a lesson are read.
    pub conventions: &'c dyn Fn(&Path) -> Conventions,
    /// Called when files may have changed, to read cached settings again.
    pub refresh: &'c dyn Fn(),
}

/// An event that the server handles.
pub(super) enum ServerEvent {
    Incoming(Incoming),
    Finished(FinishedJob),
    Proved(FinishedProof),
}

/// The phase of the session.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Phase {
    /// Before `initialize`.
    Uninitialized,
    Running,
    /// After `shutdown`.
    ShutDown,
}

pub(super) struct ServerState<'c> {
    pub(super) course: CourseConfig<'c>,
    output: &'c mut dyn Write,
    sender: Sender<ServerEvent>,
    pub(super) phase: Phase,
    /// The open documents, by URI.
    pub(super) documents: BTreeMap<String, OpenDocument>,
    pub(super) contexts: ModelContexts,
    course_files: CourseFiles,
    /// The folders that are open in the editor.
    pub(super) folders: Vec<WorkspaceRoot>,
    pub(super) settings: EditorSettings,
    /// What the editor can do.
    pub(super) editor: EditorSupport,
    job: Option<RunningCheck>,
    /// The documents whose runs start after those of the current check.
    waiting: Vec<String>,
    proof: Option<RunningProof>,
    /// The number of checks and searches that were started.
    jobs: u64,
    /// The number of requests that were sent to the editor.
    requests: u64,
}

impl<'c> ServerState<'c> {
    pub(super) fn new(
        course: CourseConfig<'c>,
        output: &'c mut dyn Write,
        sender: Sender<ServerEvent>,
    ) -> Self {
        ServerState {
            course,
            output,
            sender,
            phase: Phase::Uninitialized,
            documents: BTreeMap::new(),
            contexts: ModelContexts::default(),
            course_files: CourseFiles::default(),
            folders: Vec::new(),
            settings: EditorSettings::default(),
            editor: EditorSupport::default(),
            job: None,
            waiting: Vec::new(),
            proof: None,
            jobs: 0,
            requests: 0,
        }
    }

    /// Sends a message.
    ///
    /// # Errors
    /// The message cannot be written.
    pub(super) fn send(&mut self, message: &impl Serialize) -> io::Result<()> {
        wire::write(self.output, message)
    }

    pub(super) fn publish_diagnostics(&mut self, params: PublishDiagnosticsParams) -> io::Result<()> {
        let params = serde_json::to_value(params)?;
        self.send(&lsp_server::Notification { method: PublishDiagnostics::METHOD.to_string(), params })
    }

    /// Reports a problem to the user in the log of the editor.
    ///
    /// # Errors
    /// The message cannot be written.
    pub(super) fn log(&mut self, message: String) -> io::Result<()> {
        let params = LogMessageParams { typ: MessageType::WARNING, message };
        let params = serde_json::to_value(params)?;
        self.send(&lsp_server::Notification { method: LogMessage::METHOD.to_string(), params })
    }

    /// Shows a message to the user.
    fn show(&mut self, message: String) -> io::Result<()> {
        let params = serde_json::to_value(ShowMessageParams { typ: MessageType::INFO, message })?;
        self.send(&lsp_server::Notification { method: ShowMessage::METHOD.to_string(), params })
    }

    /// Sends a request to the editor. Nothing depends on its response.
    fn request(&mut self, method: &str, params: Value) -> io::Result<()> {
        self.requests += 1;
        let id = lsp_server::RequestId::from(format!("labspec-{}", self.requests));
        self.send(&lsp_server::Request { id, method: method.to_string(), params })
    }

    /// Applies settings from the editor. Invalid settings are logged.
    ///
    /// # Errors
    /// The log message cannot be written.
    pub(super) fn update_settings(&mut self, message: Value) -> io::Result<()> {
        match self.settings.update(message) {
            Ok(()) => Ok(()),
            Err(e) => self.log(format!("the settings of labspec are invalid, so nothing changes: {e}")),
        }
    }

    /// Sets the folders that are open in the editor.
    pub(super) fn open_folders(&mut self, uris: &[&Uri]) {
        let paths = uris.iter().filter_map(|uri| convert::path_of_uri(uri));
        self.folders =
            paths.map(|named| WorkspaceRoot { real: convert::resolve_links(&named), named }).collect();
        self.course_files.forget();
    }

    /// Returns an open document with the models and sources that it uses.
    pub(super) fn document_in_context(&mut self, uri: &Uri) -> Option<(&mut OpenDocument, &mut Context)> {
        let document = self.documents.get_mut(uri.as_str())?;
        let context = self.contexts.model_context(&document.content.path, self.course.models);
        Some((document, context))
    }

    /// Sets the text of a file in the editor, or `None` if it is not open. Documents that depend on the file are checked again.
    pub(super) fn set_text(&mut self, path: &Path, text: Option<&str>) {
        let sources = self.contexts.sources();
        let current = || sources.text(path, MAX_FILE, "a lesson or a model").ok();
        let before = current();
        match text {
            Some(text) => self.contexts.overlay.put(path, text),
            None => self.contexts.overlay.close(path),
        }
        if before == current() {
            return;
        }
        match kind_of(path) {
            FileKind::Model => self.recompile_models(),
            _ => self.mark_readers_stale(path),
        }
    }

    /// Marks lessons that use labs of this one, or link to it, to be parsed again.
    pub(super) fn mark_readers_stale(&mut self, path: &Path) {
        let sources = self.contexts.sources();
        for document in self.documents.values_mut() {
            let is_this = |other: &Path| sources.real(other).as_deref().unwrap_or(other) == path;
            let reads = |lesson: &Arc<Lesson>| {
                lesson.others.iter().any(|other| is_this(Path::new(&other.path)))
                    || lesson.data.iter().any(|file| is_this(&file.path))
                    || links_to(lesson, path)
            };
            if document.content.path != path && document.content.lesson.as_ref().is_some_and(reads) {
                document.content.lesson = None;
                document.stale = true;
            }
        }
    }

    /// Reads cached information about files again.
    pub(super) fn refresh(&mut self) {
        self.contexts.refresh();
        self.course_files.refresh();
        (self.course.refresh)();
    }

    /// Recompiles models, and checks everything again.
    pub(super) fn recompile_models(&mut self) {
        self.cancel_runs();
        self.contexts.forget();
        for document in self.documents.values_mut() {
            document.content.forget_models();
            document.values = RunValues::default();
            document.stale = true;
        }
    }

    /// Runs the labs of a document on a separate thread, after the check of another document if there is one.
    pub(super) fn start_runs(&mut self, uri: &str) {
        self.waiting.retain(|other| other != uri);
        if self.job.as_ref().is_some_and(|job| job.uri != uri) {
            return self.waiting.push(uri.to_string());
        }
        if let Some(job) = self.job.take() {
            job.stop();
        }
        self.run_now(uri);
    }

    /// Starts the check of the next document that waits.
    fn run_next(&mut self) {
        while self.job.is_none() && !self.waiting.is_empty() {
            let uri = self.waiting.remove(0);
            self.run_now(&uri);
        }
    }

    fn run_now(&mut self, uri: &str) {
        let Some(document) = self.documents.get(uri) else { return };
        let context = self.contexts.model_context(&document.content.path, self.course.models);
        let context = (context.models.clone(), context.sources.clone());
        let text = document.content.text();
        let sender = self.sender.clone();
        // The channel is closed if the server has ended.
        let done = move |finished| drop(sender.send(ServerEvent::Finished(finished)));
        self.jobs += 1;
        self.job = RunningCheck::start(self.jobs, uri, document.version, text, context, done);
    }

    /// Stores the findings of runs, unless the text has changed.
    pub(super) fn finish_runs(&mut self, finished: FinishedJob) -> io::Result<()> {
        // A cancelled check may have finished just before.
        if self.job.as_ref().is_none_or(|job| job.number != finished.job) {
            return Ok(());
        }
        self.job = None;
        self.run_next();
        let Some(document) =
            self.documents.get_mut(&finished.uri).filter(|d| d.version == finished.version && !d.stale)
        else {
            return Ok(());
        };
        let Some((findings, values)) = finished.outcome else { return Ok(()) };
        document.content.findings = findings;
        document.values = values;
        (self.course.policy)(&document.content.path, &mut document.content.findings);
        self.publish(&finished.uri)?;
        match self.editor.refreshes_lenses {
            true => self.request(CodeLensRefresh::METHOD, Value::Null),
            false => Ok(()),
        }
    }

    /// Searches claims for numbers of a document on a separate thread.
    pub(super) fn start_proof(&mut self, uri: &str, numbers: Vec<Range<usize>>) {
        self.cancel_proof();
        let Some(document) = self.documents.get(uri) else { return };
        let context = self.contexts.model_context(&document.content.path, self.course.models);
        let context = (context.models.clone(), context.sources.clone());
        self.jobs += 1;
        let request = ProofRequest {
            job: self.jobs,
            uri: uri.to_string(),
            version: document.version,
            text: document.content.text(),
            numbers,
        };
        let sender = self.sender.clone();
        // The channel is closed if the server has ended.
        let done = move |finished| drop(sender.send(ServerEvent::Proved(finished)));
        self.proof = RunningProof::start(request, context, done);
    }

    /// Asks the editor to apply the claims that were found, unless the text has changed.
    pub(super) fn finish_proof(&mut self, finished: FinishedProof) -> io::Result<()> {
        if self.proof.as_ref().is_none_or(|proof| proof.number != finished.job) {
            return Ok(());
        }
        self.proof = None;
        let Some(document) = self.documents.get(&finished.uri).filter(|d| d.version == finished.version)
        else {
            return Ok(());
        };
        match finished.found {
            Err(why) => self.show(format!("nothing is claimed: {why}")),
            Ok(edit) => {
                let label = Some("labspec: claim numbers".to_string());
                let edit = workspace_edit(document, edit);
                let params = serde_json::to_value(ApplyWorkspaceEditParams { label, edit })?;
                self.request(ApplyWorkspaceEdit::METHOD, params)
            }
        }
    }

    /// Cancels the runs of all checks and searches.
    pub(super) fn cancel_runs(&mut self) {
        self.waiting.clear();
        if let Some(job) = self.job.take() {
            job.stop();
        }
        self.cancel_proof();
    }

    fn cancel_proof(&mut self) {
        if let Some(proof) = self.proof.take() {
            proof.stop();
        }
    }

    pub(super) fn cancel_runs_of(&mut self, uri: &str) {
        self.waiting.retain(|other| other != uri);
        if let Some(job) = self.job.take_if(|job| job.uri == uri) {
            job.stop();
            self.run_next();
        }
        if let Some(proof) = self.proof.take_if(|proof| proof.uri == uri) {
            proof.stop();
        }
    }

    /// Checks all changed documents.
    pub(super) fn check_documents(&mut self) -> io::Result<()> {
        if !self.course_files.are_read() {
            for document in self.documents.values_mut() {
                let conventions = (self.course.conventions)(&document.content.path);
                document.stale |= document.content.set_conventions(conventions);
            }
        }
        let stale = self.documents.iter().filter(|(_, document)| document.stale);
        let stale: Vec<String> = stale.map(|(uri, _)| uri.clone()).collect();
        for uri in &stale {
            let Some(document) = self.documents.get_mut(uri) else { continue };
            let context = self.contexts.model_context(&document.content.path, self.course.models);
            let checked = catch_unwind(AssertUnwindSafe(|| document.content.check(context)));
            document.stale = false;
            if checked.is_err() {
                document.content.findings.clear();
            }
            (self.course.policy)(&document.content.path, &mut document.content.findings);
        }
        if stale.is_empty() && self.course_files.are_read() {
            return Ok(());
        }
        let changed = {
            let ServerState { course_files, documents, folders, course, .. } = self;
            course::update(course_files, documents, folders, course.policy)
        };
        let others = changed.into_iter().filter(|uri| !stale.contains(uri));
        stale.iter().cloned().chain(others).collect::<Vec<_>>().iter().try_for_each(|uri| self.publish(uri))
    }

    /// Sends the findings of a document.
    fn publish(&mut self, uri: &str) -> io::Result<()> {
        let Some(OpenDocument { uri, content, version, .. }) = self.documents.get(uri) else {
            return Ok(());
        };
        let diagnostics = content.all_findings().iter().map(|f| diagnostic(f, &content.file, uri)).collect();
        let params = PublishDiagnosticsParams { uri: uri.clone(), diagnostics, version: Some(*version) };
        self.publish_diagnostics(params)
    }
}
