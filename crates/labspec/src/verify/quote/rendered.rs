//! The rendered text of a lesson: prose, headings, cells, captions, printed output, and the displayed texts of labs and
//! quizzes. Keys, code, listings, attributes and comments are not part of it.

use super::clause::{Clause, clause_of};
use super::constant::value_before;
use super::denial::is_denied;
use super::markdown_cell::{is_head_of_units, unit_of_cell, unit_of_column};
use super::pieces::rendered_pieces;
use super::places::{MAX_PLACES, Readable, Search};
use super::quote_claim::QuotePlace;
use super::table::RenderedTable;
use super::unit_text::Unit;
use super::{fold, html, prose};
use crate::run::Cell;
use crate::source::{SourceMap, Text};
use crate::spec::{ControlKind, Lesson, Verify};
use std::collections::BTreeMap;
use std::ops::Range;

/// The places of the quotes of a lesson in its rendered text. Computed once for a lesson.
#[derive(Debug, Default)]
pub struct RenderedText {
    places: BTreeMap<String, Vec<QuotePlace>>,
    /// The place of a quote that is not rendered: in code, a key, a listing.
    hidden: BTreeMap<String, Range<usize>>,
    /// The tables, if a claim refers to one.
    tables: Vec<RenderedTable>,
}

/// Maximum number of searched quotes without a number: each needs a pass through the text.
const MAX_WORDS: usize = 200;

/// Maximum number of quotes that are searched outside of the rendered text: each needs a pass through the file.
const MAX_HIDDEN: usize = 16;

impl RenderedText {
    /// Searches all quotes of a lesson.
    pub fn of_lesson(lesson: &Lesson) -> RenderedText {
        let file = lesson.file.text();
        let mut search = Search::new();
        let mut numbers: BTreeMap<&str, usize> = BTreeMap::new();
        for verify in lesson.verifies() {
            for quoted in &verify.says {
                let quote = quoted.quote.as_str();
                numbers.entry(quote).or_insert_with(|| search.add(quote));
            }
        }
        let tabled = lesson.verifies().any(|verify| !verify.table.is_empty());
        let tables = if tabled { prose::tables(lesson) } else { Vec::new() };
        let mut rendered = RenderedText { tables, ..RenderedText::default() };
        if numbers.is_empty() {
            return rendered;
        }
        let wordy: Vec<&str> = numbers.keys().copied().filter(|q| !has_number(q)).take(MAX_WORDS).collect();
        let (text, map) = join(rendered_pieces(lesson), !wordy.is_empty());
        search.walk(&text);
        let sliders = at_sliders(lesson, &numbers);
        for (&quote, &number) in &numbers {
            let words = if wordy.contains(&quote) { find_words(&text.flat, quote) } else { Vec::new() };
            let found = search.found(number).iter().map(|f| (f.bytes.clone(), f.unit.clone()));
            let place = |(bytes, unit)| {
                let span = lesson.file.snap(&map.span(bytes));
                // A number in a cell has the unit of its column.
                let of_column = || unit_of_column(file, span.start);
                let unit = if has_number(quote) { Option::or_else(unit, of_column) } else { None };
                QuotePlace {
                    arithmetic: value_before(file, span.start),
                    clause: clause_of(file, &span),
                    span,
                    unit,
                }
            };
            let mut places: Vec<_> =
                found.chain(words.into_iter().map(|span| (span, None))).map(place).collect();
            if places.is_empty() {
                places.extend(sliders.get(quote).map(|span| QuotePlace {
                    span: span.clone(),
                    unit: None,
                    arithmetic: None,
                    clause: Clause::default(),
                }));
            }
            places.sort_by_key(|p| (p.span.start, p.span.end));
            places.dedup();
            if places.is_empty() && rendered.hidden.len() < MAX_HIDDEN {
                let place = unseen(quote, file, lesson);
                rendered.hidden.extend(place.map(|place| (quote.to_string(), place)));
            }
            rendered.places.insert(quote.to_string(), places);
        }
        rendered
    }

    /// The places where a quote appears as a separate number, in bytes of the file.
    pub fn places(&self, quote: &str) -> Vec<Range<usize>> {
        self.found(quote).iter().map(|p| p.span.clone()).collect()
    }

    /// The places where a quote appears as a separate number, with the units in the text.
    pub(in crate::verify) fn found(&self, quote: &str) -> &[QuotePlace] {
        self.places.get(quote).map_or(&[], Vec::as_slice)
    }

    /// The places of quotes and tables of one object within a range of the file.
    pub fn within(&self, block: &Range<usize>, verify: &Verify) -> RenderedText {
        let inside = |r: &&Range<usize>| block.start <= r.start && r.end <= block.end;
        let places = verify.says.iter().map(|quoted| {
            let quote = quoted.quote.as_str();
            (quote.to_string(), self.found(quote).iter().filter(|p| inside(&&p.span)).cloned().collect())
        });
        let begins = |t: &&RenderedTable| t.head.first().is_some_and(|cell| inside(&&cell.span));
        let tables = self.tables.iter().filter(|_| !verify.table.is_empty()).filter(begins);
        RenderedText { places: places.collect(), hidden: BTreeMap::new(), tables: tables.cloned().collect() }
    }

    /// The tables with these columns.
    pub(super) fn tables<'t>(&'t self, headings: &'t [&str]) -> impl Iterator<Item = &'t RenderedTable> {
        self.tables.iter().filter(move |table| headings.iter().all(|h| table.column(h).is_some()))
    }

    /// The unit that the row of a cell of a table states in a column of units.
    pub(in crate::verify) fn unit_in_row(&self, cell: &Range<usize>) -> Option<Unit> {
        self.tables.iter().find_map(|table| {
            let column = table.head.iter().position(|head| is_head_of_units(&head.text))?;
            let row = table.rows.iter().find(|row| row.iter().any(|other| other.span == *cell))?;
            unit_of_cell(&row.get(column)?.text)
        })
    }

    /// The number of cells of all tables.
    pub(in crate::verify) fn cells(&self) -> usize {
        self.tables.iter().map(|table| table.head.len() * (1 + table.rows.len())).sum()
    }

    /// The headings of all tables.
    pub(super) fn headings(&self) -> impl Iterator<Item = &str> {
        self.tables.iter().flat_map(|table| &table.head).map(|cell| cell.text.as_str())
    }

    /// The place of a quote that appears only in text that is not rendered.
    pub(super) fn hidden(&self, quote: &str) -> Option<Range<usize>> {
        self.hidden.get(quote).cloned()
    }
}

/// Quotes that equal the initial value of a slider with its unit: `0.010 s`. Used only for quotes without another place.
fn at_sliders<'q>(lesson: &Lesson, quotes: &BTreeMap<&'q str, usize>) -> BTreeMap<&'q str, Range<usize>> {
    let folded = |text: &str| fold::fold(&html::strip(text).0, true).0;
    let searched: BTreeMap<String, &'q str> = quotes.keys().map(|quote| (folded(quote), *quote)).collect();
    let labs = lesson.addressed().into_iter();
    let displayed = labs.flat_map(|(_, lab)| &lab.controls).filter_map(|control| {
        let ControlKind::Slider { unit, value, .. } = &control.kind else { return None };
        let number = Cell::Number(value.value).rounded(control.digits()?);
        let text = unit.as_ref().map_or(number.clone(), |unit| format!("{number} {}", unit.as_str()));
        Some((*searched.get(&folded(&text))?, value.span.clone()))
    });
    displayed.collect()
}

/// A place of a quote outside of `verify` objects. Used only for quotes that are not rendered.
fn unseen(quote: &str, file: &str, lesson: &Lesson) -> Option<Range<usize>> {
    if quote.is_empty() {
        return None;
    }
    let claims: Vec<Range<usize>> = lesson.verifies().map(|v| v.span.clone()).collect();
    let digit = |c: Option<char>| c.is_some_and(|c| c.is_ascii_digit() || c == '.');
    let mut found = file.match_indices(quote).take(1000).map(|(i, _)| i..i + quote.len());
    found.find(|r| {
        let before = file.get(..r.start).and_then(|t| t.chars().next_back());
        let after = file.get(r.end..).and_then(|t| t.chars().next());
        let claimed = claims.iter().any(|o| o.start <= r.start && r.end <= o.end);
        let goes_on = digit(before) && digit(quote.chars().next());
        !(claimed || goes_on || digit(after) && digit(quote.chars().next_back()))
    })
}

/// Whether a text contains a number. `&frac12;` and `&#49;` are numbers too.
fn has_number(text: &str) -> bool {
    text.contains(|c: char| c.is_numeric()) || text.contains("&frac")
}

/// The places of words without a number, at word boundaries.
fn find_words(text: &str, quote: &str) -> Vec<Range<usize>> {
    let (plain, _) = html::strip(quote);
    let searched = fold::fold(&plain, true).0.trim_matches('\n').to_string();
    if searched.trim().is_empty() {
        return Vec::new();
    }
    let goes_on =
        |a: Option<char>, b: Option<char>| [a, b].iter().all(|c| c.is_some_and(char::is_alphanumeric));
    let found = text.match_indices(&searched).map(|(start, found)| start..start + found.len());
    let stands_alone = |r: &Range<usize>| {
        let [before, after] = [text.get(..r.start).unwrap_or(""), text.get(r.end..).unwrap_or("")];
        !goes_on(before.chars().next_back(), searched.chars().next())
            && !goes_on(searched.chars().next_back(), after.chars().next())
            && !is_denied(before)
    };
    found.filter(stands_alone).take(MAX_PLACES).collect()
}

/// Joins the rendered pieces into one text, a line for each piece, with a source map to the file. Pieces without a digit
/// are included only if `words` is true.
fn join(pieces: Vec<Text>, words: bool) -> (Readable, SourceMap) {
    let (mut all, mut chars, mut map) = (String::new(), Vec::new(), SourceMap::default());
    for Text { value: text, map: back } in pieces {
        if !words && !has_number(&text) {
            continue;
        }
        let (folded, inner) = fold::fold(&text, true);
        let start = back.span(0..0).start;
        all.push_str(&folded);
        chars.extend(fold::fold(&text, false).0.chars());
        chars.push('\n');
        for part in inner.then(&back).pieces() {
            if part.verbatim {
                map.push_verbatim(part.origin.clone());
            } else {
                map.push_whole(part.derived.len(), part.origin.clone());
            }
        }
        all.push('\n');
        map.push_whole(1, start..start);
    }
    (Readable::new(all, &chars), map)
}

#[cfg(test)]
#[path = "rendered_tests.rs"]
mod tests;
