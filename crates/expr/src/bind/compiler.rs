//! The compiler for the programs of one lab: it runs the passes in order.

use super::lints;
use super::names::{self, NameContext};
use super::source::SourceTree;
use super::types::{self, BindContext, TypedText};
use crate::globals::{Globals, ProgramId};
use crate::parse::{self, Parsed, in_order};
use crate::program::Program;
use crate::rules;
use crate::schema::{Help, Schema};
use crate::types::Type;
use labspec_finding::order;

use labspec_finding::{Finding, Fix, Span};

/// Compiles the source texts of one lab.
pub struct Compiler<'s> {
    schema: &'s dyn Schema,
    globals: &'s mut Globals,
    value: Option<Type>,
    explains: bool,
    tells: bool,
    lint: Option<Lint>,
}

/// The pass of the lints. A compiler holds it only if it was asked for, so that a module which never asks does not contain it.
type Lint = fn(&dyn Schema, &str, SourceTree<'_>, &TypedText) -> Vec<Finding>;

/// The result of compiling one text.
#[derive(Clone, Debug)]
pub struct Compiled {
    /// The id of this program in [`Globals`].
    pub id: ProgramId,
    /// The program, or `None` if there are errors.
    pub program: Option<Program>,
    /// Findings in source order.
    pub diagnostics: Vec<Finding>,
    /// Help for the parts of the source text, for a user who points at them; empty unless requested.
    pub help: Vec<(Span, Help)>,
    /// Replacements of numeric indexes by object names: `data.qpos[9]` becomes `data.joint("light_free").qpos[2]`. Both
    /// denote the same element of the current model. Empty unless requested.
    pub named: Vec<Fix>,
}

impl Compiled {
    /// Returns the source with every numeric index that belongs to a named object replaced by the name.
    pub fn modernized(&self, source: &str) -> String {
        let mut out = String::new();
        let mut offset = 0;
        let mut fixes: Vec<&Fix> = self.named.iter().collect();
        order::sort_by_key(&mut fixes, |f| (f.span.start, f.span.end));
        for fix in fixes {
            // An index inside a replaced index is skipped.
            if let Some(before) = source.get(offset..fix.span.start) {
                out.push_str(before);
                out.push_str(&fix.text);
                offset = fix.span.end;
            }
        }
        out + source.get(offset..).unwrap_or("")
    }
}

impl<'s> Compiler<'s> {
    /// A compiler for source texts that refer to names of `schema` and share the variables `globals`. It reports errors, and
    /// the warnings that come with binding names and types.
    pub fn new(schema: &'s dyn Schema, globals: &'s mut Globals) -> Compiler<'s> {
        Compiler { schema, globals, value: None, explains: false, tells: false, lint: None }
    }

    /// A compiler for programs of a control with a `value` of this type, or `None` where no control supplies a value.
    pub fn with_value(self, value: Option<Type>) -> Compiler<'s> {
        Compiler { value, ..self }
    }

    /// A compiler that also computes [`Compiled::help`] and [`Compiled::named`]. These take longer than the compilation
    /// itself.
    pub fn explaining(self) -> Compiler<'s> {
        Compiler { explains: true, ..self }
    }

    /// A compiler that also reports code that is allowed but rarely intended. No such warning prevents a program.
    pub fn linting(self) -> Compiler<'s> {
        Compiler { lint: Some(lints::lint), ..self }
    }

    /// A compiler for a host that reports typographic quotes itself: a text with such quotes gives no program and no
    /// finding.
    pub fn without_quotes(self) -> Compiler<'s> {
        Compiler { tells: true, ..self }
    }

    /// Compiles an expression, such as a trace, a readout or a condition. It reads, and changes nothing unless it calls a
    /// function that does.
    pub fn expression(&mut self, source: &str) -> Compiled {
        let Parsed { tree, diagnostics, quotes_left_to_host } =
            parse::expression(source, self.schema.host_terms(), self.tells);
        self.compile(source, diagnostics, quotes_left_to_host, SourceTree::Expression(&tree))
    }

    /// Compiles statements: `setup`, `controller`, `apply`, `run`.
    pub fn statements(&mut self, source: &str) -> Compiled {
        let Parsed { tree, diagnostics, quotes_left_to_host } =
            parse::statements(source, self.schema.host_terms(), self.tells);
        self.compile(source, diagnostics, quotes_left_to_host, SourceTree::Statements(&tree))
    }

    /// Compiles the target of a control (`set`): the program stores `value` there. If the type of `value` is unknown, it
    /// may be any type.
    pub fn assignment(&mut self, target: &str) -> Compiled {
        let Parsed { tree, diagnostics, quotes_left_to_host } =
            parse::expression(target, self.schema.host_terms(), self.tells);
        self.compile(target, diagnostics, quotes_left_to_host, SourceTree::Target(&tree))
    }

    fn compile(
        &mut self,
        source: &str,
        mut found: Vec<Finding>,
        quotes_left_to_host: bool,
        tree: SourceTree<'_>,
    ) -> Compiled {
        let id = self.globals.next_program();
        let around = NameContext {
            schema: Some(self.schema),
            globals: self.globals,
            mode: tree.mode(),
            has_value: self.value.is_some(),
        };
        let (names, wrong) = names::resolve(around, |walk| match tree {
            SourceTree::Expression(expr) => walk.value(expr),
            SourceTree::Statements(statements) => walk.block(statements),
            SourceTree::Target(target) => walk.place(target),
        });
        found.extend(wrong);
        if names.stopped {
            return Compiled {
                id,
                program: None,
                diagnostics: in_order(found),
                help: Vec::new(),
                named: Vec::new(),
            };
        }
        let mut context = BindContext {
            schema: self.schema,
            globals: self.globals,
            value: self.value,
            explains: self.explains,
        };
        let bound = types::bind(&mut context, source, tree, &names, id);
        if let Some(lint) = self.lint {
            found.extend(lint(self.schema, source, tree, &bound.typed));
        }
        found.extend(bound.found);
        // An unresolved name without an error would silently remove code from the program.
        if let Some(span) = bound.unresolved.filter(|_| !found.iter().any(Finding::is_error)) {
            let name = source.get(span.start..span.end).unwrap_or("");
            found.push(Finding::error(rules::UNKNOWN_NAME, span, format!("`{name}` has no value here")));
        }
        let failed = quotes_left_to_host || found.iter().any(Finding::is_error);
        let parts = bound.program.filter(|_| !failed);
        let program = parts.map(|parts| {
            Program::new(&parts.tree, self.schema, parts.result, parts.aggregates, self.globals)
        });
        Compiled { id, program, diagnostics: in_order(found), help: bound.help, named: bound.named }
    }
}
