//! Models and their files from a page: an object of names and contents.

use crate::error::call_error;
use js_sys::{Array, Object, Uint8Array};
use labspec::Models;
use labspec_core::xml::{FileProblem, Files};
use std::collections::BTreeMap;
use wasm_bindgen::{JsCast, JsValue};

/// The message for models in another form.
const MODELS: &str = "`models` must be an object: names with MJCF as text or with compiled models as `Uint8Array`, and paths with files as `Uint8Array`";

/// Models by name, and files by path.
pub(crate) struct PageModels {
    models: BTreeMap<String, String>,
    files: BTreeMap<String, Vec<u8>>,
}

impl PageModels {
    /// A string is a model, available under its name and as the file `NAME.xml`. Bytes are a file, or, under a name without an
    /// extension, a compiled model.
    pub(crate) fn new(given: &JsValue) -> Result<PageModels, JsValue> {
        let wrong = || call_error("wrong-type", MODELS);
        let object: &Object = given.dyn_ref().ok_or_else(wrong)?;
        let (mut models, mut files) = (BTreeMap::new(), BTreeMap::new());
        for pair in Object::entries(object).iter() {
            let pair: Array = pair.dyn_into().map_err(|_| wrong())?;
            let name = pair.get(0).as_string().ok_or_else(wrong)?;
            let content = pair.get(1);
            if let Some(text) = content.as_string() {
                if name.contains('.') {
                    files.insert(name.clone(), text.clone().into_bytes());
                }
                let short = name.strip_suffix(".xml").map(String::from).unwrap_or(name);
                models.insert(short, text);
            } else {
                let bytes: &Uint8Array = content.dyn_ref().ok_or_else(wrong)?;
                files.insert(name, bytes.to_vec());
            }
        }
        Ok(PageModels { models, files })
    }
}

impl Models for PageModels {
    fn text(&self, name: &str) -> Option<String> {
        self.models.get(name).cloned()
    }

    fn compiled(&self, name: &str) -> Option<Vec<u8>> {
        self.files.get(name).filter(|_| !name.contains('.')).cloned()
    }

    fn names(&self) -> Option<Vec<String>> {
        // Only models that the checker can read, too.
        Some(self.models.keys().cloned().collect())
    }

    fn file(&self, path: &str, limit: usize) -> Result<Vec<u8>, FileProblem> {
        let text = || self.models.get(path.strip_suffix(".xml")?).map(|text| text.clone().into_bytes());
        let bytes = self.files.get(path).cloned().or_else(text).ok_or(FileProblem::Missing)?;
        if bytes.len() > limit { Err(FileProblem::TooLarge) } else { Ok(bytes) }
    }
}

impl Files for PageModels {
    fn read(&self, path: &str, limit: usize) -> Result<Vec<u8>, FileProblem> {
        self.file(path, limit)
    }
}
