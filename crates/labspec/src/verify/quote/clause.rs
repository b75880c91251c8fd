//! The clause around a place of the text, or the first cell of its row.

use std::ops::Range;

/// The most bytes of a text before and behind a place that are read, and of its row before it.
const REACH: usize = 400;
const ROW: usize = 4000;
/// Signs that separate clauses. `.` and `,` do so only before a space: `1.42 s`.
const SEPARATORS: [char; 12] = [';', ':', '!', '?', '(', ')', '"', '<', '>', '|', '—', '–'];
/// Words between clauses.
const WORDS: [&str; 14] = [
    " and ",
    " but ",
    " while ",
    " whereas ",
    " against ",
    " instead ",
    " und ",
    " aber ",
    " während ",
    " et ",
    " mais ",
    " y ",
    " pero ",
    " e ",
];

/// The beginnings of items of a list.
const LIST_ITEMS: [&str; 3] = ["\n- ", "\n* ", "\n+ "];

/// The most words of an introduction.
const INTRODUCTION: usize = 8;

/// The clause around a place.
#[derive(Clone, Debug, Default, PartialEq)]
pub(in crate::verify) struct Clause {
    /// Its text; in a row of a table, the first cell of the row.
    pub(in crate::verify) text: String,
    /// A few words before it, from the start of the sentence up to a comma or a colon: `From 0.1 rad, a swing takes`.
    pub(in crate::verify) introduction: String,
}

/// The clause around a place; in a row of a table, its first cell.
pub(super) fn clause_of(file: &str, place: &Range<usize>) -> Clause {
    let before = file.get(..place.start).unwrap_or("");
    let behind = file.get(place.end..).unwrap_or("");
    let near = before.len().saturating_sub(ROW);
    let near = (near..=before.len()).find_map(|i| before.get(i..)).unwrap_or("");
    let line = near.rsplit('\n').next().unwrap_or(near);
    if let Some(cells) = line.trim_start().strip_prefix('|') {
        let text = cells.split('|').next().unwrap_or("").trim().to_string();
        return Clause { text, introduction: String::new() };
    }
    let start = (before.len().saturating_sub(REACH)..=before.len()).find(|i| before.is_char_boundary(*i));
    let before = before.get(start.unwrap_or(0)..).unwrap_or("");
    let paragraph = before.rsplit("\n\n").next().unwrap_or(before);
    let item = LIST_ITEMS.iter().filter_map(|mark| paragraph.rfind(mark)).max();
    let before = item.and_then(|start| paragraph.get(start..)).unwrap_or(paragraph).replace('\n', " ");
    let end = (0..=REACH.min(behind.len())).rev().find(|i| behind.is_char_boundary(*i)).unwrap_or(0);
    let behind = behind.get(..end).unwrap_or("");
    let paragraph = behind.split("\n\n").next().unwrap_or(behind);
    let item = LIST_ITEMS.iter().filter_map(|mark| paragraph.find(mark)).min();
    let behind = item.and_then(|end| paragraph.get(..end)).unwrap_or(paragraph).replace('\n', " ");
    let after_last = ends(&before).max().unwrap_or(0);
    let first = starts(&behind).min().unwrap_or(behind.len());
    let quote = file.get(place.clone()).unwrap_or("").replace('\n', " ");
    let clause = before.get(after_last..).unwrap_or("").trim_start();
    let text = format!("{clause}{quote}{}", behind.get(..first).unwrap_or("")).trim_end().to_string();
    let introduction = introduction(before.get(..after_last).unwrap_or("")).unwrap_or_default();
    Clause { text, introduction }
}

/// The few words of a sentence before a comma or a colon at the end of a text.
fn introduction(before: &str) -> Option<String> {
    let head = before.trim_end().strip_suffix([',', ':'])?;
    let is_end = |c: char, next: Option<char>| c != ',' && separates(c, next);
    let ends =
        head.char_indices().filter(|(i, c)| is_end(*c, head.get(i + c.len_utf8()..).and_then(first_of)));
    let start = ends.map(|(i, c)| i + c.len_utf8()).next_back().unwrap_or(0);
    let words: Vec<&str> = head.get(start..)?.split_whitespace().collect();
    (words.len() <= INTRODUCTION).then(|| words.join(" "))
}

/// Whether a character, with the one behind it, separates clauses.
fn separates(c: char, next: Option<char>) -> bool {
    SEPARATORS.contains(&c) || (c == '.' || c == ',') && next.is_none_or(char::is_whitespace)
}

/// The places behind separators.
fn ends(text: &str) -> impl Iterator<Item = usize> + '_ {
    let signs =
        text.char_indices().filter(|(i, c)| separates(*c, text.get(i + c.len_utf8()..).and_then(first_of)));
    let words = WORDS.iter().flat_map(|word| text.match_indices(word).map(|(i, word)| i + word.len()));
    signs.map(|(i, c)| i + c.len_utf8()).chain(words)
}

/// The places before separators.
fn starts(text: &str) -> impl Iterator<Item = usize> + '_ {
    let signs =
        text.char_indices().filter(|(i, c)| separates(*c, text.get(i + c.len_utf8()..).and_then(first_of)));
    let words = WORDS.iter().flat_map(|word| text.match_indices(word).map(|(i, _)| i));
    signs.map(|(i, _)| i).chain(words)
}

fn first_of(text: &str) -> Option<char> {
    text.chars().next()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_clause_ends_at_signs_and_conjunctions() {
        let clause = |text: &str, quote: &str| {
            let start = text.find(quote).unwrap();
            clause_of(text, &(start..start + quote.len())).text
        };
        let text =
            "Look: the small swing takes 1.65 s, the wide\none 1.42 s and on earth 7 s. The rest is 3 s";
        assert_eq!(clause(text, "1.65 s"), "the small swing takes 1.65 s");
        assert_eq!(clause(text, "1.42 s"), "the wide one 1.42 s");
        assert_eq!(clause(text, "7 s"), "on earth 7 s");
        assert_eq!(clause(text, "3 s"), "The rest is 3 s");
        assert_eq!(clause("| run | T |\n|---|---|\n| small | 1.42 s |\n", "1.42 s"), "small");
        assert_eq!(clause("it falls for 0.45 s on earth", "0.45 s"), "it falls for 0.45 s on earth");
    }

    #[test]
    fn a_sentence_may_begin_with_an_introduction() {
        let introduction = |text: &str, quote: &str| {
            let start = text.find(quote).unwrap();
            clause_of(text, &(start..start + quote.len())).introduction
        };
        assert_eq!(
            introduction("<!-- a -->\nReleased at 0.1 rad, it takes 1.65 s.", "1.65 s"),
            "Released at 0.1 rad"
        );
        assert_eq!(introduction("It falls. After 2 s, it is at 3 m.", "3 m"), "After 2 s");
        assert_eq!(introduction("From 0.1 rad it takes 1.42 s as always, then 7 s", "7 s"), "");
        assert_eq!(introduction("It takes 7 s", "7 s"), "");
        assert_eq!(introduction("- moon: 0.406 s", "0.406 s"), "- moon");
    }
}
