use labspec_finding::{Example, Layer, Rule, Severity};

/// Two attributes contradict each other.
pub const CONFLICT: &Rule = &Rule {
    code: "mjcf-conflicting-attributes",
    severity: Severity::Error,
    exceptions: &[],
    layer: Layer::Model,
    summary: "two attributes contradict each other",
    why: "the loader cannot know which of the two is meant",
    bad: Example::Model(
        "<mujoco><worldbody><geom name='a' size='.1'/><body name='b' pos='1 0 0'><geom size='.1'/></body></worldbody><sensor><distance geom1='a' body1='⟦b⟧' body2='b'/></sensor></mujoco>",
    ),
    good: Example::Model(
        "<mujoco><worldbody><geom name='a' size='.1'/><body name='b' pos='1 0 0'><geom size='.1'/></body></worldbody><sensor><distance geom1='a' body2='b'/></sensor></mujoco>",
    ),
};
