//! Notifications of the editor: documents that were opened, changed, saved and closed, and files and settings that changed.
//! Notifications have no response; invalid ones are logged.

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
    PublishDiagnosticsParams, TextDocumentIdentifier,
};
use serde::de::DeserializeOwned;
use serde_json::Value;
use std::io;
use std::path::PathBuf;

/// Handles a notification.
///
/// # Errors
/// A resulting message cannot be written.
pub(super) fn handle(state: &mut ServerState<'_>, notification: Message) -> io::Result<()> {
    let Message { method, mut params } = notification;
    convert::encode_uris(&mut params);
    match method.as_str() {
        DidOpenTextDocument::METHOD => with_params(state, &method, params, did_open),
        DidChangeTextDocument::METHOD => {
            let uri = params["textDocument"]["uri"].as_str().unwrap_or_default().to_string();
            match serde_json::from_value(params) {
                Ok(params) => did_change(state, params),
                Err(e) => lose(state, &uri, &e),
            }
        }
        DidSaveTextDocument::METHOD => with_params(state, &method, params, did_save),
        DidCloseTextDocument::METHOD => with_params(state, &method, params, did_close),
        DidChangeWatchedFiles::METHOD => with_params(state, &method, params, did_change_files),
        DidChangeConfiguration::METHOD => {
            with_params(state, &method, params, |state, p: DidChangeConfigurationParams| {
                state.update_settings(p.settings)
            })
        }
        _ => Ok(()),
    }
}

/// Parses the parameters for a handler. Invalid parameters are logged.
fn with_params<P: DeserializeOwned>(
    state: &mut ServerState<'_>,
    method: &str,
    params: Value,
    handler: impl FnOnce(&mut ServerState<'_>, P) -> io::Result<()>,
) -> io::Result<()> {
    match serde_json::from_value(params) {
        Ok(params) => handler(state, params),
        Err(e) => state.log(format!("`{method}` is ignored, because its parameters are invalid: {e}")),
    }
}

/// Closes a document after an invalid change: the server's text differs from the editor's, so that an edit
/// would damage the lesson.
fn lose(state: &mut ServerState<'_>, uri: &str, e: &serde_json::Error) -> io::Result<()> {
    state.log(format!("a change of `{uri}` cannot be read: {e}. Close and open it again to see findings"))?;
    match uri.parse() {
        Ok(uri) => {
            did_close(state, DidCloseTextDocumentParams { text_document: TextDocumentIdentifier { uri } })
        }
        Err(_) => Ok(()),
    }
}

fn did_open(state: &mut ServerState<'_>, params: DidOpenTextDocumentParams) -> io::Result<()> {
    let opened = params.text_document;
    let Some(path) = convert::path_of_uri(&opened.uri) else { return Ok(()) };
    let key = opened.uri.as_str().to_string();
    state.cancel_runs_of(&key);
    let path = convert::resolve_links(&path);
    let document = OpenDocument::new(opened.uri, path.clone(), &opened.text, opened.version);
    state.refresh();
    let text = document.content.file.text().to_string();
    state.documents.insert(key, document);
    state.set_text(&path, Some(&text));
    Ok(())
}

fn did_change(state: &mut ServerState<'_>, params: DidChangeTextDocumentParams) -> io::Result<()> {
    let uri = params.text_document.uri;
    state.cancel_runs_of(uri.as_str());
    if let Some(document) = state.documents.get_mut(uri.as_str()) {
        document.change(&params.content_changes, params.text_document.version);
        let (path, text) = (document.content.path.clone(), document.content.file.text().to_string());
        state.set_text(&path, Some(&text));
    }
    Ok(())
}

fn did_save(state: &mut ServerState<'_>, params: DidSaveTextDocumentParams) -> io::Result<()> {
    state.refresh();
    let uri = params.text_document.uri.as_str();
    match state.documents.get(uri).map(|document| document.content.kind) {
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
    state.set_text(&document.content.path, None);
    state.publish_diagnostics(PublishDiagnosticsParams { uri, diagnostics: Vec::new(), version: None })
}

/// Files that other programs changed. If a file is open, the text of the editor takes precedence.
fn did_change_files(state: &mut ServerState<'_>, params: DidChangeWatchedFilesParams) -> io::Result<()> {
    state.refresh();
    let paths = params.changes.iter().filter_map(|change| convert::path_of_uri(&change.uri));
    let paths: Vec<PathBuf> = paths.map(|path| convert::resolve_links(&path)).collect();
    let is_lesson = |path: &PathBuf| matches!(kind_of(path), FileKind::Lesson | FileKind::Json);
    if paths.is_empty() || !paths.iter().all(is_lesson) {
        state.recompile_models();
        return Ok(());
    }
    for path in paths {
        if !state.documents.values().any(|document| document.content.path == path) {
            state.mark_readers_stale(&path);
        }
    }
    Ok(())
}
