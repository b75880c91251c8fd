//! The comparison: the reference, a run with every setting, and the report.

use super::agreement::ReferenceSolution;
use super::case::{OmittedNumber, PrecisionCase};
use super::conserved::{Conserved, change};
use super::events::{self, Event};
use super::judge::{self, Compared, Errors};
use super::ladder::Ladder;
use super::report::{PrecisionOptions, PrecisionResults, PrecisionRow};
use super::run_cost::{self, RunCost};
use super::run_record::{RecordRequest, RunStatus};
use super::setting::Setting;
use super::{advice, orders, reference};
use labspec::bind::Programs;
use labspec::finding::Finding;
use labspec::interrupt;
use labspec::run::Integrator;
use labspec::run::{self, RunError};
use labspec::spec::Lab;
use labspec::spec::format::RUN_LENGTH;
use labspec_core::Model;

/// Runs the lab with every setting. `report_progress` receives descriptions of the current activity.
///
/// # Errors
/// The lab displays no numbers that can be compared, it sets its timestep itself during the run, a requested interaction is
/// impossible, or the runs would need too many steps. Errors in closed forms are added to `findings`.
pub fn compare(
    lab: &Lab,
    model: &Model,
    programs: &Programs,
    options: &PrecisionOptions,
    findings: &mut Vec<Finding>,
    report_progress: &mut dyn FnMut(&str),
) -> Result<PrecisionResults, RunError> {
    let mut case = PrecisionCase::new(lab, model, programs, &options.set, findings);
    let ladder = prepare(&mut case, options)?;
    report_progress("the reference");
    let truth = find_reference(&mut case, &ladder)?;
    let settings = ladder.settings(options);
    let Some(truth) = truth else { return without_reference(case, &settings, &ladder) };
    let setting = Setting { integrator: ladder.integrator, timestep: ladder.timestep, solver: None };
    let lab_run = case.run(&setting, RecordRequest::default())?;
    let targets = judge::compared(&case, &truth, &lab_run);
    let blank = targets.iter().filter(|t| t.blank);
    case.omitted.extend(
        blank.map(|t| OmittedNumber { label: t.label.clone(), reason: "it is not a number at the start" }),
    );
    let horizon = targets.iter().filter_map(|t| t.until).reduce(f64::min);
    let part = horizon.map_or(1.0, |t| t / case.length().max(f64::MIN_POSITIVE));
    let judge = ComparisonData {
        case: &case,
        ladder: &ladder,
        truth: &truth,
        conserved: Conserved::measure(&truth.run, part),
        events: events::events(&case, &truth, &targets),
        targets,
        part,
    };
    let mut rows = judge.rows(&settings, report_progress)?;
    orders::observe_orders(&mut rows, &judge.targets, !truth.jumps && horizon.is_none());
    report_progress("run times");
    measure_run_times(&case, &mut rows);
    let ComparisonData { conserved, events, targets, .. } = judge;
    let known_to_end = |x: f64| if horizon.is_none() { x } else { f64::NAN };
    let mut report = PrecisionResults {
        nearby: horizon.map(|_| events::nearby(&case, &targets, ladder.timestep)).transpose()?,
        beside: options.beside.as_ref().map(|r| r.judge(&case, &truth, &targets)).transpose()?,
        events,
        length: case.length(),
        samples: case.count,
        omitted: case.omitted,
        energy: conserved.energy,
        momentum: conserved.momentum,
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

/// The reference with the densest samples for which it can be computed.
fn find_reference(
    case: &mut PrecisionCase<'_>,
    ladder: &Ladder,
) -> Result<Option<ReferenceSolution>, RunError> {
    for samples in ladder.samplings() {
        (case.interval, case.count) = samples;
        let reference = reference::reference(case, ladder.timestep)?;
        if reference.is_some() || interrupt::requested() {
            return Ok(reference);
        }
    }
    Ok(None)
}

/// Measures the run time of every setting that reached its end.
fn measure_run_times(case: &PrecisionCase<'_>, rows: &mut [PrecisionRow]) {
    let timed: Vec<Option<Setting>> =
        rows.iter().map(|r| (r.status != RunStatus::Stopped).then_some(r.setting)).collect();
    for (row, [median, low, high]) in rows.iter_mut().zip(run_cost::measure(case, &timed)) {
        (row.cost.median, row.cost.low, row.cost.high) = (median, low, high);
    }
}

/// Checks that the lab can be compared, and moves presses to times at which the steps of all settings meet.
fn prepare(case: &mut PrecisionCase<'_>, options: &PrecisionOptions) -> Result<Ladder, RunError> {
    if case.targets.is_empty() {
        let why = match case.omitted.first() {
            Some(out) => {
                format!(": \"{}\" is skipped, because {}", labspec::report::printable(&out.label), out.reason)
            }
            None => "; add a plot with a trace, or a readout".to_string(),
        };
        return Err(RunError::new(format!("this lab displays no numbers to compare{why}")));
    }
    case.presses = run::presses(case.programs, &options.press)?;
    if let Some(subject) = case.program_that_sets_timestep() {
        return Err(RunError::new(format!(
            "{} sets the timestep while the lab runs, so no other timestep can be tested",
            labspec::report::printable(&subject)
        )));
    }
    let (timestep, integrator) = {
        let session = case.start(None)?;
        (session.world.model.opt.timestep, Integrator::of_model(&session.world.model))
    };
    let length = options.until.or(case.lab.stop_at.as_ref().map(|s| s.value)).unwrap_or(RUN_LENGTH);
    let ladder = Ladder::new(case.lab, timestep, integrator, length)?;
    // Between such times, a press would occur at a different time in each run.
    let coarse = ladder.coarse();
    for (_, time) in &mut case.presses {
        *time = (*time / coarse - 1e-9).ceil().max(0.0) * coarse;
    }
    run::presses_within(case.programs, &case.presses, ladder.count, coarse)?;
    Ok(ladder)
}

/// The data with which runs are compared.
struct ComparisonData<'j, 'a> {
    case: &'j PrecisionCase<'a>,
    ladder: &'j Ladder,
    truth: &'j ReferenceSolution,
    targets: Vec<Compared>,
    events: Vec<Event>,
    conserved: Conserved,
    /// The part of the run before the horizon of the reference.
    part: f64,
}

impl ComparisonData<'_, '_> {
    /// Runs all settings, and for each method also longer timesteps, until a visible error appears.
    fn rows(
        &self,
        settings: &[Setting],
        report_progress: &mut dyn FnMut(&str),
    ) -> Result<Vec<PrecisionRow>, RunError> {
        let mut rows: Vec<PrecisionRow> = Vec::new();
        for (i, setting) in settings.iter().enumerate() {
            if interrupt::requested() {
                break;
            }
            report_progress(&format!("setting {} of {}: {}", i + 1, settings.len(), setting.integrator.name));
            let mut current = vec![self.row(setting)?];
            let begins = rows.last().is_none_or(|r| r.setting.integrator != setting.integrator);
            let longest = begins && setting.solver.is_none() && setting.timestep == self.ladder.coarse();
            while longest
                && current.last().is_some_and(|r| r.status == RunStatus::Good && r.score <= 1.0)
                && let Some(step) =
                    current.last().and_then(|r| self.ladder.longer(r.setting.timestep, self.case))
            {
                current.push(self.row(&Setting { timestep: step, ..*setting })?);
            }
            rows.extend(current.into_iter().rev());
        }
        Ok(rows)
    }

    fn row(&self, setting: &Setting) -> Result<PrecisionRow, RunError> {
        let ask = RecordRequest { sought: Some(&self.truth.sought), ..RecordRequest::default() };
        let run = self.case.run(setting, ask)?;
        let errors = judge::errors(self.case, self.truth, &self.targets, &run, setting.timestep);
        let score = match run.status {
            RunStatus::Good | RunStatus::Warned => score(&self.targets, &errors),
            _ => f64::NAN,
        };
        Ok(PrecisionRow {
            setting: *setting,
            is_own: self.ladder.is_own(setting),
            errors,
            events: events::timing_errors(&run, &self.events),
            energy: self.conserved.energy.map(|_| change(&run.energy, self.part)),
            momentum: [0, 1]
                .map(|k| self.conserved.momentum[k].map(|_| self.conserved.change(&run, k, self.part))),
            penetration: if self.part < 1.0 { f64::NAN } else { run.penetration },
            cost: RunCost::of_work(run.work),
            status: run.status,
            reported: run.reported,
            score,
        })
    }
}

fn score(targets: &[Compared], errors: &[Errors]) -> f64 {
    let compared = targets.iter().zip(errors).filter(|(t, _)| t.is_compared());
    compared.map(|(_, e)| e.seen[0]).reduce(f64::max).unwrap_or(f64::NAN)
}

/// The report of a lab that no method can simulate: it contains only the outcome of each setting.
fn without_reference(
    case: PrecisionCase<'_>,
    settings: &[Setting],
    ladder: &Ladder,
) -> Result<PrecisionResults, RunError> {
    let mut rows = Vec::new();
    for setting in settings {
        let run = case.run(setting, RecordRequest::default())?;
        rows.push(PrecisionRow {
            setting: *setting,
            is_own: ladder.is_own(setting),
            errors: Vec::new(),
            events: Vec::new(),
            energy: None,
            momentum: [None; 2],
            penetration: run.penetration,
            cost: RunCost::of_work(run.work),
            status: run.status,
            reported: run.reported,
            score: f64::NAN,
        });
    }
    Ok(PrecisionResults {
        targets: Vec::new(),
        reference: None,
        length: case.length(),
        samples: case.count,
        omitted: case.omitted,
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
