//! Tests of the compiler as a whole.

mod assets;
mod doubtful;
mod golden;
mod hostile;
mod measured;
mod mistakes;
mod supported;

/// A model with this content in its world.
pub(crate) fn world(inside: &str) -> String {
    format!("<mujoco><worldbody>{inside}</worldbody></mujoco>")
}
