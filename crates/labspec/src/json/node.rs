//! The tree: values and their spans.

use crate::source::Text;
use std::ops::Range;

/// A value and its bytes in the author's file.
#[derive(Clone, Debug, PartialEq)]
pub struct Node {
    /// The value.
    pub json: Json,
    /// Bytes of the file, including quotes and brackets.
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
    /// An object, in the author's order, including duplicates.
    Object(Vec<Member>),
    /// A value that cannot be read. The error is reported, and no other finding may refer to it.
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
    /// The value of a key, if this is an object that has it. Of two equal keys, the last one is used, as in `JSON.parse`.
    pub fn get(&self, key: &str) -> Option<&Node> {
        self.members().iter().rev().find(|m| m.key.value == key).map(|m| &m.value)
    }

    /// The members of an object; empty for other values.
    pub fn members(&self) -> &[Member] {
        match &self.json {
            Json::Object(members) => members,
            _ => &[],
        }
    }

    /// Whether it could not be read; the error is reported.
    pub fn is_broken(&self) -> bool {
        self.json == Json::Broken
    }

    /// Its type, in an author's words.
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
