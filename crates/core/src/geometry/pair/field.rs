//! A height field against a convex shape: every triangle of the grid under the shape is the top of a prism that
//! reaches down to the base.

use super::{MOST, Settings, Touch};
use crate::geometry::Shape;
use crate::geometry::convex::{Convex, Room, nearest};
use crate::math::*;

pub(super) fn field(
    ground: &Shape,
    b: &Shape,
    margin: f64,
    settings: &Settings,
    room: &mut Room,
    out: &mut Vec<Touch>,
) {
    let field = &ground.field;
    let [sx, sy, top, base] = field.size;
    // The shape in the frame of the field.
    let columns = [0, 1, 2].map(|i| mat_t_mul_vec(&ground.mat, b.axis(i)));
    let local = Shape {
        pos: mat_t_mul_vec(&ground.mat, sub(b.pos, ground.pos)),
        mat: std::array::from_fn(|i| columns[i % 3][i / 3]),
        ..*b
    };
    let mut bare = Convex::new(&local, 0.0);
    let mut reach = |i: usize, side: f64| {
        let mut dir = [0.0; 3];
        dir[i] = side;
        bare.support(dir)[i]
    };
    let [[x0, x1], [y0, y1], [z0, z1]] = [0, 1, 2].map(|i| [reach(i, -1.0), reach(i, 1.0)]);
    let outside = x0 - margin > sx
        || x1 + margin < -sx
        || y0 - margin > sy
        || y1 + margin < -sy
        || z0 - margin > top
        || z1 + margin < -base;
    if outside {
        return;
    }
    let cells = |low: f64, high: f64, half: f64, n: usize| {
        let last = n as f64 - 1.0;
        let (low, high) = ((low + half) / (2.0 * half) * last, (high + half) / (2.0 * half) * last);
        // Casts saturate.
        low.floor().max(0.0) as usize..=(high.ceil().max(0.0) as usize).min(n.saturating_sub(1))
    };
    let (cols, rows) = (cells(x0, x1, sx, field.ncol), cells(y0, y1, sy, field.nrow));
    let mut body = Convex::new(&local, margin);
    let start = out.len();
    for r in *rows.start()..*rows.end() {
        // The last three samples of a zigzag between two rows make a triangle.
        let mut corners = [[0.0; 3]; 3];
        let mut seen = 0;
        for c in cols.clone() {
            for row in [r + 1, r] {
                let mut sample = field.point(row, c);
                sample[2] += margin;
                corners = [corners[1], corners[2], sample];
                seen += 1;
                if seen < 3 || corners.iter().all(|p| p[2] < z0) {
                    continue;
                }
                let [p, q, s] = corners;
                let bottom = corners.map(|p| [p[0], p[1], -base]);
                let mut prism = Convex::prism([bottom[0], bottom[1], bottom[2], p, q, s]);
                let found = nearest(&mut prism, &mut body, 0.0, settings.effort, room);
                let Some([on_a, on_b]) = found.witness.filter(|_| found.dist < 0.0) else { continue };
                let (normal, length) = normalize(sub(on_a, on_b));
                if length == 0.0 {
                    continue;
                }
                let pos = ground.world(scale(add(on_a, on_b), 0.5));
                let normal = mat_mul_vec(&ground.mat, normal);
                out.push(Touch { dist: found.dist, pos, normal, tangent: [0.0; 3] });
                if out.len() - start >= MOST {
                    return;
                }
            }
        }
    }
}
