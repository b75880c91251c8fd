//! Interrupts: a flag that long work reads, so that finished results can still be printed (Ctrl-C), and one for the work of a single
//! thread that a newer request replaces.

use std::cell::RefCell;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, OnceLock};

static REQUESTED: OnceLock<Arc<AtomicBool>> = OnceLock::new();

/// Whether some thread has a flag of its own: as long as none has, nobody looks for one.
static OWN: AtomicBool = AtomicBool::new(false);

thread_local! {
    static HERE: RefCell<Option<Arc<AtomicBool>>> = const { RefCell::new(None) };
}

/// Whether long work on this thread must end: the flag of all threads is set, or that of this thread. It is never true in a program
/// that calls neither [`flag`] nor [`until`].
#[inline]
pub fn requested() -> bool {
    REQUESTED.get().is_some_and(|flag| flag.load(Ordering::Relaxed))
        || (OWN.load(Ordering::Relaxed) && here())
}

#[cold]
fn here() -> bool {
    HERE.with(|flag| flag.borrow().as_ref().is_some_and(|flag| flag.load(Ordering::Relaxed)))
}

/// Does work on this thread, and ends it early when the flag is set. The work asks [`requested`] between steps.
pub fn until<T>(flag: Arc<AtomicBool>, work: impl FnOnce() -> T) -> T {
    OWN.store(true, Ordering::Relaxed);
    let before = HERE.with(|here| here.replace(Some(flag)));
    let done = work();
    HERE.with(|here| here.replace(before));
    done
}

/// The flag that ends long work on all threads: the program sets it at Ctrl-C.
pub fn flag() -> Arc<AtomicBool> {
    REQUESTED.get_or_init(Arc::default).clone()
}
