//! Questions of kind `truefalse` and `multiple`.

use super::change;
use super::decision::{Decision, Expected, settle};
use super::objects;
use super::question::{QuestionText, Undecided, compared};
use super::relation::Relation;
use crate::trace::TracedLab;
use labspec::verify::RunCache;

/// Whether a statement holds: "with heavier beads, the pulse travels faster". The clause before the first comma states the change,
/// and the rest the result. A statement that names two values of a control needs no comma.
///
/// # Errors
/// The reason why nothing can be proposed.
pub(super) fn statement<'t, 'l>(
    asked: &QuestionText,
    labs: &[&'t TracedLab<'l>],
    stage: &RunCache<'_>,
) -> Result<Decision<'t, 'l>, Undecided> {
    in_first_lab(labs, "there is no lab to run it in", |tried| Some(of_lab(asked, tried, stage)))
}

/// The decision of the first lab that gives one, or else the first reason against it; `otherwise` if no lab gives a reason.
fn in_first_lab<'t, 'l>(
    labs: &[&'t TracedLab<'l>],
    otherwise: &str,
    decide: impl Fn(&'t TracedLab<'l>) -> Option<Result<Decision<'t, 'l>, String>>,
) -> Result<Decision<'t, 'l>, Undecided> {
    let mut first: Option<String> = None;
    for tried in labs {
        match decide(tried) {
            Some(Ok(decision)) => return Ok(decision),
            Some(Err(why)) => drop(first.get_or_insert(why)),
            None => {}
        }
    }
    Err(first.unwrap_or_else(|| otherwise.to_string()).into())
}

fn of_lab<'t, 'l>(
    asked: &QuestionText,
    tried: &'t TracedLab<'l>,
    stage: &RunCache<'_>,
) -> Result<Decision<'t, 'l>, String> {
    let text = asked.text.as_str();
    let (change, result) = match text.split_once(", ") {
        _ if change::compares(text, tried.lab, &asked.stated) => (text, text),
        Some((change, result)) => (change, result),
        None => return Err("the statement does not separate the change from its result".into()),
    };
    let comparison = change::comparison(change, tried.lab, &asked.stated)?;
    let runs = comparison.runs.to_vec();
    let quantity = asked.quantity(tried, result, &runs);
    let relation = Relation::read(result, quantity.directions)
        .ok_or("the words of the statement state nothing that can be compared")?;
    if quantity.groups.is_empty() {
        return Err("the statement names no quantity that the lab shows".into());
    }
    let fixed = asked.is_fixed(tried, &runs);
    settle(tried, runs, &compared(&quantity, &[Some(relation)]), (Expected::Any, fixed), stage)
}

/// The options that hold of a question with several right ones.
///
/// # Errors
/// The reason why nothing can be proposed.
pub(super) fn several<'t, 'l>(
    asked: &QuestionText,
    labs: &[&'t TracedLab<'l>],
    stage: &RunCache<'_>,
) -> Result<Decision<'t, 'l>, Undecided> {
    let otherwise = "the question asks neither for changes of a control nor for quantities of a lab";
    in_first_lab(labs, otherwise, |tried| {
        let changes = objects::of_changes(asked, tried, Expected::Any, stage);
        changes.or_else(|| objects::of_quantities(asked, tried, stage))
    })
}
