//! The controls of a lab, as a page draws them.

use crate::bind::scalar;
use crate::spec::{self, Lab};
use labspec_expr::Value;

/// A slider, a select or a button.
#[derive(Clone, Debug, PartialEq)]
pub struct Control {
    /// Its label.
    pub label: String,
    /// Its kind, with its range or options.
    pub kind: ControlKind,
    /// Its value when the lab is loaded; `undefined` for a button.
    pub start: Value,
}

/// The three kinds of controls.
#[derive(Clone, Debug, PartialEq)]
pub enum ControlKind {
    /// A number from `min` to `max`, in steps.
    Slider {
        /// Lower end.
        min: f64,
        /// Upper end.
        max: f64,
        /// Step.
        step: f64,
        /// Unit, possibly empty.
        unit: String,
        /// Number of decimals to print.
        digits: u32,
    },
    /// One of several values.
    Select {
        /// Displayed text and value of each.
        options: Vec<(String, Value)>,
    },
    /// A button, which runs statements when it is pressed.
    Button,
}

/// Denotes a control by its label or its index.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ControlKey<'a> {
    /// The first with this label.
    Label(&'a str),
    /// The one with this index, from 0.
    Index(usize),
}

impl<'a> From<&'a str> for ControlKey<'a> {
    fn from(label: &'a str) -> ControlKey<'a> {
        ControlKey::Label(label)
    }
}

impl From<usize> for ControlKey<'_> {
    fn from(index: usize) -> Self {
        ControlKey::Index(index)
    }
}

/// All controls of a lab, in order.
pub(super) fn list(lab: &Lab) -> Vec<Control> {
    lab.controls.iter().map(one).collect()
}

fn one(control: &spec::Control) -> Control {
    let (kind, start) = match &control.kind {
        spec::ControlKind::Slider { unit, min, max, value, .. } => {
            let slider = ControlKind::Slider {
                min: min.value,
                max: max.value,
                step: control.step().unwrap_or(0.0),
                unit: unit.as_ref().map_or(String::new(), |t| t.value.clone()),
                digits: control.digits().unwrap_or(0),
            };
            (slider, Value::Number(value.value))
        }
        spec::ControlKind::Select { options, value, .. } => {
            let offered = |o: &spec::Choice| (o.text.value.clone(), scalar(&o.value));
            (ControlKind::Select { options: options.iter().map(offered).collect() }, scalar(value))
        }
        spec::ControlKind::Button { .. } => (ControlKind::Button, Value::Undefined),
    };
    Control { label: control.label.value.clone(), kind, start }
}
