//! The initial state of data: creation, reset, and replacement of the plan.

use super::sequence::with_clock;
use super::{forward, sleep};
use crate::dynamics::{self, kinematics, mass, tree_algorithms};
use crate::forces::{actuation, transmission};
use crate::math::*;
use crate::model::meter::Meter;
use crate::model::plan::PlanFlag;
use crate::model::plan::PlanTable;
use crate::model::stage::Stage;
use crate::model::stopwatch::Stopwatch;
use crate::model::tree_algorithm::TreeAlgorithms;
use crate::model::{Fields, Model, Warning, WarningStat, asleep, reflect};
use crate::step::analysis::{self, AccessSet};
use crate::step::workspace::{StepScratch, Workspace};
use crate::{collision, constraint, sensor};

impl Workspace {
    /// Data for a model, in the default configuration. Nothing is computed yet: call `forward`.
    ///
    /// The plan allows any field to be read or written at any time. See `Data::planned` for less work.
    pub fn new(m: &Model) -> Workspace {
        Workspace::planned(m, PlanTable::new(m, &AccessSet::ANY, TreeAlgorithms::ALL))
    }

    /// Data that compute only the stages that a plan keeps.
    pub fn planned(m: &Model, plan: PlanTable) -> Workspace {
        let mut w = Workspace::unplanned(m);
        set_plan(m, &mut w.fields, &mut w.scratch, plan);
        w
    }

    /// Data with all stages except sleep, and without collision pairs.
    pub fn unplanned(m: &Model) -> Workspace {
        let mut w = Workspace::default();
        let Workspace { fields: d, scratch: s } = &mut w;
        (d.plan, d.meter, d.acting) = (PlanTable::awake(), Meter::new(m), vec![0.0; m.nu]);
        s.resize(m, TreeAlgorithms::ALL);
        reset_data(m, d, s);
        w
    }
}

/// Replaces the plan, which determines what the next forward pass computes.
pub fn set_plan(m: &Model, d: &mut Fields, s: &mut StepScratch, plan: PlanTable) {
    s.collision.pairs = if plan.keeps(Stage::Collision) {
        collision::pairs(m, analysis::changes(&plan))
    } else {
        collision::CandidatePairs::default()
    };
    if plan.algorithms != d.plan.algorithms {
        s.dynamics = dynamics::DynamicsScratch::new(m, plan.algorithms);
    }
    d.plan = plan;
    if s.watch.is_some() {
        d.plan.passes = with_clock(d.plan.passes);
    }
    tree_algorithms::load(m, &mut s.dynamics);
    s.derivative.invalidate();
    if sleep::is_fresh(&s.sleep) {
        sleep_or_wake_trees(m, d, s);
    }
    clear_omitted_fields(m, d, s);
}

/// Starts measuring the times of the stages from zero, with a clock of the caller.
pub fn clock(d: &mut Fields, s: &mut StepScratch, clock: fn() -> u64) {
    s.watch = Some(Box::new(Stopwatch::new(clock)));
    d.plan.passes = with_clock(d.plan.passes);
}

/// Resets state, inputs, results and warnings to the default configuration (`mj_resetData`). Edits of the model stay.
pub fn reset_data(m: &Model, d: &mut Fields, s: &mut StepScratch) {
    reflect::allocate_data(m, d);
    (d.ncon, d.nefc, d.nisland, d.solver_niter) = (0, 0, 0, 0);
    (d.ne, d.nf, d.nl) = (0, 0, 0);
    d.contact.clear();
    d.warning = [WarningStat::default(); Warning::COUNT];
    kinematics::world(d);
    d.qpos.copy_from_slice(&m.qpos0);
    d.eq_active.copy_from_slice(&m.eq_active0);
    actuation::reset(m, d);
    sensor::reset(m, d);
    for b in 0..m.nbody {
        let id = m.body_mocapid[b];
        if id >= 0 {
            rows_mut::<3>(&mut d.mocap_pos)[id as usize] = rows::<3>(&m.body_pos)[b];
            rows_mut::<4>(&mut d.mocap_quat)[id as usize] = rows::<4>(&m.body_quat)[b];
        }
    }
    clear_omitted_fields(m, d, s);
    sleep_or_wake_trees(m, d, s);
}

/// Puts the trees to sleep that start asleep, and wakes all others.
fn sleep_or_wake_trees(m: &Model, d: &mut Fields, s: &mut StepScratch) {
    if sleep::wake_all(m, d) {
        forward::forward(m, d, s);
        sleep::start(m, d, &mut s.constraint);
    }
    sleep::begin(d, &mut s.sleep);
}

/// Resets the data to keyframe `key` (`mj_resetDataKeyframe`). If there is no such keyframe, resets to the default configuration.
pub fn reset_data_keyframe(m: &Model, d: &mut Fields, s: &mut StepScratch, key: usize) {
    reset_data(m, d, s);
    if key >= m.nkey {
        return;
    }
    let row = |a: &[f64], n: usize, out: &mut [f64]| out.copy_from_slice(&a[key * n..(key + 1) * n]);
    d.time = m.key_time[key];
    row(&m.key_qpos, m.nq, &mut d.qpos);
    row(&m.key_qvel, m.nv, &mut d.qvel);
    row(&m.key_act, m.na, &mut d.act);
    row(&m.key_mpos, 3 * m.nmocap, &mut d.mocap_pos);
    row(&m.key_mquat, 4 * m.nmocap, &mut d.mocap_quat);
    row(&m.key_ctrl, m.nu, &mut d.ctrl);
}

/// Stores the time, the state and the inputs in keyframe `key` (`mj_setKeyframe`). If the model has no such keyframe, changes
/// nothing and returns `false`.
pub fn set_keyframe(m: &mut Model, d: &Fields, key: usize) -> bool {
    let Some(time) = m.key_time.get_mut(key) else { return false };
    *time = d.time;
    let row = |a: &mut [f64], x: &[f64]| a[key * x.len()..(key + 1) * x.len()].copy_from_slice(x);
    row(&mut m.key_qpos, &d.qpos);
    row(&mut m.key_qvel, &d.qvel);
    row(&mut m.key_act, &d.act);
    row(&mut m.key_mpos, &d.mocap_pos);
    row(&mut m.key_mquat, &d.mocap_quat);
    row(&mut m.key_ctrl, &d.ctrl);
    true
}

/// Sets the fields of stages that the plan leaves out to the values that these stages would compute.
pub(crate) fn clear_omitted_fields(m: &Model, d: &mut Fields, s: &mut StepScratch) {
    if !d.plan.has(PlanFlag::General) {
        mass::constant(m, d);
    }
    if d.plan.keeps(Stage::Actuation) && !d.plan.keeps(Stage::Transmission) {
        transmission::transmissions(m, d, &mut s.forces);
    }
    if !d.plan.keeps(Stage::Actuation) {
        d.actuator_force.fill(0.0);
        d.qfrc_actuator.fill(0.0);
    }
    if !d.plan.keeps(Stage::Sleep) && asleep::some(m, d) {
        sleep::wake_all(m, d);
    }
    if !d.plan.keeps(Stage::Passive) {
        d.qfrc_passive.fill(0.0);
    }
    if !d.plan.keeps(Stage::Constraint) {
        constraint::none(d, &mut s.constraint);
    } else if !d.plan.keeps(Stage::Collision) {
        collision::none(d);
    }
    if !d.plan.keeps(Stage::Solve) {
        d.qfrc_constraint.fill(0.0);
        (d.solver_niter, d.nisland) = (0, 0);
    }
    if !d.plan.keeps(Stage::Energy) {
        d.energy = [0.0; 2];
    }
    if !d.plan.has(PlanFlag::Springs) {
        d.qfrc_spring.fill(0.0);
    }
    if !d.plan.has(PlanFlag::Dampers) {
        d.qfrc_damper.fill(0.0);
    }
    if !d.plan.has(PlanFlag::BodyForces) {
        d.qfrc_gravcomp.fill(0.0);
        d.qfrc_fluid.fill(0.0);
    }
    if !d.plan.has(PlanFlag::Adhesion) {
        d.qfrc_adhesion.fill(0.0);
    }
}
