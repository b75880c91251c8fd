//! Values: operators, their types, and the mistakes that JavaScript turns into NaN without a word.

use super::name::quoted;
use super::{Attempt, Binder, Mode, Reported, Thing, no_result};
use crate::ast::{BinaryOp, Expr, ExprKind, LogicalOp, UnaryOp};
use crate::ir::{Index, Ir, Kind};
use crate::rules;
use crate::schema::Type;
use crate::value::Value;
use crate::{Finding, Span};

impl<'a> Binder<'a> {
    /// A part of the source as a value of any kind.
    pub(super) fn value(&mut self, expr: &'a Expr) -> Attempt<Ir> {
        let thing = self.thing(expr)?;
        self.value_of(thing, expr.span)
    }

    /// The value that a thing is.
    pub(super) fn value_of(&mut self, thing: Thing, span: Span) -> Attempt<Ir> {
        let report = match thing {
            Thing::Value(ir) if ir.ty == Type::Void => no_result(span, self.source),
            Thing::Value(ir) => return Ok(ir),
            Thing::Field(field) if field.is_scalar() => return Ok(self.load(&field, Index::At(0), span)),
            Thing::Field(field) => return Ok(self.field_value(&field, span)),
            Thing::Closure(at) => return self.closure_value(at, span),
            other => self.not_a_value(&other, span),
        };
        self.refuse(report)
    }

    /// A part of the source as a single value: a number, a text, a truth value.
    pub(super) fn operand(&mut self, expr: &'a Expr) -> Attempt<Ir> {
        let thing = self.thing(expr)?;
        self.operand_of(thing, expr.span)
    }

    pub(super) fn operand_of(&mut self, thing: Thing, span: Span) -> Attempt<Ir> {
        if let Thing::Field(field) = &thing
            && !field.is_scalar()
        {
            let report = self.whole_array(field, span);
            return self.refuse(report);
        }
        let ir = self.value_of(thing, span)?;
        self.expect_single(&ir)?;
        Ok(ir)
    }

    /// Refuses lists, records and functions where a single value must stand.
    fn expect_single(&mut self, ir: &Ir) -> Attempt<()> {
        if !matches!(ir.ty, Type::List | Type::Record | Type::Function | Type::View) {
            return Ok(());
        }
        let text = self.text(ir.span);
        let message = format!("`{text}` is {}, not one value", ir.ty.describe());
        let code =
            if matches!(ir.ty, Type::List | Type::View) { rules::WHOLE_ARRAY } else { rules::NOT_A_VALUE };
        let report = Finding::error(code, ir.span, message);
        self.refuse(match ir.ty {
            Type::Function => report.why("it is not called").help(format!("write `{text}(…)`")),
            Type::Record => {
                let member = match &ir.kind {
                    Kind::Call(id, _) => self.schema.function(*id).members.first().map(|(n, _)| n.clone()),
                    _ => None,
                };
                let member = member.unwrap_or_else(|| "x".into());
                report
                    .why("a computation needs one of its members")
                    .help(format!("write one of them, as `{text}.{member}`"))
            }
            _ => report.why("a computation needs one of its elements").help(format!(
                "choose an element, as `{text}[0]`, or make one value of them, as `Math.hypot(...{text})`"
            )),
        })
    }

    fn not_a_value(&self, thing: &Thing, span: Span) -> Finding {
        let text = self.text(span);
        let error = |message: String| Finding::error(rules::NOT_A_VALUE, span, message);
        match thing {
            Thing::Collection(id) => self.collection_needs_call(*id, span, None),
            Thing::Function(_) | Thing::MathFunction(_) | Thing::Method(..) | Thing::Native(_) => {
                self.not_called(thing, span)
            }
            Thing::Namespace(name) => error(format!("`{name}` is not a value"))
                .why("it holds functions")
                .help(format!("call it, as `{name}(x)`, or one of its functions")),
            Thing::Picked(..) => error(format!("`{text}` is an object of the simulation, not a value"))
                .help(format!("write one of its fields, as `{text}.id`")),
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
            Thing::Value(_) | Thing::Field(_) | Thing::Closure(_) => {
                error(format!("`{text}` is not a value"))
            }
        }
    }

    /// A literal or an operator.
    pub(super) fn operation(&mut self, expr: &'a Expr) -> Attempt<Ir> {
        let span = expr.span;
        match &expr.kind {
            ExprKind::Number(x) => Ok(Ir::number(*x, span)),
            ExprKind::String(text) => Ok(Ir::constant(Value::from(text.as_str()), span)),
            ExprKind::Boolean(b) => Ok(Ir::constant(Value::Boolean(*b), span)),
            ExprKind::Null => Ok(Ir::constant(Value::Null, span)),
            ExprKind::Unary { op, operand } => self.unary(*op, operand, span),
            ExprKind::Binary { op, left, right } => self.binary(*op, left, right, span),
            ExprKind::Logical { op, left, right } => {
                let left = self.test(left);
                self.guards += 1;
                let right = self.value(right);
                self.guards -= 1;
                let (left, right) = (left?, right?);
                self.check_fallback(*op, &left, span);
                Ok(Ir::logical(*op, left, right, span))
            }
            ExprKind::Conditional { test, then, otherwise } => {
                let test = self.test(test);
                self.guards += 1;
                let (then, otherwise) = (self.value(then), self.value(otherwise));
                self.guards -= 1;
                Ok(Ir::choice(test?, then?, otherwise?, span))
            }
            ExprKind::Array(items) => self.list(items, span),
            ExprKind::Object(properties) => self.record(properties, span),
            ExprKind::Template { texts, values } => self.template(texts, values, span),
            ExprKind::Chain(inner) => {
                let thing = self.thing(inner)?;
                let ir = self.value_of(thing, span)?;
                let ty = ir.ty.or(Type::Undefined);
                Ok(Ir::new(Kind::Chain(Box::new(ir)), ty, span))
            }
            ExprKind::Assign { op, op_span, .. } if self.only_reads() => {
                let report = self.assignment_inside(*op, *op_span, span);
                self.refuse(report)
            }
            ExprKind::AssignLogical { op_span, .. } if self.only_reads() => {
                let report = self.assignment_inside(Some(BinaryOp::Add), *op_span, span);
                self.refuse(report)
            }
            ExprKind::Update { increment, .. } if self.only_reads() => {
                let symbol = if *increment { "++" } else { "--" };
                self.refuse(
                    Finding::error(rules::ASSIGN_INSIDE, span, format!("`{symbol}` inside an expression"))
                        .why("this text only reads a value")
                        .help("change the variable in `controller`"),
                )
            }
            ExprKind::Assign { .. } | ExprKind::AssignLogical { .. } | ExprKind::Update { .. } => {
                self.changing(expr)
            }
            ExprKind::Sequence(_) | ExprKind::Spread(_) => self.refuse(
                Finding::error(rules::MISPLACED, span, "this has no place inside an expression")
                    .help("write one value"),
            ),
            // Names, members, indexes, calls and functions are things; an error node is already reported.
            _ => Err(Reported),
        }
    }

    /// Warns of a fallback that can never be taken, or is taken for 0 as well.
    fn check_fallback(&mut self, op: LogicalOp, left: &Ir, span: Span) {
        let never =
            op == LogicalOp::Nullish && matches!(left.ty, Type::Number | Type::Boolean | Type::String);
        if never && self.site.is_none() && left.known().is_none() {
            let text = self.text(left.span);
            self.report(
                Finding::warning(rules::UNUSED_RESULT, span, "the value behind `??` is never used")
                    .why(format!("`{text}` is {}, never `undefined` or `null`", left.ty.describe()))
                    .help(format!("write `{text}` alone")),
            );
        }
    }

    /// Both operands, so that a mistake in one does not hide one in the other.
    fn both(&mut self, left: &'a Expr, right: &'a Expr) -> Attempt<(Ir, Ir)> {
        let left = self.operand(left);
        let right = self.operand(right);
        Ok((left?, right?))
    }

    pub(super) fn assignment_inside(&self, op: Option<BinaryOp>, op_span: Span, span: Span) -> Finding {
        if self.mode == Mode::Expression && op.is_some() {
            return Finding::error(
                rules::EXPRESSION_ONLY,
                op_span,
                "an assignment where only a value is read",
            )
            .why("this text is an expression: it gives a value and changes nothing")
            .help("assign in `controller`, `apply` or `run`, and show the variable here");
        }
        let symbol = self.text(op_span);
        let report =
            Finding::error(rules::ASSIGN_INSIDE, op_span, format!("`{symbol}` assigns; it does not compare"));
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

    fn unary(&mut self, op: UnaryOp, operand: &'a Expr, span: Span) -> Attempt<Ir> {
        let ir = match op {
            UnaryOp::Not => self.test(operand)?,
            UnaryOp::TypeOf => self.value(operand)?,
            _ => self.operand(operand)?,
        };
        if matches!(op, UnaryOp::Minus | UnaryOp::BitNot) {
            self.expect_number(&ir, op.symbol());
        }
        Ok(Ir::sign(op, ir, span))
    }

    /// The operands of `==` and its like: lists and records may be compared with nothing and with each other, and
    /// `+` joins them to a text.
    fn comparable(&mut self, op: BinaryOp, left: &'a Expr, right: &'a Expr) -> Attempt<(Ir, Ir)> {
        let things = (self.thing(left), self.thing(right));
        let (left_thing, right_thing) = (things.0?, things.1?);
        let fine = |other: &Thing| match other {
            Thing::Value(ir) if op == BinaryOp::Add => ir.ty == Type::String,
            Thing::Value(ir) => matches!(ir.ty, Type::Null | Type::Undefined),
            _ => false,
        };
        let parts = |t: &Thing| match t {
            Thing::Value(ir) => ir.ty != Type::View && ir.ty.may_have_parts(),
            _ => false,
        };
        let loose = fine(&left_thing) || fine(&right_thing);
        let loose = loose || op != BinaryOp::Add && parts(&left_thing) && parts(&right_thing);
        let mut bind = |thing: Thing, span: Span| {
            if loose { self.value_of(thing, span) } else { self.operand_of(thing, span) }
        };
        let (a, b) = (bind(left_thing, left.span), bind(right_thing, right.span));
        Ok((a?, b?))
    }

    fn binary(&mut self, op: BinaryOp, left: &'a Expr, right: &'a Expr, span: Span) -> Attempt<Ir> {
        self.check_nan(op, left, right, span);
        self.check_chain(op, left, span);
        let (a, b) = if op.power() == 8 || op == BinaryOp::Add {
            self.comparable(op, left, right)?
        } else {
            self.both(left, right)?
        };
        if !op.is_comparison() && op != BinaryOp::Add {
            self.expect_number(&a, op.symbol());
            self.expect_number(&b, op.symbol());
            self.check_conversion(op, &a, &b);
        }
        if op == BinaryOp::BitXor {
            let meant = format!("{} ** {}", self.text(left.span), self.text(right.span));
            self.report(
                Finding::warning(rules::XOR_AS_POWER, span, "`^` is not a power")
                    .why("in JavaScript it is the bitwise exclusive or: `3 ^ 2` is 1")
                    .help(format!("write `{meant}`"))
                    .fix(span, meant),
            );
        }
        self.effects.can_throw |= op == BinaryOp::Add && !(a.is_plain() && b.is_plain());
        Ok(Ir::binary(op, a, b, span))
    }

    /// Warns of a string where an operator needs a number.
    fn expect_number(&mut self, ir: &Ir, symbol: &str) {
        if ir.ty != Type::String || self.site.is_some() {
            return;
        }
        let report = Finding::warning(
            rules::STRING_AS_NUMBER,
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
            Finding::warning(rules::COMPARE_NAN, span, format!("this comparison is always {result}"))
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
            Finding::warning(rules::CHAINED_COMPARISON, span, "comparisons do not chain")
                .why(format!(
                    "`{}` is true or false, and that is what is compared next, as 1 or 0",
                    self.text(left.span)
                ))
                .help(format!("write `{meant}`"))
                .fix(span, meant),
        );
    }
}
