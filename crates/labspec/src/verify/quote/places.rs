//! Finds where texts appear as separate numbers: all quotes are searched at once, in one pass through the text.

use super::numeral::{Chars, fraction};
use super::quantity::{Quantity, quantities, separate_quantities};
use super::unit_text::{Link, Unit};
use super::{fold, html};
use labspec_bind::units::is_wide;
use std::ops::Range;

/// Maximum number of reported places of one quote.
pub(super) const MAX_PLACES: usize = 1000;

/// Maximum length of a searched text, in bytes: this bounds the work at every number.
const MAX_LENGTH: usize = 120;

/// A searched text.
#[derive(Debug)]
struct SearchedText {
    folded: String,
    /// The index of its first digit: the search begins at numbers.
    digit: usize,
    /// The quantities that it states when it is read alone.
    quantities: Vec<Quantity>,
    found: Vec<QuoteMatch>,
}

/// A node of a trie over the bytes of the searched texts, from their first digits on.
#[derive(Debug, Default)]
struct TrieNode {
    next: Vec<(u8, u32)>,
    ends: Vec<u32>,
}

/// Quotes, and where they were found.
#[derive(Debug)]
pub(super) struct Search {
    needles: Vec<SearchedText>,
    nodes: Vec<TrieNode>,
    /// Number of steps, for tests that the work is proportional to the text.
    pub(super) work: usize,
}

impl Search {
    pub(super) fn new() -> Search {
        Search { needles: Vec::new(), nodes: vec![TrieNode::default()], work: 0 }
    }

    /// Adds a quote; returns the index of its results.
    pub(super) fn add(&mut self, quote: &str) -> usize {
        let (rendered, _) = html::strip(quote);
        let folded = fold::fold(&rendered, true).0.trim_matches('\n').to_string();
        let digit = folded.find(is_anchor);
        let number = self.needles.len();
        // A longer text is not searched, and its numbers are not read.
        let digit = digit.filter(|_| folded.len() <= MAX_LENGTH);
        let tail = digit.and_then(|start| folded.get(start..)).unwrap_or("");
        let mut node = 0;
        for &b in tail.as_bytes() {
            node = match self.child(node, b) {
                Some(next) => next,
                None => {
                    let next = self.nodes.len();
                    self.nodes.push(TrieNode::default());
                    if let Some(n) = self.nodes.get_mut(node) {
                        n.next.push((b, next as u32));
                    }
                    next
                }
            };
        }
        if digit.is_some()
            && let Some(n) = self.nodes.get_mut(node)
        {
            n.ends.push(number as u32);
        }
        let chars: Vec<char> = fold::fold(&rendered, false).0.trim_matches('\n').chars().collect();
        let quantities = if digit.is_some() { quantities(Chars(&chars)) } else { Vec::new() };
        self.needles.push(SearchedText { folded, digit: digit.unwrap_or(0), quantities, found: Vec::new() });
        number
    }

    fn child(&self, node: usize, b: u8) -> Option<usize> {
        self.nodes.get(node)?.next.iter().find(|(c, _)| *c == b).map(|(_, next)| *next as usize)
    }

    /// Searches a text.
    pub(super) fn walk(&mut self, text: &Readable) {
        let bytes = text.flat.as_bytes();
        let mut previous = b' ';
        for (start, &first) in bytes.iter().enumerate() {
            let goes_on = first.is_ascii_digit() && previous.is_ascii_digit();
            previous = first;
            // The beginning of a sequence of digits, or a byte that may begin a fraction character.
            if goes_on || !(first.is_ascii_digit() || first == 0xc2 || first == 0xe2) {
                continue;
            }
            let mut node = 0;
            for (index, &b) in bytes.iter().enumerate().skip(start) {
                self.work += 1;
                let Some(next) = self.child(node, b) else { break };
                node = next;
                for i in 0..self.nodes.get(node).map_or(0, |n| n.ends.len()) {
                    self.note(node, i, start, index + 1, text);
                }
            }
        }
    }

    /// Records a match if the part before the first digit matches too.
    fn note(&mut self, node: usize, i: usize, start: usize, end: usize, text: &Readable) {
        let Some(&number) = self.nodes.get(node).and_then(|n| n.ends.get(i)) else { return };
        let Some(needle) = self.needles.get_mut(number as usize) else { return };
        let Some(begin) = start.checked_sub(needle.digit) else { return };
        let head = needle.folded.get(..needle.digit);
        if needle.found.len() < MAX_PLACES && text.flat.get(begin..start) == head {
            needle.found.extend(text.states(&(begin..end), &needle.quantities));
        }
    }

    /// The places where a quote appears.
    pub(super) fn found(&self, number: usize) -> &[QuoteMatch] {
        self.needles.get(number).map_or(&[], |n| &n.found)
    }
}

fn is_anchor(c: char) -> bool {
    c.is_ascii_digit() || fraction(c).is_some()
}

/// Whether a range begins and ends at word boundaries.
fn whole_words(text: &str, range: &Range<usize>) -> bool {
    let Some(quote) = text.get(range.clone()) else { return false };
    let letter = |c: Option<char>| c.filter(|c| c.is_alphanumeric() && !is_wide(*c));
    let before = letter(text.get(..range.start).and_then(|t| t.chars().next_back()));
    let after = letter(text.get(range.end..).and_then(|t| t.chars().next()));
    let begins = before.is_some() && letter(quote.chars().next()).is_some();
    let goes_on = after.is_some() && letter(quote.chars().next_back()).is_some_and(|c| !c.is_numeric());
    !begins && !goes_on
}

/// A place where a quote appears.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct QuoteMatch {
    /// Bytes of the text that was searched.
    pub(super) bytes: Range<usize>,
    /// The unit that the text has after the last number of the quote, if the quote ends with that number.
    pub(super) unit: Option<Unit>,
}

/// A text with its quantities.
pub(super) struct Readable {
    /// The normalized text, with all dashes alike.
    pub(super) flat: String,
    /// The index of the character for each byte of `flat`.
    character: Vec<u32>,
    quantities: Vec<Quantity>,
    /// The quantities with the ends of ranges as separate quantities.
    separate: Vec<Quantity>,
}

impl Readable {
    /// `chars` are the characters of `flat`, but with different dashes.
    pub(super) fn new(flat: String, chars: &[char]) -> Readable {
        let mut character = Vec::with_capacity(flat.len() + 1);
        for (i, c) in flat.chars().enumerate() {
            character.extend(std::iter::repeat_n(i as u32, c.len_utf8()));
        }
        character.push(chars.len() as u32);
        Readable {
            flat,
            character,
            quantities: quantities(Chars(chars)),
            separate: separate_quantities(Chars(chars)),
        }
    }

    /// Whether the text at a range states what the quote states when it is read alone: the same numbers with the same
    /// signs, factors and units, none of them part of another expression.
    fn states(&self, bytes: &Range<usize>, quantities: &[Quantity]) -> Option<QuoteMatch> {
        if !whole_words(&self.flat, bytes) {
            return None;
        }
        let character_at = |byte: usize| self.character.get(byte).map(|i| *i as usize);
        let (start, end) = (character_at(bytes.start)?, character_at(bytes.end)?);
        let among = |all: &[Quantity]| states(all, start..end, quantities);
        let unit = among(&self.quantities).or_else(|| among(&self.separate))?;
        Some(QuoteMatch { bytes: bytes.clone(), unit })
    }
}

/// Whether the quantities in a range of characters are those of a quote. Returns the unit that the text has after the last
/// of them.
fn states(all: &[Quantity], range: Range<usize>, quantities: &[Quantity]) -> Option<Option<Unit>> {
    let Range { start, end } = range;
    let first = all.partition_point(|q| q.whole.end <= start);
    let mut here = all.get(first..)?.iter().take_while(|q| q.whole.start < end);
    let mut unit = None;
    for (i, quoted) in quantities.iter().enumerate() {
        let in_text = here.next()?;
        let inside =
            in_text.digits == start + quoted.digits && in_text.number_end == start + quoted.number_end;
        // A plus sign before it has no meaning.
        let begins = in_text.whole.start >= start || in_text.whole.start + 1 == start;
        // A quote that cannot be read gets a finding when it is read.
        let clear = quoted.refused.is_some() || in_text.refused.is_none();
        if !(inside && begins && clear && quoted.states(in_text)) {
            return None;
        }
        let text = |q: &Quantity| q.unit.as_ref().map(|u| u.text.clone());
        if text(quoted) == text(in_text) {
            if in_text.whole.end > end && in_text.unit.as_ref().is_some_and(|u| u.link == Link::Direct) {
                return None;
            }
            continue;
        }
        let last = i + 1 == quantities.len();
        if quoted.unit.is_some() && !quoted.unit.as_ref().is_some_and(|u| u.link != Link::Direct) || !last {
            return None;
        }
        // In `0.7 mm per step`, the number alone is not the quantity.
        if in_text.unit.as_ref().is_some_and(|u| u.dimension.is_none() && u.link != Link::Clause) {
            return None;
        }
        unit = in_text.unit.clone();
    }
    here.next().is_none().then_some(unit)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn readable(text: &str) -> Readable {
        let chars: Vec<char> = fold::fold(text, false).0.chars().collect();
        Readable::new(fold::fold(text, true).0, &chars)
    }

    fn starts_of(text: &str, quote: &str) -> Vec<usize> {
        let mut search = Search::new();
        let n = search.add(quote);
        search.walk(&readable(text));
        search.found(n).iter().map(|r| r.bytes.start).collect()
    }

    #[test]
    fn a_quote_is_a_number_of_its_own() {
        for (text, quote, found) in [
            ("at 0.44.", "0.44", vec![3]),
            ("21.5 and 1.5", "1.5", vec![9]),
            ("at -0.7357 now", "-0.7357", vec![3]),
            ("at \u{2212}0.7357 now", "-0.7357", vec![3]),
            ("0.442 s, 0.442 s", "0.442 s", vec![0, 9]),
            ("$2.4\\times10^{-4}$", "2.4×10⁻⁴", vec![0]),
            ("it takes about 29 mm", "about 29 mm", vec![9]),
            ("a ball — 5 m", "5 m", vec![9]),
            ("下落需要0.5秒。", "0.5秒", vec![12]),
            ("下落需要0.5秒。", "0.5", vec![12]),
            ("it takes +0.5 s", "0.5 s", vec![10]),
            ("(0.5 s)", "0.5 s", vec![1]),
            ("from 0.3 s to 0.5 s", "0.5 s", vec![14]),
            ("from 2.31 to 3.73 N m", "2.31", vec![5]),
            ("between 0.4 J and 0.5 J", "0.4 J", vec![8]),
            ("between 0.4 J and 0.5 J", "0.5 J", vec![18]),
            ("up to 27 mm deep", "27 mm", vec![6]),
            ("no more than 41 ms", "41 ms", vec![13]),
            ("0.5 thousand s", "0.5 thousand s", vec![0]),
            ("a 0.5-second fall", "0.5", vec![2]),
            ("0.7 mm per step", "0.7 mm per step", vec![0]),
            ("½ m", "½ m", vec![0]),
            ("3 m, 3 m.", "3 m", vec![0, 5]),
            ("a 0.5 kg stone", "0.5 kg", vec![2]),
            ("0.5 m au sol", "0.5 m", vec![0]),
            ("0.5 m ✓", "0.5 m", vec![0]),
            ("0.5 m†", "0.5 m", vec![0]),
            ("0.5 makes A move", "0.5", vec![0]),
            ("0.5 gives a second bounce", "0.5", vec![0]),
            ("0.01 s steps", "0.01 s", vec![0]),
        ] {
            assert_eq!(starts_of(text, quote), found, "{quote} in {text}");
        }
        for (text, quote) in [
            ("at 0.442 s", "0.44"),
            ("-0.44", "0.44"),
            ("\u{2212}0.44 s", "0.44 s"),
            ("0.442 mm", "0.442 m"),
            ("0.442 seconds", "0.442 s"),
            ("3 m/s", "3 m"),
            ("3 m²", "3 m"),
            ("2.4e-4", "2.4"),
            ("2.4 x 10^-4", "2.4"),
            ("$2.4 \\times 10^{-4}$", "2.4"),
            ("1,500 m", "500 m"),
            ("1\u{2009}500 m", "500 m"),
            ("1,500 m", "1"),
            ("x_2, x^2, t2, #2", "2"),
            ("10^-3", "-3"),
            ("0.442(3)", "0.442"),
            ("1½", "½"),
            ("0.5 m\u{1}s", "0.5 ms"),
            ("0.4–0.5", "0.5"),
            ("run 2 500 N", "500 N"),
        ] {
            assert_eq!(starts_of(text, quote), Vec::<usize>::new(), "{quote} in {text}");
        }
    }

    /// The work grows with the text and not with the number of quotes.
    #[test]
    fn many_quotes_cost_one_pass() {
        let text = "0.442 s and 0.4421 s; ".repeat(50_000);
        let mut search = Search::new();
        let all: Vec<usize> = (0..400).map(|i| search.add(&format!("0.442{i} s"))).collect();
        search.walk(&readable(&text));
        assert_eq!(search.found(all[1]).len(), MAX_PLACES);
        assert!(search.found(all[2]).is_empty());
        assert!(search.work < 2 * text.len(), "{} steps for {} bytes", search.work, text.len());
    }
}
