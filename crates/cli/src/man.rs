//! `labspec man`: manual pages.

use super::common::{CommandOutcome, Failure};
use super::stdio::print;
use clap_mangen::Man;
use labspec_finding::nearest;

/// Arguments of `man`.
#[derive(clap::Args, Debug)]
pub(super) struct ManArguments {
    /// The command [default: the page of the program]
    command: Option<String>,
    /// List the commands that have a page
    #[arg(long, conflicts_with = "command")]
    list: bool,
}

pub(super) fn man(a: &ManArguments, program: &mut clap::Command) -> Result<CommandOutcome, Failure> {
    // Propagates the version and the global options to the commands.
    program.build();
    let has_page = |c: &clap::Command| !c.is_hide_set() && c.get_name() != "help";
    let names = || program.get_subcommands().filter(|c| has_page(c)).map(clap::Command::get_name);
    if a.list {
        print(&names().map(|name| format!("{name}\n")).collect::<String>())?;
        return Ok(CommandOutcome::Clean);
    }
    let page = match &a.command {
        None => program.clone(),
        Some(name) => {
            let command = program.find_subcommand(name).filter(|c| has_page(c));
            let near = || match nearest(name, names()) {
                Some(near) => format!("did you mean `{near}`?"),
                None => "`labspec help` lists them".into(),
            };
            // The name of a page is that of `man labspec-check`; its usage stays `labspec check`.
            let command = command.ok_or_else(|| format!("there is no such command; {}", near()))?.clone();
            let title = format!("labspec-{name}");
            command.display_name(title)
        }
    };
    let mut text = Vec::new();
    Man::new(page).render(&mut text).map_err(|e| format!("cannot write the page: {e}"))?;
    print(&String::from_utf8_lossy(&text))?;
    Ok(CommandOutcome::Clean)
}
