//! What stands twice where it is meant once: an element that is stored and at once stored again, an argument beside itself.

use super::pass::LintPass;
use crate::ast::{Expr, ExprKind, Stmt, StmtKind};
use crate::rules;
use labspec_finding::{Finding, Span};

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

/// Most bytes of a text that is compared, and most arguments of a call: what is longer was not copied by hand.
const LONG: usize = 400;
const MANY: usize = 8;

impl LintPass<'_> {
    /// A text without its spaces; `None` where it is long.
    fn bare(&self, span: Span) -> Option<String> {
        let text = self.text(span);
        (text.len() <= LONG).then(|| text.chars().filter(|c| !c.is_whitespace()).collect())
    }

    /// Two statements, one behind the other, that store the same element: the first is lost.
    pub(super) fn stored_twice(&mut self, statements: &[Stmt]) {
        for pair in statements.windows(2) {
            let [Some((first, _)), Some((second, value))] = [0, 1].map(|i| pair.get(i).and_then(stored))
            else {
                continue;
            };
            let texts = [first.span, second.span, value.span].map(|span| self.bare(span));
            let [Some(one), Some(two), Some(used)] = texts else { continue };
            // What the second computes may use the first.
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
                // The first says it; the others may follow from it.
                return;
            }
        }
    }

    /// One argument twice, where two are meant.
    pub(super) fn same_argument(&mut self, callee: &Expr, args: &[Expr]) {
        if args.len() > MANY || !self.bare(callee.span).is_some_and(|name| FUNCTIONS.contains(&name.as_str()))
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
                    .why("a maximum or minimum of both is the same, and a length counts it twice")
                    .help("check the index: one of the two probably belongs to another element"),
                );
                return;
            }
        }
    }
}
