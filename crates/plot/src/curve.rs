//! Reduces samples to the few points that a picture needs.
//!
//! A million samples become a curve of a few hundred points in three steps. First, only the lowest and the highest sample in
//! each column of pixels are kept (a reduced form of the M4 aggregation of Jugel et al., 2014), so that a spike of one sample
//! stays visible. Then the curve is clipped to the frame (Liang and Barsky, 1984). Finally, points on the line between their
//! neighbours are removed (Ramer, 1972; Douglas and Peucker, 1973).

use super::frame::{Frame, Point};
use super::number::px;

/// The maximum distance of a removed point from the drawn line, in pixels. It is invisible even when the picture is enlarged.
const TOLERANCE: f64 = 0.05;
/// Positions further away than this many pixels are moved to this distance, which is far outside any picture.
const MAX_POSITION: f64 = 1e6;

/// The parts of the curve through `samples` inside the frame. A sample for which `place` returns no position ends a part, and
/// so does a step backwards in x, because time starts again after a reset.
///
/// Parts with a single point are isolated samples.
pub(super) fn pieces(
    samples: &[(f64, f64)],
    frame: &Frame,
    place: impl Fn((f64, f64)) -> Option<Point>,
) -> Vec<Vec<Point>> {
    let places = samples.iter().map(|s| place(*s));
    let whole = columns(places, frame);
    let inside = whole.iter().flat_map(|piece| clip(piece, frame));
    inside.map(|piece| simplify(&piece)).collect()
}

/// The samples in one column of pixels: their number, and the samples that are drawn, each with its index in the column.
struct PixelColumn {
    index: i64,
    count: usize,
    first: (usize, Point),
    low: (usize, Point),
    high: (usize, Point),
    last: (usize, Point),
}

impl PixelColumn {
    fn new(index: i64, point: Point) -> Self {
        let only = (0, point);
        PixelColumn { index, count: 1, first: only, low: only, high: only, last: only }
    }

    fn add(&mut self, point: Point) {
        let entry = (self.count, point);
        self.count += 1;
        self.last = entry;
        if point.1 < self.low.1.1 {
            self.low = entry;
        }
        if point.1 > self.high.1.1 {
            self.high = entry;
        }
    }

    /// Appends the extreme samples in their order. The first and the last sample are added if the curve starts or ends here, or
    /// enters the frame from outside.
    fn flush(&self, starts: bool, ends: bool, piece: &mut Vec<Point>) {
        let mut extremes = vec![self.low, self.high];
        if starts {
            extremes.push(self.first);
        }
        if ends {
            extremes.push(self.last);
        }
        extremes.sort_by_key(|entry| entry.0);
        extremes.dedup_by_key(|entry| entry.0);
        piece.extend(extremes.iter().map(|entry| entry.1));
    }
}

fn columns(places: impl Iterator<Item = Option<Point>>, frame: &Frame) -> Vec<Vec<Point>> {
    let mut pieces = Vec::new();
    let mut piece = Vec::new();
    let mut open: Option<PixelColumn> = None;
    let mut gap = false;
    for place in places {
        let Some((x, y)) = place else {
            gap = true;
            continue;
        };
        let point = (x.clamp(-MAX_POSITION, MAX_POSITION), y.clamp(-MAX_POSITION, MAX_POSITION));
        let index = point.0.clamp(frame.left - 1.0, frame.right + 1.0).floor() as i64;
        match &mut open {
            // A gap that is narrower than a pixel is invisible.
            Some(column) if column.index == index => column.add(point),
            Some(column) => {
                let outside = !(frame.left..=frame.right).contains(&(column.index as f64));
                let breaks = gap || index < column.index;
                column.flush(piece.is_empty() || outside, breaks || outside, &mut piece);
                if breaks {
                    pieces.push(std::mem::take(&mut piece));
                }
                *column = PixelColumn::new(index, point);
            }
            None => open = Some(PixelColumn::new(index, point)),
        }
        gap = false;
    }
    if let Some(column) = open {
        column.flush(piece.is_empty(), true, &mut piece);
        pieces.push(piece);
    }
    pieces
}

/// The parts of a curve that are inside the frame.
fn clip(piece: &[Point], frame: &Frame) -> Vec<Vec<Point>> {
    if let [only] = piece {
        return if frame.holds(*only) { vec![vec![*only]] } else { Vec::new() };
    }
    let mut parts: Vec<Vec<Point>> = Vec::new();
    let mut joined = false;
    for pair in piece.windows(2) {
        let [from, to] = pair else { continue };
        let Some((a, b)) = segment(*from, *to, frame) else {
            joined = false;
            continue;
        };
        match parts.last_mut() {
            Some(part) if joined && a == *from => part.push(b),
            _ => parts.push(vec![a, b]),
        }
        joined = b == *to;
    }
    parts
}

/// The part of a straight line that is inside the frame.
pub(super) fn segment(from: Point, to: Point, frame: &Frame) -> Option<(Point, Point)> {
    let (dx, dy) = (to.0 - from.0, to.1 - from.1);
    let edges = [
        (-dx, from.0 - frame.left),
        (dx, frame.right - from.0),
        (-dy, from.1 - frame.top),
        (dy, frame.bottom - from.1),
    ];
    let (mut enter, mut leave) = (0.0f64, 1.0f64);
    for (towards, distance) in edges {
        if towards == 0.0 {
            if distance < 0.0 {
                return None;
            }
        } else if towards < 0.0 {
            enter = enter.max(distance / towards);
        } else {
            leave = leave.min(distance / towards);
        }
    }
    if enter > leave {
        return None;
    }
    let point_at = |t: f64| (from.0 + t * dx, from.1 + t * dy);
    let start = if enter == 0.0 { from } else { point_at(enter) };
    let end = if leave == 1.0 { to } else { point_at(leave) };
    Some((start, end))
}

/// Removes the points that lie on the line between the remaining points.
fn simplify(piece: &[Point]) -> Vec<Point> {
    let mut keep = vec![false; piece.len()];
    for end in [0, piece.len().saturating_sub(1)] {
        if let Some(flag) = keep.get_mut(end) {
            *flag = true;
        }
    }
    let mut open = vec![(0, piece.len().saturating_sub(1))];
    while let Some((start, end)) = open.pop() {
        let (Some(from), Some(to)) = (piece.get(start), piece.get(end)) else { continue };
        let between = piece.iter().enumerate().take(end).skip(start + 1);
        let farthest = between.fold((0.0, start), |worst, (i, point)| {
            let off = distance(*point, *from, *to);
            if off > worst.0 { (off, i) } else { worst }
        });
        if farthest.0 > TOLERANCE {
            if let Some(flag) = keep.get_mut(farthest.1) {
                *flag = true;
            }
            open.extend([(start, farthest.1), (farthest.1, end)]);
        }
    }
    piece.iter().zip(keep).filter(|(_, selected)| *selected).map(|(point, _)| *point).collect()
}

/// The distance of a point from the line between two others.
fn distance(point: Point, from: Point, to: Point) -> f64 {
    let (dx, dy) = (to.0 - from.0, to.1 - from.1);
    let (px, py) = (point.0 - from.0, point.1 - from.1);
    let square = dx * dx + dy * dy;
    let along = if square > 0.0 { ((px * dx + py * dy) / square).clamp(0.0, 1.0) } else { 0.0 };
    let (ox, oy) = (px - along * dx, py - along * dy);
    (ox * ox + oy * oy).sqrt()
}

/// The path data of all parts with more than one point.
pub(super) fn path(pieces: &[Vec<Point>]) -> String {
    let mut data = String::new();
    for piece in pieces.iter().filter(|p| p.len() > 1) {
        for (i, (x, y)) in piece.iter().enumerate() {
            data.push_str(if i == 0 { "M" } else { "L" });
            data.push_str(&px(*x));
            data.push(',');
            data.push_str(&px(*y));
        }
    }
    data
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const FRAME: Frame = Frame { left: 0.0, top: 0.0, right: 100.0, bottom: 100.0 };

    fn simplified_pieces(samples: &[(f64, f64)]) -> Vec<Vec<Point>> {
        pieces(samples, &FRAME, |(x, y)| (x.is_finite() && y.is_finite()).then_some((x, y)))
    }

    #[test]
    fn a_straight_line_is_two_points() {
        let samples: Vec<_> = (0..100_000).map(|i| f64::from(i) * 1e-3).map(|x| (x, 0.5 * x)).collect();
        assert_eq!(simplified_pieces(&samples), vec![vec![(0.0, 0.0), (99.999, 49.9995)]]);
    }

    #[test]
    fn a_spike_of_one_sample_is_kept() {
        let samples: Vec<_> =
            (0..100_000).map(|i| (f64::from(i) * 1e-3, if i == 31_416 { 80.0 } else { 20.0 })).collect();
        let peak = simplified_pieces(&samples).concat().iter().fold(0.0, |m: f64, p| m.max(p.1));
        assert_eq!(peak, 80.0);
    }

    #[test]
    fn gaps_and_resets_break_the_line() {
        let gap = simplified_pieces(&[(0.0, 1.0), (10.0, 5.0), (20.0, f64::NAN), (30.0, 1.0), (40.0, 2.0)]);
        assert_eq!(gap, vec![vec![(0.0, 1.0), (10.0, 5.0)], vec![(30.0, 1.0), (40.0, 2.0)]]);
        let reset = simplified_pieces(&[(0.0, 1.0), (50.0, 9.0), (0.0, 1.0), (20.0, 3.0)]);
        assert_eq!(reset.len(), 2);
        assert_eq!(simplified_pieces(&[(5.0, 5.0)]), vec![vec![(5.0, 5.0)]]);
        assert!(simplified_pieces(&[(f64::NAN, 5.0)]).is_empty() && simplified_pieces(&[]).is_empty());
    }

    #[test]
    fn lines_are_cut_at_the_frame() {
        assert_eq!(
            simplified_pieces(&[(-50.0, 50.0), (50.0, 50.0), (50.0, 200.0), (75.0, -1e9)]),
            vec![
                vec![(0.0, 50.0), (50.0, 50.0), (50.0, 100.0)],
                vec![(50.002_499_500_099_98, 100.0), (50.004_999_000_199_96, 0.0)]
            ]
        );
        assert!(simplified_pieces(&[(-5.0, -5.0), (-3.0, 300.0)]).is_empty());
    }

    proptest! {
        #[test]
        fn few_points_stay_inside_and_keep_the_extremes(
            mut samples in prop::collection::vec((0.0..100.0f64, 0.0..100.0f64), 1..3000)
        ) {
            samples.sort_by(|a, b| a.0.total_cmp(&b.0));
            let points = simplified_pieces(&samples).concat();
            prop_assert!(points.len() <= 2 * 101 + 4);
            prop_assert!(points.iter().all(|p| FRAME.holds(*p)));
            let top = |points: &[Point]| points.iter().fold(f64::MAX, |m, p| m.min(p.1));
            prop_assert!((top(&points) - top(&samples)).abs() <= TOLERANCE);
        }

        #[test]
        fn anything_can_be_drawn(samples in prop::collection::vec((any::<f64>(), any::<f64>()), 0..50)) {
            prop_assert!(simplified_pieces(&samples).concat().iter().all(|p| FRAME.holds((p.0.round(), p.1.round()))));
        }
    }
}
