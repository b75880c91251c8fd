//! Which files a model is made of, and what was in them: by this a result is known to be about the same model.

use crate::source::SourceFile;
use labspec_core::xml::{FileProblem, Files};
use serde::{Deserialize, Serialize};
use std::cell::RefCell;
use std::path::Path;

/// Makes a mark of some bytes, which other bytes do not share: a digest. Whoever keeps results brings it.
pub type Hash = fn(&[&[u8]]) -> String;

/// A file that a model was made of.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub struct ModelFile {
    /// Its path from the folder of the model; empty for the model itself.
    pub path: String,
    /// Most bytes that it may have.
    pub limit: usize,
    /// The mark of its bytes, or of why there are none.
    pub hash: String,
}

/// The mark of a model file's text.
pub(super) fn hash_text(hash: Hash, text: Result<&str, &str>) -> String {
    match text {
        Ok(text) => hash(&[b"text", text.as_bytes()]),
        Err(why) => hash(&[b"none", why.as_bytes()]),
    }
}

fn hash_bytes(hash: Hash, bytes: &Result<Vec<u8>, FileProblem>) -> String {
    match bytes {
        Ok(bytes) => hash(&[b"bytes", bytes]),
        Err(why) => hash(&[b"none", format!("{why:?}").as_bytes()]),
    }
}

/// The mark of a part as it is now.
pub(super) fn hash_now(hash: Hash, model: &Path, files: &dyn Files, path: &str, limit: usize) -> String {
    if path.is_empty() {
        let file = SourceFile::read(model);
        return hash_text(hash, file.as_ref().map(SourceFile::text).map_err(String::as_str));
    }
    hash_bytes(hash, &files.read(path, limit))
}

/// Files that remember what was read of them, when it is to be marked.
pub(super) struct Remembering<'f> {
    files: &'f dyn Files,
    hash: Option<Hash>,
    parts: RefCell<Vec<ModelFile>>,
}

impl<'f> Remembering<'f> {
    pub(super) fn new(files: &'f dyn Files, hash: Option<Hash>) -> Remembering<'f> {
        Remembering { files, hash, parts: RefCell::default() }
    }

    /// Every file that was asked for, once each.
    pub(super) fn parts(self) -> Vec<ModelFile> {
        let mut parts = self.parts.into_inner();
        parts.sort();
        parts.dedup();
        parts
    }
}

impl Files for Remembering<'_> {
    fn read(&self, path: &str, limit: usize) -> Result<Vec<u8>, FileProblem> {
        let bytes = self.files.read(path, limit);
        if let Some(hash) = self.hash {
            let hash = hash_bytes(hash, &bytes);
            self.parts.borrow_mut().push(ModelFile { path: path.to_string(), limit, hash });
        }
        bytes
    }
}
