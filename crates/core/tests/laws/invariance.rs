//! Physics does not depend on the choice of the world axes: a world that is rotated and translated as a whole, together with its
//! gravity, has the same motion.

use crate::definitions::*;
use crate::scenes::scene;
use labspec_core::math::{Quat, Vec3, add, quat_mul, quat_normalize, rotate};
use labspec_core::xml::compile;
use labspec_core::{self as core, Data, Model, joint};
use proptest::prelude::*;

/// A rigid motion of the world.
#[derive(Clone, Copy, Debug)]
struct Motion {
    turn: Quat,
    shift: Vec3,
}

fn motion() -> impl Strategy<Value = Motion> {
    let any = || -1.0..1.0f64;
    ((any(), any(), any(), any()), (any(), any(), any())).prop_map(|((w, x, y, z), (a, b, c))| Motion {
        turn: quat_normalize([w + 1.5, x, y, z]),
        shift: [a, b, c],
    })
}

impl Motion {
    /// Moves a pose, given as position and orientation.
    fn pose(&self, pos: &mut [f64], quat: &mut [f64]) {
        let p = add(rotate([pos[0], pos[1], pos[2]], self.turn), self.shift);
        pos.copy_from_slice(&p);
        quat.copy_from_slice(&quat_mul(self.turn, [quat[0], quat[1], quat[2], quat[3]]));
    }

    fn vector(&self, v: &mut [f64]) {
        let turned = rotate([v[0], v[1], v[2]], self.turn);
        v.copy_from_slice(&turned);
    }

    /// Moves coordinates: those of free joints are relative to the world.
    fn coordinates(&self, m: &Model, qpos: &mut [f64]) {
        for j in free_joints(m) {
            let at = m.jnt_qposadr[j] as usize;
            let (pos, quat) = qpos[at..at + 7].split_at_mut(3);
            self.pose(pos, quat);
        }
    }

    /// Rotates velocities or accelerations: the translational ones of free joints are relative to the world.
    fn velocities(&self, m: &Model, qvel: &mut [f64]) {
        for j in free_joints(m) {
            let at = m.jnt_dofadr[j] as usize;
            self.vector(&mut qvel[at..at + 3]);
        }
    }

    fn model(&self, m: &Model) -> Model {
        let mut moved = m.clone();
        for b in (1..m.nbody).filter(|&b| m.body_parentid[b] == 0) {
            let edit = moved.edit();
            self.pose(&mut edit.body_pos[3 * b..3 * b + 3], &mut edit.body_quat[4 * b..4 * b + 4]);
        }
        self.coordinates(m, moved.edit().qpos0);
        self.coordinates(m, moved.edit().qpos_spring);
        self.vector(moved.edit().opt.gravity);
        let mut scratch = Data::new(&moved);
        core::set_const(&mut moved, &mut scratch).unwrap();
        moved
    }
}

fn free_joints(m: &Model) -> impl Iterator<Item = usize> + '_ {
    (0..m.njnt).filter(|&j| m.jnt_type[j] == joint::FREE)
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 200, ..ProptestConfig::default() })]

    #[test]
    fn a_turned_world_moves_as_before(scene in scene(), numbers in numbers(), motion in motion()) {
        let m = compile(&scene.smooth()).unwrap();
        let moved = motion.model(&m);
        let (mut d, mut e) = (Data::new(&m), Data::new(&moved));
        scatter(&m, &mut d, &numbers);
        e.edit().qpos.copy_from_slice(&d.qpos);
        e.edit().qvel.copy_from_slice(&d.qvel);
        motion.coordinates(&m, e.edit().qpos);
        motion.velocities(&m, e.edit().qvel);
        core::forward(&m, &mut d).unwrap();
        core::forward(&moved, &mut e).unwrap();

        let mut qacc = d.qacc.clone();
        motion.velocities(&m, &mut qacc);
        let scale = qacc.iter().fold(1.0f64, |s, a| s.max(a.abs()));
        for (i, (a, b)) in qacc.iter().zip(&e.qacc).enumerate() {
            prop_assert!((a - b).abs() <= 1e-10 * scale, "{i}: {a} {b}");
        }
        prop_assert!((d.energy[1] - e.energy[1]).abs() <= ROUNDING * d.energy[1].max(1.0));
        for b in (1..m.nbody).filter(|&b| m.body_mocapid[m.body_rootid[b] as usize] < 0) {
            let pose = |d: &Data| (d.xpos[3 * b..3 * b + 3].to_vec(), d.xquat[4 * b..4 * b + 4].to_vec());
            let ((mut pos, mut quat), (pos2, quat2)) = (pose(&d), pose(&e));
            motion.pose(&mut pos, &mut quat);
            for (a, b) in pos.iter().zip(&pos2).chain(quat.iter().zip(&quat2)) {
                prop_assert!((a - b).abs() <= ROUNDING, "{a} {b}");
            }
        }
    }
}
