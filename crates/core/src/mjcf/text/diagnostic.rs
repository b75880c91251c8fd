//! Diagnostics of a model: a stable code, a position in the XML, the reason and the next step. A [`Diagnostics`] collects them, so
//! that an author with three mistakes sees three.
//!
//! A model may consist of several files. The passes use one address space for all texts, which follow each other in it. A span is
//! a range of bytes in this space; [`Diagnostics::finish`] converts it to a file and a position.

use crate::mjcf::rules::{self, Rule};
use labspec_finding::order::sort_by_key;
use labspec_finding::{Finding, Lines, Position, Severity, floor};
use std::fmt;
use std::ops::Range;
use std::path::PathBuf;
use std::rc::Rc;

pub(crate) use labspec_finding::nearest;

/// Limit for the number of listed findings. The first mistakes usually explain the rest.
const MAX_DIAGNOSTICS: usize = 100;
/// Limit for the numbers that a model may request: 200 MB, which are copied once or twice during compilation.
const MAX_NUMBERS: usize = 25_000_000;

/// A finding that was just added. The reason and the next step can be added to it.
pub(crate) struct ReportedFinding<'r>(&'r mut Finding);

impl ReportedFinding<'_> {
    /// Adds the reason why the finding matters.
    pub(crate) fn why(self, why: impl Into<String>) -> Self {
        self.0.why = Some(why.into());
        self
    }

    /// Adds a suggestion what to write instead.
    pub(crate) fn help(self, help: impl Into<String>) -> Self {
        self.0.help = Some(help.into());
        self
    }
}

/// The reason why a model file could not be compiled.
#[derive(Debug)]
pub enum MjcfFileError {
    /// The file could not be read.
    Io {
        /// The file.
        path: PathBuf,
        /// The message of the operating system.
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
    /// The model has errors.
    Model {
        /// The file.
        path: PathBuf,
        /// The findings.
        diagnostics: Vec<Finding>,
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
                    match (d.path.is_empty(), path.parent()) {
                        (false, Some(folder)) => {
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

/// A text of a model: the main model or another file.
struct SourceText {
    /// `None` for the model itself.
    file: Option<String>,
    text: Rc<str>,
    /// The first byte of the text in the address space of all texts.
    base: usize,
}

/// Collects the findings in the texts of one model.
pub(crate) struct Diagnostics {
    sources: Vec<SourceText>,
    /// Errors.
    list: Vec<Finding>,
    warnings: Vec<Finding>,
    /// The numbers that the arrays of the model have requested so far.
    numbers: usize,
    /// Whether something was left out because it is not supported. Names that it would define are then missing, and a second
    /// message about them would only repeat the first.
    pub(crate) incomplete: bool,
}

impl Diagnostics {
    pub(crate) fn new() -> Diagnostics {
        Diagnostics {
            sources: Vec::new(),
            list: Vec::new(),
            warnings: Vec::new(),
            numbers: 0,
            incomplete: false,
        }
    }

    /// Adds a text and returns the first byte of its spans. The first text is the model itself.
    pub(crate) fn source(&mut self, file: Option<&str>, text: Rc<str>) -> usize {
        // One byte separates two texts, so that the end of one differs from the start of the next.
        let base = self.bytes() + self.sources.len();
        self.sources.push(SourceText { file: file.map(str::to_string), text, base });
        base
    }

    /// The length of all texts together.
    pub(crate) fn bytes(&self) -> usize {
        self.sources.iter().map(|s| s.text.len()).sum()
    }

    /// Adds an error at a range of bytes.
    pub(crate) fn error(
        &mut self,
        rule: &'static Rule,
        span: Range<usize>,
        message: impl Into<String>,
    ) -> ReportedFinding<'_> {
        add(&mut self.list, Finding::error(rule, span, message))
    }

    /// The error of a rule with the same message, if it is reported.
    pub(crate) fn same(&mut self, rule: &'static Rule, message: &str) -> Option<&mut Finding> {
        self.list.iter_mut().find(|f| f.code == rule.code && f.message == message)
    }

    /// Adds a warning at a range of bytes. The model still loads.
    pub(crate) fn warning(
        &mut self,
        rule: &'static Rule,
        span: Range<usize>,
        message: impl Into<String>,
    ) -> ReportedFinding<'_> {
        add(&mut self.warnings, Finding::warning(rule, span, message))
    }

    /// Adds a note at a range of bytes.
    pub(crate) fn note(
        &mut self,
        rule: &'static Rule,
        span: Range<usize>,
        message: impl Into<String>,
    ) -> ReportedFinding<'_> {
        add(&mut self.warnings, Finding::plain(rule, span, message).severity(Severity::Note))
    }

    /// Counts numbers that the arrays of a model need, in addition to those in its text. Returns `false` if the total exceeds the
    /// limit, and reports this at the element that requested the last numbers.
    pub(crate) fn take(&mut self, numbers: usize, span: Range<usize>, what: &str) -> bool {
        self.numbers = self.numbers.saturating_add(numbers);
        if self.numbers <= MAX_NUMBERS {
            return true;
        }
        if !self.list.iter().any(|d| d.code == rules::LIMIT) {
            let message =
                format!("{what} would take {numbers} numbers, but a model can have at most {MAX_NUMBERS}");
            self.error(rules::LIMIT, span, message)
                .why("a short text could otherwise request more memory than a computer has")
                .help("use fewer here, or elsewhere in the model");
        }
        false
    }

    /// Whether there are no errors so far. Warnings do not count.
    pub(crate) fn is_clean(&self) -> bool {
        self.list.is_empty()
    }

    /// Whether the list of errors is full. The search for further findings and for suggestions can then stop.
    pub(crate) fn is_full(&self) -> bool {
        self.list.len() > MAX_DIAGNOSTICS
    }

    /// The findings in the order of the texts, each with its file, line and column. A finding that copies of one element share is
    /// reported once.
    pub(crate) fn finish(mut self) -> Vec<Finding> {
        self.list.truncate(MAX_DIAGNOSTICS);
        self.warnings.truncate(MAX_DIAGNOSTICS);
        self.list.append(&mut self.warnings);
        sort_by_key(&mut self.list, |d| (d.span.start, d.span.end));
        self.list.dedup_by(|a, b| (a.code, &a.span, &a.message) == (b.code, &b.span, &b.message));
        let mut lines: Vec<Option<Lines>> = vec![None; self.sources.len()];
        // The position of the last finding. With it, the characters of a long line are counted once, however many findings it
        // has.
        let mut last = (usize::MAX, 0, Position { line: 0, column: 1 });
        for d in &mut self.list {
            let i = self.sources.partition_point(|s| s.base <= d.span.start).saturating_sub(1);
            let (Some(SourceText { file, text, base }), Some(lines)) =
                (self.sources.get(i), lines.get_mut(i))
            else {
                continue;
            };
            d.path = file.as_deref().unwrap_or("").into();
            // A span that was computed on decoded text may end inside a UTF-8 character.
            let start = floor(text, d.span.start - base);
            d.span = start..floor(text, d.span.end.saturating_sub(*base)).max(start);
            let lines = lines.get_or_insert_with(|| Lines::new(text));
            let line = lines.line(start);
            let (from, column) = match last {
                (source, offset, place) if source == i && place.line == line => (offset, place.column),
                _ => (lines.start(line).unwrap_or(0), 1),
            };
            let column = column + text.get(from..start).unwrap_or("").chars().count();
            last = (i, start, Position { line, column });
            d.position = Some(last.2);
        }
        self.list
    }
}

/// Adds a finding to a list. At the limit, it replaces the last finding of the list.
fn add(list: &mut Vec<Finding>, finding: Finding) -> ReportedFinding<'_> {
    if list.len() > MAX_DIAGNOSTICS {
        list.pop();
    }
    let index = list.len();
    list.push(finding);
    ReportedFinding(&mut list[index]) // in bounds: the element was just pushed
}

/// A name for a message: quoted, and truncated if it is very long.
pub(crate) fn shorten_name(name: &str) -> String {
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
        let mut r = Diagnostics::new();
        assert_eq!(r.source(None, "äö\nxyz".into()), 0);
        let base = r.source(Some("b.xml"), "\nx".into());
        r.error(rules::XML, base + 1..base + 2, "x");
        r.error(rules::XML, 7..8, "z");
        r.error(rules::XML, 2..4, "ö");
        r.error(rules::XML, 2..4, "ö");
        let places: Vec<_> = r
            .finish()
            .into_iter()
            .map(|d| (d.path, d.position.map(|position| (position.line, position.column)), d.span))
            .collect();
        assert_eq!(
            places,
            [
                ("".into(), Some((1, 2)), 2..4),
                ("".into(), Some((2, 3)), 7..8),
                ("b.xml".into(), Some((2, 1)), 1..2)
            ]
        );
    }
}
