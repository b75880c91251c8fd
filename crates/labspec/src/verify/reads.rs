//! The values that a student reads under a label or sees on a curve, for `shown('label')`.

use crate::bind::of_label;
use crate::bind::{DisplayedLabels, Programs};
use crate::run::{Session, printed};
use crate::source::Text;
use crate::spec::{Lab, Plot, Readout, Trace};
use labspec_expr::Value;
use labspec_expr::dimension::Dimension;

/// The labels of a lab: its readouts, its traces, and both with the prefixes that the table of `labspec run` uses.
pub fn labels(lab: &Lab) -> DisplayedLabels {
    let readout = |prefix: &str, r: &Readout| (format!("{prefix}{}", r.label.value), unit(&[Some(&r.label)]));
    let trace = |prefix: &str, plot: &Plot, t: &Trace| {
        (format!("{prefix}{}", t.label.value), unit(&[Some(&t.label), plot.ylabel.as_ref()]))
    };
    let bare_readouts = lab.readouts.iter().map(|r| readout("", r));
    // A label that several plots use for different expressions gets the prefix of its plot.
    let several = |t: &Trace| {
        lab.traces().any(|other| other.label.value == t.label.value && other.expr.value != t.expr.value)
    };
    let traces = lab.plots.iter().enumerate().flat_map(|(i, plot)| {
        let prefix = format!("plot/{i}/");
        let read_trace = move |t| trace(if several(t) { &prefix } else { "" }, plot, t);
        plot.traces.iter().map(read_trace)
    });
    let called = lab
        .plots
        .iter()
        .enumerate()
        .flat_map(|(i, plot)| plot.traces.iter().map(move |t| trace(&format!("plot/{i}/"), plot, t)));
    let readouts = lab.readouts.iter().map(|r| readout("readout/", r));
    DisplayedLabels::new(bare_readouts.chain(traces).chain(called).chain(readouts))
}

/// The unit of the first label that has one.
fn unit(labels: &[Option<&Text>]) -> Option<Dimension> {
    labels.iter().flatten().find_map(|label| of_label(label.as_str())).map(|(_, unit)| unit)
}

/// Stores the current values of these labels. The value of a readout is rounded to its decimals, as it is printed.
pub(super) fn show(asked: &[usize], lab: &Lab, programs: &Programs, session: &mut Session<'_>) {
    let (readouts, traces) = (lab.readouts.len(), lab.traces().count());
    for &label in asked {
        // Readouts are first among the labels and last among the probes.
        let probe = match label.checked_sub(readouts) {
            None => traces + label,
            Some(trace) if trace < traces => trace,
            Some(called) => called - traces,
        };
        let digits = probe.checked_sub(traces).and_then(|i| lab.readouts.get(i)).map(|r| r.digits());
        let bound = programs.probes.get(probe).and_then(|p| p.bound.as_ref());
        let value = bound.and_then(|b| session.evaluate(&b.program, &b.text)).unwrap_or(Value::Undefined);
        let printed = match (&value, digits) {
            (Value::Number(x), Some(digits)) if x.is_finite() => Value::Number(printed(*x, digits)),
            _ => value,
        };
        let displayed = &mut session.world.displayed;
        displayed.resize(displayed.len().max(label + 1), Value::Undefined);
        if let Some(place) = displayed.get_mut(label) {
            *place = printed;
        }
    }
}
