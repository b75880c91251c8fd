//! The ratio that the text of an option states: `twice as deep`, `a third longer`, `50 %`.

use super::context::BOUND;
use super::modifier::{WordList, last_word};
use super::number::NumberForm;
use super::numeral::Chars;
use super::option_text::{BoundSide, plain_text};
use super::quantity::quantities;
use crate::language::words::{ends_with, split_words, starts_with};
use crate::language::{ComparisonWords, Languages};
use labspec_bind::units;
use labspec_expr::dimension::Dimension;
use std::ops::Range;

/// The ratio that an option states.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::verify) struct OptionRatio {
    /// As it is written.
    pub(in crate::verify) text: String,
    /// The possible values of the ratio: the words may leave open whether a loss or a remainder is meant.
    pub(in crate::verify) may_be: Vec<f64>,
    /// The dimensions of the quantities that the words name; empty where they name none.
    pub(in crate::verify) named: Vec<Dimension>,
    /// The side on which the ratio lies of a bound: `more than twice as long`.
    pub(in crate::verify) side: Option<BoundSide>,
}

impl OptionRatio {
    /// Whether the words name a quantity, and not the measured one: a height where the condition compares speeds.
    pub(in crate::verify) fn names_another(&self, measured: Option<&Dimension>) -> bool {
        !self.named.is_empty() && !measured.is_some_and(|m| self.named.iter().any(|d| d.agrees(m)))
    }

    /// The ratios of another quantity, which may depend on the named one by any usual power, directly or inversely.
    pub(in crate::verify) fn of_another(&self) -> Vec<f64> {
        let powers =
            [1.0, -1.0, 2.0, -2.0, 0.5, -0.5, 3.0, -3.0, 1.0 / 3.0, -1.0 / 3.0, 1.5, -1.5, 4.0, -4.0];
        let ratios = self.may_be.iter().flat_map(|b| powers.map(|p| b.powf(p)));
        ratios.flat_map(|r| [r, r - 1.0, 1.0 - r, -r]).filter(|x| x.is_finite()).collect()
    }
}

/// The words of every language are read.
const ALL: Languages = Languages::ALL;

/// Numbers, and parts, of mixed factors: `two and a half times`.
const NUMBER_WORDS: [(&str, f64); 10] = [
    ("one", 1.0),
    ("two", 2.0),
    ("three", 3.0),
    ("four", 4.0),
    ("five", 5.0),
    ("six", 6.0),
    ("seven", 7.0),
    ("eight", 8.0),
    ("nine", 9.0),
    ("ten", 10.0),
];
const PART_WORDS: [(&str, f64); 4] =
    [("a half", 0.5), ("a third", 1.0 / 3.0), ("a quarter", 0.25), ("three quarters", 0.75)];

/// A factor of a setting is at most this number of words behind the first word of its clause: `with twice the gravity`.
const SETTING_LENGTH: usize = 5;

/// A negation is at most this number of words before a factor: `not quite twice`.
const NEGATION_LENGTH: usize = 2;

/// The number of words behind a factor that tell what it is a factor of.
const NEAR_WORDS: usize = 3;

/// Whether a factor behind this text is that of a setting, not of a result: `with twice the gravity`.
fn is_setting(before: &str) -> bool {
    let clause = before.rsplit(['.', ',', ';', ':', '?', '!']).next().unwrap_or("");
    let words: Vec<&str> = split_words(clause).collect();
    words.first().is_some_and(|word| ALL.ratios(|r| r.settings).any(|first| first == *word))
        && words.len() <= SETTING_LENGTH
}

/// Whether a factor behind this text is denied: `but not twice as long`.
fn is_denied(before: &str) -> bool {
    let clause = before.rsplit(['.', ',', ';', ':', '?', '!']).next().unwrap_or("");
    let words: Vec<&str> = clause.split_whitespace().collect();
    let is_negation =
        |word: &str| word.ends_with("n't") || ALL.comparisons(|c| c.negations).any(|w| w == word);
    words.iter().rev().take(NEGATION_LENGTH + 1).any(|word| is_negation(word))
        || FAR_NEGATIONS.iter().any(|phrase| clause.contains(phrase))
}

/// Phrases that deny a factor in the same clause.
const FAR_NEGATIONS: [&str; 9] = [
    "far from",
    "nowhere near",
    "by no means",
    "in no way",
    "bei weitem nicht",
    "keineswegs",
    "loin de",
    "lejos de",
    "lontano da",
];

/// The most words of an object behind a factor, with which an option may end: `four times the height`.
const OBJECT_LENGTH: usize = 3;

/// Words behind a factor that make it a bound of an interval.
const BOUNDS_BEHIND: [&str; 14] = [
    "or more",
    "or less",
    "at least",
    "at most",
    "at the very least",
    "at the very most",
    "oder mehr",
    "oder weniger",
    "ou plus",
    "ou moins",
    "o más",
    "o menos",
    "o più",
    "o meno",
];

/// Whether a factor behind this text is an end of a range, or a count: `two to three times`, `three halves`.
fn is_ranged(before: &str) -> bool {
    let mut words = before.split([' ', '–', '—', '-']).filter(|word| !word.is_empty()).rev();
    let is_number = |word: &str| {
        word.starts_with(|c: char| c.is_ascii_digit())
            || ALL.words_of(|language| language.numerals).any(|n| n == word)
            || NUMBER_WORDS.iter().any(|(n, _)| *n == word)
    };
    let (last, previous) = (words.next().unwrap_or(""), words.next().unwrap_or(""));
    let joins =
        ["to", "or", "and", "bis", "oder", "und", "à", "ou", "et", "o", "y", "e", "a"].contains(&last);
    is_number(last) || joins && is_number(previous) || before.ends_with(['–', '—'])
}

/// Whether a part is one of a unit: `a tenth of a second`.
fn is_of_unit(behind: &str) -> bool {
    let rest = behind.trim_start();
    let whole = ["of a ", "of an ", "of one "].iter().find_map(|words| rest.strip_prefix(words));
    whole.is_some_and(|whole| split_words(whole).next().is_some_and(|word| units::parse(word).is_some()))
}

/// The factor of an option: its place, its text, its value, and whether it is a share in percent.
type PlacedFactor = (Range<usize>, String, f64, bool);

/// The only factor in the lower-case text of an option.
fn only_factor(folded: &str) -> Option<PlacedFactor> {
    let chars: Vec<char> = folded.chars().take(2000).collect();
    let chars = Chars(&chars);
    let factors = factor_words(folded);
    // Example: `two and a half days`, which states no ratio.
    let mut halves = folded.match_indices("and a half");
    if halves.any(|(half, _)| !factors.iter().any(|(place, _)| place.contains(&half))) {
        return None;
    }
    Some(match (quantities(chars).as_slice(), factors.as_slice()) {
        ([], [(place, x), others @ ..]) if others.iter().all(|(_, y)| y == x) => {
            (place.clone(), folded.get(place.clone())?.to_string(), *x, false)
        }
        ([q], [])
            if q.refused.is_none_or(|why| why == BOUND)
                && matches!(q.quoted.form, NumberForm::Plain(_) | NumberForm::Share) =>
        {
            let first_words = q.unit.as_ref().is_some_and(|unit| unit.is_own());
            let text = chars.text(q.whole.start, if first_words { q.whole.end } else { q.number_end });
            let start = chars.text(0, q.whole.start).len();
            let place = start..start + text.len();
            match q.unit.as_ref().filter(|unit| unit.is_own()) {
                Some(unit) => (place, text, q.quoted.value * 10f64.powi(unit.share()?), true),
                None if is_factor(folded.get(..start)?) => (place, text, q.quoted.value, false),
                None => {
                    let behind = folded.get(place.end..)?.trim_start();
                    let times = ["times", "×"].into_iter().find(|word| behind.starts_with(word))?;
                    let end = folded.len() - behind.len() + times.len();
                    (place.start..end, format!("{text} times"), q.quoted.value, false)
                }
            }
        }
        _ => return None,
    })
}

/// The only ratio that an option states about a result; `None` where it states several, a bound, or other numbers.
pub(in crate::verify) fn option_ratio(option: &str) -> Option<OptionRatio> {
    let folded = plain_text(option).to_lowercase();
    let (place, text, x, share) = only_factor(&folded)?;
    let before = folded.get(..place.start)?.trim_end();
    // A bound stands before `a factor of`.
    let outer = FACTOR_OF.iter().find_map(|words| before.strip_suffix(words)).map_or(before, str::trim_end);
    let (side, bound) = bound_before(outer)?;
    let before = if bound.is_empty() { before } else { outer.strip_suffix(bound)?.trim_end() };
    let behind = folded.get(place.end..)?;
    if is_setting(before) || is_denied(before) || is_of_unit(behind) || is_ranged(before) {
        return None;
    }
    // `The speed doubles or less`, `15 times the angle makes it …`
    let clause = behind.split(['.', ';', ':']).next().unwrap_or("").trim_start_matches([',', ' ']);
    if BOUNDS_BEHIND.iter().any(|words| clause.contains(words))
        || split_words(before.rsplit([',', ';', ':', '.']).next().unwrap_or("")).next().is_none()
            && starts_with(clause, "the")
            && split_words(clause).count() > OBJECT_LENGTH
        || ["plus que", "moins que"].iter().any(|bound| before.ends_with(bound))
    {
        return None;
    }
    // `changes by less than a tenth`: the direction is open.
    let is_by = ALL.comparisons(|c| c.by).any(|by| ends_with(before, by));
    let may_be = readings(x, share, before, behind);
    if side.is_some() && is_by && x < 1.0 && may_be == [x] {
        return None;
    }
    // Example: `it takes longer from twice the height` is about a factor of the height.
    let near: String = behind
        .split(['.', ',', ';', ':'])
        .next()
        .unwrap_or("")
        .split_whitespace()
        .take(NEAR_WORDS)
        .collect::<Vec<_>>()
        .join(" ");
    // `four times as stiff` is about no other quantity of the text.
    let is_told = near.starts_with("as ");
    let near = named_quantities(&near);
    let named = if near.is_empty() && !is_told { named_quantities(&folded) } else { near };
    Some(OptionRatio { text, may_be, named, side })
}

/// The side of a bound that the words before a factor state, and these words. `None` if they state another interval.
fn bound_before(before: &str) -> Option<(Option<BoundSide>, &'static str)> {
    let word = |list: WordList| last_word(before, list, ALL);
    if word(WordList::SlightlyLess).or(word(WordList::SlightlyMore)).is_some() {
        return None;
    }
    // `no more than` ends with `more than`.
    let upper = [WordList::UpperBound, WordList::Largest].into_iter().filter_map(word);
    let below = upper.max_by_key(|word| word.len());
    Some(match (word(WordList::LowerBound), below) {
        (Some(lower), Some(upper)) if lower.len() > upper.len() => (Some(BoundSide::Above), lower),
        (Some(lower), None) => (Some(BoundSide::Above), lower),
        (_, Some(upper)) => (Some(BoundSide::Below), upper),
        (None, None) => (None, ""),
    })
}

/// Whether a number behind this text is a factor: `larger by a factor of`.
fn is_factor(before: &str) -> bool {
    let before = before.trim_end();
    FACTOR_OF.iter().any(|words| before.ends_with(words))
}

/// Words before the number of a factor.
const FACTOR_OF: [&str; 3] = ["a factor of", "the factor", "by the factor of"];

/// The dimensions of the quantities that the words of a text name.
pub(in crate::verify) fn named_quantities(text: &str) -> Vec<Dimension> {
    let named = ALL.ratios(|r| r.quantities).filter(|(word, _)| split_words(text).any(|w| w == *word));
    named.flat_map(|(_, units)| units.iter().filter_map(|unit| units::parse(unit))).collect()
}

/// The words for factors in a text, with their places.
fn factor_words(lower: &str) -> Vec<(Range<usize>, f64)> {
    let letter = |c: Option<char>| c.is_some_and(char::is_alphanumeric);
    let is_word = |place: &Range<usize>| {
        !letter(lower.get(..place.start).and_then(|t| t.chars().next_back()))
            && !letter(lower.get(place.end..).and_then(|t| t.chars().next()))
    };
    let place_of = |word: &str| {
        let mut found = lower.match_indices(word).map(|(start, found)| start..start + found.len());
        found.find(is_word)
    };
    let mixed = NUMBER_WORDS.iter().flat_map(|(number, x)| {
        PART_WORDS.iter().flat_map(move |(part, y)| {
            // Without `times`, the number may be of anything: `two and a half days`.
            [format!("{number} and {part} times"), format!("{number} times and {part}")]
                .map(|words| (words, x + y))
        })
    });
    // `by a factor of four`
    let named = NUMBER_WORDS.iter().filter_map(|(number, x)| {
        let place = place_of(&format!("factor of {number}"))?;
        Some((place.end - number.len()..place.end, *x))
    });
    let mixed = mixed.filter_map(|(words, x)| Some((place_of(&words)?, x)));
    let mixed: Vec<(Range<usize>, f64)> = mixed.chain(named).collect();
    let is_in_mixed =
        |place: &Range<usize>| mixed.iter().any(|(m, _)| m.start < place.end && place.start < m.end);
    let single = ALL.ratios(|r| r.factors).filter_map(|(word, x)| Some((place_of(word)?, x)));
    let single: Vec<_> = single.filter(|(place, _)| !is_in_mixed(place)).collect();
    [mixed, single].concat()
}

/// German words that end like English comparatives.
const POSSESSIVES: [&str; 5] = ["ihrer", "seiner", "unserer", "dieser", "jener"];

/// The values of a ratio that a factor and the words around it may state.
fn readings(x: f64, share: bool, before: &str, behind: &str) -> Vec<f64> {
    let next = split_words(behind).next().unwrap_or("");
    let is_part = share || x < 1.0;
    let is = |word: &str, words: ComparisonWords| ALL.comparisons(words).any(|listed| listed == word);
    let rest = behind.trim_start();
    let begins = |words: ComparisonWords| ALL.comparisons(words).any(|phrase| starts_with(rest, phrase));
    let is_less = begins(|c| c.smaller);
    let is_comparative = is_less
        || begins(|c| c.larger)
        || next.len() > 4 && next.ends_with("er") && !POSSESSIVES.contains(&next);
    let again = split_words(behind).any(|w| w == "again");
    let is_smaller = is_factor(before) && split_words(before).any(|w| is(w, |c| c.smaller));
    let verb = |stems: ComparisonWords| {
        let mut all = split_words(before).chain(split_words(behind));
        all.any(|word| ALL.comparisons(stems).any(|stem| word.starts_with(stem)))
    };
    match () {
        () if is_factor(before) && (is_smaller || verb(|c| c.decreases)) => vec![1.0 / x],
        () if is_comparative && is_less && is_part => vec![1.0 - x],
        () if is_comparative && is_less => vec![1.0 / x, 1.0 / (1.0 + x)],
        () if (is_comparative || again) && is_part => vec![1.0 + x],
        () if is_comparative => vec![x, 1.0 + x],
        () if is_part && (verb(|c| c.decreases) || verb(|c| c.loses)) => vec![x, 1.0 - x],
        () if is_part && verb(|c| c.increases) => vec![x, 1.0 + x],
        () if share => vec![x, 1.0 - x, 1.0 + x],
        () => vec![x],
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_ratio_of_an_option_is_read() {
        let is = |text: &str, x: f64| {
            option_ratio(text).is_some_and(|r| r.may_be.iter().any(|y| (x - y).abs() < 1e-9))
        };
        for (text, x) in [
            ("Twice as deep", 2.0),
            ("half", 0.5),
            ("Half as long", 0.5),
            ("half as long again", 1.5),
            ("a third longer", 4.0 / 3.0),
            ("a third less", 2.0 / 3.0),
            ("it drops by a third", 2.0 / 3.0),
            ("it drops to a third", 1.0 / 3.0),
            ("two times shorter", 0.5),
            ("the longer one takes half as long", 0.5),
            ("about 50 %", 0.5),
            ("it loses 30 % of it", 0.7),
            ("30 % longer", 1.3),
            ("3 times as long", 3.0),
            ("four times", 4.0),
            ("it grows sixfold", 6.0),
            ("two and a half times as far", 2.5),
            ("one and a third times", 4.0 / 3.0),
            ("it quadruples", 4.0),
            ("larger by a factor of 6", 6.0),
            ("smaller by a factor of 2", 0.5),
        ] {
            assert!(is(text, x), "{text} {x}");
        }
        for (text, x) in [
            ("Twice as deep", 0.5),
            ("Twice as deep", 5.0),
            ("half as long", 2.0),
            ("a third longer", 1.0 / 3.0),
            ("a third longer", 2.0 / 3.0),
            ("three times as long", 2.0),
            ("four times", 16.0),
            ("30 %", 0.05),
            ("30 % less", 1.3),
            ("20 times", 5.0),
            ("two and a half times as far", 2.0),
            ("two and a half times as far", 0.5),
        ] {
            assert!(!is(text, x), "{text} {x}");
        }
    }

    #[test]
    fn ranges_bounds_and_denials_are_no_ratio() {
        for text in [
            "twice as much as 3 s",
            "half or double",
            "halfway",
            "two and a half days",
            "nearly twice as long",
            "three balls",
            "it falls",
            "two to three times as fast",
            "between two and four times as fast",
            "zwei- bis dreimal so schnell",
            "deux à trois fois plus vite",
            "it is nowhere near six times as fast",
            "it by no means becomes six times as fast",
            "sie ist bei weitem nicht sechsmal so schnell",
            "it is twice as fast as before, or more",
            "it doubles at the very least",
            "it halves or less",
            "it has three halves of its speed",
            "15 times the angle makes it less than a fifth longer",
            "Hardly: 15 times the angle changes it little",
            "it changes by less than a tenth",
            "la vitesse est plus que doublée",
        ] {
            assert_eq!(option_ratio(text), None, "{text}");
        }
    }

    #[test]
    fn ratios_are_read_in_several_languages() {
        for (text, x) in [
            ("it falls by a factor of four", 0.25),
            ("sie verdoppelt sich", 2.0),
            ("sie wird viermal so lang", 4.0),
            ("sinkt auf ein Viertel", 0.25),
            ("quatre fois plus longue", 4.0),
            ("sie verliert ein Drittel ihrer Geschwindigkeit", 2.0 / 3.0),
            ("la bille perd un tiers de sa vitesse", 2.0 / 3.0),
            ("deux fois plus courte", 0.5),
        ] {
            let ratio = option_ratio(text);
            assert!(ratio.is_some_and(|r| r.may_be.iter().any(|y| (x - y).abs() < 1e-9)), "{text}");
        }
    }

    #[test]
    fn a_ratio_may_be_a_bound() {
        let side = |text: &str| option_ratio(text).map(|ratio| ratio.side);
        assert_eq!(side("more than twice as long"), Some(Some(BoundSide::Above)));
        assert_eq!(side("at least 50 % longer"), Some(Some(BoundSide::Above)));
        assert_eq!(side("less than half as long"), Some(Some(BoundSide::Below)));
        assert_eq!(side("no more than twice as long"), Some(Some(BoundSide::Below)));
        assert_eq!(side("twice as long"), Some(None));
        assert_eq!(side("it grows by less than a factor of three"), Some(Some(BoundSide::Below)));
    }

    #[test]
    fn a_setting_and_a_denied_factor_are_no_ratio() {
        for text in [
            "with twice the gravity, it lands earlier",
            "if the stiffness is doubled, the period becomes shorter",
            "when gravity is doubled it falls faster",
            "longer, but not twice as long",
            "it isn't quite three times as long",
            "it is far from being doubled",
            "it grows by a tenth of a second",
        ] {
            assert_eq!(option_ratio(text), None, "{text}");
        }
    }

    #[test]
    fn another_quantity_may_depend_on_the_named_one() {
        let (time, speed) = (units::parse("s").unwrap(), units::parse("m/s").unwrap());
        let names =
            |text: &str, measured: &Dimension| option_ratio(text).unwrap().names_another(Some(measured));
        assert!(!names("half as long", &time) && names("half as long", &speed));
        assert!(!names("half", &time) && names("four times the height", &speed));
        assert!(names("it takes longer from twice the height", &time));
        assert!(names("four times as stiff makes the period shorter", &time));
        assert!(
            option_ratio("a wide swing is twice as dangerous as a short period").unwrap().named.is_empty()
        );
        let height = option_ratio("four times the height").unwrap().of_another();
        assert!(height.contains(&2.0) && height.contains(&0.5) && !height.contains(&5.0));
    }
}
