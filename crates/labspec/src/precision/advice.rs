//! What the numbers come to: which settings nobody should take, as another is both closer and cheaper, and which one to take.

use super::{Report, Row, milliseconds};
use crate::run::two_digits;

/// Whether a row came to its end and is compared.
fn counts(row: &Row) -> bool {
    row.fate == super::Fate::Good && row.score.is_finite()
}

/// The error that can be counted on, in times of what nobody sees: the largest of this step and all shorter ones of the same
/// method. That a step happens to meet an impact well is no merit.
fn reliable(rows: &[Row], i: usize) -> f64 {
    let mine = rows[i].setting;
    let shorter = |r: &&Row| {
        r.setting.integrator == mine.integrator
            && r.setting.solver.is_none()
            && r.setting.timestep < mine.timestep
    };
    let others = rows.iter().filter(shorter).map(|r| if counts(r) { r.score } else { f64::INFINITY });
    if mine.solver.is_some() { rows[i].score } else { others.fold(rows[i].score, f64::max) }
}

/// The settings that no other beats in both, from the cheapest to the closest.
pub(super) fn front(rows: &[Row]) -> Vec<usize> {
    let mut order: Vec<usize> = (0..rows.len()).filter(|&i| counts(&rows[i])).collect();
    order.sort_by(|&a, &b| {
        let key = |i: usize| (rows[i].cost.median, reliable(rows, i));
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

/// A sentence about what to take, with the row that it is about.
#[derive(Clone, Debug, PartialEq)]
pub struct Advice {
    /// The row.
    pub row: usize,
    /// The sentence.
    pub text: String,
}

/// As far as timings repeat: less is no difference.
const NO_LONGER: f64 = 1.05;

/// What the lab's own setting costs in error, what is closer for the same time, and the cheapest that shows every digit rightly.
/// Only what a page can use is advised.
pub(super) fn advise(report: &Report) -> Vec<Advice> {
    let rows = &report.rows;
    let mut list = Vec::new();
    let usable = |i: &usize| rows[*i].setting.integrator.shared && counts(&rows[*i]);
    let mine = rows.iter().position(|r| r.own);
    if let Some(own) = mine {
        list.push(Advice { row: own, text: about_own(report, own) });
        let closest = (0..rows.len())
            .filter(usable)
            .filter(|&i| rows[i].cost.median <= NO_LONGER * rows[own].cost.median)
            .min_by(|&a, &b| reliable(rows, a).total_cmp(&reliable(rows, b)));
        if let Some(i) = closest
            && rows[own].score > 2.0 * reliable(rows, i)
            && counts(&rows[own])
        {
            let times = rows[own].score / reliable(rows, i).max(f64::MIN_POSITIVE);
            let how = if reliable(rows, i) == 0.0 || times > 1e12 {
                "right to rounding".to_string()
            } else {
                format!("{} times closer", two_digits(times))
            };
            let text = format!("{} is {how} and takes {}.", name(&rows[i]), beside(&rows[i], &rows[own]));
            list.push(Advice { row: i, text });
        }
    }
    let good = (0..rows.len()).filter(usable).filter(|&i| reliable(rows, i) <= 1.0);
    let cheapest = good.min_by(|&a, &b| rows[a].cost.median.total_cmp(&rows[b].cost.median));
    let text = match (cheapest, mine) {
        (Some(i), Some(own)) if i == own => {
            Some((i, "It is also the cheapest setting tried that shows every number rightly.".to_string()))
        }
        (Some(i), own) => {
            let time =
                own.map_or(String::new(), |own| format!(" and takes {}", beside(&rows[i], &rows[own])));
            Some((
                i,
                format!(
                    "The cheapest setting tried that shows every number rightly is {}{time}.",
                    name(&rows[i])
                ),
            ))
        }
        (None, _) => {
            (0..rows.len()).filter(usable).min_by(|&a, &b| rows[a].score.total_cmp(&rows[b].score)).map(|i| {
                (
                    i,
                    format!(
                        "No setting tried shows every number rightly; the closest is {}.",
                        name(&rows[i])
                    ),
                )
            })
        }
    };
    list.extend(text.map(|(row, text)| Advice { row, text }));
    list
}

fn name(row: &Row) -> String {
    let solver = row.setting.solver.map_or(String::new(), |s| format!(" with {}", s.name()));
    format!("{} at {} ms{solver}", row.setting.integrator.name, milliseconds(row.setting.timestep))
}

/// The time of a run beside another's.
fn beside(row: &Row, own: &Row) -> String {
    let ratio = row.cost.median / own.cost.median;
    match ratio {
        r if !r.is_finite() => "a time that was not measured".into(),
        r if (1.0 / NO_LONGER..=NO_LONGER).contains(&r) => "the same time".into(),
        r => format!("{} times the time", two_digits(r)),
    }
}

/// What the lab's own setting is off by.
fn about_own(report: &Report, own: usize) -> String {
    let row = &report.rows[own];
    let name = name(row);
    if !matches!(row.fate, super::Fate::Good | super::Fate::Warned) {
        let why = row.told.first().map_or(String::new(), |t| format!(": {t}"));
        return format!("As the lab has it, {name}, the run is no good ({}{why}).", row.fate.word());
    }
    let known = report.targets.iter().zip(&row.errors).filter(|(_, e)| e.largest.is_finite());
    let worst = known.max_by(|(s, a), (t, b)| (s.counts(a) / s.unseen).total_cmp(&(t.counts(b) / t.unseen)));
    let Some((target, e)) = worst else {
        return format!("As the lab has it, {name}: nothing could be compared.");
    };
    if e.below {
        return format!("As the lab has it, {name}, every number is as exact as the reference.");
    }
    let seen = match (target.counts(e) > target.unseen, target.readout) {
        (false, _) => "which nobody sees".to_string(),
        (true, true) => format!("which its digits show ({} would not)", two_digits(target.unseen)),
        (true, false) => format!("which its plot shows ({} would not)", two_digits(target.unseen)),
    };
    let how = match target.readout {
        true => format!("{} at the end", two_digits(e.end)),
        false => format!("up to {} at {} s", two_digits(e.largest), crate::run::time(e.at)),
    };
    format!("As the lab has it, {name}, \"{}\" is off by {how}, {seen}.", target.label)
}
