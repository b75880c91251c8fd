//! Items shared by all commands: options for models and colours, the outcome, failures, and Ctrl-C.

use clap::{Args, ValueEnum};
use labspec::interrupt;
use std::io::IsTerminal;
use std::path::PathBuf;

/// Where models are.
#[derive(Args, Debug, Clone)]
pub(super) struct ModelOptions {
    /// The folder of models [default: `models/` beside or above the lesson]
    #[arg(long, value_name = "DIR")]
    pub(super) models: Option<PathBuf>,
    /// Models can read meshes and included files only in this folder [default: the nearest folder around the
    /// models with `labspec.toml`, else their repository or environment of packages, else the folder that is checked,
    /// else their own folder]
    #[arg(long, value_name = "DIR")]
    pub(super) root: Option<PathBuf>,
}

/// When to use colours.
#[derive(Clone, Copy, Debug, ValueEnum)]
pub(super) enum Color {
    /// On a terminal, unless NO_COLOR is set
    Auto,
    Always,
    Never,
}

impl Color {
    pub(super) fn on(self) -> bool {
        match self {
            Color::Auto => std::io::stdout().is_terminal() && std::env::var_os("NO_COLOR").is_none(),
            Color::Always => true,
            Color::Never => false,
        }
    }
}

/// The outcome of a command.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum CommandOutcome {
    Clean,
    Findings,
    /// What was checked is in order, but not everything was checked.
    Partial,
}

/// The reason why a command could not run: a sentence for the user that states what to do next.
pub(super) type Failure = String;

/// Whether the user has pressed Ctrl-C: the command then prints finished results and stops with exit code 130.
pub(super) fn interrupted() -> bool {
    interrupt::requested()
}
