//! What the runs of a question decide: numbers of runs, a condition for each option, and the options that hold.

use super::relation::{Relation, SAME};
use crate::trace::{Candidate, ProposedVerify, TraceRun, TracedLab};
use labspec::run::StepVariant;
use labspec::spec::format::RUN_LENGTH;
use labspec::verify::{HALVED, RunCache};

/// A number: a measure in a run, by their indexes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Term {
    pub(super) run: usize,
    pub(super) candidate: usize,
}

/// What an option states of the numbers, which it names by their indexes.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Condition {
    /// The second number is in this relation to the first one, or is not.
    Relation { relation: Relation, a: usize, b: usize, negated: bool },
    /// One number is larger than the others, or smaller.
    Extreme { which: usize, among: Vec<usize>, largest: bool },
}

/// A meaning of a question: its numbers, and the condition of each option whose words are understood.
#[derive(Clone, Debug)]
pub(super) struct Meaning {
    pub(super) terms: Vec<Term>,
    pub(super) conditions: Vec<Option<Condition>>,
    /// Whether the question states which values of the runs count, so that they may be those of the start.
    pub(super) is_explicit: bool,
}

/// A decided question.
pub(super) struct Decision<'t, 'l> {
    pub(super) tried: &'t TracedLab<'l>,
    runs: Vec<TraceRun>,
    meaning: Meaning,
    found: Vec<f64>,
    broke: bool,
    /// The options that hold, from 0.
    pub(super) holding: Vec<usize>,
}

/// The factor by which the largest of several numbers exceeds the others.
const OVER: f64 = 1.0 + SAME;

impl Condition {
    fn holds(&self, found: &[f64], broke: bool) -> bool {
        let value_of = |i: usize| found.get(i).copied().unwrap_or(f64::NAN);
        match self {
            Condition::Relation { relation, a, b, negated } => {
                relation.holds(value_of(*a), value_of(*b), broke) != *negated
            }
            Condition::Extreme { which, among, largest } => {
                let value = value_of(*which).abs();
                among.iter().filter(|i| *i != which).map(|i| value_of(*i).abs()).all(|other| match largest {
                    true => value > OVER * other,
                    false => OVER * value < other,
                })
            }
        }
    }

    fn text(&self, names: &[String], below: bool, broke: bool) -> String {
        let name = |i: &usize| names.get(*i).cloned().unwrap_or_default();
        match self {
            Condition::Relation { relation, a, b, negated } => {
                let (a, b) = (name(a), name(b));
                let run = b.split('.').next().unwrap_or("run").to_string();
                let text = relation.condition(&a, &b, &run, below);
                match (negated, broke && *relation != Relation::Breaks) {
                    (true, _) => format!("!({text})"),
                    (false, true) => format!("{run}.warnings == 0 && {text}"),
                    (false, false) => text,
                }
            }
            Condition::Extreme { which, among, largest } => {
                let size = |i: &usize| if below { format!("abs({})", name(i)) } else { name(i) };
                let value = size(which);
                let one = |i: &usize| match largest {
                    true => format!("{value} > {OVER} * {}", size(i)),
                    false => format!("{OVER} * {value} < {}", size(i)),
                };
                among.iter().filter(|i| *i != which).map(one).collect::<Vec<_>>().join(" && ")
            }
        }
    }

    fn shifted(&self, by: usize) -> Condition {
        match self.clone() {
            Condition::Relation { relation, a, b, negated } => {
                Condition::Relation { relation, a: a + by, b: b + by, negated }
            }
            Condition::Extreme { which, among, largest } => Condition::Extreme {
                which: which + by,
                among: among.into_iter().map(|i| i + by).collect(),
                largest,
            },
        }
    }
}

impl<'t, 'l> Decision<'t, 'l> {
    /// A decision by numbers that are known.
    pub(super) fn measured(
        tried: &'t TracedLab<'l>,
        runs: Vec<TraceRun>,
        meaning: Meaning,
        found: Vec<f64>,
    ) -> Decision<'t, 'l> {
        let holding = holding(&meaning, &found, false);
        Decision { tried, runs, meaning, found, broke: false, holding }
    }

    /// Returns a condition for each option; adds measures to the block, and their values to the list.
    pub(super) fn conditions(
        &self,
        block: &mut ProposedVerify,
        values: &mut Vec<(String, f64)>,
    ) -> Vec<String> {
        let named = |term: &Term| {
            let candidate = self.tried.candidates.get(term.candidate);
            let text = candidate.map_or("", |c| c.text.as_str());
            block.measured(term.run, self.runs.get(term.run), text, candidate)
        };
        let names: Vec<String> = self.meaning.terms.iter().map(named).collect();
        for (name, x) in names.iter().zip(&self.found) {
            if !values.iter().any(|(listed, _)| listed == name) {
                values.push((name.clone(), *x));
            }
        }
        let below = self.found.iter().any(|x| *x < 0.0);
        let text = |c: &Option<Condition>| {
            c.as_ref().map_or("undecided".to_string(), |c| c.text(&names, below, self.broke))
        };
        self.meaning.conditions.iter().map(text).collect()
    }

    /// Whether one of the runs has the settings of a run of the trace.
    pub(super) fn has_run(&self, trial: &TraceRun) -> bool {
        self.runs
            .iter()
            .any(|run| (&run.set, &run.press, &run.setup()) == (&trial.set, &trial.press, &trial.setup()))
    }

    /// Whether it reads a measure.
    pub(super) fn reads(&self, measure: &str) -> bool {
        let is_measure =
            |term: &Term| self.tried.candidates.get(term.candidate).is_some_and(|c| c.text == measure);
        self.meaning.terms.iter().any(is_measure)
    }

    /// The numbers with their descriptions.
    pub(super) fn values(&self) -> Vec<(String, f64)> {
        let describe = |term: &Term| {
            let text = self.tried.candidates.get(term.candidate).map_or("", |c| c.text.as_str());
            let words = self.runs.get(term.run).map_or("", |run| run.words.as_str());
            format!("{text}, {words}")
        };
        self.meaning.terms.iter().map(describe).zip(self.found.iter().copied()).collect()
    }

    /// Several decisions by the same runs, each of one option, as one.
    pub(super) fn merged(all: Vec<Decision<'t, 'l>>) -> Option<Decision<'t, 'l>> {
        let mut all = all.into_iter();
        let mut whole = all.next()?;
        whole.holding = if whole.holding.is_empty() { Vec::new() } else { vec![0] };
        for (i, one) in all.enumerate() {
            let by = whole.meaning.terms.len();
            whole.meaning.terms.extend(one.meaning.terms);
            whole.found.extend(one.found);
            whole
                .meaning
                .conditions
                .extend(one.meaning.conditions.iter().map(|c| c.as_ref().map(|c| c.shifted(by))));
            whole.holding.extend((!one.holding.is_empty()).then_some(i + 1));
            whole.broke |= one.broke;
        }
        Some(whole)
    }
}

fn holding(meaning: &Meaning, found: &[f64], broke: bool) -> Vec<usize> {
    let holds = |c: &Option<Condition>| c.as_ref().is_some_and(|c| c.holds(found, broke));
    meaning.conditions.iter().enumerate().filter(|(_, c)| holds(c)).map(|(i, _)| i).collect()
}

/// How many options may hold.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Expected {
    /// Exactly one; the others may be undecided.
    One,
    /// Any number, and all are decided.
    Any,
}

/// The factors by which runs become longer until a measure has a value.
const LONGER: [f64; 2] = [2.0, 4.0];

/// Makes the runs and decides the options: every meaning that has values must agree, at half the timestep too. If no meaning of a
/// group has values, those of the next group count. `fixed` runs keep their length.
///
/// # Errors
/// The reason why nothing is decided.
pub(super) fn settle<'t, 'l>(
    tried: &'t TracedLab<'l>,
    runs: Vec<TraceRun>,
    groups: &[Vec<Meaning>],
    (expected, fixed): (Expected, bool),
    stage: &RunCache<'_>,
) -> Result<Decision<'t, 'l>, String> {
    let table = RunTable::new(tried, runs, groups, fixed, stage)?;
    let meanings = groups.iter().map(|group| table.with_values(group)).find(|group| !group.is_empty());
    let Some(meanings) = meanings else {
        return Err("the measure has no value in these runs, or the value of the start".into());
    };
    // A timestep that the question states is not halved.
    let numerics = |run: &TraceRun| if run.timestep.is_some() { StepVariant::NOMINAL } else { HALVED };
    let halved: Vec<Vec<f64>> =
        table.runs.iter().map(|run| tried.values_of(run, stage, numerics(run))).collect();
    let mut decided: Option<(Meaning, Vec<f64>, Vec<usize>)> = None;
    for meaning in meanings {
        let found = table.found(&meaning, &table.values);
        let held = holding(&meaning, &found, table.broke);
        let is_open = meaning.conditions.iter().any(Option::is_none);
        if expected == Expected::One && held.len() != 1 || expected == Expected::Any && is_open {
            return Err("the measure does not decide between the options in these runs".into());
        }
        if holding(&meaning, &table.found(&meaning, &halved), table.broke) != held {
            return Err("half the timestep gives another result".into());
        }
        match &decided {
            Some((.., other)) if *other != held => {
                return Err("several measures can be meant, and they do not agree".into());
            }
            Some(_) => {}
            None => decided = Some((meaning, found, held)),
        }
    }
    let Some((meaning, found, holding)) = decided else { return Err("nothing is measured".into()) };
    Ok(Decision { tried, runs: table.runs, meaning, found, broke: table.broke, holding })
}

/// Whether the depth of a sphere is larger than its radius: then its coordinate is no height above the ground.
pub(super) fn is_no_depth(tried: &TracedLab<'_>, candidate: usize, values: &[f64]) -> bool {
    let text = tried.candidates.get(candidate).map_or("", |c| c.text.as_str());
    let size = text.split_once(" - ").map(|(size, _)| size).filter(|size| size.starts_with("model.geom("));
    let radius = size.and_then(|size| tried.candidates.iter().position(|c| c.text == size));
    let Some(radius) = radius else { return false };
    let [x, radius] = [candidate, radius].map(|i| values.get(i).copied().unwrap_or(f64::NAN));
    x.abs() >= radius
}

/// The values of all measures in all runs.
struct RunTable<'t, 'l> {
    tried: &'t TracedLab<'l>,
    runs: Vec<TraceRun>,
    values: Vec<Vec<f64>>,
    /// Whether a run after the first one breaks.
    broke: bool,
}

impl<'t, 'l> RunTable<'t, 'l> {
    fn new(
        tried: &'t TracedLab<'l>,
        runs: Vec<TraceRun>,
        groups: &[Vec<Meaning>],
        fixed: bool,
        stage: &RunCache<'_>,
    ) -> Result<Self, String> {
        let perform = |runs: &[TraceRun]| -> Vec<Vec<f64>> {
            runs.iter().map(|run| tried.values_of(run, stage, StepVariant::NOMINAL)).collect()
        };
        let is_broken = |values: &Vec<f64>| values.iter().all(|x| x.is_nan());
        let values = perform(&runs);
        if values.first().is_none_or(is_broken) {
            return Err("the run before the change breaks".into());
        }
        let broke = values.iter().any(is_broken);
        let mut table = RunTable { tried, runs, values, broke };
        let lacks = |table: &Self| groups.first().is_some_and(|group| table.with_values(group).is_empty());
        let end = tried.lab.stop_at.as_ref().map(|stop| stop.value);
        let given: Vec<f64> = table.runs.iter().map(|run| run.until.or(end).unwrap_or(RUN_LENGTH)).collect();
        for factor in LONGER {
            if fixed || !lacks(&table) || !groups.iter().flatten().any(|m| table.measures_time(m)) {
                break;
            }
            let mut longer = table.runs.clone();
            for (run, given) in longer.iter_mut().zip(&given) {
                run.until = Some(factor * given);
            }
            let values = perform(&longer);
            // A run that is too long has no values.
            if values.iter().any(is_broken) {
                break;
            }
            (table.runs, table.values) = (longer, values);
        }
        Ok(table)
    }

    fn candidate(&self, term: &Term) -> Option<&Candidate> {
        self.tried.candidates.get(term.candidate)
    }

    /// Whether a meaning reads the time of something that may come later.
    fn measures_time(&self, meaning: &Meaning) -> bool {
        let waits = |c: &Candidate| ["period(", "crossing(", "first("].iter().any(|f| c.text.starts_with(f));
        meaning.terms.iter().filter_map(|term| self.candidate(term)).any(waits)
    }

    fn found(&self, meaning: &Meaning, values: &[Vec<f64>]) -> Vec<f64> {
        let value_of = |term: &Term| values.get(term.run).and_then(|v| v.get(term.candidate)).copied();
        meaning.terms.iter().map(|term| value_of(term).unwrap_or(f64::NAN)).collect()
    }

    /// The meanings whose numbers exist and depend on the run.
    fn with_values(&self, group: &[Meaning]) -> Vec<Meaning> {
        let has_values = |meaning: &&Meaning| {
            let found = self.found(meaning, &self.values);
            let first = found.first().copied().unwrap_or(f64::NAN);
            let exist = found.iter().all(|x| x.is_finite() || self.broke);
            let compares =
                meaning.conditions.iter().flatten().any(|c| matches!(c, Condition::Relation { .. }));
            exist
                && first.is_finite()
                && (first != 0.0 || !compares)
                && (meaning.is_explicit || !self.is_start(meaning))
                && !self.is_no_depth(meaning)
        };
        group.iter().filter(has_values).cloned().collect()
    }

    /// Whether a meaning reads such a depth.
    fn is_no_depth(&self, meaning: &Meaning) -> bool {
        let exceeds = |term: &Term| {
            let values = self.values.get(term.run);
            values.is_some_and(|values| is_no_depth(self.tried, term.candidate, values))
        };
        meaning.terms.iter().any(exceeds)
    }

    /// Whether the extremes that a meaning reads are the values of the start in every run: they say nothing of the run.
    fn is_start(&self, meaning: &Meaning) -> bool {
        let is_initial = |term: &Term| {
            let Some(candidate) = self.candidate(term) else { return false };
            let extreme = candidate.text.strip_prefix("max").or_else(|| candidate.text.strip_prefix("min"));
            let inner = extreme.and_then(|inner| inner.strip_prefix('('));
            let Some(initial) = inner.and_then(|inner| self.tried.initial(inner)) else { return false };
            let Some(values) = self.values.get(term.run) else { return false };
            let [x, start] = [term.candidate, initial].map(|i| values.get(i).copied().unwrap_or(f64::NAN));
            (x - start).abs() <= SAME * start.abs()
        };
        meaning.terms.iter().all(is_initial)
    }
}
