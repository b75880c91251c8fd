//! Short chains compared with composite bodies and recursion, which do not use chains.

use proptest::prelude::*;

use crate::dynamics::{mass, rne};
use crate::step::forward::forward;
use crate::step::workspace::Workspace;
use crate::tests::compile;

/// A link: whether it is a slide, axis, anchor, position and orientation of its body, whether a body is welded to it,
/// whether the joint is an additional one of the previous body.
type LinkText = (bool, [f64; 3], [f64; 3], [f64; 3], [f64; 3], bool, bool);

fn link(planar: bool) -> impl Strategy<Value = LinkText> {
    let place = || prop::array::uniform3(-0.5f64..0.5);
    let axis = place().prop_filter("too short", |a| a.iter().any(|x| x.abs() > 0.1));
    (any::<bool>(), axis, place(), place(), place(), any::<bool>(), any::<bool>()).prop_map(
        move |(slides, mut axis, anchor, pos, mut turn, welded, second)| {
            if planar {
                axis = if slides {
                    [axis[0], 0.1, 0.0]
                } else {
                    [0.0, 0.0, if axis[2] < 0.0 { -1.0 } else { 1.0 }]
                };
                turn = [0.0, 0.0, turn[2]];
            }
            (slides, axis, anchor, pos, turn, welded, second)
        },
    )
}

fn chain() -> impl Strategy<Value = Vec<LinkText>> {
    any::<bool>().prop_flat_map(|planar| prop::collection::vec(link(planar), 1..7))
}

fn numbers(v: [f64; 3]) -> String {
    format!("{} {} {}", v[0], v[1], v[2])
}

fn text(links: &[LinkText]) -> String {
    let (mut open, mut joints) = (String::new(), 0);
    for (slides, axis, anchor, pos, turn, welded, second) in links {
        let kind = if *slides { "slide" } else { "hinge" };
        let joint = format!(
            "<joint type='{kind}' axis='{}' pos='{}' armature='0.01' ref='0.2'/>",
            numbers(*axis),
            numbers(*anchor)
        );
        let body = format!("<body pos='{}' euler='{}'>", numbers(*pos), numbers(turn.map(|x| 40.0 * x)));
        if *second && joints > 0 && joints < 3 {
            open = open.replacen("<inertial", &format!("{joint}<inertial"), 1);
            joints += 1;
            continue;
        }
        joints = 1;
        open = open.replace("<inertial", "<Inertial");
        let inertial =
            "<inertial pos='0.1 -0.05 0.2' mass='0.7' fullinertia='0.02 0.03 0.025 0.004 -0.003 0.002'/>";
        open += &format!("{body}{joint}{inertial}");
        if *welded {
            open += "<body pos='0.2 0.1 0' euler='10 20 30'><geom size='0.1' pos='0.05 0 0.1'/></body>";
        }
    }
    let bodies = open.matches("<body").count() - open.matches("</body>").count();
    format!(
        "<mujoco><option gravity='1 -2 -9'/><worldbody><body pos='0.1 0.2 0.3' euler='0 0 30'>{}{}</body></worldbody></mujoco>",
        open.replace("<Inertial", "<inertial"),
        "</body>".repeat(bodies)
    )
}

proptest! {
    #[test]
    fn a_chain_moves_as_its_bodies(links in chain(), q in prop::array::uniform8(-2.0f64..2.0), v in prop::array::uniform8(-3.0f64..3.0)) {
        let m = compile(&text(&links)).map_err(|e| TestCaseError::fail(format!("{e:?}\n{}", text(&links))))?;
        prop_assume!(m.nv > 0 && m.dof_simplenum[0] == 0);
        let Workspace { fields: mut d, scratch: mut s } = Workspace::new(&m);
        d.qpos.copy_from_slice(&q[..m.nq]);
        d.qvel.copy_from_slice(&v[..m.nv]);
        forward(&m, &mut d, &mut s);
        let (mass_matrix, bias) = (d.M.clone(), d.qfrc_bias.clone());
        prop_assert!(super::covers(&m, 0));
        let all = 0..m.nv;
        mass::composite_inertia(&m, &mut d, &mut s.dynamics.path, std::slice::from_ref(&all));
        rne::newton_euler(&m, &mut d, &mut s.dynamics, m.opt.gravity);
        for (computed, reference) in [(mass_matrix, &d.M), (bias, &d.qfrc_bias)] {
            let size = reference.iter().fold(1.0_f64, |s, x| s.max(x.abs()));
            for (a, b) in computed.iter().zip(reference) {
                prop_assert!((a - b).abs() < 1e-13 * size, "{computed:?}\n{reference:?}\n{}", text(&links));
            }
        }
    }
}
