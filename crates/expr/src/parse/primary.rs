//! Prefixes of expressions: literals, names, unary operators, parentheses, templates and records.

use super::node::{ASSIGNMENT, ExprNode, SIGN, error_node};
use super::parser::{Attempt, Parser, Reported};
use super::refuse;
use crate::ast::{Expr, ExprKind, Name, Property, UnaryOp};
use crate::lex::{self, TokenKind};
use crate::rules;
use labspec_finding::{Finding, Span};

impl Parser<'_> {
    /// Parses the beginning of an expression.
    pub(super) fn prefix(&mut self) -> Attempt<ExprNode> {
        let span = self.span();
        let kind = match self.peek() {
            TokenKind::Number(x) => {
                let x = *x;
                let doubt = self.tokens.get(self.position).and_then(|token| token.doubt.clone());
                self.diagnostics.extend(doubt.map(|finding| *finding));
                ExprKind::Number(x)
            }
            TokenKind::Text(text) => ExprKind::String(text.clone()),
            TokenKind::Template(texts, values) => {
                let (texts, values) = (texts.clone(), values.clone());
                return self.template(texts, values);
            }
            TokenKind::Bad => return Err(Reported),
            TokenKind::End => return self.expected_value(),
            TokenKind::Symbol(symbol) => return self.prefix_symbol(symbol),
            TokenKind::Word(_) if *self.peek_at(1) == TokenKind::Symbol("=>") => return self.arrow(),
            TokenKind::Word(word) => match *word {
                "not" if self.is_python_not() => return self.python_not(),
                "typeof" => return self.sign(UnaryOp::TypeOf),
                "function" => return self.function_expression(),
                "true" => ExprKind::Boolean(true),
                "false" => ExprKind::Boolean(false),
                "null" => ExprKind::Null,
                // A declaration inside an expression.
                "const" | "let" | "var" => return self.expected_value(),
                "new" if *self.peek_at(1) == TokenKind::Word("Date") => {
                    return self.refuse(refuse::new_date(span, self.host_terms));
                }
                word => match refuse::word(word, span, self.host_terms) {
                    Some(report) => return self.refuse(report),
                    None => ExprKind::Name(word.to_owned()),
                },
            },
        };
        self.bump();
        self.node(kind, span, 0)
    }

    fn prefix_symbol(&mut self, symbol: &'static str) -> Attempt<ExprNode> {
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
            _ => match refuse::symbol(symbol, span, self.host_terms) {
                Some(report) => self.refuse(report),
                None => self.expected_value(),
            },
        }
    }

    /// Parses a unary operator and its operand.
    pub(super) fn sign(&mut self, op: UnaryOp) -> Attempt<ExprNode> {
        let span = self.bump();
        let operand = self.expression(SIGN)?;
        let span = span.to(operand.expr.span);
        self.node(ExprKind::Unary { op, operand: Box::new(operand.expr) }, span, operand.height)
    }

    /// Parses `(expression)`, or an arrow function.
    pub(super) fn parenthesis(&mut self) -> Attempt<ExprNode> {
        if self.is_arrow_function() {
            return self.arrow();
        }
        let opener = self.bump();
        let (inner, closer) = self.enclosed(opener, ")", ASSIGNMENT)?;
        let span = opener.to(closer);
        Ok(ExprNode { expr: Expr { span, ..inner.expr }, closed: true, ..inner })
    }

    /// Parses the expressions of a template literal, each as a separate text.
    pub(super) fn template(&mut self, texts: Vec<String>, places: Vec<Span>) -> Attempt<ExprNode> {
        let span = self.bump();
        let mut values = Vec::new();
        let mut height = 0;
        for place in places {
            let tokens = lex::tokens_of(self.source, place, &mut self.diagnostics);
            let outer = std::mem::replace(&mut self.tokens, tokens);
            self.check_typographic_quotes();
            let position = std::mem::take(&mut self.position);
            let value = self.template_value(place);
            self.tokens = outer;
            self.position = position;
            let value = value.unwrap_or_else(|Reported| error_node(place));
            height = height.max(value.height);
            values.push(value.expr);
        }
        self.node(ExprKind::Template { texts, values }, span, height)
    }

    fn template_value(&mut self, place: Span) -> Attempt<ExprNode> {
        if self.ended() {
            let report = Finding::error(rules::EMPTY, place, "there is nothing between the braces").help(
                format!("write the value to insert into the text, as `${{{}}}`", self.host_terms.number),
            );
            return self.refuse(report);
        }
        let value = self.expression(ASSIGNMENT)?;
        if !self.ended() {
            let report = self.unexpected_after(value.expr.span);
            self.diagnostics.extend(report);
        }
        Ok(value)
    }

    /// Parses `{key: value, …}`.
    pub(super) fn object(&mut self) -> Attempt<ExprNode> {
        let opener = self.bump();
        let mut properties = Vec::new();
        let mut height = 0;
        loop {
            if let Some(closer) = self.consume("}") {
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
            if self.consume(",").is_some() || self.is("}") {
                continue;
            }
            let report = self.unclosed(opener, "}", self.last_span());
            self.diagnostics.extend(report);
            if !self.skip_to(&[",", "}"]) {
                return Err(Reported);
            }
            self.consume(",");
        }
    }

    pub(super) fn property(&mut self) -> Attempt<(Property, usize)> {
        let span = self.span();
        if self.consume("...").is_some() {
            let value = self.expression(ASSIGNMENT)?;
            return Ok((Property::Spread(value.expr), value.height));
        }
        if self.is("[") {
            let opener = self.bump();
            let (key, _) = self.enclosed(opener, "]", ASSIGNMENT)?;
            if self.consume(":").is_none() {
                return self.refuse(refuse::member_function(span));
            }
            let value = self.expression(ASSIGNMENT)?;
            let height = key.height.max(value.height);
            return Ok((Property::Computed { key: key.expr, value: value.expr }, height));
        }
        let (text, word) = match self.peek() {
            TokenKind::Word(text) => ((*text).to_owned(), true),
            TokenKind::Text(text) => (text.clone(), false),
            TokenKind::Number(x) => (crate::number::to_text(*x), false),
            TokenKind::Bad => return Err(Reported),
            _ => {
                let message = format!("expected a key, found {}", self.describe_token());
                let report = Finding::error(rules::MISSING_NAME, span, message)
                    .why("braces inside an expression contain a record: keys and their values")
                    .help("write it as `{a: 1, b: 2}`");
                return self.refuse(report);
            }
        };
        self.bump();
        let key = Name { text, span };
        if self.consume(":").is_some() {
            let value = self.expression(ASSIGNMENT)?;
            return Ok((Property::Named { key, value: value.expr }, value.height));
        }
        if word && (self.is(",") || self.is("}")) {
            let value = Expr { kind: ExprKind::Name(key.text.clone()), span };
            return Ok((Property::Named { key, value }, 1));
        }
        if self.is("(") || matches!(self.peek(), TokenKind::Word(_)) {
            return self.refuse(refuse::member_function(span));
        }
        let report =
            Finding::error(rules::MISSING_VALUE, span, format!("the key `{}` has no value", key.text))
                .help(format!("write `{}: …`", key.text));
        self.refuse(report)
    }
}
