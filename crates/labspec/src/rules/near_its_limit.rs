use crate::check::PreparedLab;
use crate::printable::counted;
use crate::run::{self, Budget, Session};
use crate::stress::{Fault, FaultKind, Interaction, StressCase};
use labspec_core::reflect::option;
use labspec_finding::{Example, Finding, Layer, Rule, Severity};

/// The lab breaks at twice its timestep.
pub const NEAR_ITS_LIMIT: &Rule = &Rule {
    code: "near-its-limit",
    severity: Severity::Note,
    exceptions: &[],
    layer: Layer::Run,
    summary: "the lab breaks at twice its timestep",
    why: "it works at its own timestep, but a slightly stiffer model or a page with longer steps would break it",
    bad: Example::Lab(
        r#"{"xml": "⟦<mujoco><worldbody><body name='rod'><joint name='hinge' axis='0 1 0' stiffness='8000'/><geom type='capsule' size='.02' fromto='0 0 0 0 0 -.5' mass='.2'/></body></worldbody></mujoco>⟧", "setup": "data.qpos[0] = 0.001", "stopAt": 2, "readouts": [{"label": "angle (rad)", "expr": "data.qpos[0]"}]}"#,
    ),
    good: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><body name='rod'><joint name='hinge' axis='0 1 0' stiffness='20'/><geom type='capsule' size='.02' fromto='0 0 0 0 0 -.5' mass='.2'/></body></worldbody></mujoco>", "setup": "data.qpos[0] = 0.001", "stopAt": 2, "readouts": [{"label": "angle (rad)", "expr": "data.qpos[0]"}]}"#,
    ),
};

/// The work budget of a run at twice the timestep.
const DOUBLED_TIMESTEP_WORK: Budget = Budget { left: 300_000_000 };

/// Reports a lab that breaks at twice its timestep, but did not break in this many runs of this length, s.
pub(crate) fn check_margin(
    ready: &PreparedLab<'_>,
    case: &StressCase<'_>,
    untouched: &Interaction,
    length: f64,
    runs: usize,
) -> Option<Finding> {
    let writes = |effects: &labspec_expr::Effects| {
        effects.writes_everything
            || effects.writes.iter().any(|w| w.field.0 as usize == option::timestep.index())
    };
    // If a control sets the timestep, its extreme values were run.
    if ready.programs.bound().any(|b| writes(b.program.effects())) {
        return None;
    }
    let twice = |session: &mut Session<'_>| *session.world.model.edit().opt.timestep *= 2.0;
    let outcome = case.run(untouched, Some(&twice), length, DOUBLED_TIMESTEP_WORK.left);
    let breaks = |f: &&Fault| matches!(f.kind, FaultKind::Diverges | FaultKind::Grows | FaultKind::Silent);
    let fault = outcome.faults.iter().find(breaks)?;
    let h = ready.model.opt.timestep;
    let message = format!(
        "this lab breaks at twice its timestep of {} s: {}, {}, at t = {} s",
        run::two_digits(h),
        fault.subject,
        fault.kind.description(),
        run::time(fault.time)
    );
    Some(
        Finding::plain(NEAR_ITS_LIMIT, ready.lab.place(), message)
            .why(format!("at its own timestep its {} were fine, but a slightly stiffer model or a page with longer steps would break it", counted(runs, "run")))
            .help(format!("{}; `labspec stability --margins` finds how far every value can be raised", fault.cause)),
    )
}
