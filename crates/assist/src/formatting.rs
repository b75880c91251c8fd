//! The edits that format the code and the JSON of a lesson, as `labspec fmt` does.

use super::item::Edit;
use labspec::format::format_checked;
use labspec::lint::ModelFolder;
use labspec::spec::Lesson;
use std::ops::Range;

/// The edits that format a lesson, from its start to its end; with a range, only those that touch it. Empty if it is
/// formatted already, or cannot be formatted.
pub fn formatting(lesson: &Lesson, folder: &ModelFolder, within: Option<&Range<usize>>) -> Vec<Edit> {
    let Ok(done) = format_checked(lesson, folder, None) else { return Vec::new() };
    let touches = |span: &Range<usize>| within.is_none_or(|w| span.start <= w.end && w.start <= span.end);
    let edits = done.edits.into_iter().rev().filter(|(span, _)| touches(span));
    edits.map(|(span, text)| Edit { span, text }).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use labspec::lint::load_lesson;
    use labspec::source::SourceFile;

    #[test]
    fn only_the_texts_of_a_range_are_formatted() {
        let text = "```lab\n{\n  \"model\": \"a\",\n  \"setup\": \"data.qpos[0]=1\",\n  \"controller\": \"ctx.a=\\\"ä\\\"\",\n  \"readouts\": [{\"label\": \"b\", \"expr\": \"1+\"}]\n}\n```\n";
        let lesson = load_lesson(SourceFile::new("a.md", text), &ModelFolder::unknown());
        let all = formatting(&lesson, &ModelFolder::unknown(), None);
        let texts: Vec<&str> = all.iter().map(|edit| edit.text.as_str()).collect();
        assert_eq!(texts, ["data.qpos[0] = 1", "ctx.a = 'ä'"]);
        let offset = text.find("ctx").unwrap_or(0);
        let one = formatting(&lesson, &ModelFolder::unknown(), Some(&(offset..offset)));
        assert_eq!(one, all[1..]);
    }

    #[test]
    fn a_block_with_another_layout_is_one_edit() {
        let text = "```lab\n{\"model\":\"a\",\n\"setup\": \"data.qpos[0]=1\"}\n```\n\n> ```lab\n> {\"model\":\n> \"a\"}\n> ```\n";
        let lesson = load_lesson(SourceFile::new("a.md", text), &ModelFolder::unknown());
        let edits = formatting(&lesson, &ModelFolder::unknown(), None);
        let texts: Vec<&str> = edits.iter().map(|edit| edit.text.as_str()).collect();
        assert_eq!(texts, [r#"{"model": "a", "setup": "data.qpos[0] = 1"}"#], "a quote is not laid out");
    }
}
