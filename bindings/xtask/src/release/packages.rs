//! The packages of crates.io, of npm, and of editors, made by the tools of their registries.

use super::platform::output_of;
use super::{Release, copied, emptied, files_of};
use crate::page::npm;
use std::path::PathBuf;
use std::process::Command;

/// Packs all crates that are published, builds each of them as it was packed, and does all that publishing does but the upload. Their
/// interfaces are compared with those of the last release.
pub(super) fn crates(release: &Release) -> Result<Vec<PathBuf>, String> {
    compare_interfaces(release)?;
    let target = release.target.join("packed-crates");
    let packed = target.join("package");
    emptied(&packed)?;
    let cargo = |arguments: &[&str]| {
        let mut cargo = Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
        cargo.args(arguments).args(["--quiet", "--locked", "--allow-dirty"]);
        cargo.current_dir(&release.root).env("CARGO_TARGET_DIR", &target);
        match cargo.status().map_err(|e| format!("cannot run cargo: {e}"))?.success() {
            true => Ok(()),
            false => Err("a crate cannot be packed".to_string()),
        }
    };
    match release.quick {
        true => cargo(&["publish", "--dry-run", "--no-verify"])?,
        false => cargo(&["publish", "--dry-run"])?,
    }
    // A dry run keeps no files.
    cargo(&["package", "--no-verify"])?;
    let mut files = files_of(&packed)?;
    files.retain(|file| file.extension().is_some_and(|ending| ending == "crate"));
    if files.is_empty() {
        return Err("cargo has packed no crate".into());
    }
    files.into_iter().map(|file| copied(&file, &release.folder, None)).collect()
}

/// Compares the interfaces of the crates with those of the last release, which is the newest tag `v*`, by cargo-semver-checks: what breaks
/// programs that use them needs another version.
fn compare_interfaces(release: &Release) -> Result<(), String> {
    let tags = output_of(
        Command::new("git")
            .args(["tag", "--list", "v*", "--sort=-version:refname"])
            .current_dir(&release.root),
    )?;
    let Some(last) = tags.lines().next() else {
        eprintln!("xtask: skipped: interfaces are not compared: there is no earlier release (no tag v*)");
        return Ok(());
    };
    let mut cargo = Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
    cargo.args(["semver-checks", "--workspace", "--baseline-rev", last]).current_dir(&release.root);
    cargo.env("CARGO_TARGET_DIR", release.target.join("compared-crates"));
    output_of(&mut cargo).map(drop).map_err(|why| {
        format!("{why}\n(if cargo has no such command: cargo install cargo-semver-checks --locked)")
    })
}

/// The npm packages that are published; each is built before it is packed.
const PACKAGES: [&str; 3] = ["labspec", "elements", "adapters"];

/// Builds and packs the npm packages.
pub(super) fn npm_tarballs(release: &Release) -> Result<Vec<PathBuf>, String> {
    (release.scripts)()?;
    let mut packed = Vec::new();
    for package in PACKAGES {
        let folder = release.root.join("web").join(package);
        for licence in ["LICENSE-MIT", "LICENSE-APACHE"] {
            copied(&release.root.join(licence), &folder, None)?;
        }
        npm(&folder, &["run", "--silent", "build"])?;
        let out = release.target.join("packed-npm");
        emptied(&out)?;
        npm(&folder, &["pack", "--silent", "--pack-destination", &out.display().to_string()])?;
        for file in files_of(&out)? {
            packed.push(copied(&file, &release.folder, None)?);
        }
    }
    Ok(packed)
}

/// Packs the extension of VS Code.
pub(super) fn editor(release: &Release) -> Result<Vec<PathBuf>, String> {
    let folder = release.root.join("bindings/vscode");
    npm(&folder, &["ci", "--no-audit", "--no-fund", "--silent"])?;
    npm(&folder, &["run", "--silent", "pack"])?;
    let name = format!("labspec-vscode-{}.vsix", release.version);
    Ok(vec![copied(&folder.join("labspec.vsix"), &release.folder, Some(name))?])
}
