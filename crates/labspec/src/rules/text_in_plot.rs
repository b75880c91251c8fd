use crate::check::lab_runs::{WatchedDisplay, moment};
use labspec_expr::Value;
use labspec_finding::{Example, Finding, Layer, Rule, Severity};

/// A trace of a plot is a string.
pub const TEXT_IN_PLOT: &Rule = &Rule {
    code: "text-in-plot",
    severity: Severity::Warning,
    exceptions: &[],
    layer: Layer::Run,
    summary: "a trace of a plot is a string",
    why: "a plot draws numbers: the curve is missing, or shows what the page makes of the string",
    bad: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><geom name='floor' type='plane' size='1 1 1'/><body name='ball' pos='0 0 1'><freejoint/><geom name='ball' size='.05' mass='1'/></body></worldbody></mujoco>", "plots": [{"traces": [{"label": "height", "expr": "⟦data.qpos[2].toFixed(2)⟧"}]}]}"#,
    ),
    good: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><geom name='floor' type='plane' size='1 1 1'/><body name='ball' pos='0 0 1'><freejoint/><geom name='ball' size='.05' mass='1'/></body></worldbody></mujoco>", "plots": [{"traces": [{"label": "height", "expr": "data.qpos[2]"}]}]}"#,
    ),
};

/// Reports a trace whose value is a string.
pub(crate) fn check_cell(display: &WatchedDisplay<'_>, value: &Value, t: f64, done: &str) -> Option<Finding> {
    (display.trace && matches!(value, Value::String(_))).then(|| {
        let (name, moment) = (&display.name, moment(t, done));
        let message = format!("{name} is a string, \"{}\" ({moment})", shortened(value));
        Finding::warning(TEXT_IN_PLOT, display.bound.text.span(), message)
            .why("a plot draws numbers: the curve is missing, or shows what the page makes of the string")
            .help("remove what makes it a string, such as `.toFixed(…)`, or display it as a readout")
    })
}

/// The first words of a text.
fn shortened(value: &Value) -> String {
    let text = value.to_string();
    let short: String = text.chars().take(30).collect();
    if short.len() < text.len() { format!("{short}…") } else { short }
}
