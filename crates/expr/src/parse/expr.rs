//! Expressions by binding power.
//!
//! The height of every tree is counted while it is built, so that no later stage, which walks trees by
//! recursion, can run out of stack.

use super::parser::{Attempt, MAX_DEPTH, Parser, Reported};
use super::refuse;
use crate::ast::{BinaryOp, Expr, ExprKind, LogicalOp, Name, Property, UnaryOp};
use crate::lex::{self, Tok};
use crate::rules;
use labspec_finding::{Finding, Span};

/// Binding powers that no operator table holds, see [`BinaryOp::power`].
const ASSIGNMENT: u8 = 1;
const CHOICE: u8 = 2;
const SIGN: u8 = 15;

/// An expression with what only the parser needs to know.
pub(super) struct Node {
    pub(super) expr: Expr,
    height: usize,
    /// It stands between parentheses.
    closed: bool,
    /// A `?.` stands in the chain of members that it ends.
    chain: bool,
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
    let op = LogicalOp::ALL.into_iter().find(|op| op.symbol() == symbol)?;
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

/// The operator of `&&=`, `||=` or `??=`.
fn logical_assignment(symbol: &str) -> Option<LogicalOp> {
    let op = symbol.strip_suffix('=')?;
    LogicalOp::ALL.into_iter().find(|l| l.symbol() == op)
}

impl Parser<'_> {
    /// An expression of any kind.
    pub(super) fn assignment(&mut self) -> Attempt<Expr> {
        Ok(self.expression(ASSIGNMENT)?.expr)
    }

    /// An expression whose operators bind at least as tightly as `power`.
    pub(super) fn expression(&mut self, power: u8) -> Attempt<Node> {
        if self.depth >= MAX_DEPTH {
            let span = self.span();
            return self.too_deep(span);
        }
        self.depth += 1;
        let result = self.prefix().and_then(|left| self.continuation(left, power));
        self.depth -= 1;
        result.map(Node::whole_chain)
    }

    pub(super) fn too_deep<T>(&mut self, span: Span) -> Attempt<T> {
        let message = format!("the expression is nested more than {MAX_DEPTH} levels deep");
        let report = Finding::error(rules::TOO_DEEP, span, message)
            .why("each bracket, sign and further operator of a chain counts as a level")
            .help("split it: store parts in `const` names or in `ctx`");
        self.refuse(report)
    }

    /// A node from its parts, if the tree does not become too high.
    pub(super) fn node(&mut self, kind: ExprKind, span: Span, below: usize) -> Attempt<Node> {
        if below >= MAX_DEPTH {
            return self.too_deep(span);
        }
        self.tallest = self.tallest.max(below + 1);
        Ok(Node { expr: Expr { kind, span }, height: below + 1, closed: false, chain: false })
    }

    /// What follows `left`, as long as it binds tightly enough.
    fn continuation(&mut self, mut left: Node, power: u8) -> Attempt<Node> {
        loop {
            let Tok::Symbol(symbol) = *self.peek() else { return Ok(left) };
            if matches!(symbol, "." | "[" | "(" | "?.") {
                left = self.postfix(left, symbol)?;
                continue;
            }
            left = left.whole_chain();
            if matches!(symbol, "++" | "--") && !self.newline() {
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
            } else if let Some(op) = logical_assignment(symbol).filter(|_| power <= ASSIGNMENT) {
                left = self.assign_logical(left, op)?;
            } else {
                return Ok(left);
            }
        }
    }

    /// `.name`, `[index]` or `(arguments)`, each with `?.` before it or not.
    fn postfix(&mut self, left: Node, symbol: &str) -> Attempt<Node> {
        let mut opener = self.bump();
        let optional = symbol == "?.";
        let symbol = match *self.peek() {
            Tok::Symbol(bracket @ ("[" | "(")) if optional => {
                opener = self.bump();
                bracket
            }
            _ if optional => ".",
            _ => symbol,
        };
        // In `(a?.b).c` the parentheses end the chain.
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
        Ok(Node { chain, ..node? })
    }

    fn member_name(&mut self) -> Attempt<Name> {
        let span = self.span();
        match self.peek() {
            Tok::Word(word) => {
                let text = (*word).to_owned();
                self.bump();
                Ok(Name { text, span })
            }
            Tok::Bad => Err(Reported),
            _ => {
                let message = format!("expected a name after `.`, found {}", self.shown());
                let report = Finding::error(rules::MISSING_NAME, span, message).help(format!(
                    "write the field after the point, as `{0}`, and indexes in brackets, as `{0}[2]`",
                    self.words.array
                ));
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
        let op_span = self.bump();
        // `**` groups from the right, all others from the left.
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
            self.diagnostics.push(report); // and read on, as if it were the second
        }
        if let Infix::Logical(op) = operator {
            let mixes = |side: &Node| {
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

    fn choice(&mut self, test: Node) -> Attempt<Node> {
        let question = self.bump();
        let then = self.expression(ASSIGNMENT)?;
        if self.eat(":").is_none() {
            let report = Finding::error(rules::HALF_CHOICE, question, "this `?` has no `:`")
                .why(format!("found {} where the second value is required", self.shown()))
                .help("write a conditional expression as `test ? a : b`");
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

    fn assign_logical(&mut self, target: Node, op: LogicalOp) -> Attempt<Node> {
        let op_span = self.bump();
        let value = self.expression(ASSIGNMENT)?;
        let span = target.expr.span.to(value.expr.span);
        let height = target.height.max(value.height);
        let (target, value) = (Box::new(target.expr), Box::new(value.expr));
        self.node(ExprKind::AssignLogical { target, op, op_span, value }, span, height)
    }

    /// What an expression starts with.
    fn prefix(&mut self) -> Attempt<Node> {
        let span = self.span();
        let kind = match self.peek() {
            Tok::Number(x) => {
                let x = *x;
                let doubt = self.tokens.get(self.at).and_then(|token| token.doubt.clone());
                self.diagnostics.extend(doubt.map(|finding| *finding));
                ExprKind::Number(x)
            }
            Tok::Text(text) => ExprKind::String(text.clone()),
            Tok::Template(texts, values) => {
                let (texts, values) = (texts.clone(), values.clone());
                return self.template(texts, values);
            }
            Tok::Bad => return Err(Reported),
            Tok::End => return self.expected_value(),
            Tok::Symbol(symbol) => return self.prefix_symbol(symbol),
            Tok::Word(_) if *self.peek_at(1) == Tok::Symbol("=>") => return self.arrow(),
            Tok::Word(word) => match *word {
                "typeof" => return self.sign(UnaryOp::TypeOf),
                "function" => return self.function_expression(),
                "true" => ExprKind::Boolean(true),
                "false" => ExprKind::Boolean(false),
                "null" => ExprKind::Null,
                // A declaration in the middle of an expression.
                "const" | "let" | "var" => return self.expected_value(),
                "new" if *self.peek_at(1) == Tok::Word("Date") => {
                    return self.refuse(refuse::new_date(span, self.words));
                }
                word => match refuse::word(word, span, self.words) {
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
            return self.sign(op);
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
            "{" => self.object(),
            _ => match refuse::symbol(symbol, span, self.words) {
                Some(report) => self.refuse(report),
                None => self.expected_value(),
            },
        }
    }

    /// An operator before its operand.
    fn sign(&mut self, op: UnaryOp) -> Attempt<Node> {
        let span = self.bump();
        let operand = self.expression(SIGN)?;
        let span = span.to(operand.expr.span);
        self.node(ExprKind::Unary { op, operand: Box::new(operand.expr) }, span, operand.height)
    }

    /// `(expression)`, or an arrow function.
    fn parenthesis(&mut self) -> Attempt<Node> {
        if self.arrow_ahead() {
            return self.arrow();
        }
        let opener = self.bump();
        let (inner, closer) = self.enclosed(opener, ")", ASSIGNMENT)?;
        let span = opener.to(closer);
        Ok(Node { expr: Expr { span, ..inner.expr }, closed: true, ..inner })
    }

    /// The parts of a template literal, each read as a text of its own.
    fn template(&mut self, texts: Vec<String>, places: Vec<Span>) -> Attempt<Node> {
        let span = self.bump();
        let mut values = Vec::new();
        let mut height = 0;
        for place in places {
            let tokens = lex::tokens_of(self.source, place, &mut self.diagnostics);
            let outer = std::mem::replace(&mut self.tokens, tokens);
            self.look_at_quotes();
            let at = std::mem::take(&mut self.at);
            let value = self.template_value(place);
            self.tokens = outer;
            self.at = at;
            let value = value.unwrap_or_else(|Reported| error_node(place));
            height = height.max(value.height);
            values.push(value.expr);
        }
        self.node(ExprKind::Template { texts, values }, span, height)
    }

    fn template_value(&mut self, place: Span) -> Attempt<Node> {
        if self.ended() {
            let report = Finding::error(rules::EMPTY, place, "there is nothing between the braces")
                .help(format!("write the value to insert into the text, as `${{{}}}`", self.words.number));
            return self.refuse(report);
        }
        let value = self.expression(ASSIGNMENT)?;
        if !self.ended() {
            let report = self.unexpected_behind(value.expr.span);
            self.diagnostics.extend(report);
        }
        Ok(value)
    }

    /// `{key: value, …}`
    fn object(&mut self) -> Attempt<Node> {
        let opener = self.bump();
        let mut properties = Vec::new();
        let mut height = 0;
        loop {
            if let Some(closer) = self.eat("}") {
                return self.node(ExprKind::Object(properties), opener.to(closer), height);
            }
            match self.property() {
                Ok((property, below)) => {
                    height = height.max(below);
                    properties.push(property);
                }
                Err(Reported) if self.skip_to(&[",", "}"]) => {}
                Err(Reported) => return Err(Reported),
            }
            if self.eat(",").is_some() || self.is("}") {
                continue;
            }
            let report = self.unclosed(opener, "}", self.last_span());
            self.diagnostics.extend(report);
            if !self.skip_to(&[",", "}"]) {
                return Err(Reported);
            }
            self.eat(",");
        }
    }

    fn property(&mut self) -> Attempt<(Property, usize)> {
        let span = self.span();
        if self.eat("...").is_some() {
            let value = self.expression(ASSIGNMENT)?;
            return Ok((Property::Spread(value.expr), value.height));
        }
        if self.is("[") {
            let opener = self.bump();
            let (key, _) = self.enclosed(opener, "]", ASSIGNMENT)?;
            if self.eat(":").is_none() {
                return self.refuse(refuse::member_function(span));
            }
            let value = self.expression(ASSIGNMENT)?;
            let height = key.height.max(value.height);
            return Ok((Property::Computed { key: key.expr, value: value.expr }, height));
        }
        let (text, word) = match self.peek() {
            Tok::Word(text) => ((*text).to_owned(), true),
            Tok::Text(text) => (text.clone(), false),
            Tok::Number(x) => (crate::number::to_text(*x), false),
            Tok::Bad => return Err(Reported),
            _ => {
                let message = format!("expected a key, found {}", self.shown());
                let report = Finding::error(rules::MISSING_NAME, span, message)
                    .why("braces inside an expression contain a record: keys and their values")
                    .help("write it as `{a: 1, b: 2}`");
                return self.refuse(report);
            }
        };
        self.bump();
        let key = Name { text, span };
        if self.eat(":").is_some() {
            let value = self.expression(ASSIGNMENT)?;
            return Ok((Property::Named { key, value: value.expr }, value.height));
        }
        if word && (self.is(",") || self.is("}")) {
            let value = Expr { kind: ExprKind::Name(key.text.clone()), span };
            return Ok((Property::Named { key, value }, 1));
        }
        if self.is("(") || matches!(self.peek(), Tok::Word(_)) {
            return self.refuse(refuse::member_function(span));
        }
        let report =
            Finding::error(rules::MISSING_VALUE, span, format!("the key `{}` has no value", key.text))
                .help(format!("write `{}: …`", key.text));
        self.refuse(report)
    }

    /// One expression and its closing bracket; a mistake inside is skipped to the bracket.
    pub(super) fn enclosed(&mut self, opener: Span, closer: &str, power: u8) -> Attempt<(Node, Span)> {
        if self.is(closer) {
            let span = opener.to(self.bump());
            let what = if closer == "]" { "an index" } else { "an expression" };
            let report =
                Finding::error(rules::MISSING_VALUE, span, format!("{what} is missing between the brackets"))
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
            let item = match self.item() {
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

    /// An item or argument, possibly a spread.
    fn item(&mut self) -> Attempt<Node> {
        let Some(dots) = self.eat("...") else { return self.expression(ASSIGNMENT) };
        let value = self.expression(ASSIGNMENT)?;
        let span = dots.to(value.expr.span);
        self.node(ExprKind::Spread(Box::new(value.expr)), span, value.height)
    }

    /// The finding when something else stands where a bracket must close.
    pub(super) fn unclosed(&mut self, opener: Span, closer: &str, before: Span) -> Option<Finding> {
        // An index holds no assignment, so `=` shows that its bracket should have been closed.
        let ends = self.ended() || matches!(self.peek(), Tok::Symbol(";" | ")" | "]" | "}" | "="));
        if !ends {
            return self.unexpected_behind(before);
        }
        let open = opener.text(self.source);
        Some(
            Finding::error(rules::UNCLOSED, opener, format!("this `{open}` is not closed"))
                .why(format!("found {} where `{closer}` is required", self.shown()))
                .help(format!("write `{closer}` after `{}`", before.text(self.source)))
                .guess(before.after(), closer),
        )
    }

    /// Reports that a value is missing.
    pub(super) fn expected_value<T>(&mut self) -> Attempt<T> {
        let span = self.span();
        let before = self.last_span().text(self.source);
        let message = format!("expected a value, found {}", self.shown());
        let mut report = Finding::error(rules::MISSING_VALUE, span, message);
        if !before.is_empty() && self.at > 0 {
            report = report.why(format!("`{before}` needs a value after it"));
        }
        report = match self.peek() {
            // `a = == b`, `a * * b`: two operators in a row.
            Tok::Symbol(symbol) if infix(symbol).is_some() && before.is_empty() => {
                report.help(format!("write the value before `{symbol}`, or remove it"))
            }
            Tok::Symbol(symbol) if infix(symbol).is_some() => report.help(format!(
                "remove one of the operators, or write the value between `{before}` and `{symbol}`"
            )),
            _ => report.help(format!(
                "write a number, a name such as `{}`, or an expression in parentheses",
                self.words.number
            )),
        };
        self.refuse(report)
    }
}

fn error_node(span: Span) -> Node {
    Node { expr: Expr { kind: ExprKind::Error, span }, height: 1, closed: true, chain: false }
}

impl Node {
    /// Puts the mark of a chain around a finished one.
    fn whole_chain(self) -> Node {
        if !self.chain {
            return self;
        }
        let span = self.expr.span;
        let kind = ExprKind::Chain(Box::new(self.expr));
        Node { expr: Expr { kind, span }, height: self.height + 1, chain: false, ..self }
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
