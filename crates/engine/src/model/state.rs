//! The state as one list of numbers (MuJoCo's documentation, "Programming: Simulation", section on state).
//!
//! A signature, a sum of the bits below, selects the parts of the state. The parts are in the order of their bits.

use crate::model::reflect::{self, Cell, FieldId, View, ViewMut, data};
use crate::model::{Fields, Model};
use std::fmt;

macro_rules! elements {
    ($($bit:literal $name:ident $field:ident $doc:literal;)*) => {
        $(#[doc = $doc] pub const $name: i32 = 1 << $bit;)*
        /// The field of each part, by bit.
        const FIELDS: &[FieldId] = &[$(data::$field),*];
        fn part(d: &Fields, bit: usize) -> View<'_> {
            match bit { $($bit => d.$field.view(),)* _ => View::F64(&[]) }
        }
        fn part_mut(d: &mut Fields, bit: usize) -> ViewMut<'_> {
            match bit { $($bit => d.$field.view_mut(),)* _ => ViewMut::Fixed }
        }
        /// Copies the parts of a signature; the first part with another length is an error.
        fn copy_parts(from: &Fields, to: &mut Fields, sig: i32) -> Result<(), usize> {
            $(if sig & (1 << $bit) != 0 && !copy_view(from.$field.view(), to.$field.view_mut()) {
                return Err($bit);
            })*
            Ok(())
        }
    };
}
elements! {
    0 TIME time "Time.";
    1 QPOS qpos "Positions.";
    2 QVEL qvel "Velocities.";
    3 ACT act "Activations of actuators.";
    4 HISTORY history "Histories of delayed controls and sensors.";
    5 WARMSTART qacc_warmstart "The acceleration that the solver starts from.";
    6 CTRL ctrl "Controls.";
    7 QFRC_APPLIED qfrc_applied "Applied generalized forces.";
    8 XFRC_APPLIED xfrc_applied "Applied forces and torques.";
    9 EQ_ACTIVE eq_active "Which equality constraints act.";
    10 MOCAP_POS mocap_pos "Positions of mocap bodies.";
    11 MOCAP_QUAT mocap_quat "Orientations of mocap bodies.";
    12 USERDATA userdata "Values of the user.";
}

/// State of plugins. Plugins are not supported, so it is empty.
pub(crate) const PLUGIN: i32 = 1 << 13;
/// Number of bits.
pub(crate) const COUNT: usize = 14;
/// The physics state: all parts that evolve in time, except the time.
pub const PHYSICS: i32 = QPOS | QVEL | ACT | HISTORY;
/// The physics state with the time.
pub const FULLPHYSICS: i32 = TIME | PHYSICS | PLUGIN;
/// The inputs that the user sets.
pub const USER: i32 = CTRL | QFRC_APPLIED | XFRC_APPLIED | EQ_ACTIVE | MOCAP_POS | MOCAP_QUAT | USERDATA;
/// The full input of the next step: from equal states, a step gives equal bits.
pub const INTEGRATION: i32 = FULLPHYSICS | USER | WARMSTART;

/// The reason why a state cannot be read or written. The data are then unchanged.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StateError {
    /// The signature contains bits that are not defined in this module.
    Signature(i32),
    /// The length of the list does not match the signature.
    Length {
        /// The length that the signature requires.
        expected: usize,
        /// The length of the list.
        found: usize,
    },
    /// A requested part is not in the source list.
    Missing(i32),
}

impl fmt::Display for StateError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            StateError::Signature(sig) => {
                write!(
                    f,
                    "{sig} is not a state signature: use a sum of the bits from 1 to {}",
                    1 << (COUNT - 1)
                )
            }
            StateError::Length { expected, found } => {
                write!(f, "a state of this signature has {expected} numbers, and the list has {found}")
            }
            StateError::Missing(bits) => {
                write!(f, "the list does not contain the requested parts {bits}")
            }
        }
    }
}

impl std::error::Error for StateError {}

/// The length of a state vector (`mj_stateSize`).
pub fn size(m: &Model, sig: i32) -> Result<usize, StateError> {
    Ok(bits(sig)?.map(|bit| length(m, bit)).sum())
}

/// Writes a state to `out`, which has `size` numbers (`mj_getState`).
pub fn get(d: &Fields, out: &mut [f64], sig: i32) -> Result<(), StateError> {
    let expected = bits(sig)?.map(|bit| part(d, bit).len()).sum();
    if expected != out.len() {
        return Err(StateError::Length { expected, found: out.len() });
    }
    let mut rest = out;
    for bit in bits(sig)? {
        let part = part(d, bit);
        let (values, after) = rest.split_at_mut(part.len());
        part.copy_to(values);
        rest = after;
    }
    Ok(())
}

/// Sets a state (`mj_setState`). `forward` or the next step computes the results that depend on it.
pub fn set(m: &Model, d: &mut Fields, state: &[f64], sig: i32) -> Result<(), StateError> {
    fits(m, sig, state.len())?;
    let mut rest = state;
    for bit in bits(sig)? {
        let (values, after) = rest.split_at_checked(length(m, bit)).unwrap_or((rest, &[]));
        match part_mut(d, bit) {
            ViewMut::F64(part) => part.iter_mut().zip(values).for_each(|(p, x)| *p = *x),
            // Any number except zero is true.
            ViewMut::Bool(part) => part.iter_mut().zip(values).for_each(|(p, x)| *p = *x != 0.0),
            ViewMut::I32(_) | ViewMut::Fixed => {}
        }
        rest = after;
    }
    Ok(())
}

/// Copies the parts `to` from the state vector `from`, which has the parts `sig` (`mj_extractState`).
pub fn extract(m: &Model, from: &[f64], sig: i32, out: &mut [f64], to: i32) -> Result<(), StateError> {
    fits(m, sig, from.len())?;
    fits(m, to, out.len())?;
    if to & !sig != 0 {
        return Err(StateError::Missing(to & !sig));
    }
    let (mut rest, mut out) = (from, out.iter_mut());
    for bit in bits(sig)? {
        let (values, after) = rest.split_at_checked(length(m, bit)).unwrap_or((rest, &[]));
        if to & (1 << bit) != 0 {
            values.iter().zip(&mut out).for_each(|(x, o)| *o = *x);
        }
        rest = after;
    }
    Ok(())
}

/// Copies parts of a state between data of the same model (`mj_copyState`).
pub fn copy(m: &Model, from: &Fields, to: &mut Fields, sig: i32) -> Result<(), StateError> {
    let _ = bits(sig)?;
    copy_parts(from, to, sig)
        .map_err(|bit| StateError::Length { expected: length(m, bit), found: part(from, bit).len() })
}

/// Whether a part could be copied.
#[inline]
fn copy_view(from: View<'_>, to: ViewMut<'_>) -> bool {
    match (from, to) {
        (View::F64(x), ViewMut::F64(out)) if x.len() == out.len() => out.copy_from_slice(x),
        (View::Bool(x), ViewMut::Bool(out)) if x.len() == out.len() => out.copy_from_slice(x),
        (x, _) => return x.is_empty(),
    }
    true
}

/// The bits of a signature, ascending.
fn bits(sig: i32) -> Result<impl Iterator<Item = usize>, StateError> {
    if !(0..1 << COUNT).contains(&sig) {
        return Err(StateError::Signature(sig));
    }
    Ok((0..COUNT).filter(move |bit| sig & (1 << bit) != 0))
}

fn length(m: &Model, bit: usize) -> usize {
    FIELDS.get(bit).map_or(0, |field| reflect::length(m, *field))
}

fn fits(m: &Model, sig: i32, found: usize) -> Result<(), StateError> {
    let expected = size(m, sig)?;
    if expected == found { Ok(()) } else { Err(StateError::Length { expected, found }) }
}

#[cfg(test)]
mod tests;
