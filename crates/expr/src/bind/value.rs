//! Values: operators, their types, and the mistakes that JavaScript turns into NaN without a word.

use super::name::quoted;
use super::{Attempt, Binder, Mode, Thing, no_result};
use crate::ast::{BinaryOp, Expr, ExprKind, UnaryOp};
use crate::code;
use crate::diagnostic::{Diagnostic, Span};
use crate::ir::{Index, Ir};
use crate::schema::Type;
use crate::value::Value;

impl Binder<'_> {
    /// A part of the source as a value.
    pub(super) fn value(&mut self, expr: &Expr) -> Attempt<Ir> {
        let thing = self.thing(expr)?;
        self.value_of(thing, expr.span)
    }

    /// The value that a thing is.
    pub(super) fn value_of(&mut self, thing: Thing, span: Span) -> Attempt<Ir> {
        let report = match thing {
            Thing::Value(ir) if ir.ty == Type::Void => no_result(span, self.source),
            Thing::Value(ir) => return Ok(ir),
            Thing::Field(field) if field.is_scalar() => return Ok(self.load(&field, Index::At(0), span)),
            Thing::Field(field) => self.whole_array(&field, span),
            other => self.not_a_value(&other, span),
        };
        self.refuse(report)
    }

    fn not_a_value(&self, thing: &Thing, span: Span) -> Diagnostic {
        let text = self.text(span);
        let error = |message: String| Diagnostic::error(code::NOT_A_VALUE, span, message);
        match thing {
            Thing::Collection(id) => self.collection_needs_call(*id, span, None),
            Thing::Function(_) | Thing::MathFunction(_) | Thing::Method(..) => self.not_called(thing, span),
            Thing::Math => {
                error("`Math` is not a value".into()).help("write one of its functions, as `Math.sqrt(x)`")
            }
            Thing::Globals => {
                error("`ctx` is not a value".into()).help("write one of its variables, as `ctx.peak`")
            }
            Thing::Object(id) => {
                let report = error(format!("{} is not a value", quoted(&self.schema.describe(*id))));
                match self.schema.member_names(*id).first() {
                    Some(first) => report
                        .why("it is an object with fields")
                        .help(format!("write one of them, as `{text}.{first}`")),
                    None => report,
                }
            }
            Thing::Value(_) | Thing::Field(_) => error(format!("`{text}` is not a value")),
        }
    }

    /// A literal or an operator.
    pub(super) fn operation(&mut self, expr: &Expr) -> Attempt<Ir> {
        let span = expr.span;
        match &expr.kind {
            ExprKind::Number(x) => Ok(Ir::constant(Value::Number(*x), span)),
            ExprKind::String(text) => Ok(Ir::constant(Value::from(text.as_str()), span)),
            ExprKind::Boolean(b) => Ok(Ir::constant(Value::Boolean(*b), span)),
            ExprKind::Null => Ok(Ir::constant(Value::Null, span)),
            ExprKind::Unary { op, operand } => self.unary(*op, operand, span),
            ExprKind::Binary { op, left, right } => self.binary(*op, left, right, span),
            ExprKind::Logical { op, left, right } => {
                let (left, right) = self.both(left, right)?;
                Ok(Ir::logical(*op, left, right, span))
            }
            ExprKind::Conditional { test, then, otherwise } => {
                let test = self.value(test);
                let (then, otherwise) = self.both(then, otherwise)?;
                Ok(Ir::choice(test?, then, otherwise, span))
            }
            ExprKind::Array(items) => {
                for item in items {
                    let _ = self.value(item); // for the mistakes in it
                }
                self.refuse(
                    Diagnostic::error(code::NOT_SUPPORTED, span, "array literals are not supported here yet")
                        .why("they stand only as the argument of `.set`")
                        .help("write `data.qpos.set([0, 0, 1], 0)` to store several numbers"),
                )
            }
            ExprKind::Assign { op, op_span, .. } => {
                let report = self.assignment_inside(*op, *op_span, span);
                self.refuse(report)
            }
            ExprKind::Update { increment, .. } => {
                let symbol = if *increment { "++" } else { "--" };
                let inside =
                    Diagnostic::error(code::ASSIGN_INSIDE, span, format!("`{symbol}` inside an expression"));
                let report = match self.mode {
                    Mode::Statements => inside
                        .why("a change hidden in an expression is easily missed")
                        .help("write it as a statement of its own"),
                    _ => {
                        inside.why("this text only reads a value").help("change the variable in `controller`")
                    }
                };
                self.refuse(report)
            }
            // Names, members, indexes and calls are things; an error node is already reported.
            _ => Err(super::Reported),
        }
    }

    /// Both operands, so that a mistake in one does not hide one in the other.
    fn both(&mut self, left: &Expr, right: &Expr) -> Attempt<(Ir, Ir)> {
        let left = self.value(left);
        let right = self.value(right);
        Ok((left?, right?))
    }

    fn assignment_inside(&self, op: Option<BinaryOp>, op_span: Span, span: Span) -> Diagnostic {
        if self.mode == Mode::Expression && op.is_some() {
            return Diagnostic::error(
                code::EXPRESSION_ONLY,
                op_span,
                "an assignment where only a value is read",
            )
            .why("this text is an expression: it gives a value and changes nothing")
            .help("assign in `controller`, `apply` or `run`, and show the variable here");
        }
        let symbol = self.text(op_span);
        let report = Diagnostic::error(
            code::ASSIGN_INSIDE,
            op_span,
            format!("`{symbol}` assigns; it does not compare"),
        );
        let report = match self.mode {
            Mode::Statements => {
                report.why("inside an expression the value would be changed where a test was probably meant")
            }
            _ => report
                .why(format!("this text only reads a value, and `{}` would change one", self.text(span))),
        };
        match op {
            None => report.help("write `===` to compare").fix(op_span, "==="),
            Some(_) => report.help("write the assignment as a statement of its own"),
        }
    }

    fn unary(&mut self, op: UnaryOp, operand: &Expr, span: Span) -> Attempt<Ir> {
        let ir = self.value(operand)?;
        Ok(match op {
            UnaryOp::Not => Ir::not(ir, span),
            // `+text` is how a string is turned into a number on purpose.
            UnaryOp::Plus => Ir::to_number(ir, span),
            UnaryOp::Minus => {
                self.expect_number(&ir, "-");
                Ir::negate(ir, span)
            }
            UnaryOp::BitNot => {
                self.expect_number(&ir, "~");
                Ir::bit_not(ir, span)
            }
        })
    }

    fn binary(&mut self, op: BinaryOp, left: &Expr, right: &Expr, span: Span) -> Attempt<Ir> {
        self.check_nan(op, left, right, span);
        self.check_chain(op, left, span);
        let (a, b) = self.both(left, right)?;
        if !op.is_comparison() && op != BinaryOp::Add {
            self.expect_number(&a, op.symbol());
            self.expect_number(&b, op.symbol());
        }
        if op == BinaryOp::BitXor {
            let meant = format!("{} ** {}", self.text(left.span), self.text(right.span));
            self.report(
                Diagnostic::warning(code::XOR_AS_POWER, span, "`^` is not a power")
                    .why("in JavaScript it is the bitwise exclusive or: `3 ^ 2` is 1")
                    .help(format!("write `{meant}`"))
                    .fix(span, meant),
            );
        }
        Ok(Ir::binary(op, a, b, span))
    }

    /// Warns of a string where an operator needs a number.
    fn expect_number(&mut self, ir: &Ir, symbol: &str) {
        if ir.ty != Type::String {
            return;
        }
        let report = Diagnostic::warning(
            code::STRING_AS_NUMBER,
            ir.span,
            format!("`{symbol}` needs a number, this is a string"),
        );
        let report = match ir.known().map(Value::to_number) {
            Some(x) if x.is_nan() => report.why("JavaScript turns it into NaN").help("write the number"),
            Some(x) => {
                let meant = crate::number::to_text(x);
                report
                    .why("JavaScript reads the number in it")
                    .help(format!("write `{meant}`"))
                    .fix(ir.span, meant)
            }
            None => report
                .why("JavaScript reads the number in it, or gives NaN when there is none")
                .help("write `+text` if that is meant"),
        };
        self.report(report);
    }

    /// Warns of a comparison with the literal NaN.
    fn check_nan(&mut self, op: BinaryOp, left: &Expr, right: &Expr, span: Span) {
        let is_nan = |e: &Expr| matches!(&e.kind, ExprKind::Name(n) if n == "NaN");
        if !op.is_comparison() || !(is_nan(left) || is_nan(right)) {
            return;
        }
        let other = self.text(if is_nan(right) { left.span } else { right.span }).to_owned();
        let negated = matches!(op, BinaryOp::NotEqual | BinaryOp::StrictNotEqual);
        let result = if negated { "true" } else { "false" };
        let meant = format!("{}isNaN({other})", if negated { "!" } else { "" });
        let report =
            Diagnostic::warning(code::COMPARE_NAN, span, format!("this comparison is always {result}"))
                .why("NaN is not equal to anything, not even to itself, and neither smaller nor larger");
        self.report(match op.power() {
            8 => report.help(format!("write `{meant}`")).fix(span, meant),
            _ => report.help("compare with a number"),
        });
    }

    /// Warns of `a < b < c`.
    fn check_chain(&mut self, op: BinaryOp, left: &Expr, span: Span) {
        let ExprKind::Binary { op: inner, right: middle, left: first } = &left.kind else { return };
        let orders = |op: BinaryOp| op.power() == 9;
        // In `(a < b) < c` the parenthesis says that it is meant.
        let enclosed = left.span.start < first.span.start
            && self.text(left.span).starts_with('(')
            && left.span.end > middle.span.end;
        if !(orders(op) && orders(*inner)) || enclosed {
            return;
        }
        let middle = self.text(middle.span);
        let last = self.text(Span::new(left.span.end, span.end)).trim_start();
        let meant = format!("{} && {middle} {last}", self.text(left.span));
        self.report(
            Diagnostic::warning(code::CHAINED_COMPARISON, span, "comparisons do not chain")
                .why(format!(
                    "`{}` is true or false, and that is what is compared next, as 1 or 0",
                    self.text(left.span)
                ))
                .help(format!("write `{meant}`"))
                .fix(span, meant),
        );
    }
}
