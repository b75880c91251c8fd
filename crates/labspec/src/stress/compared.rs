//! The runs of a lab that compares integrators, and all of them as one lab with one table: a curve for each integrator.

use super::watched_run;
use crate::bind::Programs;
use crate::run::{Breakdown, Cell, RunError, RunOptions, Table, final_values, rounded};
use crate::source::Text;
use crate::spec::{ENERGY_DRIFT, Lab, Plot, Readout, Trace};
use labspec_core::Model;

/// The run of a lab with one of the integrators that it compares.
#[derive(Clone, Debug)]
pub struct ComparedRun {
    /// The integrator.
    pub name: &'static str,
    /// Its samples.
    pub table: Table,
}

/// The runs of all integrators that a lab compares; `None` for another lab, or if the options set the integrator.
///
/// # Errors
/// A run does not start.
pub fn compared_runs(
    lab: &Lab,
    model: &Model,
    programs: &Programs,
    options: &RunOptions,
) -> Result<Option<Vec<ComparedRun>>, RunError> {
    let Some(comparison) = &lab.comparison else { return Ok(None) };
    let Some(control) = lab.controls.get(comparison.control) else { return Ok(None) };
    let label = &control.label.value;
    if options.set.iter().any(|(set, _)| set == label) {
        return Ok(None);
    }
    let run = |name: &&'static str| {
        let mut options = options.clone();
        options.set.push((label.clone(), (*name).into()));
        Ok(ComparedRun { name, table: watched_run(lab, model, programs, &options)? })
    };
    comparison.integrators.iter().map(run).collect::<Result<Vec<_>, _>>().map(Some)
}

/// The lab whose traces and readouts are those of all runs, and the table of its samples.
pub fn join_runs(lab: &Lab, runs: &[ComparedRun]) -> (Lab, Table) {
    let plots = lab.plots.iter().map(|plot| Plot { traces: joined_traces(plot, runs), ..plot.clone() });
    let readouts = lab.readouts.iter().flat_map(|readout| {
        let one = |run: &ComparedRun| {
            let label = relabelled(&readout.label, &format!("{}, {}", readout.label.value, run.name));
            Readout { label, ..readout.clone() }
        };
        runs.iter().map(one)
    });
    let joined = Lab { plots: plots.collect(), readouts: readouts.collect(), ..lab.clone() };
    let table = join_tables(&joined, runs);
    (joined, table)
}

/// A row of the table of a comparison: the values of all runs.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ComparisonRow<'a> {
    /// What the values are: the largest energy drift, a trace or a readout.
    pub label: &'a str,
    /// A value for each run, at its end.
    pub values: Vec<String>,
    /// Whether it is a trace, whose curves show more.
    pub is_trace: bool,
}

/// The table of a comparison: the largest energy drift, then the last value of each trace and each readout.
pub fn comparison_rows<'a>(lab: &Lab, runs: &'a [ComparedRun]) -> Vec<ComparisonRow<'a>> {
    let drifts = runs.iter().map(|run| rounded(largest_drift(run), DRIFT_DIGITS)).collect();
    let mut rows = vec![ComparisonRow { label: "largest energy drift", values: drifts, is_trace: false }];
    for (i, run) in runs.iter().enumerate() {
        for (k, last) in final_values(lab, &run.table).into_iter().enumerate() {
            if i == 0 {
                rows.push(ComparisonRow { label: last.label, values: Vec::new(), is_trace: last.is_trace });
            }
            if let Some(row) = rows.get_mut(k + 1) {
                row.values.push(last.value);
            }
        }
    }
    rows
}

/// Number of decimals of an energy drift.
const DRIFT_DIGITS: u32 = 4;

/// The largest drift of the energy in a run; NaN if it has no number.
fn largest_drift(run: &ComparedRun) -> f64 {
    let name = format!("plot/0/{ENERGY_DRIFT}");
    let Some(column) = run.table.columns.iter().position(|column| *column == name) else { return f64::NAN };
    let values = run.table.rows.iter().filter_map(|row| row.get(column)).map(Cell::number);
    values.map(f64::abs).filter(|x| !x.is_nan()).fold(f64::NAN, f64::max)
}

/// The traces of a plot, one for each run: named after the integrator, and after the trace where there are several.
fn joined_traces(plot: &Plot, runs: &[ComparedRun]) -> Vec<Trace> {
    let is_single = plot.traces.len() == 1;
    let of_trace = |trace: &Trace| {
        let one = |run: &ComparedRun| {
            let label = match is_single {
                true => run.name.to_string(),
                false => format!("{}, {}", trace.label.value, run.name),
            };
            Trace { label: relabelled(&trace.label, &label), ..trace.clone() }
        };
        runs.iter().map(one).collect::<Vec<_>>()
    };
    plot.traces.iter().flat_map(of_trace).collect()
}

fn relabelled(label: &Text, value: &str) -> Text {
    Text::derived(value.to_string(), label.span())
}

fn join_tables(joined: &Lab, runs: &[ComparedRun]) -> Table {
    let traces = joined.plots.iter().enumerate();
    let traces = traces
        .flat_map(|(i, plot)| plot.traces.iter().map(move |trace| format!("plot/{i}/{}", trace.label.value)));
    let readouts = joined.readouts.iter().map(|readout| format!("readout/{}", readout.label.value));
    let columns = std::iter::once("time".to_string()).chain(traces).chain(readouts).collect();
    let times = sample_times(runs);
    let row = |(i, time): (usize, &f64)| {
        // All columns of a probe follow each other, in the order of the runs.
        let probes = runs.iter().map(|run| run.table.columns.len()).min().unwrap_or(1);
        let cell = |probe: usize, run: &ComparedRun| match run.table.rows.get(i) {
            Some(row) if row.first().map(Cell::number) == Some(*time) => {
                row.get(probe).cloned().unwrap_or(Cell::Nothing)
            }
            _ => Cell::Nothing,
        };
        let cells = (1..probes).flat_map(|probe| runs.iter().map(move |run| cell(probe, run)));
        std::iter::once(Cell::Number(*time)).chain(cells).collect()
    };
    Table {
        timestep: runs.first().map_or(f64::NAN, |run| run.table.timestep),
        columns,
        rows: times.iter().enumerate().map(row).collect(),
        warnings: total_warnings(runs),
        breakdowns: shared_breakdowns(runs),
        errors: runs
            .iter()
            .flat_map(|run| run.table.errors.iter().map(|error| format!("{}: {error}", run.name)))
            .collect(),
    }
}

/// The times of the samples: those of the longest run in which time never goes back. An integrator that breaks is reset to
/// time 0, and has no values after that.
fn sample_times(runs: &[ComparedRun]) -> Vec<f64> {
    let times = |run: &ComparedRun| {
        let all = run.table.rows.iter().map(|row| row.first().map_or(f64::NAN, Cell::number));
        let mut last = f64::NEG_INFINITY;
        let advances = |time: &f64| std::mem::replace(&mut last, *time) < *time;
        all.take_while(advances).collect::<Vec<_>>()
    };
    runs.iter().map(times).max_by_key(Vec::len).unwrap_or_default()
}

fn total_warnings(runs: &[ComparedRun]) -> Vec<(&'static str, usize)> {
    let mut all: Vec<(&'static str, usize)> = Vec::new();
    for (name, number) in runs.iter().flat_map(|run| &run.table.warnings) {
        match all.iter_mut().find(|(other, _)| other == name) {
            Some((_, total)) => *total += number,
            None => all.push((*name, *number)),
        }
    }
    all
}

/// The breakdowns of all runs, each kind once, with the integrators that have it.
fn shared_breakdowns(runs: &[ComparedRun]) -> Vec<Breakdown> {
    let mut all: Vec<(Vec<&str>, &Breakdown)> = Vec::new();
    for run in runs {
        for breakdown in &run.table.breakdowns {
            match all.iter_mut().find(|(_, other)| other.rule.code == breakdown.rule.code) {
                Some((names, _)) if names.contains(&run.name) => {}
                Some((names, _)) => names.push(run.name),
                None => all.push((vec![run.name], breakdown)),
            }
        }
    }
    let named = |(names, breakdown): (Vec<&str>, &Breakdown)| Breakdown {
        what: format!("{}: {}", names.join(", "), breakdown.what),
        ..breakdown.clone()
    };
    all.into_iter().map(named).collect()
}

#[cfg(test)]
#[allow(clippy::panic)] // a panic is the report of a failed test
mod tests {
    use super::*;
    use crate::source::SourceFile;
    use crate::spec::read_lesson;

    /// A run that ended before its first sample has no numbers, and its column of the table stays.
    #[test]
    fn a_run_without_samples_keeps_its_column() {
        let table = |rows: Vec<Vec<Cell>>| Table {
            timestep: 0.002,
            columns: ["time", "plot/0/energy drift", "readout/height"].map(String::from).to_vec(),
            rows,
            warnings: Vec::new(),
            breakdowns: Vec::new(),
            errors: Vec::new(),
        };
        let sampled = table(vec![[0.0, 0.5, 2.0].map(Cell::Number).to_vec()]);
        let lesson = read_lesson(SourceFile::new("lab.json", r#"{"model": "ball"}"#));
        let Some(lab) = lesson.labs.first().and_then(|entry| entry.lab.as_ref()) else { panic!("no lab") };
        for order in [[0, 1], [1, 0]] {
            let runs = order.map(|i| match i {
                0 => ComparedRun { name: "Euler", table: sampled.clone() },
                _ => ComparedRun { name: "RK4", table: table(Vec::new()) },
            });
            let rows = comparison_rows(lab, &runs);
            let labels: Vec<&str> = rows.iter().map(|row| row.label).collect();
            assert_eq!(labels, ["largest energy drift", "energy drift", "height"]);
            let number = |i: usize| if order[i] == 0 { "2.0000" } else { "nan" };
            assert_eq!(rows[2].values, [number(0), number(1)]);
        }
    }
}
