//! Faults in several settings, and the rules that report them.

use super::interaction::Interaction;
use crate::rules::{self, Rule};
use labspec_monitors::stress::{Fault, FaultKind};

/// The rule of the findings that report a kind of fault; `None` where several rules may.
pub(super) fn rule_of(kind: FaultKind) -> Option<&'static Rule> {
    match kind {
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
