//! `labspec preview`: what the program does for the server of `labspec_site`.

use super::build::PageOptions;
use super::cache::Cache;
use super::common::{CommandOutcome, Failure, ModelOptions};
use super::course::{CheckRequest, CrossCheckRequest};
use super::output::write_file;
use super::output_kind::OutputKind;
use super::policy::{Policies, PolicyOptions};
use super::scheduler::check_lessons;
use super::stdio::{print, print_error};
use super::target::model_folder_within;
use super::trace::describe_origin;
use super::watch::stamps;
use labspec::bind::scene::Models;
use labspec::check::{self, CheckLevel};
use labspec::finding::{Applicability, Finding};
use labspec::lint::{ModelFolder, reload_lesson};
use labspec::repair::{CheckedText, repair, traces};
use labspec::report::printable_path;
use labspec::spec::Lesson;
use labspec::verify::significant;
use labspec_proposals::scaffold::{Scaffold, ScaffoldOutcome, scaffold, written};
use labspec_proposals::trace::{format_verify, trace};
use labspec_site::preview::{
    Backend, CourseCheck, Fingerprint, PreviewOptions, Proposals, VerifyProposal, serve,
};
use std::collections::BTreeSet;
use std::num::NonZeroUsize;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// PreviewArguments of `preview`.
#[derive(clap::Args, Debug)]
pub(super) struct PreviewArguments {
    /// A lesson, or a folder of lessons
    #[arg(value_name = "LESSON|FOLDER")]
    path: PathBuf,
    /// The port on this machine [default: any that is free]
    #[arg(long, value_name = "N", default_value_t = 0, hide_default_value = true)]
    port: u16,
    /// Open the page in a browser
    #[arg(long)]
    open: bool,
    #[command(flatten)]
    page: PageOptions,
    #[command(flatten)]
    models: ModelOptions,
    #[command(flatten)]
    policy: PolicyOptions,
}

/// Serves the lessons until Ctrl-C.
pub(super) fn preview(a: &PreviewArguments) -> Result<CommandOutcome, Failure> {
    let page_files = a.page.files()?;
    Policies::new(&a.policy)?;
    let folder = match a.path.is_dir() {
        true => a.path.clone(),
        false => labspec::lint::lesson_folder(&a.path),
    };
    let author = Author { a, cache: Cache::open(false, true) };
    let options = PreviewOptions { port: a.port, site: a.page.site(None) };
    let mut ready = |url: &str| {
        if let Err(why) = print(&format!("{} is shown at {url} (Ctrl-C ends)\n", printable_path(&a.path))) {
            print_error(&format!("labspec: {why}\n"));
        }
        if a.open {
            open_browser(url);
        }
    };
    serve(&author, &folder, &options, &page_files, &mut ready)?;
    Ok(CommandOutcome::Clean)
}

/// Opens an address with the program of the system. The address is printed as well, so that a failure costs nothing.
fn open_browser(url: &str) {
    let program = if cfg!(target_os = "macos") {
        "open"
    } else if cfg!(windows) {
        "explorer"
    } else {
        "xdg-open"
    };
    let mut command = Command::new(program);
    let started = command.arg(url).stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null()).spawn();
    if started.is_err() {
        print_error(&format!("labspec: {program} is missing; open the address in a browser\n"));
    }
}

/// The work for the pages of one author.
struct Author<'a> {
    a: &'a PreviewArguments,
    /// Results are kept in memory: only what has changed is checked again.
    cache: Cache,
}

impl Author<'_> {
    fn paths(&self) -> &[PathBuf] {
        std::slice::from_ref(&self.a.path)
    }

    fn models_of(&self, lesson: &Path) -> Result<ModelFolder, Failure> {
        model_folder_within(&self.a.models, lesson, self.paths())
    }
}

impl Backend for Author<'_> {
    fn check(&self, level: CheckLevel) -> Result<CourseCheck, String> {
        let request = CheckRequest {
            paths: self.paths(),
            skip_others: false,
            stdin: None,
            models: &self.a.models,
            level,
            policy: &self.a.policy,
            baseline: None,
            listings: None,
            with_bases: false,
            cross_check: CrossCheckRequest::default(),
            with_curves: false,
            jobs: std::thread::available_parallelism().map_or(1, NonZeroUsize::get),
            progress: false,
            findings_in_color: None,
        };
        let results = check_lessons(&request, &self.cache)?;
        Ok(CourseCheck {
            lessons: results.checked,
            findings: results.findings,
            ledger: results.ledger,
            dependencies: results.dependencies,
        })
    }

    fn models(&self, lesson: &Path) -> ModelFolder {
        self.models_of(lesson).unwrap_or_else(|_| ModelFolder::unknown())
    }

    fn fingerprint(&self, others: &BTreeSet<PathBuf>) -> Fingerprint {
        let mut all = others.clone();
        all.extend(self.a.policy.config().map(Path::to_path_buf));
        stamps(self.paths(), &all)
    }

    fn fix(&self, path: &Path, lesson: &Lesson, finding: &Finding) -> Result<(), String> {
        let policy = Policies::new(&self.a.policy)?.policy_for(path)?;
        let models = Models::new(self.models_of(path)?);
        // All findings count, but only this one may be repaired.
        let look = |lesson: Lesson| {
            let found = check::run_checks(&lesson, &models, CheckLevel::FULL);
            let broken = lesson.broken.len();
            let checked = check::join(lesson, found, CheckLevel::FULL);
            let mut findings = checked.findings;
            let errors = findings.iter().filter(|f| f.is_error()).count();
            policy.apply(&mut findings);
            let is_other = |f: &&mut Finding| f.code != finding.code || f.fix != finding.fix;
            findings.iter_mut().filter(is_other).for_each(|f| f.fix = None);
            CheckedText { text: checked.lesson.file.text().to_string(), findings, errors, broken }
        };
        let again = |text: &str| look(reload_lesson(lesson, text, models.folder()));
        let displayed = |text: &str| traces(&reload_lesson(lesson, text, models.folder()), &models);
        let is_guess = finding.fix.as_ref().is_some_and(|fix| fix.applicability == Applicability::Unsafe);
        let (new, count) = repair(look(lesson.clone()), is_guess, &again, &displayed);
        match count {
            0 => Err(
                "the fix was tried and not applied: the finding would remain, or another one would appear"
                    .into(),
            ),
            _ => self.write(path, lesson.file.text(), &new),
        }
    }

    fn write(&self, path: &Path, old: &str, new: &str) -> Result<(), String> {
        write_file(path, OutputKind::Lesson(old), new)
    }

    fn propose(&self, path: &Path, lesson: &Lesson) -> Proposals {
        let Ok(folder) = self.models_of(path) else { return Proposals::default() };
        let models = Models::new(folder.clone());
        let found = trace(lesson, &models, &mut |_| {});
        let numbers = found.numbers.iter().map(|number| {
            let text = format!("{}{}", number.stated.quote, describe_origin(&number.origin, &found));
            (number.stated.span.clone(), text)
        });
        let numbers = numbers.collect();
        let all = scaffold(lesson, &models, &mut |_| {});
        Proposals { verify: all.iter().map(|one| proposal(lesson, one, &folder)).collect(), numbers }
    }
}

/// The lesson with one proposal. `None` if the object would change the meaning of the lesson; it is then only displayed.
fn with(lesson: &Lesson, one: &Scaffold, folder: &ModelFolder) -> Option<String> {
    let text = written(lesson, std::slice::from_ref(one), std::slice::from_ref(&one.address));
    let again = reload_lesson(lesson, &text, folder);
    (again.verifies().count() == lesson.verifies().count() + 1).then_some(text)
}

/// A proposal for a lab or a question, with the lesson in which it is inserted.
fn proposal(lesson: &Lesson, one: &Scaffold, folder: &ModelFolder) -> VerifyProposal {
    let (name, span) = (one.name.clone(), one.span.clone());
    let measured = |values: &[(String, f64)]| {
        values
            .iter()
            .map(|(name, value)| format!("{name} = {}", significant(*value)))
            .collect::<Vec<_>>()
            .join(", ")
    };
    match &one.found {
        ScaffoldOutcome::Proposed { verify, values, undecided, verdict } => {
            let mut note = vec![measured(values)];
            note.extend(verdict.as_ref().map(|(_, reason)| format!("the key holds {reason}")));
            note.extend(undecided.iter().map(|option| format!("option {option} is left open")));
            note.retain(|part| !part.trim().is_empty());
            let (text, note) = (format_verify(verify), note.join("; "));
            VerifyProposal { name, span, text, note, lesson: with(lesson, one, folder) }
        }
        ScaffoldOutcome::Skeleton { why, verify } => {
            let (text, note) = (format_verify(verify), format!("not decided: {why}; a skeleton"));
            VerifyProposal { name, span, text, note, lesson: with(lesson, one, folder) }
        }
        ScaffoldOutcome::Contradicted { option, values } => {
            let note =
                format!("the runs support option {}, which is not the key: {}", option + 1, measured(values));
            VerifyProposal { name, span, text: String::new(), note, lesson: None }
        }
        ScaffoldOutcome::Open(why) => VerifyProposal {
            name,
            span,
            text: String::new(),
            note: format!("left open: {why}"),
            lesson: None,
        },
    }
}
