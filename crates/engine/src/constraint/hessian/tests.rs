//! The layout of the Hessian, and its sums and solutions compared with computations entry by entry.

use crate::constraint::jacobian::{HessianAccumulator, add_entries};
use crate::constraint::six::Six;
use crate::math::dot;
use crate::model::Model;
use crate::step::forward::forward;
use crate::step::step;
use crate::step::workspace::Workspace;
use crate::tests;
use std::array::from_fn;
use std::fmt::Write;

/// Two hundred balls in one place, which all touch each other: no Hessian is allocated, and the step is computed
/// nevertheless.
#[test]
fn an_island_that_is_too_large_is_solved_without_its_hessian() {
    let ball = |i: usize| {
        let position = 1e-3 * i as f64;
        format!("<body pos='{position} {} 0'><freejoint/><geom size='0.3'/></body>", position * position)
    };
    let text: String = (0..200).map(ball).collect();
    let m = tests::compile(&format!("<mujoco><worldbody>{text}</worldbody></mujoco>")).unwrap();
    let Workspace { fields: mut d, scratch: mut s } = Workspace::new(&m);
    step(&m, &mut d, &mut s);
    assert_eq!((d.ncon, d.nisland), (200 * 199 / 2, 1));
    assert_eq!(s.constraint.solver.hessian.block_count(), 0);
    assert!(d.solver_niter > 0 && d.qacc.iter().all(|a| a.is_finite()));
}

/// Boxes with free joints and the given names, positions and sizes, on a floor.
fn boxes(list: impl Iterator<Item = (usize, [f64; 3], [f64; 3])>) -> Model {
    let mut text = String::from("<mujoco><worldbody><geom type=\"plane\" size=\"9 9 1\"/>");
    for (i, [x, y, z], [a, b, c]) in list {
        let _ = write!(
            text,
            "<body name=\"b{i}\" pos=\"{x} {y} {z}\"><freejoint/><geom type=\"box\" size=\"{a} {b} {c}\"/></body>"
        );
    }
    tests::compile(&(text + "</worldbody></mujoco>")).unwrap()
}

fn blocks(m: &Model) -> (usize, Workspace) {
    let mut w = Workspace::new(m);
    forward(m, &mut w.fields, &mut w.scratch);
    let hessian = &w.scratch.constraint.solver.hessian;
    (hessian.block_count(), w)
}

const SMALL_BOX: [f64; 3] = [0.1; 3];

fn row(i: usize) -> (usize, [f64; 3], [f64; 3]) {
    (i, [0.1995 * i as f64, 0.0, 0.0995], SMALL_BOX)
}

/// The sums of the feature `small`, computed entry by entry, are bit-identical to those computed in blocks of four,
/// in both matrices.
#[test]
fn products_are_the_same_entry_by_entry() {
    let (_, Workspace { fields: d, scratch: s }) = blocks(&boxes((0..3).map(row)));
    let (jac, mut fours) = (&s.constraint.jac, s.constraint.solver.hessian.clone());
    fours.clear();
    let mut entries = fours.clone();
    let none = vec![0.0; d.M.len()];
    let free =
        tests::compile("<mujoco><worldbody><body><freejoint/><geom size='1'/></body></worldbody></mujoco>");
    let six = || Six::new(free.as_ref().unwrap(), &none, 0);
    let (mut six_fours, mut six_entries) = (six(), six());
    // A weight matrix that is not symmetric.
    let w: [[f64; 4]; 4] = from_fn(|i| from_fn(|j| 0.1 + (5 * i + j) as f64 / 7.0));
    let apply_weights = |v: &[f64; 4]| w.map(|w| dot(w, *v));
    let mut wide = 0;
    for b in &jac.blocks {
        let (columns, v) = (jac.columns(b), jac.values(b));
        let by_slice =
            |v: &[f64], to: &mut [f64]| to.copy_from_slice(&apply_weights(v.first_chunk().unwrap()));
        fours.add_weighted_gram(columns, v.as_chunks().0, &apply_weights);
        add_entries(&mut entries, columns, v, &by_slice);
        if columns.iter().all(|&c| c < 6) {
            six_fours.add_weighted_gram(columns, v.as_chunks().0, &apply_weights);
            add_entries(&mut six_entries, columns, v, &by_slice);
        }
        wide += usize::from(columns.len() == 12);
    }
    assert!(jac.blocks.len() > wide && wide > 0);
    let same = |a: &mut dyn HessianAccumulator, b: &mut dyn HessianAccumulator, n: usize| {
        let mut filled = 0;
        for (i, j) in (0..n).flat_map(|i| (0..=i).map(move |j| (i, j))) {
            let [a, b] = [a.entry(i, j).copied(), b.entry(i, j).copied()];
            assert_eq!(a.map(f64::to_bits), b.map(f64::to_bits), "{i} {j}");
            filled += usize::from(a.is_some_and(|a| a != 0.0));
        }
        filled
    };
    assert!(same(&mut fours, &mut entries, 18) > 100 && same(&mut six_fours, &mut six_entries, 6) > 15);
}

#[test]
fn a_row_of_boxes_takes_a_band() {
    let (count, Workspace { fields: d, .. }) = blocks(&boxes((0..100).map(row)));
    assert_eq!(d.nisland, 1);
    // Twelve columns per row, and the padding of blocks.
    assert!(count <= 600 * 16, "{count} numbers of {}", 600 * 601 / 2);
}

#[test]
fn a_common_plate_does_not_fill_the_matrix() {
    let plate = (0, [10.0, 0.0, 0.0495], [12.0, 1.0, 0.05]);
    let upon = (1..100).map(|i| (i, [0.25 * i as f64, 0.0, 0.1985], SMALL_BOX));
    let (count, Workspace { fields: d, .. }) = blocks(&boxes(std::iter::once(plate).chain(upon)));
    assert_eq!(d.nisland, 1);
    assert!(count <= 600 * 16, "{count} numbers of {}", 600 * 601 / 2);
}

/// A constrained stem with four hundred twigs: the twigs do not interact with each other, but all interact with the
/// stem.
#[test]
fn branches_are_coupled_in_their_common_parent() {
    let twigs = "<body><joint/><geom size='0.1'/></body>".repeat(400);
    let m = tests::compile(&format!(
        "<mujoco><option><flag contact='disable'/></option><worldbody><body name='stem'><freejoint/><geom size='1'/>{twigs}</body>\
         </worldbody><equality><weld body1='stem'/></equality></mujoco>"
    ));
    let (count, Workspace { fields: d, .. }) = blocks(&m.unwrap());
    assert_eq!((d.nisland, d.nefc), (1, 6));
    // One diagonal block for every four twigs, and two full rows of blocks for the stem.
    assert!(count <= 16 * (100 + 2 * 102), "{count} numbers of {}", 203 * 407);
}

#[test]
fn separate_pairs_have_separate_matrices() {
    let pair = |i: usize| (i, [0.5 * (i / 2) as f64 + 0.1995 * (i % 2) as f64, 0.0, 0.0995], SMALL_BOX);
    let (count, Workspace { fields: d, .. }) = blocks(&boxes((0..300).map(pair)));
    // Three rows of blocks for each pair, with one, two and three blocks.
    assert_eq!((d.nisland, count), (150, 96));
}

/// Layouts are computed when islands are found, not in every step.
#[test]
fn islands_keep_their_layouts() {
    let pair = |i: usize| (i, [0.5 * (i / 2) as f64 + 0.1995 * (i % 2) as f64, 0.0, 0.0995], SMALL_BOX);
    let mut m = boxes((0..6).map(pair));
    m.opt.disableflags |= crate::kinds::disable::WARMSTART;
    let Workspace { fields: mut d, scratch: mut s } = Workspace::new(&m);
    let mut directions = 0;
    for _ in 0..50 {
        step(&m, &mut d, &mut s);
        directions += d.solver_niter;
    }
    let solver = &s.constraint.solver;
    let all = solver.island_hessians.iter().chain([&solver.hessian]);
    let (laid_out, found) = (all.map(|h| h.laid_out).sum::<usize>(), s.constraint.islands.found as usize);
    assert!(d.nisland == 3 && directions >= 150 && found < 25, "{directions} directions, found {found}");
    assert!(laid_out <= 3 * found, "{laid_out} layouts of islands that were found {found} times");
}

#[test]
fn the_order_in_the_file_changes_rounding_alone() {
    // In steps of 37 modulo a hundred, so that neighbours are far from each other in the model.
    let (near, far) = (boxes((0..100).map(row)), boxes((0..100).map(|i| row(i * 37 % 100))));
    let ((_, a), (count, b)) = (blocks(&near), blocks(&far));
    assert!(count <= 600 * 16, "{count}");
    for i in 0..600 {
        let there = 6 * (i / 6 * 73 % 100) + i % 6;
        assert!(
            (a.fields.qacc[i] - b.fields.qacc[there]).abs() < 1e-9,
            "{i}: {} and {}",
            a.fields.qacc[i],
            b.fields.qacc[there]
        );
    }
}
