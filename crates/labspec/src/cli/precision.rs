//! `labspec precision`.

use super::handle::Handled;
use super::output::{wanted, write_png, write_with};
use super::stdio::{Progress, print_json, stream};
use super::{Failure, Outcome, OutputKind, interrupted, print, write_file};
use crate::precision::{
    Axis, Beside, BesideRow, Compared, Errors, Fate, INTEGRATORS, Integrator, Options, Recording, Report,
    Row, compare, milliseconds,
};
use crate::report::{key, printable, printable_path, set_number, set_numbers};
use crate::source::read_text;
use crate::verify::significant;
use clap::ValueEnum;
use labspec_plot::{Method, MethodPoint, WorkPrecision, work_precision};
use serde_json::{Value, json};
use std::fmt::Write;
use std::io;
use std::path::{Path, PathBuf};

/// Arguments of `precision`.
#[derive(clap::Args, Debug)]
pub(super) struct Arguments {
    #[command(flatten)]
    handled: Handled,
    /// Length in seconds [default: the lab's stopAt, or 2]
    #[arg(long, value_name = "S")]
    until: Option<f64>,
    /// Only this integrator, or `all`, with those that MuJoCo does not have [default: MuJoCo's five]
    #[arg(long, value_name = "NAME")]
    integrator: Vec<String>,
    /// Vary a setting of the constraint solver as well
    #[arg(long, value_enum, value_name = "SETTING")]
    vary: Vec<Vary>,
    /// Another program's runs of the same lab, to stand beside ours
    #[arg(long, value_name = "FILE")]
    beside: Option<PathBuf>,
    /// How to print
    #[arg(long, value_enum, default_value = "human")]
    format: Format,
    /// Write all errors as comma-separated values
    #[arg(long, value_name = "FILE")]
    csv: Option<PathBuf>,
    /// Write the chart of the first trace
    #[arg(long, value_name = "FILE")]
    svg: Option<PathBuf>,
    /// The same in pixels
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
enum Format {
    Human,
    Json,
    Csv,
}

pub(super) fn precision(a: &Arguments) -> Result<Outcome, Failure> {
    let target = a.handled.open()?;
    a.handled.look_ahead(
        &target,
        &wanted(&[(OutputKind::Settings, &a.csv), (OutputKind::Plot, &a.svg), (OutputKind::Picture, &a.png)]),
    )?;
    let options = Options {
        until: a.until,
        set: a.handled.set(&target.lab)?,
        press: a.handled.press(&target.lab)?,
        integrators: integrators(&a.integrator)?,
        axes: a.vary.iter().map(|v| v.axis()).collect(),
        beside: a.beside.as_ref().map(|path| recording(path)).transpose()?,
    };
    let mut findings = Vec::new();
    let progress = Progress::new(matches!(a.format, Format::Human));
    let mut tell = |text: &str| progress.tell(text);
    let report = compare(&target.lab, &target.model, &target.programs, &options, &mut findings, &mut tell)
        .map_err(|e| e.0)?;
    drop(progress);
    if let Some(f) = findings.first() {
        return Err(format!(
            "a closed form has a mistake: {}; `labspec check` shows where",
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
        Format::Human => print(&human(&report))?,
        Format::Json => print_json(&value(&report), true)?,
        Format::Csv => stream(|out| csv(&report, out))?,
    }
    Ok(if report.reference.is_none() || lost(&report) { Outcome::Findings } else { Outcome::Clean })
}

/// Whether the lab as it stands is no good, or the truth is not known to its end.
fn lost(report: &Report) -> bool {
    report.rows.iter().any(|r| r.own && r.fate != Fate::Good)
        || report.targets.iter().any(|t| t.until.is_some())
}

impl Vary {
    fn axis(self) -> Axis {
        match self {
            Vary::Iterations => Axis::Iterations,
            Vary::Tolerance => Axis::Tolerance,
            Vary::Cone => Axis::Cone,
        }
    }
}

/// Bytes of a recording, at most.
const MOST: u64 = 256 << 20;

fn recording(path: &Path) -> Result<Recording, Failure> {
    let named = |e: String| format!("cannot use {}: {e}", printable_path(path));
    let text = read_text(path, MOST, "a recording")?;
    Recording::read(&text).map_err(named)
}

fn integrators(names: &[String]) -> Result<Vec<Integrator>, Failure> {
    if names.iter().any(|n| n == "all") {
        return Ok(INTEGRATORS.to_vec());
    }
    let known = || INTEGRATORS.map(|i| i.name).join(", ");
    let one = |name: &String| {
        Integrator::named(name).ok_or_else(|| {
            format!("--integrator {name}: there is none of this name; there are {}, and all", known())
        })
    };
    names.iter().map(one).collect()
}

/// Log-log chart of the first trace: error across, cost upwards, one curve per integrator.
fn chart(report: &Report, title: &str) -> String {
    // What is as exact as the reference stands where that is off.
    let doubt = report.targets.first().map_or(0.0, |t| t.uncertain);
    let error = |errors: &[Errors]| {
        errors.first().map_or(f64::NAN, |e| if e.below { e.largest.max(doubt) } else { e.largest })
    };
    let point = |row: &Row| MethodPoint {
        cost: row.cost.median,
        error: error(&row.errors),
        note: format!("{} ms", milliseconds(row.setting.timestep)),
        failed: row.fate != Fate::Good,
    };
    let used = INTEGRATORS.iter().filter(|i| report.rows.iter().any(|r| r.setting.integrator == **i));
    let methods = used.map(|integrator| Method {
        label: integrator.name.to_string(),
        points: report
            .rows
            .iter()
            .filter(|row| row.setting.integrator == *integrator && row.setting.solver.is_none())
            .map(point)
            .collect(),
        echo: None,
    });
    let mut methods: Vec<Method> = methods.collect();
    if let Some(beside) = &report.beside {
        let engine = beside.engine.split(' ').next().unwrap_or_default();
        for i in 0..methods.len() {
            let rows = beside.rows.iter().filter(|row| row.integrator == methods[i].label);
            let points: Vec<MethodPoint> = rows
                .map(|row| MethodPoint {
                    cost: row.cost,
                    error: error(&row.errors),
                    note: String::new(),
                    failed: false,
                })
                .collect();
            if !points.is_empty() {
                methods.push(Method {
                    label: format!("{}, {engine}", methods[i].label),
                    points,
                    echo: Some(i),
                });
            }
        }
    }
    work_precision(&WorkPrecision {
        title: title.to_string(),
        xlabel: format!("largest error of {}", report.targets.first().map_or("", |t| t.label.as_str())),
        ylabel: "µs per simulated second".into(),
        methods,
        width: 640.0,
        height: 420.0,
    })
}

fn human(report: &Report) -> String {
    let mut text = String::new();
    match &report.reference {
        None => {
            let why = match report.rows.iter().any(|r| r.fate == Fate::Good) {
                true => "the methods of high order take more work than a run may do; shorten it with --until",
                false => "no method comes through this lab",
            };
            let _ = writeln!(text, "Nothing can be compared: {why}.");
            fates(report, &mut text);
        }
        Some(how) => {
            let _ = writeln!(
                text,
                "Over {} s, {}. Where there is no closed form the reference is {how}.",
                significant(report.length),
                compared_at(report)
            );
            table(report, &mut text);
        }
    }
    if let Some(beside) = &report.beside {
        others(report, beside, &mut text);
    }
    for out in &report.left_out {
        let _ = writeln!(text, "Not compared: {}, as {}.", printable(&out.label), out.reason);
    }
    if let Some(nearby) = &report.nearby {
        let _ = match nearby.until {
            Some(t) => writeln!(
                text,
                "Two starts that are {:e} apart show the same until {} s: what comes later cannot be predicted, by any method.",
                nearby.apart,
                significant(t)
            ),
            None => writeln!(
                text,
                "Two starts that are {:e} apart show the same to the end, yet the methods do not come closer with the step: \
                 this is not chaos; forces that jump, as at an impact, are likely.",
                nearby.apart
            ),
        };
    }
    for advice in &report.advice {
        let _ = writeln!(text, "{}", printable(&advice.text));
    }
    if interrupted() {
        text.push_str("stopped by Ctrl-C: the runs above are those that were finished\n");
    }
    text
}

/// When runs are compared.
fn compared_at(report: &Report) -> String {
    let apart = report.length / report.samples as f64;
    let shortest = report.rows.iter().map(|r| r.setting.timestep).fold(f64::INFINITY, f64::min);
    match shortest < 0.9 * apart {
        true => format!("after each step, but at most every {} ms", milliseconds(apart)),
        false => "after each step".to_string(),
    }
}

fn setting(row: &Row) -> String {
    let solver = row.setting.solver.map_or(String::new(), |s| format!(" {}", s.name()));
    let own = if row.own { " *" } else { "" };
    format!("{}{solver}{own}", row.setting.integrator.name)
}

/// A column of the table: what it is, and a cell for each row.
struct Column {
    legend: String,
    cells: Vec<String>,
}

/// Columns that stand beside each other.
const ABREAST: usize = 5;

/// The largest errors of all that is compared, a column each; what is best in both is marked.
fn table(report: &Report, text: &mut String) {
    let columns = columns(report);
    for (k, column) in columns.iter().enumerate() {
        let _ = writeln!(text, "({}) {}", k + 1, column.legend);
    }
    let names: Vec<String> = report.rows.iter().map(setting).collect();
    let width = names.iter().map(|n| n.chars().count()).max().unwrap_or(0).max(10);
    for (first, some) in columns.chunks(ABREAST).enumerate() {
        let heads: String =
            (0..some.len()).map(|k| format!(" {:>10}", format!("({})", first * ABREAST + k + 1))).collect();
        let _ = writeln!(text, "\n  {:<width$}   timestep   µs per s      {heads}", "");
        for (i, row) in report.rows.iter().enumerate() {
            let h = format!("{} ms", milliseconds(row.setting.timestep));
            let spread = 50.0 * (row.cost.high - row.cost.low) / row.cost.median;
            let cost = match spread.is_finite() {
                true => format!("{:.0} ±{spread:>2.0}%", row.cost.median),
                false => String::new(),
            };
            let cells: String = match row.fate {
                Fate::Good | Fate::Warned => some.iter().map(|c| format!(" {:>10}", c.cells[i])).collect(),
                other => format!("  {}", other.word()),
            };
            let best = if report.front.contains(&i) { " ‹" } else { "" };
            let _ = writeln!(text, "  {:<width$} {h:>10} {cost:>16}{cells}{best}", names[i]);
        }
    }
    text.push_str(
        "\n* as the lab has it; ‹ no other is both closer and cheaper; ≤ as exact as the reference\n",
    );
}

fn columns(report: &Report) -> Vec<Column> {
    let mut list: Vec<Column> = Vec::new();
    let cell = |x: f64| if x.is_finite() { format!("{x:.1e}") } else { "–".into() };
    for (i, target) in report.targets.iter().enumerate().filter(|(_, t)| !t.blank) {
        let of = |row: &Row| match row.errors.get(i) {
            Some(e) if e.below => format!("≤{:.0e}", target.uncertain.max(e.largest)),
            Some(e) => cell(e.largest),
            None => "–".into(),
        };
        list.push(Column { legend: about(target), cells: report.rows.iter().map(of).collect() });
    }
    for (k, event) in report.events.iter().enumerate().filter(|(_, e)| e.time.is_finite()) {
        let legend = format!(
            "{}, at {} s (± {} s): error, s",
            printable(&event.name),
            significant(event.time),
            cell(event.uncertain)
        );
        let of = |row: &Row| cell(row.events.get(k).copied().unwrap_or(f64::NAN));
        list.push(Column { legend, cells: report.rows.iter().map(of).collect() });
    }
    let mut keeps = |size: Option<f64>, what: &str, unit: &str, of: fn(&Row) -> Option<f64>| {
        if let Some(size) = size {
            let legend = format!(
                "the scene keeps its {what} ({} {unit} move): largest change, {unit}",
                significant(size)
            );
            let cells = report.rows.iter().map(|r| cell(of(r).unwrap_or(f64::NAN))).collect();
            list.push(Column { legend, cells });
        }
    };
    keeps(report.energy, "energy", "J", |r| r.energy);
    keeps(report.momentum[0], "momentum", "kg m/s", |r| r.momentum[0]);
    keeps(report.momentum[1], "angular momentum", "kg m²/s", |r| r.momentum[1]);
    if report.penetration > 0.0 {
        let legend = format!("bodies are {} m in each other: error, m", significant(report.penetration));
        let of = |r: &Row| cell((r.penetration - report.penetration).abs());
        list.push(Column { legend, cells: report.rows.iter().map(of).collect() });
    }
    list
}

/// What a column of errors is held against, and what it takes to be seen.
fn about(target: &Compared) -> String {
    let against = match target.closed {
        true => "the closed form".to_string(),
        false => format!("the reference (± {:.0e})", target.uncertain),
    };
    let until = target.until.map_or(String::new(), |t| {
        format!("; compared until {} s, as the reference is not known beyond", significant(t))
    });
    format!(
        "{}: largest error against {against}; {} {}{until}",
        printable(&target.label),
        if target.readout { "its digits hide" } else { "its plot hides" },
        crate::run::two_digits(target.unseen)
    )
}

/// Another program's runs: the same columns of errors, its own times.
fn others(report: &Report, beside: &Beside, text: &mut String) {
    let _ = writeln!(text, "\nBeside: {}, largest errors against the same truth", printable(&beside.engine));
    let shown = || report.targets.iter().enumerate().filter(|(_, t)| !t.blank).take(ABREAST);
    for row in &beside.rows {
        let cell = |(i, target): (usize, &Compared)| match row.errors.get(i) {
            Some(e) if e.below => format!(" {:>10}", format!("≤{:.0e}", target.uncertain.max(e.largest))),
            Some(e) if e.largest.is_finite() => format!(" {:>10}", format!("{:.1e}", e.largest)),
            _ => format!(" {:>10}", "–"),
        };
        let cells: String = shown().map(cell).collect();
        let h = format!("{} ms", milliseconds(row.timestep));
        let _ =
            writeln!(text, "  {:<12} {h:>10} {:>10.0}      {cells}", printable(&row.integrator), row.cost);
    }
    text.push('\n');
}

/// What became of each run.
fn fates(report: &Report, text: &mut String) {
    for row in &report.rows {
        let told = row.told.first().map_or(String::new(), |t| format!(": {}", printable(t)));
        let _ = writeln!(
            text,
            "  {} at {} ms {}{told}",
            setting(row),
            milliseconds(row.setting.timestep),
            row.fate.word()
        );
    }
}

/// A line for each setting and number.
fn csv(report: &Report, out: &mut dyn io::Write) -> io::Result<()> {
    writeln!(
        out,
        "integrator,solver,timestep,own,label,largest,at,rms,end,below,order,fate,microsecondsPerSecond,work"
    )?;
    for row in &report.rows {
        let solver = row.setting.solver.map_or(String::new(), |s| s.name());
        let start = format!("{},{solver},{},{}", row.setting.integrator.name, row.setting.timestep, row.own);
        let end = format!("{},{},{}", key(row.fate.word()), row.cost.median, row.cost.work);
        if row.errors.is_empty() {
            writeln!(out, "{start},,,,,,,,{end}")?;
        }
        for (target, e) in report.targets.iter().zip(&row.errors) {
            let label = target.label.replace('"', "\"\"");
            let order = e.order.map_or(String::new(), |o| o.to_string());
            writeln!(
                out,
                "{start},\"{label}\",{},{},{},{},{},{order},{end}",
                e.largest, e.at, e.rms, e.end, e.below
            )?;
        }
    }
    Ok(())
}

fn value(report: &Report) -> Value {
    let labels: Vec<&str> = report.targets.iter().map(|t| t.label.as_str()).collect();
    let words = |t: &Compared| key(if t.closed { "closed form" } else { "tiny steps" });
    let truth: Vec<String> = report.targets.iter().map(words).collect();
    let rows: Vec<Value> = report.rows.iter().map(row_value).collect();
    let left_out: Vec<Value> =
        report.left_out.iter().map(|o| json!({"label": o.label, "reason": o.reason})).collect();
    let advice: Vec<Value> = report.advice.iter().map(|a| json!({"row": a.row, "text": a.text})).collect();
    let mut value = json!({
        "traces": labels, "truth": truth, "reference": report.reference, "length": report.length, "rows": rows,
        "events": report.events.iter().map(event_value).collect::<Vec<_>>(),
        "leftOut": left_out, "front": report.front, "advice": advice,
    });
    let of = |f: fn(&Compared) -> Option<f64>| report.targets.iter().map(f).collect::<Vec<_>>();
    // A closed form is not off: there is no number for it, not one that was lost.
    set_numbers(&mut value, "uncertainty", &of(|t| (!t.closed).then_some(t.uncertain)));
    set_numbers(&mut value, "unseen", &of(|t| Some(t.unseen)));
    set_numbers(&mut value, "until", &of(|t| t.until));
    set_numbers(&mut value, "kept", &[report.energy, report.momentum[0], report.momentum[1]]);
    set_number(&mut value, "penetration", report.penetration);
    value["samples"] = json!(report.samples);
    value["beside"] = report.beside.as_ref().map_or(
        Value::Null,
        |b| json!({"engine": b.engine, "rows": b.rows.iter().map(beside_value).collect::<Vec<_>>()}),
    );
    value["nearby"] = match &report.nearby {
        Some(n) => json!({"apart": n.apart, "until": n.until}),
        None => Value::Null,
    };
    crate::report::report("precision", value)
}

fn beside_value(row: &BesideRow) -> Value {
    let mut value = json!({"integrator": row.integrator, "timestep": row.timestep});
    set_numbers(&mut value, "errors", &row.errors.iter().map(|e| Some(e.largest)).collect::<Vec<_>>());
    set_number(&mut value, "microsecondsPerSecond", row.cost);
    value
}

fn event_value(event: &crate::precision::Event) -> Value {
    let mut value = json!({"name": event.name});
    set_number(&mut value, "time", event.time);
    set_number(&mut value, "uncertainty", event.uncertain);
    value
}

fn row_value(row: &Row) -> Value {
    let mut value = json!({
        "integrator": row.setting.integrator.name,
        "timestep": row.setting.timestep,
        "solver": row.setting.solver.map(|s| s.name()),
        "own": row.own,
        "fate": key(row.fate.word()),
        "diverged": row.fate == Fate::Diverged,
        "told": row.told,
        "below": row.errors.iter().map(|e| e.below).collect::<Vec<_>>(),
    });
    let of = |f: fn(&Errors) -> Option<f64>| row.errors.iter().map(f).collect::<Vec<_>>();
    set_numbers(&mut value, "errors", &of(|e| Some(e.largest)));
    set_numbers(&mut value, "at", &of(|e| Some(e.at)));
    set_numbers(&mut value, "rms", &of(|e| Some(e.rms)));
    set_numbers(&mut value, "end", &of(|e| Some(e.end)));
    set_numbers(&mut value, "orders", &of(|e| e.order));
    set_numbers(&mut value, "events", &row.events.iter().copied().map(Some).collect::<Vec<_>>());
    set_numbers(&mut value, "kept", &[row.energy, row.momentum[0], row.momentum[1]]);
    set_number(&mut value, "penetration", row.penetration);
    set_number(&mut value, "score", row.score);
    set_number(&mut value, "microsecondsPerSecond", row.cost.median);
    set_numbers(&mut value, "repeats", &[Some(row.cost.low), Some(row.cost.high)]);
    set_number(&mut value, "work", row.cost.work);
    value
}
