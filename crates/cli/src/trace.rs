//! `labspec trace`.

use super::common::{CommandOutcome, Failure, ModelOptions, interrupted};
use super::policy::conventions_of;
use super::report_json::print_report;
use super::stdio::{Progress, print};
use super::target::model_folder;
use clap::ValueEnum;
use labspec::bind::scene::Models;
use labspec::lint::load_lesson_file;
use labspec::report::{printable, printable_lines, printable_path};
use labspec::spec::Lesson;
use labspec::verify::significant;
use labspec_proposals::trace::{
    self, MeasureMatch, Origin, ProposedVerify, Traced, Traces, blocks, format_verify,
};
use schemars::JsonSchema;
use serde::Serialize;
use serde_json::{Map, Value};
use std::fmt::Write;
use std::path::PathBuf;

/// Arguments of `trace`.
#[derive(clap::Args, Debug)]
pub(super) struct TraceArguments {
    /// A lesson, or a JSON file of labs or quizzes
    lesson: PathBuf,
    #[command(flatten)]
    models: ModelOptions,
    /// Output format
    #[arg(long, value_enum, default_value = "human")]
    format: TraceFormat,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum TraceFormat {
    Human,
    Json,
}

pub(super) fn trace(a: &TraceArguments) -> Result<CommandOutcome, Failure> {
    let folder = model_folder(&a.models, &a.lesson)?;
    let mut lesson = load_lesson_file(&a.lesson, &folder)?;
    lesson.conventions = conventions_of(&a.lesson)?;
    let models = Models::new(folder);
    let progress = Progress::new(a.format == TraceFormat::Human);
    let found = trace::trace(&lesson, &models, &mut |text| progress.report(text));
    drop(progress);
    if interrupted() {
        return Ok(CommandOutcome::Clean);
    }
    match a.format {
        TraceFormat::Human => print(&human(a, &lesson, &found))?,
        TraceFormat::Json => print_report("trace", &machine(&lesson, &found))?,
    }
    let traced = |n: &Traced| {
        matches!(n.origin, Origin::Claimed | Origin::From(_) | Origin::Setting(_) | Origin::Listed(_))
    };
    Ok(match found.numbers.iter().all(traced) {
        false => CommandOutcome::Findings,
        true if !found.without_values.is_empty() => CommandOutcome::Partial,
        true => CommandOutcome::Clean,
    })
}

/// The origin of a hit in words.
fn place(found: &Traces<'_>, hit: &MeasureMatch) -> String {
    match hit.place.and_then(|(lab, trial)| found.run(lab, trial)) {
        Some((address, words)) => format!("lab {address} {words}"),
        None => "worked out".to_string(),
    }
}

fn human(a: &TraceArguments, lesson: &Lesson, found: &Traces<'_>) -> String {
    let mut text = String::new();
    for n in &found.numbers {
        let position = lesson.file.position(n.stated.span.start);
        let quote = printable(&n.stated.quote);
        let _ = writeln!(
            text,
            "{:>4}:{:<4} {quote:<14}{}",
            position.line,
            position.column,
            describe_origin(&n.origin, found)
        );
    }
    for (address, block) in blocks(found) {
        let has = lesson.lab(&address).is_some_and(|lab| lab.verify.is_some());
        let accept = if has { "to add to its `verify`" } else { "to accept" };
        let _ = write!(
            text,
            "\nfor lab {address}, {accept}:\n\n\"verify\": {}\n",
            printable_lines(&format_verify(&block))
        );
    }
    for address in &found.without_values {
        let _ = writeln!(
            text,
            "\nno measure of lab {address} has a value, so no number could be traced to it; `labspec check` says why"
        );
    }
    let _ = writeln!(text, "\n{}: {}", printable_path(&a.lesson), summarize(&found.numbers));
    text
}

/// The origin of a number in words.
pub(super) fn describe_origin(origin: &Origin, found: &Traces<'_>) -> String {
    match origin {
        Origin::From(hit) => {
            let value = significant(hit.value);
            let chance =
                if hit.chance > 0.0 { format!(", chance {}", share(hit.chance)) } else { String::new() };
            let description = hit.description();
            let fragile = if hit.fragile { ", other digits at half the timestep" } else { "" };
            let place = place(found, hit);
            format!(" = {} = {value}  ({}{chance}{fragile})", printable(&description), printable(&place))
        }
        Origin::Unsteady(hit) => format!(
            " is not reproducible: {} = {}  ({}), and other digits if the start moves by 1e-14",
            printable(&hit.description()),
            significant(hit.value),
            printable(&place(found, hit))
        ),
        Origin::Setting(words) => format!(" is set: {}", printable(words)),
        Origin::Chance(hit) => {
            format!(" may be chance ({}): {}", share(hit.chance), printable(&hit.description()))
        }
        Origin::Listed(line) => format!(" is printed by a listing, in line {line}"),
        Origin::Claimed => " is claimed".to_string(),
        Origin::Unknown => " not traced".to_string(),
    }
}

/// The number of origins of each kind.
fn summarize(numbers: &[Traced]) -> String {
    let count = |is: fn(&Origin) -> bool| numbers.iter().filter(|n| is(&n.origin)).count();
    let claimed = count(|o| matches!(o, Origin::Claimed));
    let from = count(|o| matches!(o, Origin::From(_)));
    let set = count(|o| matches!(o, Origin::Setting(_)));
    let listed = match count(|o| matches!(o, Origin::Listed(_))) {
        0 => String::new(),
        n => format!("{n} printed by listings, "),
    };
    let chance = count(|o| matches!(o, Origin::Chance(_)));
    let unknown = count(|o| matches!(o, Origin::Unknown));
    let unsteady = match count(|o| matches!(o, Origin::Unsteady(_))) {
        0 => String::new(),
        n => format!("{n} not reproducible, "),
    };
    format!(
        "{} numbers with units; {claimed} claimed, {from} traced, {set} set by the text, {listed}{chance} perhaps by chance, {unsteady}{unknown} not traced",
        numbers.len()
    )
}

fn share(x: f64) -> String {
    if x < 0.001 { "below 0.1 %".to_string() } else { format!("{:.1} %", 100.0 * x) }
}

/// Where the numbers of a lesson come from: for each number with a unit the simplest measure of a run that has its digits, and what
/// an author can take over.
#[derive(Serialize, JsonSchema)]
#[serde(rename_all = "camelCase")]
pub(super) struct TraceReport<'a> {
    /// Every number with a unit that a reader sees, and the answers of numeric questions, in the order of the text.
    numbers: Vec<NumberRow<'a>>,
    /// A verify object for each lab that numbers come from.
    proposals: Vec<ProposalRow>,
    /// The addresses of the labs without a value in any run, for example because they cannot run: no number can be traced to them.
    without_values: Vec<String>,
}

/// A number.
#[derive(Serialize, JsonSchema)]
struct NumberRow<'a> {
    /// Number and unit as a quote has them.
    text: &'a str,
    /// The first byte in the file.
    start: usize,
    /// The byte behind the last one.
    end: usize,
    /// Its line, from 1.
    #[schemars(range(min = 1))]
    line: usize,
    /// Its column in characters, from 1.
    #[schemars(range(min = 1))]
    column: usize,
    /// Its unit, possibly that of its column.
    unit: &'a str,
    /// Claimed by the lesson already; traced to a run or a formula; with digits that a start moved by 1e-14 changes; set by the text;
    /// printed by a listing; perhaps by chance; or unknown.
    origin: OriginWord,
    /// The lab and the run, or that it was worked out; null where nothing was found.
    from: Option<String>,
    /// The measure, or the formula.
    measure: Option<&'a str>,
    /// What makes its value the number of the text.
    factor: Option<&'a str>,
    /// The value in the unit of the text.
    value: Option<f64>,
    /// How likely something as simple has these digits by chance, of one.
    #[schemars(range(min = 0, max = 1))]
    chance: Option<f64>,
    /// What the text sets to this number, where it does.
    by: Option<&'a str>,
}

#[derive(Serialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
enum OriginWord {
    Claimed,
    Traced,
    Unsteady,
    Set,
    Listed,
    Chance,
    Unknown,
}

/// A proposed object for a lab.
#[derive(Serialize, JsonSchema)]
struct ProposalRow {
    /// The address of the lab in the lesson.
    lab: String,
    /// The object, as the lesson format has it.
    #[schemars(with = "Map<String, Value>")]
    verify: ProposedVerify,
}

fn machine<'a>(lesson: &Lesson, found: &'a Traces<'_>) -> TraceReport<'a> {
    let numbers = found.numbers.iter().map(|n| {
        let position = lesson.file.position(n.stated.span.start);
        let (origin, hit, by) = match &n.origin {
            Origin::From(hit) => (OriginWord::Traced, Some(hit), None),
            Origin::Chance(hit) => (OriginWord::Chance, Some(hit), None),
            Origin::Unsteady(hit) => (OriginWord::Unsteady, Some(hit), None),
            Origin::Setting(words) => (OriginWord::Set, None, Some(words.as_str())),
            Origin::Listed(_) => (OriginWord::Listed, None, None),
            Origin::Claimed => (OriginWord::Claimed, None, None),
            Origin::Unknown => (OriginWord::Unknown, None, None),
        };
        NumberRow {
            text: &n.stated.quote,
            start: n.stated.span.start,
            end: n.stated.span.end,
            line: position.line,
            column: position.column,
            unit: &n.stated.unit,
            origin,
            from: hit.map(|hit| place(found, hit)),
            measure: hit.map(|hit| hit.measure.as_str()),
            factor: hit.map(|hit| hit.factor.as_str()),
            value: hit.map(|hit| hit.value),
            chance: hit.map(|hit| hit.chance),
            by,
        }
    });
    let proposals =
        blocks(found).into_iter().map(|(address, verify)| ProposalRow { lab: address.to_string(), verify });
    let without_values = found.without_values.iter().map(ToString::to_string).collect();
    TraceReport { numbers: numbers.collect(), proposals: proposals.collect(), without_values }
}
