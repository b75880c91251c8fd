//! Describes faults in the same words for `run`, `check` and `stability`, and tests shorter timesteps as a remedy.

use super::case::{RunOutcome, StressCase};
use super::drift::without_pushed_bodies;
use super::fault_groups::{rule_of, worst_fault};
use super::interaction::{Action, Interaction, InteractionKind};
use crate::bind::Programs;
use crate::rules::{self, Rule};
use crate::run::{self, Breakdown, Play, RunError, RunOptions, Session, ShorterTimestep, StartedRun, Table};
use crate::spec::{ControlKind, Lab};
use labspec_core::Model;
use labspec_expr::Value;
use labspec_monitors::stress::{Fault, FaultKind};
use std::ops::ControlFlow;

/// Number of tested halvings of the timestep, work budget of one run, and of all of them.
const MAX_HALVINGS: i32 = 8;
const WORK_OF_RUN: u64 = 300_000_000;
const WORK: u64 = 1_000_000_000;

/// Describes a fault that the run itself does not report; `None` for the others.
pub(crate) fn describe(fault: &Fault) -> Option<Breakdown> {
    let (rule, what, why): (&'static Rule, &str, &'static str) = match fault.kind {
        _ if fault.by_run => return None,
        FaultKind::Silent => (
            rules::RUNS_AWAY,
            "runs away",
            "every number stays within the limits of the engine, so there is no warning: a student sees something leave the picture",
        ),
        FaultKind::Tunnels => (
            rules::PASSES_THROUGH,
            "pass",
            "no step finds them in contact in time: a student sees one pass through the other",
        ),
        FaultKind::Penetrates => (
            rules::PRESSED_DEEP,
            "are pressed deep into each other",
            "a student who finds this setting sees bodies inside each other; the text may intend it, or it may be an accident",
        ),
        FaultKind::Chatters => (
            rules::CHATTERS,
            "touch and separate again and again, while nothing moves",
            "forces that jump from step to step come from the timestep, so a plot of them shows only noise",
        ),
        FaultKind::Drifts => (
            rules::CREEPS,
            "creeps, although it seems to rest",
            "a student who waits sees the body slide, even if the text says that friction holds it",
        ),
        _ => return None,
    };
    Some(Breakdown {
        rule,
        what: format!("{} {what} at t = {} s", fault.subject, run::time(fault.time)),
        why,
        cause: Some(fault.cause.clone()),
        shorter: ShorterTimestep::No,
        instead: "run `labspec stability`, which makes these runs longer and tests remedies".into(),
    })
}

/// The same breakdown with a tested timestep: the longest with which the run has no fault. The work is subtracted from
/// `left`.
pub(crate) fn with_tried_timestep(
    case: &StressCase<'_>,
    interaction: &Interaction,
    length: f64,
    mut breakdown: Breakdown,
    left: &mut u64,
) -> Breakdown {
    let ShorterTimestep::Maybe(theory) = breakdown.shorter else { return breakdown };
    let timestep = case.start(interaction, WORK_OF_RUN).world.model.opt.timestep;
    let halved = (1..=MAX_HALVINGS).map(|k| timestep * 0.5f64.powi(k));
    let mut candidates: Vec<f64> =
        theory.into_iter().chain(halved).map(rounded_down).filter(|h| *h > 0.0 && *h < timestep).collect();
    candidates.sort_by(|a, b| b.total_cmp(a));
    candidates.dedup();
    let mut budget = WORK.min(*left);
    for h in candidates {
        let change = move |session: &mut Session<'_>| *session.world.model.edit().opt.timestep = h;
        let outcome = case.run(interaction, Some(&change), length, WORK_OF_RUN.min(budget));
        budget = budget.saturating_sub(outcome.spent);
        *left = left.saturating_sub(outcome.spent);
        if !has_no_fault(&outcome, breakdown.rule) {
            // An incomplete run tests neither this timestep nor shorter ones, which need more work.
            if outcome.cut {
                return breakdown;
            }
            continue;
        }
        if !outcome.cut {
            breakdown.shorter = ShorterTimestep::Tested(h);
        }
        return breakdown;
    }
    breakdown.shorter = ShorterTimestep::Useless;
    breakdown
}

/// The same breakdown with a tested end of a slider: the next value with which the run has no fault, where no timestep helps. The
/// work is subtracted from `left`.
pub(crate) fn with_tried_end(
    case: &StressCase<'_>,
    lab: &Lab,
    interaction: &Interaction,
    length: f64,
    mut breakdown: Breakdown,
    left: &mut u64,
) -> Breakdown {
    let (ShorterTimestep::No, [action]) = (&breakdown.shorter, interaction.actions.as_slice()) else {
        return breakdown;
    };
    let Some(control) = lab.controls.get(action.control) else { return breakdown };
    let (ControlKind::Slider { min, max, .. }, Some(step)) = (&control.kind, control.step()) else {
        return breakdown;
    };
    let Some(Value::Number(value)) = action.value else { return breakdown };
    let (key, next) = match value {
        x if x == min.value => ("min", min.value + step),
        x if x == max.value => ("max", max.value - step),
        _ => return breakdown,
    };
    // The value that is run is the one that is printed.
    let next: f64 = format!("{next:.12e}").parse().unwrap_or(next);
    if !(min.value..=max.value).contains(&next) {
        return breakdown;
    }
    let inside = Interaction {
        actions: vec![Action { value: Some(Value::Number(next)), ..action.clone() }],
        ..interaction.clone()
    };
    let outcome = case.run(&inside, None, length, WORK_OF_RUN.min(*left));
    *left = left.saturating_sub(outcome.spent);
    if !outcome.cut && has_no_fault(&outcome, breakdown.rule) {
        breakdown.instead = format!(
            "write \"{key}\": {next} for this slider: the run is fine with it; or {}",
            breakdown.instead
        );
    }
    breakdown
}

/// Whether a run has no fault except drift, and not the reported one.
fn has_no_fault(outcome: &RunOutcome, rule: &Rule) -> bool {
    let same = |f: &Fault| rule_of(f.kind).is_some_and(|r| r.code == rule.code);
    worst_fault(&outcome.faults, &[]).is_none() && !outcome.faults.iter().any(same)
}

/// Rounds down to two digits.
fn rounded_down(x: f64) -> f64 {
    if !(x.is_finite() && x > 0.0) {
        return 0.0;
    }
    let unit = 10f64.powf(x.log10().floor() - 1.0);
    let digits = (x / unit + 1e-9).floor();
    format!("{:.3e}", digits * unit).parse().unwrap_or(x)
}

/// [`run::run`] with the monitors of `check` and `stability`, and with tested timesteps.
///
/// # Errors
/// A control that does not exist, a setting that a student cannot choose, or a run that is too long.
pub fn watched_run(
    lab: &Lab,
    model: &Model,
    programs: &Programs,
    options: &RunOptions,
) -> Result<Table, RunError> {
    let base = Interaction::base(lab, programs, &options.set, &options.press)?;
    let case = StressCase::new(lab, model, programs, base.clone());
    let mut started = run::begin(lab, model, programs, options, &case.access)?;
    let presses: Vec<Action> =
        started.presses.iter().map(|&(control, time)| Action { time, control, value: None }).collect();
    let pressed = Interaction { kind: InteractionKind::AsItStands, actions: presses };
    let StartedRun { session, samples, steps, stop, every, .. } = &mut started;
    let (steps, stop, every) = (*steps, *stop, *every);
    let mut watcher = case.table_watcher(&pressed, session);
    let played = Play { stop, watched: true, ..Play::steps(steps) };
    let made = run::play(session, &played, |session, made| {
        if made == 0 {
            watcher.press_at_start(session);
        }
        let is_over = played.is_over(session, made);
        let sampled = if made.is_multiple_of(every) || is_over {
            run::take(samples, session)
        } else {
            ControlFlow::Continue(())
        };
        watcher.observe(session, made, is_over);
        sampled
    });
    let timestep = started.session.world.model.opt.timestep;
    let (length, faults) = (made.min(steps) as f64 * timestep, watcher.faults(&started.session));
    let mut left = WORK;
    let (faults, _) = without_pushed_bodies(&case, &base, faults, length, left);
    let mut table = run::finish(started, made)?;
    for breakdown in &mut table.breakdowns {
        *breakdown = with_tried_timestep(&case, &base, length, breakdown.clone(), &mut left);
    }
    let described = faults.iter().filter_map(|f| {
        let breakdown = describe(f)?;
        Some(Breakdown { what: format!("{} ({})", breakdown.what, f.measured()), ..breakdown })
    });
    table.breakdowns.extend(described);
    Ok(table)
}
