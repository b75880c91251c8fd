use crate::check::observations::{ObservedLab, Record};
use crate::check::setconst::digits;
use crate::run::Cell;
use crate::spec::{Plot, Trace};
use labspec_finding::{Example, Finding, Layer, Rule, Severity};

/// A trace is outside its plot most of the time, in every run.
pub const OUTSIDE_PLOT: &Rule = &Rule {
    code: "outside-plot",
    severity: Severity::Warning,
    exceptions: &[],
    layer: Layer::Run,
    summary: "a trace is outside its plot most of the time, in every run",
    why: "`ymin` and `ymax` are the ends of the axis: the page does not draw what is above or below",
    bad: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><geom name='floor' type='plane' size='1 1 1'/><body name='ball' pos='0 0 1'><freejoint/><geom name='ball' size='.05' mass='1'/></body></worldbody></mujoco>", "plots": [{"window": 1, "ymin": 0, "ymax": 1.1, "traces": [{"label": "height (mm)", "expr": "⟦1000 * data.qpos[2]⟧"}]}]}"#,
    ),
    good: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><geom name='floor' type='plane' size='1 1 1'/><body name='ball' pos='0 0 1'><freejoint/><geom name='ball' size='.05' mass='1'/></body></worldbody></mujoco>", "plots": [{"window": 1, "ymin": 0, "ymax": 1.1, "traces": [{"label": "height (m)", "expr": "data.qpos[2]"}]}]}"#,
    ),
};

/// A curve that is inside its plot for less than this fraction of the time is reported.
const INSIDE: f64 = 0.5;

/// Reports a curve that is outside its plot for most of the time, in every run.
pub(crate) fn check_trace_range(
    observed: &ObservedLab<'_>,
    plot: &Plot,
    c: usize,
    trace: &Trace,
) -> Option<Finding> {
    // A limit at only one end may be intended to crop the curve.
    let (low, high) = (plot.ymin.as_ref()?.value, plot.ymax.as_ref()?.value);
    if low >= high {
        return None;
    }
    let share = |record: &Record| {
        let all: Vec<f64> =
            record.rows.iter().filter_map(|r| r.get(c)).map(Cell::number).filter(|x| x.is_finite()).collect();
        let inside = all.iter().filter(|x| (low..=high).contains(*x)).count();
        (!all.is_empty()).then(|| inside as f64 / all.len() as f64)
    };
    let first = observed.records.first()?;
    let most = observed.records.iter().filter_map(share).fold(0.0, f64::max);
    let nominal_share = share(first)?;
    if nominal_share >= INSIDE || most >= INSIDE {
        return None;
    }
    let cells = first.rows.iter().filter_map(|r| r.get(c)).map(Cell::number).filter(|x| x.is_finite());
    let (least, largest) = cells.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), x| (l.min(x), h.max(x)));
    let [least, largest] = [least, largest].map(|x| digits(x, 4));
    let message = format!("this curve is outside its plot, which goes from {low} to {high}");
    Some(
        Finding::warning(OUTSIDE_PLOT, trace.expr.span(), message)
            .why(format!(
                "in the run of the lab as it stands, it goes from {least} to {largest} and is inside for {} of the time; in {}, it is inside for at most {} of the time",
                percent(nominal_share),
                observed.runs(),
                percent(most)
            ))
            .help("widen `ymin` and `ymax` to include the curve, or delete them: the plot then follows it"),
    )
}

/// A share in percent. One that is not zero is not printed as 0 %.
fn percent(share: f64) -> String {
    match 100.0 * share {
        x if x > 0.0 && x < 0.5 => "less than 1 %".to_string(),
        x => format!("{x:.0} %"),
    }
}
