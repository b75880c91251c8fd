//! Adds a rule: the label of every trace states its unit.
use labspec::finding::{Finding, Severity};
use labspec::rules::{Example, Layer, Rule};
use labspec::{Checker, spec::Lesson};

const NO_UNIT: &Rule = &Rule {
    code: "house-no-unit",
    severity: Severity::Warning,
    exceptions: &[],
    layer: Layer::Structure,
    summary: "the label of a trace has no unit",
    why: "students cannot read the axis",
    bad: Example::Lab(r#"{"model": "m", "plots": [{"traces": [{"label": ⟦"h"⟧, "expr": "data.time"}]}]}"#),
    good: Example::Lab(r#"{"model": "m", "plots": [{"traces": [{"label": "t (s)", "expr": "data.time"}]}]}"#),
};
fn check(lesson: &Lesson) -> Vec<Finding> {
    let labels = lesson.all_labs().into_iter().flat_map(|lab| lab.traces()).map(|trace| &trace.label);
    let bare = labels.filter(|label| !label.as_str().ends_with(')'));
    bare.map(|label| Finding::new(NO_UNIT, label.span(), "no unit").help("write \"height (m)\"")).collect()
}
pub(crate) fn main() {
    print!("{}", rule());
}
/// The findings of a check of the rule's two examples.
pub(crate) fn rule() -> String {
    let mut checker = Checker::new([("m", "<mujoco><worldbody/></mujoco>")]).rule(check);
    let [wrong, right] = [NO_UNIT.bad, NO_UNIT.good].map(|lab| checker.check("lab.md", &lab.text()));
    format!("{}\nright: {:?}\n", wrong.findings[0], right.outcome())
}
