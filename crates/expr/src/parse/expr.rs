//! Expressions by binding power.
//!
//! The height of every tree is counted while it is built, so that no later stage, which walks trees by
//! recursion, can run out of stack.

use super::{Attempt, MAX_DEPTH, Parser, Reported, refuse};
use crate::ast::{BinaryOp, Expr, ExprKind, LogicalOp, Name, UnaryOp};
use crate::code;
use crate::diagnostic::{Diagnostic, Span};
use crate::lex::Tok;

/// Binding powers that no operator table holds, see [`BinaryOp::power`].
const ASSIGNMENT: u8 = 1;
const CHOICE: u8 = 2;
const SIGN: u8 = 15;

/// An expression with what only the parser needs to know.
struct Node {
    expr: Expr,
    height: usize,
    /// It stands between parentheses.
    closed: bool,
}

/// What stands between two operands.
enum Infix {
    Binary(BinaryOp),
    Logical(LogicalOp),
}

fn infix(symbol: &str) -> Option<(Infix, u8)> {
    if let Some(op) = BinaryOp::ALL.into_iter().find(|op| op.symbol() == symbol) {
        return Some((Infix::Binary(op), op.power()));
    }
    let op = [LogicalOp::And, LogicalOp::Or].into_iter().find(|op| op.symbol() == symbol)?;
    Some((Infix::Logical(op), op.power()))
}

/// The operator of `=` (none) or of a compound assignment.
fn assignment_op(symbol: &str) -> Option<Option<BinaryOp>> {
    if symbol == "=" {
        return Some(None);
    }
    let op = symbol.strip_suffix('=')?;
    BinaryOp::ALL.into_iter().find(|b| !b.is_comparison() && b.symbol() == op).map(Some)
}

impl Parser<'_> {
    /// An expression of any kind.
    pub(super) fn assignment(&mut self) -> Attempt<Expr> {
        Ok(self.expression(ASSIGNMENT)?.expr)
    }

    /// An expression whose operators bind at least as tightly as `power`.
    fn expression(&mut self, power: u8) -> Attempt<Node> {
        if self.depth >= MAX_DEPTH {
            let span = self.span();
            return self.too_deep(span);
        }
        self.depth += 1;
        let result = self.prefix().and_then(|left| self.continuation(left, power));
        self.depth -= 1;
        result
    }

    fn too_deep<T>(&mut self, span: Span) -> Attempt<T> {
        let message = format!("the expression is nested more than {MAX_DEPTH} levels deep");
        let report = Diagnostic::error(code::TOO_DEEP, span, message)
            .why("brackets, signs and each further operator of a chain count as a level")
            .help("split it: keep parts in `const` names, or in `ctx`");
        self.refuse(report)
    }

    /// A node from its parts, if the tree does not become too high.
    fn node(&mut self, kind: ExprKind, span: Span, below: usize) -> Attempt<Node> {
        if below >= MAX_DEPTH {
            return self.too_deep(span);
        }
        Ok(Node { expr: Expr { kind, span }, height: below + 1, closed: false })
    }

    /// What follows `left`, as long as it binds tightly enough.
    fn continuation(&mut self, mut left: Node, power: u8) -> Attempt<Node> {
        loop {
            let Tok::Symbol(symbol) = *self.peek() else { return Ok(left) };
            if matches!(symbol, "." | "[" | "(") {
                left = self.postfix(left, symbol)?;
            } else if matches!(symbol, "++" | "--") && !self.newline() {
                left = self.update_behind(left)?;
            } else if let Some((operator, binds)) = infix(symbol) {
                if binds < power {
                    return Ok(left);
                }
                left = self.binary(left, operator, binds)?;
            } else if symbol == "?" && power <= CHOICE {
                left = self.choice(left)?;
            } else if let Some(op) = assignment_op(symbol).filter(|_| power <= ASSIGNMENT) {
                left = self.assign(left, op)?;
            } else if matches!(symbol, "=>" | "?." | "??" | "??=" | "&&=" | "||=") {
                let report = refuse::symbol(symbol, self.span());
                self.diagnostics.extend(report);
                return Err(Reported);
            } else {
                return Ok(left);
            }
        }
    }

    /// `.name`, `[index]` or `(arguments)`
    fn postfix(&mut self, left: Node, symbol: &str) -> Attempt<Node> {
        let opener = self.bump();
        let start = left.expr.span;
        let object = Box::new(left.expr);
        match symbol {
            "." => {
                let name = self.member_name()?;
                let span = start.to(name.span);
                self.node(ExprKind::Member { object, name }, span, left.height)
            }
            "[" => {
                let (index, closer) = self.enclosed(opener, "]", CHOICE)?;
                let height = left.height.max(index.height);
                self.node(ExprKind::Index { object, index: Box::new(index.expr) }, start.to(closer), height)
            }
            _ => {
                let (args, height, closer) = self.list(opener, ")")?;
                self.node(ExprKind::Call { callee: object, args }, start.to(closer), left.height.max(height))
            }
        }
    }

    fn member_name(&mut self) -> Attempt<Name> {
        let span = self.span();
        match self.peek() {
            Tok::Word(word) => {
                let text = word.clone();
                self.bump();
                Ok(Name { text, span })
            }
            Tok::Bad => Err(Reported),
            _ => {
                let message = format!("expected a name behind `.`, found {}", self.shown());
                let report = Diagnostic::error(code::UNEXPECTED, span, message)
                    .help("write the field behind the point, as `data.qpos`, and indexes in brackets, as `data.qpos[2]`");
                self.refuse(report)
            }
        }
    }

    fn update_behind(&mut self, left: Node) -> Attempt<Node> {
        let increment = self.is("++");
        let span = left.expr.span.to(self.bump());
        let kind = ExprKind::Update { target: Box::new(left.expr), increment, prefix: false };
        self.node(kind, span, left.height)
    }

    fn binary(&mut self, left: Node, operator: Infix, binds: u8) -> Attempt<Node> {
        let power = matches!(operator, Infix::Binary(BinaryOp::Power));
        self.bump();
        // `**` groups from the right, all others from the left.
        let right = self.expression(if power { binds } else { binds + 1 })?;
        if let (true, false, ExprKind::Unary { op, operand }) = (power, left.closed, &left.expr.kind) {
            let (sign, base) = (op.symbol(), operand.span.text(self.source));
            let exponent = right.expr.span.text(self.source);
            let report = Diagnostic::error(
                code::AMBIGUOUS_POWER,
                left.expr.span,
                format!("a `{sign}` directly before a power"),
            )
            .why(
                "it could mean the power of the negative or the negative of the power; JavaScript refuses it",
            )
            .help(format!("write `{sign}({base} ** {exponent})` or `({sign}{base}) ** {exponent}`"));
            self.diagnostics.push(report); // and read on, as if it were the second
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

    fn choice(&mut self, test: Node) -> Attempt<Node> {
        let question = self.bump();
        let then = self.expression(ASSIGNMENT)?;
        if self.eat(":").is_none() {
            let report = Diagnostic::error(code::UNEXPECTED, question, "this `?` has no `:`")
                .why(format!("found {} where the other value must stand", self.shown()))
                .help("a choice is written `test ? a : b`");
            return self.refuse(report);
        }
        let otherwise = self.expression(ASSIGNMENT)?;
        let span = test.expr.span.to(otherwise.expr.span);
        let height = test.height.max(then.height).max(otherwise.height);
        let (test, then, otherwise) = (Box::new(test.expr), Box::new(then.expr), Box::new(otherwise.expr));
        self.node(ExprKind::Conditional { test, then, otherwise }, span, height)
    }

    fn assign(&mut self, target: Node, op: Option<BinaryOp>) -> Attempt<Node> {
        let op_span = self.bump();
        let value = self.expression(ASSIGNMENT)?;
        let span = target.expr.span.to(value.expr.span);
        let height = target.height.max(value.height);
        let (target, value) = (Box::new(target.expr), Box::new(value.expr));
        self.node(ExprKind::Assign { target, op, op_span, value }, span, height)
    }

    /// What an expression starts with.
    fn prefix(&mut self) -> Attempt<Node> {
        let span = self.span();
        let kind = match self.peek() {
            Tok::Number(x) => ExprKind::Number(*x),
            Tok::Text(text) => ExprKind::String(text.clone()),
            Tok::Template => return self.refuse(refuse::template(span)),
            Tok::Bad => return Err(Reported),
            Tok::End => return self.expected_value(),
            Tok::Symbol(symbol) => return self.prefix_symbol(symbol),
            Tok::Word(word) => match word.as_str() {
                "true" => ExprKind::Boolean(true),
                "false" => ExprKind::Boolean(false),
                "null" => ExprKind::Null,
                // A declaration in the middle of an expression.
                "const" | "let" | "var" => return self.expected_value(),
                word => match refuse::word(word, span) {
                    Some(report) => return self.refuse(report),
                    None => ExprKind::Name(word.to_owned()),
                },
            },
        };
        self.bump();
        self.node(kind, span, 0)
    }

    fn prefix_symbol(&mut self, symbol: &'static str) -> Attempt<Node> {
        let span = self.span();
        let sign = [UnaryOp::Minus, UnaryOp::Plus, UnaryOp::Not, UnaryOp::BitNot]
            .into_iter()
            .find(|op| op.symbol() == symbol);
        if let Some(op) = sign {
            self.bump();
            let operand = self.expression(SIGN)?;
            let span = span.to(operand.expr.span);
            return self.node(ExprKind::Unary { op, operand: Box::new(operand.expr) }, span, operand.height);
        }
        match symbol {
            "++" | "--" => {
                self.bump();
                let target = self.expression(SIGN)?;
                let span = span.to(target.expr.span);
                let increment = symbol == "++";
                let kind = ExprKind::Update { target: Box::new(target.expr), increment, prefix: true };
                self.node(kind, span, target.height)
            }
            "(" => self.parenthesis(),
            "[" => {
                let opener = self.bump();
                let (items, height, closer) = self.list(opener, "]")?;
                self.node(ExprKind::Array(items), opener.to(closer), height)
            }
            _ => match refuse::symbol(symbol, span)
                .filter(|_| !matches!(symbol, "=>" | "?." | "??" | "??=" | "&&=" | "||="))
            {
                Some(report) => self.refuse(report),
                None => self.expected_value(),
            },
        }
    }

    /// `(expression)`, or the parameters of an arrow function, which is refused as such.
    fn parenthesis(&mut self) -> Attempt<Node> {
        if let Some(arrow) = self.arrow_ahead() {
            let report = refuse::symbol("=>", arrow);
            self.diagnostics.extend(report);
            return Err(Reported);
        }
        let opener = self.bump();
        let (inner, closer) = self.enclosed(opener, ")", ASSIGNMENT)?;
        let span = opener.to(closer);
        Ok(Node { expr: Expr { span, ..inner.expr }, closed: true, height: inner.height })
    }

    /// Where the `=>` stands when the parenthesis ahead is a list of parameters: names and commas.
    fn arrow_ahead(&self) -> Option<Span> {
        let mut n = 1;
        while matches!(self.peek_at(n), Tok::Word(_) | Tok::Symbol("," | "=" | "...") | Tok::Number(_)) {
            n += 1;
        }
        let arrow = *self.peek_at(n) == Tok::Symbol(")") && *self.peek_at(n + 1) == Tok::Symbol("=>");
        arrow.then(|| self.tokens.get(self.at + n + 1).map(|t| t.span))?
    }

    /// One expression and its closing bracket; a mistake inside is skipped to the bracket.
    fn enclosed(&mut self, opener: Span, closer: &str, power: u8) -> Attempt<(Node, Span)> {
        if self.is(closer) {
            let span = opener.to(self.bump());
            let what = if closer == "]" { "an index" } else { "an expression" };
            let report =
                Diagnostic::error(code::UNEXPECTED, span, format!("{what} is missing between the brackets"))
                    .help(if closer == "]" {
                        "write the index, as `[0]`"
                    } else {
                        "write the expression, or remove the brackets"
                    });
            self.diagnostics.push(report);
            return Ok((error_node(span), span));
        }
        let inner = match self.expression(power) {
            Ok(inner) => inner,
            Err(Reported) => {
                let span = self.span();
                if !self.skip_to(&[closer]) {
                    return Err(Reported);
                }
                error_node(span)
            }
        };
        if let Some(end) = self.eat(closer) {
            return Ok((inner, end));
        }
        let report = self.unclosed(opener, closer, inner.expr.span);
        self.diagnostics.extend(report);
        if self.skip_to(&[closer]) { Ok((inner, self.bump())) } else { Err(Reported) }
    }

    /// Expressions between commas and their closing bracket; a mistake in one is skipped to the next comma.
    fn list(&mut self, opener: Span, closer: &str) -> Attempt<(Vec<Expr>, usize, Span)> {
        let mut items = Vec::new();
        let mut height = 0;
        loop {
            if let Some(end) = self.eat(closer) {
                return Ok((items, height, end)); // also behind a comma at the end, as in JavaScript
            }
            let span = self.span();
            let item = match self.expression(ASSIGNMENT) {
                Ok(item) => item,
                Err(Reported) if self.skip_to(&[",", closer]) => error_node(span),
                Err(Reported) => return Err(Reported),
            };
            height = height.max(item.height);
            let last = item.expr.span;
            items.push(item.expr);
            if self.eat(",").is_some() || self.is(closer) {
                continue;
            }
            let report = self.unclosed(opener, closer, last);
            self.diagnostics.extend(report);
            if !self.skip_to(&[",", closer]) {
                return Err(Reported);
            }
            self.eat(",");
        }
    }

    /// The finding when something else stands where a bracket must close.
    fn unclosed(&mut self, opener: Span, closer: &str, before: Span) -> Option<Diagnostic> {
        // An index holds no assignment, so `=` shows that its bracket should have been closed.
        let ends = self.ended() || matches!(self.peek(), Tok::Symbol(";" | ")" | "]" | "}" | "="));
        if !ends {
            return self.unexpected_behind(before);
        }
        let open = opener.text(self.source);
        Some(
            Diagnostic::error(code::UNCLOSED, opener, format!("this `{open}` is never closed"))
                .why(format!("found {} where `{closer}` must stand", self.shown()))
                .help(format!("write `{closer}` behind `{}`", before.text(self.source)))
                .fix(before.after(), closer),
        )
    }

    /// Reports that a value is missing.
    fn expected_value<T>(&mut self) -> Attempt<T> {
        let span = self.span();
        let before = self.last_span().text(self.source);
        let message = format!("expected a value, found {}", self.shown());
        let mut report = Diagnostic::error(code::UNEXPECTED, span, message);
        if !before.is_empty() && self.at > 0 {
            report = report.why(format!("`{before}` needs a value behind it"));
        }
        report = match self.peek() {
            // `a = == b`, `a * * b`: two operators in a row.
            Tok::Symbol(symbol) if infix(symbol).is_some() => report.help(format!(
                "remove one of the operators, or write the value between `{before}` and `{symbol}`"
            )),
            _ => report.help("write a number, a name such as `data.time`, or an expression in parentheses"),
        };
        self.refuse(report)
    }
}

fn error_node(span: Span) -> Node {
    Node { expr: Expr { kind: ExprKind::Error, span }, height: 1, closed: true }
}

#[cfg(test)]
mod tests {
    use super::super::{parse_expression, parse_statements};
    use crate::code;
    use crate::print::print;

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
            Member { object, name } => format!("{}.{}", explicit(object), name.text),
            Index { object, index } => format!("{}[{}]", explicit(object), explicit(index)),
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
            assert_eq!(found.iter().map(|d| d.code).collect::<Vec<_>>(), [code::AMBIGUOUS_POWER], "{source}");
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
