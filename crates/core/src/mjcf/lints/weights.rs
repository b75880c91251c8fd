//! Masses with an extreme ratio, and very small inertias.

use super::{digits, element_span, format_name};
use crate::kinds::joint;
use crate::mjcf::rules;
use crate::mjcf::text::diagnostic::Diagnostics;
use crate::mjcf::text::tree::ElementTree;
use crate::model::{Model, Obj};

/// The largest ratio of the masses of neighbours that is not reported.
const MAX_MASS_RATIO: f64 = 1e4;
/// The smallest inertia that is not reported, kg m².
const TINY: f64 = 1e-9;

pub(super) fn check_masses(tree: &ElementTree, m: &Model, report: &mut Diagnostics) {
    let body = |b: usize| m.names.of_kind(Obj::Body).get(b).map_or("", String::as_str);
    for b in 1..m.nbody {
        let parent = m.body_parentid.get(b).and_then(|p| usize::try_from(*p).ok()).unwrap_or(0);
        let moves = |b: usize| m.body_weldid.get(b).is_some_and(|w| *w != 0);
        let has_dofs = |b: usize| m.body_dofnum.get(b).is_some_and(|n| *n > 0);
        let mass = |b: usize| m.body_mass.get(b).copied().unwrap_or(0.0);
        let [child, base] = [mass(b), mass(parent)];
        let ratio = child.max(base) / child.min(base);
        if parent > 0 && moves(parent) && has_dofs(b) && child > 0.0 && base > 0.0 && ratio > MAX_MASS_RATIO {
            let message = format!(
                "{} has {} kg, but its neighbour {} has {} kg",
                format_name("body", body(b), b),
                digits(child),
                format_name("body", body(parent), parent),
                digits(base)
            );
            report
                .note(rules::MASSES_APART, element_span(tree, &["body"], body(b)), message)
                .why(format!(
                    "at a ratio of {}, the solver needs many more steps, and joints between the two give way",
                    digits(ratio)
                ))
                .help("check the units: grams for kilograms, millimetres for metres");
        }
    }
    for j in 0..m.njnt {
        let turns = m.jnt_type.get(j) == Some(&joint::HINGE);
        let inverse = m.jnt_dofadr.get(j).and_then(|d| m.dof_invweight0.get(usize::try_from(*d).ok()?));
        if let Some(inverse) = inverse.filter(|w| turns && **w > 1.0 / TINY) {
            let name = m.names.of_kind(Obj::Joint).get(j).map_or("", String::as_str);
            let message = format!(
                "{} turns an inertia of {} kg m²",
                format_name("joint", name, j),
                digits(1.0 / inverse)
            );
            report
                .note(rules::TINY_INERTIA, element_span(tree, &["joint"], name), message)
                .why("the smallest torque makes it faster than any timestep can follow")
                .help("check the units of its sizes, or give it `armature`");
        }
    }
}
