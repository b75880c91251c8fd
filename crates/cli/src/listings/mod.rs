//! `labspec check --listings`: runs the Python listings of lessons whose output is displayed below them.
//!
//! A listing is code of somebody else. [`process`] runs it without a network and with limits, [`folder`] gives it a folder of its
//! own, and [`python`] finds the interpreter. [`labspec::listings`] compares what it prints.

mod environment;
mod folder;
mod process;
mod python;
mod settings;

pub(super) use settings::ListingSettings;

use super::cache::Cache;
use super::digest;
use folder::{RunFolder, SharedFiles, read_shared};
use labspec::finding::Finding;
use labspec::listings::{Listing, ListingResult, ListingRun, check_listing, is_as_displayed, pair_listings};
use labspec::spec::Lesson;
use process::{Ended, Limits, run_limited};
use python::Interpreter;
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};

/// A reason why a listing was not run, and what to do.
type NotRun = (String, String);

/// What the listings of one settings file share.
struct Setup {
    interpreter: Interpreter,
    shared: SharedFiles,
}

/// Runs listings. Each distinct listing runs once.
pub(super) struct ListingRunner<'c> {
    cache: &'c Cache,
    /// Per settings file: the interpreter and the shared files.
    setups: Mutex<BTreeMap<String, Result<Arc<Setup>, NotRun>>>,
    runs: Mutex<BTreeMap<String, ListingRun>>,
    files: Mutex<BTreeSet<PathBuf>>,
}

fn locked<T>(mutex: &Mutex<T>) -> std::sync::MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

impl<'c> ListingRunner<'c> {
    pub(super) fn new(cache: &'c Cache) -> ListingRunner<'c> {
        ListingRunner { cache, setups: Mutex::default(), runs: Mutex::default(), files: Mutex::default() }
    }

    /// Reads shared files again and runs listings again, for a check of changed files.
    pub(super) fn forget(&self) {
        locked(&self.setups).clear();
        locked(&self.runs).clear();
    }

    /// The shared files on which the results depend.
    pub(super) fn dependencies(&self) -> Vec<PathBuf> {
        locked(&self.files).iter().cloned().collect()
    }

    /// Runs the listings of a lesson and compares their outputs. Adds the findings.
    pub(super) fn check_lesson(
        &self,
        lesson: &Lesson,
        settings: &ListingSettings,
        findings: &mut Vec<Finding>,
    ) -> Vec<ListingResult> {
        let listings = pair_listings(lesson);
        let run = |listing: &Listing<'_>| match listing.path() {
            Some(path) => {
                self.run(listing, path, settings).unwrap_or_else(|(why, help)| ListingRun::NotRun(why, help))
            }
            // Refused with a finding.
            None => ListingRun::NotRun(String::new(), String::new()),
        };
        listings.iter().map(|listing| check_listing(listing, &run(listing), findings)).collect()
    }

    fn run(
        &self,
        listing: &Listing<'_>,
        path: &str,
        settings: &ListingSettings,
    ) -> Result<ListingRun, NotRun> {
        let setup = self.setup(settings)?;
        let key = key(listing, path, settings, &setup);
        if let Some(run) = locked(&self.runs).get(&key) {
            return Ok(run.clone());
        }
        let slot = format!("listing-{key}");
        let run = match self.cache.load_text(&slot).and_then(|text| serde_json::from_str(&text).ok()) {
            Some(run) => run,
            None => {
                let run = confirmed(listing, || execute(listing, path, settings, &setup))?;
                // A limit depends on the load of the machine.
                let is_final = matches!(run, ListingRun::Finished(_) | ListingRun::Failed(..));
                if let Some(text) =
                    Some(&run).filter(|_| is_final).and_then(|run| serde_json::to_string(run).ok())
                {
                    self.cache.save_text(&slot, &text);
                }
                run
            }
        };
        locked(&self.runs).insert(key, run.clone());
        Ok(run)
    }

    /// The interpreter and the shared files of these settings. They are prepared once, while other lessons wait.
    fn setup(&self, settings: &ListingSettings) -> Result<Arc<Setup>, NotRun> {
        let mut setups = locked(&self.setups);
        let name = format!("{settings:?}");
        if let Some(setup) = setups.get(&name) {
            return setup.clone();
        }
        let prepare = || {
            let shared = read_shared(settings)?;
            locked(&self.files).extend(shared.sources.iter().cloned());
            Ok(Arc::new(Setup { interpreter: find_interpreter(settings)?, shared }))
        };
        let setup = prepare();
        setups.insert(name, setup.clone());
        setup
    }
}

/// The interpreter that the settings state, or `python3`.
fn find_interpreter(settings: &ListingSettings) -> Result<Interpreter, NotRun> {
    if let Some(python) = &settings.python {
        let path = settings.folder.join(python);
        let path = if path.is_dir() { path.join("bin/python") } else { path };
        return Interpreter::describe(&path).map_err(|why| {
            let why = format!("the Python interpreter {python} does not run: {why}");
            (why, "correct `python` under [listings] in labspec.toml".into())
        });
    }
    let found = Interpreter::describe(Path::new("python3")).map_err(|why| {
        let why = format!("`python3` does not run: {why}");
        (why, "install Python 3, or name an interpreter: `python` under [listings] in labspec.toml".into())
    })?;
    match (&settings.project, settings.requirements.as_slice()) {
        (Some(project), _) => environment::of_project(&found, &settings.folder.join(project)),
        (None, []) => Ok(found),
        (None, requirements) => environment::with_packages(&found, requirements),
    }
}

/// The digest of everything on which the output of a listing depends.
fn key(listing: &Listing<'_>, path: &str, settings: &ListingSettings, setup: &Setup) -> String {
    let limits = format!("{} {} {}", settings.seconds, settings.memory, settings.network);
    let parts =
        ["listing 1", &listing.code.value, path, &limits, &setup.interpreter.identity, &setup.shared.digest];
    digest::hex_of(&parts.map(str::as_bytes))
}

/// The run of a listing. If the lesson displays another output, the listing runs once more: an output that varies is no
/// correction of the lesson.
fn confirmed(
    listing: &Listing<'_>,
    execute: impl Fn() -> Result<ListingRun, NotRun>,
) -> Result<ListingRun, NotRun> {
    let first = execute()?;
    let ListingRun::Finished(printed) = &first else { return Ok(first) };
    if is_as_displayed(listing, printed) {
        return Ok(first);
    }
    Ok(match execute()? {
        ListingRun::Finished(other) if other != *printed => ListingRun::Varies(printed.clone(), other),
        second => second,
    })
}

/// Runs a listing in a folder of its own.
fn execute(
    listing: &Listing<'_>,
    path: &str,
    settings: &ListingSettings,
    setup: &Setup,
) -> Result<ListingRun, NotRun> {
    let cannot = |e: std::io::Error| {
        (format!("its folder cannot be written: {e}"), "check the folder for temporary files".to_string())
    };
    let folder = RunFolder::create().map_err(cannot)?;
    folder.write(&setup.shared, path, &listing.code.value).map_err(cannot)?;
    let limits = Limits { seconds: settings.seconds, memory: settings.memory, network: settings.network };
    let ended = run_limited(&folder, &setup.interpreter.program, path, &limits)?;
    let place = format!("{}/", folder.work().display());
    Ok(match ended {
        Ended::Exit { code: 0, output, .. } => ListingRun::Finished(output),
        Ended::Exit { code, errors, .. } => ListingRun::Failed(code, errors.replace(&place, "")),
        Ended::Stopped { why, help } => ListingRun::Stopped(why, help),
    })
}
