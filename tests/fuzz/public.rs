//! The engine through its public interface: random calls with hostile numbers, indices and lengths. Nothing panics;
//! invalid calls are refused.

use super::run_cases;
use crate::support::random::Random;
use crate::support::{model, models, workspace};
use labspec_core::reflect::{self, Elem, Kind};
use labspec_core::{self as core, AccessSet, Data, Model, Obj, Plan, save, state};

/// The number of cases of a test run.
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

/// A list, most of the time of the right length.
fn numbers(random: &mut Random, right: usize) -> Vec<f64> {
    let n = if random.below(4) == 0 { random.below(right + 3) } else { right };
    (0..n).map(|_| number(random)).collect()
}

fn point(random: &mut Random) -> [f64; 3] {
    std::array::from_fn(|_| number(random))
}

/// Writes to a random field that a lesson may write: any field that is not fixed when a model is compiled.
fn write(m: &mut Model, d: &mut Data, random: &mut Random) -> String {
    let fields: Vec<_> = reflect::fields().filter(|f| f.info().kind != Kind::Structure).collect();
    let field = *random.pick(&fields);
    let info = field.info();
    // The number of solver iterations is limited, because it has its own budget.
    let most = if info.name.contains("iterations") { 100.0 } else { f64::INFINITY };
    let n = core::length(m, d, field);
    let i = if random.below(8) == 0 { *random.pick(INDEXES) } else { random.below(n + 1) };
    let value = if info.elem == Elem::F64 { number(random) } else { number(random).min(most) };
    if let Ok(mut view) = core::view_mut(m, d, field) {
        view.set(i, value);
    }
    format!("{}[{i}] = {value:?}", info.name)
}

/// A model that differs from all others.
fn other_model() -> Model {
    let text = "<mujoco><worldbody><body><freejoint/><geom size='1'/></body></worldbody></mujoco>";
    Model::from_xml(text).unwrap()
}

/// Performs one random call; returns its description.
fn call(m: &mut Model, d: &mut Data, saved: &mut Vec<u8>, random: &mut Random) -> String {
    let k = if random.below(2) == 0 { random.below(4) } else { *random.pick(INDEXES) };
    let mut out = numbers(random, m.nv);
    let what = random.below(36);
    let keys: Vec<_> = m.keys().collect();
    let key = keys.get(k % keys.len().max(1)).copied();
    // A call may be refused, but it must return.
    match what {
        0 => drop(core::reset_data(m, d)),
        1 => drop(key.map(|key| core::reset_data_keyframe(m, d, key))),
        2 => drop(key.map(|key| core::set_keyframe(m, d, key))),
        3 | 4 => drop(core::step(m, d)),
        5 => drop(core::forward(m, d)),
        6 => drop((core::step1(m, d), core::step2(m, d))),
        7 => drop((d.set_qacc(&out), core::inverse(m, d))),
        8 => drop(core::set_const(m, d)),
        9 => {
            *saved = save::save(m, d).unwrap_or_default();
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
        12 => drop((core::jac(m, d, point(random), k), core::jac_dot(m, d, point(random), k))),
        13 => drop((core::jac_body(m, d, k), core::jac_body_com(m, d, k), core::jac_subtree_com(m, d, k))),
        14 => drop((core::jac_geom(m, d, k), core::jac_site(m, d, k))),
        15 => drop(core::apply_ft(m, d, [point(random), point(random)], point(random), k, &mut out)),
        16 => {
            let v = numbers(random, m.nv);
            let _ = core::mul_m(m, d, &v, &mut out);
        }
        17 => drop((core::solve_m(m, d, &mut out), core::solve_m2(m, d, &mut out))),
        18 => drop(core::rne(m, d, Some(&numbers(random, m.nv)))),
        19 => drop((core::full_m(m, d), core::full_j(m, d))),
        20 => {
            let kind = *random.pick(KINDS);
            let _ = core::object_velocity(m, d, kind, k, random.below(2) == 0);
            let _ = core::object_acceleration(m, d, kind, k, random.below(2) == 0);
        }
        21 => {
            // Contacts that were not computed by a simulation are passed as well.
            let mut contact = d.contact.first().cloned().unwrap_or_default();
            if random.below(2) == 0 {
                contact.dim = *random.pick(INDEXES);
                contact.efc_address = Some(*random.pick(INDEXES));
            }
            let _ = core::contact_force(m, d, &contact);
        }
        22 => drop((core::subtree_vel(m, d), core::rne_post_constraint(m, d))),
        23 => drop((core::kinematics(m, d), core::energy_pos(m, d), core::energy_vel(m, d))),
        24 => *d = Data::new(m),
        25 => {
            let filter = core::RayFilter { exclude_body: Some(k), ..core::RayFilter::default() };
            let _ = core::ray(m, d, point(random), point(random), &filter);
            let _ = core::geom_distance(m, d, k, random.below(5), number(random));
            drop((core::inside_site(m, d, k, point(random)), core::can_collide(m, k, 0)));
        }
        26 => {
            let (mut from, v) = (numbers(random, m.nq), numbers(random, m.nv));
            let _ = core::integrate_pos(m, &mut from, &v, number(random));
            let _ = core::differentiate_pos(m, number(random), &from, &d.qpos);
        }
        27 => {
            let name = |kind| m.name_of(kind, k).unwrap_or("no such name").to_string();
            let (body, joint) = (name(Obj::Body), name(Obj::Joint));
            drop((d.set_joint_qpos(&*joint, &out), d.set_joint_qvel(&*joint, &out), d.set_ctrl("", &out)));
            drop((d.set_xfrc(&*body, [number(random); 6]), d.body(&*body).map(|b| b.xpos())));
            drop((d.joint(&*joint).map(|j| j.qpos().len()), d.sensor(&*body).map(|s| s.values().len())));
        }
        28 => {
            // Data of another model.
            let other = other_model();
            let mut foreign = Data::new(&other);
            assert!(core::step(m, &mut foreign).is_err() && core::full_m(m, &foreign).is_err());
            assert!(core::inverse(&other, d).is_err() && save::restore(&other, d, saved).is_err());
        }
        29 => {
            let mut planned = Data::planned(
                m,
                Plan::new(m, &AccessSet { reads: Default::default(), ..AccessSet::OBSERVE }),
            );
            drop((
                core::step(m, &mut planned),
                core::full_m(m, &planned),
                core::ray(m, &planned, [0.0; 3], [1.0; 3], &Default::default()),
            ));
            drop((core::inverse(m, &mut planned), planned.get("xpos").map(|v| v.len())));
        }
        _ => return write(m, d, random),
    }
    format!("call {what} with {k}")
}

#[test]
fn random_calls_of_the_engine_do_not_panic() {
    let names = models(&workspace().join("tests/golden/models"));
    let all: Vec<Model> = names.iter().map(|name| model(name)).collect();
    let one = std::env::var_os("LABSPEC_FUZZ_CASE").is_some();
    run_cases(CASES, |n| {
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

/// FNV-1a. With it, a modified model has a valid checksum.
fn fingerprint(bytes: &[u8]) -> u64 {
    bytes.iter().fold(0xcbf2_9ce4_8422_2325, |h, &b| (h ^ u64::from(b)).wrapping_mul(0x0000_0100_0000_01b3))
}

#[test]
fn stored_models_come_back_or_are_refused() {
    let names = models(&workspace().join("tests/golden/models"));
    let all: Vec<Model> = names.iter().map(|name| model(name)).collect();
    for m in &all {
        assert_eq!(Model::from_bytes(&m.to_bytes()).unwrap(), *m);
    }
    let mut accepted = 0;
    run_cases(CASES, |n| {
        let mut random = Random(n);
        let mut bytes = random.pick(&all).to_bytes();
        let end = bytes.len() - 8;
        for _ in 0..1 + random.below(3) {
            // Integers have four bytes and are small, so most changes produce other valid integers.
            let at = 28 + random.below(end - 28);
            bytes[at] = if random.below(2) == 0 { random.below(8) as u8 } else { random.next() as u8 };
        }
        let sum = fingerprint(&bytes[..end]);
        bytes[end..].copy_from_slice(&sum.to_le_bytes());
        if let Ok(m) = Model::from_bytes(&bytes) {
            accepted += 1;
            let mut d = Data::new(&m);
            core::limit(&mut d, 50_000_000);
            for _ in 0..3 {
                let _ = core::step(&m, &mut d);
            }
            let _ = core::inverse(&m, &mut d);
        }
        String::new()
    });
    assert!(accepted > 50, "{accepted}");
}
