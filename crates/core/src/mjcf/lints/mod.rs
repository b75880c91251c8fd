//! Constructs that are valid and rarely intended: unused names, time constants that are too short for the timestep,
//! ranges that the motion leaves at once. MuJoCo accepts all of them without a message.
//!
//! The lints run on a model without errors. Each states the consequence in numbers of this model.

mod angles;
mod contradicted;
mod overlapping;
mod too_fast;
mod unused_names;
mod weights;

use super::text::diagnostic::Diagnostics;
use super::text::tree::{ElementNode, ElementTree};
use crate::model::Model;
use std::ops::Range;

/// Reports doubtful constructs of a model.
pub(super) fn check_model(tree: &ElementTree, m: &Model, report: &mut Diagnostics) {
    unused_names::check_names(tree, report);
    contradicted::check_ranges(tree, m, report);
    angles::check_angles(tree, m, report);
    too_fast::check_time_constants(tree, m, report);
    weights::check_masses(tree, m, report);
    overlapping::check_overlaps(tree, m, report);
}

/// The span of the element with this name, of one of these kinds. If the name is empty or not found, the span of the root.
fn element_span(tree: &ElementTree, kinds: &[&str], name: &str) -> Range<usize> {
    let named = |n: &&ElementNode| kinds.contains(&n.element.name) && own_name(n) == Some(name);
    let found = tree.nodes.iter().find(named).filter(|_| !name.is_empty());
    found.or(tree.nodes.first()).map_or(0..0, |n| n.span.clone())
}

/// The name of an element, if it has one.
fn own_name(node: &ElementNode) -> Option<&str> {
    let given = node.attributes.iter().find(|a| a.attr.name == "name")?;
    match &given.value {
        super::text::values::Value::Text(name) => Some(name),
        _ => None,
    }
}

/// An object in a message: its kind, and its name or number.
fn format_name(kind: &str, name: &str, number: usize) -> String {
    match name {
        "" => format!("{kind} {number}"),
        name => format!("{kind} {}", super::text::diagnostic::shorten_name(name)),
    }
}

/// Formats a number with three significant digits.
fn digits(x: f64) -> String {
    match x.abs() {
        size if size != 0.0 && !(1e-3..1e5).contains(&size) => format!("{x:.2e}"),
        size => {
            let before = if size >= 1.0 { size.log10().floor() as usize + 1 } else { 1 };
            let text = format!("{x:.*}", 4_usize.saturating_sub(before));
            match text.contains('.') {
                true => text.trim_end_matches('0').trim_end_matches('.').to_string(),
                false => text,
            }
        }
    }
}
