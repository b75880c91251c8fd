//! A verdict as a word and a mark, distinguishable without colours.

use super::text::plain;
use crate::finding::Severity;
use crate::ledger::State;

/// The class of a state in the style sheet, and its mark.
fn mark(state: State) -> (&'static str, &'static str) {
    match state {
        State::True(_) => ("good", "✓"),
        State::False => ("bad", "✗"),
        State::Unchecked => ("open", "?"),
        State::Baselined => ("open", "≈"),
        State::Skipped => ("none", "–"),
        State::NotClaimed => ("none", "○"),
    }
}

/// A state with its word: `✓ verified`.
pub(super) fn verdict(state: State, word: &str) -> String {
    let (class, mark) = mark(state);
    badge(class, mark, word)
}

/// The severity of a finding: `✗ error`.
pub(super) fn severity(severity: Severity) -> String {
    let (class, mark) = match severity {
        Severity::Error => ("bad", "✗"),
        Severity::Warning => ("open", "!"),
        Severity::Note => ("none", "i"),
    };
    badge(class, mark, severity.as_str())
}

/// Whether a condition holds: `✓ holds, by 0.02`.
pub(super) fn condition(holds: Option<bool>, words: &str) -> String {
    let mark = match holds {
        Some(true) => "✓",
        Some(false) => "✗",
        None => "○",
    };
    badge("plain", mark, words)
}

fn badge(class: &str, mark: &str, word: &str) -> String {
    let word = plain(word);
    format!("<span class=\"verdict {class}\"><span aria-hidden=\"true\">{mark}</span> {word}</span>")
}

/// A fraction as a bar, with a text alternative.
pub(super) fn bar(part: usize, whole: usize) -> String {
    let permille = part.min(whole) * 1000 / whole.max(1);
    format!(
        "<span class=\"bar\" role=\"img\" aria-label=\"{part} of {whole}\"><span style=\"width:{}.{}%\"> </span></span>",
        permille / 10,
        permille % 10
    )
}
