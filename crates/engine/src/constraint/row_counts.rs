//! The possible numbers of rows of a block as constants, so that loops over rows are unrolled.

/// Maximum number of rows of a block.
pub(super) const MOST_ROWS: usize = 10;

/// Evaluates an expression with the constant `$rows` equal to one of the listed counts, and to the last one otherwise.
macro_rules! by_count {
    ($n:expr, [$($count:literal),+; $most:expr], $rows:ident => $run:expr) => {
        match $n {
            $($count => {
                const $rows: usize = $count;
                $run
            })+
            _ => {
                const $rows: usize = $most;
                $run
            }
        }
    };
}
pub(super) use by_count;

/// Evaluates an expression with the constant `$rows` equal to the number of rows of a block: 1 for a scalar, 3 for a
/// point, 4 and 6 for pyramids and cones with friction, 6 for a frame, 10 for the pyramid with torsional and rolling
/// friction.
macro_rules! by_rows {
    ($n:expr, $rows:ident => $run:expr) => {
        $crate::constraint::row_counts::by_count!(
            $n,
            [1, 3, 4, 6; $crate::constraint::row_counts::MOST_ROWS],
            $rows => $run
        )
    };
}
pub(super) use by_rows;

/// Evaluates an expression with the number of rows of an elliptic cone: one normal, and two, three or five friction
/// directions.
macro_rules! by_cone_rows {
    ($n:expr, $rows:ident => $run:expr) => {
        $crate::constraint::row_counts::by_count!($n, [3, 4; 6], $rows => $run)
    };
}
pub(super) use by_cone_rows;
