//! `labspec stability`.

mod machine;

use super::common::{CommandOutcome, Failure, interrupted};
use super::lab_args::LabArguments;
use super::output::write_file;
use super::output::{requested_outputs, write_png};
use super::output_kind::OutputKind;
use super::report_json::print_report;
use super::stdio::{Progress, print};
use clap::ValueEnum;
use labspec::bind::Programs;
use labspec::report::{counted, printable};
use labspec::run::two_digits;
use labspec::spec::Lab;
use labspec::stress::{FaultGroup, FaultKind};
use labspec_numerics::stability::{
    MapCell, Margin, Sensitivity, StabilityFinding, StabilityMap, StressOptions, StressReport, probe,
};
use labspec_plot::{Cells, cells};
pub(super) use machine::{StabilityReport, machine};
use std::fmt::Write;
use std::path::PathBuf;

/// Arguments of `stability`.
#[derive(clap::Args, Debug)]
pub(super) struct StabilityArguments {
    #[command(flatten)]
    handled: LabArguments,
    /// Length of each run in seconds [default: ten times the lab's stopAt or the window of its plots]
    #[arg(long, value_name = "S")]
    until: Option<f64>,
    /// Find the largest timestep, gains, stiffnesses and mass ratios that work in the lab
    #[arg(long)]
    margins: bool,
    /// Run the lab over a grid of two controls
    #[arg(long, value_name = "CONTROL1,CONTROL2")]
    map: Option<String>,
    /// Draw the map
    #[arg(long, value_name = "FILE", requires = "map")]
    svg: Option<PathBuf>,
    /// Draw the map as PNG
    #[arg(long, value_name = "FILE", requires = "map")]
    png: Option<PathBuf>,
    /// Output format
    #[arg(long, value_enum, default_value = "human")]
    format: StabilityFormat,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum StabilityFormat {
    Human,
    Json,
}

pub(super) fn stability(a: &StabilityArguments) -> Result<CommandOutcome, Failure> {
    let target = a.handled.open()?;
    a.handled.check_outputs_writable(
        &target,
        &requested_outputs(&[(OutputKind::Plot, &a.svg), (OutputKind::Picture, &a.png)]),
    )?;
    let map = a.map.as_ref().map(|text| two_labels(&target.lab, text)).transpose()?;
    let (set, press) = (a.handled.set(&target.lab)?, a.handled.press(&target.lab)?);
    let options = StressOptions { until: a.until, margins: a.margins, map, set, press };
    let progress = Progress::new(a.format == StabilityFormat::Human);
    let mut report_progress = |text: &str| progress.report(text);
    let report = probe(&target.lab, &target.model, &target.programs, &options, &mut report_progress)
        .map_err(|e| e.to_string())?;
    drop(progress);
    if let (Some(file), Some(map)) = (&a.png, &report.map) {
        write_png(file, &chart(map, target.lab.title()))?;
    }
    if let (Some(file), Some(map)) = (&a.svg, &report.map) {
        write_file(file, OutputKind::Plot, &chart(map, target.lab.title()))?;
    }
    match a.format {
        StabilityFormat::Human => print(&human(&report, &target.programs))?,
        StabilityFormat::Json => print_report("stability", &machine(&report, &target.programs))?,
    }
    Ok(if report.fine() { CommandOutcome::Clean } else { CommandOutcome::Findings })
}

/// Parses `CONTROL1,CONTROL2`. Labels may contain commas: the text is split after the label of a control,
/// otherwise at the last comma.
fn two_labels(lab: &Lab, text: &str) -> Result<[String; 2], Failure> {
    let splits = || text.match_indices(',').map(|(i, _)| [text[..i].trim(), text[i + 1..].trim()]);
    let at_labels = splits().find(|two| two.iter().all(|label| lab.control(label).is_some()));
    let two = at_labels.or_else(|| splits().next_back());
    two.map(|two| two.map(String::from)).ok_or_else(|| format!("--map {text}: write CONTROL1,CONTROL2"))
}

fn human(report: &StressReport, programs: &Programs) -> String {
    let mut text = String::new();
    let runs: usize = report.tried.iter().map(|t| t.made + t.cut).sum();
    let kinds: Vec<String> =
        report.tried.iter().map(|t| format!("{} {}", t.made + t.cut, t.kind.description())).collect();
    let _ = writeln!(
        text,
        "{} of {} s: {}.",
        counted(runs, "run"),
        labspec::verify::significant(report.length),
        kinds.join(", ")
    );
    for found in &report.found {
        finding(found, programs, &mut text);
    }
    for line in describe_skipped(report) {
        let _ = writeln!(text, "Not tested: {line}.");
    }
    if report.found.is_empty() {
        text.push_str("Nothing went wrong.\n");
    }
    margins(report, &mut text);
    sensitivity(&report.sensitivity, &mut text);
    if let Some(map) = &report.map {
        letters(map, &mut text);
    }
    if interrupted() {
        text.push_str("stopped by Ctrl-C: the runs above are the finished ones\n");
    }
    text
}

fn finding(found: &StabilityFinding, programs: &Programs, text: &mut String) {
    let StabilityFinding { group, expected, remedies } = found;
    let FaultGroup { fault, interaction, settings, worst } = group;
    let expected = if *expected { " (as the lab expects)" } else { "" };
    let _ = writeln!(
        text,
        "\n{}{expected}: {}, at t = {} s, {}",
        fault.kind.description(),
        printable(&fault.subject),
        labspec::run::time(fault.time),
        printable(&interaction.describe(programs))
    );
    let _ = writeln!(text, "  {}", fault.measured());
    let _ = writeln!(text, "  cause: {}", printable(&fault.cause));
    if *settings > 1 {
        let _ = write!(text, "  also in {} other settings", settings - 1);
        let _ = match worst {
            Some((interaction, fault)) => {
                writeln!(text, "; worst {}: {}", printable(&interaction.describe(programs)), fault.measured())
            }
            None => writeln!(text),
        };
    }
    for remedy in remedies {
        let cost = match remedy.work {
            x if (0.95..=1.05).contains(&x) => "the same work".to_string(),
            x => format!("{} times the work", two_digits(x)),
        };
        let error = match remedy.error {
            Some(x) if x < 1e-4 => ", no visible error".to_string(),
            Some(x) => format!(", off by at most {} % of a range", two_digits(100.0 * x)),
            None => String::new(),
        };
        let time = two_digits(remedy.time);
        let _ =
            writeln!(text, "  helps: {} ({cost}, {time} times the time{error})", printable(&remedy.change));
    }
}

/// Writes how far each parameter can be raised.
fn margins(report: &StressReport, text: &mut String) {
    let list = &report.margins;
    if list.is_empty() {
        return;
    }
    let rows: Vec<[String; 6]> =
        std::iter::once(["", "now", "largest", "times", "theory", "beyond"].map(String::from))
            .chain(list.iter().map(margin))
            .collect();
    let widths: Vec<usize> =
        (0..6).map(|k| rows.iter().map(|r| r[k].chars().count()).max().unwrap_or(0)).collect();
    let length = labspec::verify::significant(report.window);
    let _ = writeln!(
        text,
        "\nThe largest values at which nothing but creep goes wrong within {length} s, for the lab as it stands and after a small perturbation:"
    );
    for row in &rows {
        let cells = row.iter().zip(&widths).enumerate().map(|(k, (cell, w))| match k {
            0 => format!("{cell:<w$}"),
            5 => cell.clone(),
            _ => format!("{cell:>w$}"),
        });
        let _ = writeln!(text, "  {}", cells.collect::<Vec<_>>().join("  ").trim_end());
    }
}

fn margin(m: &Margin) -> [String; 6] {
    let unit = if m.unit.is_empty() { String::new() } else { format!(" {}", m.unit) };
    let value = |x: f64| format!("{}{unit}", labspec::run::rounded(x, 3));
    let largest = match (m.largest, m.breaks) {
        (Some(x), Some(_)) => value(x),
        (Some(x), None) => format!("> {}", value(x)),
        (None, _) => "none".into(),
    };
    let subject = if m.parameter.description() == "timestep" {
        String::new()
    } else {
        format!(" of {}", printable(&m.subject))
    };
    let how = m
        .how
        .as_ref()
        .map_or(String::new(), |(kind, subject)| format!("{}: {}", kind.description(), printable(subject)));
    [
        format!("{}{subject}", m.parameter.description()),
        value(m.current),
        largest,
        m.largest.map_or(String::new(), |x| two_digits(x / m.current)),
        m.bound.map_or("–".into(), value),
        how,
    ]
}

/// Writes how strongly the lab depends on its initial state.
fn sensitivity(s: &Sensitivity, text: &mut String) {
    if let Some(p) = &s.divergence {
        let most = 1.0 / s.distance;
        let times = match [p.low, p.high].map(two_digits) {
            _ if p.low >= most => format!("more than {most:e}"),
            [low, _] if p.high >= most => format!("{low} to more than {most:e}"),
            [low, high] if low == high => low,
            [low, high] => format!("{low} to {high}"),
        };
        let _ = writeln!(
            text,
            "\nA small difference at the start is {times} times as large after {} s.",
            labspec::verify::significant(s.length)
        );
    }
    if let Some(e) = &s.exponent {
        let _ = writeln!(
            text,
            "It grows exponentially: tenfold in {} s (largest Lyapunov exponent {} /s, {} to {} in {} directions).",
            two_digits(std::f64::consts::LN_10 / e.mean),
            two_digits(e.mean),
            two_digits(e.low),
            two_digits(e.high),
            e.directions
        );
    }
    for h in &s.horizons {
        if let Some(t) = h.until {
            let _ = writeln!(
                text,
                "For a start that is off by {:e}, \"{}\" shows other digits from {} s on.",
                s.distance,
                printable(&h.label),
                labspec::run::time(t)
            );
        }
    }
}

/// Writes the map in letters: a row for each value of the second control, the largest value first.
fn letters(map: &StabilityMap, text: &mut String) {
    let [x, y] = map.labels.each_ref().map(|l| printable(l).into_owned());
    let _ = writeln!(text, "\n\"{y}\" upwards, \"{x}\" to the right:");
    let width = map.values[1].iter().map(|v| v.to_string().chars().count()).max().unwrap_or(0);
    let kinds = kinds(map);
    for (row, value) in map.cells.iter().zip(&map.values[1]).rev() {
        let letter = |cell: &MapCell| match index(&kinds, *cell) {
            Some(0) => ".".into(),
            Some(k) => k.to_string(),
            None => "?".into(),
        };
        let cells: String = row.iter().map(letter).collect();
        let _ = writeln!(text, "  {:>width$}  {cells}", printable(&value.to_string()));
    }
    if let (Some(first), Some(last)) = (map.values[0].first(), map.values[0].last()) {
        let _ = writeln!(
            text,
            "  {:>width$}  {} … {}",
            "",
            printable(&first.to_string()),
            printable(&last.to_string())
        );
    }
    let legend = kinds.iter().enumerate().map(|(k, kind)| format!("{} {}", k + 1, kind.description()));
    let legend: Vec<String> = std::iter::once(". fine".into()).chain(legend).collect();
    let _ = writeln!(text, "  {}", legend.join(", "));
}

/// The kinds of faults in a map, the worst first.
fn kinds(map: &StabilityMap) -> Vec<FaultKind> {
    let broken = |c: &MapCell| match c {
        MapCell::Broken(kind) => Some(*kind),
        _ => None,
    };
    let mut list: Vec<FaultKind> = map.cells.iter().flatten().filter_map(broken).collect();
    list.sort_unstable();
    list.dedup();
    list
}

/// The index of a cell's kind; index 0 means no fault.
fn index(kinds: &[FaultKind], cell: MapCell) -> Option<usize> {
    match cell {
        MapCell::Fine => Some(0),
        MapCell::Broken(kind) => kinds.iter().position(|k| *k == kind).map(|k| k + 1),
        MapCell::Unknown => None,
    }
}

pub(super) fn chart(map: &StabilityMap, title: &str) -> String {
    let kinds = kinds(map);
    let names = std::iter::once("fine").chain(kinds.iter().map(|k| k.description()));
    let values = |k: usize| map.values[k].iter().map(ToString::to_string).collect();
    cells(&Cells {
        title: title.to_string(),
        xlabel: map.labels[0].clone(),
        ylabel: map.labels[1].clone(),
        columns: values(0),
        rows: values(1),
        kinds: names.map(String::from).collect(),
        cells: map.cells.iter().map(|row| row.iter().map(|c| index(&kinds, *c)).collect()).collect(),
        width: 640.0,
        height: 420.0,
    })
}

/// Everything that was not tried, or not completely.
fn describe_skipped(report: &StressReport) -> Vec<String> {
    let mut list = Vec::new();
    for t in &report.tried {
        if t.skipped > 0 {
            list.push(format!("{} of {}", t.skipped, t.kind.description()));
        }
    }
    let cut: usize = report.tried.iter().map(|t| t.cut).sum();
    if let Some(shortest) = report.shortest {
        list.push(format!(
            "the end of {}, which need more work than allowed; the shortest covers {} s",
            counted(cut, "run"),
            two_digits(shortest)
        ));
    }
    if report.skipped_pairs > 0 {
        list.push(format!("{} pairs of settings, because there are too many", report.skipped_pairs));
    }
    list.extend(report.skipped.iter().cloned());
    list
}
