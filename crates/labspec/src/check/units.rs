//! Units against dimensions: what labels say of numbers, controls of what they set, and sums of what cannot be added.

use crate::bind::{Bound, ControlProgram, ModelNames, Programs, Scope};
use crate::bind::{contradicts, dimensions, given_by, of_label, unit};
use crate::finding::{Finding, Severity};
use crate::rules;
use crate::source::Text;
use crate::spec::{Control, ControlKind, Lab, Plot};
use labspec_bind::units::written;
use labspec_core::Model;
use labspec_core::reflect::FieldId;
use labspec_expr::dimension::{Dimension, Measure};
use labspec_expr::{Schema, TextDimensions};

/// What units contradict.
pub(super) fn check_units(lab: &Lab, model: &Model, programs: &Programs, findings: &mut Vec<Finding>) {
    let found = dimensions(lab, model, programs);
    for ((labels, probe), measured) in labels(lab).zip(&programs.probes).zip(&found.probes) {
        let (Some(bound), Some(measured)) = (&probe.bound, measured) else { continue };
        findings.extend(clashes(bound, measured, Severity::Warning));
        let Measure::Known(dimension) = measured.value else { continue };
        findings.extend(wrong_label(&labels, model, bound, &dimension));
    }
    findings.extend(lab.plots.iter().flat_map(|plot| at_odds(plot, model)));
    let names = ModelNames::new(model, Scope::Lab);
    let controls = lab.controls.iter().zip(&programs.controls).zip(&found.controls);
    for ((control, (_, program)), measured) in controls {
        let (Some(bound), Some(measured)) = (bound_of(program), measured) else { continue };
        findings.extend(clashes(bound, measured, Severity::Note));
        findings.extend(wrong_control(control, &names, bound, measured));
    }
    for (bound, measured) in [&programs.setup, &programs.controller].into_iter().zip(&found.others) {
        if let (Some(bound), Some(measured)) = (bound, measured) {
            findings.extend(clashes(bound, measured, Severity::Note));
        }
    }
}

/// The labels of every trace, with that of its plot, then those of the readouts.
pub fn labels(lab: &Lab) -> impl Iterator<Item = Vec<&Text>> {
    let traces = lab.plots.iter().flat_map(|plot| {
        plot.traces
            .iter()
            .map(|trace| [Some(&trace.label), plot.ylabel.as_ref()].into_iter().flatten().collect())
    });
    traces.chain(lab.readouts.iter().map(|r| vec![&r.label]))
}

/// The label of a plot with a unit that is not the one of a trace, though both measure the same: degrees beside radians.
fn at_odds(plot: &Plot, model: &Model) -> Option<Finding> {
    let axis = plot.ylabel.as_ref()?;
    let (text, of_axis) = of_label(axis.as_str())?;
    if super::named::names(model).any(|name| name == text) {
        return None;
    }
    plot.traces.iter().find_map(|trace| {
        let (label_unit, of_trace) = of_label(trace.label.as_str())?;
        let ratio = of_trace.factor.abs() / of_axis.factor.abs();
        let other = of_trace.agrees(&of_axis) && (ratio - 1.0).abs() > 1e-3;
        other.then(|| {
            Finding::new(
                rules::LABEL_UNIT,
                axis.span(),
                format!("the plot is in {text}, but one of its traces is in {label_unit}"),
            )
            .why("a student reads the curve on an axis with another unit")
            .related(trace.label.span(), "the trace")
            .help("use the same unit for both")
        })
    })
}

fn bound_of(program: &ControlProgram) -> Option<&Bound> {
    match program {
        ControlProgram::Change(_, action) => action.run.as_ref(),
        ControlProgram::Press(run) => run.as_ref(),
    }
}

/// The first of the labels that has a unit, if it is another one than that of the numbers.
fn wrong_label(labels: &[&Text], model: &Model, bound: &Bound, found: &Dimension) -> Option<Finding> {
    let (label, (text, wanted)) = labels.iter().find_map(|l| Some((l, of_label(l.as_str())?)))?;
    // Something of the model may have the name of a unit.
    if super::named::names(model).any(|name| name == text) {
        return None;
    }
    // The smallest of something is no time.
    if text == "min" && !found.agrees(&wanted) {
        return None;
    }
    // A turn is not a radian.
    let turns = text.contains("Hz") && found.is_exact() && found.has_angle() && found.agrees(&wanted);
    if !contradicts(found, &wanted) && !turns {
        return None;
    }
    let gives = written(found);
    let message = format!("the label says {text}, but the expression gives {gives}");
    let found = Finding::new(rules::LABEL_UNIT, label.span(), message)
        .why(why(found, &wanted))
        .related(bound.text.span(), format!("this is in {gives}"));
    Some(found.help(match factor_words(&wanted) {
        Some(words) => format!("convert the number ({words}), or write its unit into the label"),
        None => "write the unit of the number into the label, or display what the label says".to_string(),
    }))
}

/// What a student reads.
fn why(found: &Dimension, wanted: &Dimension) -> String {
    if !found.agrees(wanted) {
        return "the two are different quantities".to_string();
    }
    let ratio = found.factor.abs() / wanted.factor.abs();
    let near = |x: f64| (x - x.round()).abs() < 1e-6 * x;
    match (ratio, 1.0 / ratio) {
        (r, _) if r >= 1.0 && near(r) => {
            format!("a student reads a number that is {} times too large", r.round())
        }
        (_, r) if r >= 1.0 && near(r) => {
            format!("a student reads a number that is {} times too small", r.round())
        }
        _ => "a student takes the number for something else".to_string(),
    }
}

/// How SI becomes a unit.
fn factor_words(wanted: &Dimension) -> Option<String> {
    let factor = wanted.factor.abs();
    if (factor - 1f64.to_degrees()).abs() < 1e-6 {
        return Some("`lib.deg(…)` converts radians to degrees".to_string());
    }
    let power = factor.log10();
    let plain = (power - power.round()).abs() < 1e-9 && power.round() > 0.0;
    plain.then(|| format!("`{} * (…)`", factor.round()))
}

/// A control whose unit is not that of what it sets.
fn wrong_control(
    control: &Control,
    names: &dyn Schema,
    bound: &Bound,
    measured: &TextDimensions,
) -> Option<Finding> {
    let Measure::Known(_) = given_by(control) else { return None };
    let (stored, found, wanted) = measured.stores.iter().find_map(|stored| {
        let (Measure::Known(found), Measure::Known(wanted)) =
            (stored.measure, names.measure(stored.access.field, stored.access.first, stored.access.count))
        else {
            return None;
        };
        contradicts(&found, &wanted).then_some((stored, found, wanted))
    })?;
    let field = FieldId::new(stored.access.field.0 as usize)?.info().name;
    let label = match &control.kind {
        ControlKind::Slider { unit: Some(text), .. } if unit(text.as_str()).is_some() => text,
        _ => &control.label,
    };
    let message =
        format!("the control stores a value in {}, but {field} is in {}", written(&found), written(&wanted));
    let at = bound.text.span_of(stored.span.into());
    let finding = Finding::new(rules::LABEL_UNIT, label.span(), message).related(at, "it stores this");
    Some(
        finding
            .why(why(&found, &wanted))
            .help("convert `value` where it is stored, or write the unit of the field"),
    )
}

/// Sums and comparisons of what cannot be added or compared.
fn clashes(bound: &Bound, measured: &TextDimensions, severity: Severity) -> Vec<Finding> {
    let one = |clash: &labspec_expr::DimensionClash| {
        let message = format!("{} and {} are added or compared", written(&clash.left), written(&clash.right));
        let mut found = Finding::new(rules::MIXED_DIMENSIONS, bound.text.span_of(clash.span.into()), message)
            .help("check the index and the field: one of the two may be a different quantity than intended");
        found.severity = severity;
        found
    };
    measured.clashes.iter().map(one).collect()
}
