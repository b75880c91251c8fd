//! The model that a lab names, by what the folder of models has.

use crate::finding::Finding;
use crate::json::{
    encode, nearest,
    read::{named, shorten},
};
use crate::lint::ModelFolder;
use crate::rules;
use crate::source::Text;
use crate::spec::{Lab, ModelSource};

/// Whether the model that a lab names is there.
pub(super) fn check_lab_models(lab: &Lab, models: &ModelFolder, findings: &mut Vec<Finding>) {
    if let Some(ModelSource::Model(name)) = lab.scene() {
        findings.extend(missing(name, models));
    }
}

/// What is wrong with the name of a model.
pub(crate) fn missing(name: &Text, models: &ModelFolder) -> Option<Finding> {
    let text = name.as_str();
    if text.contains(['/', '\\', '\0'])
        || text.contains("..")
        || text.ends_with(".xml")
        || text.trim().is_empty()
    {
        let stem = text.rsplit(['/', '\\']).next().unwrap_or("");
        let stem = stem.strip_suffix(".xml").unwrap_or(stem);
        let finding = Finding::new(
            rules::MODEL_NAME,
            name.span(),
            format!("{} is not the name of a model", named(text)),
        );
        return Some(if stem.is_empty() || stem.contains("..") {
            finding.help("write the name of the file without folder and extension")
        } else {
            let named = finding
                .help(format!("write the name of the file without folder and extension: {}", shorten(stem)));
            // What the folder does not have is no repair.
            let exists = models.names().is_none_or(|names| names.iter().any(|n| n == stem));
            if exists { named.fix(name.span(), encode(stem)) } else { named }
        });
    }
    let names = models.names()?;
    if names.iter().any(|n| n == text) {
        return None;
    }
    let finding = Finding::new(
        rules::UNKNOWN_MODEL,
        name.span(),
        format!("the model `{}` does not exist", shorten(text)),
    );
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
