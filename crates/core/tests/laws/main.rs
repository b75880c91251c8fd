//! Laws of mechanics on random trees, which hold for every algorithm. Quantities for comparison are computed independently from
//! their definitions, with dense matrices.

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
