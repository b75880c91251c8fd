use crate::check::assignments::{Assignment, assignments};
use crate::spec::Lab;
use labspec_core::{Model, biastype, dyntype};
use labspec_expr::ast::BinaryOp;
use labspec_finding::{Example, Finding, Layer, Rule, Severity};

/// A controller adds to a force in every step.
pub const FORCE_ACCUMULATES: &Rule = &Rule {
    code: "force-accumulates",
    severity: Severity::Warning,
    exceptions: &[],
    layer: Layer::Program,
    summary: "a controller adds to a force in every step",
    why: "an applied force keeps its value until it is set again: with `+=` it grows with every step",
    bad: Example::Statements("⟦data.qfrc_applied[6] += 0.001⟧"),
    good: Example::Statements("data.qfrc_applied[6] = 0.001"),
};

/// The fields that keep what a program stores.
const FIELDS: [&str; 2] = ["qfrc_applied", "xfrc_applied"];

pub(crate) fn check_controller(lab: &Lab, model: &Model, findings: &mut Vec<Finding>) {
    let Some(controller) = &lab.controller else { return };
    let all = assignments(controller);
    let has_motors = model.actuator_biastype.iter().all(|kind| *kind == biastype::NONE)
        && model.actuator_dyntype.iter().all(|kind| *kind == dyntype::NONE);
    let field_of = |a: &Assignment| {
        let of_motor = a.target.contains(".ctrl[") && has_motors && !a.value.contains("timestep");
        let name = FIELDS.into_iter().find(|name| a.target.contains(name));
        name.or(if of_motor { Some(".ctrl") } else { None })
    };
    for assignment in &all {
        let Some(field) = field_of(assignment) else { continue };
        let adds = matches!(assignment.op, Some(BinaryOp::Add | BinaryOp::Subtract))
            || assignment.op.is_none() && assignment.is_cumulative();
        // A controller that sets the field first adds up the forces of one step.
        let is_set = all.iter().any(|other| field_of(other) == Some(field) && !other.is_cumulative())
            || ["fill", "set"].iter().any(|method| {
                controller.as_str().contains(&format!("{}.{method}(", field.trim_start_matches('.')))
            });
        if !adds || is_set {
            continue;
        }
        let span = controller.span_of(assignment.span.into());
        let message = format!("every step adds to `{}`", assignment.target);
        let found = Finding::new(FORCE_ACCUMULATES, span.clone(), message);
        let sign = if assignment.op == Some(BinaryOp::Subtract) { "-" } else { "" };
        let is_simple = assignment.op.is_some()
            && !assignment.value.is_empty()
            && (sign.is_empty() || !assignment.value.contains([' ', '+', '-']));
        let once = all.iter().filter(|a| a.target == assignment.target).count() == 1;
        findings.push(match is_simple && once {
            true => {
                let meant = format!("{} = {sign}{}", assignment.target, assignment.value);
                found.help(format!("write `{meant}`"))
            }
            false => found
                .help(format!("set `{}` to 0 first, or store the whole force with `=`", assignment.target)),
        });
    }
}
