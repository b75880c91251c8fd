//! Claimed and unclaimed numbers in the text of a lesson, for its author.

use labspec::ledger::{Entry, Ledger, State, Subject};
use labspec::spec::Lesson;
use labspec::verify::{RenderedText, counted};
use std::ops::Range;

/// A piece of text with its state.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct TextMark {
    /// Bytes of the file.
    pub(crate) span: Range<usize>,
    /// The class of its state: `claim-true`, `claim-false`, `claim-open` or `claim-none`.
    pub(crate) class: &'static str,
    /// What a reader sees beside it.
    pub(crate) label: String,
}

/// The class of a state, and the sign that distinguishes it without colours.
pub(crate) fn class_of(state: State) -> (&'static str, &'static str) {
    match state {
        State::True(_) => ("claim-true", "✓"),
        State::False => ("claim-false", "✗"),
        State::Unchecked => ("claim-open", "?"),
        State::Baselined => ("claim-open", "≈"),
        State::Skipped => ("claim-open", "…"),
        State::NotClaimed => ("claim-none", "○"),
    }
}

/// The verdict of a claim in words.
pub(crate) fn verdict(entry: &Entry) -> String {
    match entry.remark.as_str() {
        "" => format!("{} ({})", entry.word, entry.owner),
        remark => format!("{} ({}): {remark}", entry.word, entry.owner),
    }
}

/// The marks of a lesson in the order of the text. Where two overlap, the one that needs attention stays.
pub(crate) fn text_marks(lesson: &Lesson, ledger: &Ledger) -> Vec<TextMark> {
    let rendered = RenderedText::of_lesson(lesson);
    let mut all = Vec::new();
    for entry in
        ledger.entries().iter().filter(|e| e.path == *lesson.file.path() && e.subject == Subject::Quote)
    {
        let comment = lesson
            .claim_comments
            .iter()
            .find(|r| r.verify.says.iter().any(|quoted| quoted.quote.span() == entry.span));
        let over = comment.map(|comment| &comment.over);
        let (class, _) = class_of(entry.state);
        for span in rendered.places(&entry.what) {
            if over.is_none_or(|over| over.start <= span.start && span.end <= over.end) {
                all.push(TextMark { span, class, label: verdict(entry) });
            }
        }
    }
    for stated in counted(lesson).left {
        all.push(TextMark {
            span: stated.span,
            class: "claim-none",
            label: "no claim states this number".into(),
        });
    }
    let attention = ["claim-false", "claim-open", "claim-true", "claim-none"];
    let rank = |mark: &TextMark| attention.iter().position(|class| *class == mark.class);
    all.sort_by_key(|mark| (rank(mark), mark.span.start, mark.span.end));
    let mut chosen: Vec<TextMark> = Vec::new();
    let mut occupied: std::collections::BTreeMap<usize, usize> = std::collections::BTreeMap::new();
    for mark in all {
        let before = occupied.range(..mark.span.end).next_back();
        if mark.span.is_empty() || before.is_some_and(|(_, end)| *end > mark.span.start) {
            continue;
        }
        occupied.insert(mark.span.start, mark.span.end);
        chosen.push(mark);
    }
    chosen.sort_by_key(|mark| mark.span.start);
    chosen
}
