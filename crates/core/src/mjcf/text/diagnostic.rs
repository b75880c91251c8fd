//! What is wrong with a model, and where: diagnostics with a stable code, a place in the XML, the reason and
//! the next step. A [`Report`] collects them, so that an author with three mistakes sees three.
//!
//! A model may be written in several files. The passes know one text, in which the files follow each other: a
//! span is a range of bytes there, and only [`Report::finish`] tells which file it belongs to.

use std::fmt;
use std::ops::Range;
use std::path::PathBuf;
use std::rc::Rc;

pub(crate) use crate::model::nearest::closest;

/// More findings than this are not listed: the first mistakes explain the rest.
const MAX_DIAGNOSTICS: usize = 100;
/// Numbers that a model may ask for: 200 MB, which are copied once or twice on their way.
const MAX_NUMBERS: usize = 25_000_000;

/// How bad a finding is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Severity {
    /// The model does not load.
    Error,
    /// The model loads, and probably is not what its author meant.
    Warning,
}

/// One finding in an MJCF file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct MjcfDiagnostic {
    /// Stable code, one of [`code`].
    pub code: &'static str,
    /// Whether the model loads all the same.
    pub severity: Severity,
    /// The file, seen from the folder of the model; `None` for the model itself.
    pub file: Option<String>,
    /// Bytes of the file's text.
    pub span: Range<usize>,
    /// Line of the start of `span`, from 1.
    pub line: usize,
    /// Column of the start of `span`, from 1, in characters.
    pub column: usize,
    /// What is wrong.
    pub message: String,
    /// Why it matters.
    pub why: Option<String>,
    /// What to write instead.
    pub help: Option<String>,
}

impl MjcfDiagnostic {
    /// Adds the reason why it matters.
    pub(crate) fn why(&mut self, why: impl Into<String>) -> &mut Self {
        self.why = Some(why.into());
        self
    }

    /// Adds what to write instead.
    pub(crate) fn help(&mut self, help: impl Into<String>) -> &mut Self {
        self.help = Some(help.into());
        self
    }
}

impl fmt::Display for MjcfDiagnostic {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some(file) = &self.file {
            write!(f, "{file}:")?;
        }
        let severity = match self.severity {
            Severity::Error => "error",
            Severity::Warning => "warning",
        };
        write!(f, "{}:{}: {severity}[{}]: {}", self.line, self.column, self.code, self.message)?;
        if let Some(why) = &self.why {
            write!(f, "\n  why: {why}")?;
        }
        if let Some(help) = &self.help {
            write!(f, "\n  help: {help}")?;
        }
        Ok(())
    }
}

impl std::error::Error for MjcfDiagnostic {}

/// Why a model file could not be compiled.
#[derive(Debug)]
pub enum MjcfFileError {
    /// The file could not be read.
    Io {
        /// The file.
        path: PathBuf,
        /// What the operating system said.
        error: std::io::Error,
    },
    /// The file is larger than [`crate::mjcf::MAX_TEXT`].
    TooLarge {
        /// The file.
        path: PathBuf,
    },
    /// The file is not UTF-8 text.
    NotUtf8 {
        /// The file.
        path: PathBuf,
        /// The first byte that is not UTF-8.
        offset: usize,
    },
    /// The model has mistakes.
    Model {
        /// The file.
        path: PathBuf,
        /// What is wrong.
        diagnostics: Vec<MjcfDiagnostic>,
    },
}

impl fmt::Display for MjcfFileError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            MjcfFileError::Io { path, error } => write!(f, "cannot read {}: {error}", path.display()),
            MjcfFileError::TooLarge { path } => {
                write!(
                    f,
                    "{} is larger than {} MB, the limit for a model",
                    path.display(),
                    crate::mjcf::MAX_TEXT >> 20
                )
            }
            MjcfFileError::NotUtf8 { path, offset } => {
                write!(
                    f,
                    "{} is not UTF-8 text: byte {offset} does not belong to a character",
                    path.display()
                )
            }
            MjcfFileError::Model { path, diagnostics } => {
                for (i, d) in diagnostics.iter().enumerate() {
                    let separator = if i == 0 { "" } else { "\n" };
                    match (&d.file, path.parent()) {
                        (Some(_), Some(folder)) => {
                            write!(f, "{separator}{}", folder.join(d.to_string()).display())?
                        }
                        _ => write!(f, "{separator}{}:{d}", path.display())?,
                    }
                }
                Ok(())
            }
        }
    }
}

impl std::error::Error for MjcfFileError {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        match self {
            MjcfFileError::Io { error, .. } => Some(error),
            _ => None,
        }
    }
}

/// Stable codes of the findings.
pub mod code {
    macro_rules! codes {
        ($($name:ident = $code:literal, $doc:literal;)*) => {
            $(#[doc = $doc] pub const $name: &str = $code;)*
            /// All codes, each with what it means.
            pub const ALL: &[(&str, &str)] = &[$(($code, $doc)),*];
        };
    }
    codes! {
        XML = "mjcf-xml", "The text is not well-formed XML.";
        LIMIT = "mjcf-limit", "The model is larger or more deeply nested than the limits allow.";
        FILE = "mjcf-file", "A file that the model names cannot be read, or may not be.";
        OUTSIDE = "mjcf-file-outside", "A file that the model names lies outside of what may be opened.";
        TEXT = "mjcf-text", "There is text where only elements belong.";
        NO_EFFECT = "mjcf-no-effect", "What is written there has no effect.";
        UNKNOWN_ELEMENT = "mjcf-unknown-element", "MJCF has no such element.";
        MISPLACED_ELEMENT = "mjcf-misplaced-element", "The element does not belong here.";
        REPEATED_ELEMENT = "mjcf-repeated-element", "The element may stand only once.";
        UNKNOWN_ATTRIBUTE = "mjcf-unknown-attribute", "The element has no such attribute.";
        MISSING_ATTRIBUTE = "mjcf-missing-attribute", "The element needs an attribute that is missing.";
        CONFLICT = "mjcf-conflicting-attributes", "Two attributes say different things.";
        NOT_SUPPORTED = "mjcf-not-supported", "The element, attribute or value is MJCF, but labspec does not support it yet.";
        NUMBER = "mjcf-number", "The value is not a number, or not a finite one.";
        COUNT = "mjcf-count", "There are too many or too few numbers.";
        KEYWORD = "mjcf-keyword", "The value is none of the keywords.";
        VALUE = "mjcf-value", "The value is out of its range.";
        DUPLICATE_NAME = "mjcf-duplicate-name", "Two objects of one kind have the same name.";
        UNKNOWN_NAME = "mjcf-unknown-name", "The name belongs to no object.";
        UNKNOWN_CLASS = "mjcf-unknown-class", "There is no such default class.";
        COPY = "mjcf-copy", "A `replicate` or `attach` cannot copy what it should.";
        ORIENTATION = "mjcf-orientation", "The orientation is given twice, or has no direction.";
        JOINT = "mjcf-joint", "The joints of a body do not fit together.";
        MOCAP = "mjcf-mocap", "A mocap body must be a child of the world without joints.";
        MESH = "mjcf-mesh", "The data of a mesh do not make a body.";
        SKIN = "mjcf-skin", "The data of a skin do not make a surface that bodies carry.";
        HFIELD = "mjcf-hfield", "The data of a height field do not make a ground.";
        GEOM = "mjcf-geom", "The geom lacks a size, or may not be here.";
        INERTIA = "mjcf-inertia", "A moving body has no mass or an impossible inertia.";
        TENDON = "mjcf-tendon", "The path of a tendon is incomplete, or its numbers are out of range.";
        EQUALITY = "mjcf-equality", "The equality constraint does not say what it ties.";
        CONTACT = "mjcf-contact", "The contact pair does not say which geoms may touch.";
        ACTUATOR = "mjcf-actuator", "The parts of an actuator do not fit together, or its numbers are out of range.";
        SENSOR = "mjcf-sensor", "The sensor cannot measure that object.";
        KEYFRAME = "mjcf-keyframe", "The keyframe does not fit the model.";
    }
}

/// A text that a model is written in.
struct Source {
    /// `None` for the model itself.
    file: Option<String>,
    text: Rc<str>,
    /// Where it begins among all texts.
    base: usize,
}

/// Collects findings about the texts of one model.
pub(crate) struct Report {
    sources: Vec<Source>,
    /// Errors.
    list: Vec<MjcfDiagnostic>,
    warnings: Vec<MjcfDiagnostic>,
    /// Numbers that the model has room for, by now.
    numbers: usize,
    /// Something was left out because it is not supported: names that it would define are missing, and
    /// saying so again would only repeat the first message.
    pub(crate) incomplete: bool,
}

impl Report {
    pub(crate) fn new() -> Report {
        Report { sources: Vec::new(), list: Vec::new(), warnings: Vec::new(), numbers: 0, incomplete: false }
    }

    /// Takes a text; returns where its spans begin. The first is the model itself.
    pub(crate) fn source(&mut self, file: Option<&str>, text: Rc<str>) -> usize {
        // A byte between two texts: the end of one is not the start of the next.
        let base = self.bytes() + self.sources.len();
        self.sources.push(Source { file: file.map(str::to_string), text, base });
        base
    }

    /// Length of all texts together.
    pub(crate) fn bytes(&self) -> usize {
        self.sources.iter().map(|s| s.text.len()).sum()
    }

    /// Adds an error at a range of bytes.
    pub(crate) fn error(
        &mut self,
        code: &'static str,
        span: Range<usize>,
        message: impl Into<String>,
    ) -> &mut MjcfDiagnostic {
        add(&mut self.list, Severity::Error, code, span, message.into())
    }

    /// Adds a warning at a range of bytes: the model loads all the same.
    pub(crate) fn warning(
        &mut self,
        code: &'static str,
        span: Range<usize>,
        message: impl Into<String>,
    ) -> &mut MjcfDiagnostic {
        add(&mut self.warnings, Severity::Warning, code, span, message.into())
    }

    /// Counts numbers that the arrays of a model take, beyond those that stand in its text. `false` when all together are
    /// too many: that is reported at the element that asks for them.
    pub(crate) fn take(&mut self, numbers: usize, span: Range<usize>, what: &str) -> bool {
        self.numbers = self.numbers.saturating_add(numbers);
        if self.numbers <= MAX_NUMBERS {
            return true;
        }
        if !self.list.iter().any(|d| d.code == code::LIMIT) {
            let message =
                format!("{what} would take {numbers} numbers, a model may hold {MAX_NUMBERS} in all");
            self.error(code::LIMIT, span, message)
                .why("a short text could ask for more memory than a computer has")
                .help("ask for fewer here, or elsewhere in the model");
        }
        false
    }

    /// Whether nothing is wrong so far, warnings aside.
    pub(crate) fn is_clean(&self) -> bool {
        self.list.is_empty()
    }

    /// Whether more findings would not be listed: looking for them, and for suggestions, can stop.
    pub(crate) fn is_full(&self) -> bool {
        self.list.len() > MAX_DIAGNOSTICS
    }

    /// The findings in the order of the texts, each with its file, line and column. What copies of one element
    /// have in common is said once.
    pub(crate) fn finish(mut self) -> Vec<MjcfDiagnostic> {
        self.list.truncate(MAX_DIAGNOSTICS);
        self.warnings.truncate(MAX_DIAGNOSTICS);
        self.list.append(&mut self.warnings);
        self.list.sort_by_key(|d| (d.span.start, d.span.end));
        self.list.dedup_by(|a, b| (a.code, &a.span, &a.message) == (b.code, &b.span, &b.message));
        let (mut source, mut at, mut line, mut column) = (usize::MAX, 0, 1, 1);
        for d in &mut self.list {
            let i = self.sources.partition_point(|s| s.base <= d.span.start).saturating_sub(1);
            let Some(Source { file, text, base }) = self.sources.get(i) else { continue };
            if i != source {
                (source, at, line, column) = (i, 0, 1, 1);
            }
            d.file = file.clone();
            // A span that was computed on decoded text may end inside a character.
            let start = boundary(text, d.span.start - base);
            d.span = start..boundary(text, d.span.end.saturating_sub(*base)).max(start);
            for c in text.get(at..start).unwrap_or("").chars() {
                if c == '\n' {
                    line += 1;
                    column = 1;
                } else {
                    column += 1;
                }
            }
            at = start;
            (d.line, d.column) = (line, column);
        }
        self.list
    }
}

/// Adds a finding to a list; one beyond the limit stands for all that follow.
fn add<'l>(
    list: &'l mut Vec<MjcfDiagnostic>,
    severity: Severity,
    code: &'static str,
    span: Range<usize>,
    message: String,
) -> &'l mut MjcfDiagnostic {
    if list.len() > MAX_DIAGNOSTICS {
        list.pop();
    }
    let d = MjcfDiagnostic {
        code,
        severity,
        file: None,
        span,
        line: 0,
        column: 0,
        message,
        why: None,
        help: None,
    };
    let at = list.len();
    list.push(d);
    &mut list[at] // just pushed
}

/// The start of the character that holds a byte; the end of the text for a byte beyond it.
fn boundary(text: &str, byte: usize) -> usize {
    (0..=byte.min(text.len())).rev().find(|&i| text.is_char_boundary(i)).unwrap_or(0)
}

/// A name as it is shown in a message: quoted, and cut when an author wrote a very long one.
pub(crate) fn shown(name: &str) -> String {
    const LONGEST: usize = 60;
    if name.chars().count() <= LONGEST {
        return format!("`{name}`");
    }
    let cut: String = name.chars().take(LONGEST).collect();
    format!("`{cut}…`")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_and_columns_count_characters() {
        let mut r = Report::new();
        assert_eq!(r.source(None, "äö\nxyz".into()), 0);
        let base = r.source(Some("b.xml"), "\nx".into());
        r.error(code::XML, base + 1..base + 2, "x");
        r.error(code::XML, 7..8, "z");
        r.error(code::XML, 2..4, "ö");
        r.error(code::XML, 2..4, "ö");
        let places: Vec<_> = r.finish().into_iter().map(|d| (d.file, d.line, d.column, d.span)).collect();
        assert_eq!(places, [(None, 1, 2, 2..4), (None, 2, 3, 7..8), (Some("b.xml".into()), 2, 1, 1..2)]);
    }
}
