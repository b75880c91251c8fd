//! Breakdowns of a run, described for teachers: what broke, when, the likely cause, and a suggestion.

use super::integrator::sets_integrator;
use super::session::Session;
use crate::rules::Rule;
use labspec_core::AccessSet;
use labspec_finding::{two_digits, without_zeros};
use labspec_monitors::stability::{self, StiffPart, UnstablePart, how_stiff, owner};

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
