//! The output of a check: what each format prints, the files that are written, and the outcome of the command.

use super::baseline::Baseline;
use super::common::{Color, CommandOutcome, Failure, interrupted};
use super::course::CourseResults;
use super::machine::check_report;
use super::output::write_file;
use super::output_kind::OutputKind;
use super::overview::{format_allowed, format_overview, format_summary};
use super::report_json::print_report;
use super::reproduction::ReproductionRecord;
use super::stdio::{print, print_error, print_json};
use super::{judge, reproduction, since};
use clap::ValueEnum;
use labspec::ledger::{self, Entry, State, Subject};
use labspec::report::html::Material;
use labspec::report::{self, printable_lines, printable_path};
use labspec::source::SourceFile;
use labspec::spec::Lesson;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(super) enum CheckFormat {
    /// For people
    Human,
    /// A line for each finding
    Concise,
    /// For programs
    Json,
    /// A JSON object in each line
    Jsonl,
    /// Commands of GitHub's workflows
    Github,
    /// GitLab's report of code quality
    Gitlab,
    /// SARIF 2.1.0, for code scanning
    Sarif,
    /// JUnit: a test case for each claim
    Junit,
}

/// The record of an earlier check: its file and its content.
pub(super) type PreviousRecord<'a> = (&'a Path, ReproductionRecord);

/// The file of the earlier record, and the changes since then.
type Changes<'a> = (&'a Path, Vec<since::LessonChange>);

/// The options of the output.
pub(super) struct OutputOptions<'a> {
    pub(super) paths: &'a [PathBuf],
    /// Whether it is no error that nothing could be checked.
    pub(super) skip_others: bool,
    pub(super) format: CheckFormat,
    pub(super) color: Color,
    /// Whether the command is `verify`, which prints the evidence of every claim.
    pub(super) with_evidence: bool,
    pub(super) statistics: bool,
    /// Whether only the summary is printed.
    pub(super) quiet: bool,
    pub(super) show_allowed: bool,
    /// The baseline to write.
    pub(super) new_baseline: Option<&'a Path>,
    /// The request to the reference simulator to write.
    pub(super) judge_request: Option<&'a Path>,
    /// The recording of the reference simulator that was used for the comparison.
    pub(super) recording: Option<&'a Path>,
    /// The record of this check to write.
    pub(super) record: Option<&'a Path>,
    /// The page to write.
    pub(super) html: Option<&'a Path>,
    /// The record of the earlier check that is used for the comparison.
    pub(super) previous: Option<&'a PreviousRecord<'a>>,
}

/// Writes the files, prints the results, and returns the outcome of the command.
///
/// # Errors
/// Something cannot be written, or no lesson contains a claim that could be verified.
pub(super) fn report_results(
    options: &OutputOptions<'_>,
    results: &CourseResults,
) -> Result<CommandOutcome, Failure> {
    let outcome = overall_outcome(options, results);
    let mut sources: Vec<&SourceFile> = results.checked.iter().map(|c| &c.lesson.file).collect();
    sources.extend(&results.sources);
    write_files(options, results, &sources)?;
    let changes = options
        .previous
        .map(|(file, old)| (*file, since::changes(old, &reproduction::current(file, results))));
    match options.format {
        _ if options.statistics => {
            print(&format!("{}{}\n", report::statistics(&results.findings), format_summary(results)))?;
        }
        CheckFormat::Human if options.quiet => print(&format!("{}\n", format_summary(results)))?,
        CheckFormat::Human => print(&human_text(options, outcome, results, &sources, changes.as_ref()))?,
        CheckFormat::Json => {
            let mut report = check_report(outcome, results, &sources);
            report.since = changes.as_ref().map(|(_, changes)| changes.as_slice());
            report.judge = results.reference_engine.as_ref().map(|engine| judge::machine(engine, results));
            print_report(if options.with_evidence { "verify" } else { "check" }, &report)?;
        }
        CheckFormat::Concise => print(&report::concise(&results.findings, &sources))?,
        CheckFormat::Jsonl => print(&report::jsonl(&results.findings, &sources))?,
        CheckFormat::Github => {
            let annotations = report::github(&results.findings, &sources);
            print(&format!("{annotations}{}\n", printable_lines(&format_summary(results))))?;
        }
        CheckFormat::Gitlab => print_json(&report::gitlab(&results.findings, &sources), true)?,
        CheckFormat::Sarif => print_json(&report::sarif(&results.findings, &sources), true)?,
        CheckFormat::Junit => print(&report::junit(&results.ledger, &results.findings, &sources))?,
    }
    print_unlisted_outcome(options, outcome, results);
    command_outcome(options, outcome, results)
}

/// If a format consists of findings, and they are not the reason why the check is not clean: the reason on standard error.
fn print_unlisted_outcome(options: &OutputOptions<'_>, outcome: ledger::Outcome, results: &CourseResults) {
    let lists_findings = matches!(
        options.format,
        CheckFormat::Concise | CheckFormat::Jsonl | CheckFormat::Gitlab | CheckFormat::Sarif
    );
    let is_problem = |f: &labspec::finding::Finding| f.severity != labspec::finding::Severity::Note;
    let is_listed = results.findings.iter().any(is_problem) && outcome == ledger::Outcome::Findings;
    if lists_findings && !is_listed && matches!(outcome, ledger::Outcome::Findings | ledger::Outcome::Partial)
    {
        print_error(&format!("{}\n", printable_lines(&format_summary(results))));
    }
}

/// The outcome of the ledger; `Nothing` for `verify` if there are no claims.
fn overall_outcome(options: &OutputOptions<'_>, results: &CourseResults) -> ledger::Outcome {
    let is_claimed = |e: &Entry| {
        let claims = [Subject::Answer, Subject::Quote, Subject::ClosedForm, Subject::Run];
        claims.contains(&e.subject) && e.state != State::NotClaimed
    };
    match results.ledger.outcome() {
        ledger::Outcome::Clean
            if options.with_evidence && !results.ledger.entries().iter().any(is_claimed) =>
        {
            ledger::Outcome::Nothing
        }
        outcome => outcome,
    }
}

/// Writes the requested files; none after Ctrl-C.
fn write_files(
    options: &OutputOptions<'_>,
    results: &CourseResults,
    sources: &[&SourceFile],
) -> Result<(), Failure> {
    if let Some(file) = options.new_baseline {
        // Without the findings of the other files, the baseline would forget them.
        if interrupted() {
            return Err(format!(
                "{} is not changed, because the check was interrupted",
                printable_path(file)
            ));
        }
        let lessons: Vec<&Lesson> = results.checked.iter().map(|c| &c.lesson).collect();
        let claims = (results.ledger.entries(), lessons.as_slice());
        let others =
            if file.exists() { Baseline::read(file)?.of_other_files(sources) } else { Baseline::new(file) };
        others.write(file, &results.findings, sources, claims)?;
    }
    if let Some(file) = options.record.filter(|_| !interrupted()) {
        reproduction::write(file, &reproduction::current(file, results))?;
    }
    if let Some(file) = options.judge_request.filter(|_| !interrupted()) {
        judge::write_request(file, results)?;
    }
    if let Some(file) = options.html.filter(|_| !interrupted()) {
        let material = Material {
            lessons: &results.checked,
            curves: &results.curves,
            bases: &results.bases,
            findings: &results.findings,
            allowed: &results.suppressed.allowed,
            ledger: &results.ledger,
            sources,
            summary: &format_summary(results),
        };
        write_file(file, OutputKind::Page, &report::html::page(&material))?;
    }
    Ok(())
}

/// The output for people. The findings of lessons have already been printed.
fn human_text(
    options: &OutputOptions<'_>,
    outcome: ledger::Outcome,
    results: &CourseResults,
    sources: &[&SourceFile],
    changes: Option<&Changes<'_>>,
) -> String {
    let mut text = report::human(&results.course_findings, sources, options.color.on());
    if options.show_allowed {
        text.push_str(&format_allowed(results, sources));
    }
    text.push_str(&format_overview(results, options.with_evidence));
    if let Some((file, changes)) = changes {
        text.push_str(&since::summary(&file.display().to_string(), changes));
    }
    if let (Some(file), Some(engine)) = (options.recording, &results.reference_engine) {
        text.push_str(&judge::summary(file, engine, results));
    }
    if outcome == results.ledger.outcome() {
        let _ = writeln!(text, "{}", format_summary(results));
    }
    text
}

/// Returns the outcome of the command.
///
/// # Errors
/// Nothing could be checked or verified.
fn command_outcome(
    options: &OutputOptions<'_>,
    outcome: ledger::Outcome,
    results: &CourseResults,
) -> Result<CommandOutcome, Failure> {
    if options.new_baseline.is_some() {
        // The current findings have become the baseline, so there are no new ones. A claim whose finding is ignored is not in it.
        let is_ignored = results.suppressed.ignored.iter().any(labspec::finding::Finding::is_error);
        match outcome {
            ledger::Outcome::Findings if is_ignored => return Ok(CommandOutcome::Findings),
            ledger::Outcome::Partial => return Ok(CommandOutcome::Partial),
            ledger::Outcome::Nothing => {}
            _ => return Ok(CommandOutcome::Clean),
        }
    }
    let names = || options.paths.iter().map(|p| printable_path(p)).collect::<Vec<_>>().join(", ");
    match outcome {
        ledger::Outcome::Findings => Ok(CommandOutcome::Findings),
        ledger::Outcome::Nothing if results.ledger.outcome() == ledger::Outcome::Clean => Err(format!(
            "there is nothing to verify in {}: no question and no lab has a `verify` object",
            names()
        )),
        // No file contains anything, and the user expects that.
        ledger::Outcome::Nothing if options.skip_others => Ok(CommandOutcome::Clean),
        ledger::Outcome::Nothing => {
            Err(format!("there is nothing to check in {}: no lab, no question and no model", names()))
        }
        ledger::Outcome::Partial => Ok(CommandOutcome::Partial),
        ledger::Outcome::Clean | ledger::Outcome::Baselined
            if results.reference_engine.is_some() && judge::is_partial(results) =>
        {
            Ok(CommandOutcome::Partial)
        }
        ledger::Outcome::Clean | ledger::Outcome::Baselined => Ok(CommandOutcome::Clean),
    }
}
