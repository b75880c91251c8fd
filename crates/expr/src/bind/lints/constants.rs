//! The constants that a text declares.

use crate::ast::{Body, Declarator, Expr, Pattern, Stmt, StmtKind};
use crate::bind::source::SourceTree;
use std::collections::BTreeMap;

/// The value of each constant that a text declares once; `None` for a name with several declarations.
pub(super) type Definitions<'t> = BTreeMap<&'t str, Option<&'t Expr>>;

pub(super) fn definitions<'t>(tree: SourceTree<'t>) -> Definitions<'t> {
    let mut all = Definitions::new();
    if let SourceTree::Statements(statements) = tree {
        statements.iter().for_each(|statement| collect(statement, &mut all));
    }
    all
}

fn collect<'t>(statement: &'t Stmt, all: &mut Definitions<'t>) {
    match &statement.kind {
        StmtKind::Declare { constant, declarators } => {
            for Declarator { target, value } in declarators {
                let Pattern::Name(name) = target else { continue };
                let is_new = !all.contains_key(name.text.as_str());
                all.insert(&name.text, value.as_ref().filter(|_| is_new && *constant));
            }
        }
        StmtKind::Function { function, .. } => {
            if let Body::Block(statements) = &function.body {
                statements.iter().for_each(|inner| collect(inner, all));
            }
        }
        StmtKind::If { then, otherwise, .. } => {
            collect(then, all);
            otherwise.iter().for_each(|inner| collect(inner, all));
        }
        StmtKind::For { init, body, .. } => {
            init.iter().for_each(|inner| collect(inner, all));
            collect(body, all);
        }
        StmtKind::ForOf { body, .. } | StmtKind::While { body, .. } | StmtKind::DoWhile { body, .. } => {
            collect(body, all);
        }
        StmtKind::Block(statements) => statements.iter().for_each(|inner| collect(inner, all)),
        _ => {}
    }
}
