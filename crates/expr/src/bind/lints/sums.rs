//! Lints about sums and products: a term that a sum contains twice, and factors that do not convert angles.

use super::pass::LintPass;
use crate::ast::{BinaryOp, Expr, ExprKind, UnaryOp};
use crate::rules;
use crate::schema::Role;
use labspec_finding::Finding;
use std::f64::consts::PI;

/// The terms of a longer sum are not compared.
const MAX_TERMS: usize = 12;
/// The relative difference of two numbers that are meant to be equal.
const SAME: f64 = 1e-3;

/// The operands of a chain of one operator.
fn terms<'e>(expr: &'e Expr, all: &mut Vec<&'e Expr>) {
    match &expr.kind {
        ExprKind::Binary { op: BinaryOp::Add, left, right } => {
            terms(left, all);
            terms(right, all);
        }
        _ => all.push(expr),
    }
}

/// The factors of a product, each with whether it divides.
fn factors<'e>(expr: &'e Expr, divides: bool, all: &mut Vec<(&'e Expr, bool)>) {
    match &expr.kind {
        ExprKind::Binary { op: BinaryOp::Multiply, left, right } => {
            factors(left, divides, all);
            factors(right, divides, all);
        }
        ExprKind::Binary { op: BinaryOp::Divide, left, right } => {
            factors(left, divides, all);
            factors(right, !divides, all);
        }
        ExprKind::Unary { op: UnaryOp::Minus, operand } => factors(operand, divides, all),
        _ => all.push((expr, divides)),
    }
}

impl LintPass<'_> {
    /// Marks the parts of a chain, which are not checked again.
    fn mark_parts(&mut self, expr: &Expr, is_part: fn(BinaryOp) -> bool) {
        if let ExprKind::Binary { op, left, right } = &expr.kind
            && is_part(*op)
        {
            self.visited.insert(expr.span);
            self.mark_parts(left, is_part);
            self.mark_parts(right, is_part);
        }
    }

    /// Warns about `x * x + y * y + y * y`.
    #[inline(never)]
    pub(super) fn same_term(&mut self, expr: &Expr) {
        if self.visited.contains(&expr.span) {
            return;
        }
        self.mark_parts(expr, |op| op == BinaryOp::Add);
        let mut all = Vec::new();
        terms(expr, &mut all);
        let is_product = |e: &Expr| {
            let name = match &e.kind {
                ExprKind::Call { callee, .. } => self.bare(callee.span),
                _ => None,
            };
            name.as_deref() == Some("Math.pow")
                || matches!(&e.kind, ExprKind::Binary { op: BinaryOp::Multiply | BinaryOp::Power, .. })
        };
        if all.len() > MAX_TERMS || !all.iter().all(|term| is_product(term)) {
            return;
        }
        let texts: Vec<Option<String>> = all.iter().map(|term| self.bare(term.span)).collect();
        for (i, (term, text)) in all.iter().zip(&texts).enumerate() {
            let Some(text) = text else { continue };
            if texts.iter().take(i).flatten().any(|other| other == text) {
                self.found.push(
                    Finding::new(rules::SAME_TERM, term.span, format!("`{text}` is in this sum twice"))
                        .help("check the index: one of the two probably belongs to another component"),
                );
                return;
            }
        }
    }

    /// Whether an expression is an angle in rad.
    pub(super) fn is_angle(&self, expr: &Expr, depth: usize) -> bool {
        let expr = self.definition(expr);
        if let Some((field, index)) = self.typed.shape(expr.span).and_then(|shape| shape.element) {
            return self.schema.role(field, index) == Role::Angle;
        }
        match &expr.kind {
            ExprKind::Unary { op: UnaryOp::Minus | UnaryOp::Plus, operand } if depth > 0 => {
                self.is_angle(operand, depth - 1)
            }
            ExprKind::Call { callee, args, .. } => match (self.bare(callee.span).as_deref(), args.as_slice())
            {
                (Some("Math.abs"), [one]) if depth > 0 => self.is_angle(one, depth - 1),
                (Some("Math.atan2" | "Math.atan" | "Math.asin" | "Math.acos"), _) => true,
                _ => false,
            },
            _ => false,
        }
    }

    /// The constant factor of a product, and its other factors, each with whether it divides.
    pub(super) fn constant_factor<'e>(&self, expr: &'e Expr) -> (f64, Vec<(&'e Expr, bool)>) {
        let (mut all, mut rest, mut factor) = (Vec::new(), Vec::new(), 1.0);
        factors(expr, false, &mut all);
        for (part, divides) in all {
            match self.literal(part) {
                Some(x) if divides => factor /= x,
                Some(x) => factor *= x,
                None => rest.push((part, divides)),
            }
        }
        (factor, rest)
    }

    /// Warns about `angle * 180` and `angle * 360 / Math.PI`.
    #[inline(never)]
    pub(super) fn degree_factor(&mut self, expr: &Expr) {
        if self.visited.contains(&expr.span) {
            return;
        }
        self.mark_parts(expr, |op| matches!(op, BinaryOp::Multiply | BinaryOp::Divide));
        self.converted_twice(expr);
        let (factor, rest) = self.constant_factor(expr);
        let [(angle, false)] = rest.as_slice() else { return };
        let near = |x: f64| (factor.abs() / x - 1.0).abs() < SAME;
        let wrong = [180.0, 360.0, 360.0 / PI, 90.0 / PI, 180.0 * PI, 360.0 / PI / PI, 180.0 / PI / PI];
        if !wrong.into_iter().any(near) || !self.is_angle(angle, 4) {
            return;
        }
        self.found.push(
            Finding::new(
                rules::DEGREE_FACTOR,
                expr.span,
                format!(
                    "this multiplies an angle in rad by {}",
                    crate::number::to_text((factor * 1e4).round() / 1e4)
                ),
            )
            .help("for degrees, multiply by `180 / Math.PI`"),
        );
    }
}
