use super::example::{FALL, STORED};
use labspec_finding::{Example, Layer, Rule, Severity};

/// Decided by `orphaned_snapshot_finding` in `../../cli/src/scheduler.rs`.
pub const SNAPSHOT_WITHOUT_LESSON: &Rule = &Rule {
    code: "snapshot-without-lesson",
    severity: Severity::Error,
    exceptions: &[],
    layer: Layer::Source,
    summary: "a snapshot has no lesson",
    why: "a renamed or moved lesson is no longer compared with its snapshot, and nobody notices",
    bad: Example::Files(&[(
        "gone.json.snap",
        r##"⟦⟧labspec snapshot 1

lab "#1" "A fall"
run as it stands
  0.2 s, timestep 0.002 s, Euler, Newton, pyramidal
  time                   0  0.02  0.04  0.06  0.08   0.1  0.12  0.14  0.16  0.18   0.2
  "readout/height (m)"   1     1     1  0.98  0.97  0.95  0.93   0.9   0.9   0.8   0.8

end of 1 labs
"##
        .as_bytes(),
    )]),
    good: Example::Files(&[("fall.json", FALL), ("fall.json.snap", STORED)]),
};
