//! Measures the time of each stage. The engine has no clock (in a browser, a module has no access to one), so the caller provides
//! one.

use super::stage::Stage;

/// The cost of the runs of a stage.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct StageTime {
    /// Number of runs. A stage that has a part in the position pass and one in the velocity pass runs twice per forward pass.
    pub runs: u64,
    /// Time on the caller's clock, including the time of reading the clock.
    pub time: u64,
    /// Counted work, in units of about a nanosecond. It is the same on every machine.
    pub work: u64,
}

impl StageTime {
    fn add(&mut self, time: u64, work: u64) {
        *self = StageTime { runs: self.runs + 1, time: self.time + time, work: self.work + work };
    }
}

/// The cost of each stage.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct StageTimes {
    stages: Vec<(Stage, StageTime)>,
    /// The cost of an empty call, measured once per part of a pass. Every measured run includes this cost of reading the clock.
    pub nothing: StageTime,
    /// The time between the parts of passes: integrators, the check for bad numbers, and the caller's work between steps.
    pub between: StageTime,
}

impl StageTimes {
    /// The cost of a stage.
    pub fn stage_time(&self, stage: Stage) -> StageTime {
        self.stages
            .iter()
            .find(|(s, _)| *s == stage)
            .map_or(StageTime::default(), |(_, stage_time)| *stage_time)
    }

    /// Adds one run of a stage, or of an empty call.
    pub(crate) fn add(&mut self, stage: Option<Stage>, time: u64, work: u64) {
        let Some(stage) = stage else { return self.nothing.add(time, work) };
        match self.stages.iter_mut().find(|(s, _)| *s == stage) {
            Some((_, stage_time)) => stage_time.add(time, work),
            None => self.stages.push((stage, StageTime { runs: 1, time, work })),
        }
    }
}

/// A clock, and the measured costs.
#[derive(Clone, Debug)]
pub struct Stopwatch {
    pub(crate) clock: fn() -> u64,
    /// Time and runs of each stage so far.
    pub stage_times: StageTimes,
    /// The time at which the last part of a pass ended.
    pub ended: Option<u64>,
}

impl PartialEq for Stopwatch {
    /// Compares the measurements. The clocks cannot be compared.
    fn eq(&self, other: &Stopwatch) -> bool {
        (&self.stage_times, self.ended) == (&other.stage_times, other.ended)
    }
}

impl Stopwatch {
    pub(crate) fn new(clock: fn() -> u64) -> Stopwatch {
        Stopwatch { clock, stage_times: StageTimes::default(), ended: None }
    }

    /// Records the start of a part of a pass.
    pub(crate) fn begin(&mut self) {
        if let Some(ended) = self.ended.take() {
            self.stage_times.between.add((self.clock)().saturating_sub(ended), 0);
        }
    }

    /// Records its end.
    pub(crate) fn end(&mut self) {
        self.ended = Some((self.clock)());
    }
}
