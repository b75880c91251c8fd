//! Properties of the broad phase: its result does not depend on the method.

use super::*;
use crate::dynamics::kinematics;
use crate::model::Contact;
use crate::step::reset::reset_data;
use crate::step::workspace::Workspace;
use crate::tests::compile;

/// Free bodies of random shapes in a cube, above a plane. The shapes replace compiled spheres.
fn pile(bodies: usize, side: f64) -> Model {
    let mut random = random(0x2545_f491_4f6c_dd1d);
    let mut xml = String::from("<mujoco><worldbody><geom type='plane' size='1 1 1'/>");
    for _ in 0..bodies {
        let [x, y, z] = [(); 3].map(|()| side * random());
        xml += &format!("<body pos='{x} {y} {z}' euler='{x} {y} {z}'><freejoint/><geom size='.1'/>");
        xml += "<geom size='.1' pos='.1 0 0' margin='.02'/></body>";
    }
    let mut m = compile(&(xml + "</worldbody></mujoco>")).unwrap();
    for g in 1..m.ngeom {
        m.geom_type[g] = [geom::SPHERE, geom::CAPSULE, geom::ELLIPSOID, geom::CYLINDER, geom::BOX][g % 5];
        let size = [0.05 + 0.1 * random(), 0.05 + 0.1 * random(), 0.05 + 0.1 * random()];
        rows_mut::<3>(&mut m.geom_size)[g] = size;
        m.geom_rbound[g] = match m.geom_type[g] {
            geom::SPHERE => size[0],
            geom::CAPSULE => size[0] + size[1],
            _ => norm(size),
        };
    }
    m
}

/// Contacts found with the list of all pairs, or with the sweep.
fn contacts(m: &Model, sweep: bool) -> Vec<Contact> {
    let Workspace { fields: mut d, scratch: mut s } = Workspace::unplanned(m);
    reset_data(m, &mut d, &mut s);
    s.collision.pairs = pairs(m, Changes::default());
    if sweep {
        s.collision.pairs =
            CandidatePairs { sweep: Some(Box::new(Sweep::new(m, false))), ..CandidatePairs::default() };
    }
    kinematics(m, &mut d, &mut s.dynamics);
    // Two runs: the second one starts with the order of the first.
    for _ in 0..2 {
        collide(m, &mut d, &mut s.collision);
    }
    d.contact
}

#[test]
fn the_sweep_finds_the_pairs_of_the_list() {
    for (bodies, side) in [(5, 0.3), (20, 0.6), (40, 1.5)] {
        let m = pile(bodies, side);
        let (list, sweep) = (contacts(&m, false), contacts(&m, true));
        assert!(list.len() > bodies, "{}", list.len());
        assert_eq!(list, sweep);
    }
}

/// Contacts are ordered by bodies, then by geoms in the order of their types.
#[test]
fn contacts_are_in_order() {
    let m = pile(40, 1.0);
    let keys: Vec<_> = contacts(&m, true)
        .iter()
        .map(|c| {
            let (a, b) = (m.geom_bodyid[c.geom1], m.geom_bodyid[c.geom2]);
            (a.min(b), a.max(b), c.geom1, c.geom2)
        })
        .collect();
    assert!(keys.is_sorted(), "{keys:?}");
}

/// Scenes with too many pairs for a list use the sweep.
#[test]
fn large_scenes_sweep() {
    assert!(pairs(&pile(20, 1.0), Changes::default()).sweep.is_none());
    assert!(pairs(&pile(60, 1.0), Changes::default()).sweep.is_some());
}

/// `n` spheres at random positions in a box with the sides `sides`, m; sphere g has the radius `sizes(g)`.
fn cloud(n: usize, sides: Vec3, sizes: impl Fn(usize) -> f64) -> Model {
    let mut m = pile(4, 1.0);
    let mut next = random(0x9e37_79b9_7f4a_7c15);
    let body = |g: usize| (g % 4 + 1) as i32;
    m.ngeom = n;
    m.geom_rbound = (0..n).map(&sizes).collect();
    m.geom_size = (0..n).flat_map(|g| [sizes(g), 0.0, 0.0]).collect();
    m.geom_type = vec![geom::SPHERE; n];
    m.geom_bodyid = (0..n).map(body).collect();
    for bits in [&mut m.geom_contype, &mut m.geom_conaffinity] {
        *bits = vec![1; n];
    }
    (m.geom_margin, m.geom_gap) = (vec![0.0; n], vec![0.0; n]);
    m.geom_pos = (0..3 * n).map(|i| sides[i % 3] * next()).collect();
    m
}

/// Pseudorandom numbers in [0, 1).
fn random(mut state: u64) -> impl FnMut() -> f64 {
    move || {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        (state >> 11) as f64 / (1u64 << 53) as f64
    }
}

/// The number of pairs that the sweep tests per geom, and the number of pairs with overlapping bounds.
fn tested_pairs(m: &Model) -> (f64, usize) {
    let mut d = Workspace::unplanned(&pile(4, 1.0)).fields;
    d.geom_xpos.clone_from(&m.geom_pos);
    d.geom_xmat = [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0].repeat(m.ngeom);
    let mut sweep = Sweep::new(m, false);
    sweep.run(m, &d);
    (sweep.tested as f64 / m.ngeom as f64, sweep.near.len())
}

/// From 10 to 10,000 geoms in a heap, a layer and a row, of equal size or of very different sizes: the number of
/// tested pairs is proportional to the number of geoms. `--nocapture` prints the table of
/// `docs/measured/contacts.md`.
#[test]
fn cost_grows_with_the_number_of_geoms() {
    for (name, dims) in [("heap", 3), ("layer", 2), ("row", 1)] {
        for (kind, spread) in [("one size", 0.0), ("1 in 100 ten times as large", 1.0)] {
            let size = |g: usize| if g % 100 == 99 && spread > 0.0 { 1.0 } else { 0.1 };
            let mut rates = Vec::new();
            for n in [10, 100, 1000, 10_000] {
                let side = 0.25 * (n as f64).powf(1.0 / f64::from(dims));
                let sides = std::array::from_fn(|k| if (k as i32) < dims { side } else { 0.05 });
                let (rate, near) = tested_pairs(&cloud(n, sides, size));
                println!("| {name}, {kind} | {n} | {:.0} | {rate:.1} | {near} |", rate * n as f64);
                rates.push(rate);
            }
            // With ten times as many geoms, a sweep without columns tests 4.6 times as many pairs per geom in a heap,
            // and 3.2 times as many in a layer. The bound allows for large geoms, which have many neighbours that all
            // must be tested.
            assert!(rates[3] < 1.5 * rates[2] + 5.0, "{name}, {kind}: {rates:?}");
        }
    }
}

/// The columns miss no pair: comparison with a test of all pairs, with sizes over four decades.
#[test]
fn columns_find_the_same_pairs_as_all_pairs() {
    for seed in 0..20 {
        let size = |g: usize| 0.02 * [1.0, 0.01, 3.0, 30.0][(g * (seed + 3) / 7) % 4];
        let m = cloud(300, [1.0, 0.5 + 0.1 * seed as f64, 0.3], size);
        let (_, near) = tested_pairs(&m);
        let positions = rows::<3>(&m.geom_pos);
        let touch =
            |a: usize, b: usize| norm(sub(positions[a], positions[b])) <= m.geom_rbound[a] + m.geom_rbound[b];
        let all = (0..300).flat_map(|a| (0..a).map(move |b| (a, b)));
        let expected = all.filter(|&(a, b)| m.geom_bodyid[a] != m.geom_bodyid[b] && touch(a, b)).count();
        assert_eq!(near, expected);
    }
}

/// If there are more contacts than the maximum, a warning is reported and the memory does not grow.
#[test]
fn too_many_contacts_are_left_out_with_a_warning() {
    let balls = "<body><freejoint/><geom size='.1'/></body>".repeat(400);
    let m = compile(&format!("<mujoco><worldbody>{balls}</worldbody></mujoco>")).unwrap();
    let Workspace { fields: mut d, scratch: mut s } = Workspace::new(&m);
    kinematics(&m, &mut d, &mut s.dynamics);
    collide(&m, &mut d, &mut s.collision);
    let stat = d.warning[Warning::ContactFull as usize];
    assert_eq!((d.ncon, stat.number, stat.lastinfo), (MOST_CONTACTS, 1, MOST_CONTACTS));
}

/// A box tilted by one degree lies on the ridge between a small horizontal face of a mesh and a large face with a
/// slope of four degrees. Both faces face the box. The contacts must be on the horizontal face, which is nearer to
/// the direction of least depth.
#[test]
fn of_several_sides_the_one_nearest_to_the_direction_of_least_depth_is_used() {
    let profile = [(-1.0, -0.07), (0.0, 0.0), (0.1, 0.0), (0.1, -1.0), (-1.0, -1.0)];
    let ends = profile.iter().flat_map(|(x, z)| [-0.5, 0.5].map(|y| format!("{x} {y} {z} ")));
    let xml = format!(
        "<mujoco><asset><mesh name='ridge' vertex='{}'/></asset><worldbody>\
         <body><freejoint/><geom type='mesh' mesh='ridge'/></body>\
         <body pos='0 0 0.499' euler='0 -1 0'><freejoint/><geom type='box' size='.5 .5 .5'/></body></worldbody></mujoco>",
        ends.collect::<String>()
    );
    let m = compile(&xml).unwrap();
    let Workspace { fields: mut d, scratch: mut s } = Workspace::unplanned(&m);
    reset_data(&m, &mut d, &mut s);
    // Places the mesh where its vertices were given: the compiled model centres it.
    rows_mut::<3>(&mut d.qpos[..3])[0] = [0.0; 3];
    let found = {
        kinematics(&m, &mut d, &mut s.dynamics);
        s.collision.pairs = pairs(&m, Changes::default());
        collide(&m, &mut d, &mut s.collision);
        &d.contact
    };
    assert!(found.len() > 1);
    for c in found {
        assert!((c.frame[2].abs() - 1.0).abs() < 1e-12 && c.dist < 0.0, "{c:?}");
    }
}

/// A roof with its ridge down, near the edge of a box. The face towards the edge of the box is steeper than the
/// other, and the penetration depth along its normal is smaller. The contact must be with this face.
#[test]
fn of_several_faces_those_of_least_depth_are_used() {
    let (h, slopes) = (0.1, [3.0_f64, 2.0].map(|degrees| degrees.to_radians().tan()));
    let (back, front, side) = (-h / slopes[0], h / slopes[1], h / 20.0_f64.to_radians().tan());
    let mut vertices = String::from("0 0 0");
    for (x, y) in [(back, side), (back, -side), (front, side), (front, -side)] {
        vertices += &format!(" {x} {y} {h}");
    }
    let m = compile(&format!(
        "<mujoco><asset><mesh name='roof' vertex='{vertices}'/></asset><worldbody>
         <geom type='box' size='1 1 .1' pos='-.9 0 -.1'/>
         <body pos='0 0 -.01'><freejoint/><geom type='mesh' mesh='roof'/></body></worldbody></mujoco>"
    ))
    .unwrap();
    let found = contacts(&m, false);
    // The normal points from the box up to the roof and is normal to the steeper face.
    let (sin, cos) = 3.0_f64.to_radians().sin_cos();
    assert!(!found.is_empty());
    for c in found {
        assert!(norm(sub([c.frame[0], c.frame[1], c.frame[2]], [sin, 0.0, cos])) < 1e-9, "{:?}", c.frame);
    }
}
