//! Where the time of a step goes: a stopwatch for the stages. The engine has no clock of its own (a browser gives none to a
//! module): whoever measures brings one.

use super::stage::Stage;

/// What a stage took since the stopwatch was started.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Lap {
    /// How often it ran: a stage with parts in a pass of positions and of velocities runs twice in a pass.
    pub runs: u64,
    /// Time on the caller's clock, with what looking at it takes.
    pub time: u64,
    /// The work that it counted, in units of about a nanosecond: the same on every machine.
    pub work: u64,
}

/// A clock, and what each stage took by it.
#[derive(Clone, Debug)]
pub(crate) struct Stopwatch {
    pub(crate) clock: fn() -> u64,
    laps: Vec<(Option<Stage>, Lap)>,
}

impl PartialEq for Stopwatch {
    /// Two clocks cannot be told apart; what they have measured can.
    fn eq(&self, other: &Stopwatch) -> bool {
        self.laps == other.laps
    }
}

impl Stopwatch {
    pub(crate) fn new(clock: fn() -> u64) -> Stopwatch {
        Stopwatch { clock, laps: Vec::new() }
    }

    /// Adds one run of a stage, or of nothing.
    pub(crate) fn add(&mut self, stage: Option<Stage>, time: u64, work: u64) {
        let lap = match self.laps.iter().position(|(s, _)| *s == stage) {
            Some(i) => self.laps.get_mut(i),
            None => {
                self.laps.push((stage, Lap::default()));
                self.laps.last_mut()
            }
        };
        if let Some((_, lap)) = lap {
            *lap = Lap { runs: lap.runs + 1, time: lap.time + time, work: lap.work + work };
        }
    }

    /// What a stage took, or nothing.
    pub(crate) fn lap(&self, stage: Option<Stage>) -> Lap {
        self.laps.iter().find(|(s, _)| *s == stage).map_or(Lap::default(), |(_, lap)| *lap)
    }
}
