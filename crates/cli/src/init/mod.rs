//! `labspec init`: a folder for lessons, with a first lesson whose claims are true.

use super::common::{CommandOutcome, Failure};
use super::output::write_file;
use super::output_kind::OutputKind;
use super::stdio::print;
use labspec::report::printable_path;
use std::path::{Path, PathBuf};

/// Arguments of `init`.
#[derive(clap::Args, Debug)]
pub(super) struct InitArguments {
    /// The folder; it is created if it does not exist
    #[arg(default_value = ".", value_name = "DIR")]
    folder: PathBuf,
}

/// The names and contents of the files that are written. `VERSION` stands for the version of this program, with which the lessons are
/// checked until its author changes it.
const FILES: [(&str, &str); 4] = [
    ("labspec.toml", include_str!("labspec.toml")),
    ("lessons/01-fall.md", include_str!("lesson.md")),
    ("lessons/models/fall.xml", include_str!("fall.xml")),
    (".github/workflows/labspec.yml", include_str!("workflow.yml")),
];

pub(super) fn init(a: &InitArguments) -> Result<CommandOutcome, Failure> {
    let places: Vec<(PathBuf, &str)> =
        FILES.iter().map(|(name, text)| (a.folder.join(name), *text)).collect();
    // Nothing is written if one of the files already exists.
    if let Some((path, _)) = places.iter().find(|(path, _)| path.symlink_metadata().is_ok()) {
        return Err(format!(
            "{} already exists, so nothing was written; name an empty folder: labspec init FOLDER",
            printable_path(path)
        ));
    }
    let mut message = String::new();
    for (path, text) in places {
        let folder = path.parent().unwrap_or(Path::new("."));
        std::fs::create_dir_all(folder)
            .map_err(|e| format!("cannot make {}: {e}", printable_path(folder)))?;
        write_file(&path, OutputKind::New, &text.replace("VERSION", env!("CARGO_PKG_VERSION")))?;
        message.push_str(&format!("wrote {}\n", printable_path(&path)));
    }
    let lessons = a.folder.join("lessons");
    message.push_str(&format!("\nnow run: labspec check {}\n", printable_path(&lessons)));
    print(&message)?;
    Ok(CommandOutcome::Clean)
}
