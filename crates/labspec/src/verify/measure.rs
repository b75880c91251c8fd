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

/// Why a measure has no value.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum NoValue {
    /// Samples had no number.
    Samples(MissingSamples),
    /// What an aggregate waits for did not happen: the aggregate as written, and what did not happen.
    Event { part: String, what: String },
}

impl NoValue {
    /// Whether two measures wait for the same event, which does not happen.
    pub(super) fn is_same_event(&self, other: &NoValue) -> bool {
        match (self, other) {
            (NoValue::Event { part: a, .. }, NoValue::Event { part: b, .. }) => {
                first_argument(a).is_some_and(|event| first_argument(b) == Some(event))
            }
            _ => false,
        }
    }
}

/// The first argument of a call, without spaces.
fn first_argument(call: &str) -> Option<String> {
    let (_, arguments) = call.split_once('(')?;
    let mut depth = 0;
    let mut quote = None;
    let end = arguments.find(|c: char| {
        match (quote, c) {
            (Some(open), c) if c == open => quote = None,
            (Some(_), _) => {}
            (None, '\'' | '"') => quote = Some(c),
            (None, '(' | '[') => depth += 1,
            (None, ')' | ']') if depth > 0 => depth -= 1,
            (None, ',' | ')') if depth == 0 => return true,
            (None, _) => {}
        }
        false
    })?;
    Some(arguments.get(..end)?.split_whitespace().collect())
}

impl std::fmt::Display for NoValue {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            NoValue::Samples(missing) => missing.fmt(f),
            NoValue::Event { part, what } => write!(f, "in `{part}`, {what}"),
        }
    }
}

/// The result of a measure.
#[derive(Clone, Debug)]
pub(crate) struct Sampled {
    /// Its value; NaN where samples without a number leave it undecided.
    pub(crate) value: f64,
    /// The results of its aggregates, in order.
    pub(crate) parts: Vec<f64>,
    /// Why it has no value, if that is known.
    pub(crate) no_value: Option<NoValue>,
    /// The aggregate whose event happens at the first sample, as written.
    pub(crate) at_start: Option<String>,
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
        let value = if sample_gap.is_some() { f64::NAN } else { value };
        let event = || {
            let mut absent = self.running.iter().zip(self.program.aggregates());
            let (what, aggregate) = absent.find_map(|(r, aggregate)| Some((r.absent_event()?, aggregate)))?;
            Some(NoValue::Event { part: part(aggregate.span.start, aggregate.span.end), what })
        };
        let no_value = match sample_gap {
            Some(missing) => Some(NoValue::Samples(missing)),
            None => value.is_nan().then(event).flatten(),
        };
        let mut at_start = self.running.iter().zip(self.program.aggregates()).filter(|(r, _)| r.at_start);
        let at_start = at_start.next().map(|(_, aggregate)| part(aggregate.span.start, aggregate.span.end));
        Sampled { value, parts: self.parts(), no_value, at_start }
    }
}
