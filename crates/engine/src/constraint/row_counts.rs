//! Numbers of rows that a block of constraints can have, as constants: loops over them are unrolled.

/// Rows of the largest block.
pub(super) const MOST_ROWS: usize = 10;

/// Runs an expression with the constant `$rows` equal to the number of rows of a block: 1 for what is a number, 3 for a
/// point, 4 and 6 for pyramids and cones with friction, 6 for a frame, 10 for the pyramid with all friction.
macro_rules! by_rows {
    ($n:expr, $rows:ident => $run:expr) => {
        match $n {
            1 => {
                const $rows: usize = 1;
                $run
            }
            3 => {
                const $rows: usize = 3;
                $run
            }
            4 => {
                const $rows: usize = 4;
                $run
            }
            6 => {
                const $rows: usize = 6;
                $run
            }
            _ => {
                const $rows: usize = $crate::constraint::row_counts::MOST_ROWS;
                $run
            }
        }
    };
}
pub(super) use by_rows;

/// The same for an elliptic cone: a normal, and two, three or five directions of friction.
macro_rules! by_cone_rows {
    ($n:expr, $rows:ident => $run:expr) => {
        match $n {
            3 => {
                const $rows: usize = 3;
                $run
            }
            4 => {
                const $rows: usize = 4;
                $run
            }
            _ => {
                const $rows: usize = 6;
                $run
            }
        }
    };
}
pub(super) use by_cone_rows;
