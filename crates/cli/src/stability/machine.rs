//! The output of `labspec stability` for programs.

use super::super::report_json::{NonFinite, nonfinite, with_nonfinite};
use super::describe_skipped;
use labspec::bind::Programs;
use labspec::report::key;
use labspec::stress::{Action, Fault, Interaction, InteractionKind};
use labspec_numerics::stability::{
    DivergenceOfStarts, MapCell, Margin, Sensitivity, StabilityFinding, StabilityMap, StressReport,
};
use serde::Serialize;
use serde_json::{Map, Value};

/// The performed runs and the results. Times are in s.
#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
pub(in super::super) struct StabilityReport<'a> {
    length: f64,
    tried: Vec<CountRow>,
    runs: Vec<StabilityRunRow<'a>>,
    shortest: Option<f64>,
    #[serde(rename = "pairsLeftOut")]
    skipped_pairs: usize,
    #[serde(rename = "leftOut")]
    skipped: Vec<String>,
    findings: Vec<StabilityFindingRow<'a>>,
    window: f64,
    margins: Vec<MarginRow<'a>>,
    sensitivity: SensitivityRow<'a>,
    map: Option<MapRow<'a>>,
    work: u64,
    fine: bool,
}

#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
struct CountRow {
    kind: String,
    made: usize,
    cut: usize,
    #[serde(rename = "leftOut")]
    skipped: usize,
}

#[derive(Serialize)]
struct StabilityRunRow<'a> {
    kind: String,
    setting: Vec<ActionRow<'a>>,
    covered: f64,
    cut: bool,
    wrong: Vec<String>,
}

/// An action of a student: a control changed, or a button pressed.
#[derive(Serialize)]
struct ActionRow<'a> {
    control: &'a str,
    time: f64,
    value: Option<Value>,
}

#[derive(Serialize)]
struct FaultRow<'a> {
    kind: String,
    time: f64,
    who: &'a str,
    cause: &'a str,
    evidence: Vec<EvidenceRow>,
    setting: Vec<ActionRow<'a>>,
}

#[derive(Serialize)]
struct EvidenceRow {
    name: &'static str,
    value: f64,
    #[serde(skip_serializing_if = "NonFinite::is_empty")]
    nonfinite: NonFinite,
    unit: &'static str,
}

#[derive(Serialize)]
struct StabilityFindingRow<'a> {
    #[serde(flatten)]
    fault: FaultRow<'a>,
    touched: bool,
    settings: usize,
    expected: bool,
    remedies: Vec<Map<String, Value>>,
    worst: Option<FaultRow<'a>>,
}

/// A remedy: its cost relative to that of the unchanged lab, and its error as a share of a range.
#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
struct RemedyRow<'a> {
    change: &'a str,
    work: f64,
    time_ratio: f64,
    error: Option<f64>,
}

/// How far a parameter can be raised, in its unit.
#[derive(Serialize)]
struct MarginRow<'a> {
    knob: String,
    who: &'a str,
    unit: &'static str,
    #[serde(rename = "now")]
    current: f64,
    largest: Option<f64>,
    breaks: Option<f64>,
    how: Option<BreakRow<'a>>,
    bound: Option<f64>,
    runs: usize,
    geoms: &'a [usize],
}

#[derive(Serialize)]
struct BreakRow<'a> {
    kind: String,
    who: &'a str,
}

#[derive(Serialize)]
struct SensitivityRow<'a> {
    length: f64,
    #[serde(rename = "apart")]
    distance: f64,
    parting: Option<Map<String, Value>>,
    exponent: Option<ExponentRow>,
    horizons: Vec<HorizonRow<'a>>,
}

#[derive(Serialize)]
struct PartingRow {
    low: f64,
    high: f64,
}

/// Lyapunov exponents in 1/s.
#[derive(Serialize)]
struct ExponentRow {
    mean: f64,
    low: f64,
    high: f64,
    directions: usize,
}

#[derive(Serialize)]
struct HorizonRow<'a> {
    label: &'a str,
    until: Option<f64>,
}

#[derive(Serialize)]
struct MapRow<'a> {
    controls: &'a [String; 2],
    values: Vec<Vec<Value>>,
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
        who: &fault.subject,
        cause: &fault.cause,
        evidence: evidence.collect(),
        setting: actions(interaction, programs),
    }
}

fn margin_row(m: &Margin) -> MarginRow<'_> {
    MarginRow {
        knob: key(m.knob.description()),
        who: &m.subject,
        unit: m.unit,
        current: m.current,
        largest: m.largest,
        breaks: m.breaks,
        how: m.how.as_ref().map(|(kind, subject)| BreakRow { kind: key(kind.description()), who: subject }),
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
        parting: s.parting.map(|DivergenceOfStarts { low, high }| {
            with_nonfinite(&PartingRow { low, high }, &[("low", &low), ("high", &high)])
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
        MapCell::Fine => "fine".to_string(),
        MapCell::Broken(kind) => key(kind.description()),
        MapCell::Unknown => "unknown".to_string(),
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
