//! The events of a run, and its settings at the start.

use super::text::{code, plain, text};
use crate::check::RunSettings;
use crate::json::Scalar;
use crate::spec::{Run, Sweep, VerifyLab};
use crate::verify::significant;

/// The events of a run, in order. `name` is the name of the run in the report; for a sweep it includes the index of the
/// member.
pub(super) fn done(run: Option<&Run>, name: &str) -> String {
    let Some(run) = run else { return "as the lab stands".into() };
    let mut all = Vec::new();
    match &run.lab {
        Some(VerifyLab::Reference(lab, _) | VerifyLab::Elsewhere(lab, ..)) => {
            all.push(format!("lab {}", text(lab.as_str())))
        }
        Some(VerifyLab::Inline(_)) => all.push("a lab of its own".into()),
        Some(VerifyLab::Broken) | None => {}
    }
    let change = |what: &str, value: &str| format!("{} = {}", text(what), plain(value));
    all.extend(run.model.iter().map(|c| change(c.path.as_str(), &c.value)));
    all.extend(run.key.as_ref().map(|key| format!("keyframe {}", plain(&scalar(key)))));
    all.extend(run.set.iter().map(|(label, value)| change(label.as_str(), &scalar(value))));
    let index = |sweep: &Sweep| if sweep.is_list() { member(run.name.as_str(), name) } else { Some(0) };
    if let Some((sweep, index)) = run.sweep.as_ref().and_then(|sweep| Some((sweep, index(sweep)?))) {
        all.extend(sweep.values(index).map(|(axis, value)| change(axis.what.as_str(), &value.to_string())));
    }
    all.extend(run.setup.as_ref().map(|statements| format!("setup {}", code(statements.as_str()))));
    all.extend(run.controller.as_ref().map(|statements| match statements.as_str().trim() {
        "" => "no controller".to_string(),
        statements => format!("controller {}", code(statements)),
    }));
    let press_at = |(label, t): &(crate::source::Text, crate::json::Number)| {
        format!("{} pressed at {} s", text(label.as_str()), plain(&significant(t.value)))
    };
    all.extend(run.press.iter().map(press_at));
    if all.is_empty() {
        all.push("as the lab stands".into());
    }
    all.extend(run.until.as_ref().map(|t| format!("until {} s", plain(&significant(t.value)))));
    all.extend(run.steps.as_ref().map(|n| format!("{} steps", plain(&n.value.to_string()))));
    all.extend(run.stop.as_ref().map(|stop| format!("stops at {}", code(stop.as_str()))));
    all.join("; ")
}

/// The index of the member of a sweep with this name: `fall[2]`.
fn member(run: &str, name: &str) -> Option<usize> {
    name.strip_prefix(run)?.strip_prefix('[')?.strip_suffix(']')?.parse().ok()
}

fn scalar(value: &Scalar) -> String {
    match value {
        Scalar::Number(n) => n.value.to_string(),
        Scalar::Text(text) => format!("\"{}\"", text.value),
        Scalar::Bool(b, _) => b.to_string(),
    }
}

/// The numerics of a run at its start, in one line.
pub(super) fn numerics(s: &RunSettings) -> String {
    let RunSettings { integrator, solver, cone, iterations, .. } = s;
    let timestep = plain(&significant(s.timestep));
    let tolerance = plain(&format!("{:e}", s.tolerance));
    let mut all = format!(
        "timestep {timestep} s, {integrator}, solver {solver} (at most {iterations} iterations, tolerance {tolerance}), {cone} cone"
    );
    for (name, values) in &s.options {
        let values: Vec<String> = values.iter().map(|x| plain(&significant(*x))).collect();
        all.push_str(&format!(", {} {}", plain(name), values.join(" ")));
    }
    all
}
