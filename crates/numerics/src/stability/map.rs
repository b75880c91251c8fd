//! The stable region over two controls, from a grid of runs.

use labspec::bind::scalar;
use labspec::interrupt;
use labspec::run::{RunError, settings};
use labspec::spec::ControlKind;
use labspec::stress::{Action, FaultKind, InteractionKind, StressCase};
use labspec_expr::Value;

/// The number of values of a slider, and the maximum for a select.
const VALUES: usize = 21;
const MOST: usize = 60;
/// The work limit for all runs of a map.
const WORK: u64 = 40_000_000_000;

/// The outcome of the run at a cell.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MapCell {
    /// No fault.
    Fine,
    /// The worst fault.
    Broken(FaultKind),
    /// The run was not performed, or not completed.
    Unknown,
}

/// The stable region over two controls.
#[derive(Clone, Debug, PartialEq)]
pub struct StabilityMap {
    /// The labels: horizontal, and vertical.
    pub labels: [String; 2],
    /// The values of the two controls.
    pub values: [Vec<Value>; 2],
    /// A row for each value of the second control, with a cell for each value of the first.
    pub cells: Vec<Vec<MapCell>>,
}

/// Runs the lab at every cell. The work is added to `work`.
///
/// # Errors
/// A control does not exist, or has no values to choose from.
pub(super) fn map(
    case: &StressCase<'_>,
    labels: &[String; 2],
    length: f64,
    report_progress: &mut dyn FnMut(&str),
    work: &mut u64,
) -> Result<StabilityMap, RunError> {
    let [(x, across), (y, up)] = [values(case, &labels[0])?, values(case, &labels[1])?];
    let many = across.len() * up.len();
    let (mut left, mut made) = (WORK, 0);
    let mut cells = Vec::new();
    for b in &up {
        let mut row = Vec::new();
        for a in &across {
            report_progress(&format!("map: run {} of {many}", made + 1));
            let set =
                |control: usize, value: &Value| Action { time: 0.0, control, value: Some(value.clone()) };
            let interaction = case.base.and(InteractionKind::Corner, vec![set(x, a), set(y, b)]);
            if interrupt::requested() {
                row.push(MapCell::Unknown);
                continue;
            }
            let outcome = case.run(&interaction, None, length, left / (many - made).max(1) as u64);
            made += 1;
            left = left.saturating_sub(outcome.spent);
            *work += outcome.spent;
            let worst = outcome.faults.iter().map(|f| f.kind).min();
            row.push(match worst {
                Some(kind) => MapCell::Broken(kind),
                None if outcome.cut => MapCell::Unknown,
                None => MapCell::Fine,
            });
        }
        cells.push(row);
    }
    Ok(StabilityMap { labels: labels.clone(), values: [across, up], cells })
}

/// A control and the values of a map; those of a slider are evenly spaced on its grid.
fn values(case: &StressCase<'_>, label: &str) -> Result<(usize, Vec<Value>), RunError> {
    let found = case.lab.controls.iter().position(|c| c.label.value == label);
    let Some((i, control)) = found.and_then(|i| Some((i, case.lab.controls.get(i)?))) else {
        return Err(settings::unknown_control(label, case.programs));
    };
    let list = match &control.kind {
        ControlKind::Slider { min, max, .. } => {
            let (min, max) = (min.value, max.value);
            let step = control.step().filter(|s| *s > 0.0).unwrap_or((max - min) / 100.0);
            let most = ((max - min) / step + 1e-9).floor();
            if !(most.is_finite() && most >= 0.0) {
                return Err(RunError::new(format!("\"{label}\" has no values to choose from")));
            }
            let places = (0..VALUES).map(|k| (most * k as f64 / (VALUES - 1) as f64).round());
            let mut list: Vec<f64> =
                places.map(|k| format!("{:.11e}", min + k * step).parse().unwrap_or(max)).collect();
            list.dedup();
            list.into_iter().map(Value::Number).collect()
        }
        ControlKind::Select { options, .. } => options.iter().take(MOST).map(|o| scalar(&o.value)).collect(),
        ControlKind::Button { .. } => {
            return Err(RunError::new(format!("\"{label}\" is a button: a map needs sliders and selects")));
        }
    };
    Ok((i, list))
}
