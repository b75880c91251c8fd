//! One run of a comparison: how it is made, what it showed, and how it ended.

use super::event_finder::{EventFinder, EventThresholds};
use super::event_time::EventTime;
use labspec::run::{self, End, Session};
use labspec_core::{self as core, Data, Full, Model, Warning, state};

/// The samples of a run: after every step, or after so many as the truth is known at.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Rhythm {
    /// Steps from one sample to the next.
    pub(super) steps: usize,
    /// Samples of the truth from one to the next.
    pub(super) stride: usize,
    /// Their number, the start not counted.
    pub(super) count: usize,
}

/// How a run is made, and what is looked for in it.
#[derive(Clone, Copy, Default)]
pub(super) struct RunRequest<'s> {
    /// Every coordinate of the start is moved by this.
    pub(super) perturbation: f64,
    /// All that is shown is of the current state, as in the truth; else what a page shows after a step is partly of the state before
    /// it: forces, energies, contacts. A fresh run is not watched for growth of energy, as every look begins that watch anew.
    pub(super) fresh: bool,
    /// Steps are cut where controls jump.
    pub(super) cut: bool,
    /// The moments that are looked for.
    pub(super) sought: Option<&'s EventThresholds>,
    /// The run is made for its moments alone: it is of no more use after this time, s, or when all are found.
    pub(super) stop: Option<f64>,
}

impl RunRequest<'_> {
    /// As a reference is run.
    pub(super) const FRESH: RunRequest<'static> =
        RunRequest { perturbation: 0.0, fresh: true, cut: false, sought: None, stop: None };
}

/// What a run showed.
#[derive(Clone, Debug, Default)]
pub(super) struct Run {
    /// Values of each target at the run's samples, and of its closed form (NaN without one).
    pub(super) values: Vec<Vec<f64>>,
    pub(super) exact: Vec<Vec<f64>>,
    /// When bodies first touch, when each target first passes through zero, when each first turns back; empty where nobody asked.
    pub(super) moments: Vec<EventTime>,
    /// When the last of them was sure to be one, s.
    pub(super) settled: f64,
    /// Whether bodies touch at the start.
    pub(super) touching: bool,
    /// Whether a force could jump: dry friction, a limit or a contact pushed.
    pub(super) jumps: bool,
    /// Energy, J, and momentum (three of motion, three of turning), where they were looked at.
    pub(super) energy: Vec<f64>,
    pub(super) momentum: Vec<[f64; 6]>,
    /// The largest kinetic energy among them, J.
    pub(super) kinetic: f64,
    /// How deep bodies were in each other at most, m.
    pub(super) penetration: f64,
    /// What became of it.
    pub(super) status: RunStatus,
    /// Everything that was reported about it.
    pub(super) reported: Vec<String>,
    /// Work, in the engine's own units, per simulated second.
    pub(super) work: f64,
}

/// What became of a run.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum RunStatus {
    /// It came to its end.
    #[default]
    Good,
    /// A number was not finite, or too large, and the engine reset the scene.
    Diverged,
    /// It gained energy that nothing gave.
    Grows,
    /// The engine warned of something else: full buffers, bodies without inertia, a control that is no number.
    Warned,
    /// It threw, or took more work than a run may.
    Stopped,
}

impl RunStatus {
    /// In one word.
    pub fn word(self) -> &'static str {
        match self {
            RunStatus::Good => "good",
            RunStatus::Diverged => "diverged",
            RunStatus::Grows => "gains energy",
            RunStatus::Warned => "warned",
            RunStatus::Stopped => "stopped",
        }
    }
}

impl Run {
    /// A run of so many targets and samples, before its start.
    pub(super) fn with_capacity(targets: usize, samples: usize) -> Run {
        let lists = || vec![Vec::with_capacity(samples); targets];
        Run { values: lists(), exact: lists(), ..Run::default() }
    }

    /// Takes over the moments that were found.
    pub(super) fn take_moments(&mut self, finder: EventFinder<'_>) {
        (self.touching, self.settled) = (finder.touches_at_start(), finder.settled());
        self.moments = finder.finish();
    }

    /// Fills up the samples of a run that ended before its time: their values are unknown.
    pub(super) fn fill_up(&mut self, samples: usize) {
        self.values.iter_mut().chain(&mut self.exact).for_each(|list| list.resize(samples, f64::NAN));
    }

    /// Looks at contacts and constraints after a step.
    pub(super) fn observe(&mut self, session: &Session<'_>) {
        let d = session.world.data.fields();
        self.jumps |= d.nefc > d.ne;
        let deepest = d.contact.iter().map(|c| -c.dist).fold(f64::NAN, f64::max);
        if deepest > 0.0 {
            self.penetration = self.penetration.max(deepest);
        }
    }

    /// Sets the fate of a run that ends here.
    pub(super) fn set_fate(&mut self, session: &Session<'_>) {
        let bad = [Warning::BadQpos, Warning::BadQvel, Warning::BadQacc, Warning::BadCtrl];
        self.reported = run::breakdowns_of(session).into_iter().map(|b| b.what).collect();
        self.status = match session.ended() {
            _ if bad.iter().any(|&w| session.warnings[w as usize].number > 0) => RunStatus::Diverged,
            _ if session.growth().is_some() => RunStatus::Grows,
            Some(End::Budget { time }) => {
                self.reported.push(format!("the work budget ran out, so the run ends at {time} s"));
                RunStatus::Stopped
            }
            Some(_) => RunStatus::Stopped,
            None if !self.reported.is_empty() => RunStatus::Warned,
            None => RunStatus::Good,
        };
        if let Some(trouble) = session.troubles.first() {
            self.reported.push(trouble.message.clone());
        }
    }
}

/// Computes energy and momentum in data of its own, so that the run stays as it is.
pub(super) struct EnergySampler {
    data: Data<Full>,
}

impl EnergySampler {
    pub(super) fn new(m: &Model) -> EnergySampler {
        EnergySampler { data: Data::new(m) }
    }

    pub(super) fn sample(&mut self, session: &Session<'_>, seen: &mut Run) {
        let m = &session.world.model;
        // Of one model: nothing can be refused.
        let _ = state::copy(m, &session.world.data, &mut self.data, state::INTEGRATION);
        let energy = core::mechanical_energy(m, &mut self.data).ok().flatten();
        seen.energy.push(energy.map_or(f64::NAN, |e| e.kinetic + e.potential()));
        seen.kinetic = seen.kinetic.max(energy.map_or(0.0, |e| e.kinetic));
        let d = &mut self.data;
        let moving = core::forward(m, d).and_then(|()| core::subtree_vel(m, d));
        let mut momentum = [f64::NAN; 6];
        let of = |list: &[f64], k: usize| list.get(k).copied().unwrap_or(f64::NAN);
        if moving.is_ok() {
            let mass = of(&m.body_subtreemass, 0);
            for k in 0..3 {
                momentum[k] = mass * of(&d.subtree_linvel, k);
                momentum[3 + k] = of(&d.subtree_angmom, k);
            }
        }
        seen.momentum.push(momentum);
    }
}
