//! Whatever else a student may do to a lab that is sound as it stands and with each control at its ends: a touch, several controls
//! at their ends, buttons in order, everything in turn while it runs, and ten times as long as anybody looks; then twice the
//! timestep. What `labspec stability` does, as far as a check may work.

use super::{LabRunState, Trial, attempt};
use crate::finding::{Finding, Severity};
use crate::printable::counted;
use crate::rules;
use crate::run::{self, Budget, Session};
use crate::spec::Lab;
use crate::stress::{self, Fault, FaultGroup, FaultKind, Interaction, Kind};
use labspec_core::reflect::option;

/// How many times longer than anybody looks the last run is.
const LONGER: f64 = 10.0;
/// Work for a run at twice the timestep.
const TWICE: Budget = Budget { left: 300_000_000 };

/// Nothing is done.
pub(super) fn nothing() -> Interaction {
    Interaction { kind: Kind::AsItStands, actions: Vec::new() }
}

/// Makes these runs, while something is left, and reports what was seen in all of them.
pub(super) fn go_on(tour: &mut LabRunState<'_>, left: &mut u64, findings: &mut Vec<Finding>) {
    let sound = tour.tried.as_ref().is_some_and(|t| t.runs > 0 && t.ended.is_none());
    if !tour.hopeless && sound {
        try_more(tour, left, findings);
    }
    findings.extend(tour.faults.iter().filter_map(|found| finding_of(found, tour)));
}

fn try_more(tour: &mut LabRunState<'_>, left: &mut u64, findings: &mut Vec<Finding>) {
    let (handlings, missing) = handlings(tour.ready.lab, tour.wanted);
    tour.skip(missing);
    for (handling, length) in handlings {
        let done = match handling.kind {
            Kind::AsItStands => "as it stands, in a long run".to_string(),
            _ => handling.describe(&tour.ready.programs),
        };
        let trial = Trial { handling, length, done, control: None, moved: None };
        let budget = Budget { left: Budget::TRIAL.left.min(*left) };
        let mut of_trial = Vec::new();
        let made = match budget.left {
            0 => None,
            _ => attempt::make(tour.ready, &tour.case, &trial, budget, &mut tour.seen, &mut of_trial).ok(),
        };
        let Some(attempt) = made else {
            tour.skip(1);
            continue;
        };
        *left = left.saturating_sub(attempt.spent);
        // What a simpler setting has shown already is not told again.
        of_trial
            .retain(|f| !findings.iter().any(|reported| reported.code == f.code && reported.span == f.span));
        findings.extend(of_trial);
        if attempt.ended.is_some() {
            tour.skip(1);
        } else if let Some(tried) = &mut tour.tried {
            tried.runs += 1;
            tried.broke |= attempt.broke;
        }
        tour.note(&trial, attempt.faults, left);
    }
    if tour.tried.as_ref().is_some_and(|t| t.broke) {
        // A run shows it now.
        findings.retain(|f| f.code != rules::STIFF_FOR_TIMESTEP.code);
    } else if tour.tried.as_ref().is_some_and(|t| t.skipped == 0) {
        findings.extend(near_its_limit(tour));
    }
}

/// What is done, and for how long; and how many pairs of settings meet in no run, as there are too many.
fn handlings(lab: &Lab, wanted: f64) -> (Vec<(Interaction, f64)>, usize) {
    let several =
        |h: &Interaction| matches!(h.kind, Kind::Touched | Kind::InOrder | Kind::Corner | Kind::Interleaved);
    let (all, missing) = stress::list_interactions(lab, wanted, &nothing());
    let mut all: Vec<(Interaction, f64)> = all.into_iter().filter(several).map(|h| (h, wanted)).collect();
    // What a lab stops before is seen by nobody.
    if lab.stop_at.is_none() {
        all.push((nothing(), LONGER * wanted));
    }
    (all, missing)
}

/// A lab that breaks at twice its timestep.
fn near_its_limit(tour: &LabRunState<'_>) -> Option<Finding> {
    let writes = |effects: &labspec_expr::Effects| {
        effects.writes_everything
            || effects.writes.iter().any(|w| w.field.0 as usize == option::timestep.index())
    };
    // Where a control chooses it, its ends were run.
    if tour.ready.programs.bound().any(|b| writes(b.program.effects())) {
        return None;
    }
    let twice = |session: &mut Session<'_>| *session.world.model.edit().opt.timestep *= 2.0;
    let outcome = tour.case.run(&nothing(), Some(&twice), tour.wanted, TWICE.left);
    let breaks = |f: &&Fault| matches!(f.kind, FaultKind::Diverges | FaultKind::Grows | FaultKind::Silent);
    let fault = outcome.faults.iter().find(breaks)?;
    let h = tour.ready.model.opt.timestep;
    let message = format!(
        "this lab breaks at twice its timestep of {} s: {}, {}, at t = {} s",
        run::two_digits(h),
        fault.who,
        fault.kind.description(),
        run::time(fault.time)
    );
    Some(
        Finding::plain(rules::NEAR_ITS_LIMIT, tour.ready.lab.place(), message)
            .why(format!("at its own timestep its {} were fine, but a slightly stiffer model or a page with longer steps breaks it", runs(tour)))
            .help(format!("{}; `labspec stability --margins` finds how far every value can be raised", fault.cause)),
    )
}

fn runs(tour: &LabRunState<'_>) -> String {
    counted(tour.tried.as_ref().map_or(0, |t| t.runs), "run")
}

/// What was seen beside that of which runs speak themselves.
fn finding_of(found: &FaultGroup, tour: &LabRunState<'_>) -> Option<Finding> {
    let FaultGroup { fault, interaction, settings, .. } = found;
    let breakdown = stress::describe(fault)?;
    let others = match settings {
        0 | 1 => String::new(),
        2 => ", and in another setting".into(),
        n => format!(", and in {} other settings", n - 1),
    };
    let done = interaction.describe(&tour.ready.programs);
    let message = format!("{}, {done} ({}){others}", breakdown.what, fault.measured());
    let place = tour.ready.lab.place();
    let severity = breakdown.rule.severity.max(Severity::Warning);
    Some(
        Finding::plain(breakdown.rule, place, message)
            .severity(severity)
            .why(breakdown.why)
            .help(breakdown.help()),
    )
}
