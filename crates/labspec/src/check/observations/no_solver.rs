//! Detects a solver with zero iterations in a scene with constraints.

use super::ObservedLab;
use crate::finding::Finding;
use crate::rules;
use crate::run::{self, Play};
use labspec_core::reflect::option;
use std::ops::ControlFlow;

/// Number of steps in which constraints are looked for.
const STEPS: usize = 500;

pub(super) fn check_solver(observed: &ObservedLab<'_>, findings: &mut Vec<Finding>) {
    let ready = observed.bench.ready;
    let mut session = observed.bench.start();
    if session.world.model.opt.iterations != 0 {
        return;
    }
    // An author who sets the number during a run wants to show its effect.
    let programs = &ready.programs;
    let sets = |b: &crate::bind::Bound| {
        let writes = |w: &labspec_expr::Access| w.field.0 as usize == option::iterations.index();
        b.program.effects().writes.iter().any(writes)
    };
    let in_setup = programs.setup.as_ref().filter(|b| sets(b)).map(|b| b.text.span());
    if programs.bound().filter(|b| sets(b)).count() > usize::from(in_setup.is_some()) {
        return;
    }
    let mut found = None;
    run::play(&mut session, &Play::steps(STEPS), |session, _| {
        let data = session.world.data.fields();
        found = (data.nefc > 0).then_some((data.nefc, data.time));
        if found.is_some() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    });
    let Some((rows, time)) = found else { return };
    let time = crate::check::setconst::digits(time, 3);
    findings.push(
        Finding::warning(rules::SOLVER_STOPS_EARLY, in_setup.unwrap_or(ready.lab.place()), "`opt.iterations` is 0, so the solver never iterates")
            .why(format!("at t = {time} s there are {rows} constraint rows of contacts, limits or equalities, but nothing computes their forces"))
            .help("leave `iterations` at its default of 100"),
    );
}
