//! The rules, a file per family: metadata, reason, examples and check side by side.

pub mod control;
pub mod fence;
pub mod html;
pub mod ids;
pub mod json;
pub mod keys;
pub mod latex;
pub mod listing;
pub mod model;
pub mod plot;
pub mod quiz;
pub mod quotes;
pub mod ranges;
pub mod verify;

use labspec_finding::Rule;

/// All rules, in the order in which they are documented.
pub(super) const FAMILIES: &[&[&Rule]] = &[
    fence::RULES,
    quotes::RULES,
    listing::RULES,
    html::RULES,
    latex::RULES,
    json::RULES,
    keys::RULES,
    model::RULES,
    ranges::RULES,
    control::RULES,
    plot::RULES,
    quiz::RULES,
    ids::RULES,
    verify::RULES,
];
