//! Which number a quote states. What is not understood is refused by name, never guessed.

use super::number::{Form, Quoted, Style, ten};
use super::numeral::{Chars, Numeral, fraction, numeral};
use super::{fold, html};

/// What a quote was read as.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Reading {
    /// The number.
    pub(super) read: Quoted,
    /// The same as a fraction of one, for `50 %`.
    pub(super) share: Option<Quoted>,
    /// Other numbers that it could state, each with a reason.
    pub(super) doubts: Vec<(Quoted, &'static str)>,
    /// Why it is not called wrong when it does not fit.
    pub(super) unsure: Option<&'static str>,
    /// What stands behind the number, up to the next space: perhaps a unit.
    pub(super) unit: String,
}

/// Why no number was read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Unread {
    /// There is none.
    NoNumber,
    /// It is written in a way that is not read; this names it: "a ratio".
    Form(&'static str),
}

/// Longest quote that is read, in characters.
const MAX_QUOTE: usize = 120;

/// The number that a quote states: the first one behind the last `=`, else the first one.
///
/// # Errors
/// It holds none, or one in a form that is not read.
pub fn quoted(text: &str) -> Result<Quoted, Unread> {
    reading(text).map(|r| r.read)
}

/// The number that a quote states, with everything that casts doubt on it.
pub(super) fn reading(text: &str) -> Result<Reading, Unread> {
    let (shown, _) = html::strip(text);
    let (folded, _) = fold::fold(&shown, false);
    let chars: Vec<char> = folded.chars().take(MAX_QUOTE + 1).collect();
    if chars.len() > MAX_QUOTE {
        return Err(Unread::Form("a text as long as a paragraph"));
    }
    let chars = Chars(&chars);
    let numbers = numbers(chars);
    let equals = last_equals(chars, &numbers);
    let mut stated = numbers.iter().filter(|n| equals.is_none_or(|i| n.start > i));
    let Some(first) = stated.next() else {
        let is_formula = ["frac", "sqrt", "√"].into_iter().any(|word| folded.contains(word));
        return Err(if is_formula { Unread::Form("a formula") } else { Unread::NoNumber });
    };
    let second = stated.next();
    if let Some(form) = first.refused.or_else(|| unread_before(chars, first)) {
        return Err(Unread::Form(form));
    }
    let mut reading = Reading {
        read: first.quoted,
        share: None,
        doubts: Vec::new(),
        unsure: first.unsure,
        unit: unit(chars, first.end),
    };
    let why = match first.quoted.form {
        Form::Plain(Style { group: Some(','), .. }) => "its comma may part thousands or decimals",
        _ => "its space may part thousands or two numbers",
    };
    reading.doubts.extend(first.doubts.iter().map(|&value| (Quoted { value, ..first.quoted }, why)));
    let behind = match second {
        Some(second) => together(chars, first, second, &mut reading)?,
        None => {
            if let Some(form) = unread_behind(chars, first.end) {
                return Err(Unread::Form(form));
            }
            first.end
        }
    };
    shares(chars, behind, &mut reading);
    let several = "it holds more than one number";
    if !matches!(reading.read.form, Form::PlusMinus(..) | Form::Range(..)) {
        let others = numbers.iter().filter(|n| n.start >= behind && n.start > first.start);
        reading.doubts.extend(others.map(|n| (n.quoted, several)));
    }
    if reading.doubts.iter().any(|(_, why)| *why == several) {
        reading.unsure = reading.unsure.or(Some(several));
    }
    if !reading.read.value.is_finite() {
        return Err(Unread::Form("a number beyond all computing"));
    }
    Ok(reading)
}

/// The last sign of equality that a number follows.
fn last_equals(chars: Chars<'_>, numbers: &[Numeral]) -> Option<usize> {
    let equals = |&i: &usize| matches!(chars.at(i), Some('=' | '≈')) && numbers.iter().any(|n| n.start > i);
    (0..chars.0.len()).rev().find(equals)
}

/// The number that a text states.
pub(super) fn stated(chars: Chars<'_>) -> Option<Numeral> {
    let numbers = numbers(chars);
    let equals = last_equals(chars, &numbers);
    numbers.into_iter().find(|n| equals.is_none_or(|i| n.start > i))
}

/// The parts of a text that state one number each, in order: from behind the number before to the number behind.
pub(in crate::verify) fn parts(text: &str) -> Vec<String> {
    let (shown, _) = html::strip(text);
    let (folded, _) = fold::fold(&shown, false);
    let chars: Vec<char> = folded.chars().take(MAX_QUOTE + 1).collect();
    let numbers = numbers(Chars(&chars));
    let edge = |i: Option<usize>, of: fn(&Numeral) -> usize, none: usize| {
        i.and_then(|i| numbers.get(i)).map_or(none, of)
    };
    let part = |i: usize| {
        let (from, to) = (edge(i.checked_sub(1), |n| n.end, 0), edge(Some(i + 1), |n| n.start, chars.len()));
        chars.get(from..to).unwrap_or_default().iter().collect()
    };
    (0..numbers.len()).map(part).collect()
}

/// All numbers of a text. Digits of words, indexes and exponents (`H2O`, `x_1`, `L^2`, `3D`, `2nd`) are none.
pub(super) fn numbers(chars: Chars<'_>) -> Vec<Numeral> {
    let mut all: Vec<Numeral> = Vec::new();
    let mut i = 0;
    while let Some(c) = chars.at(i) {
        let point = c == '.' && chars.digit(i + 1) && chars.before(i) != Some('.');
        if !(c.is_ascii_digit() || point || fraction(c).is_some()) {
            i += 1;
            continue;
        }
        let sign = chars.before(i).filter(|c| matches!(c, '-' | '–' | '+'));
        let word = |c: char| c.is_alphabetic() || matches!(c, '_' | '^' | '#');
        let front = i - usize::from(sign.is_some());
        if chars.before(front).is_some_and(word) {
            let part = |c: char| c.is_alphanumeric() || matches!(c, '_' | '^' | '.');
            while chars.at(i).is_some_and(part) {
                i += 1;
            }
            continue;
        }
        let adjacent = chars.before(front).is_some_and(|c| c.is_ascii_digit() || c == ')');
        let mut negative = matches!(sign, Some('-' | '–')) && !adjacent;
        let mut start = if adjacent { i } else { front };
        // `= - 0.5`, `-\,0.5`
        if sign.is_none() && chars.before(i) == Some(' ') && matches!(chars.before(i - 1), Some('-' | '–'))
        {
            let edge = i.saturating_sub(2);
            let opens = |c: char| matches!(c, '=' | '≈' | '(' | ':');
            let before = (0..edge).rev().find_map(|k| chars.at(k).filter(|c| *c != ' '));
            if before.is_none_or(opens) {
                (negative, start) = (true, edge);
            }
        }
        let mut found = numeral(chars, i, negative);
        found.start = start;
        let next = found.end.max(i + 1);
        if !is_word(chars, &found, i) {
            all.push(found);
        }
        i = next;
    }
    all
}

/// `2nd`, `3D`: digits that count and do not measure.
fn is_word(chars: Chars<'_>, number: &Numeral, first_digit: usize) -> bool {
    let whole = (first_digit..number.end).all(|i| chars.digit(i));
    let letters: String =
        (number.end..).map_while(|i| chars.at(i)).take_while(|c| c.is_alphabetic()).take(3).collect();
    whole && matches!(letters.as_str(), "st" | "nd" | "rd" | "th" | "D")
}

/// Words and signs that make a number a bound.
const BOUNDS: [&str; 19] = [
    "<",
    ">",
    "≤",
    "≥",
    "<=",
    ">=",
    "!=",
    "less than",
    "more than",
    "fewer than",
    "greater than",
    "at most",
    "at least",
    "below",
    "above",
    "under",
    "over",
    "up to",
    "smaller than",
];

/// Whether a number only bounds another one.
pub(super) fn is_bound(chars: Chars<'_>, number: &Numeral) -> bool {
    let from = number.start.saturating_sub(MAX_QUOTE);
    let near = chars.0.get(from..).unwrap_or_default();
    let number = Numeral { start: number.start - from, end: number.end - from, ..number.clone() };
    unread_before(Chars(near), &number) == Some(BOUND)
}

const BOUND: &str = "a bound and not a number";

/// What stands before a number and changes what it says.
fn unread_before(chars: Chars<'_>, number: &Numeral) -> Option<&'static str> {
    let before: String =
        chars.0.get(..number.start).unwrap_or_default().iter().collect::<String>().to_lowercase();
    let before = before.trim_end();
    let has = |word: &str| {
        before.strip_suffix(word).is_some_and(|rest| {
            !(word.starts_with(char::is_alphabetic) && rest.ends_with(char::is_alphanumeric))
        })
    };
    if BOUNDS.into_iter().any(has) {
        return Some(BOUND);
    }
    if before.ends_with(['√', '×', '·', '*', '/', '+']) && !before.ends_with("+/") && before.len() > 1 {
        return Some("a formula");
    }
    (before.ends_with('±') || before.ends_with("+/")).then_some("a plus-minus without its number")
}

/// What follows a number and makes it a part of something else.
fn unread_behind(chars: Chars<'_>, end: usize) -> Option<&'static str> {
    let next = chars.skip_spaces(end);
    let apart = next > end;
    let then = chars.skip_spaces(next + 1);
    let number_then = chars.digit(then) || chars.at(then) == Some('.') && chars.digit(then + 1);
    let c = chars.at(next)?;
    match c {
        '^' if !apart && chars.at(next + 1) != Some('°') => Some("a power"),
        'π' | '√' | '\\' => Some("a formula"),
        '(' if !apart && chars.digit(next + 1) => Some("an uncertainty in brackets"),
        '/' if number_then => Some("a fraction with a slash"),
        ':' if !apart && chars.digit(next + 1) => Some("a ratio or a time of day"),
        '×' | '·' | '*' if number_then => Some("a product"),
        'x' | 'X' if number_then => Some("a product"),
        '+' if number_then => Some("a sum"),
        '-' if number_then && apart => Some("a difference or a range"),
        _ => {
            let word = ["thousand", "million", "billion", "trillion"];
            word.into_iter()
                .any(|w| chars.has(next, w))
                .then_some("a number with a word for its power of ten")
        }
    }
}

/// Two numbers that say one thing: a plus-minus or a range. Gives where the second one ends when they do, else where
/// the first one does.
fn together(
    chars: Chars<'_>,
    first: &Numeral,
    second: &Numeral,
    reading: &mut Reading,
) -> Result<usize, Unread> {
    let refuse = |form| Err(Unread::Form(form));
    let (a, b) = (first.quoted, second.quoted);
    let gap: String = chars.0.get(first.end..second.start).unwrap_or_default().iter().collect();
    let tight = gap.trim();
    let second_unit = unit(chars, second.end);
    let first_unit = unit(chars, first.end);
    let part = |sign: &str| tight.strip_suffix(sign).map(str::trim);
    if let Some(left) = part("±").or(part("+/-")).or(part("+/")) {
        if let Some(form) = second.refused.or_else(|| unread_behind(chars, second.end)) {
            return refuse(form);
        }
        let relative = !left.is_empty() && !left.starts_with('%') && second_unit == "%";
        let one_unit = left == first_unit && (left.is_empty() || left == second_unit || relative);
        if !one_unit || left.is_empty() && second_unit == "%" {
            return refuse("a plus-minus whose unit is not clear");
        }
        if chars.at(second.end) == Some(')') || a.exponent != b.exponent && a.exponent == 0 {
            return refuse("a plus-minus whose power of ten is not clear");
        }
        let about = if relative { a.value * b.value / 100.0 } else { b.value }.abs();
        reading.read.form = Form::PlusMinus(a.value - about, a.value + about);
        reading.doubts.clear();
        reading.unsure = first.unsure.or(second.unsure);
        // The percent sign belongs to what it may be off by.
        return Ok(if relative { first.end } else { second.end });
    }
    let link = tight.strip_prefix(first_unit.as_str()).unwrap_or(tight).trim();
    let dash = matches!(link, "-" | "–");
    let spaced = gap.starts_with(' ');
    let between = link == "and" && word_before(chars, first.start, "between");
    let is_range =
        between || link == "to" || link == "…" || link == "..." || dash && (link == "–" || !spaced);
    if !is_range {
        return match unread_behind(chars, first.end) {
            Some(form) => refuse(form),
            None => Ok(first.end),
        };
    }
    if let Some(form) = second.refused.or_else(|| unread_behind(chars, second.end)) {
        return refuse(form);
    }
    if link == "to" && word_before(chars, first.start, "from") {
        return refuse("a change from one number to another, or a range");
    }
    let one_unit = first_unit.is_empty() || first_unit == second_unit;
    if !one_unit || a.exponent != b.exponent && a.exponent == 0 {
        return refuse("a range whose ends have different units or powers of ten");
    }
    if dash && a.value > b.value {
        return refuse("a difference or a range");
    }
    reading.read.form = Form::Range(a.value.min(b.value), a.value.max(b.value));
    reading.read.value = (a.value + b.value) / 2.0;
    reading.doubts.clear();
    reading.unsure = first.unsure.or(second.unsure);
    reading.unit = second_unit;
    Ok(second.end)
}

fn word_before(chars: Chars<'_>, at: usize, word: &str) -> bool {
    let before: String = chars.0.get(..at).unwrap_or_default().iter().collect();
    before.trim_end().to_lowercase().ends_with(word)
}

/// What stands behind a number up to the next space, as far as it may be a unit.
fn unit(chars: Chars<'_>, end: usize) -> String {
    let from = chars.skip_spaces(end);
    let letter = |c: &char| c.is_alphabetic() || matches!(c, '%' | '‰' | '°' | '/' | '·');
    let mut text = String::new();
    for i in from.. {
        let Some(c) = chars.at(i) else { break };
        // Digits and signs belong to a unit as its powers.
        let power = matches!(c, '0'..='9' | '-')
            && text.ends_with(|p: char| p == '^' || p == '-' || p.is_ascii_digit());
        let raised = c == '^' && !text.is_empty();
        if !(letter(&c) || raised || power) || text.len() > 24 {
            break;
        }
        text.push(c);
    }
    let is_word = ["to", "and", "x", "of", "in", "is", "at"].contains(&text.as_str());
    if is_word { String::new() } else { text }
}

/// A percentage may be stated as printed, or as the fraction of one that an expression gives.
fn shares(chars: Chars<'_>, behind: usize, reading: &mut Reading) {
    let at = chars.skip_spaces(behind);
    let power = match chars.at(at) {
        Some('%') => -2,
        Some('‰') => -3,
        _ if chars.has(at, "percent") || chars.has(at, "per cent") => -2,
        _ => return,
    };
    let q = reading.read;
    let scale = |x: f64| x * ten(power);
    let form = match q.form {
        Form::PlusMinus(a, b) => Form::PlusMinus(scale(a), scale(b)),
        Form::Range(a, b) => Form::Range(scale(a), scale(b)),
        _ => Form::Share,
    };
    reading.share = Some(Quoted {
        value: scale(q.value),
        half_unit: scale(q.half_unit),
        decimals: (q.decimals as i32 - q.exponent - power).max(0) as usize,
        exponent: 0,
        form,
    });
}

#[cfg(test)]
#[path = "read_tests.rs"]
mod tests;
