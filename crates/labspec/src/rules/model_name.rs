use crate::json::encode;
use crate::json::read::{named, shorten};
use crate::lint::ModelFolder;
use crate::source::Text;
use labspec_finding::{Example, Finding, Layer, Rule, Severity};

/// A lab names its model by a path or with an extension.
pub const MODEL_NAME: &Rule = &Rule {
    code: "model-name",
    severity: Severity::Error,
    exceptions: &[],
    layer: Layer::Structure,
    summary: "a lab names its model by a path or with an extension",
    why: "a model is a name in the model folder; the checker opens nothing outside that folder",
    bad: Example::Lab(r#"{"model": "⟦../other/ball.xml⟧"}"#),
    good: Example::Lab(r#"{"model": "ball"}"#),
};

/// Reports a model name with a folder or an extension, and a model in place of its name.
pub(crate) fn check_model_name(name: &Text, models: &ModelFolder) -> Option<Finding> {
    let text = name.as_str();
    let path = text.contains(['/', '\\', '\0'])
        || text.contains("..")
        || text.ends_with(".xml")
        || text.contains('<');
    if !path && !text.trim().is_empty() {
        return None;
    }
    let stem = text.rsplit(['/', '\\']).next().unwrap_or("");
    let stem = stem.strip_suffix(".xml").unwrap_or(stem);
    let finding =
        Finding::new(MODEL_NAME, name.span(), format!("{} is not the name of a model", named(text)));
    if text.trim_start().starts_with('<') {
        return Some(
            finding
                .why("`model` is the name of a file in the model folder")
                .help("write a model in the lab itself under the key `xml`, instead of `model`"),
        );
    }
    Some(if stem.is_empty() || stem.contains("..") {
        finding.help("write the name of the file without folder and extension")
    } else {
        let named = finding
            .help(format!("write the name of the file without folder and extension: {}", shorten(stem)));
        // A model that does not exist in the folder is not a repair.
        let exists = models.names().is_none_or(|names| names.iter().any(|n| n == stem));
        if exists { named.fix(name.span(), encode(stem)) } else { named }
    })
}
