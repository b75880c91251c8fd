//! Values: operators, their types, and mistakes that JavaScript silently turns into NaN.

use super::binder::{Binder, Entity};
use super::member::quoted;
use crate::ast::{BinaryOp, Expr, ExprKind, LogicalOp, UnaryOp};
use crate::bind::source::TextKind;
use crate::ir::{Index, Ir, IrKind};
use crate::parse::{Attempt, Reported};
use crate::rules;
use crate::types::Type;
use crate::value::Value;
use labspec_finding::{Finding, Span};

impl<'a> Binder<'a> {
    /// Binds a part of the source as a value of any type.
    pub(super) fn value(&mut self, expr: &'a Expr) -> Attempt<Ir> {
        let entity = self.entity(expr)?;
        self.value_of(entity, expr.span)
    }

    /// The value of an entity.
    #[inline(never)]
    pub(super) fn value_of(&mut self, entity: Entity, span: Span) -> Attempt<Ir> {
        let report = match entity {
            Entity::Value(ir) if ir.ty == Type::Void => self.no_result(span),
            Entity::Value(ir) => {
                self.record_type(span, &ir);
                return Ok(ir);
            }
            Entity::Field(field) if field.is_scalar() => {
                let ir = self.load(&field, Index::At(0), span);
                self.record_type(span, &ir);
                return Ok(ir);
            }
            Entity::Field(field) => return Ok(self.field_value(&field, span)),
            Entity::Closure(function) => return self.closure_value(function, span),
            other => self.not_a_value(&other, span),
        };
        self.refuse(report)
    }

    /// Binds a part of the source as a single value: a number, a string or a boolean.
    pub(super) fn operand(&mut self, expr: &'a Expr) -> Attempt<Ir> {
        let entity = self.entity(expr)?;
        self.operand_of(entity, expr.span)
    }

    pub(super) fn operand_of(&mut self, entity: Entity, span: Span) -> Attempt<Ir> {
        if let Entity::Field(field) = &entity
            && !field.is_scalar()
        {
            let report = self.whole_array(field, span);
            return self.refuse(report);
        }
        let ir = self.value_of(entity, span)?;
        self.expect_single(&ir)?;
        Ok(ir)
    }

    /// Refuses lists, records and functions where a single value is required.
    fn expect_single(&mut self, ir: &Ir) -> Attempt<()> {
        if !matches!(ir.ty, Type::List | Type::Record | Type::Function | Type::View) {
            return Ok(());
        }
        let report = self.not_single(ir);
        self.refuse(report)
    }

    /// The finding for a list, a record or a function where a single value is required.
    #[inline(never)]
    pub(super) fn not_single(&self, ir: &Ir) -> Finding {
        let text = self.text(ir.span);
        let message = format!("{} is {}, not a single value", self.describe_span(ir.span), ir.ty.describe());
        let code =
            if matches!(ir.ty, Type::List | Type::View) { rules::WHOLE_ARRAY } else { rules::NOT_A_VALUE };
        let report = Finding::error(code, ir.span, message);
        if self.site.is_some() {
            return report.why("a computation needs a number").help("return a number from the function");
        }
        match ir.ty {
            Type::Function => report.why("it is not called").help(format!("write `{text}(…)`")),
            Type::Record => {
                let member = match &ir.kind {
                    IrKind::Call(id, _) => self.schema.function(*id).members.first().map(|(n, _)| n.clone()),
                    _ => None,
                };
                let member = member.unwrap_or_else(|| "x".into());
                report
                    .why("a computation needs one of its members")
                    .help(format!("write one of them, as `{text}.{member}`"))
            }
            _ => report.why("a computation needs one of its elements").help(format!(
                "select an element, as `{text}[0]`, or combine them into one value, as `Math.hypot(...{text})`"
            )),
        }
    }

    #[inline(never)]
    fn not_a_value(&self, entity: &Entity, span: Span) -> Finding {
        let text = self.text(span);
        let error = |message: String| Finding::error(rules::NOT_A_VALUE, span, message);
        match entity {
            Entity::Collection(id) => self.collection_needs_call(*id, span, None),
            Entity::Function(_) | Entity::MathFunction(_) | Entity::Method(..) | Entity::Native(_) => {
                self.not_called(entity, span)
            }
            Entity::Namespace(name) => error(format!("`{name}` is not a value"))
                .why("it holds functions")
                .help(format!("call it, as `{name}(x)`, or one of its functions")),
            Entity::Picked(..) => {
                error(format!("`{text}` is an object of the {}, not a value", self.host_terms().world))
                    .help(format!("write one of its fields, as `{text}.id`"))
            }
            Entity::Math => {
                error("`Math` is not a value".into()).help("write one of its functions, as `Math.sqrt(x)`")
            }
            Entity::Globals => {
                error("`ctx` is not a value".into()).help("write one of its variables, as `ctx.peak`")
            }
            Entity::Object(id) => {
                let report = error(format!("{} is not a value", quoted(&self.schema.describe(*id))));
                match self.schema.member_names(*id).first() {
                    Some(first) => report
                        .why("it is an object with fields")
                        .help(format!("write one of them, as `{text}.{first}`")),
                    None => report,
                }
            }
            Entity::Value(_) | Entity::Field(_) | Entity::Closure(_) => {
                error(format!("`{text}` is not a value"))
            }
        }
    }

    /// Binds a literal or an operator.
    pub(super) fn operation(&mut self, expr: &'a Expr) -> Attempt<Ir> {
        let span = expr.span;
        match &expr.kind {
            ExprKind::Number(x) => Ok(Ir::number(*x, span)),
            ExprKind::String(text) => Ok(Ir::constant(Value::from(text.as_str()), span)),
            ExprKind::Boolean(b) => Ok(Ir::constant(Value::Boolean(*b), span)),
            ExprKind::Null => Ok(Ir::constant(Value::Null, span)),
            ExprKind::Unary { op, operand } => self.unary(*op, operand, span),
            ExprKind::Binary { op, left, right } => self.binary(*op, left, right, span),
            ExprKind::Logical { op, left, right } => self.logical(*op, left, right, span),
            ExprKind::Conditional { test, then, otherwise } => self.choice(test, then, otherwise, span),
            ExprKind::Array(items) => self.list(items, span),
            ExprKind::Object(properties) => self.record(properties, span),
            ExprKind::Template { texts, values } => self.template(texts, values, span),
            ExprKind::Chain(inner) => self.chain(inner, span),
            ExprKind::Assign { .. } | ExprKind::AssignLogical { .. } | ExprKind::Update { .. }
                if self.only_reads() =>
            {
                let report = self.not_here(expr);
                self.refuse(report)
            }
            ExprKind::Assign { .. } | ExprKind::AssignLogical { .. } | ExprKind::Update { .. } => {
                self.changing(expr)
            }
            ExprKind::Sequence(_) | ExprKind::Spread(_) => {
                let report = self.not_here(expr);
                self.refuse(report)
            }
            // Names, members, indexes, calls and functions are handled as entities; an error node is already reported.
            _ => Err(Reported),
        }
    }

    #[inline(never)]
    fn logical(&mut self, op: LogicalOp, left: &'a Expr, right: &'a Expr, span: Span) -> Attempt<Ir> {
        let left = self.test(left);
        self.guards += 1;
        let right = self.value(right);
        self.guards -= 1;
        Ok(Ir::logical(op, left?, right?, span))
    }

    #[inline(never)]
    fn choice(&mut self, test: &'a Expr, then: &'a Expr, otherwise: &'a Expr, span: Span) -> Attempt<Ir> {
        let test = self.test(test);
        self.guards += 1;
        let (then, otherwise) = (self.value(then), self.value(otherwise));
        self.guards -= 1;
        Ok(Ir::choice(test?, then?, otherwise?, span))
    }

    /// Binds a whole chain that contains `?.`.
    #[inline(never)]
    fn chain(&mut self, inner: &'a Expr, span: Span) -> Attempt<Ir> {
        let entity = self.entity(inner)?;
        let ir = self.value_of(entity, span)?;
        let ty = ir.ty.or(Type::Undefined);
        Ok(Ir::new(IrKind::Chain(Box::new(ir)), ty, span))
    }

    /// The finding for an expression that is not allowed here.
    #[inline(never)]
    fn not_here(&self, expr: &Expr) -> Finding {
        let span = expr.span;
        match &expr.kind {
            ExprKind::Assign { op: None, op_span, target, value } if self.stores_variable(target, value) => {
                self.assignment_inside(Some(BinaryOp::Add), *op_span, span).help(format!(
                    "move the assignment to {}, and write `{}` here",
                    self.host_terms().keeper,
                    self.text(target.span)
                ))
            }
            ExprKind::Assign { op, op_span, .. } => self.assignment_inside(*op, *op_span, span),
            ExprKind::AssignLogical { op_span, .. } => {
                self.assignment_inside(Some(BinaryOp::Add), *op_span, span)
            }
            ExprKind::Update { increment, .. } => {
                let symbol = if *increment { "++" } else { "--" };
                Finding::error(rules::ASSIGN_INSIDE, span, format!("`{symbol}` inside an expression"))
                    .why("this text can only read a value")
                    .help(format!("change the variable in {}", self.host_terms().keeper))
            }
            _ => Finding::error(rules::MISPLACED, span, "this is not allowed inside an expression")
                .help("write a single value"),
        }
    }

    /// Whether an assignment in an expression stores a variable deliberately: `ctx.peak = Math.max(ctx.peak || 0, x)`. A choice or a
    /// plain number after `=` suggests a comparison.
    fn stores_variable(&self, target: &Expr, value: &Expr) -> bool {
        let is_variable = matches!(&target.kind, ExprKind::Member { object, .. } if matches!(&object.kind, ExprKind::Name(n) if n == "ctx"));
        let compares = matches!(
            value.kind,
            ExprKind::Conditional { .. }
                | ExprKind::Logical { .. }
                | ExprKind::Number(_)
                | ExprKind::String(_)
                | ExprKind::Boolean(_)
                | ExprKind::Null
        );
        self.mode == TextKind::Expression && is_variable && !compares
    }

    /// Binds both operands before it returns, so that an error in one does not hide an error in the other.
    #[inline(never)]
    fn both(&mut self, left: &'a Expr, right: &'a Expr) -> Attempt<(Ir, Ir)> {
        let left = self.operand(left);
        let right = self.operand(right);
        Ok((left?, right?))
    }

    pub(super) fn assignment_inside(&self, op: Option<BinaryOp>, op_span: Span, span: Span) -> Finding {
        if self.mode == TextKind::Expression && op.is_some() {
            return Finding::error(
                rules::EXPRESSION_ONLY,
                op_span,
                "an assignment is used where only a value is read",
            )
            .why("this text is an expression, which returns a value and changes nothing")
            .help(format!("assign in {}, and read the variable here", self.host_terms().statements));
        }
        let symbol = self.text(op_span);
        let report =
            Finding::error(rules::ASSIGN_INSIDE, op_span, format!("`{symbol}` assigns; it does not compare"));
        let report = match self.mode {
            TextKind::Statements => {
                report.why("it would change the value, although a test was probably meant")
            }
            _ => report
                .why(format!("this text can only read a value, but `{}` would change one", self.text(span))),
        };
        match op {
            None => report.help("write `===` to compare").guess(op_span, "==="),
            Some(_) => report.help("write the assignment as a statement of its own"),
        }
    }

    #[inline(never)]
    fn unary(&mut self, op: UnaryOp, operand: &'a Expr, span: Span) -> Attempt<Ir> {
        let ir = match op {
            UnaryOp::Not => self.test(operand)?,
            UnaryOp::TypeOf => self.value(operand)?,
            _ => self.operand(operand)?,
        };
        Ok(Ir::sign(op, ir, span))
    }

    /// Binds the operands of `==`, `+` and similar operators. Lists and records may be compared with `null`, with `undefined`
    /// and with each other, and `+` may join them with a string.
    #[inline(never)]
    fn comparable(&mut self, op: BinaryOp, left: &'a Expr, right: &'a Expr) -> Attempt<(Ir, Ir)> {
        let things = (self.entity(left), self.entity(right));
        let (left_thing, right_thing) = (things.0?, things.1?);
        let fine = |other: &Entity| match other {
            Entity::Value(ir) if op == BinaryOp::Add => ir.ty == Type::String,
            Entity::Value(ir) => matches!(ir.ty, Type::Null | Type::Undefined),
            _ => false,
        };
        let parts = |t: &Entity| match t {
            Entity::Value(ir) => ir.ty != Type::View && ir.ty.may_have_parts(),
            _ => false,
        };
        let loose = fine(&left_thing) || fine(&right_thing);
        let loose = loose || op != BinaryOp::Add && parts(&left_thing) && parts(&right_thing);
        let mut bind = |entity: Entity, span: Span| {
            if loose { self.value_of(entity, span) } else { self.operand_of(entity, span) }
        };
        let (a, b) = (bind(left_thing, left.span), bind(right_thing, right.span));
        Ok((a?, b?))
    }

    #[inline(never)]
    fn binary(&mut self, op: BinaryOp, left: &'a Expr, right: &'a Expr, span: Span) -> Attempt<Ir> {
        let (a, b) = if op.power() == 8 || op == BinaryOp::Add {
            self.comparable(op, left, right)?
        } else {
            self.both(left, right)?
        };
        Ok(Ir::binary(op, a, b, span))
    }
}
