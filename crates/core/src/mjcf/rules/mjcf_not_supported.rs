use labspec_finding::{Example, Layer, Rule, Severity};

/// The element, attribute or value is MJCF, but labspec does not support it yet.
pub const NOT_SUPPORTED: &Rule = &Rule {
    code: "mjcf-not-supported",
    severity: Severity::Error,
    layer: Layer::Model,
    summary: "the element, attribute or value is MJCF, but labspec does not support it yet",
    why: "what it would do would be missing from every number: better no answer than a wrong one",
    bad: Example::Model(
        "<mujoco><worldbody><⟦flexcomp⟧ name='f' type='grid' count='3 3 3' spacing='.1 .1 .1' mass='1'/></worldbody></mujoco>",
    ),
    good: Example::Model("<mujoco><worldbody><geom size='.1'/></worldbody></mujoco>"),
};
