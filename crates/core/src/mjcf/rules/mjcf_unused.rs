use labspec_finding::{Example, Layer, Rule, Severity};

/// A class or an asset that nothing uses.
pub const UNUSED: &Rule = &Rule {
    code: "mjcf-unused",
    severity: Severity::Note,
    layer: Layer::Model,
    summary: "a default class or an asset that nothing uses",
    why: "what it says holds for nothing: often a `class` or a `material` is forgotten",
    bad: Example::Model(
        "<mujoco><default><default class='⟦thin⟧'><geom size='.01'/></default></default><worldbody><geom size='.1'/></worldbody></mujoco>",
    ),
    good: Example::Model(
        "<mujoco><default><default class='thin'><geom size='.01'/></default></default><worldbody><geom class='thin'/></worldbody></mujoco>",
    ),
};
