//! The server: a loop of requests, one of quick checks after every change, and one of whole checks.

use super::actions::{Ask, act};
use super::backend::{Backend, CourseCheck, Fingerprint};
use super::events::EventHub;
use super::guard::{ACTIONS, ServerIdentity, headers};
use super::http::{RequestHead, drain, read_body, read_head, write_answer};
use super::snapshot::{Snapshot, SnapshotMaterial};
use crate::assets::PageFiles;
use crate::options::{SiteFile, SiteOptions};
use labspec::check::CheckLevel;
use labspec::threads;
use percent_encoding::percent_decode_str;
use std::net::{TcpListener, TcpStream};
use std::path::Path;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Condvar, Mutex, PoisonError};
use std::time::Duration;

/// The interval between two inspections of the files.
const PAUSE: Duration = Duration::from_millis(250);
/// The maximum number of requests that are answered at the same time.
const MAX_REQUESTS: usize = 96;
/// The maximum size of a request in bytes.
const MAX_BODY: u64 = 20 << 20;

/// The options of a preview.
#[derive(Clone, Debug, Default)]
pub struct PreviewOptions {
    /// The port; 0 for any that is free.
    pub port: u16,
    /// What the pages say of themselves.
    pub site: SiteOptions,
}

/// The state that all threads share.
struct Shared<'s> {
    material: SnapshotMaterial<'s>,
    identity: &'s ServerIdentity,
    hub: EventHub,
    snapshot: Mutex<Arc<Snapshot>>,
    /// The files of the newest version, and whether the whole check of it is made.
    newest: Mutex<(Fingerprint, bool)>,
    changed: Condvar,
    requests: AtomicUsize,
    /// One change of a file at a time.
    writing: Mutex<()>,
}

/// Serves a course until the program ends. `ready` receives the address.
///
/// # Errors
/// The port is taken, or there is nothing to show.
pub fn serve(
    backend: &dyn Backend,
    folder: &Path,
    options: &PreviewOptions,
    page_files: &PageFiles,
    ready: &mut dyn FnMut(&str),
) -> Result<(), String> {
    let listener = TcpListener::bind(("127.0.0.1", options.port)).map_err(|e| {
        format!("cannot listen on 127.0.0.1:{}: {e}; choose another port with --port", options.port)
    })?;
    let port = listener.local_addr().map_or(options.port, |address| address.port());
    let identity = ServerIdentity::new(port)?;
    let material =
        SnapshotMaterial { backend, folder, options: &options.site, page_files, token: &identity.token };
    let before = backend.fingerprint(&Default::default());
    let course = Arc::new(backend.check(CheckLevel::STATIC)?);
    let first = Snapshot::new(&material, course, 1, false, None);
    let shared = Shared {
        material,
        identity: &identity,
        hub: EventHub::default(),
        snapshot: Mutex::new(Arc::new(first)),
        newest: Mutex::default(),
        changed: Condvar::new(),
        requests: AtomicUsize::new(0),
        writing: Mutex::new(()),
    };
    *locked(&shared.newest) = (shared.fingerprint_after(before), false);
    shared.hub.announce(1);
    let cannot = |e: std::io::Error| format!("cannot start a thread: {e}");
    std::thread::scope(|scope| {
        threads::checking().spawn_scoped(scope, || shared.follow_files()).map_err(cannot)?;
        threads::checking().spawn_scoped(scope, || shared.check_all()).map_err(cannot)?;
        // A single lesson needs no index.
        let page = match shared.current().lessons.keys().collect::<Vec<_>>()[..] {
            [page] => crate::text::address(page),
            _ => String::new(),
        };
        ready(&format!("http://{}/{page}", identity.host));
        for stream in listener.incoming() {
            // A browser that has gone is no error of the server; a full table of files passes.
            let Ok(stream) = stream else {
                std::thread::sleep(PAUSE);
                continue;
            };
            if shared.requests.fetch_add(1, Ordering::SeqCst) >= MAX_REQUESTS {
                shared.requests.fetch_sub(1, Ordering::SeqCst);
                continue;
            }
            let shared = &shared;
            let answer = move || {
                // A panic ends one answer, and the next request gets one again. Nobody reads an answer that cannot be written.
                let _ = threads::catch_panic(|| shared.serve(stream));
                shared.requests.fetch_sub(1, Ordering::SeqCst);
            };
            if threads::checking().spawn_scoped(scope, answer).is_err() {
                shared.requests.fetch_sub(1, Ordering::SeqCst);
            }
        }
        Ok(())
    })
}

fn locked<T>(mutex: &Mutex<T>) -> std::sync::MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

impl Shared<'_> {
    fn current(&self) -> Arc<Snapshot> {
        locked(&self.snapshot).clone()
    }

    fn fingerprint(&self) -> Fingerprint {
        let snapshot = self.current();
        let others = snapshot.course.dependencies.iter().chain(&snapshot.watched).cloned().collect();
        self.material.backend.fingerprint(&others)
    }

    /// Publishes the pages of a check. A check that fails keeps the lessons of the last one, with the reason.
    fn publish(&self, check: Result<CourseCheck, String>, is_checked: bool) {
        let served = self.current();
        let (course, problem) = match check {
            Ok(course) => (Arc::new(course), None),
            Err(why) => (served.course.clone(), Some(why)),
        };
        let version = served.version + 1;
        let made = threads::catch_panic(|| {
            Snapshot::new(&self.material, course, version, is_checked, problem.as_deref())
        });
        let snapshot = made.unwrap_or_else(|why| Snapshot::failed(&self.material, &served, version, &why));
        *locked(&self.snapshot) = Arc::new(snapshot);
        self.hub.announce(version);
    }

    fn check(&self, level: CheckLevel) -> Result<CourseCheck, String> {
        threads::catch_panic(|| self.material.backend.check(level))
            .unwrap_or_else(|panic| Err(format!("labspec failed while checking: {panic}")))
    }

    /// Shows every change at once, without runs.
    fn follow_files(&self) {
        loop {
            std::thread::sleep(PAUSE);
            let fingerprint = self.fingerprint();
            if locked(&self.newest).0 == fingerprint {
                continue;
            }
            let check = self.check(CheckLevel::STATIC);
            let mut newest = locked(&self.newest);
            self.publish(check, false);
            // Files that the new text is the first to name are part of the next inspection.
            *newest = (self.fingerprint_after(fingerprint), false);
            drop(newest);
            self.changed.notify_all();
        }
    }

    /// The state of the files before a check, with those that were not known then.
    fn fingerprint_after(&self, before: Fingerprint) -> Fingerprint {
        let mut all = self.fingerprint();
        let before_check: Vec<_> = before.into_iter().filter(|(path, _)| all.contains_key(path)).collect();
        all.extend(before_check);
        all
    }

    /// Checks everything after each change. The results of a text that has changed meanwhile are not shown.
    fn check_all(&self) {
        loop {
            let newest = locked(&self.newest);
            let newest = self
                .changed
                .wait_while(newest, |(_, is_done)| *is_done)
                .unwrap_or_else(PoisonError::into_inner);
            let files = newest.0.clone();
            drop(newest);
            let check = self.check(CheckLevel::FULL);
            let mut newest = locked(&self.newest);
            if newest.0 == files {
                self.publish(check, true);
                *newest = (self.fingerprint_after(files), true);
            }
        }
    }

    /// Reads a request and answers it.
    fn serve(&self, mut stream: TcpStream) -> std::io::Result<()> {
        let head = read_head(&mut stream)?;
        let path = head.target.split(['?', '#']).next().unwrap_or("");
        let answer = match self.identity.check(&head) {
            Err((status, why)) => {
                drain(&mut stream, &head);
                Response::refusal(status, &why)
            }
            Ok(()) => match path.strip_prefix(ACTIONS) {
                Some("events") if head.method == "GET" => {
                    self.hub.follow(&mut stream);
                    return Ok(());
                }
                Some(action) if head.method == "POST" => self.act(action, &head, &mut stream)?,
                Some(_) => Response::refusal(405, "the preview answers this request with POST"),
                None => self.file(path),
            },
        };
        let headers = headers(answer.kind, answer.is_copied);
        write_answer(&mut stream, answer.status, &headers, &answer.body, head.method != "HEAD")
    }

    /// A file of the site. Only names of such files are found, so that no path leads out of it.
    fn file(&self, path: &str) -> Response {
        let name = percent_decode_str(path.trim_start_matches('/')).decode_utf8_lossy();
        let name = if name.is_empty() { "index.html" } else { &*name };
        let (kind, is_copied) = (kind_of(name), !name.starts_with("page/"));
        match self.current().files.get(name) {
            Some(SiteFile::Text(text)) => {
                Response { status: 200, kind, is_copied: false, body: text.clone().into_bytes() }
            }
            Some(SiteFile::Bytes(body)) => Response { status: 200, kind, is_copied, body: body.clone() },
            Some(SiteFile::Copy(file)) => match std::fs::read(file) {
                Ok(body) => Response { status: 200, kind, is_copied, body },
                Err(_) => Response::refusal(404, "this file cannot be read"),
            },
            None => Response::refusal(404, "the course has no such page"),
        }
    }

    /// Does what a page asks for.
    fn act(&self, action: &str, head: &RequestHead, stream: &mut TcpStream) -> std::io::Result<Response> {
        let Some(body) = read_body(stream, head, MAX_BODY)? else {
            return Ok(Response::refusal(413, "the request is too large, or does not state its length"));
        };
        let Ok(ask) = serde_json::from_slice::<Ask>(&body) else {
            return Ok(Response::refusal(400, "the request cannot be read"));
        };
        let snapshot = self.current();
        let backend = self.material.backend;
        let done = threads::catch_panic(|| match action {
            "edit" | "fix" | "accept" => {
                let _one = locked(&self.writing);
                act(action, &ask, &snapshot, backend)
            }
            _ => act(action, &ask, &snapshot, backend),
        });
        Ok(match done {
            Ok(Ok(value)) => Response::json(200, &value),
            Ok(Err((status, why))) => Response::refusal(status, &why),
            Err(panic) => Response::refusal(500, &format!("labspec failed: {panic}")),
        })
    }
}

/// What a request gets.
struct Response {
    status: u16,
    kind: &'static str,
    /// Whether it is a file of the course.
    is_copied: bool,
    body: Vec<u8>,
}

impl Response {
    fn json(status: u16, value: &serde_json::Value) -> Response {
        Response { status, kind: "application/json", is_copied: false, body: value.to_string().into_bytes() }
    }

    fn refusal(status: u16, why: &str) -> Response {
        Response::json(status, &serde_json::json!({ "error": why }))
    }
}

/// The type of a file, from its name.
fn kind_of(name: &str) -> &'static str {
    match name.rsplit_once('.').map_or("", |(_, ending)| ending).to_ascii_lowercase().as_str() {
        "html" => "text/html; charset=utf-8",
        "js" => "text/javascript; charset=utf-8",
        "css" => "text/css; charset=utf-8",
        "json" => "application/json",
        "wasm" => "application/wasm",
        "woff2" => "font/woff2",
        "xml" => "text/xml; charset=utf-8",
        "png" => "image/png",
        "jpg" | "jpeg" => "image/jpeg",
        "gif" => "image/gif",
        "webp" => "image/webp",
        "avif" => "image/avif",
        "svg" => "image/svg+xml",
        "pdf" => "application/pdf",
        "mp4" => "video/mp4",
        "webm" => "video/webm",
        "txt" | "csv" | "tsv" | "py" | "m" | "jl" | "r" | "toml" => "text/plain; charset=utf-8",
        _ => "application/octet-stream",
    }
}
