use super::Check;
use super::claims;
use crate::json::{encode, nearest, read::named};
use crate::source::Text;
use crate::spec::{ControlKind, Lab, Lesson};
use labspec_finding::{Example, Finding, Layer, Rule, Severity};

/// A run sets or presses a control that the lab does not have.
pub const UNKNOWN_CONTROL: &Rule = &Rule {
    code: "unknown-control",
    severity: Severity::Error,
    exceptions: &[],
    layer: Layer::Structure,
    summary: "a run sets or presses a control that the lab does not have",
    why: "the run is not the one that the text describes",
    bad: Example::Lab(
        r#"{"model": "ball", "note": "It rests at 0.10 m.", "controls": [{"label": "friction", "set": "model.geom_friction[0]", "min": 1, "max": 2, "value": 1}], "verify": {"runs": {"heavy": {"set": {"⟦fricton⟧": 2}}}, "says": [["0.10 m", "final(data.qpos[2])"]]}}"#,
    ),
    good: Example::Lab(
        r#"{"model": "ball", "note": "It rests at 0.10 m.", "controls": [{"label": "friction", "set": "model.geom_friction[0]", "min": 1, "max": 2, "value": 1}], "verify": {"runs": {"heavy": {"set": {"friction": 2}, "until": 2}}, "says": [["0.10 m", "final(data.qpos[2])"]]}}"#,
    ),
};

pub(super) const CHECK: Check = Check::Lesson(check_lesson);

/// A hostile object can set thousands of controls; only the first mistakes are reported.
const MAX_FINDINGS: usize = 50;
const MAX_CONTROLS: usize = 200;

fn check_lesson(lesson: &Lesson, findings: &mut Vec<Finding>) {
    for claim in claims::all(lesson) {
        let labels = claim.verify.runs.iter().filter_map(|run| Some((run, claim.lab_of(run, lesson)?)));
        let labels = labels.flat_map(|(run, lab)| {
            let set = run.set.iter().take(MAX_CONTROLS).map(move |(label, _)| (label, lab, false));
            set.chain(run.press.iter().take(MAX_CONTROLS).map(move |(label, _)| (label, lab, true)))
        });
        findings
            .extend(labels.filter_map(|(label, lab, press)| missing(label, lab, press)).take(MAX_FINDINGS));
    }
}

/// Reports a label that names no control of the lab that can be set, or pressed.
fn missing(label: &Text, lab: &Lab, press: bool) -> Option<Finding> {
    let fits = |kind: &ControlKind| matches!(kind, ControlKind::Button { .. }) == press;
    // A control that could not be parsed may be the intended one.
    if lab.unread_controls || lab.control(label.as_str()).is_some_and(|c| fits(&c.kind)) {
        return None;
    }
    let what = if press { "button" } else { "slider or select" };
    if let Some(control) = lab.control(label.as_str()) {
        return Some(wrong_kind(label, &control.kind));
    }
    let labels: Vec<&str> =
        lab.controls.iter().filter(|c| fits(&c.kind)).map(|c| c.label.as_str()).take(MAX_CONTROLS).collect();
    let message = format!("the lab has no {what} {}", named(label.as_str()));
    let found = Finding::new(UNKNOWN_CONTROL, label.span(), message);
    Some(match nearest(label.as_str(), labels.iter().copied()) {
        Some(right) => found.help(format!("did you mean `{right}`?")).guess(label.span(), encode(right)),
        None if labels.is_empty() => found.help(format!("remove it: the lab has no {what}")),
        None => found.help(format!("use one of: {}", labels.join(", "))),
    })
}

/// Reports a button that a run sets, or a slider or select that it presses.
fn wrong_kind(label: &Text, kind: &ControlKind) -> Finding {
    let name = format!("\"{}\"", encode(label.as_str()));
    let (message, help) = match kind {
        ControlKind::Button { .. } => {
            ("is a button: press it instead of setting it", format!("write \"press\": [[{name}, TIME]]"))
        }
        ControlKind::Slider { .. } => {
            ("is a slider: set it instead of pressing it", format!("write \"set\": {{{name}: VALUE}}"))
        }
        ControlKind::Select { .. } => {
            ("is a select: set it instead of pressing it", format!("write \"set\": {{{name}: VALUE}}"))
        }
    };
    Finding::new(UNKNOWN_CONTROL, label.span(), format!("{} {message}", named(label.as_str()))).help(help)
}
