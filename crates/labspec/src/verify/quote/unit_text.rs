//! The unit behind a number, as far as it goes.

use super::numeral::Chars;
use labspec_bind::units;
use labspec_expr::dimension::Dimension;

/// A unit as it is written.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::verify) struct Unit {
    /// Its text, with single spaces.
    pub(in crate::verify) text: String,
    /// What it means; `None` where that is not known: `mm per step`, `dB`.
    pub(in crate::verify) dimension: Option<Dimension>,
    /// How it belongs to its number.
    pub(in crate::verify) link: Link,
}

/// How a unit belongs to a number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::verify) enum Link {
    /// It stands behind it.
    Own,
    /// It stands behind a later number, or in the head of the column.
    Shared,
    /// The clause of the number names it: it may be that of something else.
    Clause,
}

impl Unit {
    /// The power of ten that makes a fraction of one of it: of a percentage -2.
    pub(super) fn share(&self) -> Option<i32> {
        match self.text.as_str() {
            "%" | "percent" | "per cent" | "pct" | "Prozent" => Some(-2),
            "‰" | "per mille" | "permille" => Some(-3),
            _ => None,
        }
    }

    /// Whether it stands behind its number, or is shared with another one, and is none of things that are counted.
    pub(super) fn is_own(&self) -> bool {
        self.link != Link::Clause && !self.is_counted()
    }

    /// Whether it is a name of things that are counted: `steps`, `bounces`.
    pub(super) fn is_counted(&self) -> bool {
        COUNTED.contains(&self.text.as_str())
    }

    /// Whether its text may be a symbol of a formula as well: `2 h` are two hours, or two timesteps.
    pub(super) fn is_doubtful(&self) -> bool {
        matches!(self.text.as_str(), "A" | "C" | "K" | "L" | "V" | "T" | "g" | "h" | "l")
    }
}

/// Longest unit, in characters.
const LONG: usize = 40;

/// The unit behind a number that ends at a character, and where it ends.
pub(super) fn unit_behind(chars: Chars<'_>, end: usize) -> Option<(Unit, usize)> {
    let text = chars.text(end, end + LONG);
    let line = text.split('\n').next().unwrap_or("");
    let (unit, bytes) = unit_of(line)?;
    Some((unit, end + line.get(..bytes)?.chars().count()))
}

/// The unit that a text begins with, and the bytes up to its end, the space before it included.
fn unit_of(line: &str) -> Option<(Unit, usize)> {
    let trimmed = line.trim_start_matches(' ');
    let mut from = line.len() - trimmed.len();
    if from > 1 {
        return None;
    }
    // The raised ring of TeX: `30^\circ`.
    from += usize::from(trimmed.starts_with("^°"));
    if from == 0
        && let Some(tail) = line.strip_prefix('-')
        && tail.starts_with(char::is_alphabetic)
    {
        return hyphenated_unit(tail);
    }
    let rest = line.get(from..)?;
    if let Some((unit, length)) = percentage(rest) {
        return Some((unit, from + length));
    }
    // `3 per second`, `3/s`
    let over = ["per ", "/"].into_iter().find_map(|sign| rest.strip_prefix(sign).map(|tail| (sign, tail)));
    let (sign, body) = over.map_or(("", rest), |(sign, tail)| (sign, tail));
    let body_from = sign.len();
    let read = units::read(body).filter(|found| !goes_on(body.get(found.length..).unwrap_or("")));
    let Some(found) = read else {
        let word = rest.get(..word_length(rest)).unwrap_or("");
        if COUNTED.contains(&word) {
            let dimension = Some(Dimension::NUMBER);
            return Some((Unit { text: word.into(), dimension, link: Link::Own }, from + word.len()));
        }
        // Once for each of something that is no unit: the number is of that.
        let word = word_length(body);
        return (!sign.is_empty() && word > 0).then(|| {
            let length = body_from + word;
            let text = rest.get(..length).unwrap_or("").to_string();
            (Unit { text, dimension: None, link: Link::Own }, from + length)
        });
    };
    let mut dimension = found.dimension;
    if !sign.is_empty() {
        dimension = dimension.and_then(|d| d.power(-1.0));
    }
    let mut length = body_from + found.length;
    // `0.7 mm per step`, `0.7 mm/step`
    let tail = rest.get(length..).unwrap_or("");
    for sign in [" per ", "/", " / "] {
        let word = tail.strip_prefix(sign).map_or(0, word_length);
        if word > 0 {
            length += sign.len() + word;
            dimension = None;
            break;
        }
    }
    let text = rest.get(..length)?.to_string();
    from += length;
    Some((Unit { text, dimension, link: Link::Own }, from))
}

/// The unit of an adjective, as in `a 0.5-second fall`, behind its hyphen.
fn hyphenated_unit(tail: &str) -> Option<(Unit, usize)> {
    let found = units::read(tail)?;
    let text = tail.get(..found.length)?;
    let whole = text.chars().count() > 0 && !goes_on(tail.get(found.length..)?);
    whole.then(|| (Unit { text: text.into(), dimension: found.dimension, link: Link::Own }, 1 + found.length))
}

/// A word for a percentage that a text begins with, and its bytes.
fn percentage(rest: &str) -> Option<(Unit, usize)> {
    let words = ["percent", "per cent", "per mille", "permille", "pct", "Prozent"];
    let word = words.into_iter().find(|word| {
        rest.get(..word.len()).is_some_and(|w| w.eq_ignore_ascii_case(word))
            && !goes_on(rest.get(word.len()..).unwrap_or(""))
    })?;
    let factor = if word.ends_with("mille") { 1000.0 } else { 100.0 };
    let dimension = Some(Dimension::NUMBER.times(factor));
    Some((Unit { text: word.into(), dimension, link: Link::Own }, word.len()))
}

/// What is counted: a number of them has no other unit.
const COUNTED: [&str; 15] = [
    "steps",
    "frames",
    "samples",
    "ticks",
    "beats",
    "bounces",
    "contacts",
    "collisions",
    "swings",
    "periods",
    "oscillations",
    "cycles",
    "laps",
    "jumps",
    "pieces",
];

/// Length of the letters that a text begins with.
fn word_length(text: &str) -> usize {
    text.chars().take_while(|c| c.is_alphabetic() && !units::is_wide(*c)).map(char::len_utf8).sum()
}

/// Whether a word goes on.
fn goes_on(tail: &str) -> bool {
    tail.starts_with(|c: char| c.is_alphanumeric() && !units::is_wide(c) || c == '_')
}
