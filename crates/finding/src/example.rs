//! Examples of rules, as texts: with the feature `docs`.

use std::ops::Range;

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
