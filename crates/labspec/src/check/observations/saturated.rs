//! Inputs that are beyond their range all the time, in every run: the controller might as well be a constant.

use super::ObservedLab;
use crate::check::setconst::digits;
use crate::finding::Finding;
use crate::rules;
use crate::run::Session;
use labspec_core::Obj;

/// Inputs that were beyond their range whenever they were observed at, with the least that they were beyond it by.
#[derive(Debug, Default)]
pub(in crate::check) struct Beyond {
    looks: usize,
    /// How often each input was, and what it was then.
    times: Vec<(usize, f64)>,
}

impl Beyond {
    /// Looks at the inputs of a step that was made.
    pub(in crate::check) fn observe(&mut self, session: &Session<'_>) {
        let (model, data) = (&session.world.model, session.world.data.fields());
        self.looks += 1;
        self.times.resize(data.ctrl.len(), (0, 0.0));
        for (i, (value, times)) in data.ctrl.iter().zip(&mut self.times).enumerate() {
            let limited = model.actuator_ctrllimited.get(i).is_some_and(|l| *l);
            let [low, high] = [0, 1].map(|k| model.actuator_ctrlrange.get(2 * i + k).copied().unwrap_or(0.0));
            if limited && !(low..=high).contains(value) {
                *times = (times.0 + 1, *value);
            }
        }
    }
}

/// Runs of fewer samples say nothing.
const LOOKS: usize = 10;

pub(super) fn check_saturation(observed: &ObservedLab<'_>, findings: &mut Vec<Finding>) {
    let ready = observed.bench.ready;
    let Some(first) = observed.records.first() else { return };
    for (i, (_, value)) in first.beyond.times.iter().enumerate() {
        let always = |b: &Beyond| b.looks >= LOOKS && b.times.get(i).is_some_and(|t| t.0 == b.looks);
        if !observed.records.iter().all(|r| always(&r.beyond)) {
            continue;
        }
        let [low, high] =
            [0, 1].map(|k| ready.model.actuator_ctrlrange.get(2 * i + k).copied().unwrap_or(0.0));
        let name = ready.model.names.of(Obj::Actuator).get(i).filter(|n| !n.is_empty());
        let who = name.map_or_else(|| format!("data.ctrl[{i}]"), |n| format!("the input of \"{n}\""));
        findings.push(
            Finding::warning(rules::ALWAYS_SATURATED, ready.lab.place(), format!("{who} is outside its range all the time"))
                .why(format!(
                    "it is {} in the run as the lab stands, its `ctrlrange` goes from {low} to {high}, and it is outside at every sample of {}: the engine clamps it",
                    digits(*value, 4), observed.runs()
                ))
                .help("check the unit and the gain of what computes it, or widen `ctrlrange`"),
        );
    }
}
