use crate::check::observations::ObservedLab;
use crate::check::setconst::digits;
use crate::run::{self, Play};
use crate::source::Text;
use labspec_finding::{Example, Finding, Layer, Rule, Severity};
use std::ops::ControlFlow;

/// A lab says that it begins at rest or in equilibrium, but its keyframe is not an equilibrium.
pub const NOT_AT_REST: &Rule = &Rule {
    code: "not-at-rest",
    severity: Severity::Note,
    exceptions: &[],
    layer: Layer::Run,
    summary: "a lab says that it begins at rest or in equilibrium, but its keyframe is not an equilibrium",
    why: "a student sees it move from the start, and looks for the reason in the control they changed",
    bad: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><body name='rod'><joint name='hinge' axis='0 1 0'/><geom type='capsule' size='.02' fromto='0 0 0 0 0 -1'/></body></worldbody><keyframe><key qpos='.3'/></keyframe></mujoco>", "key": 0, "note": "⟦The rod starts at rest in equilibrium.⟧", "stopAt": 0.5, "readouts": [{"label": "angle", "expr": "data.qpos[0]"}]}"#,
    ),
    good: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><body name='rod'><joint name='hinge' axis='0 1 0'/><geom type='capsule' size='.02' fromto='0 0 0 0 0 -1'/></body></worldbody><keyframe><key qpos='.3'/></keyframe></mujoco>", "key": 0, "note": "The rod is let go.", "stopAt": 0.5, "readouts": [{"label": "angle", "expr": "data.qpos[0]"}]}"#,
    ),
};

/// The observed time, s, and the motion that is tolerated in that time, m or rad: contacts settle by less.
const LENGTH: f64 = 0.2;
const SETTLES: f64 = 2e-3;
const WORDS: [&str; 3] = ["starts at rest", "begins at rest", "in equilibrium"];

pub(crate) fn check_at_rest(observed: &ObservedLab<'_>, findings: &mut Vec<Finding>) {
    let ready = observed.bench.ready;
    let texts: [Option<&Text>; 2] = [ready.lab.title.as_ref(), ready.lab.note.as_ref()];
    let speaks_of_rest = |text: &&Text| {
        let text = text.as_str().to_lowercase();
        WORDS.iter().any(|w| text.contains(w))
    };
    let (Some(text), Some(key)) = (texts.into_iter().flatten().find(speaks_of_rest), ready.lab.keyframe())
    else {
        return;
    };
    let mut session = observed.bench.start();
    let timestep = session.world.model.opt.timestep;
    let start = session.world.data.fields().qpos.clone();
    let steps = (LENGTH / timestep).clamp(1.0, 1000.0) as usize;
    run::play(&mut session, &Play::steps(steps), |_, _| ControlFlow::Continue(()));
    let moved =
        start.iter().zip(&session.world.data.fields().qpos).enumerate().map(|(i, (a, b))| (i, (b - a).abs()));
    if session.ended().is_some() {
        return;
    }
    if let Some((i, far)) = moved.max_by(|a, b| a.1.total_cmp(&b.1)).filter(|(_, far)| *far > SETTLES) {
        let [far, time] = [far, session.world.data.time()].map(|x| digits(x, 3));
        findings.push(
            Finding::new(NOT_AT_REST, text.span(), "this lab is described as at rest, but it moves")
                .why(format!("from keyframe {key}, data.qpos[{i}] moves by {far} in {time} s"))
                .help("correct the keyframe or the description"),
        );
    }
}
