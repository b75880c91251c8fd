//! The engine as an embedder meets it: random calls with hostile numbers, indexes and lengths. Nothing panics; what a call
//! cannot do it refuses.

use super::{Random, tries};
use crate::support::{model, models, workspace};
use labspec_core::reflect::{self, Elem, Kind};
use labspec_core::{self as core, Data, Demand, Model, Obj, Plan, save, state};

/// What a test run affords.
const CASES: u64 = 400;

const NUMBERS: &[f64] = &[
    0.0,
    -0.0,
    1.0,
    -1.0,
    0.5,
    2.0,
    3.0,
    7.0,
    100.0,
    1e-9,
    -1e-9,
    1e-300,
    1e9,
    -1e9,
    1e150,
    1e300,
    -1e300,
    f64::MAX,
    f64::INFINITY,
    f64::NEG_INFINITY,
    f64::NAN,
    5e-324,
];
const INDEXES: &[usize] = &[0, 1, 2, 3, 5, 17, 1 << 20, usize::MAX / 2, usize::MAX];
const KINDS: &[Obj] =
    &[Obj::Body, Obj::Joint, Obj::Geom, Obj::Site, Obj::Camera, Obj::Tendon, Obj::Sensor, Obj::Key];

fn number(random: &mut Random) -> f64 {
    if random.below(4) == 0 { random.below(2000) as f64 / 1000.0 - 1.0 } else { *random.pick(NUMBERS) }
}

/// A list that has the right length most of the time.
fn numbers(random: &mut Random, right: usize) -> Vec<f64> {
    let n = if random.below(4) == 0 { random.below(right + 3) } else { right };
    (0..n).map(|_| number(random)).collect()
}

fn point(random: &mut Random) -> [f64; 3] {
    std::array::from_fn(|_| number(random))
}

/// Stores something in a field that a lesson may write: all but what is fixed when a model is compiled.
fn write(m: &mut Model, d: &mut Data, random: &mut Random) -> String {
    let fields: Vec<_> = reflect::fields().filter(|f| f.info().kind != Kind::Structure).collect();
    let field = *random.pick(&fields);
    let info = field.info();
    // How many turns a solver may take is a budget of its own.
    let most = if info.name.contains("iterations") { 100.0 } else { f64::INFINITY };
    let n = reflect::view(m, d, field).len();
    let i = if random.below(8) == 0 { *random.pick(INDEXES) } else { random.below(n + 1) };
    let value = if info.elem == Elem::F64 { number(random) } else { number(random).min(most) };
    reflect::view_mut(m, d, field).set(i, value);
    format!("{}[{i}] = {value:?}", info.name)
}

/// One call; what it was.
fn call(m: &mut Model, d: &mut Data, saved: &mut Vec<u8>, random: &mut Random) -> String {
    let k = if random.below(2) == 0 { random.below(4) } else { *random.pick(INDEXES) };
    let mut out = numbers(random, m.nv);
    let what = random.below(30);
    match what {
        0 => core::reset_data(m, d).unwrap(),
        1 => core::reset_data_keyframe(m, d, k).unwrap(),
        2 => drop(core::set_keyframe(m, d, k).unwrap()),
        3 | 4 => core::step(m, d).unwrap(),
        5 => core::forward(m, d).unwrap(),
        6 => (core::step1(m, d).unwrap(), core::step2(m, d).unwrap()).0,
        7 => drop(core::inverse(m, d).unwrap()),
        8 => core::set_const(m, d).unwrap(),
        9 => {
            *saved = save::save(m, d);
            if random.below(2) == 0 && !saved.is_empty() {
                let at = random.below(saved.len());
                saved[at] ^= 1 << random.below(8);
                saved.truncate(saved.len() - random.below(2));
            }
        }
        10 => drop(save::restore(m, d, saved)),
        11 => {
            let sig = random.next() as i32;
            let mut values = numbers(random, state::size(m, sig).unwrap_or(3));
            let _ = state::get(m, d, &mut values, sig);
            let _ = state::set(m, d, &values, sig);
            let _ = state::extract(m, &values, sig, &mut out, random.next() as i32);
        }
        12 => drop((core::jac(m, d, point(random), k).unwrap(), core::jac_dot(m, d, point(random), k).unwrap())),
        13 => drop((core::jac_body(m, d, k).unwrap(), core::jac_body_com(m, d, k).unwrap(), core::jac_subtree_com(m, d, k).unwrap())),
        14 => drop((core::jac_geom(m, d, k).unwrap(), core::jac_site(m, d, k).unwrap())),
        15 => drop(core::apply_ft(m, d, point(random), point(random), point(random), k, &mut out).unwrap()),
        16 => {
            let v = numbers(random, m.nv);
            let _ = core::mul_m(m, d, &v, &mut out).unwrap();
        }
        17 => drop((core::solve_m(m, d, &mut out).unwrap(), core::solve_m2(m, d, &mut out).unwrap())),
        18 => drop(core::rne(m, d, Some(&numbers(random, m.nv)), &mut out).unwrap()),
        19 => drop((core::full_m(m, d).unwrap(), core::full_j(m, d).unwrap())),
        20 => {
            let kind = *random.pick(KINDS);
            core::object_velocity(m, d, kind, k, random.below(2) == 0).unwrap();
            core::object_acceleration(m, d, kind, k, random.below(2) == 0).unwrap();
        }
        21 => {
            if let Some(contact) = d.contact.first() {
                core::contact_force(m, d, contact).unwrap();
            }
        }
        22 => (core::subtree_vel(m, d).unwrap(), core::rne_post_constraint(m, d).unwrap()).0,
        23 => core::set_plan(m, d, Plan::new(m, &Demand::OBSERVE)).unwrap(),
        24 => *d = Data::new(m),
        _ => return write(m, d, random),
    }
    format!("call {what} with {k}")
}

#[test]
fn random_calls_of_the_engine_do_not_panic() {
    let names = models(&workspace().join("tests/golden/models"));
    let all: Vec<Model> = names.iter().map(|name| model(name)).collect();
    let one = std::env::var_os("LABSPEC_FUZZ_CASE").is_some();
    tries(CASES, |n| {
        let mut random = Random(n);
        let mut m = random.pick(&all).clone();
        let mut d = Data::new(&m);
        let mut saved = Vec::new();
        let mut calls = Vec::new();
        for _ in 0..5 + random.below(25) {
            calls.push(call(&mut m, &mut d, &mut saved, &mut random));
            if one {
                println!("{}", calls[calls.len() - 1]);
            }
        }
        calls.join("\n")
    });
}
