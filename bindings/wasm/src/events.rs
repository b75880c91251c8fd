//! Events that stop a run of a page at the step at which they occur: contacts that begin or end, and warnings of the engine.

use labspec::player::touching_pairs;
use labspec_core::{Fields, Warning};

/// The observed state after the last step.
#[derive(Default)]
pub(crate) struct Watched {
    /// The pairs of geoms in contact.
    touching: Vec<(usize, usize)>,
    /// The number of times that each warning was raised since the last reset of the data.
    warnings: [usize; Warning::COUNT],
    /// Time after the last step and before it, s.
    time: f64,
    pub(crate) before: f64,
}

impl Watched {
    /// Stores the counts of warnings and the time before a step.
    pub(crate) fn start(&mut self, fields: &Fields) {
        (self.warnings, self.time) = (fields.warning.map(|w| w.number), fields.time);
    }

    /// Whether the pairs of geoms in contact have changed.
    pub(crate) fn touches_otherwise(&mut self, fields: &Fields) -> bool {
        let current = touching_pairs(fields);
        let other = current != self.touching;
        self.touching = current;
        other
    }

    /// Whether the engine raised a warning in this step. A bad number resets the data and its counts, and is counted afterwards.
    pub(crate) fn warns(&mut self, fields: &Fields) -> bool {
        self.before = self.time;
        let counted = if fields.time < self.time { [0; Warning::COUNT] } else { self.warnings };
        self.start(fields);
        self.warnings.iter().zip(&counted).any(|(current, before)| current > before)
    }
}
