use labspec_finding::{Example, Finding, Layer, Rule, Severity};
use std::ops::Range;

/// A claim refers to a file or to a listing that is not there.
pub const UNKNOWN_SOURCE: &Rule = &Rule {
    code: "unknown-source",
    severity: Severity::Error,
    exceptions: &[],
    layer: Layer::Structure,
    summary: "a claim refers to a file of values or to a listing that cannot be read",
    why: "its runs cannot be executed, so nothing is checked",
    bad: Example::Lesson(
        "A ball falls from 1 m in 0.43 s.\n\n```lab simlab\n{\"xml\": \"<mujoco><worldbody><geom name='floor' type='plane' size='1 1 1'/><body name='ball' pos='0 0 1'><freejoint/><geom name='ball' size='0.1'/></body></worldbody></mujoco>\", \"controls\": [{\"label\": \"height\", \"set\": \"data.qpos[2]\", \"min\": 0.5, \"max\": 2, \"step\": 0.5, \"value\": 1, \"init\": true}], \"verify\": {\"runs\": {\"fall\": {\"sweep\": {\"height\": ⟦{\"file\": \"heights.csv\"}⟧}, \"until\": 1}}, \"measure\": {\"lands\": \"first(contact('ball', 'floor'))\"}, \"says\": [[\"0.43 s\", \"fall.lands[1]\"]]}}\n```\n",
    ),
    good: Example::Lesson(
        "A ball falls from 1 m in 0.43 s.\n\n```lab simlab\n{\"xml\": \"<mujoco><worldbody><geom name='floor' type='plane' size='1 1 1'/><body name='ball' pos='0 0 1'><freejoint/><geom name='ball' size='0.1'/></body></worldbody></mujoco>\", \"controls\": [{\"label\": \"height\", \"set\": \"data.qpos[2]\", \"min\": 0.5, \"max\": 2, \"step\": 0.5, \"value\": 1, \"init\": true}], \"verify\": {\"runs\": {\"fall\": {\"sweep\": {\"height\": [0.5, 1]}, \"until\": 1}}, \"measure\": {\"lands\": \"first(contact('ball', 'floor'))\"}, \"says\": [[\"0.43 s\", \"fall.lands[1]\"]]}}\n```\n",
    ),
};

/// Reports a file or a listing that cannot be read.
pub(crate) fn unreadable(span: Range<usize>, name: &str, why: &str) -> Finding {
    Finding::new(UNKNOWN_SOURCE, span, format!("`{name}` cannot be used: {why}"))
        .help("correct the name, or write the values or the model here")
}
