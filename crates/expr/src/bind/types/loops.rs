//! Loops, and the known ranges of their counters.

use super::access::{past_the_end, range};
use super::binder::{Binder, Entity};
use super::facts::FactKind;
use super::member::view_of;
use crate::ast::{BinaryOp, Expr, ExprKind, Name, Pattern, Stmt, StmtKind};
use crate::bind::names::{Declaration, names_of};
use crate::ir::{AssignmentTarget, Index, Ir, IrItem, IrKind, IrLoop, IrStatement, LocalId, UpdateResult};
use crate::parse::{Attempt, Reported};
use crate::rules;
use crate::schema::Field;
use crate::types::Type;
use crate::value::Value;
use crate::{natives, number};
use labspec_finding::{Finding, Span};

impl<'a> Binder<'a> {
    /// Binds `for (init; test; update) body`.
    pub(super) fn for_loop(
        &mut self,
        init: Option<&'a Stmt>,
        test: Option<&'a Expr>,
        update: Option<&'a Expr>,
        body: &'a Stmt,
        span: Span,
        steps: &mut Vec<IrStatement>,
    ) {
        let functions = self.functions.len();
        let mut names: Vec<&Name> = Vec::new();
        if let Some(init) = init {
            if let StmtKind::Declare { declarators, .. } = &init.kind {
                for d in declarators {
                    self.hoist_pattern(&d.target, steps);
                    names_of(&d.target, &mut |name| names.push(name));
                }
            }
            self.statement(init, steps);
        }
        let test = test.and_then(|t| self.test(t).ok());
        let counted = self.counted(&names, steps.last(), test.as_ref(), update);
        let guards = self.guards;
        if counted {
            self.guards = 0;
        } else {
            self.guards += 1;
        }
        let inside = self.body_of_loop(body);
        self.guards = guards;
        let mut after = Vec::new();
        for name in names {
            let key = self.key_of(name);
            if let Some(variable) = self.variables.get(&key)
                && self.declaration(key).is_some_and(Declaration::is_shared)
            {
                after.push(IrStatement::Renew(variable.id));
            }
        }
        if let Some(update) = update {
            self.effect_into(update, &mut after);
        }
        steps.push(IrStatement::Loop(Box::new(IrLoop {
            test,
            late: false,
            body: inside,
            update: after,
            span,
        })));
        self.leave(functions);
    }

    pub(super) fn while_loop(
        &mut self,
        test: &'a Expr,
        body: &'a Stmt,
        late: bool,
        span: Span,
        steps: &mut Vec<IrStatement>,
    ) {
        let bound = self.test(test);
        self.guards += 1;
        let inside = self.body_of_loop(body);
        self.guards -= 1;
        if let Ok(ir) = bound {
            if ir.as_constant().is_some_and(Value::truthy) && !leaves(&inside) {
                self.report(
                    Finding::error(rules::BUDGET, test.span, "this loop never ends")
                        .why("its condition is always true, and nothing in it leaves the loop")
                        .help("write a condition that becomes false, or leave the loop with `break`"),
                );
            }
            steps.push(IrStatement::Loop(Box::new(IrLoop {
                test: Some(ir),
                late,
                body: inside,
                update: Vec::new(),
                span,
            })));
        }
    }

    /// Binds `for (const target of items) body`.
    pub(super) fn for_of(
        &mut self,
        target: &'a Pattern,
        items: &'a Expr,
        body: &'a Stmt,
        span: Span,
        steps: &mut Vec<IrStatement>,
    ) {
        let list = self.entity(items);
        let functions = self.functions.len();
        // The list and the counter of the loop are stored in unnamed local variables.
        let counter = self.unnamed_local(span, FactKind::Counter, Type::Number);
        let read_counter = Ir::new(IrKind::Local(counter), Type::Number, items.span);
        let elements = match list {
            Ok(Entity::Field(field)) if !field.is_scalar() => {
                Ok(self.elements_of_field(&field, &read_counter, items.span))
            }
            Ok(entity) => self.elements_of_value(entity, &read_counter, items.span, span, steps),
            Err(Reported) => Err(Reported),
        };
        let Ok((length, item)) = elements else { return self.dead_loop(target, body, functions) };
        let mut turn = Vec::new();
        steps.push(IrStatement::Declare(counter, Ir::number(0.0, items.span)));
        let test = Ir::binary(BinaryOp::Less, read_counter, length, items.span);
        self.hoist_pattern(target, &mut turn);
        match target {
            Pattern::Name(name) => self.initialize(name, item, &mut turn),
            pattern => {
                let whole = self.store_in_temporary(item, pattern.span(), &mut turn);
                self.destructure_value(pattern, whole, &mut turn);
            }
        }
        self.guards += 1;
        turn.extend(self.body_of_loop(body));
        self.guards -= 1;
        let one_more = IrKind::Update(Box::new(AssignmentTarget::Local(counter)), 1.0, UpdateResult::New);
        let update = vec![IrStatement::Effect(Ir::new(one_more, Type::Number, items.span))];
        steps.push(IrStatement::Loop(Box::new(IrLoop {
            test: Some(test),
            late: false,
            body: turn,
            update,
            span,
        })));
        self.leave(functions);
    }

    /// A local variable without a name in the source text.
    fn unnamed_local(&mut self, span: Span, what: FactKind, ty: Type) -> LocalId {
        let key = self.key(span.start, what);
        self.facts.widen(key, ty);
        self.new_local(key, false)
    }

    /// The number of elements of an array of the host, and its element at the counter of a loop.
    fn elements_of_field(&mut self, field: &Field, counter: &Ir, span: Span) -> (Ir, Ir) {
        let length = match field.len() {
            Some(n) => Ir::number(n as f64, span),
            None => Ir::new(IrKind::Length(view_of(field)), Type::Number, span),
        };
        let index = Index::Computed(Box::new(counter.clone()));
        let fixed = field.len().is_some();
        let mut item = self.load(field, index, span);
        // The counter stays below the length, so the element exists.
        item.ty = if fixed { Type::Number } else { item.ty };
        (length, item)
    }

    /// The same for any other list, which is stored in a local variable.
    fn elements_of_value(
        &mut self,
        list: Entity,
        counter: &Ir,
        span: Span,
        site: Span,
        steps: &mut Vec<IrStatement>,
    ) -> Attempt<(Ir, Ir)> {
        let value = self.value_of(list, span)?;
        self.expect_elements(&value)?;
        // A string is split into its characters, some of which take two UTF-16 units.
        let function = natives::find_function("_parts");
        let value = match (value.ty, function) {
            (Type::List | Type::View, _) | (_, None) => value,
            (_, Some(function)) => {
                let whole = IrItem { value, spread: false };
                Ir::new(IrKind::Native(function, vec![whole]), Type::List, span)
            }
        };
        let ty = value.ty;
        let list = self.unnamed_local(site, FactKind::List, ty);
        steps.push(IrStatement::Declare(list, value));
        let list = Ir::new(IrKind::Local(list), ty, span);
        let length = Ir::new(IrKind::Member(Box::new(list.clone()), "length".into()), Type::Number, span);
        let element = if ty == Type::View { Type::Element } else { Type::Any };
        let item = IrKind::Element(Box::new(list), Box::new(counter.clone()));
        Ok((length, Ir::new(item, element, span)))
    }

    /// Binds a loop over an invalid value: its body may contain further errors.
    fn dead_loop(&mut self, target: &'a Pattern, body: &'a Stmt, functions: usize) {
        self.hoist_pattern(target, &mut Vec::new());
        self.mark_unbound(target);
        self.body_of_loop(body);
        self.leave(functions);
    }

    fn body_of_loop(&mut self, body: &'a Stmt) -> Vec<IrStatement> {
        self.loops += 1;
        let steps = self.scoped(body);
        self.loops -= 1;
        steps
    }

    /// Binds a statement with its own scope.
    pub(super) fn scoped(&mut self, statement: &'a Stmt) -> Vec<IrStatement> {
        match &statement.kind {
            StmtKind::Block(statements) => self.block(statements),
            _ => self.block(std::slice::from_ref(statement)),
        }
    }

    /// Whether the loop counts its own variable up to a known bound. If so, the range of the variable is recorded.
    fn counted(
        &mut self,
        names: &[&Name],
        init: Option<&IrStatement>,
        test: Option<&Ir>,
        update: Option<&Expr>,
    ) -> bool {
        let ([name], Some(IrStatement::Declare(id, start))) = (names, init) else { return false };
        let counts = |e: &Expr| matches!(&e.kind, ExprKind::Name(n) if *n == name.text);
        let single = match update.map(|u| &u.kind) {
            Some(ExprKind::Update { target, increment: true, .. }) if counts(target) => true,
            Some(ExprKind::Assign { target, op: Some(BinaryOp::Add), value, .. })
                if counts(target) && matches!(value.kind, ExprKind::Number(x) if x >= 1.0) =>
            {
                false
            }
            _ => return false,
        };
        let Some(IrKind::Binary(op @ (BinaryOp::Less | BinaryOp::LessEqual), left, right)) =
            test.map(|t| &t.kind)
        else {
            return false;
        };
        // Only the update assigns the counter: an assignment in the body would be a second one.
        let key = self.key_of(name);
        if !matches!(left.kind, IrKind::Local(counter) if counter == *id) || self.assignments(key) > 1 {
            return false;
        }
        let (Some((least, _)), Some((_, bound))) = (self.range_of(start), self.range_of(right)) else {
            return false;
        };
        let most = if *op == BinaryOp::Less { (bound - 1.0).ceil() } else { bound.floor() };
        let whole = least.fract() == 0.0 && least.is_finite() && most.is_finite();
        if whole && let Some(variable) = self.variables.get_mut(&key) {
            variable.range = Some((least, most.max(least)));
        }
        // A step larger than 1 may skip the last value; an empty loop executes nothing.
        whole && single && most >= least
    }

    /// The smallest and the largest value of a number, if known.
    pub(super) fn range_of(&self, ir: &Ir) -> Option<(f64, f64)> {
        match &ir.kind {
            IrKind::Constant(Value::Number(x)) => Some((*x, *x)),
            IrKind::Local(id) => self.variables.get(self.keys.get(*id as usize)?)?.range,
            IrKind::Binary(op, a, b) => {
                let ((a0, a1), (b0, b1)) = (self.range_of(a)?, self.range_of(b)?);
                let range = match op {
                    BinaryOp::Add => (a0 + b0, a1 + b1),
                    BinaryOp::Subtract => (a0 - b1, a1 - b0),
                    BinaryOp::Multiply => {
                        let all = [a0 * b0, a0 * b1, a1 * b0, a1 * b1];
                        all.iter()
                            .fold((f64::INFINITY, f64::NEG_INFINITY), |(l, m), x| (l.min(*x), m.max(*x)))
                    }
                    _ => return None,
                };
                (range.0.is_finite() && range.1.is_finite()).then_some(range)
            }
            _ => None,
        }
    }

    /// Refuses an index that is out of range in the last iteration of a loop, if nothing in the loop prevents this.
    pub(super) fn check_range(&mut self, field: &Field, index: &Ir) -> Attempt<()> {
        let (Some((least, most)), Some(n)) = (self.range_of(index), field.len()) else { return Ok(()) };
        if self.guards > 0 || self.site.is_some() {
            return Ok(());
        }
        if most >= n as f64 {
            let index_text = number::to_text(most);
            let text = self.text(index.span);
            let message = format!(
                "in the last iteration of the loop, `{text}` is {index_text}: past the end of `{}`",
                field.path
            );
            return self.refuse(past_the_end(field, index.span, message, self.host_terms()));
        }
        if least < 0.0 {
            let index_text = number::to_text(least);
            return self.refuse(
                Finding::error(
                    rules::INDEX_NEGATIVE,
                    index.span,
                    format!(
                        "in the loop, `{}` becomes {index_text}, which is negative",
                        self.text(index.span)
                    ),
                )
                .why("indexes start at 0; JavaScript gives `undefined` here")
                .help(format!("indexes of `{}` are{}", field.path, range(field))),
            );
        }
        Ok(())
    }
}

/// Whether statements may leave the loop that contains them.
fn leaves(steps: &[IrStatement]) -> bool {
    steps.iter().any(|step| match step {
        IrStatement::Break | IrStatement::Return(_) => true,
        IrStatement::If(_, then, otherwise) => leaves(then) || leaves(otherwise),
        IrStatement::Loop(inner) => returns(&inner.body),
        _ => false,
    })
}

fn returns(steps: &[IrStatement]) -> bool {
    steps.iter().any(|step| match step {
        IrStatement::Return(_) => true,
        IrStatement::If(_, then, otherwise) => returns(then) || returns(otherwise),
        IrStatement::Loop(inner) => returns(&inner.body),
        _ => false,
    })
}
