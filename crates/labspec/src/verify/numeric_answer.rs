//! The answer of a numeric question: whether the keyed number equals the value of an expression, within its tolerance and
//! in its unit.

use super::bound::BoundVerify;
use super::bracket::{BracketClaim, numbers_agree, report_undecided_bracket};
use super::format::significant;
use super::found::MeasuredValue;
use super::grounded::{decided_value, report_constant_claim, report_undecided};
use super::measures_another::check_words_of_measure;
use super::outcome::MeasuredRuns;
use super::outcomes::Outcomes;
use super::ratio_of_change::{StatedExpr, check_asked_change};
use super::ratio_order::check_ratio_order;
use super::survival::{fragile_answer, verdict_by, withstand_numerics};
use super::value_of::value_of;
use super::verdict::{Answer, Verdict, Weight};
use super::{quote, units};
use crate::finding::Finding;
use crate::rules;
use crate::source::Text;
use crate::spec::{Question, QuestionKind};
use labspec_bind::units::{parse as units_of, written};
use labspec_expr::Value;
use labspec_expr::dimension::Dimension;
use labspec_expr::parse_expression;
use std::ops::Range;

/// Checks that the keyed number equals the value of the expression, and that its tolerance rejects the values of mistakes
/// (`wrong`).
pub(super) fn check_number(
    bound: &BoundVerify<'_>,
    outcomes: &Outcomes,
    text: &Text,
    wrong: &[Text],
    question: &Question,
    findings: &mut Vec<Finding>,
) -> Answer {
    let (Some((answer, tol)), QuestionKind::Numeric { answer: Some(keyed), unit: asked, .. }) =
        (question.numeric(), &question.kind)
    else {
        return Answer::failed("the question does not ask for a number");
    };
    let value = match finite_number(bound, &outcomes.nominal, text, findings) {
        _ if tol < 0.0 => return Answer::failed("its tolerance is below 0"),
        Ok(value) => value,
        Err(reason) => return Answer::failed(reason),
    };
    let in_text = unit_in_text(bound, &outcomes.nominal, text, question).filter(|_| asked.is_none());
    let asked = asked.as_ref().map(|unit| unit.as_str()).or(in_text.as_deref());
    let measured = asked.and_then(|unit| dimension_beside(bound, &outcomes.nominal, text, unit));
    let gives = measured.as_ref().map(written);
    let is_fraction = measured.as_ref().is_some_and(|d| d.is_number() && d.factor == 1.0);
    if let Some(reason) = contradicts_question(bound, &outcomes.nominal, text, question, asked, findings) {
        return Answer::failed(reason);
    }
    let unit = quote::answer_unit(asked, measured);
    let mut key = NumericKey { answer, tol, span: keyed.span.clone(), text, factor: unit.factor(), gives };
    key.choose_percent(asked, is_fraction, value.value.to_number());
    if let Some(refused) = key.refuse_unit(&unit, findings) {
        return refused;
    }
    let computed = key.factor * value.value.to_number();
    if !computed.is_finite() {
        findings.push(no_value(text, computed));
        return Answer::failed("the simulation gives no number");
    }
    if let Some(reason) = key.report_undecided_bracket(bound, &outcomes.nominal, findings) {
        return Answer::failed(reason);
    }
    let margin = Some(key.margin(computed));
    let mut weights = vec![Weight { option: None, holds: Some(key.accepts(computed)), margin, spread: None }];
    let nominal = weights.clone();
    let judged = |verdict, reason: String| Answer { verdict, reason, weights: nominal.clone() };
    if !key.accepts(computed) {
        return judged(Verdict::Refuted, key.refute(computed, findings));
    }
    let says = |value: &Value| key.accepts(key.factor * value.to_number());
    if value.unread || !bound.could_differ(&value, Some(&says)) {
        return Answer::failed(report_constant_claim(text, findings));
    }
    if let Err((verdict, reason)) =
        key.check_tolerance_rejects_wrong(bound, &outcomes.nominal, wrong, findings)
    {
        return judged(verdict, reason);
    }
    let mut turns = |outcome: &MeasuredRuns, how: &str, weights: &mut [Weight]| {
        key.answer_changes(bound, outcome, how, computed, weights)
    };
    if let Err((verdict, reason)) =
        withstand_numerics(bound, outcomes, &mut weights, keyed.span.clone(), findings, &mut turns)
    {
        return judged(verdict, reason);
    }
    let is_open = unit == quote::AnswerUnit::Unknown && asked.is_some_and(quote::is_unit);
    let reason = if is_open { UNIT_NOT_COMPARED } else { "" }.to_string();
    Answer { verdict: verdict_by(Some(value.evidence)), reason, weights }
}

/// The dimension of an expression beside the unit of a question. A frequency times 2π is an angular velocity, which is not in hertz.
fn dimension_beside(
    bound: &BoundVerify<'_>,
    outcome: &MeasuredRuns,
    text: &Text,
    unit: &str,
) -> Option<Dimension> {
    let measured = units::of_claim(bound, outcome, text)?;
    Some(if unit.contains("Hz") { quote::without_pure_factor(measured) } else { measured })
}

/// Reports an expression that is not what the question asks for: the ratio where it asks for a change, or the inverse ratio. Returns the
/// reason.
fn contradicts_question(
    bound: &BoundVerify<'_>,
    outcome: &MeasuredRuns,
    text: &Text,
    question: &Question,
    unit: Option<&str>,
    findings: &mut Vec<Finding>,
) -> Option<String> {
    let in_text = quote::asked_unit(question.q.as_str());
    let is_percentage = unit.or(in_text.as_deref()).is_some_and(|unit| quote::percentage(unit).is_some());
    let text_of = |name: &str| bound.text_of_measure(name);
    let value = value_of(bound, outcome, &parse_expression(text.as_str()).tree, text);
    let expr = StatedExpr { text, value, measures: &text_of, languages: bound.stage().languages() };
    check_words_of_measure(bound, outcome, question.q.as_str(), question.q.span(), text, findings);
    let change = is_percentage.then(|| check_asked_change(&question.q, expr, findings)).flatten();
    change.or_else(|| check_ratio_order(bound, outcome, &question.q, text, findings))
}

/// The unit in which the text of a question asks: without a unit beside the field, the student answers in it. `None` for pure numbers
/// and for units of angles other than degrees and radians: a text may ask for turns or things.
fn unit_in_text(
    bound: &BoundVerify<'_>,
    outcome: &MeasuredRuns,
    text: &Text,
    question: &Question,
) -> Option<String> {
    let asked = quote::asked_unit(question.q.as_str())?;
    let measured = units::of_claim(bound, outcome, text)?;
    let is_angle =
        || units_of(&asked).is_some_and(|unit| unit.has_angle() && unit.agrees(&measured) && !is_turn(&unit));
    let is_read = if measured.has_angle() { is_angle() } else { !measured.is_number() };
    is_read.then_some(asked)
}

/// Whether a unit of an angle is a whole turn.
fn is_turn(unit: &Dimension) -> bool {
    let radians = unit.factor.abs();
    [std::f64::consts::TAU, 1.0 / std::f64::consts::TAU]
        .iter()
        .any(|turn| (radians / turn - 1.0).abs() < 1e-6)
}

/// The value of the expression of a numeric answer. If there is none, the reason is returned and reported.
fn finite_number(
    bound: &BoundVerify<'_>,
    outcome: &MeasuredRuns,
    text: &Text,
    findings: &mut Vec<Finding>,
) -> Result<MeasuredValue, String> {
    let value = decided_value(bound, outcome, text, findings)?;
    if !matches!(value.value, Value::Number(_)) {
        findings.push(no_quantity(text, &value.value));
        return Err("the expression gives no number".to_string());
    }
    let gives = value.value.to_number();
    if !gives.is_finite() {
        findings.push(no_value(text, gives));
        return Err("the simulation gives no number".to_string());
    }
    Ok(value)
}

/// The keyed number of a question, and the expression that it is compared with.
struct NumericKey<'q> {
    answer: f64,
    tol: f64,
    /// The span of the number.
    span: Range<usize>,
    text: &'q Text,
    /// Factor that converts the value of the expression to the unit of the question.
    factor: f64,
    /// The unit of the expression, if it is known.
    gives: Option<String>,
}

impl NumericKey<'_> {
    /// The distance of a number from the end of the tolerance, positive inside.
    fn margin(&self, x: f64) -> f64 {
        self.tol - (x - self.answer).abs()
    }

    /// Sets the factor of an answer in percent. An expression that certainly is a fraction of one is no number of percent.
    fn choose_percent(&mut self, asked: Option<&str>, is_fraction: bool, value: f64) {
        if let Some(share) = asked.and_then(quote::percentage) {
            self.factor = self.nearest_factor([if is_fraction { share } else { 1.0 }, share], value);
        }
    }

    /// The factor with which a value is nearest to the answer: an expression gives 16.3 % as 16.3 or as 0.163.
    fn nearest_factor(&self, factors: [f64; 2], value: f64) -> f64 {
        let [a, b] = factors;
        if self.margin(b * value) > self.margin(a * value) { b } else { a }
    }

    fn accepts(&self, x: f64) -> bool {
        self.margin(x) >= 0.0
    }

    /// Reports an answer that the bracket of a search does not decide, and returns the reason.
    fn report_undecided_bracket(
        &self,
        bound: &BoundVerify<'_>,
        nominal: &MeasuredRuns,
        findings: &mut Vec<Finding>,
    ) -> Option<String> {
        let accepts = |x: f64| self.accepts(self.factor * x);
        let agrees = |values: &[Value]| numbers_agree(values, self.answer / self.factor, &accepts);
        let (place, rule) = (self.span.clone(), rules::CLAIM_WITHOUT_NUMBER);
        let claim = BracketClaim { text: self.text, place, rule, agrees: &agrees };
        report_undecided_bracket(bound, nominal, &claim, findings)
    }

    /// The answer if the unit of the question is unknown or is not that of the expression.
    fn refuse_unit(&self, unit: &quote::AnswerUnit, findings: &mut Vec<Finding>) -> Option<Answer> {
        match unit {
            quote::AnswerUnit::Unread(asked_in, gives) => {
                let message = format!("\"{asked_in}\" is not a known unit, but the expression gives {gives}");
                findings.push(
                    Finding::error(rules::VERIFY_ANSWER, self.span.clone(), message.clone())
                        .why("the unit of the answer could not be compared")
                        .help("write the unit by its symbol: `s`, `mm`, `m/s^2`")
                        .related(self.text.span(), format!("this is in {gives}")),
                );
                Some(Answer::failed(message))
            }
            quote::AnswerUnit::Wrong(asked_in, gives) => {
                let message = format!("the question asks in {asked_in}, but the expression gives {gives}");
                findings.push(wrong_unit(self.span.clone(), self.text, &message));
                Some(Answer { verdict: Verdict::Refuted, reason: message, weights: Vec::new() })
            }
            quote::AnswerUnit::Equal(_) | quote::AnswerUnit::Unknown => None,
        }
    }

    /// Reports that the simulation gives another number.
    fn refute(&self, computed: f64, findings: &mut Vec<Finding>) -> String {
        let (answer, tol) = (self.answer, self.tol);
        let message = format!("the answer is {answer}, but the simulation gives {}", significant(computed));
        findings.push(
            Finding::error(rules::ANSWER_REFUTED, self.span.clone(), message.clone())
                .why(format!(
                    "they differ by {}, but the tolerance is {}",
                    significant((computed - answer).abs()),
                    significant(tol)
                ))
                .help(self.help_for(computed))
                .related(self.text.span(), format!("this is {}", significant(computed))),
        );
        message
    }

    /// The number to write, or the unit of the expression if the answer is right in it.
    fn help_for(&self, computed: f64) -> String {
        // As many decimals as in the text, if the tolerance accepts them and the first digit is among them.
        let decimals = self.answer.to_string().split_once('.').map_or(0, |(_, digits)| digits.len());
        let rounded = labspec_expr::to_fixed(computed, decimals);
        let is_near = |x: f64| (x - computed).abs() <= 0.5 * self.tol.min(0.1 * computed.abs());
        let right = match rounded.parse::<f64>().is_ok_and(is_near) {
            true => rounded,
            false => significant(computed),
        };
        match &self.gives {
            Some(unit) if self.factor != 1.0 && self.accepts(computed / self.factor) && unit == "1" => {
                format!("remove the unit, without which the answer is right, or write {right}")
            }
            Some(unit) if self.factor != 1.0 && self.accepts(computed / self.factor) => {
                format!("write `\"unit\": \"{unit}\"`, in which the answer is right, or write {right}")
            }
            _ => match self.metric_prefix(computed) {
                Some(power) => format!(
                    "write {right}, or the unit in which {} is right: the answer is 10^{power} times the value of the expression",
                    self.answer
                ),
                None => format!("write {right}, or correct the expression"),
            },
        }
    }

    /// The power of ten between two metric prefixes, or to percent, with which the value is the answer.
    fn metric_prefix(&self, computed: f64) -> Option<i32> {
        [3, -3, 2, -2, 6, -6].into_iter().find(|power| self.accepts(computed * 10f64.powi(*power)))
    }

    /// Checks that the tolerance rejects the values of mistakes.
    ///
    /// # Errors
    /// It accepts one, or one has no value: the verdict, and the reason.
    fn check_tolerance_rejects_wrong(
        &self,
        bound: &BoundVerify<'_>,
        nominal: &MeasuredRuns,
        wrong: &[Text],
        findings: &mut Vec<Finding>,
    ) -> Result<(), (Verdict, String)> {
        for mistake in wrong {
            let x = self.factor
                * value_of_wrong_answer(bound, nominal, mistake, findings).map_err(|reason| {
                    (Verdict::Failed, format!("a value of `wrong` is unknown: {reason}"))
                })?;
            if self.accepts(x) {
                let message = format!("the tolerance accepts {}, which a mistake gives", significant(x));
                findings.push(
                    Finding::error(rules::ANSWER_AMBIGUOUS, mistake.span(), message.clone())
                        .why("a student who makes this mistake is graded as correct")
                        .help(format!(
                            "make the tolerance smaller than {} to reject it",
                            significant((x - self.answer).abs())
                        ))
                        .related(self.span.clone(), "this is the answer"),
                );
                return Err((Verdict::Ambiguous, message));
            }
        }
        Ok(())
    }

    /// A finding if the answer is false in an outcome under perturbed numerics; otherwise the spread of `weights` is
    /// widened. `computed` is the value under the numerics of the lesson.
    fn answer_changes(
        &self,
        bound: &BoundVerify<'_>,
        outcome: &MeasuredRuns,
        how: &str,
        computed: f64,
        weights: &mut [Weight],
    ) -> Option<Finding> {
        let again = decided_value(bound, outcome, self.text, &mut Vec::new());
        let what = match again.map(|f| self.factor * f.value.to_number()) {
            Err(reason) => reason,
            Ok(x) if self.accepts(x) => {
                weights.iter_mut().for_each(|w| w.widen(Some(self.margin(x))));
                return None;
            }
            Ok(x) => {
                format!("then it is {}, but the tolerance is {}", significant(x), significant(self.tol))
            }
        };
        let nominal = format!("with the numerics of the lesson, this is {}", significant(computed));
        Some(fragile_answer(self.span.clone(), how, &what).related(self.text.span(), nominal))
    }
}

/// The remark for a correct number whose unit could not be compared.
const UNIT_NOT_COMPARED: &str =
    "its unit could not be compared, because the unit of the expression is uncertain";

/// The value of a mistake, given by an expression under `wrong`.
fn value_of_wrong_answer(
    bound: &BoundVerify<'_>,
    outcome: &MeasuredRuns,
    text: &Text,
    findings: &mut Vec<Finding>,
) -> Result<f64, String> {
    // A mistake may be a bare number.
    let found = bound.find(outcome, text, findings).ok_or("it cannot be evaluated")?;
    if let Some(undecided) = &found.undecided {
        return Err(report_undecided(bound, outcome, text, undecided, findings));
    }
    match found.value {
        Value::Number(x) if x.is_finite() => Ok(x),
        Value::Number(x) => {
            findings.push(no_value(text, x));
            Err(format!("it is {}", name_not_finite(x)))
        }
        value => {
            findings.push(no_quantity(text, &value));
            Err("it gives no number".to_string())
        }
    }
}

/// The finding about a condition or a text where a number is required.
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

/// The finding about a unit of a question that differs from that of the value.
fn wrong_unit(span: Range<usize>, text: &Text, message: &str) -> Finding {
    Finding::error(rules::ANSWER_REFUTED, span, message)
        .why("a student who answers in this unit is graded as wrong")
        .help("correct the unit of the question, or convert the expression to it")
        .related(text.span(), "the expression")
}

/// The finding about an expression that gives no number where one is claimed.
fn no_value(text: &Text, x: f64) -> Finding {
    let message = format!("this expression gives {}, which is not a number", name_not_finite(x));
    Finding::error(rules::CLAIM_WITHOUT_NUMBER, text.span(), message)
        .why("there is no number to compare with: it divides by zero, or a value grows without end")
        .help("correct the expression")
}

fn name_not_finite(x: f64) -> &'static str {
    if x.is_nan() { "NaN" } else { "infinity" }
}

#[cfg(test)]
mod tests {
    use super::Verdict;

    /// The verdict on a numeric answer about a pendulum that is let go at 0.5 rad: its period is 1.441 s.
    fn verdict(question: &str, unit: Option<&str>, answer: f64, value: &str) -> Verdict {
        let xml = "<mujoco><worldbody><body><joint axis='0 1 0'/><geom size='.05' pos='0 0 -.5'/></body></worldbody></mujoco>";
        let lab = serde_json::json!({"stopAt": 4, "xml": xml, "setup": "data.qpos[0] = 0.5"});
        let mut asked = serde_json::json!({"kind": "numeric", "q": question, "answer": answer, "tol": 0.02 * answer,
            "verify": {"lab": lab, "measure": {"q": "max(data.qpos[0])", "T": "period(data.qpos[0])"}, "value": value}});
        if let Some(unit) = unit {
            asked["unit"] = unit.into();
        }
        let quiz = serde_json::json!({"id": "q", "questions": [asked]}).to_string();
        let report = crate::Checker::new(|_: &str| None::<String>).check("q.json", &quiz);
        let answers = report.checked.claims.iter().filter_map(|claim| claim.judgement.answer.as_ref());
        answers.map(|answer| answer.verdict).next().unwrap_or(Verdict::Unverified)
    }

    #[test]
    fn answers_are_in_the_unit_of_the_text() {
        let angle = "How far does it swing, in degrees?";
        assert_eq!(verdict(angle, None, 0.5, "q"), Verdict::Refuted);
        assert_eq!(verdict(angle, None, 28.65, "q"), Verdict::Verified);
        assert_eq!(verdict("How far does it swing, in rad?", None, 0.5, "q"), Verdict::Verified);
        assert_eq!(verdict("What is its frequency?", Some("Hz"), 4.36, "2 * Math.PI / T"), Verdict::Refuted);
        assert_eq!(verdict("What is its frequency?", Some("Hz"), 0.694, "1 / T"), Verdict::Verified);
        assert_eq!(
            verdict("What is its angular frequency?", Some("rad/s"), 4.36, "2 * Math.PI / T"),
            Verdict::Verified
        );
    }
}
