use labspec_finding::{Example, Layer, Rule, Severity};

/// The model folder does not exist.
pub const NO_MODEL_FOLDER: &Rule = &Rule {
    code: "no-model-folder",
    severity: Severity::Error,
    layer: Layer::Model,
    summary: "the model folder does not exist",
    why: "a lab that names its model cannot run, so nothing about it can be checked",
    bad: Example::Files(&[("lesson.md", "```lab simlab\n{\"model\": \"⟦ball⟧\"}\n```\n".as_bytes())]),
    good: Example::Files(&[
        ("lesson.md", b"```lab simlab\n{\"model\": \"ball\"}\n```\n"),
        ("models/ball.xml", b"<mujoco><worldbody><geom size='.1'/></worldbody></mujoco>"),
    ]),
};
