//! Contacts, ray hits and distances of a scaled scene, for every pair of geom types, at scales from 6e-5 to 16384. Scales are
//! powers of two, so that the scaled result equals the result of the original scene bit for bit.

use crate::math::{Vec3, scale};
use crate::mjcf::compile;
use crate::model::{Contact, Fields, Model};
use crate::query::{RayFilter, geom_distance, ray};
use crate::step::forward;
use crate::step::workspace::Workspace;

const SCENE: &str = "<mujoco><asset><mesh name='m' vertex='0 0 0 1 0 0 0 1 0 0 0 1 .8 .7 .9' scale='.5 .5 .5'/>
    <hfield name='h' nrow='3' ncol='3' size='2 2 .4 .2' elevation='0 1 0 2 3 1 0 1 2'/></asset>
    <worldbody><geom type='plane' size='5 5 1' pos='0 0 -.1'/><geom type='hfield' hfield='h' pos='0 0 -.2' contype='2' conaffinity='2'/>
    GEOMS</worldbody></mujoco>";
const KINDS: [&str; 6] = [
    "type='sphere' size='.3'",
    "type='capsule' size='.2 .3'",
    "type='ellipsoid' size='.3 .2 .4'",
    "type='cylinder' size='.25 .3'",
    "type='box' size='.2 .3 .25'",
    "type='mesh' mesh='m'",
];

/// Two geoms of each type, rotated, so close that every pair of types touches somewhere.
fn scene(turn: f64) -> Model {
    let geom = |(i, kind): (usize, &&str)| {
        let k = i as f64;
        let (x, y, z) = (0.35 * (k % 3.0) - 0.3, 0.3 * (k / 3.0).floor() - 0.5, 0.15 + 0.12 * (k % 4.0));
        let euler = [40.0 * turn * k, 25.0 * turn + k, 70.0 * turn];
        format!(
            "<body pos='{x} {y} {z}' euler='{} {} {}'><freejoint/><geom {kind} margin='{}' contype='3' conaffinity='3'/></body>",
            euler[0],
            euler[1],
            euler[2],
            if i % 5 == 1 { 0.01 } else { 0.0 }
        )
    };
    let geoms: String = KINDS.iter().chain(&KINDS).enumerate().map(geom).collect();
    compile(&SCENE.replace("GEOMS", &geoms)).unwrap()
}

/// The model and its data with every length of the geometry multiplied by `by`.
fn scaled(m: &Model, d: &Fields, by: f64) -> (Model, Workspace) {
    let mut large = m.clone();
    let lists = [&mut large.geom_size, &mut large.geom_rbound, &mut large.geom_margin, &mut large.geom_gap];
    lists.into_iter().chain([&mut large.mesh_vert, &mut large.hfield_size]).flatten().for_each(|x| *x *= by);
    large.opt.ccd_tolerance *= by;
    let mut scaled = Workspace::new(&large);
    let Workspace { fields: there, scratch: s } = &mut scaled;
    there.geom_xpos.iter_mut().zip(&d.geom_xpos).for_each(|(x, &y)| *x = by * y);
    there.geom_xmat.copy_from_slice(&d.geom_xmat);
    forward::contacts(&large, there, s);
    (large, scaled)
}

fn back(c: &Contact, by: f64) -> (f64, Vec3, [f64; 9], f64, [usize; 2]) {
    (c.dist / by, scale(c.pos, 1.0 / by), c.frame, c.includemargin / by, [c.geom1, c.geom2])
}

#[test]
fn whole_scenes_scale() {
    let mut kinds = std::collections::BTreeSet::new();
    let mut hits = 0;
    for turn in [0.0, 0.3, 1.0, 1.7] {
        let m = scene(turn);
        let Workspace { fields: mut d, scratch: mut s } = Workspace::new(&m);
        forward::forward(&m, &mut d, &mut s);
        let (_, Workspace { fields: unit, scratch: unit_scratch }) = scaled(&m, &d, 1.0);
        kinds.extend(unit.contact.iter().map(|c| [m.geom_type[c.geom1], m.geom_type[c.geom2]]));
        for power in [-14, -9, -3, 4, 10, 14] {
            let by = 2f64.powi(power);
            let (large, Workspace { fields: mut there, scratch: mut s }) = scaled(&m, &d, by);
            assert_eq!(there.contact.len(), unit.contact.len(), "2^{power}");
            for (got, expected) in there.contact.iter().zip(&unit.contact) {
                assert_eq!(back(got, by), back(expected, 1.0), "2^{power}");
            }
            for k in 0..40 {
                let angle = f64::from(k);
                let (from, along) =
                    ([angle.sin(), angle.cos(), 1.5], [-angle.sin(), 0.3 - angle.cos(), -1.0]);
                let expected = ray(&m, &unit, from, along, &RayFilter::default());
                let got = ray(&large, &there, scale(from, by), scale(along, 1e-12), &RayFilter::default());
                hits += usize::from(expected.is_some());
                assert_eq!(got.map(|h| h.geom), expected.map(|h| h.geom), "2^{power}, ray {k}");
                if let (Some(got), Some(expected)) = (got, expected) {
                    let difference = got.distance * 1e-12 / by / expected.distance - 1.0;
                    assert!(difference.abs() < 1e-12, "2^{power}, ray {k}: {difference}");
                }
            }
            for a in 0..m.ngeom {
                for b in 0..m.ngeom {
                    let expected = geom_distance(
                        &m,
                        &mut unit.clone(),
                        &mut unit_scratch.clone().sensor.narrow,
                        [a, b],
                        3.0,
                    )
                    .unwrap();
                    let got =
                        geom_distance(&large, &mut there, &mut s.sensor.narrow, [a, b], 3.0 * by).unwrap();
                    assert_eq!(got.dist / by, expected.dist, "2^{power}: {a} {b}");
                    let points = got.fromto.map(|p| scale(p, 1.0 / by));
                    assert_eq!(points, expected.fromto, "2^{power}: {a} {b}");
                }
            }
        }
    }
    assert!(hits > 500, "{hits}");
    // Nearly all pairs of the six types, and each type with the plane and with the height field.
    assert!(kinds.len() >= 28, "{kinds:?}");
}
