//! Loads a model and its files. Included text replaces its `include`; models to attach are read separately.
//!
//! As in MuJoCo, paths are relative to the folder of the model, the root element of an included file is dropped with its
//! attributes, and no file is included twice.

use crate::mjcf::gather::filled;
use crate::mjcf::gather::listed;
use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;
use std::rc::Rc;

use super::diagnostic::{Diagnostics, shorten_name};
use super::patch;
use super::scan;
use super::tree::{self, ElementTree};
use super::xml::{self, XmlElement};
use crate::mjcf::rules;
use crate::mjcf::{MAX_TEXT, names};
use crate::source::files::{FileProblem, Files, folder_of, normalize_path};
use crate::source::model_patch::{Patch, Refusal};

/// Limit for the number of files.
const MAX_FILES: usize = 500;
/// Limit for the depth of models that attach models.
const MAX_NESTED: usize = 10;

/// A model before `replicate` and `attach` are expanded.
#[derive(Debug)]
pub(crate) struct UnexpandedModel {
    pub(crate) tree: ElementTree,
    /// The folder of its files; empty for the folder of the main model.
    pub(crate) folder: String,
    /// The models that it may attach, by name.
    pub(crate) models: BTreeMap<String, UnexpandedModel>,
}

/// Reads models and counts the resources that they use.
pub(crate) struct Loader<'f> {
    files: &'f dyn Files,
    counts: scan::TextCounts,
    files_read: usize,
    /// The files of the models that are currently being read. Each is attached by the one before.
    open: Vec<String>,
    /// Patches of the main model, and for each of them the reason why it was refused, or `None`.
    patches: &'f [Patch],
    refusals: Vec<Option<Refusal>>,
}

impl<'f> Loader<'f> {
    pub(crate) fn new(files: &'f dyn Files, patches: &'f [Patch]) -> Loader<'f> {
        let (counts, open, refusals) = (scan::TextCounts::default(), Vec::new(), Vec::new());
        Loader { files, counts, files_read: 0, open, patches, refusals }
    }

    /// The text of a model with its patches applied and its includes expanded. `None` if the text is not XML, or a patch cannot
    /// be applied.
    pub(crate) fn written(
        &mut self,
        text: &str,
        file: Option<&str>,
        report: &mut Diagnostics,
    ) -> Option<String> {
        let base = report.source(None, text.into());
        let mut list = Vec::new();
        let root = self.parse(text, base, &mut list, report)?;
        self.include(&mut list, file, folder_of(file.unwrap_or("")), report);
        for p in self.patches {
            self.patch(&mut list, root, p).ok()?;
        }
        report.is_clean().then(|| xml::print(&list, root))
    }

    /// For each patch, in their order, the reason why it was refused, or `None`.
    pub(crate) fn refusals(self) -> Vec<Option<Refusal>> {
        self.refusals
    }

    /// Reads a model. `file` is its path, if it has one. `None` if the text is not XML or not a model.
    pub(crate) fn model(
        &mut self,
        text: Rc<str>,
        file: Option<&str>,
        report: &mut Diagnostics,
    ) -> Option<UnexpandedModel> {
        let folder = folder_of(file.unwrap_or("")).to_string();
        self.open.push(file.unwrap_or("").to_string());
        let base = report.source(file.filter(|_| self.open.len() > 1), text.clone());
        let mut list = Vec::new();
        let written = self.parse(&text, base, &mut list, report).and_then(|root| {
            self.include(&mut list, file, &folder, report);
            if self.open.len() == 1 {
                let patches = self.patches;
                self.refusals = listed(patches.iter().map(|p| self.patch(&mut list, root, p).err()));
            }
            let mut tree = tree::check_tree(&list, root, report)?;
            names::after_files(&mut tree);
            let models = self.models(&tree, &folder, report);
            Some(UnexpandedModel { tree, folder, models })
        });
        self.open.pop();
        written
    }

    /// Applies a patch.
    fn patch(&mut self, list: &mut Vec<XmlElement>, root: usize, patch: &Patch) -> Result<(), Refusal> {
        if !patch.is_element() {
            return patch::apply(list, root, patch);
        }
        // Mistakes in the new element are a reason to refuse it; its text has no place in the model.
        let mut report = Diagnostics::new();
        let base = report.source(None, patch.value.as_str().into());
        let first = list.len();
        let new = self.parse(&patch.value, base, list, &mut report);
        // Files are included before a patch is applied.
        if list.iter().skip(first).any(|element| element.name == "include") {
            return Err(Refusal {
                message: "the new element includes a file".to_string(),
                help: "write the content of the file in its place".to_string(),
            });
        }
        match new.filter(|_| report.is_clean()) {
            Some(new) => patch::replace(list, root, patch, new),
            None => Err(Refusal {
                message: "the new element is not XML".to_string(),
                help: "write one whole element, as in `<position joint='arm' kp='50'/>`".to_string(),
            }),
        }
    }

    fn parse(
        &mut self,
        text: &str,
        base: usize,
        list: &mut Vec<XmlElement>,
        report: &mut Diagnostics,
    ) -> Option<usize> {
        let text = scan::prepare(text, base, &mut self.counts, report)?;
        xml::parse(&text, base, list, report)
    }

    /// Inserts the contents of files below the elements that include them. These files may include others.
    fn include(
        &mut self,
        list: &mut Vec<XmlElement>,
        model_name: Option<&str>,
        folder: &str,
        report: &mut Diagnostics,
    ) {
        let mut included: BTreeSet<String> = filled(model_name.map(str::to_string));
        let mut index = 0;
        while let Some(element) = list.get(index) {
            if element.name == "include" && !report.is_full() {
                let children = self.included(index, list, folder, &mut included, report);
                if let Some(element) = list.get_mut(index) {
                    element.children = children;
                }
            }
            index += 1;
        }
    }

    /// The elements that replace an `include`.
    fn included(
        &mut self,
        index: usize,
        list: &mut Vec<XmlElement>,
        folder: &str,
        included: &mut BTreeSet<String>,
        report: &mut Diagnostics,
    ) -> Vec<usize> {
        let Some(element) = list.get(index) else { return Vec::new() };
        #[cfg(test)]
        super::seen::note(&crate::mjcf::schema::INCLUDE, "file");
        let span = element.span.clone();
        if !element.children.is_empty() {
            report
                .error(rules::FILE, span, "`include` contains elements")
                .help("write `<include file=\"…\"/>`: the contents of the file replace it");
            return Vec::new();
        }
        let Some(file) = element.attribute("file") else {
            report
                .error(rules::MISSING_ATTRIBUTE, span, "include has no `file`")
                .help("write `<include file=\"parts/arm.xml\"/>`");
            return Vec::new();
        };
        let (name, span) = (file.value.clone(), file.value_span.clone());
        let Some((path, text)) = self.text(&name, folder, &span, report) else { return Vec::new() };
        if !included.insert(path.clone()) {
            report
                .error(rules::FILE, span, format!("the file {} is included twice", shorten_name(&path)))
                .why("its elements would appear twice, or a file would include itself without end")
                .help("include it once; `replicate` and `attach` make copies");
            return Vec::new();
        }
        let base = report.source(Some(&path), text.clone());
        let root = self.parse(&text, base, list, report).and_then(|root| list.get(root));
        let children = root.map_or(Vec::new(), |r| r.children.clone());
        if root.is_some() && children.is_empty() {
            report.error(
                rules::FILE,
                span,
                format!("the included file {} has no elements", shorten_name(&path)),
            );
        }
        children
    }

    /// The models that the assets of a model refer to.
    fn models(
        &mut self,
        tree: &ElementTree,
        folder: &str,
        report: &mut Diagnostics,
    ) -> BTreeMap<String, UnexpandedModel> {
        let mut models = BTreeMap::new();
        let assets = tree.sections("asset").flat_map(|(section, _)| tree.children(section));
        for (_, node) in assets.filter(|(_, n)| n.element.name == "model") {
            let Some(file) = node.attribute("file").filter(|_| node.text("file").is_some()) else {
                report
                    .error(rules::MISSING_ATTRIBUTE, node.span.clone(), "model has no `file`")
                    .help("write `<model name=\"…\" file=\"….xml\"/>`");
                continue;
            };
            let written = node.text("file").unwrap_or("");
            let Some((path, text)) = self.text(written, folder, &file.span, report) else { continue };
            if self.open.contains(&path) || self.open.len() > MAX_NESTED {
                report
                    .error(
                        rules::FILE,
                        file.span.clone(),
                        format!("the model {} contains itself", shorten_name(&path)),
                    )
                    .why("a model that attaches itself through another model has no end");
                continue;
            }
            let Some(model) = self.model(text, Some(&path), report) else { continue };
            let child_model = model.tree.nodes.first().and_then(|root| root.text("model"));
            let name = node.text("name").or(child_model).unwrap_or("MuJoCo Model").to_string();
            if models.contains_key(&name) {
                let message = format!("a second model has the name {}", shorten_name(&name));
                report
                    .error(rules::DUPLICATE_NAME, node.span.clone(), message)
                    .help("rename one of them: a model without `name` takes the name in its file");
            }
            models.insert(name, model);
        }
        models
    }

    /// The normalized path and the text of a file.
    fn text(
        &mut self,
        written: &str,
        folder: &str,
        span: &Range<usize>,
        report: &mut Diagnostics,
    ) -> Option<(String, Rc<str>)> {
        self.files_read += 1;
        if self.files_read > MAX_FILES {
            report.error(rules::LIMIT, span.clone(), format!("the model has more than {MAX_FILES} files"));
            return None;
        }
        let left = MAX_TEXT.saturating_sub(report.bytes());
        let (path, bytes) = read(self.files, written, folder, left, span, report)?;
        match String::from_utf8(bytes) {
            Ok(text) => Some((path, text.into())),
            Err(e) => {
                let byte = e.utf8_error().valid_up_to();
                let message = format!(
                    "{} is not UTF-8 text: byte {byte} does not belong to a character",
                    shorten_name(&path)
                );
                report.error(rules::FILE, span.clone(), message);
                None
            }
        }
    }
}

/// Reads a file that is named at `span`, and returns its normalized path and its bytes.
pub(crate) fn read(
    files: &dyn Files,
    written: &str,
    folder: &str,
    limit: usize,
    span: &Range<usize>,
    report: &mut Diagnostics,
) -> Option<(String, Vec<u8>)> {
    let Some(path) = normalize_path(folder, written) else {
        report
            .error(
                rules::FILE,
                span.clone(),
                format!("{} is not a path relative to the folder of the model", shorten_name(written)),
            )
            .why("an absolute path is valid on one computer only")
            .help("write the path relative to the folder of the model");
        return None;
    };
    let name = shorten_name(&path);
    match files.read(&path, limit) {
        Ok(bytes) => return Some((path, bytes)),
        Err(FileProblem::NoFolder) => report
            .error(
                rules::FILE,
                span.clone(),
                format!("the file {name} is not read, because this model is given as text"),
            )
            .why("a text has no folder in which to look for files")
            .help("save the model as a file and load that, or write the contents of the file here"),
        Err(FileProblem::Missing) => report
            .error(rules::FILE, span.clone(), format!("the file {name} does not exist"))
            .why("paths are relative to the folder of the model, also in included files"),
        Err(FileProblem::Outside) => report
            .error(
                rules::OUTSIDE,
                span.clone(),
                format!("the file {name} is outside the allowed folder"),
            )
            .why(
                "a model can read only files under one root, after resolving links: it may come from a stranger",
            )
            .help("put the file into the folder of the model, or choose a root that holds both"),
        Err(FileProblem::TooLarge) => report
            .error(rules::LIMIT, span.clone(), format!("the file {name} is too large"))
            .why("all texts of a model together have a size limit, and so does every other file"),
        Err(FileProblem::Unreadable(what)) => {
            report.error(rules::FILE, span.clone(), format!("the file {name} cannot be read: {what}"))
        }
    };
    None
}
