//! What stands before a place of a text, as far as its tokens tell: `data.joint("hinge").qpos[0]` is a name, a member, a call, a
//! member and an index. The text around it may be incomplete, which is what it is while somebody writes.

use crate::globals::Globals;
use crate::lex::{Token, TokenKind, tokens};
use crate::schema::{Entry, Field, Param, Schema};
use crate::types::{CollectionId, FunctionId, ObjectId, Type};
use labspec_finding::Span;

/// How often a variable may stand for another one.
const MAX_ALIASES: usize = 8;
/// The longest chain that is looked at.
const MAX_LINKS: usize = 32;

/// What a chain means.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum PathMeaning {
    Object(ObjectId),
    Field(Field),
    /// One element of a field: the field, and its index where it is a number of the text.
    Element(Field, Option<usize>),
    Collection(CollectionId),
    Function(FunctionId),
    /// What a function gives.
    Result(FunctionId),
    /// `Math`
    Math,
    /// `ctx`
    Globals,
    /// A value of which only the type is known.
    Value(Type),
}

/// A text by its tokens.
pub(crate) struct Tokens<'s> {
    list: Vec<Token<'s>>,
    /// `None` where only its form is of interest.
    schema: Option<&'s dyn Schema>,
}

/// A name between quotes that a call takes for the name of an object.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NamedObject {
    /// The objects among which it is looked up.
    pub collection: CollectionId,
    /// The name.
    pub name: String,
    /// Its bytes in the text, without quotes.
    pub span: Span,
}

/// A field that a text names.
#[derive(Clone, Debug, PartialEq)]
pub struct FieldMention {
    /// The field, or the part of it that one object has.
    pub field: Field,
    /// The element, counted from the start of that part, where a number of the text tells it.
    pub element: Option<usize>,
    /// Bytes of the text, an index included.
    pub span: Span,
}

/// All names of objects in a text, in order. Where it is broken, those that can be recognized.
pub fn names_in(schema: &dyn Schema, source: &str) -> Vec<NamedObject> {
    let all = Tokens::read(schema, source);
    let named = (0..all.list.len()).filter_map(|i| all.named(i));
    named.collect()
}

/// All texts between quotes in a text, with their bytes (without quotes).
pub fn texts_in(source: &str) -> Vec<(String, Span)> {
    let found = tokens(source, &mut Vec::new());
    let text = |t: Token<'_>| match t.kind {
        TokenKind::Text(text) => Some((text, inner(t.span))),
        _ => None,
    };
    found.into_iter().filter_map(text).collect()
}

/// The longest chain of names, members, indexes and calls that ends with the link at a byte of a text: in `data.qpos[0]` that is
/// `data` at its first letter, `data.qpos` behind the point, and all of it at the index.
pub fn chain_at(source: &str, offset: usize) -> Option<Span> {
    let all = Tokens { list: listed(source), schema: None };
    let holds = |t: &Token<'_>| t.span.start <= offset && offset <= t.span.end;
    // Between two tokens, the one that begins there is meant, if it is a name.
    let near: Vec<usize> = (0..all.len()).filter(|&i| all.list.get(i).is_some_and(holds)).collect();
    let is_word = |i: &&usize| matches!(all.kind(**i), Some(TokenKind::Word(_)));
    let mut last = *near.iter().find(is_word).or(near.first())?;
    // In the brackets of an index or a call, all of it is meant.
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
    // A name that is called means what the call gives.
    if matches!(all.kind(last + 1), Some(TokenKind::Symbol("("))) {
        let close = (last + 1..all.len()).find(|&i| all.opening(i) == Some(last + 1) && i > last + 1)?;
        last = close;
    }
    let first = all.begin(last + 1)?;
    let (first, last) = (all.list.get(first)?, all.list.get(last)?);
    Some(first.span.to(last.span))
}

/// All fields that a text names, in order.
pub fn fields_in(schema: &dyn Schema, source: &str) -> Vec<FieldMention> {
    let all = Tokens::read(schema, source);
    let mut found = Vec::new();
    for i in 0..all.list.len() {
        // The last link of a chain: nothing goes on behind it.
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

/// The bytes of a text between quotes, without the quotes.
fn inner(span: Span) -> Span {
    Span::new(span.start + 1, span.end.saturating_sub(1).max(span.start + 1))
}

/// The tokens of a text, without its end.
fn listed(source: &str) -> Vec<Token<'_>> {
    let mut list = tokens(source, &mut Vec::new());
    list.pop();
    list
}

impl<'s> Tokens<'s> {
    pub(crate) fn read(schema: &'s dyn Schema, source: &'s str) -> Tokens<'s> {
        Tokens { list: listed(source), schema: Some(schema) }
    }

    pub(crate) fn len(&self) -> usize {
        self.list.len()
    }

    pub(crate) fn kind(&self, i: usize) -> Option<&TokenKind<'s>> {
        self.list.get(i).map(|t| &t.kind)
    }

    /// The name of an object that stands at a token.
    fn named(&self, i: usize) -> Option<NamedObject> {
        let Some(TokenKind::Text(name)) = self.kind(i) else { return None };
        let collection = self.collection_at(i)?;
        Some(NamedObject { collection, name: name.clone(), span: inner(self.list.get(i)?.span) })
    }

    /// The objects whose names the argument takes that stands at, or would stand at, a token.
    pub(crate) fn collection_at(&self, i: usize) -> Option<CollectionId> {
        let (mut depth, mut argument, mut at) = (0usize, 0usize, i);
        let open = loop {
            at = at.checked_sub(1)?;
            match self.kind(at)? {
                TokenKind::Symbol(")" | "]" | "}") => depth += 1,
                TokenKind::Symbol("(") if depth == 0 => break at,
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

    /// What the chain means that ends before a token, and the token at which it begins.
    pub(crate) fn meaning(&self, end: usize) -> Option<(PathMeaning, usize)> {
        self.meaning_within(end, MAX_ALIASES)
    }

    fn meaning_within(&self, end: usize, aliases: usize) -> Option<(PathMeaning, usize)> {
        let mut links = Vec::new();
        let mut at = end;
        loop {
            at = at.checked_sub(1)?;
            if links.len() > MAX_LINKS {
                return None;
            }
            match self.kind(at)? {
                TokenKind::Symbol(close @ (")" | "]")) => {
                    let open = self.opening(at)?;
                    links.push(if *close == ")" {
                        PathLink::Call(open, at)
                    } else {
                        PathLink::Index(open, at)
                    });
                    at = open;
                }
                TokenKind::Word(name) => match at.checked_sub(1).and_then(|before| self.kind(before)) {
                    Some(TokenKind::Symbol("." | "?.")) => {
                        links.push(PathLink::Member(name));
                        at -= 1;
                    }
                    _ => {
                        let mut meaning = self.root(name, at, aliases)?;
                        for link in links.iter().rev() {
                            meaning = self.follow(&meaning, link)?;
                        }
                        return Some((meaning, at));
                    }
                },
                _ => return None,
            }
        }
    }

    /// The bracket that a bracket closes.
    fn opening(&self, close: usize) -> Option<usize> {
        let mut depth = 0usize;
        for at in (0..=close).rev() {
            match self.kind(at)? {
                TokenKind::Symbol(")" | "]" | "}") => depth += 1,
                TokenKind::Symbol("(" | "[" | "{") => depth = depth.checked_sub(1)?,
                _ => {}
            }
            if depth == 0 {
                return Some(at);
            }
        }
        None
    }

    fn root(&self, name: &str, at: usize, aliases: usize) -> Option<PathMeaning> {
        if let Some(end) = self.declared(name, at) {
            return self.meaning_within(end, aliases.checked_sub(1)?).map(|(meaning, _)| meaning);
        }
        match name {
            "Math" => Some(PathMeaning::Math),
            "ctx" => Some(PathMeaning::Globals),
            _ => self.schema?.root(name).map(of_entry),
        }
    }

    /// The end of what a variable is declared as, before a token: `const v = CHAIN`.
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
        // Nothing but one chain.
        (end <= before && self.begin(end)? == start).then_some(end)
    }

    /// Whether as many brackets are closed as are opened between two tokens.
    fn is_level(&self, from: usize, to: usize) -> bool {
        let count = |marks: [&str; 3]| {
            let within = (from..to)
                .filter(|&i| matches!(self.kind(i), Some(TokenKind::Symbol(s)) if marks.contains(s)));
            within.count()
        };
        count(["(", "[", "{"]) == count([")", "]", "}"])
    }

    /// Where the chain begins that ends before a token.
    fn begin(&self, end: usize) -> Option<usize> {
        let mut at = end;
        loop {
            at = at.checked_sub(1)?;
            match self.kind(at)? {
                TokenKind::Symbol(")" | "]") => at = self.opening(at)?,
                TokenKind::Word(_) => match at.checked_sub(1).and_then(|before| self.kind(before)) {
                    Some(TokenKind::Symbol("." | "?.")) => at -= 1,
                    _ => return Some(at),
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

    /// Every name that the text declares: variables, functions and their parameters.
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
        names.sort_unstable();
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

/// The variables of `ctx` that any of these texts names.
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
