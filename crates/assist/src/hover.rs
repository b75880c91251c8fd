//! Hover texts: the meaning of a name of the language or the model, with its value at the start of the lab, and the
//! meaning of a key of the format.

use super::code;
use super::document::{Context, Document};
use super::item::Hover;
use super::mjcf;
use super::start::{unit, value};
use labspec::bind::Scope;
use labspec::spec::FileKind;
use labspec::spec::format::completions_in;
use labspec_expr::{Globals, Help, Span, chain_at};

/// The hover text for a byte of a document, or `None` if there is none.
pub fn hover(document: &mut Document, context: &mut Context, byte: usize) -> Option<Hover> {
    let byte = document.file.floor(byte);
    if document.kind == FileKind::Model {
        return mjcf::hover(document.file.text(), byte);
    }
    let lesson = document.read_lesson(context)?;
    let file = &document.file;
    let Some((piece, inside)) = code::code_at(&lesson, byte) else {
        return hover_key(document, context, byte);
    };
    let text = &piece.text.value;
    let key = file.slice(piece.lab.span.clone());
    let started = context.started.start(&context.models, piece.lab, key)?;
    let help = code::explained(&piece, &started.model, &mut Globals::new()).help;
    // The smallest part that has help.
    let holds = |span: &Span| span.start <= inside && inside <= span.end;
    let mut explained: Vec<&(Span, Help)> = help.iter().filter(|(span, _)| holds(span)).collect();
    explained.sort_by_key(|(span, _)| span.end - span.start);
    let chain = chain_at(text, inside);
    let worth = chain.and_then(|span| {
        let code = span.text(text);
        value(started, code).map(|worth| format!("At the start of the lab: `{code}` = **{worth}**"))
    });
    let measures = chain.and_then(|span| {
        let code = span.text(text);
        unit(started, piece.lab, code).map(|unit| format!("By its dimension, `{code}` is in {unit}."))
    });
    let first = explained.first().map(|(_, help)| help);
    if first.is_none() && worth.is_none() {
        return None;
    }
    let title = first.map(|help| format!("```js\n{}\n```", help.title));
    let lines = first.map(|help| help.lines.join("\n\n")).filter(|lines| !lines.is_empty());
    let measured = (piece.scope == Scope::Measure && first.is_none())
        .then(|| "In a measure, over a whole run.".to_string());
    let parts: Vec<String> = [title, lines, measures, measured, worth].into_iter().flatten().collect();
    let span = chain.or(explained.first().map(|(span, _)| *span))?;
    Some(Hover { span: piece.text.span_of(span.into()), text: parts.join("\n\n") })
}

/// The value type and the meaning of a key of the format.
fn hover_key(document: &Document, context: &Context, byte: usize) -> Option<Hover> {
    let file = &document.file;
    // The quoted text that contains the byte.
    let line = file.text().get(..byte)?.rfind('\n').map_or(0, |at| at + 1);
    let start = file.text().get(line..byte)?.rfind('"').map(|at| line + at)?;
    let end = start + 1 + file.text().get(start + 1..)?.find(['"', '\n'])?;
    let word = file.text().get(start + 1..end)?;
    let offered = completions_in(file, end, &|asked| context.models.names(asked));
    let found = offered.iter().find(|c| c.text == word)?;
    let default = found.default.as_ref().map_or(String::new(), |d| format!("\n\nDefault: `{d}`"));
    let text = format!("**{}**: {}\n\n{}{default}", found.text, found.takes, found.doc);
    Some(Hover { span: file.snap(&(start..end + 1)), text })
}
