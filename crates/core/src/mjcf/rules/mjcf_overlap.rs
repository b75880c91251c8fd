use labspec_finding::{Example, Layer, Rule, Severity};

/// A geom begins deep inside another one.
pub const OVERLAP: &Rule = &Rule {
    code: "mjcf-overlap",
    severity: Severity::Note,
    exceptions: &[],
    layer: Layer::Model,
    summary: "a geom begins deep inside another one",
    why: "contacts throw the two apart in the first steps, unless a keyframe or a setup moves them first",
    bad: Example::Model(
        "<mujoco><worldbody><geom type='plane' size='1 1 1'/><body pos='0 0 .02'><freejoint/><⟦geom⟧ name='ball' size='.05'/></body></worldbody></mujoco>",
    ),
    good: Example::Model(
        "<mujoco><worldbody><geom type='plane' size='1 1 1'/><body pos='0 0 .05'><freejoint/><geom name='ball' size='.05'/></body></worldbody></mujoco>",
    ),
};
