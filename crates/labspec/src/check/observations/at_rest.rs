//! A lab that says that it begins at rest, and does not.

use super::ObservedLab;
use crate::check::setconst::digits;
use crate::finding::Finding;
use crate::rules;
use crate::run::{self, Play};
use crate::source::Text;
use std::ops::ControlFlow;

/// How long it is observed at, s, and what it may move in that time (m or rad): contacts settle by less than that.
const LENGTH: f64 = 0.2;
const SETTLES: f64 = 2e-3;
const WORDS: [&str; 3] = ["starts at rest", "begins at rest", "in equilibrium"];

pub(super) fn check_at_rest(observed: &ObservedLab<'_>, findings: &mut Vec<Finding>) {
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
            Finding::new(rules::NOT_AT_REST, text.span(), "this lab is described as at rest, but it moves")
                .why(format!("from keyframe {key}, data.qpos[{i}] moves by {far} in {time} s"))
                .help("correct the keyframe or the description"),
        );
    }
}
