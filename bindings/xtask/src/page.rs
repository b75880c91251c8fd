//! The scripts and styles of pages: the modules, then the npm packages that are built from them, in their order.

use std::path::{Path, PathBuf};
use std::process::Command;

/// The packages, each after those that it contains.
const PACKAGES: [&str; 3] = ["labspec", "elements", "site"];

/// The time that packages state instead of the time of packing: 1 January 2025, as the tools read it from `SOURCE_DATE_EPOCH`.
pub(crate) const PACKED_AT: &str = "1735689600";

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
    let files = built(build)?;
    let root = root();
    let lessons = lessons.unwrap_or_else(|| root.join("specs/lessons"));
    labspec(&root, "preview", |command| command.arg("--page").arg(&files).arg(&lessons))?;
    Ok(files)
}

/// The documentation and the course of this repository as a site: the first page is the list of the documentation.
const SITE: [&str; 5] =
    ["docs", "specs/lessons", "web/labspec/README.md", "web/elements/README.md", "CHANGELOG.md"];
const INDEX: &str = "docs/README.md";
/// Links to other files of the repository lead there.
const SOURCES: &str = "https://github.com/labspec/labspec/blob/main/";

/// Builds the site of this repository into a folder (`docs/site`).
pub(crate) fn site(
    folder: Option<PathBuf>,
    build: impl Fn() -> Result<PathBuf, String>,
) -> Result<PathBuf, String> {
    let files = built(build)?;
    let root = root();
    let folder = folder.unwrap_or_else(|| root.join("docs/site"));
    labspec(&root, "build", |command| {
        command.args(SITE.iter().map(|path| root.join(path))).arg("--index").arg(root.join(INDEX));
        command
            .args(["--title", "labspec", "--sources", SOURCES, "--page"])
            .arg(&files)
            .arg("--out")
            .arg(&folder)
    })?;
    Ok(folder)
}

/// The folder of the scripts and styles of pages, which are built if they are missing.
pub(crate) fn built(build: impl Fn() -> Result<PathBuf, String>) -> Result<PathBuf, String> {
    let files = root().join("web/site/dist");
    if !files.exists() {
        build()?;
        page()?;
    }
    Ok(files)
}

/// The repository.
pub(crate) fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// Runs a command of the program, which cargo builds.
fn labspec(root: &Path, name: &str, arguments: impl Fn(&mut Command) -> &mut Command) -> Result<(), String> {
    let mut cargo = Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
    cargo
        .args(["run", "--locked", "--package", "labspec-cli", "--manifest-path"])
        .arg(root.join("Cargo.toml"));
    match arguments(cargo.args(["--", name]))
        .status()
        .map_err(|e| format!("cannot run cargo: {e}"))?
        .success()
    {
        true => Ok(()),
        false => Err(format!("`labspec {name}` ended with an error")),
    }
}

/// Runs npm in the folder of a package.
pub(crate) fn npm(folder: &Path, arguments: &[&str]) -> Result<(), String> {
    let program = if cfg!(windows) { "npm.cmd" } else { "npm" };
    let mut command = Command::new(program);
    command.args(arguments).current_dir(folder).env("SOURCE_DATE_EPOCH", PACKED_AT);
    let done = command.status();
    match done.map_err(|e| format!("cannot run npm, which comes with node: {e}"))?.success() {
        true => Ok(()),
        false => Err(format!("`npm {}` failed in {}", arguments.join(" "), folder.display())),
    }
}
