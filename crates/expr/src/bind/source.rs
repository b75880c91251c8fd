//! A text that is read, its kind, and how deep it may be nested.

use crate::ast::{Expr, Stmt};
use crate::rules;
use labspec_finding::{Finding, Span};

/// How deep expressions, statements and functions that name each other may stand inside one another: every pass walks them by
/// recursion. Small functions keep its frames small: whatever builds a message is a function of its own, and not inlined.
pub(super) const MAX_LEVELS: usize = 200;

/// The finding for a text beyond [`MAX_LEVELS`].
pub(super) fn too_deep(span: Span) -> Finding {
    let message = format!("functions that call each other are nested more than {MAX_LEVELS} levels deep");
    Finding::error(rules::TOO_DEEP, span, message)
        .why("nested brackets, signs and functions count as levels")
        .help("split the text, or the functions")
}

/// A text, read.
#[derive(Clone, Copy)]
pub(super) enum SourceTree<'t> {
    /// A value.
    Expression(&'t Expr),
    Statements(&'t [Stmt]),
    /// What a control sets.
    Target(&'t Expr),
}

/// What kind of text is bound; decides what an assignment in it means.
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
