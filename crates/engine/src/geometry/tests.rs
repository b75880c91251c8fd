//! Rays, distances and contacts compared with MuJoCo 3.14.0, recorded by `golden/record.py`.
//!
//! `LABSPEC_GEOMETRY` can name a folder with more cases than the repository contains. Then the largest difference of
//! each pair is also printed, and the tables of `docs/measured/contacts.md` are written to `contacts.md` and
//! `distances.md` in this folder.

mod figures;
mod random;
mod scaled;
mod truth;

pub(crate) use random::Random;

use figures::Figures;
use std::collections::BTreeMap;

use super::convex::{Convex, nearest};
use super::pair::{self, ContactPoint, Method, PairSettings};
use super::{HeightField, Hull, HullFaces, Mesh, Narrow, Shape, ray, ray_shape};
use crate::kinds::geom;
use crate::math::*;
use crate::model::Model;

const KINDS: [&str; 8] = ["plane", "hfield", "sphere", "capsule", "ellipsoid", "cylinder", "box", "mesh"];

#[derive(Default)]
struct Assets {
    vert: BTreeMap<String, Vec<Vec3>>,
    face: BTreeMap<String, Vec<[i32; 3]>>,
    graph: BTreeMap<String, Vec<i32>>,
    hull_faces: BTreeMap<String, HullFaces>,
    field: Option<(Vec<f64>, Vec<f64>)>,
}

fn floats(text: &str) -> Vec<f64> {
    text.split_whitespace().map(|w| w.parse().unwrap()).collect()
}

fn ints(text: &str) -> Vec<i32> {
    text.split_whitespace().map(|w| w.parse().unwrap()).collect()
}

impl Assets {
    fn read(text: &str) -> Assets {
        let mut assets = Assets::default();
        for line in text.lines() {
            let parts: Vec<&str> = line.split('|').collect();
            let (what, rest) = parts[0].split_once(' ').unwrap();
            let (name, rest) = rest.split_once(' ').unwrap();
            match what {
                "mesh" => {
                    assets.vert.insert(name.into(), rows::<3>(&floats(rest)).to_vec());
                    assets.face.insert(name.into(), ints(parts[1]).as_chunks().0.to_vec());
                    assets.graph.insert(name.into(), ints(parts[2]));
                    let mesh = assets.mesh(name);
                    let hull_faces = mesh
                        .hull
                        .map_or_else(HullFaces::default, |hull| HullFaces::from_hull(mesh.vert, &hull));
                    assets.hull_faces.insert(name.into(), hull_faces);
                }
                "field" => assets.field = Some((floats(rest), floats(parts[1]))),
                _ => break,
            }
        }
        assets
    }

    fn mesh<'a>(&'a self, name: &str) -> Mesh<'a> {
        Mesh {
            vert: &self.vert[name],
            face: &self.face[name],
            hull: Hull::from_graph(&self.graph[name]),
            hull_faces: self.hull_faces.get(name),
        }
    }

    /// Parses a shape from the next words.
    fn shape<'a>(&'a self, words: &mut std::str::SplitWhitespace<'_>) -> Shape<'a> {
        let kind = KINDS.iter().position(|k| Some(*k) == words.clone().next()).unwrap() as i32;
        words.next();
        let data = words.next().unwrap();
        let mut take = || words.next().unwrap().parse::<f64>().unwrap();
        let (size, pos) = ([take(), take(), take()], [take(), take(), take()]);
        let quat = quat_normalize([take(), take(), take(), take()]);
        let mut shape = Shape::new(kind, size, pos, quat_to_mat(quat));
        match kind {
            geom::MESH => shape.mesh = Some(self.mesh(data)),
            geom::HFIELD => {
                let (head, samples) = self.field.as_ref().unwrap();
                let size = [head[2], head[3], head[4], head[5]];
                shape.field =
                    Some(HeightField { size, nrow: head[0] as usize, ncol: head[1] as usize, data: samples });
            }
            _ => {}
        }
        shape
    }
}

/// The recorded cases, from the folder that the environment variable names or from the repository. The flag is true
/// for the former.
fn cases(file: &str, committed: &str) -> (String, bool) {
    match std::env::var("LABSPEC_GEOMETRY") {
        Ok(folder) => (std::fs::read_to_string(format!("{folder}/{file}")).unwrap(), true),
        Err(_) => (committed.to_string(), false),
    }
}

/// Writes a table to the folder that the environment variable names.
fn write_table(file: &str, table: &str) {
    if let Ok(folder) = std::env::var("LABSPEC_GEOMETRY") {
        std::fs::write(format!("{folder}/{file}"), table).unwrap();
    }
}

/// Cases beyond the bound for a known reason: quantity or pair, numbers of the cases, reason. A case beyond the bound
/// that is not listed fails the test, and so does a listed case within the bound.
type AllowedCases = (&'static str, &'static [usize], &'static str);

/// Cases of one pair of types.
#[derive(Default)]
struct Cases {
    number: usize,
    /// Cases beyond the bound: number of the case, difference, input and result.
    beyond: Vec<(usize, f64, String)>,
    /// The largest difference of the other cases.
    worst: f64,
}

#[derive(Default)]
struct ToleranceReport(BTreeMap<String, Cases>);

impl ToleranceReport {
    fn note(&mut self, name: String, case: usize, difference: f64, bound: f64, line: &str) {
        let r = self.0.entry(name).or_default();
        r.number += 1;
        if difference.is_nan() || difference > bound {
            r.beyond.push((case, difference, line.to_string()));
        } else {
            r.worst = r.worst.max(difference);
        }
    }

    /// Fails if the cases beyond the bound are not exactly the listed ones. Results of other recordings are only
    /// printed.
    fn finish(self, print: bool, allowed: &[AllowedCases]) {
        let (mut text, mut wrong) = (String::new(), String::new());
        for (name, r) in &self.0 {
            let (number, worst) = (r.number, r.worst);
            text += &format!(
                "{name:24} {number:6} cases, {} beyond the bound, else within {worst:.1e}\n",
                r.beyond.len()
            );
            for (case, error, line) in &r.beyond {
                if !allowed.iter().any(|(of, cases, _)| of == name && cases.contains(case)) {
                    wrong += &format!("{name}, case {case}: {error:.1e} apart\n    {line}\n");
                }
            }
        }
        for (name, cases, _) in allowed {
            for case in *cases {
                if !self.0.get(*name).is_some_and(|r| r.beyond.iter().any(|(k, ..)| k == case)) {
                    wrong += &format!("{name}, case {case}: is listed, and is within the bound\n");
                }
            }
        }
        if print {
            println!("{text}");
        } else {
            assert!(wrong.is_empty(), "{text}{wrong}");
        }
    }
}

/// Largest difference of two lists of numbers; infinite if their lengths differ.
fn difference(a: &[f64], b: &[f64]) -> f64 {
    if a.len() != b.len() {
        return f64::INFINITY;
    }
    let error = a.iter().zip(b).map(|(x, y)| (x - y).abs());
    error.fold(0.0, |m, d| if d.is_nan() { f64::INFINITY } else { m.max(d) })
}

/// Reorders one list of contacts like another: each contact is matched with the nearest one that remains.
fn in_order_of(expected: &[f64], got: &[f64]) -> Vec<f64> {
    let (expected, mut left) = (rows::<10>(expected), rows::<10>(got).to_vec());
    let mut out = Vec::new();
    for w in expected {
        let far = |g: &[f64; 10]| difference(&g[1..4], &w[1..4]);
        let Some(k) = (0..left.len()).min_by(|&i, &j| far(&left[i]).total_cmp(&far(&left[j]))) else { break };
        out.extend(left.remove(k));
    }
    out.extend(left.into_iter().flatten());
    out
}

/// Removes repeated contacts: MuJoCo lists some contacts twice, for a capsule and a box and for two capsules end to
/// end.
fn distinct(contacts: Vec<f64>) -> Vec<f64> {
    let list = rows::<10>(&contacts);
    let repeats = |k: usize| list[..k].iter().any(|c| difference(c, &list[k]) == 0.0);
    (0..list.len()).filter(|&k| !repeats(k)).flat_map(|k| list[k]).collect()
}

/// Whether the axis of a capsule intersects a box. MuJoCo then uses the nearest face of one point of the axis, not
/// the shortest translation that separates the two (`pair/cuboid/tests.rs` verifies ours).
fn pierced(a: &Shape, b: &Shape) -> bool {
    let core = Shape { size: [0.0, a.size[1], 0.0], ..*a };
    let near = |core| {
        nearest(
            &mut Convex::new(core),
            &mut Convex::new(b),
            0.0,
            precise_settings().effort,
            &mut Default::default(),
        )
    };
    a.kind == geom::CAPSULE && b.kind == geom::BOX && near(&core).is_some()
}

#[test]
fn rays_hit_where_they_do_in_mujoco() {
    let (text, print) = cases("rays.txt", include_str!("golden/rays.txt"));
    let assets = Assets::read(&text);
    let mut report = ToleranceReport::default();
    for (case, line) in text.lines().filter(|l| l.starts_with("ray ")).enumerate() {
        let (given, expected) = line.split_once('|').unwrap();
        let mut words = given.split_whitespace();
        words.next();
        let shape = assets.shape(&mut words);
        let v: Vec<f64> = words.map(|w| w.parse().unwrap()).collect();
        let hit = ray_shape(&shape, [v[0], v[1], v[2]], [v[3], v[4], v[5]], &mut 0);
        let got = hit.map_or([-1.0, 0.0, 0.0, 0.0], |h| [h.distance, h.normal[0], h.normal[1], h.normal[2]]);
        let name = KINDS[shape.kind as usize].to_string();
        report.note(
            name,
            case,
            difference(&got, &floats(expected)),
            1e-10,
            &format!("{line}\n    got {got:?}"),
        );
    }
    report.finish(print, &[]);
}

fn settings() -> PairSettings {
    PairSettings::from_model(&Model { opt: crate::model::Options::default(), ..Model::default() })
}

/// Settings with more iterations than the default of 35, which is not always enough for round bodies in deep
/// penetration.
fn precise_settings() -> PairSettings {
    let mut settings = settings();
    settings.effort.iterations = 300;
    settings
}

/// MuJoCo's search for round bodies stops within 1e-9 m. Distances have this accuracy; points and directions are
/// accurate to about its square root. (For bodies with corners only, both results are exact.)
const DEPTH: f64 = 1e-8;
const POINT: f64 = 2e-4;
/// Distances smaller than this mean that the bodies just touch, m.
const CLOSE: f64 = 1e-6;

/// Whether a shape is a polyhedron.
fn cornered(s: &Shape) -> bool {
    matches!(s.kind, geom::BOX | geom::MESH)
}

/// Whether the centres of two bodies coincide. MuJoCo then finds no contact, or a distance of zero, for convex
/// bodies.
fn concentric(a: &Shape, b: &Shape) -> bool {
    norm(sub(a.pos, b.pos)) < MINVAL
}

/// All points of a face or a line are equally near.
const FLAT: &str =
    "a face or a line that lies on a face: all of its points are as near, and each side names another";

const DISTANCES: &[AllowedCases] =
    &[("box-box fromto", &[1235], FLAT), ("capsule-cylinder fromto", &[829], FLAT)];

/// Distances of height fields are excluded. MuJoCo measures them with the margins of its contacts: for a maximum
/// distance of 1000 m, it reports 490 m of penetration for bodies of one metre. `tests/truth.rs` tests them.
#[test]
fn distances_are_those_of_mujoco() {
    let (text, print) = cases("pairs.txt", include_str!("golden/pairs.txt"));
    let assets = Assets::read(&text);
    let (mut report, mut figures) = (ToleranceReport::default(), Figures::default());
    let mut work = Narrow::default();
    for (case, line) in text.lines().filter(|l| l.starts_with("distance ")).enumerate() {
        let (given, expected) = line.split_once('|').unwrap();
        let mut words = given.split_whitespace();
        words.next();
        let (a, b) = (assets.shape(&mut words), assets.shape(&mut words));
        let most: f64 = words.next().unwrap().parse().unwrap();
        let (least, other) = if a.kind <= b.kind { (&a, &b) } else { (&b, &a) };
        let method = pair::method(least.kind, other.kind);
        let searched = matches!(method, Some(Method::Convex)) || least.kind == geom::BOX;
        if matches!(method, Some(Method::Field)) || searched && concentric(&a, &b) || pierced(least, other) {
            continue;
        }
        let found = super::distance::shape_distance(&a, &b, most, &precise_settings(), &mut work).unwrap();
        let [p, q] = found.fromto;
        let got = [found.dist, p[0], p[1], p[2], q[0], q[1], q[2]];
        let expected = floats(expected);
        let kinds = |a: &Shape, b: &Shape| format!("{}-{}", KINDS[a.kind as usize], KINDS[b.kind as usize]);
        let name = |end| format!("{} {end}", kinds(&a, &b));
        figures.distance(&kinds(least, other), expected[0], got[0]);
        let scale = 1.0 + norm(a.size).min(norm(b.size));
        let rendered = format!("{line}\n    got {got:?}");
        let exact = !searched || cornered(&a) && cornered(&b);
        let (depth, point) = if exact { (1e-10, 1e-7) } else { (DEPTH, POINT) };
        let error = difference(&got[..1], &expected[..1]);
        if searched && error > depth * scale && truth::is_true(&a, &b) {
            continue; // MuJoCo's search stopped before it converged.
        }
        report.note(name("dist"), case, error, depth * scale, &rendered);
        // For bodies that barely touch, the nearest points can be anywhere along the gap.
        if !searched || got[0].abs() > CLOSE {
            report.note(
                name("fromto"),
                case,
                difference(&got[1..], &expected[1..]),
                point * scale,
                &rendered,
            );
        }
    }
    write_table("distances.md", &figures.distance_table());
    report.finish(print, DISTANCES);
}

/// Two contacts at the same position, or one on the line between two others.
const TWICE: &str = "one side lists a point of the face or line twice: 1e-16 m apart, or between two others";

const CONTACTS: &[AllowedCases] = &[
    ("box-mesh number", &[1248], TWICE),
    ("capsule-cylinder number", &[829], TWICE),
    ("cylinder-box number", &[1134], TWICE),
    ("cylinder-cylinder number", &[1102], TWICE),
    ("cylinder-cylinder place", &[1104], FLAT),
    ("ellipsoid-ellipsoid place", &[935], "1e-9 m deep: the library's normal points the other way"),
    ("hfield-cylinder place", &[374], FLAT),
    ("hfield-ellipsoid place", &[356], "within the root of 1e-9 of a side of a prism: 4e-4"),
];

#[test]
#[expect(clippy::too_many_lines, reason = "one comparison of every recorded case")]
fn contacts_are_those_of_mujoco() {
    let (text, print) = cases("pairs.txt", include_str!("golden/pairs.txt"));
    let assets = Assets::read(&text);
    let (mut report, mut figures) = (ToleranceReport::default(), Figures::default());
    let mut work = Narrow::default();
    for (case, line) in text.lines().filter(|l| l.starts_with("contact ")).enumerate() {
        let (given, expected) = line.split_once('|').unwrap();
        let mut words = given.split_whitespace();
        words.next();
        let (a, b) = (assets.shape(&mut words), assets.shape(&mut words));
        let margin: f64 = words.next().unwrap().parse().unwrap();
        let method = pair::method(a.kind, b.kind).unwrap();
        let searched = !matches!(method, Method::Direct(_));
        if searched && concentric(&a, &b) {
            continue;
        }
        work.touches.clear();
        pair::contacts(method, &a, &b, margin, precise_settings, &mut work.convex, &mut work.touches);
        let mut got = Vec::new();
        for t in &work.touches {
            got.push(t.dist);
            got.extend(t.pos);
            got.extend(&frame_along(t.normal, t.tangent)[..6]);
        }
        let mut expected = floats(expected);
        if !searched {
            (expected, got) = (distinct(expected), distinct(got));
        }
        let kinds = format!("{}-{}", KINDS[a.kind as usize], KINDS[b.kind as usize]);
        // Contacts are compared as a set: their order depends on the method.
        got = in_order_of(&expected, &got);
        if pierced(&a, &b) {
            figures.contacts(&format!("{kinds}, axis in the box"), &expected, &got);
            continue;
        }
        figures.contacts(&kinds, &expected, &got);
        let scale = 1.0 + norm(a.size).min(norm(b.size));
        let rendered = format!("{line}\n    got {got:?}");
        if !searched {
            report.note(kinds, case, difference(&got, &expected), 1e-10 * scale, &rendered);
            continue;
        }
        let number = (got.len().abs_diff(expected.len()) / 10) as f64;
        report.note(format!("{kinds} number"), case, number, 0.5, &rendered);
        // MuJoCo's search from inside a prism of the height field ends too early if the other shape has corners,
        // because it treats all corners of the prism as the same one.
        let ends_early = a.kind == geom::HFIELD && matches!(b.kind, geom::BOX | geom::MESH);
        if number == 0.0 && !ends_early {
            let (dist, rest): (Vec<_>, Vec<_>) = got
                .chunks(10)
                .zip(expected.chunks(10))
                .map(|(g, w)| (difference(&g[..1], &w[..1]), difference(&g[1..], &w[1..])))
                .unzip();
            let most = |list: &[f64]| list.iter().copied().fold(0.0, f64::max);
            if most(&dist) > DEPTH * scale && a.kind != geom::HFIELD && truth::is_true(&a, &b) {
                continue; // MuJoCo's search stopped before it converged.
            }
            let exact = margin == 0.0 && cornered(&a) && cornered(&b);
            let (depth, point) = if exact { (1e-10, 1e-7) } else { (DEPTH, POINT) };
            report.note(format!("{kinds} dist"), case, most(&dist), depth * scale, &rendered);
            report.note(format!("{kinds} place"), case, most(&rest), point * scale, &rendered);
        }
    }
    write_table("contacts.md", &figures.contact_table());
    report.finish(print, CONTACTS);
}

/// Distances of random convex bodies do not depend on which one is first.
#[test]
fn distance_is_symmetric() {
    let (text, _) = cases("pairs.txt", include_str!("golden/pairs.txt"));
    let assets = Assets::read(&text);
    let mut work = Narrow::default();
    for line in text.lines().filter(|l| l.starts_with("distance ")).take(1000) {
        let mut words = line.split_whitespace();
        words.next();
        let (a, b) = (assets.shape(&mut words), assets.shape(&mut words));
        if a.kind < geom::SPHERE || b.kind < geom::SPHERE {
            continue;
        }
        let mut there = |a: &Shape, b: &Shape| {
            let (mut u, mut v) = (Convex::new(a), Convex::new(b));
            nearest(&mut u, &mut v, 1e3, settings().effort, &mut work.convex).map_or(f64::NAN, |n| n.dist)
        };
        let (x, y) = (there(&a, &b), there(&b, &a));
        assert!((x - y).abs() < 1e-5 * (1.0 + norm(a.size) + norm(b.size)), "{x} {y}: {line}");
    }
}

/// Sizes, poses and directions with arbitrary numbers cause no panic, no endless loop and no unbounded list.
#[test]
fn hostile_numbers_are_harmless() {
    let assets = Assets::read(include_str!("golden/pairs.txt"));
    let odd = [0.0, -1.0, 1e-300, 1e-9, 0.3, 1.0, 1e9, 1e300, f64::INFINITY, f64::NAN];
    let mut work = Narrow::default();
    let shape = |kind: usize, k: usize| {
        let number_at = |i: usize| odd[(k * (i + 1) + i) % odd.len()];
        let mat = if k.is_multiple_of(3) { EYE } else { std::array::from_fn(|i| number_at(i + k)) };
        let pos = if k.is_multiple_of(2) { [0.0; 3] } else { [number_at(3), number_at(4), number_at(5)] };
        let mut s = Shape::new(kind as i32, [number_at(0), number_at(1), number_at(2)], pos, mat);
        if s.kind == geom::MESH {
            s.mesh = Some(assets.mesh(["wedge", "prism", "stone"][k % 3]));
        }
        if s.kind == geom::HFIELD {
            let (head, samples) = assets.field.as_ref().unwrap();
            let size = [number_at(6), number_at(7), number_at(8), number_at(9)];
            s.field =
                Some(HeightField { size, nrow: head[0] as usize, ncol: head[1] as usize, data: samples });
        }
        s
    };
    for a in 0..8 {
        for b in a..8 {
            for k in 0..60 {
                let (first, second) = (shape(a, k), shape(b, k / 7 + 3 * k));
                let margin = odd[(k + 3) % odd.len()];
                super::distance::shape_distance(&first, &second, margin, &settings(), &mut work).unwrap();
                ray_shape(&first, second.pos, second.size, &mut 0);
                super::inside_shape(&first, second.pos);
                if let Some(method) = pair::method(first.kind, second.kind) {
                    work.touches.clear();
                    pair::contacts(
                        method,
                        &first,
                        &second,
                        margin,
                        settings,
                        &mut work.convex,
                        &mut work.touches,
                    );
                    // A height field with many prisms has at most as many contacts as MuJoCo keeps; two bodies have
                    // at most those of a face.
                    let most = if b == 1 || a == 1 { pair::MAX_CONTACTS } else { 8 };
                    assert!(work.touches.len() <= most, "{}-{}, {k}", KINDS[a], KINDS[b]);
                }
            }
        }
    }
}
