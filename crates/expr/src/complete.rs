//! Completions at a position of a source text that may be incomplete: names, members, methods, and names of
//! objects in string literals.

use crate::chain::{PathMeaning, Tokens, of_entry};
use crate::globals::Globals;
use crate::lex::TokenKind;
use crate::math;
use crate::natives;
use crate::schema::{Entry, Field, Param, Schema, signature};
use crate::types::Type;
use labspec_finding::Span;
use std::fmt;

/// The maximum number of elements of a field whose unit is determined from its object.
const MAX_OBJECT_ELEMENTS: usize = 16;

/// The kind of a suggestion.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Suggested {
    /// An object with members, or a function that returns one.
    Object,
    /// A field of the host.
    Field,
    /// A function or a method.
    Function,
    /// The name of an object, in quotes.
    Name,
    /// A variable of the text, or of `ctx`.
    Variable,
    /// A constant.
    Constant,
}

/// A completion.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Suggestion {
    /// The text to insert.
    pub text: String,
    /// Its kind.
    pub kind: Suggested,
    /// The full form: `data.qpos`, or a signature.
    pub title: String,
    /// Its documentation.
    pub doc: String,
    /// The span that it replaces: the part already typed.
    pub replace: Span,
}

/// What a text can use.
pub struct CompletionScope<'s> {
    /// The variables of all programs of the lab; `None` where the text cannot read them.
    pub globals: Option<&'s Globals>,
    /// Whether `value` has a meaning.
    pub has_value: bool,
    /// Whether the text consists of statements: a function without a result is useful only as one.
    pub has_statements: bool,
    /// Whether the position is the target of an assignment: values and functions cannot be assigned.
    pub is_target: bool,
    /// Whether the text may use a name of the host.
    pub accepts: &'s dyn Fn(&Entry) -> bool,
}

impl fmt::Debug for CompletionScope<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let CompletionScope { globals, has_value, .. } = self;
        f.debug_struct("CompletionScope").field("globals", globals).field("has_value", has_value).finish()
    }
}

/// Returns the completions at byte `offset`, in the order of the host. There are none inside numbers, comments and strings
/// that are not names of objects.
pub fn complete(
    schema: &dyn Schema,
    scope: &CompletionScope<'_>,
    source: &str,
    offset: usize,
) -> Vec<Suggestion> {
    let offset = labspec_finding::floor(source, offset);
    let Some(before) = source.get(..offset) else { return Vec::new() };
    match unclosed(before) {
        OpenConstruct::Comment => Vec::new(),
        OpenConstruct::Text(start) => names(schema, source, start, offset),
        OpenConstruct::Nothing => {
            let part = |c: char| c.is_alphanumeric() || matches!(c, '_' | '$');
            let start = before.len()
                - before.chars().rev().take_while(|c| part(*c)).map(char::len_utf8).sum::<usize>();
            let behind = source.get(offset..).unwrap_or("").chars().take_while(|c| part(*c));
            let replace = Span::new(start, offset + behind.map(char::len_utf8).sum::<usize>());
            if before.get(start..).is_some_and(|word| word.starts_with(|c: char| c.is_ascii_digit())) {
                return Vec::new();
            }
            let all = Tokens::read(schema, source.get(..start).unwrap_or(""));
            let last = all.len().checked_sub(1);
            let point = last.filter(|last| matches!(all.kind(*last), Some(TokenKind::Symbol("." | "?."))));
            let chain = point.and_then(|point| all.meaning(point));
            let first = chain.as_ref().map_or(all.len(), |(_, first)| *first);
            let written = before.get(..start).unwrap_or("");
            let is_statement = scope.has_statements && begins_statement(&all, first, written);
            let mut list = SuggestionList { schema, scope, is_statement, replace, all: Vec::new() };
            match point {
                Some(_) => list.members(chain.map(|(meaning, _)| meaning)),
                None => {
                    list.roots();
                    let whole = Tokens::read(schema, source);
                    for name in whole.variables() {
                        list.add(name, Suggested::Variable, name, "a variable of this text");
                    }
                }
            }
            list.all
        }
    }
}

/// Whether a statement can begin with a token, or with the text after the last one.
fn begins_statement(all: &Tokens<'_>, first: usize, before: &str) -> bool {
    let after_line = match all.kind(first) {
        Some(_) => all.is_first_of_line(first),
        None => before.trim_end_matches([' ', '\t']).ends_with(['\n', '\r']),
    };
    let previous = first.checked_sub(1).and_then(|index| all.kind(index));
    after_line
        || matches!(
            previous,
            None | Some(TokenKind::Symbol(";" | "{" | "}" | ")" | "=>") | TokenKind::Word("else"))
        )
}

/// The construct that is open at the end of a text.
pub(crate) enum OpenConstruct {
    Nothing,
    Comment,
    /// A string literal, and its start.
    Text(usize),
}

pub(crate) fn unclosed(text: &str) -> OpenConstruct {
    let (mut open, mut chars) = (OpenConstruct::Nothing, text.char_indices().peekable());
    while let Some((offset, c)) = chars.next() {
        let next = chars.peek().map(|(_, c)| *c);
        open = match (open, c) {
            (OpenConstruct::Nothing, '\'' | '"' | '`') => OpenConstruct::Text(offset),
            (OpenConstruct::Nothing, '/') if next == Some('/') => {
                // A comment extends to the end of the line.
                match chars.by_ref().find(|(_, c)| *c == '\n') {
                    Some(_) => OpenConstruct::Nothing,
                    None => return OpenConstruct::Comment,
                }
            }
            (OpenConstruct::Nothing, '/') if next == Some('*') => {
                match text.get(offset + 2..).and_then(|rest| rest.find("*/")) {
                    Some(length) => {
                        while chars.next_if(|(i, _)| *i < offset + 2 + length + 2).is_some() {}
                        OpenConstruct::Nothing
                    }
                    None => return OpenConstruct::Comment,
                }
            }
            (OpenConstruct::Text(start), '\\') => {
                chars.next();
                OpenConstruct::Text(start)
            }
            (OpenConstruct::Text(start), c) if text.get(start..).is_some_and(|t| t.starts_with(c)) => {
                OpenConstruct::Nothing
            }
            (OpenConstruct::Text(_), '\n') => OpenConstruct::Nothing,
            (open, _) => open,
        };
    }
    open
}

/// The names of objects that a call accepts, in quotes.
fn names(schema: &dyn Schema, source: &str, start: usize, offset: usize) -> Vec<Suggestion> {
    let all = Tokens::read(schema, source.get(..start).unwrap_or(""));
    let Some(collection) = all.collection_at(all.len()) else { return Vec::new() };
    let quote = source.get(start..).and_then(|t| t.chars().next()).unwrap_or('"');
    let rest = source.get(offset..).unwrap_or("");
    let end = offset + rest.find([quote, ')', ',', '\n']).unwrap_or(0);
    let noun = schema.noun(collection);
    let one = |name: String| Suggestion {
        kind: Suggested::Name,
        title: format!("{noun} {name}"),
        doc: String::new(),
        replace: Span::new(start + 1, end.max(start + 1)),
        text: name,
    };
    schema.names(collection).into_iter().map(one).collect()
}

/// The completions at one position.
struct SuggestionList<'s> {
    schema: &'s dyn Schema,
    scope: &'s CompletionScope<'s>,
    /// Whether a call here would be a statement.
    is_statement: bool,
    replace: Span,
    all: Vec<Suggestion>,
}

impl SuggestionList<'_> {
    fn add(&mut self, text: &str, kind: Suggested, title: impl Into<String>, doc: impl Into<String>) {
        if !self.all.iter().any(|s| s.text == text) {
            let (title, doc) = (title.into(), doc.into());
            self.all.push(Suggestion { text: text.to_string(), kind, title, doc, replace: self.replace });
        }
    }

    fn entry(&mut self, text: &str, entry: Entry) {
        if !(self.scope.accepts)(&entry) || !self.can_follow(&entry) {
            return;
        }
        match of_entry(entry) {
            PathMeaning::Object(id) => self.add(text, Suggested::Object, self.schema.describe(id), ""),
            PathMeaning::Field(field) => {
                let doc = about(self.schema, &field);
                self.add(text, Suggested::Field, field.path, doc);
            }
            PathMeaning::Collection(id) => {
                let noun = self.schema.noun(id).to_string();
                self.add(
                    text,
                    Suggested::Object,
                    format!("{text}(\"name of a {noun}\")"),
                    format!("the {noun} of this name"),
                );
            }
            PathMeaning::Function(id) => {
                let info = self.schema.function(id);
                self.add(text, Suggested::Function, signature(self.schema, &info), info.doc);
            }
            _ => self.add(text, Suggested::Constant, text, ""),
        }
    }

    /// Whether a valid text can continue with this name: a collection needs an object, and so does a function that takes a
    /// name; a function without a result is a statement.
    fn can_follow(&self, entry: &Entry) -> bool {
        let has_names = |id| !self.schema.names(id).is_empty();
        match entry {
            Entry::Collection(id) => has_names(*id),
            Entry::Function(id) => {
                let info = self.schema.function(*id);
                let required = info.params.len().saturating_sub(info.optional);
                let mut required = info.params.iter().take(required);
                (info.returns != Type::Void || self.is_statement)
                    && required.all(|param| !matches!(param, Param::Name(id) if !has_names(*id)))
            }
            Entry::Field(field) => !(self.scope.is_target && field.is_empty()),
            Entry::Object(_) | Entry::Constant(_) => true,
        }
    }

    fn roots(&mut self) {
        if self.scope.has_value && !self.scope.is_target {
            self.add("value", Suggested::Variable, "value", "the chosen value");
        }
        for name in self.schema.root_names() {
            if let Some(entry) = self.schema.root(&name) {
                self.entry(&name, entry);
            }
        }
        if self.scope.globals.is_some() {
            self.add("ctx", Suggested::Object, "ctx", "global variables");
        }
        if self.scope.is_target {
            return;
        }
        self.add("Math", Suggested::Object, "Math", "mathematical functions and constants");
        for name in ["Infinity", "NaN", "undefined", "null", "true", "false"] {
            self.add(name, Suggested::Constant, name, "");
        }
        for name in ["isFinite", "isNaN"] {
            self.add(name, Suggested::Function, name, math::global(name).map_or("", math::MathFunction::doc));
        }
    }

    /// Adds the members after a point.
    fn members(&mut self, of: Option<PathMeaning>) {
        match of {
            Some(PathMeaning::Object(id)) => {
                for name in self.schema.member_names(id) {
                    if let Some(entry) = self.schema.member(id, &name) {
                        self.entry(&name, entry);
                    }
                }
            }
            Some(PathMeaning::Math) if !self.scope.is_target => {
                for name in math::names() {
                    match math::function(name) {
                        Some(function) => {
                            self.add(name, Suggested::Function, function.path(), function.doc())
                        }
                        None => self.add(name, Suggested::Constant, format!("Math.{name}"), ""),
                    }
                }
            }
            Some(PathMeaning::Globals) => {
                let globals = self.scope.globals;
                for slot in 0..globals.map_or(0, Globals::len) {
                    let name = globals.map_or("", |all| all.name(slot as u32)).to_string();
                    self.add(&name, Suggested::Variable, format!("ctx.{name}"), "a global variable");
                }
            }
            Some(PathMeaning::Field(field))
                if !field.is_scalar() && (self.scope.accepts)(&Entry::Field(field.clone())) =>
            {
                self.methods(Type::View);
            }
            Some(PathMeaning::Result(id)) if (self.scope.accepts)(&Entry::Function(id)) => {
                let info = self.schema.function(id);
                for (name, ty) in info.members {
                    self.add(&name, Suggested::Field, format!("{}().{name}", info.name), ty.describe());
                }
                self.methods(info.returns);
            }
            Some(PathMeaning::Value(ty)) => self.methods(ty),
            _ => {}
        }
    }

    fn methods(&mut self, of: Type) {
        if self.scope.is_target {
            return;
        }
        if matches!(of, Type::View | Type::List | Type::String) {
            self.add("length", Suggested::Field, ".length", "the number of elements");
        }
        for row in natives::public_rows().filter(|row| of != Type::Any && row.is_of(of)) {
            self.add(row.name, Suggested::Function, row.title(), row.doc);
        }
    }
}

/// A description of a field in one sentence.
fn about(schema: &dyn Schema, field: &Field) -> String {
    // The part of one object is small; a whole array would need a search in each of its elements.
    let of_object = field.len().is_some_and(|count| count <= MAX_OBJECT_ELEMENTS);
    let unit = if of_object { schema.unit(field, None) } else { field.unit.clone() };
    let unit = if unit.is_empty() { String::new() } else { format!(", {unit}") };
    let shape: Vec<String> = field.shape.iter().map(|n| n.map_or("?".into(), |n| n.to_string())).collect();
    let shape = if shape.is_empty() { String::new() } else { format!(" ({} numbers)", shape.join(" × ")) };
    format!("{}{unit}{shape}", field.doc)
}
