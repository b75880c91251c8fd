//! All of a simulation as bytes: state, inputs and everything computed, contacts and warnings included.
//!
//! A file is a header (a word, the version, fingerprints of the table of fields and of the model), the fields in the order
//! of the table, contacts, warnings, and a fingerprint of all before it. Numbers are least significant byte first. Lengths
//! are not written: the model and the counts of the data decide them. A file may come from anywhere: what the
//! engine would index by is looked at before it is believed.

use crate::constraint::kind;
use crate::kinds::cone;
use crate::model::bytes::{Plain, fingerprint};
use crate::model::reflect::{self, Elem, Object, View};
use crate::model::{Contact, Fields, Model, Obj, Warning, WarningStat};
use crate::step::workspace::{Scratch, Workspace};
use crate::step::{forward, reset};
use std::fmt;
use std::ops::Range;

const MAGIC: [u8; 8] = *b"labdata\n";
/// Of the layout that this module writes.
const VERSION: u32 = 1;

/// Why saved data are not restored. The data are as before then.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RestoreError {
    /// The bytes do not begin as saved data do.
    NotData,
    /// They were saved by another version of the engine: its layout, if that is what differs.
    Version(u32),
    /// They belong to a model of other sizes, types, addresses or names.
    OtherModel,
    /// They are cut off, too long, or some of them were changed.
    Damaged,
    /// A field holds what no simulation puts there.
    Wrong(&'static str),
}

impl fmt::Display for RestoreError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            RestoreError::NotData => f.write_str("these bytes are not saved data: their header is missing"),
            RestoreError::Version(v) => write!(
                f,
                "the data were saved by another version of the engine (layout {v}, this one has {VERSION}): save them again with this one"
            ),
            RestoreError::OtherModel => f.write_str(
                "the data belong to another model: its objects, their types or their names are not the same",
            ),
            RestoreError::Damaged => {
                f.write_str("the saved data are damaged: they are truncated or were changed")
            }
            RestoreError::Wrong(field) => {
                write!(f, "the saved data are damaged: `{field}` has an invalid value")
            }
        }
    }
}

impl std::error::Error for RestoreError {}

/// All of a simulation as bytes, for [`restore`].
pub fn save(m: &Model, d: &Fields) -> Vec<u8> {
    let mut out = header(m);
    reflect::write_data(d, &mut out);
    d.contact.len().put(&mut out);
    d.contact.iter().for_each(|c| write_contact(c, &mut out));
    for w in &d.warning {
        w.number.put(&mut out);
        w.lastinfo.put(&mut out);
        w.first_time.put(&mut out);
    }
    fingerprint(&out).put(&mut out);
    out
}

/// Brings a simulation of the same model back to where it was saved, every bit of it; its plan stays. Parameters of the
/// model are not part of it: a run goes on with those that the model has now.
pub fn restore(m: &Model, d: &mut Fields, s: &mut Scratch, bytes: &[u8]) -> Result<(), RestoreError> {
    let (body, end) = bytes.split_last_chunk::<8>().ok_or(RestoreError::NotData)?;
    let rest = check_header(m, body)?;
    if fingerprint(body) != u64::from_le_bytes(*end) {
        return Err(RestoreError::Damaged);
    }
    let mut new = saved(m, d, rest).ok_or(RestoreError::Damaged)?;
    if let Some(field) = wrong(m, &new.fields) {
        return Err(RestoreError::Wrong(field));
    }
    reset::clear_left_out(m, &mut new.fields, &mut new.scratch);
    if let Some(again) = saved(m, d, rest) {
        restore_rows(m, &mut new, again);
    }
    (*d, *s) = (new.fields, new.scratch);
    Ok(())
}

/// The data that were saved, with the plan and the meter of others; `None` when these are not all the bytes of some.
fn saved(m: &Model, like: &Fields, mut bytes: &[u8]) -> Option<Workspace> {
    let mut d = Workspace::planned(m, like.plan.clone());
    d.fields.meter = like.meter;
    read(m, &mut d.fields, &mut bytes).filter(|()| bytes.is_empty()).map(|()| d)
}

fn header(m: &Model) -> Vec<u8> {
    let mut out = MAGIC.to_vec();
    VERSION.put(&mut out);
    reflect::table(true).put(&mut out);
    model(m).put(&mut out);
    out
}

/// What follows the header.
fn check_header<'a>(m: &Model, body: &'a [u8]) -> Result<&'a [u8], RestoreError> {
    let mut rest = body;
    if <[u8; 8]>::take(&mut rest) != Some(MAGIC) {
        return Err(RestoreError::NotData);
    }
    let version = u32::take(&mut rest).ok_or(RestoreError::Damaged)?;
    if version != VERSION || u64::take(&mut rest).ok_or(RestoreError::Damaged)? != reflect::table(true) {
        return Err(RestoreError::Version(version));
    }
    if u64::take(&mut rest).ok_or(RestoreError::Damaged)? != model(m) {
        return Err(RestoreError::OtherModel);
    }
    Ok(rest)
}

/// A number for the structure and the names of a model.
fn model(m: &Model) -> u64 {
    let mut out = Vec::new();
    reflect::write_structure(m, &mut out);
    for kind in [Obj::Body, Obj::Joint, Obj::Geom, Obj::Site, Obj::Tendon, Obj::Actuator, Obj::Sensor] {
        for name in m.names.of_kind(kind) {
            out.extend_from_slice(name.as_bytes());
            out.push(0);
        }
    }
    fingerprint(&out)
}

fn write_contact(c: &Contact, out: &mut Vec<u8>) {
    let Contact {
        dist,
        pos,
        frame,
        includemargin,
        friction,
        solref,
        solreffriction,
        solimp,
        adhesion,
        mu,
        ..
    } = c;
    let Contact { dim, geom1, geom2, exclude, efc_address, .. } = c;
    for x in [dist, includemargin, adhesion, mu] {
        x.put(out);
    }
    pos.put(out);
    frame.put(out);
    friction.put(out);
    solimp.put(out);
    solref.put(out);
    solreffriction.put(out);
    for x in [dim, geom1, geom2] {
        x.put(out);
    }
    exclude.put(out);
    efc_address.put(out);
}

fn read_contact(bytes: &mut &[u8]) -> Option<Contact> {
    let [dist, includemargin, adhesion, mu] = Plain::take(bytes)?;
    // Fields are read in the order in which they stand here.
    Some(Contact {
        dist,
        includemargin,
        adhesion,
        mu,
        pos: Plain::take(bytes)?,
        frame: Plain::take(bytes)?,
        friction: Plain::take(bytes)?,
        solimp: Plain::take(bytes)?,
        solref: Plain::take(bytes)?,
        solreffriction: Plain::take(bytes)?,
        dim: Plain::take(bytes)?,
        geom1: Plain::take(bytes)?,
        geom2: Plain::take(bytes)?,
        exclude: Plain::take(bytes)?,
        efc_address: Plain::take(bytes)?,
    })
}

fn read(m: &Model, d: &mut Fields, bytes: &mut &[u8]) -> Option<()> {
    reflect::read_data(m, d, bytes).then_some(())?;
    let count = usize::take(bytes)?;
    d.contact.clear();
    for _ in 0..count {
        d.contact.push(read_contact(bytes)?);
    }
    for k in 0..Warning::COUNT {
        let (number, lastinfo) = (Plain::take(bytes)?, Plain::take(bytes)?);
        d.warning[k] = WarningStat { number, lastinfo, first_time: Plain::take(bytes)? };
    }
    Some(())
}

/// The first field that holds what the engine could not index by.
fn wrong(m: &Model, d: &Fields) -> Option<&'static str> {
    for f in reflect::fields().filter(|f| f.info().object == Object::Data) {
        let info = f.info();
        if !matches!(info.elem, Elem::I32 | Elem::Size) {
            continue;
        }
        let Some(range) = limits(m, d, info.name) else { return Some(info.name) };
        let good = match reflect::view(m, d, f) {
            View::I32(list) => list.iter().all(|&x| range.contains(&i64::from(x))),
            View::Size(n) => i64::try_from(n).is_ok_and(|n| range.contains(&n)),
            View::F64(_) | View::Bool(_) => true,
        };
        if !good {
            return Some(info.name);
        }
    }
    let within = |adr: &[i32], n: &[i32], end: usize| {
        adr.iter().zip(n).all(|(&a, &n)| i64::from(a) + i64::from(n) <= end as i64)
    };
    if !within(&d.ten_wrapadr, &d.ten_wrapnum, d.wrap_obj.len()) {
        return Some("ten_wrapadr");
    }
    if !within(&d.moment_rowadr, &d.moment_rownnz, m.nJmom) {
        return Some("moment_rowadr");
    }
    let owned = |(&kind, &id): (&i32, &i32)| (id as usize) < owners(m, d, kind);
    if !d.efc_type.iter().zip(&d.efc_id).all(owned) {
        return Some("efc_id");
    }
    let good = |c: &Contact| {
        let rows = if m.opt.cone == cone::PYRAMIDAL { (2 * c.dim).saturating_sub(2).max(1) } else { c.dim };
        let last = c.efc_address.map(|a| a.saturating_add(rows));
        matches!(c.dim, 1 | 3 | 4 | 6)
            && c.geom1.max(c.geom2) < m.ngeom
            && last.is_none_or(|end| end <= d.nefc)
    };
    (d.contact.len() != d.ncon || !d.contact.iter().all(good)).then_some("contact")
}

/// What the numbers of an integer field can be.
fn limits(m: &Model, d: &Fields, name: &str) -> Option<Range<i64>> {
    let to = |n: usize| 0..i64::try_from(n).unwrap_or(i64::MAX);
    Some(match name {
        "ncon" | "nefc" | "solver_niter" | "efc_id" => 0..i64::MAX,
        "ne" | "nf" | "nl" | "nisland" => to(d.nefc + 1),
        "ten_wrapadr" | "ten_wrapnum" => to(d.wrap_obj.len() + 1),
        // What a tendon's path lies on may be no geom: -1, -2.
        "wrap_obj" => -2..to(m.ngeom).end,
        "moment_rownnz" => to(m.nv + 1),
        "moment_rowadr" => to(m.nJmom + 1),
        "moment_colind" => to(m.nv.max(1)),
        "efc_type" => 0..8,
        "efc_state" => 0..5,
        // Steps at rest are counted from -11 on; then it is a tree.
        "tree_asleep" => -11..to(m.ntree).end,
        "tree_awake" => 0..2,
        "body_awake" => -1..2,
        "ntree_awake" => to(m.ntree + 1),
        "nbody_awake" | "nparent_awake" => to(m.nbody + 1),
        "nv_awake" => to(m.nv + 1),
        _ => return None,
    })
}

/// The number of objects that rows of a kind can belong to.
fn owners(m: &Model, d: &Fields, kind: i32) -> usize {
    match kind {
        kind::EQUALITY => m.neq,
        kind::FRICTION_DOF => m.nv,
        kind::LIMIT_JOINT => m.njnt,
        kind::FRICTION_TENDON | kind::LIMIT_TENDON => m.ntendon,
        _ => d.ncon,
    }
}

/// The Jacobian of the constraints is no field: it is computed again, for a step that is in its middle, and is empty where
/// the state has moved on since. `again` are the same data once more.
fn restore_rows(m: &Model, d: &mut Workspace, mut again: Workspace) {
    let Workspace { fields, scratch } = &mut again;
    reset::clear_left_out(m, fields, scratch);
    forward::position(m, fields, scratch);
    let same = fields.efc_type == d.fields.efc_type && fields.efc_id == d.fields.efc_id;
    d.scratch = again.scratch;
    if !same {
        d.scratch.constraint.jac = Default::default();
    }
}

#[cfg(test)]
mod tests;
