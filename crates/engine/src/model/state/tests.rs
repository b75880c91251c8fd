//! Compares states with those of MuJoCo 3.14.0, recorded by `golden/record.py`.

use super::*;
use crate::model::reflect::Object;
use crate::step::reset::{reset_data_keyframe, set_keyframe};
use crate::step::step;
use crate::step::workspace::Workspace;
use crate::tests::compile;

const MODEL: &str = include_str!("golden/everything.xml");

fn model() -> Model {
    compile(MODEL).unwrap()
}

/// The name and the numbers of each recorded line.
fn recorded() -> Vec<(&'static str, Vec<f64>)> {
    let line = |line: &'static str| {
        let mut words = line.split(' ');
        (words.next().unwrap(), words.map(|w| w.parse().unwrap()).collect())
    };
    include_str!("golden/everything.txt").lines().map(line).collect()
}

fn state(m: &Model, d: &Fields, sig: i32) -> Vec<f64> {
    let mut out = vec![f64::NAN; size(m, sig).unwrap()];
    get(d, &mut out, sig).unwrap();
    out
}

#[test]
fn states_are_those_of_mujoco() {
    let mut m = model();
    let Workspace { fields: mut d, scratch: mut s } = Workspace::new(&m);
    let mut compared = 0;
    for (name, expected) in recorded() {
        let close = |got: &[f64]| {
            assert_eq!(got.len(), expected.len(), "{name}");
            let difference =
                got.iter().zip(&expected).fold(0.0f64, |s, (a, b)| s.max((a - b).abs() / (1.0 + b.abs())));
            assert!(difference < 1e-12, "{name}: {difference:e}");
        };
        match name {
            "set" => set(&m, &mut d, &expected, INTEGRATION).unwrap(),
            "step" => {
                (0..10).for_each(|_| step(&m, &mut d, &mut s));
                close(&state(&m, &d, INTEGRATION));
                assert!(set_keyframe(&mut m, &d, 1) && !set_keyframe(&mut m, &d, 2));
            }
            "reset" => {
                reset_data_keyframe(&m, &mut d, &mut s, 0);
                close(&state(&m, &d, INTEGRATION));
            }
            field if field.starts_with("key_") => {
                let field = reflect::field(Object::Model, field).unwrap();
                let view = reflect::view(&m, &d, field);
                close(&(0..view.len()).map(|i| view.get(i).unwrap()).collect::<Vec<_>>());
            }
            signature => assert_eq!(state(&m, &d, signature.parse().unwrap()), expected, "{signature}"),
        }
        compared += 1;
    }
    assert!(compared > 40);
}

#[test]
fn parts_of_a_state_are_extracted_and_copied() {
    let m = model();
    let mut d = Workspace::new(&m).fields;
    let (_, wild) = recorded().swap_remove(0);
    set(&m, &mut d, &wild, INTEGRATION).unwrap();
    for to in [0, TIME, QVEL, PHYSICS, USER, EQ_ACTIVE | CTRL, INTEGRATION] {
        let mut part = vec![f64::NAN; size(&m, to).unwrap()];
        extract(&m, &wild, INTEGRATION, &mut part, to).unwrap();
        assert_eq!(part, state(&m, &d, to));
        let mut other = Workspace::new(&m).fields;
        copy(&m, &d, &mut other, to).unwrap();
        assert_eq!(state(&m, &other, to), part);
        let rest = INTEGRATION & !to;
        assert_eq!(state(&m, &other, rest), state(&m, &Workspace::new(&m).fields, rest));
    }
}

#[test]
fn nonzero_is_true() {
    let m = model();
    let mut d = Workspace::new(&m).fields;
    for (values, expected) in
        [([0.5, 0.0], [true, false]), ([f64::NAN, -0.0], [true, false]), ([0.0, 256.0], [false, true])]
    {
        set(&m, &mut d, &values, EQ_ACTIVE).unwrap();
        assert_eq!(d.eq_active, expected);
    }
}

#[test]
fn wrong_lists_change_nothing() {
    let m = model();
    let mut d = Workspace::new(&m).fields;
    let before = d.clone();
    for sig in [-1, 1 << COUNT, i32::MAX, i32::MIN] {
        assert_eq!(size(&m, sig), Err(StateError::Signature(sig)));
        assert_eq!(set(&m, &mut d, &[], sig), Err(StateError::Signature(sig)));
    }
    let length = StateError::Length { expected: m.nq, found: 3 };
    assert_eq!(set(&m, &mut d, &[1.0; 3], QPOS), Err(length));
    assert_eq!(get(&d, &mut [0.0; 3], QPOS), Err(length));
    let missing = extract(&m, &[1.0], TIME, &mut vec![0.0; m.nq], QPOS);
    assert_eq!(missing, Err(StateError::Missing(QPOS)));
    assert!(d == before);
    let other =
        compile("<mujoco><worldbody><body><joint/><geom size='1'/></body></worldbody></mujoco>").unwrap();
    assert!(copy(&other, &Workspace::new(&other).fields, &mut d, QPOS).is_err() && d == before);
}
