//! What rests and creeps all the same: bodies that touch others with friction and move on at the same small speed, although nothing
//! pushes them along.

use super::bodies::{body_name, body_of, halves};
use super::fault::{Evidence, Fault, FaultKind};
use super::memory::Memory;
use labspec_core::math::{Vec3, norm, rows, sub};
use labspec_core::{Fields, Model};

/// Looks between two entries of the memory, and entries before every second one is forgotten.
const EVERY: usize = 4;
const MOST: usize = 128;
/// A body that moves by less than this part of its size in a second rests; one that moved farther than that part in all creeps.
const RESTS: f64 = 0.1;
const CREEPS: f64 = 0.02;
/// How straight the way is, and how even.
const STRAIGHT: f64 = 0.9;
const EVEN: f64 = 0.2;
/// How long it has to rest at least, s.
const LONG: f64 = 0.5;

/// The memory of a run: times, places of bodies, and which of them touch others.
#[derive(Debug)]
pub(super) struct Rest {
    memory: Memory<(f64, Vec<Vec3>, Vec<bool>)>,
}

impl Default for Rest {
    fn default() -> Rest {
        Rest { memory: Memory::new(EVERY, MOST) }
    }
}

impl Rest {
    pub(super) fn restart(&mut self) {
        *self = Rest::default();
    }

    pub(super) fn look(&mut self, m: &Model, d: &Fields) {
        self.memory.look(|| {
            let mut rubs = vec![false; m.nbody];
            for c in d.contact.iter().filter(|c| c.efc_address.is_some() && c.dim >= 3) {
                for g in [c.geom1, c.geom2] {
                    if let Some(rubs) = rubs.get_mut(body_of(m, g)) {
                        *rubs = true;
                    }
                }
            }
            (d.time, rows::<3>(&d.xpos).to_vec(), rubs)
        });
    }

    /// The second half of what is remembered.
    fn half(&self) -> &[(f64, Vec<Vec3>, Vec<bool>)] {
        let past = self.memory.past();
        past.get(past.len() / 2..).unwrap_or_default()
    }

    /// Bodies that creep in the second half of what is remembered.
    pub(super) fn faults(&self, m: &Model) -> Vec<Fault> {
        let half = self.half();
        let (Some(first), Some(last)) = (half.first(), half.last()) else { return Vec::new() };
        let time = last.0 - first.0;
        if half.len() < 9 || time < LONG {
            return Vec::new();
        }
        let mut list = Vec::new();
        let place =
            |i: usize, b: usize| half.get(i).and_then(|(_, x, _)| x.get(b)).copied().unwrap_or_default();
        let way = |b: usize, from: usize, to: usize| norm(sub(place(to, b), place(from, b)));
        let size = |b: usize| sizes(m, b);
        let end = half.len() - 1;
        // The scene rests when every body in it does.
        let moves = |b: usize| m.body_treeid.get(b).is_some_and(|&t| t >= 0);
        let path = |b: usize| (0..end).map(|i| way(b, i, i + 1)).sum::<f64>();
        if (1..m.nbody).filter(|b| moves(*b)).any(|b| path(b) > RESTS * size(b) * time) {
            return Vec::new();
        }
        for b in (1..m.nbody).filter(|b| moves(*b)) {
            let rubs = half.iter().all(|(_, _, rubs)| rubs.get(b).copied().unwrap_or(false));
            let all = way(b, 0, end);
            let [one, two] =
                [way(b, 0, end / 2) / (end / 2) as f64, way(b, end / 2, end) / (end - end / 2) as f64];
            let even = (one - two).abs() <= EVEN * one.max(two);
            if rubs && all > CREEPS * size(b) && all >= STRAIGHT * path(b) && even {
                list.push(Fault {
                    kind: FaultKind::Drifts,
                    time: first.0,
                    who: body_name(m, b),
                    cause: "friction is soft: what holds a body still lets it creep, slowly and for ever"
                        .into(),
                    evidence: vec![
                        Evidence { name: "speed", value: all / time, unit: "m/s" },
                        Evidence { name: "way", value: all, unit: "m" },
                        Evidence { name: "for", value: time, unit: "s" },
                    ],
                    size: all / time,
                });
            }
        }
        list
    }

    /// How fast each body moved on in the second half of what is remembered, by name, m/s.
    pub(super) fn speeds(&self, m: &Model) -> Vec<(String, f64)> {
        let half = self.half();
        let (Some(first), Some(last)) = (half.first(), half.last()) else { return Vec::new() };
        let ways = last.1.iter().zip(&first.1).map(|(to, from)| norm(sub(*to, *from)) / (last.0 - first.0));
        ways.enumerate().map(|(b, speed)| (body_name(m, b), speed)).collect()
    }
}

/// The largest extent of a body, m.
fn sizes(m: &Model, b: usize) -> f64 {
    let own = (0..m.ngeom).filter(|&g| body_of(m, g) == b);
    let largest = own.map(|g| 2.0 * halves(m, g).into_iter().fold(0.0, f64::max)).fold(0.0, f64::max);
    if largest > 0.0 { largest } else { m.stat.extent }
}
