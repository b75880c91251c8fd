//! One fence: its opening line, whether it is closed, and where a damaged one really ends.

use super::{BlockKind, extent};
use labspec_finding::nearest;
use std::ops::Range;

/// The opening line of a fence.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Opener {
    /// The fence character.
    mark: char,
    /// How many of them.
    count: usize,
    /// Bytes of the line from the first mark, without its end.
    pub(crate) line: Range<usize>,
    /// Bytes of the marks and the info string, without what does not belong there.
    pub(crate) head: Range<usize>,
    /// Words of the info string.
    words: Vec<String>,
    /// Bytes of JSON or code that stands on this line and belongs below it.
    pub(crate) rest: Option<Range<usize>>,
}

impl Opener {
    /// What the fence holds.
    pub(crate) fn kind(&self) -> BlockKind {
        match self.words.first().map(String::as_str) {
            Some("lab") => BlockKind::Lab(self.words.get(1).cloned().unwrap_or_else(|| "simlab".into())),
            Some("quiz") => BlockKind::Quiz,
            first => BlockKind::Code {
                language: first.unwrap_or("").to_string(),
                file: self.words.iter().find_map(|w| w.strip_prefix("file=")).map(str::to_string),
            },
        }
    }

    /// What the lines below the opening line begin with: the `> ` of a quote, the indentation of a list.
    pub(crate) fn prefix(&self, text: &str) -> String {
        let line = super::line_start(text, self.line.start);
        let before = text.get(line..self.line.start).unwrap_or("");
        before.chars().map(|c| if c == '>' || c.is_whitespace() { c } else { ' ' }).collect()
    }

    /// The line that closes this fence.
    pub(crate) fn closing(&self) -> String {
        self.mark.to_string().repeat(self.count)
    }
}

/// Reads the opening line that begins at `at` (perhaps indented).
pub(super) fn opener(text: &str, at: usize) -> Option<Opener> {
    let line = text.get(at..)?.lines().next()?;
    let start = at + line.len() - line.trim_start().len();
    let line = line.trim();
    let mark = line.chars().next().filter(|c| matches!(c, '`' | '~'))?;
    let info = line.trim_start_matches(mark);
    let count = line.len() - info.len();
    if count < 3 {
        return None;
    }
    let end = start + line.len();
    let info_at = end - info.len();
    let rest = belongs_below(info).map(|i| info_at + i..end);
    let head_end = rest.as_ref().map_or(end, |r| r.start);
    let head = text.get(start..head_end)?.trim_end();
    let words = text.get(info_at..head_end)?.split_whitespace().map(str::to_string).collect();
    Some(Opener { mark, count, line: start..end, head: start..start + head.len(), words, rest })
}

/// Where in an info string something begins that is no info: the JSON of a lab or quiz, or a listing.
fn belongs_below(info: &str) -> Option<usize> {
    let first = info.split_whitespace().next()?;
    if first == "lab" || first == "quiz" || first.starts_with("lab{") || first.starts_with("quiz{") {
        return info.find(['{', '[']).filter(|&at| !is_attributes(info.get(at..).unwrap_or("")));
    }
    if first.starts_with("{.") || first.starts_with("{lab") || first.starts_with("{quiz") {
        return None;
    }
    // Attributes are words, key=value pairs and {…}; anything else is code.
    let mut at = info.len() - info.trim_start().len() + first.len();
    let mut plain = 0;
    let mut candidate = None;
    while let Some(word) = info.get(at..).and_then(|rest| rest.split_whitespace().next()) {
        let begin = at + info.get(at..)?.find(word)?;
        let key = word.split('=').next().unwrap_or("");
        let is_name = !key.is_empty()
            && key.chars().all(|c| c.is_ascii_alphanumeric() || matches!(c, '-' | '_' | '.' | ':'));
        let is_attribute = (is_name && word.contains('=') && !word.ends_with('=')) || word.starts_with('{');
        if !is_attribute {
            candidate = candidate.or(Some(begin));
            plain += if is_name { 1 } else { 3 };
        }
        at = begin + word.len();
    }
    // One or two plain words after the language are common (`title`, `numbered`); a listing has more. Behind the
    // name of a file, nothing but a listing is left.
    candidate.filter(|_| plain >= if info.contains("file=") { 2 } else { 3 })
}

/// Whether these are the attributes of some Markdown dialects, `{.class #id key=value}`, and no JSON.
fn is_attributes(text: &str) -> bool {
    let Some(inside) =
        text.strip_prefix('{').and_then(|t| t.split_once('}')).map(|(inside, _)| inside.trim())
    else {
        return false;
    };
    let key = inside.split('=').next().unwrap_or("");
    let is_name = !key.is_empty() && key.chars().all(|c| c.is_ascii_alphanumeric() || matches!(c, '-' | '_'));
    inside.starts_with(['.', '#']) || (is_name && inside.contains('='))
}

/// `lab` or `quiz`, where a fence says so in the way of another Markdown dialect: ```{lab}, ```{.lab}, ```json lab.
fn in_other_words(words: &[String]) -> Option<&'static str> {
    let bare =
        |word: &String| word.trim_start_matches(['{', '.']).trim_end_matches([',', '}']).to_ascii_lowercase();
    let ours = |word: &String| ["lab", "quiz"].into_iter().find(|w| bare(word) == *w);
    let first = words.first()?;
    match bare(first).as_str() {
        "json" | "json5" | "jsonc" | "js" | "javascript" => ours(words.get(1)?),
        _ => ours(first),
    }
}

/// `lab` or `quiz`, where the word is made of ours alone: `lab-simlab`, `simlab`, `labs`, `quizzes`.
fn joined_or_plural(language: &str) -> Option<&'static str> {
    let language = language.to_ascii_lowercase();
    let ours = |word: &str| match word {
        "lab" | "labs" | "simlab" | "simlabs" => Some("lab"),
        "quiz" | "quizzes" | "quizes" | "quizs" => Some("quiz"),
        _ => None,
    };
    let words = language.split(|c: char| !c.is_alphanumeric()).filter(|word| !word.is_empty());
    let kinds: Option<Vec<_>> = words.map(ours).collect();
    let kinds = kinds?;
    if kinds.contains(&"quiz") { Some("quiz") } else { kinds.first().copied() }
}

/// The kind that a misspelt fence was meant to have, and how it is written.
pub(super) fn meant(open: &Opener, kind: &BlockKind, body: &str) -> Option<(&'static str, BlockKind)> {
    let lab = ("lab simlab", BlockKind::Lab("simlab".into()));
    let quiz = ("quiz", BlockKind::Quiz);
    match kind {
        BlockKind::Lab(widget) if widget != "simlab" => {
            (widget.starts_with('{') || nearest(widget, ["simlab"]).is_some()).then_some(lab)
        }
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
                // A language of a similar name is none of our business, unless it holds what we know.
                _ if super::loose::bare_json(body).next().is_none() => None,
                "quiz" => Some(quiz),
                _ => Some(lab),
            }
        }
        _ => None,
    }
}

/// Whether the last line of a block closes it.
pub(super) fn is_closed(text: &str, span: &Range<usize>, open: &Opener) -> bool {
    let Some(below) = text.get(open.line.end..span.end) else { return false };
    let Some((_, last)) = below.trim_end_matches(['\n', '\r']).rsplit_once('\n') else { return false };
    let last = last.trim_start_matches([' ', '>', '\t']).trim_end();
    last.len() >= open.count && last.chars().all(|c| c == open.mark)
}

/// Where a damaged block ends, in bytes of its body.
pub(super) struct Cut {
    /// End of what belongs to the block.
    pub(super) end: usize,
    /// Where the rest of the lesson begins, if there is any.
    pub(super) resume: Option<usize>,
}

/// The first line of a body that opens another fence, which the fence around it should not contain.
fn inner_opener(body: &str, open: &Opener, any_word: bool) -> Option<usize> {
    let mut at = 0;
    for line in body.split_inclusive('\n') {
        if let Some(inner) = opener(line, 0)
            && inner.mark == open.mark
            && inner.count >= open.count
            && inner
                .words
                .first()
                .is_some_and(|w| any_word || w.starts_with(|c: char| c.is_ascii_alphabetic()))
            && line.len() - line.trim_start().len() <= 3
            && at > 0
        {
            return Some(at);
        }
        at += line.len();
    }
    None
}

/// Where a lab or a quiz ends that lost its closing line. `None` when nothing is wrong.
pub(super) fn cut_json(body: &str, open: &Opener, closed: bool) -> Option<Cut> {
    let inner = inner_opener(body, open, true);
    let object = extent::json_end(body);
    if closed && inner.is_none() {
        // The fence was closed, perhaps by a line that was meant to open another one: then prose follows the
        // object on lines of its own.
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

/// Where a listing ends that lost its closing line. `None` when nothing is wrong, or nothing follows.
pub(super) fn cut_listing(body: &str, open: &Opener, closed: bool) -> Option<Cut> {
    let mut end = inner_opener(body, open, false);
    if end.is_none() && !closed {
        end = super::loose::bare_json(body).next().map(|found| found.line);
    }
    end.map(|end| Cut { end, resume: Some(end) })
}
