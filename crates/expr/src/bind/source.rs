//! A parsed source text, its kind, and the limit on its nesting.

use crate::ast::{Expr, Stmt};
use crate::rules;
use labspec_finding::{Finding, Span};

/// Limit on the nesting of expressions, statements and functions that name each other, because every pass visits them
/// recursively. Stack frames must stay small: code that builds a message is in a separate function that is not inlined.
pub(super) const MAX_LEVELS: usize = 200;

/// The finding for a text beyond [`MAX_LEVELS`].
pub(super) fn too_deep(span: Span) -> Finding {
    let message = format!("functions that call each other are nested more than {MAX_LEVELS} levels deep");
    Finding::error(rules::TOO_DEEP, span, message)
        .why("nested brackets, signs and functions count as levels")
        .help("split the text, or the functions")
}

/// A parsed source text.
#[derive(Clone, Copy)]
pub(super) enum SourceTree<'t> {
    /// An expression.
    Expression(&'t Expr),
    Statements(&'t [Stmt]),
    /// The target of a control.
    Target(&'t Expr),
}

/// The kind of a source text, which decides whether and how it may assign.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum TextKind {
    Expression,
    Statements,
    Target,
}

impl SourceTree<'_> {
    pub(super) fn mode(self) -> TextKind {
        match self {
            SourceTree::Expression(_) => TextKind::Expression,
            SourceTree::Statements(_) => TextKind::Statements,
            SourceTree::Target(_) => TextKind::Target,
        }
    }
}
