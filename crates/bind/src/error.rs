//! The one error of the library as frontends hold it.

use labspec_finding::{Finding, Lines};
use std::fmt;
use std::sync::Arc;

/// Why something could not be done.
#[derive(Clone, Debug, PartialEq)]
pub enum Error {
    /// What was given has mistakes, or it broke: each is a finding with its place.
    Findings(Vec<Finding>),
    /// The call asks for what there is not. A sentence says what there is.
    Call(String),
}

impl Error {
    /// The findings; none when the call itself was wrong.
    pub fn findings(&self) -> &[Finding] {
        match self {
            Error::Findings(list) => list,
            Error::Call(_) => &[],
        }
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

/// A finding in a text of this name, with line and column.
pub(crate) fn located(mut finding: Finding, path: &Arc<str>, text: &str) -> Finding {
    finding.position = Some(Lines::new(text).position(text, finding.span.start));
    finding.path = path.clone();
    finding
}
