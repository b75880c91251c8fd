//! The largest or the smallest value with which a condition holds, found by running.
//!
//! The two ends are run first, then a few values between them: a condition that changes more than once has no one limit. Then the
//! part in which it changes is halved until it is as short as is asked for.

use super::bound::BoundVerify;
use super::perform::TIMESTEP;
use super::significant;
use super::stage::{Scene, Stage, misspelt};
use crate::finding::Finding;
use crate::rules;
use crate::run::Numerics;
use crate::source::Text;
use crate::spec::{Find, Run, Verify};
use labspec_core::xml::Patch;

/// Values that are looked at between the ends.
const PROBES: usize = 6;
/// Most halvings: more are finer than numbers are.
const HALVINGS: usize = 60;

/// A search: in which run, with which measures, of which lab.
pub(super) struct Case<'c> {
    pub(super) find: &'c Find,
    pub(super) run: Option<&'c Run>,
    pub(super) measure: &'c [(Text, Text)],
    pub(super) scene: &'c Scene<'c>,
}

/// Makes the search; `None` when a run cannot be made, NaN when there is no one limit. Both are reported.
pub(super) fn search(
    case: &Case<'_>,
    stage: &Stage<'_>,
    numerics: Numerics,
    findings: &mut Vec<Finding>,
) -> Option<f64> {
    let find = case.find;
    let known = case.scene.lab.control(&find.what.value).is_some() || find.what.value == "timestep";
    if let Some(unknown) = misspelt(&case.scene.lab, &find.what).filter(|_| !known) {
        findings.push(unknown);
        return None;
    }
    let mut refused = Vec::new();
    let mut try_at = |x: f64| holds(case, stage, x, numerics, &mut refused);
    let found = halve(find, &mut try_at);
    match found {
        Some(Ok(x)) => Some(x),
        Some(Err((message, help))) => {
            findings.push(
                Finding::error(rules::CLAIM_WITHOUT_NUMBER, find.holds.span(), message)
                    .why("the search has no value, and what reads it cannot be checked")
                    .help(help),
            );
            Some(f64::NAN)
        }
        None => {
            findings.extend(refused.into_iter().take(1));
            None
        }
    }
}

/// Why a search has no value, and what to do about it.
type NoLimit = (String, &'static str);

/// The limit, or why there is none; `None` when a run cannot be made.
fn halve(find: &Find, holds: &mut dyn FnMut(f64) -> Option<bool>) -> Option<Result<f64, NoLimit>> {
    let [from, to] = find.range;
    let part = |i: usize| from + (to - from) * i as f64 / (PROBES + 1) as f64;
    // The ends first: where nothing changes, nothing more is run.
    let ends = [holds(from)?, holds(to)?];
    if let Some(none) = no_limit(find, ends) {
        return Some(Err(none));
    }
    let mut tried = vec![(from, ends[0])];
    for i in 1..=PROBES {
        tried.push((part(i), holds(part(i))?));
    }
    tried.push((to, ends[1]));
    let pairs = tried.iter().zip(tried.iter().skip(1));
    let changes: Vec<[f64; 2]> = pairs.filter(|(a, b)| a.1 != b.1).map(|(a, b)| [a.0, b.0]).collect();
    let [[mut low, mut high]] = changes[..] else {
        let place = |[a, b]: &[f64; 2]| format!("{} and {}", significant(*a), significant(*b));
        let places: Vec<String> = changes.iter().map(place).collect();
        return Some(Err((
            format!("this changes more than once: between {}", places.join(", between ")),
            "there is no one limit: search where it changes once",
        )));
    };
    for _ in 0..HALVINGS {
        let middle = low + (high - low) / 2.0;
        if high - low <= find.tol.value || middle <= low || middle >= high {
            break;
        }
        if holds(middle)? == find.largest { low = middle } else { high = middle }
    }
    // The value with which it was seen to hold.
    Some(Ok(if find.largest { low } else { high }))
}

/// What the two ends say, where there is no limit between them or it is one of the other kind.
fn no_limit(find: &Find, ends: [bool; 2]) -> Option<NoLimit> {
    let [from, to] = find.range.map(significant);
    match (ends, find.largest) {
        ([true, true], _) => {
            let message = format!("this holds over the whole range from {from} to {to}");
            Some((message, "search further, or ask for something that ends"))
        }
        ([false, false], _) => {
            let message = format!("this holds at neither end of the range from {from} to {to}");
            Some((message, "begin, or end, where it holds"))
        }
        ([false, true], true) => {
            let message =
                format!("this holds at {to} and not at {from}: it has a smallest value, and no largest");
            Some((message, "write \"smallest\""))
        }
        ([true, false], false) => {
            let message =
                format!("this holds at {from} and not at {to}: it has a largest value, and no smallest");
            Some((message, "write \"largest\""))
        }
        _ => None,
    }
}

/// The attribute of the model that is changed; `None` for a control.
fn path(case: &Case<'_>) -> Option<String> {
    let what = &case.find.what.value;
    match case.scene.lab.control(what) {
        Some(_) => None,
        None if what == "timestep" => Some(TIMESTEP.to_string()),
        None => Some(what.clone()),
    }
}

/// Whether the condition holds with this value. In a run that breaks it does not.
fn holds(
    case: &Case<'_>,
    stage: &Stage<'_>,
    x: f64,
    numerics: Numerics,
    findings: &mut Vec<Finding>,
) -> Option<bool> {
    let find = case.find;
    let path = path(case);
    let patch =
        path.iter().map(|path| (Patch { path: path.clone(), value: x.to_string() }, find.what.span()));
    let scene = stage.changed(case.scene, &patch.collect::<Vec<_>>(), None, None, findings)?;
    let runs = case.run.cloned().into_iter().collect();
    let verify = Verify::measuring(find.name.span(), runs, case.measure.to_vec());
    let scenes = [vec![scene.clone()]];
    let mut bound = BoundVerify::new(&verify, Some(&scene), &scenes, stage, findings)?;
    if case.scene.lab.control(&find.what.value).is_some() {
        bound.set_freely(&find.what, x);
    }
    let outcome = bound.outcome(numerics, findings)?;
    let found = bound.find(&outcome, &find.holds, findings)?;
    Some(found.broke.is_none() && found.value.truthy())
}
