//! The occurrences of a name of a model: in the model itself, and in the labs and claims of the lessons around it.

use super::context::{ModelContexts, WorkspaceRoot, editor_uri, lessons_below, text_of};
use super::convert;
use super::documents::OpenDocument;
use labspec::bind::ModelNames;
use labspec::bind::scene::Models;
use labspec::lint::{ModelFolder, load_lesson_at};
use labspec::source::{Overlay, SourceFile, Text};
use labspec::spec::{FileKind, Lab, Lesson, ModelSource};
use labspec_assist::code;
use labspec_assist::elements::{ElementName, element_names};
use labspec_expr::{Schema, names_in, texts_in};
use lsp_types::{Location, Position, Uri};
use std::collections::BTreeMap;
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// A name, and the model that defines its meaning.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct QualifiedName {
    /// The noun for the named object: `body`.
    pub(super) noun: String,
    pub(super) name: String,
    pub(super) model: ModelLocation,
    /// The span at which the user pointed, in bytes of that file.
    pub(super) span: Range<usize>,
}

/// The location of the text of a model.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum ModelLocation {
    /// A separate file.
    File(PathBuf),
    /// A lab at this span of a lesson.
    Lab(PathBuf, Range<usize>),
}

/// An occurrence of a name.
#[derive(Clone, Debug)]
pub(super) struct Occurrence {
    pub(super) file: SourceFile,
    pub(super) span: Range<usize>,
    /// Whether the element gets its name here.
    pub(super) defines: bool,
    /// Whether the bytes are the name without escapes.
    pub(super) plain: bool,
}

/// Another text that contains the name and may refer to it.
#[derive(Clone, Debug)]
pub(super) struct Ambiguity {
    pub(super) file: SourceFile,
    pub(super) span: Range<usize>,
    pub(super) why: &'static str,
}

/// All occurrences of a name.
#[derive(Clone, Debug, Default)]
pub(super) struct Occurrences {
    pub(super) all: Vec<Occurrence>,
    pub(super) ambiguities: Vec<Ambiguity>,
}

/// The data for a search of names: the open documents, and the locations of models and folders.
pub(super) struct SearchScope<'a> {
    pub(super) open: &'a BTreeMap<String, OpenDocument>,
    pub(super) folders: &'a [WorkspaceRoot],
    pub(super) models_of: &'a dyn Fn(&Path) -> ModelFolder,
    pub(super) overlay: &'a Arc<Overlay>,
}

impl SearchScope<'_> {
    /// The URI of a file as the editor names it.
    pub(super) fn uri(&self, path: &Path) -> Option<Uri> {
        editor_uri(path, self.open, self.folders)
    }
}

/// The name at a byte of a lesson.
pub(super) fn name_in_lesson(
    lesson: &Lesson,
    path: &Path,
    models: &Models,
    byte: usize,
) -> Option<QualifiedName> {
    if let Some((piece, inside)) = code::code_at(lesson, byte) {
        let model = models.model_of_lab(piece.lab, &mut Vec::new())?;
        let readouts = labspec::verify::labels(piece.lab);
        let names = ModelNames::new(&model, piece.scope).showing(&readouts);
        let all = names_in(&names, &piece.text.value);
        let found = all.into_iter().find(|n| n.span.start <= inside && inside <= n.span.end)?;
        let span = piece.text.span_of(found.span.into());
        let noun = names.noun(found.collection).to_string();
        return Some(QualifiedName {
            noun,
            name: found.name,
            model: model_location(piece.lab, path, models)?,
            span,
        });
    }
    let holds = |text: &Text| text.span().start <= byte && byte <= text.span().end;
    let trail =
        lesson.all_labs().into_iter().find_map(|lab| Some((lab, lab.trail.as_ref().filter(|t| holds(t))?)));
    if let Some((lab, text)) = trail {
        let model = model_location(lab, path, models)?;
        return Some(QualifiedName {
            noun: "site".into(),
            name: text.value.clone(),
            model,
            span: text.span(),
        });
    }
    // In a model that is part of the lab itself.
    let inline =
        lesson.all_labs().into_iter().find_map(|lab| Some((lab, lab.xml.as_ref().filter(|t| holds(t))?)));
    let (lab, text) = inline?;
    let all = element_names(&text.value).all.into_iter();
    let mut all = all.map(|m| (text.span_of(m.span.clone()), m));
    let (span, m) = all.find(|(span, _)| span.start <= byte && byte <= span.end)?;
    Some(QualifiedName {
        noun: m.noun.into(),
        name: m.name,
        model: ModelLocation::Lab(path.to_path_buf(), lab.span.clone()),
        span,
    })
}

/// The name at a byte of a model file.
pub(super) fn name_in_model(file: &SourceFile, path: &Path, byte: usize) -> Option<(QualifiedName, bool)> {
    let all = element_names(file.text()).all.into_iter();
    let ElementName { noun, name, span, defines } =
        all.into_iter().find(|m| m.span.start <= byte && byte <= m.span.end)?;
    Some((
        QualifiedName { noun: noun.into(), name, model: ModelLocation::File(path.to_path_buf()), span },
        defines,
    ))
}

/// The file of the model that a lab uses, if the byte is inside the model's name.
pub(super) fn model_named(lesson: &Lesson, models: &Models, byte: usize) -> Option<PathBuf> {
    let named = lesson.all_labs().into_iter().filter_map(|lab| lab.model.as_ref());
    let widgets = lesson.widgets.iter().filter_map(|widget| widget.model.as_ref());
    let text = named.chain(widgets).find(|t| t.span().start <= byte && byte <= t.span().end)?;
    models.folder().path(&text.value)
}

fn model_location(lab: &Lab, path: &Path, models: &Models) -> Option<ModelLocation> {
    match lab.scene()? {
        ModelSource::Model(name) => models.folder().path(&name.value).map(ModelLocation::File),
        ModelSource::Xml(_) => Some(ModelLocation::Lab(path.to_path_buf(), lab.span.clone())),
    }
}

/// All occurrences of a name in its model, and in the labs and claims that use this model.
pub(super) fn find_occurrences(name: &QualifiedName, scope: &SearchScope<'_>) -> Occurrences {
    let mut found = Occurrences::default();
    let mut contexts = ModelContexts::with_overlay(scope.overlay.clone());
    let files = match &name.model {
        ModelLocation::Lab(path, _) => {
            text_of(path, scope.open).into_iter().map(|file| (path.clone(), file)).collect()
        }
        ModelLocation::File(path) => {
            if let Some(file) = text_of(path, scope.open) {
                in_model(name, &file, |span| Some(span.clone()), file.text(), &mut found);
            }
            lessons_around(path, scope)
        }
    };
    for (path, file) in files {
        if !file.text().contains(&name.name) {
            continue;
        }
        let context = contexts.model_context(&path, scope.models_of);
        let lesson = load_lesson_at(file, &path, &context.sources, context.models.folder());
        in_lesson(name, &lesson, &path, &context.models, &mut found);
    }
    found
}

/// The lessons in the open folder that contains a model, otherwise in the parent of the folder of models.
fn lessons_around(model: &Path, scope: &SearchScope<'_>) -> Vec<(PathBuf, SourceFile)> {
    let opened = scope
        .folders
        .iter()
        .map(|folder| &folder.real)
        .filter(|folder| model.starts_with(folder))
        .min_by_key(|f| f.components().count());
    let above = model.parent().and_then(Path::parent);
    let Some(folder) = opened.map(PathBuf::as_path).or(above) else { return Vec::new() };
    let all = lessons_below(folder, scope.open).into_iter();
    all.map(|file| (PathBuf::from(&**file.path()), file)).collect()
}

/// Adds the occurrences in the text of the model.
fn in_model(
    name: &QualifiedName,
    file: &SourceFile,
    span_of: impl Fn(&Range<usize>) -> Option<Range<usize>>,
    xml: &str,
    found: &mut Occurrences,
) {
    let read = element_names(xml);
    for m in read.all.iter().filter(|m| m.noun == name.noun && m.name == name.name) {
        let span = span_of(&m.span);
        let plain = span.as_ref().is_some_and(|span| file.slice(span.clone()) == name.name);
        let span = span.unwrap_or_default();
        found.all.push(Occurrence { file: file.clone(), span, defines: m.defines, plain });
    }
    let ambiguity = |span: Range<usize>, why| Ambiguity { file: file.clone(), span, why };
    let texts = read.texts.into_iter().filter(|(text, _)| *text == name.name);
    found.ambiguities.extend(texts.map(|(_, span)| {
        ambiguity(span_of(&span).unwrap_or_default(), "this attribute may mean it, or something else")
    }));
    if read.composed.is_some() {
        found.ambiguities.push(ambiguity(0..0, "this model generates names, or takes them from other files"));
    }
}

/// Adds the occurrences in the labs and claims of a lesson that use this model.
fn in_lesson(name: &QualifiedName, lesson: &Lesson, path: &Path, models: &Models, found: &mut Occurrences) {
    let file = &lesson.file;
    let about = |lab: &Lab| model_location(lab, path, models).is_some_and(|location| location == name.model);
    let mut occurrence = |text: &Text, span: Range<usize>| {
        let span_in_file = text.span_of(span.clone());
        let plain = text.map.is_unbroken(span) && file.slice(span_in_file.clone()) == name.name;
        found.all.push(Occurrence { file: file.clone(), span: span_in_file, defines: false, plain });
    };
    let mut ambiguities = Vec::new();
    for piece in code::code_texts(lesson).into_iter().filter(|piece| about(piece.lab)) {
        let Some(model) = models.model_of_lab(piece.lab, &mut Vec::new()) else { continue };
        let readouts = labspec::verify::labels(piece.lab);
        let names = ModelNames::new(&model, piece.scope).showing(&readouts);
        let named = names_in(&names, &piece.text.value);
        for n in named.iter().filter(|n| n.name == name.name && names.noun(n.collection) == name.noun) {
            occurrence(piece.text, n.span.into());
        }
        // Texts that contain the name, alone or as one of several words, but do not refer to an object.
        let bears = |text: &str| {
            text.split(|c: char| !(c.is_alphanumeric() || "_-.".contains(c))).any(|w| w == name.name)
        };
        let loose = texts_in(&piece.text.value).into_iter().filter(|(text, span)| {
            (bears(text) || text == &name.name) && !named.iter().any(|n| n.span == *span)
        });
        ambiguities.extend(loose.map(|(_, span)| piece.text.span_of(span.into())));
    }
    for lab in lesson.all_labs().into_iter().filter(|lab| about(lab)) {
        if let Some(text) = lab.trail.as_ref().filter(|t| name.noun == "site" && t.value == name.name) {
            occurrence(text, 0..text.value.len());
        }
    }
    let why = "this text may mean it, or something else";
    found.ambiguities.extend(ambiguities.into_iter().map(|span| Ambiguity { file: file.clone(), span, why }));
    let broken = lesson.broken.iter().filter(|span| file.slice((*span).clone()).contains(&name.name));
    let why = "the JSON of this block must be fixed before it can be read";
    found.ambiguities.extend(broken.map(|span| Ambiguity { file: file.clone(), span: span.clone(), why }));
    // The model itself, if it is part of the lab.
    for lab in lesson.all_labs() {
        if let (ModelLocation::Lab(owner, span), Some(xml)) = (&name.model, &lab.xml)
            && owner == path
            && *span == lab.span
        {
            let whole =
                |span: &Range<usize>| xml.map.is_unbroken(span.clone()).then(|| xml.span_of(span.clone()));
            in_model(name, file, whole, &xml.value, found);
        }
    }
    found.all.dedup_by(|a, b| a.span == b.span && a.file.path() == b.file.path());
}

/// The locations of occurrences, as the editor names them.
pub(super) fn locations<'o>(
    occurrences: impl Iterator<Item = &'o Occurrence>,
    scope: &SearchScope<'_>,
) -> Vec<Location> {
    let location = |found: &Occurrence| {
        let range = convert::range(&found.file, &found.span);
        Some(Location { uri: scope.uri(Path::new(&**found.file.path()))?, range })
    };
    occurrences.filter_map(location).collect()
}

/// The start of a file.
pub(super) fn beginning(uri: Uri) -> Location {
    let zero = Position::new(0, 0);
    Location { uri, range: lsp_types::Range::new(zero, zero) }
}

/// Whether a document is a model file.
pub(super) fn is_model(document: &OpenDocument) -> bool {
    document.content.kind == FileKind::Model
}
