//! The files of a model and digests of their contents, which identify the model of a cached result: those from which it was compiled,
//! and those of its textures.

use crate::source::SourceFile;
use labspec_core::Model;
use labspec_core::xml::{FileProblem, Files, MAX_FILE};
use labspec_finding::order;
use serde::{Deserialize, Serialize};
use std::cell::RefCell;
use std::path::Path;

/// Computes a digest of some bytes. The owner of a cache provides it.
pub type Hash = fn(&[&[u8]]) -> String;

/// A file of a model.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub struct ModelFile {
    /// Its path relative to the folder of the model; empty for the model itself.
    pub path: String,
    /// Maximum number of bytes.
    pub limit: usize,
    /// The digest of its bytes, or of the error.
    pub hash: String,
}

/// The digest of the text of a model file.
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

/// The digest of the current content of a file.
pub(super) fn hash_now(hash: Hash, model: &Path, files: &dyn Files, path: &str, limit: usize) -> String {
    if path.is_empty() {
        let file = SourceFile::read(model);
        return hash_text(hash, file.as_ref().map(SourceFile::text).map_err(String::as_str));
    }
    hash_bytes(hash, &files.read(path, limit))
}

/// Files that record the digests of what is read, if there is a hash function.
pub(super) struct RecordingFiles<'f> {
    files: &'f dyn Files,
    hash: Option<Hash>,
    parts: RefCell<Vec<ModelFile>>,
}

impl<'f> RecordingFiles<'f> {
    pub(super) fn new(files: &'f dyn Files, hash: Option<Hash>) -> RecordingFiles<'f> {
        RecordingFiles { files, hash, parts: RefCell::default() }
    }

    /// Records the files of the textures of a model. The compiler does not read them; a page that shows the model does.
    pub(super) fn record_textures(&self, model: Option<&Model>) {
        if self.hash.is_none() {
            return;
        }
        let textures = model.into_iter().flat_map(|model| &model.textures);
        for path in textures.flat_map(|texture| &texture.files).filter(|path| !path.is_empty()) {
            // A missing picture is recorded as well: the result changes when the file appears.
            let _ = self.read(path, MAX_FILE);
        }
    }

    /// Every requested file, once each.
    pub(super) fn parts(self) -> Vec<ModelFile> {
        let mut parts = self.parts.into_inner();
        order::sort_by(&mut parts, Ord::cmp);
        parts.dedup();
        parts
    }
}

impl Files for RecordingFiles<'_> {
    fn read(&self, path: &str, limit: usize) -> Result<Vec<u8>, FileProblem> {
        let bytes = self.files.read(path, limit);
        if let Some(hash) = self.hash {
            let hash = hash_bytes(hash, &bytes);
            self.parts.borrow_mut().push(ModelFile { path: path.to_string(), limit, hash });
        }
        bytes
    }
}
