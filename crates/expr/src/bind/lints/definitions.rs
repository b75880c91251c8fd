//! The constants that a text declares, and declarations that hide a variable.

use super::pass::LintPass;
use crate::ast::{Declarator, Expr, ExprKind, Name, Pattern, Stmt, StmtKind};
use crate::rules;
use labspec_finding::{Finding, Span};

/// The limit on constants that are defined by other constants.
const MAX_HOPS: usize = 8;

impl<'l> LintPass<'l> {
    /// The expression that a constant stands for; any other expression stands for itself.
    pub(super) fn definition<'e>(&self, expr: &'e Expr) -> &'e Expr
    where
        'l: 'e,
    {
        let mut expr = expr;
        for _ in 0..MAX_HOPS {
            let ExprKind::Name(name) = &expr.kind else { return expr };
            match self.definitions.get(name.as_str()) {
                Some(Some(value)) => expr = value,
                _ => return expr,
            }
        }
        expr
    }

    /// Warns about a declaration in a block that hides a variable around it, and that nothing reads.
    pub(super) fn lost_declarations(&mut self, statements: &[Stmt]) -> Vec<String> {
        let (Some(first), Some(last)) = (statements.first(), statements.last()) else { return Vec::new() };
        let block = first.span.to(last.span);
        let mut names = Vec::new();
        for statement in statements {
            let StmtKind::Declare { declarators, .. } = &statement.kind else { continue };
            for declarator in declarators {
                let Pattern::Name(name) = &declarator.target else { continue };
                let hides = self.scopes.iter().flatten().any(|outer| *outer == name.text);
                if hides && !self.reads(block, &name.text) {
                    let alone = declarators.len() == 1;
                    self.lost_declaration(name, declarator, statement.span.start, alone);
                }
                names.push(name.text.clone());
            }
        }
        names
    }

    /// Whether a part of the text reads a variable, so that it does more than store it.
    fn reads(&self, span: Span, name: &str) -> bool {
        let text = self.text(span);
        let is_part = |c: char| c.is_alphanumeric() || c == '_' || c == '$';
        text.match_indices(name).any(|(at, _)| {
            let before = text.get(..at).unwrap_or("");
            let after = text.get(at + name.len()..).unwrap_or("");
            let is_word = !before.ends_with(|c| is_part(c) || c == '.') && !after.starts_with(is_part);
            let next = after.trim_start();
            let stores = next.starts_with('=') && !next.starts_with("==") && !next.starts_with("=>");
            is_word && !stores
        })
    }

    fn lost_declaration(&mut self, declared: &Name, declarator: &Declarator, start: usize, alone: bool) {
        let name = &declared.text;
        let report = Finding::new(
            rules::LOST_DECLARATION,
            declared.span,
            format!("this is a new variable `{name}`, and nothing reads it"),
        );
        self.found.push(match declarator.value.as_ref().filter(|_| alone) {
            Some(value) => {
                let meant = format!("{name} = {}", self.text(value.span));
                let whole = Span::new(start, value.span.end);
                report.help(format!("to change the outer `{name}`, write `{meant}`")).guess(whole, meant)
            }
            None => report.help(format!("to change the outer `{name}`, assign it without `let`")),
        });
    }
}
