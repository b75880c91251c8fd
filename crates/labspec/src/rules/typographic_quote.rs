use super::Check;
use crate::json::fix_in;
use crate::lint::CodeScan;
use crate::markdown::is_typographic;
use crate::source::Text;
use crate::spec::Lab;
use labspec_finding::{Example, Finding, Layer, Rule, Severity};
use std::ops::Range;

/// Code contains a typographic quote.
pub const TYPOGRAPHIC_QUOTE: &Rule = &Rule {
    code: "typographic-quote",
    severity: Severity::Error,
    exceptions: &[],
    layer: Layer::Structure,
    summary: "code contains a typographic quote",
    why: "word processors replace straight quotes; a program reads “ ” ‘ ’ as letters",
    bad: Example::Lesson("```lab simlab\n{⟦“⟧model”: “ball”}\n```\n"),
    good: Example::Lesson("```lab simlab\n{\"model\": \"ball\", \"note\": \"a “ball”\"}\n```\n"),
};

pub(super) const CHECK: Check = Check::Lab(check_lab);

/// Checks the statements and expressions of a lab: one finding for all quotes of a text, with one fix.
fn check_lab(lab: &Lab, findings: &mut Vec<Finding>) {
    for (_, code) in lab.code() {
        let (mut quoted, mut found) = (None, Vec::new());
        for (offset, c) in code.value.char_indices() {
            match (quoted, c) {
                (None, '\'' | '"' | '`') => quoted = Some(c),
                (Some(open), _) if open == c => quoted = None,
                (None, _) if is_typographic(c) => found.push(offset..offset + c.len_utf8()),
                _ => {}
            }
        }
        let (Some(first), Some(last)) = (found.first(), found.last()) else { continue };
        let quote = code.value.get(first.clone()).unwrap_or("");
        let message = match found.len() {
            1 => format!("an expression contains the typographic quote {quote}"),
            n => format!("an expression contains {n} typographic quotes, {quote} is the first"),
        };
        let part = first.start..last.end;
        let right = code.value.get(part.clone()).unwrap_or("").replace(is_typographic, "'");
        let mut finding = Finding::new(TYPOGRAPHIC_QUOTE, code.span_of(first.clone()), message)
            .help("write ' around names: data.body('ball')");
        // Typographic quotes inside plain quotes are not replaced.
        if !right.contains(['"', '`']) && found.len() == right.matches('\'').count() && found.len() % 2 == 0 {
            finding.fix = Some(fix_in(code, part, &right));
        }
        findings.push(finding);
    }
}

/// Reports the quotes of a listing in one finding.
pub(crate) fn check_listing_quotes(body: &Text, scan: &CodeScan, findings: &mut Vec<Finding>) {
    let Some(first) = scan.quotes.first() else { return };
    // The first quote of every line.
    let mut lines: Vec<&Range<usize>> = Vec::new();
    for quote in &scan.quotes {
        let same = lines
            .last()
            .and_then(|last| scan.bare.get(last.start..quote.start))
            .is_some_and(|b| !b.contains('\n'));
        if !same {
            lines.push(quote);
        }
    }
    let on = if lines.len() > 1 { format!(", on {} lines", lines.len()) } else { String::new() };
    let mut finding = Finding::new(
        TYPOGRAPHIC_QUOTE,
        body.span_of(first.clone()),
        format!("a listing has typographic quotes{on}"),
    )
    .help("write \" for “ and ”, and ' for ‘ and ’");
    for &quote in lines.iter().skip(1).take(7) {
        finding = finding.related(body.span_of(quote.clone()), "and on this line");
    }
    findings.push(finding);
}

/// Reports typographic quotes in the JSON itself. `last`: the last of them.
pub(crate) fn quotes_of_json(span: Range<usize>, count: usize, last: Option<Range<usize>>) -> Finding {
    let plural = if count == 1 { "" } else { "s" };
    let message = format!("JSON has {count} typographic quote{plural} where it needs \"");
    let finding = Finding::new(TYPOGRAPHIC_QUOTE, span, message).help(
        "write straight quotes: \"model\": \"…\"; the checker reads these as straight ones and checks the rest",
    );
    match last {
        Some(last) => finding.related(last, "the last one"),
        None => finding,
    }
}
