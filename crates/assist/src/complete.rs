//! Completions: keys and values of the format, names in source texts, and MJCF.

use super::code;
use super::complete_code::completions_in_code;
use super::document::{Context, Document};
use super::item::{Completion, CompletionKind, Edit};
use super::mjcf;
use labspec::json::encode;
use labspec::spec::format::{Completion as FormatCompletion, completions_in};
use labspec::spec::{FileKind, Lesson};

/// The completions at a byte of a document, in the order of the reference.
pub fn completions(document: &mut Document, context: &Context, byte: usize) -> Vec<Completion> {
    let byte = document.file.floor(byte);
    if document.kind == FileKind::Model {
        return mjcf::completions(document.file.text(), byte);
    }
    let Some(lesson) = document.read_lesson(context) else { return Vec::new() };
    if let Some((piece, inside)) = code::code_at(&lesson, byte) {
        return completions_in_code(&piece, inside, context);
    }
    if let Some(inside) = in_inline_model(&lesson, byte) {
        return inside;
    }
    let file = &document.file;
    let offered = completions_in(file, byte, &|asked| context.models.names(asked));
    let items = offered.into_iter().map(|c| {
        // The existing text may begin with a quote.
        let is_quoted = file.slice(c.replace.clone()).starts_with('"');
        Completion {
            filter: is_quoted.then(|| format!("\"{}", c.text)),
            documentation: describe_completion(&c),
            kind: if c.is_key { CompletionKind::Key } else { CompletionKind::Value },
            label: c.text.into_owned(),
            detail: c.takes,
            edit: Edit { span: c.replace, text: c.insert },
        }
    });
    items.collect()
}

/// The completions in a model that is part of a lab, as a JSON string or as a listing. `None` outside of all of them.
fn in_inline_model(lesson: &Lesson, byte: usize) -> Option<Vec<Completion>> {
    let labs = lesson.all_labs().into_iter();
    let text = labs.filter_map(|lab| lab.xml.as_ref()).find(|text| {
        let span = text.span();
        span.start <= byte && byte <= span.end
    })?;
    let all = mjcf::completions(&text.value, code::offset_in_text(text, byte)).into_iter();
    let all = all.filter(|c| text.map.is_unbroken(c.edit.span.clone()));
    // A model from a listing is not a JSON string.
    let is_json = lesson.file.text().get(..text.span().start).is_some_and(|before| before.ends_with('"'));
    let placed = |c: Completion| {
        let inserted = if is_json { encode(&c.edit.text) } else { c.edit.text };
        let edit = Edit { span: text.span_of(c.edit.span), text: inserted };
        Completion { edit, ..c }
    };
    Some(all.map(placed).collect())
}

fn describe_completion(c: &FormatCompletion) -> String {
    let default = c.default.as_ref().map_or(String::new(), |d| format!("\n\nDefault: `{d}`"));
    let required = if c.required { "\n\nRequired." } else { "" };
    format!("{}{default}{required}", c.doc)
}
