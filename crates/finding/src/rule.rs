//! Rules: declared once, with their reasons and examples.

use crate::severity::Severity;
use std::ops::Range;

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

/// The lab of questions in examples.
const FALLING: &str = r#"{"xml": "<mujoco><worldbody><geom name='floor' type='plane' size='1 1 1'/><body name='ball' pos='0 0 1'><freejoint/><geom name='ball' size='.05' mass='1'/></body></worldbody></mujoco>",
 "title": "Falling", "readouts": [{"label": "height (m)", "expr": "data.qpos[2]"}]}"#;

/// What encloses the place that the rule points at, in its wrong example. It is not part of the example.
const MARKS: [&str; 2] = ["⟦", "⟧"];

/// An example of a rule. In the wrong one, `⟦` and `⟧` stand around the place that is found.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Example {
    /// A whole lesson, Markdown.
    Lesson(&'static str),
    /// The JSON of a question about a ball that falls, in a quiz below its lab.
    Question(&'static str),
    /// The JSON of a lab.
    Lab(&'static str),
    /// The JSON of a quiz.
    Quiz(&'static str),
    /// A stand-alone JSON file.
    Json(&'static str),
    /// A lesson that says the same thing very often.
    Repeated(&'static str, usize),
    /// An expression: what a trace or a readout shows.
    Expression(&'static str),
    /// Statements: what a controller does.
    Statements(&'static str),
    /// An expression so long or deep that it has to be made: before, repeated, how often, after.
    Long(&'static str, &'static str, usize, &'static str),
    /// A model, MJCF.
    Model(&'static str),
    /// A model so large that it has to be made: before, repeated, how often, after.
    LongModel(&'static str, &'static str, usize, &'static str),
    /// Files by their names, the first of which is checked; bytes, for those that are no text.
    Files(&'static [(&'static str, &'static [u8])]),
}

impl Example {
    /// The language of the listing that shows it.
    pub fn language(&self) -> &'static str {
        match self {
            Example::Lesson(_)
            | Example::Question(_)
            | Example::Repeated(..)
            | Example::Lab(_)
            | Example::Quiz(_) => "markdown",
            Example::Json(_) => "json",
            Example::Model(_) | Example::LongModel(..) => "xml",
            Example::Expression(_) | Example::Statements(_) | Example::Long(..) => "javascript",
            Example::Files(_) => "text",
        }
    }

    /// The name of a file that would hold it.
    pub fn name(&self) -> &'static str {
        match self {
            Example::Json(_) => "example.json",
            Example::Model(_) | Example::LongModel(..) => "example.xml",
            Example::Files(files) => files.first().map_or("example.md", |(name, _)| name),
            _ => "example.md",
        }
    }

    /// The whole text, as it would stand in a file.
    pub fn text(&self) -> String {
        String::from_utf8_lossy(&self.bytes()).into_owned()
    }

    /// The file's bytes, which need not be text.
    pub fn bytes(&self) -> Vec<u8> {
        let mut bytes = self.written();
        for mark in MARKS {
            while let Some(at) = find(&bytes, mark) {
                bytes.drain(at..at + mark.len());
            }
        }
        bytes
    }

    /// Bytes of [`Example::text`] that the rule points at; `None` where the example does not mark them.
    pub fn marked(&self) -> Option<Range<usize>> {
        let bytes = self.written();
        let text = String::from_utf8_lossy(&bytes);
        let [open, close] = MARKS.map(|mark| text.find(mark));
        let (open, close) = (open?, close?.checked_sub(MARKS[0].len())?);
        (open <= close).then_some(open..close)
    }

    /// The whole text with the marks.
    fn written(&self) -> Vec<u8> {
        let text = match self {
            Example::Lesson(text)
            | Example::Json(text)
            | Example::Expression(text)
            | Example::Statements(text)
            | Example::Model(text) => (*text).to_string(),
            Example::Repeated(text, times) => text.repeat(*times),
            Example::Long(before, text, times, after) | Example::LongModel(before, text, times, after) => {
                format!("{before}{}{after}", text.repeat(*times))
            }
            Example::Lab(json) => format!("```lab simlab\n{json}\n```\n"),
            Example::Quiz(json) => format!("```quiz\n{json}\n```\n"),
            Example::Question(json) => format!(
                "```lab simlab\n{FALLING}\n```\n\n```quiz\n{{\"id\": \"fall\", \"questions\": [{json}]}}\n```\n"
            ),
            Example::Files(files) => return files.first().map_or(Vec::new(), |(_, bytes)| bytes.to_vec()),
        };
        text.into_bytes()
    }

    /// The rendered text: a repetition is named, not repeated.
    pub fn render(&self) -> String {
        let text = match self {
            Example::Repeated(text, times) => {
                format!("{}\n… and so on, {times} times", text.trim_end())
            }
            Example::Long(before, text, times, after) => {
                format!("{before}{text}…{after}        // {text} stands here {times} times")
            }
            Example::LongModel(before, text, times, after) => {
                format!("{before}{text}…{after}        <!-- {text} stands here {times} times -->")
            }
            Example::Files(files) => {
                let one = |(name, bytes): &(&str, &[u8])| {
                    format!("{name}:\n{}", String::from_utf8_lossy(bytes).trim_end())
                };
                files.iter().map(one).collect::<Vec<_>>().join("\n\n")
            }
            _ => self.text().trim_end().to_string(),
        };
        MARKS.iter().fold(text, |text, mark| text.replace(mark, ""))
    }
}

/// Where a text stands in bytes.
fn find(bytes: &[u8], text: &str) -> Option<usize> {
    bytes.windows(text.len()).position(|window| window == text.as_bytes())
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
