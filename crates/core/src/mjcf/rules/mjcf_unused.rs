use labspec_finding::{Example, Layer, Rule, Severity};

/// Nothing uses a default class or an asset.
pub const UNUSED: &Rule = &Rule {
    code: "mjcf-unused",
    severity: Severity::Note,
    exceptions: &[],
    layer: Layer::Model,
    summary: "nothing uses a default class or an asset",
    why: "its values apply to nothing: often a `class` or a `material` attribute is missing",
    bad: Example::Model(
        "<mujoco><default><default class='⟦thin⟧'><geom size='.01'/></default></default><worldbody><geom size='.1'/></worldbody></mujoco>",
    ),
    good: Example::Model(
        "<mujoco><default><default class='thin'><geom size='.01'/></default></default><worldbody><geom class='thin'/></worldbody></mujoco>",
    ),
};
