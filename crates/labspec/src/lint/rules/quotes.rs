//! Typographic quotes where a program reads: in JSON, in listings, in expressions.

use crate::finding::{Finding, Severity};
use crate::lint::{Example, Rule};
use crate::markdown::is_typographic;
use crate::spec::Lab;

/// A typographic quote in code.
pub static TYPOGRAPHIC: Rule = Rule {
    code: "typographic-quote",
    severity: Severity::Error,
    summary: "a typographic quote stands where a program needs a straight one",
    why: "word processors replace straight quotes; programs read “ ” ‘ ’ as letters",
    bad: Example::Lesson("```lab simlab\n{“model”: “ball”}\n```\n"),
    good: Example::Lesson("```lab simlab\n{\"model\": \"ball\", \"note\": \"a “ball”\"}\n```\n"),
};

pub(in crate::lint) const RULES: &[&Rule] = &[&TYPOGRAPHIC];

/// Looks into the statements and expressions of a lab.
pub(in crate::lint) fn check_lab(lab: &Lab, findings: &mut Vec<Finding>) {
    for (_, code) in lab.code() {
        let mut quoted = None;
        for (at, c) in code.value.char_indices() {
            match (quoted, c) {
                (None, '\'' | '"' | '`') => quoted = Some(c),
                (Some(open), _) if open == c => quoted = None,
                (None, _) if is_typographic(c) => {
                    let span = code.span_of(at..at + c.len_utf8());
                    findings.push(
                        Finding::new(
                            &TYPOGRAPHIC,
                            span.clone(),
                            format!("the typographic quote {c} in an expression"),
                        )
                        .help("write ' around names: data.body('ball')")
                        .fix(span, "'"),
                    );
                    // One is enough to find the others.
                    break;
                }
                _ => {}
            }
        }
    }
}
