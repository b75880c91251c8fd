//! Checks one quote: compares a number or words with the value of its expression, in the nominal and in perturbed runs.

use super::bound::BoundVerify;
use super::bracket::{BracketClaim, conditions_agree, numbers_agree, report_undecided_bracket};
use super::found::MeasuredValue;
use super::grounded::grounded_value;
use super::numerics::QuotedChange;
use super::outcome::MeasuredRuns;
use super::outcomes::Outcomes;
use super::quote::RenderedText;
use super::quote::{self, OtherValue, QuoteState};
use super::units;
use crate::finding::Finding;
use crate::ledger::Evidence;
use crate::rules;
use crate::source::Text;
use labspec_expr::Value;
use serde::{Deserialize, Serialize};
use std::ops::Range;

/// A quoted number, or quoted words.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Quote {
    /// The quoted text.
    pub text: String,
    /// The span of the claim under `says`.
    pub span: Range<usize>,
    /// The state.
    pub state: QuoteState,
    /// Whether its value was simulated.
    pub evidence: Evidence,
    /// Why it is not right.
    pub reason: String,
    /// The value of the expression; NaN when it could not be computed. For words, 1 where they are right and 0 where they
    /// are not.
    #[serde(with = "crate::verify::float_bits")]
    pub computed: f64,
}

impl Quote {
    /// A quote that could not be checked.
    pub(super) fn unclear(text: &Text, reason: &str) -> Quote {
        Quote {
            text: text.value.clone(),
            span: text.span(),
            state: QuoteState::Unclear,
            evidence: Evidence::Computed,
            reason: reason.to_string(),
            computed: f64::NAN,
        }
    }

    /// Every verdict of a quote.
    pub const VERDICTS: [&'static str; 4] = ["verified", "computed", "refuted", "failed"];

    /// The verdict as one word, one of [`Quote::VERDICTS`].
    pub fn verdict(&self) -> &'static str {
        match (self.state, self.evidence) {
            (QuoteState::Right, Evidence::Simulated) => "verified",
            (QuoteState::Right, Evidence::Computed) => "computed",
            (QuoteState::Wrong, _) => "refuted",
            (QuoteState::Unclear, _) => "failed",
        }
    }
}

/// The data that quotes are compared with.
#[derive(Clone, Copy)]
pub(super) struct QuoteChecker<'c, 'b> {
    pub(super) bound: &'c BoundVerify<'b>,
    pub(super) outcomes: &'c Outcomes,
    pub(super) rendered: &'c RenderedText,
}

impl QuoteChecker<'_, '_> {
    /// Reports a quote that the bracket of a search does not decide, and returns the reason.
    fn report_undecided_bracket(
        self,
        claim: &quote::QuoteClaim<'_>,
        agrees: &dyn Fn(&[Value]) -> bool,
        findings: &mut Vec<Finding>,
    ) -> Option<String> {
        let (place, rule) = (claim.quote.span(), rules::QUOTE_UNCLEAR);
        let claim = BracketClaim { text: claim.expr, place, rule, agrees };
        report_undecided_bracket(self.bound, &self.outcomes.nominal, &claim, findings)
    }
}

/// The value of an expression in the nominal runs and in perturbed runs.
pub(super) struct QuotedValue {
    found: MeasuredValue,
    timestep: Vec<OtherValue>,
    start: Vec<OtherValue>,
}

impl QuotedValue {
    pub(super) fn measure(
        checker: QuoteChecker<'_, '_>,
        expr: &Text,
        findings: &mut Vec<Finding>,
    ) -> Result<QuotedValue, String> {
        let QuoteChecker { bound, outcomes, .. } = checker;
        let found = grounded_value(bound, &outcomes.nominal, expr, findings)?;
        let others = |change: QuotedChange| -> Vec<OtherValue> {
            outcomes.quoted(change).filter_map(|(o, how)| value_of(bound, o, expr, how)).collect()
        };
        let (timestep, start) = (others(QuotedChange::Timestep), others(QuotedChange::Start));
        Ok(QuotedValue { found, timestep, start })
    }

    /// The value, if it is a number.
    pub(super) fn number(&self) -> Option<f64> {
        matches!(self.found.value, Value::Number(_)).then(|| self.found.value.to_number())
    }

    pub(super) fn is_condition(&self) -> bool {
        matches!(self.found.value, Value::Boolean(_))
    }

    /// Whether the value is a condition, as words require; a finding if not.
    pub(super) fn is_condition_of(
        &self,
        checker: QuoteChecker<'_, '_>,
        expr: &Text,
        findings: &mut Vec<Finding>,
    ) -> bool {
        checker.bound.is_condition(&self.found, expr, findings)
    }

    /// Whether the condition holds.
    pub(super) fn holds(&self) -> bool {
        self.found.value.truthy()
    }
}

fn value_of(
    bound: &BoundVerify<'_>,
    outcome: &MeasuredRuns,
    expr: &Text,
    how: &'static str,
) -> Option<OtherValue> {
    let found = bound.find(outcome, expr, &mut Vec::new())?;
    Some(OtherValue { how, value: found.value.to_number() })
}

/// Whether an expression, or a measure that it reads, is a reciprocal of a period that is not multiplied by 2π.
fn counts_turns(bound: &BoundVerify<'_>, expr: &str) -> bool {
    let is_read =
        |name: &str| expr.split(|c: char| !c.is_alphanumeric() && c != '_').any(|word| word == name);
    let measures = bound.measure_texts().filter(|(name, _)| is_read(name)).map(|(_, text)| text);
    let texts: Vec<&str> = measures.chain([expr]).collect();
    let has = |word: &str| texts.iter().any(|text| text.contains(word));
    has("period(") && !has("PI") && !has("6.28")
}

/// Checks a quoted number.
pub(super) fn check_number(
    checker: QuoteChecker<'_, '_>,
    claim: &quote::QuoteClaim<'_>,
    part: &quote::QuotePart,
    given: QuotedValue,
    places: Vec<quote::QuotePlace>,
    findings: &mut Vec<Finding>,
) -> Quote {
    let unit = &|| units::of_claim(checker.bound, &checker.outcomes.nominal, claim.expr);
    let computed = given.found.value.to_number();
    let counts_turns = counts_turns(checker.bound, claim.expr.as_str());
    let value =
        quote::QuoteValue { computed, timestep: &given.timestep, start: &given.start, unit, counts_turns };
    let mut found = Vec::new();
    let mut o = quote::check_quote(claim, &part.reading, places, &value, checker.rendered, &mut found);
    if let Some(read) = o.read.filter(|_| o.state != QuoteState::Unclear) {
        // The number is compared in the unit of the quote.
        let factor = if computed == 0.0 { 1.0 } else { o.computed / computed };
        let agrees = |values: &[Value]| numbers_agree(values, read.value / factor, &|x| read.is(factor * x));
        if let Some(reason) = checker.report_undecided_bracket(claim, &agrees, findings) {
            found.clear();
            (o.state, o.reason) = (QuoteState::Unclear, reason);
        }
    }
    findings.extend(found);
    let text = claim.part.trim().to_string();
    let (state, evidence, reason) = (o.state, given.found.evidence, o.reason);
    Quote { text, span: claim.quote.span(), state, evidence, reason, computed }
}

/// Checks words that state a condition.
pub(super) fn check_words(
    checker: QuoteChecker<'_, '_>,
    claim: &quote::QuoteClaim<'_>,
    given: &QuotedValue,
    places: &[Range<usize>],
    findings: &mut Vec<Finding>,
) -> Quote {
    let moved = |others: &[OtherValue]| -> Vec<&'static str> {
        others.iter().filter(|o| (o.value != 0.0) != given.holds()).map(|o| o.how).collect()
    };
    let condition = quote::QuotedCondition {
        holds: given.holds(),
        timestep: moved(&given.timestep),
        start: moved(&given.start),
    };
    let mut found = Vec::new();
    let (mut state, mut reason) = quote::check_words(claim, places, &condition, checker.rendered, &mut found);
    if state != QuoteState::Unclear
        && let Some(undecided) = checker.report_undecided_bracket(claim, &conditions_agree, findings)
    {
        found.clear();
        (state, reason) = (QuoteState::Unclear, undecided);
    }
    findings.extend(found);
    let computed = f64::from(u8::from(given.holds()));
    let (text, evidence) = (claim.quote.value.clone(), given.found.evidence);
    Quote { text, span: claim.quote.span(), state, evidence, reason, computed }
}
