//! Recommendations: which settings are inferior, because another one is both more accurate and cheaper, and which one to use.

use super::case::OmittedNumber;
use super::case::REPEATED_NUMBER;
use super::judge::Compared;
use super::numbers::milliseconds;
use super::report::{Advice, AdviceKind, PrecisionResults, PrecisionRow};
use super::run_record::RunStatus;
use labspec::run::two_digits;

/// Whether the run of a row reached its end and was compared.
fn is_compared_to_end(row: &PrecisionRow) -> bool {
    row.status == RunStatus::Good && row.score.is_finite()
}

/// The reliable error, in multiples of the smallest visible error: the largest error of this timestep and of all shorter ones
/// of the same method. This way, a timestep that happens to hit an impact well gets no advantage.
fn reliable(rows: &[PrecisionRow], i: usize) -> f64 {
    let setting = rows[i].setting;
    let shorter = |r: &&PrecisionRow| {
        r.setting.integrator == setting.integrator
            && r.setting.solver.is_none()
            && r.setting.timestep < setting.timestep
    };
    let others =
        rows.iter().filter(shorter).map(|r| if is_compared_to_end(r) { r.score } else { f64::INFINITY });
    if setting.solver.is_some() { rows[i].score } else { others.fold(rows[i].score, f64::max) }
}

/// The settings for which no other is better in both error and cost, from the cheapest to the most accurate.
pub(super) fn front(rows: &[PrecisionRow]) -> Vec<usize> {
    let mut order: Vec<usize> = (0..rows.len()).filter(|&i| is_compared_to_end(&rows[i])).collect();
    order.sort_by(|&a, &b| {
        let key = |i: usize| (rows[i].cost.work, reliable(rows, i));
        key(a).0.total_cmp(&key(b).0).then(key(a).1.total_cmp(&key(b).1))
    });
    let mut best = f64::INFINITY;
    order.retain(|&i| {
        let error = reliable(rows, i);
        let better = error < best;
        best = best.min(error);
        better
    });
    order
}

/// A ratio of work below this counts as equal.
const EQUAL_WORK: f64 = 1.05;

/// Reports the error of the lab's own setting, a more accurate setting for the same work, and the cheapest one that displays
/// every digit correctly. Only settings that a page can use are recommended.
pub(super) fn advise(report: &PrecisionResults) -> Vec<Advice> {
    let rows = &report.rows;
    let usable: Vec<usize> = (0..rows.len())
        .filter(|&i| rows[i].setting.integrator.shared && is_compared_to_end(&rows[i]))
        .collect();
    let own_row = rows.iter().position(|r| r.is_own);
    let mut list = Vec::new();
    if let Some(own_row) = own_row {
        list.push(Advice {
            kind: AdviceKind::LabSetting,
            row: own_row,
            text: describe_own_error(report, own_row),
        });
        list.extend(closer_for_same_work(rows, &usable, own_row));
    }
    let correct = usable.iter().copied().filter(|&i| reliable(rows, i) <= 1.0);
    let cheapest = correct.min_by(|&a, &b| rows[a].cost.work.total_cmp(&rows[b].cost.work));
    list.extend(match cheapest {
        Some(i) => Some(cheapest_correct(report, own_row, i)),
        None => closest(report, &usable),
    });
    list
}

/// The most accurate setting that needs no more work than the lab's own, if it is much more accurate.
fn closer_for_same_work(rows: &[PrecisionRow], usable: &[usize], own_row: usize) -> Option<Advice> {
    let affordable =
        usable.iter().copied().filter(|&i| rows[i].cost.work <= EQUAL_WORK * rows[own_row].cost.work);
    let i = affordable.min_by(|&a, &b| reliable(rows, a).total_cmp(&reliable(rows, b)))?;
    if !(rows[own_row].score > 2.0 * reliable(rows, i) && is_compared_to_end(&rows[own_row])) {
        return None;
    }
    let times = rows[own_row].score / reliable(rows, i).max(f64::MIN_POSITIVE);
    let how = if reliable(rows, i) == 0.0 || times > 1e12 {
        "exact except for rounding".to_string()
    } else {
        format!("{} times more accurate", two_digits(times))
    };
    let text = format!("{} is {how} and takes {}.", name(&rows[i]), relative_work(&rows[i], &rows[own_row]));
    Some(Advice { kind: AdviceKind::Closer, row: i, text })
}

/// The cheapest setting that displays every number correctly.
fn cheapest_correct(report: &PrecisionResults, own_row: Option<usize>, i: usize) -> Advice {
    let (rows, every) = (&report.rows, every(report));
    let text = match own_row {
        Some(own_row) if i == own_row => {
            format!("It is also the cheapest tested setting that shows {every} correctly.")
        }
        own_row => {
            let time = own_row.map_or(String::new(), |own_row| {
                format!(" and takes {}", relative_work(&rows[i], &rows[own_row]))
            });
            format!("The cheapest tested setting that shows {every} correctly is {}{time}.", name(&rows[i]))
        }
    };
    Advice { kind: AdviceKind::Right, row: i, text }
}

/// The most accurate setting, if none displays every number correctly, or if that is unknown.
fn closest(report: &PrecisionResults, usable: &[usize]) -> Option<Advice> {
    let (rows, every) = (&report.rows, every(report));
    let i = usable.iter().copied().min_by(|&a, &b| rows[a].score.total_cmp(&rows[b].score))?;
    // Wrong, even if the error of the reference is taken into account.
    let wrong = |row: &PrecisionRow| {
        report.targets.iter().zip(&row.errors).any(|(t, e)| t.is_compared() && e.seen[1] > 1.0)
    };
    let doubtful = report.targets.iter().zip(&rows[i].errors).find(|(t, e)| {
        let [most, least] = e.seen;
        t.is_compared() && most > 1.0 && least <= 1.0
    });
    let text = match doubtful {
        Some((target, _)) if !usable.iter().all(|&i| wrong(&rows[i])) => format!(
            "It is unknown whether a tested setting shows {every} correctly: the reference of \"{}\" may be off by {}, and {} would be visible; the most accurate is {}.",
            target.label,
            with_unit(target.uncertainty, target),
            with_unit(target.invisible_error, target),
            name(&rows[i])
        ),
        _ => format!("No tested setting shows {every} correctly; the most accurate is {}.", name(&rows[i])),
    };
    Some(Advice { kind: AdviceKind::Closest, row: i, text })
}

/// The meaning of "every number" in this comparison.
fn every(report: &PrecisionResults) -> String {
    let again = |o: &&OmittedNumber| o.reason != REPEATED_NUMBER;
    let compared = report.targets.iter().filter(|t| t.is_compared());
    let until = compared.filter_map(|t| t.until).reduce(f64::min);
    let some = report.omitted.iter().any(|o| again(&o)) || report.targets.iter().any(|t| !t.is_compared());
    match until {
        Some(t) => format!("every compared number (until {} s)", labspec::run::time(t)),
        None if some => "every compared number".to_string(),
        None => "every number".to_string(),
    }
}

fn name(row: &PrecisionRow) -> String {
    let solver = row.setting.solver.map_or(String::new(), |s| format!(" with {}", s.name()));
    format!("{} at {} ms{solver}", row.setting.integrator.name, milliseconds(row.setting.timestep))
}

/// The work of a run relative to that of the lab's own setting.
fn relative_work(row: &PrecisionRow, own_row: &PrecisionRow) -> String {
    let ratio = row.cost.work / own_row.cost.work;
    match ratio {
        r if !r.is_finite() => "work that was not counted".into(),
        r if (1.0 / EQUAL_WORK..=EQUAL_WORK).contains(&r) => "the same work".into(),
        r => format!("{} times the work", two_digits(r)),
    }
}

/// The error of the lab's own setting.
fn describe_own_error(report: &PrecisionResults, own_row: usize) -> String {
    let row = &report.rows[own_row];
    let name = name(row);
    if !matches!(row.status, RunStatus::Good | RunStatus::Warned) {
        let why = row.reported.first().map_or(String::new(), |t| format!(": {t}"));
        return format!(
            "With the settings of the lab, {name}, the run is not usable ({}{why}).",
            row.status.word()
        );
    }
    let compared = report.targets.iter().zip(&row.errors).filter(|(t, _)| t.is_compared());
    if compared.clone().next().is_none() {
        return format!("With the settings of the lab, {name}, nothing could be compared.");
    }
    if let Some((target, _)) = compared.clone().find(|(_, e)| e.largest.is_nan()) {
        return format!("With the settings of the lab, {name}, \"{}\" is not always a number.", target.label);
    }
    let above = compared.filter(|(_, e)| !e.below);
    let Some((target, e)) = above.max_by(|(_, a), (_, b)| a.seen[0].total_cmp(&b.seen[0])) else {
        return format!(
            "With the settings of the lab, {name}, {} is as exact as the reference.",
            every(report)
        );
    };
    let [most, least] = e.seen;
    let samples = || format!("at {} of {} samples", e.wrong, e.samples);
    let seen = match (least > 1.0, target.readout) {
        _ if most <= 1.0 => "not visible".to_string(),
        (false, _) => {
            format!("within {}, the error of the reference", with_unit(target.uncertainty, target))
        }
        (true, true) => format!("visible in its digits {}", samples()),
        (true, false) => {
            format!(
                "visible in its plot {} (an error below {} is not)",
                samples(),
                with_unit(target.invisible_error, target)
            )
        }
    };
    let how = format!("up to {} at {} s", with_unit(e.largest, target), labspec::run::time(e.time));
    format!("With the settings of the lab, {name}, \"{}\" is off by {how}, {seen}.", target.label)
}

/// A number with the unit of the compared quantity.
fn with_unit(x: f64, target: &Compared) -> String {
    match &target.unit {
        Some(unit) => format!("{} {unit}", two_digits(x)),
        None => two_digits(x),
    }
}
