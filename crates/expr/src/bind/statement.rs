//! Statements: declarations, effects, and expressions that change nothing.

use std::collections::BTreeSet;

use super::name::is_language;
use super::{Attempt, Binder, Local, Meaning, Thing};
use crate::ast::{BinaryOp, Declarator, Expr, ExprKind, Stmt, StmtKind};
use crate::code;
use crate::diagnostic::{Diagnostic, Span};
use crate::ir::{Ir, Kind, Step};
use crate::schema::Type;
use crate::value::Value;

impl Binder<'_> {
    /// Notes which names the text declares, and which it assigns again.
    pub(super) fn prepare(&mut self, statements: &[Stmt]) {
        let mut reassigned = BTreeSet::new();
        for statement in statements {
            match &statement.kind {
                StmtKind::Expr(expr) => assigned_names(expr, &mut reassigned),
                StmtKind::Declare { declarators, .. } => {
                    for declarator in declarators {
                        self.declared_later.push(declarator.name.text.clone());
                        if let Some(value) = &declarator.value {
                            assigned_names(value, &mut reassigned);
                        }
                    }
                }
                StmtKind::Error => {}
            }
        }
        self.reassigned = reassigned;
    }

    pub(super) fn statement(&mut self, statement: &Stmt, steps: &mut Vec<Step>) {
        match &statement.kind {
            StmtKind::Error => {}
            StmtKind::Expr(expr) => {
                if let Ok(Some(ir)) = self.effect(expr) {
                    steps.push(Step::Effect(ir));
                }
            }
            StmtKind::Declare { constant, declarators } => {
                for declarator in declarators {
                    self.declare(*constant, declarator, steps);
                }
            }
        }
    }

    /// An expression as a statement; nothing to run when it has no effect.
    fn effect(&mut self, expr: &Expr) -> Attempt<Option<Ir>> {
        match &expr.kind {
            ExprKind::Assign { target, op, value, .. } => {
                self.assign(target, *op, value, expr.span).map(Some)
            }
            ExprKind::Update { target, increment, .. } => {
                self.update(target, *increment, expr.span).map(Some)
            }
            ExprKind::Call { .. } | ExprKind::Name(_) | ExprKind::Member { .. } => {
                let ir = match self.thing(expr)? {
                    // The bare name of a function whose arguments are implied.
                    Thing::Function(id) if self.schema.function(id).implied => {
                        self.host_call(id, &[], expr.span, expr.span)?
                    }
                    Thing::Value(ir) if acts(&ir) => ir,
                    thing @ (Thing::Function(_) | Thing::MathFunction(_) | Thing::Method(..)) => {
                        let report = self.not_called(&thing, expr.span);
                        return self.refuse(report);
                    }
                    _ => {
                        self.unused(expr);
                        return Ok(None);
                    }
                };
                Ok(Some(ir))
            }
            // `test && call()` and `test ? call() : call()`: the last parts are statements of their own.
            ExprKind::Logical { op, left, right } => {
                let (test, act) = (self.value(left), self.effect(right));
                let test = test?;
                Ok(act?.map(|act| Ir::logical(*op, test, act, expr.span)))
            }
            ExprKind::Conditional { test, then, otherwise } => {
                let (test, then, otherwise) = (self.value(test), self.effect(then), self.effect(otherwise));
                let (test, then, otherwise) = (test?, then?, otherwise?);
                let nothing = || Ir::constant(Value::Undefined, expr.span);
                if then.is_none() && otherwise.is_none() {
                    return Ok(None);
                }
                let (then, otherwise) = (then.unwrap_or_else(nothing), otherwise.unwrap_or_else(nothing));
                Ok(Some(Ir::choice(test, then, otherwise, expr.span)))
            }
            _ => {
                let ir = self.value(expr)?;
                // A call in the middle of a computation acts all the same.
                if acts(&ir) {
                    return Ok(Some(ir));
                }
                self.unused(expr);
                Ok(None)
            }
        }
    }

    /// Warns of a statement that changes nothing.
    fn unused(&mut self, expr: &Expr) {
        let report = Diagnostic::warning(code::UNUSED_RESULT, expr.span, "this statement changes nothing")
            .why("its value is computed and dropped");
        let equality = |op: &BinaryOp| matches!(op, BinaryOp::Equal | BinaryOp::StrictEqual);
        let report = match &expr.kind {
            ExprKind::Binary { op, left, right } if equality(op) => {
                let meant = format!("{} = {}", self.text(left.span), self.text(right.span));
                report.help(format!("to assign, write `{meant}`")).fix(expr.span, meant)
            }
            _ => report.help(format!("assign it, as `ctx.x = {}`, or remove it", self.text(expr.span))),
        };
        self.report(report);
    }

    /// One name of a declaration.
    fn declare(&mut self, constant: bool, declarator: &Declarator, steps: &mut Vec<Step>) {
        let (name, span) = (&declarator.name.text, declarator.name.span);
        // From here on the name is known; the value itself cannot use it yet.
        let meaning = match &declarator.value {
            Some(value) => self.declared_meaning(name, constant, value, span, steps),
            None => {
                let undefined = Ir::constant(Value::Undefined, span);
                Ok(self.declared_value(name, undefined, steps))
            }
        };
        if let Some(i) = self.declared_later.iter().position(|n| n == name) {
            self.declared_later.remove(i);
        }
        let taken = self.locals.iter().any(|l| l.name == *name);
        if taken || is_language(name) || self.schema.root(name).is_some() {
            let why = if taken {
                "it is declared above"
            } else {
                "it already means something in every text of a lab"
            };
            self.report(
                Diagnostic::error(code::NAME_TAKEN, span, format!("`{name}` cannot be declared here"))
                    .why(format!("{why}; JavaScript refuses a second declaration"))
                    .help(if taken {
                        "assign it without `const` or `let`, or choose another name"
                    } else {
                        "choose another name"
                    }),
            );
            return;
        }
        let meaning = meaning.unwrap_or(Meaning::Unknown);
        self.locals.push(Local { name: name.clone(), constant, meaning });
    }

    fn declared_meaning(
        &mut self,
        name: &str,
        constant: bool,
        value: &Expr,
        span: Span,
        steps: &mut Vec<Step>,
    ) -> Attempt<Meaning> {
        if let ExprKind::Assign { target, op, value, .. } = &value.kind {
            let ir = self.assign(target, *op, value, span)?;
            return Ok(self.declared_value(name, ir, steps));
        }
        let thing = match self.thing(value)? {
            Thing::Field(field) if !field.is_scalar() => Thing::Field(field),
            single @ (Thing::Value(_) | Thing::Field(_)) => {
                let ir = self.value_of(single, value.span)?;
                return Ok(self.declared_value(name, ir, steps));
            }
            other => other,
        };
        if !constant && self.reassigned.contains(name) {
            return self.refuse(
                Diagnostic::error(
                    code::NOT_A_VALUE,
                    value.span,
                    format!("`{}` is not a value that `{name}` can hold and change", self.text(value.span)),
                )
                .why("a name for a part of the simulation means that part for good")
                .help(format!("declare it with `const {name}`, and use another name for the number")),
            );
        }
        Ok(Meaning::Alias(thing))
    }

    /// A name that holds a value.
    fn declared_value(&mut self, name: &str, value: Ir, steps: &mut Vec<Step>) -> Meaning {
        let fixed = !self.reassigned.contains(name);
        let ty = if fixed { value.ty } else { Type::Any };
        // Numbers of locals are those of the steps that declare them, so no two are the same.
        let local = steps.len() as u32;
        steps.push(Step::Declare { local, fixed, value });
        Meaning::Slot(local, ty)
    }
}

/// Whether computing this does something.
fn acts(ir: &Ir) -> bool {
    match &ir.kind {
        Kind::Call(..) | Kind::Store(..) | Kind::Fill(..) | Kind::StoreAll(..) => true,
        Kind::Not(a) | Kind::BitNot(a) | Kind::Negate(a) | Kind::ToNumber(a) => acts(a),
        Kind::Binary(_, a, b) | Kind::Logical(_, a, b) => acts(a) || acts(b),
        Kind::Choice(a, b, c) => acts(a) || acts(b) || acts(c),
        Kind::Math(_, args) => args.iter().any(acts),
        _ => false,
    }
}

/// Names that an expression assigns, as far as assignments are allowed: one after the other.
fn assigned_names(expr: &Expr, names: &mut BTreeSet<String>) {
    let target = match &expr.kind {
        ExprKind::Assign { target, value, .. } => {
            assigned_names(value, names);
            target
        }
        ExprKind::Update { target, .. } => target,
        _ => return,
    };
    if let ExprKind::Name(name) = &target.kind {
        names.insert(name.clone());
    }
}
