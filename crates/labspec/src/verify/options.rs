//! The answer of a question with options: one condition per option, and whether only the keyed option holds.

use super::bound::BoundVerify;
use super::condition::ConditionMargin;
use super::format::shorten;
use super::found::MeasuredValue;
use super::grounded::{decided_value, grounded_value};
use super::option_numbers::check_option_numbers;
use super::outcome::Outcome;
use super::outcomes::Outcomes;
use super::survival::{fragile_answer, verdict_by, withstand_numerics};
use super::verdict::{Answer, Verdict, Weight};
use crate::finding::Finding;
use crate::rules;
use crate::source::Text;
use crate::spec::{Question, QuestionKind, Verify};
use std::ops::Range;

/// Evaluates which options hold, and whether the keyed one is the only one.
pub(super) fn check_options(
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
    let values = match evaluate_conditions(bound, &outcomes.nominal, verify, true, findings) {
        Ok(values) => values,
        Err(reason) => return Answer::failed(reason),
    };
    let weights = values.iter().enumerate().map(|(i, value)| option_weight(i, value.as_ref())).collect();
    let judgement = OptionJudgement { verify, options, answer, keyed: keyed.span.clone(), weights };
    let undecided = judgement.options_with(None);
    if let Some(answer) = judgement.refuse(&undecided, findings) {
        return answer;
    }
    let holds: Vec<Option<bool>> = judgement.weights.iter().map(|w| w.holds).collect();
    let conditions = &verify.options;
    if let Some(reason) =
        check_option_numbers(bound, &outcomes.nominal, options, conditions, &holds, findings)
    {
        return judgement.judged(Verdict::Failed, reason);
    }
    if undecided.len() + 1 == judgement.weights.len() {
        return judgement.judged(Verdict::Failed, "no other option is decided".to_string());
    }
    let mut widened = judgement.weights.clone();
    let mut turns = |outcome: &Outcome, how: &str, weights: &mut [Weight]| {
        judgement.answer_changes(bound, outcome, how, weights)
    };
    if let Err((verdict, reason)) =
        withstand_numerics(bound, outcomes, &mut widened, keyed.span.clone(), findings, &mut turns)
    {
        return judgement.judged(verdict, reason);
    }
    let evidence = values.iter().flatten().map(|(value, _)| value.evidence).min();
    Answer {
        verdict: verdict_by(evidence),
        reason: judgement.describe_undecided(&undecided),
        weights: widened,
    }
}

/// The options of a question and their results under the numerics of the lesson.
struct OptionJudgement<'q> {
    verify: &'q Verify,
    options: &'q [Text],
    /// The keyed option, and the span of the key.
    answer: usize,
    keyed: Range<usize>,
    weights: Vec<Weight>,
}

impl OptionJudgement<'_> {
    /// An option in a message: `2 ("It slides.")`.
    fn name(&self, i: usize) -> String {
        format!("{} (\"{}\")", i, self.options.get(i).map_or(String::new(), |o| shorten(&o.value)))
    }

    fn names(&self, list: &[usize]) -> String {
        list.iter().map(|&i| self.name(i)).collect::<Vec<_>>().join(", ")
    }

    /// The span of the condition of an option.
    fn condition(&self, i: usize) -> Range<usize> {
        self.verify.options.get(i).map_or(self.verify.span.clone(), |c| c.span())
    }

    fn describe(&self, i: usize) -> String {
        self.weights.get(i).map_or(String::new(), Weight::describe)
    }

    /// The options that hold (`Some(true)`), that do not (`Some(false)`), or that are undecided (`None`).
    fn options_with(&self, holds: Option<bool>) -> Vec<usize> {
        self.weights.iter().filter(|w| w.holds == holds).filter_map(|w| w.option).collect()
    }

    fn judged(&self, verdict: Verdict, reason: String) -> Answer {
        Answer { verdict, reason, weights: self.weights.clone() }
    }

    /// The answer if the keyed option is undecided, does not hold, or is not the only one.
    fn refuse(&self, undecided: &[usize], findings: &mut Vec<Finding>) -> Option<Answer> {
        let true_options = self.options_with(Some(true));
        if undecided.contains(&self.answer) {
            let reason = format!("answer {} is not decided by this evidence", self.name(self.answer));
            return Some(self.judged(Verdict::Failed, reason));
        }
        if !true_options.contains(&self.answer) {
            return Some(self.refute(&true_options, findings));
        }
        (true_options.len() > 1).then(|| self.report_ambiguous(&true_options, findings))
    }

    /// Reports that the keyed option does not hold.
    fn refute(&self, true_options: &[usize], findings: &mut Vec<Finding>) -> Answer {
        let message = format!("the simulation refutes answer {}", self.name(self.answer));
        let f = Finding::error(rules::ANSWER_REFUTED, self.keyed.clone(), message.clone())
            .why("a student who predicts the simulation correctly is graded as wrong")
            .related(self.condition(self.answer), format!("this condition {}", self.describe(self.answer)));
        findings.push(match true_options {
            [] => f.help("correct the conditions, or the model: no condition holds"),
            [one] => f
                .help(format!("correct the answer or the conditions: the true option is {}", self.name(*one)))
                .related(self.condition(*one), format!("this condition {}", self.describe(*one)))
                .guess(self.keyed.clone(), one.to_string()),
            all => f.help(format!(
                "correct the answer or the conditions: the true options are {}",
                self.names(all)
            )),
        });
        self.judged(Verdict::Refuted, message)
    }

    /// Reports that the keyed option holds and others too.
    fn report_ambiguous(&self, true_options: &[usize], findings: &mut Vec<Finding>) -> Answer {
        let others: Vec<usize> = true_options.iter().copied().filter(|&i| i != self.answer).collect();
        let message =
            format!("besides answer {}, {} is also true", self.name(self.answer), self.names(&others));
        let mut f = Finding::error(rules::ANSWER_AMBIGUOUS, self.keyed.clone(), message.clone())
            .why("a student who picks the other true option is graded as wrong")
            .help("rewrite the options or their conditions, so that exactly one can hold");
        for i in others {
            f = f.related(self.condition(i), format!("this condition also {}", self.describe(i)));
        }
        findings.push(f);
        self.judged(Verdict::Ambiguous, message)
    }

    /// A finding if an option changes in an outcome under perturbed numerics. The spread of `weights` is widened by the
    /// margins.
    fn answer_changes(
        &self,
        bound: &BoundVerify<'_>,
        outcome: &Outcome,
        how: &str,
        weights: &mut [Weight],
    ) -> Option<Finding> {
        let again = evaluate_conditions(bound, outcome, self.verify, false, &mut Vec::new());
        for (weight, now) in weights.iter_mut().zip(again.iter().flatten()) {
            weight.widen(now.as_ref().and_then(|(_, condition)| condition.margin));
        }
        let (i, what) = match &again {
            Err(reason) => (self.answer, reason.clone()),
            Ok(now) => {
                let now = now.iter().enumerate().map(|(i, value)| option_weight(i, value.as_ref()));
                let (now, _) = now.zip(weights.iter()).find(|(now, then)| now.holds != then.holds)?;
                let i = now.option.unwrap_or(self.answer);
                (i, format!("then the condition of {} {}", self.name(i), now.describe()))
            }
        };
        let now = format!("with the numerics of the lesson, this {}", self.describe(i));
        Some(fragile_answer(self.keyed.clone(), how, &what).related(self.condition(i), now))
    }

    /// Names the undecided options.
    fn describe_undecided(&self, undecided: &[usize]) -> String {
        match undecided {
            [] => String::new(),
            [one] => format!("option {} is not decided", self.name(*one)),
            all => format!("options {} are not decided", self.names(all)),
        }
    }
}

/// The text that replaces a condition where the evidence does not decide the option.
pub const UNDECIDED: &str = "undecided";

/// The conditions of all options with their evidence; `None` for one that is undecided. With `tried`, each is also tested
/// with other values in place of the measured ones, as under the numerics of the lesson.
fn evaluate_conditions(
    bound: &BoundVerify<'_>,
    outcome: &Outcome,
    verify: &Verify,
    tried: bool,
    findings: &mut Vec<Finding>,
) -> Result<Vec<Option<(MeasuredValue, ConditionMargin)>>, String> {
    let ground = if tried { grounded_value } else { decided_value };
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
                let condition = bound.evaluate_margin(&found);
                all.push(Some((found, condition)));
            }
        }
    }
    reason.map_or(Ok(all), Err)
}

/// Whether a text declares an option as undecided.
pub(super) fn is_undecided(text: &Text) -> bool {
    text.value.trim() == UNDECIDED
}

/// Whether exactly the same options hold, with the smallest margin.
pub(super) enum SameOptions {
    /// The same options hold, with this smallest margin.
    Yes(f64),
    /// Another option holds, or one does not: describes the first.
    No(String),
    /// Undecided: the reason.
    Open(String),
}

/// Whether exactly the same options hold as before, in an outcome with other settings.
pub(super) fn compare_options(
    bound: &BoundVerify<'_>,
    outcome: &Outcome,
    verify: &Verify,
    weights: &[Weight],
) -> SameOptions {
    let values = match evaluate_conditions(bound, outcome, verify, false, &mut Vec::new()) {
        Ok(values) => values,
        Err(reason) => return SameOptions::Open(reason),
    };
    let now = values.iter().enumerate().map(|(i, found)| option_weight(i, found.as_ref()));
    let mut least = f64::INFINITY;
    for (now, then) in now.zip(weights) {
        if now.holds != then.holds {
            let i = now.option.unwrap_or(0);
            return SameOptions::No(format!("the condition of option {i} {}", now.describe()));
        }
        least = least.min(now.margin.map_or(f64::INFINITY, f64::abs));
    }
    SameOptions::Yes(least)
}

fn option_weight(i: usize, found: Option<&(MeasuredValue, ConditionMargin)>) -> Weight {
    let condition = found.map(|(_, w)| w);
    Weight {
        option: Some(i),
        holds: condition.map(|w| w.holds),
        margin: condition.and_then(|w| w.margin),
        spread: None,
    }
}
