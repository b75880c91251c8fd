//! Listings and their outputs: which output a lesson displays below a Python listing, and whether the listing prints it.
//!
//! Nothing is run here. The program runs the listings (`labspec check --listings`), and [`check_listing`] compares.

mod compare;
mod decimal;
mod outcome;
mod pairing;
mod table;
mod traceback;

pub use outcome::{ListingResult, ListingRun, check_listing, is_as_displayed};
pub use pairing::{DisplayedOutput, Listing, pair_listings};
pub use traceback::last_line;

#[cfg(test)]
mod tests;
