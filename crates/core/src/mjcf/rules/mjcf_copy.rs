use labspec_finding::{Example, Layer, Rule, Severity};

/// A `replicate` or `attach` cannot copy its source.
pub const COPY: &Rule = &Rule {
    code: "mjcf-copy",
    severity: Severity::Error,
    exceptions: &[],
    layer: Layer::Model,
    summary: "a `replicate` or `attach` cannot copy its source",
    why: "the model does not load, so the scene stays empty",
    bad: Example::Model(
        "<mujoco><worldbody><body><joint name='a'/><geom size='.1'/></body><replicate count='2' offset='1 0 0'><body><joint name='b'/><geom size='.1'/></body></replicate></worldbody><equality><⟦joint⟧ joint1='a' joint2='b'/></equality></mujoco>",
    ),
    good: Example::Model(
        "<mujoco><worldbody><replicate count='2' offset='1 0 0'><body><joint name='a'/><joint name='b' axis='1 0 0'/><geom size='.1'/></body></replicate></worldbody><equality><joint joint1='a' joint2='b'/></equality></mujoco>",
    ),
};
