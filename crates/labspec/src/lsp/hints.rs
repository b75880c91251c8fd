//! The unit of what a text names, behind it, for who asks for it.

use super::check::lesson;
use super::code;
use super::course::Around;
use super::documents::Document;
use super::places;
use crate::bind::ModelNames;
use labspec_expr::{FieldMention, Schema, fields_in};
use serde_json::{Value, json};
use std::ops::Range;

/// The units within a range of a document.
pub(super) fn hints(document: &mut Document, around: &Around, range: &Range<usize>) -> Value {
    let Some(lesson) = lesson(document, around) else { return json!([]) };
    let mut all = Vec::new();
    for piece in code::pieces(&lesson) {
        let span = piece.text.span();
        if span.end < range.start || range.end < span.start {
            continue;
        }
        let Some(model) = around.models.of(piece.lab, &mut Vec::new()) else { continue };
        let shown = crate::verify::labels(piece.lab);
        let names = ModelNames::new(&model, piece.scope).showing(&shown);
        for mention in fields_in(&names, &piece.text.value) {
            let Some(unit) = unit(&names, &mention) else { continue };
            let end = piece.text.span_of(mention.span.into()).end;
            let place = places::range(&document.file, &(end..end));
            all.push(json!({"position": place["start"], "label": unit, "paddingLeft": true}));
        }
    }
    all.into()
}

/// The unit of a field, or of the element of one whose elements differ: the height of a free body is in m, the parts of its
/// quaternion have none.
fn unit(names: &ModelNames<'_>, mention: &FieldMention) -> Option<String> {
    let FieldMention { field, element, .. } = mention;
    let told = element.and_then(|i| names.element_help(field.key, field.first + i));
    let of_element =
        told.as_deref().and_then(|help| help.rsplit_once(", ")).map(|(_, unit)| unit.to_string());
    match field.unit.as_str() {
        "" => None,
        // Each element is of its own kind of joint.
        several if several.contains(" or ") => of_element,
        unit => Some(unit.to_string()),
    }
}
