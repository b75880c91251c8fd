//! Tree to meaning: resolves every name against the host's schema and checks everything that can be checked
//! before a run.
//!
//! Types are found by repetition: a pass binds the whole text with what the last pass saw stored in each variable
//! and returned by each function, until nothing new is seen (a fixed point over a lattice of small height; Kildall,
//! "A unified approach to global program optimization", 1973). Findings are those of the last pass.

mod access;
mod assign;
mod call;
mod facts;
mod function;
mod literal;
mod loops;
mod method;
mod name;
mod object;
mod scope;
mod statement;
mod units;
mod value;

use crate::effects::Effects;
use crate::globals::{Globals, ProgramId};
use crate::ir::{Ir, Shown, Step, Tree, Unit, UnitId};
use crate::natives;
use crate::parse::in_order;
use crate::program::{Aggregate, Program};
use crate::rules;
use crate::schema::{CollectionId, Field, FunctionId, Help, ObjectId, Schema, Type};
use crate::{Finding, Fix, Span};
use crate::{math, parse_expression, parse_statements};

pub(crate) use facts::Facts;
use scope::{Known, Variable};

/// Compiles the texts of one lab.
pub struct Compiler<'s> {
    schema: &'s dyn Schema,
    globals: &'s mut Globals,
    /// The type of `value` in the next texts; `None` where no control gives one.
    pub value: Option<Type>,
    /// Whether [`Compiled::help`] and [`Compiled::named`] are wanted, which take longer than the program itself.
    pub explains: bool,
}

/// The result of compiling one text.
#[derive(Clone, Debug)]
pub struct Compiled {
    /// Which text this was for the [`Globals`].
    pub id: ProgramId,
    /// The program; `None` when there are errors.
    pub program: Option<Program>,
    /// Findings in source order.
    pub diagnostics: Vec<Finding>,
    /// What the parts of the text are, for a person who points at them, if wanted.
    pub help: Vec<(Span, Help)>,
    /// Bare indexes that could be written by the name of their object: `data.qpos[9]` as
    /// `data.joint("light_free").qpos[2]`, if wanted. Both mean the same element of the model at hand.
    pub named: Vec<Fix>,
}

impl Compiled {
    /// The source with every bare index that belongs to a named object written by its name.
    pub fn modernized(&self, source: &str) -> String {
        let mut out = String::new();
        let mut at = 0;
        let mut fixes: Vec<&Fix> = self.named.iter().collect();
        fixes.sort_by_key(|f| (f.span.start, f.span.end));
        for fix in fixes {
            // An index inside an index stays.
            if let Some(before) = source.get(at..fix.span.start) {
                out.push_str(before);
                out.push_str(&fix.text);
                at = fix.span.end;
            }
        }
        out + source.get(at..).unwrap_or("")
    }
}

/// Passes over a text before every type that still changes is taken to be unknown.
const PASSES: usize = 8;

impl<'s> Compiler<'s> {
    /// A compiler for texts that name things of `schema` and share the variables `globals`.
    pub fn new(schema: &'s dyn Schema, globals: &'s mut Globals) -> Compiler<'s> {
        Compiler { schema, globals, value: None, explains: false }
    }

    /// An expression: a trace, a readout, a condition. It reads and changes nothing, unless a function does.
    pub fn expression(&mut self, source: &str) -> Compiled {
        let parsed = parse_expression(source);
        self.compile(source, &parsed.diagnostics, Mode::Expression, &mut |binder| {
            let ir = binder.operand(&parsed.tree)?;
            let ty = ir.ty;
            binder.finish(vec![Step::Return(ir)], Some(ty));
            Ok(ty)
        })
    }

    /// Statements: `setup`, `controller`, `apply`, `run`.
    pub fn statements(&mut self, source: &str) -> Compiled {
        let parsed = parse_statements(source);
        self.compile(source, &parsed.diagnostics, Mode::Statements, &mut |binder| {
            let steps = binder.block(&parsed.tree);
            binder.finish(steps, None);
            Ok(Type::Void)
        })
    }

    /// The target of a control (`set`): the program stores `value` there. Without a known type of `value` it
    /// may be anything.
    pub fn assignment(&mut self, target: &str) -> Compiled {
        let parsed = parse_expression(target);
        let given = self.value.unwrap_or(Type::Any);
        self.compile(target, &parsed.diagnostics, Mode::Target, &mut |binder| {
            let step = Step::Effect(binder.set(&parsed.tree, given)?);
            binder.finish(vec![step], None);
            Ok(Type::Void)
        })
    }

    fn compile<'t>(
        &mut self,
        source: &'t str,
        read: &[Finding],
        mode: Mode,
        work: &mut dyn FnMut(&mut Binder<'t>) -> Attempt<Type>,
    ) -> Compiled
    where
        's: 't,
    {
        let id = self.globals.next_program();
        let mark = self.globals.mark();
        let mut facts = Facts::default();
        let mut passes = 0;
        loop {
            passes += 1;
            let before = facts.clone();
            self.globals.back_to(mark);
            let mut binder = Binder::new(self, source, mode, id, facts);
            let done = work(&mut binder);
            let Binder {
                mut diagnostics,
                mut effects,
                aggregates,
                tree,
                facts: seen,
                help,
                named,
                globals,
                ..
            } = binder;
            *self.globals = globals;
            facts = seen;
            if facts != before {
                if passes >= PASSES {
                    facts.give_up();
                }
                continue;
            }
            diagnostics.extend(read.iter().cloned());
            let failed = diagnostics.iter().any(Finding::is_error);
            note_views(&tree.views, &mut effects);
            let program = done.ok().filter(|_| !failed);
            let program = program.map(|result| Program::new(&tree, effects, result, aggregates));
            return Compiled { id, program, diagnostics: in_order(diagnostics), help, named };
        }
    }
}

/// Arrays that became values may be read, and stored to when anything is stored through a value.
fn note_views(views: &[Shown], effects: &mut Effects) {
    for shown in views {
        let access = crate::Access {
            field: shown.view.field,
            first: shown.view.first as usize,
            count: shown.view.count(),
        };
        effects.read(access);
        if effects.stores_items && shown.assignable {
            effects.write(access);
        }
    }
}

/// What kind of text is bound; decides what an assignment in it means.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Mode {
    Expression,
    Statements,
    Target,
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
    Native(natives::Free),
    /// A method, not yet called, with what it is called on.
    Method(Box<Receiver>, natives::Name),
    /// A function of the text: its place among the known ones.
    Closure(usize),
}

/// What a method is called on.
#[derive(Clone, Debug)]
enum Receiver {
    Field(Field),
    Value(Ir),
}

/// The work on one text, in one pass.
struct Binder<'a> {
    schema: &'a dyn Schema,
    globals: Globals,
    value: Option<Type>,
    source: &'a str,
    mode: Mode,
    program: ProgramId,
    diagnostics: Vec<Finding>,
    effects: Effects,
    aggregates: Vec<Aggregate>,
    next_aggregate: usize,
    /// Whether the next two are wanted.
    explains: bool,
    help: Vec<(Span, Help)>,
    named: Vec<Fix>,
    facts: Facts,
    tree: Tree,
    /// Names in reach, inner ones last.
    variables: Vec<Variable>,
    /// Functions of the text.
    known: Vec<Known<'a>>,
    /// The function that is bound.
    unit: UnitId,
    /// The call whose method of the prelude is bound.
    site: Option<Span>,
    /// Where the results of the functions around go.
    returns: Vec<(facts::Key, UnitId)>,
    /// Loops around the statement, in this function.
    loops: usize,
    /// Conditions and jumps since the innermost counted loop began: what stands behind one may never run.
    guards: usize,
}

impl<'a> Binder<'a> {
    fn new<'s: 'a>(
        compiler: &mut Compiler<'s>,
        source: &'a str,
        mode: Mode,
        program: ProgramId,
        facts: Facts,
    ) -> Binder<'a> {
        Binder {
            schema: compiler.schema,
            globals: std::mem::take(compiler.globals),
            value: compiler.value,
            source,
            mode,
            program,
            diagnostics: Vec::new(),
            effects: Effects::default(),
            aggregates: Vec::new(),
            next_aggregate: 0,
            explains: compiler.explains,
            help: Vec::new(),
            named: Vec::new(),
            facts,
            tree: Tree { units: vec![Unit::default()], ..Tree::default() },
            variables: Vec::new(),
            known: Vec::new(),
            unit: 0,
            site: None,
            returns: Vec::new(),
            loops: 0,
            guards: 0,
        }
    }

    /// The text itself is bound: it is the first function.
    fn finish(&mut self, body: Vec<Step>, result: Option<Type>) {
        if let Some(unit) = self.tree.units.first_mut() {
            unit.body = body;
            unit.result = result;
        }
    }

    fn report(&mut self, diagnostic: Finding) {
        // In a method of the prelude the call is the place.
        self.diagnostics.push(match self.site {
            Some(span) => Finding { span: span.into(), fix: None, ..diagnostic },
            None => diagnostic,
        });
    }

    fn refuse<T>(&mut self, diagnostic: Finding) -> Attempt<T> {
        self.report(diagnostic);
        Err(Reported)
    }

    /// The source of a part; in a method of the prelude, whose text nobody wrote here, that of the call.
    fn text(&self, span: Span) -> &'a str {
        self.site.unwrap_or(span).text(self.source)
    }

    /// Notes what a part of the text is.
    fn explain(&mut self, span: Span, help: impl FnOnce() -> Help) {
        const MOST: usize = 1000;
        if self.explains && self.site.is_none() && self.help.len() < MOST {
            self.help.push((span, help()));
        }
    }
}

/// The finding for a function without a result where a value must stand.
fn no_result(span: Span, source: &str) -> Finding {
    let name = span.text(source).split('(').next().unwrap_or("");
    Finding::error(rules::NO_RESULT, span, format!("`{name}` gives nothing back"))
        .why("it is called for what it does; there is no value to go on with")
        .help("call it as a statement of its own, in `setup`, `controller`, `apply` or `run`")
}
