//! The runs of a snapshot: the lab as loaded, each slider at its ends, each select at its other options, after each button.

use super::super::PreparedLab;
use crate::run::Integrator;
use crate::run::{self, Budget, Cell, End, Play, RunError, Session, Start, StepVariant};
use crate::spec::{ControlKind, Lab, LabAddress, Lesson};
use crate::stress::window;
use crate::verify::significant;
use labspec_core::reflect::option;
use labspec_core::{Model, solver};
use labspec_expr::{Effects, Value};
use std::ops::ControlFlow;

/// Number of samples of a run, besides its start.
const SAMPLES: usize = 10;
/// Time at which buttons are pressed, s.
const PRESS_TIME: f64 = 0.1;

/// The interaction before the run, and its name in the file.
pub(super) struct SnapshotInput {
    pub(super) name: String,
    set: Vec<(String, Value)>,
    press: Vec<(String, f64)>,
}

/// The samples of a run.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct SnapshotRun {
    pub(super) name: String,
    /// Its length, its timestep and further settings.
    pub(super) about: Vec<String>,
    pub(super) times: Vec<f64>,
    /// The name of each trace and readout, and a value for each time.
    pub(super) rows: Vec<(String, Vec<Cell>)>,
    /// Whether the limit of work ended it early.
    pub(super) is_cut: bool,
}

/// A lab with its runs.
pub(super) struct LabRuns<'r, 'l> {
    pub(super) address: LabAddress,
    pub(super) lab: &'l Lab,
    /// `None` where it cannot run.
    pub(super) ready: Option<&'r PreparedLab<'l>>,
    pub(super) runs: Vec<(SnapshotInput, SnapshotRun)>,
    /// The number of runs that were not made, or that were cut short, because a file has a limit of work.
    pub(super) incomplete: usize,
}

/// The runs of all labs of a lesson, within the budget of a file. Each lab is run at least as loaded.
pub(super) fn run_labs<'r, 'l>(lesson: &'l Lesson, ready: &'r [PreparedLab<'l>]) -> Vec<LabRuns<'r, 'l>> {
    let addressed = lesson.addressed();
    let (mut left, mut others) = (Budget::FILE.left, addressed.len() as u64);
    let mut all = Vec::new();
    for (address, lab) in addressed {
        let mut share = left / others.max(1);
        others = others.saturating_sub(1);
        let one = ready.iter().find(|r| std::ptr::eq(r.lab, lab));
        let mut runs: Vec<(SnapshotInput, SnapshotRun)> = Vec::new();
        let inputs = snapshot_inputs(lab);
        let mut incomplete = 0;
        for (i, input) in inputs.into_iter().enumerate() {
            let Some(one) = one else { break };
            if i > 0 && share == 0 {
                incomplete += 1;
                continue;
            }
            let Ok((run, spent)) = play(one, &input, StepVariant::NOMINAL, Budget::TRIAL) else {
                continue;
            };
            share = share.saturating_sub(spent);
            left = left.saturating_sub(spent);
            incomplete += usize::from(run.is_cut);
            runs.push((input, run));
        }
        all.push(LabRuns { address, lab, ready: one, runs, incomplete });
    }
    all
}

/// As loaded, then with each control moved.
fn snapshot_inputs(lab: &Lab) -> Vec<SnapshotInput> {
    let mut all = vec![SnapshotInput { name: "as it stands".into(), set: Vec::new(), press: Vec::new() }];
    for control in &lab.controls {
        let label = &control.label.value;
        let mut moved = |value: Value, start: &Value| {
            if value != *start {
                let name = format!("with \"{label}\" at {value}");
                all.push(SnapshotInput { name, set: vec![(label.clone(), value)], press: Vec::new() });
            }
        };
        match &control.kind {
            ControlKind::Slider { min, max, value, .. } => {
                let start = Value::Number(value.value);
                moved(Value::Number(min.value), &start);
                moved(Value::Number(max.value), &start);
            }
            ControlKind::Select { options, value, .. } => {
                let start = crate::bind::scalar(value);
                options.iter().for_each(|o| moved(crate::bind::scalar(&o.value), &start));
            }
            ControlKind::Button { .. } => {
                let name = format!("after \"{label}\" is pressed");
                let press = vec![(label.clone(), PRESS_TIME.min(0.5 * window(lab)))];
                all.push(SnapshotInput { name, set: Vec::new(), press });
            }
        }
    }
    all
}

/// Makes a run; returns the work that it took.
pub(super) fn play(
    ready: &PreparedLab<'_>,
    input: &SnapshotInput,
    numerics: StepVariant,
    budget: Budget,
) -> Result<(SnapshotRun, u64), RunError> {
    let (lab, programs) = (ready.lab, &ready.programs);
    let start = Start { budget, ..Start::of_lab(lab) };
    let mut session = Session::start(programs, &ready.model, start);
    run::set_controls(&mut session, lab, programs, &input.set)?;
    let presses = run::presses(programs, &input.press)?;
    let about = about(lab, &session.world.model);
    let timestep = session.world.model.opt.timestep;
    let count = run::count_steps(lab, Some(window(lab)), None, timestep)?;
    let stated = states_timestep(ready, input);
    session.perturb(numerics, stated);
    // The same duration at any timestep.
    let finer = if stated { 1 } else { (1.0 / numerics.timestep).round() as usize };
    let mut looks: Vec<usize> = (0..=SAMPLES).map(|i| (count * i + SAMPLES / 2) / SAMPLES).collect();
    looks.dedup();

    let mut samples: Vec<Vec<Cell>> = Vec::new();
    let played = Play { steps: count * finer, stop: None, every: finer, presses: &presses, watched: false };
    run::play(&mut session, &played, |session, step| {
        if looks.binary_search(&(step / finer)).is_ok() {
            samples.push(session.sample());
        }
        ControlFlow::Continue(())
    });
    let column = |i: usize| {
        let cell_at = |k: usize| samples.get(k).and_then(|row| row.get(i)).cloned().unwrap_or(Cell::Nothing);
        (0..looks.len()).map(cell_at).collect::<Vec<Cell>>()
    };
    let rows = programs.probes.iter().enumerate().map(|(i, p)| (p.name.clone(), column(i + 1))).collect();
    let times = looks.iter().map(|&step| step as f64 * timestep).collect();
    let is_cut = matches!(session.ended(), Some(End::Budget { .. }));
    Ok((SnapshotRun { name: input.name.clone(), about, times, rows, is_cut }, session.spent()))
}

/// The length and the numerics of a run.
fn about(lab: &Lab, model: &Model) -> Vec<String> {
    let opt = &model.opt;
    let solver = match opt.solver {
        solver::PGS => "PGS",
        solver::CG => "CG",
        _ => "Newton",
    };
    let cone = if opt.cone == 0 { "pyramidal" } else { "elliptic" };
    vec![
        format!("{} s", significant(window(lab))),
        format!("timestep {} s", opt.timestep),
        Integrator::of_model(model).name.into(),
        solver.into(),
        cone.into(),
    ]
}

/// Whether the lesson itself sets the timestep: then half of it does not test the digits.
fn states_timestep(ready: &PreparedLab<'_>, input: &SnapshotInput) -> bool {
    let writes = |e: &Effects| e.writes.iter().any(|a| a.field.0 as usize == option::timestep.index());
    let set = input.set.iter().filter_map(|(label, _)| ready.programs.effects_of(label));
    set.chain(ready.programs.setup.iter().map(|b| b.program.effects())).any(writes)
}
