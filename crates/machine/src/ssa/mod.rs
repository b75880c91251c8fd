//! Static single assignment form: operations on values that each have one name and one definition, and
//! basic blocks of operations.

mod op;
mod program;

pub use op::{Args, Num, Op, OperandUse, Val};
pub use program::{
    BasicBlock, BlockEdge, BlockId, Operand, Representation, SsaFunction, SsaProgram, Terminator,
};
