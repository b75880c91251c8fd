//! Where models come from: a folder, or texts by their names.

use crate::error::error;
use facade::Models as _;
use facade::lint::ModelFolder;
use labspec_core::xml::{FileProblem, Files, Folder, NoFiles};
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// Where models come from.
enum GivenModels {
    None,
    Folder(PathBuf),
    Texts(BTreeMap<String, String>),
}

fn given_models(given: Option<&Bound<'_, PyAny>>) -> PyResult<GivenModels> {
    let Some(given) = given.filter(|given| !given.is_none()) else { return Ok(GivenModels::None) };
    if let Ok(texts) = given.extract() {
        return Ok(GivenModels::Texts(texts));
    }
    let path = given.extract().map_err(|_| {
        PyTypeError::new_err("`models` must be the path of a folder, or a dictionary of MJCF by name")
    })?;
    Ok(GivenModels::Folder(path))
}

fn unreadable(path: &Path, e: &std::io::Error) -> PyErr {
    error("file", &format!("cannot read the models in {}: {e}", path.display()), &[])
}

/// The files that the text of a model may name: none, those of a folder, or texts by name.
pub(crate) fn files(given: Option<&Bound<'_, PyAny>>) -> PyResult<Box<dyn Files + Send + Sync>> {
    Ok(match given_models(given)? {
        GivenModels::None => Box::new(NoFiles),
        GivenModels::Folder(path) => Box::new(Folder::new(&path).map_err(|e| unreadable(&path, &e))?),
        GivenModels::Texts(texts) => Box::new(FilesOfTexts(texts)),
    })
}

/// Texts as files `NAME.xml`.
struct FilesOfTexts(BTreeMap<String, String>);

impl Files for FilesOfTexts {
    fn read(&self, path: &str, limit: usize) -> Result<Vec<u8>, FileProblem> {
        self.0.file(path, limit)
    }
}

/// The models for labs and checks: `None`, the path of a folder, or a dictionary of MJCF by name.
pub(crate) fn models(given: Option<&Bound<'_, PyAny>>) -> PyResult<ModelFolder> {
    Ok(match given_models(given)? {
        GivenModels::None => facade::NoModels.into(),
        GivenModels::Folder(path) => ModelFolder::open(&path).map_err(|e| unreadable(&path, &e))?,
        GivenModels::Texts(texts) => texts.into(),
    })
}
