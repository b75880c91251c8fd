//! Paths of spatial tendons: their legs, lengths, Jacobians and points.

use super::wrap::{self, Round};
use crate::dynamics::{jacobian, walk};
use crate::kinds::wraptype;
use crate::math::*;
use crate::model::{Fields, Model};

/// Jacobians and points of all paths.
struct Paths {
    jacobian: Vec<f64>,
    /// The object of each point: a geom, [`ON_SITE`] or [`ON_PULLEY`].
    on: Vec<i32>,
    /// The positions of the points, world.
    points: Vec<f64>,
    /// Number of points so far.
    count: usize,
}

const ON_SITE: i32 = -1;
const ON_PULLEY: i32 = -2;

impl Paths {
    fn push(&mut self, on: i32, point: Vec3) {
        // The compiler allocates two points per object of a path, and no path has more.
        if let (Some(o), Some(p)) =
            (self.on.get_mut(self.count), rows_mut::<3>(&mut self.points).get_mut(self.count))
        {
            (*o, *p) = (on, point);
            self.count += 1;
        }
    }
}

/// A leg of a path: the part from a site to the next site.
struct Leg {
    from: usize,
    to: usize,
    /// The geom between them, with the site that selects a side.
    over: Option<(usize, Option<usize>)>,
    /// The divisor of its length.
    divisor: f64,
    /// Whether a pulley precedes it.
    after_pulley: bool,
    /// Whether it is the last leg of a branch.
    ends: bool,
}

/// The legs of a path in order.
struct Legs<'a> {
    m: &'a Model,
    next_wrap: usize,
    end: usize,
    divisor: f64,
}

impl<'a> Legs<'a> {
    fn new(m: &'a Model, t: usize) -> Legs<'a> {
        let first = m.tendon_adr[t] as usize;
        Legs { m, next_wrap: first, end: first + m.tendon_num[t] as usize, divisor: 1.0 }
    }

    /// The kind of an object. The end of the path counts as a pulley, because both end a branch.
    fn kind(&self, wrap: usize) -> i32 {
        if wrap < self.end { self.m.wrap_type[wrap] } else { wraptype::PULLEY }
    }

    fn object(&self, wrap: usize) -> usize {
        self.m.wrap_objid[wrap] as usize
    }
}

impl Iterator for Legs<'_> {
    type Item = Leg;

    fn next(&mut self) -> Option<Leg> {
        let m = self.m;
        if self.next_wrap + 1 >= self.end {
            return None;
        }
        let after_pulley = self.kind(self.next_wrap) == wraptype::PULLEY;
        if after_pulley {
            self.divisor = m.wrap_prm[self.next_wrap];
            self.next_wrap += 1;
        }
        let from = self.next_wrap;
        let geom = from + 1;
        let over = matches!(self.kind(geom), wraptype::SPHERE | wraptype::CYLINDER).then(|| {
            // A program may write this parameter. Any number that is not the id of a site means that there is no side site.
            let side = m.wrap_prm[geom];
            (self.object(geom), (side >= 0.0 && side < m.nsite as f64).then_some(side as usize))
        });
        let to = if over.is_some() { from + 2 } else { from + 1 };
        let ends = self.kind(to + 1) == wraptype::PULLEY;
        self.next_wrap = if ends { to + 1 } else { to };
        let (from, to) = (self.object(from), self.object(to));
        Some(Leg { from, to, over, divisor: self.divisor, after_pulley, ends })
    }
}

/// The length of a spatial tendon, m. Writes its Jacobian and its points to the data.
///
/// `points` is the number of points of all previous paths, and is updated.
#[inline(never)] // fixed tendons do not move the arrays
pub(super) fn spatial(m: &Model, d: &mut Fields, t: usize, points: &mut usize) -> f64 {
    // Removed temporarily, so that the rest of the data can be read while they are written.
    let mut out = Paths {
        jacobian: std::mem::take(&mut d.ten_J),
        on: std::mem::take(&mut d.wrap_obj),
        points: std::mem::take(&mut d.wrap_xpos),
        count: *points,
    };
    let length = path(m, d, t, &mut out);
    *points = out.count;
    (d.ten_J, d.wrap_obj, d.wrap_xpos) = (out.jacobian, out.on, out.points);
    length
}

fn path(m: &Model, d: &Fields, t: usize, out: &mut Paths) -> f64 {
    let site_xpos = rows::<3>(&d.site_xpos);
    let mut length = 0.0;
    for leg in Legs::new(m, t) {
        let ends = [site_xpos[leg.from], site_xpos[leg.to]];
        let bodies = [leg.from, leg.to].map(|s| m.site_bodyid[s] as usize);
        if leg.after_pulley {
            out.push(ON_PULLEY, [0.0; 3]);
        }
        out.push(ON_SITE, ends[0]);
        let arc = leg.over.and_then(|(geom, side)| {
            Some((geom, wrap::around(ends, &round(m, d, geom), side.map(|s| site_xpos[s]))?))
        });
        length += match arc {
            None => straight_segment(m, d, t, bodies, ends, leg.divisor, out),
            Some((geom, arc)) => {
                let on = m.geom_bodyid[geom] as usize;
                let before =
                    straight_segment(m, d, t, [bodies[0], on], [ends[0], arc.from], leg.divisor, out);
                let after = straight_segment(m, d, t, [on, bodies[1]], [arc.to, ends[1]], leg.divisor, out);
                out.push(geom as i32, arc.from);
                out.push(geom as i32, arc.to);
                before + arc.length + after
            }
        } / leg.divisor;
        if leg.ends {
            out.push(ON_SITE, ends[1]);
        }
    }
    length
}

/// The shape that a tendon wraps around.
fn round(m: &Model, d: &Fields, geom: usize) -> Round {
    Round {
        pos: rows::<3>(&d.geom_xpos)[geom],
        mat: rows::<9>(&d.geom_xmat)[geom],
        radius: rows::<3>(&m.geom_size)[geom][0],
        cylinder: m.geom_type[geom] == crate::kinds::geom::CYLINDER,
    }
}

/// The length of a straight piece between points on two bodies. Adds its derivative u·(J₂ - J₁) / divisor, with the direction u,
/// to the Jacobian of the tendon.
fn straight_segment(
    m: &Model,
    d: &Fields,
    t: usize,
    bodies: [usize; 2],
    points: [Vec3; 2],
    divisor: f64,
    out: &mut Paths,
) -> f64 {
    let (u, length) = normalize(sub(points[1], points[0]));
    if bodies[0] == bodies[1] {
        return length;
    }
    let row = super::row(m, t);
    let columns = &m.ten_J_colind[row.clone()];
    let values = &mut out.jacobian[row];
    // Degrees of freedom in descending order, in which `point_difference` visits them. Those that move both ends do
    // not change the distance.
    let mut index = columns.len();
    for (k, side) in walk::moving_one(m, bodies) {
        let sign = if side == 1 { 1.0 } else { -1.0 };
        while index > 0 && columns[index - 1] as usize >= k {
            index -= 1;
        }
        if columns.get(index).is_some_and(|&c| c as usize == k) {
            let (_, move_) = jacobian::dof_motion(m, d, k, points[side]);
            values[index] += sign * dot(move_, u) / divisor;
        }
    }
    length
}

/// J̇ v: the acceleration of a tendon's length due to the velocities alone, m/s².
///
/// A leg with length l, direction u and velocity w of its end relative to its start has the length acceleration u·a + (w·w -
/// (u·w)²)/l, with the relative acceleration a. The compiler refuses wrapping for such tendons.
pub(crate) fn acceleration(m: &Model, d: &Fields, t: usize) -> f64 {
    let site_xpos = rows::<3>(&d.site_xpos);
    let mut sum = 0.0;
    for leg in Legs::new(m, t) {
        let ends = [site_xpos[leg.from], site_xpos[leg.to]];
        let bodies = [leg.from, leg.to].map(|s| m.site_bodyid[s] as usize);
        if bodies[0] == bodies[1] {
            continue;
        }
        let (u, length) = normalize(sub(ends[1], ends[0]));
        let [first, second] = [0, 1].map(|i| jacobian::unforced(m, d, bodies[i], ends[i]));
        let w = sub(second.velocity, first.velocity);
        let a = sub(second.acceleration, first.acceleration);
        let along = dot(u, w);
        let turning = if length > MINVAL { (dot(w, w) - along * along) / length } else { 0.0 };
        sum += (dot(u, a) + turning) / leg.divisor;
    }
    sum
}

/// Calls `apply` with the body, point and force at each end of the straight pieces of a path, for a tendon force that
/// acts in the direction of lengthening. Both ends of an arc around a geom are on the same body.
pub(crate) fn pull(m: &Model, d: &Fields, t: usize, force: f64, apply: &mut impl FnMut(usize, Vec3, Vec3)) {
    let first = d.ten_wrapadr[t] as usize;
    let points = first..first + d.ten_wrapnum[t] as usize;
    let pulleys = m.tendon_adr[t] as usize..(m.tendon_adr[t] + m.tendon_num[t]) as usize;
    let mut divisors = pulleys.filter(|&w| m.wrap_type[w] == wraptype::PULLEY).map(|w| m.wrap_prm[w]);
    // The sites, in the order of the path.
    let sites = m.tendon_adr[t] as usize..(m.tendon_adr[t] + m.tendon_num[t]) as usize;
    let mut sites = sites.filter(|&w| m.wrap_type[w] == wraptype::SITE).map(|w| m.wrap_objid[w] as usize);
    let (mut divisor, mut last) = (1.0, None);
    for k in points {
        let point = rows::<3>(&d.wrap_xpos)[k];
        let body = match d.wrap_obj[k] {
            ON_PULLEY => {
                divisor = divisors
                    .next()
                    .unwrap_or_else(|| 1.0 + broken_invariant::<f64>("a pulley has a divisor"));
                last = None;
                continue;
            }
            ON_SITE => sites.next().map_or(0, |s| m.site_bodyid[s]),
            geom => m.geom_bodyid[geom as usize],
        };
        if let Some((from, start)) = last.replace((body, point))
            && from != body
        {
            let (u, _) = normalize(sub(point, start));
            apply(from as usize, start, scale(u, -force / divisor));
            apply(body as usize, point, scale(u, force / divisor));
        }
    }
}
