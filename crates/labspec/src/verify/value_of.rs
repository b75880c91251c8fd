//! The value of a part of a condition, and whether a text states a number about it.

use super::bound::BoundVerify;
use super::condition::numbers_in;
use super::outcome::MeasuredRuns;
use super::quote::quantities_in;
use super::units;
use crate::language::words::words_of;
use crate::language::{ComparisonWords, Languages};
use crate::source::Text;
use labspec_expr::ast::Expr;
use labspec_expr::print;

/// The finite value of a part of a condition over the outcome.
pub(super) fn value_of(
    bound: &BoundVerify<'_>,
    outcome: &MeasuredRuns,
    part: &Expr,
    condition: &Text,
) -> Option<f64> {
    let text = Text::derived(print(part), condition.span());
    let found = bound.find(outcome, &text, &mut Vec::new())?.value.to_number();
    Some(found).filter(|x| x.is_finite())
}

/// Whether a text states a number that may be about a part of a condition: a part in percent, a pure number, one of the same dimension,
/// or one in words. Others are settings.
pub(super) fn states_number(
    bound: &BoundVerify<'_>,
    outcome: &MeasuredRuns,
    part: &Expr,
    (stated, condition): (&Text, &Text),
) -> bool {
    let text = Text::derived(print(part), condition.span());
    let measured = units::of_claim(bound, outcome, &text);
    let (about_it, settings): (Vec<_>, Vec<_>) =
        quantities_in(stated.as_str(), bound.stage().languages()).into_iter().partition(|q| {
            let is_share = q.unit.percentage().is_some();
            let dimension = q.unit.dimension.filter(|d| !d.is_number() || d.has_angle());
            is_share || dimension.zip(measured).is_none_or(|(a, b)| a.agrees(&b))
        });
    let mut text = stated.as_str().to_string();
    settings.iter().for_each(|q| text = text.replace(&q.text, ""));
    !about_it.is_empty()
        || states_size(&text, bound.stage().languages())
        || shares_number(&text, condition.as_str())
}

/// Whether a text says in words how large a difference is.
fn states_size(text: &str, languages: Languages) -> bool {
    let words = words_of(text);
    let is = |word: &String, list: ComparisonWords| languages.comparisons(list).any(|listed| listed == word);
    let is_setting = |i: usize| words.iter().take(i).rev().take(2).any(|word| is(word, |c| c.after));
    words.iter().enumerate().any(|(i, word)| is(word, |c| c.sizes) && !is_setting(i))
}

/// Factors between a number of a condition and that of its text: percent, and metric prefixes.
const FACTORS: [f64; 3] = [1.0, 100.0, 1000.0];

/// Whether a text has a number of its condition, perhaps in percent or with a metric prefix: what the condition tests is then what the text says.
pub(super) fn shares_number(stated: &str, condition: &str) -> bool {
    let of_text = numbers_in(&with_points(stated));
    let is_same = |x: f64, y: f64| (x - y).abs() <= 1e-9 * y.abs();
    numbers_in(condition).into_iter().filter(|x| *x != 0.0).any(|x| {
        // `1.15 *` is 15 % more.
        let changes = [(x - 1.0) * 100.0, (1.0 - x) * 100.0];
        let all = FACTORS.map(|factor| factor * x).into_iter().chain(changes);
        all.into_iter().any(|x| of_text.iter().any(|y| *y != 0.0 && is_same(x, *y)))
    })
}

/// A text with a point in each decimal number: `0,3 s`.
fn with_points(text: &str) -> String {
    let chars: Vec<char> = text.chars().collect();
    let is_digit = |i: Option<usize>| i.and_then(|i| chars.get(i)).is_some_and(char::is_ascii_digit);
    let point =
        |(i, c): (usize, &char)| match *c == ',' && is_digit(i.checked_sub(1)) && is_digit(Some(i + 1)) {
            true => '.',
            false => *c,
        };
    chars.iter().enumerate().map(point).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_number_of_the_condition_is_that_of_the_text() {
        for (text, condition) in [
            ("It grows by less than 0.3 s.", "b.t - a.t < 0.3"),
            ("It is more than 15 % longer.", "b.t > 1.15 * a.t"),
            ("20 cm are missing at least.", "z1 < z0 - 0.2"),
            ("They differ by less than 5 %.", "abs(b.t / a.t - 1) < 0.05"),
            ("Sie wächst um weniger als 0,3 s.", "b.t - a.t < 0.3"),
        ] {
            assert!(shares_number(text, condition), "{text}");
        }
        assert!(
            states_size("It grows by less than a tenth of a second.", Languages::ALL)
                && !states_size("It is faster after a second.", Languages::ALL)
        );
        assert!(!shares_number("After 0.5 s both have the same speed.", "abs(b.v - a.v) < 0.3"));
    }
}
