use super::example::{FALL, STORED};
use labspec_finding::{Example, Layer, Rule, Severity};

/// Decided by `outdated` in `check/snapshot/mod.rs`.
pub const SNAPSHOT_OUTDATED: &Rule = &Rule {
    code: "snapshot-outdated",
    severity: Severity::Error,
    exceptions: &[],
    layer: Layer::Run,
    summary: "a lab has changed since its snapshot was taken",
    why: "some stored output is no longer shown, or some shown output is not stored: nobody has reviewed it",
    bad: Example::Files(&[
        (
            "fall.json",
            r##"{"xml": "⟦<mujoco><option integrator='RK4'/><worldbody><body pos='0 0 1'><freejoint/><geom size='.1'/></body></worldbody></mujoco>⟧", "stopAt": 0.2, "readouts": [{"label": "height (m)", "expr": "data.qpos[2]", "digits": 3}]}"##.as_bytes(),
        ),
        ("fall.json.snap", STORED),
    ]),
    good: Example::Files(&[("fall.json", FALL), ("fall.json.snap", STORED)]),
};
