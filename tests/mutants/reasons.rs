//! Reasons why some mistakes are not found although they could be detected without a claim.

/// Kinds with mistakes that are not found, and the reason.
pub(super) const REASONS: [(&str, &str); 7] = [
    ("nan-at-start", "the text reads a variable that is initially null, so a gap may be intended"),
    ("constant-trace", "the text contains a formula of time, which changes"),
    ("constant-readout", "the text contains a formula of time, which changes"),
    ("above-plot", "the curve has no values in the short run"),
    (
        "no-digits",
        "the value hardly changes relative to its size, or changes by several units when a control is moved",
    ),
    ("button-overwritten", "the button sets the same values as a reset"),
    ("answer-digit", "the explanation contains another number with fewer digits that is equally near"),
];

/// The reason for a kind.
pub(super) fn reason(kind: &str) -> Option<&'static str> {
    REASONS.iter().find(|(name, _)| *name == kind).map(|(_, why)| *why)
}
