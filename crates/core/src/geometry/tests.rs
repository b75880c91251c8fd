//! Rays, distances and contacts against what MuJoCo 3.14.0 finds: `golden/record.py` recorded it.
//!
//! `LABSPEC_GEOMETRY` may name a folder with more cases than the repository keeps; then every pair's worst difference
//! is printed as well, and the tables of `docs/contacts.md` are written to `contacts.md` and `distances.md` in it.

mod figures;

use figures::Figures;
use std::collections::BTreeMap;

use super::convex::{Convex, nearest};
use super::pair::{self, Method, Settings};
use super::{Field, Hull, Mesh, Narrow, Shape, Sides, ray_shape};
use crate::math::*;
use crate::{Model, geom};

const KINDS: [&str; 8] = ["plane", "hfield", "sphere", "capsule", "ellipsoid", "cylinder", "box", "mesh"];

#[derive(Default)]
struct Assets {
    vert: BTreeMap<String, Vec<Vec3>>,
    face: BTreeMap<String, Vec<[i32; 3]>>,
    graph: BTreeMap<String, Vec<i32>>,
    sides: BTreeMap<String, Sides>,
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
                    let sides = Sides::of(&assets.mesh(name));
                    assets.sides.insert(name.into(), sides);
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
            hull: Hull::of(&self.graph[name]),
            sides: self.sides.get(name),
        }
    }

    /// The shape that the next words say.
    fn shape<'a>(&'a self, words: &mut std::str::SplitWhitespace<'_>) -> Shape<'a> {
        let kind = KINDS.iter().position(|k| Some(*k) == words.clone().next()).unwrap() as i32;
        words.next();
        let data = words.next().unwrap();
        let mut take = || words.next().unwrap().parse::<f64>().unwrap();
        let (size, pos) = ([take(), take(), take()], [take(), take(), take()]);
        let quat = quat_normalize([take(), take(), take(), take()]);
        let mut shape = Shape::new(kind, size, pos, quat_to_mat(quat));
        match kind {
            geom::MESH => shape.mesh = self.mesh(data),
            geom::HFIELD => {
                let (head, samples) = self.field.as_ref().unwrap();
                let size = [head[2], head[3], head[4], head[5]];
                shape.field = Field { size, nrow: head[0] as usize, ncol: head[1] as usize, data: samples };
            }
            _ => {}
        }
        shape
    }
}

/// The recorded cases: from the folder that the environment names, or those of the repository.
fn cases(file: &str, ours: &str) -> (String, bool) {
    match std::env::var("LABSPEC_GEOMETRY") {
        Ok(folder) => (std::fs::read_to_string(format!("{folder}/{file}")).unwrap(), true),
        Err(_) => (ours.to_string(), false),
    }
}

/// Writes a table beside the recordings that the environment names.
fn keep(file: &str, table: &str) {
    if let Ok(folder) = std::env::var("LABSPEC_GEOMETRY") {
        std::fs::write(format!("{folder}/{file}"), table).unwrap();
    }
}

/// Cases that are beyond the bound, and why that is no mistake: quantity or pair, numbers of the cases, reason. A case that
/// is not listed fails, and a listed one that is within the bound, too.
type Known = (&'static str, &'static [usize], &'static str);

/// Cases of one pair of types.
#[derive(Default)]
struct Cases {
    number: usize,
    /// Beyond the bound: number of the case, difference, what was given and found.
    beyond: Vec<(usize, f64, String)>,
    /// The largest difference of the others.
    worst: f64,
}

#[derive(Default)]
struct Report(BTreeMap<String, Cases>);

impl Report {
    fn note(&mut self, name: String, case: usize, difference: f64, bound: f64, line: &str) {
        let r = self.0.entry(name).or_default();
        r.number += 1;
        if difference.is_nan() || difference > bound {
            r.beyond.push((case, difference, line.to_string()));
        } else {
            r.worst = r.worst.max(difference);
        }
    }

    /// Fails where the cases beyond the bound are not those that are known; other recordings are printed alone.
    fn finish(self, print: bool, known: &[Known]) {
        let (mut text, mut wrong) = (String::new(), String::new());
        for (name, r) in &self.0 {
            let (number, worst) = (r.number, r.worst);
            text += &format!(
                "{name:24} {number:6} cases, {} beyond the bound, else within {worst:.1e}\n",
                r.beyond.len()
            );
            for (case, apart, line) in &r.beyond {
                if !known.iter().any(|(of, cases, _)| of == name && cases.contains(case)) {
                    wrong += &format!("{name}, case {case}: {apart:.1e} apart\n    {line}\n");
                }
            }
        }
        for (name, cases, _) in known {
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

/// Largest difference of two lists of numbers, infinite when their lengths differ.
fn difference(a: &[f64], b: &[f64]) -> f64 {
    if a.len() != b.len() {
        return f64::INFINITY;
    }
    let apart = a.iter().zip(b).map(|(x, y)| (x - y).abs());
    apart.fold(0.0, |m, d| if d.is_nan() { f64::INFINITY } else { m.max(d) })
}

/// The contacts of one list in the order of another, each next to the nearest that is left.
fn in_order_of(want: &[f64], got: &[f64]) -> Vec<f64> {
    let (want, mut left) = (rows::<10>(want), rows::<10>(got).to_vec());
    let mut out = Vec::new();
    for w in want {
        let far = |g: &[f64; 10]| difference(&g[1..4], &w[1..4]);
        let Some(k) = (0..left.len()).min_by(|&i, &j| far(&left[i]).total_cmp(&far(&left[j]))) else { break };
        out.extend(left.remove(k));
    }
    out.extend(left.into_iter().flatten());
    out
}

#[test]
fn rays_hit_where_they_do_in_mujoco() {
    let (text, print) = cases("rays.txt", include_str!("golden/rays.txt"));
    let assets = Assets::read(&text);
    let mut report = Report::default();
    for (case, line) in text.lines().filter(|l| l.starts_with("ray ")).enumerate() {
        let (given, want) = line.split_once('|').unwrap();
        let mut words = given.split_whitespace();
        words.next();
        let shape = assets.shape(&mut words);
        let v: Vec<f64> = words.map(|w| w.parse().unwrap()).collect();
        let hit = ray_shape(&shape, [v[0], v[1], v[2]], [v[3], v[4], v[5]]);
        let got = hit.map_or([-1.0, 0.0, 0.0, 0.0], |h| [h.distance, h.normal[0], h.normal[1], h.normal[2]]);
        let name = KINDS[shape.kind as usize].to_string();
        report.note(name, case, difference(&got, &floats(want)), 1e-10, &format!("{line}\n    got {got:?}"));
    }
    report.finish(print, &[]);
}

fn settings() -> Settings {
    Settings::of(&Model { opt: crate::Options::mujoco(), ..Model::default() })
}

/// `ccd_tolerance`, m.
const CLOSE: f64 = 1e-6;

/// What a search over round sides finds is known to its tolerance alone.
const SEARCHED: &str =
    "the search stops within `ccd_tolerance`, 1e-6 m: depths less than 5e-7 m apart, points 1e-3 m";
const LED_AWAY: &str = "a depth of 464 m between bodies of a metre means nothing on either side: the search from inside of a prism of the \
                        ground is led away";

const DISTANCES: &[Known] = &[
    ("cylinder-mesh dist", &[1182], SEARCHED),
    ("cylinder-mesh fromto", &[1182], SEARCHED),
    ("mesh-cylinder dist", &[1177], SEARCHED),
    ("mesh-cylinder fromto", &[1177], SEARCHED),
    (
        "cylinder-mesh fromto",
        &[1161],
        "a line lies along a face: all of its points are as near, and each side names another",
    ),
    ("ellipsoid-hfield dist", &[341], LED_AWAY),
    ("ellipsoid-hfield fromto", &[341], LED_AWAY),
];

#[test]
fn distances_are_those_of_mujoco() {
    let (text, print) = cases("pairs.txt", include_str!("golden/pairs.txt"));
    let assets = Assets::read(&text);
    let (mut report, mut figures) = (Report::default(), Figures::default());
    let mut work = Narrow::default();
    for (case, line) in text.lines().filter(|l| l.starts_with("distance ")).enumerate() {
        let (given, want) = line.split_once('|').unwrap();
        let mut words = given.split_whitespace();
        words.next();
        let (a, b) = (assets.shape(&mut words), assets.shape(&mut words));
        let most: f64 = words.next().unwrap().parse().unwrap();
        let found = super::distance::shape_distance(&a, &b, most, &settings(), &mut work);
        let [p, q] = found.fromto;
        let got = [found.dist, p[0], p[1], p[2], q[0], q[1], q[2]];
        let want = floats(want);
        let kinds = |a: &Shape, b: &Shape| format!("{}-{}", KINDS[a.kind as usize], KINDS[b.kind as usize]);
        let name = |end| format!("{} {end}", kinds(&a, &b));
        let (least, other) = if a.kind <= b.kind { (&a, &b) } else { (&b, &a) };
        figures.distance(&kinds(least, other), want[0], got[0]);
        let scale = 1.0 + norm(a.size).min(norm(b.size));
        let shown = format!("{line}\n    got {got:?}");
        // Nearer than the tolerance of the search, a distance is known to that, and its points are anywhere along the slit.
        let searched = matches!(pair::method(least.kind, other.kind), Some(Method::Convex));
        if searched && got[0].abs().max(want[0].abs()) < CLOSE {
            report.note(name("dist"), case, difference(&got[..1], &want[..1]), CLOSE, &shown);
            continue;
        }
        report.note(name("dist"), case, difference(&got[..1], &want[..1]), 1e-10 * scale, &shown);
        report.note(name("fromto"), case, difference(&got[1..], &want[1..]), 1e-7 * scale, &shown);
    }
    keep("distances.md", &figures.distance_table());
    report.finish(print, DISTANCES);
}

const CONTACTS: &[Known] = &[
    ("box-mesh", &[1248], "the library lists one point twice, 1e-16 m apart; ours once, 2e-8 m deeper"),
    (
        "cylinder-cylinder",
        &[1102],
        "faces that are parallel: tilted by 3e-7 as found here they touch in one point, not along two",
    ),
    (
        "hfield-cylinder",
        &[377],
        "one of 17 contacts, with a prism whose side the cylinder's round side meets: found within `ccd_tolerance`",
    ),
];

#[test]
fn contacts_are_those_of_mujoco() {
    let (text, print) = cases("pairs.txt", include_str!("golden/pairs.txt"));
    let assets = Assets::read(&text);
    let (mut report, mut figures) = (Report::default(), Figures::default());
    let mut work = Narrow::default();
    for (case, line) in text.lines().filter(|l| l.starts_with("contact ")).enumerate() {
        let (given, want) = line.split_once('|').unwrap();
        let mut words = given.split_whitespace();
        words.next();
        let (a, b) = (assets.shape(&mut words), assets.shape(&mut words));
        let margin: f64 = words.next().unwrap().parse().unwrap();
        let method = pair::method(a.kind, b.kind).unwrap();
        work.touches.clear();
        pair::contacts(method, &a, &b, margin, &settings(), &mut work.room, &mut work.touches);
        let mut got = Vec::new();
        for t in &work.touches {
            got.push(t.dist);
            got.extend(t.pos);
            got.extend(&crate::collision::frame_along(t.normal, t.tangent)[..6]);
        }
        let want = floats(want);
        let name = format!("{}-{}", KINDS[a.kind as usize], KINDS[b.kind as usize]);
        let bound = if matches!(method, Method::Direct(_)) { 1e-10 } else { 1e-7 };
        if !matches!(method, Method::Direct(_)) {
            got = in_order_of(&want, &got);
        }
        figures.contacts(&name, &want, &got);
        let scale = 1.0 + norm(a.size).min(norm(b.size));
        report.note(name, case, difference(&got, &want), bound * scale, &format!("{line}\n    got {got:?}"));
    }
    keep("contacts.md", &figures.contact_table());
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
            let (mut u, mut v) = (Convex::new(a, 0.0), Convex::new(b, 0.0));
            nearest(&mut u, &mut v, 1e3, settings().effort, &mut work.room).dist
        };
        let (x, y) = (there(&a, &b), there(&b, &a));
        assert!((x - y).abs() < 1e-5 * (1.0 + norm(a.size) + norm(b.size)), "{x} {y}: {line}");
    }
}

/// No size, pose or direction makes a panic, a hang or an endless list.
#[test]
fn hostile_numbers_are_harmless() {
    let assets = Assets::read(include_str!("golden/pairs.txt"));
    let odd = [0.0, -1.0, 1e-300, 1e-9, 0.3, 1.0, 1e9, 1e300, f64::INFINITY, f64::NAN];
    let mut work = Narrow::default();
    let shape = |kind: usize, k: usize| {
        let at = |i: usize| odd[(k * (i + 1) + i) % odd.len()];
        let mat = if k.is_multiple_of(3) { EYE } else { std::array::from_fn(|i| at(i + k)) };
        let pos = if k.is_multiple_of(2) { [0.0; 3] } else { [at(3), at(4), at(5)] };
        let mut s = Shape::new(kind as i32, [at(0), at(1), at(2)], pos, mat);
        if s.kind == geom::MESH {
            s.mesh = assets.mesh(["wedge", "prism", "stone"][k % 3]);
        }
        if s.kind == geom::HFIELD {
            let (head, samples) = assets.field.as_ref().unwrap();
            let size = [at(6), at(7), at(8), at(9)];
            s.field = Field { size, nrow: head[0] as usize, ncol: head[1] as usize, data: samples };
        }
        s
    };
    for a in 0..8 {
        for b in a..8 {
            for k in 0..60 {
                let (first, second) = (shape(a, k), shape(b, k / 7 + 3 * k));
                let margin = odd[(k + 3) % odd.len()];
                super::distance::shape_distance(&first, &second, margin, &settings(), &mut work);
                ray_shape(&first, second.pos, second.size);
                super::inside_shape(&first, second.pos);
                if let Some(method) = pair::method(first.kind, second.kind) {
                    work.touches.clear();
                    pair::contacts(
                        method,
                        &first,
                        &second,
                        margin,
                        &settings(),
                        &mut work.room,
                        &mut work.touches,
                    );
                    // Over a ground of many prisms as many as MuJoCo keeps; two bodies touch along a face at most.
                    let most = if b == 1 || a == 1 { pair::MOST } else { 8 };
                    assert!(work.touches.len() <= most, "{}-{}, {k}", KINDS[a], KINDS[b]);
                }
            }
        }
    }
}
