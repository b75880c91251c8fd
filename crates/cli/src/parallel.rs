//! Checks files on several threads, and prints their output in the order of the files.

use super::common::Failure;
use super::stdio::{clear_progress, print};
use labspec::threads;
use std::collections::BTreeMap;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};

/// Applies `work` to each item, on this thread and at most `threads - 1` others; returns the results in the order of the items.
pub(super) fn map_in_parallel<T: Sync, R: Send>(
    items: &[T],
    threads: usize,
    work: impl Fn(usize, &T) -> R + Sync,
) -> Vec<R> {
    let next = AtomicUsize::new(0);
    let take_items = || {
        let mut results = Vec::new();
        loop {
            let i = next.fetch_add(1, Ordering::Relaxed);
            let Some(item) = items.get(i) else { return results };
            results.push((i, work(i, item)));
        }
    };
    let mut results = std::thread::scope(|scope| {
        let others = 1..threads.min(items.len());
        // If the system provides no further thread, the existing ones do all the work.
        let spawn = || threads::checking().spawn_scoped(scope, take_items).ok();
        let threads: Vec<_> = others.map_while(|_| spawn()).collect();
        let mut results = take_items();
        for thread in threads {
            match thread.join() {
                Ok(more) => results.extend(more),
                Err(panic) => std::panic::resume_unwind(panic),
            }
        }
        results
    });
    results.sort_by_key(|(i, _)| *i);
    results.into_iter().map(|(_, result)| result).collect()
}

/// Prints a text for each file as soon as the texts of all files before it are printed.
pub(super) struct OrderedPrinter {
    queue: Mutex<PrintQueue>,
    /// Whether a progress line must be cleared before something is printed.
    progress: bool,
}

#[derive(Default)]
struct PrintQueue {
    /// The number of files whose texts are printed.
    printed: usize,
    /// The texts of later files.
    waiting: BTreeMap<usize, String>,
    /// The reason why nothing more can be printed.
    failure: Option<Failure>,
}

impl OrderedPrinter {
    pub(super) fn new(progress: bool) -> OrderedPrinter {
        OrderedPrinter { queue: Mutex::default(), progress }
    }

    /// Adds the text of a file.
    pub(super) fn add(&self, file: usize, text: String) {
        let mut queue = self.queue.lock().unwrap_or_else(PoisonError::into_inner);
        queue.waiting.insert(file, text);
        let mut ready = String::new();
        loop {
            let next = queue.printed;
            let Some(text) = queue.waiting.remove(&next) else { break };
            ready.push_str(&text);
            queue.printed += 1;
        }
        if !ready.is_empty() && queue.failure.is_none() {
            if self.progress {
                clear_progress();
            }
            queue.failure = print(&ready).err();
        }
    }

    /// # Errors
    /// Something could not be printed.
    pub(super) fn finish(self) -> Result<(), Failure> {
        let queue = self.queue.into_inner().unwrap_or_else(PoisonError::into_inner);
        queue.failure.map_or(Ok(()), Err)
    }
}
