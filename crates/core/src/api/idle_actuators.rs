//! Actuators that can apply no force are left out of plans, without changing a number.

use crate::api::{call, data::Data, data::Planned, model::Model, planning::Plan};
use crate::model::reflect::{FieldSet, data, model};
use crate::model::stage::Stage;
use crate::step::analysis::AccessSet;

/// Two pendulums, with these actuators and constraints.
fn pendulum(more: &str) -> Model {
    Model::from_xml(&format!(
        "<mujoco><worldbody><body name='a'><joint name='j' axis='0 1 0'/><geom size='.1' pos='1 0 0'/></body>
         <body name='b' pos='0 0 3'><joint name='k' axis='0 1 0'/><geom size='.1' pos='1 0 0'/></body></worldbody>
         <tendon><fixed name='t'><joint joint='j' coef='1'/><joint joint='k' coef='-1'/></fixed></tendon>{more}</mujoco>"
    ))
    .unwrap()
}

fn reading() -> AccessSet {
    let mut access = AccessSet { reads: FieldSet::EMPTY, writes: FieldSet::EMPTY };
    access.reads.insert(data::qpos);
    access
}

/// Checks that steps with planned data give the results of full steps.
fn check_steps_agree(m: &Model, planned: &mut Data<Planned>, full: &mut Data) {
    for _ in 0..30 {
        call::step(m, planned).unwrap();
        call::step(m, full).unwrap();
    }
    let bits = |q: &[f64]| q.iter().map(|x| x.to_bits()).collect::<Vec<_>>();
    assert_eq!(bits(&planned.fields().qpos), bits(&full.qpos));
    assert_eq!(bits(&planned.fields().actuator_force), bits(&full.actuator_force));
    assert_eq!(bits(&planned.fields().qfrc_actuator), bits(&full.qfrc_actuator));
}

/// Gravity compensation that counts as an actuator force does not act in a model without actuators (measured on MuJoCo
/// 3.14.0), whatever the plan contains.
#[test]
fn without_actuators_there_is_no_actuator_gravity_compensation() {
    let m = Model::from_xml(
        "<mujoco><worldbody><site name='a' pos='0 0 .5'/><body gravcomp='.1'><freejoint/><geom size='.05' mass='1'/>\
         <site name='s' pos='0 0 .1'/></body></worldbody><tendon><spatial><site site='a'/><site site='s'/></spatial></tendon>\
         <sensor><accelerometer site='s'/></sensor></mujoco>",
    )
    .unwrap();
    let mut everything = AccessSet { reads: FieldSet::ALL, writes: FieldSet::EMPTY };
    everything.writes.insert(model::jnt_actgravcomp);
    let (mut planned, mut full) = (Data::planned(&m, Plan::new(&m, &everything)), Data::unplanned(&m));
    let mut written = m.clone();
    assert!(call::view_mut(&mut written, &mut planned, model::jnt_actgravcomp).unwrap().set(0, 1.0));
    check_steps_agree(&written, &mut planned, &mut full);
    assert_eq!(planned.fields().qfrc_actuator, [0.0; 6]);
    assert_eq!(planned.fields().qfrc_gravcomp[2], 9.81 * 0.1);
}

#[test]
fn actuators_without_controls_are_left_out() {
    for (actuators, is_omitted) in [
        ("<motor joint='j' gear='-3'/><motor tendon='t'/>", true),
        ("<motor joint='j' ctrlrange='-1 1'/>", true),
        ("<motor joint='j' ctrlrange='.5 1'/>", false),
        ("<motor joint='j' forcerange='-3 -1'/>", false),
        ("<motor joint='j'/><position joint='k'/>", false),
        ("<general joint='j' dyntype='filter' dynprm='.1'/>", false),
        ("<velocity joint='j'/>", false),
    ] {
        let m = pendulum(&format!("<actuator>{actuators}</actuator>"));
        let plan = Plan::new(&m, &reading());
        assert_eq!(!plan.keeps(Stage::Actuation), is_omitted, "{actuators}");
        let mut written = reading();
        written.writes.insert(data::ctrl);
        assert!(Plan::new(&m, &written).keeps(Stage::Actuation));
        let (mut planned, mut full) = (Data::planned(&m, plan), Data::unplanned(&m));
        check_steps_agree(&m, &mut planned, &mut full);
        // A control that the access set does not announce acts.
        planned.edit().ctrl[0] = 0.7;
        full.edit().ctrl[0] = 0.7;
        check_steps_agree(&m, &mut planned, &mut full);
        assert!(planned.fields().actuator_force[0] != 0.0, "{actuators}");
    }
}

#[test]
fn keyframes_and_states_set_controls() {
    let more = "<actuator><motor joint='j'/></actuator><keyframe><key ctrl='.5'/></keyframe>";
    let m = pendulum(more);
    let key = m.keys().next().unwrap();
    let (mut planned, mut full) = (Data::planned(&m, Plan::new(&m, &reading())), Data::unplanned(&m));
    call::reset_data_keyframe(&m, &mut planned, key).unwrap();
    call::reset_data_keyframe(&m, &mut full, key).unwrap();
    check_steps_agree(&m, &mut planned, &mut full);
    let mut other = Data::planned(&m, Plan::new(&m, &reading()));
    call::state::copy(&m, &full, &mut other, call::state::INTEGRATION).unwrap();
    check_steps_agree(&m, &mut other, &mut full);
}

#[test]
fn inactive_equalities_are_excluded() {
    let tie = "<equality><joint joint1='j' joint2='k' active='false'/><connect body1='a' body2='b' anchor='1 0 0' active='false'/></equality>";
    let mut m = pendulum(tie);
    let plan = Plan::new(&m, &reading());
    assert!(!plan.keeps(Stage::Constraint) && !plan.keeps(Stage::Kinematics));
    assert!(Plan::new(&pendulum(&tie.replacen("false", "true", 1)), &reading()).keeps(Stage::Solve));
    let (mut planned, mut full) = (Data::planned(&m, plan), Data::unplanned(&m));
    check_steps_agree(&m, &mut planned, &mut full);
    for (i, on) in [(0, true), (1, true), (0, false)] {
        planned.edit().eq_active[i] = on;
        full.edit().eq_active[i] = on;
        check_steps_agree(&m, &mut planned, &mut full);
    }
    // Inactive after a reset, and active until then.
    m.edit().eq_active0.fill(false);
    check_steps_agree(&m, &mut planned, &mut full);
    let mut data = Data::planned(&m, Plan::new(&m, &reading()));
    m.edit().eq_active0.fill(true);
    call::reset_data(&m, &mut data).unwrap();
    call::reset_data(&m, &mut full).unwrap();
    check_steps_agree(&m, &mut data, &mut full);
    assert!(data.plan().keeps(Stage::Solve));
}
