//! Which files a model is made of, and what was in them: by this a result is known to be about the same model.

use crate::digest;
use crate::source::SourceFile;
use labspec_core::xml::{FileProblem, Files};
use std::cell::RefCell;
use std::path::Path;

/// A file that a model was made of.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Part {
    /// Its path from the folder of the model; empty for the model itself.
    pub path: String,
    /// Most bytes that it may have.
    pub limit: usize,
    /// The digest of its bytes, or of why there are none.
    pub mark: String,
}

/// The digest of a model file's text.
pub(super) fn mark_of_text(text: Result<&str, &str>) -> String {
    match text {
        Ok(text) => digest::hex_of(&[b"text", text.as_bytes()]),
        Err(why) => digest::hex_of(&[b"none", why.as_bytes()]),
    }
}

fn mark_of_bytes(bytes: &Result<Vec<u8>, FileProblem>) -> String {
    match bytes {
        Ok(bytes) => digest::hex_of(&[b"bytes", bytes]),
        Err(why) => digest::hex_of(&[b"none", format!("{why:?}").as_bytes()]),
    }
}

/// The digest of a part as it is now.
pub(super) fn mark_now(model: &Path, files: &dyn Files, path: &str, limit: usize) -> String {
    if path.is_empty() {
        let file = SourceFile::read(model);
        return mark_of_text(file.as_ref().map(SourceFile::text).map_err(String::as_str));
    }
    mark_of_bytes(&files.read(path, limit))
}

/// Files that remember what was read of them.
pub(super) struct Remembering<'f> {
    files: &'f dyn Files,
    parts: RefCell<Vec<Part>>,
}

impl<'f> Remembering<'f> {
    pub(super) fn new(files: &'f dyn Files) -> Remembering<'f> {
        Remembering { files, parts: RefCell::default() }
    }

    /// Every file that was asked for, once each.
    pub(super) fn parts(self) -> Vec<Part> {
        let mut parts = self.parts.into_inner();
        parts.sort();
        parts.dedup();
        parts
    }
}

impl Files for Remembering<'_> {
    fn read(&self, path: &str, limit: usize) -> Result<Vec<u8>, FileProblem> {
        let bytes = self.files.read(path, limit);
        self.parts.borrow_mut().push(Part { path: path.to_string(), limit, mark: mark_of_bytes(&bytes) });
        bytes
    }
}
