use labspec_finding::{Example, Layer, Rule, Severity};

/// There is no folder of models.
pub const NO_MODEL_FOLDER: &Rule = &Rule {
    code: "no-model-folder",
    severity: Severity::Error,
    layer: Layer::Model,
    summary: "there is no folder of models",
    why: "A lab that names its model cannot run, and nothing about it can be checked",
    bad: Example::Files(&[("lesson.md", "```lab simlab\n{\"model\": \"⟦ball⟧\"}\n```\n".as_bytes())]),
    good: Example::Files(&[
        ("lesson.md", b"```lab simlab\n{\"model\": \"ball\"}\n```\n"),
        ("models/ball.xml", b"<mujoco><worldbody><geom size='.1'/></worldbody></mujoco>"),
    ]),
};
