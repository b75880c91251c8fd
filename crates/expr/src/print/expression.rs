//! Prints expressions, with parentheses only where the tree requires them.

use super::literal::{is_word, number_text, quote, template_text};
use super::printer::{ASSIGNMENT, ATOM, CHOICE, MEMBER, Printer, SIGN, UPDATE, power};
use crate::ast::{BinaryOp, Expr, ExprKind, LogicalOp, Property, UnaryOp};

impl Printer<'_> {
    /// Prints a tree whose context requires a binding power of at least `least`.
    pub(super) fn expr(&mut self, expr: &Expr, least: u8) {
        let enclosed = power(expr) < least;
        if enclosed {
            self.append("(");
        }
        self.kind(expr);
        if enclosed {
            self.append(")");
        }
    }

    pub(super) fn kind(&mut self, expr: &Expr) {
        match &expr.kind {
            ExprKind::Number(x) => match expr.span.text(self.source) {
                "" => self.append(&number_text(*x)),
                // The span of a parenthesized literal may include the parentheses.
                written => {
                    self.append(written.trim_matches(|c: char| matches!(c, '(' | ')') || c.is_whitespace()))
                }
            },
            ExprKind::String(text) => quote(text, &mut self.out),
            ExprKind::Boolean(b) => self.append(if *b { "true" } else { "false" }),
            ExprKind::Null => self.append("null"),
            ExprKind::Name(name) => self.append(name),
            ExprKind::Error => self.append("<error>"),
            ExprKind::Chain(inner) => self.kind(inner),
            ExprKind::Array(items) => {
                self.append("[");
                self.items(items);
                self.append("]");
            }
            ExprKind::Spread(items) => {
                self.append("...");
                self.expr(items, ASSIGNMENT);
            }
            ExprKind::Object(properties) => self.object(properties),
            ExprKind::Template { texts, values } => self.template(texts, values),
            ExprKind::Function(function) => self.function(function),
            ExprKind::Member { .. } | ExprKind::Index { .. } | ExprKind::Call { .. } => self.postfix(expr),
            ExprKind::Assign { .. } | ExprKind::AssignLogical { .. } | ExprKind::Update { .. } => {
                self.change(expr)
            }
            _ => self.operation(expr),
        }
    }

    /// Prints a member, an element or a call.
    fn postfix(&mut self, expr: &Expr) {
        match &expr.kind {
            ExprKind::Member { object, name, optional } => {
                // `1.x` would be parsed as the number `1.`.
                let digits = matches!(object.kind, ExprKind::Number(_));
                self.expr(object, if digits { ATOM + 1 } else { MEMBER });
                self.append(if *optional { "?." } else { "." });
                self.append(&name.text);
            }
            ExprKind::Index { object, index, optional } => {
                self.expr(object, MEMBER);
                self.append(if *optional { "?.[" } else { "[" });
                // An assignment in an index is valid only in parentheses.
                self.expr(index, CHOICE);
                self.append("]");
            }
            ExprKind::Call { callee, args, optional } => {
                self.expr(callee, MEMBER);
                self.append(if *optional { "?.(" } else { "(" });
                self.items(args);
                self.append(")");
            }
            _ => {}
        }
    }

    /// Prints operators, and expressions joined by commas.
    fn operation(&mut self, expr: &Expr) {
        match &expr.kind {
            ExprKind::Unary { op, operand } => {
                self.append(op.symbol());
                // A space separates the operators of `- -x`, `+ ++x` and `typeof x`.
                let runs = starts_with_sign(operand) && matches!(op, UnaryOp::Minus | UnaryOp::Plus);
                if runs || *op == UnaryOp::TypeOf {
                    self.append(" ");
                }
                self.expr(operand, SIGN);
            }
            ExprKind::Binary { op, left, right } => {
                let p = op.power();
                // `**` is right-associative and allows no unary operator on its left; all others are left-associative.
                let (l, r) = if *op == BinaryOp::Power { (UPDATE, p) } else { (p, p + 1) };
                self.binary_operation(left, l, op.symbol(), right, r);
            }
            ExprKind::Logical { op, left, right } => {
                self.logical_operand(*op, left, op.power());
                self.append(" ");
                self.append(op.symbol());
                self.append(" ");
                self.logical_operand(*op, right, op.power() + 1);
            }
            ExprKind::Conditional { test, then, otherwise } => {
                self.expr(test, CHOICE + 1);
                self.append(" ? ");
                self.expr(then, ASSIGNMENT);
                self.append(" : ");
                self.expr(otherwise, ASSIGNMENT);
            }
            ExprKind::Sequence(parts) => {
                for (i, part) in parts.iter().enumerate() {
                    if i > 0 {
                        self.append(", ");
                    }
                    self.expr(part, ASSIGNMENT);
                }
            }
            _ => {}
        }
    }

    /// Prints assignments, `++` and `--`.
    fn change(&mut self, expr: &Expr) {
        match &expr.kind {
            ExprKind::Assign { target, op, value, .. } => {
                let symbol = format!("{}=", op.map_or("", |o| o.symbol()));
                self.binary_operation(target, UPDATE, &symbol, value, ASSIGNMENT);
            }
            ExprKind::AssignLogical { target, op, value, .. } => {
                self.binary_operation(target, UPDATE, &format!("{}=", op.symbol()), value, ASSIGNMENT);
            }
            ExprKind::Update { target, increment, prefix } => {
                let symbol = if *increment { "++" } else { "--" };
                if *prefix {
                    self.append(symbol);
                    self.expr(target, SIGN);
                } else {
                    self.expr(target, UPDATE);
                    self.append(symbol);
                }
            }
            _ => {}
        }
    }

    fn template(&mut self, texts: &[String], values: &[Expr]) {
        self.append("`");
        for (i, text) in texts.iter().enumerate() {
            template_text(text, &mut self.out);
            if let Some(value) = values.get(i) {
                self.append("${");
                self.expr(value, ASSIGNMENT);
                self.append("}");
            }
        }
        self.append("`");
    }

    pub(super) fn object(&mut self, properties: &[Property]) {
        self.append("{");
        for (i, property) in properties.iter().enumerate() {
            if i > 0 {
                self.append(", ");
            }
            match property {
                Property::Named { key, value } => {
                    let short = matches!(&value.kind, ExprKind::Name(name) if *name == key.text);
                    if !short {
                        if is_word(&key.text) {
                            self.append(&key.text);
                        } else {
                            quote(&key.text, &mut self.out);
                        }
                        self.append(": ");
                    }
                    self.expr(value, ASSIGNMENT);
                }
                Property::Computed { key, value } => {
                    self.append("[");
                    self.expr(key, ASSIGNMENT);
                    self.append("]: ");
                    self.expr(value, ASSIGNMENT);
                }
                Property::Spread(value) => {
                    self.append("...");
                    self.expr(value, ASSIGNMENT);
                }
            }
        }
        self.append("}");
    }

    pub(super) fn binary_operation(&mut self, left: &Expr, l: u8, symbol: &str, right: &Expr, r: u8) {
        self.expr(left, l);
        self.append(" ");
        self.append(symbol);
        self.append(" ");
        self.expr(right, r);
    }

    /// `??` can be combined with `||` and `&&` only in parentheses.
    fn logical_operand(&mut self, op: LogicalOp, operand: &Expr, least: u8) {
        let mixes = matches!(&operand.kind, ExprKind::Logical { op: other, .. }
            if (*other == LogicalOp::Nullish) != (op == LogicalOp::Nullish));
        self.expr(operand, if mixes { ATOM + 1 } else { least });
    }

    pub(super) fn items(&mut self, items: &[Expr]) {
        for (i, item) in items.iter().enumerate() {
            if i > 0 {
                self.append(", ");
            }
            self.expr(item, ASSIGNMENT);
        }
    }
}

/// Whether the printed operand starts with `+` or `-`.
fn starts_with_sign(expr: &Expr) -> bool {
    matches!(
        &expr.kind,
        ExprKind::Unary { op: UnaryOp::Minus | UnaryOp::Plus, .. } | ExprKind::Update { prefix: true, .. }
    )
}
