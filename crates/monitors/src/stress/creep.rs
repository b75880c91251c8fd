//! Detects creep of objects at rest: bodies in frictional contact that move on at the same small speed although no force
//! moves them, and joints that move on although their friction loss exceeds the load.

use super::bodies::{body_name, body_of, joint_of_dof};
use super::fault::{Fault, FaultEvidence, FaultKind};
use super::history::RunHistory;
use labspec_core::math::{Vec3, norm, rows, sub};
use labspec_core::{Fields, Model, disable, geom_half_extents, joint};

/// Number of calls between two stored samples, and the number of samples at which every second one is dropped.
const CALLS_PER_SAMPLE: usize = 4;
const MAX_SAMPLES: usize = 128;
/// A body is at rest if it moves by less than the fraction `REST_SPEED` of its size per second. It creeps if it moved by more
/// than the fraction `CREEP_SPEED` of its size in total.
const REST_SPEED: f64 = 0.1;
const CREEP_SPEED: f64 = 0.02;
/// Minimum straightness of the path, and maximum relative difference of the speeds of its halves.
const MIN_STRAIGHTNESS: f64 = 0.9;
const MAX_SPEED_DIFFERENCE: f64 = 0.2;
/// Minimum duration of rest, s.
const MIN_REST: f64 = 0.5;
/// Minimum displacement of a creeping hinge, rad.
const ANGLE: f64 = 0.01;
/// Friction below this fraction of its limit holds.
const STICKING_FRACTION: f64 = 0.99;
/// The type of a constraint row for the friction loss of a degree of freedom.
const FRICTION_OF_DOF: i32 = 1;

/// A stored sample.
#[derive(Debug)]
struct CreepSample {
    time: f64,
    /// Positions of bodies, m, and which of them are in contact with friction.
    places: Vec<Vec3>,
    rubs: Vec<bool>,
    /// Positions of joints with friction loss, m or rad, and whether their friction is below its limit.
    joints: Vec<(f64, bool)>,
}

/// Monitors the creep of a run by stored samples.
#[derive(Debug)]
pub(super) struct CreepMonitor {
    memory: RunHistory<CreepSample>,
}

impl Default for CreepMonitor {
    fn default() -> CreepMonitor {
        CreepMonitor { memory: RunHistory::new(CALLS_PER_SAMPLE, MAX_SAMPLES) }
    }
}

impl CreepMonitor {
    pub(super) fn restart(&mut self) {
        *self = CreepMonitor::default();
    }

    pub(super) fn observe(&mut self, m: &Model, d: &Fields) {
        self.memory.observe(|| {
            let mut rubs = vec![false; m.nbody];
            for c in d.contact.iter().filter(|c| c.efc_address.is_some() && c.dim >= 3) {
                for g in [c.geom1, c.geom2] {
                    if let Some(rubs) = rubs.get_mut(body_of(m, g)) {
                        *rubs = true;
                    }
                }
            }
            let joints = with_friction(m).map(|(_, qpos, dof)| {
                let q = d.qpos.get(qpos).copied().unwrap_or(0.0);
                (q, is_sticking(d, dof))
            });
            CreepSample { time: d.time, places: rows::<3>(&d.xpos).to_vec(), rubs, joints: joints.collect() }
        });
    }

    /// The second half of the stored samples.
    fn second_half(&self) -> &[CreepSample] {
        let samples = self.memory.samples();
        samples.get(samples.len() / 2..).unwrap_or_default()
    }

    /// Bodies and joints that creep in the second half of the stored samples.
    pub(super) fn faults(&self, m: &Model) -> Vec<Fault> {
        let half = self.second_half();
        let (Some(first), Some(last)) = (half.first(), half.last()) else { return Vec::new() };
        if half.len() < 9 || last.time - first.time < MIN_REST {
            return Vec::new();
        }
        let mut list = bodies(m, half);
        list.extend(joints(m, half));
        list
    }

    /// Drift speed of each body and each joint with friction in the second half of the stored samples, by name, m/s or
    /// rad/s.
    pub(super) fn speeds(&self, m: &Model) -> Vec<(String, f64)> {
        let half = self.second_half();
        let (Some(first), Some(last)) = (half.first(), half.last()) else { return Vec::new() };
        let time = last.time - first.time;
        let speeds = last.places.iter().zip(&first.places).map(|(to, from)| norm(sub(*to, *from)) / time);
        let mut list: Vec<(String, f64)> =
            speeds.enumerate().map(|(b, speed)| (body_name(m, b), speed)).collect();
        let turns = last.joints.iter().zip(&first.joints).map(|(to, from)| (to.0 - from.0).abs() / time);
        list.extend(with_friction(m).zip(turns).map(|((_, _, dof), speed)| (joint_of_dof(m, dof), speed)));
        list
    }
}

/// The creeping bodies.
fn bodies(m: &Model, half: &[CreepSample]) -> Vec<Fault> {
    let (Some(first), Some(last)) = (half.first(), half.last()) else { return Vec::new() };
    let time = last.time - first.time;
    let mut list = Vec::new();
    let place =
        |i: usize, b: usize| half.get(i).and_then(|sample| sample.places.get(b)).copied().unwrap_or_default();
    let distance = |b: usize, from: usize, to: usize| norm(sub(place(to, b), place(from, b)));
    let size = |b: usize| sizes(m, b);
    let end = half.len() - 1;
    // The scene is at rest when every body is.
    let moves = |b: usize| m.body_treeid.get(b).is_some_and(|&t| t >= 0);
    let path = |b: usize| (0..end).map(|i| distance(b, i, i + 1)).sum::<f64>();
    if (1..m.nbody).filter(|b| moves(*b)).any(|b| path(b) > REST_SPEED * size(b) * time) {
        return Vec::new();
    }
    for b in (1..m.nbody).filter(|b| moves(*b)) {
        let rubs = half.iter().all(|sample| sample.rubs.get(b).copied().unwrap_or(false));
        let all = distance(b, 0, end);
        let [one, two] =
            [distance(b, 0, end / 2) / (end / 2) as f64, distance(b, end / 2, end) / (end - end / 2) as f64];
        let even = (one - two).abs() <= MAX_SPEED_DIFFERENCE * one.max(two);
        if rubs && all > CREEP_SPEED * size(b) && all >= MIN_STRAIGHTNESS * path(b) && even {
            list.push(creep(body_name(m, b), first.time, all, time, "m"));
        }
    }
    list
}

/// Joints that move on while their friction is below its limit.
fn joints(m: &Model, half: &[CreepSample]) -> Vec<Fault> {
    let (Some(first), Some(last)) = (half.first(), half.last()) else { return Vec::new() };
    let mut list = Vec::new();
    for (i, (j, _, dof)) in with_friction(m).enumerate() {
        let joint_at = |moment: &CreepSample| moment.joints.get(i).copied().unwrap_or((0.0, false));
        let travel = (joint_at(last).0 - joint_at(first).0).abs();
        let path: f64 =
            half.windows(2).map(|two| two.iter().map(|x| joint_at(x).0).fold(0.0, |a, b| b - a).abs()).sum();
        let slide = m.jnt_type.get(j) == Some(&joint::SLIDE);
        let body = m.jnt_bodyid.get(j).map_or(0, |&b| b as usize);
        let (least, unit) = if slide { (CREEP_SPEED * sizes(m, body), "m") } else { (ANGLE, "rad") };
        if half.iter().all(|moment| joint_at(moment).1) && travel > least && travel >= MIN_STRAIGHTNESS * path
        {
            list.push(creep(joint_of_dof(m, dof), first.time, travel, last.time - first.time, unit));
        }
    }
    list
}

/// Joints with one degree of freedom and friction loss: their ids, and the indexes of their position and velocity.
fn with_friction(m: &Model) -> impl Iterator<Item = (usize, usize, usize)> {
    let on = !m.opt.disabled(disable::FRICTIONLOSS) && !m.opt.disabled(disable::CONSTRAINT);
    (0..m.njnt).filter(move |_| on).filter_map(|j| {
        let single = matches!(m.jnt_type.get(j), Some(&(joint::HINGE | joint::SLIDE)));
        let [qpos, dof] =
            [&m.jnt_qposadr, &m.jnt_dofadr].map(|list| list.get(j).map(|&address| address as usize));
        let (qpos, dof) = (qpos?, dof?);
        let loss = m.dof_frictionloss.get(dof).copied().unwrap_or(0.0);
        (single && loss > 0.0).then_some((j, qpos, dof))
    })
}

/// Whether the friction of a degree of freedom is below its limit.
fn is_sticking(d: &Fields, dof: usize) -> bool {
    let row = (0..d.efc_type.len()).find(|&i| {
        d.efc_type.get(i) == Some(&FRICTION_OF_DOF) && d.efc_id.get(i).is_some_and(|&id| id as usize == dof)
    });
    let value = |list: &[f64]| row.and_then(|i| list.get(i)).copied();
    let (force, most) = (value(&d.efc_force), value(&d.efc_frictionloss));
    force.zip(most).is_some_and(|(force, most)| force.abs() < STICKING_FRACTION * most)
}

fn creep(subject: String, since: f64, travel: f64, time: f64, unit: &'static str) -> Fault {
    let speed = if unit == "m" { "m/s" } else { "rad/s" };
    Fault {
        kind: FaultKind::Drifts,
        time: since,
        subject,
        cause: "friction is soft: what it holds creeps, slowly and forever".into(),
        evidence: vec![
            FaultEvidence { name: "speed", value: travel / time, unit: speed },
            FaultEvidence { name: "way", value: travel, unit },
            FaultEvidence { name: "for", value: time, unit: "s" },
        ],
        size: travel / time,
        by_run: false,
    }
}

/// The largest extent of a body, m.
fn sizes(m: &Model, b: usize) -> f64 {
    let geoms = (0..m.ngeom).filter(|&g| body_of(m, g) == b);
    let largest =
        geoms.map(|g| 2.0 * geom_half_extents(m, g).into_iter().fold(0.0, f64::max)).fold(0.0, f64::max);
    if largest > 0.0 { largest } else { m.stat.extent }
}
