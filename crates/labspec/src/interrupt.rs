//! Ctrl-C: a flag that long work looks at, so that what is finished can still be printed.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, LazyLock};

static REQUESTED: LazyLock<Arc<AtomicBool>> = LazyLock::new(Arc::default);

/// Whether the person at the terminal wants an end. Never true in a program that does not call [`listen`].
#[inline]
pub(crate) fn requested() -> bool {
    REQUESTED.load(Ordering::Relaxed)
}

/// From now on Ctrl-C sets the flag; a second one ends the program at once, with exit code 130.
pub(crate) fn listen() {
    #[cfg(any(unix, windows))]
    {
        use signal_hook::{consts::SIGINT, flag};
        // The handlers run in this order. Where they cannot be set, Ctrl-C ends the program as it always does.
        if flag::register_conditional_shutdown(SIGINT, 130, REQUESTED.clone()).is_ok() {
            let _ = flag::register(SIGINT, REQUESTED.clone());
        }
    }
}
