//! A lab with the values of all measures.

use super::candidates::{Candidate, candidates};
use super::restored;
use super::trials::{TraceRun, trials};
use super::words::text;
use labspec::bind::Programs;
use labspec::bind::scene::Models;
use labspec::check;
use labspec::run::StepVariant;
use labspec::spec::{Lab, LabAddress, Lesson, Verify};
use labspec::verify::{self, BoundLab, BoundVerify, RunCache, Stated};
use labspec_core::Model;
use std::collections::BTreeMap;
use std::ops::Range;
use std::sync::Arc;

/// A lab with the values of all measures.
pub(crate) struct TracedLab<'l> {
    pub(crate) address: LabAddress,
    pub(crate) lab: &'l Lab,
    /// The question to which it belongs.
    pub(crate) owner: Option<Range<usize>>,
    model: Arc<Model>,
    programs: Programs,
    pub(crate) trials: Vec<TraceRun>,
    pub(crate) candidates: Vec<Candidate>,
    /// The value of every candidate in every trial; NaN if there is none.
    pub(crate) values: Vec<Vec<f64>>,
    /// The candidates for values of the start, by the expression with its closing bracket.
    initial: BTreeMap<String, usize>,
}

impl<'l> TracedLab<'l> {
    /// The candidate for the value of the start of an expression with its closing bracket: `data.qpos[0])`.
    pub(crate) fn initial(&self, inner: &str) -> Option<usize> {
        self.initial.get(inner).copied()
    }

    /// Whether any measure has a value in any trial, if there are measures.
    pub(super) fn has_values(&self) -> bool {
        let mut values = self.values.iter().flatten().peekable();
        values.peek().is_none() || values.any(|x| x.is_finite())
    }

    /// Whether a value is a limit of an actuator or a joint of the model. A force with this value says nothing about a run.
    pub(crate) fn is_limit(&self, value: f64) -> bool {
        let m = &self.model;
        let lists = [&m.actuator_forcerange, &m.actuator_ctrlrange, &m.jnt_actfrcrange, &m.jnt_range];
        let mut limits = lists.into_iter().flat_map(|list| list.iter().copied());
        limits.any(|x| x != 0.0 && (x.abs() - value.abs()).abs() <= 1e-9 * x.abs())
    }

    /// Performs the runs of a lab that the text names, and evaluates all measures; `None` if the lab cannot run.
    pub(super) fn measure(
        lesson: &Lesson,
        (address, lab): (LabAddress, &'l Lab),
        numbers: &[Stated],
        models: &Models,
        stage: &RunCache<'_>,
    ) -> Option<TracedLab<'l>> {
        let (model, programs, _) = check::bind(lab, models, &mut Vec::new())?;
        let questions = lesson.quizzes.iter().flat_map(|quiz| quiz.numbered());
        let owner = questions.map(|(_, q)| q.span.clone()).find(|span| span.contains(&lab.span.start));
        let trials = restored::with(trials(lab, numbers), lab, &model, &programs);
        let candidates = candidates(lab, &model, &programs, numbers);
        let starts = candidates.iter().enumerate();
        let starts = starts.filter_map(|(i, c)| Some((c.text.strip_prefix("initial(")?.to_string(), i)));
        let initial = starts.collect();
        let values = Vec::new();
        let mut traced =
            TracedLab { address, lab, owner, model, programs, trials, candidates, values, initial };
        traced.values =
            traced.trials.iter().map(|t| traced.values_of(t, stage, StepVariant::NOMINAL)).collect();
        Some(traced)
    }

    /// Performs a run of the lab, and evaluates all measures. A run that fails has no values.
    pub(crate) fn values_of(
        &self,
        trial: &TraceRun,
        stage: &RunCache<'_>,
        numerics: StepVariant,
    ) -> Vec<f64> {
        let TracedLab { lab, model, programs, candidates, .. } = self;
        let none = || vec![f64::NAN; candidates.len()];
        let name = |i: usize| text(&format!("m{i}"));
        let measure = candidates.iter().enumerate().map(|(i, c)| (name(i), text(&c.text))).collect();
        let verify = Verify::measuring(0..0, vec![trial.run("run")], measure);
        let scene = BoundLab::new(lab, model, programs);
        let bound = BoundVerify::new(&verify, None, &[vec![scene]], stage, &mut Vec::new());
        let found = bound.and_then(|bound| verify::measure_only_run(&bound, numerics));
        found.filter(|values| values.len() == candidates.len()).unwrap_or_else(none)
    }
}
