//! Edits of a document in the protocol.

use super::convert;
use super::documents::OpenDocument;
use labspec_assist::Edit;
use lsp_types::{
    DocumentChanges, OneOf, OptionalVersionedTextDocumentIdentifier, TextDocumentEdit, TextEdit,
    WorkspaceEdit,
};

/// An edit of the document, in the version that the editor has.
pub(super) fn workspace_edit(document: &OpenDocument, edit: Edit) -> WorkspaceEdit {
    let edit = TextEdit { range: convert::range(&document.content.file, &edit.span), new_text: edit.text };
    let edits = TextDocumentEdit {
        text_document: OptionalVersionedTextDocumentIdentifier {
            uri: document.uri.clone(),
            version: Some(document.version),
        },
        edits: vec![OneOf::Left(edit)],
    };
    WorkspaceEdit { document_changes: Some(DocumentChanges::Edits(vec![edits])), ..WorkspaceEdit::default() }
}
