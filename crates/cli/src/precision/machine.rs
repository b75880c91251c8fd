//! The output of a comparison for programs: CSV and JSON.

use super::super::report_json::{WithNonfinite, with_nonfinite};
use super::super::schema_words::{AnyNumber, AnyNumbers, TRUTHS, Truth, WordOf};
use labspec::report::key;
use labspec::run::INTEGRATORS;
use labspec_numerics::precision::{
    Advice, BesideRow, Compared, Errors, Event, NearbyStarts, OmittedNumber, PrecisionResults, PrecisionRow,
    RunCost, RunStatus,
};
use schemars::JsonSchema;
use serde::Serialize;
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
                e.largest, e.time, e.rms, e.end, e.below
            )?;
        }
    }
    Ok(())
}

/// The error of integrators, timesteps and settings of the solver against their run time. Run times are measured: they differ from
/// run to run.
#[derive(Serialize, JsonSchema)]
#[serde(rename_all = "camelCase")]
pub(in super::super) struct PrecisionReport<'a> {
    /// Labels of the traces, then of the readouts, that were compared.
    traces: Vec<&'a str>,
    /// What each was compared with: its closed form, or what two families of methods agree on with tiny steps.
    #[schemars(with = "Vec<WordOf<Truth>>")]
    truth: Vec<String>,
    /// The two families of methods behind the reference, in words; null if no method completes the lab.
    reference: Option<&'a str>,
    /// The length of the runs, in seconds of simulation.
    length: f64,
    /// The runs, by integrator, then from large to small steps; then settings of the solver.
    rows: Vec<WithNonfinite<PrecisionRunRow<'a>>>,
    /// What happens in the reference.
    events: Vec<WithNonfinite<EventRow<'a>>>,
    /// What is not compared.
    #[serde(rename = "leftOut")]
    omitted: &'a [OmittedNumber],
    /// The Pareto front: indexes of the rows that no other beats in both error and work, cheapest first.
    front: &'a [usize],
    /// The recommended settings, each with its row and a sentence.
    advice: &'a [Advice],
    /// The unit of each trace, where it is known.
    units: Vec<Option<&'a str>>,
    /// The uncertainty of the reference of each trace, in the unit of the trace; null for a closed form.
    #[schemars(with = "AnyNumbers")]
    uncertainty: Vec<Option<f64>>,
    /// The largest error of each that nobody sees: half a unit of a readout's last digit, half a pixel of a plot. A readout that shows
    /// other digits than the truth at a sample is wrong there.
    #[schemars(with = "AnyNumbers")]
    unseen: Vec<Option<f64>>,
    /// Until when each is compared, in seconds, where the reference is not known to the end.
    #[schemars(with = "AnyNumbers")]
    until: Vec<Option<f64>>,
    /// The size of energy (J), momentum (kg m/s) and angular momentum (kg m²/s) that the scene keeps; null where it does not.
    #[serde(rename = "kept")]
    #[schemars(with = "AnyNumbers")]
    conserved: [Option<f64>; 3],
    /// How deep bodies are in each other in the reference, in metres.
    #[schemars(with = "AnyNumber")]
    penetration: f64,
    /// How far that may be off, in metres.
    #[schemars(with = "AnyNumber")]
    penetration_uncertainty: f64,
    /// The number of samples of the reference over the length, without that of the start: a run is compared at those that its steps
    /// meet.
    #[schemars(range(min = 1))]
    samples: usize,
    /// Another program's runs of the same lab (`--beside`), against the same truth.
    beside: Option<BesideReport<'a>>,
    /// How long two indistinguishable initial states give the same values; null if the reference is known to the end.
    nearby: Option<NearbyStarts>,
}

/// A run.
#[derive(Serialize, JsonSchema)]
#[serde(rename_all = "camelCase")]
#[schemars(rename = "run")]
struct PrecisionRunRow<'a> {
    /// The integrator.
    #[schemars(extend("enum" = INTEGRATORS.map(|integrator| integrator.name)))]
    integrator: &'static str,
    /// The length of a step, in seconds.
    timestep: f64,
    /// The setting of the solver that differs from the lab's own, in words.
    solver: Option<String>,
    /// The lab as it stands.
    #[serde(rename = "own")]
    is_own: bool,
    /// What became of the run.
    #[serde(rename = "fate")]
    #[schemars(extend("enum" = RunStatus::ALL.map(|status| key(status.word()))))]
    status: String,
    /// The engine met a bad number, and reset the scene.
    diverged: bool,
    /// What is reported about the run.
    #[serde(rename = "told")]
    reported: &'a [String],
    /// For each trace: the samples at which a student sees its error.
    wrong: Vec<usize>,
    /// For each trace: the samples that are compared.
    compared: Vec<usize>,
    /// For each event: the number under `events` is what the event itself may be off; the error is at most that.
    events_below: Vec<bool>,
    /// For each trace: whether its error is within the uncertainty of the reference.
    below: Vec<bool>,
    /// The largest error of each trace over the run.
    #[schemars(with = "AnyNumbers")]
    errors: Vec<Option<f64>>,
    /// When that was, in seconds.
    #[serde(rename = "at")]
    #[schemars(with = "AnyNumbers")]
    times: Vec<Option<f64>>,
    /// The root of the mean square of its error.
    #[schemars(with = "AnyNumbers")]
    rms: Vec<Option<f64>>,
    /// Its error at the end.
    #[schemars(with = "AnyNumbers")]
    end: Vec<Option<f64>>,
    /// The observed order of each trace; null where there is none.
    #[schemars(with = "AnyNumbers")]
    orders: Vec<Option<f64>>,
    /// The timing error of each event, in seconds; at least the uncertainty of its reference time.
    #[schemars(with = "AnyNumbers")]
    events: Vec<Option<f64>>,
    /// The largest change of energy (J), of momentum (kg m/s) and of angular momentum (kg m²/s); null where the scene does not keep it.
    #[serde(rename = "kept")]
    #[schemars(with = "AnyNumbers")]
    conserved: [Option<f64>; 3],
    /// The maximum penetration depth of two bodies during the run, in metres.
    #[schemars(with = "AnyNumber")]
    penetration: f64,
    /// The largest possible error, including the uncertainty of the reference, in multiples of the largest invisible error.
    #[schemars(with = "AnyNumber")]
    score: f64,
    /// Measured run time, in microseconds for a second of simulation: the median of repeats.
    #[schemars(with = "AnyNumber")]
    microseconds_per_second: f64,
    /// A quarter of the repeats took less than the first of these, and a quarter more than the second.
    #[schemars(with = "AnyNumbers")]
    repeats: [Option<f64>; 2],
    /// The work of the whole run, for a second of simulation, as the engine counts it, in units of about a nanosecond: the same on every
    /// machine. It decides.
    #[schemars(with = "AnyNumber")]
    work: f64,
}

/// An event: the first contact, the first passage of a trace through zero, or its first turning point; none beyond the horizon of a
/// chaotic lab.
#[derive(Serialize, JsonSchema)]
struct EventRow<'a> {
    /// In words.
    name: &'a str,
    /// When, in seconds; null where it does not happen.
    #[schemars(with = "AnyNumber")]
    time: f64,
    /// How far that may be off, in seconds.
    #[schemars(with = "AnyNumber")]
    uncertainty: f64,
}

/// Another program's runs of the same lab.
#[derive(Serialize, JsonSchema)]
struct BesideReport<'a> {
    /// The program and its version.
    engine: &'a str,
    /// Its runs.
    rows: Vec<WithNonfinite<BesideRunRow<'a>>>,
}

/// A run of another program.
#[derive(Serialize, JsonSchema)]
#[serde(rename_all = "camelCase")]
struct BesideRunRow<'a> {
    /// The integrator.
    integrator: &'a str,
    /// The length of a step, in seconds.
    timestep: f64,
    /// The largest error of each trace over the run.
    #[schemars(with = "AnyNumbers")]
    errors: Vec<Option<f64>>,
    /// Run time as that program measured it.
    #[schemars(with = "AnyNumber")]
    microseconds_per_second: f64,
}

pub(in super::super) fn machine(report: &PrecisionResults) -> WithNonfinite<PrecisionReport<'_>> {
    let targets = || report.targets.iter();
    // A closed form has no uncertainty: its entry is missing, not lost.
    let column = |f: fn(&Compared) -> Option<f64>| targets().map(f).collect::<Vec<_>>();
    let uncertainty = column(|t| (!t.closed).then_some(t.uncertain));
    let (unseen, until) = (column(|t| Some(t.invisible_error)), column(|t| t.until));
    let conserved = [report.energy, report.momentum[0], report.momentum[1]];
    let row = PrecisionReport {
        traces: targets().map(|t| t.label.as_str()).collect(),
        truth: targets().map(|t| key(TRUTHS[usize::from(t.closed)])).collect(),
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

fn beside_row(row: &BesideRow) -> WithNonfinite<BesideRunRow<'_>> {
    let row = BesideRunRow {
        integrator: &row.integrator,
        timestep: row.timestep,
        errors: row.errors.iter().map(|e| Some(e.largest)).collect(),
        microseconds_per_second: row.cost,
    };
    with_nonfinite(&row, &[("errors", &row.errors), ("microsecondsPerSecond", &row.microseconds_per_second)])
}

fn event_row(event: &Event) -> WithNonfinite<EventRow<'_>> {
    let row = EventRow { name: &event.name, time: event.time, uncertainty: event.uncertain };
    with_nonfinite(&row, &[("time", &row.time), ("uncertainty", &row.uncertainty)])
}

fn run_row<'a>(row: &'a PrecisionRow, report: &PrecisionResults) -> WithNonfinite<PrecisionRunRow<'a>> {
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
        times: column(|e| Some(e.time)),
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
            ("at", &row.times),
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
