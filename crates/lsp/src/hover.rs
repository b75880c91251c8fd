//! Hover texts in the protocol.

use super::convert;
use super::documents::OpenDocument;
use labspec_assist::{Context, hover};
use lsp_types::{Hover, HoverContents, MarkupContent, MarkupKind};

/// The hover text for a byte of a document, or `None` if there is none.
pub(super) fn hover_at_byte(
    document: &mut OpenDocument,
    context: &mut Context,
    byte: usize,
) -> Option<Hover> {
    let found = hover(&mut document.content, context, byte)?;
    let contents = HoverContents::Markup(MarkupContent { kind: MarkupKind::Markdown, value: found.text });
    Some(Hover { contents, range: Some(convert::range(&document.content.file, &found.span)) })
}
