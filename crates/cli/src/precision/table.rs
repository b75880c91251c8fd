//! The table of a comparison: a line for each setting, a column for each number, event and conserved quantity.

use labspec::report::printable;
use labspec::run::two_digits;
use labspec::verify::significant;
use labspec_numerics::precision::{
    Beside, Compared, Errors, PrecisionResults, PrecisionRow, RunStatus, milliseconds,
};
use std::fmt::Write;

pub(super) fn setting(row: &PrecisionRow) -> String {
    let solver = row.setting.solver.map_or(String::new(), |s| format!(" {}", s.name()));
    let mark = if row.is_own { " *" } else { "" };
    format!("{}{solver}{mark}", row.setting.integrator.name)
}

/// A column of the table: its meaning, and a cell for each row.
struct TableColumn {
    legend: String,
    cells: Vec<String>,
}

/// The maximum number of columns next to each other.
const MAX_COLUMNS: usize = 5;

/// Writes the largest errors of all compared quantities, with one column each, and marks the settings that
/// are best in cost and error.
pub(super) fn table(report: &PrecisionResults, text: &mut String) {
    let columns = columns(report);
    for (k, column) in columns.iter().enumerate() {
        let _ = writeln!(text, "({}) {}", k + 1, column.legend);
    }
    let names: Vec<String> = report.rows.iter().map(setting).collect();
    let width = names.iter().map(|n| n.chars().count()).max().unwrap_or(0).max(10);
    for (first, some) in columns.chunks(MAX_COLUMNS).enumerate() {
        let heads: String = (0..some.len())
            .map(|k| format!(" {:>10}", format!("({})", first * MAX_COLUMNS + k + 1)))
            .collect();
        let _ = writeln!(
            text,
            "\n  {:<width$} {:>10} {:>12} {:>16}{heads}",
            "", "step", "work, ~µs/s", "time, µs/s"
        );
        for (i, row) in report.rows.iter().enumerate() {
            let h = format!("{} ms", milliseconds(row.setting.timestep));
            let work = two_digits(row.cost.work / 1e3);
            let spread = 50.0 * (row.cost.high - row.cost.low) / row.cost.median;
            let cost = match spread.is_finite() {
                true => format!("{:.0} ±{spread:>2.0}%", row.cost.median),
                false => String::new(),
            };
            let cells: String = match row.status {
                RunStatus::Good | RunStatus::Warned => {
                    some.iter().map(|c| format!(" {:>10}", c.cells[i])).collect()
                }
                other => format!("  {}", other.word()),
            };
            let best = if report.front.contains(&i) { " ‹" } else { "" };
            let _ = writeln!(text, "  {:<width$} {h:>10} {work:>12} {cost:>16}{cells}{best}", names[i]);
        }
    }
    text.push_str(
        "\n* the setting of the lab; ‹ no other is both more accurate and cheaper; ≤ an upper bound: the reference is no more accurate\nwork: of the whole run, per simulated second, as the engine counts it, in units of about a microsecond; it decides\ntime: of that run, on this machine, with the spread of the middle half of its repeats\n",
    );
}

fn columns(report: &PrecisionResults) -> Vec<TableColumn> {
    let mut list: Vec<TableColumn> = Vec::new();
    for (i, target) in report.targets.iter().enumerate().filter(|(_, t)| !t.blank) {
        let cell_of = |row: &PrecisionRow| row.errors.get(i).map_or("–".into(), |e| error(e, target));
        list.push(TableColumn {
            legend: describe_truth(target),
            cells: report.rows.iter().map(cell_of).collect(),
        });
    }
    for (k, event) in report.events.iter().enumerate().filter(|(_, e)| e.time.is_finite()) {
        let legend = format!(
            "{}, at {} s (± {} s): error in s",
            printable(&event.name),
            certain_digits(event.time, event.uncertain),
            cell(event.uncertain)
        );
        let cell_of = |row: &PrecisionRow| {
            error_or_doubt(row.events.get(k).copied().unwrap_or(f64::NAN), event.uncertain)
        };
        list.push(TableColumn { legend, cells: report.rows.iter().map(cell_of).collect() });
    }
    let mut keeps = |size: Option<f64>, what: &str, unit: &str, size_of: fn(&PrecisionRow) -> Option<f64>| {
        if let Some(size) = size {
            let legend = format!(
                "the scene keeps its {what} ({} {unit} move): largest change in {unit}",
                significant(size)
            );
            let change = |r: &PrecisionRow| error_or_doubt(size_of(r).unwrap_or(f64::NAN), ROUNDING * size);
            list.push(TableColumn { legend, cells: report.rows.iter().map(change).collect() });
        }
    };
    keeps(report.energy, "energy", "J", |r| r.energy);
    keeps(report.momentum[0], "momentum", "kg m/s", |r| r.momentum[0]);
    keeps(report.momentum[1], "angular momentum", "kg m²/s", |r| r.momentum[1]);
    if report.penetration > 0.0 {
        let uncertainty = report.penetration_doubt.max(ROUNDING * report.penetration);
        let legend = format!(
            "bodies are {} m (± {} m) in each other: error in m",
            certain_digits(report.penetration, uncertainty),
            cell(uncertainty)
        );
        let cell_of =
            |r: &PrecisionRow| error_or_doubt((r.penetration - report.penetration).abs(), uncertainty);
        list.push(TableColumn { legend, cells: report.rows.iter().map(cell_of).collect() });
    }
    list
}

/// The relative rounding error of a number after a run of many steps.
const ROUNDING: f64 = 1e-13;

fn cell(x: f64) -> String {
    if x.is_finite() { format!("{x:.1e}") } else { "–".into() }
}

/// An error, or the doubt about the truth if that is larger.
fn error_or_doubt(error: f64, uncertainty: f64) -> String {
    if error <= uncertainty { format!("≤{uncertainty:.0e}") } else { cell(error) }
}

/// The error of a number.
fn error(e: &Errors, target: &Compared) -> String {
    if e.below { format!("≤{:.0e}", target.uncertain.max(e.largest)) } else { cell(e.largest) }
}

/// A number with its certain digits and one more.
fn certain_digits(x: f64, uncertainty: f64) -> String {
    if !(uncertainty > 0.0 && uncertainty.is_finite()) {
        return significant(x);
    }
    let decimals = (1.0 - uncertainty.log10().floor()).clamp(0.0, 15.0) as usize;
    format!("{x:.decimals$}")
}

/// The label of a compared number, with its unit.
pub(super) fn named(target: &Compared) -> String {
    let label = printable(&target.label).to_string();
    match &target.unit {
        Some(unit) if !label.contains(unit.as_str()) => format!("{label} ({})", printable(unit)),
        _ => label,
    }
}

/// The truth with which a column of errors was computed, and the smallest visible error.
fn describe_truth(target: &Compared) -> String {
    let unit = target.unit.as_ref().map_or(String::new(), |u| format!(" {}", printable(u)));
    let in_unit = if unit.is_empty() { String::new() } else { format!(" in{unit}") };
    let against = match target.closed {
        true => "the closed form".to_string(),
        false => format!("the reference (± {:.0e}{unit})", target.uncertain),
    };
    let until = target.until.map_or(String::new(), |t| {
        format!("; compared until {} s, because the reference is unknown beyond", significant(t))
    });
    format!(
        "{}: largest error{in_unit} against {against}; {} {}{unit}{until}",
        printable(&target.label),
        if target.readout { "its digits hide" } else { "its plot hides" },
        two_digits(target.invisible_error)
    )
}

/// Writes the runs of another program: the same columns of errors, and the times that it measured.
pub(super) fn write_other_runs(report: &PrecisionResults, beside: &Beside, text: &mut String) {
    let _ = writeln!(text, "\nBeside: {}, largest errors against the same truth", printable(&beside.engine));
    let columns = || report.targets.iter().enumerate().filter(|(_, t)| !t.blank).take(MAX_COLUMNS);
    for row in &beside.rows {
        let cell_of = |(i, target): (usize, &Compared)| {
            format!(" {:>10}", row.errors.get(i).map_or("–".into(), |e| error(e, target)))
        };
        let cells: String = columns().map(cell_of).collect();
        let h = format!("{} ms", milliseconds(row.timestep));
        let _ = writeln!(text, "  {:<12} {h:>10} {:>29.0}{cells}", printable(&row.integrator), row.cost);
    }
    text.push('\n');
}
