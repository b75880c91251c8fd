//! Further interactions with a lab that has no fault as loaded and with each control at its ends: a push, several controls
//! at their ends, buttons in order, all controls in turn during the run, ten times the usual length, and then twice the
//! timestep. These are the runs of `labspec stability`, within the work budget of a check.

use super::{LabRunState, Trial, attempt};
use crate::finding::Finding;
use crate::rules;
use crate::run::Budget;
use crate::spec::Lab;
use crate::stress::{self, FaultGroup, Interaction, InteractionKind};

/// Factor of the length of the last run.
const LENGTH_FACTOR: f64 = 10.0;

/// No interaction.
pub(super) fn nothing() -> Interaction {
    Interaction { kind: InteractionKind::AsItStands, actions: Vec::new() }
}

/// Makes these runs within the budget, and reports the faults of all runs.
pub(super) fn go_on(state: &mut LabRunState<'_>, left: &mut u64, findings: &mut Vec<Finding>) {
    let completed = state.tried.as_ref().is_some_and(|t| t.runs > 0 && t.ended.is_none());
    if !state.has_no_remedy && completed {
        try_more(state, left, findings);
    }
    findings.extend(state.faults.iter().filter_map(|found| finding_of(found, state)));
}

fn try_more(state: &mut LabRunState<'_>, left: &mut u64, findings: &mut Vec<Finding>) {
    let (interactions, missing) = list_interactions(state.ready.lab, state.requested);
    state.skip(missing);
    for (interaction, length) in interactions {
        let done = match interaction.kind {
            InteractionKind::AsItStands => "as it stands, in a long run".to_string(),
            _ => interaction.describe(&state.ready.programs),
        };
        let trial = Trial { interaction, length, done, control: None, moved: None };
        let budget = Budget { left: Budget::TRIAL.left.min(*left) };
        let mut of_trial = Vec::new();
        let made = match budget.left {
            0 => None,
            _ => attempt::make(state.ready, &state.case, &trial, budget, &mut state.seen, &mut of_trial).ok(),
        };
        let Some(attempt) = made else {
            state.skip(1);
            continue;
        };
        *left = left.saturating_sub(attempt.spent);
        // A fault that a simpler interaction shows is not reported again.
        of_trial.retain(|f| {
            let is_same = |other: &Finding| other.code == f.code && other.span == f.span;
            !findings.iter().any(is_same) && !state.is_shown_alone(f.code, &trial.interaction)
        });
        findings.extend(of_trial);
        if attempt.ended.is_some() {
            state.skip(1);
        } else if let Some(tried) = &mut state.tried {
            tried.runs += 1;
            tried.broke |= attempt.broke;
        }
        state.note(&trial, attempt.faults, left);
    }
    if state.tried.as_ref().is_some_and(|t| t.broke) {
        // A run shows the fault, so its prediction is redundant.
        findings.retain(|f| f.code != rules::STIFF_FOR_TIMESTEP.code);
    } else if state.tried.as_ref().is_some_and(|t| t.skipped == 0) {
        let made = state.tried.as_ref().map_or(0, |t| t.runs);
        let found =
            rules::near_its_limit::check_margin(state.ready, &state.case, &nothing(), state.requested, made);
        findings.extend(found);
    }
}

/// The interactions and their lengths, and the number of pairs of settings that no run covers.
fn list_interactions(lab: &Lab, requested: f64) -> (Vec<(Interaction, f64)>, usize) {
    let several = |h: &Interaction| {
        matches!(
            h.kind,
            InteractionKind::Touched
                | InteractionKind::InOrder
                | InteractionKind::Corner
                | InteractionKind::Interleaved
        )
    };
    let (all, missing) = stress::list_interactions(lab, requested, &nothing());
    let mut all: Vec<(Interaction, f64)> = all.into_iter().filter(several).map(|h| (h, requested)).collect();
    // A lab with a stop time is never run longer.
    if lab.stop_at.is_none() {
        all.push((nothing(), LENGTH_FACTOR * requested));
    }
    (all, missing)
}

/// A finding about a fault that the runs themselves do not report.
fn finding_of(found: &FaultGroup, state: &LabRunState<'_>) -> Option<Finding> {
    let FaultGroup { fault, interaction, settings, .. } = found;
    let breakdown = stress::describe(fault)?;
    let others = match settings {
        0 | 1 => String::new(),
        2 => ", and in another setting".into(),
        n => format!(", and in {} other settings", n - 1),
    };
    let done = interaction.describe(&state.ready.programs);
    let message = format!("{}, {done} ({}){others}", breakdown.what, fault.measured());
    let place = state.ready.lab.place();
    Some(Finding::plain(breakdown.rule, place, message).why(breakdown.why).help(breakdown.help()))
}
