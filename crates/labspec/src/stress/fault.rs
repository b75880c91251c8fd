//! What goes wrong in a run, with the numbers that show it.

use super::interaction::Interaction;
use crate::rules::{self, Rule};
use crate::run::two_digits;

/// What goes wrong.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum FaultKind {
    /// A number was not one, or too large, and the engine reset the scene.
    Diverges,
    /// The engine warned of something else.
    Warns,
    /// Energy that nothing gave.
    Grows,
    /// Everything leaves every sensible bound, and nobody warned.
    Silent,
    /// A joint is past its limit.
    PastLimit,
    /// A body passed through another one.
    Tunnels,
    /// A body stays in another one.
    Sinks,
    /// The solver stops before it has found the forces.
    Unsolved,
    /// Bodies are deep in each other for a while.
    Penetrates,
    /// A contact switches on and off while nothing moves.
    Chatters,
    /// What rests creeps.
    Drifts,
    /// A program of the lab threw.
    Throws,
}

impl FaultKind {
    /// In words, as a heading.
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

    /// The rule of the findings that report it; `None` where several may.
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

/// A value that was measured.
#[derive(Clone, Debug, PartialEq)]
pub struct Evidence {
    /// What it is.
    pub name: &'static str,
    /// The value.
    pub value: f64,
    /// Its unit; empty for a share or a count.
    pub unit: &'static str,
}

/// Something that went wrong in a run.
#[derive(Clone, Debug, PartialEq)]
pub struct Fault {
    /// What.
    pub kind: FaultKind,
    /// When, s of the lab's clock.
    pub time: f64,
    /// The joint, the body, or the two bodies that touch.
    pub who: String,
    /// Why, as far as that is known.
    pub cause: String,
    /// The numbers that show it.
    pub evidence: Vec<Evidence>,
    /// How bad it is, to compare it with others of its kind.
    pub size: f64,
    /// The run itself reports it.
    pub(super) by_run: bool,
}

impl Fault {
    /// One of the numbers, by its name.
    pub fn value(&self, name: &str) -> Option<f64> {
        self.evidence.iter().find(|e| e.name == name).map(|e| e.value)
    }

    /// Whether another fault says the same of the same bodies, or less.
    pub(super) fn covers(&self, other: &Fault) -> bool {
        let [mine, others] = [self, other].map(|f| {
            let mut both: Vec<&str> = f.who.split(" through ").flat_map(|part| part.split(" and ")).collect();
            both.sort_unstable();
            both
        });
        let same = mine == others;
        match (self.kind, other.kind) {
            (FaultKind::Tunnels, FaultKind::Tunnels | FaultKind::Penetrates) => same,
            (FaultKind::Sinks, FaultKind::Penetrates) => same,
            _ => false,
        }
    }

    /// The numbers in a line: `depth 0.02 m, share 1.3`.
    pub fn measured(&self) -> String {
        let one = |e: &Evidence| {
            let unit = if e.unit.is_empty() { String::new() } else { format!(" {}", e.unit) };
            format!("{} {}{unit}", e.name, two_digits(e.value))
        };
        self.evidence.iter().map(one).collect::<Vec<_>>().join(", ")
    }
}

/// The same fault in one or several settings.
#[derive(Clone, Debug, PartialEq)]
pub struct FaultGroup {
    /// As it was in the simplest setting.
    pub fault: Fault,
    /// That setting.
    pub interaction: Interaction,
    /// How many settings show it.
    pub settings: usize,
    /// The setting in which it is the worst, and how it is there, where that is another one.
    pub worst: Option<(Interaction, Fault)>,
}

/// The worst fault that breaks a run, except for those in `except`: drift, warnings and programs that throw do not count.
pub fn worst_fault<'f>(faults: &'f [Fault], except: &[(FaultKind, String)]) -> Option<&'f Fault> {
    let counts = |f: &&Fault| {
        !matches!(f.kind, FaultKind::Drifts | FaultKind::Throws | FaultKind::Warns)
            && !except.iter().any(|(kind, who)| *kind == f.kind && *who == f.who)
    };
    faults.iter().filter(counts).min_by_key(|f| f.kind)
}

/// Adds a fault to its group: there is one for each kind and each object.
pub fn add_fault(list: &mut Vec<FaultGroup>, fault: Fault, interaction: &Interaction) {
    let same = |f: &&mut FaultGroup| f.fault.kind == fault.kind && f.fault.who == fault.who;
    match list.iter_mut().find(same) {
        None => list.push(FaultGroup { fault, interaction: interaction.clone(), settings: 1, worst: None }),
        Some(group) => {
            group.settings += 1;
            let size = group.worst.as_ref().map_or(group.fault.size, |(_, f)| f.size);
            // A little worse is the same.
            if fault.size > 1.05 * size {
                group.worst = Some((interaction.clone(), fault));
            }
        }
    }
}
