//! Contact bits of geoms, and the values derived from them that also decide about contacts: the bits of their bodies, and
//! the trees of bounding volumes. Both are computed when the model is compiled.

use super::change::{Changes, PartnerChange};
use super::statements::StatementWriter;
use labspec_core::{Model, disable};

/// The accessors of contact bits of geoms and of bodies: types or affinities.
type Bits = [fn(&Model) -> &[i32]; 2];

const TYPES: Bits = [|m| &m.geom_contype, |m| &m.body_contype];
const AFFINITIES: Bits = [|m| &m.geom_conaffinity, |m| &m.body_conaffinity];

fn body_of(m: &Model, geom: usize) -> Option<usize> {
    usize::try_from(*m.geom_bodyid.get(geom)?).ok()
}

/// A body needs the bits of its geoms: each bit that is set in a geom must be set in its body.
fn bits_of_bodies(before: &Model, current: &Model, [of_geom, of_body]: Bits) -> Changes {
    let mut required: Vec<i32> = of_body(current).to_vec();
    for (g, (was, is)) in of_geom(before).iter().zip(of_geom(current)).enumerate() {
        if was != is
            && let Some(bits) = body_of(current, g).and_then(|b| required.get_mut(b))
        {
            *bits |= is;
        }
    }
    let both = of_body(before).iter().zip(of_body(current)).zip(required).enumerate();
    let left = both.filter(|(_, ((was, is), required))| was == is && **is != *required);
    left.map(|(b, (_, required))| (b, PartnerChange::Becomes(f64::from(required)))).collect()
}

pub(super) fn types_of_bodies(before: &Model, current: &Model) -> Changes {
    bits_of_bodies(before, current, TYPES)
}

pub(super) fn affinities_of_bodies(before: &Model, current: &Model) -> Changes {
    bits_of_bodies(before, current, AFFINITIES)
}

/// A geom without contact bits at compile time is in no tree of bounding volumes. If its body has a tree, contacts of the
/// geom are found only without the midphase.
pub(super) fn midphase(before: &Model, current: &Model) -> Changes {
    let visual = |g: usize| current.visual_geoms.iter().any(|&v| v as usize == g);
    let switched = |g: usize| {
        let bits =
            |m: &Model| [&m.geom_contype, &m.geom_conaffinity].map(|list| list.get(g).copied().unwrap_or(0));
        bits(before) == [0, 0] && bits(current) != [0, 0]
    };
    let has_tree = |g: usize| {
        let body = body_of(current, g);
        (0..current.ngeom).any(|other| body_of(current, other) == body && !visual(other))
    };
    let flags = current.opt.disableflags;
    let unsupported = flags & disable::MIDPHASE == 0
        && flags == before.opt.disableflags
        && (0..current.ngeom).any(|g| visual(g) && switched(g) && has_tree(g));
    match unsupported {
        true => vec![(0, PartnerChange::Becomes(f64::from(flags | disable::MIDPHASE)))],
        false => Vec::new(),
    }
}

/// The statements for the bits of the bodies of these geoms.
fn repair(s: &mut StatementWriter<'_>, geoms: &[usize], kind: &str) -> Option<()> {
    if geoms.is_empty() {
        s.add(format!(
            "for (let g = 0; g < model.ngeom; g++) model.body_{kind}[model.geom_bodyid[g]] |= model.geom_{kind}[g]"
        ));
    }
    for &g in geoms {
        let body = body_of(s.model, g)?;
        s.add(format!("model.body_{kind}[{body}] |= model.geom_{kind}[{g}]"));
    }
    Some(())
}

pub(super) fn repair_types(s: &mut StatementWriter<'_>, geoms: &[usize]) -> Option<()> {
    repair(s, geoms, "contype")
}

pub(super) fn repair_affinities(s: &mut StatementWriter<'_>, geoms: &[usize]) -> Option<()> {
    repair(s, geoms, "conaffinity")
}

pub(super) fn repair_midphase(s: &mut StatementWriter<'_>, _: &[usize]) -> Option<()> {
    s.add(format!("model.opt.disableflags |= {}", disable::MIDPHASE));
    Some(())
}
