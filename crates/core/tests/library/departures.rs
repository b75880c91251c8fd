//! Intentional differences from MuJoCo 3.14.0. `docs/measured/parity.md` contains the cases and figures.

use labspec_core::xml::compile;
use labspec_core::{self as core, Data, Model};

pub(crate) fn at(m: &Model, qpos: &[f64], qvel: &[f64]) -> Data {
    let mut d = Data::new(m);
    d.edit().qpos.copy_from_slice(qpos);
    d.edit().qvel.copy_from_slice(qvel);
    core::forward(m, &mut d).unwrap();
    d
}

/// The velocity of actuator 0, and the time derivative of its length by central differences.
fn speeds(m: &Model, qpos: &[f64], qvel: &[f64]) -> [f64; 2] {
    let h = 1e-6;
    let length = |by: f64| {
        let mut moved = qpos.to_vec();
        core::integrate_pos(m, &mut moved, qvel, by).unwrap();
        at(m, &moved, qvel).actuator_length[0]
    };
    [at(m, qpos, qvel).actuator_velocity[0], (length(h) - length(-h)) / (2.0 * h)]
}

/// The time derivative of the length of a rotation between sites is the velocity of the actuator: for any motion if the sites
/// have the same orientation, and at any angle if they rotate about one axis.
#[test]
fn lengths_of_rotations_change_at_their_velocity() {
    let axis = |turned: &str, gear: &str| {
        format!(
            "<mujoco><worldbody><body><joint type='ball'/><geom size='.1'/><site name='r' euler='{turned}'/>
             <body><joint axis='1 2 3'/><geom size='.1'/><site name='s' euler='{turned}'/></body></body></worldbody>
             <actuator><motor site='s' refsite='r' gear='0 0 0 {gear}'/></actuator></mujoco>"
        )
    };
    for (turned, gear) in [("0 0 0", "1 0 0"), ("20 30 40", ".3 .5 .7"), ("90 0 -35", "0 1 -2")] {
        let m = compile(&axis(turned, gear)).unwrap();
        for angle in [-2.0, -0.5, 0.1, 1.0, 3.0] {
            let q = [0.8, 0.4, -0.4, 0.2, angle];
            let [velocity, slope] = speeds(&m, &q, &[0.7, -0.4, 0.9, 1.3]);
            assert!((velocity - slope).abs() < 1e-8, "{turned} at {angle}: {velocity}, {slope}");
            assert!(velocity.abs() > 0.05);
        }
    }
    // Both bodies rotate freely. The sites, which have different orientations in their bodies, have the same orientation in the
    // world.
    let m = compile(
        "<mujoco><worldbody><body><joint type='ball'/><geom size='.1'/><site name='r' euler='20 30 40'/></body>
         <body><joint type='ball'/><geom size='.1'/><site name='s' quat='1 0 0 0'/></body></worldbody>
         <actuator><motor site='s' refsite='r' gear='0 0 0 .3 .5 .7'/></actuator></mujoco>",
    )
    .unwrap();
    // The second body has the orientation of the reference site, which is computed by a forward pass.
    let q = [0.8, 0.4, -0.4, 0.2];
    let d = at(&m, &[q, [1.0, 0.0, 0.0, 0.0]].concat(), &[0.0; 6]);
    let mat = &d.site_xmat[..9];
    let w = 0.5 * (1.0 + mat[0] + mat[4] + mat[8]).sqrt();
    let same =
        [w, (mat[7] - mat[5]) / (4.0 * w), (mat[2] - mat[6]) / (4.0 * w), (mat[3] - mat[1]) / (4.0 * w)];
    let [velocity, slope] = speeds(&m, &[q, same].concat(), &[0.7, -0.4, 0.9, -0.2, 1.1, 0.6]);
    assert!((velocity - slope).abs() < 1e-8 && velocity.abs() > 0.05, "{velocity}, {slope}");
}

/// The projection of a site is its position in the image, which is shifted by the principal point. MuJoCo's sensor ignores the
/// principal point.
#[test]
fn projections_use_the_principal_point() {
    let pixel = |optics: &str| {
        let m = compile(&format!(
            "<mujoco><worldbody><site name='s' pos='.1 .2 0'/><body><joint/><geom size='.1'/></body>
             <camera name='c' pos='0 0 1' resolution='640 480' sensorsize='0.008 0.006' {optics}/></worldbody>
             <sensor><camprojection site='s' camera='c'/></sensor></mujoco>"
        ))
        .unwrap();
        at(&m, &[0.0], &[0.0]).sensordata.clone()
    };
    // MuJoCo's value for all four, recorded: 399.999993896484 80.
    let cases = [
        ("focal='0.01 0.01'", [400.0, 80.0]),
        ("focal='0.01 0.01' principal='0.001 0.0005'", [320.0, 40.0]),
        ("focal='0.01 0.01' principal='-0.001 0.0005'", [480.0, 40.0]),
        ("focalpixel='800 800' principalpixel='80 40'", [320.0, 40.0]),
    ];
    for (optics, expected) in cases {
        let found = pixel(optics);
        let near = found.iter().zip(expected).all(|(x, y)| (x - y).abs() < 1e-4);
        assert!(near, "{optics}: {found:?}, not {expected:?}");
    }
}

const FUSED: &str = "<mujoco><compiler fusestatic='true'/><worldbody><body name='a'><joint name='ja'/>
    <geom name='g0' size='.1'/><site name='s0'/><camera name='c0'/>
    <body><geom name='g1' size='.1'/><site name='s1'/><camera name='c1'/>
      <body name='b'><joint name='jb'/><geom name='g2' size='.1'/><site name='s2'/><camera name='c2'/></body></body>
    <geom name='g3' size='.1'/><site name='s3'/><camera name='c3'/>
    <body name='c'><joint name='jc'/><geom name='g4' size='.1'/><site name='s4'/><camera name='c4'/></body>
    <body><geom name='g5' size='.1'/><site name='s5'/><camera name='c5'/></body></body></worldbody>
    <tendon><spatial><site site='s1'/><geom geom='g5' sidesite='s2'/><site site='s4'/></spatial></tendon>
    <actuator><motor site='s5' refsite='s1'/><motor site='s4'/><adhesion body='c' ctrlrange='0 1'/></actuator>
    <equality><connect site1='s1' site2='s4'/><connect body1='b' body2='c' anchor='0 0 0'/></equality>
    <contact><pair geom1='g1' geom2='g4'/><pair geom1='g5' geom2='g2'/><exclude body1='b' body2='c'/></contact>
    <sensor><framepos objtype='site' objname='s2'/><framepos objtype='site' objname='s4'/><framepos objtype='site' objname='s5'/>
    <framepos objtype='geom' objname='g2'/><framepos objtype='geom' objname='g5'/>
    <framepos objtype='camera' objname='c2'/><framepos objtype='camera' objname='c5'/>
    <framepos objtype='body' objname='c' reftype='site' refname='s5'/><camprojection site='s1' camera='c5'/></sensor>
    <custom><tuple name='t'><element objtype='site' objname='s4'/><element objtype='geom' objname='g5'/></tuple></custom></mujoco>";

/// After bodies are fused, references by name still refer to the same object. In MuJoCo, they refer to the object with the
/// previous index.
#[test]
fn numbers_after_fused_bodies() {
    // The projection of a camera requires an image resolution.
    let m = compile(&FUSED.replace("camera name='c5'", "camera name='c5' resolution='64 48'")).unwrap();
    let name = |kind: core::Obj, id: i32| m.name_of(kind, id as usize).unwrap_or_default().to_string();
    let names = |kind: core::Obj, ids: &[i32]| ids.iter().map(|&id| name(kind, id)).collect::<Vec<_>>();
    use core::Obj::{Body, Camera, Geom, Site};
    assert_eq!(names(Site, &m.sensor_objid[..3]), ["s2", "s4", "s5"]);
    assert_eq!(names(Geom, &m.sensor_objid[3..5]), ["g2", "g5"]);
    assert_eq!(names(Camera, &m.sensor_objid[5..7]), ["c2", "c5"]);
    assert_eq!((name(Body, m.sensor_objid[7]), name(Site, m.sensor_refid[7])), ("c".into(), "s5".into()));
    assert_eq!((name(Site, m.sensor_objid[8]), name(Camera, m.sensor_refid[8])), ("s1".into(), "c5".into()));
    assert_eq!(
        name(Site, m.wrap_objid[0]) + &name(Geom, m.wrap_objid[1]) + &name(Site, m.wrap_objid[2]),
        "s1g5s4"
    );
    assert_eq!(name(Site, m.wrap_prm[1] as i32), "s2");
    assert_eq!(
        names(Site, &[m.actuator_trnid[0], m.actuator_trnid[1], m.actuator_trnid[2]]),
        ["s5", "s1", "s4"]
    );
    assert_eq!(name(Body, m.actuator_trnid[4]), "c");
    assert_eq!([name(Site, m.eq_obj1id[0]), name(Site, m.eq_obj2id[0])], ["s1", "s4"]);
    assert_eq!([name(Body, m.eq_obj1id[1]), name(Body, m.eq_obj2id[1])], ["b", "c"]);
    assert_eq!([name(Site, m.tuple_objid[0]), name(Geom, m.tuple_objid[1])], ["s4", "g5"]);
    let mut pairs: Vec<_> =
        m.pair_geom1.iter().zip(&m.pair_geom2).map(|(&a, &b)| name(Geom, a) + &name(Geom, b)).collect();
    pairs.sort();
    assert!(pairs == ["g1g4", "g5g2"] || pairs == ["g1g4", "g2g5"], "{pairs:?}");
    assert_eq!((m.exclude_signature[0] >> 16, m.exclude_signature[0] & 0xffff), (2, 3));
}

/// A deterministic source of numbers from -1 to 1.
fn noise() -> impl FnMut() -> f64 {
    let mut state = 0x2545_f491_4f6c_dd1d_u64;
    move || {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        (state >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }
}

fn rotate(q: [f64; 4], [x, y, z]: [f64; 3]) -> [f64; 3] {
    let [w, a, b, c] = q;
    let t = [2.0 * (b * z - c * y), 2.0 * (c * x - a * z), 2.0 * (a * y - b * x)];
    [
        x + w * t[0] + b * t[2] - c * t[1],
        y + w * t[1] + c * t[0] - a * t[2],
        z + w * t[2] + a * t[1] - b * t[0],
    ]
}

/// The orientation of the principal axes of a body with one mesh.
fn axes(vertices: &[[f64; 3]]) -> [f64; 4] {
    let text: Vec<String> = vertices.iter().flatten().map(|x| format!("{x:?}")).collect();
    let m = compile(&format!(
        "<mujoco><asset><mesh name='m' vertex='{}'/></asset><worldbody><body><freejoint/><geom type='mesh' mesh='m'/></body></worldbody></mujoco>",
        text.join(" ")
    ))
    .unwrap();
    [m.body_iquat[4], m.body_iquat[5], m.body_iquat[6], m.body_iquat[7]]
}

/// For a mesh with equal moments, the principal axes are not unique. Perturbations of the vertices by single-precision rounding
/// do not select other axes: for any rotation of the mesh, its axes stay the same within 1e-5 rad.
#[test]
fn axes_of_symmetric_meshes_are_stable() {
    let prism = |half: f64| -> Vec<[f64; 3]> {
        let corner = |k: usize| {
            let (s, c) = (std::f64::consts::PI * (k / 2) as f64 / 6.0).sin_cos();
            [0.1 * c, 0.1 * s, if k.is_multiple_of(2) { -half } else { half }]
        };
        (0..24).map(corner).collect()
    };
    let cube: Vec<[f64; 3]> =
        (0..8).map(|k| [0, 1, 2].map(|i| if k >> i & 1 == 1 { 0.1 } else { -0.1 })).collect();
    let mut random = noise();
    for (what, vertices) in [("cube", cube), ("long prism", prism(0.2)), ("disc", prism(0.04))] {
        let mut worst = 0.0_f64;
        for _ in 0..100 {
            let q: [f64; 4] = std::array::from_fn(|_| random());
            let n = q.iter().map(|x| x * x).sum::<f64>().sqrt();
            let q = q.map(|x| x / n);
            let here: Vec<[f64; 3]> = vertices.iter().map(|v| rotate(q, *v)).collect();
            let moved: Vec<[f64; 3]> = here.iter().map(|v| v.map(|x| x + 1e-8 * random())).collect();
            let (a, b) = (axes(&here), axes(&moved));
            let cos = a.iter().zip(b).map(|(x, y)| x * y).sum::<f64>().abs().min(1.0);
            worst = worst.max(2.0 * cos.acos());
        }
        println!("{what}: {worst:e} rad");
        assert!(worst < 1e-5, "{what}: {worst} rad");
    }
}

/// Two bodies of 2,000 ellipsoids each, and thirteen sensors of their distance. A pair that the bounding spheres exclude costs
/// one comparison. Every comparison is counted as work.
#[test]
fn distances_of_large_bodies_are_counted() {
    let side = |z: f64| -> String {
        let geom = |i: usize| {
            let (x, y) = (0.25 * (i % 45) as f64, 0.25 * (i / 45) as f64);
            format!("<geom type='ellipsoid' size='.1 .08 .12' pos='{x} {y} {z}'/>")
        };
        (0..2000).map(geom).collect()
    };
    let m = compile(&format!(
        "<mujoco><worldbody><body name='a'><freejoint/>{}</body><body name='b' pos='0 0 1'><freejoint/>{}</body></worldbody>
         <sensor>{}</sensor></mujoco>",
        side(0.0),
        side(0.0),
        "<distance body1='a' body2='b' cutoff='10'/>".repeat(13)
    ))
    .unwrap();
    let mut d = Data::new(&m);
    core::step(&m, &mut d).unwrap();
    assert!((d.sensordata[12] - 0.76).abs() < 1e-9, "{:?}", d.sensordata);
    assert!(core::cost(&d) > 13 * 2000 * 2000, "{}", core::cost(&d));
}

/// The cells of a height field below a shape are counted as work, whether the shape touches them or not.
#[test]
fn cells_of_height_fields_are_counted() {
    let work = |samples: usize| {
        let m = compile(&format!(
            "<mujoco><asset><hfield name='h' nrow='{samples}' ncol='{samples}' size='1 1 .1 .1'/></asset><worldbody>
             <geom type='hfield' hfield='h'/><body pos='0 0 .45'><freejoint/><geom type='box' size='.9 .9 .5'/></body></worldbody></mujoco>"
        ))
        .unwrap();
        let mut d = Data::new(&m);
        core::forward(&m, &mut d).unwrap();
        assert!(d.ncon > 0);
        let above = {
            d.edit().qpos[2] = 0.55;
            let before = core::cost(&d);
            core::forward(&m, &mut d).unwrap();
            assert_eq!(d.ncon, 0);
            core::cost(&d) - before
        };
        (core::cost(&d), above)
    };
    let ((few, low), (many, high)) = (work(11), work(101));
    assert!(many > few && high > low, "{few} {many} {low} {high}");
}
