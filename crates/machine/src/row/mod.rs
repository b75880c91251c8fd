//! A row evaluates a formula for the current state. One call of the host reads all field elements. Then each operation combines
//! an accumulator with a register or a constant. The accumulator stays in a processor register from operation to operation;
//! only values that are used again later go to memory.

mod build;
mod operation;
mod run;

pub use build::RequestedResult;
pub use operation::RowOp;
pub use run::{REGISTERS, Row};
