//! What an editor reports: documents that were opened, changed, saved and closed, files and settings that changed. Nothing of this
//! is answered; what cannot be read is dropped.

use super::convert;
use super::documents::OpenDocument;
use super::state::ServerState;
use labspec::spec::{FileKind, kind_of};
use lsp_server::Notification as Message;
use lsp_types::notification::{
    DidChangeConfiguration, DidChangeTextDocument, DidChangeWatchedFiles, DidCloseTextDocument,
    DidOpenTextDocument, DidSaveTextDocument, Notification,
};
use lsp_types::{
    DidChangeConfigurationParams, DidChangeTextDocumentParams, DidChangeWatchedFilesParams,
    DidCloseTextDocumentParams, DidOpenTextDocumentParams, DidSaveTextDocumentParams,
    PublishDiagnosticsParams,
};
use serde::de::DeserializeOwned;
use serde_json::Value;
use std::io;
use std::path::PathBuf;

/// Takes a notification.
///
/// # Errors
/// What it makes the server send cannot be written.
pub(super) fn handle(state: &mut ServerState<'_>, notification: Message) -> io::Result<()> {
    let Message { method, params } = notification;
    match method.as_str() {
        DidOpenTextDocument::METHOD => with_params(params, |p| did_open(state, p)),
        DidChangeTextDocument::METHOD => with_params(params, |p| did_change(state, p)),
        DidSaveTextDocument::METHOD => with_params(params, |p| did_save(state, &p)),
        DidCloseTextDocument::METHOD => with_params(params, |p| did_close(state, p)),
        DidChangeWatchedFiles::METHOD => with_params(params, |p| did_change_files(state, &p)),
        DidChangeConfiguration::METHOD => with_params(params, |p: DidChangeConfigurationParams| {
            state.settings.update(p.settings);
            Ok(())
        }),
        _ => Ok(()),
    }
}

fn with_params<P: DeserializeOwned>(
    params: Value,
    handler: impl FnOnce(P) -> io::Result<()>,
) -> io::Result<()> {
    serde_json::from_value(params).map_or(Ok(()), handler)
}

fn did_open(state: &mut ServerState<'_>, params: DidOpenTextDocumentParams) -> io::Result<()> {
    let opened = params.text_document;
    let Some(path) = convert::path_of_uri(&opened.uri) else { return Ok(()) };
    let key = opened.uri.as_str().to_string();
    state.cancel_runs_of(&key);
    let path = convert::resolve_links(&path);
    let document = OpenDocument::new(opened.uri, path.clone(), &opened.text, opened.version);
    state.refresh();
    let text = document.file.text().to_string();
    state.documents.insert(key, document);
    state.set_text(&path, Some(&text));
    Ok(())
}

fn did_change(state: &mut ServerState<'_>, params: DidChangeTextDocumentParams) -> io::Result<()> {
    let uri = params.text_document.uri;
    state.cancel_runs_of(uri.as_str());
    if let Some(document) = state.documents.get_mut(uri.as_str()) {
        document.change(&params.content_changes, params.text_document.version);
        let (path, text) = (document.path.clone(), document.file.text().to_string());
        state.set_text(&path, Some(&text));
    }
    Ok(())
}

fn did_save(state: &mut ServerState<'_>, params: &DidSaveTextDocumentParams) -> io::Result<()> {
    state.refresh();
    let uri = params.text_document.uri.as_str();
    match state.documents.get(uri).map(|document| document.kind) {
        Some(FileKind::Model) => state.recompile_models(),
        Some(FileKind::Lesson | FileKind::Json) if state.settings.run_on_save => state.start_runs(uri),
        _ => {}
    }
    Ok(())
}

fn did_close(state: &mut ServerState<'_>, params: DidCloseTextDocumentParams) -> io::Result<()> {
    let uri = params.text_document.uri;
    state.cancel_runs_of(uri.as_str());
    let Some(document) = state.documents.remove(uri.as_str()) else { return Ok(()) };
    state.refresh();
    state.set_text(&document.path, None);
    state.publish_diagnostics(PublishDiagnosticsParams { uri, diagnostics: Vec::new(), version: None })
}

/// Files that somebody else changed. Of one that is open, the editor's text counts.
fn did_change_files(state: &mut ServerState<'_>, params: &DidChangeWatchedFilesParams) -> io::Result<()> {
    state.refresh();
    let paths = params.changes.iter().filter_map(|change| convert::path_of_uri(&change.uri));
    let paths: Vec<PathBuf> = paths.map(|path| convert::resolve_links(&path)).collect();
    let is_lesson = |path: &PathBuf| matches!(kind_of(path), FileKind::Lesson | FileKind::Json);
    if paths.is_empty() || !paths.iter().all(is_lesson) {
        state.recompile_models();
        return Ok(());
    }
    for path in paths {
        if !state.documents.values().any(|document| document.path == path) {
            state.mark_readers_stale(&path);
        }
    }
    Ok(())
}
