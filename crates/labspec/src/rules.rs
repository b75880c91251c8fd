//! Every code that a finding may carry, whatever part of labspec it comes from: lesson rules, the language, the
//! model compiler, and what running and verifying finds.

use crate::lint;

/// Codes of findings that need a run: code, what is wrong, why it matters.
pub const RUN_RULES: &[(&str, &str, &str)] = &[
    (
        "model-broken",
        "the model of a lab has mistakes",
        "The lab cannot run, and its expressions cannot be checked, until the model loads.",
    ),
    (
        "not-utf8",
        "a file is not UTF-8",
        "A page reads lessons as UTF-8: letters beyond plain English are shown as a black diamond.",
    ),
    ("model-unreadable", "a model file cannot be read", "The page would show an empty scene."),
    (
        "keyframe-missing",
        "`key` names a keyframe that the model does not have",
        "The page silently starts from the default configuration.",
    ),
    ("value-unused", "the statements of a control never use `value`", "Moving the control changes nothing."),
    (
        "missing-setconst",
        "a mass or an inertia is changed without `mj_setConst`",
        "Constants that follow from it keep the old value, so contacts are as soft as for the old mass. The lab was run with and without: what differs is stated.",
    ),
    (
        "lost-at-reset",
        "what a control sets in the data is lost at the next reset",
        "The control still shows its value, but the simulation no longer has it. `\"init\": true` applies it again.",
    ),
    (
        "simulation-diverges",
        "the simulation meets a number that is not one, or above 1e10",
        "MuJoCo resets the data and goes on from time 0: a student sees the scene jump back without a word.",
    ),
    (
        "engine-warning",
        "the engine warns while a lab runs",
        "A body that moves has no inertia, or more things touch than are kept: what follows is not physics, and the page says nothing.",
    ),
    (
        "shows-nan",
        "a trace or a readout shows nan",
        "A student cannot tell whether the lab or the physics is broken. A gap that is meant says `NaN` itself, or reads a variable that is stored later.",
    ),
    ("shows-infinite", "a trace or a readout shows inf", "Something is divided by 0 there."),
    (
        "text-in-plot",
        "a trace of a plot is a text",
        "A plot draws numbers: the curve is missing, or drawn from what the page makes of the text.",
    ),
    (
        "energy-grows",
        "the simulation gains energy that nothing gives it",
        "The steps make it, not physics: a student sees things leap or swing ever wider, without a word from MuJoCo.",
    ),
    (
        "stiff-for-timestep",
        "a servo, a spring or a contact is too stiff for the timestep",
        "Every step pushes farther than the last one missed, without a word from MuJoCo until a number is beyond 1e10.",
    ),
    (
        "does-not-break",
        "a lab or a run that is said to break does not",
        "The author says `\"expect\": \"breaks\"`, and no run does: a student sees nothing of what the text speaks of.",
    ),
    (
        "run-impossible",
        "a run cannot be made",
        "It does what no student can do (a control that does not exist, a value that a slider cannot stand at, a press after the end), or it would take too many steps.",
    ),
    (
        "run-breaks",
        "a run of a `verify` object breaks",
        "It met a bad number, gained energy from nothing, or something in it threw: what it measures is evidence of nothing.",
    ),
    (
        "constant-claim",
        "a condition, a value or a number's expression is a bare constant",
        "It is the same whatever the simulation does, so nothing is checked by it.",
    ),
    (
        "compares-nan",
        "a condition is decided by what is no number",
        "A comparison with NaN never holds: it says nothing about the answer. A measure is NaN when its event never happens.",
    ),
    (
        "claim-without-number",
        "an expression that should give a number gives none",
        "Nothing can be compared with it.",
    ),
    (
        "unknown-trace",
        "a closed form is given for a trace that the lab does not have",
        "It is held to nothing.",
    ),
    (
        "closed-form-wrong",
        "a trace does not follow its closed form",
        "The formula in the lesson describes something else than the lab.",
    ),
    ("closed-form-untried", "a closed form cannot be tried", "Nothing says whether the trace follows it."),
    (
        "closed-form-undecided",
        "the runs do not tell whether a trace follows its closed form",
        "The difference between them neither vanishes nor stays as the timestep shrinks. State a tolerance.",
    ),
    (
        "no-model-folder",
        "there is no folder of models",
        "A lab that names its model cannot run, and nothing about it can be checked.",
    ),
    ("unreadable-file", "a file cannot be read", "Nothing in it was checked."),
    (
        "answer-refuted",
        "the simulation refutes the keyed answer",
        "A student who predicts right is told that they are wrong.",
    ),
    (
        "answer-ambiguous",
        "more than one option holds",
        "A student who chooses the other one is right and is told otherwise.",
    ),
    (
        "answer-fragile",
        "the answer holds only for one choice of numerics",
        "It depends on the timestep or on the solver's tolerance, which the question does not mention.",
    ),
    (
        "quote-wrong",
        "a number quoted in the text is not what the simulation gives",
        "A reader who measures it finds another number.",
    ),
    (
        "quote-not-found",
        "a quoted text stands nowhere that a reader sees, as a number of its own",
        "The check is about a number that no reader sees.",
    ),
    ("quote-without-number", "a quote holds no number", "There is nothing to compare."),
    (
        "quote-unclear",
        "a quoted number can be read in two ways, or in none",
        "Nothing was compared: a number that is guessed would make the verdict a guess.",
    ),
    (
        "quote-unit",
        "a quoted number and its expression differ by a power of ten",
        "The text is in another unit than the expression, so that the two cannot be compared.",
    ),
    (
        "quote-without-value",
        "the expression of a quoted number has no value",
        "What it waits for never happens in the run, so nothing was compared.",
    ),
    (
        "quote-of-timestep",
        "the digits of a quoted number change with half the timestep",
        "It is right for this timestep only; a reader with another one finds another number.",
    ),
    (
        "quote-chaotic",
        "the digits of a quoted number change with a start that is within rounding of the lesson's own",
        "No reader can reproduce them, on no other computer and with no other version of the simulator.",
    ),
];

/// All codes with a one-line summary: rules of lessons, then of runs, of the language, of models.
pub fn all() -> impl Iterator<Item = (&'static str, &'static str)> {
    let language = labspec_expr::code::ALL.iter().copied();
    let models = labspec_core::xml::code::ALL.iter().copied();
    lint::all()
        .map(|r| (r.code, r.summary))
        .chain(RUN_RULES.iter().map(|r| (r.0, r.1)))
        .chain(language)
        .chain(models)
}

/// The explanation of a code that is not a rule of lessons.
pub fn explain(code: &str) -> Option<String> {
    if let Some((_, summary, why)) = RUN_RULES.iter().find(|r| r.0 == code) {
        return Some(format!("# {code}\n\n{summary}.\n\n{why}\n"));
    }
    let (_, summary) = all().find(|(c, _)| *c == code)?;
    Some(format!("# {code}\n\n{summary}\n"))
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    #[test]
    fn codes_have_one_meaning() {
        let mut seen = BTreeMap::new();
        for (code, summary) in super::all() {
            assert!(seen.insert(code, summary).is_none(), "{code} twice");
            assert!(
                !summary.is_empty()
                    && code.chars().all(|c| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '-'),
                "{code}"
            );
        }
    }
}
