//! The relation that the words of an option state: how a number after a change compares with its value before.

use std::fmt::Write;

/// The relation of a number `b` to a number `a`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Relation {
    /// Equal, within [`SAME`].
    Same,
    /// Larger, by at most this share if given.
    More(Option<f64>),
    /// Smaller, to at most this share if given.
    Less(Option<f64>),
    /// Larger by this factor.
    Times(f64),
    /// It changes by more than half: something falls, slips or flies away.
    Gone,
    /// Approximately zero.
    Nothing,
    /// The simulation fails.
    Breaks,
}

/// The relative tolerance for equality.
const SAME: f64 = 0.02;
/// The relative tolerance of a stated factor.
const ABOUT: f64 = 0.1;
/// The share for "a little".
const LITTLE_SHARE: f64 = 0.2;
/// The share for "much less than".
const MUCH_SHARE: f64 = 0.7;

const SAME_WORDS: [&str; 14] = [
    "same",
    "nothing changes",
    "nothing measurable",
    "unchanged",
    "no change",
    "does not change",
    "doesn't change",
    "equal",
    "no difference",
    "no effect",
    "does not depend",
    "stays",
    "nothing happens",
    "nothing",
];
const MORE: [&str; 26] = [
    "later",
    "deeper",
    "farther",
    "further",
    "more",
    "higher",
    "longer",
    "larger",
    "bigger",
    "greater",
    "increases",
    "increase",
    "rises",
    "grows",
    "faster",
    "stronger",
    "steeper",
    "softer",
    "heavier",
    "wider",
    "warmer",
    "quicker",
    "sooner out",
    "gains",
    "doubles",
    "louder",
];
const LESS: [&str; 16] = [
    "earlier",
    "less",
    "lower",
    "shorter",
    "smaller",
    "decreases",
    "decrease",
    "shrinks",
    "slower",
    "weaker",
    "shallower",
    "sooner",
    "loses",
    "drops by",
    "falls by",
    "stiffer",
];
const ABSENCE_WORDS: [&str; 13] = [
    "tunnels",
    "falls through",
    "passes through",
    "slides out",
    "slips out",
    "falls out",
    "is dropped",
    "drops out",
    "topples",
    "tips over",
    "flies off",
    "flies away",
    "escapes",
];
const BREAKS: [&str; 7] = ["refuses", "unstable", "explodes", "diverges", "blows up", "nan", "breaks"];
const ZERO_WORDS: [&str; 4] = ["zero", "exactly at", "vanishes", "not at all"];
const FACTORS: [(&str, f64); 12] = [
    ("four times", 4.0),
    ("quadruples", 4.0),
    ("three times", 3.0),
    ("triples", 3.0),
    ("ten times", 10.0),
    ("twice", 2.0),
    ("doubles", 2.0),
    ("double", 2.0),
    ("a quarter", 0.25),
    ("halves", 0.5),
    ("half as", 0.5),
    ("by half", 0.5),
];

/// Whether a text contains words, as whole words.
pub(super) fn contains_words(text: &str, words: &str) -> bool {
    let part = |c: char| c.is_alphanumeric();
    text.match_indices(words).any(|(at, _)| {
        let before = text.get(..at).and_then(|t| t.chars().next_back());
        let after = text.get(at + words.len()..).and_then(|t| t.chars().next());
        !before.is_some_and(part) && !after.is_some_and(part)
    })
}

impl Relation {
    /// Reads the relation that an option states, or `None` if its words are unknown.
    pub(super) fn read(option: &str) -> Option<Relation> {
        let text = option.to_lowercase();
        // The first statement counts; the rest are reasons and reservations.
        let first = |list: &[&str]| {
            let found = list.iter().filter(|w| contains_words(&text, w)).filter_map(|w| text.find(w));
            found.min().unwrap_or(usize::MAX)
        };
        let [same, more, less, gone, nothing] =
            [&SAME_WORDS[..], &MORE, &LESS, &ABSENCE_WORDS, &ZERO_WORDS].map(first);
        let percent = percent(&text);
        if BREAKS.iter().any(|w| contains_words(&text, w)) {
            return Some(Relation::Breaks);
        }
        if let Some((_, factor)) = FACTORS.iter().find(|(words, _)| contains_words(&text, words)) {
            let down = less < more && *factor > 1.0;
            return Some(Relation::Times(if down { 1.0 / factor } else { *factor }));
        }
        let most = match percent {
            Some(p) if contains_words(&text, "much less than") => Some(MUCH_SHARE * p),
            Some(p) if contains_words(&text, "less than") => Some(p),
            _ if contains_words(&text, "a little") || contains_words(&text, "slightly") => Some(LITTLE_SHARE),
            _ => None,
        };
        // In "much less than 60 %", "less" does not state a decrease.
        let less = if percent.is_some() && contains_words(&text, "less than") { usize::MAX } else { less };
        let earliest = same.min(more).min(less).min(gone).min(nothing);
        match (earliest, percent) {
            (usize::MAX, _) => None,
            (at, _) if at == nothing => Some(Relation::Nothing),
            (at, _) if at == gone => Some(Relation::Gone),
            (at, _) if at == same => Some(Relation::Same),
            (at, Some(p)) if most.is_none() => {
                Some(Relation::Times(if at == more { 1.0 + p } else { 1.0 - p }))
            }
            (at, _) => Some(if at == more { Relation::More(most) } else { Relation::Less(most) }),
        }
    }

    /// Whether the relation holds.
    pub(super) fn holds(self, a: f64, b: f64, broke: bool) -> bool {
        let (low, high) = (a.abs(), b.abs());
        match self {
            Relation::Breaks => broke,
            _ if broke => false,
            Relation::Same => (b - a).abs() <= SAME * low,
            Relation::More(most) => high > (1.0 + SAME) * low && most.is_none_or(|p| high < (1.0 + p) * low),
            Relation::Less(most) => high < (1.0 - SAME) * low && most.is_none_or(|p| high > (1.0 - p) * low),
            Relation::Times(f) => (high / low - f).abs() <= ABOUT * f,
            Relation::Gone => (b - a).abs() > 0.5 * low,
            Relation::Nothing => high <= SAME * low,
        }
    }

    /// The condition, with the names of both numbers and of the run of the second. Negative numbers are compared by magnitude.
    pub(super) fn condition(self, a: &str, b: &str, run: &str, below: bool) -> String {
        let size = |x: &str| if below { format!("abs({x})") } else { x.to_string() };
        let [low, high] = [size(a), size(b)];
        let mut text = String::new();
        let _ = match self {
            Relation::Breaks => write!(text, "{run}.warnings > 0"),
            Relation::Same => write!(text, "abs({b} - {a}) <= {SAME} * {low}"),
            Relation::More(None) => write!(text, "{high} > {} * {low}", 1.0 + SAME),
            Relation::More(Some(p)) => {
                write!(
                    text,
                    "{high} > {} * {low} && {high} < {} * {low}",
                    1.0 + SAME,
                    rounded_number(1.0 + p)
                )
            }
            Relation::Less(None) => write!(text, "{high} < {} * {low}", 1.0 - SAME),
            Relation::Less(Some(p)) => {
                write!(
                    text,
                    "{high} < {} * {low} && {high} > {} * {low}",
                    1.0 - SAME,
                    rounded_number(1.0 - p)
                )
            }
            Relation::Times(f) => {
                write!(text, "abs({high} / {low} - {}) <= {}", rounded_number(f), rounded_number(ABOUT * f))
            }
            Relation::Gone => write!(text, "abs({b} - {a}) > 0.5 * {low}"),
            Relation::Nothing => write!(text, "{high} <= {SAME} * {low}"),
        };
        text
    }
}

/// The first number before a percent sign, as a share.
fn percent(text: &str) -> Option<f64> {
    let before = text.split('%').next().filter(|_| text.contains('%'))?.trim_end();
    let digits = before.rsplit(|c: char| !c.is_ascii_digit() && c != '.').next()?;
    digits.parse::<f64>().ok().map(|p| p / 100.0)
}

/// A number for a condition, rounded to four decimals.
fn rounded_number(x: f64) -> f64 {
    (x * 1e4).round() / 1e4
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_are_read_as_relations() {
        for (words, relation) in [
            ("Nothing measurable changes", Some(Relation::Same)),
            ("The same 0.53 mrad: a limit's softness does not depend on the load", Some(Relation::Same)),
            ("Farther, but by much less than 60%", Some(Relation::More(Some(MUCH_SHARE * 0.6)))),
            ("About 60% farther, in proportion to the load", Some(Relation::Times(1.6))),
            ("About 20 % shorter", Some(Relation::Times(0.8))),
            ("It creeps a little faster but stays", Some(Relation::More(Some(LITTLE_SHARE)))),
            ("It slides out of the grasp", Some(Relation::Gone)),
            ("The ball tunnels through the floor", Some(Relation::Gone)),
            ("MuJoCo refuses to run", Some(Relation::Breaks)),
            ("It doubles", Some(Relation::Times(2.0))),
            ("It is half as high", Some(Relation::Times(0.5))),
            (
                "Touchdown is detected later, the ball sinks deeper, but it does not fall through",
                Some(Relation::More(None)),
            ),
            ("Lower than before", Some(Relation::Less(None))),
            ("It vanishes", Some(Relation::Nothing)),
            ("Exactly at the stop: a heavier arm presses harder", Some(Relation::Nothing)),
            ("Because the wheel is round", None),
        ] {
            assert_eq!(Relation::read(words), relation, "{words}");
        }
    }

    #[test]
    fn relations_hold_or_not() {
        for (relation, a, b, holds) in [
            (Relation::Same, 2.0, 2.01, true),
            (Relation::Same, 2.0, 2.1, false),
            (Relation::More(None), -2.0, -2.1, true),
            (Relation::More(Some(0.42)), 0.526, 0.665, true),
            (Relation::More(Some(0.2)), 0.526, 0.665, false),
            (Relation::Times(1.6), 0.526, 0.665, false),
            (Relation::Gone, 0.25, 0.02, true),
            (Relation::Nothing, 0.25, 0.001, true),
            (Relation::Less(None), 0.25, 0.2, true),
        ] {
            assert_eq!(relation.holds(a, b, false), holds, "{relation:?} {a} {b}");
            assert!(!relation.holds(a, b, true), "what broke has no numbers");
        }
        assert!(Relation::Breaks.holds(f64::NAN, f64::NAN, true));
    }
}
