//! The output of a comparison for programs: CSV and JSON.

use super::super::report_json::with_nonfinite;
use labspec::report::key;
use labspec_numerics::precision::{
    Advice, BesideRow, Compared, Errors, Event, NearbyStarts, OmittedNumber, PrecisionResults, PrecisionRow,
    RunCost, RunStatus,
};
use serde::Serialize;
use serde_json::{Map, Value};
use std::io;

/// Writes a line for each setting and number.
pub(super) fn csv(report: &PrecisionResults, out: &mut dyn io::Write) -> io::Result<()> {
    writeln!(
        out,
        "integrator,solver,timestep (s),own,label,unit,largest,at (s),rms,end,below,order,fate,microsecondsPerSecond,lowMicrosecondsPerSecond,highMicrosecondsPerSecond,work"
    )?;
    for row in &report.rows {
        let solver = row.setting.solver.map_or(String::new(), |s| s.name());
        let start =
            format!("{},{solver},{},{}", row.setting.integrator.name, row.setting.timestep, row.is_own);
        let RunCost { median, low, high, work } = row.cost;
        let end = format!("{},{median},{low},{high},{work}", key(row.status.word()));
        if row.errors.is_empty() {
            writeln!(out, "{start},,,,,,,,,{end}")?;
        }
        for (target, e) in report.targets.iter().zip(&row.errors) {
            let quoted = |text: &str| text.replace('"', "\"\"");
            let (label, unit) = (quoted(&target.label), quoted(target.unit.as_deref().unwrap_or_default()));
            let order = e.order.map_or(String::new(), |o| o.to_string());
            writeln!(
                out,
                "{start},\"{label}\",\"{unit}\",{},{},{},{},{},{order},{end}",
                e.largest, e.at, e.rms, e.end, e.below
            )?;
        }
    }
    Ok(())
}

/// A comparison. Lengths and times are in s, errors in the unit of their trace, energy in J, momentum in kg m/s
/// and kg m²/s, depths in m.
#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
struct PrecisionReport<'a> {
    traces: Vec<&'a str>,
    truth: Vec<String>,
    reference: Option<&'a str>,
    length: f64,
    rows: Vec<Map<String, Value>>,
    events: Vec<Map<String, Value>>,
    #[serde(rename = "leftOut")]
    omitted: &'a [OmittedNumber],
    front: &'a [usize],
    advice: &'a [Advice],
    units: Vec<Option<&'a str>>,
    uncertainty: Vec<Option<f64>>,
    unseen: Vec<Option<f64>>,
    until: Vec<Option<f64>>,
    #[serde(rename = "kept")]
    conserved: [Option<f64>; 3],
    penetration: f64,
    penetration_uncertainty: f64,
    samples: usize,
    beside: Option<BesideReport<'a>>,
    nearby: Option<NearbyStarts>,
}

/// A setting with the errors of each trace. `work` is in units of the engine.
#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
struct PrecisionRunRow<'a> {
    integrator: &'static str,
    timestep: f64,
    solver: Option<String>,
    #[serde(rename = "own")]
    is_own: bool,
    #[serde(rename = "fate")]
    status: String,
    diverged: bool,
    #[serde(rename = "told")]
    reported: &'a [String],
    wrong: Vec<usize>,
    compared: Vec<usize>,
    events_below: Vec<bool>,
    below: Vec<bool>,
    errors: Vec<Option<f64>>,
    at: Vec<Option<f64>>,
    rms: Vec<Option<f64>>,
    end: Vec<Option<f64>>,
    orders: Vec<Option<f64>>,
    events: Vec<Option<f64>>,
    #[serde(rename = "kept")]
    conserved: [Option<f64>; 3],
    penetration: f64,
    score: f64,
    microseconds_per_second: f64,
    repeats: [Option<f64>; 2],
    work: f64,
}

#[derive(Serialize)]
struct EventRow<'a> {
    name: &'a str,
    time: f64,
    uncertainty: f64,
}

#[derive(Serialize)]
struct BesideReport<'a> {
    engine: &'a str,
    rows: Vec<Map<String, Value>>,
}

#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
struct BesideRunRow<'a> {
    integrator: &'a str,
    timestep: f64,
    errors: Vec<Option<f64>>,
    microseconds_per_second: f64,
}

pub(in super::super) fn machine(report: &PrecisionResults) -> Map<String, Value> {
    let targets = || report.targets.iter();
    // A closed form has no uncertainty: its entry is missing, not lost.
    let column = |f: fn(&Compared) -> Option<f64>| targets().map(f).collect::<Vec<_>>();
    let uncertainty = column(|t| (!t.closed).then_some(t.uncertain));
    let (unseen, until) = (column(|t| Some(t.invisible_error)), column(|t| t.until));
    let conserved = [report.energy, report.momentum[0], report.momentum[1]];
    let row = PrecisionReport {
        traces: targets().map(|t| t.label.as_str()).collect(),
        truth: targets().map(|t| key(if t.closed { "closed form" } else { "tiny steps" })).collect(),
        reference: report.reference.as_deref(),
        length: report.length,
        rows: report.rows.iter().map(|row| run_row(row, report)).collect(),
        events: report.events.iter().map(event_row).collect(),
        omitted: &report.omitted,
        front: &report.front,
        advice: &report.advice,
        units: targets().map(|t| t.unit.as_deref()).collect(),
        uncertainty,
        unseen,
        until,
        conserved,
        penetration: report.penetration,
        penetration_uncertainty: report.penetration_doubt,
        samples: report.samples,
        beside: report
            .beside
            .as_ref()
            .map(|b| BesideReport { engine: &b.engine, rows: b.rows.iter().map(beside_row).collect() }),
        nearby: report.nearby,
    };
    with_nonfinite(
        &row,
        &[
            ("uncertainty", &row.uncertainty),
            ("unseen", &row.unseen),
            ("until", &row.until),
            ("kept", &row.conserved),
            ("penetration", &row.penetration),
            ("penetrationUncertainty", &row.penetration_uncertainty),
        ],
    )
}

fn beside_row(row: &BesideRow) -> Map<String, Value> {
    let row = BesideRunRow {
        integrator: &row.integrator,
        timestep: row.timestep,
        errors: row.errors.iter().map(|e| Some(e.largest)).collect(),
        microseconds_per_second: row.cost,
    };
    with_nonfinite(&row, &[("errors", &row.errors), ("microsecondsPerSecond", &row.microseconds_per_second)])
}

fn event_row(event: &Event) -> Map<String, Value> {
    let row = EventRow { name: &event.name, time: event.time, uncertainty: event.uncertain };
    with_nonfinite(&row, &[("time", &row.time), ("uncertainty", &row.uncertainty)])
}

fn run_row(row: &PrecisionRow, report: &PrecisionResults) -> Map<String, Value> {
    let at_most = row.events.iter().zip(&report.events).map(|(off, event)| *off <= event.uncertain);
    let column = |f: fn(&Errors) -> Option<f64>| row.errors.iter().map(f).collect::<Vec<_>>();
    let row = PrecisionRunRow {
        integrator: row.setting.integrator.name,
        timestep: row.setting.timestep,
        solver: row.setting.solver.map(|s| s.name()),
        is_own: row.is_own,
        status: key(row.status.word()),
        diverged: row.status == RunStatus::Diverged,
        reported: &row.reported,
        wrong: row.errors.iter().map(|e| e.wrong).collect(),
        compared: row.errors.iter().map(|e| e.samples).collect(),
        events_below: at_most.collect(),
        below: row.errors.iter().map(|e| e.below).collect(),
        errors: column(|e| Some(e.largest)),
        at: column(|e| Some(e.at)),
        rms: column(|e| Some(e.rms)),
        end: column(|e| Some(e.end)),
        orders: column(|e| e.order),
        events: row.events.iter().copied().map(Some).collect(),
        conserved: [row.energy, row.momentum[0], row.momentum[1]],
        penetration: row.penetration,
        score: row.score,
        microseconds_per_second: row.cost.median,
        repeats: [row.cost.low, row.cost.high].map(Some),
        work: row.cost.work,
    };
    with_nonfinite(
        &row,
        &[
            ("errors", &row.errors),
            ("at", &row.at),
            ("rms", &row.rms),
            ("end", &row.end),
            ("orders", &row.orders),
            ("events", &row.events),
            ("kept", &row.conserved),
            ("penetration", &row.penetration),
            ("score", &row.score),
            ("microsecondsPerSecond", &row.microseconds_per_second),
            ("repeats", &row.repeats),
            ("work", &row.work),
        ],
    )
}
