//! Why mistakes of a kind are not found.

/// Kinds with survivors, and the reason.
pub(super) const REASONS: [(&str, &str); 44] = [
    ("next-index", "the neighbour is a quantity of its own: only the label says which is meant"),
    ("written-index", "the neighbour acts, too: only the label says which is meant"),
    (
        "wrong-sign",
        "what is shown is a possible number: only the label, or a `verify`, says which sign is meant",
    ),
    ("wrong-unit", "another number of the text is a factor, and may have a unit of its own"),
    ("labels-exchanged", "both measure the same, and neither label is a name of the model"),
    (
        "label-in-degrees",
        "it is the label of a plot, and the curves have units of their own, which are right",
    ),
    ("degrees", "a large angle is an angle"),
    ("compared", "the comparison stands in an `if` or a `?:`, where it may be meant"),
    ("nan-at-start", "the text itself says that there may be a gap"),
    ("constant-trace", "the text has a formula of time, which moves"),
    ("constant-readout", "a readout may show where something begins"),
    ("frozen-trace", "beside curves that move, a number may be meant as a line"),
    ("above-plot", "the curve is a gap in the short run"),
    ("copied-readout", "the two print different decimals, which may be the lesson"),
    ("early-stop", "a readout changes in the few steps that are run"),
    ("no-digits", "the value goes over several units"),
    ("few-digits", "the numbers are printed with an exponent, which has decimals of its own"),
    ("one-value-forgotten", "the other statement still acts"),
    ("dropped-statement", "the other statement still acts"),
    ("unused-element", "the budget of runs that make sure is spent"),
    ("overwritten", "the controller writes before the first step: what is shown before it changes"),
    (
        "clamped",
        "the half that is cut off is smaller than half of the places that are tried, or the budget is spent",
    ),
    ("reset-forgotten", "the control acts without a reset, too, and a run may go on"),
    ("one-option-twice", "the other option is the same in the lab: it is not known which is meant"),
    ("button-idle", "the lab's other buttons are many, and the budget of runs that make sure is spent"),
    ("button-overwritten", "a button may be there to begin again"),
    ("no-controller", "the lab is another one, and a sound one"),
    ("no-setup", "the lab is another one, and a sound one"),
    ("no-key", "the lab is another one, and a sound one"),
    ("long-step", "the scene follows even this timestep, or a slider sets it again"),
    ("negative-damping", "friction, contacts or the controller hold what the damper pushes"),
    ("no-gravity", "weightlessness is a lesson, too"),
    ("solver-stops", "nothing touches in the run"),
    ("stale-read", "the joint is none, or the position does not follow from what is written"),
    ("stale-sensor", "the sensor does not measure what is written"),
    ("key-shifted", "a question without `verify` has nothing to be compared with"),
    ("no-tolerance", "an answer that is a whole number may be asked for exactly"),
    ("tiny-tolerance", "the answer itself can be typed"),
    ("ten-times", "neither a `verify` nor the explanation says the number"),
    ("answer-sign", "neither a `verify` nor the explanation says the number"),
    ("answer-digit", "the explanation does not come to a number, or to one of fewer digits"),
    ("open-formula", "without a command or an index, a dollar may be a price"),
    ("reworded-option", "the option is code or a formula, in which every character counts"),
    ("into-the-floor", "the body is not pushed out in so few steps"),
];

/// The reason for a kind.
pub(super) fn reason(kind: &str) -> Option<&'static str> {
    REASONS.iter().find(|(name, _)| *name == kind).map(|(_, why)| *why)
}
