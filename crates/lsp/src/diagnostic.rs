//! A finding as an editor shows it.

use super::places;
use labspec::finding::{Finding, Severity};
use labspec::report::page;
use labspec::source::SourceFile;
use serde_json::{Value, json};

/// What the editor calls something that has no effect, so that it is drawn pale.
const UNNECESSARY: u8 = 1;
/// Rules about what could as well be left out.
const PALE: [&str; 3] = ["unused-allowance", "value-unused", "apply-unused"];

/// The finding, at its place in a file that the editor knows by this URI.
pub(super) fn diagnostic(f: &Finding, file: &SourceFile, uri: &str) -> Value {
    let severity = match f.severity {
        Severity::Error => 1,
        Severity::Warning => 2,
        Severity::Note => 3,
    };
    let parts = [Some(&f.message), f.why.as_ref(), f.help.as_ref()];
    let message: Vec<&str> = parts.into_iter().flatten().map(String::as_str).collect();
    let mut told = json!({
        "range": places::range(file, &f.span),
        "severity": severity,
        "code": f.code,
        "codeDescription": {"href": page(f.code)},
        "source": "labspec",
        "message": message.join("\n"),
    });
    // Places in files that are not at hand have no lines to name.
    let here = f.related.iter().filter(|place| place.path == *file.path());
    let related: Vec<Value> = here
        .map(|place| {
            json!({"location": {"uri": uri, "range": places::range(file, &place.span)}, "message": place.label})
        })
        .collect();
    if !related.is_empty() {
        told["relatedInformation"] = related.into();
    }
    if PALE.contains(&f.code) {
        told["tags"] = json!([UNNECESSARY]);
    }
    told
}
