//! Runs of a lab under every listed interaction, and the report of everything that goes wrong in them.

use super::map::{self, StabilityMap};
use super::margins::{self, Margin};
use super::remedy::{Remedy, RemedyTests};
use super::sensitivity::{self, Sensitivity};
use labspec::bind::Programs;
use labspec::interrupt;
use labspec::run::{self, RunError};
use labspec::spec::{Expect, Lab};
use labspec::stress::{
    FaultGroup, FaultKind, Interaction, Kind, StressCase, add_fault, list_interactions, window,
    without_pushed_bodies,
};
use labspec_core::Model;
use labspec_expr::Value;

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
pub struct StressRun {
    /// What was done.
    pub interaction: Interaction,
    /// How much of it was made, s.
    pub covered: f64,
    /// It took more work than it may.
    pub cut: bool,
    /// What went wrong, each kind once.
    pub wrong: Vec<FaultKind>,
}

/// A fault, and what helps against it.
#[derive(Clone, Debug, PartialEq)]
pub struct StabilityFinding {
    /// The fault, and the settings that show it.
    pub group: FaultGroup,
    /// The lab says itself that it breaks.
    pub expected: bool,
    /// What was tried and helps in the simplest setting.
    pub remedies: Vec<Remedy>,
}

/// How many runs of a kind there are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RunCount {
    /// The kind.
    pub kind: Kind,
    /// Runs that were made to their end, or until they broke.
    pub made: usize,
    /// Runs that were started and took more work than they may.
    pub cut: usize,
    /// Runs that were not started.
    pub left_out: usize,
}

/// All runs of a lab.
#[derive(Clone, Debug, PartialEq)]
pub struct StressReport {
    /// How long a run is, s.
    pub length: f64,
    /// What was tried, kind by kind.
    pub tried: Vec<RunCount>,
    /// The runs.
    pub runs: Vec<StressRun>,
    /// How long the shortest of those runs was that were cut, s.
    pub shortest: Option<f64>,
    /// Pairs of settings that meet in no run, as there are too many.
    pub pairs_left_out: usize,
    /// What was not looked at, and why.
    pub left_out: Vec<String>,
    /// What goes wrong, the simplest setting first.
    pub found: Vec<StabilityFinding>,
    /// How long a student looks, s: margins and sensitivity are of runs of this length.
    pub window: f64,
    /// How far everything may be raised, where that was asked for.
    pub margins: Vec<Margin>,
    /// How much the lab depends on its start.
    pub sensitivity: Sensitivity,
    /// The stable region over two controls, where that was asked for.
    pub map: Option<StabilityMap>,
    /// Work that all of it took.
    pub work: u64,
}

impl StressReport {
    /// Whether everything that was to be tried was tried and is fine.
    pub fn fine(&self) -> bool {
        let whole = self.tried.iter().all(|t| t.cut == 0 && t.left_out == 0);
        whole && self.pairs_left_out == 0 && self.left_out.is_empty() && self.found.iter().all(|f| f.expected)
    }
}

/// Runs the lab in every way that is tried. `report_progress` hears what is being done.
///
/// # Errors
/// The length is none that a run can have, or no student can set or press what the options say.
pub fn probe(
    lab: &Lab,
    model: &Model,
    programs: &Programs,
    options: &Options,
    report_progress: &mut dyn FnMut(&str),
) -> Result<StressReport, RunError> {
    let length = options.until.unwrap_or(LONGER * window(lab));
    let short = window(lab).min(length);
    let base = Interaction::base(lab, programs, &options.set, &options.press)?;
    let case = StressCase::new(lab, model, programs, base);
    // A control may set the timestep.
    let timestep = case.start(&case.base, WORK).world.model.opt.timestep;
    let steps = run::count_steps(lab, Some(length), None, timestep)?;
    run::presses_within(programs, &run::presses(programs, &options.press)?, steps, timestep)?;
    let (interactions, pairs_left_out) = list_interactions(lab, short, &case.base);
    let mut report = empty_report(length, short, pairs_left_out);
    if let Some(most) = case.watched_pairs_limit() {
        report.left_out.push(format!("only the first {most} pairs of geoms are watched for tunnelling"));
    }
    let (groups, work_per_second) = run_interactions(&case, &interactions, &mut report, report_progress);
    report.tried.retain(|t| t.made + t.cut + t.left_out > 0);
    let expects_breaks = matches!(lab.expect, Some(Expect::Breaks(_)));
    let breaks = |kind| matches!(kind, FaultKind::Diverges | FaultKind::Grows | FaultKind::Silent);
    let finding = |group: FaultGroup| {
        let expected = expects_breaks && breaks(group.fault.kind);
        StabilityFinding { group, expected, remedies: Vec::new() }
    };
    report.found = groups.into_iter().map(finding).collect();
    try_remedies(&case, &mut report, work_per_second, report_progress);
    if options.margins {
        let (margins, more) = margins::margins(&case, short, report_progress, &mut report.work);
        report.margins = margins;
        report.left_out.extend(more);
    }
    report_progress("sensitivity");
    report.sensitivity = sensitivity::sensitivity(&case, short, &mut report.work);
    if let Some(labels) = &options.map {
        report.map = Some(map::map(&case, labels, short, report_progress, &mut report.work)?);
    }
    Ok(report)
}

/// A report of runs of this length, before the first of them.
fn empty_report(length: f64, window: f64, pairs_left_out: usize) -> StressReport {
    StressReport {
        length,
        tried: Kind::ALL.map(|kind| RunCount { kind, made: 0, cut: 0, left_out: 0 }).to_vec(),
        runs: Vec::new(),
        shortest: None,
        pairs_left_out,
        left_out: Vec::new(),
        found: Vec::new(),
        window,
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
    }
}

/// Runs each interaction. Returns the faults in groups, and the work of a simulated second of the lab as it stands.
fn run_interactions(
    case: &StressCase<'_>,
    interactions: &[Interaction],
    report: &mut StressReport,
    report_progress: &mut dyn FnMut(&str),
) -> (Vec<FaultGroup>, f64) {
    let length = report.length;
    let mut left = WORK;
    let mut groups = Vec::new();
    let mut work_per_second = f64::INFINITY;
    for (i, interaction) in interactions.iter().enumerate() {
        report_progress(&format!(
            "run {} of {}: {}",
            i + 1,
            interactions.len(),
            interaction.kind.description()
        ));
        // Work that earlier runs did not use is available to later ones.
        let share = left / (interactions.len() - i) as u64;
        let Some(tried) = report.tried.iter_mut().find(|t| t.kind == interaction.kind) else { continue };
        if interrupt::requested() {
            tried.left_out += 1;
            continue;
        }
        let outcome = case.run(interaction, None, length, share);
        left = left.saturating_sub(outcome.spent);
        report.work += outcome.spent;
        if interaction.kind == Kind::AsItStands {
            work_per_second = outcome.spent as f64 / outcome.covered.max(case.model.opt.timestep);
        }
        if outcome.cut {
            tried.cut += 1;
            report.shortest = Some(report.shortest.unwrap_or(f64::INFINITY).min(outcome.covered));
        } else {
            tried.made += 1;
        }
        let (covered, cut) = (outcome.covered, outcome.cut);
        let (faults, spent) = without_pushed_bodies(case, interaction, outcome.faults, length, left);
        left = left.saturating_sub(spent);
        report.work += spent;
        let mut wrong: Vec<FaultKind> = faults.iter().map(|f| f.kind).collect();
        wrong.sort_unstable();
        wrong.dedup();
        faults.into_iter().for_each(|fault| add_fault(&mut groups, fault, interaction));
        report.runs.push(StressRun { interaction: interaction.clone(), covered, cut, wrong });
    }
    (groups, work_per_second)
}

/// Tries remedies for the faults, the simplest first.
fn try_remedies(
    case: &StressCase<'_>,
    report: &mut StressReport,
    work_per_second: f64,
    report_progress: &mut dyn FnMut(&str),
) {
    let mut tries = RemedyTests {
        case,
        length: report.length,
        window: report.window,
        work_per_second,
        left: WORK_OF_REMEDIES,
        work: 0,
    };
    let many = report.found.len();
    let mut untried = 0;
    for (i, found) in report.found.iter_mut().enumerate() {
        if matches!(found.group.fault.kind, FaultKind::Throws | FaultKind::Warns) {
            continue;
        }
        report_progress(&format!("remedies for finding {} of {many}", i + 1));
        match if i < MOST_REMEDIED { tries.remedies(&found.group) } else { None } {
            Some(list) => found.remedies = list,
            None => untried += 1,
        }
    }
    report.work += tries.work;
    if untried > 0 {
        report.left_out.push(format!("remedies for {untried} of the findings"));
    }
}
