//! Rules: declared once, with their reasons and examples.

use crate::example::Example;
use crate::severity::Severity;

/// What a rule needs in order to look: a layer knows what the layers before it know, and more.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Layer {
    /// Bytes and lines of a file.
    Source,
    /// JSON, before anybody knows what it is about.
    Json,
    /// The objects of a lesson: labs, quizzes, claims.
    Structure,
    /// The model that a lab names.
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

/// What can be wrong: what it is called, why it matters, and how the wrong and the right thing look.
///
/// Both examples are executed: the wrong one breaks the rule, the right one breaks none.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Rule {
    /// Stable name, in words: `unknown-key`.
    pub code: &'static str,
    /// How bad it is, as a rule.
    pub severity: Severity,
    /// What it needs in order to look.
    pub layer: Layer,
    /// What is wrong, in one line without a full stop.
    pub summary: &'static str,
    /// Why it matters to students; may be empty when the summary says it.
    pub why: &'static str,
    /// Something that breaks the rule.
    pub bad: Example,
    /// The same, done right.
    pub good: Example,
}

/// A finding's code names its rule.
impl PartialEq<Rule> for str {
    fn eq(&self, rule: &Rule) -> bool {
        self == rule.code
    }
}

impl Rule {
    /// The long explanation, as Markdown: what, why, wrong, right.
    pub fn explain(&self) -> String {
        let mut text =
            format!("# {} ({})\n\n{}\n", self.code, self.severity.as_str(), sentence(self.summary));
        if !self.why.is_empty() {
            text.push_str(&format!("\n{}\n", sentence(self.why)));
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

/// With a capital and a full stop. What begins with code keeps its letters.
fn sentence(text: &str) -> String {
    let mut chars = text.chars();
    let first = chars.next().map(|c| c.to_uppercase().to_string()).unwrap_or_default();
    let stop = if text.ends_with(['.', '?', '!']) { "" } else { "." };
    format!("{first}{}{stop}", chars.as_str())
}
