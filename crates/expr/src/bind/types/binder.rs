//! The work on one text, and what it knows of the variables and functions in it.

use std::collections::BTreeMap;

use super::facts::{FactKey, TypeFacts};
use super::typed::{Expectation, ExpressionShape, TypedText};
use crate::ast::{Expr, Function};
use crate::bind::names::NameTable;
use crate::bind::source::{MAX_LEVELS, SourceTree, TextKind, too_deep};
use crate::globals::{Globals, ProgramId};
use crate::host_terms::HostTerms;
use crate::ir::{Ir, IrFunction, IrProgram, IrStatement, LocalId};
use crate::math;
use crate::natives::Native;
use crate::parse::{Attempt, Reported};
use crate::program::Aggregate;
use crate::rules;
use crate::schema::{Field, Help, Schema};
use crate::tables::{FreeFunctionId, MethodId, UnitId};
use crate::types::{CollectionId, FunctionId, ObjectId, Type};
use labspec_finding::{Finding, Fix, Span};

/// What the pass found of a text.
pub(in crate::bind) struct BoundText {
    /// The program, when nothing was in the way.
    pub(in crate::bind) program: Option<BoundProgram>,
    pub(in crate::bind) found: Vec<Finding>,
    /// The first name that means nothing.
    pub(in crate::bind) unresolved: Option<Span>,
    pub(in crate::bind) typed: TypedText,
    pub(in crate::bind) help: Vec<(Span, Help)>,
    pub(in crate::bind) named: Vec<Fix>,
    /// Rounds that it took.
    #[cfg(test)]
    pub(super) rounds: usize,
}

/// What a program is made of.
pub(in crate::bind) struct BoundProgram {
    pub(in crate::bind) tree: IrProgram,
    pub(in crate::bind) result: Type,
    pub(in crate::bind) aggregates: Vec<Aggregate>,
}

/// What a text is bound to.
pub(in crate::bind) struct BindContext<'c, 's> {
    pub(in crate::bind) schema: &'s dyn Schema,
    pub(in crate::bind) globals: &'c mut Globals,
    /// The type of `value`, where a control gives one.
    pub(in crate::bind) value: Option<Type>,
    /// Whether [`BoundText::help`] and [`BoundText::named`] are wanted.
    pub(in crate::bind) explains: bool,
}

/// Finds the types of a text whose names are known.
pub(in crate::bind) fn bind(
    context: &mut BindContext<'_, '_>,
    source: &str,
    tree: SourceTree<'_>,
    names: &NameTable,
    id: ProgramId,
) -> BoundText {
    let mark = context.globals.mark();
    let mut facts = TypeFacts::default();
    loop {
        context.globals.back_to(mark);
        let mut binder = Binder::new(context, source, tree.mode(), names, id, facts);
        let done = binder.whole(tree);
        binder.settle();
        let again = binder.facts.next_round();
        *context.globals = binder.globals;
        facts = binder.facts;
        if again {
            continue;
        }
        binder.typed.sort();
        let (tree, aggregates) = (binder.tree, binder.aggregates);
        return BoundText {
            program: done.ok().map(|result| BoundProgram { tree, result, aggregates }),
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

/// What a part of the source stands for.
#[derive(Clone, Debug)]
pub(super) enum Entity {
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
    MathFunction(math::MathFunction),
    /// `ctx`
    Globals,
    /// `Array`, `Number`, `String`, `Object`: a holder of functions.
    Namespace(&'static str),
    /// A function of the language, not yet called.
    Native(FreeFunctionId),
    /// A method, not yet called, with what it is called on.
    Method(Box<MethodReceiver>, MethodId),
    /// A function of the text: its place among the known ones.
    Closure(usize),
}

/// What a method is called on.
#[derive(Clone, Debug)]
pub(super) enum MethodReceiver {
    Field(Field),
    Value(Ir),
}

/// A name that the text gives.
#[derive(Clone, Debug)]
pub(super) struct Variable {
    pub(super) key: FactKey,
    pub(super) id: LocalId,
    /// The function that it belongs to.
    pub(super) unit: UnitId,
    /// Its declaration has run.
    pub(super) ready: bool,
    pub(super) meaning: VariableMeaning,
    /// Smallest and largest value, of a loop that counts between known bounds.
    pub(super) range: Option<(f64, f64)>,
}

/// What a name stands for.
#[derive(Clone, Debug)]
pub(super) enum VariableMeaning {
    /// A value, kept in a place of its own.
    Slot,
    /// Another word for a thing: `const v = list`.
    Alias(Entity),
    /// Its declaration has a mistake, reported there.
    Unknown,
}

/// A function of the text.
#[derive(Clone)]
pub(super) struct KnownFunction<'a> {
    pub(super) function: &'a Function,
    /// What it gives.
    pub(super) key: FactKey,
    /// The function around it.
    pub(super) around: UnitId,
    /// What it was bound as.
    pub(super) unit: Option<UnitId>,
    /// The call whose written method it stands in.
    pub(super) site: Option<InlineSite>,
}

/// The call of a written method.
#[derive(Clone, Copy)]
pub(super) struct InlineSite {
    /// Tells its variables from those of other calls.
    pub(super) id: usize,
    /// Where the text calls it.
    pub(super) call: Span,
    pub(super) row: &'static Native,
    pub(super) names: &'static NameTable,
}

impl InlineSite {
    /// The method as it is called: `.map`.
    pub(super) fn called(&self) -> String {
        self.row.title()
    }
}

/// The work on one text, in one round.
pub(super) struct Binder<'a> {
    pub(super) schema: &'a dyn Schema,
    pub(super) globals: Globals,
    pub(super) value: Option<Type>,
    /// What variables measure, where that is asked for.
    pub(super) source: &'a str,
    pub(super) mode: TextKind,
    pub(super) names: &'a NameTable,
    pub(super) program: ProgramId,
    pub(super) diagnostics: Vec<Finding>,
    /// A name that means nothing; the first pass has reported it.
    pub(super) unresolved: Option<Span>,
    pub(super) aggregates: Vec<Aggregate>,
    pub(super) next_aggregate: usize,
    /// Whether the next two are wanted.
    pub(super) explains: bool,
    pub(super) help: Vec<(Span, Help)>,
    pub(super) named: Vec<Fix>,
    pub(super) typed: TypedText,
    pub(super) facts: TypeFacts,
    pub(super) tree: IrProgram,
    /// The place that each variable of the tree is.
    pub(super) keys: Vec<FactKey>,
    pub(super) variables: BTreeMap<FactKey, Variable>,
    /// Functions of the text.
    pub(super) functions: Vec<KnownFunction<'a>>,
    /// The function that is bound.
    pub(super) unit: UnitId,
    /// The call whose method, written in the language, is bound.
    pub(super) site: Option<InlineSite>,
    /// Where the results of the functions around go.
    pub(super) returns: Vec<FactKey>,
    /// Loops around the statement, in this function.
    pub(super) loops: usize,
    /// Conditions and jumps since the innermost counted loop began: what stands behind one may never run.
    pub(super) guards: usize,
    /// Expressions that are being bound, one inside the other.
    pub(super) levels: usize,
}

impl<'a> Binder<'a> {
    pub(super) fn new<'s: 'a>(
        context: &mut BindContext<'_, 's>,
        source: &'a str,
        mode: TextKind,
        names: &'a NameTable,
        program: ProgramId,
        facts: TypeFacts,
    ) -> Binder<'a> {
        Binder {
            schema: context.schema,
            globals: std::mem::take(context.globals),
            value: context.value,
            source,
            mode,
            names,
            program,
            diagnostics: Vec::new(),
            unresolved: None,
            aggregates: Vec::new(),
            next_aggregate: 0,
            explains: context.explains,
            help: Vec::new(),
            named: Vec::new(),
            typed: TypedText::default(),
            facts,
            tree: IrProgram { units: vec![IrFunction::default()], ..IrProgram::default() },
            keys: Vec::new(),
            variables: BTreeMap::new(),
            functions: Vec::new(),
            unit: 0,
            site: None,
            returns: Vec::new(),
            loops: 0,
            guards: 0,
            levels: 0,
        }
    }

    /// Binds the text; gives the type of its result.
    pub(super) fn whole(&mut self, tree: SourceTree<'a>) -> Attempt<Type> {
        match tree {
            SourceTree::Expression(expr) => {
                let ir = self.operand(expr)?;
                let ty = ir.ty;
                self.finish(vec![IrStatement::Return(ir)], Some(ty));
                Ok(ty)
            }
            SourceTree::Statements(statements) => {
                let steps = self.block(statements);
                self.finish(steps, None);
                Ok(Type::Void)
            }
            SourceTree::Target(target) => {
                let given = self.value.unwrap_or(Type::Any);
                let step = IrStatement::Effect(self.set(target, given)?);
                self.finish(vec![step], None);
                Ok(Type::Void)
            }
        }
    }

    /// The text itself is the first function.
    pub(super) fn finish(&mut self, body: Vec<IrStatement>, result: Option<Type>) {
        if let Some(unit) = self.tree.units.first_mut() {
            unit.body = body;
            unit.result = result;
        }
    }

    /// The variables of the tree get the types that were found of them.
    pub(super) fn settle(&mut self) {
        for (local, key) in self.tree.locals.iter_mut().zip(&self.keys) {
            local.ty = self.facts.found(*key);
        }
    }

    /// What the host calls its things.
    pub(super) fn host_terms(&self) -> &'static HostTerms {
        self.schema.host_terms()
    }

    pub(super) fn report(&mut self, diagnostic: Finding) {
        // In a method that is written in the language, the call is the place.
        self.diagnostics.push(match self.site {
            Some(site) => Finding { span: site.call.into(), fix: None, ..diagnostic },
            None => diagnostic,
        });
    }

    pub(super) fn refuse<T>(&mut self, diagnostic: Finding) -> Attempt<T> {
        self.report(diagnostic);
        Err(Reported)
    }

    /// The source of a part; in a method that is written in the language, whose text nobody wrote here, that of the call.
    pub(super) fn text(&self, span: Span) -> &'a str {
        self.site.map_or(span, |site| site.call).text(self.source)
    }

    /// A part as it is called in a message.
    pub(super) fn describe_span(&self, span: Span) -> String {
        match self.site {
            Some(site) => format!("the result of the function of `{}`", site.called()),
            None => format!("`{}`", self.text(span)),
        }
    }

    /// Notes what a part of the text is.
    pub(super) fn explain(&mut self, span: Span, help: impl FnOnce() -> Help) {
        const MOST: usize = 1000;
        if self.explains && self.site.is_none() && self.help.len() < MOST {
            self.help.push((span, help()));
        }
    }

    /// What a part of the source stands for.
    pub(super) fn entity(&mut self, expr: &'a Expr) -> Attempt<Entity> {
        if self.levels >= MAX_LEVELS {
            return self.refuse_deep(expr.span);
        }
        self.levels += 1;
        let thing = self.entity_inside(expr);
        self.levels -= 1;
        thing
    }

    #[inline(never)]
    fn refuse_deep(&mut self, span: Span) -> Attempt<Entity> {
        self.refuse(too_deep(span))
    }

    /// The finding for a function without a result where a value must stand.
    pub(super) fn no_result(&self, span: Span) -> Finding {
        let name = self.text(span).split('(').next().unwrap_or("");
        Finding::error(rules::NO_RESULT, span, format!("`{name}` returns nothing"))
            .why("it is called for its effect, so it has no value")
            .help(format!("call it as a statement, in {}", self.host_terms().statements))
    }

    /// Notes what an expression is.
    pub(super) fn note(&mut self, span: Span, ir: &Ir) {
        if self.site.is_none() {
            self.typed.shapes.push((span, ExpressionShape::of_ir(ir)));
        }
    }

    /// Notes that a statement does nothing.
    pub(super) fn idle(&mut self, span: Span) {
        if self.site.is_none() {
            self.typed.idle.insert(span);
        }
    }

    /// Notes what a value is needed for.
    pub(super) fn want(&mut self, ir: &Ir, span: Span, want: Expectation) {
        if self.site.is_none() {
            self.typed.wants.push((span, want, ExpressionShape::of_ir(ir)));
        }
    }
}
