use super::Check;
use crate::spec::Lab;
use labspec_finding::{Example, Finding, Layer, Rule, Severity};

/// The window of a plot is so short that its curve has only a few points.
pub const SHORT_WINDOW: &Rule = &Rule {
    code: "short-window",
    severity: Severity::Warning,
    exceptions: &[],
    layer: Layer::Structure,
    summary: "the window of a plot is so short that its curve has only a few points",
    why: "a page samples once per drawn frame",
    bad: Example::Lab(
        r#"{"model": "ball", "plots": [{"window": ⟦0.005⟧, "traces": [{"label": "height", "expr": "data.qpos[2]"}]}]}"#,
    ),
    good: Example::Lab(
        r#"{"model": "ball", "plots": [{"window": 0.5, "traces": [{"label": "height", "expr": "data.qpos[2]"}]}]}"#,
    ),
};

pub(super) const CHECK: Check = Check::Lab(check_lab);

/// The maximum number of frames per second of a page.
const FRAMES: f64 = 60.0;
/// Curves with fewer points are reported.
const POINTS: f64 = 10.0;

fn check_lab(lab: &Lab, findings: &mut Vec<Finding>) {
    let slowest = lab.speeds().into_iter().filter(|s| *s > 0.0).fold(f64::INFINITY, f64::min);
    for window in lab.plots.iter().filter_map(|p| p.window.as_ref()) {
        let points = window.value * FRAMES / slowest;
        if window.value > 0.0 && points < POINTS {
            let message =
                format!("this plot shows {} s, so a page draws at most {points:.0} points", window.value);
            findings.push(
                Finding::new(SHORT_WINDOW, window.span.clone(), message)
                    .why(format!("a page samples {FRAMES} times per second; at the slowest speed, {slowest}, that is once every {:.4} s", slowest / FRAMES))
                    .help(format!("make the window longer, or offer a slower speed: \"speeds\": [{}, 1]", window.value / 2.0)),
            );
        }
    }
}
