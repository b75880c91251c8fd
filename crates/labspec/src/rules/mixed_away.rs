use crate::bind::ControlProgram;
use crate::check::choices::choices;
use crate::check::observations::ObservedLab;
use crate::check::setconst::digits;
use crate::run::{self, Play, Session, Start};
use crate::spec::Control;
use crate::stress;
use labspec_core::{Contact, Model, Plan};
use labspec_finding::{Example, Finding, Layer, Rule, Severity};
use labspec_monitors::stress::geom_label;
use std::ops::ControlFlow;

/// A control sets a contact parameter of one geom, but the contact has another value.
pub const MIXED_AWAY: &Rule = &Rule {
    code: "mixed-away",
    severity: Severity::Warning,
    exceptions: &[],
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

/// The number of steps in which contacts are observed, and the maximum number where none was observed by then.
const STEPS: usize = 300;
const MAX_STEPS: usize = 5000;
/// The number of steps between observations.
const STEP_INTERVAL: usize = 5;

/// A mixed parameter of contacts.
struct Mixed {
    field: &'static str,
    /// How the engine mixes it.
    how: fn(f64) -> &'static str,
    /// Its components for a geom.
    of_geom: fn(&Model, usize) -> Option<&[f64]>,
    /// The component of a contact that corresponds to a component of a geom.
    of_contact: fn(&Contact, usize) -> Option<f64>,
}

const MEAN: &str = "the contact uses their mean, weighted by `solmix`";

const MIXED: [Mixed; 3] = [
    Mixed {
        field: "geom_friction",
        how: |_| "the contact uses the larger of the two",
        of_geom: |m, g| m.geom_friction.get(3 * g..3 * g + 3),
        // A contact has the friction of both tangents, of turning, and of rolling about both tangents.
        of_contact: |c, k| c.friction.get([0, 2, 3].get(k).copied()?).copied(),
    },
    Mixed {
        field: "geom_solref",
        how: |value| if value > 0.0 { MEAN } else { "the contact uses the smaller of the two" },
        of_geom: |m, g| m.geom_solref.get(2 * g..2 * g + 2),
        of_contact: |c, k| c.solref.get(k).copied(),
    },
    Mixed {
        field: "geom_solimp",
        how: |_| MEAN,
        of_geom: |m, g| m.geom_solimp.get(5 * g..5 * g + 5),
        of_contact: |c, k| c.solimp.get(k).copied(),
    },
];

/// A contact between a geom that a control has changed and one that it has not changed.
struct MixedContact {
    /// The changed geom and the other one.
    geoms: [usize; 2],
    /// The component of the parameter.
    component: usize,
    /// The value of the changed geom, and that of the contact.
    written: f64,
    used: f64,
}

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
            let Some((value, MixedContact { geoms: [set, other], component, written, used })) = found else {
                continue;
            };
            findings.push(
                Finding::warning(
                    MIXED_AWAY,
                    bound.text.span(),
                    format!("the contact does not use what \"{}\" sets", control.label.value),
                )
                .why(format!(
                    "at {value}, {} has {}, but its contact with {} has {}: {}",
                    geom_label(&ready.model, set),
                    digits(written, 4),
                    geom_label(&ready.model, other),
                    digits(used, 4),
                    (what.how)(written)
                ))
                .help(format!(
                    "{}, or give {} a higher `priority`",
                    set_on_both(bound.text.as_str(), control, &ready.model, (other, component), what),
                    geom_label(&ready.model, set)
                )),
            );
        }
    }
}

/// The advice to set the parameter on the other geom too, with the code if that is known.
fn set_on_both(
    text: &str,
    control: &Control,
    model: &Model,
    (other, component): (usize, usize),
    what: &Mixed,
) -> String {
    let name = model.names.geom.get(other).filter(|name| !name.is_empty() && !name.contains(['\'', '\\']));
    let Some(name) = name else { return "set it on both geoms".to_string() };
    let short = what.field.trim_start_matches("geom_");
    let second = format!("model.geom('{name}').{short}[{component}] = value");
    let action = control.action();
    if action.is_some_and(|a| a.set.as_ref().is_some_and(|set| set.as_str() == text)) {
        return format!(
            "set it on both geoms: write `\"apply\": \"{text} = value; {second}\"` instead of `set`"
        );
    }
    match text.contains("= value") {
        true => format!("set it on both geoms: add `; {second}`"),
        false => format!("set it on both geoms, also on \"{name}\""),
    }
}

/// Finds a contact between a geom that the control has changed and one that it has not changed, with a value that differs from the
/// written one.
fn differs(
    observed: &ObservedLab<'_>,
    index: usize,
    value: labspec_expr::Value,
    what: &Mixed,
) -> Option<MixedContact> {
    let ready = observed.bench.ready;
    let (key, budget) = (ready.lab.keyframe(), observed.bench.budget());
    let start = Start { key, plan: Some(Plan::full()), budget };
    let mut session = Session::start(&ready.programs, &ready.model, start);
    let all = |session: &Session<'_>| -> Vec<Vec<f64>> {
        let model = &session.world.model;
        (0..ready.model.ngeom).map(|g| (what.of_geom)(model, g).unwrap_or(&[]).to_vec()).collect()
    };
    let before = all(&session);
    session.set_control(index, value);
    let after = all(&session);
    let changed = |g: usize| {
        let (before, after) = (before.get(g)?, after.get(g)?);
        before.iter().zip(after).position(|(a, b)| a.to_bits() != b.to_bits())
    };
    let (mut found, mut observed_contact) = (None, false);
    let steps = (stress::window(ready.lab) / session.world.model.opt.timestep).min(MAX_STEPS as f64) as usize;
    let played = Play { every: STEP_INTERVAL, ..Play::steps(steps.max(STEPS)) };
    run::play(&mut session, &played, |session, step| {
        for c in session.world.data.fields().contact.iter().filter(|c| c.efc_address.is_some()) {
            let (geoms, component) = match (changed(c.geom1), changed(c.geom2)) {
                (Some(k), None) => ([c.geom1, c.geom2], k),
                (None, Some(k)) => ([c.geom2, c.geom1], k),
                (Some(_), Some(_)) => {
                    observed_contact = true;
                    continue;
                }
                (None, None) => continue,
            };
            observed_contact = true;
            let written = after.get(geoms[0]).and_then(|values| values.get(component)).copied();
            if let (Some(used), Some(written)) = ((what.of_contact)(c, component), written)
                && (used - written).abs() > 1e-6 * written.abs()
            {
                found = Some(MixedContact { geoms, component, written, used });
                return ControlFlow::Break(());
            }
        }
        if observed_contact && step >= STEPS { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    });
    found.filter(|_| session.ended().is_none())
}
