//! The geometry code is independent of scale. The tests multiply all lengths of every recorded case, and of some
//! additional ones, by powers of two from 6e-5 to 16384. Such a factor causes no rounding, so the result must be the
//! scaled result, bit for bit. A length that is compared with a quantity that is not a length, or a threshold that is
//! an absolute length, makes a test fail.

use super::*;

/// Powers of two: 2⁻¹⁴ is 6.1e-5, 2¹⁴ is 16384.
const POWERS: [i32; 6] = [-14, -10, -4, 5, 11, 14];

/// Additional shapes, for which thresholds once had the wrong dimension.
const MORE: &str = "\
distance capsule - 2.5 0.2 0 0 0 2.4 0.7071067811865476 0 0.7071067811865475 0 box - 0.1 0.1 0.1 0 0 0 1 0 0 0 1
distance capsule - 3 1 0 0.3 0.1 3.05 0.8 0.1 0.6 0 box - 0.2 0.1 0.1 0 0 0 1 0 0 0 1
distance capsule - 0.05 0.00008 0 0 0 0.09 1 0 0 0 capsule - 0.05 0.00009 0 0 0 0 0.7071067811865476 0.7071067811865475 0 0 1
distance capsule - 0.5 1 0 0 0 0.9 1 0 0 0 capsule - 0.5 1 0 0.6 0 0 1 0 0 0 1
distance sphere - 0.5 0 0 0.3 0.2 1.4 1 0 0 0 box - 1 1 1 0 0 0 1 0 0 0 1
";

fn assets_scaled(text: &str, by: f64) -> Assets {
    let mut assets = Assets::read(text);
    for list in assets.vert.values_mut() {
        *list = list.iter().map(|&v| scale(v, by)).collect();
    }
    // The hull faces are recomputed from the scaled vertices.
    let names: Vec<String> = assets.vert.keys().cloned().collect();
    for name in names {
        let mesh = assets.mesh(&name);
        let hull_faces =
            mesh.hull.map_or_else(HullFaces::default, |hull| HullFaces::from_hull(mesh.vert, &hull));
        assets.hull_faces.insert(name, hull_faces);
    }
    if let Some((head, _)) = &mut assets.field {
        head[2..].iter_mut().for_each(|x| *x *= by);
    }
    assets
}

fn scaled<'a>(s: Shape<'a>, by: f64) -> Shape<'a> {
    Shape { size: scale(s.size, by), pos: scale(s.pos, by), ..s }
}

fn settings_scaled(by: f64) -> PairSettings {
    let mut settings = precise_settings();
    settings.effort.tolerance *= by;
    settings
}

/// Contacts and distance of the two shapes in a line, with lengths divided by the scale.
fn answer(assets: &Assets, line: &str, by: f64) -> (Vec<ContactPoint>, Vec<f64>) {
    let given = line.split('|').next().unwrap();
    let mut words = given.split_whitespace();
    words.next();
    let (a, b) = (scaled(assets.shape(&mut words), by), scaled(assets.shape(&mut words), by));
    let margin = words.next().map_or(0.0, |w| w.parse::<f64>().unwrap());
    let (settings, mut work) = (settings_scaled(by), Narrow::default());
    let found = crate::geometry::shape_distance(&a, &b, margin.min(10.0) * by, &settings, &mut work).unwrap();
    let lengths = [found.dist].into_iter().chain(found.fromto.into_iter().flatten());
    let distance = lengths.map(|x| x / by).collect();
    work.touches.clear();
    let (first, second) = if a.kind <= b.kind { (&a, &b) } else { (&b, &a) };
    if let Some(method) = pair::method(first.kind, second.kind) {
        let near = margin.min(0.01) * by;
        pair::contacts(method, first, second, near, || settings, &mut work.convex, &mut work.touches);
    }
    let back = |t: &ContactPoint| ContactPoint { dist: t.dist / by, pos: scale(t.pos, 1.0 / by), ..*t };
    (work.touches.iter().map(back).collect(), distance)
}

#[test]
fn contacts_and_distances_scale_with_the_scene() {
    let text = include_str!("../golden/pairs.txt");
    let whole = assets_scaled(text, 1.0);
    let is_case = |l: &&str| l.starts_with("distance ") || l.starts_with("contact");
    let lines: Vec<&str> = text.lines().filter(is_case).step_by(2).chain(MORE.lines()).collect();
    assert!(lines.len() > 800, "{}", lines.len());
    let expected: Vec<_> = lines.iter().map(|line| answer(&whole, line, 1.0)).collect();
    let touching = expected.iter().filter(|(touches, _)| !touches.is_empty()).count();
    assert!(touching > 300, "{touching}");
    for power in POWERS {
        let by = 2f64.powi(power);
        let assets = assets_scaled(text, by);
        let mut wrong: BTreeMap<String, Vec<String>> = BTreeMap::new();
        for (line, expected) in lines.iter().zip(&expected) {
            let got = answer(&assets, line, by);
            if got != *expected && format!("{got:?}") != format!("{expected:?}") {
                let words: Vec<&str> = line.split_whitespace().collect();
                let kinds = format!("{} {}", words[1], words[13]);
                wrong.entry(kinds).or_default().push(format!("{line}\n  {expected:?}\n  {got:?}"));
            }
        }
        for (kinds, list) in &wrong {
            println!("2^{power} {kinds}: {}\n{}", list.len(), list[0]);
        }
        assert!(wrong.is_empty(), "2^{power}: {:?}", wrong.keys());
    }
}

#[test]
fn rays_scale_with_the_scene_and_with_their_direction() {
    let text = include_str!("../golden/rays.txt");
    let whole = Assets::read(text);
    let mut hits = 0;
    for power in POWERS {
        let by = 2f64.powi(power);
        let assets = assets_scaled(text, by);
        for line in text.lines().filter(|l| l.starts_with("ray ")) {
            let mut words = line.split('|').next().unwrap().split_whitespace();
            words.next();
            let mut again = words.clone();
            let (shape, large) = (whole.shape(&mut words), scaled(assets.shape(&mut again), by));
            let v: Vec<f64> = words.map(|w| w.parse().unwrap()).collect();
            let (from, along) = ([v[0], v[1], v[2]], [v[3], v[4], v[5]]);
            let expected = ray_shape(&shape, from, along, &mut 0);
            hits += usize::from(expected.is_some());
            for short in [1.0, 2f64.powi(-60), 2f64.powi(40)] {
                let got = ray_shape(&large, scale(from, by), scale(along, short), &mut 0);
                let got = got.map(|h| ray::Hit { distance: h.distance / by * short, ..h });
                assert_eq!(got, expected, "2^{power}, a direction of {short:e}: {line}");
            }
        }
    }
    assert!(hits > 300, "{hits}");
}

/// A capsule of any size lying on a box has two contacts, one at each end, with known depth.
#[test]
fn large_and_small_capsules_lie_on_boxes() {
    for power in [-14, -7, 0, 1, 2, 4, 7, 14] {
        let by = 2f64.powi(power);
        for thick in [0.01, 1.0, 30.0] {
            let lying = [0.0, 0.0, 1.0, 0.0, 1.0, 0.0, -1.0, 0.0, 0.0];
            let capsule = Shape::new(
                geom::CAPSULE,
                scale([thick, 0.5, 0.0], by),
                scale([0.0, 0.0, 1.0 + 0.5 * thick], by),
                lying,
            );
            let cuboid = Shape::new(geom::BOX, scale([1.0, 1.0, 1.0], by), [0.0; 3], EYE);
            let (mut scratch, mut touches) = (Default::default(), Vec::new());
            let Some(method) = pair::method(geom::CAPSULE, geom::BOX) else { panic!() };
            pair::contacts(method, &capsule, &cuboid, 0.0, settings, &mut scratch, &mut touches);
            assert_eq!(touches.len(), 2, "{by} {thick}");
            for t in touches {
                assert!(
                    (t.dist / by + 0.5 * thick).abs() < 1e-12 * (1.0 + thick)
                        && (t.normal[2] + 1.0).abs() < 1e-12,
                    "{t:?}"
                );
            }
        }
    }
}

/// Two crossing capsules have one contact, at the crossing, however short they are.
#[test]
fn short_capsules_cross() {
    for half in [1e-6, 1e-4, 1.0, 1e4] {
        let lying = [0.0, 0.0, 1.0, 0.0, 1.0, 0.0, -1.0, 0.0, 0.0];
        let upright = [1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, -1.0, 0.0];
        let size = [0.1 * half, half, 0.0];
        let a = Shape::new(geom::CAPSULE, size, [0.0; 3], lying);
        let b = Shape::new(geom::CAPSULE, size, scale([0.3, 0.4, 0.15], half), upright);
        let (mut scratch, mut touches) = (Default::default(), Vec::new());
        let Some(method) = pair::method(geom::CAPSULE, geom::CAPSULE) else { panic!() };
        pair::contacts(method, &a, &b, 0.0, settings, &mut scratch, &mut touches);
        let [t] = touches[..] else { panic!("{half}: {touches:?}") };
        assert!((t.dist / half + 0.05).abs() < 1e-12, "{half}: {t:?}");
        assert!(norm(sub(scale(t.pos, 1.0 / half), [0.3, 0.0, 0.075])) < 1e-12, "{half}: {t:?}");
    }
}
