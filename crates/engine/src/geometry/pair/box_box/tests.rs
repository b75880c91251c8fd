use super::*;
use crate::geometry::tests::Random;
use crate::kinds::geom;

impl Random {
    fn pose(&mut self) -> Quat {
        let [a, b, c, d] = std::array::from_fn(|_| self.within(-1.0, 1.0));
        quat_normalize([a, b, c, d])
    }

    fn box_at_origin(&mut self) -> Shape<'static> {
        let size = std::array::from_fn(|_| self.within(0.05, 0.6));
        Shape::new(geom::BOX, size, [0.0; 3], quat_to_mat(self.pose()))
    }

    /// Two boxes close to each other. A quarter of the cases are degenerate.
    fn boxes(&mut self) -> (Shape<'static>, Shape<'static>) {
        let (mut first, mut second) = (self.box_at_origin(), self.box_at_origin());
        second.pos = self.vector(-0.8, 0.8);
        if self.below(4) > 0 {
            return (first, second);
        }
        match self.below(5) {
            // Aligned boxes, one on top of the other, touching or nearly touching.
            0 => {
                second.mat = first.mat;
                let k = self.below(3);
                let gap = [0.0, 1e-15, 1e-9, -1e-9, 1e-4, -1e-4][self.below(6)];
                second.pos = scale(first.axis(k), first.size[k] + second.size[k] + gap);
            }
            1 => second.pos = first.pos,
            2 => {
                first.size[self.below(3)] = [0.0, 1e-9][self.below(2)];
                second.size[self.below(3)] = [0.0, 1e-9, 0.3][self.below(3)];
            }
            // Boxes with a common axis, or nearly so.
            3 => {
                let tilt = [0.0, 0.0, 1e-12, 1e-6, 1e-3][self.below(5)];
                let [a, b] = [self.within(-1.0, 1.0), self.within(-1.0, 1.0)];
                second.mat = mat_mul(&first.mat, &quat_to_mat(quat_normalize([a, b, tilt, -tilt])));
            }
            // Two equal boxes, one shifted in its own frame.
            _ => {
                second = first;
                second.pos = mat_mul_vec(&first.mat, self.vector(-0.5, 0.5).map(|x| (4.0 * x).round() / 4.0));
            }
        }
        (first, second)
    }
}

fn extent(first: &Shape, second: &Shape) -> f64 {
    norm(first.size) + norm(second.size) + norm(sub(second.pos, first.pos))
}

/// The largest face gap, and the edge axis if its gap is larger.
fn axes(first: &Shape, second: &Shape) -> (f64, Option<EdgeAxis>) {
    let placement = Placement::new(first, second);
    let (gap, _) = placement.largest_face_gap();
    (gap, placement.larger_edge_gap(gap))
}

/// The gap along the contact normal, and whether it is a gap of two edges.
fn contact_gap(first: &Shape, second: &Shape) -> (f64, bool) {
    let placement = Placement::new(first, second);
    let (gap, face) = placement.largest_face_gap();
    let edges = placement.larger_edge_gap(gap).filter(|axis| !placement.prefers_face(gap, face, axis));
    edges.map_or((gap, false), |axis| (axis.gap, true))
}

fn corner(shape: &Shape, bits: usize) -> Vec3 {
    let sign = |k: usize| if bits >> k & 1 == 0 { 1.0 } else { -1.0 };
    shape.world(std::array::from_fn(|k| sign(k) * shape.size[k]))
}

fn holds(shape: &Shape, point: Vec3, tolerance: f64) -> bool {
    shape.local(point).iter().zip(shape.size).all(|(x, s)| x.abs() <= s + tolerance)
}

/// Whether a face of `second` intersects `first`, enlarged by `grown`, or one box contains the other. Computed by
/// clipping polygons in space.
fn overlap_by_clipping(first: &Shape, second: &Shape, grown: f64) -> bool {
    if holds(first, second.pos, grown) || holds(second, first.pos, 0.0) {
        return true;
    }
    (0..6).any(|face| {
        let [b, u, v] = [face % 3, (face + 1) % 3, (face + 2) % 3];
        let bits = |m: usize| (face / 3) << b | (m / 2) << u | (m.div_ceil(2) % 2) << v;
        let (mut polygon, mut cut) = ([[0.0; 3]; 16], [[0.0; 3]; 16]);
        let mut count = 4;
        for m in 0..4 {
            polygon[m] = first.local(corner(second, bits(m)));
        }
        for plane in 0..6 {
            let (k, side) = (plane % 3, if plane < 3 { 1.0 } else { -1.0 });
            let beyond = |p: Vec3| side * p[k] - first.size[k] - grown;
            let mut n = 0;
            for m in 0..count {
                let (p, q) = (polygon[m], polygon[(m + 1) % count]);
                if beyond(p) <= 0.0 {
                    cut[n] = p;
                    n += 1;
                }
                if (beyond(p) <= 0.0) != (beyond(q) <= 0.0) {
                    cut[n] = add_scaled(p, sub(q, p), beyond(p) / (beyond(p) - beyond(q)));
                    cut[n][k] = side * (first.size[k] + grown);
                    n += 1;
                }
            }
            (polygon, count) = (cut, n);
        }
        count > 0
    })
}

#[test]
fn gaps_agree_with_clipping_and_contacts_lie_on_both_boxes() {
    let mut random = Random(1);
    let mut out = Vec::new();
    let (mut overlapping, mut touching) = (0, 0);
    for case in 0..100_000 {
        let (first, second) = random.boxes();
        let tolerance = 1e-9 * extent(&first, &second);
        let (gap, of_edges) = contact_gap(&first, &second);
        if gap.abs() > tolerance {
            let overlap = overlap_by_clipping(&first, &second, 0.5 * tolerance);
            assert_eq!(gap < 0.0, overlap, "case {case}: gap {gap:e}, {first:?} {second:?}");
            overlapping += usize::from(overlap);
        }

        let margin = [0.0, 0.05][case % 2];
        out.clear();
        box_box(&first, &second, margin, &mut out);
        touching += usize::from(!out.is_empty());
        assert!(out.is_empty() || gap <= margin + tolerance, "case {case}");
        assert!(!out.is_empty() || gap >= -tolerance, "case {case}: nothing found at {gap:e}");
        for touch in &out {
            let describe = || format!("case {case}: {touch:?}, {first:?} {second:?}");
            assert!((norm(touch.normal) - 1.0).abs() < 1e-12, "{}", describe());
            assert!(touch.dist >= gap - tolerance && touch.dist <= margin + tolerance, "{}", describe());
            let half = scale(touch.normal, 0.5 * touch.dist);
            if of_edges {
                assert!((touch.dist - gap).abs() < tolerance, "{}", describe());
                if touch.dist > 0.0 {
                    continue; // The nearest points may be ends of edges, which are not opposite each other along the normal.
                }
            }
            // The two surface points lie opposite each other along the normal.
            assert!(holds(&first, sub(touch.pos, half), tolerance), "{}", describe());
            assert!(holds(&second, add(touch.pos, half), tolerance), "{}", describe());
        }
    }
    println!("{overlapping} overlap, {touching} touch");
    assert!((20_000..80_000).contains(&overlapping) && touching > overlapping);
}

/// Depth of the origin in the convex hull of the differences of all corners. Examines every plane through three of
/// them that has all others on one side. Returns `None` for a flat hull.
fn depth_by_hull(first: &Shape, second: &Shape) -> Option<f64> {
    // A mixed order, so that points on both sides are found early.
    let points: [Vec3; 64] = std::array::from_fn(|m| {
        let m = m * 37 % 64;
        sub(corner(second, m / 8), corner(first, m % 8))
    });
    let size = extent(first, second);
    let mut depth = None;
    for i in 0..64 {
        for j in 0..i {
            for k in 0..j {
                let normal = cross(sub(points[j], points[i]), sub(points[k], points[i]));
                let length = norm(normal);
                if length < 1e-5 * size * size {
                    continue;
                }
                let normal = scale(normal, 1.0 / length);
                let level = dot(normal, points[i]);
                let tolerance = 1e-11 * size;
                let (mut above, mut below) = (false, false);
                for p in &points {
                    let height = dot(normal, *p) - level;
                    above |= height > tolerance;
                    below |= height < -tolerance;
                    if above && below {
                        break;
                    }
                }
                if above != below {
                    let inside = if above { -level } else { level };
                    depth = Some(depth.map_or(inside, |d: f64| d.min(inside)));
                }
            }
        }
    }
    depth
}

#[test]
fn depth_is_that_of_the_hull_of_differences() {
    let mut random = Random(2);
    let (mut compared, mut edges) = (0, 0);
    for case in 0..2_000 {
        let (first, second) = random.boxes();
        if first.size.iter().chain(&second.size).any(|&s| s > 0.0 && s < 1e-6) {
            continue; // Facets too thin for their plane to be computed in floating point.
        }
        let Some(depth) = depth_by_hull(&first, &second) else { continue };
        let (face_gap, axis) = axes(&first, &second);
        let gap = axis.map_or(face_gap, |axis| axis.gap);
        let tolerance = 1e-9 * extent(&first, &second);
        let residual = -depth - gap;
        let describe = || format!("case {case}: depth {depth:e}, gap {gap:e}, {first:?} {second:?}");
        assert!(residual <= tolerance, "{}", describe());
        if depth < -tolerance {
            // For separate boxes, the gap along an axis that belongs to no facet may be larger than all gaps along
            // facet normals.
            assert!(gap > 0.0, "{}", describe());
        } else {
            assert!(residual >= -tolerance, "{}", describe());
            compared += 1;
            edges += usize::from(axis.is_some());
        }
    }
    println!("{compared} compared, {edges} of them edges");
    assert!(compared > 1_000 && edges > 100);
}

#[test]
fn nonfinite_input_gives_no_nan() {
    let mut random = Random(4);
    let mut out = Vec::new();
    let strange =
        [0.0, -1.0, f64::NAN, f64::INFINITY, f64::NEG_INFINITY, f64::MAX, f64::MIN_POSITIVE, 1e-200];
    for _ in 0..100_000 {
        let (mut first, mut second) = random.boxes();
        for _ in 0..=random.below(3) {
            let x = strange[random.below(strange.len())];
            let shape = if random.below(2) == 0 { &mut first } else { &mut second };
            match random.below(5) {
                0 | 1 => shape.size[random.below(3)] = x,
                2 => shape.pos[random.below(3)] = x,
                3 => shape.mat[random.below(9)] = x,
                _ => shape.size = [x; 3],
            }
        }
        let margin = if random.below(8) == 0 { strange[random.below(strange.len())] } else { 0.01 };
        out.clear();
        box_box(&first, &second, margin, &mut out);
        assert!(out.len() <= 8 && out.iter().all(|touch| !touch.dist.is_nan()));
    }
}
