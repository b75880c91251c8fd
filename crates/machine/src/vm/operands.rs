//! Properties of the operands of an operation, recorded by a watched run before the operation runs.

use crate::operators::BinaryOp;

/// Recorded before the operation, because its result may overwrite an operand.
#[derive(Clone, Copy)]
pub(super) struct Operands {
    /// Whether an operand is NaN.
    pub(super) nan: bool,
    /// The operands of a comparison of numbers or of another binary operation.
    pub(super) sides: Option<(BinaryOp, f64, f64)>,
}

impl Operands {
    pub(super) const NONE: Operands = Operands { nan: false, sides: None };
}
