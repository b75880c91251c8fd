//! Every rule, whatever part of labspec it comes from: those of the lessons, of the language and of models, and those that need
//! a run or a claim, which are declared here, each on a page of its own.

pub mod example;

pub use labspec_finding::Rule;

use crate::lint;

macro_rules! rules {
    ($($file:ident :: $name:ident,)*) => {
        $(mod $file; pub use $file::$name;)*
        /// The rules that need a model, a run or a claim.
        pub const RUNS: &[&Rule] = &[$($name),*];
    };
}

rules! {
    model_broken::MODEL_BROKEN,
    not_utf8::NOT_UTF8,
    model_unreadable::MODEL_UNREADABLE,
    keyframe_missing::KEYFRAME_MISSING,
    value_unused::VALUE_UNUSED,
    missing_setconst::MISSING_SETCONST,
    lost_at_reset::LOST_AT_RESET,
    simulation_diverges::SIMULATION_DIVERGES,
    engine_warning::ENGINE_WARNING,
    shows_nan::SHOWS_NAN,
    shows_infinite::SHOWS_INFINITE,
    text_in_plot::TEXT_IN_PLOT,
    energy_grows::ENERGY_GROWS,
    stiff_for_timestep::STIFF_FOR_TIMESTEP,
    does_not_break::DOES_NOT_BREAK,
    run_impossible::RUN_IMPOSSIBLE,
    run_breaks::RUN_BREAKS,
    constant_claim::CONSTANT_CLAIM,
    compares_nan::COMPARES_NAN,
    claim_without_number::CLAIM_WITHOUT_NUMBER,
    unknown_trace::UNKNOWN_TRACE,
    closed_form_wrong::CLOSED_FORM_WRONG,
    closed_form_untried::CLOSED_FORM_UNTRIED,
    closed_form_undecided::CLOSED_FORM_UNDECIDED,
    no_model_folder::NO_MODEL_FOLDER,
    unreadable_file::UNREADABLE_FILE,
    answer_refuted::ANSWER_REFUTED,
    answer_ambiguous::ANSWER_AMBIGUOUS,
    answer_fragile::ANSWER_FRAGILE,
    quote_wrong::QUOTE_WRONG,
    quote_not_found::QUOTE_NOT_FOUND,
    quote_without_number::QUOTE_WITHOUT_NUMBER,
    quote_unclear::QUOTE_UNCLEAR,
    quote_unit::QUOTE_UNIT,
    quote_without_value::QUOTE_WITHOUT_VALUE,
    quote_of_timestep::QUOTE_OF_TIMESTEP,
    quote_chaotic::QUOTE_CHAOTIC,
}

/// All rules: of lessons, of runs and claims, of the language, of models.
pub fn all() -> impl Iterator<Item = &'static Rule> {
    let language = labspec_expr::rules::ALL.iter().copied();
    let models = labspec_core::xml::rules::ALL.iter().copied();
    lint::all().chain(RUNS.iter().copied()).chain(language).chain(models)
}

/// The rule with this code.
pub fn find(code: &str) -> Option<&'static Rule> {
    all().find(|rule| rule.code == code)
}

/// The long explanation of a rule, as Markdown: what, why, wrong, right.
pub fn explain(code: &str) -> Option<String> {
    find(code).map(Rule::explain)
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    #[test]
    fn codes_have_one_meaning_and_are_in_words() {
        let mut seen = BTreeSet::new();
        for rule in super::all() {
            assert!(seen.insert(rule.code), "{} twice", rule.code);
            let words = rule.code.chars().all(|c| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '-');
            assert!(words && !rule.summary.is_empty() && !rule.summary.ends_with('.'), "{}", rule.code);
        }
    }

    #[test]
    fn explanations_show_both_examples() {
        insta::assert_snapshot!(super::explain("unknown-key").unwrap());
        assert_eq!(super::explain("no-such-rule"), None);
    }
}
