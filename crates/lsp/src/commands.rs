//! Commands of the editor: a check of a lesson with all its runs, and claims for the numbers of a line.

use super::answers::{Answer, error, not_open};
use super::convert;
use super::lenses::{CHECK, PROVE};
use super::state::ServerState;
use labspec_assist::unclaimed_numbers;
use lsp_server::ErrorCode;
use lsp_types::{ExecuteCommandParams, Uri};
use serde_json::Value;

/// Executes a command. What needs runs is done on a separate thread.
pub(super) fn execute_command(state: &mut ServerState<'_>, params: ExecuteCommandParams) -> Answer<Value> {
    let arguments = params.arguments;
    let invalid = |why: &str| error(ErrorCode::InvalidParams, format!("`{}` {why}", params.command));
    let uri = arguments.first().and_then(Value::as_str).ok_or_else(|| invalid("needs the URI of a document"));
    match params.command.as_str() {
        CHECK => {
            let uri = uri?.to_string();
            if !state.documents.contains_key(&uri) {
                return Err(not_open());
            }
            state.start_runs(&uri);
        }
        PROVE => {
            let line = arguments.get(1).and_then(Value::as_u64).and_then(|line| usize::try_from(line).ok());
            let line = line.ok_or_else(|| invalid("needs a line"))?;
            prove_line(state, uri?, line)?;
        }
        _ => return Err(invalid("is not a command of this server")),
    }
    Ok(Value::Null)
}

fn prove_line(state: &mut ServerState<'_>, uri: &str, line: usize) -> Answer<()> {
    let parsed: Uri = uri.parse().map_err(|_| not_open())?;
    let (document, context) = state.document_in_context(&parsed).ok_or_else(not_open)?;
    let Some(lesson) = document.content.read_lesson(context) else { return Ok(()) };
    let is_there = |byte: usize| convert::position(&lesson.file, byte).line as usize == line;
    let mut numbers = unclaimed_numbers(&lesson);
    numbers.retain(|span| is_there(span.start));
    if numbers.is_empty() {
        return Err(error(ErrorCode::RequestFailed, "every number of this line has a claim"));
    }
    state.start_proof(uri, numbers);
    Ok(())
}
