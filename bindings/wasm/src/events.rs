//! What a page is told at the step at which it happens: contacts that begin or end, and warnings of the engine.

use labspec_core::{Fields, Warning};
use labspec_finding::order;

/// What was seen after the last step.
#[derive(Default)]
pub(crate) struct Watched {
    /// The pairs of geoms that touched.
    touching: Vec<(usize, usize)>,
    /// How often each warning was raised since the data were reset.
    warnings: [usize; Warning::COUNT],
    /// Time after the last step and before it, s.
    time: f64,
    pub(crate) before: f64,
}

impl Watched {
    /// Takes what is so before a step.
    pub(crate) fn start(&mut self, fields: &Fields) {
        (self.warnings, self.time) = (fields.warning.map(|w| w.number), fields.time);
    }

    /// Whether other geoms touch now.
    pub(crate) fn touches_otherwise(&mut self, fields: &Fields) -> bool {
        let now = touching_pairs(fields);
        let other = now != self.touching;
        self.touching = now;
        other
    }

    /// Whether the engine warned in this step. A bad number resets the data and their counts, and is counted then.
    pub(crate) fn warns(&mut self, fields: &Fields) -> bool {
        self.before = self.time;
        let counted = if fields.time < self.time { [0; Warning::COUNT] } else { self.warnings };
        self.start(fields);
        self.warnings.iter().zip(&counted).any(|(now, before)| now > before)
    }
}

/// The pairs of geoms that touched in the last step.
pub(crate) fn touching_pairs(fields: &Fields) -> Vec<(usize, usize)> {
    let pairs = fields.contact.iter().filter(|c| c.exclude == 0).map(|c| (c.geom1, c.geom2));
    let mut pairs: Vec<(usize, usize)> = pairs.collect();
    order::sort_by(&mut pairs, Ord::cmp);
    pairs.dedup();
    pairs
}
