//! Quoted numbers: they are found in the rendered text, read, and compared with the simulation at the printed precision.

mod arithmetic;
mod asked_unit;
mod check_quote;
mod clause;
mod clause_unit;
mod constant;
mod context;
mod context_after;
mod denial;
mod equations;
mod fold;
mod heading;
mod hidden;
mod html;
mod markdown_cell;
mod messages;
mod modifier;
mod number;
mod numeral;
mod option_ratio;
mod option_text;
mod pieces;
mod places;
mod printed;
mod prose;
mod quantity;
mod quote_claim;
mod read;
mod rendered;
mod row_value;
mod siunitx;
mod stated;
mod table;
mod table_cells;
mod unit;
mod unit_check;
mod unit_text;
mod words;

pub(crate) use asked_unit::{asked_unit, differ_in_scale};
pub(super) use check_quote::{check_quote, places_of_quote};
pub(super) use clause::Clause;
pub(super) use heading::operation_in_heading;
pub(super) use markdown_cell::unit_of_head;
pub use number::{NumberForm, Quoted, Style};
pub(super) use option_ratio::{named_quantities, option_ratio};
pub(super) use option_text::{BoundSide, OptionNumber, option_text, quantities_in};
pub use printed::{OutputBlock, OutputMatch, numbers_in_outputs};
pub use quote_claim::{OtherValue, QuoteOutcome, QuoteState};
pub(super) use quote_claim::{QuoteClaim, QuotePlace, QuoteValue};
pub(super) use read::{QuotePart, other_numbers, parts, read_quote_in, whole};
pub use read::{Unread, quoted};
pub use rendered::RenderedText;
pub(super) use row_value::stated_values;
pub use stated::{Counted, Stated, answered, claimed, counted, stated};
pub(super) use table_cells::{cells_of_column, is_rendered_equally};
pub(super) use unit_check::{
    AnswerUnit, UnitMatch, answer_unit, conversion, hold, is_unit, percentage, without_pure_factor,
};
pub(super) use unit_text::Unit;
pub(super) use words::{QuotedCondition, check_words};

/// The visible text of a piece of HTML.
pub fn plain(html: &str) -> String {
    html::strip(html).0
}

/// The visible text of a formula. A command without a plain equivalent is kept, with its backslash.
pub fn folded(tex: &str) -> String {
    fold::fold(tex, false).0
}

#[cfg(test)]
#[path = "check_tests.rs"]
mod tests;

#[cfg(test)]
#[path = "whole_tests.rs"]
mod whole_tests;
