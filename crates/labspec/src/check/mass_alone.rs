//! Controls that change the mass of a body that turns, and leave its inertia.

use super::Ready;
use crate::bind::ControlProgram;
use crate::finding::Finding;
use crate::rules;
use labspec_core::joint;
use labspec_core::reflect::FieldId;

pub(super) fn check(ready: &Ready<'_>, findings: &mut Vec<Finding>) {
    for (label, program) in &ready.programs.controls {
        let ControlProgram::Change(_, action) = program else { continue };
        let Some(bound) = action.run.as_ref() else { continue };
        let writes = bound.program.own_writes();
        let of = |name: &'static str| {
            writes
                .iter()
                .filter(move |w| FieldId::new(w.field.0 as usize).is_some_and(|f| f.info().name == name))
        };
        if of("body_inertia").next().is_some() {
            continue;
        }
        let turning = of("body_mass").find(|w| w.count == Some(1) && turns(ready, w.first));
        if turning.is_some() {
            findings.push(
                Finding::new(rules::MASS_ALONE, bound.text.span(), format!("\"{label}\" changes a mass and leaves the inertia"))
                    .help("multiply the three numbers of model.body_inertia by the same factor, where the body is to keep its shape"),
            );
        }
    }
}

/// Whether a body turns about a hinge or a ball joint, its own or one that carries it.
fn turns(ready: &Ready<'_>, body: usize) -> bool {
    let m = &ready.model;
    let mut at = body;
    while at > 0 {
        let own = (0..m.njnt).filter(|j| m.jnt_bodyid.get(*j).is_some_and(|b| *b as usize == at));
        if own
            .into_iter()
            .any(|j| m.jnt_type.get(j).is_some_and(|t| matches!(*t, joint::HINGE | joint::BALL)))
        {
            return true;
        }
        let parent = m.body_parentid.get(at).map_or(0, |p| *p as usize);
        if parent >= at {
            return false;
        }
        at = parent;
    }
    false
}
