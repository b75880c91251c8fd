//! Examples of rules in a build without the feature `docs`, which contains none of their texts.

use std::ops::Range;

/// An example of a rule, without its text.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Example;

/// Constructors with the names of the variants that exist with the feature `docs`.
#[allow(non_snake_case, missing_docs, reason = "they stand for the variants of the enumeration")]
impl Example {
    pub const fn Lesson(_: &'static str) -> Example {
        Example
    }
    pub const fn Question(_: &'static str) -> Example {
        Example
    }
    pub const fn Lab(_: &'static str) -> Example {
        Example
    }
    pub const fn Quiz(_: &'static str) -> Example {
        Example
    }
    pub const fn Json(_: &'static str) -> Example {
        Example
    }
    pub const fn Repeated(_: &'static str, _: usize) -> Example {
        Example
    }
    pub const fn Expression(_: &'static str) -> Example {
        Example
    }
    pub const fn Statements(_: &'static str) -> Example {
        Example
    }
    pub const fn Long(_: &'static str, _: &'static str, _: usize, _: &'static str) -> Example {
        Example
    }
    pub const fn Model(_: &'static str) -> Example {
        Example
    }
    pub const fn LongModel(_: &'static str, _: &'static str, _: usize, _: &'static str) -> Example {
        Example
    }
    pub const fn Files(_: &'static [(&'static str, &'static [u8])]) -> Example {
        Example
    }
}

impl Example {
    /// Empty.
    pub fn language(&self) -> &'static str {
        ""
    }

    /// Empty.
    pub fn name(&self) -> &'static str {
        ""
    }

    /// Empty.
    pub fn text(&self) -> String {
        String::new()
    }

    /// Empty.
    pub fn bytes(&self) -> Vec<u8> {
        Vec::new()
    }

    /// None.
    pub fn marked(&self) -> Option<Range<usize>> {
        None
    }

    /// Empty.
    pub fn render(&self) -> String {
        String::new()
    }
}
