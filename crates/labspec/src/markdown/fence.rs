//! A single fence: the intended kind of a misspelt one, whether it is closed, and the real end of a damaged one.

use super::loose::bare_json;
use super::opener::{Opener, opener};
use super::{BlockKind, LabKind, extent};
use labspec_finding::nearest;
use std::ops::Range;

/// `lab` or `quiz`, if a fence is written in another Markdown dialect: ```{lab}, ```{.lab}, ```json lab.
fn in_other_words(words: &[String]) -> Option<&'static str> {
    let bare =
        |word: &String| word.trim_start_matches(['{', '.']).trim_end_matches([',', '}']).to_ascii_lowercase();
    let kind_of = |word: &String| ["lab", "quiz"].into_iter().find(|w| bare(word) == *w);
    let first = words.first()?;
    match bare(first).as_str() {
        "json" | "json5" | "jsonc" | "js" | "javascript" => kind_of(words.get(1)?),
        _ => kind_of(first),
    }
}

/// `lab` or `quiz`, if the word consists only of our words: `lab-simlab`, `simlab`, `labs`, `quizzes`.
fn joined_or_plural(language: &str) -> Option<&'static str> {
    let language = language.to_ascii_lowercase();
    let kind_of = |word: &str| match word {
        "lab" | "labs" | "simlab" | "simlabs" => Some("lab"),
        "quiz" | "quizzes" | "quizes" | "quizs" => Some("quiz"),
        _ => None,
    };
    let words = language.split(|c: char| !c.is_alphanumeric()).filter(|word| !word.is_empty());
    let kinds: Option<Vec<_>> = words.map(kind_of).collect();
    let kinds = kinds?;
    if kinds.contains(&"quiz") { Some("quiz") } else { kinds.first().copied() }
}

/// The intended kind of a misspelt fence, and its spelling.
pub(super) fn meant(open: &Opener, kind: &BlockKind, body: &str) -> Option<(&'static str, BlockKind)> {
    let lab_of = |kind: LabKind| (kind.fence(), BlockKind::Lab(kind));
    let lab = lab_of(LabKind::Simulation);
    let quiz = ("quiz", BlockKind::Quiz);
    match kind {
        BlockKind::Widget(name) => match nearest(name, LabKind::ALL.map(LabKind::word)) {
            Some(word) => LabKind::named(word).map(lab_of),
            None => name.starts_with('{').then_some(lab),
        },
        BlockKind::Code { language, .. } => {
            let holds_json = body.trim_start().starts_with(['{', '[']);
            match in_other_words(&open.words).filter(|_| holds_json) {
                Some("quiz") => return Some(quiz),
                Some(_) => return Some(lab),
                None => {}
            }
            match joined_or_plural(language).filter(|_| holds_json) {
                Some("quiz") => return Some(quiz),
                Some(_) => return Some(lab),
                None => {}
            }
            match nearest(language, ["lab", "quiz", "simlab"])? {
                // A language with a similar name is not reported, unless the fence contains a lab or a quiz.
                _ if bare_json(body).next().is_none() => None,
                "quiz" => Some(quiz),
                _ => Some(lab),
            }
        }
        _ => None,
    }
}

/// The kind of a lab or a quiz whose JSON is the whole content of a fence of another language.
pub(super) fn listed(kind: &BlockKind, body: &str) -> Option<&'static str> {
    let BlockKind::Code { .. } = kind else { return None };
    let body = body.trim();
    if !(body.starts_with('{') && body.ends_with('}')) {
        return None;
    }
    let found = bare_json(body).next().filter(|found| found.line == 0)?;
    Some(if found.is_quiz { "quiz" } else { LabKind::Simulation.fence() })
}

/// Whether the last line of a block closes it.
pub(super) fn is_closed(text: &str, span: &Range<usize>, open: &Opener) -> bool {
    let Some(below) = text.get(open.line.end..span.end) else { return false };
    let Some((_, last)) = below.trim_end_matches(['\n', '\r']).rsplit_once('\n') else { return false };
    let last = last.trim_start_matches([' ', '>', '\t']).trim_end();
    last.len() >= open.count && last.chars().all(|c| c == open.mark)
}

/// The end of a damaged block, in bytes of its body.
pub(super) struct Cut {
    /// End of the content of the block.
    pub(super) end: usize,
    /// Where the rest of the lesson begins, if there is any.
    pub(super) resume: Option<usize>,
}

/// The first line of a body that opens another fence, which the outer fence should not contain.
fn inner_opener(body: &str, open: &Opener, any_word: bool) -> Option<usize> {
    let mut offset = 0;
    for line in body.split_inclusive('\n') {
        if let Some(inner) = opener(line, 0)
            && inner.mark == open.mark
            && inner.count >= open.count
            && inner
                .words
                .first()
                .is_some_and(|w| any_word || w.starts_with(|c: char| c.is_ascii_alphabetic()))
            && line.len() - line.trim_start().len() <= 3
            && offset > 0
        {
            return Some(offset);
        }
        offset += line.len();
    }
    None
}

/// The end of a lab or a quiz without its closing line. `None` when nothing is wrong.
pub(super) fn cut_json(body: &str, open: &Opener, closed: bool) -> Option<Cut> {
    let inner = inner_opener(body, open, true);
    let object = extent::json_end(body);
    if closed && inner.is_none() {
        // The fence is closed, possibly by a line that opens another fence. In that case, prose follows the object on
        // separate lines.
        let end = object?;
        let below = body.get(end..)?;
        let next_line = below.find('\n').map(|i| end + i + 1)?;
        let on_line = body.get(end..next_line)?;
        let after = body.get(next_line..)?.trim_start();
        let is_json = after.starts_with(['{', '}', ']', ',', '"', ':', '“']);
        let is_prose = on_line.trim().is_empty() && !after.is_empty() && !is_json;
        return is_prose.then_some(Cut { end, resume: Some(next_line) });
    }
    if closed || inner.is_some() || object.is_some() {
        let end = match (object, inner) {
            (Some(end), Some(inner)) if end > inner => inner,
            (Some(end), _) => end,
            (None, inner) => inner.unwrap_or(body.len()),
        };
        let next_line = match inner {
            Some(inner) if inner == end => inner,
            _ => body.get(end..).and_then(|b| b.find('\n')).map_or(body.len(), |i| end + i + 1),
        };
        let more = body.get(next_line..).is_some_and(|rest| !rest.trim().is_empty());
        return more.then_some(Cut { end, resume: Some(next_line) });
    }
    None
}

/// The end of a listing without its closing line. `None` when nothing is wrong, or nothing follows.
pub(super) fn cut_listing(body: &str, open: &Opener, closed: bool) -> Option<Cut> {
    let mut end = inner_opener(body, open, false);
    if end.is_none() && !closed {
        end = bare_json(body).next().map(|found| found.line);
    }
    end.map(|end| Cut { end, resume: Some(end) })
}
