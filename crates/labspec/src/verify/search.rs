//! The largest or the smallest value for which a condition holds, found by running.
//!
//! The two ends are run first, then a few values between them, because a condition that changes more than once has no
//! single limit. Where the margin of the condition has a minimum between two of these values, a golden section search looks
//! for it, so that a narrow band is found. Then the interval in which the condition changes is bisected down to the
//! requested length, and values on both sides of the limit are tested.

use super::bound::BoundVerify;
use super::format::significant;
use super::run_cache::{BoundLab, RunCache, misspelt};
use super::runner::TIMESTEP;
use crate::finding::Finding;
use crate::rules;
use crate::run::StepVariant;
use crate::source::Text;
use crate::spec::{Find, Run, Verify};
use labspec_core::xml::Patch;

/// Number of values that are tested between the ends, and of the search for the minimum of the margin.
const PROBES: usize = 12;
const MAX_REFINEMENTS: usize = 20;
/// Distances from the limit at which both sides are tested, as fractions of the range.
const TEST_DISTANCES: [f64; 2] = [0.004, 0.02];
/// Maximum number of bisection steps; more would exceed the precision of numbers.
const MAX_BISECTIONS: usize = 60;

/// A search, with its run, its measures and its lab.
pub(super) struct SearchCase<'c> {
    pub(super) find: &'c Find,
    pub(super) run: Option<&'c Run>,
    pub(super) measure: &'c [(Text, Text)],
    pub(super) scene: &'c BoundLab<'c>,
}

/// The result for one value.
#[derive(Clone, Debug)]
struct TriedValue {
    holds: bool,
    /// The margin of the condition; `None` where nothing is compared, or the run broke.
    margin: Option<f64>,
}

/// The result of a search.
pub(super) struct SearchLimit {
    /// NaN when there is no single limit.
    pub(super) value: f64,
    /// The other end of the interval in which the condition changes; NaN when there is no single limit.
    pub(super) other_end: f64,
    /// The searched range, in words.
    pub(super) looked: String,
}

/// Makes the search. Returns `None` when a run cannot be executed, and NaN when there is no single limit. Both are
/// reported.
pub(super) fn search(
    case: &SearchCase<'_>,
    stage: &RunCache<'_>,
    numerics: StepVariant,
    findings: &mut Vec<Finding>,
) -> Option<SearchLimit> {
    let find = case.find;
    let is_control = case.scene.lab.control(&find.what.value).is_some() || find.what.value == "timestep";
    if let Some(unknown) = misspelt(&case.scene.lab, &find.what).filter(|_| !is_control) {
        findings.push(unknown);
        return None;
    }
    let mut refused = Vec::new();
    let mut open = None;
    let mut tried: Vec<(f64, TriedValue)> = Vec::new();
    let mut try_at = |x: f64| -> Option<TriedValue> {
        if let Some((_, tried_before)) = tried.iter().find(|(tried_value, _)| *tried_value == x) {
            return Some(tried_before.clone());
        }
        match holds(case, stage, x, numerics, &mut refused)? {
            Ok(found) => {
                tried.push((x, found.clone()));
                Some(found)
            }
            Err(part) => {
                open.get_or_insert((x, part));
                None
            }
        }
    };
    let found = halve(find, &mut try_at);
    let count = tried.len();
    let [from, to] = find.range.map(significant);
    let looked = format!("`{}` was searched at {count} values from {from} to {to}", find.name.value);
    let mut none = |message: String, help: &str| {
        findings.push(
            Finding::error(rules::CLAIM_WITHOUT_NUMBER, find.holds.span(), message)
                .why(format!("the search has no result, so no claim that reads it can be checked: {looked}"))
                .help(help),
        );
    };
    match (found, open) {
        (Some(Ok([value, other_end])), _) => Some(SearchLimit { value, other_end, looked }),
        (Some(Err((message, help))), _) => {
            none(message, help);
            Some(SearchLimit { value: f64::NAN, other_end: f64::NAN, looked })
        }
        (None, Some((x, part))) => {
            let message =
                format!("with {} the condition is undecided: `{part}` compares NaN", significant(x));
            none(message, "search where the measure has a value, or test for it with `isNaN(x)`");
            Some(SearchLimit { value: f64::NAN, other_end: f64::NAN, looked })
        }
        (None, None) => {
            findings.extend(refused.into_iter().take(1));
            None
        }
    }
}

/// Lints the condition of a search without executing a run.
pub(super) fn lint_condition(case: &SearchCase<'_>, stage: &RunCache<'_>, findings: &mut Vec<Finding>) {
    let runs = case.run.cloned().into_iter().collect();
    let verify = Verify::measuring(case.find.name.span(), runs, case.measure.to_vec());
    let scenes = [vec![case.scene.clone()]];
    // Errors of the run and the measures are already reported.
    if let Some(bound) = BoundVerify::new(&verify, Some(case.scene), &scenes, stage, &mut Vec::new()) {
        bound.lint_texts(std::iter::once(&case.find.holds), findings);
    }
}

/// Why a search has no value, and the help.
type NoLimit = (String, &'static str);

/// The limit and the other end of its bracket, or why there is none; `None` when a run cannot be executed.
fn halve(
    find: &Find,
    try_at: &mut dyn FnMut(f64) -> Option<TriedValue>,
) -> Option<Result<[f64; 2], NoLimit>> {
    let [from, to] = find.range;
    let part = |i: usize| from + (to - from) * i as f64 / (PROBES + 1) as f64;
    // The ends first: if the condition is the same at both, nothing else is run.
    let ends = [try_at(from)?.holds, try_at(to)?.holds];
    if let Some(none) = no_limit(find, ends) {
        return Some(Err(none));
    }
    let mut tried = Vec::new();
    for x in [from].into_iter().chain((1..=PROBES).map(part)).chain([to]) {
        tried.push((x, try_at(x)?));
    }
    let near: Vec<(f64, TriedValue)> =
        tried.windows(3).map(|t| refine(t, try_at)).collect::<Option<Vec<_>>>()?.concat();
    tried.extend(near);
    tried.sort_by(|a, b| a.0.total_cmp(&b.0));
    let found = as_one(changes(&tried), find.tol.value);
    let [[mut low, mut high]] = found[..] else { return Some(Err(several(&found))) };
    for _ in 0..MAX_BISECTIONS {
        let middle = low + (high - low) / 2.0;
        if high - low <= find.tol.value || middle <= low || middle >= high {
            break;
        }
        let current = try_at(middle)?;
        if current.holds == find.largest {
            low = middle
        } else {
            high = middle
        }
        tried.push((middle, current));
    }
    for x in TEST_DISTANCES.iter().flat_map(|part| [low - part * (to - from), high + part * (to - from)]) {
        if x > from && x < to {
            tried.push((x, try_at(x)?));
        }
    }
    tried.sort_by(|a, b| a.0.total_cmp(&b.0));
    let found = as_one(changes(&tried), find.tol.value);
    if found.len() != 1 {
        return Some(Err(several(&found)));
    }
    // The end of the interval at which the condition holds comes first.
    Some(Ok(if find.largest { [low, high] } else { [high, low] }))
}

/// The intervals in which the condition changes.
fn changes(tried: &[(f64, TriedValue)]) -> Vec<[f64; 2]> {
    let pairs = tried.iter().zip(tried.iter().skip(1));
    pairs.filter(|(a, b)| a.1.holds != b.1.holds).map(|(a, b)| [a.0, b.0]).collect()
}

/// Merges changes that are closer to each other than the requested precision.
fn as_one(changes: Vec<[f64; 2]>, tol: f64) -> Vec<[f64; 2]> {
    match (changes.first(), changes.last()) {
        (Some([low, _]), Some([_, high])) if high - low <= tol => vec![[*low, *high]],
        _ => changes,
    }
}

fn several(changes: &[[f64; 2]]) -> NoLimit {
    let place = |[a, b]: &[f64; 2]| format!("{} and {}", significant(*a), significant(*b));
    let places: Vec<String> = changes.iter().map(place).collect();
    let message = format!("the condition changes more than once: between {}", places.join(", between "));
    (message, "search where the condition changes only once")
}

/// Searches among three neighbours for the minimum of the margin, where it is between them.
fn refine(
    three: &[(f64, TriedValue)],
    try_at: &mut dyn FnMut(f64) -> Option<TriedValue>,
) -> Option<Vec<(f64, TriedValue)>> {
    let [(a, at_a), (_, at_m), (b, at_b)] = three else { return Some(Vec::new()) };
    let size = |t: &TriedValue| t.margin.map(f64::abs);
    let same = at_a.holds == at_m.holds && at_m.holds == at_b.holds;
    let (Some(da), Some(dm), Some(db)) = (size(at_a), size(at_m), size(at_b)) else {
        return Some(Vec::new());
    };
    if !same || dm >= da || dm >= db {
        return Some(Vec::new());
    }
    let (mut low, mut high) = (*a, *b);
    let mut found = Vec::new();
    for _ in 0..MAX_REFINEMENTS / 2 {
        let [x, y] = [high - 0.618_034 * (high - low), low + 0.618_034 * (high - low)];
        let (at_x, at_y) = (try_at(x)?, try_at(y)?);
        let (dx, dy) = (size(&at_x), size(&at_y));
        let turned = at_x.holds != at_m.holds || at_y.holds != at_m.holds;
        found.extend([(x, at_x), (y, at_y)]);
        if turned {
            break;
        }
        match dx.zip(dy) {
            Some((dx, dy)) if dx < dy => high = y,
            Some(_) => low = x,
            None => break,
        }
    }
    Some(found)
}

/// The error if the two ends show no limit between them, or one of the other kind.
fn no_limit(find: &Find, ends: [bool; 2]) -> Option<NoLimit> {
    let [from, to] = find.range.map(significant);
    match (ends, find.largest) {
        ([true, true], _) => {
            let message = format!("the condition holds at both ends of the range from {from} to {to}");
            Some((message, "widen the range, or ask for something that has a limit"))
        }
        ([false, false], _) => {
            let message = format!("the condition holds at neither end of the range from {from} to {to}");
            Some((message, "start or end the range where it holds"))
        }
        ([false, true], true) => {
            let message = format!(
                "the condition holds at {to} but not at {from}: there is a smallest value, but no largest one"
            );
            Some((message, "write \"smallest\""))
        }
        ([true, false], false) => {
            let message = format!(
                "the condition holds at {from} but not at {to}: there is a largest value, but no smallest one"
            );
            Some((message, "write \"largest\""))
        }
        _ => None,
    }
}

/// The attribute of the model that is modified; `None` for a control.
fn path(case: &SearchCase<'_>) -> Option<String> {
    let what = &case.find.what.value;
    match case.scene.lab.control(what) {
        Some(_) => None,
        None if what == "timestep" => Some(TIMESTEP.to_string()),
        None => Some(what.clone()),
    }
}

/// Whether the condition holds for this value; it does not in a run that breaks. The error is the part that compares NaN,
/// if the condition is undecided.
fn holds(
    case: &SearchCase<'_>,
    stage: &RunCache<'_>,
    x: f64,
    numerics: StepVariant,
    findings: &mut Vec<Finding>,
) -> Option<Result<TriedValue, String>> {
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
    let outcome = bound.outcome_of_runs(numerics, findings)?;
    let found = bound.find(&outcome, &find.holds, findings)?;
    if found.broke.is_some() {
        return Some(Ok(TriedValue { holds: false, margin: None }));
    }
    if let Some(undecided) = found.undecided {
        return Some(Err(undecided.part_of(&find.holds)));
    }
    if !bound.is_condition(&found, &find.holds, findings) {
        return None;
    }
    let margin = bound.evaluate_margin(&found);
    Some(Ok(TriedValue { holds: margin.holds, margin: margin.margin }))
}
