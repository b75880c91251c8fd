//! The tree: values and their places.

use crate::source::Text;
use std::ops::Range;

/// A value and its bytes in the author's file.
#[derive(Clone, Debug, PartialEq)]
pub struct Node {
    /// The value.
    pub json: Json,
    /// Bytes of the file, quotes and brackets included.
    pub span: Range<usize>,
}

/// A JSON value.
#[derive(Clone, Debug, PartialEq)]
pub enum Json {
    /// `null`
    Null,
    /// `true` or `false`
    Bool(bool),
    /// A finite number.
    Number(f64),
    /// A string, decoded.
    Text(Text),
    /// An array.
    Array(Vec<Node>),
    /// An object, in the author's order, duplicates included.
    Object(Vec<Member>),
    /// Something that cannot be read, which is reported; nothing more is to be said about it.
    Broken,
}

/// A key and its value.
#[derive(Clone, Debug, PartialEq)]
pub struct Member {
    /// The key, decoded.
    pub key: Text,
    /// The value.
    pub value: Node,
}

impl Node {
    /// The value of a key, if this is an object that has it. Of two equal keys the last one counts, as in `JSON.parse`.
    pub fn get(&self, key: &str) -> Option<&Node> {
        self.members().iter().rev().find(|m| m.key.value == key).map(|m| &m.value)
    }

    /// The members of an object; empty for anything else.
    pub fn members(&self) -> &[Member] {
        match &self.json {
            Json::Object(members) => members,
            _ => &[],
        }
    }

    /// Whether it could not be read, which is reported.
    pub fn is_broken(&self) -> bool {
        self.json == Json::Broken
    }

    /// What it is, in an author's words.
    pub fn describe(&self) -> &'static str {
        match &self.json {
            Json::Null => "null",
            Json::Bool(_) => "true or false",
            Json::Number(_) => "a number",
            Json::Text(_) => "a text",
            Json::Array(_) => "a list",
            Json::Object(_) => "an object",
            Json::Broken => "something that is not JSON",
        }
    }
}
