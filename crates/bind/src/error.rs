//! The error type of the library, as used by frontends.

use labspec_finding::{Finding, Lines};
use std::fmt;
use std::sync::Arc;

/// The reason for a failure.
#[derive(Clone, Debug, PartialEq)]
pub enum Error {
    /// The input has errors, or a program failed. Each finding has a location.
    Findings(Vec<Finding>),
    /// The arguments of the call are invalid. The sentence states which are valid.
    Call(String),
}

impl Error {
    /// Returns the findings; empty if the call itself was invalid.
    pub fn findings(&self) -> &[Finding] {
        match self {
            Error::Findings(list) => list,
            Error::Call(_) => &[],
        }
    }
}

impl Error {
    /// The findings of the model `xml`, with locations: in included files their own, otherwise lines of `model.xml`. `None`
    /// if the call failed for another reason.
    pub fn of_model(xml: &str, failure: &labspec_core::Error) -> Option<Error> {
        let findings = failure.diagnostics();
        if findings.is_empty() {
            return None;
        }
        let (main, lines) = (Arc::from("model.xml"), Lines::new(xml));
        let located = |f: &Finding| match f.path.is_empty() {
            false => f.clone(),
            true => {
                let position = Some(lines.position(xml, f.span.start));
                Finding { path: Arc::clone(&main), position, ..f.clone() }
            }
        };
        Some(Error::Findings(findings.iter().map(located).collect()))
    }
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Error::Findings(list) => {
                for (i, finding) in list.iter().enumerate() {
                    let end = if i + 1 < list.len() { "\n" } else { "" };
                    write!(f, "{finding}{end}")?;
                }
                Ok(())
            }
            Error::Call(sentence) => f.write_str(sentence),
        }
    }
}

impl std::error::Error for Error {}

/// Adds a path, and the line and column in `text`, to a finding.
pub(crate) fn located(mut finding: Finding, path: &Arc<str>, text: &str) -> Finding {
    finding.position = Some(Lines::new(text).position(text, finding.span.start));
    finding.path = path.clone();
    finding
}
