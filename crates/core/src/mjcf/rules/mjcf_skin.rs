use labspec_finding::{Example, Layer, Rule, Severity};

/// The data of a skin do not form a surface that bodies carry.
pub const SKIN: &Rule = &Rule {
    code: "mjcf-skin",
    severity: Severity::Error,
    exceptions: &[],
    layer: Layer::Model,
    summary: "the data of a skin do not form a surface that bodies carry",
    why: "the model does not load, so the scene stays empty",
    bad: Example::Model(
        "<mujoco><asset><skin name='s' vertex='0 0 0 1 0 0' face='⟦0 1 2⟧'><bone body='b' bindpos='0 0 0' bindquat='1 0 0 0' vertid='0' vertweight='1'/></skin></asset><worldbody><body name='b'><geom size='.1'/></body></worldbody></mujoco>",
    ),
    good: Example::Model(
        "<mujoco><asset><skin name='s' vertex='0 0 0 1 0 0 0 1 0' face='0 1 2'><bone body='b' bindpos='0 0 0' bindquat='1 0 0 0' vertid='0 1 2' vertweight='1 1 1'/></skin></asset><worldbody><body name='b'><geom size='.1'/></body></worldbody></mujoco>",
    ),
};
