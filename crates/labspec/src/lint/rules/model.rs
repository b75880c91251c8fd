//! The model of a lab: exactly one, and it exists.

use crate::finding::{Finding, Severity};
use crate::json::{
    encode, nearest,
    read::{named, shorten},
};
use crate::lint::ModelFolder;
use crate::source::Text;
use crate::spec::{Lab, Scene};
use labspec_finding::{Example, Layer, Rule};

/// Both `model` and `xml`, or neither.
pub static ONE_MODEL: Rule = Rule {
    code: "one-model",
    severity: Severity::Error,
    layer: Layer::Structure,
    summary: "a lab names no model, or has both `model` and `xml`",
    why: "a lab simulates exactly one model",
    bad: Example::Lab(r#"{"title": "Falling", "readouts": [{"label": "t", "expr": "data.time"}]}"#),
    good: Example::Lab(
        r#"{"title": "Falling", "model": "ball", "readouts": [{"label": "t", "expr": "data.time"}]}"#,
    ),
};

/// A model that the folder does not have.
pub static UNKNOWN_MODEL: Rule = Rule {
    code: "unknown-model",
    severity: Severity::Error,
    layer: Layer::Structure,
    summary: "the model is not in the folder of models",
    why: "the page cannot load it, and shows an empty lab",
    bad: Example::Lab(r#"{"model": "bal"}"#),
    good: Example::Lab(r#"{"model": "ball"}"#),
};

/// A model named by a path.
pub static MODEL_NAME: Rule = Rule {
    code: "model-name",
    severity: Severity::Error,
    layer: Layer::Structure,
    summary: "a model is named by a path or with its extension",
    why: "a model is a name in the folder of models; nothing outside that folder is opened",
    bad: Example::Lab(r#"{"model": "../other/ball.xml"}"#),
    good: Example::Lab(r#"{"model": "ball"}"#),
};

pub(in crate::lint) const RULES: &[&Rule] = &[&ONE_MODEL, &UNKNOWN_MODEL, &MODEL_NAME];

pub(in crate::lint) fn check(lab: &Lab, models: &ModelFolder, findings: &mut Vec<Finding>) {
    match (lab.scene(), &lab.model, &lab.xml) {
        (Some(Scene::Model(name)), ..) => findings.extend(missing(name, models)),
        (Some(Scene::Xml(_)), ..) => {}
        (None, Some(model), Some(xml)) => findings.push(
            Finding::new(&ONE_MODEL, xml.span(), "this lab has both `model` and `xml`")
                .related(model.span(), "the model is named here")
                .help("delete one of the two"),
        ),
        (None, ..) => findings.push(
            Finding::new(&ONE_MODEL, lab.span.start..lab.span.start + 1, "this lab has no model").help(
                "add \"model\": \"NAME\" for a model of the folder, or \"xml\": \"<mujoco>…</mujoco>\"",
            ),
        ),
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
        let finding =
            Finding::new(&MODEL_NAME, name.span(), format!("{} is not the name of a model", named(text)));
        return Some(if stem.is_empty() || stem.contains("..") {
            finding.help("write the file's name without folder and extension")
        } else {
            let named = finding
                .help(format!("write the file's name without folder and extension: {}", shorten(stem)));
            // What the folder does not have is no repair.
            let known = models.names().is_none_or(|names| names.iter().any(|n| n == stem));
            if known { named.fix(name.span(), encode(stem)) } else { named }
        });
    }
    let names = models.names()?;
    if names.iter().any(|n| n == text) {
        return None;
    }
    let finding = Finding::new(&UNKNOWN_MODEL, name.span(), format!("there is no model `{}`", shorten(text)));
    Some(match nearest(text, names.iter().map(String::as_str)) {
        Some(right) => finding.help(format!("did you mean `{right}`?")).fix(name.span(), encode(right)),
        None if names.is_empty() => finding.help("the folder of models is empty"),
        None => {
            let some: Vec<&str> = names.iter().map(String::as_str).take(12).collect();
            let more = if names.len() > some.len() { ", …" } else { "" };
            finding.help(format!("the folder of models has {}{more}", some.join(", ")))
        }
    })
}
