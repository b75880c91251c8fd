//! The operands of an operation, as a watched run notes them before it runs.

use crate::operators::BinaryOp;

/// What is known of an operation before it runs: its result may take the place of an operand.
#[derive(Clone, Copy)]
pub(super) struct Operands {
    /// An operand is not a number.
    pub(super) nan: bool,
    /// The sides of a comparison of numbers, or of another operation on two.
    pub(super) sides: Option<(BinaryOp, f64, f64)>,
}

impl Operands {
    pub(super) const NONE: Operands = Operands { nan: false, sides: None };
}
