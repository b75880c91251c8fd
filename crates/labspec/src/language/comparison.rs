use super::degrees::Degree;

/// Words with which a text compares two values, or states a change.
#[derive(Debug, PartialEq, Eq)]
pub struct Comparison {
    /// Behind a number in percent.
    pub percent: &'static [&'static str],
    /// Comparatives of smaller quantities: `shorter`.
    pub smaller: &'static [&'static str],
    /// Comparatives of larger quantities: `longer`.
    pub larger: &'static [&'static str],
    /// Beginnings of verbs that state a decrease: `drop`.
    pub decreases: &'static [&'static str],
    /// Beginnings of verbs that state an increase: `grow`.
    pub increases: &'static [&'static str],
    /// Before the number of a change: `by`.
    pub by: &'static [&'static str],
    /// Verbs before what is lost: `loses 35 %`.
    pub loses: &'static [&'static str],
    /// Behind what is lost: `35 % is lost`.
    pub is_lost: &'static [&'static str],
    /// Verbs before what remains: `keeps 65 %`.
    pub keeps: &'static [&'static str],
    /// Behind what remains: `65 % is left`.
    pub remains: &'static [&'static str],
    /// They ask for a number in percent: `how many percent`.
    pub asks_percent: &'static [&'static str],
    /// They say that values are nearly the same, beside the words before approximate numbers.
    pub nearly_equal: &'static [&'static str],
    /// Before a bound of a result: `within 5 s`.
    pub within: &'static [&'static str],
    /// Before a time that is a setting: `after a second`.
    pub after: &'static [&'static str],
    /// They say how large a difference is, without figures: `a tenth of a second`.
    pub sizes: &'static [&'static str],
    /// They negate a verb: `not`.
    pub negations: &'static [&'static str],
    /// They negate a noun, or the bound behind them: `no more than`.
    pub negative_articles: &'static [&'static str],
    /// They name the largest value of a run: `highest`.
    pub highest: &'static [&'static str],
    /// They name the smallest value of a run: `lowest`.
    pub lowest: &'static [&'static str],
    /// They name the mean of a run.
    pub average: &'static [&'static str],
    /// They name the value at the start of a run.
    pub at_start: &'static [&'static str],
    /// They name the value at the end of a run.
    pub at_end: &'static [&'static str],
    /// They state a bound together with the word behind them: `at least as fast`.
    pub limits: &'static [&'static str],
    /// Words that say that one of two values is larger, or smaller.
    pub degrees: &'static [(&'static str, Degree)],
    /// Before what something is compared with: `than`.
    pub than: &'static [&'static str],
    /// Before the second of two settings: `from 1 kg to 2 kg`.
    pub to: &'static [&'static str],
    /// They name an object by another one: `the other ball`.
    pub partners: &'static [&'static str],
    /// Before an object that acts on another one: `by`.
    pub agents: &'static [&'static str],
    /// Ordinal numbers, with the number: `second`.
    pub ordinals: &'static [(&'static str, usize)],
    /// Names of what happens once or several times in a run, beside an ordinal number: `bounce`.
    pub events: &'static [&'static str],
}

/// For languages whose comparisons are not read.
pub(super) const UNREAD: Comparison = Comparison {
    percent: &[],
    smaller: &[],
    larger: &[],
    decreases: &[],
    increases: &[],
    by: &[],
    loses: &[],
    is_lost: &[],
    keeps: &[],
    remains: &[],
    asks_percent: &[],
    nearly_equal: &[],
    within: &[],
    after: &[],
    sizes: &[],
    negations: &[],
    negative_articles: &[],
    highest: &[],
    lowest: &[],
    average: &[],
    at_start: &[],
    at_end: &[],
    limits: &[],
    degrees: &[],
    than: &[],
    to: &[],
    partners: &[],
    agents: &[],
    ordinals: &[],
    events: &[],
};
