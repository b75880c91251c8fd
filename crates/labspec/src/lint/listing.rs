//! Detects listings that a text editor has damaged.

use super::code_scan::{CodeScan, Language};
use crate::finding::Finding;
use crate::rules;
use crate::source::Text;

/// Checks a listing. An unclosed one may contain text after the code, so it is read up to an empty line or a table.
pub(crate) fn check_listing(language: &str, body: &Text, closed: bool, findings: &mut Vec<Finding>) {
    let Some(language) = Language::named(language) else { return };
    let mut end = 0;
    for line in body.value.split_inclusive('\n') {
        if !closed && end > 0 && (line.trim().is_empty() || line.starts_with('|')) {
            break;
        }
        end += line.len();
    }
    let code = body.value.get(..end).unwrap_or("");
    let scan = CodeScan::scan_code(code, language);
    rules::typographic_quote::check_listing_quotes(body, &scan, findings);
    if language == Language::Python {
        check_python(body, code, &scan, findings);
    }
}

fn check_python(body: &Text, code: &str, scan: &CodeScan, findings: &mut Vec<Finding>) {
    let mut opener = None;
    for line in scan.lines(code) {
        findings.extend(rules::listing_underscores::check_line(body, &line));
        if !scan.is_statement(&line) {
            continue;
        }
        findings.extend(rules::listing_indentation::check_line(body, &line, opener.take()));
        if line.bare.trim_end().ends_with(':') {
            opener = Some((line.indent, line.content.clone()));
        } else {
            findings.extend(rules::listing_line_breaks::check_line(body, &line));
        }
    }
}
