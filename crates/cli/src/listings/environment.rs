//! Environments with the packages that the settings require. Each is made once and stays in the folder of the cache.

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

/// The interpreter of an environment with these packages. Only built packages are installed, because the installation of others
/// runs their code.
pub(super) fn with_packages(python: &Interpreter, requirements: &[String]) -> Result<Interpreter, NotRun> {
    let Some(folder) = cache::folder() else {
        return Err((
            "there is no folder for an environment with the packages of `requirements`".into(),
            "set LABSPEC_CACHE to a folder, or use `python` under [listings] in labspec.toml".into(),
        ));
    };
    let parts = [python.identity.as_str()].into_iter().chain(requirements.iter().map(String::as_str));
    let name = digest::hex_of(&parts.map(str::as_bytes).collect::<Vec<_>>());
    let environment = folder.join("environments").join(&name);
    let cannot = |why: String| {
        let why = format!("the packages of `requirements` cannot be installed: {why}");
        (why, "correct `requirements` under [listings] in labspec.toml, or check the network".to_string())
    };
    if !environment.exists() {
        make(python, requirements, &environment).map_err(cannot)?;
    }
    Interpreter::describe(&environment.join("bin/python")).map_err(|why| {
        (format!("{} is damaged: {why}", environment.display()), "delete this folder".to_string())
    })
}

/// Makes an environment under another name, and renames it when it is complete.
fn make(python: &Interpreter, requirements: &[String], environment: &Path) -> Result<(), String> {
    let new = environment.with_extension(format!("{}.new", std::process::id()));
    if let Some(folder) = new.parent() {
        fs::create_dir_all(folder).map_err(|e| e.to_string())?;
    }
    let installed = install(python, requirements, &new);
    let made = installed.and_then(|()| match fs::rename(&new, environment) {
        // Another process may have made the same one.
        Err(e) if !environment.exists() => Err(e.to_string()),
        _ => Ok(()),
    });
    let _ = fs::remove_dir_all(&new);
    made
}

fn install(python: &Interpreter, requirements: &[String], new: &Path) -> Result<(), String> {
    let inner = new.join("bin/python");
    let words = |words: &[&'static str]| words.iter().map(|word| OsStr::new(*word)).collect::<Vec<_>>();
    let packages = requirements.iter().map(OsStr::new);
    let built = words(&["--only-binary", ":all:"]);
    let has_uv = run("uv".as_ref(), words(&["--version"])).is_ok();
    if has_uv {
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
    let ended = watch(command, INSTALL_TIME, MAX_OUTPUT).map_err(|e| e.to_string())?;
    ended.success().map(|_| ())
}
