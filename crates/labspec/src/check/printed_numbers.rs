//! Numbers of the text that the output of a listing has: they are claimed by it.

use super::{LabOutcome, claims};
use crate::ledger::State;
use crate::listings::{ListingResult, pair_listings};
use crate::rules::numbers_unclaimed::report_again;
use crate::spec::Lesson;
use crate::verify::{OutputBlock, OutputMatch, numbers_in_outputs};
use std::collections::HashSet;
use std::ops::Range;

/// A number of the text that an output has.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PrintedNumber {
    /// The listing: `listing #1`.
    pub listing: String,
    /// Number and unit: `0.442 s`.
    pub quote: String,
    /// Its bytes in the file.
    pub span: Range<usize>,
    /// Whether it is a part of the displayed output itself, which was compared.
    pub is_displayed: bool,
}

/// The numbers of the text that the outputs of listings have. Only outputs count that were printed as displayed in this check.
/// Findings about unclaimed numbers no longer name them.
pub fn claim_printed_numbers(
    lesson: &Lesson,
    results: &[ListingResult],
    outcome: &mut LabOutcome,
) -> Vec<PrintedNumber> {
    let listings = pair_listings(lesson);
    let is_printed = |name: &str| {
        results.iter().any(|result| result.name == name && matches!(result.state, State::True(_)))
    };
    let printed: Vec<_> = listings.iter().filter(|listing| is_printed(&listing.name())).collect();
    let outputs: Vec<OutputBlock<'_>> = printed
        .iter()
        .map(|listing| OutputBlock { span: listing.span(), text: listing.displayed_text() })
        .collect();
    let describe = |found: OutputMatch| {
        let OutputMatch { output, number, is_displayed } = found;
        let listing = printed.get(output)?.name();
        Some(PrintedNumber { listing, quote: number.quote, span: number.span, is_displayed })
    };
    let numbers: Vec<PrintedNumber> =
        numbers_in_outputs(lesson, &outputs).into_iter().filter_map(describe).collect();
    if !numbers.is_empty() {
        let spans = |is_displayed: bool| -> HashSet<Range<usize>> {
            let chosen = numbers.iter().filter(|number| number.is_displayed == is_displayed);
            chosen.map(|number| number.span.clone()).collect()
        };
        let verified = claims::verified_answers(&outcome.claims);
        report_again(lesson, &verified, [&spans(true), &spans(false)], &mut outcome.findings);
    }
    numbers
}
