use crate::lint::ModelFolder;
use crate::source::Text;
use labspec_finding::{Example, Finding, Layer, Rule, Severity};

/// The model folder does not exist.
pub const NO_MODEL_FOLDER: &Rule = &Rule {
    code: "no-model-folder",
    severity: Severity::Error,
    exceptions: &[],
    layer: Layer::Model,
    summary: "the model folder does not exist",
    why: "a lab that names its model cannot run, so nothing about it can be checked",
    bad: Example::Files(&[("lesson.md", "```lab simlab\n{\"model\": \"⟦ball⟧\"}\n```\n".as_bytes())]),
    good: Example::Files(&[
        ("lesson.md", b"```lab simlab\n{\"model\": \"ball\"}\n```\n"),
        ("models/ball.xml", b"<mujoco><worldbody><geom size='.1'/></worldbody></mujoco>"),
    ]),
};

/// Reports a model name if there is no model folder.
pub(crate) fn check_folder(name: &Text, folder: &ModelFolder) -> Option<Finding> {
    folder.given().is_none().then(|| {
        Finding::error(
            NO_MODEL_FOLDER,
            name.span(),
            "the model folder does not exist, so this lab cannot run",
        )
        .why("the checker skips its expressions, its runs and every claim about it")
        .help(format!(
            "put {}.xml into a folder `models` beside or above the lesson, or name the folder: --models DIR",
            name.value
        ))
    })
}
