//! `labspec completions`: completion scripts for shells.

use super::common::{CommandOutcome, Failure};
use super::stdio::print;
use clap_complete::{Shell, generate};

/// Arguments of `completions`.
#[derive(clap::Args, Debug)]
pub(super) struct CompletionsArguments {
    /// The shell
    #[arg(value_enum)]
    shell: Shell,
}

pub(super) fn completions(
    a: &CompletionsArguments,
    command: &mut clap::Command,
) -> Result<CommandOutcome, Failure> {
    let mut script = Vec::new();
    generate(a.shell, command, "labspec", &mut script);
    print(&String::from_utf8_lossy(&script))?;
    Ok(CommandOutcome::Clean)
}
