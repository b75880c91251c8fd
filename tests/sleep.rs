//! Sleeping trees: `golden/sleep.py` recorded when MuJoCo 3.14.0 puts trees to sleep, what wakes them, and the values
//! of their fields meanwhile.

#![allow(clippy::unwrap_used)]

use crate::recorded::{list, objects, worst};
use crate::support::{model, numbers, recording};
use labspec_core::reflect::{self, Object};
use labspec_core::{self as core, AccessSet, Data, Plan};

/// Only rounding, over stable steps.
const ROUNDING: f64 = 1e-12;
/// The tolerance if a solver works to a tolerance of 1e-12.
const SOLVED: f64 = 1e-8;
/// The removal of slip ends when its objective stops decreasing. The objective is flat at its minimum, so that its rounding
/// error of 1e-16 hides relative differences of forces of up to the square root of that, on both sides.
const SLIP_REMOVED: f64 = 2e-7;

fn differences(scene: &str, tolerance: f64) {
    let recorded = &recording("sleep")[scene];
    let mut wrong = Vec::new();
    for (name, run) in objects(&recorded["runs"]) {
        let tolerance = if name == "noslip" { SLIP_REMOVED } else { tolerance };
        let mut m = model(scene);
        let mut d = Data::new(&m);
        for (option, value) in objects(&run["options"]) {
            let field = reflect::field(Object::Option, option).unwrap();
            assert!(labspec_core::view_mut(&mut m, &mut d, field).unwrap().set(0, value.as_f64().unwrap()));
        }
        let mut d = Data::new(&m);
        let mut next = 0;
        for row in run["rows"].as_array().unwrap() {
            let step = row["step"].as_u64().unwrap();
            while next <= step {
                for write in recorded["writes"].as_array().unwrap().iter().filter(|w| w[0] == next) {
                    let field = reflect::field(Object::Data, write[1].as_str().unwrap()).unwrap();
                    let (element, value) = (write[2].as_u64().unwrap() as usize, write[3].as_f64().unwrap());
                    assert!(labspec_core::view_mut(&mut m, &mut d, field).unwrap().set(element, value));
                }
                core::step(&m, &mut d).unwrap();
                next += 1;
            }
            for (field, values) in objects(row).filter(|(field, _)| *field != "step") {
                let computed = list(&m, &d, reflect::field(Object::Data, field).unwrap());
                let recorded_values = numbers(values);
                let scale = recorded_values.iter().fold(1.0, |s: f64, x| s.max(x.abs()));
                let (i, difference) = worst(&computed, &recorded_values, scale);
                if difference > tolerance {
                    wrong.push(format!(
                        "{name}, step {step}: {field}[{i}]: ours {:?}, theirs {:?}",
                        computed.get(i),
                        recorded_values.get(i)
                    ));
                }
            }
        }
    }
    assert!(wrong.is_empty(), "{} differences:\n{}", wrong.len(), wrong[..wrong.len().min(30)].join("\n"));
}

#[test]
fn trees_sleep_and_wake_as_recorded() {
    differences("sleep", ROUNDING);
}

/// Boxes in a pile sleep together; a ball, a body that is moved from outside, a push or a lift wakes them.
#[test]
fn piles_sleep_and_wake_as_recorded() {
    differences("sleep_pile", SOLVED);
}

/// Limits, dry friction, equalities and tendons act on sleeping trees, and wake them.
#[test]
fn constrained_trees_sleep_and_wake_as_recorded() {
    differences("sleep_ties", SOLVED);
}

/// A plan that leaves out unread fields changes no bit of sleeping trees.
#[test]
fn a_plan_lets_trees_sleep_as_they_do() {
    for scene in ["sleep", "sleep_pile", "sleep_ties"] {
        let m = model(scene);
        let mut access = AccessSet { reads: Default::default(), writes: Default::default() };
        access.reads.insert(reflect::field(Object::Data, "tree_asleep").unwrap());
        let run = |plan: Plan| {
            let mut d = Data::planned(&m, plan);
            (0..300).for_each(|_| core::step(&m, &mut d).unwrap());
            (d.fields().tree_asleep.clone(), d.fields().qpos.clone())
        };
        assert_eq!(run(Plan::new(&m, &access)), run(Plan::full()), "{scene}");
    }
}
