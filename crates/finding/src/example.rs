//! Examples of rules as texts, with the feature `docs`.

use std::ops::Range;

/// The lab to which questions in examples belong.
const FALLING: &str = r#"{"xml": "<mujoco><worldbody><geom name='floor' type='plane' size='1 1 1'/><body name='ball' pos='0 0 1'><freejoint/><geom name='ball' size='.05' mass='1'/></body></worldbody></mujoco>",
 "title": "Falling", "readouts": [{"label": "height (m)", "expr": "data.qpos[2]"}]}"#;

/// The marks around the span of the finding in a wrong example. They are not part of the example.
const MARKS: [&str; 2] = ["⟦", "⟧"];

/// An example of a rule. In a wrong example, `⟦` and `⟧` mark the span of the finding.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Example {
    /// A whole lesson, Markdown.
    Lesson(&'static str),
    /// The JSON of a question about a falling ball, in a quiz below its lab.
    Question(&'static str),
    /// The JSON of a lab.
    Lab(&'static str),
    /// The JSON of a quiz.
    Quiz(&'static str),
    /// A stand-alone JSON file.
    Json(&'static str),
    /// A lesson that repeats the same text many times.
    Repeated(&'static str, usize),
    /// An expression, as in a trace or a readout.
    Expression(&'static str),
    /// Statements, as in a controller.
    Statements(&'static str),
    /// A very long or deep expression, which is generated: prefix, repeated text, number of repetitions, suffix.
    Long(&'static str, &'static str, usize, &'static str),
    /// A model in MJCF.
    Model(&'static str),
    /// A very large model, which is generated: prefix, repeated text, number of repetitions, suffix.
    LongModel(&'static str, &'static str, usize, &'static str),
    /// Files with their names, the first of which is checked. They are bytes, because some are not text.
    Files(&'static [(&'static str, &'static [u8])]),
}

impl Example {
    /// The language of its code listing.
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

    /// A file name for the example.
    pub fn name(&self) -> &'static str {
        match self {
            Example::Json(_) => "example.json",
            Example::Model(_) | Example::LongModel(..) => "example.xml",
            Example::Files(files) => files.first().map_or("example.md", |(name, _)| name),
            _ => "example.md",
        }
    }

    /// The whole text, as in a file.
    pub fn text(&self) -> String {
        String::from_utf8_lossy(&self.bytes()).into_owned()
    }

    /// The bytes of the file, which may not be text.
    pub fn bytes(&self) -> Vec<u8> {
        let mut bytes = self.written();
        for mark in MARKS {
            while let Some(start) = find(&bytes, mark) {
                bytes.drain(start..start + mark.len());
            }
        }
        bytes
    }

    /// The range of [`Example::text`] that the finding marks, or `None` if the example has no marks.
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

    /// The text for readers: a repetition is described, not repeated.
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

/// The position of a text in bytes.
fn find(bytes: &[u8], text: &str) -> Option<usize> {
    bytes.windows(text.len()).position(|window| window == text.as_bytes())
}
