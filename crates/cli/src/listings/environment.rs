//! Environments with the packages that the settings require, or that the lock file of a project of uv names. Each is made once and
//! stays in the folder of the cache.

use super::NotRun;
use super::process::watch;
use super::python::Interpreter;
use crate::cache;
use crate::digest;
use std::ffi::OsStr;
use std::fs;
use std::path::Path;
use std::process::Command;
use std::time::Duration;

/// The time limit of an installation.
const INSTALL_TIME: Duration = Duration::from_secs(900);
/// The maximum output of an installer, in bytes.
const MAX_OUTPUT: usize = 16 << 20;

/// The maximum size of a file of a project, in bytes.
const MAX_PROJECT_FILE: u64 = 32 << 20;

/// The interpreter of an environment with these packages. Only built packages are installed, because the installation of others
/// runs their code.
pub(super) fn with_packages(python: &Interpreter, requirements: &[String]) -> Result<Interpreter, NotRun> {
    let parts = [python.identity.as_str()].into_iter().chain(requirements.iter().map(String::as_str));
    let name = digest::hex_of(&parts.map(str::as_bytes).collect::<Vec<_>>());
    let cannot = |why: String| {
        let why = format!("the packages of `requirements` cannot be installed: {why}");
        (why, "correct `requirements` under [listings] in labspec.toml, or check the network".to_string())
    };
    environment(&name, |new| install(python, requirements, new).map_err(cannot))
}

/// The interpreter of an environment with the packages that `uv.lock` of a project names. The lock file is not changed, the project
/// itself is not installed, and only built packages are.
pub(super) fn of_project(python: &Interpreter, folder: &Path) -> Result<Interpreter, NotRun> {
    let cannot = |why: String| {
        let why = format!("the packages of `project` cannot be installed: {why}");
        (why, "correct `project` under [listings] in labspec.toml, or run `uv lock` there".to_string())
    };
    let read = |name: &str| read_project_file(&folder.join(name)).map_err(|e| cannot(format!("{name}: {e}")));
    let (project, lock) = (read("pyproject.toml")?, read("uv.lock")?);
    let name = digest::hex_of(&[b"project", python.identity.as_bytes(), &project, &lock]);
    environment(&name, |new| {
        if !has_uv() {
            let help = "install uv, or use `python` or `requirements` under [listings] in labspec.toml";
            return Err(("`project` needs the program `uv`, which does not run".into(), help.into()));
        }
        // uv reads a relative path from the folder of the project.
        let new = std::path::absolute(new).map_err(|e| cannot(e.to_string()))?;
        let mut command = Command::new("uv");
        command.args(["sync", "--frozen", "--no-install-project", "--no-build", "--no-config", "--project"]);
        command.arg(folder).arg("--python").arg(&python.program);
        command.env("UV_PROJECT_ENVIRONMENT", new).env("UV_PYTHON_DOWNLOADS", "never");
        finish(command).map_err(cannot)
    })
}

fn read_project_file(path: &Path) -> std::io::Result<Vec<u8>> {
    let meta = fs::metadata(path)?;
    if !meta.is_file() || meta.len() > MAX_PROJECT_FILE {
        return Err(std::io::Error::other("it is not a file, or it is too large"));
    }
    fs::read(path)
}

/// The interpreter of the environment of this name in the folder of the cache. `install` makes it if it does not exist.
fn environment(name: &str, install: impl FnOnce(&Path) -> Result<(), NotRun>) -> Result<Interpreter, NotRun> {
    let Some(folder) = cache::folder() else {
        return Err((
            "there is no folder for the environment of the listings".into(),
            "set LABSPEC_CACHE to a folder, or use `python` under [listings] in labspec.toml".into(),
        ));
    };
    let environment = folder.join("environments").join(name);
    if !environment.exists() {
        make(&environment, install)?;
    }
    Interpreter::describe(&environment.join("bin/python")).map_err(|why| {
        (format!("{} is damaged: {why}", environment.display()), "delete this folder".to_string())
    })
}

/// Makes an environment under another name, and renames it when it is complete.
fn make(environment: &Path, install: impl FnOnce(&Path) -> Result<(), NotRun>) -> Result<(), NotRun> {
    let cannot = |e: std::io::Error| {
        (format!("cannot create {}: {e}", environment.display()), "check the folder of the cache".to_string())
    };
    let new = environment.with_extension(format!("{}.new", std::process::id()));
    if let Some(folder) = new.parent() {
        fs::create_dir_all(folder).map_err(cannot)?;
    }
    let made = install(&new).and_then(|()| match fs::rename(&new, environment) {
        // Another process may have made the same one.
        Err(e) if !environment.exists() => Err(cannot(e)),
        _ => Ok(()),
    });
    let _ = fs::remove_dir_all(&new);
    made
}

fn has_uv() -> bool {
    run("uv".as_ref(), [OsStr::new("--version")]).is_ok()
}

fn install(python: &Interpreter, requirements: &[String], new: &Path) -> Result<(), String> {
    let inner = new.join("bin/python");
    let words = |words: &[&'static str]| words.iter().map(|word| OsStr::new(*word)).collect::<Vec<_>>();
    let packages = requirements.iter().map(OsStr::new);
    let built = words(&["--only-binary", ":all:"]);
    if has_uv() {
        let program = python.program.as_os_str();
        run(
            "uv".as_ref(),
            words(&["venv", "--no-config", "--python"]).into_iter().chain([program, new.as_os_str()]),
        )?;
        let start =
            words(&["pip", "install", "--no-config", "--python"]).into_iter().chain([inner.as_os_str()]);
        return run("uv".as_ref(), start.chain(built).chain(packages));
    }
    run(&python.program, words(&["-I", "-m", "venv"]).into_iter().chain([new.as_os_str()]))?;
    let start =
        words(&["-I", "-m", "pip", "install", "--quiet", "--disable-pip-version-check", "--no-input"]);
    run(&inner, start.into_iter().chain(built).chain(packages))
}

fn run<'a>(program: &Path, arguments: impl IntoIterator<Item = &'a OsStr>) -> Result<(), String> {
    let mut command = Command::new(program);
    command.args(arguments);
    finish(command)
}

/// Runs a command to its end; an error is the last line of its errors.
fn finish(command: Command) -> Result<(), String> {
    let ended = watch(command, INSTALL_TIME, MAX_OUTPUT).map_err(|e| e.to_string())?;
    ended.success().map(|_| ())
}
