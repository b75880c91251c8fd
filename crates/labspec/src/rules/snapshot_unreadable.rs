use super::example::{FALL, STORED};
use labspec_finding::{Example, Layer, Rule, Severity};

/// Decided by `check_snapshots` in `check/snapshot/mod.rs`.
pub const SNAPSHOT_UNREADABLE: &Rule = &Rule {
    code: "snapshot-unreadable",
    severity: Severity::Error,
    exceptions: &[],
    layer: Layer::Source,
    summary: "a snapshot cannot be read",
    why: "nothing stored in it is compared",
    bad: Example::Files(&[
        (
            "fall.json",
            r##"⟦⟧{"xml": "<mujoco><worldbody><body pos='0 0 1'><freejoint/><geom size='.1'/></body></worldbody></mujoco>", "stopAt": 0.2, "readouts": [{"label": "height (m)", "expr": "data.qpos[2]", "digits": 3}]}"##.as_bytes(),
        ),
        (
            "fall.json.snap",
            br##"labspec snapshot 1

lab "#1" "A fall"
"##,
        ),
    ]),
    good: Example::Files(&[("fall.json", FALL), ("fall.json.snap", STORED)]),
};
