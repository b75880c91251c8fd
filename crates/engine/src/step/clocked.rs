//! Runs the rows of the pipeline with time measurement: the same calls in the same order, with a reading of the clock between
//! them.

use crate::model::stage::Stage;
use crate::model::{Fields, Model};
use crate::step::workspace::StepScratch;

/// The function of a stage: it reads the model, and writes the fields and the scratch.
pub(super) type Run = fn(&Model, &mut Fields, &mut StepScratch);

/// The bit of a pass that is run with time measurement.
pub(super) const CLOCKED: u32 = 1 << 31;

/// Runs the stages of the given bits one by one, and records the time of each. An empty call before them measures the cost of the
/// clock.
#[cold]
#[inline(never)]
pub(super) fn walk(
    rows: &[Run],
    stages: &[Option<Stage>],
    m: &Model,
    d: &mut Fields,
    s: &mut StepScratch,
    bits: u32,
) {
    if let Some(watch) = &mut s.watch {
        watch.begin();
    }
    run_stage(nothing, None, m, d, s);
    let kept_rows = rows.iter().zip(stages).enumerate().filter(|(i, _)| bits & !CLOCKED & (1 << i) != 0);
    kept_rows.for_each(|(_, (run, stage))| run_stage(*run, *stage, m, d, s));
    if let Some(watch) = &mut s.watch {
        watch.end();
    }
}

/// Runs one stage, or an empty call, between two readings of the clock.
#[inline(never)]
fn run_stage(run: Run, stage: Option<Stage>, m: &Model, d: &mut Fields, s: &mut StepScratch) {
    let clock = s.watch.as_ref().map(|watch| watch.clock);
    let before = clock.map(|clock| (d.meter.cost, clock()));
    run(m, d, s);
    let current = clock.map(|clock| clock());
    if let (Some(watch), Some((work, time)), Some(current)) = (&mut s.watch, before, current) {
        watch.stage_times.add(stage, current.saturating_sub(time), d.meter.cost.saturating_sub(work));
    }
}

/// Does nothing.
pub(super) fn nothing(_: &Model, _: &mut Fields, _: &mut StepScratch) {}
