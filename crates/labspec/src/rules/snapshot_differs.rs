use super::example::{FALL, STORED};
use labspec_finding::{Example, Layer, Rule, Severity};

/// What a lab shows is not what its snapshot says.
pub const SNAPSHOT_DIFFERS: &Rule = &Rule {
    code: "snapshot-differs",
    severity: Severity::Error,
    layer: Layer::Run,
    summary: "what a lab shows is not what is stored of it",
    why: "The lab has become another one since somebody looked at it: a student sees other curves than were reviewed",
    bad: Example::Files(&[
        (
            "fall.json",
            r#"{"xml": "<mujoco><worldbody><body pos='0 0 2'><freejoint/><geom size='.1'/></body></worldbody></mujoco>", "stopAt": 0.2, "readouts": [{"label": "⟦height (m)⟧", "expr": "data.qpos[2]", "digits": 3}]}"#.as_bytes(),
        ),
        ("fall.json.snap", STORED),
    ]),
    good: Example::Files(&[("fall.json", FALL), ("fall.json.snap", STORED)]),
};
