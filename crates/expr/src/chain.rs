//! The chain before a position of a source text, determined from its tokens: `data.joint("hinge").qpos[0]` is a name, a member,
//! a call, a member and an index. The text around the position may be incomplete, as it is while an author types.

use crate::globals::Globals;
use crate::lex::{Token, TokenKind, tokens};
use crate::schema::{Entry, Field, Param, Schema};
use crate::types::{CollectionId, FunctionId, ObjectId, Type};
use labspec_finding::Span;
use labspec_finding::order;

/// Limit on the number of aliases that are resolved (variables that refer to other variables).
const MAX_ALIASES: usize = 8;
/// Limit on the number of links of a chain.
const MAX_LINKS: usize = 32;

/// The meaning of a chain.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum PathMeaning {
    Object(ObjectId),
    Field(Field),
    /// An element of a field: the field, and the index if it is a literal.
    Element(Field, Option<usize>),
    Collection(CollectionId),
    Function(FunctionId),
    /// The result of a function.
    Result(FunctionId),
    /// `Math`
    Math,
    /// `ctx`
    Globals,
    /// A value of which only the type is known.
    Value(Type),
}

/// The tokens of a source text.
pub(crate) struct Tokens<'s> {
    list: Vec<Token<'s>>,
    /// `None` if only the syntax is needed.
    schema: Option<&'s dyn Schema>,
}

/// A string literal that a call interprets as the name of an object.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NamedObject {
    /// The collection in which the name is looked up.
    pub collection: CollectionId,
    /// The name.
    pub name: String,
    /// The span of the name in the text, without quotes.
    pub span: Span,
}

/// A field that a text mentions.
#[derive(Clone, Debug, PartialEq)]
pub struct FieldMention {
    /// The field, or the part of it that belongs to one object.
    pub field: Field,
    /// The element, counted from the start of that part, if its index is a literal.
    pub element: Option<usize>,
    /// The span in the text, including an index.
    pub span: Span,
}

/// Returns all names of objects in a text, in order. In an invalid text, returns those that can be recognized.
pub fn names_in(schema: &dyn Schema, source: &str) -> Vec<NamedObject> {
    let all = Tokens::read(schema, source);
    let named = (0..all.list.len()).filter_map(|i| all.named(i));
    named.collect()
}

/// Returns all string literals in a text, with their spans (without quotes).
pub fn texts_in(source: &str) -> Vec<(String, Span)> {
    let found = tokens(source, &mut Vec::new());
    let text = |t: Token<'_>| match t.kind {
        TokenKind::Text(text) => Some((text, inner(t.span))),
        _ => None,
    };
    found.into_iter().filter_map(text).collect()
}

/// Returns the span of the longest chain of names, members, indexes and calls that ends with the link at byte `offset`. In
/// `data.qpos[0]`, this is `data` at its first letter, `data.qpos` after the point, and the whole chain at the index.
pub fn chain_at(source: &str, offset: usize) -> Option<Span> {
    let all = Tokens::syntax(source);
    let holds = |t: &Token<'_>| t.span.start <= offset && offset <= t.span.end;
    // Between two tokens, a name that begins there is preferred.
    let near: Vec<usize> = (0..all.len()).filter(|&i| all.list.get(i).is_some_and(holds)).collect();
    let is_word = |i: &&usize| matches!(all.kind(**i), Some(TokenKind::Word(_)));
    let mut last = *near.iter().find(is_word).or(near.first())?;
    // Inside the brackets of an index or a call, the chain ends at the closing bracket.
    if !matches!(all.kind(last), Some(TokenKind::Word(_))) {
        let mut depth = 0usize;
        last = (last..all.len()).find(|&i| match all.kind(i) {
            Some(TokenKind::Symbol("(" | "[")) => {
                depth += usize::from(i != last);
                false
            }
            Some(TokenKind::Symbol(")" | "]")) if depth == 0 => true,
            Some(TokenKind::Symbol(")" | "]")) => {
                depth -= 1;
                false
            }
            _ => false,
        })?;
    }
    // For the name of a called function, the chain includes the call.
    if matches!(all.kind(last + 1), Some(TokenKind::Symbol("("))) {
        let close = (last + 1..all.len()).find(|&i| all.opening(i) == Some(last + 1) && i > last + 1)?;
        last = close;
    }
    let first = all.begin(last + 1)?;
    let (first, last) = (all.list.get(first)?, all.list.get(last)?);
    Some(first.span.to(last.span))
}

/// Returns all fields that a text mentions, in order.
pub fn fields_in(schema: &dyn Schema, source: &str) -> Vec<FieldMention> {
    let all = Tokens::read(schema, source);
    let mut found = Vec::new();
    for i in 0..all.list.len() {
        // The last link of a chain, which no further link follows.
        let ends = matches!(all.kind(i), Some(TokenKind::Word(_) | TokenKind::Symbol("]")));
        if !ends || matches!(all.kind(i + 1), Some(TokenKind::Symbol("." | "?." | "(" | "["))) {
            continue;
        }
        let Some((meaning, from)) = all.meaning(i + 1) else { continue };
        let span = |from: usize| match (all.list.get(from), all.list.get(i)) {
            (Some(first), Some(last)) => first.span.to(last.span),
            _ => Span::default(),
        };
        match meaning {
            PathMeaning::Field(field) if from < i => {
                found.push(FieldMention { field, element: None, span: span(from) });
            }
            PathMeaning::Element(field, element) => {
                found.push(FieldMention { field, element, span: span(from) })
            }
            _ => {}
        }
    }
    found
}

/// The span of a string literal without its quotes.
fn inner(span: Span) -> Span {
    Span::new(span.start + 1, span.end.saturating_sub(1).max(span.start + 1))
}

/// The tokens of a text, without the end token.
fn listed(source: &str) -> Vec<Token<'_>> {
    let mut list = tokens(source, &mut Vec::new());
    list.pop();
    list
}

impl<'s> Tokens<'s> {
    pub(crate) fn read(schema: &'s dyn Schema, source: &'s str) -> Tokens<'s> {
        Tokens { list: listed(source), schema: Some(schema) }
    }

    /// The tokens of a text of which only the syntax is needed.
    pub(crate) fn syntax(source: &'s str) -> Tokens<'s> {
        Tokens { list: listed(source), schema: None }
    }

    pub(crate) fn len(&self) -> usize {
        self.list.len()
    }

    pub(crate) fn kind(&self, i: usize) -> Option<&TokenKind<'s>> {
        self.list.get(i).map(|t| &t.kind)
    }

    /// Whether a line break precedes a token.
    pub(crate) fn is_first_of_line(&self, i: usize) -> bool {
        self.list.get(i).is_some_and(|t| t.newline)
    }

    /// The name of an object at a token.
    fn named(&self, i: usize) -> Option<NamedObject> {
        let Some(TokenKind::Text(name)) = self.kind(i) else { return None };
        let collection = self.collection_at(i)?;
        Some(NamedObject { collection, name: name.clone(), span: inner(self.list.get(i)?.span) })
    }

    /// The collection whose names are valid for the argument at a token, whether or not the argument has been typed yet.
    pub(crate) fn collection_at(&self, i: usize) -> Option<CollectionId> {
        let (mut depth, mut argument, mut index) = (0usize, 0usize, i);
        let open = loop {
            index = index.checked_sub(1)?;
            match self.kind(index)? {
                TokenKind::Symbol(")" | "]" | "}") => depth += 1,
                TokenKind::Symbol("(") if depth == 0 => break index,
                TokenKind::Symbol("(" | "[" | "{") => depth = depth.checked_sub(1)?,
                TokenKind::Symbol(",") if depth == 0 => argument += 1,
                _ => {}
            }
        };
        match self.meaning(open)?.0 {
            PathMeaning::Collection(id) if argument == 0 => Some(id),
            PathMeaning::Function(id) => match self.schema?.function(id).params.get(argument) {
                Some(Param::Name(id)) => Some(*id),
                _ => None,
            },
            _ => None,
        }
    }

    /// The meaning of the chain that ends before token `end`, and the token at which the chain begins.
    pub(crate) fn meaning(&self, end: usize) -> Option<(PathMeaning, usize)> {
        self.meaning_within(end, MAX_ALIASES)
    }

    fn meaning_within(&self, end: usize, aliases: usize) -> Option<(PathMeaning, usize)> {
        let mut links = Vec::new();
        let mut index = end;
        loop {
            index = index.checked_sub(1)?;
            if links.len() > MAX_LINKS {
                return None;
            }
            match self.kind(index)? {
                TokenKind::Symbol(close @ (")" | "]")) => {
                    let open = self.opening(index)?;
                    links.push(if *close == ")" {
                        PathLink::Call(open, index)
                    } else {
                        PathLink::Index(open, index)
                    });
                    index = open;
                }
                TokenKind::Word(name) => match index.checked_sub(1).and_then(|before| self.kind(before)) {
                    Some(TokenKind::Symbol("." | "?.")) => {
                        links.push(PathLink::Member(name));
                        index -= 1;
                    }
                    _ => {
                        let mut meaning = self.root(name, index, aliases)?;
                        for link in links.iter().rev() {
                            meaning = self.follow(&meaning, link)?;
                        }
                        return Some((meaning, index));
                    }
                },
                _ => return None,
            }
        }
    }

    /// The opening bracket that matches a closing bracket.
    fn opening(&self, close: usize) -> Option<usize> {
        let mut depth = 0usize;
        for index in (0..=close).rev() {
            match self.kind(index)? {
                TokenKind::Symbol(")" | "]" | "}") => depth += 1,
                TokenKind::Symbol("(" | "[" | "{") => depth = depth.checked_sub(1)?,
                _ => {}
            }
            if depth == 0 {
                return Some(index);
            }
        }
        None
    }

    fn root(&self, name: &str, index: usize, aliases: usize) -> Option<PathMeaning> {
        if let Some(end) = self.declared(name, index) {
            return self.meaning_within(end, aliases.checked_sub(1)?).map(|(meaning, _)| meaning);
        }
        match name {
            "Math" => Some(PathMeaning::Math),
            "ctx" => Some(PathMeaning::Globals),
            _ => self.schema?.root(name).map(of_entry),
        }
    }

    /// For a declaration `const v = CHAIN` before a token, the token at which the chain ends.
    fn declared(&self, name: &str, before: usize) -> Option<usize> {
        let is = |i: usize, text: &str| matches!(self.kind(i), Some(TokenKind::Word(w) | TokenKind::Symbol(w)) if *w == text);
        let declares = |i: &usize| {
            ["const", "let", "var"].iter().any(|w| is(*i, w)) && is(i + 1, name) && is(i + 2, "=")
        };
        let start = (0..before).rev().find(declares)? + 3;
        let ends = |i: &usize| match self.list.get(*i) {
            Some(t) => {
                matches!(t.kind, TokenKind::Symbol(";" | ",")) && self.is_level(start, *i)
                    || (t.newline && *i > start)
            }
            None => true,
        };
        let end = (start..=self.list.len()).find(ends)?;
        // The initial value must consist of exactly one chain.
        (end <= before && self.begin(end)? == start).then_some(end)
    }

    /// Whether the brackets between two tokens are balanced.
    fn is_level(&self, from: usize, to: usize) -> bool {
        let count = |marks: [&str; 3]| {
            let within = (from..to)
                .filter(|&i| matches!(self.kind(i), Some(TokenKind::Symbol(s)) if marks.contains(s)));
            within.count()
        };
        count(["(", "[", "{"]) == count([")", "]", "}"])
    }

    /// The token at which the chain that ends before token `end` begins.
    fn begin(&self, end: usize) -> Option<usize> {
        let mut index = end;
        loop {
            index = index.checked_sub(1)?;
            match self.kind(index)? {
                TokenKind::Symbol(")" | "]") => index = self.opening(index)?,
                TokenKind::Word(_) => match index.checked_sub(1).and_then(|before| self.kind(before)) {
                    Some(TokenKind::Symbol("." | "?.")) => index -= 1,
                    _ => return Some(index),
                },
                _ => return None,
            }
        }
    }

    fn follow(&self, meaning: &PathMeaning, link: &PathLink<'_>) -> Option<PathMeaning> {
        match (meaning, link) {
            (PathMeaning::Object(id), PathLink::Member(name)) => self.schema?.member(*id, name).map(of_entry),
            (PathMeaning::Collection(id), PathLink::Call(open, close)) => {
                let Some(TokenKind::Text(name)) = self.kind(open + 1).filter(|_| open + 2 == *close) else {
                    return None;
                };
                self.schema?.lookup(*id, name).map(PathMeaning::Object)
            }
            (PathMeaning::Function(id), PathLink::Call(..)) => Some(PathMeaning::Result(*id)),
            (PathMeaning::Result(id), PathLink::Member(name)) => {
                let members = self.schema?.function(*id).members;
                members.into_iter().find(|(member, _)| member == name).map(|(_, ty)| PathMeaning::Value(ty))
            }
            (PathMeaning::Field(field), PathLink::Index(open, close)) => {
                let index = match self.kind(open + 1) {
                    Some(TokenKind::Number(x)) if open + 2 == *close && *x >= 0.0 && x.fract() == 0.0 => {
                        Some(*x as usize)
                    }
                    _ => None,
                };
                Some(PathMeaning::Element(field.clone(), index))
            }
            _ => None,
        }
    }

    /// All names that the text declares: variables, functions and their parameters.
    pub(crate) fn variables(&self) -> Vec<&'s str> {
        let mut names: Vec<&'s str> = Vec::new();
        let word = |i: usize| match self.kind(i) {
            Some(TokenKind::Word(word)) => Some(*word),
            _ => None,
        };
        for i in 0..self.list.len() {
            match self.kind(i) {
                Some(TokenKind::Word("const" | "let" | "var" | "function")) => names.extend(word(i + 1)),
                Some(TokenKind::Symbol("=>")) => {
                    let last = i.saturating_sub(1);
                    match self.kind(last) {
                        Some(TokenKind::Symbol(")")) => {
                            let first = self.opening(last).unwrap_or(last);
                            names.extend((first..last).filter_map(word));
                        }
                        _ => names.extend(word(last)),
                    }
                }
                _ => {}
            }
        }
        order::sort_by(&mut names, Ord::cmp);
        names.dedup();
        names
    }
}

/// A link of a chain, with the tokens of its brackets.
enum PathLink<'s> {
    Member(&'s str),
    Call(usize, usize),
    Index(usize, usize),
}

pub(crate) fn of_entry(entry: Entry) -> PathMeaning {
    match entry {
        Entry::Object(id) => PathMeaning::Object(id),
        Entry::Field(field) => PathMeaning::Field(field),
        Entry::Collection(id) => PathMeaning::Collection(id),
        Entry::Function(id) => PathMeaning::Function(id),
        Entry::Constant(value) => PathMeaning::Value(value.type_of()),
    }
}

/// The variables of `ctx` that any of these texts mentions.
pub fn variables_of<'t>(schema: &dyn Schema, texts: impl IntoIterator<Item = &'t str>) -> Globals {
    let mut globals = Globals::new();
    for text in texts {
        let all = Tokens::read(schema, text);
        for i in 0..all.len() {
            let names = (all.kind(i), all.kind(i + 1), all.kind(i + 2));
            if let (
                Some(TokenKind::Word("ctx")),
                Some(TokenKind::Symbol("." | "?.")),
                Some(TokenKind::Word(name)),
            ) = names
            {
                globals.define(name);
            }
        }
    }
    globals
}
