//! The wheels of the Python package, built by maturin in an environment of its own.
//!
//! The wheel for Linux on x86-64 contains the extension module twice: for every processor, and in the folder `x86-64-v3` for newer ones. The
//! package `wheel` puts the second one into the wheel of the first one. One wheel serves all versions of Python with a global interpreter
//! lock. Each version without this lock has a wheel of its own, which is built if the interpreter is installed.

use super::platform::{self, Platform, Processor, here_is_fast, output_of};
use super::program::on_old_processor;
use super::{Release, copied, emptied, failed, files_of};
use crate::page::PACKED_AT;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// What builds and repacks wheels: maturin as in `bindings/python/test.sh`.
const TOOLS: [&str; 2] = ["maturin==1.16.0", "wheel==0.48.0"];

/// The folder of the package in a wheel, and what the file of its extension module begins with.
const PACKAGE: &str = "labspec";
const MODULE: &str = "_labspec.";

/// The interpreter of the environment of the tools, and those without a global interpreter lock.
const PYTHON: &str = "python3";
const FREE_THREADED: [&str; 2] = ["python3.14t", "python3.15t"];

/// Imports the package, makes a step, and prints the time.
const TRIED: &str = "import labspec; model = labspec.Model.from_xml('<mujoco/>'); data = labspec.Data(model); data.step(3); print(data.time)";

/// Builds the wheels of all platforms.
pub(super) fn wheels(release: &Release) -> Result<Vec<PathBuf>, String> {
    let tools = release.target.join("release-tools/python");
    environment(PYTHON, &tools, &TOOLS)?;
    let mut wheels = Vec::new();
    for platform in platform::all()? {
        wheels.push(wheel(release, &platform, PYTHON, &tools)?);
        for python in FREE_THREADED.into_iter().filter(|_| platform.is_here()) {
            if platform::is_installed(python) {
                wheels.push(wheel(release, &platform, python, &tools)?);
            } else {
                eprintln!("xtask: skipped: the wheel for {python}, which is not installed");
            }
        }
    }
    Ok(wheels)
}

/// Builds the wheel of a platform for an interpreter, and tries it.
fn wheel(release: &Release, platform: &Platform, python: &str, tools: &Path) -> Result<PathBuf, String> {
    let mut built = Vec::new();
    for processor in platform.processors {
        built.push(build(release, platform, processor, python, tools)?);
    }
    let wheel = match (built.as_slice(), platform.processors) {
        ([every], _) => copied(every, &release.folder, None)?,
        ([every, newer], [_, Processor { name: Some(name), .. }]) => {
            joined(release, tools, every, newer, name)?
        }
        _ => return Err(format!("{}: a wheel holds one build or two", platform.triple)),
    };
    if platform.is_here() {
        try_out(release, platform, python, &wheel)?;
    }
    Ok(wheel)
}

/// Makes a Python environment with packages, unless it is there.
fn environment(interpreter: &str, folder: &Path, packages: &[&str]) -> Result<(), String> {
    let python = folder.join("bin/python");
    if !python.exists() {
        output_of(Command::new(interpreter).args(["-m", "venv"]).arg(folder))?;
    }
    output_of(
        Command::new(python)
            .args(["-m", "pip", "install", "--quiet", "--disable-pip-version-check"])
            .args(packages),
    )?;
    Ok(())
}

/// Builds a wheel for a processor, and returns its file.
fn build(
    release: &Release,
    platform: &Platform,
    processor: &Processor,
    python: &str,
    tools: &Path,
) -> Result<PathBuf, String> {
    let name = processor.name.unwrap_or(&platform.triple);
    let out = release.target.join(format!("wheels-for-{name}"));
    emptied(&out)?;
    let mut maturin = Command::new(tools.join("bin/maturin"));
    maturin.args(["build", "--quiet", "--locked", "--out"]).arg(&out);
    maturin.args(platform.profile(release, processor).0);
    maturin.args(Platform::sizes(release));
    if !platform.without_symbols().is_empty() {
        maturin.arg("--strip");
    }
    platform.settings(&mut maturin, release, processor)?;
    if platform.is_here() {
        maturin.args(["--interpreter", python]);
    } else {
        // The linker of another machine comes with its C library, whose version is that of this machine's Debian.
        maturin.args(["--target", &platform.triple, "--compatibility", "linux"]);
    }
    maturin.env("CARGO_TARGET_DIR", platform.folder(release, processor)).env("SOURCE_DATE_EPOCH", PACKED_AT);
    maturin.current_dir(release.root.join("bindings/python"));
    output_of(&mut maturin)?;
    files_of(&out)?.into_iter().next().ok_or_else(|| "maturin built no wheel".into())
}

/// Writes the wheel for every processor with the module for newer processors in a folder with their name.
fn joined(
    release: &Release,
    tools: &Path,
    every: &Path,
    newer: &Path,
    name: &str,
) -> Result<PathBuf, String> {
    let unpacked = |wheel: &Path, to: &str| -> Result<PathBuf, String> {
        let folder = release.target.join("wheel-unpacked").join(to);
        emptied(&folder)?;
        output_of(wheel_tool(tools).arg("unpack").arg(wheel).arg("--dest").arg(&folder))?;
        // One folder with the name and the version of the package.
        let inside = fs::read_dir(&folder).map_err(|e| failed(&folder, &e))?.next();
        let inside = inside.ok_or_else(|| format!("{} is empty", wheel.display()))?;
        inside.map(|entry| entry.path()).map_err(|e| failed(&folder, &e))
    };
    let (every, newer) = (unpacked(every, "every")?, unpacked(newer, "newer")?);
    let to = every.join(PACKAGE).join(name);
    emptied(&to)?;
    let files = files_of(&newer.join(PACKAGE))?;
    let is_module = |file: &&PathBuf| {
        let name = file.file_name().and_then(|name| name.to_str()).unwrap_or_default();
        name.starts_with(MODULE) && name.ends_with(".so")
    };
    copied(files.iter().find(is_module).ok_or("a wheel has no extension module")?, &to, None)?;
    let out = release.target.join("wheel-packed");
    emptied(&out)?;
    output_of(wheel_tool(tools).arg("pack").arg(&every).arg("--dest-dir").arg(&out))?;
    let packed = files_of(&out)?.into_iter().next().ok_or("no wheel was packed")?;
    copied(&packed, &release.folder, None)
}

/// A command of the package `wheel`, which writes the same bytes each time.
fn wheel_tool(tools: &Path) -> Command {
    let mut command = Command::new(tools.join("bin/python"));
    command.args(["-m", "wheel"]).env("SOURCE_DATE_EPOCH", PACKED_AT);
    command
}

/// Installs a wheel into a new environment, and uses the package and its program, also on an old processor. They say which instructions the
/// module that was loaded was built for.
fn try_out(release: &Release, platform: &Platform, interpreter: &str, wheel: &Path) -> Result<(), String> {
    let folder = release.folder.join("try");
    emptied(&folder)?;
    let tried = folder.join("python");
    environment(interpreter, &tried, &[&wheel.display().to_string()])?;
    let python = tried.join("bin/python");
    let text = output_of(Command::new(&python).args(["-c", TRIED]))?;
    let lesson = release.root.join("specs/lessons/02-bounce-and-swing.md");
    output_of(Command::new(tried.join("bin/labspec")).args(["check", "--no-cache"]).arg(&lesson))?;
    let check_version = |command: &mut Command, processor: &Processor| {
        let text = output_of(command.args(["-m", "labspec", "--version"]))?;
        match text.contains(processor.instructions) {
            true => Ok(()),
            false => Err(format!("the module is not the one for {}: {text}", processor.instructions)),
        }
    };
    if here_is_fast() {
        platform
            .processors
            .last()
            .map_or(Ok(()), |newest| check_version(&mut Command::new(&python), newest))?;
    }
    if let Some(mut command) = on_old_processor(&python)
        && output_of(command.args(["-c", TRIED]))? != text
    {
        return Err("the package computes something else on an old processor".into());
    }
    if let Some(mut command) = on_old_processor(&python) {
        check_version(&mut command, &platform.processors[0])?;
    }
    fs::remove_dir_all(&folder).map_err(|e| failed(&folder, &e))
}
