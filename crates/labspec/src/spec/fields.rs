//! Reads the declared keys of an object. Errors are collected; the first one does not end the reading.

use super::format::{Family, Key, Need, Object, Type};
use super::problem::{Expected, Meant, Mistake, Problem};
use super::read::{number, scalar, text, whole, wrong, wrong_key};
use crate::json::{Json, Member, Node, Number, Scalar, nearest};
use crate::source::Text;
use std::ops::Range;

/// Reads the keys of an object. [`Fields::finish`] reports the keys that are not declared, and the missing ones.
pub(super) struct Fields<'n, 'f> {
    /// The kind of object, with its article: "a slider".
    what: &'static str,
    /// The keys that are allowed.
    keys: Vec<&'static Key>,
    members: &'n [Member],
    span: Range<usize>,
    /// For each misspelt key: the key that is probably meant, and the index of the member.
    meant: Vec<(&'static str, usize)>,
    missing: Vec<(&'static str, Problem)>,
    /// Receives the problems.
    pub(super) problems: &'f mut Vec<Problem>,
}

impl<'n, 'f> Fields<'n, 'f> {
    /// Opens an object. For any other value, the result is a problem and `None`.
    pub(super) fn open(
        node: &'n Node,
        object: &'static Object,
        problems: &'f mut Vec<Problem>,
    ) -> Option<Fields<'n, 'f>> {
        Fields::with(node, object.what, object.keys.iter().collect(), problems)
    }

    /// Opens an object of a family. Call [`Fields::narrow`] once the kind is known.
    pub(super) fn open_one(
        node: &'n Node,
        family: &'static Family,
        problems: &'f mut Vec<Problem>,
    ) -> Option<Fields<'n, 'f>> {
        Fields::with(node, family.what, family.keys(), problems)
    }

    fn with(
        node: &'n Node,
        what: &'static str,
        keys: Vec<&'static Key>,
        problems: &'f mut Vec<Problem>,
    ) -> Option<Fields<'n, 'f>> {
        let Json::Object(members) = &node.json else {
            wrong(problems, node, what.to_string(), Expected::Object);
            return None;
        };
        let (span, meant, missing) = (node.span.clone(), Vec::new(), Vec::new());
        let mut fields = Fields { what, keys, members, span, meant, missing, problems };
        fields.guess();
        Some(fields)
    }

    /// Finds the keys that misspelt keys probably mean. They are read as these keys, so that one typing error causes no
    /// other problems. [`Fields::finish`] reports them.
    fn guess(&mut self) {
        for (i, member) in self.members.iter().enumerate().take(200) {
            let key = member.key.as_str();
            if self.key(key).is_some() || self.meant.len() >= 20 {
                continue;
            }
            let fitting = self.keys.iter().filter(|k| fits(&k.ty, &member.value.json)).map(|k| k.name);
            if let Some(right) = nearest(key, fitting)
                && !self.has(right)
            {
                self.meant.push((right, i));
            }
        }
    }

    fn key(&self, name: &str) -> Option<&'static Key> {
        self.keys.iter().find(|k| k.name == name).copied()
    }

    /// Sets which object of the family it is.
    pub(super) fn narrow(&mut self, object: &'static Object) {
        self.what = object.what;
        self.keys = object.keys.iter().collect();
    }

    /// Byte range of the object, brackets included.
    pub(super) fn span(&self) -> Range<usize> {
        self.span.clone()
    }

    /// The value of a key. If a key occurs twice, the last one counts, as in `JSON.parse`. Records a problem if the key is
    /// missing and its absence is an error or a warning.
    pub(super) fn node(&mut self, key: &'static str) -> Option<&'n Node> {
        debug_assert!(self.key(key).is_some(), "{} has no key {key}", self.what);
        let exact = self.members.iter().rev().find(|m| m.key.value == key);
        let meant =
            || self.meant.iter().find(|(right, _)| *right == key).and_then(|(_, i)| self.members.get(*i));
        let found = exact.or_else(meant).map(|m| &m.value);
        if found.is_none() {
            match self.key(key).map(|k| k.need) {
                Some(Need::Must(why)) => self.missing(key, why, false),
                Some(Need::Advised(why)) => self.missing(key, why, true),
                Some(Need::Optional) | None => {}
            }
        }
        found
    }

    /// Whether the object has this key, possibly misspelt.
    pub(super) fn has(&self, key: &str) -> bool {
        self.members.iter().any(|m| m.key.value == key) || self.meant.iter().any(|(right, _)| *right == key)
    }

    /// Whether the value of a key is an empty list or an empty object.
    pub(super) fn is_empty(&self, key: &str) -> bool {
        self.members.iter().any(|m| {
            let nothing = match &m.value.json {
                Json::Array(items) => items.is_empty(),
                Json::Object(members) => members.is_empty(),
                _ => false,
            };
            m.key.value == key && nothing
        })
    }

    /// Records that a key is missing. The problem points to the opening bracket of the object.
    pub(super) fn missing(&mut self, key: &'static str, why: &'static str, advised: bool) {
        if self.missing.iter().any(|(k, _)| *k == key) {
            return;
        }
        let open = self.span.start..self.span.end.min(self.span.start + 1);
        let example = self.key(key).map_or("", |k| k.example);
        let mistake = Mistake::MissingKey { object: self.what, key, why, advised, example };
        self.missing.push((key, mistake.at(open)));
    }

    /// Whether the value of a key is a list.
    pub(super) fn takes_list(&self, key: &str) -> bool {
        matches!(self.key(key).map(|k| k.ty), Some(Type::List(_)))
    }

    /// Whether the value of a key is a boolean.
    pub(super) fn takes_flag(&self, key: &str) -> bool {
        matches!(self.key(key).map(|k| k.ty), Some(Type::Flag))
    }

    /// Reads a text.
    pub(super) fn text(&mut self, key: &'static str) -> Option<Text> {
        let node = self.node(key)?;
        text(node, key, self.problems)
    }

    /// Reads a number.
    pub(super) fn number(&mut self, key: &'static str) -> Option<Number> {
        let node = self.node(key)?;
        number(node, key, self.problems)
    }

    /// Reads an integer. The rules check its sign and its range.
    pub(super) fn whole(&mut self, key: &'static str) -> Option<Number> {
        let node = self.node(key)?;
        whole(node, key, self.problems)
    }

    /// Reads a boolean. A missing key or a value of another type gives `false`.
    pub(super) fn flag(&mut self, key: &'static str) -> bool {
        let Some(node) = self.node(key) else { return false };
        match node.json {
            Json::Bool(b) => b,
            _ => {
                wrong_key(self.problems, node, key, Expected::Flag);
                false
            }
        }
    }

    /// Reads a number, a text or a boolean.
    pub(super) fn scalar(&mut self, key: &'static str) -> Option<Scalar> {
        let node = self.node(key)?;
        scalar(node, key, self.problems)
    }

    /// The items of a list, empty for a value of another type. `None` if the key is missing.
    pub(super) fn items(&mut self, key: &'static str) -> Option<&'n [Node]> {
        let node = self.node(key)?;
        Some(match &node.json {
            Json::Array(items) => items,
            _ => {
                wrong_key(self.problems, node, key, Expected::List);
                &[]
            }
        })
    }

    /// The items of a list, empty if the key is missing or has a value of another type.
    pub(super) fn list(&mut self, key: &'static str) -> &'n [Node] {
        self.items(key).unwrap_or_default()
    }

    /// The members of an object with free keys, empty if the key is missing or has a value of another type.
    pub(super) fn map(&mut self, key: &'static str) -> &'n [Member] {
        let Some(node) = self.node(key) else { return &[] };
        match &node.json {
            Json::Object(members) => members,
            _ => {
                wrong_key(self.problems, node, key, Expected::Object);
                &[]
            }
        }
    }

    /// Reports every key that is not declared, and every missing key, except one for which a misspelt key was reported.
    pub(super) fn finish(self) {
        let (mut misspelt, mut reported) = (Vec::new(), 0);
        for (i, member) in self.members.iter().enumerate() {
            let key = member.key.as_str();
            if self.key(key).is_some() {
                continue;
            }
            // Only the first ones get suggestions: an object can have thousands of unknown keys.
            let candidates = || self.keys.iter().take(if reported < 20 { usize::MAX } else { 0 });
            let meant = self.meant.iter().find(|(right, index)| *index == i && self.key(right).is_some());
            let there =
                |right: &str| self.members.iter().any(|m| m.key.value == right) || misspelt.contains(&right);
            let fitting =
                || nearest(key, candidates().filter(|k| fits(&k.ty, &member.value.json)).map(|k| k.name));
            let near = meant.map(|(right, _)| *right).or_else(fitting);
            let meant = match near.or_else(|| nearest(key, candidates().map(|k| k.name))) {
                Some(right) if there(right) => Meant::There(right),
                Some(right) => {
                    misspelt.push(right);
                    match near {
                        Some(_) => Meant::Likely(right),
                        None => {
                            let takes = self.key(right).map_or(A_SINGLE_VALUE, |k| takes(&k.ty));
                            Meant::Other { key: right, takes }
                        }
                    }
                }
                None => Meant::Unclear(self.keys.iter().map(|k| k.name).collect()),
            };
            let mistake = Mistake::UnknownKey { object: self.what, key: key.to_string(), meant };
            self.problems.push(mistake.at(member.key.span()));
            reported += 1;
        }
        let missing = self.missing.into_iter().filter(|(key, _)| !misspelt.contains(key));
        self.problems.extend(missing.map(|(_, problem)| problem));
    }
}

/// Whether a value has the JSON type (list, object or single value) that a key of this type expects.
pub(super) fn fits(ty: &Type, value: &Json) -> bool {
    match (ty, value) {
        (_, Json::Broken) => true,
        (Type::Either(a, b), _) => fits(a, value) || fits(b, value),
        (_, Json::Array(_)) => takes(ty) == A_LIST,
        (_, Json::Object(_)) => takes(ty) == AN_OBJECT,
        _ => takes(ty) == A_SINGLE_VALUE,
    }
}

const A_LIST: &str = "a list [ … ]";
const AN_OBJECT: &str = "an object { … }";
const A_SINGLE_VALUE: &str = "a single value";

/// The expected JSON type, for messages.
fn takes(ty: &Type) -> &'static str {
    match ty {
        Type::List(_) | Type::Numbers(_) | Type::Pair(_) => A_LIST,
        Type::Map(_) | Type::Switches(_) | Type::Object(_) | Type::OneOf(_) => AN_OBJECT,
        Type::Either(first, _) => takes(first),
        _ => A_SINGLE_VALUE,
    }
}
