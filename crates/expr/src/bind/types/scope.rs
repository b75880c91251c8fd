//! Variables: their places, the functions that use them, and what they stand for.

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
    /// The key of something declared at a byte.
    pub(super) fn key(&self, at: usize, what: FactKind) -> FactKey {
        FactKey { site: self.site.map_or(0, |site| site.id), at, what }
    }

    /// The key of a variable.
    pub(super) fn key_of(&self, name: &Name) -> FactKey {
        self.key(name.span.start, FactKind::Name)
    }

    /// What the first pass found of a declaration.
    pub(super) fn declaration(&self, key: FactKey) -> Option<&'a Declaration> {
        self.site.map_or(self.names, |site| site.names).declared(key.at)
    }

    /// In how many places a variable is assigned after its declaration.
    pub(super) fn assignments(&self, key: FactKey) -> usize {
        self.declaration(key).map_or(0, |declared| declared.assigned)
    }

    /// Statements with names of their own.
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

    /// The end of a block: functions that nothing called are looked through for mistakes.
    pub(super) fn leave(&mut self, functions: usize) {
        for i in functions..self.functions.len() {
            if self.functions.get(i).is_some_and(|k| k.unit.is_none()) {
                self.bind_with_anything(i);
            }
        }
    }

    /// Names that a block declares get their places; functions can be called from its start.
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
                let thing = self.new_function(function);
                self.give(name, VariableMeaning::Alias(thing));
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

    /// A new name, whose declaration has not run yet.
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

    /// A place for values. Its type is known at the end of the round.
    pub(super) fn new_local(&mut self, key: FactKey, shared: bool) -> LocalId {
        self.tree.locals.push(Local { ty: Type::Never, shared });
        self.keys.push(key);
        (self.tree.locals.len() - 1) as LocalId
    }

    /// The declaration of a name has run.
    pub(super) fn give(&mut self, name: &Name, meaning: VariableMeaning) {
        let key = self.key_of(name);
        if let Some(variable) = self.variables.get_mut(&key) {
            variable.ready = true;
            variable.meaning = meaning;
        }
    }

    /// A declared name that holds a value: the step that stores it.
    pub(super) fn give_value(&mut self, name: &Name, value: Ir, steps: &mut Vec<IrStatement>) {
        let key = self.key_of(name);
        let changes = self.assignments(key) > 0;
        self.facts.see(key, value.ty);
        let Some(variable) = self.variables.get_mut(&key) else {
            steps.push(IrStatement::Effect(value)); // a name that could not be declared
            return;
        };
        variable.ready = true;
        // A name for a known value that never changes is that value.
        if value.as_constant().is_some() && !changes {
            variable.meaning = VariableMeaning::Alias(Entity::Value(value));
            return;
        }
        variable.meaning = VariableMeaning::Slot;
        steps.push(IrStatement::Declare(variable.id, value));
    }

    /// What the first pass found of a name, and the variable that it means.
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

    /// What a variable stands for where it is read.
    pub(super) fn read_variable(&mut self, variable: &Variable, span: Span) -> Attempt<Entity> {
        match &variable.meaning {
            VariableMeaning::Alias(thing) => Ok(thing.clone()),
            VariableMeaning::Unknown if variable.ready => Err(Reported),
            _ => {
                self.capture(variable);
                let ty = self.facts.ty(variable.key);
                Ok(Entity::Value(Ir::new(IrKind::Local(variable.id), ty, span)))
            }
        }
    }

    /// A variable of another function is used: that function, and all between, hand it in.
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
