//! `labspec config`: the settings that hold for a file, and where they come from.

use super::common::{CommandOutcome, Failure, ModelOptions};
use super::policy::{FILE, Policies, PolicyOptions};
use super::stdio::print;
use labspec::lint::ModelFolder;
use labspec::report::{printable, printable_path};
use std::fmt::Write as _;
use std::path::PathBuf;

/// Arguments of `config`.
#[derive(clap::Args, Debug)]
pub(super) struct ConfigArguments {
    /// A lesson or a folder
    #[arg(value_name = "PATH", default_value = ".")]
    path: PathBuf,
    #[command(flatten)]
    models: ModelOptions,
    #[command(flatten)]
    policy: PolicyOptions,
}

pub(super) fn config(a: &ConfigArguments) -> Result<CommandOutcome, Failure> {
    if !a.path.exists() {
        return Err(format!("{} does not exist", printable_path(&a.path)));
    }
    let (file, settings) = Policies::new(&a.policy)?.effective(&a.path)?;
    let mut text = format!("{}\n", printable_path(&a.path));
    let names = settings.iter().map(|s| s.name.len()).max().unwrap_or(0).max("settings".len());
    let file = match &file {
        Some(file) => printable_path(file),
        None => format!("none: there is no {FILE} in or above its folder"),
    };
    let _ = writeln!(text, "  {:<names$} {file}", "settings");
    // The models of a folder are those of the lessons in it.
    let lesson = if a.path.is_dir() { a.path.join("lesson.md") } else { a.path.clone() };
    let found = a.models.models.clone().or_else(|| ModelFolder::find_near(&lesson));
    let folder = found
        .as_deref()
        .map_or("none: there is no folder `models` beside or above it".into(), printable_path);
    let _ = writeln!(text, "  {:<names$} {folder}", "models");
    let width = settings.iter().map(|s| s.value.chars().count()).max().unwrap_or(0);
    for setting in &settings {
        let value = printable(&setting.value);
        let _ =
            writeln!(text, "  {:<names$} {value:<width$}  ({})", setting.name, printable(&setting.origin));
    }
    if !settings.iter().any(|setting| setting.name == "select") {
        let _ = writeln!(text, "  {:<names$} {:<width$}  (default)", "select", "all");
    }
    print(&text)?;
    Ok(CommandOutcome::Clean)
}
