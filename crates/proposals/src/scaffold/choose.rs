//! Selection of the measure that distinguishes the options of a question.

use super::pairs;
use super::relation::{Relation, contains_words};
use crate::trace::{Candidate, ProposedVerify, TraceRun, TracedLab, split_words};
use labspec::run::StepVariant;
use labspec::source::Text;
use labspec::spec::Question;
use labspec::verify::{RunCache, Stated, plain};
use std::collections::BTreeSet;

/// The reward for a word that the question and the measure share, and the maximum number of rewarded words.
const SHARED_WORD_REWARD: f64 = 0.6;
const MOST_WORDS: usize = 4;
/// The cost of a pair of runs of which one is not named.
const UNNAMED: f64 = 0.3;

/// A selection: two numbers, and the relation between them that each option states.
pub(super) struct MeasureChoice<'t, 'l> {
    pub(super) tried: &'t TracedLab<'l>,
    trials: Vec<TraceRun>,
    /// The run and the measure of each number.
    numbers: [(usize, String); 2],
    found: [f64; 2],
    relations: Vec<Option<Relation>>,
    broke: bool,
    /// The option that holds, from 0.
    pub(super) option: usize,
    /// The numbers with their names.
    pub(super) values: Vec<(String, f64)>,
    cost: f64,
}

impl MeasureChoice<'_, '_> {
    /// Returns a condition for each option; adds measures to the block, and their values to the list.
    pub(super) fn conditions(
        &self,
        block: &mut ProposedVerify,
        values: &mut Vec<(String, f64)>,
    ) -> Vec<String> {
        let [a, b] =
            self.numbers.each_ref().map(|(run, text)| block.measured(*run, self.trials.get(*run), text));
        let run = b.split('.').next().unwrap_or("run").to_string();
        values.extend([a.clone(), b.clone()].into_iter().zip(self.found));
        let below = self.found.iter().any(|x| *x < 0.0);
        let condition = |relation: &Option<Relation>| match relation {
            None => "undecided".to_string(),
            Some(Relation::Breaks) => Relation::Breaks.condition(&a, &b, &run, below),
            Some(r) if self.broke => {
                format!("{run}.warnings == 0 && {}", r.condition(&a, &b, &run, below))
            }
            Some(r) => r.condition(&a, &b, &run, below),
        };
        self.relations.iter().map(condition).collect()
    }
}

/// Returns the best selection: exactly one option must be true, and the measure should share most words with the question.
///
/// # Errors
/// The reason why nothing can be proposed.
pub(super) fn choose<'t, 'l>(
    question: &Question,
    options: &[Text],
    labs: &[&'t TracedLab<'l>],
    numbers: &[Stated],
    stage: &RunCache<'_>,
) -> Result<MeasureChoice<'t, 'l>, String> {
    let question_text = plain(&question.q.value).to_lowercase();
    let options: Vec<String> = options.iter().map(|o| plain(&o.value)).collect();
    let question_words: BTreeSet<String> =
        split_words(&question_text).chain(options.iter().flat_map(|o| split_words(o))).collect();
    let relations: Vec<Option<Relation>> = options.iter().map(|o| Relation::read(o)).collect();
    let order = ["first", "earlier", "sooner", "before"].iter().any(|w| contains_words(&question_text, w));
    let comparable = relations.iter().flatten().count();
    let mut choices: Vec<MeasureChoice<'t, 'l>> = Vec::new();
    for tried in labs {
        if order {
            choices.extend(orders(tried, &options));
        }
        if comparable >= 2 {
            let runs = pairs::runs(question, &question_text, tried.lab, numbers);
            choices.extend(comparisons(tried, &runs, &relations, &question_words, stage));
        }
    }
    // The first of those with the lowest cost.
    let cheaper = |best: MeasureChoice<'t, 'l>, other: MeasureChoice<'t, 'l>| {
        if other.cost < best.cost { other } else { best }
    };
    choices.into_iter().reduce(cheaper).ok_or_else(|| match comparable {
        0 | 1 => {
            "the words of its options state nothing that can be compared: write the conditions by hand".into()
        }
        _ => {
            "no measure of the lab distinguishes the options in the runs that the question names".to_string()
        }
    })
}

/// The measures of a lab for which exactly one option is true in a pair of runs.
fn comparisons<'t, 'l>(
    tried: &'t TracedLab<'l>,
    runs: &pairs::RunPairs,
    relations: &[Option<Relation>],
    question_words: &BTreeSet<String>,
    stage: &RunCache<'_>,
) -> Vec<MeasureChoice<'t, 'l>> {
    let values: Vec<Vec<f64>> =
        runs.trials.iter().map(|t| tried.values_of(t, stage, StepVariant::NOMINAL)).collect();
    let broke = |run: usize| values.get(run).is_none_or(|v| v.iter().all(|x| x.is_nan()));
    let mut choices = Vec::new();
    for &(before, after) in &runs.pairs {
        let unnamed = if before == 0 || after == 0 { UNNAMED } else { 0.0 };
        for (c, candidate) in tried.candidates.iter().enumerate() {
            let at = |run: usize| values.get(run).and_then(|v| v.get(c)).copied().unwrap_or(f64::NAN);
            let (a, b) = (at(before), at(after));
            let broken = broke(after);
            let has_values = a.is_finite() && a != 0.0 && (b.is_finite() || broken);
            if broke(before) || !has_values || is_constant(candidate) {
                continue;
            }
            let holding = relations.iter().map(|r| r.is_some_and(|r| r.holds(a, b, broken)));
            let Some(option) = only(holding) else { continue };
            choices.push(MeasureChoice {
                tried,
                trials: runs.trials.clone(),
                numbers: [(before, candidate.text.clone()), (after, candidate.text.clone())],
                found: [a, b],
                relations: relations.to_vec(),
                broke: broken,
                option,
                values: named(&runs.trials, [before, after], [&candidate.text; 2], [a, b]),
                cost: candidate.cost + unnamed - reward(candidate, question_words),
            });
        }
    }
    choices
}

/// Whether a measure has the same value in every run: end times, constants.
fn is_constant(c: &Candidate) -> bool {
    c.constant || c.time.is_some() || c.text.ends_with("(data.time)")
}

fn reward(c: &Candidate, question_words: &BTreeSet<String>) -> f64 {
    SHARED_WORD_REWARD * c.words.intersection(question_words).count().min(MOST_WORDS) as f64
}

/// The index of the only true element, if there is exactly one.
fn only(list: impl Iterator<Item = bool>) -> Option<usize> {
    let mut holding = list.enumerate().filter(|(_, holds)| *holds).map(|(i, _)| i);
    let first = holding.next()?;
    holding.next().is_none().then_some(first)
}

fn named(
    trials: &[TraceRun],
    runs: [usize; 2],
    measures: [&String; 2],
    values: [f64; 2],
) -> Vec<(String, f64)> {
    let one = |((run, measure), value): ((usize, &String), f64)| {
        let words = trials.get(run).map_or("", |t| t.words.as_str());
        (format!("{measure}, {words}"), value)
    };
    runs.into_iter().zip(measures).zip(values).map(one).collect()
}

/// Which event is first: contacts of two geoms with a third one, and options that name one of the two, or both.
fn orders<'t, 'l>(tried: &'t TracedLab<'l>, options: &[String]) -> Vec<MeasureChoice<'t, 'l>> {
    let meets: Vec<(usize, Vec<&str>)> = tried
        .candidates
        .iter()
        .enumerate()
        .filter(|(_, c)| c.text.starts_with("first(contact(") && c.text.ends_with("))"))
        .map(|(i, c)| (i, c.text.split('\'').skip(1).step_by(2).collect()))
        .collect();
    let mut all = Vec::new();
    let Some(values) = tried.values.first() else { return all };
    for (k, (i, a)) in meets.iter().enumerate() {
        for (j, b) in meets.iter().skip(k + 1) {
            let alone = |names: &[&str], other: &[&str]| -> BTreeSet<String> {
                let words = |names: &[&str]| -> BTreeSet<String> {
                    names.iter().flat_map(|n| split_words(n)).collect()
                };
                words(names).difference(&words(other)).cloned().collect()
            };
            let [first, second] = [alone(a, b), alone(b, a)];
            let relation = |option: &String| {
                let question_words: BTreeSet<String> = split_words(option).collect();
                let text = option.to_lowercase();
                let speaks = [&first, &second].map(|words| !words.is_disjoint(&question_words));
                let both = ["both", "same", "together"].iter().any(|w| contains_words(&text, w));
                match speaks {
                    [true, false] => Some(Relation::More(None)),
                    [false, true] => Some(Relation::Less(None)),
                    _ if both => Some(Relation::Same),
                    _ => None,
                }
            };
            let relations: Vec<Option<Relation>> = options.iter().map(relation).collect();
            let found = [*i, *j].map(|c| values.get(c).copied().unwrap_or(f64::NAN));
            let texts = [*i, *j].map(|c| tried.candidates.get(c).map_or(String::new(), |c| c.text.clone()));
            if relations.iter().flatten().count() < 2 || found.iter().any(|x| !x.is_finite()) {
                continue;
            }
            let [x, y] = found;
            let Some(option) = only(relations.iter().map(|r| r.is_some_and(|r| r.holds(x, y, false)))) else {
                continue;
            };
            let values = named(&tried.trials, [0, 0], [&texts[0], &texts[1]], found);
            all.push(MeasureChoice {
                tried,
                trials: tried.trials.clone(),
                numbers: texts.map(|text| (0, text)),
                found,
                relations,
                broke: false,
                option,
                values,
                // Both geoms are named, which is the best possible match.
                cost: -SHARED_WORD_REWARD * MOST_WORDS as f64,
            });
        }
    }
    all
}
