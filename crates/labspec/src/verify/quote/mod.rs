//! Numbers quoted in the text: found where a reader sees them, read, and compared with what the simulation gives at
//! the precision that they are printed with.

mod fold;
mod html;
mod number;
mod numeral;
mod places;
mod prose;
mod read;
mod shown;
mod stated;
mod table;
mod told;
mod unit;
mod words;

pub use number::{Form, Quoted, Style};
pub(super) use read::parts;
pub use read::{Unread, quoted};
pub use shown::ShownText;
pub use stated::{Counted, Stated, answered, claimed, counted, stated};
pub(super) use stated::{unit_of_head, unit_of_quote};
pub(super) use words::{Condition, check_words};

use crate::bind::{contradicts, unit as is_unit};
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

/// Where a quote stands: in the question that claims it first.
pub(super) fn places(quote: &Text, question: Option<&Question>, shown: &ShownText) -> Vec<Range<usize>> {
    own_first(shown.places(quote.as_str()), question)
}

/// Compares a quoted number with what its expression gives, at every place where it stands; with its unit, where it has one.
pub(super) fn check(
    said: &Claim<'_>,
    places: Vec<Range<usize>>,
    unit: Option<(String, Dimension)>,
    value: &Value<'_>,
    shown: &ShownText,
    findings: &mut Vec<Finding>,
) -> QuoteOutcome {
    let Value { computed, timestep: timestep_others, start: start_others, .. } = *value;
    let mut outcome = QuoteOutcome {
        state: QuoteState::Unclear,
        reason: String::new(),
        read: None,
        computed,
        places,
        moved: Vec::new(),
    };
    let unclear = |mut outcome: QuoteOutcome, reason: &str, finding: Finding, findings: &mut Vec<Finding>| {
        outcome.reason = reason.to_string();
        findings.push(finding);
        outcome
    };
    let reading = match read::reading(said.part) {
        Ok(reading) => reading,
        Err(Unread::NoNumber) => {
            return unclear(outcome, "the quote holds no number", told::no_number(said), findings);
        }
        Err(Unread::Form(form)) => {
            let reason = format!("the quote is {form}, which is not read");
            return unclear(outcome, &reason, told::unread(said, form), findings);
        }
    };
    let fits = [Some(reading.read), reading.share].into_iter().flatten().find(|q| q.is(computed));
    let read = fits.unwrap_or(reading.read);
    outcome.read = Some(read);
    if outcome.places.is_empty() {
        let hidden = shown.hidden(said.quote.as_str());
        return unclear(outcome, "no reader sees this text", told::not_found(said, hidden), findings);
    }
    if !computed.is_finite() {
        return unclear(outcome, "the expression has no value", told::no_value(said, computed), findings);
    }
    let moved = |others: &[Other]| -> Vec<(&'static str, String)> {
        let differs = others.iter().filter(|o| read.differ(computed, o.value));
        differs.map(|o| (o.how, told::printed(&read, o.value))).collect()
    };
    let chaotic = moved(start_others);
    let values: Vec<f64> = start_others.iter().map(|o| o.value).chain([computed]).collect();
    let readings =
        [Some(read), reading.share].into_iter().flatten().chain(reading.doubts.iter().map(|(q, _)| *q));
    let readings: Vec<Quoted> = readings.collect();
    if !chaotic.is_empty() && readings.into_iter().any(|q| may_come_out(&q, &values)) {
        outcome.moved = chaotic;
        let finding = told::chaotic(said, &outcome, &read, &values);
        return unclear(outcome, "no reader can reproduce these digits", finding, findings);
    }
    if !chaotic.is_empty() {
        outcome.moved = chaotic;
        outcome.reason = format!("the text says {read}, and no run comes near");
        outcome.state = QuoteState::Wrong;
        findings.push(told::far(said, &outcome, &read, &values));
        return outcome;
    }
    outcome.moved = moved(timestep_others);
    if let Some(fits) = fits {
        // Of a fraction that is told in percent the number is right in any unit.
        let unit = unit.filter(|_| fits == reading.read);
        if let Some((text, wanted)) = unit
            && let Some(found) = (value.unit)().filter(|found| contradicts(found, &wanted))
            // A `g` may be more than grams; beside a mass it is not.
            && (is_unit(&text).is_some() || found.agrees(&wanted))
        {
            let gives = written(&found);
            outcome.reason = format!("the text says {text}, the expression gives {gives}");
            outcome.state = QuoteState::Wrong;
            findings.push(told::wrong_unit(said, &outcome, &text, &gives));
            return outcome;
        }
        if !outcome.moved.is_empty() {
            findings.push(told::of_timestep(said, &outcome, &read));
        }
        outcome.state = QuoteState::Right;
        return outcome;
    }
    if let Some((other, why)) = reading.doubts.iter().find(|(q, _)| q.is(computed)) {
        let finding = told::doubtful(said, &outcome, &read, why, Some(other));
        return unclear(outcome, "the quote can be read in two ways", finding, findings);
    }
    if let Some(why) = reading.unsure {
        let finding = told::doubtful(said, &outcome, &read, why, None);
        return unclear(outcome, "the quote can be read in two ways", finding, findings);
    }
    if let Some(shift) = unit::shift(&read, &reading.unit, computed) {
        let finding = told::other_unit(said, &outcome, &read, &shift);
        return unclear(outcome, "text and expression differ by a power of ten", finding, findings);
    }
    findings.push(told::wrong(said, &outcome, &read));
    outcome.reason = format!("the text says {read}, the simulation gives {}", told::printed(&read, computed));
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
                "give them headings of their own".into(),
            ]
        } else {
            let near =
                headings.iter().find(|h| !known.contains(h)).and_then(|h| nearest(h, known.iter().copied()));
            let help = near.map_or_else(
                || format!("the tables have the columns {}", known.join(", ")),
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
            "write what stands in the first cell of the row".into(),
        ]),
        (true, None) => Err(["this table has no rows".into(), "fill the table".into()]),
    }
}

/// Whether a reader sees the same in both.
pub(super) fn same(a: &str, b: &str) -> bool {
    table::shown(a) == table::shown(b)
}

/// The places of a question itself, then the others.
fn own_first(places: &[Range<usize>], question: Option<&Question>) -> Vec<Range<usize>> {
    let own = |p: &&Range<usize>| question.is_some_and(|q| q.span.start <= p.start && p.end <= q.span.end);
    let (own, others): (Vec<_>, Vec<_>) = places.iter().partition(own);
    own.into_iter().chain(others).cloned().collect()
}

#[cfg(test)]
#[path = "check_tests.rs"]
mod tests;
