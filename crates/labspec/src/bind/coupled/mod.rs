//! Coupled parameters of a model: pairs of a parameter that a program changes, and its partner, which must change with it.
//!
//! A body with ten times the mass has ten times the inertia, and a servo with twice the gain has twice the bias. A program
//! that writes only one of a pair creates a physically inconsistent body or servo. [`Coupled`] runs a lab with the partners
//! corrected after every program, so that the effect of the omission is measured and not guessed.
//!
//! | part | module |
//! |---|---|
//! | the pairs | `table` |
//! | how each partner follows | `follow` |
//! | sets of pairs | `pair_set` |
//! | the correction after programs | `correction` |
//! | pairs in the programs of a lab | `lab` |
//! | contact bits and the values derived from them | `bits` |
//! | shapes: bounding radius, inertia, the geom that carries the mass of a body | `shape` |
//! | the correction as statements of the language | `repair`, `statements` |

mod bits;
mod change;
mod correction;
mod follow;
mod lab;
mod pair_set;
mod repair;
mod shape;
mod statements;
mod table;

pub(crate) use correction::{Coupled, agree, has_uncoupled_change};
pub(crate) use lab::intentionally_separate;
pub(crate) use pair_set::PairSet;
pub(crate) use statements::Repair;
pub(crate) use table::CoupledPair;
