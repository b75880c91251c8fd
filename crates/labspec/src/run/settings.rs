//! The interactions that a student can make with a lab: the values of a control, and the times at which a button can be
//! pressed. A run with any other setting is an error that names the possible ones, because no student can see it.

use super::{RunError, Session};
use crate::bind::{ControlProgram, Programs, scalar};
use crate::printable::printable;
use crate::spec::{Choice, Control, ControlKind, Lab, SweepAxis, SweepValue};
use labspec_expr::Value;
use labspec_finding::order;

/// Tolerance of a value on the grid of a slider, in steps, for the rounding error of `min + k * step`.
const ON_GRID: f64 = 1e-9;
/// Maximum number of options in a message.
const MOST_LISTED: usize = 12;

/// Sets controls by label, in this order.
///
/// # Errors
/// There is no such control, it is a button, or a student cannot choose this value.
pub fn set_controls(
    session: &mut Session<'_>,
    lab: &Lab,
    programs: &Programs,
    set: &[(String, Value)],
) -> Result<(), RunError> {
    for (label, given) in set {
        let (i, value) = chosen(lab, programs, label, given)?;
        session.set_control(i, value);
    }
    Ok(())
}

/// The control of a label, and its value when a run sets `given`.
///
/// # Errors
/// There is no such control, it is a button, or a student cannot choose this value.
pub fn chosen(
    lab: &Lab,
    programs: &Programs,
    label: &str,
    given: &Value,
) -> Result<(usize, Value), RunError> {
    match (programs.control(label), lab.control(label)) {
        (Some((i, ControlProgram::Change(..))), Some(control)) => Ok((i, value(control, given)?)),
        (Some(_), Some(_)) => {
            Err(RunError::new(format!("\"{label}\" is a button: press it instead of setting it")))
        }
        _ => Err(unknown_control(label, programs)),
    }
}

/// The value of a control when a run sets `given`. For a select, the text of an option denotes its value.
///
/// # Errors
/// A student cannot choose it: it is not an option, not a number, out of the range of the slider, or between two of its
/// steps.
pub fn value(control: &Control, given: &Value) -> Result<Value, RunError> {
    let label = &control.label.value;
    match &control.kind {
        ControlKind::Button { .. } => {
            Err(RunError::new(format!("\"{label}\" is a button: press it instead of setting it")))
        }
        ControlKind::Select { options, .. } => option(label, options, given),
        ControlKind::Slider { min, max, value, .. } => match given {
            Value::Number(x) => {
                let grid = Grid { min: min.value, max: max.value, step: control.step().unwrap_or(0.0) };
                grid.holds(label, *x, value.value).map(|()| given.clone())
            }
            other => Err(RunError::new(format!(
                "\"{label}\" is a slider: it needs a number from {} to {}, not {}",
                number(min.value),
                number(max.value),
                describe_value(other)
            ))
            .help(format!("write a number, without quotes: {}", number_in(other).unwrap_or(min.value)))),
        },
    }
}

/// The value of a swept quantity in a run. A number that was drawn at random is rounded to the steps of a slider.
pub fn swept_value(control: Option<&Control>, axis: &SweepAxis, value: &SweepValue) -> Value {
    match (value, control.map(|control| (&control.kind, control.step()))) {
        (SweepValue::Number(x), Some((ControlKind::Slider { min, max, .. }, Some(step))))
            if axis.drawn && step > 0.0 =>
        {
            let nearest = min.value + ((x - min.value) / step).round() * step;
            Value::Number(if (min.value..=max.value).contains(x) { nearest.min(max.value) } else { *x })
        }
        (SweepValue::Number(x), _) => Value::Number(*x),
        (SweepValue::Text(text), _) => Value::from(text.as_str()),
    }
}

/// The value that a text on the command line denotes for this control: `4` is a number, unless only the text of an option
/// matches.
pub fn written(lab: &Lab, label: &str, text: &str) -> Value {
    let plain = match text {
        "true" => Value::Boolean(true),
        "false" => Value::Boolean(false),
        other => other.parse::<f64>().map_or_else(|_| Value::from(other), Value::Number),
    };
    match lab.control(label).map(|c| &c.kind) {
        Some(ControlKind::Select { options, .. }) if !options.iter().any(|o| same(&given_by(o), &plain)) => {
            Value::from(text)
        }
        _ => plain,
    }
}

/// The buttons with their times, in order of time.
///
/// # Errors
/// There is no such control, it is not a button, or a run cannot reach the time.
pub fn presses(programs: &Programs, press: &[(String, f64)]) -> Result<Vec<(usize, f64)>, RunError> {
    let mut list = Vec::new();
    for (label, time) in press {
        match programs.control(label) {
            Some((i, ControlProgram::Press(_))) => list.push((i, *time)),
            Some(_) => {
                return Err(RunError::new(format!(
                    "\"{label}\" is not a button: set it instead of pressing it"
                )));
            }
            None => return Err(unknown_control(label, programs)),
        }
        if !(time.is_finite() && *time >= 0.0) {
            return Err(RunError::new(format!(
                "\"{label}\" cannot be pressed at {time} s, because a run begins at 0 s; use a later time"
            )));
        }
    }
    order::sort_by(&mut list, |a, b| a.1.total_cmp(&b.1));
    Ok(list)
}

/// Checks that every press comes before the last step of a run; a later press would never happen.
///
/// # Errors
/// The first press that comes too late.
pub fn presses_within(
    programs: &Programs,
    presses: &[(usize, f64)],
    steps: usize,
    timestep: f64,
) -> Result<(), RunError> {
    let [last, end] = [steps.saturating_sub(1), steps].map(|n| n as f64 * timestep);
    // Time is a sum of steps, which may be a few bits less than the product.
    let late = presses.iter().find(|(_, time)| *time > last + ON_GRID * timestep);
    let Some((button, time)) = late else { return Ok(()) };
    let label = programs.controls.get(*button).map_or("", |(label, _)| label);
    Err(RunError::new(format!(
        "\"{label}\" would be pressed at {} s, but the run ends at {} s and its last step begins at {} s",
        number(*time),
        number(end),
        number(last)
    ))
    .help(format!("press it at {} s or earlier, or make the run longer", number(last))))
}

fn option(label: &str, options: &[Choice], given: &Value) -> Result<Value, RunError> {
    let values = options.iter().map(given_by);
    if let Some(value) = values.into_iter().find(|v| same(v, given)) {
        return Ok(value);
    }
    if let Value::String(text) = given
        && let Some(choice) = options.iter().find(|o| o.text.value.as_str() == &**text)
    {
        return Ok(given_by(choice));
    }
    let mut list: Vec<String> = options
        .iter()
        .take(MOST_LISTED)
        .map(|o| format!("{} (\"{}\")", describe_value(&given_by(o)), o.text.value))
        .collect();
    if options.len() > MOST_LISTED {
        list.push(format!("and {} more", options.len() - MOST_LISTED));
    }
    Err(RunError::new(format!(
        "{} is not an option of \"{label}\"; its options are {}",
        describe_value(given),
        list.join(", ")
    )))
}

/// The value of an option.
fn given_by(choice: &Choice) -> Value {
    scalar(&choice.value)
}

/// The values of a slider: `min`, then step after step, and `max`.
struct Grid {
    min: f64,
    max: f64,
    step: f64,
}

impl Grid {
    fn holds(&self, label: &str, x: f64, start: f64) -> Result<(), RunError> {
        let Grid { min, max, step } = *self;
        if x == start || x == max {
            return Ok(());
        }
        if !(min..=max).contains(&x) {
            return Err(RunError::new(format!(
                "\"{label}\" goes from {} to {}: {} cannot be chosen",
                number(min),
                number(max),
                number(x)
            ))
            .help(format!(
                "set it to {}, the nearest value, or change the range of the slider",
                number(if x < min { min } else { max })
            )));
        }
        // An invalid step has a separate finding.
        let steps = (x - min) / step;
        if !(step > 0.0 && steps.is_finite())
            || (steps - steps.round()).abs() <= ON_GRID.max(steps * f64::EPSILON)
        {
            return Ok(());
        }
        let [below, above] = [steps.floor(), steps.ceil()].map(|k| (min + k * step).min(max));
        Err(RunError::new(format!(
            "\"{label}\" cannot be set to {}: it moves in steps of {} from {}; the nearest values are {} and {}",
            number(x),
            number(step),
            number(min),
            number(below),
            number(above)
        ))
        .help(format!("set it to {} or {}, or change the `step` of the slider", number(below), number(above))))
    }
}

/// The number that a text contains.
fn number_in(value: &Value) -> Option<f64> {
    match value {
        Value::String(text) => text.trim().parse().ok(),
        _ => None,
    }
}

fn same(a: &Value, b: &Value) -> bool {
    match (a, b) {
        (Value::Number(a), Value::Number(b)) => a == b,
        (Value::String(a), Value::String(b)) => a == b,
        (Value::Boolean(a), Value::Boolean(b)) => a == b,
        _ => false,
    }
}

/// A value in the notation of an author.
fn describe_value(value: &Value) -> String {
    match value {
        Value::Number(x) => number(*x),
        Value::String(text) => format!("the text \"{}\"", text.chars().take(60).collect::<String>()),
        other => other.to_string(),
    }
}

/// A number without rounding errors in its last digits: 0.3, not 0.30000000000000004.
fn number(x: f64) -> String {
    let short = format!("{x:.11e}").parse().unwrap_or(x);
    Value::Number(short).to_string()
}

/// The error that no control has this label, with the existing ones.
pub fn unknown_control(label: &str, programs: &Programs) -> RunError {
    let labels: Vec<&str> = programs.controls.iter().map(|(l, _)| l.as_str()).collect();
    let available = match labels.as_slice() {
        [] => "this lab has no controls".to_string(),
        all => format!("the controls are: \"{}\"", printable(&all.join("\", \""))),
    };
    let hint = crate::json::nearest(label, labels)
        .map_or(String::new(), |l| format!("; did you mean \"{}\"?", printable(l)));
    RunError::new(format!("the lab has no control \"{}\"{hint} ({available})", printable(label)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lint::ModelFolder;
    use crate::lint::load_lesson;
    use crate::source::SourceFile;

    /// A lab with these controls, given as JSON.
    fn lab(controls: &str) -> Lab {
        let text = format!(r#"{{"model": "ball", "controls": [{controls}]}}"#);
        load_lesson(SourceFile::new("lab.json", text), &ModelFolder::unknown()).all_labs()[0].clone()
    }

    fn outcome(lab: &Lab, given: Value) -> String {
        value(&lab.controls[0], &given).map_or_else(|e| e.message, |v| format!("ok {v}"))
    }

    const INTEGRATOR: &str = r#"{"type": "select", "label": "integrator", "set": "model.opt.integrator",
        "options": [["Euler", 0], ["discrete", 4]], "value": 0}"#;

    #[test]
    fn the_text_of_an_option_means_its_value() {
        let select = lab(INTEGRATOR);
        assert_eq!(outcome(&select, "discrete".into()), "ok 4");
        assert_eq!(outcome(&select, Value::Number(4.0)), "ok 4");
        assert_eq!(
            outcome(&select, Value::Number(3.0)),
            "3 is not an option of \"integrator\"; its options are 0 (\"Euler\"), 4 (\"discrete\")"
        );
        assert!(outcome(&select, "Discrete".into()).starts_with("the text \"Discrete\" is not an option"));
        assert!(outcome(&select, Value::Boolean(true)).starts_with("true is not an option"));
    }

    #[test]
    fn a_value_takes_precedence_over_an_equal_text() {
        let select = lab(
            r#"{"type": "select", "label": "way", "param": "way", "options": [["up", "down"], ["down", "up"]], "value": "up"}"#,
        );
        assert_eq!(outcome(&select, "up".into()), "ok up");
    }

    #[test]
    fn the_command_line_accepts_the_values_of_a_control() {
        let select = lab(
            r#"{"type": "select", "label": "n", "param": "n", "options": [["1", 10], ["2", 20]], "value": 10}"#,
        );
        assert_eq!(value(&select.controls[0], &written(&select, "n", "2")).unwrap(), Value::Number(20.0));
        assert_eq!(written(&select, "n", "20"), Value::Number(20.0));
        assert_eq!(written(&select, "other", "2"), Value::Number(2.0));
    }

    #[test]
    fn a_slider_takes_only_values_of_its_grid() {
        let slider = lab(r#"{"label": "m", "param": "m", "min": 0.1, "max": 5, "step": 0.2, "value": 0.15}"#);
        // The end and the start can be chosen even if they are not on the grid.
        for x in [0.1, 0.3, 0.1 + 0.2 * 17.0, 4.9, 5.0, 0.15] {
            assert_eq!(outcome(&slider, Value::Number(x)), format!("ok {}", Value::Number(x)));
        }
        assert_eq!(
            outcome(&slider, Value::Number(0.35)),
            "\"m\" cannot be set to 0.35: it moves in steps of 0.2 from 0.1; the nearest values are 0.3 and 0.5"
        );
        assert!(outcome(&slider, Value::Number(4.95)).ends_with("the nearest values are 4.9 and 5"));
        let outside = "\"m\" goes from 0.1 to 5: 5.1 cannot be chosen";
        assert_eq!(outcome(&slider, Value::Number(5.1)), outside);
        for x in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 0.0, -1e300] {
            assert!(outcome(&slider, Value::Number(x)).contains("cannot be chosen"), "{x}");
        }
        for given in ["5".into(), Value::Boolean(true)] {
            assert!(outcome(&slider, given).contains("it needs a number from 0.1 to 5, not"));
        }
    }

    #[test]
    fn without_a_step_a_slider_moves_by_a_hundredth() {
        let slider = lab(r#"{"label": "m", "param": "m", "min": 0, "max": 1, "value": 0}"#);
        for k in 0..=100 {
            assert!(value(&slider.controls[0], &Value::Number(k as f64 / 100.0)).is_ok(), "{k}");
        }
        assert!(outcome(&slider, Value::Number(0.125)).contains("0.12 and 0.13"));
    }
}
