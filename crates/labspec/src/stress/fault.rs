//! Faults of a run, with the numbers that show them.

use super::interaction::Interaction;
use crate::rules::{self, Rule};
use crate::run::two_digits;

/// The kind of a fault.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum FaultKind {
    /// A number is NaN or too large, and the engine reset the scene.
    Diverges,
    /// The engine gave another warning.
    Warns,
    /// Energy grows without a source.
    Grows,
    /// Motion exceeds every plausible bound without a warning.
    Silent,
    /// A joint is beyond its limit.
    PastLimit,
    /// A body passed through another one.
    Tunnels,
    /// A body stays inside another one.
    Sinks,
    /// The solver stops before its forces converge.
    Unsolved,
    /// Bodies penetrate each other deeply for a while.
    Penetrates,
    /// A contact switches on and off while nothing moves.
    Chatters,
    /// An object at rest creeps.
    Drifts,
    /// A program of the lab threw.
    Throws,
}

impl FaultKind {
    /// Every kind.
    pub const ALL: [FaultKind; 12] = [
        FaultKind::Diverges,
        FaultKind::Warns,
        FaultKind::Grows,
        FaultKind::Silent,
        FaultKind::PastLimit,
        FaultKind::Tunnels,
        FaultKind::Sinks,
        FaultKind::Unsolved,
        FaultKind::Penetrates,
        FaultKind::Chatters,
        FaultKind::Drifts,
        FaultKind::Throws,
    ];

    /// The kind as a heading.
    pub fn description(self) -> &'static str {
        match self {
            FaultKind::Diverges => "diverges",
            FaultKind::Warns => "engine warns",
            FaultKind::Grows => "energy grows",
            FaultKind::Silent => "silent divergence",
            FaultKind::PastLimit => "past a limit",
            FaultKind::Tunnels => "tunnelling",
            FaultKind::Sinks => "sinks in",
            FaultKind::Unsolved => "solver stops early",
            FaultKind::Penetrates => "penetration",
            FaultKind::Chatters => "chatter",
            FaultKind::Drifts => "drift",
            FaultKind::Throws => "throws",
        }
    }

    /// The rule of the findings that report it; `None` where several rules may.
    pub(super) fn rule(self) -> Option<&'static Rule> {
        match self {
            FaultKind::Diverges => Some(rules::SIMULATION_DIVERGES),
            FaultKind::Warns => Some(rules::ENGINE_WARNING),
            FaultKind::Grows => Some(rules::ENERGY_GROWS),
            FaultKind::Silent => Some(rules::RUNS_AWAY),
            FaultKind::PastLimit => Some(rules::PAST_LIMIT),
            FaultKind::Tunnels => Some(rules::PASSES_THROUGH),
            FaultKind::Sinks => Some(rules::SINKS_IN),
            FaultKind::Unsolved => Some(rules::SOLVER_STOPS_EARLY),
            FaultKind::Penetrates => Some(rules::PRESSED_DEEP),
            FaultKind::Chatters => Some(rules::CHATTERS),
            FaultKind::Drifts => Some(rules::CREEPS),
            FaultKind::Throws => None,
        }
    }
}

/// A measured value.
#[derive(Clone, Debug, PartialEq)]
pub struct FaultEvidence {
    /// The quantity.
    pub name: &'static str,
    /// The value.
    pub value: f64,
    /// Its unit; empty for a ratio or a count.
    pub unit: &'static str,
}

/// A fault of a run.
#[derive(Clone, Debug, PartialEq)]
pub struct Fault {
    /// Its kind.
    pub kind: FaultKind,
    /// Simulated time, s.
    pub time: f64,
    /// The joint, the body, or the two bodies in contact.
    pub subject: String,
    /// The cause, as far as it is known.
    pub cause: String,
    /// The numbers that show it.
    pub evidence: Vec<FaultEvidence>,
    /// The severity, to compare it with other faults of its kind.
    pub size: f64,
    /// Whether the run itself reports it.
    pub(super) by_run: bool,
}

impl Fault {
    /// A measured value by its name.
    pub fn value(&self, name: &str) -> Option<f64> {
        self.evidence.iter().find(|e| e.name == name).map(|e| e.value)
    }

    /// Whether this fault includes another one of the same bodies.
    pub(super) fn covers(&self, other: &Fault) -> bool {
        let [parts, others] = [self, other].map(|f| {
            let mut both: Vec<&str> =
                f.subject.split(" through ").flat_map(|part| part.split(" and ")).collect();
            both.sort_unstable();
            both
        });
        let same = parts == others;
        match (self.kind, other.kind) {
            (FaultKind::Tunnels, FaultKind::Tunnels | FaultKind::Penetrates) => same,
            (FaultKind::Sinks, FaultKind::Penetrates) => same,
            _ => false,
        }
    }

    /// The measured values in a line: `depth 0.02 m, share 1.3`.
    pub fn measured(&self) -> String {
        let one = |e: &FaultEvidence| {
            let unit = if e.unit.is_empty() { String::new() } else { format!(" {}", e.unit) };
            format!("{} {}{unit}", e.name, two_digits(e.value))
        };
        self.evidence.iter().map(one).collect::<Vec<_>>().join(", ")
    }
}

/// The same fault in one or several settings.
#[derive(Clone, Debug, PartialEq)]
pub struct FaultGroup {
    /// The fault in the simplest setting.
    pub fault: Fault,
    /// That setting.
    pub interaction: Interaction,
    /// Number of settings that show it.
    pub settings: usize,
    /// The setting with the most severe fault, and that fault, if it is another setting.
    pub worst: Option<(Interaction, Fault)>,
}

/// The most severe fault of a run, except for those in `except`. Drift, warnings and errors of programs do not count.
pub fn worst_fault<'f>(faults: &'f [Fault], except: &[(FaultKind, String)]) -> Option<&'f Fault> {
    let counts = |f: &&Fault| {
        !matches!(f.kind, FaultKind::Drifts | FaultKind::Throws | FaultKind::Warns)
            && !except.iter().any(|(kind, subject)| *kind == f.kind && *subject == f.subject)
    };
    faults.iter().filter(counts).min_by_key(|f| f.kind)
}

/// Adds a fault to its group. There is one group for each kind and object.
pub fn add_fault(list: &mut Vec<FaultGroup>, fault: Fault, interaction: &Interaction) {
    let same = |f: &&mut FaultGroup| f.fault.kind == fault.kind && f.fault.subject == fault.subject;
    match list.iter_mut().find(same) {
        None => list.push(FaultGroup { fault, interaction: interaction.clone(), settings: 1, worst: None }),
        Some(group) => {
            group.settings += 1;
            let size = group.worst.as_ref().map_or(group.fault.size, |(_, f)| f.size);
            // Five percent more severe counts as the same.
            if fault.size > 1.05 * size {
                group.worst = Some((interaction.clone(), fault));
            }
        }
    }
}
