//! Boxes and meshes that meet in faces or edges: several contacts from the polygon they share.

use super::convex::between;
use super::{Settings, Touch};
use crate::geometry::Shape;
use crate::geometry::convex::{Convex, Room, nearest};

/// Contacts of two shapes without margin.
pub(super) fn contacts(
    a: &Shape,
    b: &Shape,
    margin: f64,
    settings: &Settings,
    room: &mut Room,
    out: &mut Vec<Touch>,
) {
    let (mut u, mut v) = (Convex::new(a, margin), Convex::new(b, margin));
    let found = nearest(&mut u, &mut v, 0.0, settings.effort, room);
    let Some([on_a, on_b]) = found.witness.filter(|_| found.dist < 0.0) else { return };
    out.push(between(margin + found.dist, on_a, on_b));
}
