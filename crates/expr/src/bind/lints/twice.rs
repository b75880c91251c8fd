//! What stands twice where it is meant once: an element that is stored and at once stored again, an argument beside itself.

use super::Look;
use crate::ast::{Expr, ExprKind, Stmt, StmtKind};
use crate::rules;
use crate::{Finding, Span};

/// Functions that a second argument of the same value says nothing to, or says wrongly.
const FUNCTIONS: [&str; 3] = ["Math.hypot", "Math.max", "Math.min"];

/// What a statement stores, and what it stores there: a plain assignment to an element.
fn stored(statement: &Stmt) -> Option<(&Expr, &Expr)> {
    let StmtKind::Expr(Expr { kind: ExprKind::Assign { op: None, target, value, .. }, .. }) = &statement.kind
    else {
        return None;
    };
    matches!(target.kind, ExprKind::Index { .. }).then_some((target, value))
}

impl Look<'_> {
    fn bare(&self, span: Span) -> String {
        self.text(span).chars().filter(|c| !c.is_whitespace()).collect()
    }

    /// Two statements, one behind the other, that store the same element: the first is lost.
    pub(super) fn stored_twice(&mut self, statements: &[Stmt]) {
        for pair in statements.windows(2) {
            let [Some((first, _)), Some((second, value))] = [0, 1].map(|i| pair.get(i).and_then(stored))
            else {
                continue;
            };
            let [one, two, used] = [first.span, second.span, value.span].map(|span| self.bare(span));
            // What the second computes may use the first.
            if one == two && !used.contains(&one) && !used.contains("=>") && !one.contains("++") {
                self.found.push(
                    Finding::warning(
                        rules::STORED_TWICE,
                        first.span,
                        format!("`{one}` is stored, and at once stored again"),
                    )
                    .why("what the first statement stores is lost before anything reads it")
                    .help("look at the index: one of the two is meant for another element"),
                );
            }
        }
    }

    /// One argument twice, where two are meant.
    pub(super) fn same_argument(&mut self, callee: &Expr, args: &[Expr]) {
        if !FUNCTIONS.contains(&self.bare(callee.span).as_str()) {
            return;
        }
        for (i, arg) in args.iter().enumerate() {
            let text = self.bare(arg.span);
            let number = matches!(arg.kind, ExprKind::Number(_));
            if !number && args.iter().take(i).any(|other| self.bare(other.span) == text) {
                self.found.push(
                    Finding::warning(
                        rules::SAME_ARGUMENT,
                        arg.span,
                        format!("`{text}` is an argument twice"),
                    )
                    .why("the largest or the smallest of both is the same, and a length counts it double")
                    .help("look at the index: one of the two is meant for another element"),
                );
                return;
            }
        }
    }
}
