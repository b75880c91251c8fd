//! Interrupts: a flag that long computations read, so that finished results can still be printed (Ctrl-C), and a flag for
//! the computation of a single thread that a newer request replaces.

use std::cell::RefCell;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, OnceLock};

static REQUESTED: OnceLock<Arc<AtomicBool>> = OnceLock::new();

/// Whether any thread has its own flag; otherwise none is looked up.
static ANY_THREAD_FLAG: AtomicBool = AtomicBool::new(false);

thread_local! {
    static THREAD_FLAG: RefCell<Option<Arc<AtomicBool>>> = const { RefCell::new(None) };
}

/// Whether long computations on this thread must stop: the flag of all threads or that of this thread is set. It is never
/// true in a program that calls neither [`flag`] nor [`until`].
#[inline]
pub fn requested() -> bool {
    REQUESTED.get().is_some_and(|flag| flag.load(Ordering::Relaxed))
        || (ANY_THREAD_FLAG.load(Ordering::Relaxed) && here())
}

#[cold]
fn here() -> bool {
    THREAD_FLAG.with(|flag| flag.borrow().as_ref().is_some_and(|flag| flag.load(Ordering::Relaxed)))
}

/// Runs `work` on this thread, and stops it early when the flag is set. The work calls [`requested`] between steps.
pub fn until<T>(flag: Arc<AtomicBool>, work: impl FnOnce() -> T) -> T {
    ANY_THREAD_FLAG.store(true, Ordering::Relaxed);
    let before = THREAD_FLAG.with(|here| here.replace(Some(flag)));
    let done = work();
    THREAD_FLAG.with(|here| here.replace(before));
    done
}

/// The flag that stops long computations on all threads: the program sets it at Ctrl-C.
pub fn flag() -> Arc<AtomicBool> {
    REQUESTED.get_or_init(Arc::default).clone()
}
