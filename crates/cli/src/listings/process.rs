//! Runs a program without a network and with limits of time, memory and output.
//!
//! On Linux, `unshare` gives the program namespaces of its own for the network and for processes: it reaches no other machine and
//! no other process, and all of its processes end with it. A process group is the second means against survivors.

use super::NotRun;
use super::folder::RunFolder;
use labspec::{interrupt, threads};
use std::io::Read;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, LazyLock, Mutex, PoisonError};
use std::time::{Duration, Instant};

/// The limits of a listing.
pub(super) struct Limits {
    /// Of the wall clock.
    pub(super) seconds: u64,
    /// Of each process, in MiB; 0 for none.
    pub(super) memory: u64,
    pub(super) network: bool,
}

/// How a run ended.
pub(super) enum Ended {
    Exit { code: i32, output: String, errors: String },
    Stopped { why: String, help: String },
}

/// The maximum size of an output, in bytes.
const MAX_OUTPUT: usize = 1 << 20;
/// The maximum size of a file that a listing writes, in blocks of 512 bytes: 256 MiB.
const MAX_FILE: u64 = 524_288;
/// The time between two looks at a running process.
const INTERVAL: Duration = Duration::from_millis(5);
/// How long the last output is waited for after the end of a process.
const LAST_OUTPUT: Duration = Duration::from_secs(2);
/// The exit code for limits that the system refuses.
const NO_LIMITS: i32 = 213;
/// Sets the limits, then becomes the program.
const SCRIPT: &str =
    "ulimit -c 0; ulimit -f \"$1\" && ulimit -t \"$2\" && { [ \"$3\" = 0 ] || ulimit -v \"$3\"; } || exit 213
shift 3; exec \"$@\"";

/// Namespaces of its own for processes, which end with the program.
const PROCESSES: [&str; 4] = ["--user", "--map-root-user", "--pid", "--kill-child=KILL"];

fn is_available(options: &[&str]) -> bool {
    let mut command = Command::new("unshare");
    command.args(options).arg("true").stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
    cfg!(target_os = "linux") && command.status().is_ok_and(|status| status.success())
}

/// The options of `unshare` without a network, if they work here.
static ISOLATED: LazyLock<bool> = LazyLock::new(|| is_available(&[&PROCESSES[..], &["--net"]].concat()));
/// Whether the others work here.
static SEPARATE: LazyLock<bool> = LazyLock::new(|| is_available(&PROCESSES));

/// The command before the limits, or why there is none.
fn wrapper(network: bool) -> Result<Vec<&'static str>, NotRun> {
    let start = || ["unshare"].into_iter().chain(PROCESSES);
    match (network, cfg!(unix)) {
        (_, false) => Err((
            "listings run only on Linux and macOS".into(),
            "check them there, for example in Docker or in CI".into(),
        )),
        (false, _) if *ISOLATED => Ok(start().chain(["--net"]).collect()),
        (false, _) => Err((
            "the network cannot be switched off here (`unshare --user --net` does not work)".into(),
            "install util-linux and allow user namespaces, or trust the listings: `network = true` under [listings] in labspec.toml"
                .into(),
        )),
        (true, _) if *SEPARATE => Ok(start().collect()),
        (true, _) => Ok(Vec::new()),
    }
}

/// Runs `python PATH` in a folder.
pub(super) fn run_limited(
    folder: &RunFolder,
    python: &Path,
    path: &str,
    limits: &Limits,
) -> Result<Ended, NotRun> {
    let wrapper = wrapper(limits.network)?;
    let mut words = wrapper.iter().copied().chain(["sh", "-c", SCRIPT, "sh"]);
    let mut command = Command::new(words.next().unwrap_or("sh"));
    // Ends what survives this program. Several threads use the time of several processors.
    let processors = std::thread::available_parallelism().map_or(1, |n| n.get() as u64);
    command.args(words).arg(MAX_FILE.to_string()).arg(((limits.seconds + 1) * processors).to_string());
    command.arg((limits.memory * 1024).to_string()).arg(python);
    // A name that begins with a dash would be an option.
    command.arg(if path.starts_with('-') { format!("./{path}") } else { path.to_string() });
    command.env_clear().current_dir(folder.work());
    command.env("PATH", std::env::var_os("PATH").unwrap_or_default());
    command.env("HOME", folder.home()).env("TMPDIR", folder.temporary()).env("PYTHONPATH", folder.work());
    for (name, value) in [
        ("PYTHONHASHSEED", "0"),
        ("PYTHONDONTWRITEBYTECODE", "1"),
        ("PYTHONUTF8", "1"),
        ("PYTHONNOUSERSITE", "1"),
        ("LC_ALL", "C.UTF-8"),
    ] {
        command.env(name, value);
    }
    let ended = watch(command, Duration::from_secs(limits.seconds), MAX_OUTPUT).map_err(|e| {
        (format!("it cannot be started: {e}"), "check `python` under [listings] in labspec.toml".to_string())
    })?;
    describe(ended, limits)
}

/// What the end of a process means.
fn describe(ended: ProcessEnd, limits: &Limits) -> Result<Ended, NotRun> {
    let stopped = |why: String, help: &str| Ok(Ended::Stopped { why, help: help.to_string() });
    match ended.reason {
        EndReason::Interrupted => Err(("interrupted".into(), "check again".into())),
        EndReason::Time => stopped(
            format!("it runs longer than {} s", limits.seconds),
            "make it faster, or raise `seconds` under [listings] in labspec.toml",
        ),
        EndReason::Output => stopped("it prints more than 1 MB".into(), "print less"),
        EndReason::Exit(NO_LIMITS) if ended.errors.contains("ulimit") => Err((
            "the memory of a process cannot be limited here".into(),
            "set `memory = 0` under [listings] in labspec.toml".into(),
        )),
        EndReason::Exit(code) => Ok(Ended::Exit { code, output: ended.output, errors: ended.errors }),
        EndReason::Signal(signal) => {
            let why = match limits.memory {
                0 => format!("signal {signal} ended it"),
                memory => format!("signal {signal} ended it (memory limit: {memory} MiB)"),
            };
            stopped(why, "use less memory, or raise `memory` under [listings] in labspec.toml")
        }
    }
}

enum EndReason {
    Exit(i32),
    Signal(i32),
    Time,
    Output,
    Interrupted,
}

pub(super) struct ProcessEnd {
    reason: EndReason,
    output: String,
    errors: String,
}

impl ProcessEnd {
    /// The output of a process that ended without an error, or the last line of its errors.
    pub(super) fn success(self) -> Result<String, String> {
        match self.reason {
            EndReason::Exit(0) => Ok(self.output),
            EndReason::Exit(_) | EndReason::Signal(_) => {
                Err(labspec::listings::last_line(&self.errors).to_string())
            }
            EndReason::Time => Err("it takes too long".into()),
            EndReason::Output => Err("it prints too much".into()),
            EndReason::Interrupted => Err("interrupted".into()),
        }
    }
}

/// What a process has written so far.
#[derive(Default)]
struct Collected {
    bytes: Mutex<Vec<u8>>,
    is_full: AtomicBool,
    is_complete: AtomicBool,
}

/// Reads a pipe on a thread of its own, until it is closed or has more than the maximum.
fn collect(mut pipe: impl Read + Send + 'static, max: usize) -> std::io::Result<Arc<Collected>> {
    let collected = Arc::new(Collected::default());
    let shared = collected.clone();
    threads::checking().spawn(move || {
        let mut buffer = [0; 8192];
        while let Ok(n @ 1..) = pipe.read(&mut buffer) {
            let mut bytes = shared.bytes.lock().unwrap_or_else(PoisonError::into_inner);
            bytes.extend(buffer.iter().take(n));
            if bytes.len() > max {
                bytes.truncate(max);
                shared.is_full.store(true, Ordering::Release);
                break;
            }
        }
        shared.is_complete.store(true, Ordering::Release);
    })?;
    Ok(collected)
}

impl Collected {
    fn text(&self) -> String {
        String::from_utf8_lossy(&self.bytes.lock().unwrap_or_else(PoisonError::into_inner)).into_owned()
    }
}

/// Runs a command to its end, to a limit, or to Ctrl-C, and ends all processes of its group.
pub(super) fn watch(mut command: Command, limit: Duration, max_output: usize) -> std::io::Result<ProcessEnd> {
    command.stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::piped());
    #[cfg(unix)]
    std::os::unix::process::CommandExt::process_group(&mut command, 0);
    let mut child = command.spawn()?;
    let ended = watch_child(&mut child, limit, max_output);
    // Nothing survives, whatever happened.
    if ended.is_err() {
        end_group(&mut child);
    }
    ended
}

fn watch_child(child: &mut Child, limit: Duration, max_output: usize) -> std::io::Result<ProcessEnd> {
    let output = child.stdout.take().map(|pipe| collect(pipe, max_output)).transpose()?;
    let errors = child.stderr.take().map(|pipe| collect(pipe, max_output)).transpose()?;
    let pipes: Vec<&Arc<Collected>> = output.iter().chain(&errors).collect();
    let start = Instant::now();
    let reason = loop {
        if let Some(status) = child.try_wait()? {
            break end_reason(status);
        }
        if interrupt::requested() {
            break EndReason::Interrupted;
        }
        if pipes.iter().any(|pipe| pipe.is_full.load(Ordering::Acquire)) {
            break EndReason::Output;
        }
        if start.elapsed() >= limit {
            break EndReason::Time;
        }
        std::thread::sleep(INTERVAL);
    };
    end_group(child);
    let end = Instant::now();
    while pipes.iter().any(|pipe| !pipe.is_complete.load(Ordering::Acquire)) && end.elapsed() < LAST_OUTPUT {
        std::thread::sleep(INTERVAL);
    }
    let is_full = pipes.iter().any(|pipe| pipe.is_full.load(Ordering::Acquire));
    let reason = if is_full { EndReason::Output } else { reason };
    let text = |pipe: &Option<Arc<Collected>>| pipe.as_ref().map_or(String::new(), |pipe| pipe.text());
    Ok(ProcessEnd { reason, output: text(&output), errors: text(&errors) })
}

fn end_reason(status: std::process::ExitStatus) -> EndReason {
    #[cfg(unix)]
    if let Some(signal) = std::os::unix::process::ExitStatusExt::signal(&status) {
        return EndReason::Signal(signal);
    }
    EndReason::Exit(status.code().unwrap_or(-1))
}

/// Kills all processes of the group of a child, and the child.
fn end_group(child: &mut Child) {
    let group = format!("kill -9 -{} 2>/dev/null", child.id());
    let _ = Command::new("sh").args(["-c", &group]).stdin(Stdio::null()).stderr(Stdio::null()).status();
    let _ = child.kill();
    let _ = child.wait();
}
