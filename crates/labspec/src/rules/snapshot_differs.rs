use super::example::{FALL, STORED};
use labspec_finding::{Example, Layer, Rule, Severity};

/// Decided by `compare_lab` in `check/snapshot/mod.rs`.
pub const SNAPSHOT_DIFFERS: &Rule = &Rule {
    code: "snapshot-differs",
    severity: Severity::Error,
    exceptions: &[],
    layer: Layer::Run,
    summary: "the output of a lab differs from its snapshot",
    why: "the lab has changed since someone reviewed it: a student sees other curves than the reviewer",
    bad: Example::Files(&[
        (
            "fall.json",
            r#"{"xml": "<mujoco><worldbody><body pos='0 0 2'><freejoint/><geom size='.1'/></body></worldbody></mujoco>", "stopAt": 0.2, "readouts": [{"label": "⟦height (m)⟧", "expr": "data.qpos[2]", "digits": 3}]}"#.as_bytes(),
        ),
        ("fall.json.snap", STORED),
    ]),
    good: Example::Files(&[("fall.json", FALL), ("fall.json.snap", STORED)]),
};
