use crate::bind::{ControlProgram, Programs};
use crate::json::read::named;
use crate::spec::{INTEGRATOR, Lab};
use labspec_core::reflect::option;
use labspec_expr::Effects;
use labspec_finding::{Example, Finding, Layer, Rule, Severity};

/// A control of an integrators lab sets the integrator.
pub const INTEGRATOR_CONTROL: &Rule = &Rule {
    code: "integrator-control",
    severity: Severity::Error,
    exceptions: &[],
    layer: Layer::Program,
    summary: "a control of an integrators lab sets the integrator, or is called \"integrator\"",
    why: "the lab compares integrators, so each of its runs has its own; after a reset, the control has no effect",
    bad: Example::Lesson(
        "```lab integrators\n{\"model\": \"ball\", \"controls\": [{\"type\": \"select\", \"label\": \"⟦method⟧\", \"set\": \"model.opt.integrator\", \"options\": [[\"Euler\", 0], [\"RK4\", 1]], \"value\": 0, \"reset\": true}]}\n```\n",
    ),
    good: Example::Lesson(
        "```lab integrators\n{\"model\": \"ball\", \"integrators\": [\"Euler\", \"RK4\"]}\n```\n",
    ),
};

/// Checks the controls of a lab that compares integrators.
pub(crate) fn check_controls(lab: &Lab, programs: &Programs, findings: &mut Vec<Finding>) {
    if lab.comparison.is_none() {
        return;
    }
    let writes = |e: &Effects| e.writes.iter().any(|a| a.field.0 as usize == option::integrator.index());
    for (control, (_, program)) in lab.authored_controls().iter().zip(&programs.controls) {
        let run = match program {
            ControlProgram::Change(_, action) => &action.run,
            ControlProgram::Press(run) => run,
        };
        let sets = run.as_ref().is_some_and(|bound| writes(bound.program.effects()));
        if !sets && control.label.value != INTEGRATOR {
            continue;
        }
        let what = if sets { "sets the integrator" } else { "has the label of the comparison" };
        let label = named(&control.label.value);
        findings.push(
            Finding::new(INTEGRATOR_CONTROL, control.label.span(), format!("the control {label} {what}"))
                .help("list the integrators in `integrators`, and delete or rename the control"),
        );
    }
}
