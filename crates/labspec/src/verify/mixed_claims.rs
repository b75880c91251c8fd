//! Finds claims that add or compare quantities of different dimensions: a distance and a time.

use super::bound::BoundVerify;
use super::options::is_undecided;
use super::outcome_names::OutcomeNames;
use crate::bind::Scope;
use crate::finding::{Finding, Severity};
use crate::rules::mixed_dimensions::clash_finding;
use crate::spec::Verify;

/// Reports them, as far as the dimensions of the measures are known.
pub(super) fn check_dimensions(bound: &BoundVerify<'_>, verify: &Verify, findings: &mut Vec<Finding>) {
    let (Some(base), Some(units)) = (bound.base(), bound.units()) else { return };
    let names = OutcomeNames::new(bound.layout(), base.names(Scope::Measure)).measuring(&units.runs);
    for text in verify.options.iter().chain(&verify.value).chain(verify.quoted()) {
        let claim = bound.claim(text).filter(|_| !is_undecided(text));
        let Some(program) = claim.as_ref().and_then(|claim| claim.program.as_ref()) else { continue };
        let clashes = program.measured(&names, &units.given).clashes;
        findings.extend(clashes.iter().map(|clash| of_claim(clash_finding(text, clash, Severity::Warning))));
    }
}

/// The finding with the reason and the help for a claim.
fn of_claim(finding: Finding) -> Finding {
    finding
        .why("quantities of different dimensions cannot be compared, so the claim says nothing about what is measured")
        .help("check the names of the measures: one of them is probably not the intended one")
}
