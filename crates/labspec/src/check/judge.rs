//! Compares the claims of a lesson with a reference engine: the requested runs, and the comparison with its recording.

use super::claims;
use super::resolved_labs::bind_claim;
use crate::bind::parts::Hash;
use crate::bind::scene::Models;
use crate::finding::Finding;
use crate::json::to_value;
use crate::spec::Lesson;
use crate::verify::judge::{self, Judged, RecordedRun, Reference, RunTask, Unjudged};
use crate::verify::{RenderedText, RunCache};
use std::collections::{BTreeMap, BTreeSet};

/// A run that a reference engine has to make.
#[derive(Clone, Debug, PartialEq)]
pub struct Request {
    /// The owner of the claim: `quiz fall, question 2`.
    pub claim: String,
    /// Its name.
    pub run: String,
    /// The digest of the request; that of an empty text where another program cannot execute the run.
    pub hash: String,
    /// The request, or the reason why another program cannot execute the run.
    pub task: Result<RunTask, String>,
}

/// The recorded results of a reference engine.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ReferenceRecording {
    /// `MuJoCo 3.14.0`.
    pub engine: String,
    /// The runs by the digest of the request.
    pub runs: BTreeMap<String, RecordedRun>,
    /// The lesson (its file name), claim and run of each recorded run: identifies recordings of a changed text.
    pub recorded: BTreeSet<[String; 3]>,
}

/// The comparison of a lesson with a reference engine.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct CrossCheck {
    /// The requested runs.
    pub requests: Vec<Request>,
    /// The result for every claim, by the name of its owner.
    pub claims: Vec<(String, Judged)>,
    /// Claims that the reference engine does not check, of all owners.
    pub left: Unjudged,
    /// Number of runs that were recorded for another text.
    pub stale: usize,
    /// Number of runs without a recording.
    pub missing: usize,
}

/// Collects the requests for all runs of the lesson, and compares its claims with the recording if there is one.
pub fn cross_check(
    lesson: &Lesson,
    models: &Models,
    hash_bytes: Hash,
    recording: Option<&ReferenceRecording>,
    findings: &mut Vec<Finding>,
) -> CrossCheck {
    let ready = super::of_claims(lesson, models);
    let stage = RunCache::new(models, lesson.conventions.languages);
    let rendered = RenderedText::of_lesson(lesson);
    let mut cross_check = CrossCheck::default();
    for (name, owner) in claims::owners(lesson) {
        let Some((verify, lab, question)) = owner.claim(lesson) else { continue };
        let narrow = owner.block().map(|block| rendered.within(block, verify));
        let rendered = narrow.as_ref().unwrap_or(&rendered);
        cross_check.left = cross_check.left.and(Unjudged::count(verify));
        let Some(bound) = bind_claim(lesson, &ready, verify, lab, &stage) else { continue };
        let requests = judge::tasks(&bound, verify).into_iter().map(|one| {
            let text = one.task.as_ref().map_or(String::new(), |task| to_value(task).to_string());
            let hash: String = hash_bytes(&[text.as_bytes()]).chars().take(16).collect();
            Request { claim: name.clone(), run: one.run, hash, task: one.task }
        });
        let requests: Vec<Request> = requests.collect();
        if let Some(recording) = recording {
            let runs = requests.iter().map(|r| recorded(lesson, recording, r, &mut cross_check)).collect();
            let reference = Reference { engine: &recording.engine, runs };
            let judged = judge::judge(&bound, verify, question, rendered, &reference, findings);
            cross_check.claims.extend(judged.map(|judged| (name.clone(), judged)));
        }
        cross_check.requests.extend(requests);
    }
    cross_check
}

/// The recording of a run, or the reason why there is none.
fn recorded<'r>(
    lesson: &Lesson,
    recording: &'r ReferenceRecording,
    request: &Request,
    cross_check: &mut CrossCheck,
) -> Result<&'r RecordedRun, String> {
    request.task.as_ref().map_err(Clone::clone)?;
    if let Some(recorded) = recording.runs.get(&request.hash) {
        return Ok(recorded);
    }
    let key = [file_name(lesson), request.claim.clone(), request.run.clone()];
    if recording.recorded.contains(&key) {
        cross_check.stale += 1;
        return Err("the lesson or its model has changed since it was recorded".into());
    }
    cross_check.missing += 1;
    Err("its run is not recorded".into())
}

/// The name of a lesson's file, without its folder.
pub fn file_name(lesson: &Lesson) -> String {
    let path: &str = lesson.file.path();
    path.rsplit(['/', '\\']).next().unwrap_or(path).to_string()
}
