//! Completions as items of the protocol.

use super::convert;
use super::documents::OpenDocument;
use labspec_assist::{Completion, CompletionKind, Context, completions};
use lsp_types::{CompletionItem, CompletionItemKind, Documentation, MarkupContent, MarkupKind, TextEdit};

/// The completions at a byte of a document.
pub(super) fn completion_items(
    document: &mut OpenDocument,
    context: &Context,
    byte: usize,
) -> Vec<CompletionItem> {
    let all = completions(&mut document.content, context, byte).into_iter().enumerate();
    all.map(|(index, c)| completion_item(document, index, c)).collect()
}

fn completion_item(document: &OpenDocument, index: usize, c: Completion) -> CompletionItem {
    let text_edit =
        TextEdit { range: convert::range(&document.content.file, &c.edit.span), new_text: c.edit.text };
    let documentation = MarkupContent { kind: MarkupKind::Markdown, value: c.documentation };
    CompletionItem {
        label: c.label,
        kind: Some(item_kind(c.kind)),
        detail: Some(c.detail),
        documentation: Some(Documentation::MarkupContent(documentation)),
        filter_text: c.filter,
        // Sorted in the order of the reference.
        sort_text: Some(format!("{index:05}")),
        text_edit: Some(text_edit.into()),
        ..CompletionItem::default()
    }
}

fn item_kind(kind: CompletionKind) -> CompletionItemKind {
    match kind {
        CompletionKind::Key | CompletionKind::Attribute => CompletionItemKind::PROPERTY,
        CompletionKind::Value => CompletionItemKind::VALUE,
        CompletionKind::Object => CompletionItemKind::MODULE,
        CompletionKind::Field => CompletionItemKind::FIELD,
        CompletionKind::Function => CompletionItemKind::FUNCTION,
        CompletionKind::Name => CompletionItemKind::REFERENCE,
        CompletionKind::Variable => CompletionItemKind::VARIABLE,
        CompletionKind::Constant => CompletionItemKind::CONSTANT,
        CompletionKind::Element => CompletionItemKind::CLASS,
    }
}
