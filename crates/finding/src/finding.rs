//! One thing that is wrong or doubtful, and where.

use crate::place::{Place, Position};
use crate::rule::Rule;
use crate::severity::Severity;
use std::fmt;
use std::ops::Range;
use std::sync::Arc;

/// Who may apply a fix.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Applicability {
    /// A program: it changes only what the author certainly meant.
    Safe,
    /// A program that was asked to: it is a guess.
    Unsafe,
    /// Nobody but the author: it shows how the right thing looks.
    Display,
}

impl Applicability {
    /// `safe`, `unsafe` or `display`.
    pub fn as_str(self) -> &'static str {
        match self {
            Applicability::Safe => "safe",
            Applicability::Unsafe => "unsafe",
            Applicability::Display => "display",
        }
    }
}

/// A replacement that repairs a finding.
#[derive(Clone, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Fix {
    /// Bytes of the text that are replaced; empty to insert.
    pub span: Range<usize>,
    /// What to write there.
    pub text: String,
    /// Who may do it.
    pub applicability: Applicability,
}

impl Fix {
    /// A replacement that is certainly what was meant.
    pub fn safe(span: impl Into<Range<usize>>, text: impl Into<String>) -> Fix {
        Fix { span: span.into(), text: text.into(), applicability: Applicability::Safe }
    }
}

/// The claim that a finding is about: it ties the finding to its entry in the ledger, whatever bytes both point at.
#[derive(Clone, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct ClaimId {
    /// Who claims it: `quiz fall, question 2`.
    pub owner: String,
    /// Which of the owner's claims: `answer`, `quoted number 0.45 s`; empty when the finding concerns all of them.
    pub part: String,
    /// What was claimed, and what came out.
    pub result: String,
}

/// One thing that is wrong or doubtful, and where.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Finding {
    /// The rule's code, such as `unknown-key`.
    pub code: &'static str,
    /// How bad it is.
    pub severity: Severity,
    /// The file, as it is shown to people; empty while only the text is known.
    pub path: Arc<str>,
    /// Bytes of that text; empty for a point.
    pub span: Range<usize>,
    /// Line and column where it begins, from whoever had the text at hand.
    pub position: Option<Position>,
    /// What is wrong, without a full stop.
    pub message: String,
    /// Why it matters; `None` when the message says it all.
    pub why: Option<String>,
    /// What to write instead.
    pub help: Option<String>,
    /// A replacement that does it.
    pub fix: Option<Fix>,
    /// Other places.
    pub related: Vec<Place>,
    /// The claim that it is about; `None` for what is wrong with something else.
    pub claim: Option<Box<ClaimId>>,
}

impl Finding {
    /// A finding of a rule, with the rule's severity and reason. The path is filled in by whoever collects it.
    pub fn new(rule: &Rule, span: impl Into<Range<usize>>, message: impl Into<String>) -> Finding {
        Finding {
            why: Some(rule.why.to_string()).filter(|why| !why.is_empty()),
            ..Finding::plain(rule, span, message)
        }
    }

    /// A finding whose message says why, or that states its own reason: the rule's is left to its explanation.
    pub fn plain(rule: &Rule, span: impl Into<Range<usize>>, message: impl Into<String>) -> Finding {
        Finding {
            code: rule.code,
            severity: rule.severity,
            path: Arc::from(""),
            span: span.into(),
            position: None,
            message: message.into(),
            why: None,
            help: None,
            fix: None,
            related: Vec::new(),
            claim: None,
        }
    }

    /// An error of a rule, in words that say why.
    pub fn error(rule: &Rule, span: impl Into<Range<usize>>, message: impl Into<String>) -> Finding {
        Finding::plain(rule, span, message).severity(Severity::Error)
    }

    /// A warning of a rule, in words that say why.
    pub fn warning(rule: &Rule, span: impl Into<Range<usize>>, message: impl Into<String>) -> Finding {
        Finding::plain(rule, span, message).severity(Severity::Warning)
    }

    /// Another reason than the rule's general one.
    pub fn why(mut self, why: impl Into<String>) -> Finding {
        self.why = Some(why.into());
        self
    }

    /// What to do.
    pub fn help(mut self, help: impl Into<String>) -> Finding {
        self.help = Some(help.into());
        self
    }

    /// A replacement that is certainly what was meant.
    pub fn fix(mut self, span: impl Into<Range<usize>>, text: impl Into<String>) -> Finding {
        self.fix = Some(Fix::safe(span, text));
        self
    }

    /// A replacement that is probably what was meant.
    pub fn guess(self, span: impl Into<Range<usize>>, text: impl Into<String>) -> Finding {
        let mut found = self.fix(span, text);
        if let Some(fix) = &mut found.fix {
            fix.applicability = Applicability::Unsafe;
        }
        found
    }

    /// Another place of the same text.
    pub fn related(mut self, span: impl Into<Range<usize>>, label: impl Into<String>) -> Finding {
        self.related.push(Place { path: Arc::from(""), span: span.into(), label: label.into() });
        self
    }

    /// Another severity than the rule's.
    pub fn severity(mut self, severity: Severity) -> Finding {
        self.severity = severity;
        self
    }

    /// Whether what it is about is refused because of it.
    pub fn is_error(&self) -> bool {
        self.severity == Severity::Error
    }
}

/// As a compiler says it: place, severity, code and message, then the reason and the next step on lines of their own.
impl fmt::Display for Finding {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if !self.path.is_empty() {
            write!(f, "{}:", self.path)?;
        }
        if let Some(at) = self.position {
            write!(f, "{}:{}: ", at.line, at.column)?;
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

/// Puts findings into their order (file, place, code) and drops those that say the same thing twice.
pub fn sort(findings: &mut Vec<Finding>) {
    findings.sort_by(|a, b| {
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
        layer: Layer::Structure,
        summary: "a key that nothing reads",
        why: "what it says has no effect",
        bad: Example::Lab("{\"mdoel\": 1}"),
        good: Example::Lab("{\"model\": 1}"),
    };

    #[test]
    fn order_is_by_place_and_doubles_go() {
        let one = |at: usize| Finding::new(&RULE, at..at + 1, "x");
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
