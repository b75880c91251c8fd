//! `labspec fmt`.

use super::check::{collect, is_other_json};
use super::target::model_folder;
use super::{Failure, ModelOptions, Outcome, print, write_file};
use crate::bind::scene::Models;
use crate::format;
use crate::source::SourceFile;
use crate::spec::load_lesson;
use std::path::PathBuf;

/// Arguments of `fmt`.
#[derive(clap::Args, Debug)]
pub(super) struct Arguments {
    /// Lessons (.md), labs and quizzes (.json), or folders of them
    #[arg(required = true, value_name = "PATH")]
    paths: Vec<PathBuf>,
    #[command(flatten)]
    models: ModelOptions,
    /// Also write bare indexes by name: data.qpos[9] as data.joint('light').qpos[2]
    #[arg(long)]
    modernize: bool,
    /// Change nothing; say which files would change
    #[arg(long)]
    check: bool,
}

pub(super) fn fmt(a: &Arguments) -> Result<Outcome, Failure> {
    let mut outcome = Outcome::Clean;
    let (files, problems) = collect(&a.paths);
    if let Some((_, why)) = problems.into_iter().next() {
        return Err(why);
    }
    for (path, named) in files {
        let file = SourceFile::read(&path)?;
        let folder = model_folder(&a.models, &path)?;
        let lesson = load_lesson(file, &folder);
        if !named && is_other_json(&lesson) {
            continue;
        }
        let mut models = Models::new(folder);
        let done = format::format(&lesson, a.modernize.then_some(&mut models));
        if done.changed == 0 {
            continue;
        }
        let of = format!("{} of {} texts", done.changed, done.total);
        if a.check {
            outcome = Outcome::Findings;
            print(&format!("{}: {of} would change\n", path.display()))?;
        } else {
            write_file(&path, &done.text)?;
            print(&format!("{}: {of} changed\n", path.display()))?;
        }
    }
    Ok(outcome)
}
