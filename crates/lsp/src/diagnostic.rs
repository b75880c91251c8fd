//! Conversion of findings to diagnostics of the editor.

use super::convert;
use labspec::finding::{self, Finding};
use labspec::report::page;
use labspec::source::SourceFile;
use lsp_types::{
    CodeDescription, Diagnostic, DiagnosticRelatedInformation, DiagnosticSeverity, DiagnosticTag, Location,
    NumberOrString, Uri,
};

/// Rules about code that has no effect; editors display it faded.
const UNNECESSARY: [&str; 3] = ["unused-allowance", "value-unused", "apply-unused"];

/// The diagnostic of a finding in a file with this URI.
pub(super) fn diagnostic(f: &Finding, file: &SourceFile, uri: &Uri) -> Diagnostic {
    let severity = match f.severity {
        finding::Severity::Error => DiagnosticSeverity::ERROR,
        finding::Severity::Warning => DiagnosticSeverity::WARNING,
        finding::Severity::Note => DiagnosticSeverity::INFORMATION,
    };
    let parts = [Some(&f.message), f.why.as_ref(), f.help.as_ref()];
    let message: Vec<&str> = parts.into_iter().flatten().map(String::as_str).collect();
    // Locations in other files are left out, because the lines of those files are not available.
    let related = f.related.iter().filter(|place| place.path == *file.path());
    let related: Vec<DiagnosticRelatedInformation> = related
        .map(|place| DiagnosticRelatedInformation {
            location: Location { uri: uri.clone(), range: convert::range(file, &place.span) },
            message: place.label.to_string(),
        })
        .collect();
    Diagnostic {
        range: convert::range(file, &f.span),
        severity: Some(severity),
        code: Some(NumberOrString::String(f.code.to_string())),
        code_description: page(f.code).parse().ok().map(|href| CodeDescription { href }),
        source: Some("labspec".to_string()),
        message: message.join("\n"),
        related_information: (!related.is_empty()).then_some(related),
        tags: UNNECESSARY.contains(&f.code).then(|| vec![DiagnosticTag::UNNECESSARY]),
        data: None,
    }
}
