//! The pairs: a parameter, the partner that follows it, and how.

use super::repair::{self, Statements};
use super::shape;
use super::{Change, bits};
use crate::rules::{self, Rule};
use labspec_core::math::{norm, rows, sub};
use labspec_core::reflect::{FieldId, model, option};
use labspec_core::{Model, biastype, gaintype};
use std::ops::Range;

/// What of a partner changes: an element of its field, and how.
pub(super) type Changes = Vec<(usize, Change)>;

/// Writes the statements that change the partner of these objects; `None` where that cannot be written.
type Repair = fn(&mut Statements<'_>, &[usize]) -> Option<()>;

/// A parameter of a model, and the partner that has to follow it.
#[derive(Debug)]
pub(crate) struct Pair {
    /// The field of the parameter.
    pub(crate) parameter: FieldId,
    /// The field of the partner.
    pub(crate) partner: FieldId,
    /// The rule that a parameter without its partner breaks.
    pub(crate) rule: &'static Rule,
    /// The partner in words, where it is left behind.
    pub(crate) left: &'static str,
    /// What the partner is after the correction, behind "with".
    pub(crate) corrected: &'static str,
    /// How to correct it, where no statements were tried.
    pub(crate) help: &'static str,
    /// What follows from what a program did: the model before and after it. A partner that the program changed itself stays.
    pub(super) follow: fn(&Model, &Model) -> Changes,
    /// The elements of the partner that belong to an element of the parameter.
    pub(super) partners: fn(usize) -> Range<usize>,
    /// The correction as statements; `None` where it has none.
    pub(super) repair: Option<Repair>,
}

/// All pairs.
pub(crate) const PAIRS: &[Pair] = &[
    Pair {
        parameter: model::body_mass,
        partner: model::body_inertia,
        left: "`model.body_inertia`",
        rule: rules::MASS_ALONE,
        corrected: "the inertia that this mass has",
        help: "multiply all three numbers of `model.body_inertia` by the factor of the mass, then call `mj.mj_setConst(model, data)`",
        follow: inertia_of_mass,
        partners: |b| 3 * b..3 * b + 3,
        repair: Some(repair::inertia_of_mass),
    },
    Pair {
        parameter: model::body_inertia,
        partner: model::body_mass,
        left: "`model.body_mass`",
        rule: rules::INERTIA_ALONE,
        corrected: "the mass that this inertia needs",
        help: "change `model.body_mass` by the same factor, or keep the inertia below the mass times the square of the body's reach",
        follow: mass_of_inertia,
        partners: |i| i / 3..i / 3 + 1,
        repair: None,
    },
    Pair {
        parameter: model::body_inertia,
        partner: model::body_inertia,
        left: "the other principal moments",
        rule: rules::INERTIA_ALONE,
        corrected: "all three principal moments scaled together",
        help: "change all three numbers of `model.body_inertia` together: none can exceed the sum of the other two",
        follow: other_moments,
        partners: |_| 0..0,
        repair: None,
    },
    Pair {
        parameter: model::geom_size,
        partner: model::geom_rbound,
        left: "`model.geom_rbound`",
        rule: rules::SHAPE_ALONE,
        corrected: "the bounding radius of this size",
        help: "set `model.geom_rbound` to the bounding radius of the new size",
        follow: bound_of_size,
        partners: |i| i / 3..i / 3 + 1,
        repair: Some(repair::bound_of_size),
    },
    Pair {
        parameter: model::geom_size,
        partner: model::body_inertia,
        left: "`model.body_inertia`",
        rule: rules::SHAPE_ALONE,
        corrected: "the inertia of this shape",
        help: "set `model.body_inertia` to the inertia of the new shape, then call `mj.mj_setConst(model, data)`",
        follow: inertia_of_size,
        partners: |_| 0..0,
        repair: Some(repair::inertia_of_size),
    },
    Pair {
        parameter: model::geom_pos,
        partner: model::body_ipos,
        left: "`model.body_ipos`",
        rule: rules::SHAPE_ALONE,
        corrected: "the centre of mass where the geom is",
        help: "move `model.body_ipos` as far as `model.geom_pos`, then call `mj.mj_setConst(model, data)`",
        follow: centre_of_place,
        partners: |_| 0..0,
        repair: Some(repair::centre_of_place),
    },
    Pair {
        parameter: model::actuator_gainprm,
        partner: model::actuator_biasprm,
        left: "`model.actuator_biasprm`",
        rule: rules::GAIN_ALONE,
        corrected: "the bias of this gain",
        help: "also set the number of `model.actuator_biasprm` that is minus the gain",
        follow: bias_of_gain,
        partners: |i| i + 1..i + 3,
        repair: Some(repair::bias_of_gain),
    },
    Pair {
        parameter: model::actuator_biasprm,
        partner: model::actuator_gainprm,
        left: "`model.actuator_gainprm`",
        rule: rules::GAIN_ALONE,
        corrected: "the gain of this bias",
        help: "also set `model.actuator_gainprm[10 * actuator]` to minus the bias",
        follow: gain_of_bias,
        partners: |i| i / 10 * 10..i / 10 * 10 + 1,
        repair: Some(repair::gain_of_bias),
    },
    Pair {
        parameter: model::geom_contype,
        partner: model::body_contype,
        left: "`model.body_contype`",
        rule: rules::CONTYPE_ALONE,
        corrected: "the contact types of its geoms in the body",
        help: "also set the bits of `model.body_contype`",
        follow: bits::types_of_bodies,
        partners: |_| 0..0,
        repair: Some(bits::repair_types),
    },
    Pair {
        parameter: model::geom_conaffinity,
        partner: model::body_conaffinity,
        left: "`model.body_conaffinity`",
        rule: rules::CONTYPE_ALONE,
        corrected: "the contact affinities of its geoms in the body",
        help: "also set the bits of `model.body_conaffinity`",
        follow: bits::affinities_of_bodies,
        partners: |_| 0..0,
        repair: Some(bits::repair_affinities),
    },
    MIDPHASE,
    Pair { parameter: model::geom_conaffinity, ..MIDPHASE },
];

/// A geom that is switched on, and is missing in the tree of bounding volumes of its body.
const MIDPHASE: Pair = Pair {
    parameter: model::geom_contype,
    partner: option::disableflags,
    left: "the bounding volumes of its body",
    rule: rules::CONTYPE_ALONE,
    corrected: "the midphase switched off",
    help: "set the contact bits of the geom in the model and switch it off in the setup, or switch the midphase off",
    follow: bits::midphase,
    partners: |_| 0..0,
    repair: Some(bits::repair_midphase),
};

/// A list of the model before and after.
type Both<'m> = (&'m [f64], &'m [f64]);

/// An element before and after.
fn at((before, after): Both<'_>, i: usize) -> Option<(f64, f64)> {
    Some((*before.get(i)?, *after.get(i)?))
}

fn same(both: Both<'_>, i: usize) -> bool {
    at(both, i).is_some_and(|(a, b)| a.to_bits() == b.to_bits())
}

fn factor(both: Both<'_>, i: usize) -> Option<f64> {
    let (a, b) = at(both, i)?;
    (a > 0.0 && b > 0.0 && b.is_finite()).then_some(b / a)
}

/// The inertia is proportional to the mass.
fn inertia_of_mass(before: &Model, now: &Model) -> Changes {
    let (mass, inertia) =
        ((&*before.body_mass, &*now.body_mass), (&*before.body_inertia, &*now.body_inertia));
    let mut changes = Vec::new();
    for body in (1..now.nbody).filter(|b| !same(mass, *b)) {
        let Some(f) = factor(mass, body) else { continue };
        let kept = (3 * body..3 * body + 3).filter(|i| same(inertia, *i));
        changes.extend(kept.map(|i| (i, Change::Times(f))));
    }
    changes
}

/// How much farther than its bounding spheres a body may seem to reach by rounding.
const ROUNDING: f64 = 1e-9;

/// The distance of the farthest point of a body from its centre of mass; `None` where geoms do not say.
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

/// Moments of a body, and the largest of their factors where a program changed some.
fn moments(before: &Model, now: &Model, body: usize) -> Option<([f64; 3], [f64; 3], f64)> {
    let [a, b] = [before, now].map(|m| rows::<3>(&m.body_inertia).get(body).copied());
    let (a, b) = (a?, b?);
    let factors =
        a.iter().zip(&b).filter(|(x, y)| x.to_bits() != y.to_bits() && **x > 0.0).map(|(x, y)| y / x);
    let largest = factors.fold(f64::NAN, f64::max);
    (largest > 0.0 && largest.is_finite()).then_some((a, b, largest))
}

/// No mass is farther from the axis than the body reaches: a moment above m r² takes more of it.
fn mass_of_inertia(before: &Model, now: &Model) -> Changes {
    let mass = (&*before.body_mass, &*now.body_mass);
    let most = |x: [f64; 3]| x.into_iter().fold(0.0, f64::max);
    let too_large = |m: &Model, body: usize, moments: [f64; 3]| {
        let bound = m.body_mass.get(body).zip(reach(m, body)).map(|(mass, r)| mass * r * r);
        bound.is_some_and(|bound| most(moments) > bound * (1.0 + ROUNDING))
    };
    let one = |body: usize| {
        let (a, b, factor) = moments(before, now, body)?;
        let wrong = same(mass, body) && !too_large(before, body, a) && too_large(now, body, b);
        wrong.then_some((body, Change::Times(factor)))
    };
    (1..now.nbody).filter_map(one).collect()
}

/// No principal moment is larger than the other two together.
fn other_moments(before: &Model, now: &Model) -> Changes {
    let inertia = (&*before.body_inertia, &*now.body_inertia);
    let possible = |[a, b, c]: [f64; 3]| {
        let largest = a.max(b).max(c);
        2.0 * largest <= (a + b + c) * (1.0 + ROUNDING)
    };
    let mut changes = Vec::new();
    for body in 1..now.nbody {
        let Some((a, b, factor)) = moments(before, now, body) else { continue };
        if possible(a) && !possible(b) {
            let kept = (3 * body..3 * body + 3).filter(|i| same(inertia, *i));
            changes.extend(kept.map(|i| (i, Change::Times(factor))));
        }
    }
    changes
}

/// The geoms whose size or place was changed.
fn changed<'m>(
    before: &'m Model,
    now: &'m Model,
    of: fn(&Model) -> &[f64],
) -> impl Iterator<Item = usize> + 'm {
    let [a, b] = [before, now].map(of);
    (0..now.ngeom).filter(move |g| (3 * g..3 * g + 3).any(|i| !same((a, b), i)))
}

/// Contacts are looked for within the bounding radius.
fn bound_of_size(before: &Model, now: &Model) -> Changes {
    let bounds = (&*before.geom_rbound, &*now.geom_rbound);
    let one = |g: usize| {
        let radius = shape::of(now, g)?.radius;
        (same(bounds, g) && now.geom_rbound.get(g) != Some(&radius)).then_some((g, Change::Becomes(radius)))
    };
    changed(before, now, |m| &m.geom_size).filter_map(one).collect()
}

/// The inertia of a body whose mass is that of one geom is that of its shape.
fn inertia_of_size(before: &Model, now: &Model) -> Changes {
    let inertia = (&*before.body_inertia, &*now.body_inertia);
    let mut changes = Vec::new();
    for g in changed(before, now, |m| &m.geom_size) {
        let Some(body) = shape::carried(before, g) else { continue };
        let [old, new] = [before, now].map(|m| shape::moments(m, g, body));
        let (Some(old), Some(new)) = (old, new) else { continue };
        let own = 3 * body..3 * body + 3;
        for ((i, a), b) in own.zip(old).zip(new).filter(|((i, _), _)| same(inertia, *i)) {
            changes.push((i, Change::Times(b / a)));
        }
    }
    changes
}

/// The centre of mass of a body whose mass is that of one geom is where the geom is.
fn centre_of_place(before: &Model, now: &Model) -> Changes {
    let (place, centre) = ((&*before.geom_pos, &*now.geom_pos), (&*before.body_ipos, &*now.body_ipos));
    let mut changes = Vec::new();
    for g in changed(before, now, |m| &m.geom_pos) {
        let Some(body) = shape::carried(before, g) else { continue };
        for axis in 0..3 {
            let Some((a, b)) = at(place, 3 * g + axis).filter(|(a, b)| a != b) else { continue };
            if same(centre, 3 * body + axis) {
                changes.push((3 * body + axis, Change::Plus(b - a)));
            }
        }
    }
    changes
}

/// Numbers of an actuator's gain and bias.
const PARAMETERS: usize = 10;

/// The place of the bias that is minus the gain of a servo: the position's, or the velocity's.
pub(super) fn servo(m: &Model, actuator: usize) -> Option<usize> {
    let is = |list: &[i32], kind| list.get(actuator) == Some(&kind);
    if !is(&m.actuator_gaintype, gaintype::FIXED) || !is(&m.actuator_biastype, biastype::AFFINE) {
        return None;
    }
    let gain = *m.actuator_gainprm.get(PARAMETERS * actuator)?;
    let opposite = |k: &usize| m.actuator_biasprm.get(PARAMETERS * actuator + k).is_some_and(|b| *b == -gain);
    [1, 2].into_iter().find(opposite).filter(|_| gain != 0.0).map(|k| PARAMETERS * actuator + k)
}

/// A servo pulls with gain * (target - length): its bias is minus the gain.
fn bias_of_gain(before: &Model, now: &Model) -> Changes {
    let [gain, bias] = both_of_actuators(before, now);
    let one = |actuator: usize| {
        let (first, of_bias) = (PARAMETERS * actuator, servo(before, actuator)?);
        let wrong = !same(gain, first) && same(bias, of_bias);
        wrong.then_some((of_bias, Change::Becomes(-*gain.1.get(first)?)))
    };
    (0..now.nactuator).filter_map(one).collect()
}

fn gain_of_bias(before: &Model, now: &Model) -> Changes {
    let [gain, bias] = both_of_actuators(before, now);
    let one = |actuator: usize| {
        let (first, of_bias) = (PARAMETERS * actuator, servo(before, actuator)?);
        let wrong = same(gain, first) && !same(bias, of_bias);
        wrong.then_some((first, Change::Becomes(-*bias.1.get(of_bias)?)))
    };
    (0..now.nactuator).filter_map(one).collect()
}

fn both_of_actuators<'m>(before: &'m Model, now: &'m Model) -> [Both<'m>; 2] {
    [(&*before.actuator_gainprm, &*now.actuator_gainprm), (&*before.actuator_biasprm, &*now.actuator_biasprm)]
}
