//! Orders that errors show: how many times an error halves when the timestep halves.

use super::judge::Compared;
use super::report::Row;
use super::run_record::RunStatus;

/// An order is one where the error is below this part of the range, so that its first term leads,
const SMALL: f64 = 0.1;
/// and where the next pair of steps shows the same to this part of it, with errors below that part. With one pair alone, the error is
/// below this part.
const SAME: f64 = 0.06;
const LARGE: f64 = 0.5;
const SMALL_ALONE: f64 = 0.01;
/// Less is no order of a method that converges.
const LEAST: f64 = 0.5;

/// Writes the orders from each run to the one with the next shorter timestep, where there is one: `smooth` scenes, in which no
/// force jumps, and numbers whose truth is known to the end.
pub(super) fn observe_orders(rows: &mut [Row], targets: &[Compared], smooth: bool) {
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

fn error(rows: &[Row], k: usize, target: usize) -> f64 {
    rows.get(k).and_then(|r| r.errors.get(target)).map_or(f64::NAN, |e| e.largest)
}

fn same_method(rows: &[Row], a: usize, b: usize) -> bool {
    let (Some(a), Some(b)) = (rows.get(a), rows.get(b)) else { return false };
    a.setting.integrator == b.setting.integrator && a.setting.solver.is_none() && b.setting.solver.is_none()
}

/// From the run before to this one: both errors are above the doubt of the reference, and below a part of the range.
fn observed(rows: &[Row], k: usize, i: usize, target: &Compared) -> Option<f64> {
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
