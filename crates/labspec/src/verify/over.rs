//! Tests an answer over ranges of sliders.
//!
//! The corners come first: all of them where there are few, else a pairwise covering design. Then come the middles, and a
//! search for a counterexample. The search starts where the margin of the answer is smallest and steps in both directions
//! of each slider; it halves the step when no neighbour has a smaller margin (R. Hooke and T. A. Jeeves 1961). Every value
//! is one that a student can reach.

use super::bound::BoundVerify;
use super::format::significant;
use super::options::{SameOptions, compare_options};
use super::slider_effect::slider_changes_anything;
use super::survival::out_of_work;
use super::verdict::{Answer, Verdict, Weight};
use crate::finding::Finding;
use crate::json::{Number, Scalar};
use crate::pairwise;
use crate::rules;
use crate::run::{StepVariant, settings};
use crate::source::Text;
use crate::spec::{Control, ControlKind, Lab, Run, Verify};
use labspec_expr::Value;
use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;

/// All corners are run when there are at most this many.
const MAX_CORNERS: usize = 16;
/// Maximum number of rows of a covering design, and of settings of a search.
const ROWS: usize = 24;
const MAX_SEARCH_RUNS: usize = 40;
/// The first and the last step of the search, as fractions of the range.
const FIRST_STEP: f64 = 0.25;
const LAST_STEP: f64 = 1.0 / 64.0;

/// A slider and the values on its grid between the ends that the claim names.
struct SweptSlider<'v> {
    label: &'v Text,
    from: f64,
    step: f64,
    count: f64,
}

impl SweptSlider<'_> {
    /// The value at a fraction of the range: the nearest one that a student can reach.
    fn at(&self, part: f64) -> f64 {
        let x = self.from + (part * self.count).round() * self.step;
        format!("{x:.12}").parse().unwrap_or(x)
    }
}

/// Tests a true answer over the whole range that it is claimed for.
pub(super) fn hold_over_range(
    bound: &BoundVerify<'_>,
    verify: &Verify,
    place: Range<usize>,
    answer: &mut Answer,
    findings: &mut Vec<Finding>,
) {
    let axes = match axes_of(bound, verify, findings) {
        Ok(axes) => axes,
        Err(reason) => {
            *answer = Answer::failed(reason);
            return;
        }
    };
    if let Some(label) = never_varied(bound, verify) {
        findings.push(set_by_every_run(label));
        *answer = Answer::failed("the range of `over` was not tested");
        return;
    }
    let mut space = Space {
        bound,
        verify,
        axes,
        weights: answer.weights.clone(),
        tried: BTreeMap::new(),
        seen: BTreeSet::new(),
    };
    match space.search(findings) {
        None => *answer = Answer::failed("a run in the range of `over` cannot be executed"),
        Some(Some((setting, how))) => {
            let message = format!("the answer is false with {setting}: {how}");
            findings.push(
                Finding::error(rules::COUNTEREXAMPLE, place, message.clone())
                    .why("a student can set the lab like this, and sees something different from the keyed answer")
                    .help("narrow the range under `over`, or ask about something that holds everywhere in it"),
            );
            (answer.verdict, answer.reason) = (Verdict::Refuted, message);
        }
        Some(None) => match space.without_effect() {
            Some(axis) => {
                findings.push(slider_without_effect(axis.label));
                *answer = Answer::failed("the conditions do not read the range of `over`");
            }
            None => space.add_coverage(answer),
        },
    }
}

/// The sliders of the range. The reason why one cannot be tested is added to `findings`.
///
/// # Errors
/// The reason for the verdict of the answer.
fn axes_of<'v>(
    bound: &BoundVerify<'_>,
    verify: &'v Verify,
    findings: &mut Vec<Finding>,
) -> Result<Vec<SweptSlider<'v>>, &'static str> {
    let Some(lab) = bound.lab().map(|scene| scene.lab.clone()) else {
        return Err("the lab does not have the sliders of `over`");
    };
    let axes: Result<Vec<SweptSlider<'_>>, Box<Finding>> =
        verify.over.iter().map(|(label, ends)| axis(&lab, label, *ends)).collect();
    axes.map_err(|wrong| {
        findings.push(*wrong);
        "the range of `over` cannot be tested"
    })
}

/// A slider that every run sets itself, among the runs that the conditions read. A run keeps the values that it sets, so
/// the range would never be tested.
fn never_varied<'v>(bound: &BoundVerify<'_>, verify: &'v Verify) -> Option<&'v Text> {
    let read = bound.runs_read(&verify.options);
    let always_set = |label: &Text| {
        let sets = |run: &&Run| run.set.iter().any(|(set, _)| set.value == label.value);
        let mut runs = verify.runs.iter().filter(|run| read.contains(run.name.value.as_str()));
        !verify.runs.is_empty() && runs.all(|run| sets(&run))
    };
    verify.over.iter().map(|(label, _)| label).find(|label| always_set(label))
}

fn set_by_every_run(label: &Text) -> Finding {
    Finding::error(
        rules::RUN_IMPOSSIBLE,
        label.span(),
        format!(
            "every run that the conditions read sets \"{}\" itself, so no other value is tested",
            label.value
        ),
    )
    .why("a run keeps what it sets, so the answer would be claimed for values that were never tested")
    .help("remove it from the `set` of the runs that should test it")
}

fn slider_without_effect(label: &Text) -> Finding {
    Finding::error(
        rules::RUN_IMPOSSIBLE,
        label.span(),
        format!("\"{}\" changes nothing in the runs that the conditions read", label.value),
    )
    .why("the answer would be claimed over a range that does not affect the measures")
    .help("name a slider that these runs depend on, or remove it from `over`")
}

/// A slider with the values of the range.
fn axis<'v>(lab: &Lab, label: &'v Text, ends: [f64; 2]) -> Result<SweptSlider<'v>, Box<Finding>> {
    let wrong = |what: String| {
        let finding = Finding::error(rules::RUN_IMPOSSIBLE, label.span(), what)
            .why("the checker tests only what a student can do")
            .help("name a slider of the lab, and ends that it can reach");
        Box::new(finding)
    };
    let control = lab.control(&label.value);
    let Some(Control { kind: ControlKind::Slider { min, max, .. }, .. }) = control else {
        return Err(wrong(format!("\"{}\" is not a slider of the lab", label.value)));
    };
    let step = control.and_then(Control::step).filter(|s| *s > 0.0).unwrap_or((ends[1] - ends[0]) / 1000.0);
    let slack = 1e-9 * step;
    let from = min.value + ((ends[0] - min.value - slack) / step).ceil() * step;
    let to = min.value + ((ends[1] - min.value + slack) / step).floor() * step;
    let reached = ends[0] >= min.value - slack && ends[1] <= max.value + slack && to > from;
    let values = [from, to].map(|x| format!("{x:.12}").parse::<f64>().unwrap_or(x));
    let can = |x: &f64| control.is_some_and(|c| settings::value(c, &Value::Number(*x)).is_ok());
    if !reached || !values.iter().all(can) {
        return Err(wrong(format!(
            "the slider \"{}\" goes from {} to {} in steps of {}: fewer than two of its values are from {} to {}",
            label.value,
            significant(min.value),
            significant(max.value),
            significant(step),
            significant(ends[0]),
            significant(ends[1])
        )));
    }
    Ok(SweptSlider { label, from, step, count: ((to - from) / step).round() })
}

/// The tested settings.
struct Space<'b, 's, 'v> {
    bound: &'b BoundVerify<'s>,
    verify: &'v Verify,
    axes: Vec<SweptSlider<'v>>,
    weights: Vec<Weight>,
    /// The margin of the answer by the bits of the slider values.
    tried: BTreeMap<Vec<u64>, f64>,
    /// The numbers that the conditions read in each setting, as bits.
    seen: BTreeSet<Vec<u64>>,
}

/// A setting in words, and the condition that fails there.
type Counterexample = (String, String);

impl Space<'_, '_, '_> {
    /// A counterexample, if there is one. `None` when a run cannot be executed.
    fn search(&mut self, findings: &mut Vec<Finding>) -> Option<Option<Counterexample>> {
        let levels = vec![2; self.axes.len()];
        let corners = match 1usize.checked_shl(levels.len() as u32) {
            Some(n) if n <= MAX_CORNERS => pairwise::all(&levels),
            _ => pairwise::pairwise(&levels, ROWS).0,
        };
        let mut starts: Vec<Vec<f64>> =
            corners.iter().map(|row| row.iter().map(|k| *k as f64).collect()).collect();
        starts.push(vec![0.5; self.axes.len()]);
        let mut best: Option<(f64, Vec<f64>)> = None;
        for parts in starts {
            let (turned, margin) = self.evaluate_at(&parts, findings)?;
            if turned.is_some() {
                return Some(turned);
            }
            if best.as_ref().is_none_or(|(least, _)| margin < *least) {
                best = Some((margin, parts));
            }
        }
        let (mut least, mut here) = best?;
        let (mut step, before) = (FIRST_STEP, self.tried.len());
        while step >= LAST_STEP && self.tried.len() < before + MAX_SEARCH_RUNS {
            let mut nearer = false;
            for k in 0..self.axes.len() {
                for offset in [-step, step] {
                    let mut there = here.clone();
                    if let Some(part) = there.get_mut(k) {
                        *part = (*part + offset).clamp(0.0, 1.0);
                    }
                    let (turned, margin) = self.evaluate_at(&there, findings)?;
                    if turned.is_some() {
                        return Some(turned);
                    }
                    if margin < least {
                        (least, here, nearer) = (margin, there, true);
                    }
                }
            }
            if !nearer {
                step /= 2.0;
            }
        }
        Some(None)
    }

    /// A counterexample if the answer is false in a setting, and the margin there.
    fn evaluate_at(
        &mut self,
        parts: &[f64],
        findings: &mut Vec<Finding>,
    ) -> Option<(Option<Counterexample>, f64)> {
        let values: Vec<f64> = self.axes.iter().zip(parts).map(|(axis, part)| axis.at(*part)).collect();
        let key: Vec<u64> = values.iter().map(|x| x.to_bits()).collect();
        if let Some(margin) = self.tried.get(&key) {
            return Some((None, *margin));
        }
        let verify = self.with(&values);
        let (labs, stage) = (self.bound.labs(), self.bound.stage());
        let base = self.bound.lab().cloned();
        let labs = if self.verify.runs.is_empty() { vec![base.clone().into_iter().collect()] } else { labs };
        let again = BoundVerify::new(&verify, base.as_ref(), &labs, stage, findings)?;
        let outcome = again.outcome(StepVariant::NOMINAL, findings)?;
        let same = compare_options(&again, &outcome, &verify, &self.weights);
        // A run that ended because the work budget ran out does not test the answer.
        if !matches!(same, SameOptions::Yes(_)) && stage.left() == 0 {
            findings.push(out_of_work(self.verify.span.clone(), "everywhere in its range"));
            return None;
        }
        let one = |(axis, x): (&SweptSlider<'_>, &f64)| format!("\"{}\" at {x}", axis.label.value);
        let setting = self.axes.iter().zip(&values).map(one).collect::<Vec<_>>().join(", ");
        self.seen.insert(again.read_by(&outcome, &self.verify.options));
        match same {
            SameOptions::Yes(margin) => {
                self.tried.insert(key, margin);
                Some((None, margin))
            }
            SameOptions::No(how) => Some((Some((setting, how)), f64::NEG_INFINITY)),
            SameOptions::Open(why) => {
                findings.push(
                    Finding::error(
                        rules::RUN_IMPOSSIBLE,
                        self.verify.span.clone(),
                        format!("it is undecided whether the answer holds with {setting}: {why}"),
                    )
                    .why("the answer is claimed over a range, but nothing decides it here")
                    .help("narrow the range under `over`, or measure something that has a value everywhere in it"),
                );
                None
            }
        }
    }

    /// A slider that has no effect on the simulation.
    fn without_effect(&self) -> Option<&SweptSlider<'_>> {
        let changes = |axis: &SweptSlider<'_>| {
            slider_changes_anything(self.bound, axis.label, axis.at(0.0), axis.at(1.0))
        };
        self.axes.iter().find(|axis| !changes(axis))
    }

    /// Adds to the reason in how many settings the answer holds.
    fn add_coverage(&self, answer: &mut Answer) {
        let count = self.tried.len();
        let same = if self.seen.len() == 1 { ", and the measures are the same in all of them" } else { "" };
        let also = format!("it also holds in {count} settings over its range{same}");
        answer.reason = match answer.reason.as_str() {
            "" => also,
            reason => format!("{reason}; {also}"),
        };
    }

    /// The object with these slider values. A run that sets a slider itself keeps its own value.
    fn with(&self, values: &[f64]) -> Verify {
        let mut verify = Verify { over: Vec::new(), ..self.verify.clone() };
        if verify.runs.is_empty() {
            verify.runs.push(Run::named("run"));
        }
        for run in &mut verify.runs {
            for (axis, x) in self.axes.iter().zip(values) {
                if !run.set.iter().any(|(label, _)| label.value == axis.label.value) {
                    run.set.push((
                        axis.label.clone(),
                        Scalar::Number(Number { value: *x, span: axis.label.span() }),
                    ));
                }
            }
        }
        verify
    }
}
