//! Contact parameters computed from those of two geoms: priority, mixing, margin.

use super::filter::Pair;
use crate::geometry::pair::ContactPoint;
use crate::kinds::{enable, exclude};
use crate::math::*;
use crate::model::{Contact, Model};

/// Smallest friction coefficient of a contact.
const MINMU: f64 = 1e-5;

/// The contact parameters of a pair, which are independent of the contact point.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Params {
    /// Distance up to which a contact is detected, m.
    pub(super) reach: f64,
    /// Distance below which it exerts a force, m.
    margin: f64,
    friction: [f64; 5],
    solref: [f64; 2],
    /// `solref` of the friction rows; zero if they use `solref`.
    solreffriction: [f64; 2],
    solimp: [f64; 5],
    /// Adhesion force, N.
    adhesion: f64,
    dim: usize,
}

/// The parameters of a pair: those of the explicit pair, or mixed from both geoms.
pub(super) fn params(m: &Model, pair: &Pair) -> Params {
    match pair.explicit {
        Pair::DYNAMIC => mixed(m, pair.geom1 as usize, pair.geom2 as usize),
        p => explicit(m, p as usize),
    }
}

/// Distance from a geom within which contacts are detected, m: its share of the reach of a pair.
pub(super) fn half_reach(m: &Model, g: usize) -> f64 {
    let margin = if m.opt.enabled(enable::OVERRIDE) { 0.5 * m.opt.o_margin } else { m.geom_margin[g] };
    margin + m.geom_gap[g]
}

fn explicit(m: &Model, p: usize) -> Params {
    finish(
        m,
        m.pair_gap[p],
        Params {
            reach: 0.0,
            margin: m.pair_margin[p],
            friction: rows::<5>(&m.pair_friction)[p],
            solref: rows::<2>(&m.pair_solref)[p],
            solreffriction: rows::<2>(&m.pair_solreffriction)[p],
            solimp: rows::<5>(&m.pair_solimp)[p],
            adhesion: m.pair_adhesion[p],
            dim: m.pair_dim[p].max(1) as usize,
        },
    )
}

/// Applies the override options and the limits for all contacts.
fn finish(m: &Model, gap: f64, p: Params) -> Params {
    let mut p = p;
    if m.opt.enabled(enable::OVERRIDE) {
        (p.friction, p.solref, p.solimp) = (m.opt.o_friction, m.opt.o_solref, m.opt.o_solimp);
        (p.margin, p.solreffriction) = (m.opt.o_margin, m.opt.o_solref);
    }
    Params {
        reach: p.margin + gap,
        friction: p.friction.map(|f| f.max(MINMU)),
        // Invalid dimensions that were written to the model are rounded up to the next valid one.
        dim: match p.dim {
            0 | 1 => 1,
            2 | 3 => 3,
            4 => 4,
            _ => 6,
        },
        ..p
    }
}

/// Mixes the parameters of two geoms. A geom with higher priority determines all of them. At equal priority, condim
/// and friction are the maxima of both; solref and solimp are means weighted by `solmix` (solref is the minimum of
/// both if one has the direct, negative format).
fn mixed(m: &Model, g1: usize, g2: usize) -> Params {
    let (solref, solimp) = (rows::<2>(&m.geom_solref), rows::<5>(&m.geom_solimp));
    let friction3 = rows::<3>(&m.geom_friction);
    let (p1, p2) = (m.geom_priority[g1], m.geom_priority[g2]);
    let (dim, slide_spin_roll, reference, impedance, adhesion);
    if p1 != p2 {
        let g = if p1 > p2 { g1 } else { g2 };
        adhesion = m.geom_adhesion[g];
        (dim, slide_spin_roll, reference, impedance) = (m.geom_condim[g], friction3[g], solref[g], solimp[g]);
    } else {
        adhesion = m.geom_adhesion[g1] + m.geom_adhesion[g2];
        dim = m.geom_condim[g1].max(m.geom_condim[g2]);
        slide_spin_roll = std::array::from_fn(|i| friction3[g1][i].max(friction3[g2][i]));
        let mix = mix(m.geom_solmix[g1], m.geom_solmix[g2]);
        let blend = |a: f64, b: f64| mix * a + (1.0 - mix) * b;
        reference = if solref[g1][0] > 0.0 && solref[g2][0] > 0.0 {
            std::array::from_fn(|i| blend(solref[g1][i], solref[g2][i]))
        } else {
            std::array::from_fn(|i| solref[g1][i].min(solref[g2][i]))
        };
        impedance = std::array::from_fn(|i| blend(solimp[g1][i], solimp[g2][i]));
    }
    let [slide, spin, roll] = slide_spin_roll;
    finish(
        m,
        m.geom_gap[g1] + m.geom_gap[g2],
        Params {
            reach: 0.0,
            margin: m.geom_margin[g1] + m.geom_margin[g2],
            friction: [slide, slide, spin, roll, roll],
            solref: reference,
            solreffriction: [0.0; 2],
            solimp: impedance,
            adhesion,
            dim: dim.max(1) as usize,
        },
    )
}

/// The contact of a pair at the contact point `touch`.
#[cfg_attr(not(feature = "small"), inline(always))]
pub(super) fn contact(p: &Params, g1: usize, g2: usize, touch: &ContactPoint, frame: Mat3) -> Contact {
    let beyond_margin = touch.dist >= p.margin;
    // An adhesive contact also acts within the gap, but there only in the normal direction.
    let sticks = p.adhesion != 0.0;
    Contact {
        dist: touch.dist,
        pos: touch.pos,
        frame,
        includemargin: p.margin,
        friction: p.friction,
        solref: p.solref,
        solreffriction: p.solreffriction,
        solimp: p.solimp,
        adhesion: p.adhesion,
        mu: 0.0,
        dim: if beyond_margin && sticks { 1 } else { p.dim },
        geom1: g1,
        geom2: g2,
        exclude: if beyond_margin && !sticks { exclude::IN_GAP } else { exclude::NO },
        efc_address: None,
    }
}

/// Weight of the first geom, given both `solmix`.
fn mix(a: f64, b: f64) -> f64 {
    match (a >= MINVAL, b >= MINVAL) {
        (true, true) => a / (a + b),
        (false, false) => 0.5,
        (first, _) => f64::from(u8::from(first)),
    }
}
