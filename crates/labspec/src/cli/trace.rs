//! `labspec trace`.

use super::common::{Failure, ModelOptions, Outcome, interrupted};
use super::stdio::print;
use super::stdio::{Progress, print_json};
use super::target::model_folder;
use crate::bind::scene::Models;
use crate::lint::load_lesson_file;
use crate::report::{printable, printable_lines, printable_path, report};
use crate::spec::Lesson;
use crate::trace::{Hit, Origin, Traced, Traces, blocks, laid_out, trace as look};
use crate::verify::significant;
use clap::ValueEnum;
use serde_json::{Value, json};
use std::fmt::Write;
use std::path::PathBuf;

/// Arguments of `trace`.
#[derive(clap::Args, Debug)]
pub(super) struct Arguments {
    /// A lesson, or a JSON file of labs or quizzes
    lesson: PathBuf,
    #[command(flatten)]
    models: ModelOptions,
    /// Output format
    #[arg(long, value_enum, default_value = "human")]
    format: Format,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Format {
    Human,
    Json,
}

pub(super) fn trace(a: &Arguments) -> Result<Outcome, Failure> {
    let folder = model_folder(&a.models, &a.lesson)?;
    let lesson = load_lesson_file(&a.lesson, &folder)?;
    let models = Models::new(folder);
    let progress = Progress::new(a.format == Format::Human);
    let found = look(&lesson, &models, &mut |text| progress.tell(text));
    drop(progress);
    if interrupted() {
        return Ok(Outcome::Clean);
    }
    match a.format {
        Format::Human => print(&human(a, &lesson, &found))?,
        Format::Json => print_json(&value(&lesson, &found), true)?,
    }
    let traced = |n: &Traced| matches!(n.origin, Origin::Claimed | Origin::From(_) | Origin::Setting(_));
    Ok(if found.numbers.iter().all(traced) { Outcome::Clean } else { Outcome::Findings })
}

/// Where a hit comes from, in words.
fn place(found: &Traces<'_>, hit: &Hit) -> String {
    match hit.place.and_then(|(lab, trial)| found.run(lab, trial)) {
        Some((address, words)) => format!("lab {address} {words}"),
        None => "worked out".to_string(),
    }
}

fn human(a: &Arguments, lesson: &Lesson, found: &Traces<'_>) -> String {
    let mut text = String::new();
    let mut counts = [0usize; 6];
    for n in &found.numbers {
        let at = lesson.file.position(n.stated.span.start);
        let quote = printable(&n.stated.quote);
        let _ = write!(text, "{:>4}:{:<4} {quote:<14}", at.line, at.column);
        let kind = match &n.origin {
            Origin::From(hit) => {
                let value = significant(hit.value);
                let chance =
                    if hit.chance > 0.0 { format!(", chance {}", share(hit.chance)) } else { String::new() };
                let _ = writeln!(
                    text,
                    " = {} = {value}  ({}{chance})",
                    printable(&hit.description()),
                    printable(&place(found, hit))
                );
                0
            }
            Origin::Unsteady(hit) => {
                let _ = writeln!(
                    text,
                    " is not reproducible: {} = {}  ({}), and other digits if the start moves by 1e-14",
                    printable(&hit.description()),
                    significant(hit.value),
                    printable(&place(found, hit))
                );
                4
            }
            Origin::Setting(words) => {
                let _ = writeln!(text, " is set: {}", printable(words));
                1
            }
            Origin::Chance(hit) => {
                let _ = writeln!(
                    text,
                    " may be chance ({}): {}",
                    share(hit.chance),
                    printable(&hit.description())
                );
                2
            }
            Origin::Claimed => {
                text.push_str(" is claimed\n");
                5
            }
            Origin::Unknown => {
                text.push_str(" not traced\n");
                3
            }
        };
        counts[kind] += 1;
    }
    for (address, block) in blocks(found) {
        let has = lesson.lab(&address).is_some_and(|lab| lab.verify.is_some());
        let accept = if has { "to add to its `verify`" } else { "to accept" };
        let _ = write!(
            text,
            "\nfor lab {address}, {accept}:\n\n\"verify\": {}\n",
            printable_lines(&laid_out(&block))
        );
    }
    let [from, set, chance, none, unsteady, claimed] = counts;
    let unsteady = if unsteady > 0 { format!("{unsteady} not reproducible, ") } else { String::new() };
    let _ = writeln!(
        text,
        "\n{}: {} numbers with units; {claimed} claimed, {from} traced, {set} set by the text, {chance} perhaps by chance, {unsteady}{none} not traced",
        printable_path(&a.lesson),
        found.numbers.len()
    );
    text
}

fn share(x: f64) -> String {
    if x < 0.001 { "below 0.1 %".to_string() } else { format!("{:.1} %", 100.0 * x) }
}

fn value(lesson: &Lesson, found: &Traces<'_>) -> Value {
    let one = |n: &Traced| {
        let at = lesson.file.position(n.stated.span.start);
        let (word, hit, by) = match &n.origin {
            Origin::From(hit) => ("traced", Some(hit), None),
            Origin::Chance(hit) => ("chance", Some(hit), None),
            Origin::Unsteady(hit) => ("unsteady", Some(hit), None),
            Origin::Setting(words) => ("set", None, Some(words)),
            Origin::Claimed => ("claimed", None, None),
            Origin::Unknown => ("unknown", None, None),
        };
        json!({
            "text": n.stated.quote, "start": n.stated.span.start, "end": n.stated.span.end,
            "line": at.line, "column": at.column, "unit": n.stated.unit, "origin": word,
            "from": hit.map(|hit| place(found, hit)), "measure": hit.map(|hit| &hit.measure),
            "factor": hit.map(|hit| &hit.factor), "value": hit.map(|hit| hit.value), "chance": hit.map(|hit| hit.chance),
            "by": by,
        })
    };
    let numbers: Vec<Value> = found.numbers.iter().map(one).collect();
    let blocks: Vec<Value> = blocks(found)
        .into_iter()
        .map(|(address, verify)| json!({"lab": address.to_string(), "verify": verify}))
        .collect();
    report("trace", json!({"numbers": numbers, "proposals": blocks}))
}
