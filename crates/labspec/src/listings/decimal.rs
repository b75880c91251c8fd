//! Decimal numbers by their digits, without rounding to binary numbers.

use std::ops::Range;

/// The maximum number of digits of an exponent.
const MAX_EXPONENT_DIGITS: usize = 4;

/// A number as digits: `-1.50e3` has the digits `150`, and its last digit counts tens.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Decimal {
    negative: bool,
    /// Without leading zeros; empty for zero.
    digits: String,
    /// The power of ten of the last digit.
    last: i64,
    /// As written; 0 without one.
    exponent: i64,
}

/// A part of a word: a number, or other characters.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Segment {
    /// Its bytes within the word.
    pub(super) range: Range<usize>,
    /// Its value, if it is a number.
    pub(super) number: Option<Decimal>,
}

/// The numbers of a word and the characters between them. Digits in a name (`x2`) and versions (`3.14.0`) are not numbers.
pub(super) fn segments(word: &str) -> Vec<Segment> {
    let mut all: Vec<Segment> = Vec::new();
    let (mut at, mut text) = (0, 0);
    let mut previous = None;
    while let Some(c) = word.get(at..).and_then(|rest| rest.chars().next()) {
        let rest = word.get(at..).unwrap_or("");
        let length = token_length(rest, previous);
        let number = length.and_then(|n| Decimal::parse(rest.get(..n)?));
        let n = length.unwrap_or(c.len_utf8());
        if let Some(number) = number {
            if text < at {
                all.push(Segment { range: text..at, number: None });
            }
            all.push(Segment { range: at..at + n, number: Some(number) });
            text = at + n;
        }
        previous = word.get(at..at + n).and_then(|part| part.chars().next_back());
        at += n;
    }
    if text < word.len() {
        all.push(Segment { range: text..word.len(), number: None });
    }
    all
}

fn is_minus(c: char) -> bool {
    matches!(c, '-' | '−')
}

fn count_digits(text: &str) -> usize {
    text.bytes().take_while(u8::is_ascii_digit).count()
}

/// The length of the number or version at the start of a text, or `None` if there is none.
fn token_length(text: &str, previous: Option<char>) -> Option<usize> {
    let in_name = previous.is_some_and(|c| c.is_alphanumeric() || c == '_');
    let sign = text.chars().next().filter(|c| is_minus(*c) || *c == '+').map_or(0, char::len_utf8);
    if in_name || (sign > 0 && previous.is_some_and(|c| matches!(c, ')' | ']' | '.'))) {
        return None;
    }
    let unsigned = text.get(sign..)?;
    let whole = count_digits(unsigned);
    let fraction = unsigned.get(whole..)?.strip_prefix('.').map_or(0, count_digits);
    if whole + fraction == 0 {
        return None;
    }
    let mut length = sign + whole + if fraction > 0 { fraction + 1 } else { 0 };
    let rest = text.get(length..)?;
    if rest.strip_prefix('.').is_some_and(|more| fraction > 0 && count_digits(more) > 0) {
        // A version or a date.
        return Some(length + rest.bytes().take_while(|b| b.is_ascii_digit() || *b == b'.').count());
    }
    if let Some(exponent) = rest.strip_prefix(['e', 'E']) {
        let sign = usize::from(exponent.starts_with(['+', '-']));
        let digits = exponent.get(sign..).map_or(0, count_digits);
        if digits > 0 {
            length += 1 + sign + digits;
        }
    }
    Some(length)
}

impl Decimal {
    /// The number that a text denotes as a whole; `None` for a version, and for exponents that no output has.
    fn parse(text: &str) -> Option<Decimal> {
        let unsigned = text.trim_start_matches(['+', '-', '−']);
        let (mantissa, exponent) = match unsigned.split_once(['e', 'E']) {
            Some((mantissa, exponent)) => (mantissa, exponent),
            None => (unsigned, "0"),
        };
        if exponent.trim_start_matches(['+', '-']).len() > MAX_EXPONENT_DIGITS {
            return None;
        }
        let exponent: i64 = exponent.parse().ok()?;
        let (whole, fraction) = mantissa.split_once('.').unwrap_or((mantissa, ""));
        if fraction.contains('.') {
            return None;
        }
        let digits = format!("{whole}{fraction}").trim_start_matches('0').to_string();
        let last = exponent.checked_sub(i64::try_from(fraction.len()).ok()?)?;
        Some(Decimal { negative: text.starts_with(is_minus), digits, last, exponent })
    }

    /// Whether this number is the printed one, rounded to the digits that this number has. Both directions are accepted for a
    /// printed number in the middle.
    pub(super) fn is_rounding_of(&self, printed: &Decimal) -> bool {
        let Ok(dropped) = usize::try_from(self.last - printed.last) else { return false };
        let places = printed.digits.len();
        let zeros = dropped.saturating_sub(places);
        let (head, tail) = printed.digits.split_at(places.saturating_sub(dropped));
        // The dropped digits, compared with one half of the last digit that stays.
        let first = if zeros > 0 { b'0' } else { tail.bytes().next().unwrap_or(b'0') };
        let is_middle = zeros == 0 && first == b'5' && tail.bytes().skip(1).all(|b| b == b'0');
        let mut candidates = Vec::new();
        if first < b'5' || is_middle {
            candidates.push(head.to_string());
        }
        if first >= b'5' {
            candidates.push(increment(head));
        }
        candidates.iter().any(|rounded| {
            let is_zero = rounded.is_empty() && self.digits.is_empty();
            // A zero has no sign; its exponent is a displayed digit like any other.
            let is_same_zero = is_zero && (!printed.digits.is_empty() || self.exponent == printed.exponent);
            *rounded == self.digits && if is_zero { is_same_zero } else { self.negative == printed.negative }
        })
    }
}

/// The digits of the next whole number.
fn increment(digits: &str) -> String {
    let stem = digits.trim_end_matches('9');
    let nines = digits.len() - stem.len();
    let (start, last) = stem.split_at(stem.len().saturating_sub(1));
    let next = last.bytes().next().map_or('1', |b| char::from(b + 1));
    format!("{start}{next}{}", "0".repeat(nines))
}
