//! The value of a part of a condition, and whether a text states a number about it.

use super::bound::BoundVerify;
use super::outcome::MeasuredRuns;
use super::quote::quantities_in;
use super::units;
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

/// Whether a text states a number that may be about a part of a condition: a part in percent, a pure number, or one of the same dimension.
/// Others are settings.
pub(super) fn states_number(
    bound: &BoundVerify<'_>,
    outcome: &MeasuredRuns,
    part: &Expr,
    (stated, condition): (&Text, &Text),
) -> bool {
    let text = Text::derived(print(part), condition.span());
    let measured = units::of_claim(bound, outcome, &text);
    quantities_in(stated.as_str(), bound.stage().languages()).iter().any(|q| {
        let is_share = q.unit.percentage().is_some();
        let dimension = q.unit.dimension.filter(|d| !d.is_number() || d.has_angle());
        is_share || dimension.zip(measured).is_none_or(|(a, b)| a.agrees(&b))
    })
}
