//! Finds measures whose event happens at the first sample of every run that a claim reads.

use super::bound::BoundVerify;
use super::layout::Slot;
use super::option_numbers::{constant, is_below};
use super::outcome::MeasuredRuns;
use crate::finding::Finding;
use crate::rules;
use crate::source::Text;
use crate::spec::Verify;
use labspec_expr::ast::{BinaryOp, Expr, ExprKind};
use labspec_expr::parse_expression;
use std::collections::BTreeMap;

/// Reports them. An event that one of the runs has later is compared with that run.
pub(super) fn check_events(
    bound: &BoundVerify<'_>,
    outcome: &MeasuredRuns,
    verify: &Verify,
    findings: &mut Vec<Finding>,
) {
    let claims = verify.options.iter().chain(&verify.value).chain(verify.quoted());
    // A condition may say that it happens at once.
    let claims = claims.filter(|text| !is_at_once(&parse_expression(text.as_str()).tree));
    let slots = &bound.layout().slots;
    // The measures that are read: the aggregate where it happens at the first sample of all runs so far.
    let mut read: BTreeMap<&str, Option<&str>> = BTreeMap::new();
    for claim in claims.filter_map(|text| bound.claim(text)) {
        let of_claim = claim.reads.iter().filter_map(|place| {
            let Slot::Measure(run, measure) = *slots.get(*place)? else { return None };
            let measured = outcome.runs.get(run)?;
            let (name, _) = measured.measures.get(measure)?;
            let event = measured.at_start.iter().find(|(other, _)| other == name);
            // That a condition on the time holds from the start is how a value of the start is written.
            let event =
                event.map(|(_, event)| event.as_str()).filter(|event| !event.contains("data.time >= 0"));
            Some((name.as_str(), event))
        });
        let of_claim: Vec<_> = of_claim.collect();
        // With another measure beside it, the start is one end of a duration.
        let is_end = of_claim.iter().any(|(_, event)| event.is_none());
        for (name, event) in of_claim {
            let event = event.filter(|_| !is_end);
            read.entry(name).and_modify(|all| *all = all.and(event)).or_insert(event);
        }
    }
    for (name, event) in read.into_iter().filter_map(|(name, event)| Some((name, event?))) {
        let Some(text) = measure_text(verify, name) else { continue };
        let runs = if outcome.runs.len() > 1 { "every run" } else { "the run" };
        findings.push(
            Finding::new(
                rules::EVENT_AT_START,
                text.span(),
                format!("`{event}` happens at the first sample of {runs}"),
            )
            .why("the measure describes the start, not an event during the run")
            .help("wait for what comes later (`first(… && data.time > 0.1)`), or take the value of the start with `initial(…)`"),
        );
    }
}

/// Whether a condition compares one measure with a number above it, or with 0: `t < 0.01`.
fn is_at_once(e: &Expr) -> bool {
    match &e.kind {
        ExprKind::Logical { left, right, .. } => is_at_once(left) || is_at_once(right),
        ExprKind::Binary { op, left, right } => {
            let is_measure = |e: &Expr| matches!(e.kind, ExprKind::Name(_) | ExprKind::Member { .. });
            let is_equal = matches!(op, BinaryOp::Equal | BinaryOp::StrictEqual);
            let below = |flipped: bool| is_below(*op, flipped) == Some(true) || is_equal;
            is_measure(left) && constant(right).is_some() && below(false)
                || is_measure(right) && constant(left).is_some() && below(true)
        }
        _ => false,
    }
}

/// The text of a measure, or of the list that an element belongs to.
fn measure_text<'v>(verify: &'v Verify, name: &str) -> Option<&'v Text> {
    let list = name.split('[').next().unwrap_or(name);
    verify.measure.iter().find(|(other, _)| other.value == name || other.value == list).map(|(_, text)| text)
}
