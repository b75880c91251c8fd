use crate::check::observations::{InputsOutOfRange, ObservedLab};
use crate::check::setconst::digits;
use labspec_core::Obj;
use labspec_finding::{Example, Finding, Layer, Rule, Severity};

/// An input is outside its `ctrlrange` all the time, in every run.
pub const ALWAYS_SATURATED: &Rule = &Rule {
    code: "always-saturated",
    severity: Severity::Warning,
    exceptions: &[],
    layer: Layer::Run,
    summary: "an input is outside its `ctrlrange` all the time, in every run",
    why: "the engine clamps the input: the actuator stays at its limit, whatever the controller computes",
    bad: Example::Lab(
        r#"{"xml": "⟦<mujoco><worldbody><body name='rod'><joint name='hinge' axis='0 1 0'/><geom type='capsule' size='.02' fromto='0 0 0 0 0 -1'/></body></worldbody><actuator><motor joint='hinge' ctrlrange='-1 1' ctrllimited='true'/></actuator></mujoco>⟧", "controller": "data.ctrl[0] = 5 + data.qpos[0]", "stopAt": 0.5, "readouts": [{"label": "angle", "expr": "data.qpos[0]"}]}"#,
    ),
    good: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><body name='rod'><joint name='hinge' axis='0 1 0'/><geom type='capsule' size='.02' fromto='0 0 0 0 0 -1'/></body></worldbody><actuator><motor joint='hinge' ctrlrange='-1 1' ctrllimited='true'/></actuator></mujoco>", "controller": "data.ctrl[0] = 0.5 - data.qpos[0]", "stopAt": 0.5, "readouts": [{"label": "angle", "expr": "data.qpos[0]"}]}"#,
    ),
};

/// Runs with fewer samples are inconclusive.
const MIN_SAMPLES: usize = 10;

pub(crate) fn check_saturation(observed: &ObservedLab<'_>, findings: &mut Vec<Finding>) {
    let ready = observed.bench.ready;
    let Some(first) = observed.records.first() else { return };
    for (i, (_, value)) in first.beyond.times.iter().enumerate() {
        let always =
            |b: &InputsOutOfRange| b.looks >= MIN_SAMPLES && b.times.get(i).is_some_and(|t| t.0 == b.looks);
        if !observed.records.iter().all(|r| always(&r.beyond)) {
            continue;
        }
        let [low, high] =
            [0, 1].map(|k| ready.model.actuator_ctrlrange.get(2 * i + k).copied().unwrap_or(0.0));
        let name = ready.model.names.of_kind(Obj::Actuator).get(i).filter(|n| !n.is_empty());
        let subject = name.map_or_else(|| format!("data.ctrl[{i}]"), |n| format!("the input of \"{n}\""));
        findings.push(
            Finding::warning(ALWAYS_SATURATED, ready.lab.place(), format!("{subject} is outside its range all the time"))
                .why(format!(
                    "it is {} in the run of the lab as it stands, but its `ctrlrange` is {low} to {high}; it is outside this range at every sample of {}, so the engine clamps it",
                    digits(*value, 4), observed.runs()
                ))
                .help("check the unit and the gain of what computes it, or widen `ctrlrange`"),
        );
    }
}
