//! The binder of one source text, and its knowledge of the variables and functions.

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
use labspec_finding::{DESCRIBED, Finding, Fix, Span};

/// The result of the types pass for one source text.
pub(in crate::bind) struct BoundText {
    /// The program, if there are no errors.
    pub(in crate::bind) program: Option<BoundProgram>,
    pub(in crate::bind) found: Vec<Finding>,
    /// The first unresolved name.
    pub(in crate::bind) unresolved: Option<Span>,
    pub(in crate::bind) typed: TypedText,
    pub(in crate::bind) help: Vec<(Span, Help)>,
    pub(in crate::bind) named: Vec<Fix>,
    /// The number of rounds.
    #[cfg(test)]
    pub(super) rounds: usize,
}

/// The parts of a bound program.
pub(in crate::bind) struct BoundProgram {
    pub(in crate::bind) tree: IrProgram,
    pub(in crate::bind) result: Type,
    pub(in crate::bind) aggregates: Vec<Aggregate>,
}

/// The context in which a text is bound.
pub(in crate::bind) struct BindContext<'c, 's> {
    pub(in crate::bind) schema: &'s dyn Schema,
    pub(in crate::bind) globals: &'c mut Globals,
    /// The type of `value`, if a control supplies one.
    pub(in crate::bind) value: Option<Type>,
    /// Whether [`BoundText::help`] and [`BoundText::named`] are requested.
    pub(in crate::bind) explains: bool,
}

/// Infers the types of a text whose names are resolved.
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
        binder.assign_types();
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

/// The meaning of a part of the source.
#[derive(Clone, Debug)]
pub(super) enum Entity {
    /// A value.
    Value(Ir),
    /// An object of the host.
    Object(ObjectId),
    /// A field of the host, or a part of one.
    Field(Field),
    /// A collection of named objects, not yet called.
    Collection(CollectionId),
    /// An object of a collection whose name is computed at run time.
    Picked(CollectionId, Ir),
    /// A function of the host, not yet called.
    Function(FunctionId),
    /// `Math`
    Math,
    /// A function of `Math`, not yet called.
    MathFunction(math::MathFunction),
    /// `ctx`
    Globals,
    /// `Array`, `Number`, `String`, `Object`: namespaces of functions.
    Namespace(&'static str),
    /// A function of the language, not yet called.
    Native(FreeFunctionId),
    /// A method, not yet called, with its receiver.
    Method(Box<MethodReceiver>, MethodId),
    /// A function of the text: its index in the list of known functions.
    Closure(usize),
}

/// The receiver of a method.
#[derive(Clone, Debug)]
pub(super) enum MethodReceiver {
    Field(Field),
    Value(Ir),
}

/// A variable that the text declares.
#[derive(Clone, Debug)]
pub(super) struct Variable {
    pub(super) key: FactKey,
    pub(super) id: LocalId,
    /// The function to which it belongs.
    pub(super) unit: UnitId,
    /// Whether its declaration has been executed.
    pub(super) ready: bool,
    pub(super) meaning: VariableMeaning,
    /// The smallest and the largest value, for a loop counter with known bounds.
    pub(super) range: Option<(f64, f64)>,
}

/// The meaning of a variable.
#[derive(Clone, Debug)]
pub(super) enum VariableMeaning {
    /// A value with its own storage.
    Slot,
    /// Another name for an entity: `const v = list`.
    Alias(Entity),
    /// Its declaration has an error, which is reported there.
    Unknown,
}

/// A function of the text.
#[derive(Clone)]
pub(super) struct KnownFunction<'a> {
    pub(super) function: &'a Function,
    /// The key of its result.
    pub(super) key: FactKey,
    /// The enclosing function.
    pub(super) around: UnitId,
    /// The unit as which it was bound.
    pub(super) unit: Option<UnitId>,
    /// If the function is part of a method that is written in the language, the call of that method.
    pub(super) site: Option<InlineSite>,
}

/// A call of a method that is written in the language.
#[derive(Clone, Copy)]
pub(super) struct InlineSite {
    /// Distinguishes its variables from those of other calls.
    pub(super) id: usize,
    /// The location of the call in the text.
    pub(super) call: Span,
    pub(super) row: &'static Native,
    pub(super) names: &'static NameTable,
}

impl InlineSite {
    /// The method as it appears in a call: `.map`.
    pub(super) fn called(&self) -> String {
        self.row.title()
    }
}

/// The state of one round over one source text.
pub(super) struct Binder<'a> {
    pub(super) schema: &'a dyn Schema,
    pub(super) globals: Globals,
    pub(super) value: Option<Type>,
    pub(super) source: &'a str,
    pub(super) mode: TextKind,
    pub(super) names: &'a NameTable,
    pub(super) program: ProgramId,
    pub(super) diagnostics: Vec<Finding>,
    /// An unresolved name; the first pass has reported it.
    pub(super) unresolved: Option<Span>,
    pub(super) aggregates: Vec<Aggregate>,
    pub(super) next_aggregate: usize,
    /// Whether `help` and `named` are requested.
    pub(super) explains: bool,
    pub(super) help: Vec<(Span, Help)>,
    pub(super) named: Vec<Fix>,
    pub(super) typed: TypedText,
    pub(super) facts: TypeFacts,
    pub(super) tree: IrProgram,
    /// The key of each local variable of the tree.
    pub(super) keys: Vec<FactKey>,
    pub(super) variables: BTreeMap<FactKey, Variable>,
    /// The functions of the text.
    pub(super) functions: Vec<KnownFunction<'a>>,
    /// The function that is being bound.
    pub(super) unit: UnitId,
    /// The call whose method, written in the language, is being bound.
    pub(super) site: Option<InlineSite>,
    /// The keys of the results of the enclosing functions.
    pub(super) returns: Vec<FactKey>,
    /// The number of loops around the statement, within this function.
    pub(super) loops: usize,
    /// Conditions and jumps since the innermost counted loop began. Code after one of them may never be executed.
    pub(super) guards: usize,
    /// The nesting depth of the expression that is being bound.
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

    /// Binds the text and returns the type of its result.
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

    /// Stores the text itself as the first function.
    pub(super) fn finish(&mut self, body: Vec<IrStatement>, result: Option<Type>) {
        if let Some(unit) = self.tree.units.first_mut() {
            unit.body = body;
            unit.result = result;
        }
    }

    /// Gives the variables of the tree their inferred types.
    pub(super) fn assign_types(&mut self) {
        for (local, key) in self.tree.locals.iter_mut().zip(&self.keys) {
            local.ty = self.facts.found(*key);
        }
    }

    /// The terms of the host.
    pub(super) fn host_terms(&self) -> &'static HostTerms {
        self.schema.host_terms()
    }

    pub(super) fn report(&mut self, diagnostic: Finding) {
        // In a method that is written in the language, the finding is reported at the call.
        self.diagnostics.push(match self.site {
            Some(site) => Finding { span: site.call.into(), fix: None, ..diagnostic },
            None => diagnostic,
        });
    }

    pub(super) fn refuse<T>(&mut self, diagnostic: Finding) -> Attempt<T> {
        self.report(diagnostic);
        Err(Reported)
    }

    /// The source of a part. In a method that is written in the language, whose text the author does not see, it is that of
    /// the call.
    pub(super) fn text(&self, span: Span) -> &'a str {
        self.site.map_or(span, |site| site.call).text(self.source)
    }

    /// A part as a message refers to it.
    pub(super) fn describe_span(&self, span: Span) -> String {
        match self.site {
            Some(site) => format!("the result of the function of `{}`", site.called()),
            None => format!("`{}`", self.text(span)),
        }
    }

    /// Records the help for a part of the text.
    pub(super) fn explain(&mut self, span: Span, help: impl FnOnce() -> Help) {
        const MOST: usize = 1000;
        if DESCRIBED && self.explains && self.site.is_none() && self.help.len() < MOST {
            self.help.push((span, help()));
        }
    }

    /// Binds a part of the source to its meaning.
    pub(super) fn entity(&mut self, expr: &'a Expr) -> Attempt<Entity> {
        if self.levels >= MAX_LEVELS {
            return self.refuse_nesting(expr.span);
        }
        self.levels += 1;
        let entity = self.entity_inside(expr);
        self.levels -= 1;
        entity
    }

    #[inline(never)]
    fn refuse_nesting(&mut self, span: Span) -> Attempt<Entity> {
        self.refuse(too_deep(span))
    }

    /// The finding for a function without a result where a value is required.
    pub(super) fn no_result(&self, span: Span) -> Finding {
        let name = self.text(span).split('(').next().unwrap_or("");
        Finding::error(rules::NO_RESULT, span, format!("`{name}` returns nothing"))
            .why("it is called for its effect, so it has no value")
            .help(format!("call it as a statement, in {}", self.host_terms().statements))
    }

    /// Records the type of an expression for the lints.
    pub(super) fn record_type(&mut self, span: Span, ir: &Ir) {
        if self.site.is_none() {
            self.typed.shapes.push((span, ExpressionShape::of_ir(ir)));
        }
    }

    /// Records that a statement has no effect.
    pub(super) fn record_idle(&mut self, span: Span) {
        if self.site.is_none() {
            self.typed.idle.insert(span);
        }
    }

    /// Records for the lints what is expected of a value.
    pub(super) fn record_expectation(&mut self, ir: &Ir, span: Span, expectation: Expectation) {
        if self.site.is_none() {
            self.typed.expectations.push((span, expectation, ExpressionShape::of_ir(ir)));
        }
    }
}
