//! Work and precision: how far each integrator and timestep is from the truth, and what it costs.
//!
//! The truth is the closed form that the author gives (`exact` in the lab's `verify`), otherwise what two families of methods
//! agree on (`reference.rs`). Reporting error against cost, not against the step, is the method of Hairer, Nørsett
//! and Wanner 1993, *Solving Ordinary Differential Equations I*, section II.10.

mod advice;
mod bench;
mod beside;
mod case;
mod chebyshev;
mod cost;
mod events;
mod extrapolation;
mod judge;
mod jumps;
mod kept;
mod ladder;
mod moments;
mod orders;
mod reference;
mod setting;

pub use advice::{Advice, Kind};
pub use beside::{Beside, BesideRow, Recording};
pub use case::{Fate, LeftOut};
pub use cost::Cost;
pub use events::{Event, Nearby};
pub use judge::{Compared, Errors};
pub use setting::{Axis, INTEGRATORS, Integrator, Setting, Solver};

use crate::bind::Programs;
use crate::finding::Finding;
use crate::interrupt;
use crate::run::{self, RunError};
use crate::spec::Lab;
use crate::spec::format::RUN_LENGTH;
use case::{Ask, PrecisionCase};
use kept::{Kept, change};
use labspec_core::Model;
use labspec_expr::Value;
use ladder::Ladder;
use reference::Reference;

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
    /// How far each event is from its time, s: never below what that may be off; NaN where it is not known.
    pub events: Vec<f64>,
    /// The largest change of energy, J, where the scene keeps it.
    pub energy: Option<f64>,
    /// The largest change of momentum, where the scene keeps it: of motion, kg m/s, and of turning, kg m²/s.
    pub momentum: [Option<f64>; 2],
    /// How deep bodies were in each other at most, m; NaN where the truth is not known to the end.
    pub penetration: f64,
    /// What it costs.
    pub cost: Cost,
    /// What became of the run.
    pub fate: Fate,
    /// What was told about it.
    pub reported: Vec<String>,
    /// The largest error that is possible, as the reference is in doubt, too; in times of what nobody sees. NaN where nothing is
    /// known.
    pub score: f64,
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
    /// How deep bodies are in each other in the reference, m, and how far that may be off; NaN where it is not known to the end.
    pub penetration: f64,
    /// How far that may be off, m.
    pub penetration_doubt: f64,
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
    let mut case = PrecisionCase::new(lab, model, programs, &options.set, findings);
    let ladder = prepare(&mut case, options)?;
    tell("the reference");
    let mut truth = None;
    for samples in ladder.samplings() {
        (case.interval, case.count) = samples;
        truth = reference::reference(&case, ladder.own)?;
        if truth.is_some() || interrupt::requested() {
            break;
        }
    }
    let settings = ladder.settings(options);
    let Some(truth) = truth else { return without_reference(case, &settings, &ladder) };
    let mine = Setting { integrator: ladder.integrator, timestep: ladder.own, solver: None };
    let mine = case.run(&mine, Ask::default())?;
    let targets = judge::compared(&case, &truth, &mine);
    let blank = targets.iter().filter(|t| t.blank);
    case.left_out
        .extend(blank.map(|t| LeftOut { label: t.label.clone(), reason: "it is not a number at the start" }));
    let horizon = targets.iter().filter_map(|t| t.until).reduce(f64::min);
    let part = horizon.map_or(1.0, |t| t / case.length().max(f64::MIN_POSITIVE));
    let judge = Judge {
        case: &case,
        ladder: &ladder,
        truth: &truth,
        kept: Kept::of(&truth.run, part),
        events: events::events(&case, &truth, &targets),
        targets,
        part,
    };
    let mut rows = judge.rows(&settings, tell)?;
    orders::observe_orders(&mut rows, &judge.targets, !truth.jumps && horizon.is_none());
    tell("run times");
    let timed: Vec<Option<Setting>> =
        rows.iter().map(|r| (r.fate != Fate::Stopped).then_some(r.setting)).collect();
    for (row, [median, low, high]) in rows.iter_mut().zip(cost::measure(&case, &timed)) {
        (row.cost.median, row.cost.low, row.cost.high) = (median, low, high);
    }
    let Judge { kept, events, targets, .. } = judge;
    let known_to_end = |x: f64| if horizon.is_none() { x } else { f64::NAN };
    let mut report = Report {
        nearby: horizon.map(|_| events::nearby(&case, &targets, ladder.own)).transpose()?,
        beside: options.beside.as_ref().map(|r| r.judge(&case, &truth, &targets)).transpose()?,
        events,
        length: case.length(),
        samples: case.count,
        left_out: case.left_out,
        energy: kept.energy,
        momentum: kept.momentum,
        penetration: known_to_end(truth.run.penetration),
        penetration_doubt: known_to_end(truth.depth_doubt),
        reference: Some(truth.how),
        targets,
        rows,
        front: Vec::new(),
        advice: Vec::new(),
    };
    report.front = advice::front(&report.rows);
    report.advice = advice::advise(&report);
    Ok(report)
}

/// Checks that the lab can be compared; presses come where all timesteps meet.
fn prepare(case: &mut PrecisionCase<'_>, options: &Options) -> Result<Ladder, RunError> {
    if case.targets.is_empty() {
        let why = match case.left_out.first() {
            Some(out) => {
                format!(
                    ": \"{}\" is skipped, because {}",
                    crate::printable::printable(&out.label),
                    out.reason
                )
            }
            None => "; add a plot with a trace, or a readout".to_string(),
        };
        return Err(RunError(format!("this lab displays no numbers to compare{why}")));
    }
    case.presses = run::presses(case.programs, &options.press)?;
    if let Some(who) = case.steps_itself() {
        return Err(RunError(format!(
            "{} sets the timestep while the lab runs, so no other timestep can be tested",
            crate::printable::printable(&who)
        )));
    }
    let (own, integrator) = {
        let session = case.start(None)?;
        (session.world.model.opt.timestep, Integrator::of(&session.world.model))
    };
    let length = options.until.or(case.lab.stop_at.as_ref().map(|s| s.value)).unwrap_or(RUN_LENGTH);
    let ladder = Ladder::new(case.lab, own, integrator, length)?;
    // A press between would come at another time in each run.
    let coarse = ladder.coarse();
    for (_, time) in &mut case.presses {
        *time = (*time / coarse - 1e-9).ceil().max(0.0) * coarse;
    }
    run::presses_within(case.programs, &case.presses, ladder.count, coarse)?;
    Ok(ladder)
}

/// What runs are held against.
struct Judge<'j, 'a> {
    case: &'j PrecisionCase<'a>,
    ladder: &'j Ladder,
    truth: &'j Reference,
    targets: Vec<Compared>,
    events: Vec<Event>,
    kept: Kept,
    /// The part of the run before the horizon of the truth.
    part: f64,
}

impl Judge<'_, '_> {
    /// All settings; of each method also longer steps, until something changes that a student sees.
    fn rows(&self, settings: &[Setting], tell: &mut dyn FnMut(&str)) -> Result<Vec<Row>, RunError> {
        let mut rows: Vec<Row> = Vec::new();
        for (i, setting) in settings.iter().enumerate() {
            if interrupt::requested() {
                break;
            }
            tell(&format!("setting {} of {}: {}", i + 1, settings.len(), setting.integrator.name));
            let mut now = vec![self.row(setting)?];
            let begins = rows.last().is_none_or(|r| r.setting.integrator != setting.integrator);
            let longest = begins && setting.solver.is_none() && setting.timestep == self.ladder.coarse();
            while longest
                && now.last().is_some_and(|r| r.fate == Fate::Good && r.score <= 1.0)
                && let Some(step) = now.last().and_then(|r| self.ladder.longer(r.setting.timestep, self.case))
            {
                now.push(self.row(&Setting { timestep: step, ..*setting })?);
            }
            rows.extend(now.into_iter().rev());
        }
        Ok(rows)
    }

    fn row(&self, setting: &Setting) -> Result<Row, RunError> {
        let ask = Ask { sought: Some(&self.truth.sought), ..Ask::default() };
        let run = self.case.run(setting, ask)?;
        let errors = judge::errors(self.case, self.truth, &self.targets, &run, setting.timestep);
        let score = match run.fate {
            Fate::Good | Fate::Warned => score(&self.targets, &errors),
            _ => f64::NAN,
        };
        Ok(Row {
            setting: *setting,
            own: self.ladder.is_own(setting),
            errors,
            events: events::offs(&run, &self.events),
            energy: self.kept.energy.map(|_| change(&run.energy, self.part)),
            momentum: [0, 1].map(|k| self.kept.momentum[k].map(|_| self.kept.change(&run, k, self.part))),
            penetration: if self.part < 1.0 { f64::NAN } else { run.penetration },
            cost: Cost::of_work(run.work),
            fate: run.fate,
            reported: run.reported,
            score,
        })
    }
}

fn score(targets: &[Compared], errors: &[Errors]) -> f64 {
    let known = targets.iter().zip(errors).filter(|(t, _)| t.is_compared());
    known.map(|(_, e)| e.seen[0]).reduce(f64::max).unwrap_or(f64::NAN)
}

/// The report of a lab that no method comes through: what became of each setting, and nothing else.
fn without_reference(
    case: PrecisionCase<'_>,
    settings: &[Setting],
    ladder: &Ladder,
) -> Result<Report, RunError> {
    let mut rows = Vec::new();
    for setting in settings {
        let run = case.run(setting, Ask::default())?;
        rows.push(Row {
            setting: *setting,
            own: ladder.is_own(setting),
            errors: Vec::new(),
            events: Vec::new(),
            energy: None,
            momentum: [None; 2],
            penetration: run.penetration,
            cost: Cost::of_work(run.work),
            fate: run.fate,
            reported: run.reported,
            score: f64::NAN,
        });
    }
    Ok(Report {
        targets: Vec::new(),
        reference: None,
        length: case.length(),
        samples: case.count,
        left_out: case.left_out,
        beside: None,
        rows,
        events: Vec::new(),
        energy: None,
        momentum: [None; 2],
        penetration: f64::NAN,
        penetration_doubt: f64::NAN,
        nearby: None,
        front: Vec::new(),
        advice: Vec::new(),
    })
}
