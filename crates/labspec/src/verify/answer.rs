//! The answer of a question: one condition per option, or the value of a number, under the numerics of the lesson and under
//! others that it does not mention.

use super::condition::ConditionMargin;
use super::found::MeasuredValue;
use super::outcome::Outcome;
use super::{
    BoundVerify, CLOSER, Outcomes, PERTURBED, decided, empty, grounded, option_numbers, over, quote, shorten,
    significant, undecided_by_nan, units,
};
use crate::finding::Finding;
use crate::ledger::{Evidence, State};
use crate::rules;
use crate::source::Text;
use crate::spec::{Question, QuestionKind, Verify};
use labspec_expr::Value;
use std::ops::Range;

/// What became of an answer.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Verdict {
    /// The simulation shows that exactly the keyed answer holds.
    Verified,
    /// Exactly the keyed answer holds, by formulas alone: nothing was simulated for it.
    Computed,
    /// It holds, but not under other numerics: a shorter timestep, a converged solver, a start moved by 1e-14, another integrator.
    Fragile,
    /// The keyed answer holds, and another one too.
    Ambiguous,
    /// The keyed answer does not hold.
    Refuted,
    /// It could not be checked: something is wrong with the runs or the conditions.
    Failed,
    /// There is nothing to check.
    Unverified,
}

impl Verdict {
    /// In one word.
    pub fn as_str(self) -> &'static str {
        match self {
            Verdict::Verified => "verified",
            Verdict::Computed => "computed",
            Verdict::Fragile => "fragile",
            Verdict::Ambiguous => "ambiguous",
            Verdict::Refuted => "refuted",
            Verdict::Failed => "failed",
            Verdict::Unverified => "unverified",
        }
    }

    /// The state of the claim in the ledger.
    pub fn state(self) -> State {
        match self {
            Verdict::Verified => State::True(Evidence::Simulated),
            Verdict::Computed => State::True(Evidence::Computed),
            Verdict::Fragile | Verdict::Ambiguous | Verdict::Refuted => State::False,
            Verdict::Failed => State::Unchecked,
            Verdict::Unverified => State::NotClaimed,
        }
    }
}

/// A checked answer.
#[derive(Clone, Debug, PartialEq)]
pub struct Answer {
    /// What became of it.
    pub verdict: Verdict,
    /// Why, unless it is verified; or what the evidence does not decide.
    pub reason: String,
    /// Every option with its condition, or the value of a number.
    pub weights: Vec<Weight>,
}

/// An option and how well its condition holds.
#[derive(Clone, Debug, PartialEq)]
pub struct Weight {
    /// Its index, from 0; `None` for the value of a number.
    pub option: Option<usize>,
    /// The condition holds; `None` where the author says that this evidence does not decide the option.
    pub holds: Option<bool>,
    /// How far the comparison that decides is from turning over; negative where the condition does not hold.
    pub margin: Option<f64>,
    /// How much half and a quarter of the timestep, other integrators, a converged solver and a moved start change that.
    pub spread: Option<f64>,
}

impl Weight {
    /// Whether eight times what other numerics change could turn it over: with errors of the first order in the timestep, all
    /// that is left to come is as much again as half of it changes.
    fn is_close(&self) -> bool {
        self.margin
            .zip(self.spread)
            .is_some_and(|(margin, spread)| spread > 0.0 && 8.0 * spread >= margin.abs())
    }

    /// Takes in what the margin is under other numerics.
    fn widen(&mut self, other: Option<f64>) {
        if let (Some(own), Some(other)) = (self.margin, other) {
            self.spread = Some(self.spread.unwrap_or(0.0).max((other - own).abs()));
        }
    }

    /// `holds, by 0.02`; `does not hold, by 0.6`.
    pub fn describe(&self) -> String {
        let Some(holds) = self.holds else { return "is not decided by this evidence".to_string() };
        let spread = match self.spread {
            Some(spread) if spread > 0.0 => {
                format!("; other numerics change that by {}", significant(spread))
            }
            _ => String::new(),
        };
        let words = match (holds, self.margin) {
            (true, Some(0.0)) => "holds exactly".to_string(),
            (false, Some(0.0)) => "does not hold: both sides are equal".to_string(),
            (true, Some(margin)) => format!("holds, by {}", significant(margin.abs())),
            (false, Some(margin)) => format!("does not hold, by {}", significant(margin.abs())),
            (true, None) => "holds".to_string(),
            (false, None) => "does not hold".to_string(),
        };
        words + &spread
    }
}

impl Answer {
    /// An answer that nobody says how to check.
    pub(crate) fn unverified(reason: impl Into<String>) -> Answer {
        Answer { verdict: Verdict::Unverified, reason: reason.into(), weights: Vec::new() }
    }

    /// An answer that could not be checked.
    pub(super) fn failed(reason: impl Into<String>) -> Answer {
        Answer { verdict: Verdict::Failed, reason: reason.into(), weights: Vec::new() }
    }
}

/// Checks the answer of a question; `None` when the object does not say how.
pub(super) fn check(
    bound: &BoundVerify<'_>,
    outcomes: &Outcomes,
    verify: &Verify,
    question: &Question,
    findings: &mut Vec<Finding>,
) -> Option<Answer> {
    let by_options =
        (!verify.options.is_empty()).then(|| options(bound, outcomes, verify, question, findings));
    let by_value =
        verify.value.as_ref().map(|text| value(bound, outcomes, text, &verify.wrong, question, findings));
    // An object may hold both only by mistake, which is reported: the worse of the two counts.
    by_options.into_iter().chain(by_value).max_by_key(|a| a.verdict)
}

/// What stands for a condition where the evidence does not decide the option.
pub const UNDECIDED: &str = "undecided";

/// The conditions of all options, each with what it rests on; `None` for one that is not decided. `tried`: whether they are to
/// be tried with other values of what was measured, as under the lesson's own numerics.
fn conditions(
    bound: &BoundVerify<'_>,
    outcome: &Outcome,
    verify: &Verify,
    tried: bool,
    findings: &mut Vec<Finding>,
) -> Result<Vec<Option<(MeasuredValue, ConditionMargin)>>, String> {
    let ground = if tried { grounded } else { decided };
    let mut all = Vec::new();
    let mut reason = None;
    for text in &verify.options {
        if is_undecided(text) {
            all.push(None);
            continue;
        }
        match ground(bound, outcome, text, findings) {
            Err(why) => reason = reason.or(Some(why)),
            Ok(found) if tried && !bound.is_condition(&found, text, findings) => {
                reason = reason.or_else(|| Some("an option has no condition".to_string()));
            }
            Ok(found) => {
                let weighed = bound.weigh_found(&found);
                all.push(Some((found, weighed)));
            }
        }
    }
    reason.map_or(Ok(all), Err)
}

/// Whether a text says that the evidence does not decide an option.
pub(super) fn is_undecided(text: &Text) -> bool {
    text.value.trim() == UNDECIDED
}

/// Which options hold, and so whether the keyed one is the only one.
fn options(
    bound: &BoundVerify<'_>,
    outcomes: &Outcomes,
    verify: &Verify,
    question: &Question,
    findings: &mut Vec<Finding>,
) -> Answer {
    let (Some(answer), QuestionKind::Choice { options, answer: Some(keyed), .. }) =
        (question.right_option(), &question.kind)
    else {
        return Answer::failed("the question has no correct option");
    };
    if verify.options.len() != options.len() {
        return Answer::failed("the number of conditions differs from the number of options");
    }
    let found = match conditions(bound, &outcomes.nominal, verify, true, findings) {
        Ok(found) => found,
        Err(reason) => return Answer::failed(reason),
    };
    let weights: Vec<Weight> = found.iter().enumerate().map(|(i, found)| weight(i, found.as_ref())).collect();
    let name =
        |i: usize| format!("{} (\"{}\")", i, options.get(i).map_or(String::new(), |o| shorten(&o.value)));
    let names = |list: &[usize]| list.iter().map(|&i| name(i)).collect::<Vec<_>>().join(", ");
    let with = |state: Option<bool>| -> Vec<usize> {
        weights.iter().filter(|w| w.holds == state).filter_map(|w| w.option).collect()
    };
    let (held, open) = (with(Some(true)), with(None));
    let condition = |i: usize| verify.options.get(i).map_or(verify.span.clone(), |c| c.span());
    let words = |i: usize| weights.get(i).map_or(String::new(), Weight::describe);
    let done = |verdict, reason: String| Answer { verdict, reason, weights: weights.clone() };

    if open.contains(&answer) {
        return done(Verdict::Failed, format!("answer {} is not decided by this evidence", name(answer)));
    }
    if !held.contains(&answer) {
        let message = format!("the simulation refutes answer {}", name(answer));
        let mut f = Finding::error(rules::ANSWER_REFUTED, keyed.span.clone(), message.clone())
            .why("a student who predicts the simulation correctly is graded as wrong")
            .related(condition(answer), format!("this condition {}", words(answer)));
        f = match held.as_slice() {
            [] => f.help("correct the conditions, or the model: no condition holds"),
            [one] => f
                .help(format!("correct the answer or the conditions: the true option is {}", name(*one)))
                .related(condition(*one), format!("this condition {}", words(*one)))
                .guess(keyed.span.clone(), one.to_string()),
            all => {
                f.help(format!("correct the answer or the conditions: the true options are {}", names(all)))
            }
        };
        findings.push(f);
        return done(Verdict::Refuted, message);
    }
    if held.len() > 1 {
        let others: Vec<usize> = held.iter().copied().filter(|&i| i != answer).collect();
        let message = format!("besides answer {}, {} is also true", name(answer), names(&others));
        let mut f = Finding::error(rules::ANSWER_AMBIGUOUS, keyed.span.clone(), message.clone())
            .why("a student who picks the other true option is graded as wrong")
            .help("rewrite the options or their conditions, so that exactly one can hold");
        for i in others {
            f = f.related(condition(i), format!("this condition also {}", words(i)));
        }
        findings.push(f);
        return done(Verdict::Ambiguous, message);
    }
    let holds: Vec<Option<bool>> = weights.iter().map(|w| w.holds).collect();
    let texts = option_numbers::check(bound, &outcomes.nominal, options, &verify.options, &holds, findings);
    if let Some(reason) = texts {
        return done(Verdict::Failed, reason);
    }
    if open.len() + 1 == weights.len() {
        return done(Verdict::Failed, "no other option is decided".to_string());
    }
    let mut weights = weights.clone();
    let mut turns = |outcome: &Outcome, how: &str, weights: &mut [Weight]| {
        let again = conditions(bound, outcome, verify, false, &mut Vec::new());
        for (weight, now) in weights.iter_mut().zip(again.iter().flatten()) {
            weight.widen(now.as_ref().and_then(|(_, weighed)| weighed.margin));
        }
        let (i, what) = match &again {
            Err(reason) => (answer, reason.clone()),
            Ok(now) => {
                let now = now.iter().enumerate().map(|(i, found)| weight(i, found.as_ref()));
                let (now, _) = now.zip(weights.iter()).find(|(now, then)| now.holds != then.holds)?;
                let i = now.option.unwrap_or(answer);
                (i, format!("then the condition of {} {}", name(i), now.describe()))
            }
        };
        let now = format!("with the numerics of the lesson, this {}", words(i));
        Some(fragile(keyed.span.clone(), how, &what).related(condition(i), now))
    };
    if let Err((verdict, reason)) =
        survives(bound, outcomes, &mut weights, keyed.span.clone(), findings, &mut turns)
    {
        return done(verdict, reason);
    }
    let evidence = found.iter().flatten().map(|(f, _)| f.evidence).min();
    let reason = match open.as_slice() {
        [] => String::new(),
        [one] => format!("option {} is not decided", name(*one)),
        all => format!("options {} are not decided", names(all)),
    };
    let verdict = held_by(evidence);
    let mut answer = Answer { verdict, reason, weights };
    if !verify.over.is_empty() {
        over::hold(bound, verify, keyed.span.clone(), &mut answer, findings);
    }
    add_searches(bound, &verify.options, &outcomes.nominal, &mut answer);
    answer
}

/// Says where the values were looked for that these texts read.
fn add_searches(bound: &BoundVerify<'_>, texts: &[Text], outcome: &Outcome, answer: &mut Answer) {
    if !matches!(answer.verdict, Verdict::Verified | Verdict::Computed) {
        return;
    }
    for (i, looked) in outcome.looked.iter().enumerate() {
        if texts.iter().any(|text| bound.reads_found(text, i)) {
            let before = std::mem::take(&mut answer.reason);
            answer.reason = if before.is_empty() { looked.clone() } else { format!("{before}; {looked}") };
        }
    }
}

/// Whether exactly the same options hold, and how far that is from turning over.
pub(super) enum Same {
    /// They do, by so much.
    Yes(f64),
    /// Another one holds, or one does not: the first one, in words.
    No(String),
    /// Nothing decides: why.
    Open(String),
}

/// Whether exactly the same options hold as before, with an outcome of other settings.
pub(super) fn same(bound: &BoundVerify<'_>, outcome: &Outcome, verify: &Verify, weights: &[Weight]) -> Same {
    let found = match conditions(bound, outcome, verify, false, &mut Vec::new()) {
        Ok(found) => found,
        Err(reason) => return Same::Open(reason),
    };
    let now = found.iter().enumerate().map(|(i, found)| weight(i, found.as_ref()));
    let mut least = f64::INFINITY;
    for (now, then) in now.zip(weights) {
        if now.holds != then.holds {
            let i = now.option.unwrap_or(0);
            return Same::No(format!("the condition of option {i} {}", now.describe()));
        }
        least = least.min(now.margin.map_or(f64::INFINITY, f64::abs));
    }
    Same::Yes(least)
}

fn weight(i: usize, found: Option<&(MeasuredValue, ConditionMargin)>) -> Weight {
    let weighed = found.map(|(_, w)| w);
    Weight {
        option: Some(i),
        holds: weighed.map(|w| w.holds),
        margin: weighed.and_then(|w| w.margin),
        spread: None,
    }
}

/// The outcomes under other numerics, with their names.
fn perturbed(outcomes: &Outcomes) -> impl Iterator<Item = (&Outcome, &'static str)> {
    outcomes.perturbed.iter().zip(PERTURBED).filter_map(|(o, (_, how))| Some((o.as_ref()?, how)))
}

/// What turns over in an outcome under other numerics, so called; the margins are widened by it.
type Turns<'t> = dyn FnMut(&Outcome, &str, &mut [Weight]) -> Option<Finding> + 't;

/// Puts an answer to the other numerics, and to those that are closer where these come near. `turns` says what turns over in an
/// outcome, and widens the margins by it.
///
/// # Errors
/// It does not hold in one of them, or could not be tried: the verdict, and why.
fn survives(
    bound: &BoundVerify<'_>,
    outcomes: &Outcomes,
    weights: &mut [Weight],
    place: Range<usize>,
    findings: &mut Vec<Finding>,
    turns: &mut Turns<'_>,
) -> Result<(), (Verdict, String)> {
    let mut told = |outcome: Option<&Outcome>, how: &str, weights: &mut [Weight]| {
        let turned = outcome.map(|outcome| turns(outcome, how, weights));
        match turned {
            Some(None) => Ok(()),
            // What ends because the work of a check is spent, or cannot be run at all, says nothing of the answer.
            Some(Some(finding)) if bound.stage().left() > 0 => {
                findings.push(finding);
                Err((Verdict::Fragile, format!("it does not hold {how}")))
            }
            _ => {
                findings.push(too_much(place.clone(), how));
                Err((Verdict::Failed, format!("the work budget ran out before testing it {how}")))
            }
        }
    };
    for (outcome, how) in perturbed(outcomes) {
        told(Some(outcome), how, weights)?;
    }
    for (numerics, how) in CLOSER {
        if weights.iter().any(Weight::is_close) {
            told(bound.outcome(numerics, &mut Vec::new()).as_ref(), how, weights)?;
        }
    }
    Ok(())
}

fn held_by(evidence: Option<Evidence>) -> Verdict {
    if evidence == Some(Evidence::Simulated) { Verdict::Verified } else { Verdict::Computed }
}

/// Whether the keyed number is what the expression gives.
fn value(
    bound: &BoundVerify<'_>,
    outcomes: &Outcomes,
    text: &Text,
    wrong: &[Text],
    question: &Question,
    findings: &mut Vec<Finding>,
) -> Answer {
    let (Some((answer, tol)), QuestionKind::Numeric { answer: Some(keyed), .. }) =
        (question.numeric(), &question.kind)
    else {
        return Answer::failed("the question does not ask for a number");
    };
    let found = match decided(bound, &outcomes.nominal, text, findings) {
        Ok(found) => found,
        Err(reason) => return Answer::failed(reason),
    };
    if !matches!(found.value, Value::Number(_)) {
        findings.push(no_quantity(text, &found.value));
        return Answer::failed("the expression gives no number");
    }
    let gives = found.value.to_number();
    if !gives.is_finite() {
        findings.push(no_value(text, gives));
        return Answer::failed("the simulation gives no number");
    }
    let asked = match &question.kind {
        QuestionKind::Numeric { unit, .. } => unit.as_ref(),
        _ => None,
    };
    let measured = asked.and_then(|_| units::of_claim(bound, &outcomes.nominal, text));
    let unit = quote::answer_unit(asked.map(|u| u.as_str()), measured);
    if let quote::AnswerUnit::Unread(asked_in, gives) = &unit {
        let message = format!("\"{asked_in}\" is not a known unit, but the expression gives {gives}");
        findings.push(
            Finding::error(rules::VERIFY_ANSWER, keyed.span.clone(), message.clone())
                .why("the unit of the answer could not be compared")
                .help("write the unit by its symbol: `s`, `mm`, `m/s^2`")
                .related(text.span(), format!("this is in {gives}")),
        );
        return Answer::failed(message);
    }
    if let quote::AnswerUnit::Wrong(asked_in, gives) = &unit {
        let message = format!("the question asks in {asked_in}, but the expression gives {gives}");
        findings.push(wrong_unit(keyed.span.clone(), text, &message));
        return Answer { verdict: Verdict::Refuted, reason: message, weights: Vec::new() };
    }
    let computed = unit.factor() * found.value.to_number();
    if !computed.is_finite() {
        findings.push(no_value(text, computed));
        return Answer::failed("the simulation gives no number");
    }
    let margin = |x: f64| tol - (x - answer).abs();
    let right = |x: f64| margin(x) >= 0.0;
    let weights = vec![Weight {
        option: None,
        holds: Some(right(computed)),
        margin: Some(margin(computed)),
        spread: None,
    }];
    let done = |verdict, reason: String| Answer { verdict, reason, weights: weights.clone() };
    if !right(computed) {
        let message = format!("the answer is {answer}, but the simulation gives {}", significant(computed));
        findings.push(
            Finding::error(rules::ANSWER_REFUTED, keyed.span.clone(), message.clone())
                .why(format!(
                    "they differ by {}, but the tolerance is {}",
                    significant((computed - answer).abs()),
                    significant(tol)
                ))
                .help("correct the answer, or its expression")
                .related(text.span(), format!("this is {}", significant(computed))),
        );
        return done(Verdict::Refuted, message);
    }
    let says = |value: &Value| right(unit.factor() * value.to_number());
    if found.unread || !bound.could_differ(&found, Some(&says)) {
        return Answer::failed(empty(text, findings));
    }
    for mistake in wrong {
        let taken = match taken(bound, &outcomes.nominal, mistake, findings) {
            Ok(taken) => taken,
            Err(reason) => return done(Verdict::Failed, format!("a value of `wrong` is unknown: {reason}")),
        };
        let taken = unit.factor() * taken;
        if right(taken) {
            let message = format!("the tolerance accepts {}, which a mistake gives", significant(taken));
            findings.push(
                Finding::error(rules::ANSWER_AMBIGUOUS, mistake.span(), message.clone())
                    .why("a student who makes this mistake is graded as correct")
                    .help(format!(
                        "make the tolerance smaller than {} to reject it",
                        significant((taken - answer).abs())
                    ))
                    .related(keyed.span.clone(), "this is the answer"),
            );
            return done(Verdict::Ambiguous, message);
        }
    }
    let mut weights = weights.clone();
    let mut turns = |outcome: &Outcome, how: &str, weights: &mut [Weight]| {
        let again = decided(bound, outcome, text, &mut Vec::new());
        let what = match again.map(|f| unit.factor() * f.value.to_number()) {
            Err(reason) => reason,
            Ok(x) if right(x) => {
                weights.iter_mut().for_each(|w| w.widen(Some(margin(x))));
                return None;
            }
            Ok(x) => format!("then it is {}, but the tolerance is {}", significant(x), significant(tol)),
        };
        let own = format!("with the numerics of the lesson, this is {}", significant(computed));
        Some(fragile(keyed.span.clone(), how, &what).related(text.span(), own))
    };
    if let Err((verdict, reason)) =
        survives(bound, outcomes, &mut weights, keyed.span.clone(), findings, &mut turns)
    {
        return done(verdict, reason);
    }
    let uncompared = unit == quote::AnswerUnit::Unknown && asked.is_some_and(|u| quote::is_unit(u.as_str()));
    let reason = if uncompared { UNIT_OPEN.to_string() } else { String::new() };
    let mut answer = Answer { verdict: held_by(Some(found.evidence)), reason, weights };
    add_searches(bound, std::slice::from_ref(text), &outcomes.nominal, &mut answer);
    answer
}

/// Of a right number whose unit is held to nothing.
const UNIT_OPEN: &str = "its unit could not be compared, because the unit of the expression is uncertain";

/// What a mistake gives, by an expression under `wrong`.
fn taken(
    bound: &BoundVerify<'_>,
    outcome: &Outcome,
    text: &Text,
    findings: &mut Vec<Finding>,
) -> Result<f64, String> {
    // A mistake may be a bare number.
    let found = bound.find(outcome, text, findings).ok_or("it cannot be evaluated")?;
    if let Some(undecided) = &found.undecided {
        return Err(undecided_by_nan(text, undecided, findings));
    }
    match found.value {
        Value::Number(x) if x.is_finite() => Ok(x),
        Value::Number(x) => {
            findings.push(no_value(text, x));
            Err(format!("it is {}", shown(x)))
        }
        value => {
            findings.push(no_quantity(text, &value));
            Err("it gives no number".to_string())
        }
    }
}

/// A condition or a text where a number is asked for.
fn no_quantity(text: &Text, value: &Value) -> Finding {
    let what = match value {
        Value::Boolean(_) => "a condition".to_string(),
        Value::String(_) => "a text".to_string(),
        other => format!("`{other}`"),
    };
    Finding::error(
        rules::CLAIM_WITHOUT_NUMBER,
        text.span(),
        format!("this expression is {what}, but a number is needed"),
    )
    .why("a condition counts as 1 or 0: an answer of 1 would be correct whenever it holds")
    .help("write the number of the answer: `final(speed)`")
}

/// The unit of a question that is not that of its value.
fn wrong_unit(span: Range<usize>, text: &Text, message: &str) -> Finding {
    Finding::error(rules::ANSWER_REFUTED, span, message)
        .why("a student who answers in this unit is graded as wrong")
        .help("correct the unit of the question, or convert the expression to it")
        .related(text.span(), "the expression")
}

/// An expression that gives no number where one is claimed.
fn no_value(text: &Text, x: f64) -> Finding {
    let message = format!("this expression gives {}, which is not a number", shown(x));
    Finding::error(rules::CLAIM_WITHOUT_NUMBER, text.span(), message)
        .why("there is no number to compare with: its event may never happen in the run, or it divides by zero")
        .help("make the run longer, or correct the expression")
}

fn shown(x: f64) -> &'static str {
    if x.is_nan() { "NaN" } else { "infinity" }
}

/// The work of a check was spent before an answer was put to all numerics.
pub(super) fn too_much(span: Range<usize>, how: &str) -> Finding {
    let what = format!("the work budget ran out before testing whether the answer holds {how}");
    Finding::error(rules::RUN_BREAKS, span, what)
        .why("an answer that holds only under one choice of numerics is not an answer")
        .help("make the runs shorter, or use fewer of them in one lesson")
}

fn fragile(span: Range<usize>, how: &str, what: &str) -> Finding {
    Finding::warning(rules::ANSWER_FRAGILE, span, format!("the answer holds, but not {how}: {what}"))
        .why("it depends on numerics that the question does not mention: a student with other settings sees something else")
        .help("state the setting in the question and `set` it in the run, or ask about something that does not depend on it")
}
