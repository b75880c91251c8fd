//! Controls that another program overwrites: the lab begins with another value than they show, or the controller writes a different
//! value.
//!
//! Only values that a control sets directly are observed, elements of the model and inputs, so that the control has no other
//! effect.

use crate::bind::{Bound, ControlProgram, functions};
use crate::check::observations::{Move, ObservedLab, Setting, settings, values};
use crate::check::setconst::digits;
use crate::run::{Session, Start};
use crate::spec::Control;
use labspec_core::reflect::{FieldId, Kind, Object, option};
use labspec_expr::{FieldKey, FunctionId, Host, Value};
use labspec_finding::{Example, Finding, Layer, Rule, Severity};

/// The setup or the controller overwrites what a control sets.
pub const OVERRULED: &Rule = &Rule {
    code: "overruled",
    severity: Severity::Warning,
    exceptions: &[],
    layer: Layer::Run,
    summary: "the setup or the controller overwrites what a control sets",
    why: "a student reads one value beside the slider, but the lab uses another: the setup overwrites it once, or the controller in every step",
    bad: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><body name='cart'><joint name='cart' type='slide' axis='1 0 0' damping='.5'/><geom size='.1' mass='1'/></body></worldbody><actuator><motor joint='cart'/></actuator></mujoco>", "stopAt": 0.5, "controller": "data.ctrl[0] = 1", "controls": [{"label": "push", "unit": "N", "set": "⟦data.ctrl[0]⟧", "init": true, "min": 0, "max": 2, "value": 1}], "readouts": [{"label": "place (m)", "expr": "data.qpos[0]"}]}"#,
    ),
    good: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><body name='cart'><joint name='cart' type='slide' axis='1 0 0' damping='.5'/><geom size='.1' mass='1'/></body></worldbody><actuator><motor joint='cart'/></actuator></mujoco>", "stopAt": 0.5, "controls": [{"label": "push", "unit": "N", "set": "data.ctrl[0]", "init": true, "min": 0, "max": 2, "value": 1}], "readouts": [{"label": "place (m)", "expr": "data.qpos[0]"}]}"#,
    ),
};

/// The number of steps after which a control is moved, besides the start.
const LATE_STEPS: usize = 40;
/// The latest step at which it is moved.
const MOST_STEPS: usize = 20_000;
/// The maximum number of observed elements.
const MAX_ELEMENTS: usize = 64;

/// An element that a control sets.
#[derive(Clone, Copy)]
struct WrittenElement {
    field: FieldId,
    index: usize,
}

impl WrittenElement {
    fn value(self, session: &Session<'_>) -> f64 {
        session.world.get(FieldKey(self.field.index() as u32), self.index).unwrap_or(f64::NAN)
    }

    fn name(self) -> String {
        let info = self.field.info();
        let object = match info.object {
            Object::Data => "data.",
            Object::Model => "model.",
            _ => "model.opt.",
        };
        if info.object == Object::Option && self.index == 0 && self.field != option::gravity {
            return format!("`{object}{}`", info.name);
        }
        format!("`{object}{}[{}]`", info.name, self.index)
    }
}

/// Functions of the host that set no element of the model and no input, except from what a program sets.
const RECOMPUTING: [&str; 2] = ["mj_setConst", "mj_forward"];

/// The elements that a program sets. `None` if other elements may change with them, or if they also change by themselves.
fn elements(bound: &Bound) -> Option<Vec<WrittenElement>> {
    let effects = bound.program.effects();
    let recomputes = |f: &FunctionId| functions::name(*f).is_some_and(|name| RECOMPUTING.contains(&name));
    if effects.writes_everything
        || effects.any_ctx
        || effects.calls_values
        || !effects.calls.iter().all(recomputes)
    {
        return None;
    }
    let mut all = Vec::new();
    for write in bound.program.own_writes() {
        let field = FieldId::new(write.field.0 as usize)?;
        let count = write.count.filter(|n| *n <= MAX_ELEMENTS)?;
        if field.info().object == Object::Data && field.info().kind != Kind::Input {
            return None;
        }
        all.extend((write.first..write.first + count).map(|index| WrittenElement { field, index }));
    }
    (!all.is_empty() && all.len() <= MAX_ELEMENTS).then_some(all)
}

/// Whether a program does nothing else than set elements: the controller may read a variable that it stores.
fn only_sets(bound: &Bound) -> bool {
    let effects = bound.program.effects();
    effects.ctx_writes.is_empty() && effects.calls.is_empty()
}

/// Checks every control, and reports the overwritten ones.
pub(crate) fn check_overruled_controls(observed: &mut ObservedLab<'_>, findings: &mut Vec<Finding>) {
    let ready = observed.bench.ready;
    for (index, control) in ready.lab.controls.iter().enumerate() {
        let Some((_, ControlProgram::Change(current, action))) = ready.programs.controls.get(index) else {
            continue;
        };
        let Some(bound) = action.run.as_ref() else { continue };
        let Some(elements) = elements(bound) else { continue };
        let label = &control.label.value;
        let finding = if let Some(why) = initial_value(observed, index, current, &elements) {
            Finding::warning(OVERRULED, bound.text.span(), format!("the lab does not start with the value of \"{label}\""))
                .why(why)
                .help("delete the code after the control that overwrites it, in the setup or in another control, or let it use the control's value")
        } else if let Some(why) =
            only_sets(bound).then(|| overwritten(observed, index, control, &elements)).flatten()
        {
            Finding::warning(
                OVERRULED,
                bound.text.span(),
                format!("the controller overwrites what \"{label}\" sets"),
            )
            .why(why)
            .help("let the controller use the value: store it with `param`, and read `ctx` there")
        } else {
            continue;
        };
        findings.push(finding.related(control.label.span(), "the control"));
        observed.reported.push(index);
    }
}

/// Describes the value at the start if it differs from the value of the control.
fn initial_value(
    observed: &ObservedLab<'_>,
    index: usize,
    current: &Value,
    elements: &[WrittenElement],
) -> Option<String> {
    let ready = observed.bench.ready;
    let mut programs = ready.programs.clone();
    if let Some((_, ControlProgram::Change(_, action))) = programs.controls.get_mut(index) {
        action.reset = false;
    }
    let start = Start { budget: observed.bench.budget(), ..Start::of_lab(ready.lab) };
    let mut session = Session::start(&programs, &ready.model, start);
    let elements_of = |session: &Session<'_>| elements.iter().map(|e| e.value(session)).collect::<Vec<f64>>();
    let begins = elements_of(&session);
    session.set_control(index, current.clone());
    let says = elements_of(&session);
    session.set_control(index, current.clone());
    // Statements that add to the current value give no initial value.
    if elements_of(&session) != says || session.ended().is_some() {
        return None;
    }
    let differ = |(a, b): (&f64, &f64)| (a - b).abs() > 1e-9 * a.abs().max(b.abs());
    let differing = begins.iter().zip(&says).position(differ)?;
    let [begins, says] = [begins.get(differing)?, says.get(differing)?].map(|x| digits(*x, 6));
    Some(format!(
        "it displays {current}, for which {} is {says}, but the lab starts with {begins}",
        elements.get(differing)?.name()
    ))
}

/// Describes the value that the controller writes, whatever the value of the control.
fn overwritten(
    observed: &mut ObservedLab<'_>,
    index: usize,
    control: &Control,
    elements: &[WrittenElement],
) -> Option<String> {
    let ready = observed.bench.ready;
    ready.programs.controller.as_ref()?;
    let values = values(control);
    let (mut evidence, mut runs) = (None, 0);
    // A controller may not write it at the start, or later on.
    let (steps, _) = observed.bench.steps(observed.length)?;
    let late = [steps / 2, steps.saturating_sub(2)]
        .into_iter()
        .filter(|n| *n > LATE_STEPS)
        .map(|n| (Setting::new(), n.min(MOST_STEPS)));
    let others = settings(ready.lab, index, 1).into_iter().flat_map(|s| [(s.clone(), 2), (s, LATE_STEPS)]);
    let all: Vec<(Setting, usize)> = late.chain(others).collect();
    for (setting, step_count) in all {
        let mut first: Option<Vec<f64>> = None;
        for value in values.iter().flatten() {
            let (set, then) = after(observed, &setting, step_count, index, value, elements)?;
            runs += 1;
            match &first {
                Some(other) if *other != then => return None,
                _ => {}
            }
            if let (Some(i), None) = (set.iter().zip(&then).position(|(a, b)| a != b), &evidence) {
                let [a, b] = [set.get(i)?, then.get(i)?].map(|x| digits(*x, 6));
                evidence = Some(format!(
                    "with it at {value}, {} is {a}, but {b} after the next step",
                    elements.get(i)?.name()
                ));
            }
            first = Some(then);
        }
    }
    Some(format!(
        "{}: the same at every value, at the start and later, with every other control moved too ({runs} runs)",
        evidence?
    ))
}

/// The elements right after the control is moved, and one step later.
fn after(
    observed: &mut ObservedLab<'_>,
    setting: &[Move],
    step_count: usize,
    index: usize,
    value: &Value,
    elements: &[WrittenElement],
) -> Option<(Vec<f64>, Vec<f64>)> {
    let mut session = observed.bench.start();
    let elements_of = |session: &Session<'_>| elements.iter().map(|e| e.value(session)).collect::<Vec<f64>>();
    for step in 0..step_count {
        for m in setting.iter().filter(|m| m.step == step) {
            match &m.value {
                Some(value) => session.set_control(m.control, value.clone()),
                None => session.press(m.control),
            }
        }
        session.step();
    }
    session.set_control(index, value.clone());
    let set = elements_of(&session);
    session.step();
    let then = elements_of(&session);
    let (spent, completed) = (session.spent(), session.ended().is_none());
    drop(session);
    observed.bench.left = observed.bench.left.saturating_sub(spent);
    (completed && observed.bench.left > 0).then_some((set, then))
}
