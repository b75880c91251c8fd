//! `labspec precision`.

use super::output::{Wanted, look_ahead};
use super::stdio::print_json;
use super::{Failure, ModelOptions, Outcome, interrupted, print, target, write_file};
use crate::precision::{INTEGRATORS, Report, Row, Truth, compare};
use crate::report::{key, printable, set_number, set_numbers};
use crate::verify::significant;
use clap::ValueEnum;
use labspec_plot::{Method, MethodPoint, WorkPrecision, work_precision};
use serde_json::{Value, json};
use std::fmt::Write;
use std::path::PathBuf;

/// Arguments of `precision`.
#[derive(clap::Args, Debug)]
pub(super) struct Arguments {
    /// LAB.json, LESSON.md#2, or LESSON.md#quiz-id.1
    lab: String,
    #[command(flatten)]
    models: ModelOptions,
    /// Length in seconds [default: the lab's stopAt, or 2]
    #[arg(long, value_name = "S")]
    until: Option<f64>,
    /// How to print
    #[arg(long, value_enum, default_value = "human")]
    format: Format,
    /// Write the chart of the first trace
    #[arg(long, value_name = "FILE")]
    svg: Option<PathBuf>,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum Format {
    Human,
    Json,
}

pub(super) fn precision(a: &Arguments) -> Result<Outcome, Failure> {
    let target = target::open(&a.lab, &a.models)?;
    let wanted: Vec<Wanted> =
        a.svg.iter().map(|path| Wanted { option: "--svg", path: path.clone() }).collect();
    look_ahead(&target::read_for(&a.lab, &a.models, &target.lab), &wanted)?;
    let mut findings = Vec::new();
    let report =
        compare(&target.lab, &target.model, &target.programs, a.until, &mut findings).map_err(|e| e.0)?;
    if let Some(f) = findings.first() {
        return Err(format!(
            "a closed form has a mistake: {}; `labspec check` shows where",
            printable(&f.message)
        ));
    }
    if let Some(file) = &a.svg {
        write_file(file, &chart(&report, target.lab.title()))?;
    }
    match a.format {
        Format::Human => print(&table(&report))?,
        Format::Json => print_json(&value(&report), true)?,
    }
    let diverged = report.rows.iter().any(|r| r.diverged);
    Ok(if diverged { Outcome::Findings } else { Outcome::Clean })
}

/// Log-log chart of the first trace: error across, cost upwards, one curve per integrator.
fn chart(report: &Report, title: &str) -> String {
    let point = |row: &Row| MethodPoint {
        cost: row.cost,
        error: row.errors.first().copied().unwrap_or(f64::NAN),
        note: format!("{} ms", significant(1e3 * row.timestep)),
        failed: row.diverged,
    };
    let methods = INTEGRATORS.iter().map(|(_, name)| Method {
        label: name.to_string(),
        points: report.rows.iter().filter(|row| row.integrator == *name).map(point).collect(),
    });
    work_precision(&WorkPrecision {
        title: title.to_string(),
        xlabel: format!("largest error of {}", report.traces.first().map_or("", String::as_str)),
        ylabel: "µs per simulated second".into(),
        methods: methods.collect(),
        width: 640.0,
        height: 420.0,
    })
}

fn table(report: &Report) -> String {
    let mut text = String::new();
    for (i, trace) in report.traces.iter().enumerate() {
        let against = match report.truth.get(i) {
            Some(Truth::ClosedForm) => "the closed form".to_string(),
            _ => format!("RK4 with tiny steps (itself off by about {})", significant(report.uncertainty[i])),
        };
        let _ = writeln!(
            text,
            "{}: largest error over {} s against {against}",
            printable(trace),
            significant(report.length)
        );
        let _ = writeln!(text, "  integrator   timestep        error   order   µs per s");
        for r in &report.rows {
            let order = r.orders[i].map_or("–".to_string(), |o| format!("{o:.2}"));
            let error = if r.diverged { "diverged".to_string() } else { format!("{:.3e}", r.errors[i]) };
            let h = format!("{} ms", significant(1e3 * r.timestep));
            let _ = writeln!(text, "  {:<10} {h:>10} {error:>12} {order:>7} {:>10.0}", r.integrator, r.cost);
        }
        text.push('\n');
    }
    if interrupted() {
        text.push_str("stopped by Ctrl-C: the runs above are those that were finished\n");
    }
    text
}

fn value(report: &Report) -> Value {
    let rows: Vec<Value> = report
        .rows
        .iter()
        .map(|r| {
            let mut row = json!({"integrator": r.integrator, "timestep": r.timestep, "diverged": r.diverged});
            set_numbers(&mut row, "errors", &all(&r.errors));
            set_numbers(&mut row, "orders", &r.orders);
            set_number(&mut row, "microsecondsPerSecond", r.cost);
            row
        })
        .collect();
    let words = |truth: &Truth| if *truth == Truth::ClosedForm { "closed form" } else { "tiny steps" };
    let truth: Vec<String> = report.truth.iter().map(|t| key(words(t))).collect();
    let mut value = json!({"traces": report.traces, "truth": truth, "length": report.length, "rows": rows});
    // A closed form is not off: there is no number for it, not one that was lost.
    let reference = report.truth.iter().zip(&report.uncertainty);
    let uncertainty: Vec<Option<f64>> =
        reference.map(|(t, &x)| (*t == Truth::TinySteps).then_some(x)).collect();
    set_numbers(&mut value, "uncertainty", &uncertainty);
    crate::report::report("precision", value)
}

fn all(numbers: &[f64]) -> Vec<Option<f64>> {
    numbers.iter().copied().map(Some).collect()
}
