//! The values of a control that a student can choose.

use crate::bind::scalar;
use crate::spec::{Control, ControlKind};
use labspec_expr::Value;

/// Maximum number of tried options of a select.
const MOST_OPTIONS: usize = 8;

/// The values that are tried: the ends of a slider, the options of a select.
pub(crate) fn choices(control: &Control) -> Vec<Value> {
    match &control.kind {
        ControlKind::Slider { min, max, .. } => [max, min].map(|end| Value::Number(end.value)).to_vec(),
        ControlKind::Select { options, .. } => {
            options.iter().take(MOST_OPTIONS).map(|o| scalar(&o.value)).collect()
        }
        ControlKind::Button { .. } => Vec::new(),
    }
}
