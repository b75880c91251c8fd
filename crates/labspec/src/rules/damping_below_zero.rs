//! Negative damping that does not make the energy grow without bound, because something else limits the motion.

use crate::check::observations::{Move, ObservedLab, single_moves};
use crate::check::setconst::digits;
use crate::run::{self, Play};
use labspec_core::reflect::model;
use labspec_finding::{Example, Finding, Layer, Rule, Severity};
use std::ops::ControlFlow;

/// A damping is negative.
pub const DAMPING_BELOW_ZERO: &Rule = &Rule {
    code: "damping-below-zero",
    severity: Severity::Warning,
    exceptions: &[],
    layer: Layer::Run,
    summary: "a damping coefficient is negative",
    why: "a damper takes energy from a moving part; a negative damping adds energy. Friction, a limit or a motor may hide it for a while. The rule skips a damping that a control sets, or that the lab calls negative",
    bad: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><geom name='floor' type='plane' size='1 1 1'/><body name='ball' pos='0 0 1'><joint type='slide' axis='0 0 1'/><joint type='hinge' axis='0 1 0'/><geom name='ball' size='.05' mass='1'/></body></worldbody></mujoco>", "setup": "⟦model.dof_damping.fill(-0.5)⟧", "stopAt": 0.3, "readouts": [{"label": "height (m)", "expr": "data.xpos[5]"}]}"#,
    ),
    good: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><geom name='floor' type='plane' size='1 1 1'/><body name='ball' pos='0 0 1'><joint type='slide' axis='0 0 1'/><joint type='hinge' axis='0 1 0'/><geom name='ball' size='.05' mass='1'/></body></worldbody></mujoco>", "setup": "model.dof_damping.fill(0.5)", "stopAt": 0.3, "readouts": [{"label": "height (m)", "expr": "data.xpos[5]"}]}"#,
    ),
};

/// The number of steps of the observed runs.
const STEPS: usize = 500;
/// Words by which a lab states that negative damping is intended.
const INTENTION_WORDS: [&str; 4] = ["negative", "below zero", "self-excit", "van der pol"];

pub(crate) fn check_damping(observed: &ObservedLab<'_>, findings: &mut Vec<Finding>) {
    let ready = observed.bench.ready;
    let lab = ready.lab;
    let controls = lab.controls.iter().map(|c| &c.label);
    let texts = [lab.title.as_ref(), lab.note.as_ref()].into_iter().flatten().chain(controls);
    let says = |text: &str| INTENTION_WORDS.iter().any(|w| text.to_lowercase().contains(w));
    let chosen = |effects: &labspec_expr::Effects| {
        effects.writes_everything
            || effects.writes.iter().any(|w| w.field.0 as usize == model::dof_damping.index())
    };
    let programs = &ready.programs;
    let others = programs.bound().filter(|b| programs.setup.as_ref().is_none_or(|s| s.text != b.text));
    if texts.map(crate::source::Text::as_str).any(says)
        || others.into_iter().any(|b| chosen(b.program.effects()))
    {
        return;
    }
    let Some((dof, damping, power, time, done)) = most_powerful_damper(observed) else { return };
    let [damping, power, time] = [damping, power, time].map(|x| digits(x, 3));
    let place = programs.setup.as_ref().filter(|b| chosen(b.program.effects())).map(|b| b.text.span());
    findings.push(
        Finding::warning(
            DAMPING_BELOW_ZERO,
            place.unwrap_or(lab.place()),
            format!("the damping `model.dof_damping[{dof}]` is negative: {damping}"),
        )
        .why(format!("{done} it adds {power} W at t = {time} s, where a damper removes energy"))
        .help("set the damping to 0 or more; to drive the joint, add an actuator"),
    );
}

/// The damper with the largest power: its degree of freedom, damping, power in W, time, and the action of the run.
fn most_powerful_damper(observed: &ObservedLab<'_>) -> Option<(usize, f64, f64, f64, String)> {
    let session = observed.bench.start();
    let poly = &session.world.model.dof_dampingpoly;
    let plain = |i: usize| poly.get(2 * i..2 * i + 2).is_some_and(|p| p.iter().all(|x| *x <= 0.0));
    let all = session.world.model.dof_damping.iter().copied().enumerate();
    let below: Vec<(usize, f64)> = all.filter(|(i, d)| *d < 0.0 && plain(*i)).collect();
    drop(session);
    if below.is_empty() {
        return None;
    }
    single_moves(observed.bench.ready.lab).into_iter().find_map(|(done, description)| {
        let mut session = observed.bench.start();
        let mut most: Option<(usize, f64, f64, f64)> = None;
        run::play(&mut session, &Play::steps(STEPS), |session, step| {
            if let Some(Move { control, value, .. }) = done.as_ref().filter(|m| m.step == step) {
                match value {
                    Some(value) => session.set_control(*control, value.clone()),
                    None => session.press(*control),
                }
            }
            let data = session.world.data.fields();
            for (i, d) in &below {
                let v = data.qvel.get(*i).copied().unwrap_or(0.0);
                let power = -d * v * v;
                if power > most.map_or(1e-9, |m| m.2) {
                    most = Some((*i, *d, power, data.time));
                }
            }
            ControlFlow::Continue(())
        });
        let (dof, damping, power, time) = most?;
        Some((dof, damping, power, time, description))
    })
}
