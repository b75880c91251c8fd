//! Findings while the author types: rules of structure, models, and the names in all source texts. Nothing is run.
//!
//! A lesson is parsed again at every change, which is fast. Its programs are bound block by block. The findings of a block are
//! cached as long as its text and the labs that it names do not change.

use super::document::{Context, Document};
use labspec::bind::scene::Models;
use labspec::check::{self, CheckLevel, Checked, Claim, LabOutcome};
use labspec::finding::{self, Finding};
use labspec::lint::check_course;
use labspec::spec::{FileKind, Lab, LabEntry, Lesson, Other, Verify, VerifyLab, kind_of};
use std::collections::BTreeMap;
use std::hash::{DefaultHasher, Hash, Hasher};
use std::ops::Range;
use std::path::Path;

impl Document {
    /// Checks the text, and stores the findings.
    pub fn check(&mut self, context: &Context) {
        self.of_course.clear();
        self.findings = match self.kind {
            FileKind::Lesson | FileKind::Json => self.check_lesson(context),
            FileKind::Model => {
                let found = context.models.check_text(&self.file, &self.path);
                found.into_iter().filter(|f| f.path == *self.file.path()).collect()
            }
            FileKind::Unknown => Vec::new(),
        };
    }

    fn check_lesson(&mut self, context: &Context) -> Vec<Finding> {
        self.lesson = None;
        let Some(lesson) = self.read_lesson(context) else { return Vec::new() };
        if is_other_json(&lesson) {
            return Vec::new();
        }
        self.of_course = check_course(&[&lesson]);
        reported(check_blocks(&lesson, &mut self.blocks, &context.models))
    }
}

/// Whether a file is JSON that contains neither labs nor quizzes, which belongs to another program.
fn is_other_json(lesson: &Lesson) -> bool {
    let kind = kind_of(Path::new(&**lesson.file.path()));
    kind == FileKind::Json && lesson.labs.is_empty() && lesson.quizzes.is_empty()
}

/// The findings of a checked lesson as `labspec check` reports them, without those that depend on the other lessons of its
/// course. There are none for JSON of another program.
pub fn reported(checked: Checked) -> Vec<Finding> {
    if is_other_json(&checked.lesson) {
        return Vec::new();
    }
    let mut all = checked.findings;
    finding::sort(&mut all);
    all
}

/// Checks a lesson without runs. Only new blocks are bound.
fn check_blocks(lesson: &Lesson, blocks: &mut BTreeMap<String, Vec<Finding>>, models: &Models) -> Checked {
    let mut next_blocks = BTreeMap::new();
    let mut findings = Vec::new();
    let models_now = models_hash(models);
    for unit in units(lesson) {
        let key = format!("{models_now}\0{}", block_key(lesson, &unit));
        let cached = blocks.get(&key).or_else(|| next_blocks.get(&key)).cloned();
        let found = cached.unwrap_or_else(|| check_block(lesson, &unit, models));
        findings.extend(found.iter().map(|f| moved(f, |offset| offset + unit.start)));
        // A finding that refers to text outside its block depends on more than the block.
        if found.iter().all(|f| spans(f).all(|span| span.end <= unit.len())) {
            next_blocks.insert(key, found);
        }
    }
    *blocks = next_blocks;
    let found = LabOutcome::from_findings(findings);
    check::join(lesson.clone(), found, CheckLevel::STATIC)
}

/// A hash that changes with the list of models.
fn models_hash(models: &Models) -> u64 {
    let mut hasher = DefaultHasher::new();
    (models.folder().path_of_folder(), models.folder().names()).hash(&mut hasher);
    hasher.finish()
}

/// The byte ranges of the labs, quizzes and claims in comments of a lesson.
pub(crate) fn units(lesson: &Lesson) -> Vec<Range<usize>> {
    let labs = lesson.labs.iter().map(|entry| entry.span.clone());
    let quizzes = lesson.quizzes.iter().map(|quiz| quiz.span.clone());
    labs.chain(quizzes).chain(lesson.claim_comments.iter().map(|comment| comment.span.clone())).collect()
}

/// The dependencies of the findings of a block: its text, the text to which it applies, and the texts of the labs
/// and claims that it names.
pub(crate) fn block_key(lesson: &Lesson, unit: &Range<usize>) -> String {
    let over = lesson
        .claim_comments
        .iter()
        .filter(|comment| comment.span == *unit)
        .map(|comment| comment.over.clone());
    let mut key = lesson.file.slice(unit.clone()).to_string();
    let used = claims(lesson, unit).flat_map(|claim| lesson.used_by(claim)).map(|used| used.span.clone());
    for span in over.chain(used) {
        key.push('\0');
        key.push_str(lesson.file.slice(span));
    }
    // Files with values, and listings that are models, can be changed without the block.
    for file in &lesson.data {
        let text = file.text.as_deref().unwrap_or_else(|why| why);
        key.push_str(text);
    }
    if lesson.file.slice(unit.clone()).contains("\"listing\"") {
        key.push_str(lesson.file.text());
    }
    for named in named_by(lesson, unit) {
        key.push('\0');
        match named {
            VerifyLab::Reference(text, _) => {
                key.push_str(&text.value);
                key.push_str(lesson.named(named).map_or("", |lab| lesson.file.slice(lab.span.clone())));
            }
            VerifyLab::Elsewhere(text, ..) => {
                key.push_str(lesson.other(&text.span()).map_or("", |other| &other.text));
            }
            VerifyLab::Inline(_) | VerifyLab::Broken => {}
        }
    }
    key
}

/// The `verify` objects of a block.
fn claims<'l>(lesson: &'l Lesson, unit: &Range<usize>) -> impl Iterator<Item = &'l Verify> {
    lesson.verifies().filter(|claim| within(&claim.span, unit))
}

/// The labs that these name, and the labs that those use.
fn named_by<'l>(lesson: &'l Lesson, unit: &Range<usize>) -> impl Iterator<Item = &'l VerifyLab> {
    claims(lesson, unit).flat_map(|claim| lesson.whole(claim).labs())
}

fn within(span: &Range<usize>, unit: &Range<usize>) -> bool {
    unit.start <= span.start && span.end <= unit.end
}

/// Binds one block as if only the blocks that it names existed. Spans count from the start of the block.
fn check_block(lesson: &Lesson, unit: &Range<usize>, models: &Models) -> Vec<Finding> {
    let found = check::run_checks(&part_of(lesson, unit), models, CheckLevel::STATIC).findings;
    let inside = found.into_iter().filter(|f| (unit.start..=unit.end).contains(&f.span.start));
    inside.map(|f| moved(&f, |offset| offset.wrapping_sub(unit.start))).collect()
}

/// Checks the claims of one block with all their runs, as if only the blocks that it names existed.
pub fn check_claims_of(lesson: &Lesson, unit: &Range<usize>, models: &Models) -> Vec<Claim> {
    let part = Lesson { scan: lesson.scan.clone(), ..part_of(lesson, unit) };
    let claims = check::run_checks(&part, models, CheckLevel::CLAIMS).claims;
    claims.into_iter().filter(|claim| within(&claim.span, unit)).collect()
}

/// A lesson with one block and the blocks that it names.
fn part_of(lesson: &Lesson, unit: &Range<usize>) -> Lesson {
    let named: Vec<&VerifyLab> = named_by(lesson, unit).collect();
    let referenced: Vec<&Lab> = named.iter().filter_map(|named| lesson.named(named)).collect();
    let elsewhere = |other: &&Other| {
        let here =
            |named: &&VerifyLab| matches!(named, VerifyLab::Elsewhere(text, ..) if text.span() == other.span);
        named.iter().any(here)
    };
    let needed =
        |span: &Range<usize>| within(span, unit) || referenced.iter().any(|lab| within(&lab.span, span));
    let entry = |entry: &LabEntry| LabEntry {
        lab: entry.lab.clone().filter(|_| needed(&entry.span)),
        ..entry.clone()
    };
    Lesson {
        file: lesson.file.clone(),
        labs: lesson.labs.iter().map(entry).collect(),
        quizzes: lesson.quizzes.iter().filter(|quiz| needed(&quiz.span)).cloned().collect(),
        widgets: Vec::new(),
        broken: Vec::new(),
        definitions: lesson.definitions.clone(),
        claim_comments: lesson
            .claim_comments
            .iter()
            .filter(|comment| within(&comment.span, unit))
            .cloned()
            .collect(),
        wholes: lesson.wholes.clone(),
        others: lesson.others.iter().filter(elsewhere).cloned().collect(),
        scan: Default::default(),
        problems: Vec::new(),
        findings: Vec::new(),
        snapshot: None,
        data: lesson.data.clone(),
        conventions: lesson.conventions.clone(),
        place: None,
    }
}

/// A finding with all its spans shifted.
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

/// All spans of a finding in its own text.
fn spans(f: &Finding) -> impl Iterator<Item = &Range<usize>> {
    let related = f.related.iter().filter(|place| place.path.is_empty()).map(|place| &place.span);
    related.chain(f.fix.iter().map(|fix| &fix.span)).chain([&f.span])
}

#[cfg(test)]
mod tests {
    use super::*;
    use labspec::lint::{ModelFolder, load_lesson_at};
    use labspec::source::{SourceFile, Sources};
    use std::path::Path;
    use std::sync::Arc;

    /// The findings of a lesson without the cache, which [`Document::check`] must find as well.
    fn plainly(file: SourceFile, path: &Path, models: &Models) -> Vec<Finding> {
        let lesson = load_lesson_at(file, path, &Sources::Disk, models.folder());
        reported(check::check_lesson(lesson, models, CheckLevel::STATIC))
    }

    /// Claims that name others: one in a comment, one about a lab of another lesson, and one that uses
    /// the runs of another claim.
    const NAMING: &str = r##"# Naming

```lab simlab
{"model": "pendulum", "readouts": [{"label": "a", "expr": "data.qpos[0]"}],
 "verify": {"runs": {"swing": {"until": 1}}, "measure": {"far": "max(abs(data.qpos[0]))"}, "says": [["far", "far > 0"]]}}
```

<!-- labspec verify {"use": "#1", "measure": {"low": "min(data.qpos[0])"}, "says": [["low", "low < far"]]} -->
The pendulum swings low.

<!-- labspec verify {"lab": "02-bounce-and-swing.md#1", "measure": {"late": "max(data.qpos[0])"}, "says": [["late", "late < 9"]]} -->
It comes late.
"##;

    /// Changes in the texts of real lessons: the cache of blocks never changes the findings.
    #[test]
    fn what_is_kept_changes_nothing() {
        let specs = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../specs").canonicalize().unwrap();
        let folder = ModelFolder::open(&specs.join("models")).unwrap();
        let context = Context::new(Arc::new(Models::new(folder)), Sources::Disk);
        let (mut changes, mut with_findings) = (0, 0);
        let read = |name: &str| std::fs::read_to_string(specs.join("lessons").join(name)).unwrap();
        let lessons =
            ["01-what-a-step-computes.md", "02-bounce-and-swing.md"].map(|name| (name, read(name), 7));
        for (name, text, stride) in lessons.into_iter().chain([("naming.md", NAMING.to_string(), 1)]) {
            let path = specs.join("lessons").join(name);
            let mut document = Document::new(path.clone(), &text);
            let typed =
                [("qpos", "qpso"), ("\"verify\"", "\"verfy\""), ("{", ""), ("data.", "dta."), ("```", "``")];
            for (old_text, what) in
                typed.into_iter().chain([("far", "fra"), ("low", "lwo"), ("#1", "#2"), ("late", "lat")])
            {
                for (place, _) in text.match_indices(old_text).step_by(stride) {
                    let mut changed = text.clone();
                    changed.replace_range(place..place + old_text.len(), what);
                    document.set_text(changed);
                    document.check(&context);
                    let plain = plainly(document.file.clone(), &path, &context.models);
                    assert_eq!(document.findings, plain, "{what} at {place} of {name}");
                    changes += 1;
                    with_findings += usize::from(!plain.is_empty());
                }
            }
            if name == "naming.md" {
                document.set_text(text);
                document.check(&context);
                assert_eq!(document.findings, []);
            }
        }
        assert!(changes > 60 && with_findings > 60, "{changes} {with_findings}");
    }
}
