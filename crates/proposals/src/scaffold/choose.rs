//! Selection of the runs and the measures that decide a question.

use super::change::{self, Comparison};
use super::decision::{Condition, Decision, Expected, Meaning, Term, settle};
use super::objects;
use super::quantity;
use super::question::{QuestionText, Undecided, compared};
use super::relation::Relation;
use super::words::{contains_any, contains_words};
use crate::trace::{ProposedVerify, TracedLab, split_words};
use labspec::verify::RunCache;
use std::collections::BTreeSet;

/// Returns the decision of a question with one right option: the control and the quantity that it names, and exactly one true
/// option, for every measure that the quantity can mean, and at half the timestep too.
///
/// # Errors
/// The reason why nothing can be proposed, with what is known.
pub(super) fn choose<'t, 'l>(
    asked: &QuestionText,
    labs: &[&'t TracedLab<'l>],
    stage: &RunCache<'_>,
) -> Result<Decision<'t, 'l>, Undecided> {
    let is_order =
        contains_any(quantity::asking_part(&asked.text), &["first", "earlier", "sooner", "before"]);
    if let Some(choice) = labs.iter().filter(|_| is_order).find_map(|tried| orders(tried, &asked.options)) {
        return Ok(choice);
    }
    let mut first: Option<Undecided> = None;
    for tried in labs {
        for form in [objects::of_objects, objects::of_values, objects::of_changes] {
            match form(asked, tried, Expected::One, stage) {
                Some(Ok(decision)) => return Ok(decision),
                Some(Err(why)) => drop(first.get_or_insert(why.into())),
                None => {}
            }
        }
        let comparison = match change::comparison(&asked.text, tried.lab, &asked.stated) {
            Ok(comparison) => comparison,
            Err(why) => {
                first.get_or_insert(why.into());
                continue;
            }
        };
        // A lab whose control the question names is the one that it is about.
        return decide(asked, tried, &comparison, stage)
            .map_err(|why| Undecided { why, skeleton: Some(Box::new(skeleton(asked, tried, &comparison))) });
    }
    Err(first.unwrap_or_else(|| "there is no lab to run it in".to_string().into()))
}

/// The option that a comparison decides.
fn decide<'t, 'l>(
    asked: &QuestionText,
    tried: &'t TracedLab<'l>,
    comparison: &Comparison,
    stage: &RunCache<'_>,
) -> Result<Decision<'t, 'l>, String> {
    let quantity = asked.quantity(tried, &asked.text, &comparison.runs);
    let relation = |option: &String| Relation::read(option, quantity.directions);
    let relations: Vec<Option<Relation>> = asked.options.iter().map(relation).collect();
    if relations.iter().flatten().count() < 2 {
        return Err("the words of its options state nothing that can be compared".into());
    }
    if quantity.groups.is_empty() {
        return Err("the question names no quantity that the lab shows".into());
    }
    let runs = comparison.runs.to_vec();
    let fixed = asked.is_fixed(tried, &runs);
    settle(tried, runs, &compared(&quantity, &relations), (Expected::One, fixed), stage)
}

/// The runs of a question that is not decided, with its measure if it is known, and open conditions.
fn skeleton(asked: &QuestionText, tried: &TracedLab<'_>, comparison: &Comparison) -> ProposedVerify {
    let mut block = ProposedVerify::default();
    block.lab = Some(tried.address.to_string());
    let quantity = asked.quantity(tried, &asked.text, &comparison.runs);
    let candidate = quantity.groups.first().and_then(|group| tried.candidates.get(*group.first()?));
    for (i, run) in comparison.runs.iter().enumerate() {
        match candidate {
            Some(c) => drop(block.measured(i, Some(run), &c.text, candidate)),
            None => drop(block.run(i, run)),
        }
    }
    block.options = asked.options.iter().map(|_| "undecided".to_string()).collect();
    block
}

/// Which event is first: contacts of two geoms with a third one, and options that name one of the two, or both.
fn orders<'t, 'l>(tried: &'t TracedLab<'l>, options: &[String]) -> Option<Decision<'t, 'l>> {
    let meets: Vec<(usize, Vec<&str>)> = tried
        .candidates
        .iter()
        .enumerate()
        .filter(|(_, c)| c.text.starts_with("first(contact(") && c.text.ends_with("))"))
        .map(|(i, c)| (i, c.text.split('\'').skip(1).step_by(2).collect()))
        .collect();
    let values = tried.values.first()?;
    for (k, (i, a)) in meets.iter().enumerate() {
        for (j, b) in meets.iter().skip(k + 1) {
            let conditions = order_conditions(a, b, options);
            let found: Vec<f64> =
                [*i, *j].iter().map(|c| values.get(*c).copied().unwrap_or(f64::NAN)).collect();
            if conditions.iter().flatten().count() < 2 || found.iter().any(|x| !x.is_finite()) {
                continue;
            }
            let terms = [*i, *j].map(|candidate| Term { run: 0, candidate }).to_vec();
            let decision = Decision::measured(
                tried,
                tried.trials.clone(),
                Meaning { terms, conditions, is_explicit: true },
                found,
            );
            if decision.holding.len() == 1 {
                return Some(decision);
            }
        }
    }
    None
}

/// The conditions of options that name one of two contacts, or both.
fn order_conditions(a: &[&str], b: &[&str], options: &[String]) -> Vec<Option<Condition>> {
    let alone = |names: &[&str], other: &[&str]| -> BTreeSet<String> {
        let words =
            |names: &[&str]| -> BTreeSet<String> { names.iter().flat_map(|n| split_words(n)).collect() };
        words(names).difference(&words(other)).cloned().collect()
    };
    let [first, second] = [alone(a, b), alone(b, a)];
    let relation = |option: &String| {
        let words: BTreeSet<String> = split_words(option).collect();
        let names = [&first, &second].map(|object| !object.is_disjoint(&words));
        match names {
            [true, false] => Some(Relation::More(None)),
            [false, true] => Some(Relation::Less(None)),
            _ if ["both", "same", "together"].iter().any(|w| contains_words(option, w)) => {
                Some(Relation::Same)
            }
            _ => None,
        }
    };
    let condition = |relation| Condition::Relation { relation, a: 0, b: 1, negated: false };
    options.iter().map(|option| relation(option).map(condition)).collect()
}
