//! Lints about angles: degrees where radians are expected, and numbers used as angles that are not angles.

use super::pass::LintPass;
use crate::ast::{BinaryOp, Expr, ExprKind};
use crate::bind::types::ExpressionShape;
use crate::number::{self, to_text as number_text};
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

    /// Warns about `angle > 30` and `45 - angle`, where the angle is in rad.
    #[inline(never)]
    pub(super) fn angle_in_degrees(&mut self, op: BinaryOp, left: &Expr, right: &Expr) {
        /// Two turns; a smaller number may be an angle in rad.
        const TWO_TURNS: f64 = 4.0 * std::f64::consts::PI;
        if !(op.is_comparison() || matches!(op, BinaryOp::Add | BinaryOp::Subtract)) {
            return;
        }
        for (angle, number) in [(left, right), (right, left)] {
            let Some(x) = self.literal(number).filter(|x| x.abs() > TWO_TURNS && in_degrees(*x)) else {
                continue;
            };
            if self.is_angle(angle, 4) && number_text(x) == self.text(number.span) {
                self.degrees(number.span, &format!("`{}` is in radians", self.text(angle.span)));
            }
        }
    }

    /// Whether an expression converts to radians, or else to degrees, and what it converts.
    fn conversion<'e>(&self, expr: &'e Expr) -> Option<(bool, &'e Expr)> {
        match &expr.kind {
            ExprKind::Call { callee, args, .. } => match (self.bare(callee.span).as_deref(), args.as_slice())
            {
                (Some("lib.rad"), [one]) => Some((true, one)),
                (Some("lib.deg"), [one]) => Some((false, one)),
                _ => None,
            },
            ExprKind::Binary { op: BinaryOp::Multiply | BinaryOp::Divide, .. } => {
                let (factor, rest) = self.constant_factor(expr);
                let [(one, false)] = rest.as_slice() else { return None };
                let near = |x: f64| (factor.abs() / x - 1.0).abs() < 1e-3;
                let to_radians = near(1f64.to_radians());
                (to_radians || near(1f64.to_degrees())).then_some((to_radians, *one))
            }
            _ => None,
        }
    }

    /// Warns about `lib.rad(lib.rad(x))`, and about the conversion of an angle that is already in radians.
    #[inline(never)]
    pub(super) fn converted_twice(&mut self, expr: &Expr) {
        let Some((to_radians, inner)) = self.conversion(expr) else { return };
        let unit = if to_radians { "radians" } else { "degrees" };
        let again = match self.conversion(self.definition(inner)) {
            Some((same, _)) if same == to_radians => {
                format!("`{}` is in {unit} already", self.text(inner.span))
            }
            _ if to_radians && self.is_angle(inner, 4) => {
                format!("`{}` is in radians already", self.text(inner.span))
            }
            _ => return,
        };
        let meant = self.text(inner.span).to_owned();
        self.found.push(
            Finding::warning(rules::CONVERTED_TWICE, expr.span, format!("this converts to {unit} again"))
                .why(again)
                .help(format!("write `{meant}`"))
                .guess(expr.span, meant),
        );
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
