//! Tests whether a claim could have a different outcome. Measured values are replaced by other values of their kind. If no
//! replacement changes the outcome, the claim depends on no measured value and says nothing about the simulation.

use super::compiled_claim::ClaimInputs;
use super::draws::Draws;
use super::value_kind::ValueKind;
use labspec_expr::Comparison;

/// Number of drawn replacements for the measured values.
const REPLACEMENTS: usize = 16;

/// The inputs of a claim with drawn values of their kinds in place of the measured ones, `REPLACEMENTS` times.
pub(super) fn draws<'i>(
    nominal: &'i ClaimInputs,
    places: &'i [usize],
    kinds: &'i [ValueKind],
) -> impl Iterator<Item = ClaimInputs> + 'i {
    let mut draws = Draws::new(3);
    (0..REPLACEMENTS).map(move |_| {
        let mut inputs = nominal.clone();
        for (place, kind) in places.iter().zip(kinds) {
            inputs.set_value(*place, kind.nearest(draws.any()));
        }
        inputs
    })
}

/// Evaluates a claim with some inputs; `None` where it has no value.
pub(super) type EvaluateClaim<'s> = dyn FnMut(&ClaimInputs) -> Option<(ClaimValue, Vec<Comparison>)> + 's;

/// The value of a claim: the truth of a condition, or a number.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum ClaimValue {
    Holds(bool),
    Number(f64),
}

impl ClaimValue {
    /// Whether two values are different claims. Numbers differ if their relative difference exceeds one percent.
    pub(super) fn differs(self, other: ClaimValue) -> bool {
        match (self, other) {
            (ClaimValue::Holds(a), ClaimValue::Holds(b)) => a != b,
            (ClaimValue::Number(a), ClaimValue::Number(b)) => {
                (a - b).abs() > 0.01 * a.abs() || (a == 0.0 && b.abs() > 1e-12)
            }
            _ => true,
        }
    }
}

/// Largest magnitude of a replacement value. Values a million times as large as every measured value are excluded, so that
/// `z < 1e300` counts as a claim without content.
pub(super) fn reach(values: &[f64]) -> f64 {
    let largest = values.iter().filter(|x| x.is_finite()).fold(1.0, |most: f64, x| most.max(x.abs()));
    1e6 * largest
}

/// Factors by which a measured value is multiplied.
const FACTORS: [f64; 14] =
    [0.0, 0.5, 2.0, -1.0, 0.9, 1.1, 0.99, 1.01, 0.999_999, 1.000_001, 0.1, 10.0, 0.001, 1000.0];
/// Number of joint draws: `INITIAL_DRAWS` before the search in single numbers, `TOTAL_DRAWS` in total; and the number of
/// bisection steps of that search.
const INITIAL_DRAWS: usize = 200;
const TOTAL_DRAWS: usize = 4000;
const BISECTIONS: usize = 60;

/// Whether other measured values change the outcome of a claim. `places` are the positions of the numbers and then of the
/// parts; `kinds` are their kinds.
pub(super) fn could_differ(
    nominal: &ClaimInputs,
    places: &[usize],
    kinds: &[ValueKind],
    constants: &[f64],
    says: &mut EvaluateClaim<'_>,
) -> bool {
    let Some((current, compared)) = says(nominal) else { return false };
    let values: Vec<f64> = places.iter().filter_map(|p| nominal.at(*p)).collect();
    let lists = values_to_try(&values, kinds, constants, &compared);
    let mut inputs = nominal.clone();
    let mut all: Vec<Vec<(f64, Vec<Comparison>)>> = Vec::new();
    for (&place, list) in places.iter().zip(&lists) {
        let mut tried = Vec::new();
        // Any measure may be NaN: its event does not happen, or the run breaks.
        for x in list.iter().copied().chain([f64::NAN]) {
            inputs.set_value(place, x);
            if let Some((then, compared)) = says(&inputs) {
                if then.differs(current) {
                    return true;
                }
                tried.push((x, compared));
            }
        }
        inputs.copy(nominal);
        all.push(tried);
    }
    let mut together = JointDraws { nominal, places, kinds, lists: &lists, draws: Draws::new(7) };
    if together.differs(INITIAL_DRAWS, current, says) {
        return true;
    }
    // Where a comparison changes sign between two values, or comes close to it, search for the value in between.
    for ((&place, kind), tried) in places.iter().zip(kinds).zip(&all) {
        let mut alone = |x| {
            inputs.set_value(place, x);
            says(&inputs)
        };
        if !kind.whole && find_changing_value(tried, current, &mut alone) {
            return true;
        }
        inputs.copy(nominal);
    }
    together.differs(TOTAL_DRAWS - INITIAL_DRAWS, current, says)
}

/// For each measured value, the values that replace it, sorted: multiples of it, and values near everything that it is
/// compared with.
fn values_to_try(
    values: &[f64],
    kinds: &[ValueKind],
    constants: &[f64],
    compared: &[Comparison],
) -> Vec<Vec<f64>> {
    let sides = compared.iter().flat_map(|c| [c.left, c.right]);
    let reach = reach(values);
    let others: Vec<f64> = values
        .iter()
        .copied()
        .chain(constants.iter().copied())
        .chain(sides)
        .filter(|x| x.abs() <= reach)
        .take(40)
        .collect();
    let list = |i: usize, kind: &ValueKind| -> Vec<f64> {
        let measured = values.get(i).copied().filter(|x| x.is_finite()).unwrap_or(1.0);
        let mut list: Vec<f64> = FACTORS.iter().map(|f| f * measured).collect();
        list.extend([measured + 1.0, measured - 1.0, 0.0, 1.0, 2.0]);
        list.extend(others.iter().flat_map(|x| [*x, x * 1.000_001, x * 0.999_999, x + 1.0, x - 1.0, -x]));
        list.extend(others.iter().flat_map(|x| [x + measured, measured - x, 0.5 * x, 1.5 * x]));
        list.retain(|x| kind.has(*x));
        list.sort_by(f64::total_cmp);
        list.dedup();
        list
    };
    kinds.iter().enumerate().map(|(i, kind)| list(i, kind)).collect()
}

/// Changes several numbers at once: each keeps its value, takes one of its list, or equals another number.
struct JointDraws<'t> {
    nominal: &'t ClaimInputs,
    places: &'t [usize],
    kinds: &'t [ValueKind],
    lists: &'t [Vec<f64>],
    draws: Draws,
}

impl JointDraws<'_> {
    /// Whether one of `count` more draws changes the outcome of a claim.
    fn differs(&mut self, count: usize, current: ClaimValue, says: &mut EvaluateClaim<'_>) -> bool {
        if self.places.len() < 2 {
            return false;
        }
        let mut inputs = self.nominal.clone();
        (0..count).any(|_| {
            inputs.copy(self.nominal);
            self.draw(&mut inputs);
            says(&inputs).is_some_and(|(then, _)| then.differs(current))
        })
    }

    fn draw(&mut self, inputs: &mut ClaimInputs) {
        let draws = &mut self.draws;
        let mut last = None;
        for ((&place, kind), list) in self.places.iter().zip(self.kinds).zip(self.lists) {
            let (choice, position) = (draws.unit(), draws.unit());
            let x = match last {
                _ if choice < 0.3 => None,
                Some(x) if choice < 0.5 => Some(x),
                _ => list.get((position * list.len() as f64) as usize).copied(),
            };
            if let Some(x) = x.filter(|x| kind.has(*x)) {
                inputs.set_value(place, x);
                last = Some(x);
            }
        }
    }
}

/// Searches between tried values for one that changes the outcome of a claim, guided by the comparisons of the claim.
pub(super) fn find_changing_value(
    comparisons: &[(f64, Vec<Comparison>)],
    current: ClaimValue,
    says: &mut dyn FnMut(f64) -> Option<(ClaimValue, Vec<Comparison>)>,
) -> bool {
    let difference = |list: &[Comparison], k: usize| list.get(k).map(|c| c.left - c.right);
    let count = comparisons.iter().map(|(_, list)| list.len()).min().unwrap_or(0).min(8);
    for k in 0..count {
        for pair in comparisons.windows(2) {
            let [(a, at_a), (b, at_b)] = pair else { continue };
            let (Some(da), Some(db)) = (difference(at_a, k), difference(at_b, k)) else { continue };
            if da * db >= 0.0 || (da * db).is_nan() {
                continue;
            }
            let (mut low, mut high, low_side) = (*a, *b, da);
            for _ in 0..BISECTIONS {
                let middle = low + (high - low) / 2.0;
                let Some((then, list)) = says(middle) else { break };
                if then.differs(current) {
                    return true;
                }
                let Some(d) = difference(&list, k) else { break };
                if d * low_side > 0.0 { low = middle } else { high = middle }
            }
        }
        // The minimum of the distance between the two sides, where it lies between two values (golden section search).
        for triple in comparisons.windows(3) {
            let [(a, at_a), (_, at_m), (b, at_b)] = triple else { continue };
            let all = [at_a, at_m, at_b].map(|list| difference(list, k).map(f64::abs));
            let [Some(da), Some(dm), Some(db)] = all else { continue };
            if dm > da || dm > db {
                continue;
            }
            let (mut low, mut high) = (*a, *b);
            for _ in 0..BISECTIONS {
                let [x, y] = [high - 0.618_034 * (high - low), low + 0.618_034 * (high - low)];
                let (Some((at_x, lx)), Some((at_y, ly))) = (says(x), says(y)) else { break };
                if at_x.differs(current) || at_y.differs(current) {
                    return true;
                }
                let (Some(dx), Some(dy)) = (difference(&lx, k), difference(&ly, k)) else { break };
                if dx.abs() < dy.abs() { high = y } else { low = x }
            }
        }
    }
    false
}
