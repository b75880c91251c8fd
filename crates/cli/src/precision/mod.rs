//! `labspec precision`.

mod chart;
mod machine;
mod table;

use super::common::{CommandOutcome, Failure, interrupted};
use super::lab_args::LabArguments;
use super::output::write_file;
use super::output::{requested_outputs, write_png, write_with};
use super::output_kind::OutputKind;
use super::report_json::print_report;
use super::stdio::{Progress, print, stream};
pub(super) use chart::chart;
use clap::ValueEnum;
use labspec::report::{printable, printable_path};
use labspec::run::{INTEGRATORS, Integrator};
use labspec::source::read_text;
use labspec::verify::significant;
use labspec_numerics::precision::{
    OtherRecording, PrecisionOptions, PrecisionResults, RunStatus, VariedSetting, compare, milliseconds,
};
use machine::csv;
pub(super) use machine::{PrecisionReport, machine};
use std::fmt::Write;
use std::path::{Path, PathBuf};
use table::{setting, table, write_other_runs};

/// Arguments of `precision`.
#[derive(clap::Args, Debug)]
pub(super) struct PrecisionArguments {
    #[command(flatten)]
    handled: LabArguments,
    /// Length in seconds [default: the lab's stopAt, or 2]
    #[arg(long, value_name = "S")]
    until: Option<f64>,
    /// Test only this integrator, or `all`, including those that MuJoCo does not have [default: MuJoCo's five]
    #[arg(long, value_name = "NAME")]
    integrator: Vec<String>,
    /// Vary a setting of the constraint solver as well
    #[arg(long, value_enum, value_name = "SETTING")]
    vary: Vec<Vary>,
    /// Runs of the same lab by another program, for comparison
    #[arg(long, value_name = "FILE")]
    beside: Option<PathBuf>,
    /// Output format
    #[arg(long, value_enum, default_value = "human")]
    format: PrecisionFormat,
    /// Write all errors as comma-separated values
    #[arg(long, value_name = "FILE")]
    csv: Option<PathBuf>,
    /// Write the chart of the first trace
    #[arg(long, value_name = "FILE")]
    svg: Option<PathBuf>,
    /// Write the chart as PNG
    #[arg(long, value_name = "FILE")]
    png: Option<PathBuf>,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum Vary {
    Iterations,
    Tolerance,
    Cone,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum PrecisionFormat {
    Human,
    Json,
    Csv,
}

pub(super) fn precision(a: &PrecisionArguments) -> Result<CommandOutcome, Failure> {
    let target = a.handled.open()?;
    a.handled.check_outputs_writable(
        &target,
        &requested_outputs(&[
            (OutputKind::Settings, &a.csv),
            (OutputKind::Plot, &a.svg),
            (OutputKind::Picture, &a.png),
        ]),
    )?;
    let options = PrecisionOptions {
        until: a.until,
        set: a.handled.set(&target.lab)?,
        press: a.handled.press(&target.lab)?,
        integrators: integrators(&a.integrator)?,
        axes: a.vary.iter().map(|v| v.axis()).collect(),
        beside: a.beside.as_ref().map(|path| recording(path)).transpose()?,
    };
    let mut findings = Vec::new();
    let progress = Progress::new(matches!(a.format, PrecisionFormat::Human));
    let mut report_progress = |text: &str| progress.report(text);
    let report =
        compare(&target.lab, &target.model, &target.programs, &options, &mut findings, &mut report_progress)
            .map_err(|e| e.to_string())?;
    drop(progress);
    if let Some(f) = findings.first() {
        return Err(format!(
            "a closed form has an error: {}; `labspec check` shows where",
            printable(&f.message)
        ));
    }
    if let Some(file) = &a.svg {
        write_file(file, OutputKind::Plot, &chart(&report, target.lab.title()))?;
    }
    if let Some(file) = &a.png {
        write_png(file, &chart(&report, target.lab.title()))?;
    }
    if let Some(file) = &a.csv {
        write_with(file, OutputKind::Settings, |out| csv(&report, out))?;
    }
    match a.format {
        PrecisionFormat::Human => print(&human(&report))?,
        PrecisionFormat::Json => print_report("precision", &machine(&report))?,
        PrecisionFormat::Csv => stream(|out| csv(&report, out))?,
    }
    Ok(if report.reference.is_none() || has_no_result(&report) {
        CommandOutcome::Findings
    } else {
        CommandOutcome::Clean
    })
}

/// Whether the run with the lab's own setting failed, or the truth is not known to its end.
fn has_no_result(report: &PrecisionResults) -> bool {
    report.rows.iter().any(|r| r.is_own && r.status != RunStatus::Good)
        || report.targets.iter().any(|t| t.until.is_some())
}

impl Vary {
    fn axis(self) -> VariedSetting {
        match self {
            Vary::Iterations => VariedSetting::Iterations,
            Vary::Tolerance => VariedSetting::Tolerance,
            Vary::Cone => VariedSetting::Cone,
        }
    }
}

/// The maximum size of a recording in bytes.
const MAX_RECORDING: u64 = 256 << 20;

fn recording(path: &Path) -> Result<OtherRecording, Failure> {
    let named = |e: String| format!("cannot use {}: {e}", printable_path(path));
    let text = read_text(path, MAX_RECORDING, "a recording")?;
    OtherRecording::read(&text).map_err(named)
}

fn integrators(names: &[String]) -> Result<Vec<Integrator>, Failure> {
    if names.iter().any(|n| n == "all") {
        return Ok(INTEGRATORS.to_vec());
    }
    let names_of_all = || INTEGRATORS.map(|i| i.name).join(", ");
    let one = |name: &String| {
        Integrator::named(name).ok_or_else(|| {
            format!("--integrator {name}: unknown name; use one of {}, or all", names_of_all())
        })
    };
    names.iter().map(one).collect()
}

fn human(report: &PrecisionResults) -> String {
    let mut text = String::new();
    match &report.reference {
        None => {
            let why = match report.rows.iter().any(|r| r.status == RunStatus::Good) {
                true => "the methods of high order need more work than a run allows; shorten it with --until",
                false => "no method completes this lab",
            };
            let _ = writeln!(text, "Nothing can be compared: {why}.");
            write_outcomes(report, &mut text);
        }
        Some(how) => {
            let _ = writeln!(
                text,
                "Over {} s, {}. Without a closed form, the reference is {how}.",
                significant(report.length),
                compared_at(report)
            );
            table(report, &mut text);
        }
    }
    if let Some(beside) = &report.beside {
        write_other_runs(report, beside, &mut text);
    }
    for out in &report.omitted {
        let _ = writeln!(text, "Not compared: {}, because {}.", printable(&out.label), out.reason);
    }
    if let Some(nearby) = &report.nearby {
        let _ = match nearby.until {
            Some(t) => writeln!(
                text,
                "Two starts that are {:e} apart agree until {} s: no method can predict what comes later.",
                nearby.distance,
                significant(t)
            ),
            None => writeln!(
                text,
                "Two starts that are {:e} apart agree to the end, but the methods do not converge with the step: this is not chaos; forces that jump, as at an impact, are likely.",
                nearby.distance
            ),
        };
    }
    for advice in &report.advice {
        let _ = writeln!(text, "{}", printable(&advice.text));
    }
    if interrupted() {
        text.push_str("stopped by Ctrl-C: the runs above are the finished ones\n");
    }
    text
}

/// The times at which runs are compared.
fn compared_at(report: &PrecisionResults) -> String {
    let interval = report.length / report.samples as f64;
    let shortest = report.rows.iter().map(|r| r.setting.timestep).fold(f64::INFINITY, f64::min);
    match shortest < 0.9 * interval {
        true => format!("after each step, but at most every {} ms", milliseconds(interval)),
        false => "after each step".to_string(),
    }
}

/// Writes the outcome of each run.
fn write_outcomes(report: &PrecisionResults, text: &mut String) {
    for row in &report.rows {
        let reason = row.reported.first().map_or(String::new(), |t| format!(": {}", printable(t)));
        let _ = writeln!(
            text,
            "  {} at {} ms {}{reason}",
            setting(row),
            milliseconds(row.setting.timestep),
            row.status.word()
        );
    }
}
