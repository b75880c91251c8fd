//! The curves of a lab in a run: its traces over time, for a report that draws them.

use super::bound::BoundVerify;
use super::bound_run::BoundRun;
use super::run_cache::RunCache;
use super::runner::{self, RunRequest};
use crate::run::{Session, StepVariant};
use crate::spec::Plot;
use labspec_expr::Value;
use std::ops::Range;

/// Maximum number of samples of a run. A curve in a report is fewer pixels wide.
const SAMPLES: usize = 300;

/// The traces of a lab in one run of a `verify` object.
#[derive(Clone, Debug, PartialEq)]
pub struct Curves {
    /// The name of the run in conditions: `fine`, `fall[2]`.
    pub run: String,
    /// The bytes of the lab in the lesson.
    pub lab: Range<usize>,
    /// Its title, possibly empty.
    pub title: String,
    /// Its plots.
    pub plots: Vec<Plot>,
    /// Times of the samples, s.
    pub times: Vec<f64>,
    /// The values of every trace, plot after plot; NaN where a trace has no number.
    pub values: Vec<Vec<f64>>,
}

/// Repeats a run and samples the traces of the lab. `None` where it cannot be executed, or the lab has no trace.
fn record_curves(request: &RunRequest<'_, '_>, stage: &RunCache<'_>) -> Option<Curves> {
    let scene = &request.scene.scene;
    let (lab, programs) = (&*scene.lab, &*scene.programs);
    let traces = lab.traces().count();
    if traces == 0 {
        return None;
    }
    let mut ready = runner::prepare_run(request, stage, &mut Vec::new())?;
    let every = ready.count.div_ceil(SAMPLES).max(1);
    let mut times = Vec::new();
    let mut values = vec![Vec::new(); traces];
    let mut take = |session: &mut Session<'_>| {
        times.push(session.world.data.time());
        for (probe, column) in programs.probes.iter().zip(&mut values) {
            let value = probe.bound.as_ref().and_then(|b| session.evaluate(&b.program, &b.text));
            column.push(match value {
                Some(Value::Number(x)) => x,
                Some(Value::Boolean(holds)) => f64::from(u8::from(holds)),
                _ => f64::NAN,
            });
        }
    };
    let mut seen = 0;
    runner::play(request, &mut ready, |session, made| {
        seen = made;
        if made % every == 0 {
            take(session);
        }
    });
    // The last sample, where the run stopped.
    if seen % every != 0 && ready.session.ended().is_none() {
        take(&mut ready.session);
    }
    stage.spend(ready.session.spent());
    Some(Curves {
        run: request.run.title(),
        lab: lab.span.clone(),
        title: lab.title().to_string(),
        plots: lab.plots.clone(),
        times,
        values,
    })
}

impl<'a> BoundVerify<'a> {
    /// The traces of the lab in the first `most` runs. Runs that cannot be executed and labs without traces are left out.
    pub(crate) fn curves(&self, most: usize) -> Vec<Curves> {
        let one = |run: &BoundRun<'a>| {
            let (scene, place) = (self.scene_of(run)?, self.verify.span.clone());
            let request = RunRequest { scene, run, numerics: StepVariant::NOMINAL, measures: &[], place };
            record_curves(&request, self.stage)
        };
        self.runs.iter().take(most).filter_map(one).collect()
    }
}
