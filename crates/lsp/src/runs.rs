//! What only runs find, on a thread of its own: started when a lesson is saved, stopped when newer text comes.

use labspec::bind::scene::Models;
use labspec::check::{self, CheckLevel};
use labspec::finding::Finding;
use labspec::interrupt;
use labspec::lint::load_lesson_at;
use labspec::source::{SourceFile, Sources};
use labspec::threads;
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// What was found of a version of a document.
#[derive(Debug)]
pub(super) struct FinishedJob {
    /// Of which check this is the outcome.
    pub(super) job: u64,
    pub(super) uri: String,
    pub(super) version: i32,
    pub(super) findings: Vec<Finding>,
}

/// A check that goes on.
#[derive(Debug)]
pub(super) struct Job {
    /// Counted by whoever starts it.
    pub(super) number: u64,
    pub(super) uri: String,
    stop: Arc<AtomicBool>,
}

impl Job {
    /// Checks a text with all its runs. `done` is called at the end, unless it was stopped.
    pub(super) fn start(
        number: u64,
        uri: &str,
        version: i32,
        (file, path): (SourceFile, PathBuf),
        (models, sources): (Arc<Models>, Sources),
        done: impl FnOnce(FinishedJob) + Send + 'static,
    ) -> Option<Job> {
        let (stop, uri) = (Arc::new(AtomicBool::new(false)), uri.to_string());
        let (asked, of) = (stop.clone(), uri.clone());
        let work = move || {
            let findings = interrupt::until(asked.clone(), || {
                let lesson = load_lesson_at(file, &path, &sources, models.folder());
                check::check_lesson(lesson, &models, CheckLevel::FULL).findings
            });
            // What a run that was stopped says is not used.
            if !asked.load(Ordering::Relaxed) {
                done(FinishedJob { job: number, uri: of, version, findings });
            }
        };
        threads::checking().spawn(work).ok()?;
        Some(Job { number, uri, stop })
    }

    /// Its outcome is no longer wanted.
    pub(super) fn stop(&self) {
        self.stop.store(true, Ordering::Relaxed);
    }
}
