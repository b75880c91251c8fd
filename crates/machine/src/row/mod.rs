//! A formula for the state at hand: what it reads is fetched by one call of the host, then operations work on one
//! number at hand, each with a register or a constant as its other operand. The number so stays in a register of the
//! processor from operation to operation; only what is needed again later goes to memory.

mod build;
mod operation;
mod run;

pub use build::WantedResult;
pub use operation::RowOp;
pub use run::{REGISTERS, Row};
