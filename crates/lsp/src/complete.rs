//! Completions: keys and values of the format, and names of the language and of the model.

use super::check::lesson;
use super::code;
use super::context::ModelContext;
use super::convert;
use super::documents::OpenDocument;
use labspec::bind::ModelNames;
use labspec::spec::Verify;
use labspec::spec::format::{Completion, completions_in};
use labspec_expr::{Globals, Suggested, Suggestion, complete, variables_of};
use lsp_types::{CompletionItem, CompletionItemKind, Documentation, MarkupContent, MarkupKind, TextEdit};

/// The completions at a byte of a document.
pub(super) fn completions(
    document: &mut OpenDocument,
    context: &ModelContext,
    byte: usize,
) -> Vec<CompletionItem> {
    let Some(lesson) = lesson(document, context) else { return Vec::new() };
    let file = &document.file;
    if let Some((piece, inside)) = code::code_at(&lesson, byte) {
        let Some(model) = context.models.model_of_lab(piece.lab, &mut Vec::new()) else { return Vec::new() };
        let readouts = labspec::verify::labels(piece.lab);
        let names = ModelNames::new(&model, piece.scope).showing(&readouts);
        let texts = piece.lab.code().into_iter().map(|(_, text)| text.value.as_str());
        let mut globals = variables_of(&names, texts);
        define_params(piece.lab, &mut globals);
        let all = complete(&names, &globals, true, &piece.text.value, inside);
        let items = all.into_iter().filter(|s| piece.text.map.is_unbroken(s.replace.into()));
        let mut items: Vec<CompletionItem> = items
            .enumerate()
            .map(|(i, s)| {
                let range = convert::range(file, &piece.text.span_of(s.replace.into()));
                let text_edit = TextEdit { range, new_text: quoted(&s) };
                completion_item(i, s.text, item_kind(s.kind), s.title, s.doc, text_edit)
            })
            .collect();
        if let Some(verify) = piece.verify.filter(|_| piece.scope == labspec::bind::Scope::Measure) {
            add_measures(verify, &mut items);
        }
        return items;
    }
    let offered = completions_in(file, byte, &|asked| context.models.names(asked));
    let items = offered.into_iter().enumerate().map(|(i, c)| {
        let kind = if c.is_key { CompletionItemKind::PROPERTY } else { CompletionItemKind::VALUE };
        let documentation = describe_completion(&c);
        // The existing text may begin with a quote.
        let is_quoted = file.slice(c.replace.clone()).starts_with('"');
        let filter_text = is_quoted.then(|| format!("\"{}", c.text));
        let text_edit = TextEdit { range: convert::range(file, &c.replace), new_text: c.insert };
        let item = completion_item(i, c.text.into_owned(), kind, c.takes, documentation, text_edit);
        CompletionItem { filter_text, ..item }
    });
    items.collect()
}

/// Declares the variables that controls store.
fn define_params(lab: &labspec::spec::Lab, globals: &mut Globals) {
    let actions = lab.controls.iter().filter_map(|control| control.action());
    actions.filter_map(|action| action.param.as_ref()).for_each(|param| {
        globals.define(&param.value);
    });
}

/// The text of a suggestion inside a JSON string, with escapes.
fn quoted(s: &Suggestion) -> String {
    labspec::json::encode(&s.text)
}

fn describe_completion(c: &Completion) -> String {
    let default = c.default.as_ref().map_or(String::new(), |d| format!("\n\nDefault: `{d}`"));
    let required = if c.required { "\n\nRequired." } else { "" };
    format!("{}{default}{required}", c.doc)
}

fn item_kind(kind: Suggested) -> CompletionItemKind {
    match kind {
        Suggested::Object => CompletionItemKind::MODULE,
        Suggested::Field => CompletionItemKind::FIELD,
        Suggested::Function => CompletionItemKind::FUNCTION,
        Suggested::Name => CompletionItemKind::REFERENCE,
        Suggested::Variable => CompletionItemKind::VARIABLE,
        Suggested::Constant => CompletionItemKind::CONSTANT,
    }
}

/// Adds the runs and measures of a claim, which its conditions use by name.
fn add_measures(verify: &Verify, items: &mut Vec<CompletionItem>) {
    let named = |name: &str, what: &str| CompletionItem {
        label: name.to_string(),
        kind: Some(CompletionItemKind::VARIABLE),
        detail: Some(what.to_string()),
        sort_text: Some(" ".to_string()),
        ..CompletionItem::default()
    };
    items.extend(verify.measure.iter().map(|(name, _)| named(&name.value, "a measure")));
    items.extend(verify.find.iter().map(|find| named(&find.name.value, "a value found by a search")));
    items.extend(verify.runs.iter().map(|run| named(&run.name.value, "a run")));
}

fn completion_item(
    index: usize,
    label: String,
    kind: CompletionItemKind,
    detail: String,
    documentation: String,
    text_edit: TextEdit,
) -> CompletionItem {
    let documentation = MarkupContent { kind: MarkupKind::Markdown, value: documentation };
    CompletionItem {
        label,
        kind: Some(kind),
        detail: Some(detail),
        documentation: Some(Documentation::MarkupContent(documentation)),
        // Sorted in the order of the reference.
        sort_text: Some(format!("{index:05}")),
        text_edit: Some(text_edit.into()),
        ..CompletionItem::default()
    }
}
