//! Expressions, parsed by binding power.
//!
//! The height of every tree is counted during its construction, so that no later stage, all of which are
//! recursive, can overflow the stack.

use super::node::{ASSIGNMENT, CHOICE, ExprNode, Infix, infix};
use super::parser::{Attempt, MAX_DEPTH, Parser, Reported};
use super::refuse;
use crate::ast::{BinaryOp, Expr, ExprKind, LogicalOp, Name};
use crate::lex::TokenKind;
use crate::rules;
use labspec_finding::{Finding, Span};

/// The operator of a compound assignment, or `Some(None)` for `=`.
fn assignment_op(symbol: &str) -> Option<Option<BinaryOp>> {
    if symbol == "=" {
        return Some(None);
    }
    let op = symbol.strip_suffix('=')?;
    BinaryOp::ALL.into_iter().find(|b| !b.is_comparison() && b.symbol() == op).map(Some)
}

/// The operator of `&&=`, `||=` or `??=`.
fn logical_assignment(symbol: &str) -> Option<LogicalOp> {
    let op = symbol.strip_suffix('=')?;
    LogicalOp::ALL.into_iter().find(|l| l.symbol() == op)
}

impl Parser<'_> {
    /// Parses an expression of any kind.
    pub(super) fn assignment(&mut self) -> Attempt<Expr> {
        Ok(self.expression(ASSIGNMENT)?.expr)
    }

    /// Parses an expression whose operators bind at least as tightly as `power`.
    pub(super) fn expression(&mut self, power: u8) -> Attempt<ExprNode> {
        if self.depth >= MAX_DEPTH {
            let span = self.span();
            return self.too_deep(span);
        }
        self.depth += 1;
        let result = self.prefix().and_then(|left| self.continuation(left, power));
        self.depth -= 1;
        result.map(ExprNode::whole_chain)
    }

    pub(super) fn too_deep<T>(&mut self, span: Span) -> Attempt<T> {
        let message = format!("the expression is nested more than {MAX_DEPTH} levels deep");
        let report = Finding::error(rules::TOO_DEEP, span, message)
            .why("each bracket, sign and further operator of a chain counts as a level")
            .help("split it: store parts in `const` names or in `ctx`");
        self.refuse(report)
    }

    /// Builds a node, unless the tree becomes too high.
    pub(super) fn node(&mut self, kind: ExprKind, span: Span, below: usize) -> Attempt<ExprNode> {
        if below >= MAX_DEPTH {
            return self.too_deep(span);
        }
        self.tallest = self.tallest.max(below + 1);
        Ok(ExprNode { expr: Expr { kind, span }, height: below + 1, closed: false, chain: false })
    }

    /// Extends `left` by the operators that follow, as long as they bind tightly enough.
    fn continuation(&mut self, mut left: ExprNode, power: u8) -> Attempt<ExprNode> {
        loop {
            let TokenKind::Symbol(symbol) = *self.peek() else {
                let (next, continues) = self.python_infix(left, power)?;
                if !continues {
                    return Ok(next);
                }
                left = next;
                continue;
            };
            if matches!(symbol, "." | "[" | "(" | "?.") {
                left = self.postfix(left, symbol)?;
                continue;
            }
            left = left.whole_chain();
            if matches!(symbol, "++" | "--") && !self.newline() {
                left = self.postfix_update(left)?;
            } else if let Some((operator, binds)) = infix(symbol) {
                if binds < power {
                    return Ok(left);
                }
                left = self.binary(left, operator, binds)?;
            } else if symbol == "?" && power <= CHOICE {
                left = self.choice(left)?;
            } else if let Some(op) = assignment_op(symbol).filter(|_| power <= ASSIGNMENT) {
                left = self.assign(left, op)?;
            } else if let Some(op) = logical_assignment(symbol).filter(|_| power <= ASSIGNMENT) {
                left = self.assign_logical(left, op)?;
            } else {
                return Ok(left);
            }
        }
    }

    /// Parses `.name`, `[index]` or `(arguments)`, each possibly after `?.`.
    fn postfix(&mut self, left: ExprNode, symbol: &str) -> Attempt<ExprNode> {
        let mut opener = self.bump();
        let optional = symbol == "?.";
        let symbol = match *self.peek() {
            TokenKind::Symbol(bracket @ ("[" | "(")) if optional => {
                opener = self.bump();
                bracket
            }
            _ if optional => ".",
            _ => symbol,
        };
        // In `(a?.b).c`, the parentheses end the chain.
        let chain = optional || left.chain;
        let left = if left.closed { left.whole_chain() } else { left };
        let start = left.expr.span;
        let object = Box::new(left.expr);
        let node = match symbol {
            "." => {
                let name = self.member_name()?;
                let span = start.to(name.span);
                self.node(ExprKind::Member { object, name, optional }, span, left.height)
            }
            "[" => {
                let (index, closer) = self.enclosed(opener, "]", CHOICE)?;
                let (height, index) = (left.height.max(index.height), Box::new(index.expr));
                self.node(ExprKind::Index { object, index, optional }, start.to(closer), height)
            }
            _ => {
                let (args, height, closer) = self.list(opener, ")")?;
                let height = left.height.max(height);
                self.node(ExprKind::Call { callee: object, args, optional }, start.to(closer), height)
            }
        };
        Ok(ExprNode { chain, ..node? })
    }

    fn member_name(&mut self) -> Attempt<Name> {
        let span = self.span();
        match self.peek() {
            TokenKind::Word(word) => {
                let text = (*word).to_owned();
                self.bump();
                Ok(Name { text, span })
            }
            TokenKind::Bad => Err(Reported),
            _ => {
                let message = format!("expected a name after `.`, found {}", self.describe_token());
                let report = Finding::error(rules::MISSING_NAME, span, message).help(format!(
                    "write the field after the point, as `{0}`, and indexes in brackets, as `{0}[2]`",
                    self.host_terms.array
                ));
                self.refuse(report)
            }
        }
    }

    fn postfix_update(&mut self, left: ExprNode) -> Attempt<ExprNode> {
        let increment = self.is("++");
        let span = left.expr.span.to(self.bump());
        let kind = ExprKind::Update { target: Box::new(left.expr), increment, prefix: false };
        self.node(kind, span, left.height)
    }

    pub(super) fn binary(&mut self, left: ExprNode, operator: Infix, binds: u8) -> Attempt<ExprNode> {
        let power = matches!(operator, Infix::Binary(BinaryOp::Power));
        let op_span = self.bump();
        // `**` is right-associative, all others are left-associative.
        let right = self.expression(if power { binds } else { binds + 1 })?;
        if let (true, false, ExprKind::Unary { op, operand }) = (power, left.closed, &left.expr.kind) {
            let (sign, base) = (op.symbol(), operand.span.text(self.source));
            let exponent = right.expr.span.text(self.source);
            let report = Finding::error(
                rules::AMBIGUOUS_POWER,
                left.expr.span,
                format!("a `{sign}` is directly before a power"),
            )
            .why(
                "it could mean the power of the negative or the negative of the power; JavaScript rejects it",
            )
            .help(format!("write `{sign}({base} ** {exponent})` or `({sign}{base}) ** {exponent}`"));
            self.diagnostics.push(report); // parsing continues as if it were the second
        }
        if let Infix::Logical(op) = operator {
            let mixes = |side: &ExprNode| {
                let nullish = LogicalOp::Nullish;
                matches!(&side.expr.kind, ExprKind::Logical { op: other, .. }
                    if !side.closed && (*other == nullish) != (op == nullish))
            };
            if mixes(&left) || mixes(&right) {
                self.diagnostics.push(refuse::mixed(op_span));
            }
        }
        let span = left.expr.span.to(right.expr.span);
        let height = left.height.max(right.height);
        let (left, right) = (Box::new(left.expr), Box::new(right.expr));
        let kind = match operator {
            Infix::Binary(op) => ExprKind::Binary { op, left, right },
            Infix::Logical(op) => ExprKind::Logical { op, left, right },
        };
        self.node(kind, span, height)
    }

    fn choice(&mut self, test: ExprNode) -> Attempt<ExprNode> {
        let question = self.bump();
        let then = self.expression(ASSIGNMENT)?;
        if self.consume(":").is_none() {
            let report = Finding::error(rules::HALF_CHOICE, question, "this `?` has no `:`")
                .why(format!("found {} where the second value is required", self.describe_token()))
                .help("write a conditional expression as `test ? a : b`");
            return self.refuse(report);
        }
        let otherwise = self.expression(ASSIGNMENT)?;
        let span = test.expr.span.to(otherwise.expr.span);
        let height = test.height.max(then.height).max(otherwise.height);
        let (test, then, otherwise) = (Box::new(test.expr), Box::new(then.expr), Box::new(otherwise.expr));
        self.node(ExprKind::Conditional { test, then, otherwise }, span, height)
    }

    fn assign(&mut self, target: ExprNode, op: Option<BinaryOp>) -> Attempt<ExprNode> {
        let op_span = self.bump();
        let value = self.expression(ASSIGNMENT)?;
        let span = target.expr.span.to(value.expr.span);
        let height = target.height.max(value.height);
        let (target, value) = (Box::new(target.expr), Box::new(value.expr));
        self.node(ExprKind::Assign { target, op, op_span, value }, span, height)
    }

    fn assign_logical(&mut self, target: ExprNode, op: LogicalOp) -> Attempt<ExprNode> {
        let op_span = self.bump();
        let value = self.expression(ASSIGNMENT)?;
        let span = target.expr.span.to(value.expr.span);
        let height = target.height.max(value.height);
        let (target, value) = (Box::new(target.expr), Box::new(value.expr));
        self.node(ExprKind::AssignLogical { target, op, op_span, value }, span, height)
    }
}

#[cfg(test)]
mod tests {
    use super::super::{parse_expression, parse_statements};
    use crate::print::print;
    use crate::rules;

    /// The expression with every operation in parentheses.
    fn grouped(source: &str) -> String {
        let parsed = parse_expression(source);
        assert!(parsed.diagnostics.is_empty(), "{source}: {:?}", parsed.diagnostics);
        explicit(&parsed.tree)
    }

    fn explicit(e: &crate::ast::Expr) -> String {
        use crate::ast::ExprKind::*;
        match &e.kind {
            Unary { op, operand } => format!("({}{})", op.symbol(), explicit(operand)),
            Binary { op, left, right } => format!("({} {} {})", explicit(left), op.symbol(), explicit(right)),
            Logical { op, left, right } => {
                format!("({} {} {})", explicit(left), op.symbol(), explicit(right))
            }
            Conditional { test, then, otherwise } => {
                format!("({} ? {} : {})", explicit(test), explicit(then), explicit(otherwise))
            }
            Assign { target, op, value, .. } => {
                format!("({} {}= {})", explicit(target), op.map_or("", |o| o.symbol()), explicit(value))
            }
            Member { object, name, .. } => format!("{}.{}", explicit(object), name.text),
            Index { object, index, .. } => format!("{}[{}]", explicit(object), explicit(index)),
            _ => print(e),
        }
    }

    #[test]
    fn operators_bind_as_in_javascript() {
        for (source, meaning) in [
            ("1 + 2 * 3", "(1 + (2 * 3))"),
            ("1 - 2 - 3", "((1 - 2) - 3)"),
            ("2 ** 3 ** 2", "(2 ** (3 ** 2))"),
            ("2 ** -1", "(2 ** (-1))"),
            ("(-2) ** 2", "((-2) ** 2)"),
            ("-a.b[1]", "(-a.b[1])"),
            ("!a === b", "((!a) === b)"),
            ("a || b && c == d < e + f", "(a || (b && (c == (d < (e + f)))))"),
            ("a ? b : c ? d : e", "(a ? b : (c ? d : e))"),
            ("a = b += c", "(a = (b += c))"),
            ("a & b == c | d ^ e", "((a & (b == c)) | (d ^ e))"),
            ("a << 1 + b", "(a << (1 + b))"),
            ("- -a", "(-(-a))"),
            ("a % b * c", "((a % b) * c)"),
            ("a ?.5 : 1", "(a ? 0.5 : 1)"),
        ] {
            assert_eq!(grouped(source), meaning, "{source}");
        }
    }

    #[test]
    fn a_sign_before_a_power_is_refused() {
        for source in ["-2 ** 2", "2 ** -3 ** 2", "!a ** b"] {
            let found = parse_expression(source).diagnostics;
            assert_eq!(
                found.iter().map(|d| d.code).collect::<Vec<_>>(),
                [rules::AMBIGUOUS_POWER],
                "{source}"
            );
        }
    }

    #[test]
    fn lines_end_statements_where_javascript_ends_them() {
        for (source, count) in [
            ("a = 1\nb = 2", 2),
            ("a = 1 +\n2", 1),
            ("a\n.b = 3", 1),
            ("a = b\n++c", 2),
            (";;a = 1;", 1),
            ("", 0),
        ] {
            let parsed = parse_statements(source);
            assert!(parsed.diagnostics.is_empty(), "{source}: {:?}", parsed.diagnostics);
            assert_eq!(parsed.tree.len(), count, "{source:?}");
        }
    }
}
