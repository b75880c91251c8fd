//! The rows of the pipeline by the clock: the same calls in the same order, with a look at the clock between them.

use crate::model::Model;
use crate::model::stage::Stage;
use crate::step::workspace::Workspace;

/// The bit of a pass that is walked by the clock.
pub(super) const CLOCKED: u32 = 1 << 31;

/// Runs what the bits say, one by one, and notes what each took; before them a call of nothing, which shows what looking costs.
#[cold]
#[inline(never)]
pub(super) fn walk(
    rows: &[fn(&Model, &mut Workspace)],
    stages: &[Stage],
    m: &Model,
    d: &mut Workspace,
    bits: u32,
) {
    if let Some(watch) = &mut d.work.watch {
        watch.begin();
    }
    lap(nothing, None, m, d);
    let kept_rows = rows.iter().zip(stages).enumerate().filter(|(i, _)| bits & (1 << i) != 0);
    kept_rows.for_each(|(_, (run, stage))| lap(*run, Some(*stage), m, d));
    if let Some(watch) = &mut d.work.watch {
        watch.end();
    }
}

/// Runs one of them, or nothing, between two looks at the clock.
#[inline(never)]
fn lap(run: fn(&Model, &mut Workspace), stage: Option<Stage>, m: &Model, d: &mut Workspace) {
    let clock = d.work.watch.as_ref().map(|watch| watch.clock);
    let before = clock.map(|clock| (d.meter.cost, clock()));
    run(m, d);
    let now = clock.map(|clock| clock());
    if let (Some(watch), Some((work, time)), Some(now)) = (&mut d.work.watch, before, now) {
        watch.laps.add(stage, now.saturating_sub(time), d.fields.meter.cost.saturating_sub(work));
    }
}

fn nothing(_: &Model, _: &mut Workspace) {}
