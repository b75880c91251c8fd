//! Compares units with dimensions: labels with displayed numbers, controls with the fields that they set, and terms of
//! sums.

use crate::bind::{Bound, ControlProgram, ModelNames, Programs, Scope, dimensions};
use crate::finding::{Finding, Severity};
use crate::rules::{label_unit, mixed_dimensions};
use crate::source::Text;
use crate::spec::Lab;
use labspec_core::Model;
use labspec_expr::dimension::Measure;

/// Reports contradictions between units.
pub(super) fn check_units(lab: &Lab, model: &Model, programs: &Programs, findings: &mut Vec<Finding>) {
    let found = dimensions(lab, model, programs);
    for ((labels, probe), measured) in labels(lab).zip(&programs.probes).zip(&found.probes) {
        let (Some(bound), Some(measured)) = (&probe.bound, measured) else { continue };
        findings.extend(mixed_dimensions::clashes(bound, measured, Severity::Warning));
        label_unit::degrees_passed(bound, measured, findings);
        let Measure::Dimension(dimension) = measured.value else { continue };
        findings.extend(label_unit::wrong_label(&labels, model, bound, &dimension));
    }
    findings.extend(lab.plots.iter().flat_map(|plot| label_unit::contradicting_units(plot, model)));
    let names = ModelNames::new(model, Scope::Lab);
    let controls = lab.controls.iter().zip(&programs.controls).zip(&found.controls);
    for ((control, (_, program)), measured) in controls {
        let (Some(bound), Some(measured)) = (bound_of(program), measured) else { continue };
        findings.extend(mixed_dimensions::clashes(bound, measured, Severity::Note));
        label_unit::degrees_passed(bound, measured, findings);
        findings.extend(
            label_unit::angle_in_quaternion(control, &names, bound, measured)
                .or_else(|| label_unit::wrong_control(control, &names, bound, measured))
                .or_else(|| label_unit::unconverted_parameter((lab, programs), &names, bound, measured)),
        );
    }
    for (bound, measured) in [&programs.setup, &programs.controller].into_iter().zip(&found.others) {
        if let (Some(bound), Some(measured)) = (bound, measured) {
            findings.extend(mixed_dimensions::clashes(bound, measured, Severity::Note));
            label_unit::degrees_passed(bound, measured, findings);
            findings.extend(label_unit::unconverted_parameter((lab, programs), &names, bound, measured));
        }
    }
}

/// The labels of every trace, including that of its plot, then those of the readouts.
pub fn labels(lab: &Lab) -> impl Iterator<Item = Vec<&Text>> {
    let traces = lab.plots.iter().flat_map(|plot| {
        plot.traces
            .iter()
            .map(|trace| [Some(&trace.label), plot.ylabel.as_ref()].into_iter().flatten().collect())
    });
    traces.chain(lab.readouts.iter().map(|r| vec![&r.label]))
}

fn bound_of(program: &ControlProgram) -> Option<&Bound> {
    match program {
        ControlProgram::Change(_, action) => action.run.as_ref(),
        ControlProgram::Press(run) => run.as_ref(),
    }
}
