//! Compares a quoted number with the value of its expression, with its unit if it has one, at every place where the quote
//! appears.

use super::messages;
use super::number::{NumberForm, Quoted};
use super::quote_claim::{OtherValue, QuoteClaim, QuoteOutcome, QuotePlace, QuoteState, QuoteValue};
use super::read::{QuoteReading, Unread};
use super::rendered::RenderedText;
use super::unit;
use super::unit_check::{UnitMatch, conversion, hold, is_angular_rate, is_power_of_ten, without_pure_factor};
use super::unit_text::{Link, Unit};
use crate::finding::Finding;
use crate::source::Text;
use crate::spec::Question;
use labspec_bind::units::written;
use labspec_expr::dimension::Dimension;

/// Compares a quoted number with the value of its expression, at the printed precision.
pub(in crate::verify) fn check_quote(
    claim: &QuoteClaim<'_>,
    reading: &Result<QuoteReading, Unread>,
    mut places: Vec<QuotePlace>,
    value: &QuoteValue<'_>,
    rendered: &RenderedText,
    findings: &mut Vec<Finding>,
) -> QuoteOutcome {
    let mut outcome = QuoteOutcome {
        state: QuoteState::Unclear,
        reason: String::new(),
        read: None,
        computed: value.computed,
        places: places.iter().map(|p| p.span.clone()).collect(),
        moved: Vec::new(),
    };
    let reading = match reading {
        Ok(reading) => reading,
        Err(unread) => return report_unread(claim, unread, outcome, findings),
    };
    let arithmetic: Vec<f64> = places.iter().filter_map(|place| place.arithmetic).collect();
    let compared = QuoteComparison::new(claim, reading, &mut places, value);
    outcome.places = places.into_iter().map(|p| p.span).collect();
    outcome.computed = compared.computed;
    outcome.read = Some(compared.read);
    if outcome.places.is_empty() {
        let hidden = rendered.hidden(claim.quote.as_str());
        return unclear(outcome, "no reader sees this text", messages::not_found(claim, hidden), findings);
    }
    if !compared.computed.is_finite() {
        let finding = messages::no_value(claim, compared.computed);
        return unclear(outcome, "the expression has no value", finding, findings);
    }
    let chaotic = compared.moved(&compared.start);
    if !chaotic.is_empty() {
        outcome.moved = chaotic;
        return compared.judge_chaotic(outcome, findings);
    }
    outcome.moved = compared.moved(&compared.timestep);
    if let Some(x) = arithmetic.into_iter().find(|x| compared.fits.is_some() && compared.differs_from(*x)) {
        outcome.reason = format!("the arithmetic before it gives {}", messages::printed(&compared.read, x));
        outcome.state = QuoteState::Wrong;
        findings.push(messages::wrong_arithmetic(claim, &outcome));
        return outcome;
    }
    match compared.fits {
        Some(fits) => compared.judge_unit(fits, outcome, findings),
        None => compared.explain_difference(outcome, findings),
    }
}

/// An undecided outcome.
fn unclear(
    mut outcome: QuoteOutcome,
    reason: &str,
    finding: Finding,
    findings: &mut Vec<Finding>,
) -> QuoteOutcome {
    outcome.reason = reason.to_string();
    findings.push(finding);
    outcome
}

/// The outcome of a quote that contains no number, or one that cannot be read.
fn report_unread(
    claim: &QuoteClaim<'_>,
    unread: &Unread,
    outcome: QuoteOutcome,
    findings: &mut Vec<Finding>,
) -> QuoteOutcome {
    match unread {
        Unread::NoNumber => {
            unclear(outcome, "the quote contains no number", messages::no_number(claim), findings)
        }
        Unread::Form(form) => {
            let reason = format!("the quote is {form}, which the checker cannot read");
            unclear(outcome, &reason, messages::unread(claim, form), findings)
        }
    }
}

/// The largest relative difference that rounded numbers in arithmetic explain.
const ROUNDED: f64 = 0.05;

/// A quoted number, and the value of its expression in the unit of the quote.
struct QuoteComparison<'q> {
    claim: &'q QuoteClaim<'q>,
    reading: &'q QuoteReading,
    /// The unit of the quote, and whether it agrees with the dimension of the expression.
    unit: Option<(Unit, UnitMatch)>,
    measured: Option<Dimension>,
    /// Factor that converts the value of the expression to the unit of the quote.
    factor: Option<f64>,
    computed: f64,
    timestep: Vec<OtherValue>,
    start: Vec<OtherValue>,
    /// The reading of the quote that equals the value.
    fits: Option<Quoted>,
    /// That reading, or else the first one.
    read: Quoted,
}

impl<'q> QuoteComparison<'q> {
    /// Converts the value of the expression. Only the places with the unit of the quote are kept.
    fn new(
        claim: &'q QuoteClaim<'q>,
        reading: &'q QuoteReading,
        places: &mut Vec<QuotePlace>,
        value: &QuoteValue<'_>,
    ) -> QuoteComparison<'q> {
        let measured = match reading.unit.is_some() || places.iter().any(|p| p.unit.is_some()) {
            true => (value.unit)().map(without_pure_factor),
            false => None,
        };
        let unit = unit_at(reading, places, measured.as_ref());
        // The reciprocal of a period counts turns, which are not radians.
        let in_radians = |unit: &Unit| unit.dimension.is_some_and(|d| is_angular_rate(&d) && d.is_exact());
        let is_turns = value.counts_turns && measured.is_some_and(|found| !found.has_angle());
        let unit = unit.map(|(unit, unit_match)| match is_turns && in_radians(&unit) {
            true => (unit, UnitMatch::Wrong),
            false => (unit, unit_match),
        });
        // Minutes and degrees are converted. A factor that is a power of ten is reported instead.
        let expected = unit.as_ref().and_then(|(unit, _)| unit.dimension);
        let factor = expected.zip(measured).and_then(|(expected, found)| conversion(&expected, &found));
        let factor = factor.filter(|f| !is_power_of_ten(*f)).filter(|_| reading.share.is_none());
        // A unit elsewhere in the clause may belong to another quantity. It counts as the unit of the number only if the
        // number is right in it.
        let in_clause = unit.as_ref().is_some_and(|(unit, _)| unit.link == Link::Clause);
        let factor = factor.filter(|f| !in_clause || reading.read.is(f * value.computed));
        let scale = |x: f64| factor.map_or(x, |f| x * f);
        let scaled =
            |list: &[OtherValue]| list.iter().map(|o| OtherValue { value: scale(o.value), ..*o }).collect();
        let computed = scale(value.computed);
        let fits = [Some(reading.read), reading.share].into_iter().flatten().find(|q| q.is(computed));
        let (timestep, start) = (scaled(value.timestep), scaled(value.start));
        let read = fits.unwrap_or(reading.read);
        QuoteComparison { claim, reading, unit, measured, factor, computed, timestep, start, fits, read }
    }

    /// Whether the number certainly differs from arithmetic with rounded numbers, and is not the same in another unit.
    fn differs_from(&self, x: f64) -> bool {
        let ratio = x / self.read.value;
        let power = ratio.abs().log10();
        let shifted = power.round() != 0.0 && (power - power.round()).abs() < 0.02;
        let is_number = self.read.is(x) || self.reading.share.is_some_and(|share| share.is(x));
        !is_number && !shifted && (ratio - 1.0).abs() > ROUNDED
    }

    /// The runs under perturbed numerics in which the printed digits change, and what they print.
    fn moved(&self, others: &[OtherValue]) -> Vec<(&'static str, String)> {
        let differs = others.iter().filter(|o| self.read.differ(self.computed, o.value));
        differs.map(|o| (o.how, self.printed(o.value))).collect()
    }

    /// A value in the digits of the quote. A value halfway may be rounded either way, as the quote does.
    fn printed(&self, x: f64) -> String {
        match self.read.form {
            NumberForm::Plain(_) if self.read.is(x) => self.read.to_string(),
            _ => messages::printed(&self.read, x),
        }
    }

    /// The outcome where the digits depend on a perturbed start: they cannot be reproduced, or no run comes near them.
    fn judge_chaotic(&self, mut outcome: QuoteOutcome, findings: &mut Vec<Finding>) -> QuoteOutcome {
        let values: Vec<f64> = self.start.iter().map(|o| o.value).chain([self.computed]).collect();
        let ambiguities = self.reading.ambiguities.iter().map(|(q, _)| *q);
        let mut readings = [Some(self.read), self.reading.share].into_iter().flatten().chain(ambiguities);
        if readings.any(|q| is_within_runs(&q, &values)) {
            let finding = messages::chaotic(self.claim, &outcome, &self.read, &values);
            return unclear(outcome, "no reader can reproduce these digits", finding, findings);
        }
        outcome.reason = format!("the text says {}, but no run comes near", self.read);
        outcome.state = QuoteState::Wrong;
        findings.push(messages::far_from_all_runs(self.claim, &outcome, &self.read, &values));
        outcome
    }

    /// The outcome where the number is right: its unit must be right too.
    fn judge_unit(
        self,
        fits: Quoted,
        mut outcome: QuoteOutcome,
        findings: &mut Vec<Finding>,
    ) -> QuoteOutcome {
        let QuoteComparison { claim, reading, measured, read, .. } = self;
        // A fraction stated in percent is right in any unit. A converted number is already in the unit of the quote.
        let kind = measured.filter(|m| m.is_exact() && !m.is_number());
        let unit = self.unit.filter(|_| (fits == reading.read || kind.is_some()) && self.factor.is_none());
        match (unit, measured) {
            (Some((unit, UnitMatch::Wrong)), Some(found)) => {
                let gives = written(&found);
                outcome.reason = format!("the text says {}, but the expression gives {gives}", unit.text);
                outcome.state = QuoteState::Wrong;
                findings.push(messages::wrong_unit(claim, &outcome, &unit.text, &gives));
                return outcome;
            }
            (Some((unit, UnitMatch::Unsure)), Some(found)) => {
                let gives = written(&found);
                let reason = match unit.link {
                    Link::Clause => format!("the text names {} apart from the number", unit.text),
                    _ => format!("{} may be a unit or a symbol", unit.text),
                };
                let finding = messages::uncertain_unit(claim, &outcome, &unit, &gives);
                return unclear(outcome, &reason, finding, findings);
            }
            _ => {}
        }
        if !outcome.moved.is_empty() {
            findings.push(messages::of_timestep(claim, &outcome, &read));
        }
        outcome.state = QuoteState::Right;
        outcome
    }

    /// The outcome where the number differs: it has another reading, is in another unit, or is wrong.
    fn explain_difference(&self, mut outcome: QuoteOutcome, findings: &mut Vec<Finding>) -> QuoteOutcome {
        let QuoteComparison { claim, reading, read, computed, .. } = self;
        if let Some((other, why)) = reading.ambiguities.iter().find(|(q, _)| q.is(*computed)) {
            let finding = messages::ambiguous_unit(claim, &outcome, read, why, Some(other));
            return unclear(outcome, "the quote has two readings", finding, findings);
        }
        if let Some(why) = reading.is_ambiguous {
            let finding = messages::ambiguous_unit(claim, &outcome, read, why, None);
            return unclear(outcome, "the quote has two readings", finding, findings);
        }
        let text = reading.unit.as_ref().map_or("", |unit| unit.text.as_str());
        if let Some(shift) = unit::shift(read, text, *computed) {
            let finding = messages::other_unit(claim, &outcome, read, &shift);
            let reason = "the text and the expression differ by a power of ten";
            return unclear(outcome, reason, finding, findings);
        }
        findings.push(messages::wrong(claim, &outcome, read));
        let gives = messages::measured(read, *computed);
        outcome.reason = format!("the text says {read}, but the simulation gives {gives}");
        outcome.state = QuoteState::Wrong;
        outcome
    }
}

/// The places where a quote appears, those in the question that claims it first.
pub(in crate::verify) fn places_of_quote(
    quote: &Text,
    question: Option<&Question>,
    rendered: &RenderedText,
) -> Vec<QuotePlace> {
    let inside =
        |p: &&QuotePlace| question.is_some_and(|q| q.span.start <= p.span.start && p.span.end <= q.span.end);
    let (inside, others): (Vec<_>, Vec<_>) = rendered.found(quote.as_str()).iter().partition(inside);
    inside.into_iter().chain(others).cloned().collect()
}

/// The unit of a number at the places where it appears, compared with the dimension of the expression. Places with a unit
/// that certainly differs are removed, unless there are no others.
fn unit_at(
    reading: &QuoteReading,
    places: &mut Vec<QuotePlace>,
    found: Option<&Dimension>,
) -> Option<(Unit, UnitMatch)> {
    let unit =
        |place: &QuotePlace| reading.unit.clone().or_else(|| place.unit.clone().filter(|_| reading.last));
    let unit_match = |place: &QuotePlace| unit(place).map(|unit| (hold(&unit, found), unit));
    let best =
        places.iter().map(|p| (unit_match(p).map_or(UnitMatch::Fits, |(unit_match, _)| unit_match), p));
    let rank = |unit_match: UnitMatch| match unit_match {
        UnitMatch::Fits => 0,
        UnitMatch::Unknown => 1,
        UnitMatch::Unsure => 2,
        UnitMatch::Wrong => 3,
    };
    let chosen = best.min_by_key(|(unit_match, _)| rank(*unit_match)).map(|(_, p)| unit(p));
    match chosen {
        None => reading
            .unit
            .clone()
            .map(|unit| (hold(&unit, found), unit))
            .map(|(unit_match, unit)| (unit, unit_match)),
        Some(chosen) => {
            places.retain(|p| unit(p).map(|u| u.text) == chosen.as_ref().map(|u| u.text.clone()));
            chosen.map(|unit| (hold(&unit, found), unit)).map(|(unit_match, unit)| (unit, unit_match))
        }
    }
}

/// Whether a run from another start could give these digits: they are within the range of the values of the runs, extended
/// by its width on both sides.
fn is_within_runs(read: &Quoted, values: &[f64]) -> bool {
    let low = values.iter().copied().fold(f64::INFINITY, f64::min);
    let high = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let spread = high - low;
    // With a NaN among the values, this is unknown.
    !values.iter().all(|x| x.is_finite())
        || read.value + read.half_unit >= low - spread && read.value - read.half_unit <= high + spread
}
