//! Work and precision: how far each integrator and timestep is from the truth, and what it costs.
//!
//! The truth is the closed form that the author gives (`exact` in the lab's `verify`), otherwise what two families of methods
//! agree on (`reference.rs`). Reporting error against cost, not against the step, is the method of Hairer, Nørsett
//! and Wanner 1993, *Solving Ordinary Differential Equations I*, section II.10.

mod advice;
mod beside;
mod case;
mod cost;
mod judge;
mod reference;
mod setting;

pub use advice::{Advice, Kind};
pub use beside::{Beside, BesideRow, Recording};
pub use case::{Fate, LeftOut};
pub use cost::Cost;
pub use judge::{Compared, Errors};
pub use setting::{Axis, INTEGRATORS, Integrator, Setting, Solver};

use crate::bind::Programs;
use crate::finding::Finding;
use crate::interrupt;
use crate::run::{self, RunError};
use crate::spec::Lab;
use crate::spec::format::RUN_LENGTH;
use case::{Case, Run};
use labspec_core::{Model, integrator};
use labspec_expr::Value;

/// Timesteps, as multiples of the lab's own; each divides the first.
const STEPS: [f64; 6] = [4.0, 2.0, 1.0, 0.5, 0.25, 0.125];
/// Samples at which the truth is known, at most.
const MOST_SAMPLES: usize = 40_000;
/// A scene keeps energy or momentum where the reference changes it by less than this part of its size.
const KEPT: f64 = 1e-7;
/// How far apart nearby starts are, and the part of its range by which a number has left the other.
const NUDGE: f64 = 1e-9;
const LEFT: f64 = 0.01;

/// What is compared, and how the lab is handled meanwhile.
#[derive(Clone, Debug, Default)]
pub struct Options {
    /// Length in s; the lab's `stopAt`, or 2, without it.
    pub until: Option<f64>,
    /// Controls by label, and what they are set to before the first step.
    pub set: Vec<(String, Value)>,
    /// Buttons by label, and the times of their presses, s.
    pub press: Vec<(String, f64)>,
    /// The integrators; MuJoCo's, where none is named.
    pub integrators: Vec<Integrator>,
    /// Settings of the solver that are varied, at the lab's own integrator and timestep.
    pub axes: Vec<Axis>,
    /// Another program's runs of the same lab.
    pub beside: Option<Recording>,
}

/// One setting.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    /// What was run.
    pub setting: Setting,
    /// Whether it is the lab's own.
    pub own: bool,
    /// How far each number is from the truth.
    pub errors: Vec<Errors>,
    /// How far each event is from its time, s; NaN where it is not known.
    pub events: Vec<f64>,
    /// The largest change of energy, J, where the scene keeps it.
    pub energy: Option<f64>,
    /// The largest change of momentum, where the scene keeps it: of motion, kg m/s, and of turning, kg m²/s.
    pub momentum: [Option<f64>; 2],
    /// How deep bodies were in each other at most, m.
    pub penetration: f64,
    /// What it costs.
    pub cost: Cost,
    /// What became of the run.
    pub fate: Fate,
    /// What was told about it.
    pub told: Vec<String>,
    /// The largest error that is possible, as the reference is in doubt, too; in times of what nobody sees. NaN where nothing is
    /// known.
    pub score: f64,
}

/// Something that happens in a run.
#[derive(Clone, Debug, PartialEq)]
pub struct Event {
    /// In words.
    pub name: String,
    /// When, s.
    pub time: f64,
    /// How far that may be off, s.
    pub uncertain: f64,
}

/// Two starts that nobody could tell apart.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Nearby {
    /// How far apart they are, in the unit of each coordinate.
    pub apart: f64,
    /// Until when they show the same to a hundredth of every range, s; `None` where they do to the end.
    pub until: Option<f64>,
}

/// All runs of a lab.
#[derive(Clone, Debug, PartialEq)]
pub struct Report {
    /// What is compared.
    pub targets: Vec<Compared>,
    /// What is not, and why.
    pub left_out: Vec<LeftOut>,
    /// The reference, in words; `None` where no method comes through the lab.
    pub reference: Option<String>,
    /// Length of the runs, s.
    pub length: f64,
    /// Number of samples of the reference, without that of the start. A run is compared at those that its steps meet: after each of
    /// its steps, unless these are shorter.
    pub samples: usize,
    /// The runs: by integrator, from large to small timesteps; then the solver's.
    pub rows: Vec<Row>,
    /// What happens in the reference, in the order of the rows' `events`.
    pub events: Vec<Event>,
    /// Energy that the scene keeps, with the size of what moves, J.
    pub energy: Option<f64>,
    /// Momentum that it keeps, with its size: of motion, and of turning.
    pub momentum: [Option<f64>; 2],
    /// How deep bodies are in each other in the reference, m.
    pub penetration: f64,
    /// How long nearby starts stay together, where the reference is lost before the end.
    pub nearby: Option<Nearby>,
    /// Rows that no other beats in both, from the cheapest to the closest.
    pub front: Vec<usize>,
    /// What to take.
    pub advice: Vec<Advice>,
    /// Another program's runs, where they were given.
    pub beside: Option<Beside>,
}

/// A time in milliseconds, for people.
pub(crate) fn milliseconds(seconds: f64) -> String {
    crate::verify::significant(1e3 * seconds)
}

/// Runs the lab with every setting. `tell` hears what is being done.
///
/// # Errors
/// The lab shows no numbers to compare, sets its timestep itself while it runs, cannot be handled as asked, or the runs would take
/// too many steps. Mistakes in closed forms go to `findings`.
pub fn compare(
    lab: &Lab,
    model: &Model,
    programs: &Programs,
    options: &Options,
    findings: &mut Vec<Finding>,
    tell: &mut dyn FnMut(&str),
) -> Result<Report, RunError> {
    let mut case = Case::new(lab, model, programs, &options.set, findings);
    if case.targets.is_empty() {
        let why = match case.left_out.first() {
            Some(out) => {
                format!(": \"{}\" is left out, as {}", crate::printable::printable(&out.label), out.reason)
            }
            None => "; add a plot with a trace, or a readout".to_string(),
        };
        return Err(RunError(format!("this lab shows no numbers to compare{why}")));
    }
    case.presses = run::presses(programs, &options.press)?;
    if let Some(who) = case.steps_itself() {
        return Err(RunError(format!(
            "{} sets the timestep while the lab runs, so that no other can be tried",
            crate::printable::printable(&who)
        )));
    }
    let (own, own_integrator) = {
        let session = case.start(None)?;
        (session.world.model.opt.timestep, Integrator::of(&session.world.model))
    };
    let length = options.until.or(lab.stop_at.as_ref().map(|s| s.value)).unwrap_or(RUN_LENGTH);
    // Of a length that every step divides; a short run begins with shorter ones.
    run::count_steps(lab, Some(length), None, own)?;
    let longest = STEPS.into_iter().find(|s| length >= 8.0 * own * s || *s == 1.0).unwrap_or(1.0);
    let ladder: Vec<f64> = STEPS.into_iter().filter(|s| *s <= longest).map(|s| s * own).collect();
    let coarse = own * longest;
    let count = run::count_steps(lab, Some(length), None, coarse)?.max(1);
    if count as f64 * (longest / STEPS[5]) > run::MAX_STEPS as f64 {
        return Err(RunError("the runs would take too many steps; shorten them with --until".into()));
    }
    // Where all timesteps meet: a press between would come at another time in each run.
    for (_, time) in &mut case.presses {
        *time = (*time / coarse - 1e-9).ceil().max(0.0) * coarse;
    }
    run::presses_within(programs, &case.presses, count, coarse)?;

    tell("the reference");
    let mut truth = None;
    for samples in samplings(count, longest, own) {
        (case.interval, case.count) = samples;
        truth = reference::reference(&case, own)?;
        if truth.is_some() || interrupt::requested() {
            break;
        }
    }
    let settings = settings(options, own_integrator, own, &ladder);
    let Some(truth) = truth else { return without_reference(case, &settings, own, own_integrator) };
    // What a student sees decides how large a plot is.
    let mine = case.run(&Setting { integrator: own_integrator, timestep: own, solver: None }, 0.0, false)?;
    let targets = judge::compared(&case, &truth, &mine);
    let blank = targets.iter().filter(|t| t.blank);
    case.left_out
        .extend(blank.map(|t| LeftOut { label: t.label.clone(), reason: "it is no number at the start" }));
    let kept = Kept::of(&truth.run);
    let mut rows = Vec::new();
    for (i, setting) in settings.iter().enumerate() {
        if interrupt::requested() {
            break;
        }
        tell(&format!("setting {} of {}: {}", i + 1, settings.len(), setting.integrator.name));
        let run = case.run(setting, 0.0, false)?;
        let errors = judge::errors(&case, &truth, &targets, &run, setting.timestep);
        let score = match run.fate {
            Fate::Good | Fate::Warned => score(&targets, &errors),
            _ => f64::NAN,
        };
        let events = run.events.iter().zip(&truth.run.events).map(|(a, b)| (a - b).abs()).collect();
        rows.push(Row {
            setting: *setting,
            own: is_own(setting, own, own_integrator),
            errors,
            events,
            energy: kept.energy.map(|_| change(&run.energy)),
            momentum: [0, 1].map(|k| kept.momentum[k].map(|_| kept.change(&run, k))),
            penetration: run.penetration,
            cost: Cost { median: f64::NAN, low: f64::NAN, high: f64::NAN, work: run.work },
            fate: run.fate,
            told: run.told,
            score,
        });
    }
    observe_orders(&mut rows, &targets);
    let timed: Vec<Option<Setting>> =
        rows.iter().map(|r| (r.fate != Fate::Stopped).then_some(r.setting)).collect();
    tell("run times");
    for (row, [median, low, high]) in rows.iter_mut().zip(cost::measure(&case, &timed)) {
        (row.cost.median, row.cost.low, row.cost.high) = (median, low, high);
    }
    let nearby = match targets.iter().any(|t| t.until.is_some()) {
        true => Some(nearby(&case, &targets, own)?),
        false => None,
    };
    let beside = options.beside.as_ref().map(|r| r.judge(&case, &truth, &targets)).transpose()?;
    let mut report = Report {
        events: events(&case, &truth, own),
        left_out: case.left_out,
        reference: Some(truth.how),
        length: case.count as f64 * case.interval,
        samples: case.count,
        beside,
        energy: kept.energy,
        momentum: kept.momentum,
        penetration: truth.run.penetration,
        targets,
        rows,
        nearby,
        front: Vec::new(),
        advice: Vec::new(),
    };
    // Of what has no moment nothing is off.
    for (k, event) in report.events.iter().enumerate().filter(|(_, e)| e.time.is_nan()) {
        report.rows.iter_mut().filter_map(|r| r.events.get_mut(k)).for_each(|off| *off = event.time);
    }
    report.front = advice::front(&report.rows);
    report.advice = advice::advise(&report);
    Ok(report)
}

/// Times between samples of the truth, s, and their numbers. First as short as the shortest step, so that each run is compared after
/// every step of its own; longer ones follow, for labs that last too long for that or whose truth takes too much work.
fn samplings(count: usize, longest: f64, own: f64) -> impl Iterator<Item = (f64, usize)> {
    let number = move |step: f64| count * (longest / step) as usize;
    let few = move |step: &f64| number(*step) <= MOST_SAMPLES || *step == longest;
    let mut steps: Vec<f64> = STEPS.into_iter().rev().filter(|s| *s <= longest).filter(few).collect();
    // The truth takes no longer steps than the lab.
    let useful = steps.iter().filter(|s| **s <= 1.0).count().max(1);
    steps.truncate(useful);
    steps.into_iter().map(move |step| {
        let stride = number(step).div_ceil(MOST_SAMPLES).max(1);
        (own * step * stride as f64, number(step).div_ceil(stride))
    })
}

fn is_own(setting: &Setting, own: f64, integrator: Integrator) -> bool {
    setting.solver.is_none() && setting.integrator == integrator && setting.timestep == own
}

/// The settings that are compared: each integrator over the ladder, then the solver at the lab's own.
fn settings(options: &Options, integrator: Integrator, own: f64, ladder: &[f64]) -> Vec<Setting> {
    let named = match options.integrators.as_slice() {
        [] => INTEGRATORS.into_iter().filter(|i| i.shared).collect(),
        some => some.to_vec(),
    };
    let steps = |integrator: Integrator| {
        ladder.iter().map(move |&timestep| Setting { integrator, timestep, solver: None })
    };
    let mut list: Vec<Setting> = named.into_iter().flat_map(steps).collect();
    let mine = Setting { integrator, timestep: own, solver: None };
    if !list.contains(&mine) {
        list.push(mine);
    }
    let solver = |s: Solver| Setting { solver: Some(s), ..mine };
    list.extend(options.axes.iter().flat_map(|axis| axis.values()).map(solver));
    list
}

/// The report of a lab that no method comes through: what became of each setting, and nothing else.
fn without_reference(
    case: Case<'_>,
    settings: &[Setting],
    own: f64,
    integrator: Integrator,
) -> Result<Report, RunError> {
    let mut rows = Vec::new();
    for setting in settings {
        let run = case.run(setting, 0.0, false)?;
        rows.push(Row {
            setting: *setting,
            own: is_own(setting, own, integrator),
            errors: Vec::new(),
            events: Vec::new(),
            energy: None,
            momentum: [None; 2],
            penetration: run.penetration,
            cost: Cost { median: f64::NAN, low: f64::NAN, high: f64::NAN, work: run.work },
            fate: run.fate,
            told: run.told,
            score: f64::NAN,
        });
    }
    Ok(Report {
        targets: Vec::new(),
        left_out: case.left_out,
        reference: None,
        length: case.count as f64 * case.interval,
        samples: case.count,
        beside: None,
        rows,
        events: Vec::new(),
        energy: None,
        momentum: [None; 2],
        penetration: f64::NAN,
        nearby: None,
        front: Vec::new(),
        advice: Vec::new(),
    })
}

/// What the scene keeps, as the reference shows it, with its size.
struct Kept {
    energy: Option<f64>,
    momentum: [Option<f64>; 2],
}

impl Kept {
    fn of(run: &Run) -> Kept {
        let moves = run.kinetic > 0.0;
        let energy = (moves && change(&run.energy) <= KEPT * run.kinetic).then_some(run.kinetic);
        let none = Kept { energy: None, momentum: [None; 2] };
        let momentum = [0, 1].map(|k| {
            let size = run.momentum.iter().map(|p| length(&p[3 * k..3 * k + 3])).fold(0.0, f64::max);
            (size > 1e-9 && none.change(run, k) <= KEPT * size).then_some(size)
        });
        Kept { energy, momentum }
    }

    /// The largest change of momentum from the start on: of motion (0) or of turning (1).
    fn change(&self, run: &Run, k: usize) -> f64 {
        let Some(start) = run.momentum.first() else { return f64::NAN };
        let apart = |p: &[f64; 6]| {
            let d: [f64; 3] = std::array::from_fn(|i| p[3 * k + i] - start[3 * k + i]);
            length(&d)
        };
        largest(run.momentum.iter().map(apart))
    }
}

fn length(v: &[f64]) -> f64 {
    v.iter().map(|x| x * x).sum::<f64>().sqrt()
}

/// The largest change of a quantity from the start on; NaN where it is not known.
fn change(values: &[f64]) -> f64 {
    values.first().map_or(f64::NAN, |start| largest(values.iter().map(|x| (x - start).abs())))
}

/// The largest; NaN where one is.
fn largest(values: impl Iterator<Item = f64>) -> f64 {
    values.fold(0.0, |a: f64, x| if x.is_nan() || a.is_nan() { f64::NAN } else { a.max(x) })
}

fn score(targets: &[Compared], errors: &[Errors]) -> f64 {
    let known = targets.iter().zip(errors).filter(|(t, _)| t.is_compared());
    known.map(|(t, e)| t.in_sight(e)[0]).reduce(f64::max).unwrap_or(f64::NAN)
}

/// Orders from a run to the one with the next shorter timestep.
fn observe_orders(rows: &mut [Row], targets: &[Compared]) {
    for i in 1..rows.len() {
        let (before, rest) = rows.split_at_mut(i);
        let (Some(coarse), Some(fine)) = (before.last(), rest.first_mut()) else { continue };
        let (a, b) = (coarse.setting, fine.setting);
        let same = a.integrator == b.integrator && a.solver.is_none() && b.solver.is_none();
        if same && a.timestep > b.timestep && [coarse.fate, fine.fate] == [Fate::Good; 2] {
            for ((c, f), target) in coarse.errors.iter().zip(&mut fine.errors).zip(targets) {
                f.order = judge::order(c, f, a.timestep / b.timestep, target.uncertain);
            }
        }
    }
}

fn events(case: &Case<'_>, truth: &reference::Reference, own: f64) -> Vec<Event> {
    // What touches within the first step touched before it.
    let from_start = truth.run.events.first().is_some_and(|t| *t <= own);
    let contact = if from_start { "bodies touch from the start" } else { "first contact" };
    let names = std::iter::once(contact.to_string())
        .chain(case.targets.iter().map(|t| format!("\"{}\" passes through zero", t.label)));
    let times = truth.run.events.iter().zip(&truth.unsure_of_events);
    let events = names.zip(times).enumerate();
    let no_moment = |i: usize, x: f64| if i == 0 && from_start { f64::NAN } else { x };
    events
        .map(|(i, (name, (&time, &uncertain)))| Event {
            name,
            time: no_moment(i, time),
            uncertain: no_moment(i, uncertain),
        })
        .collect()
}

/// How long two starts that nobody could tell apart show the same.
fn nearby(case: &Case<'_>, targets: &[Compared], own: f64) -> Result<Nearby, RunError> {
    let method = INTEGRATORS.into_iter().find(|i| i.id == integrator::RKMK8).unwrap_or(INTEGRATORS[0]);
    let setting = Setting { integrator: method, timestep: own / 2.0, solver: None };
    let (one, other) = (case.run(&setting, 0.0, true)?, case.run(&setting, NUDGE, true)?);
    let leaves = |((a, b), target): ((&Vec<f64>, &Vec<f64>), &Compared)| {
        let far = LEFT * target.range;
        // Not to be told apart is less than the part, and no number is far from every other.
        a.iter().zip(b).position(|(a, b)| (a - b).abs() > far || (a - b).is_nan())
    };
    let first = one.values.iter().zip(&other.values).zip(targets).filter_map(leaves).min();
    let apart = case.rhythm(setting.timestep).stride as f64 * case.interval;
    Ok(Nearby { apart: NUDGE, until: first.map(|i| i as f64 * apart) })
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        /// All steps of a comparison meet all samples of its truth, or all of its samples.
        #[test]
        fn steps_meet_the_samples(count in 1usize..3_000_000, longest in prop::sample::select(&STEPS[..3]), own in 1e-5..0.1f64) {
            let mut before = 0.0;
            for (interval, number) in samplings(count, longest, own) {
                prop_assert!(interval > before && (1..=MOST_SAMPLES).contains(&number));
                prop_assert!(interval * number as f64 >= 0.999_999 * own * longest * count as f64);
                for step in STEPS.into_iter().filter(|s| *s <= longest) {
                    let ratio = (own * step / interval).max(interval / (own * step));
                    prop_assert!((ratio - ratio.round()).abs() < 1e-9, "{interval} {step}");
                }
                before = interval;
            }
            prop_assert!(before > 0.0);
        }
    }
}
