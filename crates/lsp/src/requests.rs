//! Requests of the editor, and their dispatch.

use super::actions::{code_actions, proof_action};
use super::answers::{Answer, byte_at, error, not_open, open_document};
use super::commands::execute_command;
use super::complete::completion_items;
use super::convert;
use super::document_requests::{
    format_document, format_range, list_folds, list_inlay_hints, list_lenses, list_symbols,
};
use super::hover::hover_at_byte;
use super::initialize::{ClientSetup, initialize_result};
use super::names::{self, Occurrences, QualifiedName, SearchScope};
use super::rename::{FileEdits, rename};
use super::signature::signature_at_byte;
use super::state::{Phase, ServerState};
use lsp_server::{ErrorCode, Response};
use lsp_types::request::{
    CodeActionRequest, CodeLensRequest, Completion, DocumentSymbolRequest, ExecuteCommand,
    FoldingRangeRequest, Formatting, GotoDefinition, HoverRequest, Initialize, InlayHintRequest,
    PrepareRenameRequest, RangeFormatting, References, Rename, Request, Shutdown, SignatureHelpRequest,
};
use lsp_types::{
    CodeActionKind, CodeActionOrCommand, CodeActionParams, CompletionItem, CompletionParams,
    GotoDefinitionParams, GotoDefinitionResponse, Hover, HoverParams, InitializeResult, Location,
    PrepareRenameResponse, ReferenceContext, RenameParams, SignatureHelp, SignatureHelpParams,
    TextDocumentPositionParams,
};
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use serde_json::Value;
use std::panic::{AssertUnwindSafe, catch_unwind};

/// Returns the response to any request.
pub(super) fn answer(state: &mut ServerState<'_>, request: lsp_server::Request) -> Response {
    let lsp_server::Request { id, method, params } = request;
    // No panic is known here. If one occurs, only this response is lost, and not the user's work.
    let answer = catch_unwind(AssertUnwindSafe(|| dispatch(state, &method, params)));
    let failed = || Err(error(ErrorCode::InternalError, format!("`{method}` failed; please report this")));
    match answer.unwrap_or_else(|_| failed()) {
        Ok(result) => Response { id, result: Some(result), error: None },
        Err(error) => Response { id, result: None, error: Some(error) },
    }
}

fn dispatch(state: &mut ServerState<'_>, method: &str, params: Value) -> Answer<Value> {
    match (state.phase, method) {
        (Phase::Uninitialized, Initialize::METHOD) => return respond(state, method, params, initialize),
        (Phase::Uninitialized, _) => {
            return Err(error(ErrorCode::ServerNotInitialized, "`initialize` must come first"));
        }
        (Phase::ShutDown, _) => {
            return Err(error(ErrorCode::InvalidRequest, "the server is shutting down"));
        }
        (Phase::Running, Initialize::METHOD) => {
            return Err(error(ErrorCode::InvalidRequest, "`initialize` can be sent only once"));
        }
        // This request has no parameters.
        (Phase::Running, Shutdown::METHOD) => {
            state.phase = Phase::ShutDown;
            state.cancel_runs();
            return Ok(Value::Null);
        }
        (Phase::Running, _) => {}
    }
    match method {
        Completion::METHOD => respond(state, method, params, complete_at),
        HoverRequest::METHOD => respond(state, method, params, hover_at),
        GotoDefinition::METHOD => respond(state, method, params, find_definition),
        References::METHOD => respond(state, method, params, find_references),
        PrepareRenameRequest::METHOD => respond(state, method, params, prepare_rename),
        Rename::METHOD => respond(state, method, params, rename_at),
        CodeActionRequest::METHOD => respond(state, method, params, list_code_actions),
        SignatureHelpRequest::METHOD => respond(state, method, params, sign_at),
        InlayHintRequest::METHOD => respond(state, method, params, list_inlay_hints),
        DocumentSymbolRequest::METHOD => respond(state, method, params, list_symbols),
        FoldingRangeRequest::METHOD => respond(state, method, params, list_folds),
        Formatting::METHOD => respond(state, method, params, format_document),
        RangeFormatting::METHOD => respond(state, method, params, format_range),
        CodeLensRequest::METHOD => respond(state, method, params, list_lenses),
        ExecuteCommand::METHOD => respond(state, method, params, execute_command),
        _ => Err(error(ErrorCode::MethodNotFound, format!("unknown method `{method}`"))),
    }
}

/// Parses the parameters, and serializes the result of the handler.
fn respond<P: DeserializeOwned, R: Serialize>(
    state: &mut ServerState<'_>,
    method: &str,
    mut params: Value,
    handler: impl FnOnce(&mut ServerState<'_>, P) -> Answer<R>,
) -> Answer<Value> {
    convert::encode_uris(&mut params);
    let params = serde_json::from_value(params).map_err(|e| {
        error(ErrorCode::InvalidParams, format!("the parameters of `{method}` are invalid: {e}"))
    })?;
    serde_json::to_value(handler(state, params)?).map_err(|e| {
        error(ErrorCode::InternalError, format!("the answer to `{method}` cannot be written: {e}"))
    })
}

fn initialize(state: &mut ServerState<'_>, setup: ClientSetup) -> Answer<InitializeResult> {
    state.phase = Phase::Running;
    state.editor = setup.support();
    state.open_folders(&setup.roots());
    if let Some(settings) = setup.initialization_options {
        state.update_settings(settings).map_err(|e| error(ErrorCode::InternalError, e.to_string()))?;
    }
    Ok(initialize_result())
}

fn complete_at(state: &mut ServerState<'_>, params: CompletionParams) -> Answer<Vec<CompletionItem>> {
    let position = params.text_document_position;
    let byte = byte_at(state, &position)?;
    let (document, context) = state.document_in_context(&position.text_document.uri).ok_or_else(not_open)?;
    Ok(completion_items(document, context, byte))
}

fn hover_at(state: &mut ServerState<'_>, params: HoverParams) -> Answer<Option<Hover>> {
    let position = params.text_document_position_params;
    let byte = byte_at(state, &position)?;
    let (document, context) = state.document_in_context(&position.text_document.uri).ok_or_else(not_open)?;
    Ok(hover_at_byte(document, context, byte))
}

fn sign_at(state: &mut ServerState<'_>, params: SignatureHelpParams) -> Answer<Option<SignatureHelp>> {
    let position = params.text_document_position_params;
    let byte = byte_at(state, &position)?;
    let (document, context) = state.document_in_context(&position.text_document.uri).ok_or_else(not_open)?;
    Ok(signature_at_byte(document, context, byte))
}

/// The name at a position, and whether the element gets its name there.
fn name_at(
    state: &mut ServerState<'_>,
    position: &TextDocumentPositionParams,
) -> Answer<Option<(QualifiedName, bool)>> {
    let byte = byte_at(state, position)?;
    let document = open_document(state, &position.text_document)?;
    if names::is_model(document) {
        return Ok(names::name_in_model(&document.content.file, &document.content.path, byte));
    }
    let (document, context) = state.document_in_context(&position.text_document.uri).ok_or_else(not_open)?;
    let name = document
        .content
        .read_lesson(context)
        .and_then(|lesson| names::name_in_lesson(&lesson, &document.content.path, &context.models, byte));
    Ok(name.map(|name| (name, false)))
}

fn search_scope<'s>(state: &'s ServerState<'_>) -> SearchScope<'s> {
    SearchScope {
        open: &state.documents,
        folders: &state.folders,
        models_of: state.course.models,
        overlay: &state.contexts.overlay,
    }
}

fn find_occurrences(state: &ServerState<'_>, name: &QualifiedName) -> Occurrences {
    names::find_occurrences(name, &search_scope(state))
}

fn find_definition(
    state: &mut ServerState<'_>,
    params: GotoDefinitionParams,
) -> Answer<Option<GotoDefinitionResponse>> {
    let position = params.text_document_position_params;
    if let Some((name, defines)) = name_at(state, &position)? {
        // At the definition, the request returns the references instead.
        let found = find_occurrences(state, &name);
        let others = found.all.iter().filter(|occurrence| occurrence.defines != defines);
        return Ok(Some(names::locations(others, &search_scope(state)).into()));
    }
    let byte = byte_at(state, &position)?;
    let (document, context) = state.document_in_context(&position.text_document.uri).ok_or_else(not_open)?;
    let path = document
        .content
        .read_lesson(context)
        .and_then(|lesson| names::model_named(&lesson, &context.models, byte));
    let uri = path.and_then(|path| search_scope(state).uri(&path));
    Ok(uri.map(|uri| names::beginning(uri).into()))
}

/// `ReferenceParams` whose context may be missing.
#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
struct FindReferencesParams {
    #[serde(flatten)]
    position: TextDocumentPositionParams,
    context: Option<ReferenceContext>,
}

fn find_references(
    state: &mut ServerState<'_>,
    params: FindReferencesParams,
) -> Answer<Option<Vec<Location>>> {
    let Some((name, _)) = name_at(state, &params.position)? else { return Ok(None) };
    let also_definition = params.context.is_none_or(|context| context.include_declaration);
    let found = find_occurrences(state, &name);
    let occurrences = found.all.iter().filter(|occurrence| also_definition || !occurrence.defines);
    Ok(Some(names::locations(occurrences, &search_scope(state))))
}

fn prepare_rename(
    state: &mut ServerState<'_>,
    position: TextDocumentPositionParams,
) -> Answer<Option<PrepareRenameResponse>> {
    let Some((name, _)) = name_at(state, &position)? else { return Ok(None) };
    let document = open_document(state, &position.text_document)?;
    let range = convert::range(&document.content.file, &name.span);
    Ok(Some(PrepareRenameResponse::RangeWithPlaceholder { range, placeholder: name.name }))
}

fn rename_at(state: &mut ServerState<'_>, params: RenameParams) -> Answer<FileEdits> {
    let failed = |why: String| error(ErrorCode::RequestFailed, why);
    let new = params.new_name;
    let Some((name, _)) = name_at(state, &params.text_document_position)? else {
        return Err(failed("there is no name of the model here".into()));
    };
    let renamed = QualifiedName { name: new.clone(), ..name.clone() };
    if new != name.name && find_occurrences(state, &renamed).all.iter().any(|occurrence| occurrence.defines) {
        return Err(failed(format!("a {} `{new}` already exists", name.noun)));
    }
    rename(&name, &find_occurrences(state, &name), &new, &search_scope(state)).map_err(failed)
}

fn list_code_actions(
    state: &mut ServerState<'_>,
    params: CodeActionParams,
) -> Answer<Vec<CodeActionOrCommand>> {
    let document = open_document(state, &params.text_document)?;
    let span = convert::byte_span(document.content.file.text(), params.range);
    // The actions must refer to the current text.
    if document.stale {
        let uri = params.text_document.uri.as_str();
        state.check_documents().map_err(|e| error(ErrorCode::InternalError, format!("{uri}: {e}")))?;
    }
    let proves = state.settings.lens_proofs && state.editor.applies_edits;
    let (document, context) = state.document_in_context(&params.text_document.uri).ok_or_else(not_open)?;
    let lesson = document.content.read_lesson(context);
    let only = params.context.only.as_deref();
    let mut all = code_actions(document, lesson.as_deref(), &span, only, &context.models);
    let is_requested = only.is_none_or(|kinds| kinds.contains(&CodeActionKind::QUICKFIX));
    if let Some(lesson) = lesson.filter(|_| proves && is_requested) {
        all.extend(proof_action(document, &lesson, &span));
    }
    Ok(all)
}
