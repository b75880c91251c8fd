//! Why mistakes are not found that could be known without a claim.

/// Kinds with survivors, and the reason.
pub(super) const REASONS: [(&str, &str); 7] = [
    ("nan-at-start", "the text reads a variable that is null at first: there may be a gap"),
    ("constant-trace", "the text has a formula of time, which moves"),
    ("constant-readout", "the text has a formula of time, which moves"),
    ("above-plot", "the curve is a gap in the short run"),
    (
        "no-digits",
        "the value hardly changes beside its size, or goes over several units where a control is moved",
    ),
    ("button-overwritten", "what the button sets is what a reset sets"),
    ("answer-digit", "the explanation has another number, of fewer digits, that is as near"),
];

/// The reason for a kind.
pub(super) fn reason(kind: &str) -> Option<&'static str> {
    REASONS.iter().find(|(name, _)| *name == kind).map(|(_, why)| *why)
}
