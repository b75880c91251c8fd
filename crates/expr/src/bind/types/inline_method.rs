//! Calls of methods that are written in the language itself: they are bound as if their source text were inlined at the
//! call. Their variables are separate from those of the caller. A mistake inside is reported at the call, described in
//! words.

use std::sync::OnceLock;

use super::binder::{Binder, Entity, InlineSite, VariableMeaning};
use super::facts::FactKind;
use crate::ast::{Body, Expr, Function, Name, Pattern};
use crate::bind::names::{NameContext, NameTable, resolve};
use crate::bind::source::TextKind;
use crate::globals::Globals;
use crate::ir::{Ir, IrKind, IrStatement, always_return};
use crate::natives::{self, Native};
use crate::parse::{Attempt, Reported};
use crate::schema::Param;
use crate::source_functions::source_functions;
use crate::types::{FunctionId, Type};
use labspec_finding::Span;

/// The resolved names of a function that is written in the language.
fn names_of(function: &Function) -> &'static NameTable {
    static NAMES: OnceLock<Vec<(&'static Function, NameTable)>> = OnceLock::new();
    static NONE: OnceLock<NameTable> = OnceLock::new();
    let all = NAMES.get_or_init(|| source_functions().map(|f| (f, resolved(f))).collect());
    let found = all.iter().find(|(f, _)| std::ptr::eq(*f, function));
    found.map_or_else(|| NONE.get_or_init(NameTable::default), |(_, names)| names)
}

fn resolved(function: &'static Function) -> NameTable {
    let globals = Globals::new();
    let around =
        NameContext { schema: None, globals: &globals, mode: TextKind::Statements, has_value: false };
    resolve(around, |walk| walk.inside(function)).0
}

impl<'a> Binder<'a> {
    /// Binds a method that is written in the language as if its text were here.
    pub(super) fn inline_method(
        &mut self,
        function: &'a Function,
        row: &'static Native,
        first: Entity,
        args: &'a [Expr],
        span: Span,
    ) -> Attempt<Ir> {
        let mut things = vec![Ok(first)];
        for (i, arg) in args.iter().enumerate() {
            let entity = self.argument_entity(arg);
            // The function comes first among the arguments.
            let calls = match &entity {
                Ok(Entity::Value(ir)) => matches!(ir.ty, Type::Function | Type::Any | Type::Never),
                _ => true,
            };
            if i == 0 && !calls {
                let report = self.needs_function(row, arg.span);
                return self.refuse(report);
            }
            things.push(entity);
        }
        let things = things.into_iter().collect::<Attempt<Vec<Entity>>>()?;
        let Body::Block(statements) = &function.body else { return Err(Reported) };
        let functions = self.functions.len();
        // A text has fewer than 65,536 bytes, so that the id of a call inside a written method includes that of the call
        // around it.
        let (id, call) = match self.site {
            Some(outer) => (outer.id << 16 | span.end, outer.call),
            None => (span.end, span),
        };
        let site = InlineSite { id, call, row, names: names_of(function) };
        let outer = (self.site.replace(site), self.guards);
        self.guards += 1;
        let mut steps = Vec::new();
        for (param, entity) in function.params.iter().zip(things) {
            let Pattern::Name(name) = &param.target else { continue };
            self.declare_variable(name);
            self.give_entity(name, entity, &mut steps);
        }
        let key = self.key(function.span.start, FactKind::Result);
        self.returns.push(key);
        let loops = std::mem::take(&mut self.loops);
        let body = self.block(statements);
        self.loops = loops;
        self.returns.pop();
        if !always_return(&body) {
            self.facts.widen(key, Type::Undefined);
        }
        let result = self.new_local(key, false);
        let ty = self.facts.ty(key);
        self.leave(functions);
        (self.site, self.guards) = outer;
        steps.push(IrStatement::Inline(result, body, span));
        let value = Ir::new(IrKind::Local(result), ty, span);
        Ok(Ir::new(IrKind::Block(steps, Box::new(value)), ty, span))
    }

    /// Binds an argument of such a method; a function remains statically known.
    fn argument_entity(&mut self, arg: &'a Expr) -> Attempt<Entity> {
        match self.entity(arg)? {
            closure @ Entity::Closure(_) => Ok(closure),
            function @ (Entity::MathFunction(_) | Entity::Native(_)) => Ok(function),
            Entity::Function(id) if self.is_plain_function(id) => Ok(Entity::Function(id)),
            // `Number` is both a function and a namespace.
            Entity::Namespace(name) => match natives::find_function(name) {
                Some(function) => Ok(Entity::Native(function)),
                None => self.value_of(Entity::Namespace(name), arg.span).map(Entity::Value),
            },
            other => self.value_of(other, arg.span).map(Entity::Value),
        }
    }

    /// Whether the arguments of a function of the host are values, so that it may be called by another name.
    pub(super) fn is_plain_function(&self, id: FunctionId) -> bool {
        let info = self.schema.function(id);
        !info.aggregate && !info.params.iter().any(|p| matches!(p, Param::Object(_)))
    }

    /// Binds a parameter of a written method: an entity that needs no storage becomes an alias.
    fn give_entity(&mut self, name: &Name, entity: Entity, steps: &mut Vec<IrStatement>) {
        match entity {
            Entity::Value(ir) => self.initialize(name, ir, steps),
            other => self.mark_declared(name, VariableMeaning::Alias(other)),
        }
    }
}
