//! Ctrl-C: a flag that long work looks at, so that what is finished can still be printed.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, OnceLock};

static REQUESTED: OnceLock<Arc<AtomicBool>> = OnceLock::new();

/// Whether the person at the terminal wants an end. Never true in a program that does not call [`listen`].
#[inline]
pub(crate) fn requested() -> bool {
    REQUESTED.get().is_some_and(|flag| flag.load(Ordering::Relaxed))
}

/// From now on Ctrl-C sets the flag; a second one ends the program at once, with exit code 130.
#[cfg(feature = "cli")]
pub(crate) fn listen() {
    #[cfg(any(unix, windows))]
    {
        use signal_hook::{consts::SIGINT, flag};
        let requested = REQUESTED.get_or_init(Arc::default);
        // The handlers run in this order. Where they cannot be set, Ctrl-C ends the program as it always does.
        if flag::register_conditional_shutdown(SIGINT, 130, requested.clone()).is_ok() {
            let _ = flag::register(SIGINT, requested.clone());
        }
    }
}
