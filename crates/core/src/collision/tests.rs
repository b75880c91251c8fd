//! Laws of the broad phase: what it finds does not depend on how it looks.

use super::*;
use crate::mjcf::compile;
use crate::reset_data;

/// Free bodies of random shapes in a cube, on a plane. The shapes are written over compiled spheres.
fn pile(bodies: usize, side: f64) -> Model {
    let mut state = 0x2545_f491_4f6c_dd1d_u64;
    let mut random = || {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        (state >> 11) as f64 / (1u64 << 53) as f64
    };
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

/// Contacts by the list of all pairs, or by the sweep.
fn contacts(m: &Model, sweep: bool) -> Vec<Contact> {
    let mut d = Data::unplanned(m);
    reset_data(m, &mut d);
    d.work.pairs = pairs(m, false, false);
    if sweep {
        d.work.pairs = Pairs { sweep: Some(Box::new(Sweep::new(m, false))), ..Pairs::default() };
    }
    crate::kinematics::bodies(m, &mut d);
    crate::kinematics::geoms(m, &mut d);
    // Twice: the second run starts from the order of the first.
    collide(m, &mut d);
    collide(m, &mut d);
    d.contact
}

#[test]
fn sweep_finds_what_the_list_finds() {
    for (bodies, side) in [(5, 0.3), (20, 0.6), (40, 1.5)] {
        let m = pile(bodies, side);
        let (list, sweep) = (contacts(&m, false), contacts(&m, true));
        assert!(list.len() > bodies, "{}", list.len());
        assert_eq!(list, sweep);
    }
}

/// Contacts come by bodies, then by geoms in the order of their types.
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

/// Long lists of pairs give way to the sweep.
#[test]
fn large_scenes_sweep() {
    assert!(pairs(&pile(20, 1.0), false, false).sweep.is_none());
    assert!(pairs(&pile(60, 1.0), false, false).sweep.is_some());
}

/// More contacts than are kept: a warning says so, and the memory stays what it is.
#[test]
fn too_many_contacts_are_left_out_with_a_warning() {
    let balls = "<body><freejoint/><geom size='.1'/></body>".repeat(400);
    let m = compile(&format!("<mujoco><worldbody>{balls}</worldbody></mujoco>")).unwrap();
    let mut d = Data::new(&m);
    crate::kinematics::bodies(&m, &mut d);
    crate::kinematics::geoms(&m, &mut d);
    collide(&m, &mut d);
    let stat = d.warning[Warning::ContactFull as usize];
    assert_eq!((d.ncon, stat.number, stat.lastinfo), (MOST_CONTACTS, 1, MOST_CONTACTS));
}
