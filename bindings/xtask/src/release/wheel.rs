//! The wheels of the Python package, built by maturin in an environment of its own.

use super::platform::{self, Platform, output_of};
use super::program::on_old_processor;
use super::{Release, emptied, failed, files_of};
use crate::page::PACKED_AT;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// As in `bindings/python/test.sh`.
const MATURIN: &str = "maturin==1.16.0";

/// Imports the package, and prints its version.
const TRIED: &str = "import labspec; print(labspec.__version__)";

/// Builds the wheels of all platforms, for every processor of each.
pub(super) fn wheels(release: &Release) -> Result<Vec<PathBuf>, String> {
    let tools = release.target.join("release-tools/python");
    environment(&tools, MATURIN)?;
    let mut wheels = Vec::new();
    for platform in platform::all()? {
        let wheel = wheel(release, &platform, &tools)?;
        if platform.is_here() {
            try_out(release, &wheel)?;
        }
        wheels.push(wheel);
    }
    Ok(wheels)
}

/// Makes a Python environment with a package, unless it is there.
fn environment(folder: &Path, package: &str) -> Result<(), String> {
    let python = folder.join("bin/python");
    if !python.exists() {
        output_of(Command::new("python3").args(["-m", "venv"]).arg(folder))?;
    }
    output_of(
        Command::new(python)
            .args(["-m", "pip", "install", "--quiet", "--disable-pip-version-check"])
            .arg(package),
    )?;
    Ok(())
}

/// Builds the wheel of a platform.
fn wheel(release: &Release, platform: &Platform, tools: &Path) -> Result<PathBuf, String> {
    let out = release.target.join("wheels");
    emptied(&out)?;
    let every = &platform.processors[0];
    let mut maturin = Command::new(tools.join("bin/maturin"));
    maturin.args(["build", "--release", "--quiet", "--locked", "--out"]).arg(&out);
    platform.settings(&mut maturin, release, every);
    if platform.is_here() {
        maturin.arg("--interpreter").arg(tools.join("bin/python"));
    } else {
        // The linker of another machine comes with its C library, whose version is that of this machine's Debian.
        maturin.args(["--target", &platform.triple, "--compatibility", "linux"]);
    }
    let folder = release.target.join(format!("wheel-for-{}", every.name.unwrap_or(&platform.triple)));
    maturin.env("CARGO_TARGET_DIR", folder).env("SOURCE_DATE_EPOCH", PACKED_AT);
    maturin.current_dir(release.root.join("bindings/python"));
    output_of(&mut maturin)?;
    let built = files_of(&out)?.into_iter().next().ok_or("maturin built no wheel")?;
    let to = release.folder.join(built.file_name().unwrap_or_default());
    fs::copy(&built, &to).map_err(|e| failed(&built, &e))?;
    Ok(to)
}

/// Installs a wheel into a new environment, and uses the package and its program, the package also on an old processor.
fn try_out(release: &Release, wheel: &Path) -> Result<(), String> {
    let folder = release.folder.join("try");
    emptied(&folder)?;
    let tried = folder.join("python");
    environment(&tried, &wheel.display().to_string())?;
    let python = tried.join("bin/python");
    let text = output_of(Command::new(&python).args(["-c", TRIED]))?;
    let lessons = release.root.join("specs/lessons/02-bounce-and-swing.md");
    output_of(Command::new(tried.join("bin/labspec")).args(["check", "--no-cache"]).arg(&lessons))?;
    if let Some(mut command) = on_old_processor(&python)
        && output_of(command.args(["-c", TRIED]))? != text
    {
        return Err("the package does not load on an old processor".into());
    }
    fs::remove_dir_all(&folder).map_err(|e| failed(&folder, &e))
}
