//! Each specialized tree algorithm compared with the general one, for the zoo and for random trees.

#![allow(clippy::unwrap_used)]

use crate::scenes::scene;
use crate::support::compile;
use crate::zoo::animals;
use labspec_core::reflect::{self, Object};
use labspec_core::{self as core, AccessSet, Data, Model, Plan, Planned, TreeAlgorithm, TreeAlgorithms};
use proptest::prelude::*;

/// The compared fields. `qLD` of short chains and of rows is the same matrix.
const FIELDS: [&str; 9] =
    ["xpos", "xquat", "M", "qLD", "qLDiagInv", "qfrc_bias", "qacc_smooth", "qacc", "qfrc_constraint"];

fn numbers(m: &Model, d: &Data<Planned>, name: &str) -> Vec<f64> {
    let field = reflect::field(Object::Data, name).unwrap();
    let view = core::view(m, d, field).unwrap();
    (0..view.len()).filter_map(|i| view.get(i)).collect()
}

/// A field and its numbers.
type Column = (&'static str, Vec<f64>);

/// The field that differs most between two sets of algorithms after a forward pass, or the state after three more steps, with
/// the difference relative to the largest number of the field.
fn difference(
    m: &Model,
    start: impl Fn(&mut Data<Planned>),
    algorithms: TreeAlgorithms,
) -> (f64, &'static str) {
    let run = |algorithms| {
        let mut d = Data::planned(m, Plan::by_algorithms(m, &AccessSet::ANY, algorithms));
        start(&mut d);
        core::forward(m, &mut d).unwrap();
        let now: Vec<Column> = FIELDS.iter().map(|name| (*name, numbers(m, &d, name))).collect();
        for _ in 0..3 {
            core::step(m, &mut d).unwrap();
        }
        now.into_iter()
            .chain(["qpos", "qvel"].map(|name| (name, numbers(m, &d, name))))
            .collect::<Vec<Column>>()
    };
    let of = |((name, a), (_, b)): (Column, Column)| {
        let size = b.iter().fold(1.0_f64, |s, x| s.max(x.abs()));
        let error = a.iter().zip(&b).fold(0.0_f64, |s, (x, y)| s.max((x - y).abs()));
        (if a.len() == b.len() { error / size } else { f64::INFINITY }, name)
    };
    run(algorithms)
        .into_iter()
        .zip(run(TreeAlgorithms::GENERAL))
        .map(of)
        .fold((0.0, ""), |worst, now| if now.0 > worst.0 { now } else { worst })
}

/// Each algorithm alone, and all of them.
fn every() -> impl Iterator<Item = TreeAlgorithms> {
    let alone = |algorithm| {
        TreeAlgorithm::short().filter(|w| *w != algorithm).fold(TreeAlgorithms::ALL, TreeAlgorithms::without)
    };
    TreeAlgorithm::short().map(alone).chain([TreeAlgorithms::ALL])
}

#[test]
fn every_algorithm_computes_the_zoo_as_the_general_one() {
    let mut wrong = Vec::new();
    for (name, m, state) in animals() {
        let mut initial = Data::new(&m);
        crate::recorded::set(&m, &mut initial, &state);
        for algorithms in every() {
            let start =
                |d: &mut Data<Planned>| core::state::copy(&m, &initial, d, core::state::INTEGRATION).unwrap();
            let (error, field) = difference(&m, start, algorithms);
            if error > 1e-9 {
                wrong.push(format!("{name}, {algorithms:?}: {field} {error:e}"));
            }
        }
    }
    assert_eq!(wrong, [""; 0]);
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 200, ..ProptestConfig::default() })]

    #[test]
    fn every_algorithm_computes_random_trees_as_the_general_one(
        scene in scene(),
        numbers in prop::collection::vec(-1.5..1.5f64, 24),
    ) {
        let m = compile(&scene.smooth());
        let start = |d: &mut Data<Planned>| {
            let edit = d.edit();
            for (i, q) in edit.qpos.iter_mut().enumerate() {
                *q += 0.3 * numbers[i % numbers.len()];
            }
            for (i, v) in edit.qvel.iter_mut().enumerate() {
                *v = numbers[(7 * i + 3) % numbers.len()];
            }
        };
        for algorithms in every() {
            let (error, field) = difference(&m, start, algorithms);
            prop_assert!(error < 1e-9, "{algorithms:?}: {field} {error:e}\n{}", scene.smooth());
        }
    }
}
