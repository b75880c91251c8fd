use crate::check::observations::ObservedLab;
use crate::check::setconst::digits;
use crate::json::Number;
use crate::printable::counted;
use crate::run::Cell;
use labspec_core::reflect::data;
use labspec_finding::{Example, Finding, Layer, Rule, Severity};

/// A lab stops before anything that it shows changes, or before its curves are more than a dot.
pub const STOPS_EARLY: &Rule = &Rule {
    code: "stops-early",
    severity: Severity::Warning,
    exceptions: &[],
    layer: Layer::Run,
    summary: "a lab stops before anything that it shows changes, or before its curves are more than a dot",
    why: "a student presses play, and almost nothing happens: one step, or a fiftieth of a plot",
    bad: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><geom name='floor' type='plane' size='1 1 1'/><body name='ball' pos='0 0 1'><freejoint/><geom name='ball' size='.05' mass='1'/></body></worldbody></mujoco>", "stopAt": ⟦0.004⟧, "readouts": [{"label": "height (m)", "expr": "data.qpos[2]"}]}"#,
    ),
    good: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><geom name='floor' type='plane' size='1 1 1'/><body name='ball' pos='0 0 1'><freejoint/><geom name='ball' size='.05' mass='1'/></body></worldbody></mujoco>", "stopAt": 0.4, "readouts": [{"label": "height (m)", "expr": "data.qpos[2]"}]}"#,
    ),
};

/// A lab that runs for this many steps is not reported.
const MIN_STEPS: usize = 50;
/// The length of the longer run, s.
const LONGER_RUN: f64 = 2.0;
/// A run shorter than this fraction of a plot's width is visible only as a dot.
const DOT_FRACTION: f64 = 0.02;
/// The fraction of its range by which a curve must change to count as moving.
const VISIBLE_FRACTION: f64 = 0.02;

pub(crate) fn check_early_stop(observed: &mut ObservedLab<'_>, findings: &mut Vec<Finding>) {
    let ready = observed.bench.ready;
    let Some(stop) = &ready.lab.stop_at else { return };
    let Some((steps, timestep)) = observed.bench.steps(observed.length) else { return };
    if stop.value > 0.0 && stop.value < (1.0 - 1e-9) * timestep {
        findings.push(stops_after_first_step(stop, timestep));
        return;
    }
    if steps >= MIN_STEPS || steps == 0 {
        return;
    }
    let Some(all) = observed.bench.steps(LONGER_RUN).and_then(|(n, _)| observed.bench.run(&[], n)) else {
        return;
    };
    let Some(start) = all.rows.first() else { return };
    let Some((time, what)) =
        (1..start.len()).filter_map(|c| first(observed, &all.rows, c)).min_by(|a, b| a.0.total_cmp(&b.0))
    else {
        return;
    };
    // A display that changes before the lab stops is visible.
    let seen = observed.records.iter().any(|r| {
        (1..start.len()).any(|c| match (all_range(&all.rows, c), r.rows.first(), r.rows.last()) {
            (Some(range), Some(a), Some(b)) => changed(observed, c, range, a.get(c), b.get(c)),
            _ => false,
        })
    });
    let windows = ready.lab.plots.iter().filter(|p| !p.traces.is_empty()).map(|p| p.window());
    let shortest = windows.filter(|w| w.is_finite()).fold(f64::INFINITY, f64::min);
    let run = steps as f64 * timestep;
    if seen && shortest.is_finite() && run < DOT_FRACTION * shortest {
        let [run, shortest] = [run, shortest].map(|x| digits(x, 3));
        findings.push(
            Finding::warning(STOPS_EARLY, stop.span.clone(), "the lab stops when its curves have barely begun")
                .why(format!("it runs for {run} s, but its shortest plot is {shortest} s wide: a student sees a dot at the edge"))
                .help("make `stopAt` larger, or the `window` of the plot smaller"),
        );
        return;
    }
    if seen || time <= stop.value {
        return;
    }
    findings.push(stops_before_change(stop, steps, timestep, &what, time));
}

fn stops_after_first_step(stop: &Number, timestep: f64) -> Finding {
    Finding::warning(STOPS_EARLY, stop.span.clone(), "the lab stops after its first step")
        .why(format!("`stopAt` is {} s, and one step takes {} s", digits(stop.value, 4), digits(timestep, 4)))
        .help("make `stopAt` larger; for a single intended step, write the length of a step")
}

/// Reports that `what` changes first in a longer run, at this time.
fn stops_before_change(stop: &Number, steps: usize, timestep: f64, what: &str, time: f64) -> Finding {
    let message = "the lab stops before anything that it shows changes";
    Finding::warning(STOPS_EARLY, stop.span.clone(), message)
        .why(format!(
            "it runs for {} of {} s; in a longer run, the first thing that changes is {what}, at t = {} s",
            counted(steps, "step"),
            digits(timestep, 4),
            digits(time, 3)
        ))
        .help("make `stopAt` larger, or delete it")
}

/// Whether a column reads only the time.
fn clock(observed: &ObservedLab<'_>, c: usize) -> bool {
    let probe = c.checked_sub(1).and_then(|i| observed.bench.ready.programs.probes.get(i));
    let Some(effects) = probe.and_then(|p| p.bound.as_ref()).map(|b| b.program.effects()) else {
        return true;
    };
    !effects.reads_everything
        && effects.ctx_reads.is_empty()
        && effects.reads.iter().all(|a| a.field.0 as usize == data::time.index())
}

/// The range of a column. `None` if it is not a number, or reads only the time.
fn all_range(rows: &[Vec<Cell>], c: usize) -> Option<f64> {
    let numbers = rows.iter().filter_map(|r| r.get(c)).map(Cell::number).filter(|x| x.is_finite());
    let (low, high) = numbers.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), x| (l.min(x), h.max(x)));
    (high > low).then_some(high - low)
}

/// Whether a change of a column is visible.
fn changed(observed: &ObservedLab<'_>, c: usize, range: f64, a: Option<&Cell>, b: Option<&Cell>) -> bool {
    let (Some(a), Some(b)) = (a, b) else { return false };
    if clock(observed, c) {
        return false;
    }
    let lab = observed.bench.ready.lab;
    match c.checked_sub(1 + lab.traces().count()).and_then(|i| lab.readouts.get(i)) {
        Some(readout) => a.rounded(readout.digits()) != b.rounded(readout.digits()),
        None => (a.number() - b.number()).abs() > VISIBLE_FRACTION * range,
    }
}

/// The time of the first change of a column, and the name of the column.
fn first(observed: &ObservedLab<'_>, rows: &[Vec<Cell>], c: usize) -> Option<(f64, String)> {
    let range = all_range(rows, c)?;
    let start = rows.first()?.get(c);
    let row = rows.iter().find(|r| changed(observed, c, range, start, r.get(c)))?;
    let name =
        observed.bench.ready.programs.probes.get(c - 1)?.name.splitn(3, '/').last().unwrap_or("").to_string();
    Some((row.first()?.number(), format!("\"{name}\"")))
}
