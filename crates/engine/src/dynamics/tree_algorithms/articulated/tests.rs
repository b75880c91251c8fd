//! Articulated bodies compared with the factorization of M.

#![allow(clippy::unwrap_used, clippy::panic)] // a panic is the report of a failed test

use super::*;
use crate::dynamics::tree_algorithms::{solve, solve_with};
use crate::kinds::joint;
use crate::step::forward::forward;
use crate::step::workspace::Workspace;
use crate::tests::compile;
use proptest::prelude::*;

/// A tree as MJCF. Each body is given by its parent, its joints (-1 for none, at most three hinges), and three
/// numbers for its position and orientation.
fn text(bodies: &[(usize, i32, [f64; 3])]) -> String {
    fn body(i: usize, bodies: &[(usize, i32, [f64; 3])], free: bool) -> String {
        let (_, joints, [x, y, z]) = bodies[i];
        let joints = match joints {
            _ if i == 0 && free => "<freejoint/>".into(),
            -1 if i > 0 => String::new(),
            0 => "<joint type='ball' armature='0.02'/>".into(),
            1 => "<joint type='slide' axis='1 2 0' armature='0.1'/>".into(),
            n => ["1 0 0", "0 1 0.2", "0.3 0 1"][..(n.max(2) - 1) as usize]
                .iter()
                .map(|axis| format!("<joint axis='{axis}' pos='0.05 0 0.02' damping='0.3'/>"))
                .collect(),
        };
        let children = (i + 1..bodies.len()).filter(|&c| bodies[c].0.min(c - 1) == i);
        let children: String = children.map(|c| body(c, bodies, free)).collect();
        format!(
            "<body pos='{x} {y} {z}' euler='{} {} 20'>{joints}<geom type='box' size='0.1 0.07 0.05' pos='0.04 0.1 0'/>{children}</body>",
            40.0 * x,
            30.0 * z
        )
    }
    format!(
        "<mujoco><option gravity='1 2 -9'/><worldbody>{}<body><freejoint/><geom size='0.1'/></body>{}</worldbody></mujoco>",
        body(0, bodies, true),
        body(0, bodies, false)
    )
}

proptest! {
    #[test]
    fn an_articulated_tree_is_that_of_its_mass_matrix(
        bodies in prop::collection::vec((0usize..6, -1i32..5, prop::array::uniform3(-0.4f64..0.4)), 3..9),
        q in prop::collection::vec(-1.0f64..1.0, 80),
    ) {
        let m = compile(&text(&bodies)).unwrap();
        let Workspace { fields: mut d, scratch: mut s } = Workspace::new(&m);
        for j in (0..m.njnt).filter(|&j| m.jnt_type[j] != joint::FREE) {
            let address = m.jnt_qposadr[j] as usize;
            d.qpos[address] += q[address % q.len()];
        }
        for (v, x) in d.qvel.iter_mut().zip(q.iter().rev()) {
            *v = *x;
        }
        forward(&m, &mut d, &mut s);
        let (mut ld, mut inv) = (d.M.clone(), vec![0.0; m.nv]);
        prop_assert_eq!(mass::factor(&m, &mut ld, &mut inv, 0..m.nv), None);
        for (computed, rows) in d.qLD.iter().zip(&ld) {
            prop_assert!((computed - rows).abs() < 1e-10 * (1.0 + rows.abs()), "{computed} {rows}");
        }

        // Reverse check: multiplying the computed acceleration by the matrix gives the force.
        let f: Vec<f64> = (0..m.nv).map(|k| q[(3 * k) % q.len()]).collect();
        let b: Vec<f64> = (0..m.nv).map(|k| q[(5 * k) % q.len()].abs()).collect();
        let (mut x, mut back) = (f.clone(), vec![0.0; m.nv]);
        solve_with(&m, &d, &mut s.dynamics, &b, &mut x);
        mass::mul(&m, &d.M, &x, &mut back, 0..m.nv);
        for k in 0..m.nv {
            prop_assert!((back[k] + b[k] * x[k] - f[k]).abs() < 1e-9, "{k}");
        }
        x.copy_from_slice(&f);
        solve(&m, &d, &mut s.dynamics, &mut x);
        mass::mul(&m, &d.M, &x, &mut back, 0..m.nv);
        let size = x.iter().fold(1.0_f64, |s, x| s.max(x.abs()));
        for k in 0..m.nv {
            prop_assert!((back[k] - f[k]).abs() < 1e-9 * size, "{k}");
        }
    }
}
