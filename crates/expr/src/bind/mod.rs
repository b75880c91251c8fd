//! Tree to meaning: resolves every name against the host's schema and checks everything that can be checked
//! before a run.

mod access;
mod assign;
mod call;
mod name;
mod statement;
mod value;

use std::collections::BTreeSet;

use crate::ast::Stmt;
use crate::code;
use crate::diagnostic::{Diagnostic, Span};
use crate::effects::Effects;
use crate::globals::{Globals, ProgramId};
use crate::ir::{Ir, Step};
use crate::parse::in_order;
use crate::program::{Aggregate, Program};
use crate::schema::{CollectionId, Field, FunctionId, ObjectId, Schema, Type};
use crate::{lower, math, parse_expression, parse_statements};

/// Compiles the texts of one lab.
pub struct Compiler<'s> {
    schema: &'s dyn Schema,
    globals: &'s mut Globals,
    /// The type of `value` in the next texts; `None` where no control gives one.
    pub value: Option<Type>,
}

/// The result of compiling one text.
#[derive(Clone, Debug)]
pub struct Compiled {
    /// Which text this was for the [`Globals`].
    pub id: ProgramId,
    /// The program; `None` when there are errors.
    pub program: Option<Program>,
    /// Findings in source order.
    pub diagnostics: Vec<Diagnostic>,
}

impl<'s> Compiler<'s> {
    /// A compiler for texts that name things of `schema` and share the variables `globals`.
    pub fn new(schema: &'s dyn Schema, globals: &'s mut Globals) -> Compiler<'s> {
        Compiler { schema, globals, value: None }
    }

    /// An expression: a trace, a readout, a condition. It reads and changes nothing, unless a function does.
    pub fn expression(&mut self, source: &str) -> Compiled {
        let parsed = parse_expression(source);
        self.compile(source, parsed.diagnostics, Mode::Expression, |binder| {
            let ir = binder.value(&parsed.tree)?;
            Ok((lower::expression(&ir), ir.ty))
        })
    }

    /// Statements: `setup`, `controller`, `apply`, `run`.
    pub fn statements(&mut self, source: &str) -> Compiled {
        let parsed = parse_statements(source);
        self.compile(source, parsed.diagnostics, Mode::Statements, |binder| {
            let steps = binder.statements(&parsed.tree);
            Ok((lower::statements(&steps), Type::Void))
        })
    }

    /// The target of a control (`set`): the program stores `value` there. Without a known type of `value` it
    /// may be anything.
    pub fn assignment(&mut self, target: &str) -> Compiled {
        let parsed = parse_expression(target);
        let given = self.value.unwrap_or(Type::Any);
        self.compile(target, parsed.diagnostics, Mode::Target, |binder| {
            let step = Step::Effect(binder.set(&parsed.tree, given)?);
            Ok((lower::statements(&[step]), Type::Void))
        })
    }

    fn compile(
        &mut self,
        source: &str,
        diagnostics: Vec<Diagnostic>,
        mode: Mode,
        work: impl FnOnce(&mut Binder<'_>) -> Attempt<(crate::vm::Code, Type)>,
    ) -> Compiled {
        let id = self.globals.next_program();
        let mut binder = Binder {
            schema: self.schema,
            globals: self.globals,
            value: self.value,
            source,
            mode,
            program: id,
            diagnostics,
            effects: Effects::default(),
            aggregates: Vec::new(),
            next_aggregate: 0,
            locals: Vec::new(),
            reassigned: BTreeSet::new(),
            declared_later: Vec::new(),
        };
        let done = work(&mut binder);
        let Binder { diagnostics, effects, aggregates, .. } = binder;
        let failed = diagnostics.iter().any(Diagnostic::is_error);
        let program = done.ok().filter(|_| !failed);
        let program = program.map(|(code, result)| Program { code, effects, result, aggregates });
        Compiled { id, program, diagnostics: in_order(diagnostics) }
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
    /// A function of the host, not yet called.
    Function(FunctionId),
    /// `Math`
    Math,
    /// A function of `Math`, not yet called.
    MathFunction(math::Function),
    /// `ctx`
    Globals,
    /// `.fill` or `.set` of a field, not yet called.
    Method(Method, Field),
}

/// Methods of arrays.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Method {
    Fill,
    Set,
}

/// A name that the text declares.
#[derive(Clone, Debug)]
struct Local {
    name: String,
    constant: bool,
    meaning: Meaning,
}

/// What a declared name stands for.
#[derive(Clone, Debug)]
enum Meaning {
    /// A value, kept under a number.
    Slot(u32, Type),
    /// Another word for a thing: `const v = data.qvel`.
    Alias(Thing),
    /// Its declaration has a mistake, reported there.
    Unknown,
}

/// The work on one text.
struct Binder<'a> {
    schema: &'a dyn Schema,
    globals: &'a mut Globals,
    value: Option<Type>,
    source: &'a str,
    mode: Mode,
    program: ProgramId,
    diagnostics: Vec<Diagnostic>,
    effects: Effects,
    aggregates: Vec<Aggregate>,
    next_aggregate: usize,
    locals: Vec<Local>,
    /// Names that are assigned after their declaration.
    reassigned: BTreeSet<String>,
    /// Names that this text declares further down.
    declared_later: Vec<String>,
}

impl Binder<'_> {
    fn report(&mut self, diagnostic: Diagnostic) {
        self.diagnostics.push(diagnostic);
    }

    fn refuse<T>(&mut self, diagnostic: Diagnostic) -> Attempt<T> {
        self.diagnostics.push(diagnostic);
        Err(Reported)
    }

    /// The source of a part.
    fn text(&self, span: Span) -> &str {
        span.text(self.source)
    }

    fn statements(&mut self, statements: &[Stmt]) -> Vec<Step> {
        self.prepare(statements);
        let mut steps = Vec::new();
        for statement in statements {
            self.statement(statement, &mut steps);
        }
        steps
    }
}

/// The finding for a function without a result where a value must stand.
fn no_result(span: Span, source: &str) -> Diagnostic {
    let name = span.text(source).split('(').next().unwrap_or("");
    Diagnostic::error(code::NO_RESULT, span, format!("`{name}` gives nothing back"))
        .why("it is called for what it does; there is no value to go on with")
        .help("call it as a statement of its own, in `setup`, `controller`, `apply` or `run`")
}
