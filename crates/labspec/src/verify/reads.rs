//! `shown('label')` in a measure: what a student reads under a label, or sees on a curve.
//!
//! Before a measure is compiled, each such call becomes a variable of as many bytes, so that every place in the text stays what it
//! is. At each sample the variable holds what the trace or the readout of this label shows; a number of a readout is taken as it is
//! printed, with its decimals.

use crate::bind::Programs;
use crate::finding::Finding;
use crate::json::nearest;
use crate::rules;
use crate::run::{Cell, Session};
use crate::source::Text;
use crate::spec::Lab;
use labspec_expr::{Globals, Value};

/// Most calls in one text.
const MOST: usize = 36;

/// A trace or a readout that a measure reads.
#[derive(Clone, Copy, Debug)]
pub(super) struct Reading {
    slot: u32,
    /// Its place among the programs that are sampled.
    probe: usize,
    /// The decimals of a readout.
    digits: Option<u32>,
}

/// A text without its calls, and what they read. A label that the lab does not have goes to `findings`.
pub(super) fn replaced(
    text: &Text,
    lab: &Lab,
    programs: &Programs,
    globals: &mut Globals,
    findings: &mut Vec<Finding>,
) -> Option<(String, Vec<Reading>)> {
    let (mut out, mut readings) = (String::new(), Vec::new());
    let mut rest = text.value.as_str();
    while let Some((before, call, label)) = next(rest) {
        let Some(probe) = probe(lab, programs, label) else {
            let at = text.value.len() - rest.len() + before.len();
            let names: Vec<&str> = labels(lab).collect();
            let help = match nearest(label, names.iter().copied()) {
                Some(near) => format!("did you mean \"{near}\"?"),
                None => format!("the lab shows {}", names.join(", ")),
            };
            let message =
                format!("no trace or readout of the lab is called {}", crate::json::read::named(label));
            findings.push(
                Finding::error(rules::UNKNOWN_TRACE, text.span_of(at..at + call.len()), message).help(help),
            );
            return None;
        };
        let name = name(globals)?;
        let slot = globals.define(&name);
        let traces = lab.traces().count();
        let digits = probe.checked_sub(traces).and_then(|i| lab.readouts.get(i)).map(|r| r.digits());
        readings.push(Reading { slot, probe, digits });
        let variable = format!("ctx.{name}");
        out.push_str(before);
        out.push_str(&variable);
        out.push_str(&" ".repeat(call.len().saturating_sub(variable.len())));
        rest = rest.get(before.len() + call.len()..).unwrap_or("");
        if readings.len() >= MOST {
            break;
        }
    }
    out.push_str(rest);
    Some((out, readings))
}

/// What stands before the first call, the call, and the label in it.
fn next(text: &str) -> Option<(&str, &str, &str)> {
    let mut from = 0;
    loop {
        let at = from + text.get(from..)?.find("shown(")?;
        let before = text.get(..at)?;
        let part = before.chars().next_back().is_some_and(|c| c.is_alphanumeric() || "_$.'\"".contains(c));
        let inside = text.get(at + 6..)?;
        let quote = inside.chars().next().filter(|c| "'\"".contains(*c));
        let label =
            quote.and_then(|q| inside.get(1..)?.split_once(q)).filter(|(_, behind)| behind.starts_with(')'));
        match label {
            Some((label, _)) if !part => {
                return Some((before, text.get(at..at + 6 + label.len() + 3)?, label));
            }
            _ => from = at + 6,
        }
    }
}

/// A name of one byte or two that nobody has.
fn name(globals: &Globals) -> Option<String> {
    let letters = || ('a'..='z').chain('A'..='Z').chain(['_', '$']);
    let pairs = letters().flat_map(|a| letters().map(move |b| format!("{a}{b}")));
    letters().map(String::from).chain(pairs).find(|n| globals.slot(n).is_none())
}

fn labels(lab: &Lab) -> impl Iterator<Item = &str> {
    lab.readouts.iter().map(|r| r.label.as_str()).chain(lab.traces().map(|t| t.label.as_str()))
}

/// A readout of this label, or a trace; or the one that reports call so, as `plot/0/angle`.
fn probe(lab: &Lab, programs: &Programs, label: &str) -> Option<usize> {
    let traces = lab.traces().count();
    let readout = lab.readouts.iter().position(|r| r.label.as_str() == label).map(|i| traces + i);
    let trace = || lab.traces().position(|t| t.label.as_str() == label);
    let called = || programs.probes.iter().position(|p| p.name == label);
    readout.or_else(trace).or_else(called)
}

/// Stores what is shown now.
pub(super) fn read(readings: &[Reading], globals: &Globals, programs: &Programs, session: &mut Session<'_>) {
    for reading in readings {
        let bound = programs.probes.get(reading.probe).and_then(|p| p.bound.as_ref());
        let value = bound.and_then(|b| session.evaluate(&b.program, &b.text)).unwrap_or(Value::Undefined);
        let printed = match (&value, reading.digits) {
            (Value::Number(x), Some(digits)) if x.is_finite() => {
                Cell::Number(*x).shown(digits).parse().map_or(value, Value::Number)
            }
            _ => value,
        };
        session.context.store(globals, reading.slot, printed);
    }
}

#[cfg(test)]
mod tests {
    use super::next;

    #[test]
    fn calls_are_found_in_a_text() {
        assert_eq!(next("max(shown('a (m)'))"), Some(("max(", "shown('a (m)')", "a (m)")));
        assert_eq!(next("2 * shown(\"it's\") + 1"), Some(("2 * ", "shown(\"it's\")", "it's")));
        assert_eq!(next("ctx.shown('a') + unshown('b') + 'shown(c)'"), None);
        assert_eq!(next("shown(x)"), None);
    }
}
