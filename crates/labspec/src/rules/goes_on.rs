use crate::bind::ControlProgram;
use crate::check::choices::choices;
use crate::check::observations::ObservedLab;
use crate::check::programs::resets;
use crate::check::setconst::digits;
use crate::run::{self, Play};
use crate::spec::{Control, ControlKind};
use labspec_finding::{Example, Finding, Layer, Rule, Severity};
use std::ops::ControlFlow;

/// The note says that a control restarts the lab, but it does not.
pub const GOES_ON: &Rule = &Rule {
    code: "goes-on",
    severity: Severity::Warning,
    exceptions: &[],
    layer: Layer::Run,
    summary: "the note says that a control restarts the lab, but it does not",
    why: "the run continues from its current state with the new value: a student who wants to compare two runs sees only the end of one",
    bad: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><geom name='floor' type='plane' size='1 1 1'/><body name='ball' pos='0 0 1'><freejoint/><geom name='ball' size='.05' mass='1'/></body></worldbody></mujoco>", "stopAt": 0.4, "controls": [{"label": "⟦gravity⟧", "unit": "m/s^2", "set": "model.opt.gravity[2]", "min": -20, "max": 0, "value": -9.8, "step": 0.2}], "readouts": [{"label": "height (m)", "expr": "data.qpos[2]"}], "note": "Changing gravity starts the fall again."}"#,
    ),
    good: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><geom name='floor' type='plane' size='1 1 1'/><body name='ball' pos='0 0 1'><freejoint/><geom name='ball' size='.05' mass='1'/></body></worldbody></mujoco>", "stopAt": 0.4, "controls": [{"label": "gravity", "unit": "m/s^2", "set": "model.opt.gravity[2]", "min": -20, "max": 0, "value": -9.8, "step": 0.2, "reset": true}], "readouts": [{"label": "height (m)", "expr": "data.qpos[2]"}], "note": "Changing gravity starts the fall again."}"#,
    ),
};

/// The step at which the control is moved.
const STEPS: usize = 50;
/// Phrases that mean a restart: complete, or followed by another word.
const STARTS: [&str; 3] = ["restarts", "resets the", "resets it"];
const BEGINS: [&str; 4] = ["starts ", "begins ", "drops ", "lets "];
const AGAIN: [&str; 3] = [" again", " anew", " over"];
/// Phrases for the cause of a restart, and words that exclude it.
const CHANGES: [&str; 5] = ["moving", "changing", "each slider", "every slider", "slider change"];
const ELSE: [&str; 6] = ["button", "not", "press", "click", "then", "after"];

/// Whether a sentence claims that a change restarts the lab.
fn claims_restart(sentence: &str) -> bool {
    let contains_any = |words: &[&str]| words.iter().any(|w| sentence.contains(w));
    (contains_any(&STARTS) || contains_any(&BEGINS) && contains_any(&AGAIN))
        && contains_any(&CHANGES)
        && !contains_any(&ELSE)
}

pub(crate) fn check_repeats(observed: &ObservedLab<'_>, findings: &mut Vec<Finding>) {
    let ready = observed.bench.ready;
    let Some(note) = ready.lab.note.as_ref() else { return };
    let lower = note.as_str().to_lowercase();
    let sentences: Vec<&str> = lower.split(['.', ';', ':']).filter(|s| claims_restart(s)).collect();
    let sliders = ready.lab.controls.iter().filter(|c| matches!(c.kind, ControlKind::Slider { .. }));
    let one = sliders.count() == 1;
    for (index, control) in ready.lab.controls.iter().enumerate() {
        let Some((_, ControlProgram::Change(_, action))) = ready.programs.controls.get(index) else {
            continue;
        };
        let resets = action.reset || action.run.as_ref().is_some_and(resets);
        if resets || !sentences.iter().any(|s| mentions_control(s, control, one)) {
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
                GOES_ON,
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

/// Whether a sentence is about a control: about any slider, about the only one, or about this one, by a word of its label.
fn mentions_control(sentence: &str, control: &Control, one: bool) -> bool {
    let slider = matches!(control.kind, ControlKind::Slider { .. });
    let words = ["a slider", "each slider", "every slider"];
    let any =
        slider && (words.iter().any(|w| sentence.contains(w)) || one && sentence.contains("the slider"));
    let label = control.label.as_str().to_lowercase();
    let mut words = label.split(|c: char| !c.is_alphanumeric()).filter(|w| w.chars().count() > 3);
    any || words.any(|w| sentence.split(|c: char| !c.is_alphanumeric()).any(|s| s == w))
}
