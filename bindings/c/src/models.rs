//! Where models come from: a folder, or texts in memory.

use crate::arguments::{InputStruct, VersionedStruct, list, read_struct, text};
use crate::status::{Failure, Outcome};
use facade::Models;
use facade::lint::ModelFolder;
use labspec_core::xml::{FileProblem, Files, Folder, NoFiles};
use std::collections::BTreeMap;
use std::ffi::c_char;
use std::path::Path;

/// Where models come from: a folder, or texts in memory, not both. NULL instead of the struct means no models.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct ModelSource {
    /// sizeof(labspec_model_source).
    pub struct_size: usize,
    /// The folder that contains NAME.xml and the files that models refer to, or NULL. No other file is opened.
    pub folder: *const c_char,
    /// The number of texts; 0 with a folder.
    pub count: usize,
    /// The names of the models, without ".xml".
    pub names: *const *const c_char,
    /// The MJCF of each model. They may include each other as NAME.xml.
    pub texts: *const *const c_char,
}

// SAFETY: the size is the first field.
unsafe impl VersionedStruct for ModelSource {
    const FIRST_SIZE: usize = std::mem::offset_of!(ModelSource, texts) + size_of::<*const *const c_char>();
    const NAME: &'static str = "labspec_model_source";
}
// SAFETY: numbers and pointers.
unsafe impl InputStruct for ModelSource {}

/// Texts by their paths: lessons and snapshots that a lesson names.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct Texts {
    /// sizeof(labspec_texts).
    pub struct_size: usize,
    /// The number of texts.
    pub count: usize,
    /// The path of each.
    pub names: *const *const c_char,
    /// The content of each.
    pub texts: *const *const c_char,
}

// SAFETY: the size is the first field.
unsafe impl VersionedStruct for Texts {
    const FIRST_SIZE: usize = std::mem::offset_of!(Texts, texts) + size_of::<*const *const c_char>();
    const NAME: &'static str = "labspec_texts";
}
// SAFETY: numbers and pointers.
unsafe impl InputStruct for Texts {}

/// The models that a call may use.
pub(crate) enum GivenModels {
    None,
    Folder(String),
    Texts(BTreeMap<String, String>),
}

impl GivenModels {
    /// # Safety
    /// The struct is NULL, or has the size and the lists that it states.
    pub(crate) unsafe fn read(source: *const ModelSource) -> Outcome<GivenModels> {
        if source.is_null() {
            return Ok(GivenModels::None);
        }
        // SAFETY: the caller passes a struct of the size that it states, with its lists.
        unsafe {
            let source = read_struct(source)?;
            let texts = named_texts(source.names, source.texts, source.count)?;
            if source.folder.is_null() {
                return Ok(GivenModels::Texts(texts));
            }
            if !texts.is_empty() {
                return Err(Failure::argument("models come from a folder or from texts: pass one of them"));
            }
            Ok(GivenModels::Folder(text(source.folder, "the folder")?.to_string()))
        }
    }

    /// The models for labs and checks.
    pub(crate) fn open(self) -> Outcome<ModelFolder> {
        Ok(match self {
            GivenModels::None => facade::NoModels.into(),
            GivenModels::Folder(path) => {
                ModelFolder::open(Path::new(&path)).map_err(|e| Failure::file(&path, &e))?
            }
            GivenModels::Texts(texts) => texts.into(),
        })
    }

    /// The files that the text of a model may name.
    pub(crate) fn files(self) -> Outcome<Box<dyn Files>> {
        Ok(match self {
            GivenModels::None => Box::new(NoFiles),
            GivenModels::Folder(path) => {
                Box::new(Folder::new(Path::new(&path)).map_err(|e| Failure::file(&path, &e))?)
            }
            GivenModels::Texts(texts) => Box::new(FilesOfTexts(texts)),
        })
    }
}

/// Texts as files `NAME.xml`.
struct FilesOfTexts(BTreeMap<String, String>);

impl Files for FilesOfTexts {
    fn read(&self, path: &str, limit: usize) -> Result<Vec<u8>, FileProblem> {
        self.0.file(path, limit)
    }
}

/// The texts that a check may use besides the lesson.
///
/// # Safety
/// The struct is NULL, or has the size and the lists that it states.
pub(crate) unsafe fn related_texts(texts: *const Texts) -> Outcome<Option<BTreeMap<String, String>>> {
    if texts.is_null() {
        return Ok(None);
    }
    // SAFETY: the caller passes a struct of the size that it states, with its lists.
    unsafe {
        let texts = read_struct(texts)?;
        named_texts(texts.names, texts.texts, texts.count).map(Some)
    }
}

/// # Safety
/// Both lists are NULL, or have `count` texts.
unsafe fn named_texts(
    names: *const *const c_char,
    texts: *const *const c_char,
    count: usize,
) -> Outcome<BTreeMap<String, String>> {
    // SAFETY: the caller passes lists of `count` texts.
    unsafe {
        let names = list(names, count, "the list of names")?;
        let texts = list(texts, count, "the list of texts")?;
        let pair = |(name, content): (&*const c_char, &*const c_char)| {
            Ok((text(*name, "a name")?.to_string(), text(*content, "a text")?.to_string()))
        };
        names.iter().zip(texts).map(pair).collect()
    }
}
