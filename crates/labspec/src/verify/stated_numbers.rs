//! Compares the numbers in a true option, or in a true statement, with everything that the question measures: a condition such as
//! `moon.t > earth.t` holds beside "six times as long" and beside "twice as long". A number that belongs to nothing measured is
//! reported.

use super::bound::BoundVerify;
use super::format::significant;
use super::given::given_numbers;
use super::option_numbers::{constant, is_below, magnitude};
use super::outcome::MeasuredRuns;
use super::quote::{BoundSide, OptionNumber, conversion, option_ratio, quantities_in};
use super::units;
use super::value_of::shares_number;
use crate::finding::Finding;
use crate::rules;
use crate::source::Text;
use crate::spec::Question;
use labspec_bind::units::written;
use labspec_expr::ast::{BinaryOp, Expr, ExprKind, LogicalOp, UnaryOp};
use labspec_expr::dimension::{Dimension, Measure};
use labspec_expr::{parse_expression, print};

/// The most values of one measure that are compared in pairs.
const MAX_VALUES: usize = 20;
/// Relative difference up to which a ratio in words is that of the simulation.
const RATIO_TOLERANCE: f64 = 0.05;
/// The largest width of a number, relative to it, whose digits identify it.
const MAX_WIDTH: f64 = 0.15;
/// The most words of an option that states a ratio without naming a quantity, and of one that begins with a pronoun.
const MAX_BARE_WORDS: usize = 3;
const MAX_PRONOUN_WORDS: usize = 7;
const PRONOUNS: [&str; 4] = ["it", "they", "this", "that"];

/// A value with its dimension.
#[derive(Clone, Copy, Debug)]
struct Measurement {
    value: f64,
    dimension: Dimension,
}

impl Measurement {
    /// The value in the unit of a stated number; `None` for another dimension.
    fn in_unit_of(&self, stated: &OptionNumber) -> Option<f64> {
        let expected = stated.unit.dimension.filter(|_| stated.unit.percentage().is_none())?;
        Some(self.value * conversion(&expected, &self.dimension)?)
    }
}

/// What a question measures, as far as its dimension is known.
struct Measurements {
    /// The terms that the condition compares, without their constant factors.
    compared: Vec<Measurement>,
    /// The terms that have a constant factor, times this factor: the way there and back.
    multiples: Vec<Measurement>,
    /// The values of each measure, one for each run that belongs to no sweep.
    measures: Vec<Vec<Measurement>>,
}

impl Measurements {
    fn all(&self) -> impl Iterator<Item = &Measurement> {
        self.compared.iter().chain(&self.multiples).chain(self.measures.iter().flatten())
    }

    /// All pairs of which a text may state the difference or the ratio: two terms of the condition, or one measure in two runs.
    fn pairs(&self) -> impl Iterator<Item = (&Measurement, &Measurement)> {
        let groups = self.measures.iter().chain([&self.compared]);
        groups.flat_map(|group| {
            let others = move |i: usize| group.iter().enumerate().filter(move |(k, _)| *k != i);
            group.iter().enumerate().flat_map(move |(i, a)| others(i).map(move |(_, b)| (a, b)))
        })
    }
}

/// Reports true options, or a true statement, whose numbers are those of nothing that the question measures. Each comes with its
/// condition, which holds. Returns the reason if there is one.
pub(super) fn check_stated_numbers(
    bound: &BoundVerify<'_>,
    outcome: &MeasuredRuns,
    question: &Question,
    stated: &[(&Text, &Text)],
    findings: &mut Vec<Finding>,
) -> Option<String> {
    let mut reason = None;
    for (text, condition) in stated {
        let Some(message) = contradiction(bound, outcome, question, text, condition) else { continue };
        findings.push(
            Finding::error(rules::QUOTE_WRONG, text.span(), message.clone())
                .why("a reader takes the number for a result, but nothing that this question measures gives it")
                .help("correct the number, or measure what it states and compare it in the condition")
                .related(condition.span(), "the condition holds, whatever the number says"),
        );
        reason = reason.or(Some(message));
    }
    reason
}

/// The contradiction between a text and what its condition compares; `None` if there is none, or if the dimension of a compared
/// term is not known.
fn contradiction(
    bound: &BoundVerify<'_>,
    outcome: &MeasuredRuns,
    question: &Question,
    text: &Text,
    condition: &Text,
) -> Option<String> {
    let (compared, multiples) = compared_terms(bound, outcome, condition)?;
    let found = Measurements { compared, multiples, measures: measures(bound, outcome) };
    let stated = quantities_in(&text.value, bound.stage().languages());
    let given = given_numbers(bound, question, text);
    let is_compared = |q: &&OptionNumber| found.compared.iter().any(|term| term.in_unit_of(q).is_some());
    let about_it: Vec<&OptionNumber> = stated.iter().filter(is_compared).collect();
    let Some(first) = about_it.first() else {
        // "after 1 s" names a setting, not what is compared.
        let (settings, stated): (Vec<_>, Vec<_>) =
            stated.into_iter().partition(|q| given.iter().any(|number| number.is(q)));
        let words = settings.iter().fold(text.value.to_string(), |words, q| words.replace(&q.text, ""));
        return wrong_unit(&stated, &found.compared).or_else(|| wrong_ratio(&words, &found));
    };
    // The bound of a difference is a number of the condition: "at most 0.7 s longer" beside `b.t - a.t < 0.7`.
    let is_tested = |q: &OptionNumber| is_difference(condition) && shares_number(&q.text, &condition.value);
    if about_it
        .iter()
        .any(|q| is_measured(q, &found) || is_tested(q) || given.iter().any(|number| number.is(q)))
    {
        return None;
    }
    let nearest = found.compared.iter().find_map(|term| term.in_unit_of(first))?;
    Some(format!("the text says {}, but the condition compares {}", first.text, significant(nearest)))
}

/// Whether a condition compares two measured terms: their difference, or one with a part or a multiple of the other.
fn is_difference(condition: &Text) -> bool {
    let mut terms = Vec::new();
    terms_of_condition(&parse_expression(&condition.value).tree, &mut terms).is_some() && terms.len() > 1
}

/// Whether a stated number is a measured one, or a difference or a sum of two. A bound is one of what the condition compares
/// first.
fn is_measured(stated: &OptionNumber, found: &Measurements) -> bool {
    let agrees = |x: f64| stated.low <= x && x <= stated.high;
    if !(stated.low.is_finite() && stated.high.is_finite()) {
        return found.compared.first().and_then(|term| term.in_unit_of(stated)).is_some_and(agrees);
    }
    let either_sign = |x: f64| agrees(x) || agrees(-x);
    let value = |term: &Measurement| term.in_unit_of(stated);
    found.all().filter_map(value).any(either_sign)
        || found.pairs().filter_map(|(a, b)| Some(value(a)? - value(b)?)).any(either_sign)
        || found.compared.iter().filter_map(value).reduce(|a, b| a + b).is_some_and(either_sign)
}

/// A number that is that of the simulation, with a unit of another dimension. A number of one digit is near too many others.
fn wrong_unit(stated: &[OptionNumber], compared: &[Measurement]) -> Option<String> {
    let [q] = stated else { return None };
    let is_bound = !(q.low.is_finite() && q.high.is_finite());
    if is_bound || q.high - q.low > MAX_WIDTH * q.low.abs().max(q.high.abs()) {
        return None;
    }
    let differs = q.unit.dimension.is_some_and(|d| compared.iter().all(|term| !d.agrees(&term.dimension)));
    let scale = q.unit.percentage().unwrap_or(1.0);
    let close = |term: &&Measurement| {
        term.value != 0.0 && q.low * scale <= term.value && term.value <= q.high * scale
    };
    let term = compared.iter().find(close).filter(|_| differs)?;
    Some(format!(
        "the text says {}, but the condition compares {} {}",
        q.text,
        significant(term.value),
        written(&term.dimension)
    ))
}

/// A ratio in words that is that of no two measured values.
fn wrong_ratio(text: &str, found: &Measurements) -> Option<String> {
    let stated = option_ratio(text)?;
    let words: Vec<String> = text.split_whitespace().map(str::to_lowercase).collect();
    let is_bare = stated.named.is_empty() && words.len() <= MAX_BARE_WORDS;
    let is_pronoun = words.first().is_some_and(|word| PRONOUNS.contains(&word.as_str()));
    // "It is six times as large" is about any quantity that is measured twice.
    let is_open = stated.named.is_empty() && is_pronoun && words.len() <= MAX_PRONOUN_WORDS;
    let is_named = |term: &Measurement| match is_bare || is_open {
        true => !term.dimension.is_number(),
        false => stated.named.iter().any(|d| d.agrees(&term.dimension)),
    };
    let about_it = found.all().find(|term| is_named(term))?.dimension;
    let both = |(a, b): &(&Measurement, &Measurement)| {
        a.dimension.agrees(&b.dimension) && is_named(a) && (is_open || a.dimension.agrees(&about_it))
    };
    let ratios: Vec<f64> = found
        .pairs()
        .filter(both)
        .map(|(a, b)| (a.value / b.value).abs())
        .filter(|x| x.is_finite())
        .collect();
    // A condition may compare the ratio itself.
    let compared =
        found.compared.iter().filter(|term| term.dimension.is_number()).map(|term| term.value.abs());
    let close = |x: f64| {
        stated.may_be.iter().any(|y| match stated.side {
            None => (x - y).abs() <= RATIO_TOLERANCE * y.abs(),
            Some(BoundSide::Above) => x >= y * (1.0 - RATIO_TOLERANCE),
            Some(BoundSide::Below) => x <= y * (1.0 + RATIO_TOLERANCE),
        })
    };
    let nearest = ratios.iter().copied().find(|x| *x >= 1.0)?;
    let none = !ratios.iter().copied().chain(compared).any(close);
    none.then(|| format!("the text says {}, but the measured ratio is {}", stated.text, significant(nearest)))
}

/// The terms that a condition compares, and those that have a constant factor, times this factor; `None` if it is no comparison, or the
/// dimension of a term cannot be computed.
fn compared_terms(
    bound: &BoundVerify<'_>,
    outcome: &MeasuredRuns,
    condition: &Text,
) -> Option<(Vec<Measurement>, Vec<Measurement>)> {
    let mut found = Vec::new();
    terms_of_condition(&parse_expression(&condition.value).tree, &mut found)?;
    let (mut terms, mut multiples) = (Vec::new(), Vec::new());
    for Term { text, factor } in found {
        let text = Text::derived(text, condition.span());
        let value = bound.find(outcome, &text, &mut Vec::new())?.value.to_number();
        let dimension = units::of_claim(bound, outcome, &text)?;
        if !value.is_finite() || !dimension.is_exact() {
            continue;
        }
        terms.push(Measurement { value, dimension });
        if factor != 1.0 {
            multiples.push(Measurement { value: factor * value, dimension });
        }
    }
    (!terms.is_empty()).then_some((terms, multiples))
}

/// A term of a condition: its text without the constant factor.
struct Term {
    text: String,
    factor: f64,
}

/// Appends the terms on both sides of each comparison. `None` if the condition contains anything but comparisons.
fn terms_of_condition(e: &Expr, found: &mut Vec<Term>) -> Option<()> {
    match &e.kind {
        ExprKind::Logical { op: LogicalOp::And | LogicalOp::Or, left, right } => {
            terms_of_condition(left, found)?;
            terms_of_condition(right, found)
        }
        ExprKind::Unary { op: UnaryOp::Not, operand } => terms_of_condition(operand, found),
        ExprKind::Binary { op, left, right } => {
            is_below(*op, false)?;
            terms(left, 1.0, found);
            terms(right, 1.0, found);
            (!found.is_empty()).then_some(())
        }
        _ => None,
    }
}

/// Appends the terms of a sum that are not numbers, with their constant factors apart.
fn terms(e: &Expr, factor: f64, found: &mut Vec<Term>) {
    if constant(e).is_some() {
        return;
    }
    if let Some(inner) = magnitude(e) {
        return terms(inner, factor, found);
    }
    match &e.kind {
        ExprKind::Binary { op: BinaryOp::Add | BinaryOp::Subtract, left, right } => {
            terms(left, factor, found);
            terms(right, factor, found);
        }
        ExprKind::Binary { op: BinaryOp::Multiply, left, right } => match (constant(left), constant(right)) {
            (Some(number), None) => terms(right, number * factor, found),
            (None, Some(number)) => terms(left, number * factor, found),
            _ => found.push(Term { text: print(e), factor }),
        },
        ExprKind::Unary { op: UnaryOp::Minus, operand } => terms(operand, factor, found),
        _ => found.push(Term { text: print(e), factor }),
    }
}

/// The values of each measure whose dimension is known. The many values of a sweep would agree with any number.
fn measures(bound: &BoundVerify<'_>, outcome: &MeasuredRuns) -> Vec<Vec<Measurement>> {
    let mut all: Vec<(&str, Vec<Measurement>)> = Vec::new();
    let Some(units) = bound.units() else { return Vec::new() };
    for (name, measure) in units.runs.iter().flatten() {
        let Measure::Dimension(dimension) = measure else { continue };
        if !dimension.is_exact() || all.iter().any(|(other, _)| other == name) {
            continue;
        }
        let runs = outcome.runs.iter().filter(|run| run.swept.is_none());
        let values = runs.flat_map(|run| &run.measures).filter(|(of_run, x)| of_run == name && x.is_finite());
        let values = values.take(MAX_VALUES).map(|(_, x)| Measurement { value: *x, dimension: *dimension });
        all.push((name, values.collect()));
    }
    all.into_iter().map(|(_, values)| values).collect()
}

#[cfg(test)]
mod tests {
    /// The errors about a question: the same fall on the earth and on the moon takes 0.43 s and 1.06 s.
    fn errors(question: serde_json::Value) -> Vec<String> {
        let control = serde_json::json!({"label": "gravity (m/s²)", "set": "model.opt.gravity[2]", "min": -20, "max": 0, "step": 0.01, "value": -9.81, "reset": true});
        let lab = serde_json::json!({"stopAt": 2, "controls": [control],
            "xml": "<mujoco><worldbody><body pos='0 0 .9'><freejoint/><geom size='.05'/></body></worldbody></mujoco>"});
        let runs = serde_json::json!({"earth": {"set": {"gravity (m/s²)": -9.81}}, "moon": {"set": {"gravity (m/s²)": -1.62}}});
        let verify =
            serde_json::json!({"lab": lab, "runs": runs, "measure": {"t": "crossing(data.qpos[2])"}});
        let mut question = question;
        for (key, value) in verify.as_object().unwrap() {
            question["verify"][key] = value.clone();
        }
        let quiz = serde_json::json!({"id": "q", "questions": [question]}).to_string();
        let report = crate::Checker::new(|_: &str| None::<String>).check("q.json", &quiz);
        report.findings.iter().map(|finding| finding.message.clone()).collect()
    }

    fn choice(option: &str, condition: &str) -> Vec<String> {
        errors(
            serde_json::json!({"q": "How long does the fall from 0.9 m take on the moon?", "options": [option, "as long as on the earth"],
            "answer": 0, "verify": {"options": [condition, "abs(moon.t - earth.t) < 0.01"]}}),
        )
    }

    #[test]
    fn a_true_option_states_what_is_measured() {
        let conditions =
            ["abs(moon.t - 1.054) < 0.01", "moon.t > 1.1 * earth.t", "abs(moon.t - 2.46 * earth.t) < 0.1"];
        for condition in conditions {
            for option in [
                "after 1.05 s",
                "at 1.1 s",
                "0.63 s longer",
                "2.5 times as long",
                "it is 2.5 times as large",
                "it grows by a factor of 2.5",
                "longer",
                "more than 1 s",
                "never more than 2 s",
                "later than 1 s",
                "no less than 1 s",
                "within 2 s",
                "longer, from 0.9 m",
                "1050 ms, because g is 1.62 m/s²",
            ] {
                assert_eq!(choice(option, condition), [""; 0], "{option}: {condition}");
            }
            for option in [
                "after 9.9 s",
                "at 9.9 s after the release",
                "9.9 s longer",
                "six times as long",
                "it takes six times as long",
                "it is five times as large",
                "it grows sixfold",
                "it grows by a factor of 6",
                "more than 5 s",
                "never more than 1 s",
                "later than 5 s",
                "no less than 5 s",
                "within 1 s",
                "less than 1 s",
                "1.05 m/s",
                "105 ms, because g is 1.62 m/s²",
            ] {
                let all = choice(option, condition);
                assert!(
                    all.iter().any(|m| m.contains("the text says") || m.contains("the option says")),
                    "{option}: {condition}: {all:?}"
                );
            }
        }
    }

    #[test]
    fn a_constant_factor_belongs_to_what_is_stated() {
        for (option, condition) in [
            ("0.86 s in total, there and back", "abs(2 * earth.t - 0.86) < 0.02"),
            ("half of it takes 0.53 s", "abs(moon.t / 2 - 0.53) < 0.01"),
        ] {
            assert_eq!(choice(option, condition), [""; 0], "{option}: {condition}");
        }
        assert_eq!(choice("0.99 s in total", "abs(2 * earth.t - 0.86) < 0.02").len(), 1);
    }

    #[test]
    fn a_true_statement_states_what_is_measured() {
        let statement = |text: &str| {
            errors(
                serde_json::json!({"q": text, "kind": "truefalse", "answer": true, "verify": {"options": ["moon.t > 2 * earth.t"]}}),
            )
        };
        for text in [
            "On the moon it lands after 1.05 s.",
            "With g = 1.62 m/s², it takes 2.5 times as long.",
            "It lands later on the moon.",
        ] {
            assert_eq!(statement(text), [""; 0], "{text}");
        }
        for text in ["On the moon it lands after 9.9 s.", "On the moon it takes six times as long."] {
            assert_eq!(statement(text).len(), 1, "{text}");
        }
    }
}
