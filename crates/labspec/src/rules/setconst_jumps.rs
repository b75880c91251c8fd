use crate::bind::{ControlProgram, functions};
use crate::check::choices::choices;
use crate::check::observations::ObservedLab;
use crate::check::programs::{resets, sets};
use crate::check::setconst::digits;
use crate::run::{self, Play};
use labspec_core::Obj;
use labspec_finding::{Example, Finding, Layer, Rule, Severity};
use std::ops::ControlFlow;

/// A control calls `mj_setConst` in the middle of a run, and the scene jumps.
pub const SETCONST_JUMPS: &Rule = &Rule {
    code: "setconst-jumps",
    severity: Severity::Warning,
    exceptions: &[],
    layer: Layer::Run,
    summary: "a control calls `mj_setConst` in the middle of a run, and the scene jumps",
    why: "`mj_setConst` moves the coordinates back to those of the model: a falling ball returns to its start and keeps its speed",
    bad: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><body name='ball' pos='0 0 1'><freejoint/><geom name='ball' size='.05' mass='1'/></body></worldbody></mujoco>", "stopAt": 0.5, "controls": [{"label": "mass (kg)", "apply": "⟦model.body_mass[1] = value; mj.mj_setConst(model, data)⟧", "min": 1, "max": 50, "value": 1}], "readouts": [{"label": "height (m)", "expr": "data.qpos[2]"}, {"label": "weight (N)", "expr": "9.81 * model.body_mass[1]"}]}"#,
    ),
    good: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><body name='ball' pos='0 0 1'><freejoint/><geom name='ball' size='.05' mass='1'/></body></worldbody></mujoco>", "stopAt": 0.5, "controls": [{"label": "mass (kg)", "apply": "model.body_mass[1] = value; mj.mj_setConst(model, data)", "reset": true, "min": 1, "max": 50, "value": 1}], "readouts": [{"label": "height (m)", "expr": "data.qpos[2]"}, {"label": "weight (N)", "expr": "9.81 * model.body_mass[1]"}]}"#,
    ),
};

/// The maximum number of steps before the control is moved.
const STEPS: usize = 400;
/// Smaller jumps are ignored.
const MIN_JUMP: f64 = 1e-6;

pub(crate) fn check_jumps(observed: &ObservedLab<'_>, findings: &mut Vec<Finding>) {
    let ready = observed.bench.ready;
    let steps = observed.bench.steps(observed.length).map_or(STEPS, |(n, _)| (n / 2).min(STEPS));
    for (index, (label, program)) in ready.programs.controls.iter().enumerate() {
        let (bound, value) = match program {
            ControlProgram::Change(_, action) if action.reset => continue,
            ControlProgram::Change(_, action) => (
                action.run.as_ref(),
                ready.lab.controls.get(index).and_then(|c| choices(c).into_iter().next()),
            ),
            ControlProgram::Press(run) => (run.as_ref(), None),
        };
        let Some(bound) = bound else { continue };
        let calls = &bound.program.effects().calls;
        if !calls.iter().any(|f| functions::name(*f) == Some("mj_setConst"))
            || resets(bound)
            || sets(bound, &ready.model).is_some()
        {
            continue;
        }
        let mut session = observed.bench.start();
        run::play(&mut session, &Play::steps(steps), |_, _| ControlFlow::Continue(()));
        let before = session.world.data.fields().qpos.clone();
        match value {
            Some(value) => session.set_control(index, value),
            None => session.press(index),
        }
        let after = &session.world.data.fields().qpos;
        let far = before.iter().zip(after).enumerate().map(|(i, (a, b))| (i, *a, *b));
        let Some((i, a, b)) = far.max_by(|x, y| (x.1 - x.2).abs().total_cmp(&(y.1 - y.2).abs())) else {
            continue;
        };
        if session.ended().is_some() || (a - b).abs() <= MIN_JUMP {
            continue;
        }
        let model = &ready.model;
        let joint =
            (0..model.njnt).rev().find(|j| model.jnt_qposadr.get(*j).is_some_and(|adr| *adr as usize <= i));
        let name = joint.and_then(|j| model.names.of_kind(Obj::Joint).get(j)).filter(|n| !n.is_empty());
        let of_joint = name.map_or(String::new(), |n| format!(" of joint \"{n}\""));
        let [a, b, time] = [a, b, session.world.data.time()].map(|x| digits(x, 4));
        findings.push(
            Finding::warning(SETCONST_JUMPS, bound.text.span(), format!("the scene jumps when \"{label}\" moves"))
                .why(format!(
                    "mj_setConst restores the coordinates of the model: at t = {time} s, data.qpos[{i}]{of_joint} goes from {a} to {b}"
                ))
                .help("add \"reset\": true, or keep the coordinates: const q = data.qpos.slice(); …; data.qpos.set(q)"),
        );
    }
}
