//! Laws of mechanics, on random trees: what must hold whatever the algorithm. Where a quantity is needed twice it
//! is built here a second time from its definition, with dense matrices.

#![allow(clippy::unwrap_used)]

mod conservation;
mod constraints;
mod contacts;
mod definitions;
mod dynamics;
mod integrators;
mod invariance;
mod inverse;
mod rest;
#[path = "../../../../tests/scenes.rs"]
mod scenes;
