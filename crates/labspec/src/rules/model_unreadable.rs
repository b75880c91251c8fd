use labspec_finding::{Example, Layer, Rule, Severity};

/// Decided by `compile` in `bind/scene.rs`.
pub const MODEL_UNREADABLE: &Rule = &Rule {
    code: "model-unreadable",
    severity: Severity::Error,
    exceptions: &[],
    layer: Layer::Model,
    summary: "a model file cannot be read",
    why: "the page shows an empty scene",
    bad: Example::Files(&[
        ("lesson.md", b"```lab simlab\n{\"model\": \"ball\"}\n```\n"),
        ("models/ball.xml", b"<mujoco><!-- \xb5 --></mujoco>"),
    ]),
    good: Example::Files(&[
        ("lesson.md", b"```lab simlab\n{\"model\": \"ball\"}\n```\n"),
        ("models/ball.xml", b"<mujoco><worldbody><geom size='.1'/></worldbody></mujoco>"),
    ]),
};
