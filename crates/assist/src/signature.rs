//! Signature help: the function whose call contains a position, and the parameter at the position.

use super::code::{code_at, with_names};
use super::document::{Context, Document};
use labspec_expr::{CallSignature, signature_at};

/// The signature of the call at a byte of a lesson; `None` outside of calls and source texts.
pub fn signature_help(document: &mut Document, context: &Context, byte: usize) -> Option<CallSignature> {
    let byte = document.file.floor(byte);
    let lesson = document.read_lesson(context)?;
    let (piece, inside) = code_at(&lesson, byte)?;
    let model = context.models.model_of_lab(piece.lab, &mut Vec::new())?;
    with_names(&piece, &model, context.models.functions(), |names| {
        signature_at(names, &piece.text.value, inside)
    })
}
