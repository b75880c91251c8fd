//! Every rule, whatever part of labspec it comes from. Those of lessons, runs and claims are declared here, each on a page of its
//! own, with its check where it has one; those of the language and of models in their crates.
//!
//! A new rule of lessons is a file here and a line in the list below.

pub mod example;
mod language;

pub(crate) use duplicate_id::across;
pub(crate) use empty_plot::empty;
pub use labspec_finding::Rule;
pub(crate) use select_options::nothing_offered;
pub(crate) use verify_nothing::claims_nothing;

use crate::finding::Finding;
use crate::spec::{Control, Lab, Lesson, Question, Quiz};

macro_rules! rules {
    ($($file:ident :: $name:ident $(+ $check:ident)?,)*) => {
        $(mod $file; pub use $file::$name;)*
        /// The rules of lessons, their runs and their claims.
        pub const LESSONS: &[&Rule] = &[$($name),*];
        /// The checks of a lesson's structure. Other rules are told by whoever reads, binds or runs.
        pub(crate) const CHECKS: &[Check] = &[$($($file::$check,)?)*];
    };
}

/// What a rule looks at. The runner walks the lesson ([`crate::lint`]).
pub(crate) enum Check {
    /// Every lab, those of questions too.
    Lab(fn(&Lab, &mut Vec<Finding>)),
    /// Every control of every lab.
    Control(fn(&Control, &mut Vec<Finding>)),
    /// Every quiz.
    Quiz(fn(&Quiz, &mut Vec<Finding>)),
    /// Every question.
    Question(fn(&Question, &mut Vec<Finding>)),
    /// The lesson as a whole.
    Lesson(fn(&Lesson, &mut Vec<Finding>)),
}

rules! {
    fence_unclosed::FENCE_UNCLOSED,
    fence_line::FENCE_LINE,
    fence_missing::FENCE_MISSING,
    fence_unseen::FENCE_UNSEEN,
    fence_kind::FENCE_KIND,
    fence_name::FENCE_NAME,
    unknown_spec::UNKNOWN_SPEC,
    lesson_limit::LESSON_LIMIT,
    typographic_quote::TYPOGRAPHIC_QUOTE + CHECK,
    listing_underscores::LISTING_UNDERSCORES,
    listing_line_breaks::LISTING_LINE_BREAKS,
    listing_indentation::LISTING_INDENTATION,
    unescaped_element::UNESCAPED_ELEMENT,
    latex_escape::LATEX_ESCAPE + CHECK,
    json_syntax::JSON_SYNTAX,
    duplicate_key::DUPLICATE_KEY,
    json_limit::JSON_LIMIT,
    unknown_key::UNKNOWN_KEY,
    missing_key::MISSING_KEY,
    wrong_type::WRONG_TYPE,
    one_model::ONE_MODEL + CHECK,
    unknown_model::UNKNOWN_MODEL,
    model_name::MODEL_NAME,
    not_positive::NOT_POSITIVE + CHECK,
    digits_range::DIGITS_RANGE + CHECK,
    keyframe_range::KEYFRAME_RANGE + CHECK,
    unknown_overlay::UNKNOWN_OVERLAY + CHECK,
    empty_range::EMPTY_RANGE + CHECK,
    slider_value::SLIDER_VALUE + CHECK,
    slider_step::SLIDER_STEP + CHECK,
    select_value::SELECT_VALUE + CHECK,
    select_options::SELECT_OPTIONS,
    control_without_effect::CONTROL_WITHOUT_EFFECT + CHECK,
    duplicate_control::DUPLICATE_CONTROL + CHECK,
    apply_unused::APPLY_UNUSED + CHECK,
    empty_plot::EMPTY_PLOT,
    duplicate_trace::DUPLICATE_TRACE + CHECK,
    duplicate_readout::DUPLICATE_READOUT + CHECK,
    empty_quiz::EMPTY_QUIZ + CHECK,
    too_few_options::TOO_FEW_OPTIONS + CHECK,
    answer_range::ANSWER_RANGE + CHECK,
    duplicate_option::DUPLICATE_OPTION + CHECK,
    zero_tolerance::ZERO_TOLERANCE + CHECK,
    impossible_tolerance::IMPOSSIBLE_TOLERANCE + CHECK,
    duplicate_id::DUPLICATE_ID + CHECK,
    unknown_lab::UNKNOWN_LAB + CHECK,
    verify_without_lab::VERIFY_WITHOUT_LAB + CHECK,
    unknown_control::UNKNOWN_CONTROL + CHECK,
    verify_answer::VERIFY_ANSWER + CHECK,
    verify_nothing::VERIFY_NOTHING,
    run_length::RUN_LENGTH + CHECK,
    model_broken::MODEL_BROKEN,
    not_utf8::NOT_UTF8,
    model_unreadable::MODEL_UNREADABLE,
    keyframe_missing::KEYFRAME_MISSING,
    value_unused::VALUE_UNUSED,
    missing_setconst::MISSING_SETCONST,
    lost_at_reset::LOST_AT_RESET,
    quaternion_as_angle::QUATERNION_AS_ANGLE,
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

/// All rules: of lessons with their runs and claims, of the language, of models.
pub fn all() -> impl Iterator<Item = &'static Rule> {
    let models = labspec_core::xml::rules::ALL.iter().copied();
    LESSONS.iter().copied().chain(language::PAGES).chain(models)
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
