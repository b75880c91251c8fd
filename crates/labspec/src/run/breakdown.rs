//! What the engine's warnings, and what goes wrong without one, mean for a lesson: what broke, when, the likely cause,
//! and what to write instead.

use super::{Session, silent};
use crate::monitors::stability::{self, StiffPart, Suspect};
use crate::rules::{self, Rule};
use labspec_core::{Model, Obj, Warning, WarningStat, joint};

/// What went wrong in a run, loudly or silently, in a teacher's words.
#[derive(Clone, Debug, PartialEq)]
pub struct Breakdown {
    /// The code of the finding.
    pub rule: &'static Rule,
    /// What is no number, what grows, passes or sinks, and when.
    pub what: String,
    /// What the page shows.
    pub why: &'static str,
    /// The likely cause, where it is known.
    pub cause: Option<String>,
    /// A shorter timestep, s.
    pub shorter: Shorter,
    /// What else to change.
    pub instead: String,
}

/// A timestep that may be short enough.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Shorter {
    /// The timestep has nothing to do with it.
    No,
    /// A shorter one may help, this one by theory where there is one. Nobody has tried it.
    Maybe(Option<f64>),
    /// A run with this one was sound.
    Tried(f64),
    /// None of those that were tried was sound.
    Useless,
}

impl Breakdown {
    /// The likely cause and what to change.
    pub fn help(&self) -> String {
        let cause = self.cause.as_ref().map_or(String::new(), |cause| format!("the likely cause: {cause}; "));
        let instead = &self.instead;
        let advice = match self.shorter {
            Shorter::No => instead.clone(),
            Shorter::Maybe(_) => format!("try a shorter timestep, or {instead}"),
            Shorter::Tried(h) => {
                format!("set the timestep to {} s (this run is fine with it), or {instead}", two_digits(h))
            }
            Shorter::Useless => format!("use {instead}; none of the tested shorter timesteps helps"),
        };
        cause + &advice
    }
}

const RESET: &str = "MuJoCo then resets the data and continues from time 0: a student sees the scene jump back without an explanation";

/// Warnings that may follow from each other, the cause first: only the first of them is told.
const STATE: [Warning; 4] = [Warning::Inertia, Warning::BadQpos, Warning::BadQvel, Warning::BadQacc];
/// Warnings that stand for themselves.
const OTHERS: [Warning; 3] = [Warning::BadCtrl, Warning::ContactFull, Warning::ConstraintFull];

impl Breakdown {
    /// The worst of what a session met; `None` when it met nothing.
    pub fn of(session: &Session<'_>) -> Option<Breakdown> {
        Breakdown::all(session).into_iter().next()
    }

    /// Everything that a session met, the worst first; without what follows from something else.
    pub fn all(session: &Session<'_>) -> Vec<Breakdown> {
        let met = |w: &Warning| {
            let stat = session.warnings.get(*w as usize).filter(|stat| stat.number > 0)?;
            Some(Breakdown::by_warning(&session.world.model, *w, stat))
        };
        let first = |w: &Warning| session.warnings.get(*w as usize).filter(|stat| stat.number > 0);
        let mut since = STATE.iter().find_map(first).map_or(f64::INFINITY, |stat| stat.first_time);
        let mut state = STATE.iter().find_map(met);
        if let Some(growth) = session.growth() {
            // What has grown for a while becomes no number in the end.
            if growth.time < since {
                since = growth.time;
                let grows = silent::growth(&session.world.model, growth);
                let then = state.map_or(String::new(), |s| format!("; in the end {}", s.what));
                let what = format!("{}{then}", grows.what);
                state = Some(Breakdown { what, ..grows });
            }
        }
        // Where energy grows, or numbers are none, anything may follow from it; not what was before.
        let noticed = silent::first(&session.world.model, &session.noticed());
        let before = noticed.filter(|(time, _)| *time < since).map(|(_, b)| b);
        before.into_iter().chain(state).chain(OTHERS.iter().filter_map(met)).collect()
    }

    /// A warning of the engine.
    fn by_warning(model: &Model, warning: Warning, stat: &WarningStat) -> Breakdown {
        let joint = |adr: &[i32], width| joint_of(model, stat.lastinfo, adr, width);
        let at = format!("at t = {} s", time(stat.first_time));
        let no_number = |what: String| format!("{what} is not a number or exceeds 1e10 {at}");
        let (rule, what, why, advice) = match warning {
            Warning::BadQpos => (
                rules::SIMULATION_DIVERGES,
                no_number(format!("the position of {}", joint(&model.jnt_qposadr, joint::nq))),
                RESET,
                Advice::of(model),
            ),
            Warning::BadQvel => (
                rules::SIMULATION_DIVERGES,
                no_number(format!("the velocity of {}", joint(&model.jnt_dofadr, joint::nv))),
                RESET,
                Advice::of(model),
            ),
            Warning::BadQacc => (
                rules::SIMULATION_DIVERGES,
                no_number(format!("the acceleration of {}", joint(&model.jnt_dofadr, joint::nv))),
                RESET,
                Advice::of(model),
            ),
            Warning::BadCtrl => (
                rules::SIMULATION_DIVERGES,
                no_number(format!("control {}", stat.lastinfo)),
                "MuJoCo then sets all controls to 0: a student sees everything go limp without an explanation",
                Advice::only("guard the expression for `data.ctrl` with a condition"),
            ),
            Warning::Inertia => (
                rules::ENGINE_WARNING,
                format!(
                    "the parts that {} moves have no positive inertia {at}",
                    joint(&model.jnt_dofadr, joint::nv)
                ),
                "a push then gives no meaningful acceleration: things do not move, move backwards or vanish",
                Advice::only(
                    "give every moving body a mass and an inertia above 0: check the model, and what writes `body_mass`, `body_inertia` or `dof_armature`",
                ),
            ),
            Warning::ContactFull => (
                rules::ENGINE_WARNING,
                format!("there are more contacts than the {} that the engine keeps {at}", stat.lastinfo),
                "the dropped contacts do not push: bodies silently sink into each other",
                Advice::only("let fewer bodies touch, or move them apart at the start"),
            ),
            Warning::ConstraintFull => (
                rules::ENGINE_WARNING,
                format!("there are more contacts, limits and other constraints than the engine keeps {at}"),
                "the dropped constraints do not act: bodies silently sink into each other, and joints pass their limits",
                Advice::only("let fewer bodies touch, or move them apart at the start"),
            ),
        };
        advice.breakdown(rule, what, why)
    }
}

/// A time to a tenth of a millisecond.
pub fn time(t: f64) -> String {
    without_zeros(format!("{t:.4}"))
}

/// Two digits as plain decimals: `0.85`, `0.00018`; larger numbers whole. Only what is too long for that has an exponent.
pub fn two_digits(x: f64) -> String {
    let size = x.abs();
    if size == 0.0 || !(1e-6..1e7).contains(&size) {
        return super::shown(x, 2);
    }
    let places = (1.0 - size.log10().floor()).clamp(0.0, 9.0) as usize;
    without_zeros(format!("{x:.places$}"))
}

fn without_zeros(text: String) -> String {
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
}

/// The likely cause of what breaks, and what to write instead.
pub(super) struct Advice {
    pub(super) cause: Option<String>,
    pub(super) shorter: Shorter,
    pub(super) instead: String,
}

impl Advice {
    /// What to write, and nothing of timesteps.
    pub(super) fn only(instead: impl Into<String>) -> Advice {
        Advice { cause: None, shorter: Shorter::No, instead: instead.into() }
    }

    /// A shorter timestep, or something else.
    pub(super) fn shorter(instead: impl Into<String>) -> Advice {
        Advice { cause: None, shorter: Shorter::Maybe(None), instead: instead.into() }
    }

    /// By what of a model is too stiff for its timestep.
    pub(super) fn of(model: &Model) -> Advice {
        let Some(worst) = stability::suspects(model).into_iter().next() else {
            return Advice::shorter("softer contacts or springs, or a smaller range of the control");
        };
        Advice {
            cause: Some(format!(
                "{} is {} for a step of {} s",
                owner(model, &worst),
                how_stiff(&worst),
                model.opt.timestep
            )),
            shorter: Shorter::Maybe(Some(0.9 * worst.timestep)),
            instead: softer(&worst),
        }
    }

    pub(super) fn breakdown(self, rule: &'static Rule, what: String, why: &'static str) -> Breakdown {
        let Advice { cause, shorter, instead } = self;
        Breakdown { rule, what, why, cause, shorter, instead }
    }
}

/// What is too stiff: `the servo "lift"`, `the spring of joint "knee"`.
pub fn owner(model: &Model, s: &Suspect) -> String {
    let names = model.names.of(s.object);
    let name = match names.get(s.id) {
        Some(name) if !name.is_empty() => format!("\"{name}\""),
        _ => s.id.to_string(),
    };
    match (s.part, s.object) {
        (StiffPart::Servo, _) => format!("the servo {name}"),
        (StiffPart::Constraint, Obj::Geom) => format!("the contact of geom {name}"),
        (StiffPart::Constraint, Obj::Pair) => format!("the contact of pair {name}"),
        (StiffPart::Constraint, _) => format!("the equality {name}"),
        (part, object) => {
            let what = if part == StiffPart::Limit { "limit" } else { "spring or damper" };
            format!("the {what} of {} {name}", if object == Obj::Tendon { "tendon" } else { "joint" })
        }
    }
}

/// How much too stiff: `1.8 times too stiff`, `just too stiff`.
pub fn how_stiff(s: &Suspect) -> String {
    match s.excess {
        x if x < 1.1 => "just too stiff".into(),
        x if x < 10.0 => format!("{} times too stiff", without_zeros(format!("{x:.1}"))),
        x => format!("{x:.0} times too stiff"),
    }
}

/// What to make softer.
pub fn softer(s: &Suspect) -> String {
    let attribute = match (s.part, s.object) {
        (StiffPart::Servo, _) => "`kp` and `kv`",
        (StiffPart::Spring, _) => "`stiffness` and `damping`",
        (StiffPart::Limit, _) => "`solreflimit`",
        (StiffPart::Constraint, _) => "`solref`",
    };
    format!("softer {attribute}, or `integrator=\"discrete\"`")
}

pub(super) fn joint_of(model: &Model, index: usize, adr: &[i32], width: fn(i32) -> usize) -> String {
    let found = (0..model.njnt).find(|&j| {
        let first = adr.get(j).map_or(0, |&a| a as usize);
        (first..first + width(model.jnt_type.get(j).copied().unwrap_or(3))).contains(&index)
    });
    match found.and_then(|j| model.names.joint.get(j).map(|n| (j, n))) {
        Some((_, name)) if !name.is_empty() => format!("joint \"{name}\""),
        Some((j, _)) => format!("joint {j}"),
        None => format!("degree of freedom {index}"),
    }
}
