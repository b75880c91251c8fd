//! Words before a number that state an interval: `about 200 ms`, `nearly 1.5 s`, `up to 0.45 rad/s`, `over 0.4 N`, `±3 N m`.

use super::denial::is_denied;
use super::number::{NumberForm, Quoted, Style};
use crate::language::words::ends_with;
use crate::language::{Language, Languages};
use labspec_bind::units::is_wide;

/// Signs for an approximate number, a lower bound and an upper bound, in every language.
const APPROXIMATE_SIGNS: [&str; 2] = ["~", "≈"];
const LOWER_BOUND_SIGNS: [&str; 2] = [">", "≥"];
const UPPER_BOUND_SIGNS: [&str; 2] = ["<", "≤"];

/// The largest part of a number that `about` leaves open.
const ABOUT: f64 = 0.1;

/// The number with the interval that the words before it state, or its magnitude after `±`. `None` if they state no interval, or
/// if they are negated.
pub(super) fn modified(q: &Quoted, before: &str, languages: Languages) -> Option<Quoted> {
    if !matches!(q.form, NumberForm::Plain(_) | NumberForm::Fraction | NumberForm::Share) {
        return None;
    }
    let line = before.rsplit('\n').next().unwrap_or("").to_lowercase();
    let line = line.trim_end();
    let form = |low: f64, high: f64| Some(Quoted { form: NumberForm::Interval(low, high), ..*q });
    let x = q.value;
    let unit = 2.0 * q.half_unit;
    if line.ends_with('±') || line.ends_with("+/-") {
        return Some(Quoted { form: NumberForm::Magnitude, ..*q });
    }
    let states = |words: WordList| {
        let rest = line.strip_suffix(last_word(line, words, languages)?)?.trim_end();
        (!is_denied(rest) && !rest.ends_with("n't")).then_some(())
    };
    // "slightly less than" ends with "less than": the longer words first.
    match () {
        () if states(WordList::SlightlyLess).is_some() => form(x - unit.max(left_open(q)), x),
        () if states(WordList::SlightlyMore).is_some() => form(x, x + unit.max(left_open(q))),
        () if states(WordList::Largest).is_some() => form(x - unit, x + q.half_unit),
        () if states(WordList::LowerBound).is_some() => form(x, f64::INFINITY),
        () if states(WordList::UpperBound).is_some() => form(f64::NEG_INFINITY, x),
        () if states(WordList::Approximate).is_some() && left_open(q) > q.half_unit => {
            form(x - left_open(q), x + left_open(q))
        }
        () => None,
    }
}

/// Whether the words before a number state that it is approximate.
pub(super) fn is_approximate(before: &str, languages: Languages) -> bool {
    let line = before.rsplit('\n').next().unwrap_or("").to_lowercase();
    last_word(line.trim_end(), WordList::Approximate, languages).is_some()
}

/// A list of words of a language.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum WordList {
    Approximate,
    SlightlyLess,
    SlightlyMore,
    Largest,
    LowerBound,
    UpperBound,
}

impl WordList {
    /// The words in some languages, and the signs.
    fn words_in(self, languages: Languages) -> impl Iterator<Item = &'static str> {
        let (of, signs): (fn(&'static Language) -> _, &'static [&'static str]) = match self {
            WordList::Approximate => (|l| l.approximate, &APPROXIMATE_SIGNS),
            WordList::SlightlyLess => (|l| l.slightly_less, &[]),
            WordList::SlightlyMore => (|l| l.slightly_more, &[]),
            WordList::Largest => (|l| l.largest, &[]),
            WordList::LowerBound => (|l| l.lower_bounds, &LOWER_BOUND_SIGNS),
            WordList::UpperBound => (|l| l.upper_bounds, &UPPER_BOUND_SIGNS),
        };
        languages.words_of(of).chain(signs.iter().copied())
    }
}

/// The longest word of a list with which a text ends. Words of scripts without spaces, and signs, need no space before them.
pub(super) fn last_word(text: &str, words: WordList, languages: Languages) -> Option<&'static str> {
    let is_attached = |word: &str| word.chars().all(|c| is_wide(c) || !c.is_alphanumeric());
    let ends =
        |word: &&'static str| if is_attached(word) { text.ends_with(word) } else { ends_with(text, word) };
    words.words_in(languages).filter(ends).max_by_key(|word| word.len())
}

/// How much `about` leaves open: half a unit of the last digit that is not zero, for a number without decimals, and at most a tenth.
fn left_open(q: &Quoted) -> f64 {
    let NumberForm::Plain(Style { .. }) = q.form else { return q.half_unit };
    if q.decimals > 0 || q.exponent != 0 || q.value == 0.0 || q.value.abs() >= 1e15 {
        return q.half_unit;
    }
    let mut unit = 1.0;
    while (q.value / (10.0 * unit)).fract() == 0.0 {
        unit *= 10.0;
    }
    (0.5 * unit).min(ABOUT * q.value.abs()).max(q.half_unit)
}

#[cfg(test)]
mod tests {
    use super::super::read::{read_quote, read_quote_in};
    use crate::language::Languages;

    #[test]
    fn words_state_intervals() {
        for (quote, right, wrong) in [
            ("about 200 ms", &[203.0, 181.0][..], &[179.0, 250.0][..]),
            ("about 0.44 s", &[0.442], &[0.45]),
            ("about 15 N", &[15.4], &[15.6]),
            ("nearly 1.5 s", &[1.42, 1.5], &[1.51, 1.39]),
            ("almost 200 ms", &[190.0], &[203.0]),
            ("just over 2 s", &[2.3], &[1.99, 3.1]),
            ("up to 0.45 rad/s", &[0.442, 0.45], &[0.46, 0.43]),
            ("over 0.4 rad/s", &[0.442, 40.0], &[0.39]),
            ("more than 3 N", &[3.1], &[2.9]),
            ("less than 1 mm", &[0.83], &[1.2]),
            ("at most 5 N", &[5.0], &[5.1]),
            ("< 0.5 s", &[0.49], &[0.51]),
            ("±3 N m", &[3.0, -3.0, 2.6], &[3.6, 2.4]),
        ] {
            let read = read_quote(quote).unwrap_or_else(|e| panic!("{quote}: {e:?}")).read;
            assert!(right.iter().all(|x| read.is(*x)), "{quote}: {read:?}");
            assert!(!wrong.iter().any(|x| read.is(*x)), "{quote}: {read:?}");
        }
        for (code, quote, right, wrong) in [
            ("de", "etwa 200 ms", 181.0, 250.0),
            ("de", "knapp 1,5 s", 1.42, 1.51),
            ("fr", "environ 200 ms", 203.0, 250.0),
            ("fr", "au moins 3 N", 3.1, 2.9),
            ("es", "un poco más de 2 s", 2.3, 1.9),
            ("it", "fino a 0,45 rad/s", 0.442, 0.46),
            ("zh", "约200 ms", 203.0, 250.0),
        ] {
            for languages in [Languages::ALL, Languages::with_codes([code]).unwrap_or_default()] {
                let read = read_quote_in(quote, languages).unwrap_or_else(|e| panic!("{quote}: {e:?}")).read;
                assert!(read.is(right) && !read.is(wrong), "{quote}: {read:?}");
            }
        }
        // A word of a language in which the lesson is not written.
        let english = Languages::with_codes(["en"]).unwrap_or_default();
        assert!(read_quote_in("environ 200 ms", english).is_ok_and(|reading| !reading.read.is(203.0)));
        assert!(read_quote_in("au moins 3 N", english).is_err());
        for refused in ["not over 0.4 s", "isn't above 3 N", "never more than 3 N", "other than 3 N"] {
            assert!(read_quote(refused).is_err(), "{refused}");
        }
    }
}
