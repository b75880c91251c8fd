use super::label_names_another::names;
use crate::bind::{
    Bound, ControlProgram, Programs, contradicts, given_by, in_degrees, of_label, unit_beside,
};
use crate::check::observations::{ObservedLab, column};
use crate::json::read::shorten;
use crate::run::Cell;
use crate::source::Text;
use crate::spec::{Control, ControlKind, Lab, Plot, Readout};
use labspec_bind::units::written;
use labspec_core::Model;
use labspec_core::reflect::FieldId;
use labspec_expr::dimension::{Dimension, Measure};
use labspec_expr::rules::DEGREES;
use labspec_expr::{DimensionStore, Role, Schema, TextDimensions};
use labspec_finding::{Example, Finding, Layer, Rule, Severity};

/// The unit in a label does not match its expression.
pub const LABEL_UNIT: &Rule = &Rule {
    code: "label-unit",
    severity: Severity::Warning,
    exceptions: &[],
    layer: Layer::Program,
    summary: "the unit in a label does not match its expression",
    why: "a student takes the number for what the label says: a speed in m/s under `mm/s` looks a thousand times too small. The dimension follows from the fields that the expression reads, through products, roots and `Math`; the rule compares only dimensions that are certain. A literal factor may carry any unit: `9.81 * data.time` may be a speed",
    bad: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><body name='left'><joint name='left' type='slide'/><geom size='.05'/></body><body name='right' pos='1 0 0'><joint name='right' type='slide'/><geom size='.05'/></body></worldbody></mujoco>", "setup": "data.qvel[0] = 0.1", "readouts": [{"label": "⟦speed (mm/s)⟧", "expr": "Math.abs(data.qvel[0])"}]}"#,
    ),
    good: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><body name='left'><joint name='left' type='slide'/><geom size='.05'/></body><body name='right' pos='1 0 0'><joint name='right' type='slide'/><geom size='.05'/></body></worldbody></mujoco>", "setup": "data.qvel[0] = 0.1", "readouts": [{"label": "speed (mm/s)", "expr": "1000 * Math.abs(data.qvel[0])"}]}"#,
    ),
};

/// Reports a readout whose label has a unit, but whose value is a string in every run.
pub(crate) fn check_text_readout(observed: &ObservedLab<'_>, readout: &Readout, c: usize) -> Option<Finding> {
    let mut cells = column(observed.records, c);
    let (unit, _) = of_label(readout.label.as_str())?;
    let Cell::Text(first) = cells.next()? else { return None };
    let words = first.chars().filter(|c| c.is_alphabetic()).count() > 1;
    (words && cells.all(|c| matches!(c, Cell::Text(_)))).then(|| {
        let message = format!("the label says {unit}, but the value is a string");
        Finding::warning(LABEL_UNIT, readout.label.span(), message)
            .why(format!(
                "it is a string at every sample of {}: \"{}\" at first",
                observed.runs(),
                shorten(first)
            ))
            .related(readout.expr.span(), "this is a string")
            .help("display the number that the label names; two labels may be exchanged")
    })
}

/// Reports a label of a plot whose unit differs from that of a trace of the same quantity: degrees beside radians.
pub(crate) fn contradicting_units(plot: &Plot, model: &Model) -> Option<Finding> {
    let axis = plot.ylabel.as_ref()?;
    let (text, of_axis) = of_label(axis.as_str())?;
    if names(model).any(|name| name == text) {
        return None;
    }
    plot.traces.iter().find_map(|trace| {
        let (label_unit, of_trace) = of_label(trace.label.as_str())?;
        let ratio = of_trace.factor.abs() / of_axis.factor.abs();
        let other = of_trace.agrees(&of_axis) && (ratio - 1.0).abs() > 1e-3;
        other.then(|| {
            Finding::new(
                LABEL_UNIT,
                axis.span(),
                format!("the plot is in {text}, but one of its traces is in {label_unit}"),
            )
            .why("a student reads the curve on an axis with another unit")
            .related(trace.label.span(), "the trace")
            .help("use the same unit for both")
        })
    })
}

/// Reports the first label whose unit differs from that of the numbers.
pub(crate) fn wrong_label(
    labels: &[&Text],
    model: &Model,
    bound: &Bound,
    measured: &Dimension,
) -> Option<Finding> {
    let (label, (text, expected)) = labels.iter().find_map(|l| Some((l, of_label(l.as_str())?)))?;
    // An object of the model may have the name of a unit.
    if names(model).any(|name| name == text) {
        return None;
    }
    // `min` may mean a minimum instead of minutes.
    if text == "min" && !measured.agrees(&expected) {
        return None;
    }
    // A revolution is not a radian.
    let turns =
        text.contains("Hz") && measured.is_exact() && measured.has_angle() && measured.agrees(&expected);
    if !contradicts(measured, &expected) && !turns {
        return None;
    }
    let gives = written(measured);
    let message = format!("the label says {text}, but the expression gives {gives}");
    let found = Finding::new(LABEL_UNIT, label.span(), message)
        .why(why(measured, &expected))
        .related(bound.text.span(), format!("this is in {gives}"));
    let scaled = measured.agrees(&expected) && measured.is_exact();
    let converted = if scaled { convert(&expected, bound.text.as_str()) } else { None };
    Some(found.help(match converted {
        Some(converted) => {
            format!(
                "write `{converted}`, which converts the number, or write its unit, {gives}, into the label"
            )
        }
        None => "write the unit of the number into the label, or display what the label says".to_string(),
    }))
}

/// The effect of the wrong unit on a student.
fn why(found: &Dimension, expected: &Dimension) -> String {
    if !found.agrees(expected) {
        return "the two are different quantities".to_string();
    }
    let ratio = found.factor.abs() / expected.factor.abs();
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

/// Longer expressions are abbreviated in advice.
const MAX_CONVERTED: usize = 80;

/// The expression, converted from SI to a unit.
fn convert(expected: &Dimension, expression: &str) -> Option<String> {
    let (inside, product) = match expression.chars().count() <= MAX_CONVERTED {
        true => (expression, expression.contains(|c: char| "+-?:=<>&|,%".contains(c))),
        false => ("…", true),
    };
    let factor = expected.factor.abs();
    if (factor - 1f64.to_degrees()).abs() < 1e-6 {
        return Some(format!("lib.deg({inside})"));
    }
    let power = factor.log10();
    let plain = (power - power.round()).abs() < 1e-9 && power.round() > 0.0;
    let factor = factor.round();
    plain.then(|| if product { format!("{factor} * ({inside})") } else { format!("{factor} * {inside}") })
}

/// Reports a control whose unit differs from that of the value that it sets.
pub(crate) fn wrong_control(
    control: &Control,
    names: &dyn Schema,
    bound: &Bound,
    measured: &TextDimensions,
) -> Option<Finding> {
    let Measure::Dimension(_) = given_by(control) else { return None };
    let (stored, found, expected) =
        stores(names, measured).find(|(_, found, expected)| contradicts(found, expected))?;
    let field = FieldId::new(stored.access.field.0 as usize)?.info().name;
    let message = format!(
        "the control stores a value in {}, but {field} is in {}",
        written(&found),
        written(&expected)
    );
    let span = bound.text.span_of(stored.span.into());
    let finding =
        Finding::new(LABEL_UNIT, unit_text(control).span(), message).related(span, "it stores this");
    Some(
        finding
            .why(why(&found, &expected))
            .help("convert `value` where it is stored, or write the unit of the field"),
    )
}

/// The numbers that a program stores in fields, with the dimension of each and that of the field, where both are certain.
fn stores<'t>(
    names: &'t dyn Schema,
    measured: &'t TextDimensions,
) -> impl Iterator<Item = (&'t DimensionStore, Dimension, Dimension)> {
    measured.stores.iter().filter_map(move |stored| {
        let access = stored.access;
        match (stored.measure, names.measure(access.field, access.first, access.count)) {
            (Measure::Dimension(found), Measure::Dimension(expected)) => Some((stored, found, expected)),
            _ => None,
        }
    })
}

/// The text that gives the unit of a control: its `unit`, or else its label.
fn unit_text(control: &Control) -> &Text {
    match &control.kind {
        ControlKind::Slider { unit: Some(text), .. }
            if unit_beside(text.as_str(), control.label.as_str()).is_some() =>
        {
            text
        }
        _ => &control.label,
    }
}

/// Reports a control whose value is an angle and is stored as a component of a quaternion.
pub(crate) fn angle_in_quaternion(
    control: &Control,
    names: &dyn Schema,
    bound: &Bound,
    measured: &TextDimensions,
) -> Option<Finding> {
    let Measure::Dimension(_) = given_by(control) else { return None };
    measured.stores.iter().find_map(|stored| {
        let Measure::Dimension(found) = stored.measure else { return None };
        let is_angle = found.has_angle() && found.agrees(&Dimension::RADIAN);
        if !is_angle || stored.access.count != Some(1) || !(found.is_exact() || in_degrees(&found)) {
            return None;
        }
        let Role::NoAngle(advice) = names.role(stored.access.field, stored.access.first) else { return None };
        let field = FieldId::new(stored.access.field.0 as usize)?.info().name;
        let message = format!("the control stores an angle in {field}[{}], which is {}", stored.access.first, advice.what);
        Some(
            Finding::new(advice.rule, unit_text(control).span(), message)
                .why(advice.why)
                .related(bound.text.span_of(stored.span.into()), "it stores this")
                .help("store the cosine of half the angle in the first of the four numbers, and its sine times the axis in the others"),
        )
    })
}

/// Reports a control whose value another program reads from `ctx` and stores unconverted in a field with another unit.
pub(crate) fn unconverted_parameter(
    (lab, programs): (&Lab, &Programs),
    names: &dyn Schema,
    bound: &Bound,
    measured: &TextDimensions,
) -> Option<Finding> {
    let reads = &bound.program.effects().ctx_reads;
    stores(names, measured).find_map(|(stored, found, expected)| {
        let same_quantity = found.agrees(&expected) && found.has_angle() == expected.has_angle();
        let ratio = found.factor.abs() / expected.factor.abs();
        if !same_quantity || !ratio.is_finite() || (ratio - 1.0).abs() < 1e-3 {
            return None;
        }
        // Without a conversion, the number has the factor of the control's unit.
        let (control, slot) = parameters(lab, programs).find(|(control, slot)| {
            let Measure::Dimension(given) = given_by(control) else { return false };
            reads.contains(slot) && (found.factor.abs() / given.factor.abs() - 1.0).abs() < 1e-9
        })?;
        let field = FieldId::new(stored.access.field.0 as usize)?.info().name;
        let name = format!("ctx.{}", programs.globals.name(slot));
        let [given, needed] = [written(&found), written(&expected)];
        let message =
            format!("`{name}` is in {given}, but it is stored unconverted in {field}, which is in {needed}");
        let help = match in_degrees(&found) {
            true => {
                format!("write `lib.rad({name})` where it is stored, or give the control the unit {needed}")
            }
            false => format!("convert `{name}` where it is stored, or give the control the unit {needed}"),
        };
        Some(
            Finding::new(LABEL_UNIT, unit_text(control).span(), message)
                .why(format!("the lab reads a number in {given} as if it were in {needed}"))
                .related(bound.text.span_of(stored.span.into()), "it is stored here")
                .help(help),
        )
    })
}

/// The controls that store their value in a variable, with its slot.
fn parameters<'l>(lab: &'l Lab, programs: &'l Programs) -> impl Iterator<Item = (&'l Control, u32)> {
    lab.controls.iter().zip(&programs.controls).filter_map(|(control, (_, program))| match program {
        ControlProgram::Change(_, action) => Some((control, action.param?)),
        ControlProgram::Press(_) => None,
    })
}

/// The dimension without a small whole factor or divisor: half of an angle in degrees is in degrees, too.
fn multiplied(found: &Dimension) -> Dimension {
    let ratio = found.factor.abs() / 1f64.to_degrees();
    let is_small =
        [2.0, 3.0, 4.0, 1.0 / 2.0, 1.0 / 3.0, 1.0 / 4.0].into_iter().any(|k| (ratio / k - 1.0).abs() < 1e-6);
    let mut whole = *found;
    if is_small {
        whole.factor = 1f64.to_degrees();
    }
    whole
}

/// Reports functions that take radians, but receive an angle in degrees.
pub(crate) fn degrees_passed(bound: &Bound, measured: &TextDimensions, findings: &mut Vec<Finding>) {
    let mut reported = Vec::new();
    for argument in &measured.angles {
        let Measure::Dimension(found) = argument.measure else { continue };
        if !in_degrees(&multiplied(&found))
            || reported.contains(&argument.span)
            || reported.len() >= super::MAX_IN_TEXT
        {
            continue;
        }
        reported.push(argument.span);
        let message = format!("`{}` takes radians, but its argument is in degrees", argument.function);
        findings.push(
            Finding::new(DEGREES, bound.text.span_of(argument.span.into()), message)
                .why("a full turn is 2π, about 6.28 radians")
                .help("convert the argument: `lib.rad(x)`, or `x * Math.PI / 180`"),
        );
    }
}
