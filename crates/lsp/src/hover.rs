//! What stands at a place: what a name of the language or the model means, and what it is worth at the start of its lab; what a key
//! of the format takes.

use super::check::lesson;
use super::code;
use super::course::Around;
use super::documents::Document;
use super::places;
use super::start::{started, unit, value};
use labspec::bind::Scope;
use labspec::source::Text;
use labspec::spec::format::completions_in;
use labspec_expr::{Globals, Help, Span, chain_at};
use serde_json::{Value, json};
use std::ops::Range;

/// What is shown for a byte of a document; nothing where there is nothing to say.
pub(super) fn hover(document: &mut Document, around: &mut Around, byte: usize) -> Option<Value> {
    let lesson = lesson(document, around)?;
    let file = &document.file;
    let Some((piece, inside)) = code::at(&lesson, byte) else { return key(document, around, byte) };
    let text = &piece.text.value;
    let started = started(around, piece.lab, file.slice(piece.lab.span.clone()))?;
    let help = code::explained(&piece, &started.model, &mut Globals::new()).help;
    // The smallest part that something is known of.
    let holds = |span: &Span| span.start <= inside && inside <= span.end;
    let mut known: Vec<&(Span, Help)> = help.iter().filter(|(span, _)| holds(span)).collect();
    known.sort_by_key(|(span, _)| span.end - span.start);
    let chain = chain_at(text, inside);
    let worth = chain.and_then(|span| {
        let code = span.text(text);
        value(started, code).map(|worth| format!("At the start of the lab: `{code}` = **{worth}**"))
    });
    let measures = chain.and_then(|span| {
        let code = span.text(text);
        unit(started, piece.lab, code).map(|unit| format!("By its dimension, `{code}` is in {unit}."))
    });
    let first = known.first().map(|(_, help)| help);
    if first.is_none() && worth.is_none() {
        return None;
    }
    let title = first.map(|help| format!("```js\n{}\n```", help.title));
    let lines = first.map(|help| help.lines.join("\n\n")).filter(|lines| !lines.is_empty());
    let measured = (piece.scope == Scope::Measure && first.is_none())
        .then(|| "In a measure, over a whole run.".to_string());
    let parts: Vec<String> = [title, lines, measures, measured, worth].into_iter().flatten().collect();
    let span = chain.or(known.first().map(|(span, _)| *span))?;
    Some(json!({
        "contents": {"kind": "markdown", "value": parts.join("\n\n")},
        "range": places::range(file, &place(piece.text, span)),
    }))
}

fn place(text: &Text, span: Span) -> Range<usize> {
    text.span_of(span.into())
}

/// What a key of the format takes and means.
fn key(document: &Document, around: &Around, byte: usize) -> Option<Value> {
    let file = &document.file;
    // The text between quotes that the byte stands in.
    let line = file.text().get(..byte)?.rfind('\n').map_or(0, |at| at + 1);
    let start = file.text().get(line..byte)?.rfind('"').map(|at| line + at)?;
    let end = start + 1 + file.text().get(start + 1..)?.find(['"', '\n'])?;
    let word = file.text().get(start + 1..end)?;
    let offered = completions_in(file, end, &|asked| around.models.names(asked));
    let found = offered.iter().find(|c| c.text == word)?;
    let default = found.default.as_ref().map_or(String::new(), |d| format!("\n\nDefault: `{d}`"));
    let text = format!("**{}**: {}\n\n{}{default}", found.text, found.takes, found.doc);
    Some(json!({
        "contents": {"kind": "markdown", "value": text},
        "range": places::range(file, &(start..end + 1)),
    }))
}
