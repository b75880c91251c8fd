//! Parameters of a model that belong together: what a program changes, and the partner that it leaves behind.
//!
//! A body of ten times the mass has ten times the inertia, a servo of twice the gain has twice the bias. A program that writes
//! one of a pair alone makes a body, or a servo, that does not exist. [`Coupled`] makes a lab run with the partners corrected
//! behind every program, so that what the omission changes is measured and not guessed.
//!
//! | piece | module |
//! |---|---|
//! | the pairs | `table` |
//! | how each partner follows | `follow` |
//! | sets of pairs | `pair_set` |
//! | the correction behind programs | `correction` |
//! | pairs in the programs of a lab | `lab` |
//! | contact bits, and what stands between them and a contact | `bits` |
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

pub(crate) use correction::{Coupled, agree, left_behind};
pub(crate) use lab::chosen_apart;
pub(crate) use pair_set::PairSet;
pub(crate) use statements::Repair;
pub(crate) use table::Pair;
