//! The models of a course: compiled once for what a page shows without JavaScript, and delivered to the elements.
//!
//! A model that consists of one file is part of the page. One with further files (meshes, height fields, included text, pictures of
//! textures) is copied with them into a folder of the site, from which the element fetches them.

use labspec::bind::scene::Models;
use labspec::lint::ModelFolder;
use labspec::source::read_text;
use labspec::spec::{Lab, ModelSource};
use labspec_core::Model;
use labspec_core::xml::{Files, Folder};
use labspec_scene::Images;
use std::collections::BTreeMap;
use std::path::{Component, Path, PathBuf};

/// The maximum size of a model's text in bytes.
const MAX_TEXT: u64 = 16 << 20;
/// The maximum size of the picture of a texture in bytes.
const MAX_IMAGE: usize = 64 << 20;

/// The folders of models of a course.
#[derive(Debug, Default)]
pub(crate) struct ModelShelf {
    folders: Vec<(String, Models)>,
    /// The copied files: the name in the site, and the file.
    pub(crate) copied: BTreeMap<String, PathBuf>,
    /// The pictures of scenes, by their names in the site.
    pub(crate) pictures: BTreeMap<String, Vec<u8>>,
    /// What cannot be delivered, as sentences.
    pub(crate) problems: Vec<String>,
}

/// How a page gets a model.
#[derive(Debug, PartialEq, Eq)]
pub(crate) enum Delivery {
    /// Its text is part of the page.
    Embedded(String),
    /// Its files are in a folder of the site.
    Files,
    /// It cannot be delivered: it does not exist.
    Missing,
}

impl ModelShelf {
    /// The number of a folder, from 0.
    pub(crate) fn number(&mut self, folder: ModelFolder) -> usize {
        let name = format!("{folder:?}");
        if let Some(index) = self.folders.iter().position(|(other, _)| *other == name) {
            return index;
        }
        self.folders.push((name, Models::with_hash(folder, crate::verified::hex_of)));
        self.folders.len() - 1
    }

    /// The models of a folder.
    pub(crate) fn models(&self, number: usize) -> Option<&Models> {
        self.folders.get(number).map(|(_, models)| models)
    }

    /// The folder of the site with the files of a folder of models.
    pub(crate) fn site_folder(number: usize) -> String {
        format!("models/{}", number + 1)
    }

    /// A digest of all files of a model.
    pub(crate) fn digest(&self, number: usize, name: &str) -> String {
        let parts =
            self.models(number).and_then(|models| models.parts(name)).map_or(Vec::new(), |(parts, _)| parts);
        parts.into_iter().map(|part| format!("{} {}\n", part.path, part.hash)).collect()
    }

    /// How a page gets a model. Files are noted for the site.
    pub(crate) fn deliver(&mut self, number: usize, name: &str) -> Delivery {
        let Some((_, models)) = self.folders.get(number) else { return Delivery::Missing };
        let folder = models.folder().clone();
        let Some(path) = folder.path(name) else { return Delivery::Missing };
        let Ok(text) = read_text(&path, MAX_TEXT, "a model") else { return Delivery::Missing };
        let parts = models.parts(name).map_or(Vec::new(), |(parts, _)| parts);
        let others: Vec<String> =
            parts.into_iter().map(|part| part.path).filter(|path| !path.is_empty()).collect();
        if others.is_empty()
            && let Some(text) = embeddable(&text)
        {
            return Delivery::Embedded(text);
        }
        // The element fetches models with such names only.
        if !name.bytes().all(|b| b.is_ascii_alphanumeric() || b"_.-".contains(&b)) {
            self.problems.push(format!(
                "the model `{name}` has other files, so pages fetch it by its name; rename it to letters, digits, `_`, `.` and `-`"
            ));
        }
        let to = ModelShelf::site_folder(number);
        self.copied.insert(format!("{to}/{name}.xml"), path.clone());
        for other in others {
            let file = path.parent().unwrap_or(Path::new("")).join(&other);
            let real =
                file.canonicalize().ok().filter(|real| real.starts_with(folder.root()) && real.is_file());
            let is_inside = Path::new(&other).components().all(|c| matches!(c, Component::Normal(_)));
            match real {
                Some(real) if is_inside => {
                    self.copied.insert(format!("{to}/{other}"), real);
                }
                _ => self.problems.push(format!(
                    "the model `{name}` reads `{other}`, which is not in its folder, so pages cannot load it; move the file into the folder of the model"
                )),
            }
        }
        Delivery::Files
    }
}

/// The pictures of the textures of a lab's model. A model in the text of a lesson names no files.
pub(crate) fn texture_images(lab: &Lab, models: &Models, model: &Model) -> Images {
    let path = match lab.scene() {
        Some(ModelSource::Model(name)) => models.folder().path(&name.value),
        _ => None,
    };
    let folder = path.and_then(|path| Folder::at(models.folder().root(), path.parent()?).ok());
    Images::read(model, |file| folder.as_ref()?.read(file, MAX_IMAGE).ok())
}

/// The text of a model without comments, if a script element can contain it: nothing in it may end the element.
fn embeddable(xml: &str) -> Option<String> {
    let mut out = String::with_capacity(xml.len());
    let mut rest = xml;
    while let Some((before, comment)) = rest.split_once("<!--") {
        out.push_str(before);
        rest = comment.split_once("-->")?.1;
    }
    out.push_str(rest);
    let lower = out.to_ascii_lowercase();
    let ends = ["<!--", "<script", "</script"].iter().any(|text| lower.contains(text));
    // Declarations are not models; the element reads them from files.
    (!ends && !lower.contains("<!doctype") && !lower.contains("<![cdata[")).then_some(out)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_would_end_the_element_is_not_embedded() {
        assert_eq!(
            embeddable("<mujoco><!-- a --><worldbody/></mujoco>").unwrap(),
            "<mujoco><worldbody/></mujoco>"
        );
        for xml in [
            "<mujoco></SCRIPT ></mujoco>",
            "<mujoco><!-- open",
            "<mujoco><script/></mujoco>",
            "<!<!-- -->--<!-- --> x",
        ] {
            assert!(
                embeddable(xml).is_none_or(|text| !text.contains("<!--") && !text.contains("cript")),
                "{xml}"
            );
        }
    }
}
