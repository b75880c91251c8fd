//! Lints about operators whose operands are not those that were meant.

use super::pass::LintPass;
use crate::ast::{BinaryOp, Expr, ExprKind, UnaryOp};
use crate::rules;
use crate::types::Type;
use labspec_finding::{Finding, Span};

impl LintPass<'_> {
    /// Whether an expression is in parentheses of its own, which its span contains.
    pub(super) fn is_enclosed(&self, span: Span) -> bool {
        let text = self.text(span);
        let mut depth = 0usize;
        let closed = text.char_indices().find_map(|(at, c)| {
            match c {
                '(' => depth += 1,
                ')' => depth = depth.saturating_sub(1),
                _ => {}
            }
            (depth == 0).then_some(at)
        });
        text.starts_with('(') && closed.is_some_and(|at| at + 1 == text.len())
    }

    /// The number that an expression always has.
    pub(super) fn literal(&self, expr: &Expr) -> Option<f64> {
        match &expr.kind {
            ExprKind::Number(x) => Some(*x),
            ExprKind::Unary { op: UnaryOp::Minus, operand } => Some(-self.literal(operand)?),
            _ => self.typed.shape(expr.span)?.number(),
        }
    }

    /// Warns about `!a > b`.
    #[inline(never)]
    pub(super) fn negated_operand(&mut self, op: BinaryOp, left: &Expr, right: &Expr, span: Span) {
        let ExprKind::Unary { op: UnaryOp::Not, operand } = &left.kind else { return };
        if !op.is_comparison() || self.is_enclosed(left.span) {
            return;
        }
        // `!a === b` may compare two truth values.
        let is_truth = |e: &Expr| {
            let of_operator = match &e.kind {
                ExprKind::Unary { op, .. } => *op == UnaryOp::Not,
                ExprKind::Binary { op, .. } => op.is_comparison(),
                ExprKind::Logical { .. } | ExprKind::Boolean(_) => true,
                _ => false,
            };
            let shape = self.typed.shape(e.span);
            of_operator || shape.is_none_or(|shape| matches!(shape.ty, Type::Boolean | Type::Any))
        };
        if op.power() == 8 && is_truth(right) {
            return;
        }
        let rest = self.text(Span::new(operand.span.start, span.end));
        let meant = format!("!({rest})");
        let why =
            format!("`{}` is true or false, and the comparison uses that as 1 or 0", self.text(left.span));
        self.found.push(
            Finding::warning(
                rules::NEGATED_OPERAND,
                span,
                "`!` negates only the left side of this comparison",
            )
            .why(why)
            .help(format!("write `{meant}`"))
            .guess(span, meant),
        );
    }

    /// Warns about `x ** 1/2`.
    #[inline(never)]
    pub(super) fn power_of_quotient(&mut self, op: BinaryOp, left: &Expr, right: &Expr, span: Span) {
        let ExprKind::Binary { op: BinaryOp::Power, left: base, right: exponent } = &left.kind else {
            return;
        };
        let written = |e: &Expr| match &e.kind {
            ExprKind::Number(x) => Some(*x),
            ExprKind::Unary { op: UnaryOp::Minus, operand } => match operand.kind {
                ExprKind::Number(x) => Some(-x),
                _ => None,
            },
            _ => None,
        };
        let (Some(top), Some(bottom)) = (written(exponent), written(right)) else { return };
        if op != BinaryOp::Divide || self.is_enclosed(left.span) || bottom < 2.0 || top.fract() != 0.0 {
            return;
        }
        // `v ** 2 / 2` is half a square; `v ** 3/2`, with spaces around the power alone, is not half a cube.
        let between = self.text(Span::new(exponent.span.end, right.span.start));
        let around = self.text(Span::new(base.span.end, exponent.span.start));
        let is_one_number = between == "/" && around.contains(' ') && matches!(bottom, 2.0 | 3.0);
        if !(top == 1.0 || is_one_number && top % bottom != 0.0) {
            return;
        }
        let quotient = self.text(Span::new(exponent.span.start, right.span.end));
        let before = self.text(Span::new(span.start, exponent.span.start));
        let meant = format!("{before}({quotient})");
        let why = format!("it is `({}) / {}`", self.text(left.span), self.text(right.span));
        self.found.push(
            Finding::warning(
                rules::POWER_OF_QUOTIENT,
                span,
                format!("the exponent is {}, not {quotient}", self.text(exponent.span)),
            )
            .why(why)
            .help(format!("write `{meant}`"))
            .guess(span, meant),
        );
    }

    /// Warns about `x // 2`.
    #[inline(never)]
    pub(super) fn comment_as_division(&mut self) {
        let source = self.source;
        let mut offset = 0;
        for line in source.split_inclusive('\n') {
            if let Some(at) = comment_start(line) {
                let (before, comment) = line.split_at(at);
                let divisor = comment.trim_start_matches('/').trim();
                let follows_value =
                    before.trim_end().ends_with(|c: char| c.is_alphanumeric() || c == ')' || c == ']');
                if follows_value
                    && comment.starts_with("//")
                    && !comment.starts_with("///")
                    && is_divisor(divisor)
                {
                    let start = offset + at;
                    let span = Span::new(start, start + comment.trim_end().len());
                    self.found.push(
                        Finding::new(
                            rules::COMMENT_AS_DIVISION,
                            span,
                            "`//` begins a comment; it does not divide",
                        )
                        .help(format!("write `Math.floor({} / {divisor})`", before.trim())),
                    );
                }
            }
            offset += line.len();
        }
    }

    /// Whether an expression joins a text with something else.
    pub(super) fn joins_text(&self, expr: &Expr) -> bool {
        let ExprKind::Binary { op: BinaryOp::Add, left, right } = &expr.kind else { return false };
        let has_words = |e: &Expr| match &e.kind {
            ExprKind::String(text) => text.trim().parse::<f64>().is_err(),
            ExprKind::Template { .. } => true,
            _ => false,
        };
        has_words(left) || has_words(right) || self.joins_text(left)
    }

    /// Warns about `'text ' + x > 0`.
    #[inline(never)]
    pub(super) fn joined_first(&mut self, op: BinaryOp, left: &Expr, right: &Expr, span: Span) {
        if !op.is_comparison() {
            return;
        }
        let is_text = |e: &Expr| {
            matches!(e.kind, ExprKind::String(_) | ExprKind::Template { .. })
                || self.typed.shape(e.span).is_none_or(|shape| shape.ty == Type::String)
        };
        let is_joined = |e: &Expr| self.joins_text(e) && !self.is_enclosed(e.span);
        let (joined, other) = match (is_joined(left), is_joined(right)) {
            (true, false) => (left, right),
            (false, true) => (right, left),
            _ => return,
        };
        if is_text(other) {
            return;
        }
        self.joined(joined, span);
    }

    /// Reports a text that is joined before it is compared or tested.
    pub(super) fn joined(&mut self, joined: &Expr, span: Span) {
        let text = self.text(joined.span).to_owned();
        self.found.push(
            Finding::warning(rules::JOINED_FIRST, span, format!("`+` joins `{text}` to one text, and this tests that text"))
                .why("`+` binds more tightly than a comparison and `? :`")
                .help("put the condition, or the whole choice after `+`, into parentheses, as `'text ' + (a > 0 ? 'x' : 'y')`"),
        );
    }
}

/// The start of a comment of a line: the first `//` outside of a text.
fn comment_start(line: &str) -> Option<usize> {
    let mut quote = None;
    let mut before = ' ';
    for (at, c) in line.char_indices() {
        match quote {
            Some(q) if c == q && before != '\\' => quote = None,
            Some(_) => {}
            None if matches!(c, '\'' | '"' | '`') => quote = Some(c),
            None if c == '/' && before == '/' => return at.checked_sub(1),
            None => {}
        }
        before = c;
    }
    None
}

/// Whether the text of a comment is a number, or one element of the simulation.
fn is_divisor(text: &str) -> bool {
    let text = text.trim_end_matches([';', ')']);
    let is_path = ["data.", "model.", "ctx.", "lib.", "Math."].iter().any(|root| text.starts_with(root));
    text.parse::<f64>().is_ok_and(f64::is_finite) || is_path && !text.contains([' ', '='])
}
