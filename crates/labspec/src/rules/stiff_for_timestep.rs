use crate::run;
use labspec_core::{AccessSet, Model};
use labspec_finding::{Example, Finding, Layer, Rule, Severity};
use labspec_monitors::stability;
use std::ops::Range;

/// A servo, a spring or a contact is too stiff for the timestep.
pub const STIFF_FOR_TIMESTEP: &Rule = &Rule {
    code: "stiff-for-timestep",
    severity: Severity::Warning,
    exceptions: &[],
    layer: Layer::Run,
    summary: "a servo, a spring or a contact is too stiff for the timestep",
    why: "every step overshoots more than the one before, and MuJoCo gives no warning until a number exceeds 1e10",
    bad: Example::Lab(
        r#"{"xml": "⟦<mujoco><worldbody><body name='rod'><joint name='hinge' axis='0 1 0' stiffness='1e6'/><geom type='capsule' size='.02' fromto='0 0 0 0 0 -1'/></body></worldbody></mujoco>⟧", "setup": "data.qpos[0] = 0.001", "stopAt": 0.004, "readouts": [{"label": "shown", "expr": "data.qpos[0]"}]}"#,
    ),
    good: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><body name='rod'><joint name='hinge' axis='0 1 0' stiffness='10'/><geom type='capsule' size='.02' fromto='0 0 0 0 0 -1'/></body></worldbody></mujoco>", "setup": "data.qpos[0] = 0.001", "stopAt": 0.004, "readouts": [{"label": "shown", "expr": "data.qpos[0]"}]}"#,
    ),
};

/// Reports the part of a scene that is unstable at this timestep, although no run diverged.
pub(crate) fn check_stiffness(
    model: &Model,
    access: &AccessSet,
    place: Range<usize>,
    covered: &str,
) -> Option<Finding> {
    let worst = stability::unstable_parts(model).into_iter().next()?;
    let [owner, how] = [run::owner(model, &worst), run::how_stiff(&worst)];
    Some(
        Finding::warning(STIFF_FOR_TIMESTEP, place, format!("{owner} is {how} for its timestep"))
            .why(format!(
                "nothing goes wrong in the {covered} s of the run, but after a push every step overshoots more than the one before: it swings ever wider, and MuJoCo gives no warning until a number exceeds 1e10"
            ))
            .help(format!(
                "set the timestep to {} s, or {}",
                run::two_digits(0.9 * worst.timestep.min(model.opt.timestep)),
                run::attribute_to_soften(&worst, access)
            )),
    )
}
