//! The commands of the program: their arguments, and the dispatch.

use super::common::{CommandOutcome, Failure, interrupted};
#[cfg(feature = "lsp")]
use super::lsp;
use super::output::write_file;
use super::output_kind::OutputKind;
use super::stdio::{self, print_error};
use super::{
    build, check, completions, config, developer, explain, fmt, init, man, plan, precision, preview,
    report_schema, run, scaffold, schema, snapshot, stability, trace,
};
use clap::{CommandFactory, Parser, Subcommand};
use labspec::interrupt;
use labspec::report::{printable_lines, printable_path};
use labspec::threads;
use std::ffi::OsString;
use std::io::Write;
use std::path::PathBuf;
use std::sync::LazyLock;

/// The version, the build, and whose semantics the engine has, for `--version`.
static LONG_VERSION: LazyLock<String> = LazyLock::new(|| {
    let vectors = match () {
        () if cfg!(target_feature = "avx2") => "AVX2",
        () if cfg!(target_feature = "sse2") => "SSE2",
        () if cfg!(target_feature = "neon") => "NEON",
        () => "no vector instructions",
    };
    let build = if cfg!(debug_assertions) { "with debug assertions" } else { "release" };
    let (system, processor) = (std::env::consts::OS, std::env::consts::ARCH);
    let version = env!("CARGO_PKG_VERSION");
    format!("{version}\nbuild: {processor}, {system}, {vectors}, {build}\nsemantics: MuJoCo 3.14.0")
});

/// Checks that physics lessons tell the truth.
#[derive(Parser, Debug)]
#[command(name = "labspec", version, long_version = LONG_VERSION.as_str(), about, max_term_width = 100)]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand, Debug)]
enum Command {
    /// Create a folder for lessons: settings, a first lesson with its model, a workflow
    Init(init::InitArguments),
    /// Lint and run all labs and verify all quizzes of lessons, JSON files, or folders of them
    Check(check::CheckArguments),
    /// Verify the claims of quizzes and labs only, with every measure
    Verify(check::VerifyArguments),
    /// Check a folder of lessons and write it as a static site
    Build(build::BuildArguments),
    /// Serve lessons to a browser on this machine while they are written: labs, findings, claims, fixes
    Preview(preview::PreviewArguments),
    /// Store the output of labs in snapshots for review; `check` compares the labs with them
    Snapshot(snapshot::SnapshotArguments),
    /// Format the code in lessons; with --modernize, replace bare indexes by names
    Fmt(fmt::FmtArguments),
    /// Run one lab without a page: LAB.json, LESSON.md#2, LESSON.md#quiz-id.1
    Run(run::RunArguments),
    /// Compare error and run time of integrators and timesteps, for one lab
    Precision(precision::PrecisionArguments),
    /// Find what breaks in one lab when a student moves its controls in every way
    Stability(stability::StabilityArguments),
    /// Show which stages of the engine a lab or model needs, why, and what each costs
    Plan(plan::PlanArguments),
    /// Find the origin of the numbers in a lesson: runs and measures with the same digits
    Trace(trace::TraceArguments),
    /// Propose a first, tested `verify` object for every question and lab that has none
    Scaffold(scaffold::ScaffoldArguments),
    /// Show the settings that hold for a lesson or a folder, and where they come from
    Config(config::ConfigArguments),
    /// Explain the code of a finding, with an example; without a code, list all codes
    Explain(explain::ExplainArguments),
    /// Print the JSON Schema of labs and quizzes, for editors: lab, quiz, or lesson for a JSON file of both
    Schema(schema::SchemaArguments),
    /// Serve an editor: findings, completion, values and names while typing (Language Server Protocol)
    #[cfg(feature = "lsp")]
    Lsp(lsp::LspArguments),
    /// For engineers: compute the numbers of this engine for the states of a MuJoCo recording
    Record(developer::RecordArguments),
    /// For engineers: measure the time of a step
    Bench(developer::BenchArguments),
    /// Print a completion script for a shell
    Completions(completions::CompletionsArguments),
    /// Print a manual page: of the program, or of a command
    Man(man::ManArguments),
    /// Write the reference pages, and the JSON Schemas into the folder `schema` beside them
    #[command(hide = true)]
    Reference {
        /// The folder
        folder: PathBuf,
    },
}

/// Runs the program with the arguments of a command line, of which the first is the name of the program. Returns the exit code.
pub fn run_program(arguments: impl IntoIterator<Item = OsString>) -> u8 {
    let cli = match Cli::try_parse_from(arguments) {
        Ok(cli) => cli,
        Err(e) => return usage(&e),
    };
    if cli.command.handles_interrupt() {
        listen();
    }
    // All work uses the same stack size, independent of that of the main thread.
    match threads::run(|| execute(&cli.command)) {
        Ok(_) if interrupted() => 130,
        Ok(CommandOutcome::Clean) => 0,
        Ok(CommandOutcome::Findings) => 1,
        Ok(CommandOutcome::Partial) => 3,
        Err(message) => {
            print_error(&format!("labspec: {}\n", printable_lines(&message)));
            if interrupted() { 130 } else { 2 }
        }
    }
}

/// Registers a handler for Ctrl-C, which sets a flag that ends long work. A second Ctrl-C ends the program at
/// once with exit code 130.
fn listen() {
    #[cfg(any(unix, windows))]
    {
        use signal_hook::{consts::SIGINT, flag};
        let requested = interrupt::flag();
        // The handlers run in this order. If they cannot be registered, Ctrl-C ends the program as usual.
        if flag::register_conditional_shutdown(SIGINT, 130, requested.clone()).is_ok() {
            let _ = flag::register(SIGINT, requested);
        }
    }
}

fn execute(command: &Command) -> Result<CommandOutcome, Failure> {
    match command {
        Command::Init(a) => init::init(a),
        Command::Completions(a) => completions::completions(a, &mut Cli::command()),
        Command::Man(a) => man::man(a, &mut Cli::command()),
        Command::Check(a) => check::check_command(a),
        Command::Verify(a) => check::verify_command(a),
        Command::Build(a) => build::build(a),
        Command::Preview(a) => preview::preview(a),
        Command::Snapshot(a) => snapshot::snapshot(a),
        Command::Fmt(a) => fmt::fmt(a),
        Command::Run(a) => run::run(a),
        Command::Precision(a) => precision::precision(a),
        Command::Stability(a) => stability::stability(a),
        Command::Plan(a) => plan::plan(a),
        Command::Trace(a) => trace::trace(a),
        Command::Scaffold(a) => scaffold::scaffold(a),
        Command::Config(a) => config::config(a),
        Command::Explain(a) => explain::explain(a),
        Command::Schema(a) => schema::schema(a),
        #[cfg(feature = "lsp")]
        Command::Lsp(a) => lsp::lsp(a),
        Command::Record(a) => developer::record(a),
        Command::Bench(a) => developer::bench(a),
        Command::Reference { folder } => write_reference(folder),
    }
}

impl Command {
    /// Whether the command tests for Ctrl-C between pieces of work. Ctrl-C ends all other commands at once.
    fn handles_interrupt(&self) -> bool {
        use Command::{
            Bench, Build, Check, Fmt, Plan, Precision, Record, Run, Scaffold, Snapshot, Stability, Trace,
            Verify,
        };
        matches!(
            self,
            Check(_)
                | Verify(_)
                | Build(_)
                | Snapshot(_)
                | Fmt(_)
                | Run(_)
                | Precision(_)
                | Plan(_)
                | Stability(_)
                | Trace(_)
                | Scaffold(_)
                | Record(_)
                | Bench(_)
        )
    }
}

/// Prints the help or the version, which are not errors, or the error in the arguments.
fn usage(e: &clap::Error) -> u8 {
    if e.use_stderr() {
        // An argument may be a file name that someone else chose.
        print_error(&printable_lines(&e.render().to_string()));
        return 2;
    }
    match stdio::outcome(e.print().and_then(|()| std::io::stdout().flush())) {
        Ok(()) => 0,
        Err(message) => {
            print_error(&format!("labspec: {message}\n"));
            2
        }
    }
}

/// Writes the reference pages and schemas.
fn write_reference(folder: &std::path::Path) -> Result<CommandOutcome, Failure> {
    let schemas = folder.parent().unwrap_or(folder).join("schema");
    for folder in [folder, &folder.join("rules"), &schemas] {
        std::fs::create_dir_all(folder)
            .map_err(|e| format!("cannot make {}: {e}", printable_path(folder)))?;
    }
    for (name, text) in labspec::reference::pages() {
        write_file(&folder.join(name), OutputKind::Reference, &text)?;
    }
    for (name, text) in labspec::reference::schemas() {
        write_file(&schemas.join(name), OutputKind::Reference, &text)?;
    }
    for (name, text) in report_schema::schemas() {
        write_file(&schemas.join(name), OutputKind::Reference, &text)?;
    }
    Ok(CommandOutcome::Clean)
}
