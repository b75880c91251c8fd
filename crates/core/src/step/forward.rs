//! `mj_forward`: the order of the stages, each a call to the module that holds its formula.

use super::{damping, discrete, sleep};
use crate::dynamics::{articulated, camera, chain, com, jacobian, kinematics, mass, rne, subtree};
use crate::forces::{actuation, energy, passive, tendon, transmission};
use crate::kinds::{disable, enable, integrator};
use crate::math::{combine, copy, rows};
use crate::model::stage::Stage;
use crate::model::{Fields, Model, Warning};
use crate::sensor::{self, When, body_force};
use crate::step::data::Data;
use crate::{collision, constraint};

/// What a caller can leave out of a forward pass.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Skip(u8);

impl Skip {
    pub(crate) const NOTHING: Skip = Skip(0);
    /// Sensors: Runge–Kutta stages between steps do not show. The energy is that of the last stage, in MuJoCo as here.
    pub(crate) const SENSORS: Skip = Skip(1);
}

/// Computes everything that follows from the state, without advancing time (`mj_forward`).
pub fn forward(m: &Model, d: &mut Data) {
    forward_skip(m, d, Skip::NOTHING);
}

pub(crate) fn forward_skip(m: &Model, d: &mut Data, skip: Skip) {
    from_state(m, d, skip);
    from_inputs(m, d, skip);
}

/// What follows from positions and velocities, with the sensors and the energy that they determine.
pub(crate) fn from_state(m: &Model, d: &mut Data, skip: Skip) {
    let half = d.meter.half;
    d.meter.add(half);
    position(m, d);
    read(m, d, When::Position, skip);
    potential_energy(m, d, skip);
    velocity(m, d);
    read(m, d, When::Velocity, skip);
    kinetic_energy(m, d);
}

/// What follows from inputs as well: forces, accelerations and the other sensors.
pub(super) fn from_inputs(m: &Model, d: &mut Data, skip: Skip) {
    let half = d.meter.half;
    d.meter.add(half);
    sleep::keep(m, &d.fields, &mut d.work.sleep);
    actuation(m, d);
    acceleration(m, d);
    sleep::put_back(m, &mut d.fields, &d.work.sleep);
    constraints(m, d);
    read(m, d, When::Acceleration, skip);
    sleep::passed(&mut d.work.sleep);
}

/// The same, and what follows from velocities.
pub(crate) fn from_velocities(m: &Model, d: &mut Data) {
    velocity(m, d);
    read(m, d, When::Velocity, Skip::NOTHING);
    kinetic_energy(m, d);
    from_inputs(m, d, Skip::NOTHING);
}

/// What depends on `qpos` alone.
pub(crate) fn position(m: &Model, d: &mut Data) {
    if POSES.iter().any(|&stage| d.plan.keeps(stage)) {
        poses(m, d);
    }
    inertia_and_constraints(m, d);
}

/// Where things are: a scene whose trees have their equations in closed form needs none of it.
const POSES: [Stage; 8] = [
    Stage::Sleep,
    Stage::Kinematics,
    Stage::Orientations,
    Stage::GeomPoses,
    Stage::SitePoses,
    Stage::ComPos,
    Stage::CameraPoses,
    Stage::Tendon,
];

#[inline(never)]
fn poses(m: &Model, d: &mut Data) {
    if d.plan.keeps(Stage::Sleep) {
        sleep::wake(m, &mut d.fields, &mut d.work.sleep);
    }
    if d.plan.keeps(Stage::Kinematics) {
        kinematics::bodies(m, &mut d.fields, &mut d.work.dynamics);
    }
    if d.plan.keeps(Stage::Orientations) {
        kinematics::orientations(&mut d.fields, &mut d.work.dynamics);
    }
    if d.plan.keeps(Stage::GeomPoses) {
        kinematics::geoms(m, d);
    }
    if d.plan.keeps(Stage::SitePoses) {
        kinematics::sites(m, d);
    }
    if d.plan.keeps(Stage::ComPos) {
        com::com_pos(m, d);
    }
    if d.plan.keeps(Stage::CameraPoses) {
        camera::cameras(m, d);
        camera::lights(m, d);
    }
    if d.plan.keeps(Stage::Tendon) {
        tendon::tendons(m, d);
    }
    if d.plan.keeps(Stage::Sleep) {
        sleep::wake_by_tendons(m, d);
    }
}

/// Where things are and M, without what touches: what energies follow from.
pub(crate) fn placed(m: &Model, d: &mut Data) {
    poses(m, d);
    mass_matrix(m, d, d.plan.composite);
}

fn inertia_and_constraints(m: &Model, d: &mut Data) {
    let composite = d.plan.composite && !d.plan.mass_for_rows;
    if d.plan.keeps(Stage::MassMatrix) {
        mass_matrix(m, d, composite);
    }
    if d.plan.keeps(Stage::Factor) && !d.plan.mass_for_rows {
        let bad = articulated::factor(m, &mut d.fields, &mut d.work.dynamics);
        check_inertia(d, bad);
    }
    if d.plan.keeps(Stage::Collision) {
        if m.opt.disabled(disable::CONSTRAINT) || m.opt.disabled(disable::CONTACT) || d.meter.over() {
            collision::none(d);
        } else {
            collision::collide(m, &mut d.fields, &mut d.work.collision);
            if sleep::wake_touched(m, d) {
                collision::collide(m, &mut d.fields, &mut d.work.collision);
            }
        }
    }
    if d.plan.keeps(Stage::Sleep) {
        sleep::wake_by_equalities(m, d);
    }
    if d.plan.keeps(Stage::Constraint) {
        constraint::make(m, &mut d.fields, &mut d.work.constraint);
        if d.plan.mass_for_rows && d.nefc > 0 {
            if d.plan.composite {
                mass_matrix(m, d, true);
            }
            let bad = articulated::factor(m, &mut d.fields, &mut d.work.dynamics);
            check_inertia(d, bad);
        }
    }
    if d.plan.keeps(Stage::Transmission) {
        transmission::transmissions(m, &mut d.fields, &mut d.work.forces);
    }
}

/// Warns of a degree of freedom without inertia.
fn check_inertia(d: &mut Fields, bad: Option<usize>) {
    if let Some(dof) = bad {
        d.warn(Warning::Inertia, dof);
    }
}

/// `M`, with or without what follows from composite inertias.
#[inline(always)]
fn mass_matrix(m: &Model, d: &mut Data, composite: bool) {
    if composite {
        mass::composite_inertia(m, &mut d.fields, &mut d.work.dynamics, true);
    } else if d.plan.simple_bodies {
        mass::simple_diagonal(m, d);
    }
    chain::mass_matrix(m, &mut d.fields, &mut d.work.dynamics);
    if m.ntendon > 0 {
        tendon::armature(m, d);
    }
}

/// What depends on `qvel` as well.
pub(crate) fn velocity(m: &Model, d: &mut Data) {
    if d.plan.keeps(Stage::TendonVel) {
        tendon::velocities(m, d);
    }
    if d.plan.keeps(Stage::ActuatorVel) {
        transmission::velocities(m, d);
    }
    if d.plan.keeps(Stage::ComVel) {
        com::com_vel(m, d);
    }
    if d.plan.keeps(Stage::Passive) {
        passive::passive(m, d);
    }
    if d.plan.keeps(Stage::Reference) {
        constraint::reference(m, &mut d.fields, &d.work.constraint);
    }
    if d.plan.keeps(Stage::Bias) {
        rne::bias(m, &mut d.fields, &mut d.work.dynamics);
        tendon::bias(m, d);
    }
}

/// Forces of actuators: what depends on `ctrl` and `act` as well.
pub(crate) fn actuation(m: &Model, d: &mut Data) {
    if d.plan.keeps(Stage::Actuation) {
        actuation::actuation(m, &mut d.fields, &mut d.work.forces);
    }
}

/// `qfrc_smooth` and `qacc_smooth` = M⁻¹ `qfrc_smooth`.
#[inline(never)]
pub(crate) fn acceleration(m: &Model, data: &mut Data) {
    let Data { fields: d, work } = data;
    let forces = [&*d.qfrc_passive, &*d.qfrc_bias, &*d.qfrc_applied, &*d.qfrc_actuator];
    combine(&mut d.qfrc_smooth, forces, |_, [passive, bias, applied, actuator]| {
        passive - bias + applied + actuator
    });
    if d.plan.applied_forces {
        applied_forces(m, d);
    }
    work.damping.done = false;
    if m.opt.integrator == integrator::DISCRETE {
        discrete::acceleration(m, d, &mut work.metric, &mut work.derivative);
    } else if d.plan.some_general {
        let mut out = std::mem::take(&mut d.qacc_smooth);
        copy(&d.qfrc_smooth, &mut out);
        if d.plan.mass_for_rows && d.nefc == 0 {
            let euler = m.opt.integrator == integrator::EULER && damping::damps(m, d);
            let bad = match euler {
                true => damping::accelerate(m, d, &mut work.dynamics, &mut work.damping, &mut out),
                false => articulated::prepare(m, d, &mut work.dynamics, Some(&mut out)),
            };
            check_inertia(d, bad);
        } else {
            articulated::solve(m, d, &mut work.dynamics, &mut out);
        }
        d.qacc_smooth = out;
    } else {
        combine(&mut d.qacc_smooth, [&*d.qfrc_smooth, &*d.qLDiagInv], |_, [f, inv]| f * inv);
    }
}

/// Adds Jᵀ f for the force and torque applied at each body's centre of mass.
fn applied_forces(m: &Model, d: &mut Fields) {
    let mut out = std::mem::take(&mut d.qfrc_smooth);
    for b in 1..m.nbody {
        let [fx, fy, fz, tx, ty, tz] = rows::<6>(&d.xfrc_applied)[b];
        if [fx, fy, fz, tx, ty, tz] != [0.0; 6] {
            jacobian::apply(m, d, b, rows::<3>(&d.xipos)[b], [fx, fy, fz], [tx, ty, tz], &mut out);
        }
    }
    d.qfrc_smooth = out;
}

/// `qacc` and constraint forces.
pub(crate) fn constraints(m: &Model, data: &mut Data) {
    let Data { fields: d, work } = data;
    let on_discrete = m.opt.integrator == integrator::DISCRETE;
    if d.plan.keeps(Stage::Solve) {
        if on_discrete {
            discrete::constraints(m, d, &mut work.metric, &mut work.constraint);
        } else {
            constraint::solve(m, d, &mut work.constraint);
        }
    } else {
        copy(&d.qacc_smooth, &mut d.qacc);
    }
    if on_discrete {
        discrete::turn_free_bodies(m, d, &work.metric, &mut work.derivative, &work.constraint);
    }
}

/// Sensors whose values are known at this point, and what they need.
#[inline(always)]
pub(crate) fn read(m: &Model, d: &mut Data, when: When, skip: Skip) {
    let kept = [Stage::Sensors, Stage::SubtreeVel, Stage::RnePost].map(|stage| d.plan.keeps(stage));
    if skip == Skip::NOTHING && kept != [false; 3] {
        measure(m, d, when);
    }
}

#[inline(never)]
fn measure(m: &Model, d: &mut Data, when: When) {
    match when {
        When::Velocity if measured(m, d, Stage::SubtreeVel) => subtree::subtree_vel(m, d),
        When::Acceleration if measured(m, d, Stage::RnePost) => body_force::rne_post_constraint(m, d),
        _ => {}
    }
    if d.plan.keeps(Stage::Sensors) {
        sensor::evaluate(m, &mut d.fields, &mut d.work.sensor, when);
    }
}

/// Whether a stage runs that nothing but sensors needs: its fields stay as they are when there is none, or when
/// sensors are switched off.
fn measured(m: &Model, d: &Data, stage: Stage) -> bool {
    d.plan.keeps(stage) && !m.opt.disabled(disable::SENSOR) && sensor::needs(m, stage)
}

/// `energy[0]`, or zeros when the flag is off and no sensor has just computed it.
fn potential_energy(m: &Model, d: &mut Data, skip: Skip) {
    if d.plan.keeps(Stage::Energy) {
        if m.opt.enabled(enable::ENERGY) {
            energy::potential(m, d);
        } else if skip == Skip::SENSORS || m.opt.disabled(disable::SENSOR) || !sensor::measures_potential(m) {
            d.energy = [0.0; 2];
        }
    }
}

/// `energy[1]`.
fn kinetic_energy(m: &Model, d: &mut Data) {
    if d.plan.keeps(Stage::Energy) && m.opt.enabled(enable::ENERGY) {
        energy::kinetic(m, d);
    }
}
