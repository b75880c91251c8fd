//! The keys of every object of the format, by which misspelt ones are known.

/// A lab.
pub(super) const LAB: &[&str] = &[
    "model",
    "xml",
    "key",
    "title",
    "kind",
    "note",
    "height",
    "dock",
    "autoplay",
    "camera",
    "overlays",
    "toggles",
    "forceScale",
    "trail",
    "speeds",
    "stopAt",
    "setup",
    "controller",
    "controls",
    "plots",
    "readouts",
    "verify",
];
/// The view of a lab.
pub(super) const CAMERA: &[&str] = &["azimuth", "elevation", "distance", "target"];
/// A slider, a select or a button.
pub(super) const CONTROL: &[&str] = &[
    "type", "label", "unit", "min", "max", "step", "value", "digits", "set", "apply", "param", "init",
    "reset", "options", "run",
];
/// A plot.
pub(super) const PLOT: &[&str] =
    &["ylabel", "xlabel", "window", "ymin", "ymax", "height", "refLines", "traces"];
/// A curve.
pub(super) const TRACE: &[&str] = &["label", "expr", "dash"];
/// A readout.
pub(super) const READOUT: &[&str] = &["label", "expr", "digits"];
/// A quiz.
pub(super) const QUIZ: &[&str] = &["id", "title", "questions"];
/// A question of any kind.
pub(super) const QUESTION: &[&str] =
    &["kind", "q", "explain", "label", "options", "answer", "sim", "tol", "unit", "reference", "verify"];
/// What is claimed.
pub(super) const VERIFY: &[&str] = &["lab", "runs", "measure", "options", "value", "says", "exact"];
/// A run.
pub(super) const RUN: &[&str] = &["set", "press", "setup", "until", "steps"];
