//! A word such as "lowest", "average" or "at the end" in a text whose measure takes another value of the run.

use super::super::option_numbers::{constant, is_below};
use super::{Other, ReadMeasure};
use crate::language::ComparisonWords;
use crate::language::words::{ends_with, find};
use labspec_expr::ast::{BinaryOp, Expr, ExprKind, UnaryOp};
use labspec_expr::{parse_expression, print};

/// The functions of one value of a run, with the words that name it.
const EXTREMES: [(&str, ComparisonWords); 5] = [
    ("max", |c| c.highest),
    ("min", |c| c.lowest),
    ("mean", |c| c.average),
    ("initial", |c| c.at_start),
    ("final", |c| c.at_end),
];

/// The value of the run that the words of a text name, if the measure takes another one of the same quantity.
pub(super) fn other(read: &ReadMeasure<'_, '_>, text: &str) -> Option<Other> {
    let mut named = EXTREMES.iter().filter_map(|(function, words)| {
        let mut words = read.languages.comparisons(words);
        let word = words.find(|word| find(text, word).is_some_and(|start| !is_of_setting(text, start)))?;
        Some((*function, word))
    });
    let (Some((function, word)), None) = (named.next(), named.next()) else { return None };
    // `-max(x)` is a lowest value of something else.
    if !is_measure(&parse_expression(&read.expr.value).tree) {
        return None;
    }
    let tree = parse_expression(&read.text.value).tree;
    let ExprKind::Call { callee, args, .. } = &tree.kind else { return None };
    let (ExprKind::Name(function_read), [inner]) = (&callee.kind, args.as_slice()) else { return None };
    // What happens at the lowest point has a time.
    if print(inner) == "data.time" {
        return None;
    }
    let is_listed = EXTREMES.iter().any(|(function, _)| function == function_read);
    if !is_listed || function_read == function || may_be_negated(inner) {
        return None;
    }
    let replaced = format!("{function}({})", print(inner));
    Some(Other {
        words: word.to_string(),
        read: format!("`{}`", read.text.as_str()),
        with: format!("`{replaced}` in the same run"),
        value: read.with_text(replaced.clone())?,
    })
}

/// Whether an expression is one measure, perhaps times a positive number, or compares it with a number.
fn is_measure(e: &Expr) -> bool {
    match &e.kind {
        ExprKind::Binary { op, left, right } if is_below(*op, false).is_some() => {
            let is_number = |e: &Expr| constant(e).is_some();
            is_number(left) && is_measure(right) || is_number(right) && is_measure(left)
        }
        ExprKind::Name(_) => true,
        ExprKind::Member { object, .. } => matches!(object.kind, ExprKind::Name(_)),
        ExprKind::Binary { op: BinaryOp::Multiply, left, right } => {
            matches!(left.kind, ExprKind::Number(_)) && is_measure(right)
                || matches!(right.kind, ExprKind::Number(_)) && is_measure(left)
        }
        _ => false,
    }
}

/// Whether a quantity may be one whose largest value is the smallest one of another: `-z`, `h - z`, `abs(x)`.
fn may_be_negated(e: &Expr) -> bool {
    match &e.kind {
        ExprKind::Unary { op, operand } => *op == UnaryOp::Minus || may_be_negated(operand),
        ExprKind::Binary { op, left, right } => {
            matches!(op, BinaryOp::Subtract | BinaryOp::Divide)
                || may_be_negated(left)
                || may_be_negated(right)
        }
        ExprKind::Call { callee, .. } => print(callee).contains("abs"),
        _ => false,
    }
}

/// Whether a word belongs to a setting or a place: `with the largest mass`, `at the highest point`.
fn is_of_setting(text: &str, start: usize) -> bool {
    let before = text.get(..start).unwrap_or("").trim_end();
    [
        "with the",
        "at the",
        "for the",
        "from the",
        "in the",
        "by the",
        "above the",
        "below the",
        "its",
        "mit der",
        "mit dem",
        "am",
        "bei der",
        "im",
        "über dem",
        "unter dem",
    ]
    .iter()
    .any(|words| ends_with(before, words))
}

#[cfg(test)]
mod tests {
    use super::super::tests::found;

    #[test]
    fn another_extreme_is_found() {
        let highest = "max(data.body('iron').xpos[2])";
        for question in [
            "What is the lowest height of iron?",
            "Was ist die kleinste Höhe von iron?",
            "How high is iron at the end?",
        ] {
            assert_eq!(found(question, highest, 1.0).len(), 1, "{question}");
        }
        for question in [
            "What is the largest height of iron?",
            "How high is iron at the start?",
            "How high is iron at the lowest gravity?",
        ] {
            assert_eq!(found(question, highest, 1.0), [""; 0], "{question}");
        }
        assert_eq!(
            found("What is the lowest height of iron?", "max(-data.body('iron').xpos[2])", -0.56),
            [""; 0]
        );
    }
}
