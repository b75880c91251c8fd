//! The formatter for authors: numbers keep their spelling, and a text of one line stays on one line.

use super::printer::{ASSIGNMENT, Printer};
use crate::ast::{Expr, Stmt, StmtKind};
use crate::lex::{TokenKind, tokens};
use crate::parse::{parse_expression, parse_statements};
use labspec_finding::Finding;

/// The text of an expression. An invalid part is printed as `<error>`.
pub fn print(expr: &Expr) -> String {
    let mut printer = Printer::default();
    printer.expr(expr, ASSIGNMENT);
    printer.out
}

/// The text of statements, one per line, with blocks indented by two spaces.
pub fn print_statements(statements: &[Stmt]) -> String {
    let mut printer = Printer::default();
    printer.lines(statements);
    printer.out
}

/// Formats an expression. Returns `None` if it has errors, or comments, which a tree does not contain.
pub fn format_expression(source: &str) -> Option<String> {
    let parsed = parse_expression(source);
    if has_comments(source) || parsed.diagnostics.iter().any(Finding::is_error) {
        return None;
    }
    let mut printer = Printer { source, ..Printer::default() };
    printer.expr(&parsed.tree, ASSIGNMENT);
    let again = parse_expression(&printer.out);
    (shape(&again.tree) == shape(&parsed.tree)).then_some(printer.out)
}

/// Formats statements: one per line, or all on one line if the source is one line. Returns `None` as
/// [`format_expression`] does.
pub fn format_statements(source: &str) -> Option<String> {
    let parsed = parse_statements(source);
    if has_comments(source) || parsed.diagnostics.iter().any(Finding::is_error) {
        return None;
    }
    let line = !source.trim().contains(['\n', '\r']);
    let mut printer = Printer { source, line, ..Printer::default() };
    printer.lines(&parsed.tree);
    let last = parsed.tree.last().map(|s| &s.kind);
    if line && matches!(last, Some(StmtKind::Expr(_) | StmtKind::Declare { .. } | StmtKind::Return(_))) {
        printer.out.pop();
    }
    let again = parse_statements(&printer.out);
    (shape(&again.tree) == shape(&parsed.tree)).then_some(printer.out)
}

/// A tree without its spans. Two texts with the same shape have the same meaning. Comparing printed texts instead would not
/// reveal what the printer itself has lost.
fn shape(tree: &impl std::fmt::Debug) -> String {
    let text = format!("{tree:?}");
    let mut parts = text.split("Span { start: ");
    let mut bare = parts.next().unwrap_or("").to_string();
    for part in parts {
        let rest = part.split_once(", end: ").map_or(part, |(_, end)| end);
        bare.push_str(rest.trim_start_matches(|c: char| c.is_ascii_digit()));
    }
    bare
}

/// Whether there is a comment between the tokens, or possibly in a template.
fn has_comments(source: &str) -> bool {
    let opens = |text: &str| text.contains("//") || text.contains("/*");
    let mut offset = 0;
    for token in tokens(source, &mut Vec::new()) {
        let template = matches!(token.kind, TokenKind::Template(..)) && opens(token.span.text(source));
        if template || opens(source.get(offset..token.span.start).unwrap_or("")) {
            return true;
        }
        offset = token.span.end;
    }
    false
}
