//! Loads a lab from a text.

use super::{Player, Saved, control, displayed};
use crate::bind::scene::Models;
use crate::bind::{Functions, Programs, compile_to_play};
use crate::check;
use crate::error::{Error, located};
use crate::finding::{Finding, InFile};
use crate::lint::{ModelFolder, load_lesson, to_finding};
use crate::run::{Session, Start};
use crate::source::SourceFile;
use crate::spec::{Lab, LabAddress, read_lab_json};
use labspec_core::Model;
use std::sync::Arc;

impl Player {
    /// Opens a lab from its JSON. `models` contains the models that it may name: a map, a closure, a folder, or
    /// [`NoModels`](crate::NoModels).
    ///
    /// The findings are the errors in its JSON, its model and its code, which a page needs. The rules for lessons are not
    /// applied; [`Checker`](crate::Checker) and [`Player::of_lesson`] apply them.
    ///
    /// # Errors
    /// The text is not a lab, or its model has errors. Errors in its code do not prevent loading: as on every page, a text
    /// with an error displays nothing, and [`Player::findings`] contains the reason.
    pub fn of_lab(json: &str, models: impl Into<ModelFolder>) -> Result<Player, Error> {
        Player::open(json, &models.into())
    }

    fn open(json: &str, models: &ModelFolder) -> Result<Player, Error> {
        let file = SourceFile::new("lab.json", json);
        let (lab, problems) = read_lab_json(&file);
        let mut loaded: Vec<Finding> = problems.iter().map(|p| to_finding(json, p).at(&file)).collect();
        let Some(lab) = lab else {
            loaded.retain(Finding::is_error);
            return Err(match loaded.is_empty() {
                true => Error::Call("lab.json has no lab".into()),
                false => Error::Findings(loaded.into_iter().map(|f| located(f, &file)).collect()),
            });
        };
        let compiled = compile_to_play(&lab, models);
        loaded.extend(compiled.findings);
        let model = compiled.model.map(Arc::new);
        let programs = model.map(|model| {
            let programs = Programs::compile(&lab, &model, &mut loaded);
            (model, programs)
        });
        let files: Vec<&SourceFile> = std::iter::once(&file).chain(&compiled.files).collect();
        locate(&mut loaded, &files);
        let Some((model, programs)) = programs else {
            loaded.retain(Finding::is_error);
            return Err(Error::Findings(loaded));
        };
        Ok(Player::start(Arc::new(lab), file.clone(), loaded, &model, programs))
    }

    /// Opens a lab of a lesson by its address: `#2` is the second one, `#quiz-id.1` that of a question. The extension of
    /// `path` determines the format: Markdown or JSON.
    ///
    /// # Errors
    /// As for [`Player::of_lab`], and when there is no lab at this address.
    pub fn of_lesson(
        path: &str,
        text: &str,
        address: &str,
        models: impl Into<ModelFolder>,
    ) -> Result<Player, Error> {
        Player::of_lesson_with(path, text, address, models, Functions::new())
    }

    /// Like [`Player::of_lesson`], with functions of the embedding program that the texts of the lab may call.
    ///
    /// # Errors
    /// As for [`Player::of_lesson`].
    pub fn of_lesson_with(
        path: &str,
        text: &str,
        address: &str,
        models: impl Into<ModelFolder>,
        functions: Functions,
    ) -> Result<Player, Error> {
        let mut models = Models::new(models.into()).with_functions(functions);
        let lesson = load_lesson(SourceFile::new(path, text), models.folder());
        let Some(lab) = LabAddress::parse(address).and_then(|address| lesson.lab(&address)) else {
            let errors = lesson.findings.iter().filter(|f| f.is_error()).cloned();
            let errors: Vec<Finding> = errors.map(|f| located(f, &lesson.file)).collect();
            let addresses: Vec<String> =
                lesson.addressed().iter().map(|(address, _)| address.to_string()).collect();
            return Err(match (addresses.is_empty(), errors.is_empty()) {
                (false, _) => {
                    Error::Call(format!("this lesson has no lab {address}; it has {}", addresses.join(", ")))
                }
                (true, false) => Error::Findings(errors),
                (true, true) => Error::Call(format!("{path} has no lab")),
            });
        };
        let within = |f: &Finding| lab.span.start <= f.span.start && f.span.end <= lab.span.end;
        let mut loaded: Vec<Finding> = lesson.findings.iter().filter(|f| within(f)).cloned().collect();
        let bound = check::bind(lab, &models, &mut loaded);
        loaded.extend(models.take_findings());
        let files: Vec<&SourceFile> = std::iter::once(&lesson.file).chain(models.files()).collect();
        locate(&mut loaded, &files);
        let Some((model, programs, _)) = bound else {
            loaded.retain(Finding::is_error);
            return Err(Error::Findings(loaded));
        };
        Ok(Player::start(Arc::new(lab.clone()), lesson.file.clone(), loaded, &model, programs))
    }

    /// Opens a lab of a lesson whose texts are compiled, see [`check::bind`].
    pub fn of_compiled(lab: &Lab, file: &SourceFile, model: &Model, programs: Programs) -> Player {
        Player::start(Arc::new(lab.clone()), file.clone(), Vec::new(), model, programs)
    }

    /// A lab at its start.
    fn start(
        lab: Arc<Lab>,
        file: SourceFile,
        loaded: Vec<Finding>,
        model: &Model,
        programs: Programs,
    ) -> Player {
        let mut session = Session::start(Arc::new(programs), model, Start::of_lab(&lab));
        session.watch();
        let (controls, displayed) = (control::list(&lab), displayed::list(&lab));
        let current = Saved { lab: Arc::clone(&lab), session, cells: Vec::new(), numbers: Vec::new() };
        let mut player = Player { lab, file, loaded, controls, displayed, current, scene: None };
        player.observe();
        player
    }
}

/// Sets the lines and columns of findings. A finding without a path belongs to the first file.
fn locate(findings: &mut [Finding], files: &[&SourceFile]) {
    let Some(first) = files.first() else { return };
    for finding in findings {
        let path = if finding.path.is_empty() { first.path() } else { &finding.path };
        if let Some(file) = files.iter().find(|file| file.path() == path) {
            *finding = located(finding.clone(), file);
        }
    }
}
