//! Controllers that record the time of a contact. A run decides whether the recorded time is one step late.
//!
//! A step detects contacts from the positions at its start, at time t, and ends at t + h. A controller that reads these contacts
//! before the next step, and records `data.time`, records t + h.

use crate::bind::{ModelNames, Scope};
use crate::check::PreparedLab;
use crate::check::setconst::digits;
use crate::run::{Budget, Session, Start, count_steps};
use crate::source::{SourceMap, Text};
use labspec_expr::{Compiler, Program, Value};
use labspec_finding::{Example, Finding, Layer, Rule, Severity};

/// A controller records the time of a contact one step late.
pub const CONTACT_TIME_LATE: &Rule = &Rule {
    code: "contact-time-late",
    severity: Severity::Note,
    exceptions: &[],
    layer: Layer::Run,
    summary: "a controller records the time of a contact one step late",
    why: "a step finds contacts at its start, from the positions before it; when the controller sees them, `data.time` is already one timestep later",
    bad: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><geom name='floor' type='plane' size='1 1 1'/><body name='ball' pos='0 0 1'><freejoint/><geom name='ball' size='.05' mass='1'/></body></worldbody></mujoco>", "setup": "ctx.touch = 0", "controller": "⟦if (ctx.touch === 0 && data.ncon > 0) { ctx.touch = data.time }⟧", "stopAt": 0.6, "readouts": [{"label": "touches at (s)", "expr": "ctx.touch"}, {"label": "height (m)", "expr": "data.qpos[2]"}]}"#,
    ),
    good: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><geom name='floor' type='plane' size='1 1 1'/><body name='ball' pos='0 0 1'><freejoint/><geom name='ball' size='.05' mass='1'/></body></worldbody></mujoco>", "setup": "ctx.touch = 0", "controller": "if (ctx.touch === 0 && data.ncon > 0) { ctx.touch = data.time - model.opt.timestep }", "stopAt": 0.6, "readouts": [{"label": "touches at (s)", "expr": "ctx.touch"}, {"label": "height (m)", "expr": "data.qpos[2]"}]}"#,
    ),
};

/// The work budget of the run.
const WORK: Budget = Budget { left: 50_000_000 };

pub(crate) fn check_contact_times(ready: &PreparedLab<'_>, findings: &mut Vec<Finding>) {
    let Some(controller) = &ready.programs.controller else { return };
    let text = &controller.text;
    let names = |word: &str| text.value.contains(word);
    let effects = controller.program.effects();
    // A controller that recomputes contacts reads the current ones.
    let suspect = (names("ncon") || names("contact")) && names("time") && !effects.writes_everything;
    if !suspect || effects.ctx_writes.is_empty() {
        return;
    }
    let Some((slot, time, step)) = late_variable(ready, &effects.ctx_writes) else { return };
    let name = ready.programs.globals.name(slot);
    let printed = |x: f64| digits(x, 6);
    findings.push(
        Finding::new(
            CONTACT_TIME_LATE,
            text.span(),
            format!("`ctx.{name}` records the time of a contact one step late"),
        )
        .why(format!(
            "in a run, a contact of the positions at {} s sets it to {}: a step finds contacts at its start, but `data.time` is already the time of its end",
            printed(time - step),
            printed(time)
        ))
        .help("store `data.time - model.opt.timestep`"),
    );
}

/// The variable that a new contact, and no other event of the step before, sets to the time of the controller; that time; the
/// timestep.
fn late_variable(ready: &PreparedLab<'_>, slots: &[u32]) -> Option<(u32, f64, f64)> {
    let (lab, programs) = (ready.lab, &ready.programs);
    let start = Start { budget: WORK, ..Start::of_lab(lab) };
    let mut session = Session::start(programs, &ready.model, start);
    let timestep = session.world.model.opt.timestep;
    let steps = count_steps(lab, None, None, timestep).ok()?;
    let names = ModelNames::new(&ready.model, Scope::Lab);
    let mut globals = programs.globals.clone();
    let texts: Vec<Text> = slots
        .iter()
        .map(|slot| Text { value: format!("ctx.{}", globals.name(*slot)), map: SourceMap::point(0) })
        .collect();
    let reads: Option<Vec<Program>> = texts
        .iter()
        .map(|text| Compiler::new(&names, &mut globals).expression(&text.value).program)
        .collect();
    let reads = reads?;
    let values = |session: &mut Session<'_>| -> Vec<Option<f64>> {
        let one = |(program, text)| match session.evaluate(program, text) {
            Some(Value::Number(x)) => Some(x),
            _ => None,
        };
        reads.iter().zip(&texts).map(one).collect()
    };
    // The values after the previous step, and whether that step changed them.
    let (mut previous, mut changed, mut contacts) =
        (values(&mut session), vec![true; slots.len()], usize::MAX);
    for _ in 0..steps {
        let fields = session.world.data.fields();
        let (current, time) = (fields.ncon, session.world.data.time());
        session.step();
        if session.ended().is_some() {
            return None;
        }
        let new = values(&mut session);
        for (i, slot) in slots.iter().enumerate() {
            let (before, after) = (previous.get(i).copied().flatten(), new.get(i).copied().flatten());
            let changes = before.map(f64::to_bits) != after.map(f64::to_bits);
            let quiet = changed.get(i).is_some_and(|c| !c);
            if changes && quiet && current > contacts && time > 0.0 && after == Some(time) {
                return Some((*slot, time, session.world.model.opt.timestep));
            }
            if let Some(c) = changed.get_mut(i) {
                *c = changes;
            }
        }
        (previous, contacts) = (new, current);
    }
    None
}
