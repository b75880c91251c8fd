use super::*;
use crate::geometry::convex::{Convex, ConvexScratch, Effort, nearest};
use crate::geometry::tests::Random;
use crate::kinds::geom;

impl Random {
    /// A random multiple of 1/4 between `from` / 4 and `to` / 4.
    fn step(&mut self, from: i32, to: i32) -> f64 {
        f64::from(from + (self.bits() % (to - from + 1) as u64) as i32) / 4.0
    }

    fn rotation(&mut self) -> Mat3 {
        quat_to_mat(quat_normalize(std::array::from_fn(|_| self.within(-1.0, 1.0))))
    }

    /// A random rotation that maps the coordinate axes to coordinate axes, with its axis 2 along an axis of the
    /// world.
    fn aligned(&mut self) -> Mat3 {
        let [x, y, z] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        let (a, b) = [(x, y), (y, z), (z, x), (y, x), (z, y), (x, z)][(self.bits() % 6) as usize];
        let c = cross(a, b);
        std::array::from_fn(|k| [a, b, c][k % 3][k / 3])
    }

    /// A capsule and a box. A quarter of them are aligned, on a grid, touching, or have a length of zero.
    fn capsule_and_box(&mut self) -> (Shape<'static>, Shape<'static>) {
        let unit = 10f64.powf(self.within(-2.0, 2.0));
        let (size, pos) = (self.vector(0.05, 1.0), self.vector(-2.0, 2.0));
        let mut capsule = Shape::new(geom::CAPSULE, size, pos, self.rotation());
        let mut cuboid = Shape::new(geom::BOX, self.vector(0.05, 1.0), [0.0; 3], EYE);
        match self.bits() % 16 {
            0 => capsule.mat = self.aligned(),
            1 | 2 => {
                capsule.mat = self.aligned();
                capsule.size[1] = self.step(0, 4);
                capsule.pos = std::array::from_fn(|_| self.step(-8, 8));
                cuboid.size = std::array::from_fn(|_| self.step(0, 4));
            }
            3 => {
                // One end of the axis is on the surface.
                let on = self.bits() as usize % 3;
                let end: Vec3 = std::array::from_fn(|i| {
                    if i == on { cuboid.size[i] } else { self.within(-1.5, 1.5) * cuboid.size[i] }
                });
                capsule.pos = add_scaled(end, capsule.axis(2), capsule.size[1]);
            }
            _ => {}
        }
        for shape in [&mut capsule, &mut cuboid] {
            shape.size = scale(shape.size, unit);
            shape.pos = scale(shape.pos, unit);
        }
        // In half of the cases both shapes are rotated together.
        if self.bits().is_multiple_of(2) {
            let turn = self.rotation();
            capsule.mat = mat_mul(&turn, &capsule.mat);
            capsule.pos = mat_mul_vec(&turn, capsule.pos);
            cuboid.mat = turn;
        }
        (capsule, cuboid)
    }
}

/// The smallest distance of the axis from the box: dense sampling, then golden-section search around the best sample.
fn least_distance(capsule: &Shape, cuboid: &Shape) -> f64 {
    let distance = |t: f64| {
        let p = cuboid.local(add_scaled(capsule.pos, capsule.axis(2), t * capsule.size[1]));
        let beyond: Vec3 = std::array::from_fn(|i| (p[i].abs() - cuboid.size[i]).max(0.0));
        norm(beyond)
    };
    const SAMPLES: i32 = 32;
    let parameter_at = |k: i32| f64::from(2 * k) / f64::from(SAMPLES) - 1.0;
    let best = (0..=SAMPLES)
        .min_by(|&a, &b| distance(parameter_at(a)).total_cmp(&distance(parameter_at(b))))
        .unwrap_or(0);
    let (mut a, mut b) = (parameter_at((best - 1).max(0)), parameter_at((best + 1).min(SAMPLES)));
    let golden = 0.5 * (5f64.sqrt() - 1.0);
    let mut least = distance(parameter_at(best));
    for _ in 0..80 {
        let (c, d) = (b - golden * (b - a), a + golden * (b - a));
        let (x, y) = (distance(c), distance(d));
        least = least.min(x).min(y);
        if x < y { b = d } else { a = c }
    }
    least
}

#[test]
fn the_first_ball_is_nearest() {
    let mut random = Random(1);
    let (mut outside, mut pierced) = (0, 0);
    for n in 0..100_000 {
        let (capsule, cuboid) = random.capsule_and_box();
        let least = least_distance(&capsule, &cuboid);
        let scale = norm(capsule.pos) + norm(capsule.size) + norm(cuboid.size);
        if least < 1e-12 * scale {
            pierced += 1;
            continue;
        }
        outside += 1;
        let mut out = vec![];
        capsule_box(&capsule, &cuboid, f64::INFINITY, &mut out);
        let first = out.first().map_or(f64::NAN, |touch| touch.dist + capsule.size[0]);
        assert!((first - least).abs() < 1e-9 * scale, "{n}: {first} {least} {capsule:?} {cuboid:?}");
        assert!(out.len() <= 2 && out.iter().all(|touch| touch.dist >= out[0].dist - 1e-9 * scale));
    }
    assert!(outside > 50_000 && pierced > 5_000, "{outside} {pierced}");
}

/// The reference is the general algorithm for convex shapes, which shares no code with this one.
#[test]
fn a_pierced_box_is_parted_by_the_least_translation() {
    let (mut random, mut scratch) = (Random(3), ConvexScratch::default());
    let effort = Effort { tolerance: 1e-12, iterations: 300 };
    let mut pierced = [0; 2];
    for n in 0..100_000 {
        let (capsule, cuboid) = random.capsule_and_box();
        let scale = norm(capsule.pos) + norm(capsule.size) + norm(cuboid.size);
        let core = Shape { size: [0.0, capsule.size[1], 0.0], ..capsule };
        let found = nearest(&mut Convex::new(&core), &mut Convex::new(&cuboid), 0.0, effort, &mut scratch);
        let Some(depth) = found.map(|n| -n.dist).filter(|depth| *depth > 1e-9 * scale) else { continue };
        let mut out = vec![];
        capsule_box(&capsule, &cuboid, 0.0, &mut out);
        let deepest = out.iter().map(|c| -c.dist - capsule.size[0]).fold(f64::NEG_INFINITY, f64::max);
        assert!((deepest - depth).abs() < 1e-9 * scale, "{n}: {deepest} {depth} {capsule:?} {cuboid:?}");
        for c in &out {
            let [on_capsule, on_box] = [-0.5, 0.5].map(|s| add_scaled(c.pos, c.normal, s * c.dist));
            let line = axis_of(&capsule);
            let round = norm(sub(on_capsule, line.at(line.closest_to(on_capsule))));
            assert!(round < capsule.size[0] + 1e-9 * scale, "{n}: {c:?} {capsule:?} {cuboid:?}");
            let local = cuboid.local(on_box);
            let beyond = (0..3).map(|i| local[i].abs() - cuboid.size[i]).fold(f64::NEG_INFINITY, f64::max);
            assert!(beyond.abs() < 1e-9 * scale, "{n}: {c:?} {capsule:?} {cuboid:?}");
        }
        pierced[usize::from(out.len() > 1)] += 1;
    }
    println!("{pierced:?} with one and with two contacts");
    assert!(pierced.iter().all(|&n| n > 2_000), "{pierced:?}");
}

fn axis_of(capsule: &Shape) -> Segment {
    Segment { centre: capsule.pos, half: scale(capsule.axis(2), capsule.size[1]) }
}

#[test]
fn any_numbers_cause_no_panic() {
    let mut random = Random(2);
    let odd = [0.0, -0.0, 1.0, -1.0, 1e-300, 1e300, -1e300, f64::INFINITY, f64::NEG_INFINITY, f64::NAN];
    for _ in 0..200_000 {
        let (mut capsule, mut cuboid) = random.capsule_and_box();
        for _ in 0..=random.bits() % 3 {
            let shape = if random.bits().is_multiple_of(2) { &mut capsule } else { &mut cuboid };
            let x = odd[random.bits() as usize % odd.len()];
            match random.bits() as usize % 15 {
                k @ 0..3 => shape.size[k] = x,
                k @ 3..6 => shape.pos[k - 3] = x,
                k => shape.mat[k - 6] = x,
            }
        }
        let mut out = vec![];
        for margin in [0.0, f64::INFINITY, f64::NAN] {
            capsule_box(&capsule, &cuboid, margin, &mut out);
            sphere_box(&capsule, &cuboid, margin, &mut out);
        }
        assert!(out.len() <= 9);
        assert!(out.iter().all(|touch| !touch.dist.is_nan()));
    }
}
