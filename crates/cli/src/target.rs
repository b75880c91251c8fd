//! The target of a command: a lab in a file, or a model.

use super::common::{Failure, ModelOptions};
use labspec::bind::Programs;
use labspec::bind::scene::{Compiled, Models, compile_file};
use labspec::finding::{Finding, InFile, Severity};
use labspec::lint::{ModelFolder, lesson_folder, load_lesson_at, root_of};
use labspec::report::{self, printable};
use labspec::source::{SourceFile, SourceMap, Sources, Text};
use labspec::spec::{Lab, LabAddress, Lesson};
use labspec_core::Model;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// The folder of models for a file that the user named.
pub(super) fn model_folder(options: &ModelOptions, file: &Path) -> Result<ModelFolder, Failure> {
    model_folder_within(options, file, &[])
}

/// The folder of models for a file; `named` are the files and folders that the user named.
pub(super) fn model_folder_within(
    options: &ModelOptions,
    file: &Path,
    named: &[PathBuf],
) -> Result<ModelFolder, Failure> {
    let Some(folder) = options.models.clone().or_else(|| ModelFolder::find_near(file)) else {
        return Ok(ModelFolder::unknown());
    };
    let mut around: Vec<PathBuf> = named.iter().filter(|p| p.is_dir()).cloned().collect();
    if options.models.is_none() {
        around.push(lesson_folder(file));
    }
    let root = root(options, &folder, &around)?;
    ModelFolder::below(&root, &folder).map_err(|e| {
        format!("cannot read the model folder {}: {e}; name another one with --models", folder.display())
    })
}

/// The root below which the models of a folder may read files: that of `--root`, otherwise the one
/// given by the enclosing folders.
pub(super) fn root(options: &ModelOptions, models: &Path, named: &[PathBuf]) -> Result<PathBuf, Failure> {
    let Some(root) = &options.root else { return Ok(root_of(models, named)) };
    let real = root.canonicalize().map_err(|e| format!("cannot read the root {}: {e}", root.display()))?;
    match models.canonicalize() {
        Ok(models) if !models.starts_with(&real) => Err(format!(
            "the models in {} are outside the root {}; name a folder that holds both with --root",
            models.display(),
            root.display()
        )),
        _ => Ok(real),
    }
}

/// A lab that is ready to run.
pub(super) struct LabTarget {
    pub(super) lab: Lab,
    pub(super) model: Arc<Model>,
    pub(super) programs: Programs,
}

/// Opens `LAB.json`, `LESSON.md#2`, `LESSON.md#quiz-id.1` or `MODEL.xml` (a lab with only a model).
pub(super) fn open(argument: &str, options: &ModelOptions) -> Result<LabTarget, Failure> {
    let (path, address) = split(argument)?;
    if path.extension().is_some_and(|e| e == "xml") {
        return bare_model(&path, options);
    }
    let file = SourceFile::read(&path)?;
    let folder = model_folder(options, &path)?;
    let lesson = load_lesson_at(file, &path, &Sources::Disk, &folder);
    let lab = choose(&lesson, address.as_ref(), argument)?.clone();
    let mut models = Models::new(folder);
    let mut findings: Vec<Finding> = lesson.findings.clone();
    let model = models.model_of_lab(&lab, &mut findings);
    let programs = model.as_ref().map(|m| Programs::compile(&lab, m, &mut findings));
    let mut findings: Vec<Finding> =
        findings.into_iter().map(|f| if f.path.is_empty() { f.at(&lesson.file) } else { f }).collect();
    findings.extend(models.take_findings());
    // Only errors that concern this lab are reported; `check` reports everything.
    findings.retain(|f| f.severity == Severity::Error && (f.path != *lesson.file.path() || within(&lab, f)));
    match (model, programs) {
        (Some(model), Some(programs)) if findings.is_empty() => Ok(LabTarget { lab, model, programs }),
        _ => {
            let mut files: Vec<&SourceFile> = vec![&lesson.file];
            files.extend(models.files());
            let list = report::human(&findings, &files, false);
            let why = if list.is_empty() { String::new() } else { format!("\n\n{}", list.trim_end()) };
            Err(format!(
                "the lab {argument} cannot run; `labspec check {}` reports everything{why}",
                path.display()
            ))
        }
    }
}

/// The files that [`open`] read for a lab, as far as they have names. No output may overwrite them.
pub(super) fn read_for(argument: &str, options: &ModelOptions, lab: &Lab) -> Vec<PathBuf> {
    let Ok((path, _)) = split(argument) else { return Vec::new() };
    let model = lab.model.as_ref().and_then(|name| model_folder(options, &path).ok()?.path(&name.value));
    std::iter::once(path).chain(model).collect()
}

fn within(lab: &Lab, f: &Finding) -> bool {
    lab.span.start <= f.span.start && f.span.end <= lab.span.end
}

/// The path and the address of `LESSON.md#2`. A `#` in the name of an existing file is not a separator.
fn split(argument: &str) -> Result<(PathBuf, Option<LabAddress>), Failure> {
    if Path::new(argument).exists() {
        return Ok((PathBuf::from(argument), None));
    }
    match argument.split_once('#') {
        Some((path, address)) => match LabAddress::parse(&format!("#{address}")) {
            Some(parsed) => Ok((PathBuf::from(path), Some(parsed))),
            None => Err(format!(
                "`#{address}` is not the address of a lab; write LESSON.md#2 or LESSON.md#quiz-id.1"
            )),
        },
        None => Ok((PathBuf::from(argument), None)),
    }
}

fn choose<'l>(lesson: &'l Lesson, address: Option<&LabAddress>, argument: &str) -> Result<&'l Lab, Failure> {
    let addresses: Vec<String> =
        lesson.addressed().iter().map(|(a, _)| printable(&a.to_string()).into_owned()).collect();
    let argument = printable(argument);
    match address {
        Some(address) => lesson.lab(address).ok_or_else(|| match addresses.as_slice() {
            [] => format!("{argument}: the file has no readable lab; `labspec check` says why"),
            _ => format!("this file has no lab {address}; it has {}", addresses.join(", ")),
        }),
        None => match lesson.addressed().as_slice() {
            [] => Err(format!("{argument} has no readable lab; `labspec check {argument}` says why")),
            [(_, lab)] => Ok(lab),
            _ => Err(format!("{argument} has several labs: add one of {} to its name", addresses.join(", "))),
        },
    }
}

/// A model as a lab without displays.
fn bare_model(path: &Path, options: &ModelOptions) -> Result<LabTarget, Failure> {
    let model = Arc::new(load_model(path, options)?);
    let text = Text { value: String::new(), map: SourceMap::point(0) };
    let lab = Lab::of_model(text);
    let programs = Programs::compile(&lab, &model, &mut Vec::new());
    Ok(LabTarget { lab, model, programs })
}

/// Compiles a model file. Warnings are left to `check`.
pub(super) fn load_model(path: &Path, options: &ModelOptions) -> Result<Model, Failure> {
    let file = SourceFile::read(path)?;
    let root = root(options, &lesson_folder(path), &[])?;
    let Compiled { model, mut findings, files, .. } = compile_file(&file, path, &root, &Sources::Disk, None);
    findings.retain(|f| f.severity == Severity::Error);
    model.ok_or_else(|| {
        let files: Vec<&SourceFile> = files.iter().collect();
        let list = report::human(&findings, &files, false);
        format!("the model {} does not load\n\n{}", path.display(), list.trim_end())
    })
}
