use crate::bind::ControlProgram;
use crate::check::choices::choices;
use crate::check::observations::{ObservedLab, geom_name};
use crate::check::setconst::digits;
use crate::run::{self, Play, Session, Start};
use labspec_core::{Model, Plan};
use labspec_finding::{Example, Finding, Layer, Rule, Severity};
use std::ops::ControlFlow;

/// A control sets a contact parameter of one geom, but the contact has another value.
pub const MIXED_AWAY: &Rule = &Rule {
    code: "mixed-away",
    severity: Severity::Warning,
    layer: Layer::Run,
    summary: "a control sets a contact parameter of one geom, but the contact has another value",
    why: "a contact takes the larger friction of its two geoms and a mean of their `solref`, so it does not do what the slider says",
    bad: Example::Lab(
        r#"{"xml": "<mujoco><option gravity='2 0 -9.81'/><worldbody><geom name='floor' type='plane' size='1 1 1' friction='.5'/><body name='box' pos='0 0 .05'><freejoint/><geom name='box' type='box' size='.05 .05 .05' mass='1' friction='.5'/></body></worldbody></mujoco>", "stopAt": 0.5, "controls": [{"label": "friction", "set": "⟦model.geom_friction[3]⟧", "min": 0.1, "max": 0.9, "value": 0.5}], "readouts": [{"label": "place (m)", "expr": "data.qpos[0]"}]}"#,
    ),
    good: Example::Lab(
        r#"{"xml": "<mujoco><option gravity='2 0 -9.81'/><worldbody><geom name='floor' type='plane' size='1 1 1' friction='.5'/><body name='box' pos='0 0 .05'><freejoint/><geom name='box' type='box' size='.05 .05 .05' mass='1' friction='.5'/></body></worldbody></mujoco>", "stopAt": 0.5, "controls": [{"label": "friction", "apply": "model.geom_friction[0] = value; model.geom_friction[3] = value", "min": 0.05, "max": 0.3, "value": 0.1, "step": 0.05}], "readouts": [{"label": "place (m)", "expr": "data.qpos[0]"}]}"#,
    ),
};

/// The number of steps in which contacts are observed.
const STEPS: usize = 300;
/// The number of steps between observations.
const STEP_INTERVAL: usize = 5;

/// A mixed parameter: its name, how the engine mixes it, and its value for a geom.
struct Mixed {
    field: &'static str,
    how: &'static str,
    value_of_geom: fn(&Model, usize) -> Option<f64>,
}

const MIXED: [Mixed; 2] = [
    Mixed {
        field: "geom_friction",
        how: "the contact uses the larger of the two",
        value_of_geom: |m, g| m.geom_friction.get(3 * g).copied(),
    },
    Mixed {
        field: "geom_solref",
        how: "the contact uses their mean, weighted by `solmix`",
        value_of_geom: |m, g| m.geom_solref.get(2 * g).copied(),
    },
];

pub(crate) fn check_contact_mixing(observed: &ObservedLab<'_>, findings: &mut Vec<Finding>) {
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
            let Some((value, ([set, other], written, has))) = found else { continue };
            findings.push(
                Finding::warning(
                    MIXED_AWAY,
                    bound.text.span(),
                    format!("the contact does not use what \"{}\" sets", control.label.value),
                )
                .why(format!(
                    "at {value}, {} has {}, but its contact with {} has {}: {}",
                    geom_name(&ready.model, set),
                    digits(written, 4),
                    geom_name(&ready.model, other),
                    digits(has, 4),
                    what.how
                ))
                .help("set it on both geoms, or give this geom a higher `priority`"),
            );
        }
    }
}

/// Finds a contact between a geom that the control has changed and one that it has not changed, with a value that differs from the
/// written one.
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
        (0..ready.model.ngeom).map(|g| (what.value_of_geom)(&session.world.model, g)).collect()
    };
    let before = all(&session);
    session.set_control(index, value);
    let after = all(&session);
    let changed = |g: usize| before.get(g) != after.get(g);
    let mut found = None;
    run::play(&mut session, &Play { every: STEP_INTERVAL, ..Play::steps(STEPS) }, |session, _| {
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
