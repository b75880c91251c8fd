//! The rows of contacts: the normal direction, and for friction the edges of a pyramid or the axes of a cone.

use super::ConstraintScratch;
use super::cost::Cost;
use super::impedance::{Acts, Kbi, kbi, kbi_friction};
use super::jacobian::ConstraintJacobian;
use super::kind;
use super::rows::{ConstraintRows, inverse_weight, push, regularization};
use crate::dynamics::jacobian::{self, Columns};
use crate::kinds::{cone, exclude};
use crate::math::*;
use crate::model::{Contact, Fields, Model};
use wide::f64x4;

/// Upper limit of the number of contact rows.
#[cfg_attr(not(feature = "small"), inline(always))]
pub(super) fn count(m: &Model, d: &Fields) -> usize {
    let rows = |c: &Contact| match c.dim {
        1 => 1,
        dim if m.opt.cone == cone::PYRAMIDAL => 2 * (dim - 1),
        dim => dim,
    };
    d.contact.iter().map(rows).sum()
}

/// Creates the rows of all active contacts, in their order.
///
/// A contact that no degree of freedom opens or closes has no rows. There is one exception: with dense matrices, two
/// geoms on the same moving body have rows of zeros, as in MuJoCo. The forces of these rows have no effect.
pub(super) fn make(m: &Model, d: &mut Fields, w: &mut ConstraintScratch) {
    let mut list = std::mem::take(&mut d.contact);
    let ConstraintScratch { jac, columns, .. } = w;
    for (id, c) in list.iter_mut().enumerate() {
        c.efc_address = None;
        if c.exclude != exclude::NO {
            continue;
        }
        let bodies = [m.geom_bodyid[c.geom1] as usize, m.geom_bodyid[c.geom2] as usize];
        jacobian::point_difference(m, d, bodies, c.pos, &c.frame, columns);
        if columns.dofs().is_empty() && !(super::is_dense(m) && columns.push_zero_column(m, bodies[0])) {
            // In a model without degrees of freedom, nothing reads which contacts have rows, so they are not marked.
            c.exclude = if m.nv > 0 { exclude::NO_DOFS } else { exclude::NO };
            continue;
        }
        c.efc_address = Some(d.nefc);
        match (c.dim, m.opt.cone) {
            (1 | 3, cone::PYRAMIDAL) => common(m, d, jac, id, c, bodies, columns),
            _ => other(m, d, jac, id, c, bodies, columns),
        }
    }
    d.contact = list;
}

/// The properties common to all rows of a contact.
#[cfg_attr(not(feature = "small"), inline(always))]
fn shared<const R: usize>(
    c: &Contact,
    id: usize,
    kind: i32,
    kbi: Kbi,
    others: Kbi,
    r: [f64; R],
) -> ConstraintRows<R> {
    ConstraintRows { kind, id, pos: [c.dist; R], margin: [c.includemargin; R], loss: 0.0, kbi, others, r }
}

/// Creates the rows of contacts without friction, and of pyramids for sliding friction, with the edges n ± μ t.
#[cfg_attr(not(feature = "small"), inline(always))]
fn common(
    m: &Model,
    d: &mut Fields,
    jac: &mut ConstraintJacobian,
    id: usize,
    c: &mut Contact,
    bodies: [usize; 2],
    columns: &Columns,
) {
    let (cols, along) = (columns.dofs(), columns.values());
    let (row, mu, mu2) = (d.nefc, c.friction[0], c.friction[1]);
    let kbi = kbi(m, Acts::OneWay, c.solref, c.solimp, c.dist - c.includemargin);
    let translation = inverse_weight(m, bodies, 0);
    if c.dim == 1 {
        jac.push::<1>(Cost::Unilateral, row, cols, along.iter().map(|a| [a[0]]));
        let r = [regularization(kbi.imp, translation)];
        push::<1>(d, &shared(c, id, kind::CONTACT_FRICTIONLESS, kbi, kbi, r));
        return;
    }
    let sides = f64x4::new([mu, -mu, mu2, -mu2]);
    let edges = |&[n, t1, t2]: &Vec3| (f64x4::splat(n) + sides * f64x4::new([t1, t1, t2, t2])).to_array();
    jac.push::<4>(Cost::Unilateral, row, cols, along.iter().map(edges));
    let r = friction(m, c, false, regularization(kbi.imp, translation + mu * mu * translation));
    push::<4>(d, &shared(c, id, kind::CONTACT_PYRAMIDAL, kbi, kbi, r));
}

/// Creates the rows of contacts with torsional and rolling friction, and of elliptic cones.
#[inline(never)]
fn other(
    m: &Model,
    d: &mut Fields,
    jac: &mut ConstraintJacobian,
    id: usize,
    c: &mut Contact,
    bodies: [usize; 2],
    columns: &mut Columns,
) {
    if c.dim > 3 {
        jacobian::rotation_difference(m, d, bodies, &c.frame, columns);
    }
    match (c.dim, m.opt.cone) {
        (1, _) => common(m, d, jac, id, c, bodies, columns),
        (4, cone::PYRAMIDAL) => pyramid::<6>(m, d, jac, id, c, bodies, columns),
        (_, cone::PYRAMIDAL) => pyramid::<10>(m, d, jac, id, c, bodies, columns),
        (3, _) => cone::<3>(m, d, jac, id, c, bodies, columns),
        (4, _) => cone::<4>(m, d, jac, id, c, bodies, columns),
        _ => cone::<6>(m, d, jac, id, c, bodies, columns),
    }
}

/// For each column, velocities in the contact frame: along the normal, along two tangents, about the normal, about
/// both tangents.
#[cfg_attr(not(feature = "small"), inline(always))]
fn space(columns: &Columns) -> impl Iterator<Item = [f64; 6]> {
    let both = columns.values().iter().zip(columns.angular_part());
    both.map(|(v, w)| [v[0], v[1], v[2], w[0], w[1], w[2]])
}

/// Creates a pair of edges n ± μ t for each of the R / 2 friction directions.
fn pyramid<const R: usize>(
    m: &Model,
    d: &mut Fields,
    jac: &mut ConstraintJacobian,
    id: usize,
    c: &mut Contact,
    bodies: [usize; 2],
    columns: &Columns,
) {
    let mu = c.friction;
    let edge = |s: &[f64; 6], r: usize| {
        s[0] + if r.is_multiple_of(2) { mu[r / 2] } else { -mu[r / 2] } * s[1 + r / 2]
    };
    let edges = space(columns).map(|s| std::array::from_fn(|r| edge(&s, r)));
    jac.push::<R>(Cost::Unilateral, d.nefc, columns.dofs(), edges);
    let kbi = kbi(m, Acts::OneWay, c.solref, c.solimp, c.dist - c.includemargin);
    let translation = inverse_weight(m, bodies, 0);
    let r = friction(m, c, false, regularization(kbi.imp, translation + mu[0] * mu[0] * translation));
    push::<R>(d, &shared(c, id, kind::CONTACT_PYRAMIDAL, kbi, kbi, r));
}

/// Creates the row of the normal, and R - 1 rows for the friction directions, which have no stiffness.
fn cone<const R: usize>(
    m: &Model,
    d: &mut Fields,
    jac: &mut ConstraintJacobian,
    id: usize,
    c: &mut Contact,
    bodies: [usize; 2],
    columns: &Columns,
) {
    let axes = space(columns).map(|s| std::array::from_fn(|r| s[r]));
    jac.push::<R>(Cost::Cone, d.nefc, columns.dofs(), axes);
    let kbi = kbi(m, Acts::OneWay, c.solref, c.solimp, c.dist - c.includemargin);
    let others = Kbi { k: 0.0, ..kbi_friction(m, c, kbi) };
    let r = friction(m, c, true, regularization(kbi.imp, inverse_weight(m, bodies, 0)));
    let mut rows = shared::<R>(c, id, kind::CONTACT_ELLIPTIC, kbi, others, r);
    // Only the normal row has a violation.
    for r in 1..R {
        (rows.pos[r], rows.margin[r]) = (0.0, 0.0);
    }
    push::<R>(d, &rows);
}

/// The regularization R of all rows of a contact with friction, from that of the normal. Also sets the friction
/// coefficient of the regularized cone, μ = μ1 / √impratio.
///
/// Every edge of a pyramid has 2 μ² R, which is as soft as the cone. In an elliptic cone, friction direction j has R
/// μ1² / (impratio μj²), which makes the regularization isotropic.
#[cfg_attr(not(feature = "small"), inline(always))]
pub(super) fn friction<const R: usize>(m: &Model, c: &mut Contact, elliptic: bool, normal: f64) -> [f64; R] {
    let mut r = [0.0; R];
    frictions(m, c, elliptic, normal, &mut r);
    r
}

/// Like [`friction`], for any number of rows.
#[cfg_attr(not(feature = "small"), inline(always))]
pub(super) fn frictions(m: &Model, c: &mut Contact, elliptic: bool, normal: f64, r: &mut [f64]) {
    let impratio = m.opt.impratio.max(MINVAL);
    let mu1 = c.friction[0];
    if !elliptic {
        c.mu = mu1 * (1.0 / impratio).sqrt();
        return r.fill((2.0 * c.mu * c.mu * normal).max(MINVAL));
    }
    let first = normal / impratio;
    c.mu = mu1 * (first / normal).sqrt();
    for (i, r) in r.iter_mut().enumerate() {
        *r = match i {
            0 => normal,
            1 => first,
            i => first * mu1 * mu1 / (c.friction[i - 1] * c.friction[i - 1]),
        };
    }
}

/// Adds the velocity of moving surfaces (`geom_surfacevel`) to `efc_vel`: along the tangents, and about the normal.
pub(super) fn surfaces(m: &Model, d: &mut Fields) {
    for i in 0..d.contact.len() {
        let c = &d.contact[i];
        let Some(row) = c.efc_address else { continue };
        let [one, two] = [c.geom1, c.geom2].map(|g| surface(m, d, g, c.pos));
        let linear = mat_mul_vec(&c.frame, sub(two.0, one.0));
        let spin = mat_mul_vec(&c.frame, sub(two.1, one.1))[0];
        let along = [linear[1], linear[2], spin, 0.0, 0.0];
        let (dim, friction, elliptic) = (c.dim, c.friction, d.efc_type[row] == kind::CONTACT_ELLIPTIC);
        let velocities = d.efc_vel[row..].iter_mut();
        if elliptic {
            velocities.skip(1).zip(along).take(dim - 1).for_each(|(v, s)| *v += s);
        } else if dim > 1 {
            for (r, v) in velocities.take(2 * (dim - 1)).enumerate() {
                let edge = friction[r / 2] * along[r / 2];
                *v += if r.is_multiple_of(2) { edge } else { -edge };
            }
        }
    }
}

/// Velocity of the surface of a geom at a point, and its angular velocity, relative to the geom, in world axes.
fn surface(m: &Model, d: &Fields, g: usize, point: Vec3) -> (Vec3, Vec3) {
    let v = &rows::<6>(&m.geom_surfacevel)[g];
    let mat = &rows::<9>(&d.geom_xmat)[g];
    let [linear, turn] = [[v[0], v[1], v[2]], [v[3], v[4], v[5]]].map(|v| mat_mul_vec(mat, v));
    (add(linear, cross(turn, sub(point, rows::<3>(&d.geom_xpos)[g]))), turn)
}

/// Adds R times the adhesion force to `efc_aref`, so that adhesion does not change the violation of a contact.
pub(super) fn adhesion(d: &mut Fields) {
    for c in d.contact.iter().filter(|c| c.adhesion != 0.0) {
        let Some(row) = c.efc_address else { continue };
        let rows = if d.efc_type[row] == kind::CONTACT_PYRAMIDAL { 2 * (c.dim - 1) } else { 1 };
        for (aref, r) in d.efc_aref[row..].iter_mut().zip(&d.efc_R[row..]).take(rows) {
            *aref += r * c.adhesion / rows as f64;
        }
    }
}
