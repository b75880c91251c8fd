//! A finding: one thing that is wrong or doubtful, and its location.

use crate::order::sort_by;
use crate::place::{Place, Position};
use crate::rule::Rule;
use crate::severity::Severity;
use std::fmt;
use std::ops::Range;
use std::sync::Arc;

/// How certain a fix is, and therefore who may apply it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Applicability {
    /// A program may apply it: the author certainly intended the result.
    Safe,
    /// A program may apply it on request: it is a guess.
    Unsafe,
    /// Only the author may apply it: it shows the correct form.
    Display,
}

impl Applicability {
    /// Every applicability, the most certain first.
    pub const ALL: [Applicability; 3] = [Applicability::Safe, Applicability::Unsafe, Applicability::Display];

    /// `safe`, `unsafe` or `display`.
    pub fn as_str(self) -> &'static str {
        match self {
            Applicability::Safe => "safe",
            Applicability::Unsafe => "unsafe",
            Applicability::Display => "display",
        }
    }
}

/// A replacement that corrects a finding.
#[derive(Clone, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Fix {
    /// The byte range to replace; empty for an insertion.
    pub span: Range<usize>,
    /// The replacement.
    pub text: String,
    /// Who may apply it.
    pub applicability: Applicability,
}

impl Fix {
    /// A replacement that is certainly intended.
    pub fn safe(span: impl Into<Range<usize>>, text: impl Into<String>) -> Fix {
        Fix { span: span.into(), text: text.into(), applicability: Applicability::Safe }
    }
}

/// The claim to which a finding belongs. It connects the finding with its entry in the ledger, independent of their spans.
#[derive(Clone, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct ClaimId {
    /// The owner of the claim: `quiz fall, question 2`.
    pub owner: String,
    /// The claim of the owner: `answer`, `quoted number 0.45 s`; empty if the finding concerns all of them.
    pub part: String,
    /// The claimed and the computed value.
    pub result: String,
}

/// One thing that is wrong or doubtful, and its location.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Finding {
    /// The rule's code, such as `unknown-key`.
    pub code: &'static str,
    /// Its severity.
    pub severity: Severity,
    /// The file, as displayed to users; empty while only the text is known.
    pub path: Arc<str>,
    /// The byte range in that text; empty for a point.
    pub span: Range<usize>,
    /// The line and column of its start, filled in where the text is available.
    pub position: Option<Position>,
    /// What is wrong, without a full stop.
    pub message: String,
    /// Why it matters; `None` if the message is sufficient.
    pub why: Option<String>,
    /// What to write instead.
    pub help: Option<String>,
    /// A replacement that does this.
    pub fix: Option<Fix>,
    /// Other locations.
    pub related: Vec<Place>,
    /// The claim to which it belongs; `None` if it does not concern a claim.
    pub claim: Option<Box<ClaimId>>,
    /// The link that it concerns, as written; the settings of a course can resolve it.
    pub link: Option<Box<str>>,
}

impl Finding {
    /// A finding of a rule, with the severity and the reason of the rule. The code that collects findings fills in the path.
    // Inlined, so that a program contains the code of a rule without the texts and examples of its page.
    #[inline(always)]
    pub fn new(rule: &Rule, span: impl Into<Range<usize>>, message: impl Into<String>) -> Finding {
        bare(rule.code, rule.severity, rule.why, span.into(), message.into())
    }

    /// A finding whose message contains the reason, or that gets its own reason. The reason of the rule is not repeated.
    #[inline(always)]
    pub fn plain(rule: &Rule, span: impl Into<Range<usize>>, message: impl Into<String>) -> Finding {
        bare(rule.code, rule.severity, "", span.into(), message.into())
    }

    /// An error of a rule, whose message contains the reason.
    #[inline(always)]
    pub fn error(rule: &Rule, span: impl Into<Range<usize>>, message: impl Into<String>) -> Finding {
        bare(rule.code, Severity::Error, "", span.into(), message.into())
    }

    /// A warning of a rule, whose message contains the reason.
    #[inline(always)]
    pub fn warning(rule: &Rule, span: impl Into<Range<usize>>, message: impl Into<String>) -> Finding {
        bare(rule.code, Severity::Warning, "", span.into(), message.into())
    }

    /// Sets a reason that replaces that of the rule.
    pub fn why(mut self, why: impl Into<String>) -> Finding {
        self.why = Some(why.into());
        self
    }

    /// Sets the advice.
    pub fn help(mut self, help: impl Into<String>) -> Finding {
        self.help = Some(help.into());
        self
    }

    /// Sets a replacement that is certainly intended.
    pub fn fix(mut self, span: impl Into<Range<usize>>, text: impl Into<String>) -> Finding {
        self.fix = Some(Fix::safe(span, text));
        self
    }

    /// Sets a replacement that is probably intended.
    pub fn guess(self, span: impl Into<Range<usize>>, text: impl Into<String>) -> Finding {
        let mut found = self.fix(span, text);
        if let Some(fix) = &mut found.fix {
            fix.applicability = Applicability::Unsafe;
        }
        found
    }

    /// Adds another location in the same text.
    pub fn related(mut self, span: impl Into<Range<usize>>, label: impl Into<String>) -> Finding {
        self.related.push(Place { path: Arc::from(""), span: span.into(), label: label.into() });
        self
    }

    /// Sets another severity than that of the rule, one of its [exceptions](Rule::exceptions).
    pub fn severity(mut self, severity: Severity) -> Finding {
        self.severity = severity;
        self
    }

    /// Whether the finding is an error, so that the program, model or claim with it is refused.
    pub fn is_error(&self) -> bool {
        self.severity == Severity::Error
    }
}

fn bare(
    code: &'static str,
    severity: Severity,
    why: &'static str,
    span: Range<usize>,
    message: String,
) -> Finding {
    Finding {
        code,
        severity,
        path: Arc::from(""),
        span,
        position: None,
        message,
        why: Some(why.to_string()).filter(|why| !why.is_empty()),
        help: None,
        fix: None,
        related: Vec::new(),
        claim: None,
        link: None,
    }
}

/// The format of compilers: location, severity, code and message, then the reason and the help on separate lines.
impl fmt::Display for Finding {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if !self.path.is_empty() {
            write!(f, "{}:", self.path)?;
        }
        if let Some(position) = self.position {
            write!(f, "{}:{}: ", position.line, position.column)?;
        } else if !self.path.is_empty() {
            f.write_str(" ")?;
        }
        write!(f, "{}[{}]: {}", self.severity, self.code, self.message)?;
        if let Some(why) = &self.why {
            write!(f, "\n  why: {why}")?;
        }
        if let Some(help) = &self.help {
            write!(f, "\n  help: {help}")?;
        }
        Ok(())
    }
}

impl std::error::Error for Finding {}

/// Sorts findings by file, location and code, and removes duplicates.
pub fn sort(findings: &mut Vec<Finding>) {
    sort_by(findings, |a, b| {
        (&a.path, a.span.start, a.span.end, a.severity, a.code, &a.message).cmp(&(
            &b.path,
            b.span.start,
            b.span.end,
            b.severity,
            b.code,
            &b.message,
        ))
    });
    findings
        .dedup_by(|a, b| a.code == b.code && a.path == b.path && a.span == b.span && a.message == b.message);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Example, Layer};

    const RULE: Rule = Rule {
        code: "unknown-key",
        severity: Severity::Error,
        exceptions: &[],
        layer: Layer::Structure,
        summary: "a key that nothing reads",
        why: "what it says has no effect",
        bad: Example::Lab("{\"mdoel\": 1}"),
        good: Example::Lab("{\"model\": 1}"),
    };

    #[test]
    fn findings_are_sorted_by_place_without_duplicates() {
        let one = |offset: usize| Finding::new(&RULE, offset..offset + 1, "x");
        let mut all = vec![one(5), one(1), one(5)];
        sort(&mut all);
        assert_eq!(all, vec![one(1), one(5)]);
    }

    #[test]
    fn it_prints_as_a_compiler_would() {
        let mut found = Finding::new(&RULE, 1..2, "there is no key `mdoel`").help("did you mean `model`?");
        let rest = "error[unknown-key]: there is no key `mdoel`\n  why: what it says has no effect\n  help: did you mean `model`?";
        assert_eq!(found.to_string(), rest);
        found.position = Some(Position { line: 3, column: 7 });
        assert_eq!(found.to_string(), format!("3:7: {rest}"));
        found.path = Arc::from("a.md");
        assert_eq!(found.to_string(), format!("a.md:3:7: {rest}"));
    }
}
