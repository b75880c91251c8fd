//! The output of `labspec stability` for programs.

use super::super::report_json::{NonFinite, WithNonfinite, nonfinite, with_nonfinite};
use super::super::schema_words::{AnyNumber, Cell, ControlValue, FINE, UNKNOWN, WordOf};
use super::describe_skipped;
use labspec::bind::Programs;
use labspec::report::key;
use labspec::stress::{Action, Fault, FaultKind, Interaction, InteractionKind};
use labspec_numerics::stability::{
    DivergenceOfStarts, MapCell, Margin, ParameterKind, Sensitivity, StabilityFinding, StabilityMap,
    StressReport,
};
use schemars::JsonSchema;
use serde::Serialize;
use serde_json::Value;

/// The faults of a lab under every interaction that a student can make.
#[derive(Serialize, JsonSchema)]
#[serde(rename_all = "camelCase")]
pub(in super::super) struct StabilityReport<'a> {
    /// How long a run is, in seconds of simulation.
    length: f64,
    /// How many runs of each kind there are.
    tried: Vec<CountRow>,
    /// The runs that were begun.
    runs: Vec<StabilityRunRow<'a>>,
    /// How long the shortest of the runs was that were cut, in seconds; null where none was.
    shortest: Option<f64>,
    /// Pairs of settings that meet in no run, because there are too many.
    #[serde(rename = "pairsLeftOut")]
    skipped_pairs: usize,
    /// Everything that was not tried, in words.
    #[serde(rename = "leftOut")]
    skipped: Vec<String>,
    /// What goes wrong, the simplest setting first.
    findings: Vec<StabilityFindingRow<'a>>,
    /// The length of the runs for margins and sensitivity, in seconds: as long as a student watches.
    window: f64,
    /// How far everything may be raised before the lab breaks; empty without --margins.
    margins: Vec<MarginRow<'a>>,
    /// How much the lab depends on its start, as it stands.
    sensitivity: SensitivityRow<'a>,
    /// The stable region over two controls; null without --map.
    map: Option<MapRow<'a>>,
    /// Work of all runs as the engine counts it, in units of about a nanosecond: the same on every machine.
    work: u64,
    /// Everything was tried, and nothing unexpected goes wrong.
    fine: bool,
}

/// A kind of runs.
#[derive(Serialize, JsonSchema)]
#[serde(rename_all = "camelCase")]
struct CountRow {
    /// What is done in them.
    #[schemars(with = "WordOf<InteractionKind>")]
    kind: String,
    /// Runs that were made to their end, or until they broke.
    made: usize,
    /// Runs that took more work than they may, and ended before.
    cut: usize,
    /// Runs that were not begun.
    #[serde(rename = "leftOut")]
    skipped: usize,
}

/// A run.
#[derive(Serialize, JsonSchema)]
#[schemars(rename = "run")]
struct StabilityRunRow<'a> {
    /// What is done in it.
    #[schemars(with = "WordOf<InteractionKind>")]
    kind: String,
    /// What a student does, in order; empty for the lab as it stands, and for a touch that nobody sees (touched).
    setting: Vec<ActionRow<'a>>,
    /// How much of it was made, in seconds.
    covered: f64,
    /// It took more work than it may.
    cut: bool,
    /// What goes wrong in it, each kind once.
    #[schemars(with = "Vec<WordOf<FaultKind>>")]
    wrong: Vec<String>,
}

/// A control is moved, or a button is pressed.
#[derive(Serialize, JsonSchema)]
struct ActionRow<'a> {
    /// Its label.
    control: &'a str,
    /// When, in seconds; 0 is before the first step.
    time: f64,
    /// What it is set to; null for a press.
    #[schemars(with = "Option<ControlValue>")]
    value: Option<Value>,
}

/// Something that goes wrong in a setting.
#[derive(Serialize, JsonSchema)]
struct FaultRow<'a> {
    /// What goes wrong.
    #[schemars(with = "WordOf<FaultKind>")]
    kind: String,
    /// When, in seconds of the lab's clock.
    time: f64,
    /// The joint, the body, or the two that touch, in words.
    subject: &'a str,
    /// The likely cause, in words.
    cause: &'a str,
    /// The numbers that show it.
    evidence: Vec<EvidenceRow>,
    /// What a student does, in order; empty for the lab as it stands, and for a touch that nobody sees (touched).
    setting: Vec<ActionRow<'a>>,
}

/// A number.
#[derive(Serialize, JsonSchema)]
struct EvidenceRow {
    /// What it is, in words.
    name: &'static str,
    /// The number.
    #[schemars(with = "AnyNumber")]
    value: f64,
    #[serde(skip_serializing_if = "NonFinite::is_empty")]
    nonfinite: NonFinite,
    /// Its unit; empty for a share or a count.
    unit: &'static str,
}

/// Something that goes wrong, in one or several settings.
#[derive(Serialize, JsonSchema)]
#[schemars(rename = "finding")]
struct StabilityFindingRow<'a> {
    #[serde(flatten)]
    fault: FaultRow<'a>,
    /// Whether it occurs only after a small perturbation: every joint starts with a speed of 1e-6.
    touched: bool,
    /// How many settings show it.
    #[schemars(range(min = 1))]
    settings: usize,
    /// The lab itself says that it breaks.
    expected: bool,
    /// What was tried and helps in this setting.
    remedies: Vec<WithNonfinite<RemedyRow<'a>>>,
    /// The setting in which it is the worst, where that is another one.
    worst: Option<FaultRow<'a>>,
}

/// A change after which the run completes without a fault.
#[derive(Serialize, JsonSchema)]
#[serde(rename_all = "camelCase")]
struct RemedyRow<'a> {
    /// What to change, in words.
    change: &'a str,
    /// The work per simulated second with this change, relative to that of the unchanged lab.
    #[schemars(with = "AnyNumber")]
    work: f64,
    /// The same as measured by a clock.
    #[schemars(with = "AnyNumber")]
    time_ratio: f64,
    /// The largest error of any number that the lab shows with it, as a part of that number's range, against the motion that the model
    /// describes (found with much shorter steps); null where that is not known.
    error: Option<f64>,
}

/// Something that was multiplied until the lab broke.
#[derive(Serialize, JsonSchema)]
struct MarginRow<'a> {
    /// What was raised.
    #[schemars(extend("enum" = ParameterKind::ALL.map(|kind| key(kind.description()))))]
    parameter: String,
    /// Of what, in words.
    subject: &'a str,
    /// Its unit; empty where it differs from joint to joint, or for a ratio.
    unit: &'static str,
    /// The value that the lab has.
    #[serde(rename = "now")]
    current: f64,
    /// The largest value that was fine; null where even the smallest one tried breaks.
    largest: Option<f64>,
    /// The smallest value above it that breaks; null where nothing did.
    breaks: Option<f64>,
    /// What goes wrong there.
    how: Option<BreakRow<'a>>,
    /// The bound that theory gives for one degree of freedom; null without one.
    bound: Option<f64>,
    /// How many runs it took.
    #[schemars(range(min = 1))]
    runs: usize,
    /// Of the stiffness of all contacts, the geoms that touch.
    geoms: &'a [usize],
}

/// What goes wrong at a value.
#[derive(Serialize, JsonSchema)]
struct BreakRow<'a> {
    /// What goes wrong.
    #[schemars(with = "WordOf<FaultKind>")]
    kind: String,
    /// The joint, the body, or the two that touch, in words.
    subject: &'a str,
}

/// How much the lab depends on its start, as it stands.
#[derive(Serialize, JsonSchema)]
struct SensitivityRow<'a> {
    /// Over how long, in seconds.
    length: f64,
    /// How far the other start is off, in the unit of each coordinate.
    distance: f64,
    /// The factor by which a small initial difference grows until the end; null if nothing moves or the lab does not reach its
    /// end.
    divergence: Option<WithNonfinite<DivergenceRow>>,
    /// The largest Lyapunov exponent, in 1/s; null where small differences do not grow exponentially.
    exponent: Option<ExponentRow>,
    /// The readouts.
    horizons: Vec<HorizonRow<'a>>,
}

/// How many times as large a small difference at the start is at the end.
#[derive(Serialize, JsonSchema)]
struct DivergenceRow {
    /// Along the direction that grows least.
    #[schemars(with = "AnyNumber")]
    low: f64,
    /// Along the direction that grows most.
    #[schemars(with = "AnyNumber")]
    high: f64,
}

/// The largest Lyapunov exponent, in 1/s.
#[derive(Serialize, JsonSchema)]
struct ExponentRow {
    /// The mean of several directions.
    mean: f64,
    /// The smallest of them.
    low: f64,
    /// The largest of them.
    high: f64,
    /// How many directions there are.
    #[schemars(range(min = 1))]
    directions: usize,
}

/// A readout.
#[derive(Serialize, JsonSchema)]
struct HorizonRow<'a> {
    /// Its label.
    label: &'a str,
    /// When it begins to show other digits, in seconds; null where it does not.
    until: Option<f64>,
}

/// The stable region over two controls.
#[derive(Serialize, JsonSchema)]
struct MapRow<'a> {
    /// Labels of the control to the right and of the one upwards.
    controls: &'a [String; 2],
    /// Their values.
    #[schemars(with = "Vec<Vec<ControlValue>>")]
    values: Vec<Vec<Value>>,
    /// A row for each value of the second control, and in it a cell for each of the first: what goes wrong there, fine, or unknown.
    #[schemars(with = "Vec<Vec<WordOf<Cell>>>")]
    cells: Vec<Vec<String>>,
}

pub(in super::super) fn machine<'a>(report: &'a StressReport, programs: &'a Programs) -> StabilityReport<'a> {
    let tried = report.tried.iter().map(|t| CountRow {
        kind: key(t.kind.description()),
        made: t.made,
        cut: t.cut,
        skipped: t.skipped,
    });
    let runs = report.runs.iter().map(|run| StabilityRunRow {
        kind: key(run.interaction.kind.description()),
        setting: actions(&run.interaction, programs),
        covered: run.covered,
        cut: run.cut,
        wrong: run.wrong.iter().map(|k| key(k.description())).collect(),
    });
    StabilityReport {
        length: report.length,
        tried: tried.collect(),
        runs: runs.collect(),
        shortest: report.shortest,
        skipped_pairs: report.skipped_pairs,
        skipped: describe_skipped(report),
        findings: report.found.iter().map(|f| finding_row(f, programs)).collect(),
        window: report.window,
        margins: report.margins.iter().map(margin_row).collect(),
        sensitivity: sensitivity_row(&report.sensitivity),
        map: report.map.as_ref().map(map_row),
        work: report.work,
        fine: report.fine(),
    }
}

fn finding_row<'a>(found: &'a StabilityFinding, programs: &'a Programs) -> StabilityFindingRow<'a> {
    let remedies = found.remedies.iter().map(|r| {
        let row = RemedyRow { change: &r.change, work: r.work, time_ratio: r.time, error: r.error };
        with_nonfinite(&row, &[("work", &row.work), ("timeRatio", &row.time_ratio)])
    });
    let group = &found.group;
    StabilityFindingRow {
        fault: fault_row(&group.fault, &group.interaction, programs),
        touched: group.interaction.kind == InteractionKind::Touched,
        settings: group.settings,
        expected: found.expected,
        remedies: remedies.collect(),
        worst: group.worst.as_ref().map(|(other, fault)| fault_row(fault, other, programs)),
    }
}

fn fault_row<'a>(fault: &'a Fault, interaction: &Interaction, programs: &'a Programs) -> FaultRow<'a> {
    let evidence = fault.evidence.iter().map(|e| EvidenceRow {
        name: e.name,
        value: e.value,
        nonfinite: nonfinite(&[("value", &e.value)]),
        unit: e.unit,
    });
    FaultRow {
        kind: key(fault.kind.description()),
        time: fault.time,
        subject: &fault.subject,
        cause: &fault.cause,
        evidence: evidence.collect(),
        setting: actions(interaction, programs),
    }
}

fn margin_row(m: &Margin) -> MarginRow<'_> {
    MarginRow {
        parameter: key(m.parameter.description()),
        subject: &m.subject,
        unit: m.unit,
        current: m.current,
        largest: m.largest,
        breaks: m.breaks,
        how: m.how.as_ref().map(|(kind, subject)| BreakRow { kind: key(kind.description()), subject }),
        bound: m.bound,
        runs: m.runs,
        geoms: &m.geoms,
    }
}

fn sensitivity_row(s: &Sensitivity) -> SensitivityRow<'_> {
    let horizons = s.horizons.iter();
    SensitivityRow {
        length: s.length,
        distance: s.distance,
        divergence: s.divergence.map(|DivergenceOfStarts { low, high }| {
            with_nonfinite(&DivergenceRow { low, high }, &[("low", &low), ("high", &high)])
        }),
        exponent: s.exponent.map(|e| ExponentRow {
            mean: e.mean,
            low: e.low,
            high: e.high,
            directions: e.directions,
        }),
        horizons: horizons.map(|h| HorizonRow { label: &h.label, until: h.until }).collect(),
    }
}

fn map_row(map: &StabilityMap) -> MapRow<'_> {
    let cell = |c: &MapCell| match c {
        MapCell::Fine => FINE.to_string(),
        MapCell::Broken(kind) => key(kind.description()),
        MapCell::Unknown => UNKNOWN.to_string(),
    };
    MapRow {
        controls: &map.labels,
        values: map.values.iter().map(|list| list.iter().map(control_value).collect()).collect(),
        cells: map.cells.iter().map(|row| row.iter().map(cell).collect()).collect(),
    }
}

/// The value of a control.
fn control_value(value: &labspec_expr::Value) -> Value {
    match value {
        labspec_expr::Value::Number(x) => (*x).into(),
        labspec_expr::Value::Boolean(b) => (*b).into(),
        other => other.to_string().into(),
    }
}

/// The actions of a student in an interaction, each with its time.
fn actions<'a>(interaction: &Interaction, programs: &'a Programs) -> Vec<ActionRow<'a>> {
    let row = |a: &Action| ActionRow {
        control: programs.controls.get(a.control).map_or("", |(label, _)| label.as_str()),
        time: a.time,
        value: a.value.as_ref().map(control_value),
    };
    interaction.actions.iter().map(row).collect()
}
