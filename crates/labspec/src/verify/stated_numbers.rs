//! Compares the numbers in a true option, or in a true statement, with everything that the question measures: a condition such as
//! `moon.t > earth.t` holds beside "six times as long" and beside "twice as long". A number that belongs to nothing measured is
//! reported.

use super::bound::BoundVerify;
use super::format::significant;
use super::option_numbers::is_below;
use super::outcome::MeasuredRuns;
use super::quote::{OptionNumber, conversion, option_ratio, quantities_in};
use super::units;
use crate::finding::Finding;
use crate::json::Scalar;
use crate::rules;
use crate::source::{SourceMap, Text};
use crate::spec::Question;
use labspec_bind::units::written;
use labspec_expr::ast::{BinaryOp, Expr, ExprKind, LogicalOp, UnaryOp};
use labspec_expr::dimension::{Dimension, Measure};
use labspec_expr::{parse_expression, print};

/// The most measured values of which sums, differences and ratios are formed.
const MAX_VALUES: usize = 60;
/// Relative difference up to which a ratio in words is that of the simulation.
const RATIO_TOLERANCE: f64 = 0.05;
/// The most words of an option that states a ratio without naming a quantity.
const MAX_BARE_WORDS: usize = 3;

/// A measured value with its dimension.
#[derive(Clone, Copy, Debug)]
struct MeasuredQuantity {
    value: f64,
    dimension: Dimension,
}

/// Reports true options, or a true statement, whose numbers are those of nothing that the question measures. `held`: which
/// conditions hold. Returns the reason if there is one.
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

fn contradiction(
    bound: &BoundVerify<'_>,
    outcome: &MeasuredRuns,
    question: &Question,
    text: &Text,
    condition: &Text,
) -> Option<String> {
    let compared = compared_values(bound, outcome, condition)?;
    let all = measured_values(bound, outcome, &compared);
    let stated = quantities_in(&text.value, bound.stage().languages());
    let of = |q: &OptionNumber, measured: &MeasuredQuantity| {
        let is_share = q.unit.percentage().is_some();
        q.unit.dimension.filter(|_| !is_share).and_then(|expected| conversion(&expected, &measured.dimension))
    };
    let about_it: Vec<&OptionNumber> =
        stated.iter().filter(|q| compared.iter().any(|measured| of(q, measured).is_some())).collect();
    if about_it.is_empty() {
        return wrong_unit(&stated, &compared).or_else(|| wrong_ratio(text, &compared, &all));
    }
    let given = given_numbers(bound, question, text);
    let agrees = |q: &OptionNumber| {
        // A bound is one of what the condition compares first, not of any difference.
        let is_bound = !(q.low.is_finite() && q.high.is_finite());
        let measured = if is_bound { compared.get(..1).unwrap_or_default() } else { &all };
        let measured = combinations(measured, |measured| of(q, measured)).into_iter();
        let mut values = measured.flat_map(|x| if is_bound { [x, x] } else { [x, -x] });
        values.any(|x| q.low <= x && x <= q.high) || given.iter().any(|x| is_number_of(q, *x))
    };
    if about_it.iter().any(|q| agrees(q)) {
        return None;
    }
    let q = about_it.first()?;
    let nearest = compared.iter().find_map(|measured| Some(measured.value * of(q, measured)?))?;
    Some(format!("the text says {}, but the condition compares {}", q.text, significant(nearest)))
}

/// Whether a given number is the one that a text states.
fn is_number_of(q: &OptionNumber, x: f64) -> bool {
    let middle = 0.5 * (q.low + q.high);
    let stated = if middle.is_finite() { middle } else { q.low.max(-f64::MAX).max(q.high.min(f64::MAX)) };
    (x.abs() - stated.abs()).abs() <= 1e-6 * x.abs()
}

/// A number that is that of the simulation, with a unit of another dimension.
fn wrong_unit(stated: &[OptionNumber], compared: &[MeasuredQuantity]) -> Option<String> {
    let [q] = stated else { return None };
    let differs =
        q.unit.dimension.is_some_and(|d| compared.iter().all(|measured| !d.agrees(&measured.dimension)));
    let scale = q.unit.percentage().unwrap_or(1.0);
    let close = |measured: &&MeasuredQuantity| {
        measured.value != 0.0 && q.low * scale <= measured.value && measured.value <= q.high * scale
    };
    let measured = compared.iter().find(close).filter(|_| differs)?;
    Some(format!(
        "the text says {}, but the condition compares {} {}",
        q.text,
        significant(measured.value),
        written(&measured.dimension)
    ))
}

/// A ratio in words that is that of no two measured values.
fn wrong_ratio(text: &Text, compared: &[MeasuredQuantity], all: &[MeasuredQuantity]) -> Option<String> {
    let stated = option_ratio(&text.value)?;
    let is_named = |measured: &&MeasuredQuantity| stated.named.iter().any(|d| d.agrees(&measured.dimension));
    let is_bare = stated.named.is_empty() && text.value.split_whitespace().count() <= MAX_BARE_WORDS;
    let about_it = match is_bare {
        true => compared
            .iter()
            .find(|measured| !measured.dimension.is_number())
            .or(all.iter().find(|measured| !measured.dimension.is_number())),
        false => all.iter().find(is_named),
    };
    let about_it = about_it?.dimension;
    let same: Vec<f64> = all
        .iter()
        .filter(|measured| measured.dimension.agrees(&about_it))
        .map(|measured| measured.value)
        .collect();
    let ratios: Vec<f64> = pairs(&same).map(|(a, b)| (a / b).abs()).filter(|x| x.is_finite()).collect();
    let alone = compared
        .iter()
        .filter(|measured| measured.dimension.is_number())
        .map(|measured| measured.value.abs());
    let close = |x: f64| stated.may_be.iter().any(|y| (x - y).abs() <= RATIO_TOLERANCE * y.abs());
    let nearest = ratios.iter().copied().find(|x| *x >= 1.0)?;
    let none = !ratios.iter().copied().chain(alone).any(close);
    none.then(|| format!("the text says {}, but the measured ratio is {}", stated.text, significant(nearest)))
}

/// All ordered pairs of different places of a list.
fn pairs(list: &[f64]) -> impl Iterator<Item = (f64, f64)> {
    list.iter().enumerate().flat_map(move |(i, a)| {
        list.iter().enumerate().filter(move |(k, _)| *k != i).map(move |(_, b)| (*a, *b))
    })
}

/// The values that a text may state: the measured ones, their differences and sums, in the unit that `factor` converts to.
fn combinations(all: &[MeasuredQuantity], factor: impl Fn(&MeasuredQuantity) -> Option<f64>) -> Vec<f64> {
    let converted: Vec<f64> =
        all.iter().filter_map(|measured| Some(measured.value * factor(measured)?)).collect();
    let combined: Vec<f64> = pairs(&converted).flat_map(|(a, b)| [a - b, a + b]).collect();
    converted.into_iter().chain(combined).collect()
}

/// The values that a condition compares, as far as they are measured; `None` if the dimension of one is not known.
fn compared_values(
    bound: &BoundVerify<'_>,
    outcome: &MeasuredRuns,
    condition: &Text,
) -> Option<Vec<MeasuredQuantity>> {
    let mut texts = Vec::new();
    compared_texts(&parse_expression(&condition.value).tree, &mut texts)?;
    let mut all = Vec::new();
    for value in texts {
        let text = Text { map: SourceMap::whole(value.len(), condition.span()), value };
        let found = bound.find(outcome, &text, &mut Vec::new())?.value.to_number();
        let dimension = units::of_claim(bound, outcome, &text)?;
        if found.is_finite() && dimension.is_exact() {
            all.push(MeasuredQuantity { value: found, dimension });
        }
    }
    (!all.is_empty()).then_some(all)
}

/// The measured quantities of a condition: names, products and quotients with numbers, and what is subtracted from each other.
/// `None` if the condition contains anything but comparisons.
fn compared_texts(e: &Expr, texts: &mut Vec<String>) -> Option<()> {
    match &e.kind {
        ExprKind::Logical { op: LogicalOp::And | LogicalOp::Or, left, right } => {
            compared_texts(left, texts)?;
            compared_texts(right, texts)
        }
        ExprKind::Unary { op: UnaryOp::Not, operand } => compared_texts(operand, texts),
        ExprKind::Binary { op, left, right } => {
            is_below(*op, false)?;
            terms(left, texts);
            terms(right, texts);
            (!texts.is_empty()).then_some(())
        }
        _ => None,
    }
}

/// The terms of a sum that are not numbers.
fn terms(e: &Expr, texts: &mut Vec<String>) {
    match &e.kind {
        ExprKind::Number(_) => {}
        ExprKind::Binary { op: BinaryOp::Add | BinaryOp::Subtract, left, right } => {
            terms(left, texts);
            terms(right, texts);
        }
        ExprKind::Binary { op: BinaryOp::Multiply, left, right } if is_number(left) || is_number(right) => {
            terms(left, texts);
            terms(right, texts);
        }
        ExprKind::Unary { op: UnaryOp::Minus, operand } => terms(operand, texts),
        ExprKind::Call { callee, args, .. } if print(callee) == "abs" || print(callee) == "Math.abs" => {
            args.iter().for_each(|arg| terms(arg, texts));
        }
        _ => texts.push(print(e)),
    }
}

fn is_number(e: &Expr) -> bool {
    match &e.kind {
        ExprKind::Number(_) => true,
        ExprKind::Unary { op: UnaryOp::Minus, operand } => is_number(operand),
        _ => false,
    }
}

/// The values of all measures of a known dimension, and those of the condition.
fn measured_values(
    bound: &BoundVerify<'_>,
    outcome: &MeasuredRuns,
    compared: &[MeasuredQuantity],
) -> Vec<MeasuredQuantity> {
    let dimension = |name: &str| {
        let runs = &bound.units()?.runs;
        let (_, measure) = runs.iter().flatten().find(|(of_run, _)| of_run == name)?;
        match measure {
            Measure::Dimension(d) if d.is_exact() => Some(*d),
            _ => None,
        }
    };
    let measures = outcome.runs.iter().flat_map(|run| &run.measures).filter(|(_, x)| x.is_finite());
    let measured =
        measures.filter_map(|(name, x)| Some(MeasuredQuantity { value: *x, dimension: dimension(name)? }));
    compared.iter().copied().chain(measured).take(MAX_VALUES).collect()
}

/// Numbers that a text may repeat: those of the question and of the settings of the runs.
fn given_numbers(bound: &BoundVerify<'_>, question: &Question, text: &Text) -> Vec<f64> {
    let mut all = Vec::new();
    if question.q.span() != text.span() {
        let asked = quantities_in(&question.q.value, bound.stage().languages());
        all.extend(asked.iter().map(|q| 0.5 * (q.low + q.high)));
    }
    for run in bound.runs.iter().filter_map(|run| run.spec) {
        all.extend(run.set.iter().filter_map(|(_, value)| match value {
            Scalar::Number(x) => Some(x.value),
            _ => None,
        }));
        all.extend(run.until.iter().map(|x| x.value));
        all.extend(run.press.iter().map(|(_, time)| time.value));
    }
    all.retain(|x| x.is_finite());
    all
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
                "longer",
                "more than 1 s",
                "never more than 2 s",
                "later than 1 s",
                "no less than 1 s",
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
                "more than 5 s",
                "never more than 1 s",
                "later than 5 s",
                "no less than 5 s",
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
