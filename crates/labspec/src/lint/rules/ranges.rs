//! Numbers that make no sense where they stand.

use crate::finding::{Finding, Severity};
use crate::json::{Number, nearest, read::named};
use crate::spec::format::{LAB, MAX_DIGITS, OVERLAYS, Object, PLOT, READOUT, SLIDER, texts};
use crate::spec::{ControlKind, Lab};
use labspec_finding::{Example, Layer, Rule};

/// A number that must be greater than zero.
pub static NOT_POSITIVE: Rule = Rule {
    code: "not-positive",
    severity: Severity::Error,
    layer: Layer::Structure,
    summary: "a time, size or speed is zero or negative",
    why: "with nothing left to run or to draw, the lab shows nothing",
    bad: Example::Lab(r#"{"model": "ball", "stopAt": 0}"#),
    good: Example::Lab(r#"{"model": "ball", "stopAt": 1.5}"#),
};

/// `digits` outside of what a number has.
pub static DIGITS: Rule = Rule {
    code: "digits-range",
    severity: Severity::Error,
    layer: Layer::Structure,
    summary: "`digits` is not between 0 and 17",
    why: "a number has 17 significant digits at most; a negative count makes the page throw",
    bad: Example::Lab(
        r#"{"model": "ball", "readouts": [{"label": "t", "expr": "data.time", "digits": -1}]}"#,
    ),
    good: Example::Lab(
        r#"{"model": "ball", "readouts": [{"label": "t", "expr": "data.time", "digits": 1}]}"#,
    ),
};

/// A negative keyframe.
pub static KEYFRAME: Rule = Rule {
    code: "keyframe-range",
    severity: Severity::Error,
    layer: Layer::Structure,
    summary: "`key` is negative",
    why: "keyframes are counted from 0; a negative one is silently ignored",
    bad: Example::Lab(r#"{"model": "ball", "key": -1}"#),
    good: Example::Lab(r#"{"model": "ball", "key": 0}"#),
};

/// An overlay that does not exist.
pub static UNKNOWN_OVERLAY: Rule = Rule {
    code: "unknown-overlay",
    severity: Severity::Error,
    layer: Layer::Structure,
    summary: "`overlays` or `toggles` name something that cannot be drawn",
    why: "nothing is drawn, or the checkbox does nothing",
    bad: Example::Lab(r#"{"model": "ball", "toggles": ["contact"]}"#),
    good: Example::Lab(r#"{"model": "ball", "toggles": ["contacts"]}"#),
};

pub(in crate::lint) const RULES: &[&Rule] = &[&NOT_POSITIVE, &DIGITS, &KEYFRAME, &UNKNOWN_OVERLAY];

pub(in crate::lint) fn check_lab(lab: &Lab, findings: &mut Vec<Finding>) {
    positive(&LAB, "stopAt", lab.stop_at.as_ref(), "the time in seconds at which the lab pauses", findings);
    positive(&LAB, "height", lab.height.as_ref(), "pixels", findings);
    positive(&LAB, "forceScale", lab.force_scale.as_ref(), "metres per newton", findings);
    lab.speeds
        .iter()
        .for_each(|s| positive(&LAB, "speeds", Some(s), "how many times as fast as reality", findings));
    for plot in &lab.plots {
        positive(&PLOT, "window", plot.window.as_ref(), "seconds", findings);
        positive(&PLOT, "height", plot.height.as_ref(), "pixels", findings);
    }
    for control in &lab.controls {
        if let ControlKind::Slider { digits: count, .. } = &control.kind {
            digits(&SLIDER, count.as_ref(), findings);
        }
    }
    lab.readouts.iter().for_each(|r| digits(&READOUT, r.digits.as_ref(), findings));
    if let Some(key) = lab.key.as_ref().filter(|k| !LAB.allows("key", k.value)) {
        findings.push(
            Finding::new(
                &KEYFRAME,
                key.span.clone(),
                format!("`key` is {}, but keyframes are counted from 0", key.value),
            )
            .help("write 0 for the first keyframe, or leave `key` out"),
        );
    }
    let toggles = lab.toggles.iter();
    for name in toggles.chain(lab.overlays.iter().map(|(name, _)| name)) {
        if texts(&OVERLAYS).any(|known| known == name.as_str()) {
            continue;
        }
        let finding =
            Finding::new(&UNKNOWN_OVERLAY, name.span(), format!("{} cannot be drawn", named(name.as_str())));
        findings.push(match nearest(name.as_str(), texts(&OVERLAYS)) {
            Some(right) => finding.help(format!("did you mean `{right}`?")).fix(name.span(), right),
            None => finding
                .help(format!("what can be drawn: {}", texts(&OVERLAYS).collect::<Vec<_>>().join(", "))),
        });
    }
}

/// Reports a number that its key does not allow, which is one that is not greater than zero.
pub(super) fn positive(
    object: &Object,
    name: &str,
    number: Option<&Number>,
    means: &str,
    findings: &mut Vec<Finding>,
) {
    if let Some(number) = number.filter(|n| !object.allows(name, n.value)) {
        findings.push(
            Finding::new(
                &NOT_POSITIVE,
                number.span.clone(),
                format!("`{name}` is {}, but it must be positive", number.value),
            )
            .help(format!("it means: {means}")),
        );
    }
}

fn digits(object: &Object, number: Option<&Number>, findings: &mut Vec<Finding>) {
    if let Some(n) = number.filter(|n| !object.allows("digits", n.value)) {
        findings.push(
            Finding::new(
                &DIGITS,
                n.span.clone(),
                format!("`digits` is {}, not between 0 and {MAX_DIGITS}", n.value),
            )
            .help("it is the number of decimals; leave it out for 3"),
        );
    }
}
