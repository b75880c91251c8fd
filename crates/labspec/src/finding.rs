//! What a check has to say: a code, a place, and words for the person who wrote the lesson.

use crate::lint::Rule;
use crate::source::SourceFile;
use std::ops::Range;
use std::sync::Arc;

/// How bad it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Severity {
    /// The lesson is broken or says something false.
    Error,
    /// Probably not what the author meant.
    Warning,
    /// Worth knowing.
    Note,
}

impl Severity {
    /// `error`, `warning` or `note`.
    pub fn as_str(self) -> &'static str {
        match self {
            Severity::Error => "error",
            Severity::Warning => "warning",
            Severity::Note => "note",
        }
    }
}

/// A replacement that repairs a finding.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Fix {
    /// Bytes of the file that are replaced.
    pub span: Range<usize>,
    /// What to write there.
    pub text: String,
}

/// Another place that helps to understand a finding.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Place {
    /// The file.
    pub path: Arc<str>,
    /// Bytes of that file.
    pub span: Range<usize>,
    /// What is there.
    pub label: String,
}

/// One thing that is wrong or doubtful, and where.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Finding {
    /// The rule's code, such as `unknown-key`.
    pub code: &'static str,
    /// How bad it is.
    pub severity: Severity,
    /// The file, as it is shown to people.
    pub path: Arc<str>,
    /// Bytes of that file; empty for a point.
    pub span: Range<usize>,
    /// What is wrong.
    pub message: String,
    /// Why it matters; `None` when the message says it all.
    pub why: Option<String>,
    /// What to write instead.
    pub help: Option<String>,
    /// A replacement that a program may apply.
    pub fix: Option<Fix>,
    /// Other places.
    pub related: Vec<Place>,
}

impl Finding {
    /// A finding of a rule, with the rule's severity and reason. The path is filled in by whoever collects it.
    pub fn new(rule: &Rule, span: Range<usize>, message: impl Into<String>) -> Finding {
        Finding {
            code: rule.code,
            severity: rule.severity,
            path: Arc::from(""),
            span,
            message: message.into(),
            why: Some(rule.why.to_string()).filter(|why| !why.is_empty()),
            help: None,
            fix: None,
            related: Vec::new(),
        }
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

    /// A replacement.
    pub fn fix(mut self, span: Range<usize>, text: impl Into<String>) -> Finding {
        self.fix = Some(Fix { span, text: text.into() });
        self
    }

    /// Another place of the same file.
    pub fn related(mut self, span: Range<usize>, label: impl Into<String>) -> Finding {
        self.related.push(Place { path: Arc::from(""), span, label: label.into() });
        self
    }

    /// Another severity than the rule's.
    pub fn severity(mut self, severity: Severity) -> Finding {
        self.severity = severity;
        self
    }

    /// States the file of the finding and of those places that do not name another one, and widens spans that
    /// begin or end inside of a character.
    pub fn at(mut self, file: &SourceFile) -> Finding {
        for place in self.related.iter_mut().filter(|place| place.path.is_empty()) {
            place.path = file.path().clone();
            place.span = file.snap(&place.span);
        }
        self.span = file.snap(&self.span);
        if let Some(fix) = &mut self.fix {
            fix.span = file.snap(&fix.span);
        }
        self.path = file.path().clone();
        self
    }
}

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
    use crate::lint::rules::keys::UNKNOWN_KEY;

    #[test]
    fn order_is_by_place_and_doubles_go() {
        let one = |at: usize| Finding::new(&UNKNOWN_KEY, at..at + 1, "x");
        let mut all = vec![one(5), one(1), one(5)];
        sort(&mut all);
        assert_eq!(all, vec![one(1), one(5)]);
    }
}
