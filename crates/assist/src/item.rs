//! What an editor shows or applies, with byte ranges of the text.

use std::ops::Range;

/// The kind of a completion.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CompletionKind {
    /// A key of the format.
    Key,
    /// A value of the format or of an attribute.
    Value,
    /// An object with members.
    Object,
    /// A field.
    Field,
    /// A function or a method.
    Function,
    /// The name of an object of the model.
    Name,
    /// A variable, a measure or a run.
    Variable,
    /// A constant.
    Constant,
    /// An element of MJCF.
    Element,
    /// An attribute of MJCF.
    Attribute,
}

impl CompletionKind {
    /// The kind as a word.
    pub fn as_str(self) -> &'static str {
        match self {
            CompletionKind::Key => "key",
            CompletionKind::Value => "value",
            CompletionKind::Object => "object",
            CompletionKind::Field => "field",
            CompletionKind::Function => "function",
            CompletionKind::Name => "name",
            CompletionKind::Variable => "variable",
            CompletionKind::Constant => "constant",
            CompletionKind::Element => "element",
            CompletionKind::Attribute => "attribute",
        }
    }
}

/// A completion.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Completion {
    /// What a list shows.
    pub label: String,
    /// Its kind.
    pub kind: CompletionKind,
    /// The signature, or the type of a value.
    pub detail: String,
    /// Its documentation, as Markdown.
    pub documentation: String,
    /// The text that is compared with what is written, if it is not the label: with a quote that is already there.
    pub filter: Option<String>,
    /// What it replaces.
    pub edit: Edit,
}

/// A replacement of a byte range.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Edit {
    /// The bytes that are replaced.
    pub span: Range<usize>,
    /// Their replacement.
    pub text: String,
}

/// A hover text.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Hover {
    /// The bytes that it explains.
    pub span: Range<usize>,
    /// Markdown.
    pub text: String,
}

/// The applicability of a fix.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FixKind {
    /// It preserves the meaning, or is the only correction.
    Safe,
    /// A likely correction, which an author must confirm.
    Guess,
    /// It suppresses the finding; the author adds the reason.
    Suppression,
}

impl FixKind {
    /// The kind as a word.
    pub fn as_str(self) -> &'static str {
        match self {
            FixKind::Safe => "safe",
            FixKind::Guess => "guess",
            FixKind::Suppression => "suppression",
        }
    }
}

/// An edit that resolves a finding.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TextFix {
    /// What it does, for a menu.
    pub title: String,
    /// Its applicability.
    pub kind: FixKind,
    /// The edit.
    pub edit: Edit,
}
