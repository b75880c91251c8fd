//! Faults of a run, with the numbers that show them.

use labspec_finding::two_digits;

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
    pub by_run: bool,
}

impl Fault {
    /// A measured value by its name.
    pub fn value(&self, name: &str) -> Option<f64> {
        self.evidence.iter().find(|e| e.name == name).map(|e| e.value)
    }

    /// Whether this fault includes another one of the same bodies.
    pub fn covers(&self, other: &Fault) -> bool {
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
