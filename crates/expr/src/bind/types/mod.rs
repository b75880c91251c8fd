//! The second pass: which type everything has, and the typed tree.
//!
//! A round binds the whole text with the types that are known of its variables and functions. Where a type grows after it was read,
//! another round follows (a fixed point over a lattice; Kildall, "A unified approach to global program optimization", 1973). Types
//! only grow, at most three times each, so the rounds end. After a few of them the places through which every circle of types goes
//! are taken to hold anything (widening; Cousot and Cousot, "Abstract interpretation", 1977), and two more rounds are the last:
//! see [`Facts`].

mod access;
mod assign;
mod call;
mod facts;
mod function;
mod literal;
mod loops;
mod member;
mod method;
mod object;
mod scope;
mod statement;
#[cfg(test)]
mod tests;
mod typed;
mod value;
mod written;

use std::collections::BTreeMap;

use super::names::Names;
use super::{Compiler, MAX_LEVELS, Mode};
use crate::ast::Expr;
use crate::globals::{Globals, ProgramId};
use crate::ir::{FreeFunctionId, Ir, MethodId, Step, Tree, Unit, UnitId};
use crate::math;
use crate::program::Aggregate;
use crate::rules;
use crate::schema::{Field, Help, Schema};
use crate::types::{CollectionId, FunctionId, ObjectId, Type};
use crate::words::Words;
use crate::{Finding, Fix, Span};

use facts::{Facts, Key, What};
use scope::{Known, Variable};
pub(super) use typed::{Shape, Typed, Want};
use written::Site;

/// What the pass found of a text.
pub(super) struct Bound {
    /// The program, when nothing was in the way.
    pub(super) program: Option<Parts>,
    pub(super) found: Vec<Finding>,
    /// The first name that means nothing.
    pub(super) unresolved: Option<Span>,
    pub(super) typed: Typed,
    pub(super) help: Vec<(Span, Help)>,
    pub(super) named: Vec<Fix>,
    /// Rounds that it took.
    #[cfg(test)]
    rounds: usize,
}

/// What a program is made of.
pub(super) struct Parts {
    pub(super) tree: Tree,
    pub(super) result: Type,
    pub(super) aggregates: Vec<Aggregate>,
}

/// Finds the types of a text whose names are known.
pub(super) fn bind(
    compiler: &mut Compiler<'_>,
    source: &str,
    tree: super::Tree<'_>,
    names: &Names,
    id: ProgramId,
) -> Bound {
    let mark = compiler.globals.mark();
    let mut facts = Facts::default();
    loop {
        compiler.globals.back_to(mark);
        let mut binder = Binder::new(compiler, source, tree.mode(), names, id, facts);
        let done = binder.whole(tree);
        binder.settle();
        let again = binder.facts.next_round();
        *compiler.globals = binder.globals;
        facts = binder.facts;
        if again {
            continue;
        }
        binder.typed.sort();
        let (tree, aggregates) = (binder.tree, binder.aggregates);
        return Bound {
            program: done.ok().map(|result| Parts { tree, result, aggregates }),
            found: binder.diagnostics,
            unresolved: binder.unresolved,
            typed: binder.typed,
            help: binder.help,
            named: binder.named,
            #[cfg(test)]
            rounds: facts.rounds(),
        };
    }
}

/// The marker of a mistake that has been reported.
#[derive(Debug)]
struct Reported;

type Attempt<T> = Result<T, Reported>;

/// What a part of the source stands for.
#[derive(Clone, Debug)]
enum Thing {
    /// A value.
    Value(Ir),
    /// An object of the host.
    Object(ObjectId),
    /// Numbers of the host.
    Field(Field),
    /// A choice by name, not yet called.
    Collection(CollectionId),
    /// An object of a collection whose name is computed while running.
    Picked(CollectionId, Ir),
    /// A function of the host, not yet called.
    Function(FunctionId),
    /// `Math`
    Math,
    /// A function of `Math`, not yet called.
    MathFunction(math::Function),
    /// `ctx`
    Globals,
    /// `Array`, `Number`, `String`, `Object`: a holder of functions.
    Namespace(&'static str),
    /// A function of the language, not yet called.
    Native(FreeFunctionId),
    /// A method, not yet called, with what it is called on.
    Method(Box<Receiver>, MethodId),
    /// A function of the text: its place among the known ones.
    Closure(usize),
}

/// What a method is called on.
#[derive(Clone, Debug)]
enum Receiver {
    Field(Field),
    Value(Ir),
}

/// The work on one text, in one round.
struct Binder<'a> {
    schema: &'a dyn Schema,
    globals: Globals,
    value: Option<Type>,
    /// What variables measure, where that is asked for.
    source: &'a str,
    mode: Mode,
    names: &'a Names,
    program: ProgramId,
    diagnostics: Vec<Finding>,
    /// A name that means nothing; the first pass has reported it.
    unresolved: Option<Span>,
    aggregates: Vec<Aggregate>,
    next_aggregate: usize,
    /// Whether the next two are wanted.
    explains: bool,
    help: Vec<(Span, Help)>,
    named: Vec<Fix>,
    typed: Typed,
    facts: Facts,
    tree: Tree,
    /// The place that each variable of the tree is.
    keys: Vec<Key>,
    variables: BTreeMap<Key, Variable>,
    /// Functions of the text.
    known: Vec<Known<'a>>,
    /// The function that is bound.
    unit: UnitId,
    /// The call whose method, written in the language, is bound.
    site: Option<Site>,
    /// Where the results of the functions around go.
    returns: Vec<Key>,
    /// Loops around the statement, in this function.
    loops: usize,
    /// Conditions and jumps since the innermost counted loop began: what stands behind one may never run.
    guards: usize,
    /// Expressions that are being bound, one inside the other.
    levels: usize,
}

impl<'a> Binder<'a> {
    fn new<'s: 'a>(
        compiler: &mut Compiler<'s>,
        source: &'a str,
        mode: Mode,
        names: &'a Names,
        program: ProgramId,
        facts: Facts,
    ) -> Binder<'a> {
        Binder {
            schema: compiler.schema,
            globals: std::mem::take(compiler.globals),
            value: compiler.value,
            source,
            mode,
            names,
            program,
            diagnostics: Vec::new(),
            unresolved: None,
            aggregates: Vec::new(),
            next_aggregate: 0,
            explains: compiler.explains,
            help: Vec::new(),
            named: Vec::new(),
            typed: Typed::default(),
            facts,
            tree: Tree { units: vec![Unit::default()], ..Tree::default() },
            keys: Vec::new(),
            variables: BTreeMap::new(),
            known: Vec::new(),
            unit: 0,
            site: None,
            returns: Vec::new(),
            loops: 0,
            guards: 0,
            levels: 0,
        }
    }

    /// Binds the text; gives the type of its result.
    fn whole(&mut self, tree: super::Tree<'a>) -> Attempt<Type> {
        match tree {
            super::Tree::Expression(expr) => {
                let ir = self.operand(expr)?;
                let ty = ir.ty;
                self.finish(vec![Step::Return(ir)], Some(ty));
                Ok(ty)
            }
            super::Tree::Statements(statements) => {
                let steps = self.block(statements);
                self.finish(steps, None);
                Ok(Type::Void)
            }
            super::Tree::Target(target) => {
                let given = self.value.unwrap_or(Type::Any);
                let step = Step::Effect(self.set(target, given)?);
                self.finish(vec![step], None);
                Ok(Type::Void)
            }
        }
    }

    /// The text itself is the first function.
    fn finish(&mut self, body: Vec<Step>, result: Option<Type>) {
        if let Some(unit) = self.tree.units.first_mut() {
            unit.body = body;
            unit.result = result;
        }
    }

    /// The variables of the tree get the types that were found of them.
    fn settle(&mut self) {
        for (local, key) in self.tree.locals.iter_mut().zip(&self.keys) {
            local.ty = self.facts.found(*key);
        }
    }

    /// What the host calls its things.
    fn words(&self) -> &'static Words {
        self.schema.words()
    }

    fn report(&mut self, diagnostic: Finding) {
        // In a method that is written in the language, the call is the place.
        self.diagnostics.push(match self.site {
            Some(site) => Finding { span: site.call.into(), fix: None, ..diagnostic },
            None => diagnostic,
        });
    }

    fn refuse<T>(&mut self, diagnostic: Finding) -> Attempt<T> {
        self.report(diagnostic);
        Err(Reported)
    }

    /// The source of a part; in a method that is written in the language, whose text nobody wrote here, that of the call.
    fn text(&self, span: Span) -> &'a str {
        self.site.map_or(span, |site| site.call).text(self.source)
    }

    /// A part as it is called in a message.
    fn shown(&self, span: Span) -> String {
        match self.site {
            Some(site) => format!("the result of the function of `{}`", site.called()),
            None => format!("`{}`", self.text(span)),
        }
    }

    /// Notes what a part of the text is.
    fn explain(&mut self, span: Span, help: impl FnOnce() -> Help) {
        const MOST: usize = 1000;
        if self.explains && self.site.is_none() && self.help.len() < MOST {
            self.help.push((span, help()));
        }
    }

    /// What a part of the source stands for.
    fn thing(&mut self, expr: &'a Expr) -> Attempt<Thing> {
        if self.levels >= MAX_LEVELS {
            return self.refuse_deep(expr.span);
        }
        self.levels += 1;
        let thing = self.thing_inside(expr);
        self.levels -= 1;
        thing
    }

    #[inline(never)]
    fn refuse_deep(&mut self, span: Span) -> Attempt<Thing> {
        self.refuse(super::too_deep(span))
    }

    /// The finding for a function without a result where a value must stand.
    fn no_result(&self, span: Span) -> Finding {
        let name = self.text(span).split('(').next().unwrap_or("");
        Finding::error(rules::NO_RESULT, span, format!("`{name}` returns nothing"))
            .why("it is called for its effect, so it has no value")
            .help(format!("call it as a statement, in {}", self.words().statements))
    }
}
