//! A lab that never comes to the time at which it is to stop.

use super::ObservedLab;
use crate::check::setconst::digits;
use crate::finding::Finding;
use crate::rules;

pub(super) fn check_stop_reached(observed: &ObservedLab<'_>, findings: &mut Vec<Finding>) {
    let Some(stop) = &observed.bench.ready.lab.stop_at else { return };
    let Some((_, timestep)) = observed.bench.steps(observed.length) else { return };
    // As it stands; the run was long enough if time had gone on.
    let Some(nominal) =
        observed.records.first().filter(|r| r.moved.is_none() && observed.length >= stop.value)
    else {
        return;
    };
    let times = || nominal.rows.iter().filter_map(|row| row.first()).map(|cell| cell.number());
    let last = times().fold(f64::NEG_INFINITY, f64::max);
    let back = times().zip(times().skip(1)).find(|(a, b)| b < a);
    let (Some((before, after)), true) = (back, last < stop.value - 1.5 * timestep) else { return };
    let [stop_at, last, before, after] = [stop.value, last, before, after].map(|x| digits(x, 4));
    findings.push(
        Finding::warning(
            rules::STOP_UNREACHED,
            stop.span.clone(),
            format!("the lab never reaches {stop_at} s"),
        )
        .why(format!("in the run, time goes from {before} s back to {after} s, and never exceeds {last} s"))
        .help("find what resets the simulation while it runs, or stop earlier"),
    );
}
