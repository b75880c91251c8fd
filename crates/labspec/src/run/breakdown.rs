//! Breakdowns of a run, described for teachers: what broke, when, the likely cause, and a suggestion.

use super::cell::rounded;
use super::integrator::sets_integrator;
use super::session::Session;
use crate::monitors::stability::{self, StiffPart, UnstablePart};
use crate::rules::Rule;
use labspec_core::{AccessSet, Model, Obj};

/// A breakdown of a run, reported by the engine or silent, described for teachers.
#[derive(Clone, Debug, PartialEq)]
pub struct Breakdown {
    /// The rule of the finding.
    pub rule: &'static Rule,
    /// Which quantity is not a number, grows, passes or sinks, and when.
    pub what: String,
    /// The consequence on the page.
    pub why: &'static str,
    /// The likely cause, where it is known.
    pub cause: Option<String>,
    /// A shorter timestep, s.
    pub shorter: ShorterTimestep,
    /// Another remedy.
    pub instead: String,
}

/// A timestep that may be short enough.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ShorterTimestep {
    /// The timestep is not the cause.
    No,
    /// A shorter timestep may help; the value follows from theory if it is given. It was not tested.
    Maybe(Option<f64>),
    /// A run with this timestep had no fault.
    Tested(f64),
    /// None of the tested shorter timesteps gave a run without faults.
    Useless,
}

impl Breakdown {
    /// The likely cause and the remedies.
    pub fn help(&self) -> String {
        let cause = self.cause.as_ref().map_or(String::new(), |cause| format!("the likely cause: {cause}; "));
        let instead = &self.instead;
        let advice = match self.shorter {
            ShorterTimestep::No => instead.clone(),
            ShorterTimestep::Maybe(_) => format!("try a shorter timestep, or {instead}"),
            ShorterTimestep::Tested(h) => {
                format!("set the timestep to {} s (this run is fine with it), or {instead}", two_digits(h))
            }
            ShorterTimestep::Useless => format!("use {instead}; none of the tested shorter timesteps helps"),
        };
        cause + &advice
    }
}

/// A time, s, rounded to a tenth of a millisecond.
pub fn time(t: f64) -> String {
    without_zeros(format!("{t:.4}"))
}

/// Two significant digits as plain decimals: `0.85`, `0.00018`; larger numbers as integers. Very small or large numbers
/// have an exponent.
pub fn two_digits(x: f64) -> String {
    let size = x.abs();
    if size == 0.0 || !(1e-6..1e7).contains(&size) {
        return rounded(x, 2);
    }
    let places = (1.0 - size.log10().floor()).clamp(0.0, 9.0) as usize;
    without_zeros(format!("{x:.places$}"))
}

fn without_zeros(text: String) -> String {
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
}

/// The likely cause of a breakdown, and the remedies.
pub(super) struct BreakdownAdvice {
    pub(super) cause: Option<String>,
    pub(super) shorter: ShorterTimestep,
    pub(super) instead: String,
}

impl BreakdownAdvice {
    /// A remedy that does not concern the timestep.
    pub(super) fn only(instead: impl Into<String>) -> BreakdownAdvice {
        BreakdownAdvice { cause: None, shorter: ShorterTimestep::No, instead: instead.into() }
    }

    /// A shorter timestep, or another remedy.
    pub(super) fn shorter(instead: impl Into<String>) -> BreakdownAdvice {
        BreakdownAdvice { cause: None, shorter: ShorterTimestep::Maybe(None), instead: instead.into() }
    }

    /// The advice that follows from the stiffest part of the model of a session.
    pub(super) fn by_stiffness(session: &Session<'_>) -> BreakdownAdvice {
        let model = &session.world.model;
        let Some(worst) = stability::unstable_parts(model).into_iter().next() else {
            return BreakdownAdvice::shorter("softer contacts or springs, or a smaller range of the control");
        };
        BreakdownAdvice {
            cause: Some(format!(
                "{} is {} for a step of {} s",
                owner(model, &worst),
                how_stiff(&worst),
                model.opt.timestep
            )),
            shorter: ShorterTimestep::Maybe(Some(0.9 * worst.timestep)),
            instead: attribute_to_soften(&worst, &session.programs.access),
        }
    }

    pub(super) fn breakdown(self, rule: &'static Rule, what: String, why: &'static str) -> Breakdown {
        let BreakdownAdvice { cause, shorter, instead } = self;
        Breakdown { rule, what, why, cause, shorter, instead }
    }
}

/// The name of the stiff part: `the servo "lift"`, `the spring of joint "knee"`.
pub fn owner(model: &Model, s: &UnstablePart) -> String {
    let names = model.names.of_kind(s.object);
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

/// By how much it is too stiff: `1.8 times too stiff`, `just too stiff`.
pub fn how_stiff(s: &UnstablePart) -> String {
    match s.excess {
        x if x < 1.1 => "just too stiff".into(),
        x if x < 10.0 => format!("{} times too stiff", without_zeros(format!("{x:.1}"))),
        x => format!("{x:.0} times too stiff"),
    }
}

/// The attribute to make softer, or the integrator to choose where no program sets it.
pub fn attribute_to_soften(s: &UnstablePart, access: &AccessSet) -> String {
    let attribute = match (s.part, s.object) {
        (StiffPart::Servo, _) => "`kp` and `kv`",
        (StiffPart::Spring, _) => "`stiffness` and `damping`",
        (StiffPart::Limit, _) => "`solreflimit`",
        (StiffPart::Constraint, _) => "`solref`",
    };
    match sets_integrator(access) {
        true => format!("softer {attribute}"),
        false => format!("softer {attribute}, or `integrator=\"discrete\"`"),
    }
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
