//! Traces of constants of the model. A value that physics conserves is not a mistake: it changes if the initial state changes.

use crate::check::observations::{ObservedLab, column, constant, same};
use crate::check::setconst::digits;
use crate::spec::Trace;
use labspec_core::reflect::{FieldId, Object};
use labspec_expr::Effects;
use labspec_finding::{Example, Finding, Layer, Rule, Severity};

/// A trace shows the same number in every run.
pub const CONSTANT_TRACE: &Rule = &Rule {
    code: "constant-trace",
    severity: Severity::Warning,
    exceptions: &[],
    layer: Layer::Run,
    summary: "a trace shows the same number in every run",
    why: "a curve that cannot change is often a wrong name or index: `model.qpos0` for `data.qpos`, or the world body for the moving one. The rule tries every control and another state of the scene before it reports. `refLines` draws an intended constant line",
    bad: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><geom name='floor' type='plane' size='1 1 1'/><body name='ball' pos='0 0 1'><freejoint/><geom name='ball' size='.05' mass='1'/></body></worldbody></mujoco>", "plots": [{"window": 1, "traces": [{"label": "height", "expr": "⟦model.qpos0[2]⟧"}]}]}"#,
    ),
    good: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><geom name='floor' type='plane' size='1 1 1'/><body name='ball' pos='0 0 1'><freejoint/><geom name='ball' size='.05' mass='1'/></body></worldbody></mujoco>", "plots": [{"window": 1, "traces": [{"label": "height", "expr": "data.qpos[2]"}]}]}"#,
    ),
};

/// Fields of the model that give the initial configuration, and the fields of data for the current one.
const INITIAL_POSE_FIELDS: [(&str, &str); 8] = [
    ("qpos0", "data.qpos"),
    ("qpos_spring", "data.qpos"),
    ("key_qpos", "data.qpos"),
    ("key_qvel", "data.qvel"),
    ("body_pos", "data.xpos"),
    ("body_quat", "data.xquat"),
    ("geom_pos", "data.geom_xpos"),
    ("site_pos", "data.site_xpos"),
];

fn reads(effects: &Effects, which: impl Fn(FieldId) -> bool) -> bool {
    effects.reads.iter().filter_map(|a| FieldId::new(a.field.0 as usize)).any(which)
}

/// Reports a trace that shows the same number in every run. `others`: whether other curves of its plot change.
pub(crate) fn check_still_trace(
    observed: &mut ObservedLab<'_>,
    c: usize,
    trace: &Trace,
    others: bool,
) -> Option<Finding> {
    let ready = observed.bench.ready;
    let probe = ready.programs.probes.get(c.checked_sub(1)?)?;
    let effects = probe.bound.as_ref()?.program.effects();
    let data = effects.reads_everything || reads(effects, |f| f.info().object == Object::Data);
    let place = INITIAL_POSE_FIELDS
        .iter()
        .find(|(name, _)| reads(effects, |f| f.info().object == Object::Model && f.info().name == *name));
    // Beside changing curves, a number of the model or of the lab may be intended as a reference line.
    if others && !data && place.is_none() {
        return None;
    }
    let value = constant(column(observed.records, c))?.clone();
    if !observed.perturbed_rows().iter().filter_map(|row| row.get(c)).all(|cell| same(cell, &value)) {
        return None;
    }
    let help = match place.filter(|_| !data) {
        Some((name, live)) => {
            format!("read `{live}` for the current value: `model.{name}` holds the initial one")
        }
        None => {
            "check the name and the index that it reads; use `refLines` for an intended constant line".into()
        }
    };
    let message = format!("this trace is always {}", digits(value.number(), 6));
    Some(
        Finding::warning(CONSTANT_TRACE, trace.expr.span(), message)
            .why(format!(
                "it is the same to the last bit in {}, and also from other states of the scene",
                observed.runs()
            ))
            .help(help),
    )
}
