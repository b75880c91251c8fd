//! Lints about conditions that are always true or always false.

use super::pass::LintPass;
use crate::ast::{BinaryOp, Expr, ExprKind, LogicalOp, UnaryOp};
use crate::rules;
use crate::schema::Entry;
use crate::types::{FunctionId, Type};
use labspec_finding::{Finding, Span};
use std::collections::BTreeMap;

/// The limits of a number, each with whether the number may equal it.
#[derive(Clone, Copy)]
struct Limits {
    lower: (f64, bool),
    upper: (f64, bool),
}

impl Limits {
    fn between(lower: f64, upper: f64) -> Limits {
        Limits { lower: (lower, true), upper: (upper, true) }
    }

    fn is_empty(&self) -> bool {
        let ((low, with_low), (high, with_high)) = (self.lower, self.upper);
        low > high || low == high && !(with_low && with_high)
    }

    /// Keeps the numbers for which `number op x` holds.
    fn keep(&mut self, op: BinaryOp, x: f64) {
        let mut above = |with: bool| {
            if x > self.lower.0 || x == self.lower.0 && !with {
                self.lower = (x, with);
            }
        };
        match op {
            BinaryOp::Greater => above(false),
            BinaryOp::GreaterEqual | BinaryOp::Equal | BinaryOp::StrictEqual => above(true),
            _ => {}
        }
        let mut below = |with: bool| {
            if x < self.upper.0 || x == self.upper.0 && !with {
                self.upper = (x, with);
            }
        };
        match op {
            BinaryOp::Less => below(false),
            BinaryOp::LessEqual | BinaryOp::Equal | BinaryOp::StrictEqual => below(true),
            _ => {}
        }
    }
}

/// The operator with exchanged operands.
fn mirrored(op: BinaryOp) -> BinaryOp {
    match op {
        BinaryOp::Less => BinaryOp::Greater,
        BinaryOp::Greater => BinaryOp::Less,
        BinaryOp::LessEqual => BinaryOp::GreaterEqual,
        BinaryOp::GreaterEqual => BinaryOp::LessEqual,
        other => other,
    }
}

/// The operator that holds where this one does not.
fn negated(op: BinaryOp) -> BinaryOp {
    match op {
        BinaryOp::Less => BinaryOp::GreaterEqual,
        BinaryOp::Greater => BinaryOp::LessEqual,
        BinaryOp::LessEqual => BinaryOp::Greater,
        BinaryOp::GreaterEqual => BinaryOp::Less,
        BinaryOp::NotEqual | BinaryOp::StrictNotEqual => BinaryOp::Equal,
        BinaryOp::Equal | BinaryOp::StrictEqual => BinaryOp::NotEqual,
        other => other,
    }
}

/// The numbers that an expression may have.
fn range(expr: &Expr, text: &str) -> Limits {
    use std::f64::consts::{FRAC_PI_2, PI};
    let all = Limits::between(f64::NEG_INFINITY, f64::INFINITY);
    match &expr.kind {
        ExprKind::Call { .. } => match text.split('(').next().unwrap_or("").trim() {
            "Math.abs" | "Math.sqrt" | "Math.hypot" | "Math.exp" => Limits::between(0.0, f64::INFINITY),
            "Math.sin" | "Math.cos" | "Math.tanh" => Limits::between(-1.0, 1.0),
            "Math.asin" | "Math.atan" => Limits::between(-FRAC_PI_2, FRAC_PI_2),
            "Math.acos" => Limits::between(0.0, PI),
            "Math.atan2" => Limits::between(-PI, PI),
            _ => all,
        },
        ExprKind::Binary { op: BinaryOp::Power, right, .. } => match right.kind {
            ExprKind::Number(x) if x % 2.0 == 0.0 => Limits::between(0.0, f64::INFINITY),
            _ => all,
        },
        ExprKind::Member { name, .. } if name.text == "length" => Limits::between(0.0, f64::INFINITY),
        _ => all,
    }
}

/// Appends the operands of a chain of one logical operator.
fn operands<'e>(op: LogicalOp, expr: &'e Expr, all: &mut Vec<&'e Expr>) {
    match &expr.kind {
        ExprKind::Logical { op: inner, left, right } if *inner == op => {
            operands(op, left, all);
            operands(op, right, all);
        }
        _ => all.push(expr),
    }
}

/// A part of a condition: the whole comparison, its operator with the constant on the right, and the constant.
type Comparison<'e> = (&'e Expr, BinaryOp, f64);

impl LintPass<'_> {
    /// A comparison of an expression with a constant: the expression, the operator with the constant on the right, the constant.
    fn compared<'e>(&self, expr: &'e Expr) -> Option<(&'e Expr, BinaryOp, f64)> {
        let ExprKind::Binary { op, left, right } = &expr.kind else { return None };
        if !op.is_comparison() {
            return None;
        }
        match (self.literal(left), self.literal(right)) {
            (None, Some(x)) if !x.is_nan() => Some((left, *op, x)),
            (Some(x), None) if !x.is_nan() => Some((right, mirrored(*op), x)),
            _ => None,
        }
    }

    /// The first two comparisons that cannot hold together; with `negate`, that cannot fail together.
    fn contradiction<'e>(&self, parts: &[&'e Expr], negate: bool) -> Option<(&'e Expr, &'e Expr)> {
        let mut limits: BTreeMap<String, (Limits, Vec<Comparison<'e>>)> = BTreeMap::new();
        for part in parts {
            let Some((number, op, x)) = self.compared(part) else { continue };
            let op = if negate { negated(op) } else { op };
            let Some(name) = self.bare(number.span).filter(|t| !t.contains("++") && !t.contains("--")) else {
                continue;
            };
            let of_all = Limits::between(f64::NEG_INFINITY, f64::INFINITY);
            let (limit, others) = limits.entry(name).or_insert((of_all, Vec::new()));
            limit.keep(op, x);
            others.push((part, op, x));
            if limit.is_empty() {
                let other = others.iter().find(|(_, other_op, other_x)| {
                    let mut two = of_all;
                    two.keep(op, x);
                    two.keep(*other_op, *other_x);
                    two.is_empty()
                });
                return other.map(|(other, ..)| (*other, *part));
            }
        }
        None
    }

    /// Warns about `x < 1 && x > 2` and `x > 1 || x < 2`.
    #[inline(never)]
    pub(super) fn limits(&mut self, op: LogicalOp, expr: &Expr) {
        if op == LogicalOp::Nullish || !self.visited.insert(expr.span) {
            return;
        }
        let mut parts = Vec::new();
        operands(op, expr, &mut parts);
        self.mark_chain(op, expr);
        let Some((first, second)) = self.contradiction(&parts, op == LogicalOp::Or) else { return };
        let [a, b] = [first, second].map(|e| self.text(e.span));
        let (result, why, other) = match op {
            LogicalOp::And => ("false", format!("`{a}` and `{b}` are never true together"), "||"),
            _ => ("true", format!("where `{a}` is false, `{b}` is true"), "&&"),
        };
        let meant = format!("{a} {other} {b}");
        let report = Finding::warning(
            rules::CONSTANT_CONDITION,
            expr.span,
            format!("this condition is always {result}"),
        )
        .why(why);
        let report = match parts.len() {
            2 => report
                .help(format!("write `{meant}`, or correct one of the two numbers"))
                .guess(expr.span, meant),
            _ => report.help("correct one of the two numbers, or the operator between them"),
        };
        self.found.push(report);
    }

    /// The inner parts of a chain are parts of the same condition.
    fn mark_chain(&mut self, op: LogicalOp, expr: &Expr) {
        if let ExprKind::Logical { op: inner, left, right } = &expr.kind
            && *inner == op
        {
            self.visited.insert(expr.span);
            self.mark_chain(op, left);
            self.mark_chain(op, right);
        }
    }

    /// Warns about `Math.abs(x) < 0`.
    #[inline(never)]
    pub(super) fn outside_range(&mut self, expr: &Expr) {
        let Some((number, op, x)) = self.compared(expr) else { return };
        let possible = range(number, self.text(number.span));
        // An angle beside a number of degrees has a finding of its own.
        if possible.lower.0 == f64::NEG_INFINITY || x.abs() > 10.0 && self.is_angle(number, 4) {
            return;
        }
        let holds = |op: BinaryOp| {
            let mut limits = possible;
            limits.keep(op, x);
            !limits.is_empty()
        };
        let result = match (holds(op), holds(negated(op))) {
            (false, _) => "false",
            (true, false) => "true",
            _ => return,
        };
        let text = self.text(number.span);
        let limits = match possible.upper.0 {
            f64::INFINITY => "never negative".to_owned(),
            high => format!("between {:.4} and {high:.4}", possible.lower.0),
        };
        self.found.push(
            Finding::warning(
                rules::CONSTANT_CONDITION,
                expr.span,
                format!("this comparison is always {result}"),
            )
            .why(format!("`{text}` is {limits}"))
            .help("correct the number or the operator"),
        );
    }

    /// Checks a condition of `if`, `while`, `for` or `? :`.
    #[inline(never)]
    pub(super) fn tested(&mut self, test: &Expr) {
        match &test.kind {
            ExprKind::Logical { op: LogicalOp::Or, left, right } => {
                self.tested(left);
                self.alternative(left, right, test.span);
                self.tested(right);
            }
            ExprKind::Logical { left, right, .. } => {
                self.tested(left);
                self.tested(right);
            }
            ExprKind::Unary { op: UnaryOp::Not, operand } => self.tested(operand),
            ExprKind::Call { callee, .. } if self.returns_index(callee) => self.index_tested(test, callee),
            _ if self.joins_text(test) => self.joined(test, test.span),
            _ => self.list_tested(test),
        }
    }

    /// Warns about `x === 1 || 2`.
    fn alternative(&mut self, left: &Expr, right: &Expr, span: Span) {
        let ExprKind::Binary { op, left: compared, .. } = &left.kind else { return };
        let is_set = match &right.kind {
            ExprKind::Number(x) => *x != 0.0,
            ExprKind::String(text) => !text.is_empty(),
            _ => false,
        };
        if op.power() != 8 || !is_set {
            return;
        }
        let [first, number] = [left.span, right.span].map(|span| self.text(span));
        let meant = format!("{first} || {} {} {number}", self.text(compared.span), op.symbol());
        self.found.push(
            Finding::warning(rules::CONSTANT_CONDITION, span, "this condition is always true")
                .why(format!("`{number}` alone counts as true"))
                .help(format!("write `{meant}`"))
                .guess(span, meant),
        );
    }

    fn returns_index(&self, callee: &Expr) -> bool {
        let names = ["indexOf", "lastIndexOf", "findIndex", "findLastIndex"];
        matches!(&callee.kind, ExprKind::Member { name, .. } if names.contains(&name.text.as_str()))
    }

    fn index_tested(&mut self, test: &Expr, callee: &Expr) {
        let ExprKind::Member { object, name, .. } = &callee.kind else { return };
        let called = self.text(Span::new(name.span.end, test.span.end));
        let instead = if name.text.starts_with("find") { "some" } else { "includes" };
        let meant = format!("{}.{instead}{called}", self.text(object.span));
        self.found.push(
            Finding::new(
                rules::INDEX_AS_CONDITION,
                test.span,
                format!("`{}` gives an index, not true or false", name.text),
            )
            .help(format!("write `{meant}`"))
            .guess(test.span, meant),
        );
    }

    fn list_tested(&mut self, test: &Expr) {
        let Some(shape) = self.typed.shape(test.span) else { return };
        let (what, even) = match shape.ty {
            Type::List => ("a list", ", even an empty one"),
            Type::Record => ("a record", ", even an empty one"),
            Type::Function => ("a function", ""),
            _ => return,
        };
        let text = self.text(test.span);
        let report = Finding::warning(rules::CONSTANT_CONDITION, test.span, "this condition is always true")
            .why(format!("`{text}` is {what}, and {what} counts as true{even}"));
        let is_negated = self.source.get(..test.span.start).is_some_and(|before| before.ends_with('!'));
        let meant = match is_negated {
            true => format!("({text}.length > 0)"),
            false => format!("{text}.length > 0"),
        };
        self.found.push(match shape.ty {
            Type::List => report.help(format!("write `{meant}`")).guess(test.span, meant),
            _ => report.help("test one of its values"),
        });
    }

    /// Warns about a text that no entry of the list can equal: `lib.contactPairs().includes('floor')`.
    #[inline(never)]
    pub(super) fn searched(&mut self, callee: &Expr, args: &[Expr], span: Span) {
        let ExprKind::Member { object, name, .. } = &callee.kind else { return };
        let [Expr { kind: ExprKind::String(searched_text), .. }] = args else { return };
        if !["includes", "indexOf", "lastIndexOf"].contains(&name.text.as_str()) {
            return;
        }
        let ExprKind::Call { callee: of, .. } = &self.definition(object).kind else { return };
        let Some(part) = self.function_of(of).and_then(|id| self.schema.entries_contain(id)) else { return };
        if searched_text.contains(part) {
            return;
        }
        let [list, text] = [object, of].map(|e| self.text(e.span).to_owned());
        let [first] = args.first_chunk::<1>().map(|[a]| [self.text(a.span)]).unwrap_or([""]);
        let meant = format!("{list}.some((entry) => entry.split('{part}').includes({first}))");
        let result = if name.text == "includes" { "false" } else { "-1" };
        self.found.push(
            Finding::warning(
                rules::CONSTANT_CONDITION,
                span,
                format!("this is always {result}: no entry of the list is {first}"),
            )
            .why(format!("each entry of `{text}()` consists of two names with `{part}` between them"))
            .help(format!("write `{meant}`"))
            .guess(span, meant),
        );
    }

    /// The function of the host that an expression of the form `object.name` names.
    fn function_of(&self, expr: &Expr) -> Option<FunctionId> {
        let ExprKind::Member { object, name, .. } = &expr.kind else { return None };
        let ExprKind::Name(root) = &object.kind else { return None };
        let Some(Entry::Object(id)) = self.schema.root(root) else { return None };
        match self.schema.member(id, &name.text) {
            Some(Entry::Function(function)) => Some(function),
            _ => None,
        }
    }
}
