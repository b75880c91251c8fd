use labspec_finding::{Example, Layer, Rule, Severity};

/// Decided by `model_of_lab` in `bind/scene.rs`.
pub const MODEL_BROKEN: &Rule = &Rule {
    code: "model-broken",
    severity: Severity::Error,
    exceptions: &[],
    layer: Layer::Model,
    summary: "the model of a lab is invalid",
    why: "until the model loads, the lab cannot run and its expressions cannot be checked",
    bad: Example::Files(&[
        ("lesson.md", "```lab simlab\n{\"model\": \"⟦ball⟧\"}\n```\n".as_bytes()),
        ("models/ball.xml", b"<mujoco><worldbody><gemo size='.1'/></worldbody></mujoco>"),
    ]),
    good: Example::Files(&[
        ("lesson.md", b"```lab simlab\n{\"model\": \"ball\"}\n```\n"),
        ("models/ball.xml", b"<mujoco><worldbody><geom size='.1'/></worldbody></mujoco>"),
    ]),
};
