//! Angles: degrees written for radians, and components of quaternions taken for angles.

use super::Binder;
use crate::ast::BinaryOp;
use crate::ir::{Index, Ir, Kind};
use crate::math;
use crate::number;
use crate::operators::UnaryOp;
use crate::rules;
use crate::schema::Role;
use crate::value::{Value, View};
use crate::{Finding, Span};

/// Functions of an angle.
const OF_ANGLES: [&str; 3] = ["Math.sin", "Math.cos", "Math.tan"];

impl<'a> Binder<'a> {
    /// Looks at the argument of a function of angles.
    pub(super) fn check_angle(&mut self, function: math::Function, arg: &Ir) {
        let path = function.path();
        if self.site.is_some() || !OF_ANGLES.contains(&path.as_str()) {
            return;
        }
        if let Some(Value::Number(x)) = arg.known()
            && in_degrees(*x)
            && matches!(arg.kind, Kind::Constant(_))
            && number::to_text(*x) == self.text(arg.span)
        {
            let meant = format!("{} * Math.PI / 180", self.text(arg.span));
            self.report(degrees(arg.span, &format!("`{path}` takes radians"), meant));
        }
        self.check_quaternion(arg, &format!("`{path}` needs an angle"));
    }

    /// Looks at `x * 180` and its like, which make degrees of radians.
    pub(super) fn check_conversion(&mut self, op: BinaryOp, a: &Ir, b: &Ir) {
        if op != BinaryOp::Multiply {
            return;
        }
        let converts = |ir: &Ir| match ir.known() {
            Some(Value::Number(x)) => *x == 180.0 || (x - 180.0 / std::f64::consts::PI).abs() < 0.01,
            _ => false,
        };
        for (number, other) in [(a, b), (b, a)] {
            if converts(number) {
                self.check_quaternion(other, "only an angle has degrees");
            }
        }
    }

    /// Warns when a number is a component of a quaternion.
    pub(super) fn check_quaternion(&mut self, ir: &Ir, needs: &str) {
        let Some((view, i)) = element(ir) else { return };
        let at = view.first as usize + i;
        if self.site.is_some() || self.schema.role(view.field, at) != Role::Quaternion {
            return;
        }
        let text = self.text(ir.span);
        let what = self.schema.element_help(view.field, at);
        let what = what.map_or("a component of a quaternion".to_owned(), |w| {
            format!("{w}, a component of a quaternion")
        });
        self.report(
            Finding::warning(
                rules::QUATERNION_AS_ANGLE,
                ir.span,
                format!("`{text}` is no angle, and {needs}"),
            )
            .why(format!("it is {what}: four numbers that give the orientation together"))
            .help("the whole angle of the turn is `2 * Math.acos(w)`, with w the first of the four numbers"),
        );
    }

    /// Warns of degrees that are stored in an angle.
    pub(super) fn check_stored_angle(&mut self, view: View, index: &Index, value: &Ir) {
        let (Index::At(i), Some(Value::Number(x))) = (index, value.known()) else { return };
        if !in_degrees(*x) || self.schema.role(view.field, view.first as usize + i) != Role::Angle {
            return;
        }
        let meant = format!("{} * Math.PI / 180", self.text(value.span));
        self.report(degrees(value.span, "this angle is in radians", meant));
    }
}

/// Whether a number looks like degrees: whole, a multiple of 5, and more than a full turn in radians.
fn in_degrees(x: f64) -> bool {
    x.abs() >= 10.0 && x % 5.0 == 0.0 && x.abs() <= 720.0
}

fn degrees(span: Span, what: &str, meant: String) -> Finding {
    Finding::warning(rules::DEGREES, span, format!("{what}, and this looks like degrees"))
        .why("a full turn is 2π, about 6.28 radians")
        .help(format!("write `{meant}`"))
        .fix(span, meant)
}

/// The element that a number is.
fn element(ir: &Ir) -> Option<(View, usize)> {
    match &ir.kind {
        Kind::Load(view, Index::At(i)) => Some((*view, *i)),
        Kind::ToNumber(inner) | Kind::Unary(UnaryOp::Minus, inner) => element(inner),
        _ => None,
    }
}
