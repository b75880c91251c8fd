//! The components of what is published, in the format of CycloneDX, by `cargo-cyclonedx`: a file for the program, the C library, the Python
//! package and the modules of the npm packages. The npm packages depend on nothing but each other.

use super::platform::{is_installed, output_of};
use super::{Release, failed, write};
use crate::page::PACKED_AT;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// As cargo installs it.
const TOOL: (&str, &str) = ("cargo-cyclonedx", "0.5.9");

/// What is listed: the name of the file, and the crate that is built.
const LISTED: [(&str, &str); 4] = [
    ("labspec", "crates/cli"),
    ("labspec-c", "bindings/c"),
    ("labspec-python", "bindings/python"),
    ("labspec-wasm", "bindings/wasm"),
];

/// Writes the lists.
pub(super) fn lists(release: &Release) -> Result<Vec<PathBuf>, String> {
    let tool = tool(release)?;
    LISTED.iter().map(|(name, package)| list(release, &tool, name, package)).collect()
}

/// The tool, which is installed if it is missing.
fn tool(release: &Release) -> Result<PathBuf, String> {
    let (name, version) = TOOL;
    let tools = release.target.join("release-tools");
    let installed = tools.join("bin").join(name);
    if is_installed(name) {
        return Ok(name.into());
    }
    if !installed.exists() {
        // Not optimized: it runs for a second, and is built for minutes otherwise.
        let mut cargo = Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
        cargo
            .args(["install", name, "--version", version, "--locked", "--debug", "--quiet", "--root"])
            .arg(&tools);
        output_of(cargo.env_remove("RUSTFLAGS").current_dir(&release.target))?;
    }
    Ok(installed)
}

/// Removes the files that the tool has written in a folder and in those directly inside it: it writes one for each crate of a workspace.
fn remove(folder: &Path, name: &str) -> Result<(), String> {
    let entries = fs::read_dir(folder).map_err(|e| failed(folder, &e))?;
    let members = entries.filter_map(Result::ok).map(|entry| entry.path()).filter(|path| path.is_dir());
    for file in
        members.chain([folder.to_path_buf()]).map(|member| member.join(name)).filter(|file| file.exists())
    {
        fs::remove_file(&file).map_err(|e| failed(&file, &e))?;
    }
    Ok(())
}

/// Writes the list of a crate.
fn list(release: &Release, tool: &Path, name: &str, package: &str) -> Result<PathBuf, String> {
    let folder = release.root.join(package);
    let written = format!("{name}.components");
    let mut command = Command::new(tool);
    command.args([
        "cyclonedx",
        "--quiet",
        "--format",
        "json",
        "--spec-version",
        "1.5",
        "--no-build-deps",
        "--override-filename",
        &written,
    ]);
    // No time, and no number that is drawn for each file.
    command.arg("--manifest-path").arg(folder.join("Cargo.toml")).env("SOURCE_DATE_EPOCH", PACKED_AT);
    output_of(&mut command)?;
    let made = folder.join(format!("{written}.json"));
    let text = fs::read_to_string(&made).map_err(|e| failed(&made, &e))?;
    for members in ["crates", "bindings", package] {
        remove(&release.root.join(members), &format!("{written}.json"))?;
    }
    // The tool names crates of the repository by their paths on this machine.
    let text = text.replace(&format!("file://{}/", release.root.display()), "file:///labspec/");
    let file = release.folder.join(format!("{name}-{}.cdx.json", release.version));
    write(&file, text.as_bytes())?;
    Ok(file)
}
