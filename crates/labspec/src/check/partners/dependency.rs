//! Claims that depend on a parameter that was changed without its coupled parameters: their second verdicts and findings.

use super::{ClaimOwner, PartnerCandidate, moved, pairs};
use crate::finding::Finding;
use crate::json::read::named;
use crate::ledger::State;
use crate::rules;
use crate::source::Text;
use crate::spec::Question;
use crate::verify::{self, Judgement, Measured, QuoteState, Verdict, significant};
use std::ops::Range;

/// The dependency of claims on programs that omit coupled parameters.
pub(super) struct Dependency {
    subject: String,
    /// The parameters that they do not update, in words.
    left: String,
    corrected: String,
    /// The measure that changes most, in words; empty where none changes.
    pub(super) evidence: String,
    codes: String,
}

impl Dependency {
    pub(super) fn new(causes: &[PartnerCandidate<'_>], first: &Judgement, second: &Judgement) -> Dependency {
        let subject: Vec<&str> = causes.iter().map(|c| c.subject.as_str()).collect();
        let left: Vec<String> = causes.iter().map(PartnerCandidate::left).collect();
        Dependency {
            subject: subject.join(" and "),
            left: left.join(", and "),
            corrected: corrected_words(causes),
            evidence: evidence(first, second),
            codes: codes(causes),
        }
    }

    /// Replaces the first verdict by the second one where a claim is no longer true. A claim that stays true gets a remark
    /// that it was tested.
    pub(super) fn apply(
        &self,
        case: ClaimOwner<'_>,
        first: &mut Judgement,
        second: Judgement,
        findings: &mut Vec<Finding>,
    ) {
        let holds = |state: State| matches!(state, State::True(_));
        let also = format!("it is also true with {} (`{}` at {})", self.corrected, self.codes, self.subject);
        let add = |reason: &mut String| {
            let between = if reason.is_empty() { "" } else { "; " };
            *reason = format!("{reason}{between}{also}");
        };
        if let (Some(a), Some(b)) = (&mut first.answer, second.answer) {
            let margins =
                |answer: &verify::Answer| answer.weights.iter().map(|w| w.margin).collect::<Vec<_>>();
            if holds(a.verdict.state()) && !holds(b.verdict.state()) {
                let right = case.question.and_then(Question::right_option);
                let option = right.and_then(|i| case.verify.options.get(i));
                let place =
                    case.verify.value.as_ref().or(option).map_or(case.verify.span.clone(), Text::span);
                a.reason = self.reason(b.verdict.as_str());
                a.verdict = if b.verdict == Verdict::Unverified { Verdict::Failed } else { b.verdict };
                findings.push(self.finding(place, "this answer"));
            } else if holds(a.verdict.state()) && margins(a) != margins(&b) {
                add(&mut a.reason);
            }
        }
        for (a, b) in first.quotes.iter_mut().zip(second.quotes) {
            if a.state == QuoteState::Right && b.state != QuoteState::Right {
                a.reason = self.reason(b.verdict());
                (a.state, a.computed) = (b.state, b.computed);
                findings.push(self.finding(a.span.clone(), "this quote"));
            } else if a.state == QuoteState::Right && a.computed.to_bits() != b.computed.to_bits() {
                add(&mut a.reason);
            }
        }
        for (a, b) in first.exact.iter_mut().zip(second.exact) {
            if holds(a.state) && !holds(b.state) {
                (a.state, a.remark) = (b.state, self.reason(&b.remark));
                findings.push(self.finding(a.span.clone(), "this closed form"));
            } else if holds(a.state) && a.remark != b.remark {
                add(&mut a.remark);
            }
        }
    }

    /// Why a claim is not true: the two numbers, and the second result.
    fn reason(&self, then: &str) -> String {
        let numbers = match self.evidence.as_str() {
            "" => format!("with {}", self.corrected),
            evidence => format!("{evidence} with {}", self.corrected),
        };
        format!("{numbers}: {then}")
    }

    fn finding(&self, place: Range<usize>, what: &str) -> Finding {
        let message = format!("{what} is true only because {}", self.left);
        let why = match self.evidence.as_str() {
            "" => format!("with {} it is false", self.corrected),
            evidence => format!("{evidence} with {}: it is then false", self.corrected),
        };
        Finding::error(rules::CLAIM_OF_MISMATCH, place, message)
            .why(why)
            .help(format!("correct the program (see `{}`), then the claim about it", self.codes))
    }
}

/// The measure that changes most, with both numbers.
fn evidence(first: &Judgement, second: &Judgement) -> String {
    let part = |(a, b): &(&Measured, &Measured)| {
        let most = a.value.abs().max(b.value.abs());
        if most > 0.0 { (a.value - b.value).abs() / most } else { 0.0 }
    };
    let changed = pairs(first, second).filter(|(a, b)| moved(a, b));
    let Some((a, b)) = changed.max_by(|x, y| part(x).total_cmp(&part(y))) else { return String::new() };
    let run = match (a.name.split_once('.'), first.runs.as_slice()) {
        (Some((run, _)), _) => format!("in the run {}, ", named(run)),
        (None, [run]) => format!("in the run {}, ", named(&run.name)),
        (None, _) => String::new(),
    };
    format!("{run}`{}` is {}, but {}", a.name, significant(a.value), significant(b.value))
}

fn corrected_words(causes: &[PartnerCandidate<'_>]) -> String {
    let mut all: Vec<&str> = Vec::new();
    for (_, pair) in causes.iter().flat_map(|c| c.pairs.pairs()) {
        if !all.contains(&pair.corrected) {
            all.push(pair.corrected);
        }
    }
    all.join(" and ")
}

fn codes(causes: &[PartnerCandidate<'_>]) -> String {
    let mut all: Vec<&str> = causes.iter().flat_map(|c| c.pairs.pairs()).map(|(_, p)| p.rule.code).collect();
    all.dedup();
    all.join("`, `")
}
