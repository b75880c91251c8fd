//! Long work on a thread of its own, while this one listens to Ctrl-C and reports progress.

use crate::error::error;
use facade::{interrupt, threads};
use pyo3::prelude::*;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, channel};
use std::thread::{self, ScopedJoinHandle};
use std::time::Duration;

/// The time between two looks at Ctrl-C.
const BETWEEN_SIGNALS: Duration = Duration::from_millis(5);

/// Performs work without the interpreter. The work reports what it does, and `progress`, a function of Python, is called with it.
/// Ctrl-C and an error of `progress` end the work.
pub(crate) fn run<T: Send>(
    py: Python<'_>,
    progress: Option<Py<PyAny>>,
    work: impl FnOnce(&mut dyn FnMut(&str)) -> T + Send,
) -> PyResult<T> {
    let stop = Arc::new(AtomicBool::new(false));
    let (send, reported) = channel::<String>();
    let flag = Arc::clone(&stop);
    let performed = move || {
        let mut report = |text: &str| {
            // Nobody listens after an error.
            let _ = send.send(text.to_string());
        };
        interrupt::until(flag, || threads::catch_panic(|| work(&mut report)))
    };
    let done = py.detach(move || {
        thread::scope(|scope| {
            let worker = threads::checking()
                .spawn_scoped(scope, performed)
                .map_err(|e| error("thread", &format!("cannot start a thread: {e}"), &[]))?;
            let listened = listen(&worker, &reported, progress.as_ref());
            if listened.is_err() {
                stop.store(true, Ordering::Relaxed);
            }
            let done = worker.join().unwrap_or_else(|_| Err("its thread ended".to_string()));
            listened.map(|()| done)
        })
    })?;
    done.map_err(|panic| error("panic", &format!("labspec failed: {panic}; report it with this lab"), &[]))
}

/// Listens until the work is done and everything that it reported has been passed on.
fn listen<T>(
    worker: &ScopedJoinHandle<'_, T>,
    reported: &Receiver<String>,
    progress: Option<&Py<PyAny>>,
) -> PyResult<()> {
    loop {
        let is_finished = worker.is_finished();
        let text =
            if is_finished { reported.try_recv().ok() } else { reported.recv_timeout(BETWEEN_SIGNALS).ok() };
        if is_finished && text.is_none() {
            return Ok(());
        }
        Python::attach(|py| {
            py.check_signals()?;
            match (&text, progress) {
                (Some(text), Some(progress)) => progress.call1(py, (text,)).map(drop),
                _ => Ok(()),
            }
        })?;
    }
}
