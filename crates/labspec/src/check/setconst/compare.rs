//! Compares runs of a lab: unchanged, with its constants recomputed, and with coupled parameters corrected.

use super::SuspectProgram;
use super::advice::{self, SetConstAdvice};
use super::bench::{AmendedLab, BenchTrial, SampleRows, SetConstBench};
use super::difference::{PERTURBATION_FACTOR, SampleDifference};
use crate::bind::coupled::{PairSet, Repair};
use crate::run::StepVariant;
use crate::verify::HALVED;

/// A start with a perturbation that is smaller than any input resolution.
const PERTURBED_START: StepVariant = StepVariant { perturbation: 1e-9, ..StepVariant::NOMINAL };
/// Fraction of the range by which a repaired run may differ from the corrected one, because of the order of operations.
const ROUNDED: f64 = 1e-6;

/// The effects of a program in the runs of a lab.
pub(super) struct ProgramEffects {
    /// The effect of the constants, in words.
    pub(super) constants: Option<String>,
    /// The effect of the coupled parameters, in words, and the pairs that cause it; `None` where there is none.
    pub(super) partners: Option<(String, PairSet)>,
    /// The suggestion: how constants are recomputed, and the whole program where coupled parameters are corrected too.
    pub(super) advice: SetConstAdvice,
    pub(super) repaired: Option<String>,
    /// Why the effect of coupled parameters could not be tested.
    pub(super) untested: Option<String>,
}

/// The runs of one trial.
struct TrialRuns<'t> {
    trial: &'t BenchTrial,
    as_is: SampleRows,
    /// With constants recomputed.
    anew: SampleRows,
    /// With coupled parameters corrected too; `None` where that changes nothing, because none was omitted.
    corrected: Option<SampleRows>,
}

impl TrialRuns<'_> {
    /// The run with coupled parameters corrected.
    fn corrected(&self) -> &SampleRows {
        self.corrected.as_ref().unwrap_or(&self.anew)
    }
}

/// The variants of the lab.
struct LabVariants {
    /// Unchanged; observes coupled parameters.
    as_is: AmendedLab,
    /// With constants recomputed; `None` where the program does so. Observes coupled parameters.
    refreshed: Option<AmendedLab>,
    /// With all coupled parameters corrected too.
    coupled: Option<AmendedLab>,
    steps: usize,
}

impl SetConstBench<'_> {
    /// Makes all runs. `Err` states why constants could not be tested.
    pub(super) fn compare(&mut self, s: &SuspectProgram<'_>) -> Result<ProgramEffects, String> {
        let steps = self.steps(s)?;
        let trials = self.trials(s, steps);
        let as_is = self.observed(s, false);
        let refreshed = s.inertial.is_some().then(|| self.observed(s, true));
        let coupled = (!s.pairs.is_empty()).then(|| self.corrected(s, s.pairs));
        let variants = LabVariants { as_is, refreshed, coupled, steps };
        let (mut untested, mut uncoupled) = (None, None);
        let mut all: Vec<TrialRuns<'_>> = Vec::new();
        for trial in &trials {
            match self.runs(s, &variants, trial, &mut uncoupled) {
                Ok(runs) => all.push(runs),
                Err(reason) => untested = untested.or(Some(reason)),
            }
        }
        let constants = all.iter().find(|r| self.columns(s).difference(&r.as_is, &r.anew).is_some());
        if let (None, Some(reason), true) = (constants, &untested, s.inertial.is_some()) {
            return Err(reason.clone());
        }
        let mut partners = self.partners(s, &all, &variants);
        // If no run with this program alone omits a coupled parameter, a combination with another control can do so only
        // if the program reads what that control writes.
        let left = all.iter().any(|runs| runs.corrected.is_some()) || self.reads_of_others(s);
        let others = if partners.is_none() && left { self.combined(s) } else { Vec::new() };
        for trial in &others {
            let Ok(runs) = self.runs(s, &variants, trial, &mut None) else { continue };
            partners = self.partners(s, std::slice::from_ref(&runs), &variants);
            if partners.is_some() {
                all.push(runs);
                break;
            }
        }
        let matter = partners.as_ref().map_or(PairSet::NONE, |(_, pairs)| *pairs);
        if matter != s.pairs {
            let exactly = if matter.is_empty() { None } else { Some(self.corrected(s, matter)) };
            for runs in &mut all {
                let exactly = exactly.as_ref().filter(|_| runs.corrected.is_some());
                runs.corrected = exactly.and_then(|e| self.record(s, Some(e), runs.trial, steps).ok());
            }
        }
        let constants = all.iter().find_map(|r| {
            let columns = self.columns(s);
            let of_constants = columns.difference(&r.as_is, &r.anew)?;
            let difference =
                if matter.is_empty() { of_constants } else { columns.difference(&r.as_is, r.corrected())? };
            let and: String = matter.pairs().map(|(_, p)| format!(" and {}", p.corrected)).collect();
            Some(difference.describe(&r.trial.description, &format!("the constants recomputed{and}")))
        });
        let (advice, repaired) = self.choose_advice(s, matter, constants.is_some(), &all, steps);
        Ok(ProgramEffects { constants, partners, advice, repaired, untested: uncoupled })
    }

    /// The suggestion, and the corrected text if one gives the same runs.
    fn choose_advice(
        &mut self,
        s: &SuspectProgram<'_>,
        matter: PairSet,
        constants: bool,
        all: &[TrialRuns<'_>],
        steps: usize,
    ) -> (SetConstAdvice, Option<String>) {
        let repair = Repair::of_program(s.bound, matter, self.model()).filter(|_| !matter.is_empty());
        let both = [SetConstAdvice::Plain, SetConstAdvice::Keep];
        match &repair {
            None => {
                let source = advice::source(s);
                let plain = format!("{source}{}", SetConstAdvice::Plain.tail(&source));
                let good = matter.is_empty() && constants && self.gives(s, &plain, all, steps, 0.0);
                (if good { SetConstAdvice::Plain } else { SetConstAdvice::Keep }, None)
            }
            Some(repair) => {
                let texts = both.map(|advice| (advice, advice::repaired(s, repair, advice)));
                let good = texts.into_iter().find(|(_, text)| self.gives(s, text, all, steps, ROUNDED));
                good.map_or((SetConstAdvice::Keep, None), |(advice, text)| (advice, Some(text)))
            }
        }
    }

    /// The runs of one trial. If coupled parameters could not be corrected in it, the reason is stored in `uncoupled`.
    fn runs<'t>(
        &mut self,
        s: &SuspectProgram<'_>,
        variants: &LabVariants,
        trial: &'t BenchTrial,
        uncoupled: &mut Option<String>,
    ) -> Result<TrialRuns<'t>, String> {
        let describe = |reason: String| format!("{}, {reason}", trial.description);
        let steps = variants.steps;
        let (as_is, left) = self.observe(s, &variants.as_is, trial, steps).map_err(describe)?;
        let (anew, left) = match &variants.refreshed {
            Some(refreshed) => self.observe(s, refreshed, trial, steps).map_err(describe)?,
            None => (as_is.clone(), left),
        };
        let coupled = variants.coupled.as_ref().filter(|_| left);
        let corrected = match coupled.map(|c| self.record(s, Some(c), trial, steps)) {
            Some(Ok(rows)) => Some(rows),
            other => {
                *uncoupled = uncoupled.take().or(other.and_then(Result::err).map(describe));
                None
            }
        };
        Ok(TrialRuns { trial, as_is, anew, corrected })
    }

    /// Whether these statements in place of a program give the corrected runs, to this fraction of the range.
    fn gives(
        &mut self,
        s: &SuspectProgram<'_>,
        text: &str,
        all: &[TrialRuns<'_>],
        steps: usize,
        part: f64,
    ) -> bool {
        let Some(program) = self.amended(s, text) else { return false };
        all.iter().all(|runs| {
            let made = self.record(s, Some(&program), runs.trial, steps);
            let columns = self.columns(s);
            made.is_ok_and(|rows| match part > 0.0 {
                true => columns.close(runs.corrected(), &rows, part),
                false => columns.difference(runs.corrected(), &rows).is_none(),
            })
        })
    }

    /// The effect of correcting the coupled parameters in the first trial that shows one, and the pairs that cause it.
    fn partners(
        &mut self,
        s: &SuspectProgram<'_>,
        all: &[TrialRuns<'_>],
        variants: &LabVariants,
    ) -> Option<(String, PairSet)> {
        let columns = self.columns(s);
        let (refreshed, steps) = (variants.refreshed.as_ref(), variants.steps);
        let (runs, found): (&TrialRuns<'_>, SampleDifference) = all.iter().find_map(|runs| {
            let noise = || {
                let moved = self.record_under(s, refreshed, runs.trial, steps, PERTURBED_START).ok()?;
                let halved = self.record_under(s, refreshed, runs.trial, steps, HALVED).ok()?;
                Some(vec![(moved, PERTURBATION_FACTOR), (halved, 1.0)])
            };
            Some((runs, columns.mismatch(&runs.anew, runs.corrected.as_ref()?, noise)?))
        })?;
        let mut matter: PairSet = s.pairs;
        if s.pairs.pairs().count() > 1 {
            let without = |(one, _)| {
                let others = self.corrected(s, s.pairs.without(one));
                let rows = self.record(s, Some(&others), runs.trial, steps).ok()?;
                columns.mismatch(&rows, runs.corrected(), || Some(Vec::new())).map(|_| one)
            };
            let alone: PairSet = s.pairs.pairs().filter_map(without).collect();
            matter = if alone.is_empty() { s.pairs } else { alone };
        }
        let trial = match refreshed {
            Some(_) => format!("{} and the constants recomputed", runs.trial.description),
            None => runs.trial.description.clone(),
        };
        let with: Vec<&str> = matter.pairs().map(|(_, pair)| pair.corrected).collect();
        Some((found.describe(&trial, &with.join(" and ")), matter))
    }
}
