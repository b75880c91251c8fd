//! The methods of lists, strings and numbers, and the functions of `Array`, `Number`, `String` and `Object`. Each is one row:
//! its name, receiver, arguments and result, its meaning, an example, and its implementation. The binder, the virtual machine,
//! the suggestions for misspelt names, and the reference page use the row.

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
