//! `labspec scaffold`.

use super::common::{CommandOutcome, Failure, ModelOptions, interrupted};
use super::output::write_file;
use super::output_kind::OutputKind;
use super::policy::conventions_of;
use super::report_json::print_report;
use super::stdio::{Progress, print};
use super::target::model_folder;
use clap::ValueEnum;
use labspec::bind::scene::Models;
use labspec::lint::{load_lesson_file, reload_lesson};
use labspec::report::{printable, printable_lines, printable_path};
use labspec::spec::Lesson;
use labspec::verify::{Verdict, significant};
use labspec_finding::nearest;
use labspec_proposals::scaffold::{Scaffold, ScaffoldOutcome, scaffold as look, written};
use labspec_proposals::trace::{ProposedVerify, format_verify};
use schemars::JsonSchema;
use serde::Serialize;
use serde_json::{Map, Value};
use std::fmt::Write;
use std::path::{Path, PathBuf};

/// Arguments of `scaffold`.
#[derive(clap::Args, Debug)]
pub(super) struct ScaffoldArguments {
    /// A lesson, or a JSON file of labs or quizzes
    lesson: PathBuf,
    #[command(flatten)]
    models: ModelOptions,
    /// Insert the objects into the lesson; everything else stays unchanged. With names such as `quiz-id.2` or `#1`, only those, and
    /// also the skeletons of questions that are not decided
    #[arg(long, num_args = 0.., value_name = "NAME")]
    write: Option<Vec<String>>,
    /// Output format
    #[arg(long, value_enum, default_value = "human")]
    format: ScaffoldFormat,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum ScaffoldFormat {
    Human,
    Json,
}

pub(super) fn scaffold(a: &ScaffoldArguments) -> Result<CommandOutcome, Failure> {
    let folder = model_folder(&a.models, &a.lesson)?;
    let mut lesson = load_lesson_file(&a.lesson, &folder)?;
    lesson.conventions = conventions_of(&a.lesson)?;
    let models = Models::new(folder.clone());
    let progress = Progress::new(a.format == ScaffoldFormat::Human);
    let all = look(&lesson, &models, &mut |text| progress.report(text));
    drop(progress);
    if interrupted() {
        return Ok(CommandOutcome::Clean);
    }
    let names = a.write.as_deref().unwrap_or_default();
    if let Some(unknown) = names.iter().find(|name| !all.iter().any(|one| one.address == **name)) {
        return Err(unknown_name(&a.lesson, unknown, &all));
    }
    let is_written = |one: &&Scaffold| match one.found {
        ScaffoldOutcome::Proposed { .. } => names.is_empty() || names.contains(&one.address),
        ScaffoldOutcome::Skeleton { .. } => names.contains(&one.address),
        _ => false,
    };
    let proposals = all.iter().filter(is_written).count();
    if a.write.is_some() && proposals > 0 {
        let text = written(&lesson, &all, names);
        // The new text is parsed again before the file is replaced.
        let again = reload_lesson(&lesson, &text, &folder);
        if again.verifies().count() != lesson.verifies().count() + proposals {
            return Err(format!(
                "{} is unchanged: the new objects would change its meaning; fix what `labspec check` finds first",
                printable_path(&a.lesson)
            ));
        }
        write_file(&a.lesson, OutputKind::Lesson(lesson.file.text()), &text)?;
    }
    match a.format {
        ScaffoldFormat::Human => print(&human(a, &lesson, &all))?,
        ScaffoldFormat::Json => print_report("scaffold", &machine(&lesson, &all))?,
    }
    let done = |one: &Scaffold| matches!(&one.found, ScaffoldOutcome::Proposed { verdict, .. } if is_confirmed(verdict));
    Ok(if all.iter().all(done) { CommandOutcome::Clean } else { CommandOutcome::Findings })
}

/// The error that a name belongs to no question or lab without a claim.
fn unknown_name(lesson: &Path, name: &str, all: &[Scaffold]) -> Failure {
    let names = || all.iter().map(|one| one.address.as_str());
    let near = match nearest(name, names()) {
        Some(near) => format!("did you mean `{}`?", printable(near)),
        None => format!("those without a claim are {}", printable(&names().collect::<Vec<_>>().join(", "))),
    };
    format!("{} has no question or lab `{}` without a claim; {near}", printable_path(lesson), printable(name))
}

/// Whether a proposal is true.
fn is_confirmed(verdict: &Option<(Verdict, String)>) -> bool {
    verdict.as_ref().is_none_or(|(v, _)| matches!(v, Verdict::Verified | Verdict::Computed))
}

/// The result of each question and lab, and their counts.
fn human(a: &ScaffoldArguments, lesson: &Lesson, all: &[Scaffold]) -> String {
    let mut text = String::new();
    let mut counts = [0usize; 4];
    for one in all {
        let position = lesson.file.position(one.span.start);
        let _ = writeln!(text, "{}:{} {}", position.line, position.column, printable(&one.name));
        let kind = match &one.found {
            ScaffoldOutcome::Proposed { .. } => 0,
            ScaffoldOutcome::Contradicted { .. } => 1,
            ScaffoldOutcome::Skeleton { .. } => 2,
            ScaffoldOutcome::Open(_) => 3,
        };
        counts[kind] += 1;
        text += &outcome_lines(a, one);
    }
    let [proposed, against, skeletons, open] = counts;
    let against =
        if against > 0 { format!("{against} where the runs contradict the key, ") } else { String::new() };
    let _ = writeln!(
        text,
        "\n{}: {proposed} proposed, {against}{skeletons} not decided, {open} left open",
        printable_path(&a.lesson)
    );
    text
}

/// The lines below the name of a question or a lab. A proposal that `--write` inserts is not printed.
fn outcome_lines(a: &ScaffoldArguments, one: &Scaffold) -> String {
    let is_named = a.write.as_ref().is_some_and(|names| names.contains(&one.address));
    let is_all = a.write.as_ref().is_some_and(Vec::is_empty);
    match &one.found {
        ScaffoldOutcome::Proposed { verify, values, undecided, verdict } => {
            let mut text = value_lines("  ", values);
            if let Some((verdict, reason)) = verdict {
                let how = match verdict {
                    Verdict::Verified => "in these runs, the key holds",
                    _ => "the formula gives the key",
                };
                let reason =
                    if reason.is_empty() { String::new() } else { format!(": {}", printable(reason)) };
                let _ = writeln!(text, "  {how}{reason}");
            }
            for option in undecided {
                let _ = writeln!(
                    text,
                    "  option {option} is left open: its words state nothing that was measured"
                );
            }
            if !is_named && !is_all {
                let _ = writeln!(text, "\n\"verify\": {}\n", printable_lines(&format_verify(verify)));
            }
            text
        }
        ScaffoldOutcome::Contradicted { option, values } => format!(
            "  the runs support option {}, which is not the key; nothing is proposed\n{}",
            option + 1,
            value_lines("    ", values)
        ),
        ScaffoldOutcome::Skeleton { why, verify } => {
            let mut text = format!("  not decided: {}\n", printable(why));
            if !is_named {
                let _ = writeln!(
                    text,
                    "  a skeleton, which `--write {}` inserts:\n\n\"verify\": {}\n",
                    printable(&one.address),
                    printable_lines(&format_verify(verify))
                );
            }
            text
        }
        ScaffoldOutcome::Open(why) => format!("  left open: {}\n", printable(why)),
    }
}

/// A line for each value.
fn value_lines(indent: &str, values: &[(String, f64)]) -> String {
    values.iter().map(|(name, x)| format!("{indent}{} = {}\n", printable(name), significant(*x))).collect()
}

/// A first verify object for every question and lab of a lesson that has none.
#[derive(Serialize, JsonSchema)]
pub(super) struct ScaffoldReport<'a> {
    /// The result for each: labs, then questions.
    found: Vec<ScaffoldRow<'a>>,
}

/// A question or a lab.
#[derive(Default, Serialize, JsonSchema)]
struct ScaffoldRow<'a> {
    /// Which one, as reports name it.
    name: &'a str,
    /// The first byte of its object in the file.
    start: usize,
    /// The byte behind the last one.
    end: usize,
    /// Its line, from 1.
    #[schemars(range(min = 1))]
    line: usize,
    /// Its column in characters, from 1.
    #[schemars(range(min = 1))]
    column: usize,
    /// An object is proposed; the runs support another option than the key; there is only a skeleton; or there is nothing.
    outcome: OutcomeWord,
    /// The object, as the lesson format has it.
    #[schemars(with = "Option<Map<String, Value>>")]
    verify: Option<&'a ProposedVerify>,
    /// What was measured.
    values: Vec<ValueRow<'a>>,
    /// Options, counted from 1, that the runs do not decide.
    #[schemars(inner(range(min = 1)))]
    undecided: &'a [usize],
    /// What gives the key in a trial of the object: the runs, or a formula. Null for labs and without a proposal.
    tried: Option<TrialWord>,
    /// A remark on the proposal, or why there is none.
    reason: Option<&'a str>,
    /// The option, counted from 1, that the runs support, if it is not the key.
    #[schemars(range(min = 1))]
    option: Option<usize>,
}

#[derive(Default, Serialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
enum OutcomeWord {
    Proposed,
    Contradicted,
    Skeleton,
    #[default]
    Open,
}

#[derive(Serialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
enum TrialWord {
    Runs,
    Formula,
}

/// A measure.
#[derive(Serialize, JsonSchema)]
struct ValueRow<'a> {
    /// Its name in the object, or the measure and its run.
    name: &'a str,
    /// Its value; null where there is none.
    #[schemars(with = "Option<f64>")]
    value: f64,
}

fn machine<'a>(lesson: &Lesson, all: &'a [Scaffold]) -> ScaffoldReport<'a> {
    ScaffoldReport { found: all.iter().map(|one| row(lesson, one)).collect() }
}

fn row<'a>(lesson: &Lesson, one: &'a Scaffold) -> ScaffoldRow<'a> {
    let measured = |values: &'a [(String, f64)]| {
        values.iter().map(|(name, value)| ValueRow { name, value: *value }).collect()
    };
    let (position, span) = (lesson.file.position(one.span.start), &one.span);
    let (line, column) = (position.line, position.column);
    let row =
        ScaffoldRow { name: &one.name, start: span.start, end: span.end, line, column, ..Default::default() };
    match &one.found {
        ScaffoldOutcome::Proposed { verify, values, undecided, verdict } => ScaffoldRow {
            outcome: OutcomeWord::Proposed,
            verify: Some(verify),
            values: measured(values),
            undecided,
            tried: verdict.as_ref().map(|(v, _)| match v {
                Verdict::Verified => TrialWord::Runs,
                _ => TrialWord::Formula,
            }),
            reason: verdict.as_ref().map(|(_, reason)| reason.as_str()),
            ..row
        },
        ScaffoldOutcome::Contradicted { option, values } => {
            let outcome = OutcomeWord::Contradicted;
            ScaffoldRow { outcome, values: measured(values), option: Some(option + 1), ..row }
        }
        ScaffoldOutcome::Skeleton { why, verify } => {
            let outcome = OutcomeWord::Skeleton;
            ScaffoldRow { outcome, verify: Some(verify), reason: Some(why), ..row }
        }
        ScaffoldOutcome::Open(why) => ScaffoldRow { outcome: OutcomeWord::Open, reason: Some(why), ..row },
    }
}
