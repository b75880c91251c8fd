//! Finds conditions that compare in another unit than the text states: "10°" beside `q < 10`, where `q` is in radians.

use super::bound::BoundVerify;
use super::format::significant;
use super::option_numbers::{constant, is_below};
use super::outcome::MeasuredRuns;
use super::quote::{OptionNumber, conversion, quantities_in};
use super::units;
use crate::finding::Finding;
use crate::rules;
use crate::source::Text;
use labspec_bind::units::written;
use labspec_expr::ast::{BinaryOp, Expr, ExprKind, UnaryOp};
use labspec_expr::dimension::Dimension;
use labspec_expr::{parse_expression, print};

/// Reports true options, or a true statement, with a number that its condition has in another unit. Each comes with its condition, which
/// holds. Returns the reason if there is one.
pub(super) fn check_condition_units(
    bound: &BoundVerify<'_>,
    outcome: &MeasuredRuns,
    stated: &[(&Text, &Text)],
    findings: &mut Vec<Finding>,
) -> Option<String> {
    let mut reason = None;
    for (text, condition) in stated {
        let Some(Mismatch { message, help }) = mismatch(bound, outcome, text, condition) else { continue };
        findings.push(
            Finding::error(rules::QUOTE_WRONG, condition.span(), message.clone())
                .why("the condition has the digits of the text but not its unit, so it tests a different number")
                .help(help)
                .related(text.span(), "the text"),
        );
        reason = reason.or(Some(message));
    }
    reason
}

struct Mismatch {
    message: String,
    help: String,
}

fn mismatch(
    bound: &BoundVerify<'_>,
    outcome: &MeasuredRuns,
    text: &Text,
    condition: &Text,
) -> Option<Mismatch> {
    let mut comparisons = Vec::new();
    comparisons_with_numbers(&parse_expression(&condition.value).tree, &mut comparisons);
    if comparisons.is_empty() {
        return None;
    }
    let stated = quantities_in(&text.value, bound.stage().languages());
    comparisons.into_iter().find_map(|(term, number)| {
        let found = units::of_claim(bound, outcome, &Text::derived(term.clone(), condition.span()))?;
        let (q, factor) = stated.iter().find_map(|q| Some((q, factor_to(q, &found, number)?)))?;
        Some(Mismatch {
            message: format!(
                "the text says {}, but the condition compares `{term}`, which is in {}, with {number}",
                q.text,
                unit_name(&found)
            ),
            help: format!("compare `{term}` with {}", significant(number / factor)),
        })
    })
}

/// The factor from the unit of a term to that of a stated number, if the number is the one of the comparison and the units differ.
fn factor_to(stated: &OptionNumber, found: &Dimension, number: f64) -> Option<f64> {
    let differs = (stated.number().abs() - number.abs()).abs() > 1e-6 * number.abs();
    if number == 0.0 || differs {
        return None;
    }
    let factor = match stated.unit.percentage() {
        Some(share) => (found.is_number() && found.is_exact()).then_some(1.0 / share)?,
        None => conversion(&stated.unit.dimension?, found)?,
    };
    ((factor - 1.0).abs() > 1e-3).then_some(factor)
}

fn unit_name(found: &Dimension) -> String {
    if found.is_number() && !found.has_angle() { "parts of 1".into() } else { written(found) }
}

/// Appends each comparison of a term with a number.
fn comparisons_with_numbers(e: &Expr, found: &mut Vec<(String, f64)>) {
    match &e.kind {
        ExprKind::Logical { left, right, .. } => {
            comparisons_with_numbers(left, found);
            comparisons_with_numbers(right, found);
        }
        ExprKind::Unary { op: UnaryOp::Not, operand } => comparisons_with_numbers(operand, found),
        ExprKind::Binary { op, left, right } if is_below(*op, false).is_some() => {
            match (constant(left), constant(right)) {
                (None, Some(number)) => push_comparison(left, number, found),
                (Some(number), None) => push_comparison(right, number, found),
                _ => {}
            }
        }
        _ => {}
    }
}

/// `abs(x - c) < d` compares x with c, and `abs(a / b - 1) < d` a relative difference with d.
fn push_comparison(term: &Expr, number: f64, found: &mut Vec<(String, f64)>) {
    let inner = super::option_numbers::magnitude(term);
    let is_quotient = |e: &Expr| matches!(e.kind, ExprKind::Binary { op: BinaryOp::Divide, .. });
    match inner.map(|inner| &inner.kind) {
        Some(ExprKind::Binary { op: BinaryOp::Subtract, left, right })
            if !(is_quotient(left) && constant(right) == Some(1.0)) =>
        {
            match (constant(left), constant(right)) {
                (None, Some(centre)) => found.push((print(left), centre)),
                (Some(centre), None) => found.push((print(right), centre)),
                _ => {}
            }
        }
        _ => found.push((print(inner.unwrap_or(term)), number)),
    }
}

#[cfg(test)]
mod tests {
    /// The errors about a statement: a pendulum swings by 0.5 rad, and its period is 1.8 s.
    fn errors(text: &str, condition: &str) -> Vec<String> {
        let xml = "<mujoco><worldbody><body><joint name='j' axis='0 1 0'/><geom size='.05' pos='0 0 -.5'/></body></worldbody></mujoco>";
        let lab = serde_json::json!({"stopAt": 4, "xml": xml, "setup": "data.qpos[0] = 0.5"});
        let measure = serde_json::json!({"q": "max(data.qpos[0])", "T": "period(data.qpos[0])", "e": "max(data.qpos[0]) / initial(data.qpos[0])", "a": "initial(data.qpos[0])"});
        let quiz = serde_json::json!({"id": "q", "questions": [{"q": text, "kind": "truefalse", "answer": true,
            "verify": {"lab": lab, "measure": measure, "options": [condition]}}]});
        let report = crate::Checker::new(|_: &str| None::<String>).check("q.json", &quiz.to_string());
        let wrong = report.findings.iter().filter(|finding| finding.code == "quote-wrong");
        wrong.map(|finding| finding.message.clone()).collect()
    }

    #[test]
    fn a_condition_compares_in_the_unit_of_the_text() {
        for (text, condition) in [
            ("It never swings beyond 10°.", "q < 10"),
            ("Its period is less than 300 ms.", "T < 300"),
            ("It keeps more than 50 % of its amplitude.", "0.5 < e && e < 50"),
            ("It changes by less than 1 %.", "abs(q / a - 1) < 1"),
        ] {
            let all = errors(text, condition);
            assert!(all.iter().any(|m| m.contains("but the condition compares")), "{text}: {all:?}");
        }
        for (text, condition) in [
            ("It never swings beyond 40°.", "q * 180 / Math.PI < 40"),
            ("It never swings beyond 40°.", "q < 40 * Math.PI / 180"),
            ("Its period is less than 3 s.", "T < 3"),
            ("It keeps more than 50 % of its amplitude.", "e > 0.5"),
            ("It keeps more than 50 % of its amplitude.", "100 * e > 50"),
            ("It changes by less than 1 %.", "abs(q / a - 1) < 0.01"),
        ] {
            assert_eq!(errors(text, condition), [""; 0], "{text}: {condition}");
        }
    }
}
