//! Where texts stand as numbers of their own: all quotes are looked for at once, in one walk through the text.

use super::numeral::fraction;
use super::{fold, html};
use std::ops::Range;

/// Most places that are told of one quote.
pub(super) const MAX_PLACES: usize = 1000;

/// Longest text that is looked for, in bytes: so much may be walked at every number.
const MAX_LENGTH: usize = 120;

/// A text as it is looked for.
#[derive(Debug)]
struct Needle {
    folded: String,
    /// Where its first digit stands: the search begins at numbers.
    digit: usize,
    found: Vec<Range<usize>>,
}

/// A tree of the needles' bytes from their first digits on.
#[derive(Debug, Default)]
struct Node {
    next: Vec<(u8, u32)>,
    ends: Vec<u32>,
}

/// Quotes, and where they have been found.
#[derive(Debug)]
pub(super) struct Search {
    needles: Vec<Needle>,
    nodes: Vec<Node>,
    /// Steps taken, to know that the work stays in proportion to the text.
    pub(super) work: usize,
}

impl Search {
    pub(super) fn new() -> Search {
        Search { needles: Vec::new(), nodes: vec![Node::default()], work: 0 }
    }

    /// Adds a quote; the place of its results.
    pub(super) fn add(&mut self, quote: &str) -> usize {
        let (shown, _) = html::strip(quote);
        let folded = fold::fold(&shown, true).0.trim_matches('\n').to_string();
        let digit = folded.find(is_anchor);
        let number = self.needles.len();
        // Longer ones are not read either.
        let digit = digit.filter(|_| folded.len() <= MAX_LENGTH);
        let tail = digit.and_then(|at| folded.get(at..)).unwrap_or("");
        let mut node = 0;
        for &b in tail.as_bytes() {
            node = match self.child(node, b) {
                Some(next) => next,
                None => {
                    let next = self.nodes.len();
                    self.nodes.push(Node::default());
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
        self.needles.push(Needle { folded, digit: digit.unwrap_or(0), found: Vec::new() });
        number
    }

    fn child(&self, node: usize, b: u8) -> Option<usize> {
        self.nodes.get(node)?.next.iter().find(|(c, _)| *c == b).map(|(_, next)| *next as usize)
    }

    /// Looks through a folded text. `joined` tells of a space whether it was meant to hold digits together.
    pub(super) fn walk(&mut self, text: &str, joined: impl Fn(usize) -> bool) {
        let bytes = text.as_bytes();
        let mut previous = b' ';
        for (start, &first) in bytes.iter().enumerate() {
            let goes_on = first.is_ascii_digit() && previous.is_ascii_digit();
            previous = first;
            // A run of digits begins here, or a character that may be a fraction.
            if goes_on || !(first.is_ascii_digit() || first == 0xc2 || first == 0xe2) {
                continue;
            }
            let mut node = 0;
            for (at, &b) in bytes.iter().enumerate().skip(start) {
                self.work += 1;
                let Some(next) = self.child(node, b) else { break };
                node = next;
                for i in 0..self.nodes.get(node).map_or(0, |n| n.ends.len()) {
                    self.note(node, i, start, at + 1, text, &joined);
                }
            }
        }
    }

    /// Takes a needle in whose tail has been found.
    fn note(
        &mut self,
        node: usize,
        i: usize,
        start: usize,
        end: usize,
        text: &str,
        joined: &impl Fn(usize) -> bool,
    ) {
        let Some(&number) = self.nodes.get(node).and_then(|n| n.ends.get(i)) else { return };
        let Some(needle) = self.needles.get_mut(number as usize) else { return };
        let Some(begin) = start.checked_sub(needle.digit) else { return };
        let head = needle.folded.get(..needle.digit);
        if needle.found.len() < MAX_PLACES
            && text.get(begin..start) == head
            && is_own(text, begin..end, joined)
        {
            needle.found.push(begin..end);
        }
    }

    /// Where a quote stands.
    pub(super) fn found(&self, number: usize) -> &[Range<usize>] {
        self.needles.get(number).map_or(&[], |n| &n.found)
    }
}

fn is_anchor(c: char) -> bool {
    c.is_ascii_digit() || fraction(c).is_some()
}

/// Whether what stands at a range is a number of its own, with its whole unit: `0.44` is not said by `0.442` or
/// `-0.44`, `1.5` not by `21.5` or `1.5e-3`, `3 m` not by `3 mm` or `3 m/s`.
fn is_own(text: &str, range: Range<usize>, joined: &impl Fn(usize) -> bool) -> bool {
    let Some(quote) = text.get(range.clone()) else { return false };
    begins(text, &range, quote, joined) && ends(text, &range, quote, joined)
}

fn begins(text: &str, range: &Range<usize>, quote: &str, joined: &impl Fn(usize) -> bool) -> bool {
    let mut before = text.get(..range.start).unwrap_or("").chars().rev();
    let (last, second) = (before.next(), before.next());
    let Some(last) = last else { return true };
    let first = quote.chars().next().unwrap_or(' ');
    let digit_before = second.is_some_and(|c| c.is_ascii_digit());
    if is_anchor(first) || first == '.' {
        return match last {
            // A sign belongs to the number, unless it parts two.
            '-' if matches!(second, Some('e' | 'E')) => !is_digit(before.next()),
            '-' => second.is_some_and(|c| c.is_alphanumeric() || c == ')'),
            '.' | ',' | '\'' => !digit_before,
            ' ' => !(digit_before && joined(range.start - 1)),
            c => !(c.is_alphanumeric() || matches!(c, '^' | '_' | '#')),
        };
    }
    let word = first.is_alphanumeric() && last.is_alphanumeric();
    let exponent = matches!(first, '-' | '+') && matches!(last, '^' | 'e' | 'E') && is_digit(second);
    !(word || exponent)
}

/// The `e` of 1e-3, or the `^` of 10^-3, stands behind a digit.
fn is_digit(c: Option<char>) -> bool {
    c.is_some_and(|c| c.is_ascii_digit())
}

fn ends(text: &str, range: &Range<usize>, quote: &str, joined: &impl Fn(usize) -> bool) -> bool {
    let rest = text.get(range.end..).unwrap_or("");
    let mut after = rest.chars();
    let (next, second) = (after.next(), after.next());
    let (Some(next), last) = (next, quote.chars().next_back().unwrap_or(' ')) else { return true };
    let digit = |c: Option<char>| c.is_some_and(|c| c.is_ascii_digit());
    if last.is_ascii_digit() {
        return match next {
            '.' | ',' | '\'' => !digit(second),
            ' ' => !(digit(second) && joined(range.end) || power(rest.trim_start())),
            'e' | 'E' => !exponent(rest),
            '(' => !digit(second),
            '×' | '·' | '*' | 'x' => !power(rest),
            c => !(c.is_ascii_digit() || c == '^' || c == '_' || fraction(c).is_some()),
        };
    }
    if last.is_alphabetic() || last == '°' {
        let goes_on =
            matches!(next, '/' | '·' | '^') && second.is_some_and(|c| c.is_alphanumeric() || c == '-');
        return !(next.is_alphanumeric() || next == '_' || goes_on);
    }
    true
}

/// Whether a power of ten follows.
fn power(rest: &str) -> bool {
    let rest = rest.strip_prefix(['×', '·', '*', 'x']).map(str::trim_start);
    rest.and_then(|r| r.strip_prefix("10")).is_some_and(|r| r.starts_with('^') || r.starts_with("**"))
}

/// Whether an exponent follows: `e-3`, `e5`.
fn exponent(rest: &str) -> bool {
    let rest = rest.get(1..).unwrap_or("");
    let digits = rest.strip_prefix(['-', '+']).unwrap_or(rest);
    let length = digits.bytes().take_while(u8::is_ascii_digit).count();
    length > 0 && !digits.get(length..).unwrap_or("").starts_with(char::is_alphanumeric)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(text: &str, quote: &str) -> Vec<usize> {
        let (folded, _) = fold::fold(text, true);
        let mut search = Search::new();
        let n = search.add(quote);
        search.walk(&folded, |at| !folded[at..].starts_with(' ') || text.contains('\u{2009}'));
        search.found(n).iter().map(|r| r.start).collect()
    }

    #[test]
    fn a_quote_is_a_number_of_its_own() {
        for (text, quote, found) in [
            ("at 0.44.", "0.44", vec![3]),
            ("21.5 and 1.5", "1.5", vec![9]),
            ("x -0.7357 y", "-0.7357", vec![2]),
            ("x \u{2212}0.7357 y", "-0.7357", vec![2]),
            ("0.4–0.5", "0.5", vec![4]),
            ("0.442 s, 0.442 s", "0.442 s", vec![0, 9]),
            ("$2.4\\times10^{-4}$", "2.4×10⁻⁴", vec![0]),
            ("it takes about 29 mm", "about 29 mm", vec![9]),
            ("a - 5 m", "5 m", vec![4]),
            ("½ m", "½ m", vec![0]),
            ("run 2 500 N", "500 N", vec![6]),
            ("3 m, 3 m.", "3 m", vec![0, 5]),
        ] {
            assert_eq!(at(text, quote), found, "{quote} in {text}");
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
        ] {
            assert_eq!(at(text, quote), Vec::<usize>::new(), "{quote} in {text}");
        }
    }

    /// What is looked at grows with the text and not with the number of quotes.
    #[test]
    fn many_quotes_cost_one_walk() {
        let text = "0.442 s and 0.4421 s; ".repeat(50_000);
        let mut search = Search::new();
        let all: Vec<usize> = (0..400).map(|i| search.add(&format!("0.442{i} s"))).collect();
        search.walk(&text, |_| false);
        assert_eq!(search.found(all[1]).len(), MAX_PLACES);
        assert!(search.found(all[2]).is_empty());
        assert!(search.work < 2 * text.len(), "{} steps for {} bytes", search.work, text.len());
    }
}
