use crate::json::read::shorten;
use crate::json::{encode, nearest};
use crate::lint::ModelFolder;
use crate::source::Text;
use labspec_finding::{Example, Finding, Layer, Rule, Severity};

/// The model is not in the model folder.
pub const UNKNOWN_MODEL: &Rule = &Rule {
    code: "unknown-model",
    severity: Severity::Error,
    exceptions: &[],
    layer: Layer::Structure,
    summary: "the model is not in the model folder",
    why: "the page cannot load it, and shows an empty lab",
    bad: Example::Lab(r#"{"model": "⟦bal⟧"}"#),
    good: Example::Lab(r#"{"model": "ball"}"#),
};

/// Reports a model that is not in the listed folder.
pub(crate) fn check_model(name: &Text, models: &ModelFolder) -> Option<Finding> {
    let (text, names) = (name.as_str(), models.names()?);
    if names.iter().any(|n| n == text) {
        return None;
    }
    let finding =
        Finding::new(UNKNOWN_MODEL, name.span(), format!("the model `{}` does not exist", shorten(text)));
    Some(match nearest(text, names.iter().map(String::as_str)) {
        Some(right) => finding.help(format!("did you mean `{right}`?")).guess(name.span(), encode(right)),
        None if names.is_empty() => finding.help("add the model: the model folder is empty"),
        None => {
            let some: Vec<&str> = names.iter().map(String::as_str).take(12).collect();
            let more = if names.len() > some.len() { ", …" } else { "" };
            finding.help(format!("use one of the models in the model folder: {}{more}", some.join(", ")))
        }
    })
}

/// Reports a model that is not in the folder, if the folder cannot be listed.
pub(crate) fn check_unlisted(name: &Text, folder: &ModelFolder) -> Option<Finding> {
    (folder.given().is_some() && !folder.has(&name.value)).then(|| {
        let message = format!("the model `{}` does not exist", name.value);
        Finding::new(UNKNOWN_MODEL, name.span(), message).help("use the name of an existing model")
    })
}
