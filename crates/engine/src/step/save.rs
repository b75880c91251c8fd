//! A complete simulation as bytes: state, inputs and all results, including contacts and warnings.
//!
//! The format: a header (a magic word, the version, hashes of the table of fields and of the model), the fields in the order of
//! the table, contacts, warnings, and a hash of everything before it. Numbers are little-endian. Lengths are not written, because
//! the model and the counts of the data determine them. A file may come from any source: integers that the engine uses as indexes
//! are checked before their use.

use crate::constraint::kind;
use crate::kinds::cone;
use crate::model::bytes::{FixedSize, fingerprint};
use crate::model::reflect::{self, Elem, Object, View};
use crate::model::{Contact, Fields, Model, Obj, Warning, WarningStat};
use crate::step::workspace::{StepScratch, Workspace};
use crate::step::{forward, reset};
use std::fmt;
use std::ops::Range;

const MAGIC: [u8; 8] = *b"labdata\n";
/// The version of the layout that this module writes.
const VERSION: u32 = 1;

/// The reason why saved data cannot be restored. The data are then unchanged.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RestoreError {
    /// The bytes do not start with the header of saved data.
    NotData,
    /// The data were saved by another version of the engine. Contains the version of its layout.
    Version(u32),
    /// The data belong to a model with other sizes, types, addresses or names.
    OtherModel,
    /// The bytes are truncated, too long, or changed.
    Damaged,
    /// A field contains a value that no simulation produces.
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

/// Saves the complete simulation as bytes, for [`restore`].
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

/// Restores a saved simulation of the same model, bit for bit. The plan of the data stays. The parameters of the
/// model are not saved: the run continues with their current values.
pub fn restore(m: &Model, d: &mut Fields, s: &mut StepScratch, bytes: &[u8]) -> Result<(), RestoreError> {
    let (body, end) = bytes.split_last_chunk::<8>().ok_or(RestoreError::NotData)?;
    let rest = check_header(m, body)?;
    if fingerprint(body) != u64::from_le_bytes(*end) {
        return Err(RestoreError::Damaged);
    }
    let mut new = saved(m, d, rest).ok_or(RestoreError::Damaged)?;
    if let Some(field) = first_invalid_field(m, &new.fields) {
        return Err(RestoreError::Wrong(field));
    }
    reset::clear_omitted_fields(m, &mut new.fields, &mut new.scratch);
    if let Some(again) = saved(m, d, rest) {
        restore_rows(m, &mut new, again);
    }
    (*d, *s) = (new.fields, new.scratch);
    Ok(())
}

/// The saved data, with the plan and the meter of other data. `None` if the bytes are not exactly those of saved data.
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

/// Checks the header and returns the bytes after it.
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

/// A hash of the structure and the names of a model.
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
    let [dist, includemargin, adhesion, mu] = FixedSize::take(bytes)?;
    // The fields are read in the order of this expression.
    Some(Contact {
        dist,
        includemargin,
        adhesion,
        mu,
        pos: FixedSize::take(bytes)?,
        frame: FixedSize::take(bytes)?,
        friction: FixedSize::take(bytes)?,
        solimp: FixedSize::take(bytes)?,
        solref: FixedSize::take(bytes)?,
        solreffriction: FixedSize::take(bytes)?,
        dim: FixedSize::take(bytes)?,
        geom1: FixedSize::take(bytes)?,
        geom2: FixedSize::take(bytes)?,
        exclude: FixedSize::take(bytes)?,
        efc_address: FixedSize::take(bytes)?,
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
        let (number, lastinfo) = (FixedSize::take(bytes)?, FixedSize::take(bytes)?);
        d.warning[k] = WarningStat { number, lastinfo, first_time: FixedSize::take(bytes)? };
    }
    Some(())
}

/// The first field with a value that the engine cannot use as an index.
fn first_invalid_field(m: &Model, d: &Fields) -> Option<&'static str> {
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

/// The valid range of an integer field.
fn limits(m: &Model, d: &Fields, name: &str) -> Option<Range<i64>> {
    let to = |n: usize| 0..i64::try_from(n).unwrap_or(i64::MAX);
    Some(match name {
        "ncon" | "nefc" | "solver_niter" | "efc_id" => 0..i64::MAX,
        "ne" | "nf" | "nl" | "nisland" => to(d.nefc + 1),
        "ten_wrapadr" | "ten_wrapnum" => to(d.wrap_obj.len() + 1),
        // An element of a tendon's path without a geom has the value -1 or -2.
        "wrap_obj" => -2..to(m.ngeom).end,
        "moment_rownnz" => to(m.nv + 1),
        "moment_rowadr" => to(m.nJmom + 1),
        "moment_colind" => to(m.nv.max(1)),
        "efc_type" => 0..8,
        "efc_state" => 0..5,
        // The count of slow steps starts at -11. The value of a sleeping tree is the index of a tree.
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

/// Restores the Jacobian of the constraints, which is not a field. It is computed again if the saved data are in the middle of a
/// step, and is empty if the state has changed since it was computed. `again` is a second copy of the data.
fn restore_rows(m: &Model, d: &mut Workspace, mut again: Workspace) {
    let Workspace { fields, scratch } = &mut again;
    reset::clear_omitted_fields(m, fields, scratch);
    forward::position(m, fields, scratch);
    let same = fields.efc_type == d.fields.efc_type && fields.efc_id == d.fields.efc_id;
    d.scratch = again.scratch;
    if !same {
        d.scratch.constraint.jac = Default::default();
    }
}

#[cfg(test)]
mod tests;
