use labspec_finding::{Example, Layer, Rule, Severity};

/// A body is ten thousand times as heavy as its neighbour.
pub const MASSES_APART: &Rule = &Rule {
    code: "mjcf-masses-apart",
    severity: Severity::Note,
    exceptions: &[],
    layer: Layer::Model,
    summary: "a body is ten thousand times as heavy as its neighbour",
    why: "the solver converges slowly, and the joint or contact between them gives way; often one mass is in the wrong unit",
    bad: Example::Model(
        "<mujoco><worldbody><body name='arm'><joint/><geom size='.1' mass='10'/><⟦body⟧ name='tip' pos='.2 0 0'><joint/><geom size='.01' mass='1e-4'/></body></body></worldbody></mujoco>",
    ),
    good: Example::Model(
        "<mujoco><worldbody><body name='arm'><joint/><geom size='.1' mass='10'/><body name='tip' pos='.2 0 0'><joint/><geom size='.01' mass='.1'/></body></body></worldbody></mujoco>",
    ),
};
