//! Finds conditions that call two measured values equal within a tolerance that is larger than the values, or although they clearly differ.

use super::bound::BoundVerify;
use super::format::significant;
use super::option_numbers::{constant, is_below, magnitude};
use super::outcome::MeasuredRuns;
use super::value_of::{states_number, value_of};
use crate::finding::Finding;
use crate::language::Languages;
use crate::language::words::words_of;
use crate::rules;
use crate::source::Text;
use labspec_expr::ast::{BinaryOp, Expr, ExprKind, LogicalOp};
use labspec_expr::{parse_expression, print};

/// The fraction of the larger value that a tolerance may have, and the fraction of the tolerance by which the values must differ:
/// two values that are noise beside the tolerance are equal.
const MAX_FRACTION: f64 = 0.5;
const MIN_DIFFERENCE: f64 = 0.2;
/// The fraction of the larger value by which values may differ that a text calls equal, and nearly equal; and the fraction of the
/// tolerance below which the difference is noise.
const EQUAL: f64 = 0.03;
const NEARLY_EQUAL: f64 = 0.25;
const NOISE: f64 = 0.02;
/// Two terms that a condition calls equal.
struct Equality {
    a: Expr,
    b: Expr,
    tolerance: Tolerance,
}

/// A tolerance as a condition states it.
#[derive(Clone, Copy)]
enum Tolerance {
    /// `abs(a - b) < 0.1`
    Absolute(f64),
    /// `abs(a / b - 1) < 0.1`
    Relative(f64),
}

/// Reports comparisons in a condition that holds, beside the option or the statement that it belongs to.
pub(super) fn check_tolerance(
    bound: &BoundVerify<'_>,
    outcome: &MeasuredRuns,
    question: &Text,
    (stated, condition): (&Text, &Text),
    findings: &mut Vec<Finding>,
) {
    let languages = bound.stage().languages();
    let tree = parse_expression(&condition.value).tree;
    for Equality { a, b, tolerance } in equalities(&tree) {
        let [x, y] = [&a, &b].map(|e| value_of(bound, outcome, e, condition));
        let (Some(x), Some(y)) = (x, y) else { continue };
        // Beside 0, any value differs by 100 %: what is small is not known.
        if x == 0.0 || y == 0.0 {
            continue;
        }
        let tolerance = match tolerance {
            Tolerance::Absolute(tolerance) => tolerance,
            Tolerance::Relative(tolerance) => tolerance * y.abs(),
        };
        let (size, difference) = (x.abs().max(y.abs()), (x - y).abs());
        let is_loose = tolerance > MAX_FRACTION * size && difference > MIN_DIFFERENCE * tolerance;
        // A text with a number says itself how equal they are.
        let is_nearly = [stated, question].iter().any(|text| is_approximate(text.as_str(), languages));
        let most = if is_nearly { NEARLY_EQUAL } else { EQUAL };
        let differs = difference > most * size
            && difference > NOISE * tolerance
            // A condition with the order of both says that they differ.
            && !orders(&tree, &a, &b)
            && !states_number(bound, outcome, &a, (stated, condition));
        if !is_loose && !differs {
            continue;
        }
        let values = format!(
            "`{}` and `{}` are {} and {}, and the condition accepts a difference of {}",
            print(&a),
            print(&b),
            significant(x),
            significant(y),
            significant(tolerance)
        );
        let finding = Finding::new(rules::LOOSE_TOLERANCE, condition.span(), values);
        findings.push(if is_loose {
            let most = significant(0.1 * size);
            finding
                .why("so large a tolerance accepts nearly any result of the runs")
                .help(format!("compare with at most {most}, a tenth of the larger value"))
        } else {
            let percent = significant(100.0 * difference / size);
            finding
                .why(format!("the condition calls them equal, but they differ by {percent} %"))
                .help("make the tolerance smaller, or write in the text how much they may differ")
                .related(stated.span(), "this text states no difference")
        });
    }
}

/// Whether a text says that it is about values that are nearly the same.
fn is_approximate(text: &str, languages: Languages) -> bool {
    let words = words_of(text);
    let text = format!(" {} ", words.join(" "));
    let approximate = languages.words_of(|language| language.approximate);
    let slightly_less = languages.words_of(|language| language.slightly_less);
    let mut all = approximate.chain(slightly_less).chain(languages.comparisons(|c| c.nearly_equal));
    all.any(|word| text.contains(&format!(" {word} ")))
}

/// The comparisons `abs(a - b) < number` and `abs(a / b - 1) < number` in a condition.
fn equalities(e: &Expr) -> Vec<Equality> {
    match &e.kind {
        ExprKind::Logical { op: LogicalOp::And, left, right } => {
            let mut all = equalities(left);
            all.extend(equalities(right));
            all
        }
        ExprKind::Binary { op, left, right } => {
            let (distance, tolerance, below) = match (constant(left), constant(right)) {
                (None, Some(number)) => (left, number, is_below(*op, false)),
                (Some(number), None) => (right, number, is_below(*op, true)),
                _ => return Vec::new(),
            };
            let inner = magnitude(distance).filter(|_| below == Some(true));
            inner.and_then(|inner| equality(inner, tolerance)).into_iter().collect()
        }
        _ => Vec::new(),
    }
}

/// Whether a condition compares two terms directly: `a > b`.
fn orders(e: &Expr, a: &Expr, b: &Expr) -> bool {
    match &e.kind {
        ExprKind::Logical { op: LogicalOp::And, left, right } => orders(left, a, b) || orders(right, a, b),
        ExprKind::Binary { op, left, right } if is_below(*op, false).is_some() => {
            let sides = [print(left), print(right)];
            let of_both = [print(a), print(b)];
            sides == of_both || sides.iter().rev().eq(of_both.iter())
        }
        _ => false,
    }
}

/// The two terms of a difference, or of a quotient less 1.
fn equality(difference: &Expr, tolerance: f64) -> Option<Equality> {
    let ExprKind::Binary { op: BinaryOp::Subtract, left, right } = &difference.kind else { return None };
    let (a, b, tolerance) = match (&left.kind, constant(left), constant(right)) {
        (ExprKind::Binary { op: BinaryOp::Divide, left: a, right: b }, None, Some(1.0)) => {
            (a, b, Tolerance::Relative(tolerance))
        }
        (_, None, None) => (left, right, Tolerance::Absolute(tolerance)),
        _ => return None,
    };
    let is_measured = constant(a).is_none() && constant(b).is_none();
    is_measured.then(|| Equality { a: (**a).clone(), b: (**b).clone(), tolerance })
}

#[cfg(test)]
pub(super) mod tests {
    /// What is found about an option with this text and this condition: the periods of a small and of a wide swing are 1.42 s and 1.65 s.
    pub(in crate::verify) fn found(option: &str, condition: &str, code: &str) -> Vec<String> {
        let xml = "<mujoco><worldbody><body><joint name='j' axis='0 1 0'/><geom size='.05' pos='0 0 -.5'/></body></worldbody></mujoco>";
        let control = serde_json::json!({"label": "start (rad)", "param": "q", "min": 0, "max": 2, "step": 0.1, "value": 0.1, "reset": true});
        let lab = serde_json::json!({"stopAt": 6, "xml": xml, "controls": [control], "setup": "data.qpos[0] = ctx.q"});
        let quiz = serde_json::json!({"id": "q", "questions": [{"q": "The period of a wide swing", "options": [option, "neither"], "answer": 0,
            "verify": {"lab": lab, "runs": {"small": {"set": {"start (rad)": 0.1}}, "wide": {"set": {"start (rad)": 1.5}}},
                "measure": {"T": "period(data.qpos[0])"}, "options": [condition, "wide.T > 3 * small.T"]}}]});
        let report = crate::Checker::new(|_: &str| None::<String>).check("q.json", &quiz.to_string());
        report.findings.iter().filter(|f| f.code == code).map(|f| f.message.clone()).collect()
    }

    #[test]
    fn what_clearly_differs_is_not_equal() {
        for (option, condition) in [
            ("stays the same", "abs(wide.T / small.T - 1) < 0.2"),
            ("stays the same", "abs(wide.T - small.T) < 0.3"),
            ("is the same", "abs(wide.T - small.T) < 1.5"),
        ] {
            assert_eq!(found(option, condition, "loose-tolerance").len(), 1, "{option}: {condition}");
        }
        for (option, condition) in [
            ("is about the same", "abs(wide.T / small.T - 1) < 0.2"),
            ("changes by less than 20 %", "abs(wide.T / small.T - 1) < 0.2"),
            ("becomes longer", "wide.T - small.T > 0.1"),
            ("becomes longer", "wide.T > small.T && abs(wide.T - small.T) < 0.3"),
            ("differs by less than a second", "abs(wide.T - small.T) < 0.3"),
            ("ändert sich kaum", "abs(wide.T - small.T) < 0.3"),
        ] {
            assert_eq!(found(option, condition, "loose-tolerance"), [""; 0], "{option}: {condition}");
        }
    }
}
