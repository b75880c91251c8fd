//! Results of MuJoCo 3.14.0 for small models (`tests/golden/library_cases.py`), and the cases in which this engine differs
//! because MuJoCo is wrong.

#![allow(clippy::unwrap_used)]

mod capsules;
mod departures;
mod switched;

use labspec_core::xml::compile;
use labspec_core::{self as core, Data, Model};
use std::collections::BTreeMap;

/// A recorded model, and its fields.
struct Case {
    name: &'static str,
    xml: &'static str,
    fields: BTreeMap<&'static str, Vec<f64>>,
}

fn cases() -> Vec<Case> {
    let text = include_str!("../../../../tests/golden/library_cases.txt");
    let blocks = text.strip_prefix("case ").unwrap().split("\ncase ");
    let field = |line: &'static str| {
        let mut words = line.split_whitespace();
        (words.next().unwrap(), words.map(|w| w.parse().unwrap()).collect())
    };
    let case = |block: &'static str| {
        let mut lines = block.lines();
        let (name, xml) = (lines.next().unwrap(), lines.next().unwrap());
        Case { name, xml, fields: lines.map(field).collect() }
    };
    blocks.map(case).collect()
}

/// M as a dense matrix.
fn full_m(m: &Model, d: &Data) -> Vec<f64> {
    core::full_m(m, d).unwrap()
}

fn computed_values(m: &Model, d: &Data, field: &str) -> Vec<f64> {
    let contacts = |of: fn(&core::Contact) -> f64| d.contact.iter().map(of).collect();
    match field {
        "model.body_simple" => m.body_simple.iter().map(|&x| f64::from(x)).collect(),
        "model.dof_M0" => m.dof_M0.clone(),
        "model.body_invweight0" => m.body_invweight0.clone(),
        "model.dof_invweight0" => m.dof_invweight0.clone(),
        "model.tendon_invweight0" => m.tendon_invweight0.clone(),
        "model.actuator_acc0" => m.actuator_acc0.clone(),
        "full_m" => full_m(m, d),
        "nefc" => vec![d.nefc as f64],
        "contact.dist" => contacts(|c| c.dist),
        "contact.efc_address" => contacts(|c| c.efc_address.map_or(-1.0, |row| row as f64)),
        "contact.exclude" => contacts(|c| f64::from(c.exclude)),
        "data.actuator_length" => d.actuator_length.clone(),
        "data.actuator_velocity" => d.actuator_velocity.clone(),
        "data.sensordata" => d.sensordata.clone(),
        "data.qacc" => d.qacc.clone(),
        "data.efc_aref" => d.efc_aref.clone(),
        "data.efc_D" => d.efc_D.clone(),
        "data.efc_force" => d.efc_force.clone(),
        other => unreachable!("{other}"),
    }
}

/// Compares every field of the cases whose name starts with a prefix, with a tolerance of 1e-12 of max(1, its largest number).
fn as_recorded(prefix: &str) {
    let mut seen = 0;
    for case in cases().iter().filter(|c| c.name.starts_with(prefix)) {
        let m = compile(case.xml).unwrap();
        let mut d = Data::new(&m);
        core::forward(&m, &mut d).unwrap();
        for (field, recorded) in &case.fields {
            let computed = computed_values(&m, &d, field);
            let scale = recorded.iter().fold(1.0_f64, |s, x| s.max(x.abs()));
            let near = computed.len() == recorded.len()
                && computed.iter().zip(recorded).all(|(x, y)| (x - y).abs() <= 1e-12 * scale);
            assert!(near, "{}: {field} is {computed:?}, recorded {recorded:?}", case.name);
        }
        // A step accepts everything that the forward pass accepts.
        core::step(&m, &mut d).unwrap();
        seen += 1;
    }
    assert!(seen > 0, "no case begins with {prefix}");
}

/// Armature of an actuator on a tendon does not change the flag `simple` of bodies: M contains the diagonal of a Jᵀ J.
#[test]
fn inertia_of_actuators_on_tendons() {
    as_recorded("rotor_");
    as_recorded("tendon_");
    as_recorded("both_");
}

/// Explicit pairs of geoms that cannot move: contacts without rows.
#[test]
fn pairs_that_nothing_moves() {
    as_recorded("pair_of_world");
    as_recorded("pair_of_static");
    as_recorded("pair_of_mocap");
}

/// Explicit pairs of geoms of one body: rows of zeros with dense Jacobians, no rows with sparse ones.
#[test]
fn pairs_of_one_body() {
    as_recorded("pair_of_one");
    as_recorded("pair_of_welded");
    as_recorded("pair_of_parent");
}
