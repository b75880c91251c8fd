//! The opening line of a fence: its marks, its words, and misplaced text.

use super::{BlockKind, LabKind, line_start};
use std::ops::Range;

/// The opening line of a fence.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Opener {
    /// The fence character.
    pub(super) mark: char,
    /// Their number.
    pub(super) count: usize,
    /// Bytes of the line from the first mark, without the line end.
    pub(crate) line: Range<usize>,
    /// Bytes of the marks and the info string, without misplaced text.
    pub(crate) head: Range<usize>,
    /// Words of the info string.
    pub(super) words: Vec<String>,
    /// Bytes of JSON or code on this line that belongs on the next line.
    pub(crate) rest: Option<Range<usize>>,
}

impl Opener {
    /// The content of the fence.
    pub(crate) fn kind(&self) -> BlockKind {
        match self.words.first().map(String::as_str) {
            Some("lab") => match self.words.get(1) {
                None => BlockKind::Lab(LabKind::Simulation),
                Some(word) => {
                    LabKind::named(word).map_or_else(|| BlockKind::Widget(word.clone()), BlockKind::Lab)
                }
            },
            Some("quiz") => BlockKind::Quiz,
            first => BlockKind::Code {
                language: first.unwrap_or("").to_string(),
                file: self.words.iter().find_map(|w| w.strip_prefix("file=")).map(str::to_string),
            },
        }
    }

    /// The prefix of the lines after the opening line: the `> ` of a quote, the indentation of a list.
    pub(crate) fn prefix(&self, text: &str) -> String {
        let line = line_start(text, self.line.start);
        let before = text.get(line..self.line.start).unwrap_or("");
        before.chars().map(|c| if c == '>' || c.is_whitespace() { c } else { ' ' }).collect()
    }

    /// The line that closes this fence.
    pub(crate) fn closing(&self) -> String {
        self.mark.to_string().repeat(self.count)
    }
}

/// Reads the opening line that begins at `offset` (possibly indented).
pub(super) fn opener(text: &str, offset: usize) -> Option<Opener> {
    let line = text.get(offset..)?.lines().next()?;
    let start = offset + line.len() - line.trim_start().len();
    let line = line.trim();
    let mark = line.chars().next().filter(|c| matches!(c, '`' | '~'))?;
    let info = line.trim_start_matches(mark);
    let count = line.len() - info.len();
    if count < 3 {
        return None;
    }
    let end = start + line.len();
    let info_at = end - info.len();
    let rest = other_text_start(info).map(|i| info_at + i..end);
    let head_end = rest.as_ref().map_or(end, |r| r.start);
    let head = text.get(start..head_end)?.trim_end();
    let words = text.get(info_at..head_end)?.split_whitespace().map(str::to_string).collect();
    Some(Opener { mark, count, line: start..end, head: start..start + head.len(), words, rest })
}

/// The index in an info string where other text begins: the JSON of a lab or quiz, or a listing.
fn other_text_start(info: &str) -> Option<usize> {
    let first = info.split_whitespace().next()?;
    if first == "lab" || first == "quiz" || first.starts_with("lab{") || first.starts_with("quiz{") {
        return info.find(['{', '[']).filter(|&offset| !is_attributes(info.get(offset..).unwrap_or("")));
    }
    if first.starts_with("{.") || first.starts_with("{lab") || first.starts_with("{quiz") {
        return None;
    }
    // Attributes are words, key=value pairs and {…}; other text is code.
    let mut offset = info.len() - info.trim_start().len() + first.len();
    let mut plain = 0;
    let mut candidate = None;
    while let Some(word) = info.get(offset..).and_then(|rest| rest.split_whitespace().next()) {
        let begin = offset + info.get(offset..)?.find(word)?;
        let key = word.split('=').next().unwrap_or("");
        let is_name = !key.is_empty()
            && key.chars().all(|c| c.is_ascii_alphanumeric() || matches!(c, '-' | '_' | '.' | ':'));
        let is_attribute = (is_name && word.contains('=') && !word.ends_with('=')) || word.starts_with('{');
        if !is_attribute {
            candidate = candidate.or(Some(begin));
            plain += if is_name { 1 } else { 3 };
        }
        offset = begin + word.len();
    }
    // One or two plain words after the language are common (`title`, `numbered`); a listing has more. After a file name,
    // only a listing can follow.
    candidate.filter(|_| plain >= if info.contains("file=") { 2 } else { 3 })
}

/// Whether a text contains attributes of some Markdown dialects, `{.class #id key=value}`, and not JSON.
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
