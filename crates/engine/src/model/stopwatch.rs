//! Where the time of a step goes: a stopwatch for the stages. The engine has no clock of its own (a browser gives none to a
//! module): whoever measures brings one.

use super::stage::Stage;

/// What something took.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct StageTime {
    /// How often it ran: a stage with parts in a pass of positions and of velocities runs twice in a pass.
    pub runs: u64,
    /// Time on the caller's clock, with what looking at it takes.
    pub time: u64,
    /// The work that it counted, in units of about a nanosecond: the same on every machine.
    pub work: u64,
}

impl StageTime {
    fn add(&mut self, time: u64, work: u64) {
        *self = StageTime { runs: self.runs + 1, time: self.time + time, work: self.work + work };
    }
}

/// What the stages took.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct StageTimes {
    stages: Vec<(Stage, StageTime)>,
    /// Of a call of nothing, once for each part of a pass: that much of every run is the looking.
    pub nothing: StageTime,
    /// Between the parts of passes: integrators, the look for numbers that are none, and what the caller does between steps.
    pub between: StageTime,
}

impl StageTimes {
    /// What a stage took.
    pub fn stage_time(&self, stage: Stage) -> StageTime {
        self.stages.iter().find(|(s, _)| *s == stage).map_or(StageTime::default(), |(_, lap)| *lap)
    }

    /// Adds one run of a stage, or of nothing.
    pub(crate) fn add(&mut self, stage: Option<Stage>, time: u64, work: u64) {
        let Some(stage) = stage else { return self.nothing.add(time, work) };
        match self.stages.iter_mut().find(|(s, _)| *s == stage) {
            Some((_, lap)) => lap.add(time, work),
            None => self.stages.push((stage, StageTime { runs: 1, time, work })),
        }
    }
}

/// A clock, and what the stages took by it.
#[derive(Clone, Debug)]
pub struct Stopwatch {
    pub(crate) clock: fn() -> u64,
    /// Time and runs of each stage so far.
    pub laps: StageTimes,
    /// When the last part of a pass ended.
    pub ended: Option<u64>,
}

impl PartialEq for Stopwatch {
    /// Two clocks cannot be compared; what they have measured can.
    fn eq(&self, other: &Stopwatch) -> bool {
        (&self.laps, self.ended) == (&other.laps, other.ended)
    }
}

impl Stopwatch {
    pub(crate) fn new(clock: fn() -> u64) -> Stopwatch {
        Stopwatch { clock, laps: StageTimes::default(), ended: None }
    }

    /// A part of a pass begins.
    pub(crate) fn begin(&mut self) {
        if let Some(ended) = self.ended.take() {
            self.laps.between.add((self.clock)().saturating_sub(ended), 0);
        }
    }

    /// It ends.
    pub(crate) fn end(&mut self) {
        self.ended = Some((self.clock)());
    }
}
