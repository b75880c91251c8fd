//! Triangles of meshes and height fields, in a tree of boxes.

use labspec_core::Model;
use labspec_core::math::{Vec3, add, add_scaled, cross, dot, normalize, scale, sub};

/// A corner of a triangle.
#[derive(Clone, Copy, Debug)]
struct Corner {
    position: Vec3,
    normal: Vec3,
    uv: [f64; 2],
}

/// Triangles, counter-clockwise seen from outside, in m in the frame of their geom.
#[derive(Debug, Default)]
pub(crate) struct Triangles {
    triangles: Vec<[Corner; 3]>,
    nodes: Vec<Node>,
}

/// A box around triangles `first` to `end`; the children of an inner node follow it, and `second` is the second of them.
#[derive(Clone, Copy, Debug)]
struct Node {
    low: Vec3,
    high: Vec3,
    first: usize,
    end: usize,
    second: Option<usize>,
}

/// A box with no more triangles is not divided.
const MAX_LEAF_TRIANGLES: usize = 4;
/// More levels than any tree has whose lists of triangles are halved.
const MAX_DEPTH: usize = 64;

/// A row of a field with N numbers in each; zeros if there is no such row.
fn row<const N: usize, T: Copy + Default>(list: &[T], index: usize) -> [T; N] {
    list.as_chunks::<N>().0.get(index).copied().unwrap_or([T::default(); N])
}

fn index(list: &[i32], at: usize) -> usize {
    list.get(at).and_then(|i| usize::try_from(*i).ok()).unwrap_or(0)
}

/// The most points of a height field that are drawn along one side: about every second pixel of a picture of 800 pixels.
const MOST_POINTS: usize = 400;

/// The points of one side of a height field that are drawn: at equal distances, with both ends.
fn drawn_points(count: usize) -> Vec<usize> {
    let drawn = count.min(MOST_POINTS);
    (0..drawn).map(|i| i * (count - 1) / (drawn - 1)).collect()
}

/// The place of a point of a row, from 0 to 1.
fn share(i: usize, count: usize) -> f64 {
    i as f64 / (count - 1) as f64
}

impl Triangles {
    fn new(mut triangles: Vec<[Corner; 3]>) -> Triangles {
        triangles.retain(|corners| corners.iter().all(|c| c.position.iter().all(|x| x.is_finite())));
        let mut nodes = Vec::new();
        let count = triangles.len();
        if count > 0 {
            build_tree(&mut triangles, 0, count, &mut nodes, 0);
        }
        Triangles { triangles, nodes }
    }

    /// The number of triangles.
    pub(crate) fn count(&self) -> usize {
        self.triangles.len()
    }

    /// A mesh of a model.
    pub(crate) fn of_mesh(m: &Model, id: usize) -> Triangles {
        let (vertex, normal) = (index(&m.mesh_vertadr, id), index(&m.mesh_normaladr, id));
        let face = index(&m.mesh_faceadr, id);
        let texture = m.mesh_texcoordadr.get(id).and_then(|adr| usize::try_from(*adr).ok());
        let corner = |f: usize, k: usize| {
            let of = |list: &[i32]| usize::try_from(row::<3, i32>(list, f)[k]).unwrap_or(0);
            Corner {
                position: row(&m.mesh_vert, vertex + of(&m.mesh_face)),
                normal: row(&m.mesh_normal, normal + of(&m.mesh_facenormal)),
                uv: texture.map_or([0.0; 2], |t| row(&m.mesh_texcoord, t + of(&m.mesh_facetexcoord))),
            }
        };
        let faces = face..face + index(&m.mesh_facenum, id);
        Triangles::new(faces.map(|f| [corner(f, 0), corner(f, 1), corner(f, 2)]).collect())
    }

    /// A height field of a model: its surface with smooth normals, its four sides and its base. Of a large one, not all points are drawn.
    pub(crate) fn of_height_field(m: &Model, id: usize) -> Triangles {
        let count = [index(&m.hfield_nrow, id), index(&m.hfield_ncol, id)];
        if count[0] < 2 || count[1] < 2 {
            return Triangles::default();
        }
        let first = index(&m.hfield_adr, id);
        let [x, y, z, base] = row(&m.hfield_size, id);
        let drawn = count.map(drawn_points);
        let [rows, columns] = [drawn[0].len(), drawn[1].len()];
        let point = |r: usize, c: usize| {
            let (r, c) = (drawn[0][r], drawn[1][c]);
            let height = m.hfield_data.get(first + r * count[1] + c).copied().unwrap_or(0.0);
            [x * (2.0 * share(c, count[1]) - 1.0), y * (2.0 * share(r, count[0]) - 1.0), z * height]
        };
        let corner = |r: usize, c: usize| {
            let across = sub(point(r, (c + 1).min(columns - 1)), point(r, c.saturating_sub(1)));
            let along = sub(point((r + 1).min(rows - 1), c), point(r.saturating_sub(1), c));
            Corner {
                position: point(r, c),
                normal: normalize(cross(across, along)).0,
                uv: [share(drawn[1][c], count[1]), share(drawn[0][r], count[0])],
            }
        };
        let mut triangles = Vec::new();
        for r in 0..rows - 1 {
            for c in 0..columns - 1 {
                let [a, b, d, e] = [corner(r, c), corner(r, c + 1), corner(r + 1, c + 1), corner(r + 1, c)];
                triangles.extend([[a, b, d], [a, d, e]]);
            }
        }
        let mut wall = |normal: Vec3, points: Vec<Vec3>| {
            for pair in points.windows(2) {
                let at = |position: Vec3| Corner { position, normal, uv: [0.0; 2] };
                let down = |p: Vec3| [p[0], p[1], -base];
                let [a, b] = [pair[0], pair[1]];
                triangles.extend([[at(a), at(down(a)), at(down(b))], [at(a), at(down(b)), at(b)]]);
            }
        };
        wall([0.0, -1.0, 0.0], (0..columns).map(|c| point(0, c)).collect());
        wall([1.0, 0.0, 0.0], (0..rows).map(|r| point(r, columns - 1)).collect());
        wall([0.0, 1.0, 0.0], (0..columns).rev().map(|c| point(rows - 1, c)).collect());
        wall([-1.0, 0.0, 0.0], (0..rows).rev().map(|r| point(r, 0)).collect());
        let below = |i: f64, j: f64| Corner {
            position: [i * x, j * y, -base],
            normal: [0.0, 0.0, -1.0],
            uv: [0.0; 2],
        };
        let [a, b, c, d] = [below(-1.0, -1.0), below(-1.0, 1.0), below(1.0, 1.0), below(1.0, -1.0)];
        triangles.extend([[a, b, c], [a, c, d]]);
        Triangles::new(triangles)
    }

    /// The middle and the radius of a ball around all of them, m.
    pub(crate) fn bound(&self) -> (Vec3, f64) {
        let Some(root) = self.nodes.first() else { return ([0.0; 3], 0.0) };
        let half = scale(sub(root.high, root.low), 0.5);
        (add(root.low, half), dot(half, half).sqrt())
    }

    /// Where a ray first meets a triangle from outside between two distances: the distance, the normal, texture coordinates.
    pub(crate) fn hit(&self, o: Vec3, d: Vec3, from: f64, to: f64) -> Option<(f64, Vec3, [f64; 2])> {
        let inverse = d.map(|x| 1.0 / x);
        let mut waiting = vec![0];
        let (mut nearest, mut found) = (to, None);
        while let Some(node) = waiting.pop().and_then(|i: usize| self.nodes.get(i).map(|n| (i, n))) {
            let (place, node) = node;
            if !meets_box(node, o, inverse, from, nearest) {
                continue;
            }
            if let Some(second) = node.second {
                waiting.extend([second, place + 1]);
                continue;
            }
            for corners in self.triangles.get(node.first..node.end).unwrap_or(&[]) {
                if let Some((t, u, v)) =
                    meets_triangle(corners, o, d).filter(|(t, ..)| *t > from && *t < nearest)
                {
                    (nearest, found) = (t, Some((corners, u, v)));
                }
            }
        }
        let (corners, u, v) = found?;
        let [a, b, c] = corners;
        let mut normal = add_scaled(add_scaled(scale(a.normal, 1.0 - u - v), b.normal, u), c.normal, v);
        // A smooth normal may point away from the eye at the outline.
        if dot(normal, d) > 0.0 {
            normal = cross(sub(b.position, a.position), sub(c.position, a.position));
        }
        let uv = [0, 1].map(|i| a.uv[i] * (1.0 - u - v) + b.uv[i] * u + c.uv[i] * v);
        Some((nearest, normal, uv))
    }
}

/// Whether a ray meets the box of a node between two distances.
fn meets_box(node: &Node, o: Vec3, inverse: Vec3, from: f64, to: f64) -> bool {
    let (mut enter, mut leave) = (from, to);
    for i in 0..3 {
        let a = (node.low[i] - o[i]) * inverse[i];
        let b = (node.high[i] - o[i]) * inverse[i];
        enter = enter.max(a.min(b));
        leave = leave.min(a.max(b));
    }
    enter <= leave
}

/// The distance, and the weights of the second and the third corner.
fn meets_triangle([a, b, c]: &[Corner; 3], o: Vec3, d: Vec3) -> Option<(f64, f64, f64)> {
    let (e, f) = (sub(b.position, a.position), sub(c.position, a.position));
    let p = cross(d, f);
    let determinant = dot(e, p);
    // From behind, it is negative.
    if determinant <= 0.0 {
        return None;
    }
    let away = sub(o, a.position);
    let u = dot(away, p) / determinant;
    let q = cross(away, e);
    let v = dot(d, q) / determinant;
    (u >= 0.0 && v >= 0.0 && u + v <= 1.0).then(|| (dot(f, q) / determinant, u, v))
}

/// Puts triangles `first` to `end` into a tree, halved along the longest side of their box. Returns the place of its root.
fn build_tree(
    triangles: &mut [[Corner; 3]],
    first: usize,
    end: usize,
    nodes: &mut Vec<Node>,
    depth: usize,
) -> usize {
    let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
    let part = triangles.get_mut(first..end).unwrap_or(&mut []);
    for corner in part.iter().flatten() {
        for i in 0..3 {
            low[i] = low[i].min(corner.position[i]);
            high[i] = high[i].max(corner.position[i]);
        }
    }
    let place = nodes.len();
    nodes.push(Node { low, high, first, end, second: None });
    if part.len() <= MAX_LEAF_TRIANGLES || depth >= MAX_DEPTH {
        return place;
    }
    let sides = sub(high, low);
    let axis = (0..3).fold(0, |best, i| if sides[i] > sides[best] { i } else { best });
    let middle = |t: &[Corner; 3]| t.iter().map(|c| c.position[axis]).sum::<f64>();
    part.sort_by(|a, b| middle(a).total_cmp(&middle(b)));
    let half = first + part.len() / 2;
    build_tree(triangles, first, half, nodes, depth + 1);
    let second = build_tree(triangles, half, end, nodes, depth + 1);
    if let Some(node) = nodes.get_mut(place) {
        node.second = Some(second);
    }
    place
}

#[cfg(test)]
mod tests {
    use super::*;

    fn model(asset: &str, geom: &str) -> Model {
        let text = format!("<mujoco><asset>{asset}</asset><worldbody><geom {geom}/></worldbody></mujoco>");
        Model::from_xml(&text).unwrap()
    }

    #[test]
    fn a_mesh_of_a_cube_is_met_where_a_box_is() {
        let cube = "<mesh name='c' vertex='-1 -1 -1 1 -1 -1 -1 1 -1 1 1 -1 -1 -1 1 1 -1 1 -1 1 1 1 1 1'/>";
        let m = model(cube, "type='mesh' mesh='c'");
        let triangles = Triangles::of_mesh(&m, 0);
        assert_eq!(triangles.triangles.len(), 12);
        for i in 0..500 {
            let a = f64::from(i);
            let o = [-4.0, a.sin() * 1.5, (a * 1.7).cos() * 1.5];
            let found = triangles.hit(o, [1.0, 0.0, 0.0], 0.0, 100.0);
            let meets = o[1].abs() < 1.0 && o[2].abs() < 1.0;
            assert_eq!(found.map(|(t, ..)| (t * 1e9).round() / 1e9), meets.then_some(3.0), "{o:?}");
        }
        // From inside nothing is seen.
        assert!(triangles.hit([0.0; 3], [0.3, 0.4, 0.5], 0.0, 100.0).is_none());
    }

    #[test]
    fn a_height_field_has_its_heights_and_its_base() {
        let field = "<hfield name='h' nrow='3' ncol='3' size='1 1 .5 .2' elevation='0 0 0 0 1 0 0 0 0'/>";
        let m = model(field, "type='hfield' hfield='h'");
        let triangles = Triangles::of_height_field(&m, 0);
        let down =
            |x: f64, y: f64| triangles.hit([x, y, 5.0], [0.0, 0.0, -1.0], 0.0, 100.0).map(|(t, ..)| 5.0 - t);
        assert_eq!(down(0.0, 0.0), Some(0.5));
        assert_eq!(down(1.5, 0.0), None);
        let up = triangles.hit([0.1, 0.2, -5.0], [0.0, 0.0, 1.0], 0.0, 100.0).unwrap();
        assert_eq!((up.0, up.1), (4.8, [0.0, 0.0, -1.0]));
    }

    #[test]
    fn a_large_height_field_keeps_its_ends() {
        assert_eq!(drawn_points(3), [0, 1, 2]);
        let drawn = drawn_points(5000);
        assert_eq!((drawn.len(), drawn[0], drawn[MOST_POINTS - 1]), (MOST_POINTS, 0, 4999));
        assert!(drawn.windows(2).all(|pair| pair[0] < pair[1]));
    }
}
