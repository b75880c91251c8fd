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

/// The kind of an outline item.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum OutlineKind {
    /// A heading of the text.
    Heading,
    /// A lab.
    Lab,
    /// A slider, a select or a button.
    Control,
    /// A curve of a plot.
    Trace,
    /// A displayed value.
    Readout,
    /// A claim in a comment.
    Claim,
    /// A run of a claim.
    Run,
    /// A measure or a search of a claim.
    Measure,
    /// A quiz.
    Quiz,
    /// A question.
    Question,
}

impl OutlineKind {
    /// The kind as a word.
    pub fn as_str(self) -> &'static str {
        match self {
            OutlineKind::Heading => "heading",
            OutlineKind::Lab => "lab",
            OutlineKind::Control => "control",
            OutlineKind::Trace => "trace",
            OutlineKind::Readout => "readout",
            OutlineKind::Claim => "claim",
            OutlineKind::Run => "run",
            OutlineKind::Measure => "measure",
            OutlineKind::Quiz => "quiz",
            OutlineKind::Question => "question",
        }
    }
}

/// A part of a lesson, with the parts inside of it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct OutlineItem {
    /// Its name, in one line; not empty.
    pub name: String,
    /// Its model, its id, or the word of its kind; may be empty.
    pub detail: String,
    /// Its kind.
    pub kind: OutlineKind,
    /// Its bytes.
    pub span: Range<usize>,
    /// The bytes of its name, inside of its span.
    pub selection: Range<usize>,
    /// Its parts, inside of its span.
    pub children: Vec<OutlineItem>,
}

/// The kind of a fold.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FoldKind {
    /// The section of a heading.
    Section,
    /// A fence, or an HTML element.
    Block,
    /// An object or a list.
    Brackets,
    /// A comment.
    Comment,
}

/// A part of a text that can be folded.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Fold {
    /// Its bytes.
    pub span: Range<usize>,
    /// Its kind.
    pub kind: FoldKind,
}
