//! What can be written at a place: keys and words of the format, names of the language and of the model.

use super::check::lesson;
use super::code;
use super::course::Around;
use super::documents::Document;
use super::places;
use labspec::bind::ModelNames;
use labspec::spec::Verify;
use labspec::spec::format::{Completion, completions_in};
use labspec_expr::{Globals, Suggested, Suggestion, complete, variables_of};
use serde_json::{Value, json};

/// Kinds of completions, as the protocol counts them.
mod kind {
    pub(super) const FUNCTION: u8 = 3;
    pub(super) const FIELD: u8 = 5;
    pub(super) const VARIABLE: u8 = 6;
    pub(super) const MODULE: u8 = 9;
    pub(super) const PROPERTY: u8 = 10;
    pub(super) const VALUE: u8 = 12;
    pub(super) const REFERENCE: u8 = 18;
    pub(super) const CONSTANT: u8 = 21;
}

/// What can be written at a byte of a document.
pub(super) fn completions(document: &mut Document, around: &Around, byte: usize) -> Value {
    let Some(lesson) = lesson(document, around) else { return json!([]) };
    let file = &document.file;
    if let Some((piece, inside)) = code::at(&lesson, byte) {
        let Some(model) = around.models.model_of_lab(piece.lab, &mut Vec::new()) else { return json!([]) };
        let shown = labspec::verify::labels(piece.lab);
        let names = ModelNames::new(&model, piece.scope).showing(&shown);
        let texts = piece.lab.code().into_iter().map(|(_, text)| text.value.as_str());
        let mut globals = variables_of(&names, texts);
        params(piece.lab, &mut globals);
        let all = complete(&names, &globals, true, &piece.text.value, inside);
        let items = all.into_iter().filter(|s| piece.text.map.is_unbroken(s.replace.into()));
        let mut items: Vec<Value> = items
            .enumerate()
            .map(|(i, s)| {
                let range = places::range(file, &piece.text.span_of(s.replace.into()));
                item(&s.text, kind_of(s.kind), &s.title, &s.doc, &range, &quoted(&s), i)
            })
            .collect();
        if let Some(verify) = piece.verify.filter(|_| piece.scope == labspec::bind::Scope::Measure) {
            measures(verify, &mut items);
        }
        return items.into();
    }
    let offered = completions_in(file, byte, &|asked| around.models.names(asked));
    let items = offered.into_iter().enumerate().map(|(i, c)| {
        let range = places::range(file, &c.replace);
        let kind = if c.is_key { kind::PROPERTY } else { kind::VALUE };
        let mut item = item(&c.text, kind, &c.takes, &about(&c), &range, &c.insert, i);
        // What is written there already begins with a quote where there is one.
        if file.slice(c.replace.clone()).starts_with('"') {
            item["filterText"] = format!("\"{}", c.text).into();
        }
        item
    });
    items.collect()
}

/// The variables that controls store.
fn params(lab: &labspec::spec::Lab, globals: &mut Globals) {
    let actions = lab.controls.iter().filter_map(|control| control.action());
    actions.filter_map(|action| action.param.as_ref()).for_each(|param| {
        globals.define(&param.value);
    });
}

/// What is written for a suggestion: names stand between quotes in JSON, where a quote would end the text.
fn quoted(s: &Suggestion) -> String {
    labspec::json::encode(&s.text)
}

fn about(c: &Completion) -> String {
    let default = c.default.as_ref().map_or(String::new(), |d| format!("\n\nDefault: `{d}`"));
    let required = if c.required { "\n\nRequired." } else { "" };
    format!("{}{default}{required}", c.doc)
}

fn kind_of(kind: Suggested) -> u8 {
    match kind {
        Suggested::Object => kind::MODULE,
        Suggested::Field => kind::FIELD,
        Suggested::Function => kind::FUNCTION,
        Suggested::Name => kind::REFERENCE,
        Suggested::Variable => kind::VARIABLE,
        Suggested::Constant => kind::CONSTANT,
    }
}

/// Runs and measures of a claim, by whose names its conditions are written.
fn measures(verify: &Verify, items: &mut Vec<Value>) {
    let named = |name: &str, what: &str| json!({"label": name, "kind": kind::VARIABLE, "detail": what, "sortText": " "});
    items.extend(verify.measure.iter().map(|(name, _)| named(&name.value, "a measure")));
    items.extend(verify.find.iter().map(|find| named(&find.name.value, "a value found by a search")));
    items.extend(verify.runs.iter().map(|run| named(&run.name.value, "a run")));
}

fn item(label: &str, kind: u8, detail: &str, doc: &str, range: &Value, insert: &str, place: usize) -> Value {
    json!({
        "label": label,
        "kind": kind,
        "detail": detail,
        "documentation": {"kind": "markdown", "value": doc},
        // In the order of the reference.
        "sortText": format!("{place:05}"),
        "textEdit": {"range": range, "newText": insert},
    })
}
