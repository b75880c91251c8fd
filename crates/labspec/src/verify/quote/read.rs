//! Reads the number that a quote states. A form that is not understood is an error that names it; nothing is guessed.

use super::context::{BOUND, PLUS_MINUS};
use super::modifier::{is_approximate, modified};
use super::number::{NumberForm, Quoted, Style};
use super::numeral::Chars;
use super::quantity::{Quantity, as_share, quantities, range_of_change, singles};
use super::unit_text::{Link, Unit};
use super::{fold, html};
use crate::language::Languages;

/// The reading of a quote.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::verify) struct QuoteReading {
    /// The number.
    pub(super) read: Quoted,
    /// The number as a fraction of one, for `50 %`.
    pub(super) share: Option<Quoted>,
    /// Other numbers that it may state, each with a reason.
    pub(super) ambiguities: Vec<(Quoted, &'static str)>,
    /// Whether the words before it state that it is approximate.
    pub(super) is_approximate: bool,
    /// Why it must not be reported as wrong when it differs.
    pub(super) is_ambiguous: Option<&'static str>,
    /// Its unit, if it has one.
    pub(super) unit: Option<Unit>,
    /// Whether no number follows it in the quote. If so, and the quote has no unit, the unit after the quote in the text
    /// belongs to it.
    pub(super) last: bool,
}

impl QuoteReading {
    /// The number.
    pub(in crate::verify) fn number(&self) -> &Quoted {
        &self.read
    }

    /// Its unit, if it has one.
    pub(in crate::verify) fn unit(&self) -> Option<&Unit> {
        self.unit.as_ref()
    }
}

/// Why no number was read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Unread {
    /// The text contains no number.
    NoNumber,
    /// Its form cannot be read. The text names the form: "a ratio".
    Form(&'static str),
}

/// Maximum length of a quote, in characters.
const MAX_QUOTE: usize = 120;

/// The number that a quote states: the first one after the last `=`, else the first one.
///
/// # Errors
/// It contains no number, or one in a form that cannot be read.
pub fn quoted(text: &str) -> Result<Quoted, Unread> {
    read_quote(text).map(|r| r.read)
}

/// The visible characters of a quote.
fn characters(text: &str) -> Vec<char> {
    let (rendered, _) = html::strip(text);
    let (folded, _) = fold::fold(&rendered, false);
    folded.chars().take(MAX_QUOTE + 1).collect()
}

/// The number that a quote states, with its other possible readings.
pub(in crate::verify) fn read_quote(text: &str) -> Result<QuoteReading, Unread> {
    read_quote_in(text, Languages::ALL)
}

/// The number that a quote in some languages states.
pub(in crate::verify) fn read_quote_in(text: &str, languages: Languages) -> Result<QuoteReading, Unread> {
    let chars = characters(text);
    if chars.len() > MAX_QUOTE {
        return Err(Unread::Form("a text as long as a paragraph"));
    }
    let chars = Chars(&chars);
    let all = quantities(chars);
    let equals = last_equals(chars, &all);
    let Some(index) = all.iter().position(|q| equals.is_none_or(|i| q.whole.start > i)) else {
        let folded = chars.text(0, MAX_QUOTE);
        let is_formula = ["frac", "sqrt", "√"].into_iter().any(|word| folded.contains(word));
        return Err(if is_formula { Unread::Form("a formula") } else { Unread::NoNumber });
    };
    let Some(first) = all.get(index) else { return Err(Unread::NoNumber) };
    let range =
        all.get(index + 1).filter(|_| first.change).and_then(|second| range_of_change(chars, first, second));
    if first.change && range.is_none() {
        return Err(Unread::Form("a change from one number to another, or a range"));
    }
    let mut reading = of_quantity(chars, range.as_ref().unwrap_or(first), languages)?;
    let several = "it contains more than one number";
    let others = all.get(index + 1 + usize::from(range.is_some())..).unwrap_or_default();
    reading.last = others.is_empty();
    if !matches!(reading.read.form, NumberForm::PlusMinus(..) | NumberForm::Range(..)) {
        reading.ambiguities.extend(others.iter().map(|q| (q.quoted, several)));
        if !others.is_empty() {
            reading.is_ambiguous = reading.is_ambiguous.or(Some(several));
        }
    }
    Ok(reading)
}

/// The reading of one quantity.
fn of_quantity(chars: Chars<'_>, q: &Quantity, languages: Languages) -> Result<QuoteReading, Unread> {
    let q = &q.clone().with_comma(languages);
    let interval = match q.refused {
        None | Some(BOUND | PLUS_MINUS) => modified(&q.quoted, &chars.text(0, q.whole.start), languages),
        Some(_) => None,
    };
    if let (Some(form), None) = (q.refused, interval) {
        return Err(Unread::Form(form));
    }
    let quoted = interval.unwrap_or(q.quoted);
    if !q.quoted.value.is_finite() {
        return Err(Unread::Form("a number too large to compute with"));
    }
    let why = match q.quoted.form {
        NumberForm::Plain(Style { group: Some(','), .. }) => "its comma may separate thousands or decimals",
        _ => "its space may separate thousands or two numbers",
    };
    Ok(QuoteReading {
        read: quoted,
        share: q.unit.as_ref().and_then(|unit| as_share(&quoted, unit)),
        ambiguities: q.ambiguities.iter().map(|&value| (Quoted { value, ..q.quoted }, why)).collect(),
        is_approximate: is_approximate(&chars.text(0, q.whole.start), languages),
        is_ambiguous: q.is_ambiguous,
        unit: q.unit.clone(),
        last: false,
    })
}

/// The index of the last equality sign before a number.
fn last_equals(chars: Chars<'_>, all: &[Quantity]) -> Option<usize> {
    let equals = |&i: &usize| matches!(chars.at(i), Some('=' | '≈')) && all.iter().any(|q| q.whole.start > i);
    (0..chars.0.len()).rev().find(equals)
}

/// A part of a quote that states one number.
#[derive(Clone, Debug)]
pub(in crate::verify) struct QuotePart {
    /// Its text, for messages.
    pub(in crate::verify) text: String,
    pub(in crate::verify) reading: Result<QuoteReading, Unread>,
}

/// A quote as one part.
pub(in crate::verify) fn whole(text: &str, languages: Languages) -> QuotePart {
    QuotePart { text: text.to_string(), reading: read_quote_in(text, languages) }
}

/// The number of numbers that a quote states besides the one that is read. The numbers before an equality sign compute it, and
/// one after another equality sign is the same number in another form.
pub(in crate::verify) fn other_numbers(text: &str, languages: Languages) -> usize {
    let chars = characters(text);
    let chars = Chars(&chars);
    let all = quantities(chars);
    let Ok(reading) = read_quote_in(text, languages) else { return 0 };
    let is_range = matches!(reading.read.form, NumberForm::Range(..));
    if is_range || last_equals(chars, &all).is_some() || (0..chars.0.len()).any(|i| chars.at(i) == Some('='))
    {
        return 0;
    }
    // Example: `0.526 mrad at 0.8 kg`: a number of another dimension is a setting.
    let dimension = |unit: &Option<Unit>| unit.as_ref().and_then(|unit| unit.dimension);
    let is_setting = |q: &&Quantity| match (dimension(&q.unit), dimension(&reading.unit)) {
        (Some(other), Some(read)) => !other.agrees(&read),
        _ => false,
    };
    let is_shared = |q: &&Quantity| q.unit.as_ref().is_some_and(|unit| unit.link == Link::Clause);
    all.iter().filter(|q| !is_shared(q) && !is_setting(q)).count().saturating_sub(1)
}

/// The parts of a text that state one number each, in order. A range is one part, unless its two ends give the `expected`
/// number of parts.
pub(in crate::verify) fn parts(text: &str, expected: usize, languages: Languages) -> Vec<QuotePart> {
    let chars = characters(text);
    let chars = Chars(&chars);
    let mut all = quantities(chars);
    let single = singles(chars);
    if all.len() != expected && single.len() == expected {
        all = single;
    }
    let last = all.len().saturating_sub(1);
    let part = |(i, q): (usize, &Quantity)| QuotePart {
        text: chars.text(q.whole.start, q.whole.end),
        reading: of_quantity(chars, q, languages).map(|reading| QuoteReading { last: i == last, ..reading }),
    };
    all.iter().enumerate().map(part).collect()
}

#[cfg(test)]
#[path = "read_tests.rs"]
mod tests;
