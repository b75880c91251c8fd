//! The pages that wait for a change: server-sent events with the number of the newest version.

use std::io::Write;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Condvar, Mutex, PoisonError};
use std::time::Duration;

/// The maximum number of pages that wait.
const MAX_PAGES: usize = 64;
/// The time after which an idle connection is tested.
const PING: Duration = Duration::from_secs(10);
const HEAD: &[u8] = b"HTTP/1.1 200 OK\r\nContent-Type: text/event-stream\r\nCache-Control: no-store\r\n\
X-Content-Type-Options: nosniff\r\nConnection: close\r\n\r\nretry: 500\n\n";

/// The newest version, and the pages that wait for a newer one.
#[derive(Debug, Default)]
pub(super) struct EventHub {
    version: Mutex<u64>,
    changed: Condvar,
    pages: AtomicUsize,
}

impl EventHub {
    /// Announces a version.
    pub(super) fn announce(&self, version: u64) {
        *self.version.lock().unwrap_or_else(PoisonError::into_inner) = version;
        self.changed.notify_all();
    }

    /// Sends every version to a page until it is closed.
    pub(super) fn follow(&self, out: &mut dyn Write) {
        if self.pages.fetch_add(1, Ordering::SeqCst) < MAX_PAGES {
            // The page has been closed.
            let _ = self.send(out);
        } else {
            let _ = out.write_all(
                b"HTTP/1.1 503 Service Unavailable\r\nContent-Length: 0\r\nConnection: close\r\n\r\n",
            );
        }
        self.pages.fetch_sub(1, Ordering::SeqCst);
    }

    fn send(&self, out: &mut dyn Write) -> std::io::Result<()> {
        out.write_all(HEAD)?;
        let mut sent = None;
        loop {
            let guard = self.version.lock().unwrap_or_else(PoisonError::into_inner);
            let (guard, _) = self
                .changed
                .wait_timeout_while(guard, PING, |version| sent == Some(*version))
                .unwrap_or_else(PoisonError::into_inner);
            let version = *guard;
            drop(guard);
            match sent == Some(version) {
                true => out.write_all(b": waiting\n\n")?,
                false => out.write_all(format!("data: {version}\n\n").as_bytes())?,
            }
            out.flush()?;
            sent = Some(version);
        }
    }
}
