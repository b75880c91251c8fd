//! A time that a text names in place of the one at which a measure reads the run.

use super::super::option_numbers::constant;
use super::super::quote::OptionNumber;
use super::{Other, ReadMeasure, before_quantity};
use crate::language::words::split_words;
use labspec_bind::units::parse;
use labspec_expr::ast::{BinaryOp, Expr, ExprKind};
use labspec_expr::{parse_expression, print};

/// A preposition is at most this number of words before the time: `after about 2 s`.
const NEAR: usize = 2;
/// Times that differ by less are the same.
const SAME: f64 = 1e-6;

/// The time after which a text states a value, if the measure reads another one.
pub(super) fn other(read: &ReadMeasure<'_, '_>, text: &str) -> Option<Other> {
    let words = stated_time(read, text)?;
    let run = read.bound.runs.get(read.run)?;
    let tree = parse_expression(&read.text.value).tree;
    let (time, inner) = match sampled(&tree)? {
        Sampled::At(time, inner) => (time, inner),
        Sampled::End(_) if run.stop.is_some() => return None,
        Sampled::End(inner) => (run.spec?.until.as_ref()?.value, inner),
    };
    // A text may count from the press of a button.
    let presses = run.spec.iter().flat_map(|spec| spec.press.iter().map(|(_, time)| time.value));
    let mut starts = presses.chain([0.0]);
    if starts.any(|start| (start + words.0 - time).abs() <= SAME * time.abs().max(1.0)) {
        return None;
    }
    let replaced = format!("at(data.time >= {} - 1e-9, {})", words.0, print(inner));
    Some(Other {
        words: words.1,
        read: format!("the time {time} s: `{}`", read.text.as_str()),
        with: format!("`{replaced}` in the same run"),
        value: read.with_text(replaced.clone())?,
    })
}

/// The only time in seconds behind a word such as `after`, and its text.
fn stated_time(read: &ReadMeasure<'_, '_>, text: &str) -> Option<(f64, String)> {
    let second = parse("s")?;
    let quantities = read.quantities();
    let is_time = |q: &OptionNumber| q.unit.dimension.is_some_and(|d| d.agrees(&second));
    // `0.1 s after the collision at 0.4 s`
    if quantities.iter().filter(|q| is_time(q)).count() > 1 {
        return None;
    }
    let mut times = quantities.into_iter().filter_map(|q| {
        let dimension = q.unit.dimension.filter(|_| is_time(&q))?;
        let before = before_quantity(text, &q.text)?;
        let mut near = split_words(before).rev().take(NEAR);
        let is_after = near.any(|word| read.languages.comparisons(|c| c.after).any(|after| after == word));
        (is_after && q.low.is_finite() && q.high.is_finite()).then(|| (q.number() * dimension.factor, q.text))
    });
    let time = times.next()?;
    times.next().is_none().then_some(time)
}

/// Where a measure reads the run, and what.
enum Sampled<'e> {
    At(f64, &'e Expr),
    End(&'e Expr),
}

/// `at(data.time >= 1, x)` or `final(x)`.
fn sampled(e: &Expr) -> Option<Sampled<'_>> {
    let ExprKind::Call { callee, args, .. } = &e.kind else { return None };
    let ExprKind::Name(name) = &callee.kind else { return None };
    match (name.as_str(), args.as_slice()) {
        ("final", [inner]) => Some(Sampled::End(inner)),
        ("at", [condition, inner]) => {
            let ExprKind::Binary { op: BinaryOp::Greater | BinaryOp::GreaterEqual, left, right } =
                &condition.kind
            else {
                return None;
            };
            (print(left) == "data.time")
                .then(|| constant(right))
                .flatten()
                .map(|time| Sampled::At(time, inner))
        }
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::super::tests::found;

    #[test]
    fn another_time_is_found() {
        let height = "at(data.time >= 0.1, data.body('iron').xpos[2])";
        for question in
            ["How high is the iron ball after 0.2 s?", "Wie hoch ist die Kugel (iron) nach 0,2 s?"]
        {
            assert_eq!(found(question, height, 0.95).len(), 1, "{question}");
        }
        for question in [
            "How high is the iron ball after 0.1 s?",
            "How high is the iron ball?",
            "It falls for 0.2 s. How high is iron?",
        ] {
            assert_eq!(found(question, height, 0.95), [""; 0], "{question}");
        }
        assert_eq!(
            found("How high is the iron ball after 0.2 s?", "final(data.body('iron').xpos[2])", 0.8).len(),
            1
        );
        assert_eq!(
            found("How high is the iron ball after 0.3 s?", "final(data.body('iron').xpos[2])", 0.56),
            [""; 0]
        );
    }
}
