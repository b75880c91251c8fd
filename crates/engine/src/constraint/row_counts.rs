//! The possible numbers of rows of a block as constants, so that loops over rows are unrolled.

/// Maximum number of rows of a block.
pub(super) const MOST_ROWS: usize = 10;

/// Evaluates an expression with the constant `$rows` equal to the number of rows of a block: 1 for a scalar, 3 for a
/// point, 4 and 6 for pyramids and cones with friction, 6 for a frame, 10 for the pyramid with torsional and rolling
/// friction.
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

/// Evaluates an expression with the number of rows of an elliptic cone: one normal, and two, three or five friction
/// directions.
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
