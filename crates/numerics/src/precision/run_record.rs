//! One run of a comparison: how it is performed, its results, and its outcome.

use super::event_finder::{EventFinder, EventThresholds};
use super::event_time::EventTime;
use labspec::run::{self, End, Session};
use labspec_core::{self as core, Data, Full, Model, Warning, state};

/// The samples of a run: after every step, or after as many steps as there are between samples of the reference.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct SamplingPlan {
    /// The number of steps from one sample to the next.
    pub(super) steps: usize,
    /// The number of samples of the reference from one sample to the next.
    pub(super) stride: usize,
    /// The number of samples, without the start.
    pub(super) count: usize,
}

/// How a run is performed, and which events are located.
#[derive(Clone, Copy, Default)]
pub(super) struct RecordRequest<'s> {
    /// Every coordinate of the start is shifted by this.
    pub(super) perturbation: f64,
    /// Whether all displayed values belong to the current state, as in the reference. Otherwise, as on a page, values such as
    /// forces, energies and contacts may belong to the state before the last step. A fresh run is not monitored for growing
    /// energy, because every refresh restarts that monitor.
    pub(super) fresh: bool,
    /// Whether steps are split where controls jump.
    pub(super) cut: bool,
    /// The events to locate.
    pub(super) sought: Option<&'s EventThresholds>,
    /// The run is performed only for its events: it stops after this time, s, or when all are found.
    pub(super) stop: Option<f64>,
}

impl RecordRequest<'_> {
    /// The request for a run of the reference.
    pub(super) const REFERENCE_REQUEST: RecordRequest<'static> =
        RecordRequest { perturbation: 0.0, fresh: true, cut: false, sought: None, stop: None };
}

/// The results of a run.
#[derive(Clone, Debug, Default)]
pub(super) struct SampledRun {
    /// The values of each target at the samples; `exact` are those of its closed form (NaN if there is none).
    pub(super) values: Vec<Vec<f64>>,
    pub(super) exact: Vec<Vec<f64>>,
    /// The first contact, the first zero crossing and the first turning point of each target; empty if not requested.
    pub(super) moments: Vec<EventTime>,
    /// The time at which the last event was confirmed, s.
    pub(super) settled: f64,
    /// Whether bodies are in contact at the start.
    pub(super) touching: bool,
    /// Whether a force could jump: dry friction, a limit or a contact was active.
    pub(super) jumps: bool,
    /// Energy, J, and momentum (three linear and three angular components), if they were evaluated.
    pub(super) energy: Vec<f64>,
    pub(super) momentum: Vec<[f64; 6]>,
    /// The largest kinetic energy among these samples, J.
    pub(super) kinetic: f64,
    /// The largest penetration depth, m.
    pub(super) penetration: f64,
    /// The outcome.
    pub(super) status: RunStatus,
    /// All messages about the run.
    pub(super) reported: Vec<String>,
    /// The work per simulated second, in units of the engine.
    pub(super) work: f64,
}

/// The outcome of a run.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum RunStatus {
    /// The run reached its end.
    #[default]
    Good,
    /// A number was not finite, or too large, and the engine reset the scene.
    Diverged,
    /// The energy increased without a source.
    Grows,
    /// The engine reported another warning: full buffers, bodies without inertia, a control that is NaN.
    Warned,
    /// A program failed, or the run exceeded its work limit.
    Stopped,
}

impl RunStatus {
    /// Every status.
    pub const ALL: [RunStatus; 5] =
        [RunStatus::Good, RunStatus::Diverged, RunStatus::Grows, RunStatus::Warned, RunStatus::Stopped];

    /// The status in words.
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

impl SampledRun {
    /// A run with capacity for this many targets and samples, before its start.
    pub(super) fn with_capacity(targets: usize, samples: usize) -> SampledRun {
        let lists = || vec![Vec::with_capacity(samples); targets];
        SampledRun { values: lists(), exact: lists(), ..SampledRun::default() }
    }

    /// Stores the events that were found.
    pub(super) fn take_moments(&mut self, finder: EventFinder<'_>) {
        (self.touching, self.settled) = (finder.touches_at_start(), finder.settled());
        self.moments = finder.finish();
    }

    /// Fills the remaining samples of a run that ended early with NaN.
    pub(super) fn fill_up(&mut self, samples: usize) {
        self.values.iter_mut().chain(&mut self.exact).for_each(|list| list.resize(samples, f64::NAN));
    }

    /// Evaluates contacts and constraints after a step.
    pub(super) fn observe(&mut self, session: &Session<'_>) {
        let d = session.world.data.fields();
        self.jumps |= d.nefc > d.ne;
        let deepest = d.contact.iter().map(|c| -c.dist).fold(f64::NAN, f64::max);
        if deepest > 0.0 {
            self.penetration = self.penetration.max(deepest);
        }
    }

    /// Sets the status of a run at its end.
    pub(super) fn set_status(&mut self, session: &Session<'_>) {
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
        if let Some(program_error) = session.program_errors.first() {
            self.reported.push(program_error.message.clone());
        }
    }
}

/// Computes energy and momentum in separate data, so that the run is not changed.
pub(super) struct EnergySampler {
    data: Data<Full>,
}

impl EnergySampler {
    pub(super) fn new(m: &Model) -> EnergySampler {
        EnergySampler { data: Data::new(m) }
    }

    pub(super) fn sample(&mut self, session: &Session<'_>, seen: &mut SampledRun) {
        let m = &session.world.model;
        // Both data belong to the same model, so this cannot fail.
        let _ = state::copy(m, &session.world.data, &mut self.data, state::INTEGRATION);
        let energy = core::mechanical_energy(m, &mut self.data).ok().flatten();
        seen.energy.push(energy.map_or(f64::NAN, |e| e.kinetic + e.potential()));
        seen.kinetic = seen.kinetic.max(energy.map_or(0.0, |e| e.kinetic));
        let d = &mut self.data;
        let moving = core::forward(m, d).and_then(|()| core::subtree_vel(m, d));
        let mut momentum = [f64::NAN; 6];
        let value_at = |list: &[f64], k: usize| list.get(k).copied().unwrap_or(f64::NAN);
        if moving.is_ok() {
            let mass = value_at(&m.body_subtreemass, 0);
            for k in 0..3 {
                momentum[k] = mass * value_at(&d.subtree_linvel, k);
                momentum[3 + k] = value_at(&d.subtree_angmom, k);
            }
        }
        seen.momentum.push(momentum);
    }
}
