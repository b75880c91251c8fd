//! The breakdowns of a session: warnings of the engine and silent faults, the worst first.

use super::breakdown::{Breakdown, BreakdownAdvice, time};
use super::session::Session;
use super::silent;
use crate::rules;
use labspec_core::{Warning, WarningStat};
use labspec_monitors::stress::{joint_of_dof, joint_of_place};

const RESET: &str = "MuJoCo then resets the data and continues from time 0: a student sees the scene jump back without an explanation";

/// Warnings that may cause each other, the cause first: only the first of them is reported.
const RELATED_WARNINGS: [Warning; 4] =
    [Warning::Inertia, Warning::BadQpos, Warning::BadQvel, Warning::BadQacc];
/// Independent warnings.
const INDEPENDENT_WARNINGS: [Warning; 3] = [Warning::BadCtrl, Warning::ContactFull, Warning::ConstraintFull];

/// The worst breakdown of a session; `None` when there is none.
pub fn worst_breakdown(session: &Session<'_>) -> Option<Breakdown> {
    breakdowns_of(session).into_iter().next()
}

/// All breakdowns of a session, the worst first, without consequences of other breakdowns.
pub fn breakdowns_of(session: &Session<'_>) -> Vec<Breakdown> {
    let met = |w: &Warning| {
        let stat = session.warnings.get(*w as usize).filter(|stat| stat.number > 0)?;
        Some(explain_warning(session, *w, stat))
    };
    let first = |w: &Warning| session.warnings.get(*w as usize).filter(|stat| stat.number > 0);
    let mut since = RELATED_WARNINGS.iter().find_map(first).map_or(f64::INFINITY, |stat| stat.first_time);
    let mut state = RELATED_WARNINGS.iter().find_map(met);
    if let Some(growth) = session.growth() {
        // A quantity that grows for a while becomes NaN or infinite in the end.
        if growth.time < since {
            since = growth.time;
            let grows = silent::growth(session, growth);
            let then = state.map_or(String::new(), |s| format!("; in the end {}", s.what));
            let what = format!("{}{then}", grows.what);
            state = Some(Breakdown { what, ..grows });
        }
    }
    // After energy growth or a bad number, any other fault may be a consequence; earlier faults are reported.
    let noticed = silent::first(&session.world.model, &session.observations());
    let before = noticed.filter(|(time, _)| *time < since).map(|(_, b)| b);
    before.into_iter().chain(state).chain(INDEPENDENT_WARNINGS.iter().filter_map(met)).collect()
}

/// Describes a warning of the engine.
fn explain_warning(session: &Session<'_>, warning: Warning, stat: &WarningStat) -> Breakdown {
    let model = &session.world.model;
    let joint = || joint_of_dof(model, stat.lastinfo);
    let moment = format!("at t = {} s", time(stat.first_time));
    let no_number = |what: String| format!("{what} is not a number or exceeds 1e10 {moment}");
    let (rule, what, why, advice) = match warning {
        Warning::BadQpos => (
            rules::SIMULATION_DIVERGES,
            no_number(format!("the position of {}", joint_of_place(model, stat.lastinfo))),
            RESET,
            BreakdownAdvice::by_stiffness(session),
        ),
        Warning::BadQvel => (
            rules::SIMULATION_DIVERGES,
            no_number(format!("the velocity of {}", joint())),
            RESET,
            BreakdownAdvice::by_stiffness(session),
        ),
        Warning::BadQacc => (
            rules::SIMULATION_DIVERGES,
            no_number(format!("the acceleration of {}", joint())),
            RESET,
            BreakdownAdvice::by_stiffness(session),
        ),
        Warning::BadCtrl => (
            rules::SIMULATION_DIVERGES,
            no_number(format!("control {}", stat.lastinfo)),
            "MuJoCo then sets all controls to 0: a student sees everything go limp without an explanation",
            BreakdownAdvice::only("guard the expression for `data.ctrl` with a condition"),
        ),
        Warning::Inertia => (
            rules::ENGINE_WARNING,
            format!("the parts that {} moves have no positive inertia {moment}", joint()),
            "a push then gives no meaningful acceleration: things do not move, move backwards or vanish",
            BreakdownAdvice::only(
                "give every moving body a mass and an inertia above 0: check the model, and what writes `body_mass`, `body_inertia` or `dof_armature`",
            ),
        ),
        Warning::ContactFull => (
            rules::ENGINE_WARNING,
            format!("there are more contacts than the {} that the engine keeps {moment}", stat.lastinfo),
            "the dropped contacts do not push: bodies silently sink into each other",
            BreakdownAdvice::only("let fewer bodies touch, or move them apart at the start"),
        ),
        Warning::ConstraintFull => (
            rules::ENGINE_WARNING,
            format!("there are more contacts, limits and other constraints than the engine keeps {moment}"),
            "the dropped constraints do not act: bodies silently sink into each other, and joints pass their limits",
            BreakdownAdvice::only("let fewer bodies touch, or move them apart at the start"),
        ),
    };
    advice.breakdown(rule, what, why)
}
