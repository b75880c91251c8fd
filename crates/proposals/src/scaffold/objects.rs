//! Questions whose options are objects ("which cart is faster?"), values of a control ("with which ratio does it rise
//! fastest?"), changes ("which of these make it slower?"), or quantities ("which of these become larger?").

use super::change::{self, Comparison};
use super::decision::{Condition, Decision, Expected, Meaning, Term, settle};
use super::quantity::{self, AskedQuantity, Extreme};
use super::question::{QuestionText, compared};
use super::relation::Relation;
use super::words::{contains_any, contains_words};
use crate::trace::{Candidate, TraceRun, TracedLab, split_words, trials};
use labspec::json::Scalar;
use labspec::spec::{Control, ControlKind};
use labspec::verify::RunCache;
use std::collections::BTreeSet;

type Decided<'t, 'l> = Option<Result<Decision<'t, 'l>, String>>;

/// Words of options that all objects are equal.
const BOTH: [&str; 6] = ["both", "same", "equal", "equally", "neither", "no difference"];
/// Words that name no object.
const NO_OBJECTS: [&str; 6] = ["the", "one", "both", "each", "with", "its"];
/// The maximum number of meanings.
const MEANINGS: usize = 12;

/// Which object has the largest or the smallest value of a quantity, in the run that the question states. `None` if its options
/// are no objects.
pub(super) fn of_objects<'t, 'l>(
    asked: &QuestionText,
    tried: &'t TracedLab<'l>,
    expected: Expected,
    stage: &RunCache<'_>,
) -> Decided<'t, 'l> {
    let extreme = quantity::extreme(&asked.text)?;
    if expected == Expected::Any || change::compares(&asked.text, tried.lab, &asked.stated) {
        return None;
    }
    let words = object_words(&asked.options);
    let run = change::stated_run(&asked.text, tried.lab, &asked.stated, None)?;
    let runs = vec![run];
    let named: Vec<Vec<Vec<usize>>> =
        words.iter().map(|object| measures_of(asked, tried, object, &words, &runs)).collect();
    let objects: Vec<usize> =
        (0..named.len()).filter(|i| named.get(*i).is_some_and(|n| !n.is_empty())).collect();
    if objects.len() < 2 {
        return None;
    }
    let groups: Vec<Vec<Meaning>> =
        (0..).map_while(|k| meanings(asked, tried, &named, &objects, (k, extreme))).collect();
    let fixed = asked.is_fixed(tried, &runs);
    Some(settle(tried, runs, &groups, (expected, fixed), stage))
}

/// The words of each option that no other option has.
fn object_words(options: &[String]) -> Vec<BTreeSet<String>> {
    let all: Vec<BTreeSet<String>> = options
        .iter()
        .map(|option| match contains_any(option, &BOTH) {
            true => BTreeSet::new(),
            false => split_words(option).filter(|w| !NO_OBJECTS.contains(&w.as_str())).collect(),
        })
        .collect();
    let alone = |(i, object): (usize, &BTreeSet<String>)| {
        let others = all.iter().enumerate().filter(|(j, _)| *j != i);
        object.iter().filter(|w| !others.clone().any(|(_, o)| o.contains(*w))).cloned().collect()
    };
    all.iter().enumerate().map(alone).collect()
}

/// The measures of the quantity that belong to an object and to no other one, in groups.
fn measures_of(
    asked: &QuestionText,
    tried: &TracedLab<'_>,
    object: &BTreeSet<String>,
    all: &[BTreeSet<String>],
    runs: &[TraceRun],
) -> Vec<Vec<usize>> {
    if object.is_empty() {
        return Vec::new();
    }
    let names: Vec<&str> = object.iter().map(String::as_str).collect();
    let text = format!("{} {}", asked.text.trim_end_matches('?'), names.join(" "));
    let is_own = |c: &Candidate| {
        let others = all.iter().filter(|other| *other != object);
        !c.words.is_disjoint(object) && others.into_iter().all(|other| c.words.is_disjoint(other))
    };
    let belongs = |i: &usize| tried.candidates.get(*i).is_some_and(is_own);
    let groups = asked.quantity(tried, &text, runs).groups;
    let belonging = groups.into_iter().map(|group| group.into_iter().filter(belongs).collect::<Vec<_>>());
    belonging.filter(|group| !group.is_empty()).collect()
}

/// The meanings of a group: the same measure for each object. `None` if an object has no such group.
fn meanings(
    asked: &QuestionText,
    tried: &TracedLab<'_>,
    named: &[Vec<Vec<usize>>],
    objects: &[usize],
    (k, extreme): (usize, Extreme),
) -> Option<Vec<Meaning>> {
    let lists: Vec<&Vec<usize>> =
        objects.iter().map(|i| named.get(*i).and_then(|groups| groups.get(k))).collect::<Option<_>>()?;
    let kind = |i: &usize| {
        let c = tried.candidates.get(*i)?;
        Some((c.text.split('(').next()?.to_string(), c.dimension))
    };
    let mut chosen: Vec<Vec<usize>> = vec![Vec::new()];
    for list in lists {
        let next = chosen.iter().flat_map(|done| list.iter().map(move |i| [done.as_slice(), &[*i]].concat()));
        chosen = next.take(MEANINGS).collect();
    }
    let same = |all: &Vec<usize>| {
        let mut kinds = all.iter().map(kind);
        let first = kinds.next().flatten();
        kinds.all(|kind| match (&kind, &first) {
            (Some((a, x)), Some((b, y))) => a == b && x.agrees(y),
            _ => false,
        })
    };
    let among: Vec<usize> = (0..objects.len()).collect();
    let condition = |(i, option): (usize, &String)| match objects.iter().position(|o| *o == i) {
        Some(which) => {
            Some(Condition::Extreme { which, among: among.clone(), largest: extreme == Extreme::Largest })
        }
        None if contains_any(option, &BOTH) && objects.len() == 2 => {
            Some(Condition::Relation { relation: Relation::Same, a: 0, b: 1, negated: false })
        }
        None => None,
    };
    let conditions: Vec<_> = asked.options.iter().enumerate().map(condition).collect();
    let meaning = |all: Vec<usize>| Meaning {
        terms: all.into_iter().map(|candidate| Term { run: 0, candidate }).collect(),
        conditions: conditions.clone(),
        is_explicit: false,
    };
    Some(chosen.into_iter().filter(same).map(meaning).collect())
}

/// With which value of a control a quantity is largest or smallest: a run for each option.
pub(super) fn of_values<'t, 'l>(
    asked: &QuestionText,
    tried: &'t TracedLab<'l>,
    expected: Expected,
    stage: &RunCache<'_>,
) -> Decided<'t, 'l> {
    let extreme = quantity::extreme(&asked.text)?;
    let (control, values) = options_of_control(asked, tried)?;
    let base = change::stated_run(&asked.text, tried.lab, &asked.stated, Some(control))?;
    let runs: Vec<TraceRun> = values.into_iter().map(|value| change::with(&base, control, value)).collect();
    let quantity = asked.quantity(tried, &asked.text, &runs);
    let among: Vec<usize> = (0..runs.len()).collect();
    let condition = |which| {
        Some(Condition::Extreme { which, among: among.clone(), largest: extreme == Extreme::Largest })
    };
    let meaning = |candidate: &usize| Meaning {
        terms: among.iter().map(|run| Term { run: *run, candidate: *candidate }).collect(),
        conditions: among.iter().copied().map(condition).collect(),
        is_explicit: quantity.is_explicit,
    };
    let groups: Vec<Vec<Meaning>> =
        quantity.groups.iter().map(|group| group.iter().map(meaning).collect()).collect();
    if groups.is_empty() {
        return Some(Err("the question names no quantity that the lab shows".into()));
    }
    let fixed = asked.is_fixed(tried, &runs);
    Some(settle(tried, runs, &groups, (expected, fixed), stage))
}

/// The control of which every option is a value, and these values. The question must name it, and no other one as well.
fn options_of_control<'l>(asked: &QuestionText, tried: &TracedLab<'l>) -> Option<(&'l Control, Vec<Scalar>)> {
    let of = |control: &'l Control| {
        let values = asked.options.iter().map(|option| option_value(option, control));
        let values: Vec<Scalar> = values.collect::<Option<_>>()?;
        let score = change::named(&asked.text, control);
        (score > 0 && values.len() > 1).then_some((score, control, values))
    };
    let mut fitting: Vec<_> = tried.lab.controls.iter().filter_map(of).collect();
    fitting.sort_by_key(|(score, ..)| std::cmp::Reverse(*score));
    let mut fitting = fitting.into_iter();
    let (best, control, values) = fitting.next()?;
    fitting.next().is_none_or(|(score, ..)| score < best).then_some((control, values))
}

/// The value of a control that an option states: a number, with the unit of the slider or without one, or the text of a choice.
fn option_value(option: &str, control: &Control) -> Option<Scalar> {
    match &control.kind {
        ControlKind::Slider { unit, .. } => {
            let (number, rest) = option.split_once(' ').unwrap_or((option, ""));
            let unit = unit.as_ref().map_or(String::new(), |unit| unit.as_str().to_lowercase());
            let fits = rest.is_empty() || rest == unit;
            change::settable(control, number.parse().ok().filter(|_| fits)?)
        }
        ControlKind::Select { options, .. } => {
            let of = |text: &str| text.to_lowercase().split('(').next().unwrap_or("").trim().to_string();
            options
                .iter()
                .find(|choice| of(choice.text.as_str()) == *option)
                .map(|choice| choice.value.clone())
        }
        ControlKind::Button { .. } => None,
    }
}

/// Which of several changes have an effect on a quantity: "which of these make the pulse slower?". A run for each option.
pub(super) fn of_changes<'t, 'l>(
    asked: &QuestionText,
    tried: &'t TracedLab<'l>,
    expected: Expected,
    stage: &RunCache<'_>,
) -> Decided<'t, 'l> {
    let asking = quantity::asking_part(&asked.text);
    if !contains_any(asking, &["which of", "which change", "which changes"]) {
        return None;
    }
    let base = trials(tried.lab, &[]).into_iter().next()?;
    let mut runs = vec![base];
    let quantity = asked.quantity(tried, &asked.text, &runs);
    let relation = effect(asking, &quantity)?;
    let mut changes: Vec<Option<usize>> = Vec::new();
    for option in &asked.options {
        let place = change::comparison(option, tried.lab, &[]).ok().and_then(
            |Comparison { runs: [before, after] }| {
                before.set.is_empty().then(|| {
                    runs.push(after);
                    runs.len() - 1
                })
            },
        );
        changes.push(place);
    }
    if changes.iter().flatten().count() < 2 || quantity.groups.is_empty() {
        return None;
    }
    let meaning = |candidate: &usize| {
        let terms = (0..runs.len()).map(|run| Term { run, candidate: *candidate }).collect();
        let (relation, negated) = relation;
        let condition = |b| Condition::Relation { relation, a: 0, b, negated };
        Meaning {
            terms,
            conditions: changes.iter().map(|place| place.map(condition)).collect(),
            is_explicit: quantity.is_explicit,
        }
    };
    let groups: Vec<Vec<Meaning>> =
        quantity.groups.iter().map(|group| group.iter().map(meaning).collect()).collect();
    Some(settle(tried, runs, &groups, (expected, false), stage))
}

/// The effect that a question asks for, and whether it asks for its absence: "which change does not reduce it?".
fn effect(asking: &str, quantity: &AskedQuantity) -> Option<(Relation, bool)> {
    let verb = if contains_any(asking, &["reduce", "reduces"]) {
        Relation::Less(None)
    } else if contains_any(asking, &["raise", "raises"]) {
        Relation::More(None)
    } else {
        // "Which of these stay the same?" has no negation of its own.
        Relation::read(asking, quantity.directions)?
    };
    let changes = contains_any(asking, &["change the", "changes the", "affect", "affects"]);
    let is_negated = contains_words(asking, "not");
    match verb {
        _ if changes => Some((Relation::Same, !is_negated)),
        Relation::Same | Relation::More(None) | Relation::Less(None) => Some((verb, is_negated)),
        _ => None,
    }
}

/// Which of several quantities change: "which of these become larger?". A decision for each option.
pub(super) fn of_quantities<'t, 'l>(
    asked: &QuestionText,
    tried: &'t TracedLab<'l>,
    stage: &RunCache<'_>,
) -> Decided<'t, 'l> {
    let asking = quantity::asking_part(&asked.text);
    if !contains_any(asking, &["which of"]) {
        return None;
    }
    let comparison = change::comparison(&asked.text, tried.lab, &asked.stated).ok()?;
    let runs = comparison.runs.to_vec();
    let mut all = Vec::new();
    for option in &asked.options {
        let quantity = asked.quantity_of_option(tried, option, &runs);
        let (relation, negated) = effect(asking, &quantity)?;
        if quantity.groups.is_empty() {
            return Some(Err(format!("the lab does not show what option {} names", all.len() + 1)));
        }
        let mut groups = compared(&quantity, &[Some(relation)]);
        for condition in groups.iter_mut().flatten().flat_map(|meaning| &mut meaning.conditions).flatten() {
            if let Condition::Relation { negated: not, .. } = condition {
                *not = negated;
            }
        }
        match settle(tried, runs.clone(), &groups, (Expected::Any, true), stage) {
            Ok(decision) => all.push(decision),
            Err(why) => return Some(Err(format!("option {}: {why}", all.len() + 1))),
        }
    }
    Decision::merged(all).map(Ok)
}
