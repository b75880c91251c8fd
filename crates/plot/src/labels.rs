//! Placement of labels next to points, without overlapping other points, labels and, most importantly, curves.

use super::curve::segment;
use super::frame::{Frame, Point};
use super::style::SMALL;
use super::text::width;

/// A label to be placed.
pub(super) struct PlacedLabel {
    /// The point to which it belongs.
    pub(super) point: Point,
    /// Its text.
    pub(super) text: String,
    /// Whether it is placed before others. The ends of a curve are most informative.
    pub(super) first: bool,
}

/// Half the size of a mark, with a margin.
const MARK: f64 = 5.5;
/// The maximum number of marks of a chart with labels. The work grows with the square of their number, and
/// more marks overlap anyway.
const MOST: usize = 300;

/// The baselines of the labels that could be placed, in the order of placement. The others are left out.
pub(super) fn arrange(
    mut wishes: Vec<PlacedLabel>,
    marks: &[Point],
    curves: &[Vec<Point>],
    frame: &Frame,
) -> Vec<(Point, String)> {
    if marks.len() > MOST {
        return Vec::new();
    }
    wishes.sort_by_key(|wish| !wish.first);
    wishes.dedup_by(|a, b| a.point == b.point && a.text == b.text);
    let marks: Vec<Frame> = marks.iter().map(|p| frame_around(*p, MARK - 1.0, MARK - 1.0)).collect();
    let mut occupied: Vec<Frame> = Vec::new();
    let mut placed = Vec::new();
    for wish in wishes.into_iter().filter(|w| !w.text.is_empty()) {
        let free = |slot: &Frame| {
            frame.left <= slot.left
                && slot.right <= frame.right
                && frame.top <= slot.top
                && slot.bottom <= frame.bottom
                && !occupied.iter().chain(&marks).any(|other| other.overlaps(slot))
                && !curves.iter().flat_map(|c| c.windows(2)).any(|pair| match pair {
                    [a, b] => segment(*a, *b, slot).is_some(),
                    _ => false,
                })
        };
        let Some(slot) = candidates(&wish).into_iter().find(free) else { continue };
        occupied.push(slot);
        placed.push(((slot.left + 1.0, slot.bottom - 2.0), wish.text));
    }
    placed
}

/// The rectangles next to the point, the preferred ones first: at the sides, above, below, then at the corners.
fn candidates(wish: &PlacedLabel) -> [Frame; 8] {
    let (w, h) = (width(&wish.text, SMALL) + 2.0, SMALL);
    let (x, y) = (MARK + w / 2.0, MARK + h / 2.0);
    let corner = (x - 2.0, y - 2.0);
    let middles = [
        (x, 0.0),
        (-x, 0.0),
        (0.0, -y),
        (0.0, y),
        (corner.0, -corner.1),
        (-corner.0, -corner.1),
        (corner.0, corner.1),
        (-corner.0, corner.1),
    ];
    middles.map(|(dx, dy)| frame_around((wish.point.0 + dx, wish.point.1 + dy), w / 2.0, h / 2.0))
}

fn frame_around(middle: Point, half_width: f64, half_height: f64) -> Frame {
    Frame {
        left: middle.0 - half_width,
        top: middle.1 - half_height,
        right: middle.0 + half_width,
        bottom: middle.1 + half_height,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const FRAME: Frame = Frame { left: 0.0, top: 0.0, right: 100.0, bottom: 100.0 };

    fn label_at(point: Point) -> PlacedLabel {
        PlacedLabel { point, text: String::from("2 ms"), first: false }
    }

    #[test]
    fn a_label_avoids_edges_curves_and_labels() {
        let placed = arrange(vec![label_at((50.0, 50.0))], &[], &[], &FRAME);
        assert!(placed[0].0.0 > 50.0);
        let at_the_edge = arrange(vec![label_at((95.0, 50.0))], &[], &[], &FRAME);
        assert!(at_the_edge[0].0.0 < 70.0);
        let curve = vec![(0.0, 50.0), (100.0, 50.0)];
        let beside_a_curve = arrange(vec![label_at((50.0, 50.0))], &[], &[curve], &FRAME);
        assert!(beside_a_curve[0].0.1 < 46.0);
        let many = (0..50).map(|_| label_at((50.0, 50.0))).collect();
        assert_eq!(arrange(many, &[], &[], &FRAME).len(), 1);
        let near = (0..50).map(|i| label_at((50.0 + 0.1 * f64::from(i), 50.0))).collect();
        assert!(arrange(near, &[], &[], &FRAME).len() < 9);
    }
}
