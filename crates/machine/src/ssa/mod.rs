//! Operations on values that have one name and one definition each (static single assignment), and the blocks that hold them.

mod op;
mod program;

pub use op::{Args, Num, Op, OperandUse, Val};
pub use program::{
    BasicBlock, BlockEdge, BlockId, Operand, Representation, SsaFunction, SsaProgram, Terminator,
};
