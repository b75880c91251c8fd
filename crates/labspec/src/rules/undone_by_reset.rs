use super::stale_read::parts;
use crate::bind::{Bound, ControlProgram};
use crate::check::observations::ObservedLab;
use crate::check::setconst::{self, digits};
use crate::run::{self, Play, Session};
use labspec_core::reflect::{FieldId, Kind, Object};
use labspec_expr::{FieldKey, Host};
use labspec_finding::{Example, Finding, Layer, Rule, Severity};
use std::ops::ControlFlow;

/// A button resets the data after it has changed them.
pub const UNDONE_BY_RESET: &Rule = &Rule {
    code: "undone-by-reset",
    severity: Severity::Warning,
    exceptions: &[],
    layer: Layer::Run,
    summary: "a button resets the data after it has changed them",
    why: "a reset restores every position, velocity and input: the changes are lost, and a student who presses the button sees the start",
    bad: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><geom name='floor' type='plane' size='1 1 1'/><body name='ball' pos='0 0 1'><freejoint/><geom name='ball' size='.05' mass='1'/></body></worldbody></mujoco>", "stopAt": 1, "controls": [{"type": "button", "label": "throw", "run": "⟦data.qvel[2] = 3; mj.mj_resetData(model, data)⟧"}], "readouts": [{"label": "height (m)", "expr": "data.qpos[2]"}]}"#,
    ),
    good: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><geom name='floor' type='plane' size='1 1 1'/><body name='ball' pos='0 0 1'><freejoint/><geom name='ball' size='.05' mass='1'/></body></worldbody></mujoco>", "stopAt": 1, "controls": [{"type": "button", "label": "throw", "run": "mj.mj_resetData(model, data); data.qvel[2] = 3"}], "readouts": [{"label": "height (m)", "expr": "data.qpos[2]"}]}"#,
    ),
};

/// The step at which the button is pressed.
const STEPS: usize = 40;
/// The calls that reset.
const RESETS: [&str; 4] = ["mj.mj_resetData(", "mj_resetData(", "mj.mj_resetDataKeyframe(", "sim.reset("];

pub(crate) fn check_undone_writes(observed: &mut ObservedLab<'_>, findings: &mut Vec<Finding>) {
    let ready = observed.bench.ready;
    for (index, (label, program)) in ready.programs.controls.iter().enumerate() {
        let ControlProgram::Press(Some(bound)) = program else { continue };
        let Some(parts) = parts(&bound.text.value) else { continue };
        let is_reset = |p: &str| RESETS.iter().any(|r| p.trim_start().starts_with(r));
        let filled: Vec<&String> = parts.iter().filter(|p| !p.trim().is_empty()).collect();
        let Some((last, before)) =
            filled.split_last().filter(|(last, before)| is_reset(last) && !before.is_empty())
        else {
            continue;
        };
        let before = before.iter().map(|p| p.as_str()).collect::<Vec<_>>().join(";");
        let bench = setconst::SetConstBench::new(ready.lab, &ready.model, &ready.programs);
        let [first, then] = [before.as_str(), last.as_str()].map(|t| bench.compile(&bound.text, t, None));
        let (Some(first), Some(then)) = (first, then) else { continue };
        // A plain reset before a reset to a keyframe loses nothing.
        let resets = before.split(';').any(|p| is_reset(p) && p.contains("Keyframe"));
        let Some((name, set, left)) = first_lost_write(observed, &first, &then, resets) else {
            continue;
        };
        findings.push(
            Finding::warning(
                UNDONE_BY_RESET,
                bound.text.span(),
                format!("\"{label}\" resets what it has just set"),
            )
            .why(format!(
                "pressed after {STEPS} steps, {name} becomes {set}, and then the reset makes it {left}"
            ))
            .help("reset first, then set the values after the reset"),
        );
        observed.reported.push(index);
    }
}

/// The first number that the first statements set and that the following reset discards. `None` if any of their effects remains.
fn first_lost_write(
    observed: &ObservedLab<'_>,
    first: &Bound,
    then: &Bound,
    resets: bool,
) -> Option<(String, String, String)> {
    let effects = first.program.effects();
    let model = effects.writes.iter().any(|w| {
        FieldId::new(w.field.0 as usize)
            .is_none_or(|f| f.info().object != Object::Data && f.info().kind != Kind::Derived)
    });
    if effects.any_ctx || effects.calls_values || model && !resets {
        return None;
    }
    let mut session = observed.bench.start();
    run::play(&mut session, &Play::steps(STEPS), |_, _| ControlFlow::Continue(()));
    session.run_statements(&first.program, &first.text);
    let state = |session: &Session<'_>| -> Vec<(String, f64)> {
        let fields =
            ["qpos", "qvel", "ctrl", "act", "qfrc_applied", "xfrc_applied", "mocap_pos", "mocap_quat"];
        let all = (0..)
            .map_while(FieldId::new)
            .filter(|f| f.info().object == Object::Data && fields.contains(&f.info().name));
        let wrote = |f: FieldId, i: usize| {
            resets
                || first.program.own_writes().iter().any(|w| {
                    w.field.0 as usize == f.index() && i >= w.first && w.count.is_none_or(|n| i < w.first + n)
                })
        };
        all.flat_map(|f| {
            let key = FieldKey(f.index() as u32);
            let list = (0..session.world.len(key)).filter(move |i| wrote(f, *i));
            list.map(move |i| {
                (format!("`data.{}[{i}]`", f.info().name), session.world.get(key, i).unwrap_or(0.0))
            })
            .collect::<Vec<_>>()
        })
        .collect()
    };
    let set = state(&session);
    session.run_statements(&then.program, &then.text);
    let left = state(&session);
    // A value stored outside the state survives a reset.
    let survives_reset = !resets && !effects.ctx_writes.is_empty();
    let gone = set.iter().zip(&left).find(|(a, b)| (a.1 - b.1).abs() > 1e-9 * a.1.abs().max(b.1.abs()));
    let ((name, a), (_, b)) = gone.filter(|_| !survives_reset && session.ended().is_none())?;
    Some((name.clone(), digits(*a, 4), digits(*b, 4)))
}
