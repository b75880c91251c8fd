//! Motion that exceeds every bound without a warning.
//!
//! With bounded forces, speed grows at most in proportion to time: in twice the time it doubles. An instability grows
//! exponentially. A speed is a runaway when three conditions hold. It is a hundred times the speed that gravity and the
//! start can give in a scene of this size. It became ten times larger in the second half of the time since the last change
//! from outside. It never stops growing: from a plausible speed to the end of the run, every eighth of the time is faster
//! than all before. A bounded motion, such as a limit cycle, is not a runaway, however fast it is.

use super::bodies::joint_of_dof;
use super::causes::stiffness_cause;
use super::fault::{Fault, FaultEvidence, FaultKind};
use super::history::RunHistory;
use crate::slides;
use labspec_core::math::norm;
use labspec_core::{Fields, Model};

const FAR_FACTOR: f64 = 100.0;
const SPEED_FACTOR: f64 = 10.0;
/// Number of parts of the time, and the minimum growth factor of each.
const PARTS: usize = 8;
const MIN_GROWTH: f64 = 1.02;
/// Number of calls between two stored samples.
const CALLS_PER_SAMPLE: usize = 8;
/// Number of samples at which every second one is dropped.
const MAX_SAMPLES: usize = 256;

/// Monitors the speeds of a run by stored samples.
#[derive(Debug)]
pub(super) struct RunawayMonitor {
    start: f64,
    /// Degrees of freedom: translations and rotations.
    dofs: [Vec<usize>; 2],
    /// Times, and the largest speeds so far: of translations and of rotations.
    memory: RunHistory<(f64, [f64; 2])>,
    largest: [f64; 2],
    /// The largest speeds at the start.
    first: Option<[f64; 2]>,
    /// A speed above the bound: the time, the degree of freedom, its largest speed, and the bound.
    found: Option<(f64, usize, f64, f64)>,
    /// The values of `found` for a runaway before a change from outside.
    sure: Option<(f64, usize, f64, f64)>,
}

impl RunawayMonitor {
    pub(super) fn new(m: &Model) -> RunawayMonitor {
        let (translations, rotations) = (0..m.nv).partition(|&dof| slides(m, dof));
        RunawayMonitor {
            start: 0.0,
            dofs: [translations, rotations],
            memory: RunHistory::new(CALLS_PER_SAMPLE, MAX_SAMPLES),
            largest: [0.0; 2],
            first: None,
            found: None,
            sure: None,
        }
    }

    pub(super) fn restart(&mut self, m: &Model, time: f64) {
        *self = RunawayMonitor { start: time, sure: self.unbounded_speed(m), ..RunawayMonitor::new(m) };
    }

    /// The speed that never stopped growing.
    fn unbounded_speed(&self, m: &Model) -> Option<(f64, usize, f64, f64)> {
        let grows = |(_, dof, _, bound): &(f64, usize, f64, f64)| {
            let kind = usize::from(!slides(m, *dof));
            let samples = self.memory.samples().iter().map(|(_, largest)| largest[kind]);
            let speeds: Vec<f64> =
                samples.chain([self.largest[kind]]).filter(|v| FAR_FACTOR * v > *bound).collect();
            let last = speeds.len().saturating_sub(1);
            let speed_at = |part: usize| speeds.get(part * last / PARTS).copied().unwrap_or(f64::INFINITY);
            last < PARTS || (0..PARTS).all(|part| speed_at(part + 1) > MIN_GROWTH * speed_at(part))
        };
        self.sure.or(self.found.filter(grows))
    }

    pub(super) fn observe(&mut self, m: &Model, d: &Fields) {
        let current = [0, 1].map(|kind| largest_speed(d, &self.dofs[kind]));
        let first = *self.first.get_or_insert([current[0].0, current[1].0]);
        for k in 0..2 {
            self.largest[k] = self.largest[k].max(current[k].0);
        }
        self.memory.observe(|| (d.time, self.largest));
        if let Some((_, dof, speed, _)) = &mut self.found {
            *speed = speed.max(d.qvel.get(*dof).map_or(0.0, |v| v.abs()));
            return;
        }
        for k in 0..2 {
            let (speed, dof) = current[k];
            if speed <= FAR_FACTOR * first[k] {
                continue;
            }
            let bound = FAR_FACTOR * (first[k] + expected_speeds(m)[k]);
            if speed > bound {
                let half = self.start + 0.5 * (d.time - self.start);
                let samples = self.memory.samples();
                let before = samples.partition_point(|(t, _)| *t <= half);
                let early = before.checked_sub(1).and_then(|i| samples.get(i)).map_or(first, |(_, v)| *v);
                if speed > SPEED_FACTOR * early[k] {
                    self.found = Some((d.time, dof, speed, bound));
                    return;
                }
            }
        }
    }

    pub(super) fn fault(&self, m: &Model) -> Option<Fault> {
        let (time, dof, speed, bound) = self.unbounded_speed(m)?;
        let unit = if slides(m, dof) { "m/s" } else { "rad/s" };
        Some(Fault {
            kind: FaultKind::Silent,
            time,
            subject: joint_of_dof(m, dof),
            cause: stiffness_cause(m)
                .unwrap_or_else(|| "it grows exponentially, and the engine gives no warning".into()),
            evidence: vec![
                FaultEvidence { name: "speed", value: speed, unit },
                FaultEvidence { name: "sensible bound", value: bound, unit },
            ],
            size: speed / bound,
            by_run: false,
        })
    }
}

/// Speeds that a fall through the whole scene gives, of a translation and of a rotation.
fn expected_speeds(m: &Model) -> [f64; 2] {
    let (g, extent) = (norm(m.opt.gravity).max(1.0), m.stat.extent.max(1e-3));
    [(2.0 * g * extent).sqrt(), (2.0 * g / extent).sqrt() + 10.0]
}

/// The largest of the speeds of these degrees of freedom, and the one that has it.
fn largest_speed(d: &Fields, dofs: &[usize]) -> (f64, usize) {
    let mut largest = (0.0, 0);
    for &dof in dofs {
        let speed = d.qvel.get(dof).map_or(0.0, |v| v.abs());
        if speed > largest.0 {
            largest = (speed, dof);
        }
    }
    largest
}
