use crate::check::lab_runs::{WatchedDisplay, moment};
use labspec_expr::Value;
use labspec_finding::{Example, Finding, Layer, Rule, Severity};

/// A trace or a readout shows inf.
pub const SHOWS_INFINITE: &Rule = &Rule {
    code: "shows-infinite",
    severity: Severity::Warning,
    exceptions: &[],
    layer: Layer::Run,
    summary: "a trace or a readout shows inf",
    why: "the expression divides by 0",
    bad: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><geom name='floor' type='plane' size='1 1 1'/><body name='ball' pos='0 0 1'><freejoint/><geom name='ball' size='.05' mass='1'/></body></worldbody></mujoco>", "readouts": [{"label": "shown", "expr": "⟦1 / (data.time - data.time)⟧"}]}"#,
    ),
    good: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><geom name='floor' type='plane' size='1 1 1'/><body name='ball' pos='0 0 1'><freejoint/><geom name='ball' size='.05' mass='1'/></body></worldbody></mujoco>", "readouts": [{"label": "shown", "expr": "1 / (data.time + 1)"}]}"#,
    ),
};

/// Reports a display with an infinite value that its text does not announce.
pub(crate) fn check_cell(display: &WatchedDisplay<'_>, value: &Value, t: f64, done: &str) -> Option<Finding> {
    let Value::Number(x) = value else { return None };
    (x.is_infinite() && !display.says_infinite).then(|| {
        let inf = if *x > 0.0 { "inf" } else { "-inf" };
        let message = format!("{} shows {inf} ({})", display.name, moment(t, done));
        Finding::warning(SHOWS_INFINITE, display.bound.text.span(), message)
            .why(display.consequence())
            .help("guard the division by 0 with a condition, or write `NaN` for an intended gap")
    })
}
