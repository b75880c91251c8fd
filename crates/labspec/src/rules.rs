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
        "Constants that follow from it keep the old value, so contacts are as soft as for the old mass.",
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
        "run-impossible",
        "a run cannot be made",
        "A control that it sets does not exist, or it would take too many steps.",
    ),
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
        "a quoted text stands nowhere in the lesson",
        "The check is about a number that no reader sees.",
    ),
    ("quote-without-number", "a quote holds no number", "There is nothing to compare."),
];

/// All codes with a one-line summary: rules of lessons, then of runs, of the language, of models.
pub fn all() -> impl Iterator<Item = (&'static str, &'static str)> {
    let language = labspec_expr::code::ALL.iter().copied();
    let models = labspec_core::mjcf::code::ALL.iter().copied();
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
