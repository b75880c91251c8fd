//! A note that says that moving a control starts the lab again, and a control that does not.

use super::ObservedLab;
use crate::bind::ControlProgram;
use crate::check::choices::choices;
use crate::check::programs::resets;
use crate::check::setconst::digits;
use crate::finding::Finding;
use crate::rules;
use crate::run::{self, Play};
use crate::spec::{Control, ControlKind};
use std::ops::ControlFlow;

/// When the control is moved, steps.
const STEPS: usize = 50;
/// What a sentence says that means a new start: one word, or one with another behind it.
const STARTS: [&str; 3] = ["restarts", "resets the", "resets it"];
const BEGINS: [&str; 4] = ["starts ", "begins ", "drops ", "lets "];
const AGAIN: [&str; 3] = [" again", " anew", " over"];
/// Who does it, and what it may not say besides.
const CHANGES: [&str; 5] = ["moving", "changing", "each slider", "every slider", "slider change"];
const ELSE: [&str; 6] = ["button", "not", "press", "click", "then", "after"];

/// Whether a sentence says that a change starts the lab again.
fn promises(sentence: &str) -> bool {
    let says = |words: &[&str]| words.iter().any(|w| sentence.contains(w));
    (says(&STARTS) || says(&BEGINS) && says(&AGAIN)) && says(&CHANGES) && !says(&ELSE)
}

pub(super) fn check_repeats(observed: &ObservedLab<'_>, findings: &mut Vec<Finding>) {
    let ready = observed.bench.ready;
    let Some(note) = ready.lab.note.as_ref() else { return };
    let lower = note.as_str().to_lowercase();
    let sentences: Vec<&str> = lower.split(['.', ';', ':']).filter(|s| promises(s)).collect();
    let sliders = ready.lab.controls.iter().filter(|c| matches!(c.kind, ControlKind::Slider { .. }));
    let one = sliders.count() == 1;
    for (index, control) in ready.lab.controls.iter().enumerate() {
        let Some((_, ControlProgram::Change(_, action))) = ready.programs.controls.get(index) else {
            continue;
        };
        let resets = action.reset || action.run.as_ref().is_some_and(resets);
        if resets || !sentences.iter().any(|s| speaks_of(s, control, one)) {
            continue;
        }
        let Some(value) = choices(control).into_iter().next() else { continue };
        let mut session = observed.bench.start();
        run::play(&mut session, &Play::steps(STEPS), |_, _| ControlFlow::Continue(()));
        session.set_control(index, value.clone());
        let time = session.world.data.time();
        if session.ended().is_some() || time == 0.0 {
            continue;
        }
        let label = &control.label.value;
        findings.push(
            Finding::warning(
                rules::GOES_ON,
                control.label.span(),
                format!("\"{label}\" does not restart the lab, but the note says that it does"),
            )
            .why(format!(
                "moved to {value} after {STEPS} steps, the run continues from t = {} s",
                digits(time, 3)
            ))
            .related(note.span(), "the note")
            .help("add \"reset\": true, or correct the note"),
        );
    }
}

/// Whether a sentence is about a control: about any slider, about the one that there is, or about this one by a word of its label.
fn speaks_of(sentence: &str, control: &Control, one: bool) -> bool {
    let slider = matches!(control.kind, ControlKind::Slider { .. });
    let words = ["a slider", "each slider", "every slider"];
    let any =
        slider && (words.iter().any(|w| sentence.contains(w)) || one && sentence.contains("the slider"));
    let label = control.label.as_str().to_lowercase();
    let mut words = label.split(|c: char| !c.is_alphanumeric()).filter(|w| w.chars().count() > 3);
    any || words.any(|w| sentence.split(|c: char| !c.is_alphanumeric()).any(|s| s == w))
}
