//! Reads the claims and the definitions in comments.

use super::comment::{CLAIM, ClaimComment, Comment, DEFINITION, Definition, comments, labspec_comments};
use super::lesson::Lesson;
use super::problem::{Mistake, Problem};
use super::read_lab::{is_name, read_definition, read_verify};
use super::sources::read_json;
use crate::markdown::{self, MAX_BLOCKS, Scan};
use crate::source::SourceMap;

/// Reads the definitions in comments: `<!-- labspec define NAME {…} -->`. Errors are added to the lesson.
pub(super) fn read_definitions(scan: &Scan, lesson: &mut Lesson) -> Vec<Definition> {
    let file = lesson.file.clone();
    let mut all: Vec<Definition> = Vec::new();
    for (span, inside) in labspec_comments(file.text(), scan, DEFINITION).into_iter().take(MAX_BLOCKS) {
        let text = file.slice(inside.clone());
        let rest = text.trim_start();
        let name: String = rest.chars().take_while(|c| is_name(*c)).collect();
        let start = inside.start + text.len() - rest.len();
        if name.is_empty() || all.iter().any(|other| other.name == name) {
            lesson.problems.push(Mistake::NoDefinitionName(name).at(start..start + 1));
            continue;
        }
        let inside = start + name.len()..inside.end;
        let text = file.slice(inside.clone());
        let node = read_json(text, &SourceMap::verbatim(inside), span.clone(), (scan, true), lesson);
        let found = node.and_then(|node| read_definition(&node, &mut lesson.problems));
        all.extend(found.map(|verify| Definition { name, span, verify }));
    }
    all
}

/// Reads the claims in comments. Errors are added to the lesson.
pub(super) fn read_claim_comments(scan: &Scan, lesson: &mut Lesson) -> Vec<ClaimComment> {
    let file = lesson.file.clone();
    let mut all = Vec::new();
    for Comment { span, inside, over } in comments(&file, scan, CLAIM) {
        if all.len() >= MAX_BLOCKS {
            lesson.problems.push(Problem::Fence(markdown::Problem::TooManyBlocks(span.start)));
            break;
        }
        let text = file.slice(inside.clone());
        let node = read_json(text, &SourceMap::verbatim(inside), span.clone(), (scan, true), lesson);
        let found = node.and_then(|node| read_verify(&node, &mut lesson.problems));
        all.extend(found.map(|verify| ClaimComment { span, over, verify }));
    }
    all
}
