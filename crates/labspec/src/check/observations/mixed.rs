//! Contact parameters that a control sets on one geom, and that the contact mixes with those of the other: what the contact really has.

use super::ObservedLab;
use crate::bind::ControlProgram;
use crate::check::choices::choices;
use crate::check::setconst::digits;
use crate::finding::Finding;
use crate::rules;
use crate::run::{self, Play, Session, Start};
use labspec_core::{Model, Obj, Plan};
use std::ops::ControlFlow;

/// Steps in which contacts are observed for.
const STEPS: usize = 300;
/// Every so many steps.
const EVERY: usize = 5;

/// What is mixed: its name, how the engine mixes it, and its value of a geom.
struct Mixed {
    field: &'static str,
    how: &'static str,
    of: fn(&Model, usize) -> Option<f64>,
}

const MIXED: [Mixed; 2] = [
    Mixed {
        field: "geom_friction",
        how: "the contact uses the larger of the two",
        of: |m, g| m.geom_friction.get(3 * g).copied(),
    },
    Mixed {
        field: "geom_solref",
        how: "the contact uses their mean, weighted by `solmix`",
        of: |m, g| m.geom_solref.get(2 * g).copied(),
    },
];

pub(super) fn check_mixed_dimensions(observed: &ObservedLab<'_>, findings: &mut Vec<Finding>) {
    let ready = observed.bench.ready;
    for (index, control) in ready.lab.controls.iter().enumerate() {
        let Some((_, ControlProgram::Change(_, action))) = ready.programs.controls.get(index) else {
            continue;
        };
        let Some(bound) = action.run.as_ref() else { continue };
        let named = |what: &&Mixed| {
            bound.program.own_writes().iter().any(|w| {
                labspec_core::reflect::FieldId::new(w.field.0 as usize)
                    .is_some_and(|f| f.info().name == what.field)
            })
        };
        for what in MIXED.iter().filter(named) {
            let found = choices(control).into_iter().find_map(|value| {
                let printed = value.to_string();
                Some((printed, differs(observed, index, value, what)?))
            });
            let Some((value, ([own, other], written, has))) = found else { continue };
            let name = |g: usize| match ready.model.names.of(Obj::Geom).get(g).filter(|n| !n.is_empty()) {
                Some(name) => format!("geom \"{name}\""),
                None => format!("geom {g}"),
            };
            findings.push(
                Finding::warning(
                    rules::MIXED_AWAY,
                    bound.text.span(),
                    format!("the contact does not use what \"{}\" sets", control.label.value),
                )
                .why(format!(
                    "at {value}, {} has {}, but its contact with {} has {}: {}",
                    name(own),
                    digits(written, 4),
                    name(other),
                    digits(has, 4),
                    what.how
                ))
                .help("set it on both geoms, or give this geom a higher `priority`"),
            );
        }
    }
}

/// A contact between a geom that the control has changed and one that it has not, which has another value than was written.
fn differs(
    observed: &ObservedLab<'_>,
    index: usize,
    value: labspec_expr::Value,
    what: &Mixed,
) -> Option<([usize; 2], f64, f64)> {
    let ready = observed.bench.ready;
    let (key, budget) = (ready.lab.keyframe(), observed.bench.budget());
    let start = Start { key, plan: Some(Plan::full()), budget };
    let mut session = Session::start(&ready.programs, &ready.model, start);
    let all = |session: &Session<'_>| -> Vec<Option<f64>> {
        (0..ready.model.ngeom).map(|g| (what.of)(&session.world.model, g)).collect()
    };
    let before = all(&session);
    session.set_control(index, value);
    let after = all(&session);
    let changed = |g: usize| before.get(g) != after.get(g);
    let mut found = None;
    run::play(&mut session, &Play { every: EVERY, ..Play::steps(STEPS) }, |session, _| {
        for c in session.world.data.fields().contact.iter().filter(|c| c.efc_address.is_some()) {
            let pair = match (changed(c.geom1), changed(c.geom2)) {
                (true, false) => [c.geom1, c.geom2],
                (false, true) => [c.geom2, c.geom1],
                _ => continue,
            };
            let has = if what.field == "geom_friction" { c.friction.first() } else { c.solref.first() };
            let written = pair.first().and_then(|g| after.get(*g).copied().flatten());
            if let (Some(&has), Some(written)) = (has, written)
                && (has - written).abs() > 1e-6 * written.abs()
            {
                found = Some((pair, written, has));
                return ControlFlow::Break(());
            }
        }
        ControlFlow::Continue(())
    });
    found.filter(|_| session.ended().is_none())
}
