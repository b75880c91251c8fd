use super::Check;
use crate::source::Text;
use crate::spec::Lesson;
use labspec_finding::{Example, Finding, Layer, Rule, Severity};

/// A LaTeX command in JSON is written with one backslash.
pub const LATEX_ESCAPE: &Rule = &Rule {
    code: "latex-escape",
    severity: Severity::Warning,
    exceptions: &[],
    layer: Layer::Structure,
    summary: "a LaTeX command in JSON is written with one backslash",
    why: "JSON reads `\\t`, `\\f`, `\\b`, `\\n` and `\\r` as control characters, so the formula loses its command",
    bad: Example::Lab(r#"{"model": "ball", "note": "the time constant $⟦\tau⟧$"}"#),
    good: Example::Lab(r#"{"model": "ball", "note": "the time constant $\\tau$"}"#),
};

pub(super) const CHECK: Check = Check::Lesson(check_lesson);

/// The LaTeX commands whose first letter forms a JSON escape with the backslash.
const COMMANDS: [(char, char, &[&str]); 5] = [
    ('\t', 't', &["tau", "theta", "times", "tfrac", "text", "tan", "tilde", "to ", "top"]),
    ('\u{c}', 'f', &["frac", "forall", "flat"]),
    ('\u{8}', 'b', &["beta", "bar", "begin", "big", "Big", "boldsymbol", "binom"]),
    ('\n', 'n', &["nu", "nabla", "neq", "ne ", "neg", "not"]),
    ('\r', 'r', &["rho", "right", "rangle", "rm", "rightarrow"]),
];

fn check_text(text: &Text, findings: &mut Vec<Finding>) {
    let mut in_formula = false;
    for (offset, c) in text.value.char_indices() {
        in_formula ^= c == '$';
        let Some((_, letter, commands)) = COMMANDS.iter().find(|(control, ..)| *control == c) else {
            continue;
        };
        let rest = text.value.get(offset + 1..).unwrap_or("");
        // Line breaks are common; they count only inside a formula.
        if matches!(c, '\n' | '\r') && !in_formula {
            continue;
        }
        let command = commands.iter().find(|command| {
            command.get(1..).is_some_and(|tail| rest.starts_with(tail))
                && text.span_of(offset..offset + 1).len() == 2
        });
        let Some(command) = command.map(|command| command.trim()) else { continue };
        let span = text.span_of(offset..offset + 1);
        let slash = span.start..span.start + 1;
        let whole = span.start..text.span_of(offset..offset + command.len()).end;
        findings.push(
            Finding::new(
                LATEX_ESCAPE,
                whole,
                format!("`\\{command}` loses its backslash: JSON reads `\\{letter}` as an escape"),
            )
            .help(format!("write \\\\{command}"))
            .fix(slash, "\\\\"),
        );
    }
}

fn check_lesson(lesson: &Lesson, findings: &mut Vec<Finding>) {
    lesson
        .all_labs()
        .into_iter()
        .filter_map(|lab| lab.note.as_ref())
        .for_each(|note| check_text(note, findings));
    for (_, question) in lesson.quizzes.iter().flat_map(|quiz| quiz.numbered()) {
        question.html().into_iter().for_each(|html| check_text(html, findings));
    }
}
