//! Numbers quoted in the text: found where a reader sees them, read, and compared with what the simulation gives at
//! the precision that they are printed with.

mod answer_unit;
mod clause_unit;
mod context;
mod denial;
mod fold;
mod hidden;
mod html;
mod messages;
mod number;
mod numeral;
mod option_text;
mod places;
mod prose;
mod quantity;
mod read;
mod rendered;
mod siunitx;
mod stated;
mod table;
mod unit;
mod unit_check;
mod unit_text;
mod words;

pub(super) use answer_unit::{AnswerUnit, answer_unit, is_unit};
pub use number::{Form, Quoted, Style};
pub(super) use option_text::{OptionNumber, option_ratio, option_text};
pub(super) use read::{QuotePart, parts, reading, whole};
pub use read::{Unread, quoted};
pub use rendered::ShownText;
pub use stated::{Counted, Stated, answered, claimed, counted, stated};
pub(super) use unit_check::{Held, conversion, hold};
use unit_text::Link;
pub(super) use unit_text::{Unit, unit_of_head};
pub(super) use words::{Condition, check_words};

use crate::finding::Finding;
use crate::json::nearest;
use crate::source::{SourceMap, Text};
use crate::spec::{Column, Question};
use labspec_bind::units::written;
use labspec_expr::dimension::Dimension;
use std::ops::Range;

/// What a reader sees of a piece of HTML.
pub fn plain(html: &str) -> String {
    html::strip(html).0
}

/// A formula as a reader sees it. What has no plain letters stays as it is written, with its backslash.
pub fn folded(tex: &str) -> String {
    fold::fold(tex, false).0
}

/// The value of the same expression in another run: with half the timestep, or from a start that is a hair away.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Other {
    /// What was changed: "at half the timestep", "with the solver run to convergence", "with a start moved by 1e-14".
    pub how: &'static str,
    /// What the expression then gives.
    pub value: f64,
}

/// What became of a quote.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum QuoteState {
    /// The text stands in the lesson, and its number is what the expression gives.
    Right,
    /// The text stands in the lesson, and its number is another one.
    Wrong,
    /// It could not be checked; a finding says why.
    Unclear,
}

/// A quote that was checked.
#[derive(Clone, Debug, PartialEq)]
pub struct QuoteOutcome {
    /// What became of it.
    pub state: QuoteState,
    /// A short sentence when it is not right.
    pub reason: String,
    /// The number that was read. Of `50 %` that is 50 or 0.5, whichever the expression gives.
    pub read: Option<Quoted>,
    /// What the expression gives in the lesson's own runs.
    pub computed: f64,
    /// Where the text stands, in bytes of the file.
    pub places: Vec<Range<usize>>,
    /// Other runs in which the printed digits change, and what they print.
    pub moved: Vec<(&'static str, String)>,
}

/// What the expression of a quote gives.
#[derive(Clone, Copy)]
pub(super) struct Value<'v> {
    /// In the lesson's own runs.
    pub(super) computed: f64,
    /// With finer numerics.
    pub(super) timestep: &'v [Other],
    /// From starts that no reader could tell from the lesson's own.
    pub(super) start: &'v [Other],
    /// What it measures, where that is certain.
    pub(super) unit: &'v dyn Fn() -> Option<Dimension>,
}

/// A quoted text, the part of it that states a number, and the expression that gives it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Claim<'c> {
    pub(super) quote: &'c Text,
    pub(super) part: &'c str,
    pub(super) expr: &'c Text,
}

/// A place where a quote stands.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct QuotePlace {
    /// Bytes of the file.
    pub(super) at: Range<usize>,
    /// The unit that the text has behind the last number of the quote, or over its column, where the quote has none.
    pub(super) unit: Option<Unit>,
}

/// Where a quote stands: in the question that claims it first.
pub(super) fn places(quote: &Text, question: Option<&Question>, shown: &ShownText) -> Vec<QuotePlace> {
    let own =
        |p: &&QuotePlace| question.is_some_and(|q| q.span.start <= p.at.start && p.at.end <= q.span.end);
    let (own, others): (Vec<_>, Vec<_>) = shown.found(quote.as_str()).iter().partition(own);
    own.into_iter().chain(others).cloned().collect()
}

/// The unit of a number at the places where it stands, with what the expression measures. Places where the unit is another one for
/// sure are no places, unless there are no others.
fn unit_at(
    reading: &read::Reading,
    places: &mut Vec<QuotePlace>,
    found: Option<&Dimension>,
) -> Option<(Unit, Held)> {
    let unit =
        |place: &QuotePlace| reading.unit.clone().or_else(|| place.unit.clone().filter(|_| reading.last));
    let held = |place: &QuotePlace| unit(place).map(|unit| (hold(&unit, found), unit));
    let best = places.iter().map(|p| (held(p).map_or(Held::Fits, |(held, _)| held), p));
    let rank = |held: Held| match held {
        Held::Fits => 0,
        Held::Unknown => 1,
        Held::Unsure => 2,
        Held::Wrong => 3,
    };
    let chosen = best.min_by_key(|(held, _)| rank(*held)).map(|(_, p)| unit(p));
    match chosen {
        None => reading.unit.clone().map(|unit| (hold(&unit, found), unit)).map(|(held, unit)| (unit, held)),
        Some(chosen) => {
            places.retain(|p| unit(p).map(|u| u.text) == chosen.as_ref().map(|u| u.text.clone()));
            chosen.map(|unit| (hold(&unit, found), unit)).map(|(held, unit)| (unit, held))
        }
    }
}

/// Compares a quoted number with what its expression gives, at every place where it stands; with its unit, where it has one.
pub(super) fn check(
    said: &Claim<'_>,
    reading: &Result<read::Reading, Unread>,
    mut places: Vec<QuotePlace>,
    value: &Value<'_>,
    shown: &ShownText,
    findings: &mut Vec<Finding>,
) -> QuoteOutcome {
    let mut outcome = QuoteOutcome {
        state: QuoteState::Unclear,
        reason: String::new(),
        read: None,
        computed: value.computed,
        places: places.iter().map(|p| p.at.clone()).collect(),
        moved: Vec::new(),
    };
    let unclear = |mut outcome: QuoteOutcome, reason: &str, finding: Finding, findings: &mut Vec<Finding>| {
        outcome.reason = reason.to_string();
        findings.push(finding);
        outcome
    };
    let reading = match reading {
        Ok(reading) => reading,
        Err(Unread::NoNumber) => {
            return unclear(outcome, "the quote contains no number", messages::no_number(said), findings);
        }
        Err(Unread::Form(form)) => {
            let reason = format!("the quote is {form}, which the checker cannot read");
            return unclear(outcome, &reason, messages::unread(said, form), findings);
        }
    };
    let measured = match reading.unit.is_some() || places.iter().any(|p| p.unit.is_some()) {
        true => (value.unit)(),
        false => None,
    };
    let unit = unit_at(reading, &mut places, measured.as_ref());
    outcome.places = places.into_iter().map(|p| p.at).collect();
    // Minutes and degrees are converted; a power of ten too many is told.
    let wanted = unit.as_ref().and_then(|(unit, _)| unit.dimension);
    let factor = wanted.zip(measured).and_then(|(wanted, found)| conversion(&wanted, &found));
    let factor = factor.filter(|f| !unit_check::is_power_of_ten(*f)).filter(|_| reading.share.is_none());
    // A unit that the clause names may be that of something else: it is the number's own where the number is right in it.
    let apart = unit.as_ref().is_some_and(|(unit, _)| unit.link == Link::Clause);
    let factor = factor.filter(|f| !apart || reading.read.is(f * value.computed));
    let scale = |x: f64| factor.map_or(x, |f| x * f);
    let computed = scale(value.computed);
    let others = |list: &[Other]| -> Vec<Other> {
        list.iter().map(|o| Other { value: scale(o.value), ..*o }).collect()
    };
    let (timestep_others, start_others) = (others(value.timestep), others(value.start));
    outcome.computed = computed;
    let fits = [Some(reading.read), reading.share].into_iter().flatten().find(|q| q.is(computed));
    let read = fits.unwrap_or(reading.read);
    outcome.read = Some(read);
    if outcome.places.is_empty() {
        let hidden = shown.hidden(said.quote.as_str());
        return unclear(outcome, "no reader sees this text", messages::not_found(said, hidden), findings);
    }
    if !computed.is_finite() {
        return unclear(outcome, "the expression has no value", messages::no_value(said, computed), findings);
    }
    let moved = |others: &[Other]| -> Vec<(&'static str, String)> {
        let differs = others.iter().filter(|o| read.differ(computed, o.value));
        differs.map(|o| (o.how, messages::printed(&read, o.value))).collect()
    };
    let chaotic = moved(&start_others);
    let values: Vec<f64> = start_others.iter().map(|o| o.value).chain([computed]).collect();
    let readings =
        [Some(read), reading.share].into_iter().flatten().chain(reading.doubts.iter().map(|(q, _)| *q));
    let readings: Vec<Quoted> = readings.collect();
    if !chaotic.is_empty() && readings.into_iter().any(|q| may_come_out(&q, &values)) {
        outcome.moved = chaotic;
        let finding = messages::chaotic(said, &outcome, &read, &values);
        return unclear(outcome, "no reader can reproduce these digits", finding, findings);
    }
    if !chaotic.is_empty() {
        outcome.moved = chaotic;
        outcome.reason = format!("the text says {read}, but no run comes near");
        outcome.state = QuoteState::Wrong;
        findings.push(messages::far(said, &outcome, &read, &values));
        return outcome;
    }
    outcome.moved = moved(&timestep_others);
    if let Some(fits) = fits {
        // Of a fraction that is told in percent the number is right in any unit, and a converted one is in that unit.
        let kind = measured.filter(|m| m.is_exact() && !m.is_number());
        let unit = unit.filter(|_| (fits == reading.read || kind.is_some()) && factor.is_none());
        match (unit, measured) {
            (Some((unit, Held::Wrong)), Some(found)) => {
                let gives = written(&found);
                outcome.reason = format!("the text says {}, but the expression gives {gives}", unit.text);
                outcome.state = QuoteState::Wrong;
                findings.push(messages::wrong_unit(said, &outcome, &unit.text, &gives));
                return outcome;
            }
            (Some((unit, Held::Unsure)), Some(found)) => {
                let gives = written(&found);
                let reason = match unit.link {
                    Link::Clause => format!("the text names {} apart from the number", unit.text),
                    _ => format!("{} may be a unit or a symbol", unit.text),
                };
                let finding = messages::unsure_unit(said, &outcome, &unit, &gives);
                return unclear(outcome, &reason, finding, findings);
            }
            _ => {}
        }
        if !outcome.moved.is_empty() {
            findings.push(messages::of_timestep(said, &outcome, &read));
        }
        outcome.state = QuoteState::Right;
        return outcome;
    }
    if let Some((other, why)) = reading.doubts.iter().find(|(q, _)| q.is(computed)) {
        let finding = messages::doubtful(said, &outcome, &read, why, Some(other));
        return unclear(outcome, "the quote has two readings", finding, findings);
    }
    if let Some(why) = reading.unsure {
        let finding = messages::doubtful(said, &outcome, &read, why, None);
        return unclear(outcome, "the quote has two readings", finding, findings);
    }
    let text = reading.unit.as_ref().map_or("", |unit| unit.text.as_str());
    if let Some(shift) = unit::shift(&read, text, computed) {
        let finding = messages::other_unit(said, &outcome, &read, &shift);
        return unclear(outcome, "the text and the expression differ by a power of ten", finding, findings);
    }
    findings.push(messages::wrong(said, &outcome, &read));
    outcome.reason =
        format!("the text says {read}, but the simulation gives {}", messages::printed(&read, computed));
    outcome.state = QuoteState::Wrong;
    outcome
}

/// Whether a run from another start could give these digits: what the runs gave lies around them, or so near that as much again
/// reaches them.
fn may_come_out(read: &Quoted, values: &[f64]) -> bool {
    let low = values.iter().copied().fold(f64::INFINITY, f64::min);
    let high = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let spread = high - low;
    // Where one of them is no number, nobody knows.
    !values.iter().all(|x| x.is_finite())
        || read.value + read.half_unit >= low - spread && read.value - read.half_unit <= high + spread
}

/// The cells of a column, or the one cell that is meant: each with what stands in the cell that tells its row.
///
/// # Errors
/// Why there are none, and what to do.
pub(super) fn cells(claim: &Column, shown: &ShownText) -> Result<Vec<[Text; 2]>, [String; 2]> {
    let key = claim.by.as_ref().map(|(heading, _)| heading.as_str());
    let headings: Vec<&str> = [Some(claim.column.as_str()), key].into_iter().flatten().collect();
    let mut found = shown.tables(&headings);
    let (Some(table), None) = (found.next(), found.next()) else {
        let several = shown.tables(&headings).count() > 1;
        let mut known: Vec<&str> = shown.headings().take(24).collect();
        known.dedup();
        return Err(if several {
            [
                format!("several tables have the columns {}", headings.join(", ")),
                "give the tables different headings".into(),
            ]
        } else {
            let near =
                headings.iter().find(|h| !known.contains(h)).and_then(|h| nearest(h, known.iter().copied()));
            let help = near.map_or_else(
                || format!("use the columns of a table: {}", known.join(", ")),
                |right| format!("did you mean \"{right}\"?"),
            );
            [format!("no table has the columns {}", headings.join(", ")), help]
        });
    };
    let at = |heading: &str| table.column(heading).unwrap_or(0);
    let (column, by) = (at(claim.column.as_str()), key.map_or(0, at));
    let text = |cell: &table::Cell| Text {
        value: cell.text.clone(),
        map: SourceMap::whole(cell.text.len(), cell.span.clone()),
    };
    let wanted = claim.row.as_ref().map(|row| table::shown(row.as_str()));
    let rows = table.rows.iter().filter_map(|row| Some([text(row.get(by)?), text(row.get(column)?)]));
    let cells: Vec<[Text; 2]> =
        rows.filter(|[key, _]| wanted.as_ref().is_none_or(|w| *w == key.value)).collect();
    match (cells.is_empty(), &claim.row) {
        (false, _) => Ok(cells),
        (true, Some(row)) => Err([
            format!("no row of this table begins with \"{}\"", row.value),
            "write the text in the first cell of the row".into(),
        ]),
        (true, None) => Err(["this table has no rows".into(), "add rows to the table".into()]),
    }
}

/// Whether a reader sees the same in both.
pub(super) fn same(a: &str, b: &str) -> bool {
    table::shown(a) == table::shown(b)
}

#[cfg(test)]
#[path = "check_tests.rs"]
mod tests;

#[cfg(test)]
#[path = "whole_tests.rs"]
mod whole_tests;
