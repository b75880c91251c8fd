//! Silent faults of a run, described for teachers: what happens, the consequence, and a remedy.

use super::breakdown::{Breakdown, BreakdownAdvice, time};
use super::session::Session;
use crate::rules;
use labspec_core::{Model, joint, solver};
use labspec_finding::two_digits;
use labspec_monitors::growth::{Growth, Source};
use labspec_monitors::limits::ExceededLimit;
use labspec_monitors::stress::{geom_label, joint_of_dof};
use labspec_monitors::sunk::SunkContact;
use labspec_monitors::through::Through;
use labspec_monitors::unsolved::Unsolved;
use labspec_monitors::watch::Observations;

const ENERGY_FROM_STEPS: &str = "the steps create the energy, not the physics: a student sees things leap or swing ever wider, and MuJoCo gives no warning";

/// Friction above which the edges of a pyramidal cone have almost no normal component.
const SLIPPERY_FRICTION: f64 = 3.0;

/// The earliest silent fault besides energy growth, with its time; later ones may be consequences of it.
pub(super) fn first(model: &Model, noticed: &Observations) -> Option<(f64, Breakdown)> {
    let list = [
        noticed.past.map(|x| (x.time, past(model, x))),
        noticed.through.map(|x| (x.time, through(model, x))),
        noticed.unsolved.map(|x| (x.time, unsolved(model, x))),
        noticed.sunk.map(|x| (x.time, sunk(model, x))),
    ];
    list.into_iter().flatten().min_by(|a, b| a.0.total_cmp(&b.0))
}

/// Energy that no force supplied, or that a damper supplies.
pub(super) fn growth(session: &Session<'_>, g: Growth) -> Breakdown {
    let model = &session.world.model;
    let numbers = format!(
        "energy grows from t = {} s on: {} J without a source, while the start had {} J; most of it moves {}",
        time(g.time),
        two_digits(g.gain),
        two_digits(g.available_energy),
        joint_of_dof(model, g.dof)
    );
    match g.source {
        Source::Steps => {
            BreakdownAdvice::by_stiffness(session).breakdown(rules::ENERGY_GROWS, numbers, ENERGY_FROM_STEPS)
        }
        Source::LongSteps(turn) => {
            let what = format!("{numbers}, which turns by {} rad in a step", two_digits(turn));
            let cause = format!("a step of {} s cannot follow a turn that fast", model.opt.timestep);
            let advice = BreakdownAdvice { cause: Some(cause), ..BreakdownAdvice::shorter("a slower start") };
            advice.breakdown(rules::ENERGY_GROWS, what, ENERGY_FROM_STEPS)
        }
        Source::Damper(dof) => {
            let owner = joint_of_dof(model, dof);
            let damping = model.dof_damping.get(dof).copied().unwrap_or(0.0);
            let what = format!(
                "the damping of {owner} is {}, so it feeds energy in without end: it has added {} J by t = {} s, while the start had {} J",
                two_digits(damping),
                two_digits(g.gain),
                time(g.time),
                two_digits(g.available_energy)
            );
            let why = "the faster a part moves, the harder a negative damper pushes it: a student sees a swing that grows forever without a motor";
            BreakdownAdvice::only("write a `damping` of 0 or more; use an actuator to drive the joint")
                .breakdown(rules::DAMPER_PUSHES, what, why)
        }
    }
}

fn past(model: &Model, p: ExceededLimit) -> Breakdown {
    let owner = name(model.names.joint.get(p.joint), "joint", p.joint);
    let unit = if model.jnt_type.get(p.joint) == Some(&joint::SLIDE) { "m" } else { "rad" };
    let [beyond, range] = [p.beyond, p.range].map(two_digits);
    let (what, advice) = match p.step {
        Some(step) => (
            format!(
                "{owner} is {beyond} {unit} beyond its limit at t = {} s: one step moves it by {} {unit}, but its range is {range} {unit}",
                time(p.time),
                two_digits(step)
            ),
            BreakdownAdvice {
                cause: Some("a limit pushes only after a step ends beyond it".into()),
                ..BreakdownAdvice::shorter("a slower arrival at the limit")
            },
        ),
        None => (
            format!(
                "{owner} is pressed {beyond} {unit} beyond its limit from t = {} s on, and its range is {range} {unit}",
                time(p.time)
            ),
            BreakdownAdvice::only(
                "make the limit stiffer (a smaller first number of `solreflimit`), the motor or load weaker, or the range wider",
            ),
        ),
    };
    let why = "the limit does not hold it: a student sees the joint where it cannot be, and MuJoCo gives no warning";
    advice.breakdown(rules::PAST_LIMIT, what, why)
}

fn through(model: &Model, t: Through) -> Breakdown {
    let [mover, wall] = t.geoms.map(|g| geom_label(model, g));
    let what = format!(
        "{mover} passes through {wall} at t = {} s: a step moves it by {} m, but the wall is only {} m thick",
        time(t.time),
        two_digits(t.moved),
        two_digits(t.thickness)
    );
    let advice = BreakdownAdvice {
        cause: Some("the engine finds contacts only where bodies overlap at a step".into()),
        ..BreakdownAdvice::shorter("something thicker, or a lower speed")
    };
    let why = "no step finds the two in contact from the right side: a student sees a wall that holds nothing, and MuJoCo gives no warning";
    advice.breakdown(rules::PASSES_THROUGH, what, why)
}

fn sunk(model: &Model, s: SunkContact) -> Breakdown {
    let [a, b] = s.geoms.map(|g| geom_label(model, g));
    let what = format!(
        "{a} and {b} overlap by {} m from t = {} s on, but the thinner one is only {} m thick; the contact pushes with {} N",
        two_digits(s.depth),
        time(s.time),
        two_digits(s.thickness),
        two_digits(s.force)
    );
    let friction = |g: usize| model.geom_friction.get(3 * g).copied().unwrap_or(0.0);
    let most = s.geoms.map(friction).into_iter().fold(0.0, f64::max);
    let help = if model.opt.cone == 0 && most > SLIPPERY_FRICTION {
        format!(
            "write `cone=\"elliptic\"`, or a friction of 1 instead of {}: with so much friction, the edges of a pyramidal cone do not push along the normal",
            two_digits(most)
        )
    } else {
        "make the contact stiffer (a smaller first number of `solref`, with a shorter timestep), the body below heavier, the one above lighter, or the pull weaker".into()
    };
    let why = "the contact is too soft for the load: a student sees bodies sunk into each other instead of resting on each other";
    BreakdownAdvice::only(help).breakdown(rules::SINKS_IN, what, why)
}

fn unsolved(model: &Model, u: Unsolved) -> Breakdown {
    let iterations =
        if u.iterations == 1 { "1 iteration".into() } else { format!("{} iterations", u.iterations) };
    let what = format!(
        "the solver stops after {iterations}: from t = {} s on, {} % of the force of contacts, limits and constraints is missing, most of it at {}",
        time(u.time),
        two_digits(100.0 * u.part),
        joint_of_dof(model, u.dof)
    );
    let help = if model.opt.solver == solver::NEWTON {
        "write `iterations=\"100\"`, the default, or use less extreme mass ratios"
    } else {
        "write `solver=\"Newton\"` and `iterations=\"100\"`, the defaults"
    };
    let why = "forces that should hold things are missing, step after step: a student sees stacks collapse, and MuJoCo gives no warning";
    BreakdownAdvice::only(help).breakdown(rules::SOLVER_STOPS_EARLY, what, why)
}

fn name(list: Option<&String>, what: &str, id: usize) -> String {
    match list.filter(|n| !n.is_empty()) {
        Some(geom_name) => format!("{what} \"{geom_name}\""),
        None => format!("{what} {id}"),
    }
}
