//! From a text to a lab that is ready to play.

use super::{Player, Saved, control, displayed};
use crate::bind::Functions;
use crate::bind::scene::Models;
use crate::check;
use crate::error::{Error, located};
use crate::finding::Finding;
use crate::lint::ModelFolder;
use crate::lint::load_lesson;
use crate::run::{Session, Start};
use crate::source::SourceFile;
use crate::spec::LabAddress;
use labspec_core::reflect::FieldSet;
use labspec_core::{AccessSet, Plan};
use std::sync::Arc;

impl Player {
    /// Opens a lab from its JSON. `models` are what it may name: a map, a closure, a folder, or
    /// [`NoModels`](crate::NoModels).
    ///
    /// # Errors
    /// It is no lab, or its model has mistakes. Mistakes in its code stop nothing: as on every page, what has one shows
    /// nothing, and [`Player::findings`] says why.
    pub fn of_lab(json: &str, models: impl Into<ModelFolder>) -> Result<Player, Error> {
        Player::of_lesson("lab.json", json, "#1", models)
    }

    /// Opens a lab of a lesson by its address: `#2` is the second one, `#quiz-id.1` that of a question. The ending of
    /// `path` says what the text is: Markdown or JSON.
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

    /// The same with functions of one's own, which the texts of the lab may call.
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
        for finding in &mut loaded {
            let path = if finding.path.is_empty() { lesson.file.path() } else { &finding.path };
            if let Some(file) = files.iter().find(|file| file.path() == path) {
                *finding = located(finding.clone(), file);
            }
        }
        let Some((model, programs, _)) = bound else {
            loaded.retain(Finding::is_error);
            return Err(Error::Findings(loaded));
        };
        let lab = Arc::new(lab.clone());
        // Whoever draws a scene may read everything.
        let access = AccessSet { reads: FieldSet::ALL, ..programs.access };
        let start = Start { plan: Some(Plan::new(&model, &access)), ..Start::of_lab(&lab) };
        let mut session = Session::start(Arc::new(programs), &model, start);
        session.watch();
        let (controls, displayed) = (control::list(&lab), displayed::list(&lab));
        let now = Saved { lab: Arc::clone(&lab), session, cells: Vec::new(), numbers: Vec::new() };
        let mut player = Player { lab, file: lesson.file.clone(), loaded, controls, displayed, now };
        player.observe();
        Ok(player)
    }
}
