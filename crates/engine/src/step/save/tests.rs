//! Saved data are restored completely or not at all.

use super::*;
use crate::constraint::contact_force;
use crate::dynamics::subtree::subtree_vel;
use crate::model::plan::PlanTable;
use crate::sensor::body_force::rne_post_constraint;
use crate::step::analysis::AccessSet;
use crate::step::forward::forward;
use crate::step::inverse::inverse;
use crate::step::{step, step1, step2};
use crate::tests::compile;

const PILE: &str = "<mujoco><option integrator='INTEGRATOR'/><worldbody><geom type='plane' size='1 1 1'/>
    <body pos='0 0 .1'><freejoint/><geom size='.1'/></body>
    <body pos='.05 0 .28'><freejoint/><geom type='box' size='.1 .08 .05'/></body>
    <body pos='.03 .02 .5'><freejoint/><geom type='capsule' size='.05 .1'/><site name='s'/></body>
    <body pos='1 0 1'><joint name='h' axis='0 1 0' range='-10 20'/><geom type='capsule' fromto='0 0 0 .3 0 0' size='.02'/>
    <site name='t' pos='.3 0 0'/></body></worldbody>
    <tendon><spatial name='rope' stiffness='3'><site site='s'/><site site='t'/></spatial></tendon>
    <actuator><general joint='h' dyntype='filter' dynprm='.1'/><motor tendon='rope'/></actuator>
    <sensor><touch site='s'/><accelerometer site='t'/></sensor></mujoco>";

fn scenes() -> Vec<Model> {
    let pile =
        ["Euler", "RK4", "implicit", "implicitfast", "discrete"].map(|i| PILE.replace("INTEGRATOR", i));
    let delays = include_str!("../../model/state/golden/everything.xml").to_string();
    pile.into_iter().chain([delays]).map(|text| compile(&text).unwrap()).collect()
}

/// Data in the middle of a motion.
fn moving(m: &Model, plan: PlanTable) -> Workspace {
    let mut w = Workspace::planned(m, plan);
    let Workspace { fields: d, scratch: s } = &mut w;
    d.ctrl.fill(0.3);
    d.qvel.iter_mut().enumerate().for_each(|(i, v)| *v = 0.1 * (i as f64).sin());
    (0..30).for_each(|_| step(m, d, s));
    w
}

#[test]
fn restored_data_continue_bit_for_bit() {
    for m in scenes() {
        for plan in [
            PlanTable::full(),
            PlanTable::new(&m, &AccessSet::OBSERVE, crate::model::tree_algorithm::TreeAlgorithms::ALL),
        ] {
            let Workspace { fields: mut d, scratch: mut s } = moving(&m, plan.clone());
            let bytes = save(&m, &d);
            let Workspace { fields: mut other, scratch: mut t } = Workspace::planned(&m, plan);
            (0..7).for_each(|_| step(&m, &mut other, &mut t));
            restore(&m, &mut other, &mut t, &bytes).unwrap();
            assert!(save(&m, &other) == bytes);
            for _ in 0..20 {
                step(&m, &mut d, &mut s);
                step(&m, &mut other, &mut t);
                assert!(save(&m, &other) == save(&m, &d), "at {}", d.time);
            }
        }
    }
}

#[test]
fn a_step_is_restored_in_its_middle() {
    for m in scenes() {
        let Workspace { fields: mut d, scratch: mut s } = moving(&m, PlanTable::full());
        step1(&m, &mut d, &mut s);
        let bytes = save(&m, &d);
        let Workspace { fields: mut other, scratch: mut t } = Workspace::new(&m);
        restore(&m, &mut other, &mut t, &bytes).unwrap();
        step2(&m, &mut d, &mut s);
        step2(&m, &mut other, &mut t);
        assert!(save(&m, &other) == save(&m, &d));
    }
}

#[test]
fn invalid_bytes_are_refused_and_change_nothing() {
    let m = &scenes()[0];
    let d = moving(m, PlanTable::full()).fields;
    let bytes = save(m, &d);
    let before = moving(m, PlanTable::full());
    let mut after = before.clone();
    let mut fails = |m: &Model, bytes: &[u8]| {
        let error = restore(m, &mut after.fields, &mut after.scratch, bytes).unwrap_err();
        assert!(after == before && !error.to_string().is_empty());
        error
    };
    for end in (0..64).chain((64..bytes.len()).step_by(97)) {
        fails(m, &bytes[..end]);
    }
    for offset in (0..64).chain((64..bytes.len()).step_by(131)) {
        let mut changed = bytes.clone();
        changed[offset] ^= 1 << (offset % 8);
        let error = fails(m, &changed);
        assert_eq!(error == RestoreError::NotData, offset < 8);
        assert_eq!(error == RestoreError::Damaged, offset >= 28, "{offset} {error}");
    }
    assert_eq!(fails(m, &[]), RestoreError::NotData);
    assert_eq!(fails(m, b"labdata\n12345678"), RestoreError::Damaged);
    assert_eq!(fails(m, &[&bytes[..], &[0]].concat()), RestoreError::Damaged);
    assert_eq!(fails(m, b"<mujoco></mujoco>"), RestoreError::NotData);
    let renamed = compile(&PILE.replace("INTEGRATOR", "Euler").replace("'rope'", "'cord'")).unwrap();
    assert_eq!(fails(&renamed, &bytes), RestoreError::OtherModel);
    assert_eq!(fails(&scenes()[5], &bytes), RestoreError::OtherModel);
}

/// Every integer of the data is checked before its use.
#[test]
fn every_integer_field_has_its_limits() {
    let m = &scenes()[0];
    let d = Workspace::new(m).fields;
    for f in reflect::fields().map(|f| f.info()).filter(|f| f.object == Object::Data) {
        if matches!(f.elem, Elem::I32 | Elem::Size) {
            assert!(limits(m, &d, f.name).is_some(), "{}: say in `limits` what it can be", f.name);
        }
    }
}

/// Malicious bytes with a correct hash at their end are refused or cause no panic.
#[test]
fn hostile_bytes_never_panic() {
    let mut seed = 7u64;
    let mut random = |n: usize| {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (seed >> 33) as usize % n
    };
    let mut accepted = 0;
    for m in [&scenes()[0], &scenes()[4], &scenes()[5]] {
        let bytes = save(m, &moving(m, PlanTable::full()).fields);
        for _ in 0..400 {
            let mut changed = bytes[..bytes.len() - 8].to_vec();
            for _ in 0..1 + random(3) {
                let offset = 28 + random(changed.len() - 28);
                let n = 1 + random(8);
                let with = [0, 1, 0x7f, 0x80, 0xff][random(5)];
                changed.iter_mut().skip(offset).take(n).for_each(|b| *b = with);
            }
            fingerprint(&changed.clone()).put(&mut changed);
            let Workspace { fields: mut d, scratch: mut s } = Workspace::new(m);
            if restore(m, &mut d, &mut s, &changed).is_err() {
                continue;
            }
            accepted += 1;
            assert!(d.contact.iter().all(|c| contact_force(m, &d, c).len() == 6));
            rne_post_constraint(m, &mut d);
            subtree_vel(m, &mut d);
            step2(m, &mut d.clone(), &mut s.clone());
            let _ = inverse(m, &mut d.clone(), &mut s.clone());
            forward(m, &mut d.clone(), &mut s.clone());
            (0..2).for_each(|_| step(m, &mut d, &mut s));
        }
    }
    assert!(accepted > 300);
}
