//! The scripts and styles of pages: the modules, then the npm packages that are built from them, in their order.

use std::path::{Path, PathBuf};
use std::process::Command;

/// The packages, each after those that it contains.
const PACKAGES: [&str; 3] = ["labspec", "elements", "site"];

/// Builds the npm packages; returns the folder that `labspec build` and `labspec preview` use.
pub(crate) fn page() -> Result<PathBuf, String> {
    let web = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../web");
    if !web.join("node_modules").exists() {
        npm(&web, &["ci", "--no-audit", "--no-fund"])?;
    }
    for package in PACKAGES {
        npm(&web.join(package), &["run", "--silent", "build"])?;
    }
    Ok(web.join("site/dist"))
}

/// Shows lessons in a browser: builds the page once, then runs `labspec preview` until it ends.
pub(crate) fn preview(
    lessons: Option<PathBuf>,
    build: impl Fn() -> Result<PathBuf, String>,
) -> Result<PathBuf, String> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let files = root.join("web/site/dist");
    if !files.exists() {
        build()?;
        page()?;
    }
    let lessons = lessons.unwrap_or_else(|| root.join("specs/lessons"));
    let mut command = Command::new("cargo");
    command
        .args(["run", "--locked", "--package", "labspec-cli", "--manifest-path"])
        .arg(root.join("Cargo.toml"));
    command.args(["--", "preview", "--page"]).arg(&files).arg(&lessons);
    match command.status().map_err(|e| format!("cannot run cargo: {e}"))?.success() {
        true => Ok(files),
        false => Err("`labspec preview` ended with an error".into()),
    }
}

fn npm(folder: &Path, arguments: &[&str]) -> Result<(), String> {
    let program = if cfg!(windows) { "npm.cmd" } else { "npm" };
    let done = Command::new(program).args(arguments).current_dir(folder).status();
    match done.map_err(|e| format!("cannot run npm, which comes with node: {e}"))?.success() {
        true => Ok(()),
        false => Err(format!("`npm {}` failed in {}", arguments.join(" "), folder.display())),
    }
}
