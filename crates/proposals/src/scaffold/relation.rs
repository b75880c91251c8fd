//! The relation that the words of an option state: how a number after a change compares with its value before.

use super::factors::{percent, share, times};
use super::words::{contains_any, contains_words, place};

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
    /// More than this factor.
    Above(f64),
    /// Less than this factor.
    Below(f64),
    /// It changes by more than half: something falls, slips or flies away.
    Gone,
    /// Approximately zero.
    Nothing,
    /// It becomes larger, with its sign.
    Rises,
    /// It becomes smaller, with its sign.
    Sinks,
    /// The simulation fails.
    Breaks,
}

/// The words for more and less of one quantity, which count before the general ones: in "the higher pulse is faster", the speed
/// is larger.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Directions {
    pub(super) up: &'static [&'static str],
    pub(super) down: &'static [&'static str],
}

/// The relative tolerance for equality.
pub(super) const SAME: f64 = 0.02;
/// The relative tolerance of a stated factor.
const ABOUT: f64 = 0.1;
/// The share for "a little".
const LITTLE_SHARE: f64 = 0.2;
/// The share for "much less than".
const MUCH_SHARE: f64 = 0.7;
/// The factor for "hardly".
const HARDLY: f64 = 0.1;

const SAME_WORDS: [&str; 25] = [
    "same",
    "nothing changes",
    "nothing measurable",
    "unchanged",
    "no change",
    "does not change",
    "doesn't change",
    "equal",
    "equally",
    "no difference",
    "no effect",
    "does not depend",
    "does not matter",
    "stays",
    "stay",
    "remains",
    "nothing happens",
    "nothing",
    "as before",
    "just as",
    "as it was",
    "as ever",
    "no longer than before",
    "no faster than before",
    "no more than before",
];
const MORE: [&str; 27] = [
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
    "grow",
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
const LESS: [&str; 17] = [
    "earlier",
    "less",
    "lower",
    "shorter",
    "smaller",
    "decreases",
    "decrease",
    "shrinks",
    "shrink",
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
const ZERO_WORDS: [&str; 11] = [
    "zero",
    "exactly at",
    "vanishes",
    "not at all",
    "nothing is left",
    "nothing remains",
    "none is left",
    "all of it is lost",
    "all is lost",
    "it is all lost",
    "disappears",
];
const HARDLY_WORDS: [&str; 4] = ["hardly", "barely", "almost not", "almost nothing"];

impl Relation {
    /// Reads the relation that an option states, or `None` if its words are unknown.
    pub(super) fn read(option: &str, directions: Directions) -> Option<Relation> {
        let text = option.to_lowercase();
        // The first statement counts; the rest are reasons and reservations.
        let statement = text.split(':').next().unwrap_or(&text);
        Relation::of_statement(statement, directions).or_else(|| Relation::of_statement(&text, directions))
    }

    fn of_statement(text: &str, directions: Directions) -> Option<Relation> {
        if contains_any(text, &BREAKS) {
            return Some(Relation::Breaks);
        }
        match text.trim().trim_end_matches('.') {
            "positive" => return Some(Relation::Rises),
            "negative" => return Some(Relation::Sinks),
            _ => {}
        }
        let zero = place(text, &ZERO_WORDS);
        let [general_more, general_less] = [&MORE[..], &LESS].map(|list| place(text, list));
        let [own_more, own_less] = [directions.up, directions.down].map(|list| place(text, list));
        let is_own = own_more.min(own_less) < usize::MAX;
        let (more, less) = if is_own { (own_more, own_less) } else { (general_more, general_less) };
        if zero == usize::MAX
            && let Some(factor) = Relation::of_factor(text, more, less)
        {
            return Some(factor);
        }
        if contains_any(text, &HARDLY_WORDS) {
            return Some(Relation::Below(HARDLY));
        }
        let [same, gone] = [&SAME_WORDS[..], &ABSENCE_WORDS].map(|list| place(text, list));
        let most = match percent(text) {
            Some(p) if contains_words(text, "much less than") => Some(MUCH_SHARE * p),
            Some(p) if contains_words(text, "less than") => Some(p),
            _ if contains_words(text, "a little") || contains_words(text, "slightly") => Some(LITTLE_SHARE),
            _ => None,
        };
        // In "much less than 60 %", "less" does not state a decrease.
        let less = if most.is_some() && percent(text).is_some() && !is_own { usize::MAX } else { less };
        match same.min(more).min(less).min(gone).min(zero) {
            usize::MAX => None,
            first if first == zero => Some(Relation::Nothing),
            first if first == gone => Some(Relation::Gone),
            // "just as", "as fast as before": the word of the quantity comes first.
            first if first == same => Some(Relation::Same),
            first => Some(if first == more { Relation::More(most) } else { Relation::Less(most) }),
        }
    }

    /// A factor or a share: `four times as long`, `less than half`, `about 10 % shorter`, `a third of it is lost`.
    fn of_factor(text: &str, more: usize, less: usize) -> Option<Relation> {
        if let Some(factor) = times(text) {
            let is_down = less < more && factor > 1.0 && !contains_words(text, "less than");
            let factor = if is_down { 1.0 / factor } else { factor };
            return Some(match () {
                () if contains_words(text, "more than") => Relation::Above(factor),
                () if contains_words(text, "less than") => Relation::Below(factor),
                () => Relation::Times(factor),
            });
        }
        let share = share(text)?;
        let is_bound = contains_words(text, "less than");
        let compares = more.min(less) < usize::MAX;
        match () {
            // "Farther, but by much less than 60 %" states an increase, with a bound.
            () if is_bound && percent(text).is_some() => None,
            () if is_bound => Some(Relation::Below(share)),
            () if contains_any(text, &["lost", "is missing"]) => Some(Relation::Times(1.0 - share)),
            () if contains_any(text, &["left", "remains", "remain", "survives"]) => {
                Some(Relation::Times(share))
            }
            () if contains_words(text, "half") && !contains_words(text, "by half") => {
                Some(Relation::Times(share))
            }
            () if compares && more < less => Some(Relation::Times(1.0 + share)),
            () if compares => Some(Relation::Times(1.0 - share)),
            () if contains_words(text, "by half") => Some(Relation::Times(1.0 - share)),
            () if percent(text).is_none() => Some(Relation::Times(share)),
            () => None,
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
            Relation::Above(f) => high > f * low,
            Relation::Below(f) => high < f * low,
            Relation::Gone => (b - a).abs() > 0.5 * low,
            Relation::Nothing => high <= SAME * low,
            Relation::Rises => b - a > SAME * low,
            Relation::Sinks => a - b > SAME * low,
        }
    }

    /// The condition, with the names of both numbers and of the run of the second. Negative numbers are compared by magnitude.
    pub(super) fn condition(self, a: &str, b: &str, run: &str, below: bool) -> String {
        let size = |x: &str| if below { format!("abs({x})") } else { x.to_string() };
        let [low, high] = [size(a), size(b)];
        let [over, under] = [1.0 + SAME, 1.0 - SAME];
        match self {
            Relation::Breaks => format!("{run}.warnings > 0"),
            Relation::Same => format!("abs({b} - {a}) <= {SAME} * {low}"),
            Relation::More(None) => format!("{high} > {over} * {low}"),
            Relation::More(Some(p)) => {
                format!("{high} > {over} * {low} && {high} < {} * {low}", rounded_number(1.0 + p))
            }
            Relation::Less(None) => format!("{high} < {under} * {low}"),
            Relation::Less(Some(p)) => {
                format!("{high} < {under} * {low} && {high} > {} * {low}", rounded_number(1.0 - p))
            }
            Relation::Times(f) => {
                format!("abs({high} / {low} - {}) <= {}", rounded_number(f), rounded_number(ABOUT * f))
            }
            Relation::Above(f) => format!("{high} > {} * {low}", rounded_number(f)),
            Relation::Below(f) => format!("{high} < {} * {low}", rounded_number(f)),
            Relation::Gone => format!("abs({b} - {a}) > 0.5 * {low}"),
            Relation::Nothing => format!("{high} <= {SAME} * {low}"),
            Relation::Rises => format!("{b} - {a} > {SAME} * abs({a})"),
            Relation::Sinks => format!("{a} - {b} > {SAME} * abs({a})"),
        }
    }
}

/// A number for a condition, rounded to four decimals.
pub(super) fn rounded_number(x: f64) -> f64 {
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
            ("It is about 2.5 times as long", Some(Relation::Times(2.5))),
            ("positive", Some(Relation::Rises)),
            ("negative", Some(Relation::Sinks)),
            ("Exactly at the stop: a heavier arm presses harder", Some(Relation::Nothing)),
            ("Because the wheel is round", None),
            ("Just as fast as before", Some(Relation::Same)),
            ("As deep as before", Some(Relation::Same)),
            ("Four times as fast", Some(Relation::Times(4.0))),
            ("Three times slower", Some(Relation::Times(1.0 / 3.0))),
            ("A third slower than before", Some(Relation::Times(1.0 - 1.0 / 3.0))),
            ("A quarter as fast", Some(Relation::Times(0.25))),
            ("It is less than half", Some(Relation::Below(0.5))),
            ("Less than half as high", Some(Relation::Below(0.5))),
            ("More than twice as long", Some(Relation::Above(2.0))),
            ("About half of it is left", Some(Relation::Times(0.5))),
            ("A third of it is lost", Some(Relation::Times(1.0 - 1.0 / 3.0))),
            ("All of it is lost", Some(Relation::Nothing)),
            ("Nothing is left", Some(Relation::Nothing)),
            ("Not at all: it comes to rest", Some(Relation::Nothing)),
            ("It hardly rises at all", Some(Relation::Below(HARDLY))),
            ("It is shorter, because the pull is stronger", Some(Relation::Less(None))),
            ("It is the same: the probe is faster", Some(Relation::Same)),
            ("Nothing", Some(Relation::Same)),
        ] {
            assert_eq!(Relation::read(words, Directions::default()), relation, "{words}");
        }
        // The words of the quantity count first.
        let speed = Directions { up: &["faster"], down: &["slower"] };
        assert_eq!(Relation::read("The higher pulse is slower", speed), Some(Relation::Less(None)));
        assert_eq!(Relation::read("The heavier ball is higher", speed), Some(Relation::More(None)));
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
            (Relation::Above(2.0), 1.0, 2.4, true),
            (Relation::Below(0.5), 1.0, -0.6, false),
            (Relation::Gone, 0.25, 0.02, true),
            (Relation::Nothing, 0.25, 0.001, true),
            (Relation::Less(None), 0.25, 0.2, true),
            (Relation::Rises, -2.0, -1.0, true),
            (Relation::Sinks, 2.0, -1.0, true),
        ] {
            assert_eq!(relation.holds(a, b, false), holds, "{relation:?} {a} {b}");
            assert!(!relation.holds(a, b, true), "what broke has no numbers");
        }
        assert!(Relation::Breaks.holds(f64::NAN, f64::NAN, true));
    }
}
