//! Lints about duplicates: an element that is stored twice in succession, and an argument that is passed twice.

use super::pass::LintPass;
use crate::ast::{Expr, ExprKind, Stmt, StmtKind};
use crate::rules;
use labspec_finding::{Finding, Span};

/// Functions for which a repeated argument is redundant (`Math.max`, `Math.min`) or a mistake (`Math.hypot`).
const FUNCTIONS: [&str; 3] = ["Math.hypot", "Math.max", "Math.min"];

/// The target and the value of a plain assignment to an element.
fn stored(statement: &Stmt) -> Option<(&Expr, &Expr)> {
    let StmtKind::Expr(Expr { kind: ExprKind::Assign { op: None, target, value, .. }, .. }) = &statement.kind
    else {
        return None;
    };
    matches!(target.kind, ExprKind::Index { .. }).then_some((target, value))
}

/// Limits on the bytes of a compared text and on the arguments of a call. Longer code was not copied by hand.
const MAX_TEXT: usize = 400;
const MAX_ARGUMENTS: usize = 8;

impl LintPass<'_> {
    /// A text without its whitespace, or `None` if it is too long.
    pub(super) fn bare(&self, span: Span) -> Option<String> {
        let text = self.text(span);
        (text.len() <= MAX_TEXT).then(|| text.chars().filter(|c| !c.is_whitespace()).collect())
    }

    /// Warns about two consecutive statements that store the same element: the first value is lost.
    pub(super) fn stored_twice(&mut self, statements: &[Stmt]) {
        for pair in statements.windows(2) {
            let [Some((first, _)), Some((second, value))] = [0, 1].map(|i| pair.get(i).and_then(stored))
            else {
                continue;
            };
            let texts = [first.span, second.span, value.span].map(|span| self.bare(span));
            let [Some(one), Some(two), Some(used)] = texts else { continue };
            // The second value may use the first.
            if one == two && !used.contains(&one) && !used.contains("=>") && !one.contains("++") {
                self.found.push(
                    Finding::warning(
                        rules::STORED_TWICE,
                        first.span,
                        format!("`{one}` is stored twice in a row"),
                    )
                    .why("the value of the first statement is lost before anything reads it")
                    .help("check the index: one of the two probably belongs to another element"),
                );
                // One finding is enough: further duplicates may follow from it.
                return;
            }
        }
    }

    /// Warns about an argument that is passed twice where two different ones are intended.
    pub(super) fn same_argument(&mut self, callee: &Expr, args: &[Expr]) {
        if args.len() > MAX_ARGUMENTS
            || !self.bare(callee.span).is_some_and(|name| FUNCTIONS.contains(&name.as_str()))
        {
            return;
        }
        let texts: Vec<Option<String>> = args.iter().map(|arg| self.bare(arg.span)).collect();
        for (i, (arg, text)) in args.iter().zip(&texts).enumerate() {
            let Some(text) = text else { continue };
            let number = matches!(arg.kind, ExprKind::Number(_));
            if !number && texts.iter().take(i).flatten().any(|other| other == text) {
                self.found.push(
                    Finding::warning(
                        rules::SAME_ARGUMENT,
                        arg.span,
                        format!("`{text}` is an argument twice"),
                    )
                    .why("the maximum or minimum of equal numbers is that number, and a length counts it twice")
                    .help("check the index: one of the two probably belongs to another element"),
                );
                return;
            }
        }
    }
}
