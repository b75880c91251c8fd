//! Runs of a lab that are made to be sure: with several controls moved, or from another state.

use super::moves::Move;
use super::record::{Beyond, ObservationHash, Record};
use crate::bind::Programs;
use crate::check::PreparedLab;
use crate::run::{self, Budget, Cell, Play, Session, Start};
use labspec_core::{Model, Obj};
use std::ops::ControlFlow;

/// A lab, and what may still be spent on it.
pub(crate) struct ObservationBench<'a> {
    pub(crate) ready: &'a PreparedLab<'a>,
    /// Its programs, or what is tried instead.
    pub(crate) programs: &'a Programs,
    pub(crate) left: u64,
    /// Runs that were made.
    pub(crate) runs: usize,
}

/// How often a run is observed at.
const SAMPLES: usize = 60;
/// How far a state is moved, in turn.
const DISPLACEMENTS: [f64; 4] = [0.01, 0.1, 0.4, 1.0];
/// Steps after each.
const STEPS: usize = 3;

impl ObservationBench<'_> {
    /// What one run may spend.
    pub(crate) fn budget(&self) -> Budget {
        Budget { left: Budget::TRIAL.left.min(self.left) }
    }

    pub(crate) fn start(&self) -> Session<'_> {
        let (PreparedLab { lab, model, .. }, programs) = (self.ready, self.programs);
        let start = Start { budget: self.budget(), ..Start::of_lab(lab) };
        Session::start(programs, model, start)
    }

    /// Number of steps of a run of this length, and the timestep.
    pub(crate) fn steps(&self, length: f64) -> Option<(usize, f64)> {
        let timestep = self.start().world.model.opt.timestep;
        let steps = run::count_steps(self.ready.lab, Some(length), None, timestep).ok()?;
        Some((steps, timestep))
    }

    /// A run with these moves; `None` when it breaks, or when too much was spent.
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
        (completed && self.left > 0).then_some(Record { moved: None, rows, hash, beyond: Beyond::default() })
    }

    /// What is shown from other states than the lab's own.
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

/// Work for the runs that make sure, for each lab.
const WORK: u64 = 600_000_000;

/// A lab with the records of its runs.
pub(crate) struct ObservedLab<'a> {
    /// As it stands, then with each control at its ends.
    pub(crate) records: &'a [Record],
    pub(crate) bench: ObservationBench<'a>,
    /// The rows of a run from another state; `None` until they are needed.
    perturbed: Option<Vec<Vec<Cell>>>,
    /// How long each run was, s.
    pub(crate) length: f64,
    /// Controls that a finding describes already.
    pub(crate) reported: Vec<usize>,
}

impl<'a> ObservedLab<'a> {
    /// From the records of runs that are `length` seconds long.
    pub(crate) fn new(ready: &'a PreparedLab<'a>, records: &'a [Record], length: f64) -> ObservedLab<'a> {
        let bench = ObservationBench { ready, programs: &ready.programs, left: WORK, runs: 0 };
        ObservedLab { records, bench, perturbed: None, length, reported: Vec::new() }
    }

    pub(crate) fn perturbed_rows(&mut self) -> &[Vec<Cell>] {
        let bench = &mut self.bench;
        self.perturbed.get_or_insert_with(|| bench.perturbed_run())
    }

    /// The runs in words.
    pub(crate) fn runs(&self) -> String {
        match self.records.len() {
            1 => "the run".into(),
            n => format!("{n} runs, with every control moved"),
        }
    }
}

/// A geom, in words.
pub(crate) fn geom_name(model: &Model, g: usize) -> String {
    match model.names.of_kind(Obj::Geom).get(g).filter(|n| !n.is_empty()) {
        Some(geom) => format!("geom \"{geom}\""),
        None => format!("geom {g}"),
    }
}
