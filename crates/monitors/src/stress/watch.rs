//! The monitors that run after every step: bodies that tunnel or penetrate deeply, contacts that switch on and off, and
//! motion that exceeds every bound. They do not modify the run.

use super::bodies::{self, body_of, body_thickness, centre_in_frame, geom_name};
use super::causes::stiffness_cause;
use super::creep::CreepMonitor;
use super::fault::{Fault, FaultEvidence, FaultKind};
use super::height_field::{self, HeightFieldPair};
use super::runaway::RunawayMonitor;
use labspec_core::math::{Vec3, rows, sub};
use labspec_core::{Fields, Model, geom, geom_half_extents, geom_thickness};
use labspec_finding::two_digits;

/// Maximum number of pairs of geoms that are monitored for tunnelling.
pub const MOST_PAIRS: usize = 2000;
/// Maximum number of contact pairs with a history.
const MAX_TOUCHING: usize = 500;
/// Fraction of the size of the smaller body above which a penetration is deep, and its minimum duration, s. Contacts yield
/// for a moment in every fast impact.
const DEEP_FRACTION: f64 = 0.3;
const MIN_DEEP_DURATION: f64 = 0.2;
/// Number of steps of a block in which switches are counted, the minimum number of switches in a block, and the number of
/// consecutive blocks.
const BLOCK: usize = 100;
const MIN_SWITCHES: usize = 45;
const BLOCKS: usize = 2;
/// A body that moves by less than this fraction of its size in a block is nearly at rest.
const REST_FRACTION: f64 = 0.02;

/// The observations of a run.
pub struct RunMonitor {
    pairs: Vec<PassingPair>,
    grounds: Vec<HeightFieldPair>,
    touching: Vec<TouchingPair>,
    wild: RunawayMonitor,
    rest: CreepMonitor,
    faults: Vec<Fault>,
    steps: usize,
    last: f64,
    /// Whether a program writes positions of bodies, which may then jump.
    jumps: bool,
}

/// A geom and another one that it must not pass.
struct PassingPair {
    geoms: [usize; 2],
    before: Option<Vec3>,
    done: bool,
}

/// Two geoms that made contact at least once.
struct TouchingPair {
    geoms: [usize; 2],
    /// The thickness of the smaller body, m.
    size: f64,
    on: bool,
    current: bool,
    switches: usize,
    blocks: usize,
    /// The current depth, the time since which it has been deep, and the largest ratio of depth to size.
    depth_now: f64,
    deep_since: Option<f64>,
    deepest: f64,
    depth: f64,
    time: f64,
    lasted: f64,
    /// The position of the first geom at the start of the block, in the frame of the second, and its largest displacement
    /// since.
    from: Option<Vec3>,
    moved: f64,
    chatters: bool,
}

impl RunMonitor {
    /// `jumps` is true where a program writes positions of bodies.
    pub fn new(m: &Model, jumps: bool) -> RunMonitor {
        let pairs = if jumps { Vec::new() } else { bodies::pairs(m, MOST_PAIRS).0 };
        RunMonitor {
            pairs: pairs.into_iter().map(|geoms| PassingPair { geoms, before: None, done: false }).collect(),
            grounds: if jumps { Vec::new() } else { height_field::over(m, MOST_PAIRS) },
            touching: Vec::new(),
            wild: RunawayMonitor::new(m),
            rest: CreepMonitor::default(),
            faults: Vec::new(),
            steps: 0,
            last: f64::NEG_INFINITY,
            jumps,
        }
    }

    /// Call after bodies were moved from outside: earlier positions are no longer compared.
    pub fn disturb(&mut self, m: &Model, d: &Fields) {
        for pair in &mut self.pairs {
            let [g, p] = pair.geoms;
            pair.before = centre_in_frame(&d.geom_xpos, &d.geom_xmat, g, p).filter(|_| !self.jumps);
        }
        self.grounds.iter_mut().for_each(|over| over.disturb(m, d));
        for t in &mut self.touching {
            (t.switches, t.blocks, t.from, t.deep_since) = (0, 0, None, None);
        }
        self.steps = 0;
        self.wild.restart(m, d.time);
        self.rest.restart();
    }

    /// Call after a step, or at the start.
    pub fn observe(&mut self, m: &Model, d: &Fields) {
        if d.time < self.last || self.jumps {
            self.disturb(m, d);
        }
        self.last = d.time;
        self.pass(m, d);
        self.touch(m, d);
        self.wild.observe(m, d);
        self.rest.observe(m, d);
    }

    /// Detects bodies that passed through each other.
    fn pass(&mut self, m: &Model, d: &Fields) {
        let mut passed = Vec::new();
        for pair in self.pairs.iter_mut().filter(|p| !p.done) {
            let [g, p] = pair.geoms;
            let Some(current) = centre_in_frame(&d.geom_xpos, &d.geom_xmat, g, p) else { continue };
            if let Some(before) = pair.before.replace(current)
                && through(m, p, before, current)
            {
                pair.done = true;
                self.faults.push(tunnelling(m, d, pair.geoms, before, current));
                passed.push([p, g]);
            }
        }
        self.faults.extend(self.grounds.iter_mut().filter_map(|over| over.observe(m, d)));
        // The two orders of a pair are the same event.
        for other in passed {
            self.pairs.iter_mut().filter(|p| p.geoms == other).for_each(|p| p.done = true);
        }
    }

    /// Updates contacts: their depth, and how often they switch.
    fn touch(&mut self, m: &Model, d: &Fields) {
        for contact in &d.contact {
            let geoms = [contact.geom1, contact.geom2];
            let i = match self.touching.iter().position(|t| t.geoms == geoms) {
                Some(i) => i,
                None if self.touching.len() < MAX_TOUCHING => {
                    self.touching.push(TouchingPair::new(m, geoms));
                    self.touching.len() - 1
                }
                None => continue,
            };
            if let Some(touch) = self.touching.get_mut(i) {
                touch.current |= contact.efc_address.is_some();
                touch.depth_now = touch.depth_now.max(-contact.dist);
            }
        }
        self.steps += 1;
        let ends = self.steps.is_multiple_of(BLOCK);
        for touch in &mut self.touching {
            touch.switches += usize::from(touch.current != touch.on);
            (touch.on, touch.current) = (touch.current, false);
            touch.update_depths(d.time);
            let [g, p] = touch.geoms;
            let place = centre_in_frame(&d.geom_xpos, &d.geom_xmat, g, p);
            if let (Some(from), Some(place)) = (touch.from, place) {
                touch.moved = touch.moved.max(labspec_core::math::norm(sub(place, from)));
            }
            if ends {
                let rests = touch.from.is_some() && touch.moved < REST_FRACTION * touch.size;
                touch.blocks = if touch.switches >= MIN_SWITCHES && rests { touch.blocks + 1 } else { 0 };
                if touch.blocks >= BLOCKS && !touch.chatters {
                    touch.chatters = true;
                    self.faults.push(chatter(m, d, touch));
                }
                (touch.switches, touch.from, touch.moved) = (0, place, 0.0);
            }
        }
    }

    /// Drift speed of each body and each joint with friction at the end of the run, by name, m/s or rad/s.
    pub fn drift_speeds(&self, m: &Model) -> Vec<(String, f64)> {
        self.rest.speeds(m)
    }

    /// Geoms that made contact.
    pub fn touching(&self) -> Vec<[usize; 2]> {
        self.touching.iter().map(|t| t.geoms).collect()
    }

    /// All faults, after the run.
    pub fn faults(mut self, m: &Model) -> Vec<Fault> {
        let passed: Vec<Vec<usize>> =
            self.pairs.iter().filter(|p| p.done).map(|p| p.geoms.to_vec()).collect();
        let tunnels = |t: &&TouchingPair| !passed.iter().any(|p| t.geoms.iter().all(|g| p.contains(g)));
        // Of several geoms of two bodies, only the deepest is reported.
        let bodies = |t: &TouchingPair| t.geoms.map(|g| body_of(m, g));
        let deeper = |t: &&TouchingPair| {
            let others = self.touching.iter().filter(|o| bodies(o) == bodies(t));
            others.fold(0.0f64, |most, o| most.max(o.deepest)) <= t.deepest
        };
        let deep = self.touching.iter().filter(|t| t.is_deep()).filter(tunnels).filter(deeper);
        self.faults.extend(deep.map(|t| penetration(m, t)));
        self.faults.extend(self.wild.fault(m));
        self.faults.extend(self.rest.faults(m));
        self.faults
    }
}

impl TouchingPair {
    fn new(m: &Model, geoms: [usize; 2]) -> TouchingPair {
        TouchingPair {
            geoms,
            size: geoms.map(|g| body_thickness(m, body_of(m, g))).into_iter().fold(f64::INFINITY, f64::min),
            on: false,
            current: false,
            switches: 0,
            blocks: 0,
            depth_now: 0.0,
            deep_since: None,
            deepest: 0.0,
            depth: 0.0,
            time: 0.0,
            lasted: 0.0,
            from: None,
            moved: 0.0,
            chatters: false,
        }
    }

    /// Updates the depth after all contacts of a step.
    fn update_depths(&mut self, time: f64) {
        let depth = std::mem::take(&mut self.depth_now);
        let share = depth / self.size;
        if share > self.deepest {
            (self.deepest, self.depth, self.time) = (share, depth, time);
        }
        if share > DEEP_FRACTION {
            let since = *self.deep_since.get_or_insert(time);
            self.lasted = self.lasted.max(time - since);
        } else {
            self.deep_since = None;
        }
    }

    fn is_deep(&self) -> bool {
        self.deepest > DEEP_FRACTION && self.lasted >= MIN_DEEP_DURATION
    }
}

/// Whether a centre that moved between two positions passed through a geom whose centre is the origin: through the
/// inscribed ellipsoid, from outside to outside, or through the middle of a plate, from one face to the other.
fn through(m: &Model, p: usize, from: Vec3, to: Vec3) -> bool {
    let half = geom_half_extents(m, p);
    if half.iter().any(|h| *h <= 0.0) {
        return false;
    }
    let [a, b]: [Vec3; 2] = [from, to].map(|x| std::array::from_fn(|k| x[k] / half[k]));
    let square_length = |v: Vec3| v.iter().map(|x| x * x).sum::<f64>();
    let along = sub(b, a);
    let (start, square) = (square_length(a), square_length(along));
    // A path through the ellipsoid or through the middle of a plate has a point whose square is at most 2, and is not
    // longer than √square: |a| ≤ √2 + √square.
    if start > 2.0 * (2.0 + square) {
        return false;
    }
    let inward = -(0..3).map(|k| a[k] * along[k]).sum::<f64>();
    if square > 0.0 && start > 1.0 && square_length(b) > 1.0 && (0.0..=square).contains(&inward) {
        let nearest = start - inward * inward / square;
        // A path that cuts only the edge is not reported.
        if nearest < 0.8 {
            return true;
        }
    }
    let thin = (0..3).min_by(|&i, &j| half[i].total_cmp(&half[j])).unwrap_or(0);
    let others = [(thin + 1) % 3, (thin + 2) % 3];
    let plate = others.iter().all(|&k| half[k] >= 2.0 * half[thin]);
    if !plate || a[thin] * b[thin] >= 0.0 {
        return false;
    }
    let s = a[thin] / (a[thin] - b[thin]);
    let cross = |k: usize| (a[k] + s * along[k]).abs();
    match m.geom_type.get(p) {
        Some(&geom::BOX) => others.iter().all(|&k| cross(k) < 0.98),
        // A disc, or the area that any hull contains.
        _ => others.iter().map(|&k| cross(k).powi(2)).sum::<f64>() < 0.5,
    }
}

fn tunnelling(m: &Model, d: &Fields, [g, p]: [usize; 2], from: Vec3, to: Vec3) -> Fault {
    let h = m.opt.timestep;
    let moves = |g: usize| m.body_treeid.get(body_of(m, g)).is_some_and(|&t| t >= 0);
    let [g, p] = if moves(g) || !moves(p) { [g, p] } else { [p, g] };
    let travel = labspec_core::math::norm(sub(to, from));
    let [thick, own_thickness] = [geom_thickness(m, p), geom_thickness(m, g)];
    let cause = if travel > thick + own_thickness {
        format!(
            "in one step of {} s it moves farther than both are thick, so no step finds a contact",
            two_digits(h)
        )
    } else if travel > thick {
        "in one step it moves farther than the other is thick, and is pushed out on the far side".to_string()
    } else {
        "the contact is too weak to hold it, so it is pressed to the other side".to_string()
    };
    Fault {
        kind: FaultKind::Tunnels,
        time: (d.time - h).max(0.0),
        subject: format!("{} through {}", geom_name(m, g), geom_name(m, p)),
        cause,
        evidence: vec![
            FaultEvidence { name: "distance in one step", value: travel, unit: "m" },
            FaultEvidence { name: "thickness of what it passes", value: thick, unit: "m" },
            FaultEvidence { name: "own thickness", value: own_thickness, unit: "m" },
        ],
        size: travel / thick,
        by_run: false,
    }
}

fn penetration(m: &Model, t: &TouchingPair) -> Fault {
    let [g, p] = t.geoms;
    let solref = rows::<2>(&m.geom_solref);
    let [time, _] =
        [g, p].iter().filter_map(|&g| solref.get(g)).fold([0.0; 2], |a, b| if b[0] > a[0] { *b } else { a });
    let mass = |g: usize| m.body_mass.get(body_of(m, g)).copied().unwrap_or(0.0);
    let ratio = (mass(g) / mass(p)).max(mass(p) / mass(g));
    let cause = if t.time <= m.opt.timestep {
        "they overlap at the start".to_string()
    } else if ratio.is_finite() && ratio > 100.0 {
        format!("one is {} times as heavy as the other", two_digits(ratio))
    } else {
        format!("the contact is soft: its time constant is {} s", two_digits(time))
    };
    Fault {
        kind: FaultKind::Penetrates,
        time: t.time,
        subject: format!("{} and {}", geom_name(m, g), geom_name(m, p)),
        cause,
        evidence: vec![
            FaultEvidence { name: "depth", value: t.depth, unit: "m" },
            FaultEvidence { name: "size of the smaller one", value: t.size, unit: "m" },
            FaultEvidence { name: "share", value: t.deepest, unit: "" },
            FaultEvidence { name: "lasts", value: t.lasted, unit: "s" },
        ],
        size: t.deepest,
        by_run: false,
    }
}

fn chatter(m: &Model, d: &Fields, t: &TouchingPair) -> Fault {
    let [g, p] = t.geoms;
    let cause = stiffness_cause(m).unwrap_or_else(|| {
        format!("the contact is too hard, or has too little damping, for a step of {} s", m.opt.timestep)
    });
    Fault {
        kind: FaultKind::Chatters,
        time: d.time - (BLOCK * BLOCKS) as f64 * m.opt.timestep,
        subject: format!("{} on {}", geom_name(m, g), geom_name(m, p)),
        cause,
        evidence: vec![
            FaultEvidence { name: "switches in 100 steps", value: t.switches as f64, unit: "" },
            FaultEvidence { name: "moves meanwhile", value: t.moved, unit: "m" },
        ],
        size: t.switches as f64,
        by_run: false,
    }
}
