//! Runs a lab with every listed interaction, and reports all faults.

use super::map::{self, StabilityMap};
use super::margins::{self, Margin};
use super::remedy::{Remedy, RemedyTests};
use super::sensitivity::{self, Sensitivity};
use labspec::bind::Programs;
use labspec::interrupt;
use labspec::run::{self, RunError};
use labspec::spec::Lab;
use labspec::stress::{
    FaultGroup, FaultKind, Interaction, InteractionKind, StressCase, add_fault, list_interactions, window,
    without_pushed_bodies,
};
use labspec_core::Model;
use labspec_expr::Value;

/// The length of a run relative to the time that a student watches.
const LONGER: f64 = 10.0;
/// The work limit for all runs of a lab, in units of about a nanosecond.
const WORK: u64 = 30_000_000_000;
/// The work limit for remedies, and the maximum number of findings for which they are tried.
const WORK_OF_REMEDIES: u64 = 10_000_000_000;
const MOST_REMEDIED: usize = 6;

/// The options of the runs.
#[derive(Clone, Debug, Default)]
pub struct StressOptions {
    /// The length of each run in s; ten times the time that a student watches if `None`.
    pub until: Option<f64>,
    /// Whether stability margins are computed.
    pub margins: bool,
    /// The labels of the two controls of a map, if one is requested.
    pub map: Option<[String; 2]>,
    /// Controls by label, with the values that they get before all other actions.
    pub set: Vec<(String, Value)>,
    /// Buttons by label, with the times in s at which they are pressed in every run.
    pub press: Vec<(String, f64)>,
}

/// The results of one run.
#[derive(Clone, Debug, PartialEq)]
pub struct StressRun {
    /// The interaction.
    pub interaction: Interaction,
    /// The simulated time, s.
    pub covered: f64,
    /// Whether it exceeded its work limit.
    pub cut: bool,
    /// The kinds of faults, each once.
    pub wrong: Vec<FaultKind>,
}

/// A fault, and the remedies for it.
#[derive(Clone, Debug, PartialEq)]
pub struct StabilityFinding {
    /// The fault, and the settings that show it.
    pub group: FaultGroup,
    /// Whether the lab declares that it fails.
    pub expected: bool,
    /// The tested remedies that work in the simplest setting.
    pub remedies: Vec<Remedy>,
}

/// The number of runs of a kind.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RunCount {
    /// The kind.
    pub kind: InteractionKind,
    /// Runs that were completed, or stopped at a fault.
    pub made: usize,
    /// Runs that exceeded their work limit.
    pub cut: usize,
    /// Runs that were not started.
    pub skipped: usize,
}

/// All results for a lab.
#[derive(Clone, Debug, PartialEq)]
pub struct StressReport {
    /// The length of a run, s.
    pub length: f64,
    /// The performed runs by kind.
    pub tried: Vec<RunCount>,
    /// The runs.
    pub runs: Vec<StressRun>,
    /// The simulated time of the shortest run that was cut, s.
    pub shortest: Option<f64>,
    /// The number of pairs of settings that occur in no run, because there are too many.
    pub skipped_pairs: usize,
    /// What was not tested, with the reasons.
    pub skipped: Vec<String>,
    /// The faults, the simplest setting first.
    pub found: Vec<StabilityFinding>,
    /// The time that a student watches, s: the length of the runs for margins and sensitivity.
    pub window: f64,
    /// The stability margins, if requested.
    pub margins: Vec<Margin>,
    /// The sensitivity to the initial state.
    pub sensitivity: Sensitivity,
    /// The stable region over two controls, if requested.
    pub map: Option<StabilityMap>,
    /// The total work.
    pub work: u64,
}

impl StressReport {
    /// Whether everything was tested and no unexpected fault was found.
    pub fn fine(&self) -> bool {
        let whole = self.tried.iter().all(|t| t.cut == 0 && t.skipped == 0);
        whole && self.skipped_pairs == 0 && self.skipped.is_empty() && self.found.iter().all(|f| f.expected)
    }
}

/// Runs the lab with all interactions. `report_progress` receives descriptions of the current activity.
///
/// # Errors
/// The length is invalid, or a student cannot perform the actions in the options.
pub fn probe(
    lab: &Lab,
    model: &Model,
    programs: &Programs,
    options: &StressOptions,
    report_progress: &mut dyn FnMut(&str),
) -> Result<StressReport, RunError> {
    let length = options.until.unwrap_or(LONGER * window(lab));
    let short = window(lab).min(length);
    let base = Interaction::base(lab, programs, &options.set, &options.press)?;
    let case = StressCase::new(lab, model, programs, base);
    // A control may set the timestep.
    let timestep = case.start(&case.base, WORK).world.model.opt.timestep;
    let steps = run::count_steps(lab, Some(length), None, timestep)?;
    if steps == 0 {
        return Err(RunError::new(format!(
            "a run of {length} s has no step of {timestep} s, so nothing would be tested"
        )));
    }
    run::presses_within(programs, &run::presses(programs, &options.press)?, steps, timestep)?;
    let (interactions, skipped_pairs) = list_interactions(lab, short, &case.base);
    let mut report = empty_report(length, short, skipped_pairs);
    if let Some(most) = case.watched_pairs_limit() {
        report.skipped.push(format!("only the first {most} pairs of geoms are watched for tunnelling"));
    }
    let (groups, work_per_second) = run_interactions(&case, &interactions, &mut report, report_progress);
    report.tried.retain(|t| t.made + t.cut + t.skipped > 0);
    let expects_breaks = lab.expect.is_some();
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
        report.skipped.extend(more);
    }
    report_progress("sensitivity");
    report.sensitivity = sensitivity::sensitivity(&case, short, &mut report.work);
    if let Some(labels) = &options.map {
        report.map = Some(map::map(&case, labels, short, report_progress, &mut report.work)?);
    }
    Ok(report)
}

/// A report for runs of this length, before the first run.
fn empty_report(length: f64, window: f64, skipped_pairs: usize) -> StressReport {
    StressReport {
        length,
        tried: InteractionKind::ALL.map(|kind| RunCount { kind, made: 0, cut: 0, skipped: 0 }).to_vec(),
        runs: Vec::new(),
        shortest: None,
        skipped_pairs,
        skipped: Vec::new(),
        found: Vec::new(),
        window,
        margins: Vec::new(),
        sensitivity: Sensitivity {
            length: window,
            distance: 0.0,
            divergence: None,
            exponent: None,
            horizons: Vec::new(),
        },
        map: None,
        work: 0,
    }
}

/// Runs each interaction. Returns the faults in groups, and the work per simulated second of the unchanged lab.
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
        // Later runs can use the work that earlier ones did not need.
        let share = left / (interactions.len() - i) as u64;
        let Some(tried) = report.tried.iter_mut().find(|t| t.kind == interaction.kind) else { continue };
        if interrupt::requested() {
            tried.skipped += 1;
            continue;
        }
        let outcome = case.run(interaction, None, length, share);
        left = left.saturating_sub(outcome.spent);
        report.work += outcome.spent;
        if interaction.kind == InteractionKind::AsItStands {
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

/// Tries remedies for the faults, starting with the simplest fault.
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
        report.skipped.push(format!("remedies for {untried} of the findings"));
    }
}
