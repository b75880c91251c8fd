//! Inlay hints: the units of fields that source texts mention, if enabled.

use super::convert;
use super::documents::OpenDocument;
use labspec::bind::ModelNames;
use labspec_assist::{Context, code};
use labspec_expr::{FieldMention, Schema, fields_in};
use lsp_types::InlayHint;
use std::ops::Range;

/// The unit hints in a range of a document.
pub(super) fn hints(document: &mut OpenDocument, context: &Context, range: &Range<usize>) -> Vec<InlayHint> {
    let Some(lesson) = document.content.read_lesson(context) else { return Vec::new() };
    let mut all = Vec::new();
    for piece in code::code_texts(&lesson) {
        let span = piece.text.span();
        if span.end < range.start || range.end < span.start {
            continue;
        }
        let Some(model) = context.models.model_of_lab(piece.lab, &mut Vec::new()) else { continue };
        let readouts = labspec::verify::labels(piece.lab);
        let names = ModelNames::new(&model, piece.scope).showing(&readouts);
        for mention in fields_in(&names, &piece.text.value) {
            let Some(unit) = unit(&names, &mention) else { continue };
            let end = piece.text.span_of(mention.span.into()).end;
            all.push(InlayHint {
                position: convert::range(&document.content.file, &(end..end)).start,
                label: unit.into(),
                kind: None,
                text_edits: None,
                tooltip: None,
                padding_left: Some(true),
                padding_right: None,
                data: None,
            });
        }
    }
    all
}

/// The unit of a field, or of one of its elements if these differ: the height of a free body is in m, and the components of its
/// quaternion have no unit.
fn unit(names: &ModelNames<'_>, mention: &FieldMention) -> Option<String> {
    let unit = names.unit(&mention.field, mention.element);
    // The unit depends on the object, and is not certain.
    (!unit.is_empty() && !unit.contains(" or ")).then_some(unit)
}
