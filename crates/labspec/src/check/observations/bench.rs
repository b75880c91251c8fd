//! Additional runs of a lab that confirm an observation: with several controls moved, or from another state.

use super::moves::Move;
use super::record::{InputsOutOfRange, ObservationHash, Record};
use crate::bind::Programs;
use crate::check::PreparedLab;
use crate::run::{self, Budget, Cell, Play, Session, Start};
use std::ops::ControlFlow;

/// A lab with the remaining work budget.
pub(crate) struct ObservationBench<'a> {
    pub(crate) ready: &'a PreparedLab<'a>,
    /// The programs of the lab, or a variant of them.
    pub(crate) programs: &'a Programs,
    pub(crate) left: u64,
    /// Number of runs.
    pub(crate) runs: usize,
}

/// Number of samples of a run.
const SAMPLES: usize = 60;
/// Displacements of the state, in order.
const DISPLACEMENTS: [f64; 4] = [0.01, 0.1, 0.4, 1.0];
/// Number of steps after each displacement.
const STEPS: usize = 3;

impl ObservationBench<'_> {
    /// The work budget of one run.
    pub(crate) fn budget(&self) -> Budget {
        Budget { left: Budget::TRIAL.left.min(self.left) }
    }

    pub(crate) fn start(&self) -> Session<'_> {
        let (PreparedLab { lab, model, .. }, programs) = (self.ready, self.programs);
        let start = Start { budget: self.budget(), ..Start::of_lab(lab) };
        Session::start(programs, model, start)
    }

    /// Number of steps of a run of this length, and the timestep, s.
    pub(crate) fn steps(&self, length: f64) -> Option<(usize, f64)> {
        let timestep = self.start().world.model.opt.timestep;
        let steps = run::count_steps(self.ready.lab, Some(length), None, timestep).ok()?;
        Some((steps, timestep))
    }

    /// Makes a run with these moves; `None` when it breaks, or when the budget runs out.
    pub(crate) fn run(&mut self, moves: &[Move], steps: usize) -> Option<Record> {
        let mut session = self.start();
        let (mut rows, mut hash) = (Vec::new(), ObservationHash::default());
        let every = (steps / SAMPLES).max(1);
        run::play(&mut session, &Play::steps(steps), |session, step| {
            for m in moves.iter().filter(|m| m.step == step) {
                match &m.value {
                    Some(value) => session.set_control(m.control, value.clone()),
                    None if m.control == usize::MAX => session.refresh(),
                    None => session.press(m.control),
                }
            }
            if step % every == 0 || step == steps {
                let row = session.sample();
                hash.observe(&row, session);
                rows.push(row);
            }
            ControlFlow::Continue(())
        });
        hash.close(&session.world.model);
        let (spent, completed) =
            (session.spent(), session.ended().is_none() && run::worst_breakdown(&session).is_none());
        drop(session);
        self.left = self.left.saturating_sub(spent);
        self.runs += 1;
        (completed && self.left > 0).then_some(Record {
            moved: None,
            rows,
            hash,
            beyond: InputsOutOfRange::default(),
        })
    }

    /// The displayed values in states other than that of the lab.
    pub(crate) fn perturbed_run(&mut self) -> Vec<Vec<Cell>> {
        let mut session = self.start();
        let mut rows = Vec::new();
        let mut seed = 1_u64;
        let mut random = move || {
            seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (seed >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
        };
        for size in DISPLACEMENTS {
            let edit = session.world.data.edit();
            for list in [edit.qpos, edit.qvel, edit.ctrl, edit.mocap_pos] {
                list.iter_mut().for_each(|x| *x += size * random());
            }
            session.refresh();
            rows.push(session.sample());
            (0..STEPS).for_each(|_| session.step());
            rows.push(session.sample());
        }
        let spent = session.spent();
        drop(session);
        self.left = self.left.saturating_sub(spent);
        rows
    }
}

/// Work budget of the additional runs of each lab.
const WORK: u64 = 600_000_000;

/// A lab with the records of its runs.
pub(crate) struct ObservedLab<'a> {
    /// As loaded, then with each control at its ends.
    pub(crate) records: &'a [Record],
    pub(crate) bench: ObservationBench<'a>,
    /// The rows of a run from other states; `None` until they are needed.
    perturbed: Option<Vec<Vec<Cell>>>,
    /// Length of each run, s.
    pub(crate) length: f64,
    /// Controls with a finding.
    pub(crate) reported: Vec<usize>,
}

impl<'a> ObservedLab<'a> {
    /// `length` is the length of the recorded runs, s.
    pub(crate) fn new(ready: &'a PreparedLab<'a>, records: &'a [Record], length: f64) -> ObservedLab<'a> {
        let bench = ObservationBench { ready, programs: &ready.programs, left: WORK, runs: 0 };
        ObservedLab { records, bench, perturbed: None, length, reported: Vec::new() }
    }

    pub(crate) fn perturbed_rows(&mut self) -> &[Vec<Cell>] {
        let bench = &mut self.bench;
        self.perturbed.get_or_insert_with(|| bench.perturbed_run())
    }

    /// Describes the runs for a message.
    pub(crate) fn runs(&self) -> String {
        match self.records.len() {
            1 => "the run".into(),
            n => format!("{n} runs, with every control moved"),
        }
    }
}
