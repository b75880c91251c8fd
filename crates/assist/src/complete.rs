//! Completions: keys and values of the format, names of the language and of the model, and MJCF.

use super::code;
use super::document::{Context, Document};
use super::item::{Completion, CompletionKind, Edit};
use super::mjcf;
use labspec::bind::{ModelNames, Scope};
use labspec::json::encode;
use labspec::spec::format::{Completion as FormatCompletion, completions_in};
use labspec::spec::{FileKind, Lab, Lesson, Verify};
use labspec_expr::{Globals, Suggested, complete, variables_of};
use std::ops::Range;

/// The completions at a byte of a document, in the order of the reference.
pub fn completions(document: &mut Document, context: &Context, byte: usize) -> Vec<Completion> {
    let byte = document.file.floor(byte);
    if document.kind == FileKind::Model {
        return mjcf::completions(document.file.text(), byte);
    }
    let Some(lesson) = document.read_lesson(context) else { return Vec::new() };
    if let Some((piece, inside)) = code::code_at(&lesson, byte) {
        return in_code(&piece, inside, context);
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

/// The completions in a source text.
fn in_code(piece: &code::CodeText<'_>, inside: usize, context: &Context) -> Vec<Completion> {
    let Some(model) = context.models.model_of_lab(piece.lab, &mut Vec::new()) else { return Vec::new() };
    let readouts = labspec::verify::labels(piece.lab);
    let names = ModelNames::new(&model, piece.scope).showing(&readouts);
    let texts = piece.lab.code().into_iter().map(|(_, text)| text.value.as_str());
    let mut globals = variables_of(&names, texts);
    define_params(piece.lab, &mut globals);
    let mut items = Vec::new();
    if let Some(verify) = piece.verify.filter(|_| piece.scope == Scope::Measure) {
        add_measures(verify, piece, inside, &mut items);
    }
    let all = complete(&names, &globals, true, &piece.text.value, inside);
    let all = all.into_iter().filter(|s| piece.text.map.is_unbroken(s.replace.into()));
    items.extend(all.map(|s| Completion {
        edit: Edit { span: piece.text.span_of(s.replace.into()), text: encode(&s.text) },
        label: s.text,
        kind: code_kind(s.kind),
        detail: s.title,
        documentation: s.doc,
        filter: None,
    }));
    items
}

/// The completions in a model that is part of a lab, as a JSON string. `None` outside of all of them.
fn in_inline_model(lesson: &Lesson, byte: usize) -> Option<Vec<Completion>> {
    let labs = lesson.all_labs().into_iter();
    let text = labs.filter_map(|lab| lab.xml.as_ref()).find(|text| {
        let span = text.span();
        span.start <= byte && byte <= span.end
    })?;
    let all = mjcf::completions(&text.value, code::offset_in_text(text, byte)).into_iter();
    let all = all.filter(|c| text.map.is_unbroken(c.edit.span.clone()));
    let placed = |c: Completion| {
        let edit = Edit { span: text.span_of(c.edit.span), text: encode(&c.edit.text) };
        Completion { edit, ..c }
    };
    Some(all.map(placed).collect())
}

/// Declares the variables that controls store.
fn define_params(lab: &Lab, globals: &mut Globals) {
    let actions = lab.controls.iter().filter_map(|control| control.action());
    actions.filter_map(|action| action.param.as_ref()).for_each(|param| {
        globals.define(&param.value);
    });
}

fn describe_completion(c: &FormatCompletion) -> String {
    let default = c.default.as_ref().map_or(String::new(), |d| format!("\n\nDefault: `{d}`"));
    let required = if c.required { "\n\nRequired." } else { "" };
    format!("{}{default}{required}", c.doc)
}

fn code_kind(kind: Suggested) -> CompletionKind {
    match kind {
        Suggested::Object => CompletionKind::Object,
        Suggested::Field => CompletionKind::Field,
        Suggested::Function => CompletionKind::Function,
        Suggested::Name => CompletionKind::Name,
        Suggested::Variable => CompletionKind::Variable,
        Suggested::Constant => CompletionKind::Constant,
    }
}

/// Adds the runs and measures of a claim, which its conditions use by name.
fn add_measures(verify: &Verify, piece: &code::CodeText<'_>, inside: usize, items: &mut Vec<Completion>) {
    let Some(word) = word_before(&piece.text.value, inside) else { return };
    if !piece.text.map.is_unbroken(word.clone()) {
        return;
    }
    let span = piece.text.span_of(word);
    let named = |name: &str, what: &str| Completion {
        label: name.to_string(),
        kind: CompletionKind::Variable,
        detail: what.to_string(),
        documentation: String::new(),
        filter: None,
        edit: Edit { span: span.clone(), text: encode(name) },
    };
    items.extend(verify.measure.iter().map(|(name, _)| named(&name.value, "a measure")));
    items.extend(verify.find.iter().map(|find| named(&find.name.value, "a value found by a search")));
    items.extend(verify.runs.iter().map(|run| named(&run.name.value, "a run")));
}

/// The part of a name before an offset; `None` after a dot, where members are written.
fn word_before(text: &str, inside: usize) -> Option<Range<usize>> {
    let before = text.get(..inside)?;
    let start = before.trim_end_matches(|c: char| c.is_alphanumeric() || matches!(c, '_' | '$')).len();
    let is_member = before.get(..start)?.trim_end().ends_with('.');
    (!is_member).then_some(start..inside)
}
