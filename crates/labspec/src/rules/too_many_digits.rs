use crate::check::observations::ObservedLab;
use crate::check::setconst::digits;
use crate::run::{self, Cell, Play, StepVariant};
use crate::spec::Readout;
use labspec_core::reflect::option;
use labspec_expr::Effects;
use labspec_finding::{Example, Finding, Layer, Rule, Severity};
use std::ops::ControlFlow;

/// A readout prints more decimals than the integration supports.
pub const TOO_MANY_DIGITS: &Rule = &Rule {
    code: "too-many-digits",
    severity: Severity::Note,
    exceptions: &[],
    layer: Layer::Run,
    summary: "a readout prints more decimals than the integration supports",
    why: "two or more decimals depend on the timestep: a student compares them with a formula, and takes the difference for physics",
    bad: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><body name='ball' pos='0 0 1'><freejoint/><geom name='ball' size='.05' mass='1'/></body></worldbody></mujoco>", "stopAt": 0.4, "readouts": [{"label": "height (m)", "expr": "⟦data.qpos[2]⟧", "digits": 6}]}"#,
    ),
    good: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><body name='ball' pos='0 0 1'><freejoint/><geom name='ball' size='.05' mass='1'/></body></worldbody></mujoco>", "stopAt": 0.4, "readouts": [{"label": "height (m)", "expr": "data.qpos[2]", "digits": 3}]}"#,
    ),
};

/// The number of times at which a readout is observed.
const OBSERVATIONS: usize = 10;
/// Two decimals too many: the other run differs by at least this many units of the last decimal, at most of the observations.
const UNITS: f64 = 100.0;
/// The number of steps of the runs.
const STEPS: usize = 5000;

const HALF_TIMESTEP: StepVariant = StepVariant { timestep: 0.5, ..StepVariant::NOMINAL };

pub(crate) fn check_surplus_digits(observed: &mut ObservedLab<'_>, findings: &mut Vec<Finding>) {
    let ready = observed.bench.ready;
    let of_timestep = |e: &Effects| {
        let timestep = option::timestep.index();
        e.reads_everything || e.reads.iter().chain(&e.writes).any(|a| a.field.0 as usize == timestep)
    };
    // If a text reads the timestep, its effect on the numbers is the lesson.
    if ready.lab.readouts.is_empty() || ready.programs.bound().any(|b| of_timestep(b.program.effects())) {
        return;
    }
    let Some((steps, _)) =
        observed.bench.steps(observed.length).filter(|(n, _)| (OBSERVATIONS..=STEPS).contains(n))
    else {
        return;
    };
    let (Some(nominal), Some(fine)) = (samples(observed, steps, 1), samples(observed, steps, 2)) else {
        return;
    };
    let first = 1 + ready.lab.traces().count();
    for (i, readout) in ready.lab.readouts.iter().enumerate() {
        let last = 10f64.powi(-(readout.digits() as i32));
        let differs = |(a, b): &(&Vec<Cell>, &Vec<Cell>)| {
            let number_in = |row: &Vec<Cell>| row.get(first + i).map_or(f64::NAN, Cell::number);
            (number_in(a) - number_in(b)).abs() / last
        };
        let mut differences: Vec<f64> = nominal.iter().zip(&fine).map(|pair| differs(&pair)).collect();
        if differences.iter().any(|x| !x.is_finite()) {
            continue;
        }
        differences.sort_by(f64::total_cmp);
        let middle = differences.get(differences.len() / 2).copied().unwrap_or(0.0);
        let good = readout.digits() as i32 - middle.max(1.0).log10().floor() as i32;
        if middle < UNITS || good < 0 {
            continue;
        }
        let last = |rows: &[Vec<Cell>]| rows.last().and_then(|row| row.get(first + i)).cloned();
        let (Some(coarse), Some(halved)) = (last(&nominal), last(&fine)) else { continue };
        let time = nominal.last().and_then(|row| row.first()).map_or(0.0, Cell::number);
        let pairs =
            || nominal.iter().zip(&fine).filter_map(|(a, b)| Some((a.get(first + i)?, b.get(first + i)?)));
        // The advice is tried: with it, the quoted numbers are the same, and most of the others.
        let same = |(a, b): (&Cell, &Cell), n: u32| a.rounded(n) == b.rounded(n);
        let holds = |n: &u32| {
            same((&coarse, &halved), *n)
                && 2 * pairs().filter(|pair| same(*pair, *n)).count() >= pairs().count()
        };
        let supported = (0..=u32::try_from(good).unwrap_or(0)).rev().find(holds);
        findings.push(surplus(readout, supported).why(format!(
            "at t = {} s it is {}, but {} in the same run at half the timestep",
            digits(time, 4),
            coarse.rounded(readout.digits()),
            halved.rounded(readout.digits())
        )));
    }
}

/// The finding for a readout, of whose decimals the integration supports so many, or none.
fn surplus(readout: &Readout, supported: Option<u32>) -> Finding {
    let all_but = supported.map_or("all of them".into(), |n| format!("all but {n}"));
    let message = format!("{} decimals are printed, but {all_but} depend on the timestep", readout.digits());
    let advice = supported.map_or(String::new(), |n| format!("write \"digits\": {n}, or "));
    Finding::new(TOO_MANY_DIGITS, readout.expr.span(), message)
        .help(format!("{advice}use a shorter timestep; `labspec precision` shows how short"))
}

/// The displayed values of a run at a few times, with the timestep divided by `parts`.
fn samples(observed: &mut ObservedLab<'_>, steps: usize, parts: usize) -> Option<Vec<Vec<Cell>>> {
    let mut session = observed.bench.start();
    if parts > 1 {
        session.perturb(HALF_TIMESTEP, false);
    }
    let mut rows = Vec::new();
    run::play(&mut session, &Play::steps(parts * steps), |session, step| {
        if step > 0 && step % (parts * (steps / OBSERVATIONS)) == 0 {
            rows.push(session.sample());
        }
        ControlFlow::Continue(())
    });
    let (spent, completed) = (session.spent(), session.ended().is_none());
    drop(session);
    observed.bench.left = observed.bench.left.saturating_sub(spent);
    (completed && observed.bench.left > 0).then_some(rows)
}
