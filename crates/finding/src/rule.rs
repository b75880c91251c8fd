//! Rules, each declared once with its reason and examples.

use crate::example::Example;
use crate::severity::Severity;

/// The information that a rule needs. Each layer includes the information of the layers before it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Layer {
    /// The bytes and lines of a file.
    Source,
    /// JSON values, without their interpretation.
    Json,
    /// The objects of a lesson: labs, quizzes, claims.
    Structure,
    /// The model of a lab.
    Model,
    /// The expressions and statements, bound to the model.
    Program,
    /// A run of the lab.
    Run,
    /// What a lesson claims about its runs.
    Claim,
}

impl Layer {
    /// All layers, in order.
    pub const ALL: [Layer; 7] = [
        Layer::Source,
        Layer::Json,
        Layer::Structure,
        Layer::Model,
        Layer::Program,
        Layer::Run,
        Layer::Claim,
    ];

    /// `source`, `json`, …
    pub fn as_str(self) -> &'static str {
        match self {
            Layer::Source => "source",
            Layer::Json => "json",
            Layer::Structure => "structure",
            Layer::Model => "model",
            Layer::Program => "program",
            Layer::Run => "run",
            Layer::Claim => "claim",
        }
    }
}

/// A kind of mistake: its name, why it matters, and a wrong and a right example.
///
/// Both examples are executed: the wrong one must violate the rule, the right one must violate no rule.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Rule {
    /// The stable name, in words: `unknown-key`.
    pub code: &'static str,
    /// The severity of its findings.
    pub severity: Severity,
    /// Other severities of its findings, each with the circumstances in a clause.
    pub exceptions: &'static [(Severity, &'static str)],
    /// The information that it needs.
    pub layer: Layer,
    /// What is wrong, in one line without a full stop.
    pub summary: &'static str,
    /// Why it matters to students; may be empty if the summary is sufficient.
    pub why: &'static str,
    /// An example that violates the rule.
    pub bad: Example,
    /// The same example, corrected.
    pub good: Example,
}

/// The code of a finding identifies its rule.
impl PartialEq<Rule> for str {
    fn eq(&self, rule: &Rule) -> bool {
        self == rule.code
    }
}

impl Rule {
    /// Whether a finding of this rule may have this severity.
    pub fn may_be(&self, severity: Severity) -> bool {
        self.severity == severity || self.exceptions.iter().any(|(other, _)| *other == severity)
    }

    /// Returns the long explanation as Markdown: the mistake, the reason, a wrong and a right example.
    pub fn explain(&self) -> String {
        let mut text =
            format!("# {} ({})\n\n{}\n", self.code, self.severity.as_str(), sentence(self.summary));
        if !self.why.is_empty() {
            text.push_str(&format!("\n{}\n", sentence(self.why)));
        }
        for (severity, circumstances) in self.exceptions {
            let article = if *severity == Severity::Error { "an" } else { "a" };
            text.push_str(&format!("\nIt is {article} {} {}.\n", severity.as_str(), circumstances));
        }
        for (title, example) in [("Wrong", &self.bad), ("Right", &self.good)] {
            text.push_str(&format!(
                "\n## {title}\n\n````{}\n{}\n````\n",
                example.language(),
                example.render().trim_end()
            ));
        }
        text
    }
}

/// The text with a capital letter and a full stop. Code at the beginning keeps its case.
fn sentence(text: &str) -> String {
    let mut chars = text.chars();
    let first = chars.next().map(|c| c.to_uppercase().to_string()).unwrap_or_default();
    let stop = if text.ends_with(['.', '?', '!']) { "" } else { "." };
    format!("{first}{}{stop}", chars.as_str())
}
