//! No integer causes a panic or an endless loop. A stored model with any integers is refused or can be stepped. With any integers
//! that a caller writes to the data, every stage ends. The cases are generated from the table of fields.

use crate::dynamics;
use crate::mjcf::compile;
use crate::model::Model;
use crate::model::reflect::{self, Elem, FieldId, Object, View};
use crate::step::workspace::Workspace;
use crate::step::{forward, inverse, save};
use crate::step::{step, step1, step2, validate::validate};
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::time::Duration;

/// A scene with an object of every kind that another object can refer to by a number.
const EVERYTHING: &str = "<mujoco><option><flag sleep='enable'/></option>
    <asset><mesh name='m' vertex='0 0 0 1 0 0 0 1 0 0 0 1'/><hfield name='h' nrow='2' ncol='2' size='1 1 1 1'/>
    <material name='paint' rgba='1 0 0 1'/></asset>
    <worldbody><geom name='ground' type='hfield' hfield='h'/><geom name='floor' type='plane' size='9 9 1'/>
    <camera name='eye' pos='0 0 3' resolution='2 1'/><light pos='0 0 3'/><body name='hand' mocap='true'><geom size='.1'/></body>
    <body name='a' pos='0 0 .2'><freejoint/><geom name='rock' type='mesh' mesh='m'/><site name='s' size='.3'/></body>
    <body name='b' pos='3 0 .05'><joint name='j' axis='0 1 0' range='-90 90'/><geom name='u' size='.1' material='paint'/><site name='t' pos='1 0 0'/>
    <body pos='1 0 0'><joint name='k' axis='0 1 0' frictionloss='.1'/><geom name='w' size='.1'/><site name='x'/></body></body>
    <body name='c' pos='3 3 1'><joint name='ball' type='ball'/><geom type='capsule' size='.1 .2'/><site name='y'/></body>
    <body name='lazy' pos='5 5 .1' sleep='init'><freejoint/><geom type='box' size='.1 .1 .1'/></body>
    <body name='lazier' pos='5 5 .3' sleep='init'><freejoint/><geom type='box' size='.1 .1 .1'/></body>
    <body name='awake' pos='7 5 .1'><freejoint/><geom type='box' size='.1 .1 .1'/></body></worldbody>
    <contact><pair geom1='rock' geom2='u'/><exclude body1='c' body2='b'/></contact>
    <tendon><spatial name='l' limited='true' range='0 1'><site site='s'/><geom geom='w' sidesite='x'/><site site='t'/></spatial>
    <fixed name='f'><joint joint='j' coef='1'/><joint joint='k' coef='2'/></fixed></tendon>
    <equality><connect body1='a' body2='b' anchor='0 0 0'/><weld site1='s' site2='t'/><joint joint1='j' joint2='k'/></equality>
    <actuator><motor name='x0' joint='j'/><position tendon='l'/><general joint='k' dyntype='filter' dynprm='.1' delay='.004' nsample='3'/>
    <motor site='x' refsite='t' gear='1 0 0 0 1 0'/><general slidersite='x' cranksite='t' cranklength='1'/>
    <adhesion body='b' ctrlrange='0 1'/><muscle joint='j' lengthrange='0 1'/></actuator>
    <sensor><jointpos joint='j'/><touch site='s'/><framepos objtype='body' objname='a' reftype='site' refname='t'/>
    <contact subtree1='a' geom2='ground' num='2'/><contact body1='a' num='1' reduce='netforce'/><contact site='s' num='2'/>
    <rangefinder site='s'/><rangefinder camera='eye'/><distance body1='a' body2='b' cutoff='9'/><camprojection site='s' camera='eye'/>
    <insidesite site='s' objtype='body' objname='b'/><tendonpos tendon='l'/><actuatorfrc actuator='x0'/><user dim='2'/>
    <subtreecom body='b'/><gyro site='x' delay='.004' nsample='2'/></sensor>
    <keyframe><key/></keyframe></mujoco>";

const VALUES: [i32; 10] = [i32::MIN, -12, -2, -1, 0, 1, 2, 7, 1000, i32::MAX];
/// The work limit of a case. Beyond it stages are left out, as in a run whose budget is spent.
const BUDGET: u64 = 3_000_000;

fn model_with_all_features() -> Model {
    compile(EVERYTHING).unwrap()
}

/// Runs a test on a separate thread, and fails if it does not end.
fn ends(test: fn()) {
    let (sender, done) = channel();
    let thread = std::thread::spawn(move || {
        test();
        let _ = sender.send(());
    });
    match done.recv_timeout(Duration::from_secs(500)) {
        Err(RecvTimeoutError::Timeout) => panic!("a case does not end"),
        _ => thread.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic)),
    }
}

fn integers(object: Object, among: fn(FieldId) -> bool) -> impl Iterator<Item = FieldId> {
    let is = move |f: &FieldId| f.info().object == object && matches!(f.info().elem, Elem::I32 | Elem::Bool);
    reflect::fields().filter(is).filter(move |&f| among(f))
}

/// Calls every function that a caller can call.
fn call_all(m: &Model, Workspace { fields: d, scratch: s }: &mut Workspace) {
    d.meter.set_left(BUDGET);
    forward::contacts(m, d, s);
    dynamics::kinematics(m, &mut d.clone(), &mut s.clone().dynamics);
    forward::forward(m, &mut d.clone(), &mut s.clone());
    let _ = inverse::inverse(m, &mut d.clone(), &mut s.clone());
    let (mut other, mut other_scratch) = (d.clone(), s.clone());
    step1(m, &mut other, &mut other_scratch);
    step2(m, &mut other, &mut other_scratch);
    let bytes = save::save(m, d);
    let _ = save::restore(m, &mut other, &mut other_scratch, &bytes);
    (0..3).for_each(|_| step(m, d, s));
}

#[test]
fn accepted_stored_models_can_be_stepped() {
    ends(|| {
        let m = model_with_all_features();
        assert_eq!(validate(&m), None);
        let (mut accepted, mut refused, mut fatal) = (0, 0, Vec::new());
        for field in integers(Object::Model, |_| true).chain(integers(Object::Option, |_| true)) {
            for i in 0..reflect::view_model(&m, field).len() {
                for value in VALUES {
                    let mut changed = m.clone();
                    reflect::view_model_mut(&mut changed, field).set(i, f64::from(value));
                    if validate(&changed).is_some() {
                        refused += 1;
                        continue;
                    }
                    accepted += 1;
                    let run = std::panic::AssertUnwindSafe(|| {
                        let Workspace { fields: mut d, scratch: mut s } = Workspace::new(&changed);
                        d.meter.set_left(BUDGET);
                        (0..2).for_each(|_| step(&changed, &mut d, &mut s));
                    });
                    if std::panic::catch_unwind(run).is_err() {
                        fatal.push(format!("{}[{i}] = {value}", field.info().name));
                    }
                }
            }
        }
        assert_eq!(fatal, [""; 0], "accepted, and a step ends in a panic");
        assert!(accepted > 500 && refused > 1000, "{accepted} {refused}");
    });
}

#[test]
fn written_integers_of_the_data_cause_no_panic() {
    ends(|| {
        let m = model_with_all_features();
        let mut start = Workspace::new(&m);
        (0..2).for_each(|_| step(&m, &mut start.fields, &mut start.scratch));
        assert!(start.fields.tree_asleep.iter().any(|&next| next >= 0), "nothing sleeps");
        let mut written = Vec::new();
        for field in integers(Object::Data, reflect::is_writable) {
            let n = match reflect::view_data(&start.fields, field) {
                View::I32(list) => list.len(),
                View::Bool(list) => list.len(),
                _ => 0,
            };
            written.push(field.info().name);
            for i in 0..n {
                for value in VALUES {
                    // Writes one element, then all of them.
                    let mut d = start.clone();
                    reflect::view_data_mut(&mut d.fields, field).set(i, f64::from(value));
                    call_all(&m, &mut d);
                    for k in 0..n {
                        reflect::view_data_mut(&mut d.fields, field).set(k, f64::from(value));
                    }
                    call_all(&m, &mut d);
                }
                // Makes each tree follow another in the sleep cycle: cycles that the engine did not create.
                for next in 0..n {
                    let mut d = start.clone();
                    reflect::view_data_mut(&mut d.fields, field).set(i, next as f64);
                    call_all(&m, &mut d);
                }
            }
        }
        assert_eq!(written, ["eq_active", "tree_asleep"]);
    });
}

/// A regression test for an endless loop: an integer is written for a sleeping tree while an awake tree touches it.
#[test]
fn a_written_circle_of_sleeping_trees_wakes() {
    ends(|| {
        let m = compile(
            "<mujoco><option><flag sleep='enable'/></option><worldbody><geom type='plane' size='9 9 1'/>
             <body pos='0 0 .1'><freejoint/><geom size='.1'/></body>
             <body name='b' pos='.25 0 .1' sleep='init'><freejoint/><geom size='.1'/></body>
             <body name='c' pos='3 0 .1' sleep='init'><freejoint/><geom size='.1'/></body></worldbody></mujoco>",
        )
        .unwrap();
        for next in 0..3 {
            let Workspace { fields: mut d, scratch: mut s } = Workspace::new(&m);
            forward::forward(&m, &mut d, &mut s);
            d.geom_xpos[3] += 0.1;
            d.tree_asleep.copy_from_slice(&[next, 1, 2]);
            (d.tree_awake[0], d.tree_awake[1], d.tree_awake[2]) = (1, 0, 0);
            (d.ntree_awake, d.body_awake[2]) = (1, 0);
            forward::contacts(&m, &mut d, &mut s);
            assert!(d.tree_asleep[1] < 0, "{:?}", d.tree_asleep);
        }
    });
}

/// With an unlimited number of sweeps, the removal of slip ends when no slip remains. This includes a contact that is so stiff
/// that its forces are large and a change of friction is lost in their rounding.
#[test]
fn the_removal_of_slip_ends() {
    for (cone, tolerance) in [("pyramidal", 1e-6), ("elliptic", 1e-6), ("elliptic", -1.0)] {
        let option =
            format!("<option cone='{cone}' noslip_iterations='2147483647' noslip_tolerance='{tolerance}'>");
        let m = compile(&EVERYTHING.replace("<option>", &option)).unwrap();
        let Workspace { fields: mut d, scratch: mut s } = Workspace::new(&m);
        let mut most = 0;
        for _ in 0..20 {
            step(&m, &mut d, &mut s);
            most = most.max(d.solver_niter);
        }
        assert!(most < 5000, "{cone}, {tolerance}: {most} sweeps");
    }
}
