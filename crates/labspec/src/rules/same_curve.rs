//! Traces that always have the same curve. Values that are equal by physics are not a mistake: they differ if the initial state
//! changes.

use crate::check::observations::{ObservedLab, column, same};
use crate::run::Cell;
use crate::spec::Plot;
use labspec_finding::{Example, Finding, Layer, Rule, Severity};
use std::ops::Range;

/// Two traces of a plot are always the same curve.
pub const SAME_CURVE: &Rule = &Rule {
    code: "same-curve",
    severity: Severity::Warning,
    exceptions: &[],
    layer: Layer::Run,
    summary: "two traces of a plot are always the same curve",
    why: "one hides the other: often an expression was copied and not changed. The rule skips curves that agree only because of the physics; those differ when the scene starts from another state",
    bad: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><geom name='floor' type='plane' size='1 1 1'/><body name='ball' pos='0 0 1'><freejoint/><geom name='ball' size='.05' mass='1'/></body></worldbody></mujoco>", "plots": [{"window": 1, "traces": [{"label": "height", "expr": "data.qpos[2]"}, {"label": "depth", "expr": "⟦data.qpos[2]⟧"}]}]}"#,
    ),
    good: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><geom name='floor' type='plane' size='1 1 1'/><body name='ball' pos='0 0 1'><freejoint/><geom name='ball' size='.05' mass='1'/></body></worldbody></mujoco>", "plots": [{"window": 1, "traces": [{"label": "height", "expr": "data.qpos[2]"}, {"label": "sideways", "expr": "data.qpos[0]"}]}]}"#,
    ),
};

/// Finds the first of these curves of a plot that equals this one.
pub(crate) fn check_moving_trace(
    observed: &mut ObservedLab<'_>,
    before: Range<usize>,
    c: usize,
    plot: &Plot,
) -> Option<Finding> {
    let first = before.start;
    let twin = before.into_iter().find(|other| shows_same_curve(observed, *other, c))?;
    let [other, trace] = [plot.traces.get(twin - first)?, plot.traces.get(c - first)?];
    let message = format!("\"{}\" and \"{}\" are the same curve", other.label.value, trace.label.value);
    Some(
        Finding::warning(SAME_CURVE, trace.expr.span(), message)
            .why(format!(
                "they agree to the last bit in {}, and also from other states of the scene",
                observed.runs()
            ))
            .help("change the expression to what the label says, or delete the trace")
            .related(other.expr.span(), "the curve that it covers"),
    )
}

/// Whether two traces read the same fields and are equal in all runs and states.
fn shows_same_curve(observed: &mut ObservedLab<'_>, a: usize, b: usize) -> bool {
    let ready = observed.bench.ready;
    let effects =
        |c: usize| Some(ready.programs.probes.get(c.checked_sub(1)?)?.bound.as_ref()?.program.effects());
    let (Some(one), Some(two)) = (effects(a), effects(b)) else { return false };
    let mut sets = [one, two].map(|e| (e.reads.clone(), e.calls.clone(), e.ctx_reads.clone()));
    sets.iter_mut().for_each(|(reads, calls, slots)| {
        reads.sort();
        calls.sort();
        slots.sort_unstable();
    });
    let equal = |row: &Vec<Cell>| matches!((row.get(a), row.get(b)), (Some(x), Some(y)) if same(x, y));
    let [one, two] = sets;
    one == two
        && column(observed.records, a).any(|c| c.number().is_finite())
        && observed.records.iter().flat_map(|r| &r.rows).all(equal)
        && observed.perturbed_rows().iter().all(equal)
}
