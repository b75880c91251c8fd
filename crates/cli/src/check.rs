//! `labspec check` and `labspec verify`: the arguments, and the input that is read before the check.

use super::baseline::Baseline;
use super::cache::Cache;
use super::check_output::{CheckFormat, OutputOptions, PreviousRecord, report_results};
use super::collect::{STDIN, collect};
use super::common::{Color, CommandOutcome, Failure, ModelOptions};
use super::course::{CheckRequest, CrossCheckRequest};
use super::fix::{FixMode, fix};
use super::listings::ListingRunner;
use super::output::{PlannedOutput, check_outputs_writable};
use super::output_kind::OutputKind;
use super::policy::PolicyOptions;
use super::scheduler::check_lessons;
use super::stdio::print_error;
use super::{judge, reproduction, watch};
use labspec::check::{CheckLevel, ReferenceRecording};
use labspec::report::counted;
use std::io::{IsTerminal, Read};
use std::num::NonZeroUsize;
use std::path::{Path, PathBuf};

/// Arguments of `check` and `verify`.
#[derive(clap::Args, Debug)]
pub(super) struct VerifyArguments {
    /// Lessons (.md), labs and quizzes (.json), models (.xml), or folders of lessons [default: the current folder]
    #[arg(value_name = "PATH", default_value = ".", hide_default_value = true)]
    paths: Vec<PathBuf>,
    /// Print only the last line, with the counts and the conclusion
    #[arg(short, long, conflicts_with = "format")]
    quiet: bool,
    #[command(flatten)]
    models: ModelOptions,
    /// Output format
    #[arg(long, value_enum, default_value = "human")]
    format: CheckFormat,
    #[arg(long, value_enum, default_value = "auto", value_name = "WHEN")]
    color: Color,
    /// Number of files to check in parallel [default: the number of processors]
    #[arg(long, value_name = "N")]
    jobs: Option<NonZeroUsize>,
    /// Check everything, even unchanged files, and store no results
    #[arg(long)]
    no_cache: bool,
    /// Check again whenever a file changes, until Ctrl-C
    #[arg(long)]
    watch: bool,
    /// The name of the lesson that is read from standard input, where PATH is `-`
    #[arg(long, value_name = "NAME", default_value = "stdin.md")]
    stdin_name: PathBuf,
    #[command(flatten)]
    policy: PolicyOptions,
    /// Report only findings that are not in this file
    #[arg(long, value_name = "FILE")]
    baseline: Option<PathBuf>,
    /// Replace the baseline by the current findings
    #[arg(long, requires = "baseline")]
    update_baseline: bool,
    /// Write a request for a cross-check: every run of every `verify` object, to be recorded by tests/judge/record.mjs
    #[arg(long, value_name = "FILE")]
    judge_request: Option<PathBuf>,
    /// Compare every measure with a recording of MuJoCo, and check every claim again with its numbers
    #[arg(long, value_name = "FILE")]
    judge: Option<PathBuf>,
    /// Show only the number of findings of each rule
    #[arg(long)]
    statistics: bool,
    /// Also show suppressed findings, with the reasons
    #[arg(long)]
    show_allowed: bool,
}

/// Arguments of `check`.
#[derive(clap::Args, Debug)]
pub(super) struct CheckArguments {
    #[command(flatten)]
    common: VerifyArguments,
    /// Check structure, models and the names in every text, but run nothing: labs and claims count as left out,
    /// and the exit code is 3 if no problems are found
    #[arg(long, conflicts_with = "update_baseline")]
    no_run: bool,
    /// Also run the Python listings that have an output below them, without a network and with limits, and compare the
    /// output; [listings] in labspec.toml has their settings. Run only listings that you trust with your files
    #[arg(long, conflicts_with = "no_run")]
    listings: bool,
    /// Skip named files that contain no lab, quiz or model, as in folders, and succeed if nothing is left: for hooks that
    /// name every changed file
    #[arg(long)]
    skip_others: bool,
    /// Apply safe fixes; every fix is checked before it is written
    #[arg(long)]
    fix: bool,
    /// Also apply fixes that are guesses
    #[arg(long)]
    unsafe_fixes: bool,
    /// Show what --fix would change, and change nothing
    #[arg(long)]
    diff: bool,
    /// Write every verdict with its basis: versions, settings of every run, digests of models and texts
    #[arg(long, value_name = "FILE", conflicts_with = "no_run")]
    record: Option<PathBuf>,
    /// Write a page for a browser: every verdict with its evidence, plots of the runs, and how much of the text is claimed
    #[arg(long, value_name = "FILE", conflicts_with = "no_run")]
    html: Option<PathBuf>,
    /// Report the changes since a recorded check: verdicts and values, with changed settings and models
    #[arg(long, value_name = "FILE", conflicts_with = "no_run")]
    since: Option<PathBuf>,
}

/// What a command checks.
#[derive(Clone, Copy)]
struct CheckMode {
    level: CheckLevel,
    skip_others: bool,
    listings: bool,
    /// Whether every measure is printed.
    with_evidence: bool,
}

/// The files that a check writes in addition to its output, and the earlier record with which it is compared.
#[derive(Clone, Copy, Default)]
struct RecordPaths<'a> {
    write: Option<&'a Path>,
    html: Option<&'a Path>,
    since: Option<&'a Path>,
}

/// The input that is read before the check.
struct CheckInputs<'a> {
    /// The name and the text of a lesson from standard input.
    stdin: Option<(PathBuf, String)>,
    baseline: Option<Baseline>,
    previous: Option<PreviousRecord<'a>>,
    recording: Option<ReferenceRecording>,
}

pub(super) fn check_command(a: &CheckArguments) -> Result<CommandOutcome, Failure> {
    let level = if a.no_run { CheckLevel::STATIC } else { CheckLevel::FULL };
    let fix =
        (a.fix || a.diff || a.unsafe_fixes).then_some(FixMode { guesses: a.unsafe_fixes, diff: a.diff });
    let paths =
        RecordPaths { write: a.record.as_deref(), html: a.html.as_deref(), since: a.since.as_deref() };
    let mode = CheckMode { level, skip_others: a.skip_others, listings: a.listings, with_evidence: false };
    run_check(&a.common, mode, fix, paths)
}

pub(super) fn verify_command(a: &VerifyArguments) -> Result<CommandOutcome, Failure> {
    let mode =
        CheckMode { level: CheckLevel::CLAIMS, skip_others: false, listings: false, with_evidence: true };
    run_check(a, mode, None, RecordPaths::default())
}

/// Checks once, or again whenever a file changes.
fn run_check(
    a: &VerifyArguments,
    mode: CheckMode,
    fix_mode: Option<FixMode>,
    paths: RecordPaths<'_>,
) -> Result<CommandOutcome, Failure> {
    let CheckMode { level, skip_others, with_evidence, .. } = mode;
    if a.statistics && a.format != CheckFormat::Human {
        return Err("--statistics is for people; leave out --format".into());
    }
    let cache = Cache::open(a.no_cache, a.watch);
    let listings = mode.listings.then(|| ListingRunner::new(&cache));
    let processors = || std::thread::available_parallelism().map_or(1, NonZeroUsize::get);
    let inputs = read_inputs(a, fix_mode.is_some(), paths)?;
    let is_human = a.format == CheckFormat::Human;
    let request = CheckRequest {
        paths: &a.paths,
        skip_others,
        stdin: inputs.stdin.as_ref(),
        models: &a.models,
        level,
        policy: &a.policy,
        baseline: inputs.baseline.as_ref(),
        listings: listings.as_ref(),
        with_bases: paths.write.is_some() || inputs.previous.is_some() || paths.html.is_some(),
        cross_check: CrossCheckRequest {
            collect_runs: a.judge_request.is_some(),
            recording: inputs.recording.as_ref(),
        },
        with_curves: paths.html.is_some(),
        jobs: a.jobs.map_or_else(processors, NonZeroUsize::get),
        progress: is_human && std::io::stderr().is_terminal(),
        findings_in_color: (is_human && !a.statistics && !a.quiet).then(|| a.color.on()),
    };
    let output = OutputOptions {
        paths: &a.paths,
        skip_others,
        format: a.format,
        color: a.color,
        with_evidence,
        statistics: a.statistics,
        quiet: a.quiet,
        show_allowed: a.show_allowed,
        new_baseline: a.baseline.as_deref().filter(|_| a.update_baseline),
        judge_request: a.judge_request.as_deref(),
        recording: a.judge.as_deref(),
        record: paths.write,
        html: paths.html,
        previous: inputs.previous.as_ref(),
    };
    if let Some(mode) = fix_mode
        && let Some(outcome) = apply_fixes(&request, mode)?
    {
        return Ok(outcome);
    }
    if !a.watch {
        return report_results(&output, &check_lessons(&request, &cache)?);
    }
    let settings: Vec<&Path> = a.policy.config().into_iter().chain(a.baseline.as_deref()).collect();
    watch::watch(&a.paths, &settings, || {
        listings.iter().for_each(ListingRunner::forget);
        let results = check_lessons(&request, &cache)?;
        Ok((report_results(&output, &results), results.dependencies))
    })
}

/// Reads the files that the arguments name, and checks that the outputs can be written and overwrite no input.
fn read_inputs<'a>(
    a: &VerifyArguments,
    fixes: bool,
    paths: RecordPaths<'a>,
) -> Result<CheckInputs<'a>, Failure> {
    let piped = a.paths.iter().any(|p| p.as_os_str() == STDIN);
    let stdin = piped.then(|| read_stdin().map(|text| (a.stdin_name.clone(), text))).transpose()?;
    if piped && (a.watch || fixes) {
        return Err("--watch and --fix do not work on standard input; name a file".into());
    }
    let baseline = match &a.baseline {
        Some(file) if !a.update_baseline => Some(Baseline::read(file)?),
        _ => None,
    };
    check_outputs(a, paths)?;
    // Read before anything is written, because it may be the same file.
    let previous = paths.since.map(|file| Ok::<_, Failure>((file, reproduction::read(file)?))).transpose()?;
    let recording = a.judge.as_deref().map(judge::read).transpose()?;
    Ok(CheckInputs { stdin, baseline, previous, recording })
}

/// Checks that the outputs can be written and overwrite no input.
fn check_outputs(a: &VerifyArguments, paths: RecordPaths<'_>) -> Result<(), Failure> {
    let outputs = [
        (OutputKind::Record, paths.write),
        (OutputKind::Page, paths.html),
        (OutputKind::JudgeRequest, a.judge_request.as_deref()),
        (OutputKind::Baseline, a.baseline.as_deref().filter(|_| a.update_baseline)),
    ];
    let outputs: Vec<PlannedOutput> = outputs
        .into_iter()
        .filter_map(|(kind, file)| Some(PlannedOutput { kind, path: file?.to_path_buf() }))
        .collect();
    if outputs.is_empty() {
        return Ok(());
    }
    let inputs: Vec<PathBuf> = collect(&a.paths).files.into_iter().map(|(path, _)| path).collect();
    check_outputs_writable(&inputs, &outputs)
}

/// Applies fixes. With `--diff`, the command ends here with the returned outcome.
fn apply_fixes(request: &CheckRequest<'_>, mode: FixMode) -> Result<Option<CommandOutcome>, Failure> {
    let repaired = fix(request, mode)?;
    if mode.diff {
        return Ok(Some(if repaired.fixes > 0 { CommandOutcome::Findings } else { CommandOutcome::Clean }));
    }
    if repaired.fixes > 0 {
        print_error(&format!(
            "fixed {} in {}\n",
            counted(repaired.fixes, "finding"),
            counted(repaired.files, "file")
        ));
    }
    Ok(None)
}

/// The maximum size of a lesson on standard input, in bytes.
const MAX_STDIN: u64 = 64 << 20;

fn read_stdin() -> Result<String, Failure> {
    let mut text = String::new();
    let read = std::io::stdin().lock().take(MAX_STDIN + 1).read_to_string(&mut text);
    let no = |why: String| format!("cannot read standard input: {why}");
    read.map_err(|e| no(e.to_string()))?;
    if text.len() as u64 > MAX_STDIN {
        Err(no(format!("it has more than {MAX_STDIN} bytes")))
    } else {
        Ok(text)
    }
}
