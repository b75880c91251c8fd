//! Names that a text gives: their reach, the functions that use them, and what they stand for.

use super::facts::Key;
use super::name::is_language;
use super::{Attempt, Binder, Reported, Thing};
use crate::ast::{Declarator, Element, Function, Name, Pattern, Stmt, StmtKind};
use crate::ir::{Ir, Kind, Local, LocalId, Step, UnitId};
use crate::rules;
use crate::{Finding, Span};

/// A name in reach.
#[derive(Clone, Debug)]
pub(super) struct Variable {
    pub(super) name: String,
    pub(super) key: Key,
    pub(super) id: LocalId,
    /// The function that it belongs to.
    pub(super) unit: UnitId,
    pub(super) constant: bool,
    /// Its declaration has run.
    pub(super) ready: bool,
    pub(super) meaning: Meaning,
    /// Smallest and largest value, of a loop that counts between known bounds.
    pub(super) range: Option<(f64, f64)>,
}

/// What a name stands for.
#[derive(Clone, Debug)]
pub(super) enum Meaning {
    /// A value, kept in a place of its own.
    Slot,
    /// Another word for a thing: `const v = data.qvel`.
    Alias(Thing),
    /// Its declaration has a mistake, reported there.
    Unknown,
}

/// A function of the text.
#[derive(Clone, Debug)]
pub(super) struct Known<'a> {
    pub(super) function: &'a Function,
    pub(super) key: Key,
    /// How many names it sees.
    pub(super) reach: usize,
    /// The function around it.
    pub(super) around: UnitId,
    /// What it was bound as.
    pub(super) unit: Option<UnitId>,
    /// The call whose method of the prelude it stands in.
    pub(super) site: Option<Span>,
}

impl<'a> Binder<'a> {
    /// The key of something declared at a byte.
    pub(super) fn key(&self, at: usize) -> Key {
        (self.site.map_or(0, |call| call.end), at)
    }

    /// Statements with names of their own.
    pub(super) fn block(&mut self, statements: &'a [Stmt]) -> Vec<Step> {
        let (reach, known) = (self.variables.len(), self.known.len());
        let mut steps = Vec::new();
        self.hoist(statements, &mut steps);
        for statement in statements {
            self.statement(statement, &mut steps);
        }
        self.leave(reach, known);
        steps
    }

    /// Forgets the names of a block. Functions that nothing called are looked through for mistakes.
    pub(super) fn leave(&mut self, reach: usize, known: usize) {
        for i in known..self.known.len() {
            if self.known.get(i).is_some_and(|k| k.unit.is_none() && k.reach <= self.variables.len()) {
                self.bind_with_anything(i);
            }
        }
        self.variables.truncate(reach);
    }

    /// Names that a block declares mean nothing else in all of it; functions can be called from its start.
    fn hoist(&mut self, statements: &'a [Stmt], steps: &mut Vec<Step>) {
        let first = self.variables.len();
        for statement in statements {
            match &statement.kind {
                StmtKind::Declare { constant, declarators } => {
                    for Declarator { target, .. } in declarators {
                        self.hoist_pattern(target, *constant, first, steps);
                    }
                }
                StmtKind::Function { name, .. } => self.hoist_name(name, true, first, steps),
                _ => {}
            }
        }
        for statement in statements {
            if let StmtKind::Function { name, function } = &statement.kind {
                let thing = self.new_function(function);
                self.give(name, Meaning::Alias(thing));
            }
        }
    }

    pub(super) fn hoist_pattern(
        &mut self,
        pattern: &'a Pattern,
        constant: bool,
        first: usize,
        steps: &mut Vec<Step>,
    ) {
        match pattern {
            Pattern::Name(name) => self.hoist_name(name, constant, first, steps),
            Pattern::List { items, .. } => {
                for Element { target, .. } in items.iter().flatten() {
                    self.hoist_pattern(target, constant, first, steps);
                }
            }
            Pattern::Record { entries, .. } => {
                for (_, Element { target, .. }) in entries {
                    self.hoist_pattern(target, constant, first, steps);
                }
            }
        }
    }

    fn hoist_name(&mut self, name: &Name, constant: bool, first: usize, steps: &mut Vec<Step>) {
        let taken = self.variables.iter().skip(first).any(|v| v.name == name.text);
        // At the top of a text the names of the lab are parameters of the same function, in JavaScript.
        let top = first == 0 && self.unit == 0;
        if taken || top && (is_language(&name.text) || self.schema.root(&name.text).is_some()) {
            let why = if taken {
                "it is declared above"
            } else {
                "it already means something in every text of a lab"
            };
            self.report(
                Finding::error(
                    rules::NAME_TAKEN,
                    name.span,
                    format!("`{}` cannot be declared here", name.text),
                )
                .why(format!("{why}; JavaScript refuses a second declaration"))
                .help(if taken {
                    "assign it without `const` or `let`, or choose another name"
                } else {
                    "choose another name"
                }),
            );
            return;
        }
        let id = self.declare_variable(name, constant);
        if self.tree.locals.get(id as usize).is_some_and(|l| l.shared) {
            steps.push(Step::Reserve(id));
        }
    }

    /// A new name, whose declaration has not run yet.
    pub(super) fn declare_variable(&mut self, name: &Name, constant: bool) -> LocalId {
        let key = self.key(name.span.start);
        let id = self.new_local(key);
        self.variables.push(Variable {
            name: name.text.clone(),
            key,
            id,
            unit: self.unit,
            constant,
            ready: false,
            meaning: Meaning::Unknown,
            range: None,
        });
        id
    }

    /// A place for values.
    pub(super) fn new_local(&mut self, key: Key) -> LocalId {
        let local = Local { ty: self.facts.ty(key), shared: self.facts.is_shared(key) };
        self.tree.locals.push(local);
        (self.tree.locals.len() - 1) as LocalId
    }

    /// The declaration of a name has run.
    pub(super) fn give(&mut self, name: &Name, meaning: Meaning) {
        let key = self.key(name.span.start);
        if let Some(variable) = self.variables.iter_mut().rev().find(|v| v.key == key) {
            variable.ready = true;
            variable.meaning = meaning;
        }
    }

    /// A declared name that holds a value: the step that stores it.
    pub(super) fn give_value(&mut self, name: &Name, value: Ir, steps: &mut Vec<Step>) {
        let key = self.key(name.span.start);
        self.facts.see(key, value.ty);
        let Some(variable) = self.variables.iter_mut().rev().find(|v| v.key == key) else {
            steps.push(Step::Effect(value)); // a name that could not be declared
            return;
        };
        variable.ready = true;
        // A name for a known value that never changes is that value.
        if value.known().is_some() && self.facts.assignments(key) == 0 {
            variable.meaning = Meaning::Alias(Thing::Value(value));
            return;
        }
        variable.meaning = Meaning::Slot;
        steps.push(Step::Declare(variable.id, value));
    }

    /// The variable of a name that the text gave.
    pub(super) fn variable(&self, name: &str) -> Option<Variable> {
        self.variables.iter().rev().find(|v| v.name == name).cloned()
    }

    /// What a variable stands for where it is read.
    pub(super) fn read_variable(&mut self, variable: &Variable, span: Span) -> Attempt<Thing> {
        self.check_ready(variable, span)?;
        match &variable.meaning {
            Meaning::Alias(thing) => Ok(thing.clone()),
            Meaning::Unknown if variable.ready => Err(Reported),
            _ => {
                self.capture(variable);
                let ty = self.facts.ty(variable.key);
                Ok(Thing::Value(Ir::new(Kind::Local(variable.id), ty, span)))
            }
        }
    }

    /// Refuses a use before the declaration.
    pub(super) fn check_ready(&mut self, variable: &Variable, span: Span) -> Attempt<()> {
        if variable.ready {
            return Ok(());
        }
        if variable.unit != self.unit {
            // The function may run later, when there is a value.
            self.facts.use_early(variable.key);
            return Ok(());
        }
        let name = &variable.name;
        self.refuse(
            Finding::error(rules::USED_TOO_EARLY, span, format!("`{name}` is used before its declaration"))
                .why("statements run from top to bottom: here the name has no value yet")
                .help(format!("move the declaration of `{name}` up")),
        )
    }

    /// A variable of another function is used: that function, and all between, hand it in.
    pub(super) fn capture(&mut self, variable: &Variable) {
        let mut unit = self.unit;
        while unit != variable.unit {
            let Some(known) = self.known.iter().find(|k| k.unit == Some(unit)).cloned() else { return };
            self.facts.capture(known.key, variable.key);
            if let Some(unit) = self.tree.units.get_mut(unit as usize)
                && !unit.captures.contains(&variable.id)
            {
                unit.captures.push(variable.id);
            }
            unit = known.around;
        }
    }
}
