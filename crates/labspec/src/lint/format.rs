//! The findings about objects that do not match the format. `spec/` detects the problems while it reads the objects.

use crate::finding::Finding;
use crate::rules;
use crate::source::MAX_FILE;
use crate::spec::{Misfit, Mistake};
use std::ops::Range;

/// The finding about a misfit.
pub(super) fn to_finding(misfit: &Misfit) -> Finding {
    let mut finding = finding_at(misfit.span.clone(), &misfit.mistake);
    // A page does not read `verify` objects, so the consequence of an error there concerns only the check.
    let reason = |rule: &rules::Rule| *finding.code == *rule && finding.why.as_deref() == Some(rule.why);
    if misfit.in_verify && [rules::UNKNOWN_KEY, rules::WRONG_TYPE].into_iter().any(reason) {
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
        Mistake::MissingKey { object, key, why, advised } => {
            rules::missing_key::describe_missing(span, object, key, why, *advised)
        }
        Mistake::NoChoice => rules::select_options::not_a_pair(span),
        Mistake::NothingOffered => rules::select_options::no_options(open()),
        Mistake::NoTraces => rules::empty_plot::without_traces(open()),
        Mistake::NoPlace(text) => rules::unknown_lab::not_an_address(span, text),
        Mistake::ClaimsNothing => rules::verify_nothing::claims_nothing(open()),
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
        | Mistake::FindsNothing
        | Mistake::FindsBackwards
        | Mistake::SweptValues(_)
        | Mistake::NoPress
        | Mistake::NoRange
        | Mistake::NoQuote => rules::wrong_type::describe_type(&span, mistake),
    }
}
