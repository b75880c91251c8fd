//! The labs of a lesson as texts, so that each can be opened alone.

use super::code::offset_in_text;
use labspec::spec::{Lab, Lesson, ModelSource};
use std::ops::Range;

/// A lab of a lesson.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LabText {
    /// Its address: `#2`, `#quiz-id.1`.
    pub address: String,
    /// Its title; may be empty.
    pub title: String,
    /// The name of its model; `None` if the model is part of the lab.
    pub model: Option<String>,
    /// Its bytes in the lesson.
    pub span: Range<usize>,
    /// Its JSON, without the prefixes of the lines of a quote or a list.
    pub json: String,
}

/// The labs of a lesson, in order; those of questions after the others.
pub fn lab_texts(lesson: &Lesson) -> Vec<LabText> {
    let text = |lab: &Lab| {
        let holds = |span: Range<usize>| span.start <= lab.span.start && lab.span.end <= span.end;
        let block = lesson.scan.blocks.iter().find(|block| holds(block.body.span()));
        let Some(block) = block else { return lesson.file.slice(lab.span.clone()).to_string() };
        let inside = |byte| offset_in_text(&block.body, byte);
        let part = inside(lab.span.start)..inside(lab.span.end);
        block.body.value.get(part).unwrap_or("").to_string()
    };
    let labs = lesson.addressed().into_iter();
    let one = |(address, lab): (labspec::spec::LabAddress, &Lab)| LabText {
        address: address.to_string(),
        title: lab.title.as_ref().map_or_else(String::new, |title| title.value.clone()),
        model: match lab.scene() {
            Some(ModelSource::Model(name)) => Some(name.value.clone()),
            _ => None,
        },
        span: lab.span.clone(),
        json: text(lab),
    };
    labs.map(one).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use labspec::lint::{ModelFolder, load_lesson};
    use labspec::source::SourceFile;

    #[test]
    fn labs_are_found_with_their_addresses() {
        let text = "ä\n> ```lab\n> {\"model\": \"a\",\n>  \"title\": \"é\"}\n> ```\n\n```quiz\n{\"id\": \"q\", \"questions\": [{\"kind\": \"predict\", \"q\": \"?\", \"options\": [\"a\", \"b\"], \"answer\": 0, \"sim\": {\"xml\": \"<mujoco/>\"}}]}\n```\n";
        let lesson = load_lesson(SourceFile::new("a.md", text), &ModelFolder::unknown());
        let all = lab_texts(&lesson);
        let short: Vec<_> =
            all.iter().map(|l| (l.address.as_str(), l.model.as_deref(), l.json.as_str())).collect();
        assert_eq!(
            short,
            [
                ("#1", Some("a"), "{\"model\": \"a\",\n \"title\": \"é\"}"),
                ("#q.1", None, "{\"xml\": \"<mujoco/>\"}")
            ]
        );
        // A lab as JSON is the whole file.
        let alone = load_lesson(SourceFile::new("a.json", "{\"model\": \"a\"}"), &ModelFolder::unknown());
        assert_eq!(lab_texts(&alone)[0].json, "{\"model\": \"a\"}");
    }
}
