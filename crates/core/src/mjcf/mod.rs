//! MJCF.
mod diagnostic;
mod schema;
pub use diagnostic::{MjcfDiagnostic, MjcfFileError, code};
pub use schema::{schema_rows, SchemaRow};
pub const MAX_TEXT: usize = 16 << 20;
