//! Findings that require runs, and the results of the runs, computed on a separate thread. It is started when a lesson is saved, and
//! cancelled when the text changes.

use labspec::bind::scene::Models;
use labspec::check::{self, CheckLevel};
use labspec::finding::Finding;
use labspec::interrupt;
use labspec::source::Sources;
use labspec::threads;
use labspec_assist::{DocumentText, RunValues, reported, run_values};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// The findings for a version of a document.
#[derive(Debug)]
pub(super) struct FinishedJob {
    /// The number of the check.
    pub(super) job: u64,
    pub(super) uri: String,
    pub(super) version: i32,
    /// The findings, and the results of the runs; `None` if a panic ended the check.
    pub(super) outcome: Option<(Vec<Finding>, RunValues)>,
}

/// A check in progress.
#[derive(Debug)]
pub(super) struct RunningCheck {
    /// A consecutive number, assigned by the caller.
    pub(super) number: u64,
    pub(super) uri: String,
    stop: Arc<AtomicBool>,
}

impl RunningCheck {
    /// Starts a check of a text with all its runs. `done` is called at the end, unless the check was cancelled.
    pub(super) fn start(
        number: u64,
        uri: &str,
        version: i32,
        text: DocumentText,
        (models, sources): (Arc<Models>, Sources),
        done: impl FnOnce(FinishedJob) + Send + 'static,
    ) -> Option<RunningCheck> {
        let (stop, uri) = (Arc::new(AtomicBool::new(false)), uri.to_string());
        let (asked, document) = (stop.clone(), uri.clone());
        let work = move || {
            let check = || {
                let lesson = text.load(&sources, models.folder());
                let checked = check::check_lesson(lesson, &models, CheckLevel::FULL);
                let values = run_values(&checked);
                (reported(checked), values)
            };
            let outcome = threads::catch_panic(|| interrupt::until(asked.clone(), check)).ok();
            // The results of a cancelled check are discarded.
            if !asked.load(Ordering::Relaxed) {
                done(FinishedJob { job: number, uri: document, version, outcome });
            }
        };
        threads::checking().spawn(work).ok()?;
        Some(RunningCheck { number, uri, stop })
    }

    /// Cancels the check.
    pub(super) fn stop(&self) {
        self.stop.store(true, Ordering::Relaxed);
    }
}
