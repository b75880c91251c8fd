//! Words before a number that state an interval: `about 200 ms`, `nearly 1.5 s`, `up to 0.45 rad/s`, `over 0.4 N`, `±3 N m`.

use super::denial::is_denied;
use super::number::{NumberForm, Quoted, Style};

/// Words for an approximate number. Trailing zeros before the point are then not digits of it.
pub(super) const APPROXIMATE: [&str; 13] = [
    "about",
    "around",
    "roughly",
    "approximately",
    "nearly",
    "almost",
    "some",
    "circa",
    "ca.",
    "~",
    "≈",
    "约",
    "約",
];
/// Words for a number that is slightly smaller.
const SLIGHTLY_LESS: [&str; 7] =
    ["nearly", "almost", "just under", "just below", "slightly less than", "a little less than", "knapp"];
/// Words for a number that is slightly larger.
const SLIGHTLY_MORE: [&str; 5] =
    ["just over", "just above", "slightly more than", "a little more than", "a bit more than"];
/// Words for the largest value.
const LARGEST: [&str; 2] = ["up to", "bis zu"];
/// Words for a lower bound.
pub(super) const LOWER_BOUND_WORDS: [&str; 17] = [
    "more than",
    "greater than",
    "larger than",
    "longer than",
    "higher than",
    "faster than",
    "at least",
    "above",
    "over",
    "beyond",
    "exceeds",
    "exceed",
    "exceeding",
    "mehr als",
    "mindestens",
    ">",
    "≥",
];
/// Words for an upper bound.
pub(super) const UPPER_BOUND_WORDS: [&str; 13] = [
    "less than",
    "smaller than",
    "shorter than",
    "lower than",
    "slower than",
    "fewer than",
    "at most",
    "below",
    "under",
    "weniger als",
    "höchstens",
    "<",
    "≤",
];

/// The largest part of a number that `about` leaves open.
const ABOUT: f64 = 0.1;

/// Whether a text ends with a word.
pub(super) fn ends_with(text: &str, word: &str) -> bool {
    text.strip_suffix(word).is_some_and(|rest| !rest.ends_with(char::is_alphanumeric))
}

/// The number with the interval that the words before it state, or its magnitude after `±`. `None` if they state no interval, or
/// if they are negated.
pub(super) fn modified(q: &Quoted, before: &str) -> Option<Quoted> {
    if !matches!(q.form, NumberForm::Plain(_) | NumberForm::Fraction | NumberForm::Share) {
        return None;
    }
    let line = before.rsplit('\n').next().unwrap_or("").to_lowercase();
    let line = line.trim_end();
    let form = |low: f64, high: f64| Some(Quoted { form: NumberForm::Interval(low, high), ..*q });
    let ends = |list: &[&str]| {
        let word = list.iter().filter(|word| ends_with(line, word)).max_by_key(|word| word.len())?;
        Some(line.strip_suffix(word).unwrap_or("").trim_end())
    };
    let open = |list: &[&str]| ends(list).is_some_and(|rest| !is_denied(rest) && !rest.ends_with("n't"));
    let x = q.value;
    let unit = 2.0 * q.half_unit;
    if line.ends_with('±') || line.ends_with("+/-") {
        return Some(Quoted { form: NumberForm::Magnitude, ..*q });
    }
    // "slightly less than" ends with "less than": the longer words first.
    match () {
        () if open(&SLIGHTLY_LESS) => form(x - unit.max(left_open(q)), x),
        () if open(&SLIGHTLY_MORE) => form(x, x + unit.max(left_open(q))),
        () if open(&LARGEST) => form(x - unit, x + q.half_unit),
        () if open(&LOWER_BOUND_WORDS) => form(x, f64::INFINITY),
        () if open(&UPPER_BOUND_WORDS) => form(f64::NEG_INFINITY, x),
        () if open(&APPROXIMATE) && left_open(q) > q.half_unit => form(x - left_open(q), x + left_open(q)),
        () => None,
    }
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
    use super::super::read::read_quote;

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
        for refused in ["not over 0.4 s", "isn't above 3 N", "never more than 3 N", "other than 3 N"] {
            assert!(read_quote(refused).is_err(), "{refused}");
        }
    }
}
