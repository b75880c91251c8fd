//! How the coupled parameter of each pair follows from the model before and after a program.

use super::change::{Changes, PartnerChange};
use super::shape;
use labspec_core::math::{norm, rows, sub};
use labspec_core::{Model, biastype, gaintype};

/// A field of the model before and after a program.
type BeforeAndAfter<'m> = (&'m [f64], &'m [f64]);

/// An element before and after a program.
fn element_of((before, after): BeforeAndAfter<'_>, i: usize) -> Option<(f64, f64)> {
    Some((*before.get(i)?, *after.get(i)?))
}

fn same(both: BeforeAndAfter<'_>, i: usize) -> bool {
    element_of(both, i).is_some_and(|(a, b)| a.to_bits() == b.to_bits())
}

fn factor(both: BeforeAndAfter<'_>, i: usize) -> Option<f64> {
    let (a, b) = element_of(both, i)?;
    (a > 0.0 && b > 0.0 && b.is_finite()).then_some(b / a)
}

/// The inertia is proportional to the mass.
pub(super) fn inertia_of_mass(before: &Model, current: &Model) -> Changes {
    let (mass, inertia) =
        ((&*before.body_mass, &*current.body_mass), (&*before.body_inertia, &*current.body_inertia));
    let mut changes = Vec::new();
    for body in (1..current.nbody).filter(|b| !same(mass, *b)) {
        let Some(f) = factor(mass, body) else { continue };
        let unwritten = (3 * body..3 * body + 3).filter(|i| same(inertia, *i));
        changes.extend(unwritten.map(|i| (i, PartnerChange::Times(f))));
    }
    changes
}

/// Relative tolerance for the rounding error of the reach of a body.
const ROUNDING: f64 = 1e-9;

/// The distance of the farthest point of a body from its centre of mass, m; `None` where its geoms do not determine it.
fn reach(m: &Model, body: usize) -> Option<f64> {
    let centre = rows::<3>(&m.body_ipos).get(body)?;
    let geoms = (0..m.ngeom).filter(|g| m.geom_bodyid.get(*g).is_some_and(|b| *b as usize == body));
    let mut far: Option<f64> = None;
    for g in geoms {
        let radius = m.geom_rbound.get(g).copied().filter(|r| *r > 0.0)?;
        let here = norm(sub(*rows::<3>(&m.geom_pos).get(g)?, *centre)) + radius;
        far = Some(far.map_or(here, |f| f.max(here)));
    }
    far
}

/// The principal moments of a body before and after a program, and the largest factor between them, if the program changed
/// any.
fn moments(before: &Model, current: &Model, body: usize) -> Option<([f64; 3], [f64; 3], f64)> {
    let [a, b] = [before, current].map(|m| rows::<3>(&m.body_inertia).get(body).copied());
    let (a, b) = (a?, b?);
    let factors =
        a.iter().zip(&b).filter(|(x, y)| x.to_bits() != y.to_bits() && **x > 0.0).map(|(x, y)| y / x);
    let largest = factors.fold(f64::NAN, f64::max);
    (largest > 0.0 && largest.is_finite()).then_some((a, b, largest))
}

/// No mass is farther from the axis than the reach r of the body: a moment above m r² needs a larger mass.
pub(super) fn mass_of_inertia(before: &Model, current: &Model) -> Changes {
    let mass = (&*before.body_mass, &*current.body_mass);
    let most = |x: [f64; 3]| x.into_iter().fold(0.0, f64::max);
    let too_large = |m: &Model, body: usize, moments: [f64; 3]| {
        let bound = m.body_mass.get(body).zip(reach(m, body)).map(|(mass, r)| mass * r * r);
        bound.is_some_and(|bound| most(moments) > bound * (1.0 + ROUNDING))
    };
    let one = |body: usize| {
        let (a, b, factor) = moments(before, current, body)?;
        let wrong = same(mass, body) && !too_large(before, body, a) && too_large(current, body, b);
        wrong.then_some((body, PartnerChange::Times(factor)))
    };
    (1..current.nbody).filter_map(one).collect()
}

/// No principal moment exceeds the sum of the other two.
pub(super) fn other_moments(before: &Model, current: &Model) -> Changes {
    let inertia = (&*before.body_inertia, &*current.body_inertia);
    let possible = |[a, b, c]: [f64; 3]| {
        let largest = a.max(b).max(c);
        2.0 * largest <= (a + b + c) * (1.0 + ROUNDING)
    };
    let mut changes = Vec::new();
    for body in 1..current.nbody {
        let Some((a, b, factor)) = moments(before, current, body) else { continue };
        if possible(a) && !possible(b) {
            let unwritten = (3 * body..3 * body + 3).filter(|i| same(inertia, *i));
            changes.extend(unwritten.map(|i| (i, PartnerChange::Times(factor))));
        }
    }
    changes
}

/// The geoms whose size or position was changed.
fn changed<'m>(
    before: &'m Model,
    current: &'m Model,
    numbers: fn(&Model) -> &[f64],
) -> impl Iterator<Item = usize> + 'm {
    let [a, b] = [before, current].map(numbers);
    (0..current.ngeom).filter(move |g| (3 * g..3 * g + 3).any(|i| !same((a, b), i)))
}

/// The collision test uses the bounding radius.
pub(super) fn bound_of_size(before: &Model, current: &Model) -> Changes {
    let bounds = (&*before.geom_rbound, &*current.geom_rbound);
    let one = |g: usize| {
        let radius = shape::shape_of_geom(current, g)?.radius;
        (same(bounds, g) && current.geom_rbound.get(g) != Some(&radius))
            .then_some((g, PartnerChange::Becomes(radius)))
    };
    changed(before, current, |m| &m.geom_size).filter_map(one).collect()
}

/// If the mass of a body is that of one geom, its inertia is that of the shape of the geom.
pub(super) fn inertia_of_size(before: &Model, current: &Model) -> Changes {
    let inertia = (&*before.body_inertia, &*current.body_inertia);
    let mut changes = Vec::new();
    for g in changed(before, current, |m| &m.geom_size) {
        let Some(body) = shape::body_of_geom_mass(before, g) else { continue };
        let [old, new] = [before, current].map(|m| shape::moments(m, g, body));
        let (Some(old), Some(new)) = (old, new) else { continue };
        let elements = 3 * body..3 * body + 3;
        for ((i, a), b) in elements.zip(old).zip(new).filter(|((i, _), _)| same(inertia, *i)) {
            changes.push((i, PartnerChange::Times(b / a)));
        }
    }
    changes
}

/// If the mass of a body is that of one geom, its centre of mass is the position of the geom.
pub(super) fn centre_of_place(before: &Model, current: &Model) -> Changes {
    let (place, centre) =
        ((&*before.geom_pos, &*current.geom_pos), (&*before.body_ipos, &*current.body_ipos));
    let mut changes = Vec::new();
    for g in changed(before, current, |m| &m.geom_pos) {
        let Some(body) = shape::body_of_geom_mass(before, g) else { continue };
        for axis in 0..3 {
            let Some((a, b)) = element_of(place, 3 * g + axis).filter(|(a, b)| a != b) else { continue };
            if same(centre, 3 * body + axis) {
                changes.push((3 * body + axis, PartnerChange::Plus(b - a)));
            }
        }
    }
    changes
}

/// Number of gain parameters, and of bias parameters, of an actuator.
const PARAMETERS: usize = 10;

/// The index of the bias parameter of a servo that is minus its gain: that of the position or of the velocity.
pub(super) fn servo(m: &Model, actuator: usize) -> Option<usize> {
    let is = |list: &[i32], kind| list.get(actuator) == Some(&kind);
    if !is(&m.actuator_gaintype, gaintype::FIXED) || !is(&m.actuator_biastype, biastype::AFFINE) {
        return None;
    }
    let gain = *m.actuator_gainprm.get(PARAMETERS * actuator)?;
    let opposite = |k: &usize| m.actuator_biasprm.get(PARAMETERS * actuator + k).is_some_and(|b| *b == -gain);
    [1, 2].into_iter().find(opposite).filter(|_| gain != 0.0).map(|k| PARAMETERS * actuator + k)
}

/// A servo applies gain * (target - length), so its bias is minus the gain.
pub(super) fn bias_of_gain(before: &Model, current: &Model) -> Changes {
    let [gain, bias] = both_of_actuators(before, current);
    let one = |actuator: usize| {
        let (first, of_bias) = (PARAMETERS * actuator, servo(before, actuator)?);
        let wrong = !same(gain, first) && same(bias, of_bias);
        wrong.then_some((of_bias, PartnerChange::Becomes(-*gain.1.get(first)?)))
    };
    (0..current.nactuator).filter_map(one).collect()
}

pub(super) fn gain_of_bias(before: &Model, current: &Model) -> Changes {
    let [gain, bias] = both_of_actuators(before, current);
    let one = |actuator: usize| {
        let (first, of_bias) = (PARAMETERS * actuator, servo(before, actuator)?);
        let wrong = same(gain, first) && !same(bias, of_bias);
        wrong.then_some((first, PartnerChange::Becomes(-*bias.1.get(of_bias)?)))
    };
    (0..current.nactuator).filter_map(one).collect()
}

fn both_of_actuators<'m>(before: &'m Model, current: &'m Model) -> [BeforeAndAfter<'m>; 2] {
    [
        (&*before.actuator_gainprm, &*current.actuator_gainprm),
        (&*before.actuator_biasprm, &*current.actuator_biasprm),
    ]
}
