//! The algorithm for long planar chains agrees with the general algorithm: in every integrator, with equality constraints, and
//! after edits.

use crate::api::{call, data::Data, data::Planned, model::Model, planning::Plan};
use crate::model::reflect::{self, FieldSet, Object, data};
use crate::model::stage::Stage;
use crate::model::tree_algorithm::TreeAlgorithms;
use crate::step::analysis::AccessSet;
use std::fmt::Write;

/// A chain of many links in a plane that is rotated in space, with hinge axes of both signs, bodies that are welded to a link,
/// and armature at some joints.
fn chain(links: usize, option: &str, more: &str) -> Model {
    let (mut open, mut close) = (String::new(), String::new());
    for i in 0..links {
        let axis = if i % 3 == 1 { "0 -1 0" } else { "0 1 0" };
        let damping = if i % 4 == 0 { "damping='.02'" } else { "" };
        let armature = if i % 5 == 2 { "armature='.001'" } else { "" };
        let (turn, pos) =
            (if i % 4 == 3 { "0 20 0" } else { "0 0 0" }, if i == 0 { "0 .1 2" } else { ".1 0 -.02" });
        let _ = write!(
            open,
            "<body name='b{i}' pos='{pos}' euler='{turn}'><joint name='j{i}' axis='{axis}' pos='.01 0 0' {damping} {armature}/>\
             <geom type='capsule' size='.01' fromto='.01 0 0 .09 0 -.01' contype='0' conaffinity='0'/>"
        );
        if i % 6 == 4 {
            open.push_str("<body pos='.02 .03 .01' euler='10 20 30'><geom type='box' size='.01 .02 .01' contype='0' conaffinity='0'/></body>");
        }
        close.push_str("</body>");
    }
    let text = format!(
        "<mujoco><option {option}/><worldbody><geom type='plane' size='5 5 1' pos='0 0 {{}}'/><body euler='0 0 30'>{open}\
         <geom name='end' size='.04' mass='5'/>{close}</body></worldbody>{more}</mujoco>"
    );
    Model::from_xml(&text.replacen("{}", if more.is_empty() { "-9" } else { "1.95" }, 1)).unwrap()
}

fn data_with_all_fields(m: &Model, algorithms: TreeAlgorithms) -> Data<Planned> {
    Data::planned(m, Plan::by_algorithms(m, &AccessSet::ANY, algorithms))
}

/// Data whose forces are computed by the given tree algorithms, after some steps.
fn data_after_steps(
    m: &Model,
    algorithms: TreeAlgorithms,
    change: &dyn Fn(&mut Model),
) -> (Model, Data<Planned>) {
    let (mut m, mut d) = (m.clone(), data_with_all_fields(m, algorithms));
    for (i, v) in d.edit().qvel.iter_mut().enumerate() {
        *v = 0.3 * f64::from((7 * i as i32) % 5 - 2);
    }
    call::step(&m, &mut d).unwrap();
    change(&mut m);
    for _ in 0..20 {
        call::step(&m, &mut d).unwrap();
    }
    (m, d)
}

fn check_forces_agree(m: &Model, change: &dyn Fn(&mut Model)) {
    let [(_, planar), (m, general)] = [TreeAlgorithms::ALL, TreeAlgorithms::GENERAL]
        .map(|algorithms| data_after_steps(m, algorithms, change));
    for name in
        ["M", "qLD", "qLDiagInv", "qfrc_bias", "qacc_smooth", "qacc", "qfrc_constraint", "qpos", "qvel"]
    {
        let field = reflect::field(Object::Data, name).unwrap();
        let [a, b] = [&planar, &general].map(|d| {
            let view = call::view(&m, d, field).unwrap();
            (0..view.len()).filter_map(|i| view.get(i)).collect::<Vec<f64>>()
        });
        let size = b.iter().fold(1.0_f64, |s, x| s.max(x.abs()));
        let difference = a.iter().zip(&b).fold(0.0_f64, |s, (x, y)| s.max((x - y).abs()));
        assert!(a.len() == b.len() && difference < 1e-8 * size, "{name}: {difference:e} of {size:e}");
    }
}

const TIE: &str = "<equality><joint joint1='j2' joint2='j7'/></equality>";
const TENDON: &str = "<tendon><fixed armature='.01'><joint joint='j1' coef='1'/><joint joint='j8' coef='-2'/></fixed></tendon>";

#[test]
fn long_chains_move_as_by_the_general_algorithm() {
    for option in [
        "",
        "integrator='RK4'",
        "integrator='implicitfast'",
        "integrator='implicit'",
        "integrator='discrete'",
    ] {
        for more in ["", TIE, TENDON] {
            check_forces_agree(&chain(12, option, more), &|_| {});
        }
    }
    assert!(chain(12, "", "").planar_trees == [0] && chain(6, "", "").planar_trees.is_empty());
}

/// After an edit of its parameters, a chain still agrees, whether it stays in its plane or leaves it.
#[test]
fn a_chain_may_leave_its_plane() {
    for (option, more) in [("", ""), ("", TIE), ("integrator='implicitfast'", "")] {
        let m = chain(12, option, more);
        check_forces_agree(&m, &|m| m.edit().jnt_axis[3 * 5..3 * 5 + 3].copy_from_slice(&[1.0, 0.0, 0.0]));
        check_forces_agree(&m, &|m| m.edit().body_mass[4] *= 3.0);
        check_forces_agree(&m, &|m| m.edit().body_pos[3 * 4] += 0.05);
    }
}

/// The plan contains no spatial stages for a planar chain, and a planned run gives the numbers of a full run.
#[test]
fn no_spatial_bodies_are_needed() {
    let mut access = AccessSet { reads: FieldSet::EMPTY, writes: FieldSet::EMPTY };
    access.reads.insert(data::qpos);
    for more in ["", TIE, TENDON] {
        let m = chain(12, "", more);
        let plan = Plan::new(&m, &access);
        if more.is_empty() {
            assert!(
                ![Stage::Kinematics, Stage::ComPos, Stage::ComVel, Stage::Solve]
                    .iter()
                    .any(|s| plan.keeps(*s))
            );
        }
        let (mut planned, mut full) = (Data::planned(&m, plan), Data::unplanned(&m));
        for _ in 0..200 {
            call::step(&m, &mut planned).unwrap();
            call::step(&m, &mut full).unwrap();
        }
        let bits = |q: &[f64]| q.iter().map(|x| x.to_bits()).collect::<Vec<_>>();
        assert_eq!(bits(&planned.fields().qpos), bits(&full.qpos), "{more}");
    }
}
