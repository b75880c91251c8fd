//! What is found as one types: the rules of structure, models, and the names in every text. Nothing is run.
//!
//! A lesson is read anew at every change, which is quick. Its code is bound block by block, and what was found of a block is kept
//! for as long as its text and the labs that it names stay what they are.

use super::course::Around;
use super::documents::Document;
use crate::bind::scene::{Models, compile_file};
use crate::check::{self, Depth, Found};
use crate::finding::Finding;
use crate::lint::{lesson_folder, load_lesson, root_of};
use crate::spec::{FileKind, Lab, LabAddress, LabEntry, Lesson, Quiz, Verify, VerifyLab};
use std::collections::BTreeMap;
use std::ops::Range;
use std::sync::Arc;

/// Looks at a document: what is found of it is in the document then.
pub(super) fn look(document: &mut Document, around: &Around) {
    document.stale = false;
    match document.kind {
        FileKind::Lesson | FileKind::Json => {
            let lesson = load_lesson(document.file.clone(), around.models.folder());
            // JSON that is neither labs nor quizzes belongs to somebody else.
            let other =
                document.kind == FileKind::Json && lesson.labs.is_empty() && lesson.quizzes.is_empty();
            document.findings =
                if other { Vec::new() } else { bound(&lesson, &mut document.blocks, &around.models) };
            document.lesson = Some(Arc::new(lesson));
        }
        FileKind::Model => {
            let root = root_of(&lesson_folder(&document.path), &[]);
            let found = compile_file(&document.file, &document.path, &root, None).findings;
            let own = |f: &Finding| f.path == *document.file.path();
            document.findings = found.into_iter().filter(own).collect();
        }
        FileKind::Unknown => {}
    }
}

/// The lesson of a document, read if need be.
pub(super) fn lesson(document: &mut Document, around: &Around) -> Option<Arc<Lesson>> {
    if !matches!(document.kind, FileKind::Lesson | FileKind::Json) {
        return None;
    }
    let read = || Arc::new(load_lesson(document.file.clone(), around.models.folder()));
    let lesson = document.lesson.clone().unwrap_or_else(read);
    document.lesson = Some(lesson.clone());
    Some(lesson)
}

/// The findings of a lesson whose blocks are bound as far as they are new.
fn bound(lesson: &Lesson, blocks: &mut BTreeMap<String, Vec<Finding>>, models: &Models) -> Vec<Finding> {
    let mut kept = BTreeMap::new();
    let mut findings = Vec::new();
    for unit in units(lesson) {
        let key = key(lesson, &unit);
        let known = blocks.get(&key).or_else(|| kept.get(&key)).cloned();
        let found = known.unwrap_or_else(|| examine(lesson, &unit, models));
        findings.extend(found.iter().map(|f| moved(f, |at| at + unit.start)));
        // A finding that points out of its block rests on more than the block.
        if found.iter().all(|f| spans(f).all(|span| span.end <= unit.len())) {
            kept.insert(key, found);
        }
    }
    *blocks = kept;
    let found = Found { findings, ..Found::default() };
    check::join(lesson.clone(), found, Depth::STATIC).findings
}

/// The labs and quizzes of a lesson, as bytes.
fn units(lesson: &Lesson) -> Vec<Range<usize>> {
    let labs = lesson.labs.iter().map(|entry| entry.span.clone());
    labs.chain(lesson.quizzes.iter().map(|quiz| quiz.span.clone())).collect()
}

/// What the findings of a block rest on: its text, and those of the labs that it names.
fn key(lesson: &Lesson, unit: &Range<usize>) -> String {
    let mut key = lesson.file.slice(unit.clone()).to_string();
    for address in named_by(lesson, unit) {
        key.push('\0');
        key.push_str(&address.to_string());
        key.push_str(lesson.lab(&address).map_or("", |lab| lesson.file.slice(lab.span.clone())));
    }
    key
}

/// The labs that the `verify` objects of a block name.
fn named_by(lesson: &Lesson, unit: &Range<usize>) -> Vec<LabAddress> {
    let of_labs = lesson
        .all_labs()
        .into_iter()
        .filter(|lab| within(&lab.span, unit))
        .filter_map(|lab| lab.verify.as_ref());
    let quizzes = lesson.quizzes.iter().filter(|quiz| within(&quiz.span, unit));
    let of_questions = quizzes.flat_map(Quiz::numbered).filter_map(|(_, question)| question.verify.as_ref());
    let named = |lab: &VerifyLab| match lab {
        VerifyLab::Reference(_, address) => Some(address.clone()),
        _ => None,
    };
    of_labs.chain(of_questions).flat_map(Verify::labs).filter_map(named).collect()
}

fn within(span: &Range<usize>, unit: &Range<usize>) -> bool {
    unit.start <= span.start && span.end <= unit.end
}

/// Binds one block, as if there were no others but those that it names. Places count from its beginning.
fn examine(lesson: &Lesson, unit: &Range<usize>, models: &Models) -> Vec<Finding> {
    let named = named_by(lesson, unit);
    let wanted: Vec<&Lab> = named.iter().filter_map(|address| lesson.lab(address)).collect();
    let needed = |span: &Range<usize>| within(span, unit) || wanted.iter().any(|lab| within(&lab.span, span));
    let entry = |entry: &LabEntry| LabEntry {
        lab: entry.lab.clone().filter(|_| needed(&entry.span)),
        ..entry.clone()
    };
    let part = Lesson {
        file: lesson.file.clone(),
        labs: lesson.labs.iter().map(entry).collect(),
        quizzes: lesson.quizzes.iter().filter(|quiz| needed(&quiz.span)).cloned().collect(),
        widgets: Vec::new(),
        broken: Vec::new(),
        remarks: Vec::new(),
        wholes: lesson.wholes.clone(),
        others: Vec::new(),
        scan: Default::default(),
        problems: Vec::new(),
        findings: Vec::new(),
        snapshot: None,
    };
    let found = check::examine(&part, models, Depth::STATIC).findings;
    let own = found.into_iter().filter(|f| (unit.start..=unit.end).contains(&f.span.start));
    own.map(|f| moved(&f, |at| at.wrapping_sub(unit.start))).collect()
}

/// A finding with all its places moved.
fn moved(f: &Finding, to: impl Fn(usize) -> usize) -> Finding {
    let mut f = f.clone();
    let shift = |span: &Range<usize>| to(span.start)..to(span.end);
    f.span = shift(&f.span);
    f.related
        .iter_mut()
        .filter(|place| place.path.is_empty())
        .for_each(|place| place.span = shift(&place.span));
    if let Some(fix) = &mut f.fix {
        fix.span = shift(&fix.span);
    }
    f
}

/// All places of a finding in its own text.
fn spans(f: &Finding) -> impl Iterator<Item = &Range<usize>> {
    let related = f.related.iter().filter(|place| place.path.is_empty()).map(|place| &place.span);
    related.chain(f.fix.iter().map(|fix| &fix.span)).chain([&f.span])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lint::ModelFolder;
    use crate::source::SourceFile;
    use std::path::Path;

    /// What a lesson says without anything kept: what [`look`] must find, too.
    fn plainly(file: SourceFile, models: &Models) -> Vec<Finding> {
        check::check(load_lesson(file, models.folder()), models, Depth::STATIC).findings
    }

    /// Changes in the texts of real lessons: what is kept of the blocks never changes what is found.
    #[test]
    fn what_is_kept_changes_nothing() {
        let specs = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../specs");
        let folder = ModelFolder::open(&specs.join("models")).unwrap();
        let around = Around { models: Arc::new(Models::new(folder)), started: Vec::new() };
        let (mut changes, mut with_findings) = (0, 0);
        for name in ["01-what-a-step-computes.md", "02-bounce-and-swing.md"] {
            let path = specs.join("lessons").join(name);
            let text = std::fs::read_to_string(&path).unwrap();
            let mut document = Document::new("file:///a.md", path.clone(), &text, 1);
            for (at, what) in
                [("qpos", "qpso"), ("\"verify\"", "\"verfy\""), ("{", ""), ("data.", "dta."), ("```", "``")]
            {
                for (place, _) in text.match_indices(at).step_by(7) {
                    let mut changed = text.clone();
                    changed.replace_range(place..place + at.len(), what);
                    document.change(&[serde_json::json!({"text": changed})], 2);
                    look(&mut document, &around);
                    let plain = plainly(document.file.clone(), &around.models);
                    assert_eq!(document.findings, plain, "{what} at {place} of {name}");
                    changes += 1;
                    with_findings += usize::from(!plain.is_empty());
                }
            }
        }
        assert!(changes > 30 && with_findings > 30, "{changes} {with_findings}");
    }
}
