//! Words that state a condition: `stable`, `it tips over`.

use super::messages;
use super::quote_claim::{QuoteClaim, QuoteState};
use super::rendered::RenderedText;
use crate::finding::{Finding, Severity};
use crate::rules;
use std::ops::Range;

/// The results of a condition.
#[derive(Clone, Debug)]
pub(in crate::verify) struct QuotedCondition {
    /// Whether it holds in the nominal runs.
    pub(in crate::verify) holds: bool,
    /// The timestep perturbations under which the result differs.
    pub(in crate::verify) timestep: Vec<&'static str>,
    /// The perturbed starts from which the result differs.
    pub(in crate::verify) start: Vec<&'static str>,
}

/// Compares words with a condition, at every place where they appear. Returns a short reason when they are not right.
pub(in crate::verify) fn check_words(
    claim: &QuoteClaim<'_>,
    places: &[Range<usize>],
    condition: &QuotedCondition,
    rendered: &RenderedText,
    findings: &mut Vec<Finding>,
) -> (QuoteState, String) {
    let Some(first) = places.first() else {
        let finding = messages::not_found(claim, rendered.hidden(claim.quote.as_str()));
        findings.push(finding);
        return (QuoteState::Unclear, "no reader sees this text".into());
    };
    let words = messages::shorten_quote(claim);
    let mut report = |rule, severity, message: String, why: &str, help: &str| {
        findings.push(
            Finding::error(rule, first.clone(), message)
                .severity(severity)
                .why(why.to_string())
                .help(help.to_string())
                .related(claim.expr.span(), "the condition for these words"),
        );
    };
    if let Some(how) = condition.start.first() {
        let message =
            format!("whether \"{words}\" is right depends on the last digits: the result differs {how}");
        report(
            rules::QUOTE_CHAOTIC,
            Severity::Warning,
            message.clone(),
            "another computer, or another version of the simulator, gives the other result",
            "say it about a shorter run, or about a case that is further from the limit",
        );
        return (QuoteState::Unclear, message);
    }
    if !condition.holds {
        report(
            rules::QUOTE_WRONG,
            Severity::Error,
            format!("the text says \"{words}\", but the simulation disagrees"),
            "a reader who tries it sees the opposite",
            "correct the text, or its condition",
        );
        return (QuoteState::Wrong, "the simulation disagrees with the words".into());
    }
    if let Some(how) = condition.timestep.first() {
        report(
            rules::QUOTE_OF_TIMESTEP,
            Severity::Note,
            format!("\"{words}\" is right for this timestep only: the result differs {how}"),
            "a reader with another timestep sees the opposite",
            "state it with its timestep, and `set` the timestep in the run",
        );
    }
    (QuoteState::Right, String::new())
}
