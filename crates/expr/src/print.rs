//! Tree to text: one layout, parentheses only where the tree needs them. Reading the result gives the tree back.

use crate::ast::{BinaryOp, Expr, ExprKind, Stmt, StmtKind, UnaryOp};
use crate::number;

/// Binding powers beyond those of the operators, see [`BinaryOp::power`].
const ASSIGNMENT: u8 = 1;
const CHOICE: u8 = 2;
const SIGN: u8 = 15;
const UPDATE: u8 = 16;
const MEMBER: u8 = 17;

/// The text of an expression. A part that could not be read prints as `<error>`.
pub fn print(expr: &Expr) -> String {
    let mut out = String::new();
    write(expr, ASSIGNMENT, &mut out);
    out
}

/// The text of statements, one a line.
pub fn print_statements(statements: &[Stmt]) -> String {
    let mut out = String::new();
    for (i, statement) in statements.iter().enumerate() {
        if i > 0 {
            out.push('\n');
        }
        match &statement.kind {
            StmtKind::Expr(expr) => write(expr, ASSIGNMENT, &mut out),
            StmtKind::Error => out.push_str("<error>"),
            StmtKind::Declare { constant, declarators } => {
                out.push_str(if *constant { "const " } else { "let " });
                for (i, declarator) in declarators.iter().enumerate() {
                    if i > 0 {
                        out.push_str(", ");
                    }
                    out.push_str(&declarator.name.text);
                    if let Some(value) = &declarator.value {
                        out.push_str(" = ");
                        write(value, ASSIGNMENT, &mut out);
                    }
                }
            }
        }
        out.push(';');
    }
    out
}

/// How tightly the outermost operator of a tree binds.
fn power(expr: &Expr) -> u8 {
    match &expr.kind {
        ExprKind::Assign { .. } => ASSIGNMENT,
        ExprKind::Conditional { .. } => CHOICE,
        ExprKind::Logical { op, .. } => op.power(),
        ExprKind::Binary { op, .. } => op.power(),
        ExprKind::Unary { .. } => SIGN,
        ExprKind::Update { .. } => UPDATE,
        _ => MEMBER,
    }
}

/// Writes a tree where an operator around it needs at least `least`.
fn write(expr: &Expr, least: u8, out: &mut String) {
    let enclosed = power(expr) < least;
    if enclosed {
        out.push('(');
    }
    write_kind(&expr.kind, out);
    if enclosed {
        out.push(')');
    }
}

fn write_kind(kind: &ExprKind, out: &mut String) {
    match kind {
        ExprKind::Number(x) => out.push_str(&number_text(*x)),
        ExprKind::String(text) => quote(text, out),
        ExprKind::Boolean(b) => out.push_str(if *b { "true" } else { "false" }),
        ExprKind::Null => out.push_str("null"),
        ExprKind::Name(name) => out.push_str(name),
        ExprKind::Error => out.push_str("<error>"),
        ExprKind::Member { object, name } => {
            // `1.x` would be read as the number `1.`
            let digits = matches!(object.kind, ExprKind::Number(_));
            write(object, if digits { MEMBER + 1 } else { MEMBER }, out);
            out.push('.');
            out.push_str(&name.text);
        }
        ExprKind::Index { object, index } => {
            write(object, MEMBER, out);
            out.push('[');
            // An assignment in an index is read only in parentheses.
            write(index, CHOICE, out);
            out.push(']');
        }
        ExprKind::Call { callee, args } => {
            write(callee, MEMBER, out);
            write_list('(', args, ')', out);
        }
        ExprKind::Array(items) => write_list('[', items, ']', out),
        ExprKind::Unary { op, operand } => {
            out.push_str(op.symbol());
            // `- -x` and `+ ++x` must not run together.
            if starts_with_sign(operand) && matches!(op, UnaryOp::Minus | UnaryOp::Plus) {
                out.push(' ');
            }
            write(operand, SIGN, out);
        }
        ExprKind::Binary { op, left, right } => {
            let p = op.power();
            // `**` groups from the right and takes no sign on its left; all others group from the left.
            let (l, r) = if *op == BinaryOp::Power { (UPDATE, p) } else { (p, p + 1) };
            write_between(left, l, op.symbol(), right, r, out);
        }
        ExprKind::Logical { op, left, right } => {
            write_between(left, op.power(), op.symbol(), right, op.power() + 1, out);
        }
        ExprKind::Conditional { test, then, otherwise } => {
            write(test, CHOICE + 1, out);
            out.push_str(" ? ");
            write(then, ASSIGNMENT, out);
            out.push_str(" : ");
            write(otherwise, ASSIGNMENT, out);
        }
        ExprKind::Assign { target, op, value, .. } => {
            let symbol = format!("{}=", op.map_or("", |o| o.symbol()));
            write_between(target, UPDATE, &symbol, value, ASSIGNMENT, out);
        }
        ExprKind::Update { target, increment, prefix } => {
            let symbol = if *increment { "++" } else { "--" };
            if *prefix {
                out.push_str(symbol);
                write(target, SIGN, out);
            } else {
                write(target, UPDATE, out);
                out.push_str(symbol);
            }
        }
    }
}

fn write_between(left: &Expr, l: u8, symbol: &str, right: &Expr, r: u8, out: &mut String) {
    write(left, l, out);
    out.push(' ');
    out.push_str(symbol);
    out.push(' ');
    write(right, r, out);
}

fn write_list(open: char, items: &[Expr], close: char, out: &mut String) {
    out.push(open);
    for (i, item) in items.iter().enumerate() {
        if i > 0 {
            out.push_str(", ");
        }
        write(item, ASSIGNMENT, out);
    }
    out.push(close);
}

/// Whether the text of an operand starts with `+` or `-`.
fn starts_with_sign(expr: &Expr) -> bool {
    matches!(
        &expr.kind,
        ExprKind::Unary { op: UnaryOp::Minus | UnaryOp::Plus, .. } | ExprKind::Update { prefix: true, .. }
    )
}

/// A literal never holds a sign; an infinite one is written so that it is read as infinite again.
fn number_text(x: f64) -> String {
    if x.is_infinite() { "1e999".into() } else { number::to_text(x) }
}

fn quote(text: &str, out: &mut String) {
    out.push('"');
    for c in text.chars() {
        match c {
            '"' | '\\' => out.extend(['\\', c]),
            '\n' => out.push_str("\\n"),
            '\t' => out.push_str("\\t"),
            '\r' => out.push_str("\\r"),
            c if c.is_control() || matches!(c, '\u{2028}' | '\u{2029}') => {
                out.push_str(&format!("\\u{{{:x}}}", u32::from(c)));
            }
            c => out.push(c),
        }
    }
    out.push('"');
}
