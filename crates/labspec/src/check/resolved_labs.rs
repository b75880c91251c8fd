//! Resolves the labs of a `verify` object: its own, and that of each of its runs.

use super::PreparedLab;
use crate::finding::Finding;
use crate::rules;
use crate::spec::{Lab, Lesson, Verify, VerifyLab};
use crate::verify::{self, BoundLab, BoundVerify, RunCache};
use labspec_core::Model;
use std::sync::Arc;

/// The labs of a `verify` object: its own, and that of each of its runs.
pub(super) struct ResolvedLabs<'r> {
    pub(super) base: Option<BoundLab<'r>>,
    pub(super) runs: Vec<Vec<BoundLab<'r>>>,
}

/// The labs of a `verify` object, if they can run. Errors in the modifications of a run are added to `findings`.
pub(super) fn resolve_labs<'r>(
    lesson: &'r Lesson,
    ready: &'r [PreparedLab<'r>],
    verify: &'r Verify,
    lab: Option<&'r Lab>,
    stage: &RunCache<'_>,
    findings: &mut Vec<Finding>,
) -> Option<ResolvedLabs<'r>> {
    let base = match &verify.lab {
        // Formulas use an empty lab.
        None if lab.is_none() && verify.is_formulas() => {
            ready.iter().find(|r| r.lab.is_nothing()).map(PreparedLab::scene)
        }
        None => lab.and_then(|lab| scene_of(ready, lab)),
        Some(named) => named_scene(lesson, ready, named, findings),
    };
    let mut runs = Vec::new();
    for run in &verify.runs {
        let lab = match &run.lab {
            None => base.clone(),
            Some(named) => named_scene(lesson, ready, named, findings),
        };
        runs.push(stage.of_run(&lab?, run, findings)?);
    }
    (base.is_some() || !runs.is_empty()).then_some(ResolvedLabs { base, runs })
}

fn scene_of<'r>(ready: &'r [PreparedLab<'r>], lab: &Lab) -> Option<BoundLab<'r>> {
    // An object that uses another one has a copy of its inline lab.
    let same =
        ready.iter().find(|r| std::ptr::eq(r.lab, lab)).or_else(|| ready.iter().find(|r| *r.lab == *lab));
    same.map(PreparedLab::scene)
}

/// The named lab. If a lab of another lesson is missing or cannot run, the reason is added to `findings`.
fn named_scene<'r>(
    lesson: &'r Lesson,
    ready: &'r [PreparedLab<'r>],
    named: &'r VerifyLab,
    findings: &mut Vec<Finding>,
) -> Option<BoundLab<'r>> {
    let scene = lesson.named(named).and_then(|lab| scene_of(ready, lab));
    let (VerifyLab::Elsewhere(text, ..), None) = (named, &scene) else { return scene };
    let other = lesson.other(&text.span()).map(|other| other.lab.as_ref().err().map(String::as_str));
    findings.push(rules::unknown_lab::lab_of_other_lesson(text, other));
    None
}

/// A `verify` object bound to its labs. `None` where they have errors.
pub(super) fn bind_claim<'r>(
    lesson: &'r Lesson,
    ready: &'r [PreparedLab<'r>],
    verify: &'r Verify,
    lab: Option<&'r Lab>,
    stage: &'r RunCache<'r>,
) -> Option<BoundVerify<'r>> {
    bind_with_base(lesson, ready, verify, lab, stage).map(|(_, bound)| bound)
}

/// Like [`bind_claim`]; also returns the base lab.
fn bind_with_base<'r>(
    lesson: &'r Lesson,
    ready: &'r [PreparedLab<'r>],
    verify: &'r Verify,
    lab: Option<&'r Lab>,
    stage: &'r RunCache<'r>,
) -> Option<(Option<BoundLab<'r>>, BoundVerify<'r>)> {
    let ResolvedLabs { base, runs } = resolve_labs(lesson, ready, verify, lab, stage, &mut Vec::new())?;
    let bound = BoundVerify::new(verify, base.as_ref(), &runs, stage, &mut Vec::new())?;
    Some((base, bound))
}

/// The models of a `verify` object.
pub(super) struct StartedRuns {
    /// The model of its lab.
    pub(super) model: Option<Arc<Model>>,
    /// The model of every run at its start.
    pub(super) runs: Vec<(String, Option<Model>)>,
}

/// Sets up the runs of a `verify` object without executing them. `None` where they have errors.
pub(super) fn start_runs<'r>(
    lesson: &'r Lesson,
    ready: &'r [PreparedLab<'r>],
    verify: &'r Verify,
    lab: Option<&'r Lab>,
    stage: &'r RunCache<'r>,
) -> Option<StartedRuns> {
    let (base, bound) = bind_with_base(lesson, ready, verify, lab, stage)?;
    Some(StartedRuns { runs: bound.started_models(), model: base.map(|scene| scene.model) })
}

/// The curves of the labs in at most `most` runs of a `verify` object; empty where they have errors.
pub(super) fn record_curves<'r>(
    lesson: &'r Lesson,
    ready: &'r [PreparedLab<'r>],
    verify: &'r Verify,
    lab: Option<&'r Lab>,
    stage: &'r RunCache<'r>,
    most: usize,
) -> Vec<verify::Curves> {
    bind_claim(lesson, ready, verify, lab, stage).map_or(Vec::new(), |bound| bound.curves(most))
}
