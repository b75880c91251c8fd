//! Comparison of the forward passes of a model with its recording, and of quantities that are computed on request.

#![allow(clippy::unwrap_used, clippy::panic)]

use crate::recorded::{Difference, INTEGRATORS, Verdict, largest, list, named, note, objects, set};
use crate::support::numbers;
use labspec_core::reflect::Object;
use labspec_core::{self as core, Data, Model, disable, enable};
use serde_json::Value;

/// The tolerance of a forward pass.
const FORWARD: f64 = 1e-10;

pub(crate) fn forward(m: &Model, states: &Value) -> Verdict {
    let mut d = Data::new(m);
    let mut found = Vec::new();
    let mut worst: f64 = 0.0;
    let mut sensitive: Option<(f64, f64)> = None;
    assert!(states.as_array().is_some_and(|list| !list.is_empty()), "no state is recorded");
    for (k, row) in states.as_array().into_iter().flatten().enumerate() {
        set(m, &mut d, &row["state"]);
        core::forward(m, &mut d).unwrap();
        let place = format!("state {k}");
        let mut hold = |field: &str, computed: &[f64], recorded_values: &[f64]| {
            let scale = largest(recorded_values).max(1.0);
            let spread = row["spread"][field].as_str().and_then(|s| s.parse().ok()).unwrap_or(0.0);
            let difference =
                note(&mut found, &place, field, computed, recorded_values, scale, f64::max(FORWARD, spread));
            if difference > FORWARD && difference <= spread {
                sensitive = sensitive.filter(|s| s.0 > difference).or(Some((difference, spread)));
            } else {
                worst = worst.max(difference);
            }
        };
        for (field, values) in objects(&row["data"]).filter(|(name, _)| !MOMENTS.contains(&name.as_str())) {
            let id = named(Object::Data, field);
            hold(field, &list(m, &d, id), &numbers(values));
        }
        let recorded_values = MOMENTS.map(|name| row["data"].get(name).map(numbers).unwrap_or_default());
        if recorded_values.iter().any(|list| !list.is_empty()) {
            let computed = MOMENTS.map(|name| list(m, &d, named(Object::Data, name)));
            hold("actuator_moment", &dense(&computed, m.nv), &dense(&recorded_values, m.nv));
        }
        for (field, computed, recorded_values) in on_request(m, &mut d, row) {
            hold(&field, &computed, &recorded_values);
        }
    }
    // Only the first state in which a field differs is reported.
    let mut seen = std::collections::HashSet::new();
    found.retain(|d: &Difference| seen.insert(d.field.clone()));
    match sensitive {
        Some((difference, spread)) if found.is_empty() => Verdict::Sensitive(difference, spread),
        _ => Verdict::from_differences(found, worst),
    }
}

/// Quantities that are computed on request, in the order of the recording, each with our value and that of the library.
fn on_request(m: &Model, d: &mut Data, row: &Value) -> Vec<(String, Vec<f64>, Vec<f64>)> {
    let vector: Vec<f64> = (0..m.nv).map(|i| (7 * i % 5) as f64 - 2.0).collect();
    let mut out = Vec::new();
    let recorded = |part: &Value, name: &str| part.get(name).map(numbers);
    let post = &row["post"];
    core::subtree_vel(m, d).unwrap();
    core::rne_post_constraint(m, d).unwrap();
    for (name, values) in objects(post).filter(|(name, _)| *name != "qfrc_inverse") {
        let id = named(Object::Data, name);
        out.push((name.clone(), list(m, d, id), numbers(values)));
    }
    if let Some(recorded_inverse) = recorded(post, "qfrc_inverse") {
        d.set_qacc(&vector).unwrap();
        core::inverse(m, d).unwrap();
        out.push(("qfrc_inverse".into(), d.qfrc_inverse.clone(), recorded_inverse));
    }
    for (name, values) in objects(&row["functions"]) {
        out.push((format!("{name}()"), function(m, d, name, &vector), numbers(values)));
    }
    let mut m = m.clone();
    m.set_enabled(enable::INVDISCRETE, true);
    for (name, values) in objects(&row["inverse"]) {
        // The library includes dampers that the flag disables here, so that the result is not the inverse of its own step.
        if name == "Euler" && m.opt.disabled(disable::DAMPER) {
            continue;
        }
        *m.edit().opt.integrator = INTEGRATORS.iter().position(|a| a == name).unwrap() as i32;
        d.set_qacc(&vector).unwrap();
        core::inverse(&m, d).unwrap();
        out.push((format!("qfrc_inverse of a step, {name}"), d.qfrc_inverse.clone(), numbers(values)));
    }
    out
}

/// The result of a function for the vector, point and bodies of the recorder.
fn function(m: &Model, d: &mut Data, name: &str, vector: &[f64]) -> Vec<f64> {
    let body = m.nbody - 1;
    let at = &d.xpos[3 * body..];
    let point = [at[0] + 0.1, at[1] - 0.2, at[2] + 0.3];
    let both = |j: core::Jacobian| [j.jacp, j.jacr].concat();
    let mut out = vec![0.0; m.nv];
    match name {
        "mul_m" => core::mul_m(m, d, vector, &mut out).unwrap(),
        "solve_m" | "solve_m2" => {
            out.copy_from_slice(vector);
            if name == "solve_m" { core::solve_m(m, d, &mut out) } else { core::solve_m2(m, d, &mut out) }
                .unwrap();
        }
        "full_m" => return core::full_m(m, d).unwrap(),
        "rne" => return core::rne(m, d, None).unwrap(),
        "rne_acc" => return core::rne(m, d, Some(vector)).unwrap(),
        "apply_ft" => {
            core::apply_ft(m, d, [[1.0, 2.0, 3.0], [-3.0, 1.0, 2.0]], point, body, &mut out).unwrap();
        }
        "jac" => return both(core::jac(m, d, point, body).unwrap()),
        "jac_dot" => return both(core::jac_dot(m, d, point, body).unwrap()),
        "jac_body" => return both(core::jac_body(m, d, body).unwrap()),
        "jac_body_com" => return both(core::jac_body_com(m, d, body).unwrap()),
        "jac_geom" => return both(core::jac_geom(m, d, m.ngeom - 1).unwrap()),
        "jac_site" => return both(core::jac_site(m, d, m.nsite - 1).unwrap()),
        "jac_subtree_com" => return core::jac_subtree_com(m, d, body.min(1)).unwrap(),
        "integrate_pos" => {
            out.clone_from(&d.qpos);
            core::integrate_pos(m, &mut out, vector, 0.3).unwrap();
        }
        "differentiate_pos" => return core::differentiate_pos(m, 0.2, &m.qpos0, &d.qpos).unwrap(),
        other => panic!("no function is called {other}"),
    }
    out
}

/// The sparse moments of actuators: which entries are stored depends on which are rounded to zero.
const MOMENTS: [&str; 4] = ["moment_rownnz", "moment_rowadr", "moment_colind", "actuator_moment"];

/// The dense matrix of the entries in [`MOMENTS`].
fn dense([number, address, column, value]: &[Vec<f64>; 4], nv: usize) -> Vec<f64> {
    let mut out = vec![0.0; number.len() * nv];
    for (row, (&n, &start)) in out.chunks_mut(nv.max(1)).zip(number.iter().zip(address)) {
        for k in start as usize..(start + n) as usize {
            row[column[k] as usize] = value[k];
        }
    }
    out
}
