//! Completions in a lesson, from the JSON of its blocks.

use super::complete::completions_of;
use super::{Completion, INTEGRATORS, LAB, QUIZ, RequestedNames, VERIFY, completions};
use crate::markdown::{self, Block, BlockKind, LabKind};
use crate::source::SourceFile;
use crate::spec::{FileKind, comment, kind_of};
use std::ops::Range;
use std::path::Path;

/// Completions at a byte offset of a lesson (Markdown) or of a JSON file. Outside of labs, quizzes and claims there are
/// none. Offsets refer to the file. `names` provides the names, as for [`completions`].
pub fn completions_in(
    file: &SourceFile,
    offset: usize,
    names: &dyn Fn(RequestedNames<'_>) -> Vec<String>,
) -> Vec<Completion> {
    if kind_of(Path::new(&**file.path())) == FileKind::Json {
        return completions(file.text(), offset, names);
    }
    let holds = |block: &&Block| {
        let span = block.body.span();
        !matches!(block.kind, BlockKind::Code { .. }) && (span.start..=span.end).contains(&offset)
    };
    let scan = markdown::scan(file);
    let Some(Block { body, kind, .. }) = scan.blocks.iter().find(holds) else {
        let Some(claim) = comment::claim_at(file.text(), &scan, offset) else { return Vec::new() };
        let inside = file.slice(claim.clone());
        let found = completions_of(Some(&VERIFY), inside, offset - claim.start, names).into_iter();
        let place = |range: Range<usize>| claim.start + range.start..claim.start + range.end;
        return found.map(|c| Completion { replace: place(c.replace.clone()), ..c }).collect();
    };
    // The text of a block is that of the file, without the prefixes of its lines. The order of the bytes is the same, so a
    // binary search finds the offset.
    let mut here = 0..body.value.len();
    while here.start < here.end {
        let middle = here.start + (here.end - here.start) / 2;
        if body.map.span(middle..middle).start < offset {
            here.start = middle + 1;
        } else {
            here.end = middle;
        }
    }
    let whole = match kind {
        BlockKind::Lab(LabKind::Simulation) => Some(&LAB),
        BlockKind::Lab(LabKind::Comparison) => Some(&INTEGRATORS),
        BlockKind::Quiz => Some(&QUIZ),
        BlockKind::Widget(_) | BlockKind::Code { .. } => None,
    };
    let found = completions_of(whole, &body.value, here.start, names).into_iter();
    let whole = found.filter(|c| body.map.is_unbroken(c.replace.clone()));
    whole.map(|c| Completion { replace: body.map.span(c.replace), ..c }).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The completions at `|`, and the lesson after the first of them is applied.
    fn offered(lesson: &str) -> (Vec<String>, String) {
        let offset = lesson.find('|').unwrap();
        let mut text = lesson.replace('|', "");
        let all = completions_in(&SourceFile::new("a.md", text.as_str()), offset, &|_| Vec::new());
        if let Some(first) = all.first() {
            text.replace_range(first.replace.clone(), &first.insert);
        }
        (all.into_iter().map(|c| c.text.into_owned()).collect(), text)
    }

    #[test]
    fn a_key_is_offered_in_the_fence_where_it_stands() {
        let lesson = "é\n```lab simlab\n{\"model\": \"ball\",\n \"ti|\"}\n```\nSee \"ti\".\n";
        let (all, text) = offered(lesson);
        assert_eq!(all, ["title"]);
        assert!(text.contains("\n \"title\"") && text.ends_with("See \"ti\".\n"), "{text}");
        // In a block quote, every line starts with a marker that is not part of the JSON.
        let quoted =
            "> ```lab simlab\n> {\"model\": \"ball\",\n>  \"controls\": [{\"type\": \"sel|\"}]}\n> ```\n";
        let (all, text) = offered(quoted);
        assert_eq!(all, ["select"]);
        assert!(text.contains(">  \"controls\": [{\"type\": \"select\"}]}\n> ```"), "{text}");
    }

    /// The fence decides, before any key is written.
    #[test]
    fn a_quiz_has_no_keys_of_labs() {
        assert_eq!(offered("```quiz\n{|}\n```\n").0, ["id", "title", "questions", "lint"]);
        let (all, _) = offered("```lab\n{|}\n```\n");
        assert!(all.iter().any(|key| key == "model") && !all.iter().any(|key| key == "questions"), "{all:?}");
    }

    #[test]
    fn elsewhere_there_is_nothing() {
        for lesson in ["See \"ti|\".\n", "```python\nx = \"ti|\"\n```\n", "```lab simlab\n{}\n```\n\"ti|\"\n"]
        {
            assert_eq!(offered(lesson).0, Vec::<String>::new(), "{lesson}");
        }
    }

    #[test]
    fn no_offset_of_a_broken_lesson_is_a_panic() {
        let text = "> ```lab simlab\n> {“model”: \"ball\", 'é': [\n\n```quiz {\"q\n```lab simlab\n{\"a\": \"\\u00e9\"\n";
        let file = SourceFile::new("a.md", text);
        for offset in 0..=text.len() + 2 {
            for c in completions_in(&file, offset, &|_| vec!["é".into()]) {
                assert!(text.get(c.replace.clone()).is_some(), "{offset}: {:?}", c.replace);
            }
        }
    }
}
