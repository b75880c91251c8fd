//! Observed orders of convergence: how many times an error halves when the timestep is halved.

use super::judge::Compared;
use super::report::PrecisionRow;
use super::run_record::RunStatus;

/// An order is determined only if the error is below this part of the range, so that the leading term dominates,
const SMALL: f64 = 0.1;
/// and if the next pair of timesteps gives the same order within `SAME`, with errors below `LARGE`. With only one pair, the
/// error must be below `SMALL_ALONE`.
const SAME: f64 = 0.06;
const LARGE: f64 = 0.5;
const SMALL_ALONE: f64 = 0.01;
/// A smaller order is not that of a convergent method.
const LEAST: f64 = 0.5;

/// Determines the order between each run and the one with the next shorter timestep. Only for `smooth` scenes, in which no
/// force jumps, and for numbers whose truth is known to the end.
pub(super) fn observe_orders(rows: &mut [PrecisionRow], targets: &[Compared], smooth: bool) {
    if !smooth {
        return;
    }
    for (i, target) in targets.iter().enumerate().filter(|(_, t)| t.until.is_none()) {
        let seen: Vec<Option<f64>> = (0..rows.len()).map(|k| observed(rows, k, i, target)).collect();
        let alike = |k: usize, order: f64| {
            let others = [k.checked_sub(1), Some(k + 1)].into_iter().flatten();
            let others: Vec<f64> = others
                .filter(|&o| same_method(rows, k, o))
                .filter_map(|o| seen.get(o).copied().flatten())
                .collect();
            let alone = others.is_empty() && error(rows, k - 1, i) < SMALL_ALONE * target.range;
            alone || others.iter().any(|o| (o - order).abs() <= SAME * order)
        };
        let is_small = |k: usize| k > 0 && error(rows, k - 1, i) < SMALL * target.range;
        let orders: Vec<Option<f64>> =
            seen.iter().enumerate().map(|(k, o)| o.filter(|o| is_small(k) && alike(k, *o))).collect();
        for (row, order) in rows.iter_mut().zip(orders) {
            if let Some(e) = row.errors.get_mut(i) {
                e.order = order;
            }
        }
    }
}

fn error(rows: &[PrecisionRow], k: usize, target: usize) -> f64 {
    rows.get(k).and_then(|r| r.errors.get(target)).map_or(f64::NAN, |e| e.largest)
}

fn same_method(rows: &[PrecisionRow], a: usize, b: usize) -> bool {
    let (Some(a), Some(b)) = (rows.get(a), rows.get(b)) else { return false };
    a.setting.integrator == b.setting.integrator && a.setting.solver.is_none() && b.setting.solver.is_none()
}

/// The order between the previous run and this one, if both errors are above the uncertainty of the reference and
/// below a part of the range.
fn observed(rows: &[PrecisionRow], k: usize, i: usize, target: &Compared) -> Option<f64> {
    let (coarse, fine) = (rows.get(k.checked_sub(1)?)?, rows.get(k)?);
    let longer = coarse.setting.timestep / fine.setting.timestep;
    let good =
        [coarse.status, fine.status] == [RunStatus::Good; 2] && same_method(rows, k - 1, k) && longer > 1.0;
    let (c, f) = (coarse.errors.get(i)?, fine.errors.get(i)?);
    let above = !c.below && !f.below && f.largest > 10.0 * target.uncertain;
    let order = (c.largest / f.largest).log2() / longer.log2();
    (good && above && c.largest < LARGE * target.range && order >= LEAST && order.is_finite())
        .then_some(order)
}
