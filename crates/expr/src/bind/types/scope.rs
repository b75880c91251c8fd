//! Variables: their storage, the functions that capture them, and their meanings.

use super::binder::{Binder, Entity, Variable, VariableMeaning};
use super::facts::{FactKey, FactKind};
use crate::ast::{Declarator, Name, Pattern, Stmt, StmtKind};
use crate::bind::names::{Declaration, NameMeaning, names_of};
use crate::ir::{Ir, IrKind, IrStatement, Local, LocalId};
use crate::parse::{Attempt, Reported};
use crate::rules;
use crate::types::Type;
use labspec_finding::{Finding, Span};

impl<'a> Binder<'a> {
    /// The key of a declaration at a byte.
    pub(super) fn key(&self, offset: usize, what: FactKind) -> FactKey {
        FactKey { site: self.site.map_or(0, |site| site.id), offset, what }
    }

    /// The key of a variable.
    pub(super) fn key_of(&self, name: &Name) -> FactKey {
        self.key(name.span.start, FactKind::Name)
    }

    /// The result of the first pass for a declaration.
    pub(super) fn declaration(&self, key: FactKey) -> Option<&'a Declaration> {
        self.site.map_or(self.names, |site| site.names).declared(key.offset)
    }

    /// The number of assignments to a variable after its declaration.
    pub(super) fn assignments(&self, key: FactKey) -> usize {
        self.declaration(key).map_or(0, |declared| declared.assigned)
    }

    /// Binds statements with their own scope.
    pub(super) fn block(&mut self, statements: &'a [Stmt]) -> Vec<IrStatement> {
        let functions = self.functions.len();
        let mut steps = Vec::new();
        self.hoist(statements, &mut steps);
        for statement in statements {
            self.statement(statement, &mut steps);
        }
        self.leave(functions);
        steps
    }

    /// Closes a block. Functions that were never called are bound to report their errors.
    pub(super) fn leave(&mut self, functions: usize) {
        for i in functions..self.functions.len() {
            if self.functions.get(i).is_some_and(|k| k.unit.is_none()) {
                self.bind_with_anything(i);
            }
        }
    }

    /// Gives the names of a block their storage; functions can be called from the start of the block.
    fn hoist(&mut self, statements: &'a [Stmt], steps: &mut Vec<IrStatement>) {
        for statement in statements {
            match &statement.kind {
                StmtKind::Declare { declarators, .. } => {
                    for Declarator { target, .. } in declarators {
                        self.hoist_pattern(target, steps);
                    }
                }
                StmtKind::Function { name, .. } => self.hoist_name(name, steps),
                _ => {}
            }
        }
        for statement in statements {
            if let StmtKind::Function { name, function } = &statement.kind {
                let entity = self.new_function(function);
                self.mark_declared(name, VariableMeaning::Alias(entity));
            }
        }
    }

    pub(super) fn hoist_pattern(&mut self, pattern: &'a Pattern, steps: &mut Vec<IrStatement>) {
        names_of(pattern, &mut |name| self.hoist_name(name, steps));
    }

    fn hoist_name(&mut self, name: &Name, steps: &mut Vec<IrStatement>) {
        if self.declaration(self.key_of(name)).is_none() {
            return; // it could not be declared
        }
        let id = self.declare_variable(name);
        if self.tree.locals.get(id as usize).is_some_and(|l| l.shared) {
            steps.push(IrStatement::Reserve(id));
        }
    }

    /// Declares a name; its declaration has not been executed yet.
    pub(super) fn declare_variable(&mut self, name: &Name) -> LocalId {
        let key = self.key_of(name);
        let declared = self.declaration(key);
        if declared.is_some_and(Declaration::joins) {
            self.facts.join(key);
        }
        let id = self.new_local(key, declared.is_some_and(Declaration::is_shared));
        let variable = Variable {
            key,
            id,
            unit: self.unit,
            ready: false,
            meaning: VariableMeaning::Unknown,
            range: None,
        };
        self.variables.insert(key, variable);
        id
    }

    /// Adds a local variable. Its type is known at the end of the round.
    pub(super) fn new_local(&mut self, key: FactKey, shared: bool) -> LocalId {
        self.tree.locals.push(Local { ty: Type::Never, shared });
        self.keys.push(key);
        (self.tree.locals.len() - 1) as LocalId
    }

    /// Records that the declaration of a name has been executed.
    pub(super) fn mark_declared(&mut self, name: &Name, meaning: VariableMeaning) {
        let key = self.key_of(name);
        if let Some(variable) = self.variables.get_mut(&key) {
            variable.ready = true;
            variable.meaning = meaning;
        }
    }

    /// Gives a declared name its value, and adds the step that stores it.
    pub(super) fn initialize(&mut self, name: &Name, value: Ir, steps: &mut Vec<IrStatement>) {
        let key = self.key_of(name);
        let changes = self.assignments(key) > 0;
        self.facts.widen(key, value.ty);
        let Some(variable) = self.variables.get_mut(&key) else {
            steps.push(IrStatement::Effect(value)); // a name that could not be declared
            return;
        };
        variable.ready = true;
        // A name for a constant that is never reassigned becomes an alias for the constant.
        if value.as_constant().is_some() && !changes {
            variable.meaning = VariableMeaning::Alias(Entity::Value(value));
            return;
        }
        variable.meaning = VariableMeaning::Slot;
        steps.push(IrStatement::Declare(variable.id, value));
    }

    /// The variable to which a name refers, as resolved by the first pass.
    pub(super) fn variable(&mut self, name: &str, span: Span) -> Attempt<Option<Variable>> {
        match self.site.map_or(self.names, |site| site.names).at(span.start) {
            NameMeaning::Outside => Ok(None),
            NameMeaning::Wrong => Err(Reported),
            NameMeaning::Declared(byte) => match self.variables.get(&self.key(byte, FactKind::Name)) {
                Some(variable) => Ok(Some(variable.clone())),
                None => self.refuse(
                    Finding::error(rules::UNKNOWN_NAME, span, format!("`{name}` has no value here"))
                        .why("a measure over a whole run cannot use the local names around it")
                        .help("write its value or expression instead"),
                ),
            },
        }
    }

    /// The meaning of a variable where it is read.
    pub(super) fn read_variable(&mut self, variable: &Variable, span: Span) -> Attempt<Entity> {
        match &variable.meaning {
            VariableMeaning::Alias(entity) => Ok(entity.clone()),
            VariableMeaning::Unknown if variable.ready => Err(Reported),
            _ => {
                self.capture(variable);
                let ty = self.facts.ty(variable.key);
                Ok(Entity::Value(Ir::new(IrKind::Local(variable.id), ty, span)))
            }
        }
    }

    /// Records that the functions from the current one up to the owner of the variable capture it.
    pub(super) fn capture(&mut self, variable: &Variable) {
        let mut unit = self.unit;
        while unit != variable.unit {
            let Some(called) = self.functions.iter().find(|k| k.unit == Some(unit)) else { return };
            if let Some(unit) = self.tree.units.get_mut(unit as usize)
                && !unit.captures.contains(&variable.id)
            {
                unit.captures.push(variable.id);
            }
            unit = called.around;
        }
    }
}
