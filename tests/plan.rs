//! A plan never changes a number: planned and full runs agree bit for bit on every field that is read, for random scenes,
//! access sets and writes.

#![allow(clippy::unwrap_used)]

use crate::scenes::constrained_scene;
use crate::support::{compile, model};
use labspec_core::reflect::{self, FieldId, FieldSet, Object, Stage};
use labspec_core::{self as core, AccessSet, Data, Model, Plan, Planned, Scope, enable};
use proptest::collection::vec;
use proptest::prelude::*;

/// The fields that programs may write in these tests, each with a value that has an effect.
const WRITES: &[(Object, &str, f64)] = &[
    (Object::Data, "qpos", 0.07),
    (Object::Data, "qvel", -0.8),
    (Object::Data, "qfrc_applied", 0.6),
    (Object::Data, "ctrl", 0.7),
    (Object::Data, "xfrc_applied", 0.9),
    (Object::Data, "mocap_pos", -0.15),
    (Object::Option, "gravity", 3.0),
    (Object::Option, "timestep", 0.003),
    (Object::Option, "enableflags", (enable::ENERGY | enable::OVERRIDE) as f64),
    (Object::Option, "disableflags", core::disable::CONTACT as f64),
    (Object::Option, "integrator", 1.0),
    (Object::Option, "integrator", 2.0),
    (Object::Option, "integrator", 3.0),
    (Object::Option, "integrator", 4.0),
    (Object::Option, "impratio", 3.0),
    (Object::Option, "o_solref", 0.04),
    (Object::Model, "geom_solref", 0.03),
    (Object::Model, "geom_solimp", 0.8),
    (Object::Model, "geom_friction", 0.3),
    (Object::Model, "geom_condim", 1.0),
    (Object::Model, "geom_priority", 1.0),
    (Object::Model, "geom_margin", 0.02),
    (Object::Model, "geom_gap", 0.01),
    (Object::Model, "geom_contype", 0.0),
    (Object::Model, "geom_conaffinity", 3.0),
    (Object::Model, "geom_size", 0.06),
    (Object::Model, "geom_pos", 0.02),
    (Object::Model, "body_pos", 0.1),
    (Object::Model, "body_mass", 2.5),
    (Object::Model, "body_inertia", 0.02),
    (Object::Model, "body_ipos", 0.03),
    (Object::Model, "dof_damping", 0.4),
    (Object::Model, "dof_armature", 0.02),
    (Object::Model, "jnt_stiffness", 2.0),
    (Object::Model, "jnt_limited", 1.0),
    (Object::Model, "qpos_spring", 0.2),
    (Object::Model, "jnt_stiffnesspoly", 0.3),
    (Object::Model, "dof_dampingpoly", 0.2),
    (Object::Model, "tendon_stiffness", 3.0),
    (Object::Model, "tendon_damping", 0.5),
    (Object::Model, "tendon_armature", 0.1),
    (Object::Model, "tendon_lengthspring", 0.3),
    (Object::Model, "wrap_prm", 1.5),
    (Object::Model, "actuator_gainprm", 4.0),
    (Object::Model, "actuator_biasprm", -1.5),
    (Object::Model, "actuator_gear", 1.5),
    (Object::Model, "actuator_forcerange", 0.3),
    (Object::Model, "actuator_damping", 0.6),
    (Object::Data, "eq_active", 0.0),
    (Object::Data, "eq_active", 1.0),
    (Object::Model, "eq_active0", 0.0),
    (Object::Model, "actuator_ctrlrange", 0.2),
    (Object::Model, "jnt_actfrcrange", 0.1),
    (Object::Model, "jnt_actgravcomp", 1.0),
    (Object::Model, "body_contype", 0.0),
    (Object::Model, "body_conaffinity", 2.0),
    (Object::Option, "disableactuator", 1.0),
    (Object::Model, "eq_solref", 0.05),
    (Object::Model, "dof_frictionloss", 0.3),
    (Object::Option, "cone", 1.0),
    (Object::Option, "solver", 0.0),
    (Object::Option, "noslip_iterations", 2.0),
    (Object::Model, "site_pos", 0.05),
    (Object::Model, "body_gravcomp", 0.7),
    (Object::Option, "density", 2.0),
    (Object::Option, "viscosity", 0.1),
    (Object::Option, "wind", 0.4),
];

/// An event before a step: one element of a field is written, constants are recomputed, or the simulation is reset.
#[derive(Clone, Debug)]
enum Event {
    Write { step: usize, field: usize, element: prop::sample::Index },
    SetConst { step: usize },
    Reset { step: usize },
    Forward { step: usize },
}

/// The number of steps of a run.
const STEPS: usize = 50;

fn event() -> impl Strategy<Value = Event> {
    let write = (0..STEPS, 0..WRITES.len(), any::<prop::sample::Index>())
        .prop_map(|(step, field, element)| Event::Write { step, field, element });
    prop_oneof![
        6 => write,
        1 => (0..STEPS).prop_map(|step| Event::SetConst { step }),
        1 => (0..STEPS).prop_map(|step| Event::Reset { step }),
        1 => (0..STEPS).prop_map(|step| Event::Forward { step }),
    ]
}

pub(crate) fn field(object: Object, name: &str) -> FieldId {
    reflect::field(object, name).unwrap()
}

fn apply<S: Scope>(event: &Event, now: usize, m: &mut Model, d: &mut Data<S>) {
    match event {
        Event::Write { step, field: f, element } if *step == now => {
            let (object, name, value) = WRITES[*f];
            let mut view = core::view_mut(m, d, field(object, name)).unwrap();
            let len = match &view {
                reflect::ViewMut::F64(v) => v.len(),
                reflect::ViewMut::I32(v) => v.len(),
                reflect::ViewMut::Bool(v) => v.len(),
                reflect::ViewMut::Fixed => 0,
            };
            if len > 0 {
                view.set(element.index(len), value);
            }
        }
        Event::SetConst { step } if *step == now => core::set_const(m, d).unwrap(),
        Event::Reset { step } if *step == now => core::reset_data(m, d).unwrap(),
        Event::Forward { step } if *step == now => core::forward(m, d).unwrap(),
        _ => {}
    }
}

/// The bits of a field. All NaN values count as equal, because their bits depend on the order of the operands.
fn bits<S: Scope>(m: &Model, d: &Data<S>, f: FieldId) -> Vec<u64> {
    let bits = |x: f64| if x.is_nan() { f64::NAN.to_bits() } else { x.to_bits() };
    (0..core::length(m, d, f)).map(|i| bits(core::element(m, d, f, i).unwrap())).collect()
}

/// Runs a scene with a plan and with the full pipeline; returns the first field that differs, with its step.
fn difference(m: &Model, access: &AccessSet, events: &[Event]) -> Option<String> {
    difference_of(m, Data::planned(m, Plan::new(m, access)), access, events)
}

/// The same for data with a given plan.
fn difference_of(
    m: &Model,
    mut planned: Data<Planned>,
    access: &AccessSet,
    events: &[Event],
) -> Option<String> {
    let (mut m1, mut m2) = (m.clone(), m.clone());
    let mut full = Data::unplanned(m);
    for step in 0..STEPS {
        for event in events {
            apply(event, step, &mut m1, &mut planned);
            apply(event, step, &mut m2, &mut full);
        }
        core::step(&m1, &mut planned).unwrap();
        core::step(&m2, &mut full).unwrap();
        for f in access.reads.iter() {
            let (mut a, mut b) = (bits(&m1, &planned, f), bits(&m2, &full, f));
            // Of the sensors, only those that are read.
            for (i, (a, b)) in a.iter_mut().zip(&mut b).enumerate() {
                if !access.reads.contains_element(f, i) {
                    (*a, *b) = (0, 0);
                }
            }
            if a != b {
                let name = f.info().name;
                let numbers = |v: &[u64]| v.iter().map(|&x| f64::from_bits(x)).collect::<Vec<_>>();
                return Some(format!(
                    "after step {step}, {name}: planned {:?}, full {:?}",
                    numbers(&a),
                    numbers(&b)
                ));
            }
        }
    }
    None
}

/// The fields of the data, some of which an access set contains.
pub(crate) fn data_fields() -> Vec<FieldId> {
    reflect::fields().filter(|f| f.info().object == Object::Data).collect()
}

/// The fields that the events write, as the programs of a lab would declare them.
fn writes(events: &[Event]) -> FieldSet {
    let mut set = FieldSet::EMPTY;
    for event in events {
        if let Event::Write { field: f, .. } = event {
            set.insert(field(WRITES[*f].0, WRITES[*f].1));
        }
    }
    set
}

/// Scenes with sensors.
fn sensing() -> impl Strategy<Value = crate::scenes::Scene> {
    (constrained_scene(), vec(0..crate::scenes::SENSORS.len(), 1..6)).prop_map(|(mut scene, sensors)| {
        scene.sensors = sensors;
        scene
    })
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, ..ProptestConfig::default() })]

    #[test]
    fn planned_and_full_runs_agree_on_what_is_read(
        scene in constrained_scene(),
        reads in vec(any::<prop::sample::Index>(), 0..6),
        events in vec(event(), 0..6),
    ) {
        let m = compile(&scene.xml());
        let all = data_fields();
        let mut access = AccessSet { reads: FieldSet::EMPTY, writes: writes(&events) };
        reads.iter().for_each(|i| access.reads.insert(*i.get(&all)));
        // Every lab displays the state.
        for name in ["time", "qpos", "qvel"] {
            access.reads.insert(field(Object::Data, name));
        }
        let difference = difference(&m, &access, &events);
        prop_assert!(difference.is_none(), "{}", difference.unwrap_or_default());
    }

    /// The same with writes that the plan does not contain, and with a plan for any values.
    #[test]
    fn unannounced_writes_take_effect(
        scene in constrained_scene(),
        reads in vec(any::<prop::sample::Index>(), 0..6),
        events in vec(event(), 0..6),
    ) {
        let m = compile(&scene.xml());
        let mut access = AccessSet { reads: FieldSet::EMPTY, writes: FieldSet::EMPTY };
        reads.iter().for_each(|i| access.reads.insert(*i.get(&data_fields())));
        for name in ["time", "qpos", "qvel"] {
            access.reads.insert(field(Object::Data, name));
        }
        let announced = AccessSet { writes: writes(&events), ..access };
        let difference = difference(&m, &access, &events)
            .or_else(|| difference_of(&m, Data::planned(&m, Plan::for_any_value(&m, &announced)), &announced, &events));
        prop_assert!(difference.is_none(), "{}", difference.unwrap_or_default());
    }

    /// Sensors are left out individually.
    #[test]
    fn planned_and_full_runs_agree_on_the_sensors_that_are_read(
        scene in sensing(),
        reads in vec(any::<prop::sample::Index>(), 1..3),
        others in vec(any::<prop::sample::Index>(), 0..2),
        events in vec(event(), 0..4),
    ) {
        let m = compile(&scene.xml());
        let mut access = AccessSet { reads: FieldSet::EMPTY, writes: writes(&events) };
        others.iter().for_each(|i| access.reads.insert(*i.get(&data_fields())));
        let sensors: Vec<core::SensorId> = m.sensors().collect();
        for i in &reads {
            let places = i.get(&sensors).values(&m);
            access.reads.insert_elements(field(Object::Data, "sensordata"), places.start, Some(places.len()));
        }
        let difference = difference(&m, &access, &events);
        prop_assert!(difference.is_none(), "{}", difference.unwrap_or_default());
    }

    /// The measurement of `labspec plan`: an additional stage, and a clock between the stages.
    #[test]
    fn an_additional_stage_and_a_clock_change_no_number(
        scene in constrained_scene(),
        reads in vec(any::<prop::sample::Index>(), 0..4),
        more in any::<prop::sample::Index>(),
        events in vec(event(), 0..4),
    ) {
        let m = compile(&scene.xml());
        let mut access = AccessSet { reads: FieldSet::EMPTY, writes: writes(&events) };
        reads.iter().for_each(|i| access.reads.insert(*i.get(&data_fields())));
        for name in ["time", "qpos", "qvel"] {
            access.reads.insert(field(Object::Data, name));
        }
        let stages: Vec<Stage> = Plan::full().decisions().iter().map(|d| d.stage).collect();
        let plan = Plan::with(&m, &access, *more.get(&stages));
        prop_assert!(plan.keeps(*more.get(&stages)));
        let mut data = Data::planned(&m, plan);
        core::clock(&mut data, || 0);
        let difference = difference_of(&m, data, &access, &events);
        prop_assert!(difference.is_none(), "{}", difference.unwrap_or_default());
    }

    #[test]
    fn a_plan_for_any_value_equals_the_full_run(scene in constrained_scene(), events in vec(event(), 0..4)) {
        let m = compile(&scene.xml());
        let mut access = AccessSet { reads: FieldSet::EMPTY, writes: writes(&events) };
        data_fields().into_iter().for_each(|f| access.reads.insert(f));
        let difference = difference(&m, &access, &events);
        prop_assert!(difference.is_none(), "{}", difference.unwrap_or_default());
    }
}

/// An access set that reads these fields of the data and writes nothing.
pub(crate) fn reading(names: &[&str]) -> AccessSet {
    let mut access = AccessSet { reads: FieldSet::EMPTY, writes: FieldSet::EMPTY };
    names.iter().for_each(|n| access.reads.insert(field(Object::Data, n)));
    access
}

/// Forces outside the plan's access set act: the plan is recomputed.
#[test]
fn an_unannounced_force_acts() {
    let m = model("free_fall");
    let mut planned = Data::planned(&m, Plan::new(&m, &reading(&["qvel"])));
    let mut full = Data::unplanned(&m);
    for step in 0..20 {
        if step == 10 {
            planned.edit().xfrc_applied[6] = 3.0;
            full.edit().xfrc_applied[6] = 3.0;
        }
        if step == 15 {
            planned.edit().qfrc_applied[1] = -2.0;
            full.edit().qfrc_applied[1] = -2.0;
        }
        core::step(&m, &mut planned).unwrap();
        core::step(&m, &mut full).unwrap();
    }
    assert!(full.qvel[0] > 0.0 && full.qvel[1] < 0.0);
    assert_eq!(bits(&m, &planned, field(Object::Data, "qvel")), bits(&m, &full, field(Object::Data, "qvel")));
}

/// Parameters that the plan assumed constant may change: the plan is recomputed.
#[test]
fn an_unannounced_parameter_takes_effect() {
    check_unannounced_change(model("pendulum"), |m| {
        m.edit().dof_damping[0] = 0.7;
        m.edit().body_mass[1] *= 2.0;
    });
}

/// The same holds for parameters of the derivatives of forces with respect to velocities, which are analysed once.
#[test]
fn an_unannounced_derivative_takes_effect() {
    let slide = "<mujoco><option integrator='implicitfast'/><worldbody><body><joint name='x' type='slide' damping='1'/>\
                 <geom size='.1'/></body></worldbody><actuator><position joint='x' kp='90' kv='5'/></actuator></mujoco>";
    check_unannounced_change(compile(slide), |m| m.edit().actuator_biasprm[2] = -40.0);
    check_unannounced_change(compile(slide), |m| m.edit().dof_damping[0] = 30.0);
}

/// Planned steps before and after `change` give the same result as full steps after it.
fn check_unannounced_change(mut m: Model, change: impl Fn(&mut Model)) {
    let mut planned = Data::planned(&m, Plan::new(&m, &reading(&["qpos"])));
    planned.edit().qvel[0] = 1.0;
    core::step(&m, &mut planned).unwrap();
    change(&mut m);
    let mut full = Data::unplanned(&m);
    core::state::copy(&m, &planned, &mut full, core::state::INTEGRATION).unwrap();
    for _ in 0..20 {
        core::step(&m, &mut planned).unwrap();
        core::step(&m, &mut full).unwrap();
    }
    assert_eq!(bits(&m, &planned, field(Object::Data, "qpos")), bits(&m, &full, field(Object::Data, "qpos")));
}
