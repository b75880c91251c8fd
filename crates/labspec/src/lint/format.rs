//! The findings about objects that do not match the format. `spec/` detects the problems while it reads the objects.

use crate::finding::Finding;
use crate::rules;
use crate::source::MAX_FILE;
use crate::spec::{FormatProblem, Mistake};
use std::ops::Range;

/// The finding about a problem.
pub(super) fn to_finding(problem: &FormatProblem) -> Finding {
    let mut finding = finding_at(problem.span.clone(), &problem.mistake);
    // A page does not read `verify` objects, so the consequence of an error there concerns only the check.
    let reason = |rule: &rules::Rule| *finding.code == *rule && finding.why.as_deref() == Some(rule.why);
    if problem.in_verify && [rules::UNKNOWN_KEY, rules::WRONG_TYPE].into_iter().any(reason) {
        finding.why =
            Some("only this checker reads `verify`: what it does not understand is not checked".into());
    }
    finding
}

/// The finding about each mistake, from the page of its rule.
fn finding_at(span: Range<usize>, mistake: &Mistake) -> Finding {
    let open = || span.start..span.end.min(span.start + 1);
    match mistake {
        Mistake::UnknownKey { object, key, meant } => {
            rules::unknown_key::describe_key(span, object, key, meant)
        }
        Mistake::MissingKey { object, key, why, advised, example } => {
            rules::missing_key::describe_missing(span, object, key, why, *advised, example)
        }
        Mistake::NoChoice { text, index } => rules::select_options::not_a_pair(span, text.as_deref(), *index),
        Mistake::NothingOffered => rules::select_options::no_options(open()),
        Mistake::NoTraces => rules::empty_plot::without_traces(open()),
        Mistake::NoPlace(text) => rules::unknown_lab::not_an_address(span, text),
        Mistake::ClaimsNothing => rules::verify_nothing::claims_nothing(open()),
        Mistake::NoDefinitionName(name) => rules::wrong_type::no_definition_name(open(), name),
        Mistake::ClaimsInDefinition => rules::verify_nothing::claims_in_definition(open()),
        Mistake::HoldsQuiz(right) => {
            let message = "this fence says `lab`, but it holds a quiz";
            rules::fence_kind::holds(span, message, "quiz", right)
        }
        Mistake::HoldsLab(right) => {
            let message = "this fence says `quiz`, but it holds a lab";
            rules::fence_kind::holds(span, message, "lab simlab", right)
        }
        Mistake::EmptyFence => rules::json_syntax::empty_fence(span),
        Mistake::UnknownObject => rules::unknown_spec::unrecognized(open()),
        Mistake::NoSource(name, why) => rules::unknown_source::unreadable(span, name, why),
        Mistake::TooLarge => {
            let limit = MAX_FILE >> 20;
            Finding::new(rules::LESSON_LIMIT, span, format!("this file is larger than {limit} MB"))
        }
        Mistake::Type { .. }
        | Mistake::NotWhole { .. }
        | Mistake::ControlType(_)
        | Mistake::QuestionKind(_)
        | Mistake::LabExpects(_)
        | Mistake::RunExpects(_)
        | Mistake::NoPoint
        | Mistake::NoSwitch
        | Mistake::NoLab(_)
        | Mistake::NoSweep
        | Mistake::NoRows
        | Mistake::NoColumn
        | Mistake::FindsNothing
        | Mistake::FindsBackwards
        | Mistake::SweptValues(_)
        | Mistake::RunNames { .. }
        | Mistake::RunTwice(_)
        | Mistake::NoPress
        | Mistake::NoRange
        | Mistake::NoQuote
        | Mistake::QuoteWithoutList(_)
        | Mistake::AnswerText(_) => rules::wrong_type::describe_type(&span, mistake),
    }
}
