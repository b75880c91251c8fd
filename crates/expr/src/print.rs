//! Tree to text: one layout, parentheses only where the tree needs them. Reading the result gives the tree back.
//! The formatter is this with two wishes of authors: numbers stay as they are written, and a text of one line stays on one.

use crate::ast::{
    BinaryOp, Body, Element, Expr, ExprKind, Function, LogicalOp, Pattern, Property, Stmt, StmtKind, UnaryOp,
};
use crate::lex::{Tok, tokens};
use crate::number;
use crate::parse::{parse_expression, parse_statements};
use labspec_finding::Finding;

/// Binding powers beyond those of the operators, see [`BinaryOp::power`].
const ASSIGNMENT: u8 = 1;
const CHOICE: u8 = 2;
const SIGN: u8 = 15;
const UPDATE: u8 = 16;
const MEMBER: u8 = 17;
/// Of a name or a literal, which nothing can take apart.
const ATOM: u8 = 18;

/// The text of an expression. A part that could not be read prints as `<error>`.
pub fn print(expr: &Expr) -> String {
    let mut printer = Printer::default();
    printer.expr(expr, ASSIGNMENT);
    printer.out
}

/// The text of statements, one a line, blocks indented by two spaces.
pub fn print_statements(statements: &[Stmt]) -> String {
    let mut printer = Printer::default();
    printer.lines(statements);
    printer.out
}

/// How tightly the outermost operator of a tree binds.
fn power(expr: &Expr) -> u8 {
    match &expr.kind {
        ExprKind::Sequence(_) => 0,
        ExprKind::Assign { .. } | ExprKind::AssignLogical { .. } | ExprKind::Function(_) => ASSIGNMENT,
        ExprKind::Conditional { .. } => CHOICE,
        ExprKind::Logical { op, .. } => op.power(),
        ExprKind::Binary { op, .. } => op.power(),
        ExprKind::Unary { .. } => SIGN,
        ExprKind::Update { .. } => UPDATE,
        // A chain that goes on must not swallow what was outside of it.
        ExprKind::Chain(_) => MEMBER - 1,
        ExprKind::Member { .. } | ExprKind::Index { .. } | ExprKind::Call { .. } => MEMBER,
        _ => ATOM,
    }
}

/// An expression laid out anew. `None` when it has mistakes, or comments, which a tree does not hold.
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

/// Statements laid out anew: one a line, or all on one line where the source is one line. `None` as above.
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

/// A tree without its places: two texts of one shape mean the same. Not the printed text, which cannot show what the
/// printer itself has lost.
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

/// Whether a comment stands between the tokens, or may stand in a template.
fn has_comments(source: &str) -> bool {
    let opens = |text: &str| text.contains("//") || text.contains("/*");
    let mut at = 0;
    for token in tokens(source, &mut Vec::new()) {
        let template = matches!(token.kind, Tok::Template(..)) && opens(token.span.text(source));
        if template || opens(source.get(at..token.span.start).unwrap_or("")) {
            return true;
        }
        at = token.span.end;
    }
    false
}

#[derive(Default)]
struct Printer<'s> {
    out: String,
    indent: usize,
    /// All on one line.
    line: bool,
    /// Where the tree was read from, for numbers as they are written; empty when that does not matter.
    source: &'s str,
}

impl Printer<'_> {
    fn put(&mut self, text: &str) {
        self.out.push_str(text);
    }

    fn new_line(&mut self) {
        if self.line {
            return self.put(" ");
        }
        self.out.push('\n');
        for _ in 0..self.indent {
            self.out.push_str("  ");
        }
    }

    fn lines(&mut self, statements: &[Stmt]) {
        for (i, statement) in statements.iter().enumerate() {
            if i > 0 {
                self.new_line();
            }
            self.statement(statement);
        }
    }

    fn block(&mut self, statements: &[Stmt]) {
        if statements.is_empty() {
            return self.put("{}");
        }
        self.put("{");
        self.indent += 1;
        self.new_line();
        self.lines(statements);
        self.indent -= 1;
        self.new_line();
        self.put("}");
    }

    /// The statement of a condition or a loop, behind its head.
    fn body(&mut self, statement: &Stmt) {
        self.put(" ");
        self.statement(statement);
    }

    fn statement(&mut self, statement: &Stmt) {
        match &statement.kind {
            StmtKind::Expr(expr) => {
                // What starts like a block or a declaration of a function would be read as one.
                let start = self.out.len();
                self.expr(expr, 0);
                let text = self.out.get(start..).unwrap_or("");
                if text.starts_with('{') || text.starts_with("function") {
                    self.out.insert(start, '(');
                    self.put(")");
                }
                self.put(";");
            }
            StmtKind::Declare { constant, declarators } => {
                self.declarators(*constant, declarators);
                self.put(";");
            }
            StmtKind::Function { name, function } => {
                self.put("function ");
                self.put(&name.text);
                self.params(&function.params);
                self.put(" ");
                match &function.body {
                    Body::Block(statements) => self.block(statements),
                    Body::Value(_) => self.put("{}"), // the parser makes none of these
                }
            }
            StmtKind::If { test, then, otherwise } => {
                self.head("if", test);
                match otherwise {
                    None => self.body(then),
                    Some(otherwise) => {
                        // Without braces the `else` could join an `if` inside.
                        if open_ended(then) {
                            self.put(" ");
                            self.block(std::slice::from_ref(then));
                        } else {
                            self.body(then);
                        }
                        self.put(" else");
                        self.body(otherwise);
                    }
                }
            }
            StmtKind::For { init, test, update, body } => {
                self.put("for (");
                match init.as_deref().map(|s| &s.kind) {
                    Some(StmtKind::Declare { constant, declarators }) => {
                        self.declarators(*constant, declarators);
                    }
                    Some(StmtKind::Expr(expr)) => self.expr(expr, 0),
                    _ => {}
                }
                self.put(";");
                if let Some(test) = test {
                    self.put(" ");
                    self.expr(test, ASSIGNMENT);
                }
                self.put(";");
                if let Some(update) = update {
                    self.put(" ");
                    self.expr(update, 0);
                }
                self.put(")");
                self.body(body);
            }
            StmtKind::ForOf { constant, target, items, body } => {
                self.put(if *constant { "for (const " } else { "for (let " });
                self.pattern(target);
                self.put(" of ");
                self.expr(items, ASSIGNMENT);
                self.put(")");
                self.body(body);
            }
            StmtKind::While { test, body } => {
                self.head("while", test);
                self.body(body);
            }
            StmtKind::DoWhile { body, test } => {
                self.put("do");
                self.body(body);
                self.put(" ");
                self.head("while", test);
                self.put(";");
            }
            StmtKind::Block(statements) => self.block(statements),
            StmtKind::Break => self.put("break;"),
            StmtKind::Continue => self.put("continue;"),
            StmtKind::Return(None) => self.put("return;"),
            StmtKind::Return(Some(value)) => {
                self.put("return ");
                self.expr(value, ASSIGNMENT);
                self.put(";");
            }
            StmtKind::Empty => self.put(";"),
            StmtKind::Error => self.put("<error>"),
        }
    }

    fn head(&mut self, word: &str, test: &Expr) {
        self.put(word);
        self.put(" (");
        self.expr(test, ASSIGNMENT);
        self.put(")");
    }

    fn declarators(&mut self, constant: bool, declarators: &[crate::ast::Declarator]) {
        self.put(if constant { "const " } else { "let " });
        for (i, declarator) in declarators.iter().enumerate() {
            if i > 0 {
                self.put(", ");
            }
            self.pattern(&declarator.target);
            if let Some(value) = &declarator.value {
                self.put(" = ");
                self.expr(value, ASSIGNMENT);
            }
        }
    }

    fn pattern(&mut self, pattern: &Pattern) {
        match pattern {
            Pattern::Name(name) => self.put(&name.text),
            Pattern::List { items, .. } => {
                self.put("[");
                for (i, item) in items.iter().enumerate() {
                    if i > 0 {
                        self.put(", ");
                    }
                    match item {
                        Some(item) => self.element(item),
                        // A hole at the end needs a comma of its own.
                        None if i + 1 == items.len() => self.put(","),
                        None => {}
                    }
                }
                self.put("]");
            }
            Pattern::Record { entries, .. } => {
                self.put("{");
                for (i, (key, element)) in entries.iter().enumerate() {
                    if i > 0 {
                        self.put(", ");
                    }
                    if !matches!(&element.target, Pattern::Name(name) if name.text == key.text) {
                        self.put(&key.text);
                        self.put(": ");
                    }
                    self.element(element);
                }
                self.put("}");
            }
        }
    }

    fn element(&mut self, element: &Element) {
        self.pattern(&element.target);
        if let Some(default) = &element.default {
            self.put(" = ");
            self.expr(default, ASSIGNMENT);
        }
    }

    fn params(&mut self, params: &[Element]) {
        self.put("(");
        for (i, param) in params.iter().enumerate() {
            if i > 0 {
                self.put(", ");
            }
            self.element(param);
        }
        self.put(")");
    }

    fn function(&mut self, function: &Function) {
        // What calls itself by its name needs the name.
        if let (Some(name), Body::Block(statements)) = (&function.name, &function.body) {
            self.put("function ");
            self.put(&name.text);
            self.params(&function.params);
            self.put(" ");
            return self.block(statements);
        }
        self.params(&function.params);
        self.put(" => ");
        match &function.body {
            Body::Block(statements) => self.block(statements),
            // `=> {` would start a block.
            Body::Value(value) => {
                let start = self.out.len();
                self.expr(value, ASSIGNMENT);
                if self.out.get(start..).is_some_and(|text| text.starts_with('{')) {
                    self.out.insert(start, '(');
                    self.put(")");
                }
            }
        }
    }

    /// A tree where an operator around it needs at least `least`.
    fn expr(&mut self, expr: &Expr, least: u8) {
        let enclosed = power(expr) < least;
        if enclosed {
            self.put("(");
        }
        self.kind(expr);
        if enclosed {
            self.put(")");
        }
    }

    fn kind(&mut self, expr: &Expr) {
        match &expr.kind {
            ExprKind::Number(x) => match expr.span.text(self.source) {
                "" => self.put(&number_text(*x)),
                // The place of what stood in parentheses holds these.
                written => {
                    self.put(written.trim_matches(|c: char| matches!(c, '(' | ')') || c.is_whitespace()))
                }
            },
            ExprKind::String(text) => quote(text, &mut self.out),
            ExprKind::Boolean(b) => self.put(if *b { "true" } else { "false" }),
            ExprKind::Null => self.put("null"),
            ExprKind::Name(name) => self.put(name),
            ExprKind::Error => self.put("<error>"),
            ExprKind::Member { object, name, optional } => {
                // `1.x` would be read as the number `1.`
                let digits = matches!(object.kind, ExprKind::Number(_));
                self.expr(object, if digits { ATOM + 1 } else { MEMBER });
                self.put(if *optional { "?." } else { "." });
                self.put(&name.text);
            }
            ExprKind::Index { object, index, optional } => {
                self.expr(object, MEMBER);
                self.put(if *optional { "?.[" } else { "[" });
                // An assignment in an index is read only in parentheses.
                self.expr(index, CHOICE);
                self.put("]");
            }
            ExprKind::Call { callee, args, optional } => {
                self.expr(callee, MEMBER);
                self.put(if *optional { "?.(" } else { "(" });
                self.items(args);
                self.put(")");
            }
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
            ExprKind::Template { texts, values } => {
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
            ExprKind::Function(function) => self.function(function),
            ExprKind::Unary { op, operand } => {
                self.put(op.symbol());
                // `- -x` and `+ ++x` must not run together, nor `typeof x`.
                let runs = starts_with_sign(operand) && matches!(op, UnaryOp::Minus | UnaryOp::Plus);
                if runs || *op == UnaryOp::TypeOf {
                    self.put(" ");
                }
                self.expr(operand, SIGN);
            }
            ExprKind::Binary { op, left, right } => {
                let p = op.power();
                // `**` groups from the right and takes no sign on its left; all others group from the left.
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
            ExprKind::Assign { target, op, value, .. } => {
                let symbol = format!("{}=", op.map_or("", |o| o.symbol()));
                self.between(target, UPDATE, &symbol, value, ASSIGNMENT);
            }
            ExprKind::AssignLogical { target, op, value, .. } => {
                self.between(target, UPDATE, &format!("{}=", op.symbol()), value, ASSIGNMENT);
            }
            ExprKind::Sequence(parts) => {
                for (i, part) in parts.iter().enumerate() {
                    if i > 0 {
                        self.put(", ");
                    }
                    self.expr(part, ASSIGNMENT);
                }
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
        }
    }

    fn object(&mut self, properties: &[Property]) {
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

    fn between(&mut self, left: &Expr, l: u8, symbol: &str, right: &Expr, r: u8) {
        self.expr(left, l);
        self.put(" ");
        self.put(symbol);
        self.put(" ");
        self.expr(right, r);
    }

    /// `??` mixes with `||` and `&&` only in parentheses.
    fn logical_operand(&mut self, op: LogicalOp, operand: &Expr, least: u8) {
        let mixes = matches!(&operand.kind, ExprKind::Logical { op: other, .. }
            if (*other == LogicalOp::Nullish) != (op == LogicalOp::Nullish));
        self.expr(operand, if mixes { ATOM + 1 } else { least });
    }

    fn items(&mut self, items: &[Expr]) {
        for (i, item) in items.iter().enumerate() {
            if i > 0 {
                self.put(", ");
            }
            self.expr(item, ASSIGNMENT);
        }
    }
}

/// Whether an `else` behind this statement would belong to an `if` in it.
fn open_ended(statement: &Stmt) -> bool {
    match &statement.kind {
        StmtKind::If { otherwise: None, .. } => true,
        StmtKind::If { otherwise: Some(last), .. } => open_ended(last),
        StmtKind::For { body, .. } | StmtKind::ForOf { body, .. } | StmtKind::While { body, .. } => {
            open_ended(body)
        }
        _ => false,
    }
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

/// Whether a key can be written without quotes.
fn is_word(key: &str) -> bool {
    key.starts_with(|c: char| c.is_ascii_alphabetic() || c == '_' || c == '$')
        && key.chars().all(|c| c.is_ascii_alphanumeric() || c == '_' || c == '$')
}

/// In the quotes that need no escapes in JSON, unless the text holds them itself.
fn quote(text: &str, out: &mut String) {
    let mark = if text.contains('\'') && !text.contains('"') { '"' } else { '\'' };
    out.push(mark);
    for c in text.chars() {
        match c {
            '\\' => out.push_str("\\\\"),
            c if c == mark => out.extend(['\\', c]),
            '\n' => out.push_str("\\n"),
            '\t' => out.push_str("\\t"),
            '\r' => out.push_str("\\r"),
            c if c.is_control() || matches!(c, '\u{2028}' | '\u{2029}') => {
                out.push_str(&format!("\\u{{{:x}}}", u32::from(c)));
            }
            c => out.push(c),
        }
    }
    out.push(mark);
}

fn template_text(text: &str, out: &mut String) {
    for c in text.chars() {
        match c {
            '`' | '\\' | '$' => out.extend(['\\', c]),
            '\n' => out.push('\n'),
            c if c.is_control() => out.push_str(&format!("\\u{{{:x}}}", u32::from(c))),
            c => out.push(c),
        }
    }
}
