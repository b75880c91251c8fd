//! What a student may choose of a control.

use crate::bind::scalar;
use crate::spec::{Control, ControlKind};
use labspec_expr::Value;

/// Most options of a select that are tried.
const MOST_OPTIONS: usize = 8;

/// What a student may choose: the ends of a slider, the options of a select.
pub(crate) fn choices(control: &Control) -> Vec<Value> {
    match &control.kind {
        ControlKind::Slider { min, max, .. } => [max, min].map(|end| Value::Number(end.value)).to_vec(),
        ControlKind::Select { options, .. } => {
            options.iter().take(MOST_OPTIONS).map(|o| scalar(&o.value)).collect()
        }
        ControlKind::Button { .. } => Vec::new(),
    }
}
