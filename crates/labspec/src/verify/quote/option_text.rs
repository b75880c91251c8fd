//! The quantity that the text of an option states, with its precision according to the words.

use super::context::BOUND;
use super::modifier::{WordList, last_word};
use super::number::{NumberForm, Quoted};
use super::numeral::Chars;
use super::quantity::{Quantity, quantities};
use super::unit_text::Unit;
use super::{fold, html};
use crate::language::Languages;
use crate::language::words::{ends_with, find};
use labspec_bind::units;

/// The quantity that an option states.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::verify) struct OptionNumber {
    /// Number and unit as they are written.
    pub(in crate::verify) text: String,
    /// The range of values that agree with it, in its unit.
    pub(in crate::verify) low: f64,
    pub(in crate::verify) high: f64,
    pub(in crate::verify) unit: Unit,
    /// Whether the option contains nothing else, so that the number answers the question.
    pub(in crate::verify) alone: bool,
}

impl OptionNumber {
    /// The number itself; of a bound, the bound.
    pub(in crate::verify) fn number(&self) -> f64 {
        match (self.low.is_finite(), self.high.is_finite()) {
            (true, true) => 0.5 * (self.low + self.high),
            (true, false) => self.low,
            _ => self.high,
        }
    }
}

/// Relative tolerance of a number: as it is printed, and with "about" before it.
const PRINTED: f64 = 0.05;
const ABOUT: f64 = 0.1;

/// Words before a number that make it another quantity: a change, a place, a condition.
const ELSE: [&str; 14] = [
    "by",
    "than",
    "instead of",
    "rather than",
    "within",
    "after",
    "at",
    "from",
    "every",
    "of",
    "for",
    "until",
    "before",
    "first",
];

/// The text of an option without markup. Markers of bold and italic text are not products.
pub(super) fn plain_text(option: &str) -> String {
    let (rendered, _) = html::strip(option);
    fold::fold(&rendered, false).0.replace("**", "").replace("__", "")
}

/// The only quantity with a unit that an option states; `None` where it states several, or where its words give the number
/// another meaning.
pub(in crate::verify) fn option_text(option: &str, languages: Languages) -> Option<OptionNumber> {
    let folded = spelled(&plain_text(option));
    let chars: Vec<char> = folded.chars().take(2000).collect();
    let chars = Chars(&chars);
    let all = quantities(chars);
    let with_unit = |q: &&Quantity| {
        q.unit.as_ref().is_some_and(|u| u.is_own() && u.dimension.is_some() && u.share().is_none())
    };
    let mut found = all.iter().filter(with_unit);
    let (Some(q), None) = (found.next(), found.next()) else { return None };
    let unit = q.unit.clone().filter(|u| !u.is_doubtful())?;
    let before = chars.text(q.whole.start.saturating_sub(30), q.whole.start).to_lowercase();
    let before = before.trim_end();
    let behind = chars.text(q.whole.end, q.whole.end + 40).to_lowercase();
    let of_something_else = q.refused != Some(BOUND) && ELSE.into_iter().any(|word| ends_with(before, word));
    if compares(&behind) || of_something_else {
        return None;
    }
    let (low, high) = stated_range(q, before, languages)?;
    let rest = format!("{} {}", chars.text(0, q.whole.start), chars.text(q.whole.end, chars.0.len()));
    let text = chars.text(q.whole.start, q.whole.end);
    Some(OptionNumber { text, low, high, unit, alone: has_no_content(&rest) })
}

/// All quantities with a unit of their own that a text states, each with the range of values that agree with it. Numbers that
/// belong to another expression are left out.
pub(in crate::verify) fn quantities_in(text: &str, languages: Languages) -> Vec<OptionNumber> {
    let folded = spelled(&plain_text(text));
    let chars: Vec<char> = folded.chars().take(2000).collect();
    let chars = Chars(&chars);
    let stated = |q: &Quantity| {
        let unit = q.unit.clone().filter(|u| u.is_own() && u.dimension.is_some() && !u.is_doubtful())?;
        let before = chars.text(q.whole.start.saturating_sub(CLAUSE), q.whole.start).to_lowercase();
        let (low, high) = stated_range(q, before.trim_end(), languages)?;
        Some(OptionNumber { text: chars.text(q.whole.start, q.whole.end), low, high, unit, alone: false })
    };
    quantities(chars).iter().filter_map(stated).collect()
}

/// Whether the words after a number make it a comparison: `7 m farther` is a change; `7 m, no more` is not.
fn compares(behind: &str) -> bool {
    let words = behind.split_whitespace().take(3).map(|w| w.trim_matches(|c: char| !c.is_alphanumeric()));
    let words: Vec<&str> = words.collect();
    words.iter().enumerate().any(|(i, w)| {
        let denied = i.checked_sub(1).and_then(|k| words.get(k)).is_some_and(|before| *before == "no");
        !denied
            && (matches!(*w, "more" | "less" | "too") || w.len() > 4 && w.ends_with("er") && *w != "under")
    })
}

/// The range that agrees with a quantity, given the text before it; `None` where the words give it another meaning.
fn stated_range(q: &Quantity, before: &str, languages: Languages) -> Option<(f64, f64)> {
    let states = |words: WordList| last_word(before, words, languages).is_some();
    let is_about = [WordList::Approximate, WordList::SlightlyLess].into_iter().any(states);
    let Quoted { value, half_unit, form, .. } = q.quoted;
    let is_share = q.unit.as_ref().is_some_and(|unit| unit.percentage().is_some());
    let is_within = languages.comparisons(|c| c.within).any(|word| ends_with(before, word));
    match (q.refused.or(is_within.then_some(BOUND)), form) {
        (None, NumberForm::Range(a, b) | NumberForm::PlusMinus(a, b)) => Some((a, b)),
        (None, _) => {
            let off = half_unit.max(value.abs() * if is_about { ABOUT } else { PRINTED });
            Some((value - off, value + off))
        }
        (Some(_), NumberForm::Plain(_)) => Some(match side_of_bound(before, is_share, languages)? {
            BoundSide::Above => (value, f64::INFINITY),
            BoundSide::Below => (f64::NEG_INFINITY, value),
        }),
        _ => None,
    }
}

/// The side of a number on which a bound lies.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::verify) enum BoundSide {
    Above,
    Below,
}

/// The most characters before a number that are read.
const CLAUSE: usize = 100;

/// The side on which the bound lies that the words before a number state: `at least`, `later than`, `never more than`.
fn side_of_bound(before: &str, is_share: bool, languages: Languages) -> Option<BoundSide> {
    if languages.comparisons(|c| c.within).any(|word| ends_with(before, word)) {
        return Some(BoundSide::Below);
    }
    let phrase = |list: WordList| last_word(before, list, languages);
    let (side, words) = match (phrase(WordList::LowerBound), phrase(WordList::UpperBound)) {
        (Some(lower), Some(upper)) if lower.len() > upper.len() => (BoundSide::Above, lower),
        (Some(lower), None) => (BoundSide::Above, lower),
        (_, Some(upper)) => (BoundSide::Below, upper),
        (None, None) => comparative(before, languages)?,
    };
    let rest = before.strip_suffix(words)?.trim_end();
    // A bound of a difference is about another number than what is compared: `sinks by more than 1 cm`.
    if !is_share && languages.comparisons(|c| c.by).any(|word| ends_with(rest, word)) {
        return None;
    }
    let clause = rest.rsplit([',', ';', ':', '.']).next().unwrap_or(rest);
    // `no more than`; and `it never swings beyond`.
    let negated = languages.comparisons(|c| c.negative_articles).any(|word| ends_with(rest, word))
        || clause.contains("n't")
        || languages.comparisons(|c| c.negations).any(|negation| find(clause, negation).is_some());
    Some(match (side, negated) {
        (BoundSide::Above, false) | (BoundSide::Below, true) => BoundSide::Above,
        _ => BoundSide::Below,
    })
}

/// A comparative before a number: `later than`.
fn comparative(before: &str, languages: Languages) -> Option<(BoundSide, &str)> {
    let rest = before.strip_suffix("than")?.trim_end();
    let start = rest.rfind(|c: char| !c.is_alphabetic()).map_or(0, |i| i + 1);
    let word = rest.get(start..)?;
    let words = before.get(start..)?;
    match () {
        () if languages.comparisons(|c| c.smaller).any(|smaller| smaller == word) => {
            Some((BoundSide::Below, words))
        }
        () if word == "more" || word.len() > 4 && word.ends_with("er") => Some((BoundSide::Above, words)),
        () => None,
    }
}

/// Whether the rest of an option has no content, so that the option is its number alone.
fn has_no_content(rest: &str) -> bool {
    rest.to_lowercase().split_whitespace().all(|w| {
        let word = w.trim_matches(|c: char| !c.is_alphanumeric());
        word.chars().count() < 2
            || ["about", "around", "roughly", "approximately", "nearly", "almost"].contains(&word)
    })
}

/// Numbers in words.
const NUMBER_WORDS: [(&str, &str); 24] = [
    ("half a", "0.5"),
    ("a quarter of a", "0.25"),
    ("one", "1"),
    ("two", "2"),
    ("three", "3"),
    ("four", "4"),
    ("five", "5"),
    ("six", "6"),
    ("seven", "7"),
    ("eight", "8"),
    ("nine", "9"),
    ("ten", "10"),
    ("eleven", "11"),
    ("twelve", "12"),
    ("fifteen", "15"),
    ("twenty", "20"),
    ("thirty", "30"),
    ("forty", "40"),
    ("fifty", "50"),
    ("sixty", "60"),
    ("ninety", "90"),
    ("a hundred", "100"),
    ("one hundred", "100"),
    ("a thousand", "1000"),
];

/// Replaces numbers in words before a unit by figures: `three seconds`.
fn spelled(text: &str) -> String {
    let lower = text.to_lowercase();
    if lower.len() != text.len() {
        return text.to_string();
    }
    let mut all = text.to_string();
    // The longest first, so that "one hundred" is not read as "one".
    let mut words = NUMBER_WORDS;
    words.sort_by_key(|(word, _)| std::cmp::Reverse(word.len()));
    for (word, figure) in words {
        let lower = all.to_lowercase();
        let Some(start) = lower.find(word).filter(|_| lower.len() == all.len()) else { continue };
        let (before, after) =
            (lower.get(..start).unwrap_or(""), lower.get(start + word.len()..).unwrap_or(""));
        let unit = after.strip_prefix(' ').and_then(|rest| {
            let length = rest.find(|c: char| !c.is_alphabetic()).unwrap_or(rest.len());
            units::read(rest).filter(|u| u.length >= length && length > 1 && u.dimension.is_some())
        });
        if unit.is_some() && !before.ends_with(char::is_alphanumeric) {
            all.replace_range(start..start + word.len(), figure);
        }
    }
    all
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_number_of_an_option_is_read() {
        let parsed = |text: &str| option_text(text, Languages::ALL).map(|n| (n.text, n.low, n.high));
        let is = |text: &str, low: f64, high: f64| {
            let (rendered, a, b) = parsed(text).unwrap_or_else(|| panic!("{text}"));
            assert!(
                (a - low).abs() < 1e-9 * low.abs().max(1.0) && (b - high).abs() < 1e-9 * high.abs().max(1.0),
                "{text}: {rendered} {a} {b}"
            );
        };
        is("about 7 m", 6.3, 7.7);
        is("It rises to 1.23 m, as it must", 1.1685, 1.2915);
        is("0.4 to 0.5 s", 0.4, 0.5);
        is("It takes three seconds", 2.5, 3.5);
        is("about half a second", 0.45, 0.55);
        is("One hundred metres", 95.0, 105.0);
        is("**7 m**", 6.5, 7.5);
        is("roughly 7 m, no more", 6.3, 7.7);
        assert_eq!(parsed("more than 7 m"), Some(("7 m".into(), 7.0, f64::INFINITY)));
        for text in [
            "7 m farther",
            "by 7 m",
            "7 m or 8 m",
            "twice 7 m",
            "7 balls",
            "three balls",
            "someone metres",
            "50 %",
            "2 h",
            "nothing",
            "it is there after 7 s",
        ] {
            assert_eq!(parsed(text), None, "{text}");
        }
        let alone = |text: &str| option_text(text, Languages::ALL).unwrap().alone;
        assert!(alone("about 7 m") && alone("h = 7 m.") && alone("**7 m**") && !alone("It rises to 7 m"));
    }
}
