//! The outcome of a `verify` object: its measures and searches, under all numerics that its claims need.

use super::bound::BoundVerify;
use super::bound_run::BoundRun;
use super::numerics::{CHANGES, PERTURBED, Perturbation, QuotedChange};
use super::outcome::MeasuredRuns;
use super::search::{self, SearchCase};
use crate::finding::Finding;
use crate::rules;
use crate::run::StepVariant;
use crate::spec::{Find, Verify};

impl BoundVerify<'_> {
    /// Executes every run, evaluates every measure and makes every search. `None` when a run cannot be executed.
    pub(super) fn outcome(&self, numerics: StepVariant, findings: &mut Vec<Finding>) -> Option<MeasuredRuns> {
        let mut outcome = self.outcome_of_runs(numerics, findings)?;
        for find in &self.verify.find {
            let limit = self.search(find, numerics, findings)?;
            outcome.found.push((find.name.value.clone(), limit.value));
            outcome.other_ends.push(limit.other_end);
            outcome.looked.push(limit.looked);
        }
        Some(outcome)
    }

    /// Searches for a value; `None` when a run cannot be executed, NaN when there is no such value, which is reported.
    fn search(
        &self,
        find: &Find,
        numerics: StepVariant,
        findings: &mut Vec<Finding>,
    ) -> Option<search::SearchLimit> {
        let Some(case) = self.search_case(find) else {
            let place = find.run.as_ref().unwrap_or(&find.name).span();
            findings.push(
                Finding::error(rules::RUN_IMPOSSIBLE, place, "a search needs a single run, not a sweep")
                    .help("name the run: \"run\": \"coarse\""),
            );
            return None;
        };
        search::search(&case, self.stage, numerics, findings)
    }

    /// Lints the conditions of all searches without executing runs.
    pub(super) fn lint_searches(&self, findings: &mut Vec<Finding>) {
        for case in self.verify.find.iter().filter_map(|find| self.search_case(find)) {
            search::lint_condition(&case, self.stage, findings);
        }
    }

    /// A search with its run and its lab; `None` if it has several runs.
    fn search_case<'s>(&'s self, find: &'s Find) -> Option<SearchCase<'s>> {
        let named = |run: &&BoundRun<'_>| find.run.as_ref().is_none_or(|name| name.value == run.name);
        let mut runs = self.runs.iter().filter(named);
        let (Some(run), None) = (runs.next(), runs.next()) else { return None };
        let scene = &self.scene_of(run)?.scene;
        Some(SearchCase { find, run: run.spec, measure: &self.verify.measure, scene })
    }
}

/// Every measure of an object with one run; `None` where the run cannot be executed, or breaks.
pub fn measure_only_run(bound: &BoundVerify<'_>, numerics: StepVariant) -> Option<Vec<f64>> {
    let outcome = bound.outcome(numerics, &mut Vec::new())?;
    let run = outcome.runs.into_iter().next().filter(|run| run.broke.is_none())?;
    Some(run.measures.into_iter().map(|(_, x)| x).collect())
}

/// The outcomes of a `verify` object under all numerics that its claims need.
pub(super) struct Outcomes {
    pub(super) nominal: MeasuredRuns,
    /// In the order of [`PERTURBED`](super::numerics::PERTURBED); `None` where no claim needs them.
    pub(super) perturbed: [Option<MeasuredRuns>; CHANGES],
}

impl Outcomes {
    /// Every outcome under perturbed numerics, with these numerics.
    pub(super) fn under_perturbations(&self) -> impl Iterator<Item = (&MeasuredRuns, Perturbation)> {
        let pairs = self.perturbed.iter().zip(PERTURBED);
        pairs.filter_map(|(outcome, perturbation)| Some((outcome.as_ref()?, perturbation)))
    }

    /// The outcomes in which a change of a quoted value has this meaning, with the names of the numerics.
    pub(super) fn quoted(&self, change: QuotedChange) -> impl Iterator<Item = (&MeasuredRuns, &'static str)> {
        let quoted = self.under_perturbations().filter(move |(_, p)| p.quoted == Some(change));
        quoted.map(|(outcome, perturbation)| (outcome, perturbation.how))
    }
}

/// Executes every run under all numerics that are needed.
pub(super) fn run_all_numerics(
    bound: &BoundVerify<'_>,
    verify: &Verify,
    findings: &mut Vec<Finding>,
) -> Option<Outcomes> {
    let nominal = bound.outcome(StepVariant::NOMINAL, findings)?;
    let answers = verify.claims_answer();
    let quotes = !verify.says.is_empty() || !verify.table.is_empty();
    let needed = |perturbation: &Perturbation| answers || quotes && perturbation.quoted.is_some();
    let mut perturbed = [const { None }; CHANGES];
    let about_numerics = bound.states_every_timestep();
    for (outcome, perturbation) in perturbed.iter_mut().zip(PERTURBED).filter(|(_, p)| needed(p)) {
        let Perturbation { numerics, how, .. } = perturbation;
        let same = about_numerics && (numerics.timestep != 1.0 || numerics.integrator.is_some());
        let mut refused = Vec::new();
        *outcome = if same { Some(nominal.clone()) } else { bound.outcome(numerics, &mut refused) };
        if outcome.is_none() {
            // A failure here that the nominal run does not have: the run takes too long.
            findings.extend(refused.into_iter().take(1).map(|f| {
                let message = format!("{how}: {}", f.message);
                Finding { message, ..f }
            }));
            return None;
        }
    }
    Some(Outcomes { nominal, perturbed })
}
