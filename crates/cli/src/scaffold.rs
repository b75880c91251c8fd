//! `labspec scaffold`.

use super::common::{CommandOutcome, Failure, ModelOptions, interrupted};
use super::output::write_file;
use super::output_kind::OutputKind;
use super::report_json::print_report;
use super::stdio::{Progress, print};
use super::target::model_folder;
use clap::ValueEnum;
use labspec::bind::scene::Models;
use labspec::lint::{load_lesson_file, reload_lesson};
use labspec::report::{printable, printable_lines, printable_path};
use labspec::spec::Lesson;
use labspec::verify::{Verdict, significant};
use labspec_proposals::scaffold::{Scaffold, ScaffoldOutcome, scaffold as look, written};
use labspec_proposals::trace::{ProposedVerify, format_verify};
use serde::Serialize;
use std::fmt::Write;
use std::path::PathBuf;

/// Arguments of `scaffold`.
#[derive(clap::Args, Debug)]
pub(super) struct ScaffoldArguments {
    /// A lesson, or a JSON file of labs or quizzes
    lesson: PathBuf,
    #[command(flatten)]
    models: ModelOptions,
    /// Insert the objects into the lesson; everything else stays unchanged
    #[arg(long)]
    write: bool,
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
    let lesson = load_lesson_file(&a.lesson, &folder)?;
    let models = Models::new(folder.clone());
    let progress = Progress::new(a.format == ScaffoldFormat::Human);
    let all = look(&lesson, &models, &mut |text| progress.report(text));
    drop(progress);
    if interrupted() {
        return Ok(CommandOutcome::Clean);
    }
    let proposals = all.iter().filter(|one| matches!(one.found, ScaffoldOutcome::Proposed { .. })).count();
    if a.write && proposals > 0 {
        let text = written(&lesson, &all);
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

/// Whether a proposal is true.
fn is_confirmed(verdict: &Option<(Verdict, String)>) -> bool {
    verdict.as_ref().is_none_or(|(v, _)| matches!(v, Verdict::Verified | Verdict::Computed))
}

fn human(a: &ScaffoldArguments, lesson: &Lesson, all: &[Scaffold]) -> String {
    let mut text = String::new();
    let mut counts = [0usize; 3];
    for one in all {
        let at = lesson.file.position(one.span.start);
        let _ = writeln!(text, "{}:{} {}", at.line, at.column, printable(&one.name));
        match &one.found {
            ScaffoldOutcome::Proposed { verify, values, undecided, verdict } => {
                counts[0] += 1;
                for (name, x) in values {
                    let _ = writeln!(text, "  {} = {}", printable(name), significant(*x));
                }
                if let Some((verdict, reason)) = verdict {
                    let reason =
                        if reason.is_empty() { String::new() } else { format!(": {}", printable(reason)) };
                    let _ = writeln!(text, "  as it stands here: {}{reason}", verdict.as_str());
                }
                for option in undecided {
                    let _ = writeln!(
                        text,
                        "  option {option} is left open: its words state nothing that was measured"
                    );
                }
                if !a.write {
                    let _ = writeln!(text, "\n\"verify\": {}\n", printable_lines(&format_verify(verify)));
                }
            }
            ScaffoldOutcome::Contradicted { option, values } => {
                counts[1] += 1;
                let _ = writeln!(
                    text,
                    "  the runs support option {}, which is not the key; nothing is proposed",
                    option + 1
                );
                for (name, x) in values {
                    let _ = writeln!(text, "    {} = {}", printable(name), significant(*x));
                }
            }
            ScaffoldOutcome::Open(why) => {
                counts[2] += 1;
                let _ = writeln!(text, "  left open: {}", printable(why));
            }
        }
    }
    let [proposed, against, open] = counts;
    let done = if a.write { "written" } else { "proposed" };
    let against =
        if against > 0 { format!("{against} where the runs contradict the key, ") } else { String::new() };
    let _ = writeln!(text, "\n{}: {proposed} {done}, {against}{open} left open", printable_path(&a.lesson));
    text
}

/// The proposals for programs.
#[derive(Serialize)]
struct ScaffoldReport<'a> {
    found: Vec<ScaffoldRow<'a>>,
}

/// A question or a lab, its location in bytes and in lines from 1, and the result.
#[derive(Default, Serialize)]
struct ScaffoldRow<'a> {
    name: &'a str,
    start: usize,
    end: usize,
    line: usize,
    column: usize,
    outcome: &'static str,
    verify: Option<&'a ProposedVerify>,
    values: Vec<ValueRow<'a>>,
    undecided: &'a [usize],
    verdict: Option<&'static str>,
    reason: Option<&'a str>,
    option: Option<usize>,
}

/// A measure in its unit.
#[derive(Serialize)]
struct ValueRow<'a> {
    name: &'a str,
    value: f64,
}

fn machine<'a>(lesson: &Lesson, all: &'a [Scaffold]) -> ScaffoldReport<'a> {
    ScaffoldReport { found: all.iter().map(|one| row(lesson, one)).collect() }
}

fn row<'a>(lesson: &Lesson, one: &'a Scaffold) -> ScaffoldRow<'a> {
    let measured = |values: &'a [(String, f64)]| {
        values.iter().map(|(name, value)| ValueRow { name, value: *value }).collect()
    };
    let (at, span) = (lesson.file.position(one.span.start), &one.span);
    let (line, column) = (at.line, at.column);
    let row =
        ScaffoldRow { name: &one.name, start: span.start, end: span.end, line, column, ..Default::default() };
    match &one.found {
        ScaffoldOutcome::Proposed { verify, values, undecided, verdict } => ScaffoldRow {
            outcome: "proposed",
            verify: Some(verify),
            values: measured(values),
            undecided,
            verdict: verdict.as_ref().map(|(v, _)| v.as_str()),
            reason: verdict.as_ref().map(|(_, reason)| reason.as_str()),
            ..row
        },
        ScaffoldOutcome::Contradicted { option, values } => {
            ScaffoldRow { outcome: "contradicted", values: measured(values), option: Some(option + 1), ..row }
        }
        ScaffoldOutcome::Open(why) => ScaffoldRow { outcome: "open", reason: Some(why), ..row },
    }
}
