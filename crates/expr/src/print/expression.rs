//! Prints expressions, with parentheses only where the tree requires them.

use super::literal::{is_word, number_text, quote, template_text};
use super::printer::{ASSIGNMENT, ATOM, CHOICE, MEMBER, Printer, SIGN, UPDATE, power};
use crate::ast::{BinaryOp, Expr, ExprKind, LogicalOp, Property, UnaryOp};

impl Printer<'_> {
    /// Prints a tree whose context requires a binding power of at least `least`.
    pub(super) fn expr(&mut self, expr: &Expr, least: u8) {
        let enclosed = power(expr) < least;
        if enclosed {
            self.put("(");
        }
        self.kind(expr);
        if enclosed {
            self.put(")");
        }
    }

    pub(super) fn kind(&mut self, expr: &Expr) {
        match &expr.kind {
            ExprKind::Number(x) => match expr.span.text(self.source) {
                "" => self.put(&number_text(*x)),
                // The span of a parenthesized literal may include the parentheses.
                written => {
                    self.put(written.trim_matches(|c: char| matches!(c, '(' | ')') || c.is_whitespace()))
                }
            },
            ExprKind::String(text) => quote(text, &mut self.out),
            ExprKind::Boolean(b) => self.put(if *b { "true" } else { "false" }),
            ExprKind::Null => self.put("null"),
            ExprKind::Name(name) => self.put(name),
            ExprKind::Error => self.put("<error>"),
            ExprKind::Chain(inner) => self.kind(inner),
            ExprKind::Array(items) => {
                self.put("[");
                self.items(items);
                self.put("]");
            }
            ExprKind::Spread(items) => {
                self.put("...");
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
                self.put(if *optional { "?." } else { "." });
                self.put(&name.text);
            }
            ExprKind::Index { object, index, optional } => {
                self.expr(object, MEMBER);
                self.put(if *optional { "?.[" } else { "[" });
                // An assignment in an index is valid only in parentheses.
                self.expr(index, CHOICE);
                self.put("]");
            }
            ExprKind::Call { callee, args, optional } => {
                self.expr(callee, MEMBER);
                self.put(if *optional { "?.(" } else { "(" });
                self.items(args);
                self.put(")");
            }
            _ => {}
        }
    }

    /// Prints operators, and expressions joined by commas.
    fn operation(&mut self, expr: &Expr) {
        match &expr.kind {
            ExprKind::Unary { op, operand } => {
                self.put(op.symbol());
                // A space keeps `- -x`, `+ ++x` and `typeof x` apart.
                let runs = starts_with_sign(operand) && matches!(op, UnaryOp::Minus | UnaryOp::Plus);
                if runs || *op == UnaryOp::TypeOf {
                    self.put(" ");
                }
                self.expr(operand, SIGN);
            }
            ExprKind::Binary { op, left, right } => {
                let p = op.power();
                // `**` is right-associative and allows no unary operator on its left; all others are left-associative.
                let (l, r) = if *op == BinaryOp::Power { (UPDATE, p) } else { (p, p + 1) };
                self.between(left, l, op.symbol(), right, r);
            }
            ExprKind::Logical { op, left, right } => {
                self.logical_operand(*op, left, op.power());
                self.put(" ");
                self.put(op.symbol());
                self.put(" ");
                self.logical_operand(*op, right, op.power() + 1);
            }
            ExprKind::Conditional { test, then, otherwise } => {
                self.expr(test, CHOICE + 1);
                self.put(" ? ");
                self.expr(then, ASSIGNMENT);
                self.put(" : ");
                self.expr(otherwise, ASSIGNMENT);
            }
            ExprKind::Sequence(parts) => {
                for (i, part) in parts.iter().enumerate() {
                    if i > 0 {
                        self.put(", ");
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
                self.between(target, UPDATE, &symbol, value, ASSIGNMENT);
            }
            ExprKind::AssignLogical { target, op, value, .. } => {
                self.between(target, UPDATE, &format!("{}=", op.symbol()), value, ASSIGNMENT);
            }
            ExprKind::Update { target, increment, prefix } => {
                let symbol = if *increment { "++" } else { "--" };
                if *prefix {
                    self.put(symbol);
                    self.expr(target, SIGN);
                } else {
                    self.expr(target, UPDATE);
                    self.put(symbol);
                }
            }
            _ => {}
        }
    }

    fn template(&mut self, texts: &[String], values: &[Expr]) {
        self.put("`");
        for (i, text) in texts.iter().enumerate() {
            template_text(text, &mut self.out);
            if let Some(value) = values.get(i) {
                self.put("${");
                self.expr(value, ASSIGNMENT);
                self.put("}");
            }
        }
        self.put("`");
    }

    pub(super) fn object(&mut self, properties: &[Property]) {
        self.put("{");
        for (i, property) in properties.iter().enumerate() {
            if i > 0 {
                self.put(", ");
            }
            match property {
                Property::Named { key, value } => {
                    let short = matches!(&value.kind, ExprKind::Name(name) if *name == key.text);
                    if !short {
                        if is_word(&key.text) {
                            self.put(&key.text);
                        } else {
                            quote(&key.text, &mut self.out);
                        }
                        self.put(": ");
                    }
                    self.expr(value, ASSIGNMENT);
                }
                Property::Computed { key, value } => {
                    self.put("[");
                    self.expr(key, ASSIGNMENT);
                    self.put("]: ");
                    self.expr(value, ASSIGNMENT);
                }
                Property::Spread(value) => {
                    self.put("...");
                    self.expr(value, ASSIGNMENT);
                }
            }
        }
        self.put("}");
    }

    pub(super) fn between(&mut self, left: &Expr, l: u8, symbol: &str, right: &Expr, r: u8) {
        self.expr(left, l);
        self.put(" ");
        self.put(symbol);
        self.put(" ");
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
                self.put(", ");
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
