use crate::check::observations::ObservedLab;
use crate::check::setconst::digits;
use crate::run::{self, Play, Session, Start};
use labspec_core::{Plan, half_thickness_of_pair};
use labspec_finding::{Example, Finding, Layer, Rule, Severity};
use labspec_monitors::stress::geom_label;
use std::ops::ControlFlow;

/// A body begins deep inside another one.
pub const STARTS_INSIDE: &Rule = &Rule {
    code: "starts-inside",
    severity: Severity::Warning,
    exceptions: &[],
    layer: Layer::Run,
    summary: "a body begins deep inside another one",
    why: "the contact throws it out in the first steps: what a student sees at the start is not physics",
    bad: Example::Lab(
        r#"{"xml": "⟦<mujoco><worldbody><geom name='floor' type='plane' size='1 1 1'/><body name='ball' pos='0 0 0.02'><freejoint/><geom name='ball' size='.05' mass='1'/></body></worldbody></mujoco>⟧", "stopAt": 0.5, "readouts": [{"label": "height (m)", "expr": "data.qpos[2]"}]}"#,
    ),
    good: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><geom name='floor' type='plane' size='1 1 1'/><body name='ball' pos='0 0 0.05'><freejoint/><geom name='ball' size='.05' mass='1'/></body></worldbody></mujoco>", "stopAt": 0.5, "readouts": [{"label": "height (m)", "expr": "data.qpos[2]"}]}"#,
    ),
};

/// The largest normal depth of a contact, as a fraction of half the thickness of the smaller geom.
const MAX_DEPTH_FRACTION: f64 = 0.3;
/// The number of steps within which a penetration must halve to count as an ejection.
const STEPS: usize = 200;

pub(crate) fn check_start(observed: &ObservedLab<'_>, findings: &mut Vec<Finding>) {
    let ready = observed.bench.ready;
    // All stages: a reduced plan does not compute contacts that nothing reads.
    let start = Start { plan: Some(Plan::full()), ..Start::of_lab(ready.lab) };
    let mut session = Session::start(&ready.programs, &ready.model, start);
    let Some((pair, depth)) = deepest(&session) else { return };
    let mut out = None;
    run::play(&mut session, &Play::steps(STEPS), |session, step| {
        let left = contact(session, pair);
        if step > 0 && left <= 0.5 * depth {
            out = Some(session.world.data.time());
            return ControlFlow::Break(());
        }
        ControlFlow::Continue(())
    });
    let Some(time) = out else { return };
    let [a, b] = pair.map(|g| geom_label(&ready.model, g));
    let [depth, time] = [1000.0 * depth, time].map(|x| digits(x, 3));
    findings.push(
        Finding::warning(STARTS_INSIDE, ready.lab.place(), format!("{b} begins {depth} mm inside {a}"))
            .why(format!("the contact throws it out: half of that depth is gone after {time} s, and its speed is not physical"))
            .help("move it in the model, in the keyframe or in the setup, so that the two only touch"),
    );
}

/// The deepest contact of a movable body that exceeds the limit.
fn deepest(session: &Session<'_>) -> Option<([usize; 2], f64)> {
    let (model, data) = (&session.world.model, session.world.data.fields());
    let deep = data.contact.iter().filter_map(|c| {
        let pair = [c.geom1, c.geom2];
        let size = half_thickness_of_pair(model, pair);
        (c.efc_address.is_some() && -c.dist > MAX_DEPTH_FRACTION * size).then_some((pair, -c.dist))
    });
    deep.max_by(|a, b| a.1.total_cmp(&b.1))
}

/// The penetration depth of these two geoms.
fn contact(session: &Session<'_>, pair: [usize; 2]) -> f64 {
    let all = session.world.data.fields().contact.iter();
    let of_pair = all.filter(|c| [c.geom1, c.geom2] == pair);
    of_pair.map(|c| -c.dist).fold(0.0, f64::max)
}
