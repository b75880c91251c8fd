//! What the text says: numbers and words that are quoted, and the cells of tables.

use super::found::MeasuredValue;
use super::outcome::Outcome;
use super::quote::{self, Other, QuoteState};
use super::{BoundVerify, Outcomes, ShownText, column, grounded, units};
use crate::finding::Finding;
use crate::ledger::Evidence;
use crate::rules;
use crate::source::Text;
use crate::spec::{Question, Said, Verify};
use labspec_expr::Value;
use std::ops::Range;

/// A number that is quoted, or words.
#[derive(Clone, Debug, PartialEq)]
pub struct Quote {
    /// The text that is quoted.
    pub text: String,
    /// Where it is claimed: under `says`.
    pub span: Range<usize>,
    /// What became of it.
    pub state: QuoteState,
    /// How its value was found.
    pub evidence: Evidence,
    /// Why it is not right.
    pub reason: String,
    /// What the simulation gives; NaN when nothing could be computed. Of words 1 where they are right, and 0 where they are not.
    pub computed: f64,
}

impl Quote {
    /// One that could not be checked.
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

    /// In one word.
    pub fn verdict(&self) -> &'static str {
        match (self.state, self.evidence) {
            (QuoteState::Right, Evidence::Simulated) => "verified",
            (QuoteState::Right, Evidence::Computed) => "computed",
            (QuoteState::Wrong, _) => "refuted",
            (QuoteState::Unclear, _) => "failed",
        }
    }
}

/// What quotes are held to.
#[derive(Clone, Copy)]
pub(super) struct QuoteChecker<'c, 'b> {
    pub(super) bound: &'c BoundVerify<'b>,
    pub(super) outcomes: &'c Outcomes,
    pub(super) shown: &'c ShownText,
}

/// What becomes of everything that a `verify` object says is said. `question` is what carries it, unless a lab does.
pub(super) fn check(
    court: QuoteChecker<'_, '_>,
    verify: &Verify,
    question: Option<&Question>,
    findings: &mut Vec<Finding>,
) -> Vec<Quote> {
    let mut all = Vec::new();
    for said in &verify.says {
        all.extend(line(court, said, question, findings));
    }
    for claim in &verify.table {
        all.extend(column::check(court, claim, findings));
    }
    all
}

/// One line: a number, or several, and what its words say.
fn line(
    court: QuoteChecker<'_, '_>,
    said: &Said,
    question: Option<&Question>,
    findings: &mut Vec<Finding>,
) -> Vec<Quote> {
    let at = quote::places(&said.quote, question, court.shown);
    let mut given = Vec::new();
    for expr in &said.exprs {
        match Given::of(court, expr, findings) {
            Ok(found) => given.push((expr, found)),
            Err(reason) => return vec![Quote::unclear(&said.quote, &reason)],
        }
    }
    let numbers = given.iter().filter(|(_, given)| !given.is_condition()).count();
    // Of one expression the number is the one that the quote states; words beside numbers leave none of these unchecked.
    let parts = match said.exprs.as_slice() {
        [_] if numbers == 1 => vec![quote::whole(said.quote.as_str())],
        _ => quote::parts(said.quote.as_str(), numbers),
    };
    if parts.len() != numbers {
        let message = format!("the quote has {} numbers, but {numbers} expressions give one", parts.len());
        findings.push(
            Finding::error(rules::QUOTE_UNCLEAR, said.quote.span(), message.clone())
                .why("nothing was compared, because it is unclear which expression belongs to which number")
                .help(
                    "give one expression for each number, in order; conditions for words can be between them",
                ),
        );
        return vec![Quote::unclear(&said.quote, &message)];
    }
    let mut parts = parts.into_iter();
    let mut all = Vec::new();
    for (expr, given) in given {
        let claim = |part| quote::Claim { quote: &said.quote, part, expr };
        all.push(match given.is_condition() {
            true => {
                let at: Vec<Range<usize>> = at.iter().map(|place| place.at.clone()).collect();
                describe_quote(court, &claim(""), &given, &at, findings)
            }
            false => {
                let part = parts.next().unwrap_or_else(|| quote::whole(""));
                number(court, &claim(&part.text), &part, given, at.clone(), findings)
            }
        });
    }
    all
}

/// The value of an expression in the lesson's own runs, and in others.
pub(super) struct Given {
    found: MeasuredValue,
    timestep: Vec<Other>,
    start: Vec<Other>,
}

impl Given {
    pub(super) fn of(
        court: QuoteChecker<'_, '_>,
        expr: &Text,
        findings: &mut Vec<Finding>,
    ) -> Result<Given, String> {
        let QuoteChecker { bound, outcomes, .. } = court;
        let found = grounded(bound, &outcomes.nominal, expr, findings)?;
        let other = |n: usize, how| value_of(bound, outcomes.perturbed.get(n)?.as_ref()?, expr, how);
        let back = "with a start moved by -1e-14";
        let mut start: Vec<Other> = other(2, "with a start moved by 1e-14").into_iter().collect();
        start.extend(outcomes.nudged_back.as_ref().and_then(|o| value_of(bound, o, expr, back)));
        Ok(Given { found, timestep: other(0, "at half the timestep").into_iter().collect(), start })
    }

    fn is_condition(&self) -> bool {
        matches!(self.found.value, Value::Boolean(_))
    }

    /// Whether it can decide about words; a finding where not.
    pub(super) fn is_condition_of(
        &self,
        court: QuoteChecker<'_, '_>,
        expr: &Text,
        findings: &mut Vec<Finding>,
    ) -> bool {
        court.bound.is_condition(&self.found, expr, findings)
    }

    /// Whether what it says holds.
    pub(super) fn holds(&self) -> bool {
        self.found.value.truthy()
    }
}

fn value_of(bound: &BoundVerify<'_>, outcome: &Outcome, expr: &Text, how: &'static str) -> Option<Other> {
    let found = bound.find(outcome, expr, &mut Vec::new())?;
    Some(Other { how, value: found.value.to_number() })
}

/// What becomes of a number.
pub(super) fn number(
    court: QuoteChecker<'_, '_>,
    claim: &quote::Claim<'_>,
    part: &quote::QuotePart,
    given: Given,
    places: Vec<quote::QuotePlace>,
    findings: &mut Vec<Finding>,
) -> Quote {
    let unit = &|| units::of_claim(court.bound, &court.outcomes.nominal, claim.expr);
    let computed = given.found.value.to_number();
    let value = quote::Value { computed, timestep: &given.timestep, start: &given.start, unit };
    let o = quote::check(claim, &part.reading, places, &value, court.shown, findings);
    let text = claim.part.trim().to_string();
    let (state, evidence, reason) = (o.state, given.found.evidence, o.reason);
    Quote { text, span: claim.quote.span(), state, evidence, reason, computed }
}

/// What becomes of words that say that a condition holds.
pub(super) fn describe_quote(
    court: QuoteChecker<'_, '_>,
    claim: &quote::Claim<'_>,
    given: &Given,
    at: &[Range<usize>],
    findings: &mut Vec<Finding>,
) -> Quote {
    let moved = |others: &[Other]| -> Vec<&'static str> {
        others.iter().filter(|o| (o.value != 0.0) != given.holds()).map(|o| o.how).collect()
    };
    let condition = quote::Condition {
        holds: given.holds(),
        timestep: moved(&given.timestep),
        start: moved(&given.start),
    };
    let (state, reason) = quote::check_words(claim, at, &condition, court.shown, findings);
    let computed = f64::from(u8::from(given.holds()));
    let (text, evidence) = (claim.quote.value.clone(), given.found.evidence);
    Quote { text, span: claim.quote.span(), state, evidence, reason, computed }
}
