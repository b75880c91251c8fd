//! The methods of lists, texts and numbers, and the functions of `Array`, `Number`, `String` and `Object`. Each is one row:
//! what it is called, takes, gives and means, an example, and how it is computed. The binder, the machine, what was probably
//! meant by a misspelt name, and the reference page all read the row.

mod catalog;
mod each;
mod env;
mod list;
mod native;
mod number;
mod object;
mod text;

pub use catalog::{all, call, call_free, find_function, find_method, find_row, public_rows};
pub use env::{Env, NativeError, charge, out_of_steps, too_long};
pub use native::{Implementation, NanBehaviour, Native, NativeResult, ReceiverKind};
pub use number::NUMBER_CONSTANTS;
pub use number::to_fixed;
pub(crate) use text::whole;
