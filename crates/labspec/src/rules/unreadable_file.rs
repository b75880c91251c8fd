use labspec_finding::{Example, Layer, Rule, Severity};

/// Decided by `unreadable_finding` in `../../cli/src/scheduler.rs`.
pub const UNREADABLE_FILE: &Rule = &Rule {
    code: "unreadable-file",
    severity: Severity::Error,
    exceptions: &[],
    layer: Layer::Source,
    summary: "a file cannot be read",
    why: "nothing in it is checked",
    bad: Example::Repeated("A ball falls.\n", 1300000),
    good: Example::Repeated("A ball falls.\n", 13),
};
