//! Whether a lab stays sound whatever a student does to it: runs with every control at its ends, in corners and in turn, for much
//! longer than anybody looks, and everything that goes wrong in them.

mod bodies;
mod case;
mod fault;
mod ground;
mod interaction;
mod map;
mod margins;
mod memory;
mod messages;
mod remedy;
mod rest;
mod search;
mod sensitivity;
mod truth;
mod watch;
mod wild;

pub(crate) use case::StressCase;
pub(crate) use fault::add;
pub use fault::{Evidence, Fault, FaultGroup, FaultKind};
pub(crate) use interaction::list;
pub use interaction::{Action, Interaction, Kind};
pub use map::{Cell, Map};
pub use margins::{Knob, Margin};
pub use messages::watched_run;
pub(crate) use messages::{describe, with_tried_timestep};
pub use remedy::Remedy;
pub use sensitivity::{Exponent, Horizon, Parting, Sensitivity};

use crate::bind::Programs;
use crate::interrupt;
use crate::run::{self, RunError, Session};
use crate::spec::{Expect, Lab};
use labspec_core::Model;
use labspec_core::math::rows_mut;
use labspec_expr::Value;
use remedy::Tries;

/// How long a student looks at a lab that says nothing of it, s.
const WINDOW: f64 = 10.0;
/// How many times longer than anybody looks a run is.
const LONGER: f64 = 10.0;
/// Work for all runs of a lab, in units of about a nanosecond.
const WORK: u64 = 30_000_000_000;
/// Work for remedies, and how many findings they are tried for.
const WORK_OF_REMEDIES: u64 = 10_000_000_000;
const MOST_REMEDIED: usize = 6;

/// What is tried.
#[derive(Clone, Debug, Default)]
pub struct Options {
    /// Length of each run in s; ten times as long as a student looks, without it.
    pub until: Option<f64>,
    /// Also how far everything may be raised before the lab breaks.
    pub margins: bool,
    /// Also the stable region over two controls, by label.
    pub map: Option<[String; 2]>,
    /// Controls by label, and the values that they have before anything else is done.
    pub set: Vec<(String, Value)>,
    /// Buttons by label, and the times in s at which they are pressed in every run.
    pub press: Vec<(String, f64)>,
}

/// A run that was made.
#[derive(Clone, Debug, PartialEq)]
pub struct Made {
    /// What was done.
    pub handling: Interaction,
    /// How much of it was made, s.
    pub covered: f64,
    /// It took more work than it may.
    pub cut: bool,
    /// What went wrong, each kind once.
    pub wrong: Vec<FaultKind>,
}

/// How many runs of a kind there are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Tried {
    /// The kind.
    pub kind: Kind,
    /// Runs that were made to their end, or until they broke.
    pub made: usize,
    /// Runs that were begun and took more work than they may.
    pub cut: usize,
    /// Runs that were not begun.
    pub left_out: usize,
}

/// All runs of a lab.
#[derive(Clone, Debug, PartialEq)]
pub struct Report {
    /// How long a run is, s.
    pub length: f64,
    /// What was tried, kind by kind.
    pub tried: Vec<Tried>,
    /// The runs.
    pub runs: Vec<Made>,
    /// How long the shortest of those runs was that were cut, s.
    pub shortest: Option<f64>,
    /// Pairs of settings that meet in no run, as there are too many.
    pub pairs_left_out: usize,
    /// What was not looked at, and why.
    pub left_out: Vec<String>,
    /// What goes wrong, the simplest setting first.
    pub found: Vec<FaultGroup>,
    /// How long a student looks, s: margins and sensitivity are of runs of this length.
    pub window: f64,
    /// How far everything may be raised, where that was asked for.
    pub margins: Vec<Margin>,
    /// How much the lab depends on its start.
    pub sensitivity: Sensitivity,
    /// The stable region over two controls, where that was asked for.
    pub map: Option<Map>,
    /// Work that all of it took.
    pub work: u64,
}

impl Report {
    /// Whether everything that was to be tried was tried and is fine.
    pub fn fine(&self) -> bool {
        let whole = self.tried.iter().all(|t| t.cut == 0 && t.left_out == 0);
        whole && self.pairs_left_out == 0 && self.left_out.is_empty() && self.found.iter().all(|f| f.expected)
    }
}

/// Runs the lab in every way that is tried. `tell` hears what is being done.
///
/// # Errors
/// The length is none that a run can have, or no student can set or press what the options say.
pub fn probe(
    lab: &Lab,
    model: &Model,
    programs: &Programs,
    options: &Options,
    tell: &mut dyn FnMut(&str),
) -> Result<Report, RunError> {
    let window = window(lab);
    let length = options.until.unwrap_or(LONGER * window);
    let base = Interaction::base(lab, programs, &options.set, &options.press)?;
    let case = StressCase::new(lab, model, programs, base);
    // A control may set the timestep.
    let timestep = case.start(&case.base, WORK).world.model.opt.timestep;
    let steps = run::count_steps(lab, Some(length), None, timestep)?;
    run::presses_within(programs, &run::presses(programs, &options.press)?, steps, timestep)?;
    let (all, pairs_left_out) = list(lab, window.min(length), &case.base);
    let mut report = Report {
        length,
        tried: Kind::ALL.map(|kind| Tried { kind, made: 0, cut: 0, left_out: 0 }).to_vec(),
        runs: Vec::new(),
        shortest: None,
        pairs_left_out,
        left_out: Vec::new(),
        found: Vec::new(),
        window: window.min(length),
        margins: Vec::new(),
        sensitivity: Sensitivity {
            length: window,
            apart: 0.0,
            parting: None,
            exponent: None,
            horizons: Vec::new(),
        },
        map: None,
        work: 0,
    };
    if !case.jumps && bodies::pairs(model, watch::MOST_PAIRS).1 {
        report
            .left_out
            .push(format!("only the first {} pairs of geoms are watched for tunnelling", watch::MOST_PAIRS));
    }
    let mut left = WORK;
    let mut own = f64::INFINITY;
    for (i, handling) in all.iter().enumerate() {
        tell(&format!("run {} of {}: {}", i + 1, all.len(), handling.kind.description()));
        let share = left / (all.len() - i) as u64;
        let Some(tried) = report.tried.iter_mut().find(|t| t.kind == handling.kind) else { continue };
        if interrupt::requested() {
            tried.left_out += 1;
            continue;
        }
        // What others did not use is there for later ones.
        let outcome = case.run(handling, None, length, share);
        left = left.saturating_sub(outcome.spent);
        report.work += outcome.spent;
        if handling.kind == Kind::AsItStands {
            own = outcome.spent as f64 / outcome.covered.max(model.opt.timestep);
        }
        if outcome.cut {
            tried.cut += 1;
            report.shortest = Some(report.shortest.unwrap_or(f64::INFINITY).min(outcome.covered));
        } else {
            tried.made += 1;
        }
        let mut made = Made {
            handling: handling.clone(),
            covered: outcome.covered,
            cut: outcome.cut,
            wrong: Vec::new(),
        };
        let (faults, spent) = genuine(&case, handling, outcome.faults, length, left);
        left = left.saturating_sub(spent);
        report.work += spent;
        for fault in faults {
            made.wrong.push(fault.kind);
            add(&mut report.found, fault, handling);
        }
        made.wrong.sort_unstable();
        made.wrong.dedup();
        report.runs.push(made);
    }
    report.tried.retain(|t| t.made + t.cut + t.left_out > 0);
    if matches!(lab.expect, Some(Expect::Breaks(_))) {
        let breaks = |kind| matches!(kind, FaultKind::Diverges | FaultKind::Grows | FaultKind::Silent);
        report.found.iter_mut().for_each(|f| f.expected = breaks(f.fault.kind));
    }
    let short = window.min(length);
    remedies(&case, &mut report, short, own, tell);
    if options.margins {
        let (margins, more) = margins::margins(&case, short, tell, &mut report.work);
        report.margins = margins;
        report.left_out.extend(more);
    }
    tell("sensitivity");
    report.sensitivity = sensitivity::sensitivity(&case, short, &mut report.work);
    if let Some(labels) = &options.map {
        report.map = Some(map::map(&case, labels, short, tell, &mut report.work)?);
    }
    Ok(report)
}

/// Tries what may help against the findings, the simplest first.
fn remedies(case: &StressCase<'_>, report: &mut Report, window: f64, own: f64, tell: &mut dyn FnMut(&str)) {
    let mut tries = Tries { case, length: report.length, window, own, left: WORK_OF_REMEDIES, work: 0 };
    let many = report.found.len();
    let mut untried = 0;
    for (i, found) in report.found.iter_mut().enumerate() {
        if matches!(found.fault.kind, FaultKind::Throws | FaultKind::Warns) {
            continue;
        }
        tell(&format!("remedies for finding {} of {many}", i + 1));
        match if i < MOST_REMEDIED { tries.remedies(found) } else { None } {
            Some(list) => found.remedies = list,
            None => untried += 1,
        }
    }
    report.work += tries.work;
    if untried > 0 {
        report.left_out.push(format!("remedies for {untried} of the findings"));
    }
}

/// The faults of a run without bodies that creep for another reason than a soft contact: what creeps as fast where friction is
/// hard is pushed along. Also the work that it took to know.
pub(crate) fn genuine(
    case: &StressCase<'_>,
    handling: &Interaction,
    mut faults: Vec<Fault>,
    length: f64,
    budget: u64,
) -> (Vec<Fault>, u64) {
    if !faults.iter().any(|f| f.kind == FaultKind::Drifts) {
        return (faults, 0);
    }
    let firm = case.run(handling, Some(&firmer), length, budget);
    let moves = |f: &Fault| firm.speeds.iter().any(|(who, speed)| *who == f.who && 2.0 * speed > f.size);
    // Without the other run to its end nothing is known of it.
    faults.retain(|f| f.kind != FaultKind::Drifts || !firm.cut && !moves(f));
    (faults, firm.spent)
}

/// Friction a hundred times as hard.
fn firmer(session: &mut Session<'_>) {
    let model = session.world.model.edit();
    *model.opt.impratio *= 100.0;
    *model.opt.cone = 1;
    for solimp in rows_mut::<5>(model.dof_solimp) {
        harden(solimp);
    }
}

/// An impedance that gives way a hundred times less.
fn harden(solimp: &mut [f64; 5]) {
    let most = solimp[1];
    solimp[..2].fill(1.0 - 0.01 * (1.0 - most));
}

/// How long a student looks at a lab: until it stops, or as far as its plots show, s.
pub fn window(lab: &Lab) -> f64 {
    let longest = lab.plots.iter().map(|p| p.window()).filter(|w| w.is_finite()).fold(0.0, f64::max);
    match &lab.stop_at {
        Some(stop) if stop.value > 0.0 => stop.value,
        _ if longest > 0.0 => longest,
        _ => WINDOW,
    }
}
