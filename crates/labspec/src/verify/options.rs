//! The answer of a question with options: one condition per option, and whether only the keyed option holds.

use super::bound::BoundVerify;
use super::bracket::{BracketClaim, conditions_agree, report_undecided_bracket};
use super::condition::ConditionMargin;
use super::condition_units::check_condition_units;
use super::direction::check_direction;
use super::format::shorten;
use super::found::MeasuredValue;
use super::grounded::{decided_value, grounded_value};
use super::loose_tolerance::check_tolerance;
use super::measures_another::check_words_of_measure;
use super::one_sample::check_one_sample;
use super::one_sided::check_one_sided;
use super::option_numbers::check_option_numbers;
use super::outcome::MeasuredRuns;
use super::outcomes::Outcomes;
use super::stated_numbers::check_stated_numbers;
use super::survival::{fragile_answer, verdict_by, withstand_numerics};
use super::verdict::{Answer, Verdict, Weight};
use crate::finding::Finding;
use crate::rules;
use crate::source::Text;
use crate::spec::{ChoiceStyle, KeyValue, Question, QuestionKind, Verify};
use std::ops::Range;

/// Evaluates which options hold, and whether the keyed one is the only one.
pub(super) fn check_options(
    bound: &BoundVerify<'_>,
    outcomes: &Outcomes,
    verify: &Verify,
    question: &Question,
    findings: &mut Vec<Finding>,
) -> Answer {
    let (Some(right), Some(key)) = (question.keyed(), question.key()) else {
        return Answer::failed(match question.key().map(|key| &key.value) {
            Some(KeyValue::Hash(_)) => "no choice that was tried has the hash of the question",
            _ => "the question has no correct option",
        });
    };
    let (options, form): (&[Text], _) = match &question.kind {
        QuestionKind::Choice { options, style: ChoiceStyle::Multiple, .. } => (options, AnswerForm::Several),
        QuestionKind::Choice { options, .. } => (options, AnswerForm::One),
        _ => (&[], AnswerForm::Statement),
    };
    if verify.options.len() != question.condition_count() {
        return Answer::failed("the number of conditions differs from the number of options");
    }
    let values = match evaluate_conditions(bound, &outcomes.nominal, verify, true, findings) {
        Ok(values) => values,
        Err(reason) => return Answer::failed(reason),
    };
    let weights = values.iter().enumerate().map(|(i, value)| option_weight(i, value.as_ref())).collect();
    let (keyed, is_hashed) = (key.span.clone(), matches!(key.value, KeyValue::Hash(_)));
    let judgement =
        OptionJudgement { verify, options, form, right, keyed: keyed.clone(), is_hashed, weights };
    let undecided = judgement.options_with(None);
    if let Some(answer) = judgement.refuse(&undecided, findings) {
        return answer;
    }
    if let Some(reason) = judgement.contradiction(bound, &outcomes.nominal, question, findings) {
        return judgement.judged(Verdict::Failed, reason);
    }
    if judgement.is_alone(undecided.len()) {
        return judgement.judged(Verdict::Failed, "no other option is decided".to_string());
    }
    let mut widened = judgement.weights.clone();
    let mut turns = |outcome: &MeasuredRuns, how: &str, weights: &mut [Weight]| {
        judgement.answer_changes(bound, outcome, how, weights)
    };
    if let Err((verdict, reason)) =
        withstand_numerics(bound, outcomes, &mut widened, keyed, findings, &mut turns)
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

/// What the conditions of a question are about.
#[derive(Clone, Copy, PartialEq)]
enum AnswerForm {
    /// Options, one of which is correct.
    One,
    /// Options, any number of which are correct.
    Several,
    /// A statement, with one condition.
    Statement,
}

/// The options of a question and their results under the numerics of the lesson.
struct OptionJudgement<'q> {
    verify: &'q Verify,
    options: &'q [Text],
    form: AnswerForm,
    /// The keyed options, and the span of the key.
    right: Vec<usize>,
    keyed: Range<usize>,
    /// Whether the key is a hash, which a fix cannot replace.
    is_hashed: bool,
    weights: Vec<Weight>,
}

impl OptionJudgement<'_> {
    /// Compares the numbers in the texts of the options, or of the statement, with their conditions. The reason if one contradicts.
    fn contradiction(
        &self,
        bound: &BoundVerify<'_>,
        nominal: &MeasuredRuns,
        question: &Question,
        findings: &mut Vec<Finding>,
    ) -> Option<String> {
        let holds: Vec<Option<bool>> = self.weights.iter().map(|w| w.holds).collect();
        let conditions = &self.verify.options;
        let wrong = check_option_numbers(bound, nominal, self.options, conditions, &holds, findings);
        if wrong.is_some() {
            return wrong;
        }
        let is_statement = self.form == AnswerForm::Statement;
        let texts = if is_statement { std::slice::from_ref(&question.q) } else { self.options };
        let stated = texts.iter().zip(conditions).zip(&holds).filter(|(_, holds)| **holds == Some(true));
        let stated: Vec<(&Text, &Text)> = stated.map(|(both, _)| both).collect();
        let before = if is_statement { "" } else { question.q.as_str() };
        let wrong = check_condition_units(bound, nominal, &stated, findings)
            .or_else(|| check_stated_numbers(bound, nominal, question, &stated, findings))
            .or_else(|| {
                let mut all = stated.iter();
                all.find_map(|both| check_direction(bound, nominal, before, *both, findings))
            });
        if wrong.is_none() {
            for both in &stated {
                check_tolerance(bound, nominal, &question.q, *both, findings);
                check_one_sided(bound, nominal, *both, findings);
                check_one_sample(bound, nominal, *both, findings);
                let (text, condition) = *both;
                check_words_of_measure(bound, nominal, text.as_str(), text.span(), condition, findings);
            }
        }
        wrong
    }

    /// An option in a message: `2 ("It slides.")`.
    fn name(&self, i: usize) -> String {
        if self.form == AnswerForm::Statement {
            return "the statement".to_string();
        }
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

    /// The answer if a keyed option is undecided or does not hold, or if another one holds.
    fn refuse(&self, undecided: &[usize], findings: &mut Vec<Finding>) -> Option<Answer> {
        let true_options = self.options_with(Some(true));
        if self.form == AnswerForm::Statement && !undecided.is_empty() {
            return Some(self.judged(Verdict::Failed, "the statement is not decided".to_string()));
        }
        // The key of several options says of each whether it is correct; a decided one that it has wrong refutes it.
        if self.form == AnswerForm::Several {
            let is_wrong = |(i, w): (usize, &Weight)| w.holds.is_some_and(|h| h != self.right.contains(&i));
            if self.weights.iter().enumerate().any(is_wrong) {
                return Some(self.refute_set(&true_options, findings));
            }
            let i = undecided.first()?;
            let reason =
                format!("whether answer {} is correct is not decided by this evidence", self.name(*i));
            return Some(self.judged(Verdict::Failed, reason));
        }
        if let Some(i) = self.right.iter().find(|i| undecided.contains(i)) {
            let reason = format!("answer {} is not decided by this evidence", self.name(*i));
            return Some(self.judged(Verdict::Failed, reason));
        }
        if self.form != AnswerForm::One {
            return (true_options != self.right).then(|| self.refute_set(&true_options, findings));
        }
        let answer = self.right.first().copied()?;
        if !true_options.contains(&answer) {
            return Some(self.refute(answer, &true_options, findings));
        }
        (true_options.len() > 1).then(|| self.report_ambiguous(answer, &true_options, findings))
    }

    /// Whether no other option than the keyed one is decided, so that nothing distinguishes it.
    fn is_alone(&self, undecided: usize) -> bool {
        self.form == AnswerForm::One && undecided + 1 == self.weights.len()
    }

    /// Reports that the options that hold are not the keyed ones, or that a statement is keyed wrong.
    fn refute_set(&self, true_options: &[usize], findings: &mut Vec<Finding>) -> Answer {
        let differs = |i: &usize| {
            self.weights.get(*i).and_then(|w| w.holds).is_some_and(|h| h != self.right.contains(i))
        };
        let wrong: Vec<usize> = (0..self.weights.len()).filter(differs).collect();
        let (message, key) = if self.form == AnswerForm::Statement {
            let truth = !true_options.is_empty();
            (format!("the simulation refutes the answer: the statement is {truth}"), truth.to_string())
        } else {
            let describe = |i: &usize| {
                let truth = if true_options.contains(i) { "true" } else { "not true" };
                format!("{} is {truth}", self.name(*i))
            };
            let differences: Vec<String> = wrong.iter().map(describe).collect();
            let key: Vec<String> = true_options.iter().map(usize::to_string).collect();
            (
                format!("the simulation refutes the answer: {}", differences.join(", ")),
                format!("[{}]", key.join(", ")),
            )
        };
        let mut f = Finding::error(rules::ANSWER_REFUTED, self.keyed.clone(), message.clone())
            .why("a student who predicts the simulation correctly is graded as wrong")
            .help(format!("correct the answer or the conditions: the conditions give {key}"));
        for i in wrong {
            f = f.related(self.condition(i), format!("this condition {}", self.describe(i)));
        }
        // With an undecided option, the whole key is unknown.
        let is_known = !self.is_hashed && self.weights.iter().all(|w| w.holds.is_some());
        findings.push(if is_known { f.guess(self.keyed.clone(), key) } else { f });
        self.judged(Verdict::Refuted, message)
    }

    /// Reports that the keyed option does not hold.
    fn refute(&self, answer: usize, true_options: &[usize], findings: &mut Vec<Finding>) -> Answer {
        let message = format!("the simulation refutes answer {}", self.name(answer));
        let f = Finding::error(rules::ANSWER_REFUTED, self.keyed.clone(), message.clone())
            .why("a student who predicts the simulation correctly is graded as wrong")
            .related(self.condition(answer), format!("this condition {}", self.describe(answer)));
        findings.push(match true_options {
            [] => f.help("correct the conditions, or the model: no condition holds"),
            [one] => {
                let right = self.name(*one);
                let f = f
                    .help(format!("correct the answer or the conditions: the true option is {right}"))
                    .related(self.condition(*one), format!("this condition {}", self.describe(*one)));
                if self.is_hashed { f } else { f.guess(self.keyed.clone(), one.to_string()) }
            }
            all => f.help(format!(
                "correct the answer or the conditions: the true options are {}",
                self.names(all)
            )),
        });
        self.judged(Verdict::Refuted, message)
    }

    /// Reports that the keyed option holds and others too.
    fn report_ambiguous(&self, answer: usize, true_options: &[usize], findings: &mut Vec<Finding>) -> Answer {
        let others: Vec<usize> = true_options.iter().copied().filter(|&i| i != answer).collect();
        let message = format!("besides answer {}, {} is also true", self.name(answer), self.names(&others));
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
        outcome: &MeasuredRuns,
        how: &str,
        weights: &mut [Weight],
    ) -> Option<Finding> {
        let again = evaluate_conditions(bound, outcome, self.verify, false, &mut Vec::new());
        for (weight, current) in weights.iter_mut().zip(again.iter().flatten()) {
            weight.widen(current.as_ref().and_then(|(_, condition)| condition.margin));
        }
        let first = self.right.first().copied().unwrap_or(0);
        let (i, what) = match &again {
            Err(reason) => (first, reason.clone()),
            Ok(current) => {
                let current = current.iter().enumerate().map(|(i, value)| option_weight(i, value.as_ref()));
                let (current, _) =
                    current.zip(weights.iter()).find(|(current, then)| current.holds != then.holds)?;
                let i = current.option.unwrap_or(first);
                (i, format!("then the condition of {} {}", self.name(i), current.describe()))
            }
        };
        let current = format!("with the numerics of the lesson, this {}", self.describe(i));
        Some(fragile_answer(self.keyed.clone(), how, &what).related(self.condition(i), current))
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
    outcome: &MeasuredRuns,
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
                let claim = BracketClaim {
                    text,
                    place: text.span(),
                    rule: rules::CLAIM_WITHOUT_NUMBER,
                    agrees: &conditions_agree,
                };
                let undecided = tried.then(|| report_undecided_bracket(bound, outcome, &claim, findings));
                reason = reason.or(undecided.flatten());
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
    outcome: &MeasuredRuns,
    verify: &Verify,
    weights: &[Weight],
) -> SameOptions {
    let values = match evaluate_conditions(bound, outcome, verify, false, &mut Vec::new()) {
        Ok(values) => values,
        Err(reason) => return SameOptions::Open(reason),
    };
    let current = values.iter().enumerate().map(|(i, found)| option_weight(i, found.as_ref()));
    let mut least = f64::INFINITY;
    for (current, then) in current.zip(weights) {
        if current.holds != then.holds {
            let i = current.option.unwrap_or(0);
            return SameOptions::No(format!("the condition of option {i} {}", current.describe()));
        }
        least = least.min(current.margin.map_or(f64::INFINITY, f64::abs));
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
