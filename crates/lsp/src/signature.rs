//! Signature help in the protocol.

use super::documents::OpenDocument;
use labspec_assist::{Context, signature_help};
use labspec_expr::Span;
use lsp_types::{
    Documentation, MarkupContent, MarkupKind, ParameterInformation, ParameterLabel, SignatureHelp,
    SignatureInformation,
};

/// The signature of the call at a byte of a document.
pub(super) fn signature_at_byte(
    document: &mut OpenDocument,
    context: &Context,
    byte: usize,
) -> Option<SignatureHelp> {
    let found = signature_help(&mut document.content, context, byte)?;
    let units = |end: usize| {
        let before = found.label.get(..end).unwrap_or(&found.label);
        u32::try_from(before.encode_utf16().count()).unwrap_or(u32::MAX)
    };
    let parameter = |span: &Span| ParameterInformation {
        label: ParameterLabel::LabelOffsets([units(span.start), units(span.end)]),
        documentation: None,
    };
    let active = found.active.and_then(|i| u32::try_from(i).ok());
    let documentation = MarkupContent { kind: MarkupKind::Markdown, value: found.doc.clone() };
    let signature = SignatureInformation {
        label: found.label.clone(),
        documentation: Some(Documentation::MarkupContent(documentation)),
        parameters: Some(found.params.iter().map(parameter).collect()),
        active_parameter: active,
    };
    Some(SignatureHelp { signatures: vec![signature], active_signature: Some(0), active_parameter: active })
}
