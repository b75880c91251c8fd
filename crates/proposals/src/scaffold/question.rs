//! The text of a question, with its options and numbers, and what is common to all forms of questions.

use super::decision::{Condition, Meaning, Term};
use super::quantity::{self, AskedQuantity};
use super::relation::Relation;
use crate::trace::{ProposedVerify, TraceRun, TracedLab, si};
use labspec::source::Text;
use labspec::spec::Question;
use labspec::verify::{Stated, plain};

/// What is known of a question that cannot be decided: the reason, and a skeleton with its runs and its measure.
pub(super) struct Undecided {
    pub(super) why: String,
    pub(super) skeleton: Option<Box<ProposedVerify>>,
}

impl From<String> for Undecided {
    fn from(why: String) -> Self {
        Undecided { why, skeleton: None }
    }
}

/// The text of a question in lower case, its options, and the numbers that it states.
pub(super) struct QuestionText {
    pub(super) text: String,
    pub(super) options: Vec<String>,
    pub(super) stated: Vec<Stated>,
}

impl QuestionText {
    pub(super) fn new(question: &Question, options: &[Text], numbers: &[Stated]) -> QuestionText {
        let lower = |html: &str| plain(html).to_lowercase();
        // Only numbers in the question itself are settings; numbers only in its options and explanation are results.
        let span = question.q.span();
        let of_question = |n: &&Stated| span.start <= n.span.start && n.span.end <= span.end && !n.answer;
        QuestionText {
            text: lower(&question.q.value),
            options: options.iter().map(|o| lower(&o.value)).collect(),
            stated: numbers.iter().filter(of_question).cloned().collect(),
        }
    }

    /// The times that the question states, s, without timesteps and time constants.
    pub(super) fn times(&self, runs: &[TraceRun]) -> Vec<f64> {
        let is_time = |s: &&Stated| s.unit.ends_with('s') && !s.unit.contains(['/', ' ']);
        let times = self.stated.iter().filter(is_time).map(si);
        let set: Vec<f64> = runs.iter().filter_map(|run| run.timestep).collect();
        times.filter(|t| *t > SHORTEST_TIME && !set.contains(t)).collect()
    }

    /// The measures that the question can mean.
    pub(super) fn quantity(&self, tried: &TracedLab<'_>, text: &str, runs: &[TraceRun]) -> AskedQuantity {
        let end = tried.lab.stop_at.as_ref().map(|stop| stop.value);
        quantity::measures(&tried.candidates, text, &self.options.join("\n"), &self.times(runs), end)
    }

    /// The measures that one option can mean.
    pub(super) fn quantity_of_option(
        &self,
        tried: &TracedLab<'_>,
        option: &str,
        runs: &[TraceRun],
    ) -> AskedQuantity {
        let end = tried.lab.stop_at.as_ref().map(|stop| stop.value);
        quantity::measures(&tried.candidates, option, "", &self.times(runs), end)
    }

    /// Whether the runs keep their length, because the question states a time at which the lab ends.
    pub(super) fn is_fixed(&self, tried: &TracedLab<'_>, runs: &[TraceRun]) -> bool {
        tried.lab.stop_at.is_some() && !self.times(runs).is_empty()
    }
}

/// Shorter times in a question are timesteps and time constants.
const SHORTEST_TIME: f64 = 0.05;

/// The meanings of relations between the two runs of a comparison.
pub(super) fn compared(quantity: &AskedQuantity, relations: &[Option<Relation>]) -> Vec<Vec<Meaning>> {
    let condition =
        |r: &Option<Relation>| r.map(|relation| Condition::Relation { relation, a: 0, b: 1, negated: false });
    let meaning = |candidate: &usize| Meaning {
        terms: [0, 1].map(|run| Term { run, candidate: *candidate }).to_vec(),
        conditions: relations.iter().map(condition).collect(),
        is_explicit: quantity.is_explicit,
    };
    quantity.groups.iter().map(|group| group.iter().map(meaning).collect()).collect()
}
