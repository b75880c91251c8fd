//! Plots and readouts that show nothing, or the same name twice.

use super::control::EMPTY_RANGE;
use crate::finding::{Finding, Severity};
use crate::json::read::named;
use crate::source::Text;
use crate::spec::Lab;
use labspec_finding::{Example, Layer, Rule};
use std::collections::HashMap;

/// A plot without curves.
pub static EMPTY_PLOT: Rule = Rule {
    code: "empty-plot",
    severity: Severity::Error,
    layer: Layer::Structure,
    summary: "a plot has no traces",
    why: "it shows an empty frame",
    bad: Example::Lab(r#"{"model": "ball", "plots": [{"ylabel": "height (m)", "traces": []}]}"#),
    good: Example::Lab(
        r#"{"model": "ball", "plots": [{"ylabel": "height (m)", "traces": [{"label": "ball", "expr": "data.qpos[2]"}]}]}"#,
    ),
};

/// Two curves of a plot with one name.
pub static DUPLICATE_TRACE: Rule = Rule {
    code: "duplicate-trace",
    severity: Severity::Warning,
    layer: Layer::Structure,
    summary: "two traces of a plot have the same label",
    why: "the legend cannot tell them apart",
    bad: Example::Lab(
        r#"{"model": "ball", "plots": [{"traces": [{"label": "z", "expr": "data.qpos[2]"}, {"label": "z", "expr": "data.qpos[7]"}]}]}"#,
    ),
    good: Example::Lab(
        r#"{"model": "ball", "plots": [{"traces": [{"label": "height", "expr": "data.qpos[2]"}, {"label": "angle", "expr": "data.qpos[7]"}]}]}"#,
    ),
};

/// Two readouts with one name.
pub static DUPLICATE_READOUT: Rule = Rule {
    code: "duplicate-readout",
    severity: Severity::Warning,
    layer: Layer::Structure,
    summary: "two readouts of a lab have the same label",
    why: "a student cannot tell them apart",
    bad: Example::Lab(
        r#"{"model": "ball", "readouts": [{"label": "z", "expr": "data.qpos[2]"}, {"label": "z", "expr": "data.qpos[7]"}]}"#,
    ),
    good: Example::Lab(
        r#"{"model": "ball", "readouts": [{"label": "height", "expr": "data.qpos[2]"}, {"label": "angle", "expr": "data.qpos[7]"}]}"#,
    ),
};

pub(in crate::lint) const RULES: &[&Rule] = &[&EMPTY_PLOT, &DUPLICATE_TRACE, &DUPLICATE_READOUT];

/// A plot without traces, found while it is read.
pub(crate) fn empty(plot: std::ops::Range<usize>) -> Finding {
    Finding::new(&EMPTY_PLOT, plot.start..plot.start + 1, "this plot has no traces")
        .help("add \"traces\": [{\"label\": \"height (m)\", \"expr\": \"data.qpos[2]\"}]")
}

/// What to do about labels that repeat.
pub(super) const DISTINCT: &str = "say in the label what makes it different";

pub(in crate::lint) fn check(lab: &Lab, findings: &mut Vec<Finding>) {
    for plot in &lab.plots {
        if let (Some(min), Some(max)) = (&plot.ymin, &plot.ymax)
            && min.value >= max.value
        {
            findings.push(
                Finding::new(
                    &EMPTY_RANGE,
                    max.span.clone(),
                    format!("`ymax` is {}, not above `ymin`, which is {}", max.value, min.value),
                )
                .why("the plot has no height")
                .related(min.span.clone(), "the lower end")
                .help("swap the two, or leave both out: the axis then follows the data"),
            );
        }
        repeated(
            &DUPLICATE_TRACE,
            "traces of this plot have the label",
            DISTINCT,
            plot.traces.iter().map(|t| &t.label),
            findings,
        );
    }
    repeated(
        &DUPLICATE_READOUT,
        "readouts have the label",
        DISTINCT,
        lab.readouts.iter().map(|r| &r.label),
        findings,
    );
}

/// Reports every text that stood there before.
pub(super) fn repeated<'a>(
    rule: &Rule,
    what: &str,
    help: &str,
    texts: impl Iterator<Item = &'a Text>,
    findings: &mut Vec<Finding>,
) {
    let mut first: HashMap<&str, &Text> = HashMap::new();
    for text in texts {
        match first.get(text.as_str()) {
            Some(before) => findings.push(
                Finding::new(rule, text.span(), format!("two {what} {}", named(text.as_str())))
                    .related(before.span(), "the first one")
                    .help(help),
            ),
            None => {
                first.insert(text.as_str(), text);
            }
        }
    }
}
