//! Meshes that are made by a rule: `builtin` with `params`. The order of vertices and triangles is MuJoCo 3.14.0's,
//! measured on the library.

use crate::mjcf::gather::listed;
use std::collections::BTreeMap;
use std::f64::consts::PI;

use crate::math::{Vec3, normalize};
use crate::mjcf::asset::mesh::{Problem, Raw};

/// The keywords of `builtin`, each with the names of its parameters.
const RULES: [(&str, &[&str]); 7] = [
    ("sphere", &["subdivision"]),
    ("hemisphere", &["resolution"]),
    ("cone", &["edges", "radius of the top"]),
    ("supersphere", &["resolution", "e", "n"]),
    ("supertorus", &["resolution", "radius", "s", "t"]),
    (
        "wedge",
        &["horizontal resolution", "vertical resolution", "horizontal angle", "vertical angle", "gamma"],
    ),
    ("plate", &["horizontal resolution", "vertical resolution"]),
];

/// Highest resolution of a side.
const FINEST: f64 = 500.0;

/// Makes a mesh; whether it is a surface without inside is said, too.
pub(crate) fn make(rule: &str, params: &[f64]) -> Result<(Raw, bool), Problem> {
    let Some((_, names)) = RULES.iter().find(|(name, _)| *name == rule) else {
        return Err(Problem::new(
            "builtin",
            format!("uses the unknown rule `{rule}`"),
            "",
            "write sphere, hemisphere, cone, supersphere, supertorus, wedge or plate",
        ));
    };
    if params.len() != names.len() {
        return Err(Problem::new(
            "params",
            format!(
                "has {} of the {} parameters of `{rule}`: {}",
                params.len(),
                names.len(),
                names.join(", ")
            ),
            "",
            "write that many numbers",
        ));
    }
    for ((x, name), (low, high)) in params.iter().zip(*names).zip(ranges(rule)) {
        if !(*low..=*high).contains(x) {
            return Err(Problem::new(
                "params",
                format!("has {x} for the {name} of `{rule}`, which must be from {low} to {high}"),
                "",
                "see MuJoCo's XML reference, asset/mesh",
            ));
        }
    }
    let p = |i: usize| params.get(i).copied().unwrap_or(0.0);
    let n = |i: usize| p(i) as usize;
    let raw = match rule {
        "sphere" => sphere(n(0)),
        "hemisphere" => hemisphere(n(0)),
        "cone" => cone(n(0), p(1)),
        "supersphere" => supersphere(n(0), p(1), p(2)),
        "supertorus" => supertorus(n(0), p(1), p(2), p(3)),
        "wedge" => wedge([n(0), n(1)], [p(2), p(3)], p(4)),
        _ => plate([n(0), n(1)]),
    };
    Ok((single(raw), rule == "plate"))
}

/// The range of each parameter of a rule. Angles and radii may come as near to zero as they like.
fn ranges(rule: &str) -> &'static [(f64, f64)] {
    const TINY: f64 = f64::MIN_POSITIVE;
    match rule {
        "sphere" => &[(0.0, 4.0)],
        "hemisphere" => &[(0.0, 10.0)],
        "cone" => &[(3.0, FINEST), (0.0, 1e6)],
        "supersphere" => &[(3.0, FINEST), (0.0, 100.0), (0.0, 100.0)],
        "supertorus" => &[(4.0, FINEST), (TINY, 1.0), (TINY, 100.0), (TINY, 100.0)],
        "wedge" => &[(1.0, FINEST), (1.0, FINEST), (TINY, 180.0), (TINY, 90.0), (0.0, 1.0)],
        _ => &[(1.0, FINEST), (1.0, FINEST)],
    }
}

/// As precise as a file is.
fn single(mut raw: Raw) -> Raw {
    for x in raw.vert.iter_mut().chain(&mut raw.normal).flatten() {
        *x = f64::from(*x as f32);
    }
    raw
}

/// An icosahedron whose triangles are cut in four, so many times, by the middles of their sides on the sphere.
fn sphere(subdivision: usize) -> Raw {
    let golden = (1.0 + libm::sqrt(5.0)) / 2.0;
    let mut vert: Vec<Vec3> = Vec::new();
    for turn in 0..3 {
        for (small, large) in [(-1.0, golden), (1.0, golden), (-1.0, -golden), (1.0, -golden)] {
            let corner = [small, large, 0.0];
            vert.push(std::array::from_fn(|i| corner[(i + 3 - turn) % 3]));
        }
    }
    vert.iter_mut().for_each(|v| *v = normalize(*v).0);
    let mut face: Vec<[i32; 3]> = vec![
        [0, 11, 5],
        [0, 5, 1],
        [0, 1, 7],
        [0, 7, 10],
        [0, 10, 11],
        [1, 5, 9],
        [5, 11, 4],
        [11, 10, 2],
        [10, 7, 6],
        [7, 1, 8],
        [3, 9, 4],
        [3, 4, 2],
        [3, 2, 6],
        [3, 6, 8],
        [3, 8, 9],
        [4, 9, 5],
        [2, 4, 11],
        [6, 2, 10],
        [8, 6, 7],
        [9, 8, 1],
    ];
    for _ in 0..subdivision {
        let mut middles: BTreeMap<(i32, i32), i32> = BTreeMap::new();
        let mut finer = Vec::with_capacity(4 * face.len());
        for [a, b, c] in face {
            let mut cut = |a: i32, b: i32| {
                *middles.entry((a.min(b), a.max(b))).or_insert_with(|| {
                    let corner = |i: i32| vert.get(i as usize).copied().unwrap_or_default();
                    vert.push(middle(corner(a), corner(b)));
                    vert.len() as i32 - 1
                })
            };
            let (ab, bc, ca) = (cut(a, b), cut(b, c), cut(c, a));
            finer.extend([[a, ab, ca], [b, bc, ab], [c, ca, bc], [ab, bc, ca]]);
        }
        face = finer;
    }
    Raw { vert, face, ..Raw::default() }
}

/// The point on the unit sphere between two others, in single precision as MuJoCo has it.
fn middle(a: Vec3, b: Vec3) -> Vec3 {
    let m = [0, 1, 2].map(|i| 0.5 * (a[i] as f32 + b[i] as f32));
    let length = (m[0] * m[0] + m[1] * m[1] + m[2] * m[2]).sqrt();
    m.map(|x| f64::from(x / length))
}

/// Half an octahedron of `resolution` + 1 rings, blown up to the sphere, with a lid.
fn hemisphere(resolution: usize) -> Raw {
    let rings = resolution + 1;
    // A ring is a square of side `ring`; its corners are on the axes.
    let on = |ring: usize, i: usize| -> Vec3 {
        let (side, along) = (i / ring.max(1), (i % ring.max(1)) as f64);
        let (near, far) = (ring as f64 - along, along);
        let [x, y] = match side {
            0 => [near, far],
            1 => [-far, near],
            2 => [-near, -far],
            _ => [far, -near],
        };
        normalize([x, y, (rings - ring) as f64]).0
    };
    let mut vert = vec![[0.0, 0.0, 1.0]];
    for ring in 1..=rings {
        vert.extend((0..4 * ring).map(|i| on(ring, i)));
    }
    let centre = vert.len() as i32;
    vert.push([0.0; 3]);
    let first = |ring: usize| if ring == 0 { 0 } else { 1 + 2 * ring * (ring - 1) };
    let at = |ring: usize, i: usize| (first(ring) + i % (4 * ring).max(1)) as i32;
    let mut face = Vec::new();
    for ring in 0..rings {
        for side in 0..4 {
            for i in 0..=ring {
                let (inner, outer) = (side * ring + i, side * (ring + 1) + i);
                face.push([at(ring, inner), at(ring + 1, outer), at(ring + 1, outer + 1)]);
                if i < ring {
                    face.push([at(ring, inner), at(ring + 1, outer + 1), at(ring, inner + 1)]);
                }
            }
        }
    }
    face.extend((0..4 * rings).map(|i| [at(rings, i), centre, at(rings, i + 1)]));
    Raw { vert, face, ..Raw::default() }
}

/// Corners of a cone or truncated cone; its sides are those of the hull.
fn cone(edges: usize, radius: f64) -> Raw {
    let ring = |r: f64, z: f64| {
        (0..edges).map(move |i| {
            let angle = 2.0 * PI * i as f64 / edges as f64;
            [r * libm::cos(angle), r * libm::sin(angle), z]
        })
    };
    let mut vert: Vec<Vec3> = listed(ring(1.0, -1.0));
    if radius > 0.0 {
        vert.extend(ring(radius, 1.0));
    } else {
        vert.push([0.0, 0.0, 1.0]);
    }
    Raw { vert, ..Raw::default() }
}

/// A power of a cosine with the cosine's sign (Barr 1981, *Superquadrics and angle-preserving transformations*).
fn cos(angle: f64, power: f64) -> f64 {
    signed_power(libm::cos(angle), power)
}

fn sin(angle: f64, power: f64) -> f64 {
    signed_power(libm::sin(angle), power)
}

fn signed_power(x: f64, power: f64) -> f64 {
    // Of no sign when it is zero to begin with.
    let sign = if x > 0.0 {
        1.0
    } else if x < 0.0 {
        -1.0
    } else {
        0.0
    };
    sign * libm::pow(x.abs(), power)
}

fn supersphere(res: usize, e: f64, n: f64) -> Raw {
    let mut vert = vec![[0.0, 0.0, -1.0]];
    for i in 1..res {
        let v = -PI / 2.0 + i as f64 * PI / res as f64;
        for j in 0..res {
            let u = -PI + j as f64 * 2.0 * PI / res as f64;
            vert.push([cos(v, n) * cos(u, e), cos(v, n) * sin(u, e), sin(v, n)]);
        }
    }
    vert.push([0.0, 0.0, 1.0]);
    let top = vert.len() as i32 - 1;
    let at = |ring: usize, j: usize| (1 + ring * res + j % res) as i32;
    let mut face: Vec<[i32; 3]> = listed((0..res).map(|j| [0, at(0, j + 1), at(0, j)]));
    for i in 0..res - 2 {
        for j in 0..res {
            face.push([at(i, j), at(i, j + 1), at(i + 1, j)]);
            face.push([at(i, j + 1), at(i + 1, j + 1), at(i + 1, j)]);
        }
    }
    face.extend((0..res).map(|j| [at(res - 2, j), at(res - 2, j + 1), top]));
    Raw { vert, face, ..Raw::default() }
}

fn supertorus(res: usize, radius: f64, s: f64, t: f64) -> Raw {
    let step = 2.0 * PI / res as f64;
    let mut raw = Raw::default();
    let at = |i: usize, j: usize| ((i % res) * res + j % res) as i32;
    for i in 0..res {
        let u = i as f64 * step;
        for j in 0..res {
            let v = j as f64 * step;
            let out = 1.0 + radius * cos(v, s);
            raw.vert.push([out * cos(u, t), out * sin(u, t), radius * sin(v, s)]);
            raw.face.push([at(i, j), at(i + 1, j), at(i, j + 1)]);
            raw.face.push([at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)]);
        }
    }
    raw
}

/// Middles of cells that divide -1 to 1, drawn to the centre by a polynomial of the fifth degree.
fn middles(count: usize, gamma: f64) -> impl Iterator<Item = f64> + Clone {
    let edge = move |i: usize| {
        let x = -1.0 + 2.0 * i as f64 / count as f64;
        gamma * libm::pow(x, 5.0) + (1.0 - gamma) * x
    };
    (0..count).map(move |i| 0.5 * (edge(i) + edge(i + 1)))
}

/// Directions from a point, on the unit sphere around it, each with a normal and two tangents.
fn wedge([columns, rows]: [usize; 2], [wide, high]: [f64; 2], gamma: f64) -> Raw {
    let mut raw = Raw::default();
    for x in middles(columns, gamma) {
        let (sh, ch) = libm::sincos(x * wide * PI / 180.0);
        for y in middles(rows, gamma) {
            let (sv, cv) = libm::sincos(y * high * PI / 180.0);
            let out = [sh * cv, sv, -ch * cv];
            raw.vert.push(out);
            raw.normal.extend([out, [ch, 0.0, sh], [-sh * sv, cv, ch * sv]]);
        }
    }
    raw
}

/// Middles of the cells of a square, each with a normal and two tangents.
fn plate([columns, rows]: [usize; 2]) -> Raw {
    let mut raw = Raw::default();
    for x in middles(columns, 0.0) {
        for y in middles(rows, 0.0) {
            raw.vert.push([x, y, -1.0]);
            raw.normal.extend([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]);
        }
    }
    let at = |i: usize, j: usize| (i * rows + j) as i32;
    for i in 1..columns {
        for j in 1..rows {
            raw.face.push([at(i - 1, j - 1), at(i, j - 1), at(i - 1, j)]);
            raw.face.push([at(i, j), at(i - 1, j), at(i, j - 1)]);
        }
    }
    raw
}
