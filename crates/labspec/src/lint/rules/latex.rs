//! Formulas whose backslash JSON has taken for an escape.

use crate::finding::{Finding, Severity};
use crate::source::Text;
use crate::spec::{Lab, Quiz};
use labspec_finding::{Example, Layer, Rule};

/// A command of LaTeX that begins with an escape of JSON.
pub static LATEX: Rule = Rule {
    code: "latex-escape",
    severity: Severity::Warning,
    layer: Layer::Structure,
    summary: "a LaTeX command in JSON is written with one backslash",
    why: "JSON reads `\\t`, `\\f`, `\\b`, `\\n` and `\\r` as invisible characters, so the formula loses its command",
    bad: Example::Lab(r#"{"model": "ball", "note": "the time constant $\tau$"}"#),
    good: Example::Lab(r#"{"model": "ball", "note": "the time constant $\\tau$"}"#),
};

pub(in crate::lint) const RULES: &[&Rule] = &[&LATEX];

/// What an escape makes of the commands that begin with its letter.
const COMMANDS: [(char, char, &[&str]); 5] = [
    ('\t', 't', &["tau", "theta", "times", "tfrac", "text", "tan", "tilde", "to ", "top"]),
    ('\u{c}', 'f', &["frac", "forall", "flat"]),
    ('\u{8}', 'b', &["beta", "bar", "begin", "big", "Big", "boldsymbol", "binom"]),
    ('\n', 'n', &["nu", "nabla", "neq", "ne ", "neg", "not"]),
    ('\r', 'r', &["rho", "right", "rangle", "rm", "rightarrow"]),
];

fn check_text(text: &Text, findings: &mut Vec<Finding>) {
    let mut in_formula = false;
    for (at, c) in text.value.char_indices() {
        in_formula ^= c == '$';
        let Some((_, letter, commands)) = COMMANDS.iter().find(|(control, ..)| *control == c) else {
            continue;
        };
        let rest = text.value.get(at + 1..).unwrap_or("");
        // Line breaks are ordinary; they count only inside of a formula.
        if matches!(c, '\n' | '\r') && !in_formula {
            continue;
        }
        let command = commands.iter().find(|command| {
            command.get(1..).is_some_and(|tail| rest.starts_with(tail)) && text.span_of(at..at + 1).len() == 2
        });
        let Some(command) = command.map(|command| command.trim()) else { continue };
        let span = text.span_of(at..at + 1);
        let slash = span.start..span.start + 1;
        let whole = span.start..text.span_of(at..at + command.len()).end;
        findings.push(
            Finding::new(
                &LATEX,
                whole,
                format!("`\\{command}` loses its backslash: JSON reads `\\{letter}` as an escape"),
            )
            .help(format!("write \\\\{command}"))
            .fix(slash, "\\\\"),
        );
    }
}

pub(in crate::lint) fn check_lab(lab: &Lab, findings: &mut Vec<Finding>) {
    lab.note.iter().for_each(|note| check_text(note, findings));
}

pub(in crate::lint) fn check_quiz(quiz: &Quiz, findings: &mut Vec<Finding>) {
    for (_, question) in quiz.numbered() {
        question.html().into_iter().for_each(|html| check_text(html, findings));
    }
}
