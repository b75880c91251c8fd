//! A lab in a text, with its model and its programs, as the commands of the program open it.

use crate::error::error;
use facade::bind::Programs;
use facade::bind::scene::Models;
use facade::check;
use facade::finding::{Finding, InFile};
use facade::lint::{ModelFolder, load_lesson};
use facade::source::SourceFile;
use facade::spec::{Lab, LabAddress};
use labspec_core::Model;
use pyo3::prelude::*;
use std::sync::Arc;

/// A text with labs, and the address of one of them.
#[derive(FromPyObject)]
pub(crate) struct LabSource {
    /// The name for messages; its extension decides how the text is read.
    #[pyo3(item)]
    path: String,
    #[pyo3(item)]
    text: String,
    /// "#2", or "#quiz-id.1"; `None` where the text has only one lab.
    #[pyo3(item)]
    address: Option<String>,
}

/// A lab that is ready to run.
pub(crate) struct OpenedLab {
    pub(crate) lab: Lab,
    pub(crate) model: Arc<Model>,
    pub(crate) programs: Programs,
}

/// Opens a lab.
///
/// # Errors
/// There is no such lab, or it has errors.
pub(crate) fn open(source: &LabSource, folder: ModelFolder) -> PyResult<OpenedLab> {
    let mut models = Models::new(folder);
    let lesson = load_lesson(SourceFile::new(source.path.as_str(), source.text.as_str()), models.folder());
    let lab = match &source.address {
        Some(address) => LabAddress::parse(address).and_then(|address| lesson.lab(&address)).cloned(),
        None => lesson.addressed().first().map(|(_, lab)| (*lab).clone()),
    };
    let mut findings: Vec<Finding> = lesson.findings.clone();
    let Some(lab) = lab else {
        findings.retain(Finding::is_error);
        let address = source.address.as_deref().unwrap_or_default();
        let first = findings.first().map_or(String::new(), |f| format!(": {}", f.message));
        return Err(error("unknown-lab", &format!("{} has no lab {address}{first}", source.path), &findings));
    };
    let bound = check::bind(&lab, &models, &mut findings);
    let located = |f: Finding| if f.path.is_empty() { f.at(&lesson.file) } else { f };
    let mut findings: Vec<Finding> = findings.into_iter().map(located).collect();
    findings.extend(models.take_findings());
    let is_within = |f: &Finding| lab.span.start <= f.span.start && f.span.end <= lab.span.end;
    findings.retain(|f| f.is_error() && (f.path != *lesson.file.path() || is_within(f)));
    match bound {
        Some((model, programs, _)) if findings.is_empty() => Ok(OpenedLab { lab, model, programs }),
        _ => {
            let first = findings.first().map_or("its model does not load", |f| f.message.as_str());
            let message = format!("the lab cannot run: {first}");
            Err(error(findings.first().map_or("call", |f| f.code), &message, &findings))
        }
    }
}
