//! Lints about angles: degrees where radians are expected, and numbers used as angles that are not angles.

use super::pass::LintPass;
use crate::ast::{BinaryOp, Expr};
use crate::bind::types::ExpressionShape;
use crate::number;
use crate::rules;
use crate::schema::Role;
use crate::types::FieldKey;
use labspec_finding::{Finding, Span};

impl LintPass<'_> {
    /// Checks the argument of a trigonometric function.
    pub(super) fn angle(&mut self, span: Span, by: &str, shape: &ExpressionShape) {
        if let Some(x) = shape.number()
            && in_degrees(x)
            && number::to_text(x) == self.text(span)
        {
            self.degrees(span, &format!("`{by}` takes radians"));
        }
        self.no_angle(span, shape, &format!("`{by}` needs an angle"));
    }

    /// Checks `x * 180` and similar conversions of radians to degrees.
    #[inline(never)]
    pub(super) fn converted(&mut self, op: BinaryOp, left: &Expr, right: &Expr) {
        if op != BinaryOp::Multiply {
            return;
        }
        let typed = self.typed;
        let (Some(a), Some(b)) = (typed.shape(left.span), typed.shape(right.span)) else { return };
        let converts = |shape: &ExpressionShape| {
            shape.number().is_some_and(|x| x == 180.0 || (x - 1f64.to_degrees()).abs() < 0.01)
        };
        if converts(a) {
            self.no_angle(right.span, b, "only an angle has degrees");
        }
        if converts(b) {
            self.no_angle(left.span, a, "only an angle has degrees");
        }
    }

    /// Warns if an angle is needed and the host knows that the number is not one.
    fn no_angle(&mut self, span: Span, shape: &ExpressionShape, needs: &str) {
        let Some((field, index)) = shape.element else { return };
        let Role::NoAngle(advice) = self.schema.role(field, index) else { return };
        let what = match self.schema.element_help(field, index) {
            Some(what) => format!("{what}, {}", advice.what),
            None => advice.what.to_owned(),
        };
        let message = format!("`{}` is not an angle, but {needs}", self.text(span));
        self.found.push(
            Finding::warning(advice.rule, span, message)
                .why(format!("it is {what}: {}", advice.why))
                .help(advice.help),
        );
    }

    /// Warns if a number of degrees is stored in an angle.
    pub(super) fn degrees_stored(
        &mut self,
        span: Span,
        to: Option<(FieldKey, usize)>,
        shape: &ExpressionShape,
    ) {
        let (Some((field, index)), Some(x)) = (to, shape.number()) else { return };
        if in_degrees(x) && self.schema.role(field, index) == Role::Angle {
            self.degrees(span, "this angle is in radians");
        }
    }

    fn degrees(&mut self, span: Span, what: &str) {
        let meant = format!("{} * Math.PI / 180", self.text(span));
        self.found.push(
            Finding::warning(rules::DEGREES, span, format!("{what}, but this looks like degrees"))
                .why("a full turn is 2π, about 6.28 radians")
                .help(format!("write `{meant}`"))
                .guess(span, meant),
        );
    }
}

/// Whether a number looks like degrees: a multiple of 5, at least 10 (more than a full turn in radians) and at most 720.
fn in_degrees(x: f64) -> bool {
    x.abs() >= 10.0 && x % 5.0 == 0.0 && x.abs() <= 720.0
}
