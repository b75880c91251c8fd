//! The command line: one file per command, each a thin layer over the library.

mod bench;
mod check;
mod explain;
mod fmt;
mod plan;
mod precision;
mod record;
mod run;
mod target;

use clap::{Args, Parser, Subcommand, ValueEnum};
use std::ffi::OsString;
use std::io::IsTerminal;
use std::path::PathBuf;
use std::process::ExitCode;

/// Checks that physics lessons tell the truth.
#[derive(Parser, Debug)]
#[command(name = "labspec", version, about, max_term_width = 100)]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand, Debug)]
enum Command {
    /// Lint and run all labs and verify all quizzes of lessons, JSON files, or folders of them
    Check(check::Arguments),
    /// Verify the claims of quizzes and labs only, with every measure
    Verify(check::Arguments),
    /// Lay out the code in lessons; with --modernize, write bare indexes by name
    Fmt(fmt::Arguments),
    /// Run one lab without a page: LAB.json, LESSON.md#2, LESSON.md#quiz-id.1
    Run(run::Arguments),
    /// Error against run time of integrators and timesteps, for one lab
    Precision(precision::Arguments),
    /// Which stages of the engine a lab or model needs, and why
    Plan(plan::Arguments),
    /// What a finding's code means, with an example; without a code, the list of all
    Explain(explain::Arguments),
    /// For engineers: our engine's numbers for the states of a recording of MuJoCo
    Record(record::Arguments),
    /// For engineers: time of a step
    Bench(bench::Arguments),
    /// Write the reference pages
    #[command(hide = true)]
    Reference {
        /// The folder
        folder: PathBuf,
    },
}

/// Where models are.
#[derive(Args, Debug, Clone)]
struct ModelOptions {
    /// The folder of models [default: `models/` beside or above the lesson]
    #[arg(long, value_name = "DIR")]
    models: Option<PathBuf>,
    /// What models may read, meshes and included files, lies in this folder [default: the nearest folder around the
    /// models with `labspec.toml`, else their repository or environment of packages, else the folder that is checked,
    /// else their own folder]
    #[arg(long, value_name = "DIR")]
    root: Option<PathBuf>,
}

/// When to use colours.
#[derive(Clone, Copy, Debug, ValueEnum)]
enum Color {
    /// On a terminal, unless NO_COLOR is set
    Auto,
    Always,
    Never,
}

impl Color {
    fn on(self) -> bool {
        match self {
            Color::Auto => std::io::stdout().is_terminal() && std::env::var_os("NO_COLOR").is_none(),
            Color::Always => true,
            Color::Never => false,
        }
    }
}

/// What a command came to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Outcome {
    Clean,
    Findings,
}

/// Why a command could not run: a sentence for the user that says what to do next.
type Failure = String;

/// Runs the program with these arguments, the first being its own name.
pub fn main(arguments: impl IntoIterator<Item = OsString>) -> ExitCode {
    let cli = match Cli::try_parse_from(arguments) {
        Ok(cli) => cli,
        Err(e) => {
            // clap's own text; help and version are not errors.
            let _ = e.print();
            return ExitCode::from(if e.use_stderr() { 2 } else { 0 });
        }
    };
    let result = match &cli.command {
        Command::Check(a) => check::check(a),
        Command::Verify(a) => check::verify(a),
        Command::Fmt(a) => fmt::fmt(a),
        Command::Run(a) => run::run(a),
        Command::Precision(a) => precision::precision(a),
        Command::Plan(a) => plan::plan(a),
        Command::Explain(a) => explain::explain(a),
        Command::Record(a) => record::record(a),
        Command::Bench(a) => bench::bench(a),
        Command::Reference { folder } => reference(folder),
    };
    match result {
        Ok(Outcome::Clean) => ExitCode::SUCCESS,
        Ok(Outcome::Findings) => ExitCode::from(1),
        Err(message) => {
            eprintln!("labspec: {message}");
            ExitCode::from(2)
        }
    }
}

fn reference(folder: &std::path::Path) -> Result<Outcome, Failure> {
    std::fs::create_dir_all(folder).map_err(|e| format!("cannot make {}: {e}", folder.display()))?;
    for (name, text) in crate::reference::pages() {
        write_file(&folder.join(name), &text)?;
    }
    Ok(Outcome::Clean)
}

/// Prints to standard output. A reader that has gone away (`| head`) ends the program quietly.
fn print(text: &str) -> Result<(), Failure> {
    use std::io::Write;
    match std::io::stdout().lock().write_all(text.as_bytes()) {
        Err(e) if e.kind() != std::io::ErrorKind::BrokenPipe => Err(format!("cannot write: {e}")),
        _ => Ok(()),
    }
}

fn write_file(path: &std::path::Path, text: &str) -> Result<(), Failure> {
    std::fs::write(path, text).map_err(|e| format!("cannot write {}: {e}", path.display()))
}
