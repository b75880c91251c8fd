//! Statements: declarations, effects, conditionals, and expressions without an effect.

use super::binder::{Binder, Entity, VariableMeaning};
use crate::ast::{Declarator, Expr, ExprKind, Name, Pattern, Stmt, StmtKind};
use crate::bind::source::TextKind;
use crate::ir::{Ir, IrEntry, IrItem, IrKind, IrStatement};
use crate::parse::Attempt;
use crate::rules;
use crate::types::Type;
use crate::value::Value;
use labspec_finding::{Finding, Span};

impl<'a> Binder<'a> {
    pub(super) fn statement(&mut self, statement: &'a Stmt, steps: &mut Vec<IrStatement>) {
        let span = statement.span;
        match &statement.kind {
            StmtKind::Error | StmtKind::Empty | StmtKind::Function { .. } => {}
            StmtKind::Expr(expr) => self.effect_into(expr, steps),
            StmtKind::Declare { constant, declarators } => {
                for declarator in declarators {
                    self.declare(*constant, declarator, steps);
                }
            }
            StmtKind::If { test, then, otherwise } => {
                let test = self.test(test);
                self.guards += 1;
                let then = self.scoped(then);
                let otherwise = otherwise.as_ref().map(|s| self.scoped(s)).unwrap_or_default();
                self.guards -= 1;
                // A jump in one branch makes the following statements conditional.
                if jumps(&then) || jumps(&otherwise) {
                    self.guards += 1;
                }
                let Ok(test) = test else { return };
                match test.as_constant().filter(|v| !v.is_nan()).map(Value::truthy) {
                    Some(true) => steps.extend(then),
                    Some(false) => steps.extend(otherwise),
                    None => steps.push(IrStatement::If(test, then, otherwise)),
                }
            }
            StmtKind::For { init, test, update, body } => {
                self.for_loop(init.as_deref(), test.as_ref(), update.as_ref(), body, span, steps);
            }
            StmtKind::ForOf { target, items, body, .. } => {
                self.for_of(target, items, body, span, steps);
            }
            StmtKind::While { test, body } => self.while_loop(test, body, false, span, steps),
            StmtKind::DoWhile { test, body } => self.while_loop(test, body, true, span, steps),
            StmtKind::Block(statements) => {
                let inside = self.block(statements);
                steps.extend(inside);
            }
            StmtKind::Break | StmtKind::Continue => {
                let word = if statement.kind == StmtKind::Break { "break" } else { "continue" };
                if self.loops == 0 {
                    self.report(
                        Finding::error(rules::OUTSIDE_LOOP, span, format!("`{word}` is outside a loop"))
                            .why("there is no loop to leave or to continue")
                            .help("remove it, or leave a function with `return`"),
                    );
                    return;
                }
                self.guards += 1;
                steps.push(if word == "break" { IrStatement::Break } else { IrStatement::Continue });
            }
            StmtKind::Return(value) => self.leave_function(value.as_ref(), span, steps),
        }
    }

    fn leave_function(&mut self, value: Option<&'a Expr>, span: Span, steps: &mut Vec<IrStatement>) {
        let ir = match value {
            None => Ok(Ir::undefined(span)),
            Some(value) => self.value(value),
        };
        self.guards += 1;
        let Ok(ir) = ir else { return };
        if let Some(key) = self.returns.last().copied() {
            self.facts.widen(key, ir.ty);
        }
        steps.push(IrStatement::Return(ir));
    }

    /// Binds a condition.
    pub(super) fn test(&mut self, test: &'a Expr) -> Attempt<Ir> {
        if let ExprKind::Assign { op, op_span, .. } = &test.kind {
            let report = self.assignment_inside(*op, *op_span, test.span);
            return self.refuse(report);
        }
        let entity = self.entity(test)?;
        if let Entity::Field(field) = &entity
            && !field.is_scalar()
        {
            let report = self.whole_array(field, test.span);
            return self.refuse(report);
        }
        self.value_of(entity, test.span)
    }

    /// Binds an expression used as a statement. An expression without an effect adds no step.
    pub(super) fn effect_into(&mut self, expr: &'a Expr, steps: &mut Vec<IrStatement>) {
        if let ExprKind::Sequence(parts) = &expr.kind {
            return parts.iter().for_each(|part| self.effect_into(part, steps));
        }
        if let Ok(Some(ir)) = self.effect(expr) {
            steps.push(IrStatement::Effect(ir));
        }
    }

    fn effect(&mut self, expr: &'a Expr) -> Attempt<Option<Ir>> {
        match &expr.kind {
            ExprKind::Assign { .. } | ExprKind::AssignLogical { .. } | ExprKind::Update { .. } => {
                self.changing(expr).map(Some)
            }
            ExprKind::Call { .. } | ExprKind::Name(_) | ExprKind::Member { .. } => {
                let ir = match self.entity(expr)? {
                    // The name alone of a function whose arguments are implied is a call.
                    Entity::Function(id) if self.schema.function(id).implied => {
                        self.host_call(id, &[], expr.span, expr.span)?
                    }
                    Entity::Value(ir) if may_have_effect(&ir) => ir,
                    entity @ (Entity::Function(_)
                    | Entity::MathFunction(_)
                    | Entity::Method(..)
                    | Entity::Closure(_)) => {
                        let report = self.not_called(&entity, expr.span);
                        return self.refuse(report);
                    }
                    _ => {
                        self.record_idle(expr.span);
                        return Ok(None);
                    }
                };
                Ok(Some(ir))
            }
            // In `test && call()` and `test ? call() : call()`, the last operands are treated as statements.
            ExprKind::Logical { op, left, right } => {
                let (test, act) = (self.value(left), self.effect(right));
                let test = test?;
                Ok(act?.map(|act| Ir::logical(*op, test, as_value(act), expr.span)))
            }
            ExprKind::Conditional { test, then, otherwise } => {
                let (test, then, otherwise) = (self.test(test), self.effect(then), self.effect(otherwise));
                let (test, then, otherwise) = (test?, then?, otherwise?);
                let nothing = || Ir::undefined(expr.span);
                if then.is_none() && otherwise.is_none() {
                    return Ok(None);
                }
                let (then, otherwise) = (then.unwrap_or_else(nothing), otherwise.unwrap_or_else(nothing));
                Ok(Some(Ir::choice(test, as_value(then), as_value(otherwise), expr.span)))
            }
            _ => {
                let ir = self.value(expr)?;
                // A call inside a computation still has an effect.
                if may_have_effect(&ir) {
                    return Ok(Some(ir));
                }
                self.record_idle(expr.span);
                Ok(None)
            }
        }
    }

    /// Binds `name = value` of a declaration, or a pattern.
    fn declare(&mut self, constant: bool, declarator: &'a Declarator, steps: &mut Vec<IrStatement>) {
        match (&declarator.target, &declarator.value) {
            (Pattern::Name(name), Some(value)) => match self.declared(name, constant, value, steps) {
                Ok(Some(entity)) => self.mark_declared(name, VariableMeaning::Alias(entity)),
                Ok(None) => {}
                Err(_) => self.mark_declared(name, VariableMeaning::Unknown),
            },
            (Pattern::Name(name), None) => {
                let value = Ir::undefined(name.span);
                self.initialize(name, value, steps);
            }
            (pattern, Some(value)) => self.destructure(pattern, value, steps),
            (pattern, None) => self.mark_unbound(pattern),
        }
    }

    /// Returns the entity for which a declared name is an alias, or `None` if the name stores a value.
    fn declared(
        &mut self,
        name: &'a Name,
        constant: bool,
        value: &'a Expr,
        steps: &mut Vec<IrStatement>,
    ) -> Attempt<Option<Entity>> {
        if let ExprKind::Assign { .. } | ExprKind::AssignLogical { .. } = &value.kind {
            let ir = self.changing(value)?;
            self.initialize(name, ir, steps);
            return Ok(None);
        }
        let changes = !constant && self.assignments(self.key_of(name)) > 0;
        let entity = match self.entity(value)? {
            alias @ (Entity::Field(_) | Entity::Closure(_) | Entity::Native(_) | Entity::MathFunction(_))
                if !changes && !matches!(&alias, Entity::Field(f) if f.is_scalar()) =>
            {
                return Ok(Some(alias));
            }
            Entity::Function(id) if !changes && self.is_plain_function(id) => {
                return Ok(Some(Entity::Function(id)));
            }
            single @ (Entity::Value(_) | Entity::Field(_) | Entity::Closure(_)) => {
                let ir = self.value_of(single, value.span)?;
                self.initialize(name, ir, steps);
                return Ok(None);
            }
            other => other,
        };
        if changes {
            return self.refuse(
                Finding::error(
                    rules::NOT_A_VALUE,
                    value.span,
                    format!(
                        "`{}` is not a value that `{}` can store and change",
                        self.text(value.span),
                        name.text
                    ),
                )
                .why(format!("a name for a part of the {} always means that part", self.host_terms().world))
                .help(format!("declare it with `const {}`, and use another name for the number", name.text)),
            );
        }
        Ok(Some(entity))
    }

    /// Whether the program only reads values.
    pub(super) fn only_reads(&self) -> bool {
        self.mode != TextKind::Statements
    }
}

/// The value of a call that is evaluated for its effect.
fn as_value(ir: Ir) -> Ir {
    if ir.ty == Type::Void { Ir { ty: Type::Undefined, ..ir } } else { ir }
}

/// Whether statements may jump out of their block.
fn jumps(steps: &[IrStatement]) -> bool {
    steps.iter().any(|step| match step {
        IrStatement::Return(_) | IrStatement::Break | IrStatement::Continue => true,
        IrStatement::If(_, then, otherwise) => jumps(then) || jumps(otherwise),
        _ => false,
    })
}

/// Whether evaluating the expression has, or may have, an effect.
fn may_have_effect(ir: &Ir) -> bool {
    let any = |items: &[IrItem]| items.iter().any(|i| may_have_effect(&i.value));
    match &ir.kind {
        IrKind::Call(..)
        | IrKind::Store(..)
        | IrKind::StoreIf(..)
        | IrKind::Update(..)
        | IrKind::Fill(..)
        | IrKind::StoreAll(..)
        | IrKind::Invoke(..)
        | IrKind::InvokeValue(..)
        | IrKind::Block(..) => true,
        IrKind::Method(name, object, args) => {
            name.rows().any(|r| r.changes) || may_have_effect(object) || any(args)
        }
        IrKind::Native(function, args) => function.row().name == "_empty" || any(args),
        IrKind::Unary(_, a) | IrKind::ToNumber(a) | IrKind::ToText(a) | IrKind::TypeOf(a) => {
            may_have_effect(a)
        }
        IrKind::Chain(a)
        | IrKind::Present(a)
        | IrKind::Pick(_, a)
        | IrKind::GlobalNamed(a)
        | IrKind::Member(a, _) => may_have_effect(a),
        IrKind::MathOver(_, a) => may_have_effect(a),
        IrKind::Binary(_, a, b) | IrKind::Logical(_, a, b) | IrKind::Element(a, b) => {
            may_have_effect(a) || may_have_effect(b)
        }
        IrKind::Choice(a, b, c) => may_have_effect(a) || may_have_effect(b) || may_have_effect(c),
        IrKind::Math(_, args) => args.iter().any(may_have_effect),
        IrKind::List(items) => any(items),
        IrKind::Record(entries) => entries.iter().any(|e| match e {
            IrEntry::Named(_, v) | IrEntry::Spread(v) => may_have_effect(v),
            IrEntry::Computed(k, v) => may_have_effect(k) || may_have_effect(v),
        }),
        _ => false,
    }
}
