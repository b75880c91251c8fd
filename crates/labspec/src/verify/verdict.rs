//! The result of checking an answer: its verdict, the reason, and the margin of every option.

use super::format::significant;
use crate::ledger::{Evidence, State};
use serde::{Deserialize, Serialize};

/// The verdict of an answer.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub enum Verdict {
    /// The simulation shows that only the keyed answer holds.
    Verified,
    /// Only the keyed answer holds, by formulas alone, without a simulation.
    Computed,
    /// It holds, but not under perturbed numerics: a shorter timestep, a converged solver, a start perturbed by 1e-14,
    /// another integrator.
    Fragile,
    /// The keyed answer holds, and so does another one.
    Ambiguous,
    /// The keyed answer does not hold.
    Refuted,
    /// It could not be checked: the runs or the conditions have errors.
    Failed,
    /// There is nothing to check.
    Unverified,
}

impl Verdict {
    /// Every verdict.
    pub const ALL: [Verdict; 7] = [
        Verdict::Verified,
        Verdict::Computed,
        Verdict::Fragile,
        Verdict::Ambiguous,
        Verdict::Refuted,
        Verdict::Failed,
        Verdict::Unverified,
    ];

    /// The verdict as one word.
    pub fn as_str(self) -> &'static str {
        match self {
            Verdict::Verified => "verified",
            Verdict::Computed => "computed",
            Verdict::Fragile => "fragile",
            Verdict::Ambiguous => "ambiguous",
            Verdict::Refuted => "refuted",
            Verdict::Failed => "failed",
            Verdict::Unverified => "unverified",
        }
    }

    /// The state of the claim in the ledger.
    pub fn state(self) -> State {
        match self {
            Verdict::Verified => State::True(Evidence::Simulated),
            Verdict::Computed => State::True(Evidence::Computed),
            Verdict::Fragile | Verdict::Ambiguous | Verdict::Refuted => State::False,
            Verdict::Failed => State::Unchecked,
            Verdict::Unverified => State::NotClaimed,
        }
    }
}

/// A checked answer.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Answer {
    /// The verdict.
    pub verdict: Verdict,
    /// The reason, unless it is verified; or which options are undecided.
    pub reason: String,
    /// Every option with the result of its condition, or the value of a number.
    pub weights: Vec<Weight>,
}

/// An option, and by which margin its condition holds.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Weight {
    /// Its index, from 0; `None` for the value of a number.
    pub option: Option<usize>,
    /// Whether the condition holds; `None` where the author declares the option as undecided.
    pub holds: Option<bool>,
    /// Margin of the decisive comparison; negative where the condition does not hold.
    #[serde(with = "crate::verify::float_bits")]
    pub margin: Option<f64>,
    /// The largest change of the margin under perturbed numerics: half and a quarter of the timestep, other integrators, a
    /// converged solver, a perturbed start.
    #[serde(with = "crate::verify::float_bits")]
    pub spread: Option<f64>,
}

impl Weight {
    /// Whether eight times the spread reaches the margin. With errors of the first order in the timestep, the remaining
    /// error is as large as the change at half the timestep; the factor leaves a reserve.
    pub(super) fn is_close(&self) -> bool {
        self.margin
            .zip(self.spread)
            .is_some_and(|(margin, spread)| spread > 0.0 && 8.0 * spread >= margin.abs())
    }

    /// Widens the spread by the margin under perturbed numerics.
    pub(super) fn widen(&mut self, other: Option<f64>) {
        if let (Some(margin), Some(other)) = (self.margin, other) {
            self.spread = Some(self.spread.unwrap_or(0.0).max((other - margin).abs()));
        }
    }

    /// The result in words: `holds, by 0.02`; `does not hold, by 0.6`.
    pub fn describe(&self) -> String {
        let Some(holds) = self.holds else { return "is not decided by this evidence".to_string() };
        let spread = match self.spread {
            Some(spread) if spread > 0.0 => {
                format!("; other numerics change that by {}", significant(spread))
            }
            _ => String::new(),
        };
        let words = match (holds, self.margin) {
            (true, Some(0.0)) => "holds exactly".to_string(),
            (false, Some(0.0)) => "does not hold: both sides are equal".to_string(),
            (true, Some(margin)) => format!("holds, by {}", significant(margin.abs())),
            (false, Some(margin)) => format!("does not hold, by {}", significant(margin.abs())),
            (true, None) => "holds".to_string(),
            (false, None) => "does not hold".to_string(),
        };
        words + &spread
    }
}

impl Answer {
    /// An answer without a `verify` object.
    pub(crate) fn unverified(reason: impl Into<String>) -> Answer {
        Answer { verdict: Verdict::Unverified, reason: reason.into(), weights: Vec::new() }
    }

    /// An answer that could not be checked.
    pub(super) fn failed(reason: impl Into<String>) -> Answer {
        Answer { verdict: Verdict::Failed, reason: reason.into(), weights: Vec::new() }
    }
}
