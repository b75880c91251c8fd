//! Measures: an expression evaluated over all samples of a run.

use super::aggregate::RunningAggregate;
use super::sample::Sample;
use crate::source::Text;
use labspec_expr::{Program, Watch};

/// Why a measure has no value although its events happened: some samples had no number.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct MissingSamples {
    /// The part of the measure, as written.
    pub(crate) part: String,
    /// Number of samples without a number, and of all samples.
    pub(crate) gaps: usize,
    pub(crate) samples: usize,
    /// Time of the first sample without a number, s.
    pub(crate) first: f64,
}

impl std::fmt::Display for MissingSamples {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let MissingSamples { part, gaps, samples, first } = self;
        if *samples == 0 {
            return write!(f, "`{part}` compares NaN");
        }
        let first = crate::run::time(*first);
        let verb = if *gaps == 1 { "has" } else { "have" };
        write!(f, "in `{part}` {gaps} of {samples} samples {verb} no number, the first at t = {first} s")
    }
}

/// The result of a measure.
#[derive(Clone, Debug)]
pub(crate) struct Sampled {
    /// Its value; NaN where samples without a number leave it undecided.
    pub(crate) value: f64,
    /// The results of its aggregates, in order.
    pub(crate) parts: Vec<f64>,
    pub(crate) sample_gap: Option<MissingSamples>,
}

/// The aggregates of one measure.
#[derive(Debug)]
pub(super) struct Measure<'a> {
    program: &'a Program,
    text: &'a Text,
    running: Vec<RunningAggregate<'a>>,
    samples: usize,
    /// Observes lost numbers in the programs of this measure only.
    watch: Option<Box<Watch>>,
}

impl<'a> Measure<'a> {
    /// A measure before the first sample.
    pub(super) fn new(program: &'a Program, text: &'a Text) -> Measure<'a> {
        let watch = Some(Box::new(Watch::losses()));
        Measure { program, text, running: RunningAggregate::all(program), samples: 0, watch }
    }

    /// Processes the current sample.
    pub(super) fn sample(&mut self, session: &mut dyn Sample) {
        self.samples += 1;
        session.context().watch(self.watch.take());
        self.running.iter_mut().for_each(|r| r.sample(session, self.text));
        self.watch = session.context().watch(None);
    }

    /// The results of its aggregates at the end of the run.
    pub(super) fn parts(&self) -> Vec<f64> {
        self.running.iter().map(RunningAggregate::result).collect()
    }

    /// The value of the measure at the end of the run.
    pub(super) fn finish(mut self, session: &mut dyn Sample) -> Sampled {
        for r in &self.running {
            session.context().set_aggregate(r.slot, r.result());
        }
        session.context().watch(self.watch.take());
        let value = session.evaluate(self.program, self.text).map_or(f64::NAN, |v| v.to_number());
        let lost = session.context().watch(None).and_then(|watch| watch.lost);
        let part = |start: usize, end: usize| {
            self.text.value.get(start..end).unwrap_or(&self.text.value).to_string()
        };
        let open = self.running.iter().zip(self.program.aggregates()).find(|(r, _)| r.gaps.count > 0);
        let sample_gap = match (open, lost) {
            (Some((r, aggregate)), _) => Some(MissingSamples {
                part: part(aggregate.span.start, aggregate.span.end),
                gaps: r.gaps.count,
                samples: self.samples,
                first: r.gaps.first,
            }),
            (None, Some(span)) => {
                Some(MissingSamples { part: part(span.start, span.end), gaps: 0, samples: 0, first: 0.0 })
            }
            (None, None) => None,
        };
        let parts = self.parts();
        Sampled { value: if sample_gap.is_some() { f64::NAN } else { value }, parts, sample_gap }
    }
}
