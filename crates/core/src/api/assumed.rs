//! The assumptions of a plan about values of the model that programs may write, and when a new plan is made.
//!
//! A plan for the current values leaves out more stages than a plan for any values. When one of the assumed values changes, a new
//! plan is made, which takes as long as some hundred small steps. A value that changes repeatedly may therefore have any value in
//! the new plan, until it has stayed constant for some time.
//!
//! Only calls that compute everything make a narrower plan. After a call that computes a part, such as `mj_kinematics`, the
//! fields that the narrower plan leaves out would still contain the results of the last full pass.

use super::contents::Contents;
use super::planning::Plan;
use crate::model::reflect::FieldSet;
use crate::step::deciding::undecisive_writes;

/// The number of passes for which values must stay constant before a plan assumes them.
pub(super) const SETTLED: u64 = 256;

/// The assumptions of a plan.
#[derive(Clone, Debug)]
pub(super) struct Assumed {
    /// The contents that the plan was made for, or `None` if it is valid for any contents.
    pub(super) made_for: Option<Contents>,
    /// The fields for which the plan is valid with any value.
    pub(super) any: FieldSet,
    /// Whether these fields are more than necessary.
    pub(super) wide: bool,
    /// The value of the work counter from which the current values count as settled.
    pub(super) settled: u64,
    /// Whether a narrower plan is to be made at the next pass.
    pub(super) due: bool,
}

impl Assumed {
    /// The assumptions of a new plan. A plan that was made for any value is not narrowed later.
    pub(super) fn from_plan(plan: &mut Plan) -> Assumed {
        let wide = plan.any != undecisive_writes(&plan.access) && plan.made_for.is_some();
        let settled = if wide { u64::MAX } else { 0 };
        Assumed { made_for: plan.made_for.take(), any: plan.any, wide, settled, due: false }
    }

    /// The fields for which the plan is valid with any value.
    pub(super) fn any(&self) -> FieldSet {
        self.any
    }

    /// The version with which data are compared: 0 for a plan that is wider than necessary, which is checked in every call.
    pub(super) fn version_of(&self, contents: &Contents) -> u64 {
        if self.wide { 0 } else { contents.version }
    }

    /// Records that constants were computed for which the plan has already been checked.
    pub(super) fn accept_constants(&mut self, contents: &Contents) {
        if let Some(planned) = &mut self.made_for {
            planned.accept_constants(contents);
        }
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)] // a panic is the report of a failed test
mod tests {
    use super::SETTLED;
    use crate::api::{call, data::Data, data::Planned, model::Model, planning::Plan};
    use crate::kinds::integrator;
    use crate::model::reflect::{FieldId, FieldSet, data, model, option};
    use crate::model::stage::Stage;
    use crate::step::analysis::AccessSet;

    const CHAIN: &str = "<mujoco><worldbody><geom type='plane' size='2 2 1' contype='0' conaffinity='0'/>\
        <body pos='0 0 1'><joint axis='0 1 0'/><geom size='.05' pos='.2 0 0'/>\
        <body pos='.2 0 0'><joint axis='0 1 0'/><geom size='.05' pos='.2 0 0' contype='0'/></body></body>\
        </worldbody></mujoco>";

    fn access(writes: &[FieldId]) -> AccessSet {
        let mut access = AccessSet { reads: FieldSet::EMPTY, writes: FieldSet::EMPTY };
        access.reads.insert(data::qpos);
        writes.iter().for_each(|&field| access.writes.insert(field));
        access
    }

    fn start(writes: &[FieldId]) -> (Model, Data<Planned>) {
        let m = Model::from_xml(CHAIN).unwrap();
        let d = Data::planned(&m, Plan::new(&m, &access(writes)));
        (m, d)
    }

    fn write(m: &mut Model, d: &mut Data<Planned>, field: FieldId, i: usize, value: f64) {
        assert!(call::view_mut(m, d, field).unwrap().set(i, value));
    }

    /// A plan is that of the current values, before a change and after it, whatever may be written.
    #[test]
    fn written_values_are_used() {
        let fields = [
            (option::integrator, 0, f64::from(integrator::RK4)),
            (option::disableflags, 0, 16.0),
            (option::density, 0, 3.0),
            (model::dof_damping, 0, 0.5),
            (model::jnt_stiffness, 1, 2.0),
            (model::geom_contype, 0, 1.0),
            (model::dof_frictionloss, 0, 0.1),
            (option::timestep, 0, 0.001),
            (option::cone, 0, 1.0),
            (option::solver, 0, 1.0),
        ];
        let all = fields.map(|(field, ..)| field);
        let fixed = |m: &Model| Plan::new(m, &access(&[]));
        let same = |m: &Model, d: &Data<Planned>| {
            let (a, b) = (d.plan(), fixed(m));
            let kept_stages = |plan: &Plan| {
                plan.decisions().iter().filter(|row| row.keep).map(|row| row.stage).collect::<Vec<_>>()
            };
            assert_eq!(kept_stages(&a), kept_stages(&b));
        };
        for (field, i, value) in fields {
            let (mut m, mut d) = start(&all);
            same(&m, &d);
            write(&mut m, &mut d, field, i, value);
            call::step(&m, &mut d).unwrap();
            same(&m, &d);
        }
        let (m, _) = start(&all);
        let any = Plan::for_any_value(&m, &access(&all));
        assert!(any.keeps(Stage::Passive) && any.keeps(Stage::Solve) && !fixed(&m).keeps(Stage::Solve));
    }

    /// A joint gets the damper of an actuator when `mj_setConst` is called, not when `actuator_damping` is written.
    #[test]
    fn constants_that_give_joints_dampers_change_the_plan() {
        let xml = "<mujoco><worldbody><body><joint name='j' axis='0 1 0'/><geom size='.05' pos='.2 0 0'/></body></worldbody>\
            <actuator><motor joint='j'/></actuator></mujoco>";
        let mut m = Model::from_xml(xml).unwrap();
        let mut d = Data::planned(&m, Plan::new(&m, &access(&[model::actuator_damping])));
        let mut full = Data::unplanned(&m);
        write(&mut m, &mut d, model::actuator_damping, 0, 0.6);
        for constants in [false, true] {
            if constants {
                call::set_const(&mut m.clone(), &mut full).unwrap();
                call::set_const(&mut m, &mut d).unwrap();
            }
            for _ in 0..100 {
                call::step(&m, &mut d).unwrap();
                call::step(&m, &mut full).unwrap();
            }

            let planned = call::element(&m, &d, data::qpos, 0).unwrap();
            assert_eq!(planned.to_bits(), full.qpos[0].to_bits());
        }
    }

    /// A write to `geom_pos` moves a geom that is in the frame of its body when `mj_setConst` is called. Until then its contacts
    /// do not change.
    #[test]
    fn a_geom_that_is_moved_touches_until_constants_are_computed() {
        let xml = "<mujoco><worldbody><geom name='still' size='.05'/>\
            <body pos='.08 0 0'><joint axis='0 0 1' pos='0 -.05 0'/><geom size='.05'/></body></worldbody></mujoco>";
        let mut m = Model::from_xml(xml).unwrap();
        let mut d = Data::planned(&m, Plan::new(&m, &access(&[model::geom_pos])));
        let mut full = Data::unplanned(&m);
        write(&mut m, &mut d, model::geom_pos, 0, 9.0);
        let mut touched = Vec::new();
        for constants in [false, true] {
            if constants {
                call::set_const(&mut m.clone(), &mut full).unwrap();
                call::set_const(&mut m, &mut d).unwrap();
            }
            call::step(&m, &mut d).unwrap();
            call::step(&m, &mut full).unwrap();
            touched.push(full.ncon);
            assert_eq!(d.fields().qacc, full.qacc);
        }
        assert_eq!(touched, [1, 0]);
    }

    /// A plan allows any value for a field that changes repeatedly, until it has stayed constant for some time. After a call that
    /// computes a part, the plan stays until the next full pass.
    #[test]
    fn frequently_written_values_are_arbitrary() {
        let (mut m, mut d) = start(&[model::dof_damping]);
        let passive = |d: &Data<Planned>| d.plan().keeps(Stage::Passive);
        assert!(!passive(&d));
        for value in [0.5, 0.0] {
            write(&mut m, &mut d, model::dof_damping, 0, value);
            call::step(&m, &mut d).unwrap();
            assert!(passive(&d));
        }
        (0..2 * SETTLED).for_each(|_| call::step(&m, &mut d).unwrap());
        assert!(!passive(&d));
        write(&mut m, &mut d, model::dof_damping, 0, 0.5);
        call::kinematics(&m, &mut d).unwrap();
        write(&mut m, &mut d, model::dof_damping, 0, 0.0);
        call::kinematics(&m, &mut d).unwrap();
        assert!(passive(&d));
        call::forward(&m, &mut d).unwrap();
        assert!(!passive(&d));
    }
}
