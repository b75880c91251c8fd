//! Measures that are lists or matrices, quotes of whole lists, and runs with other elements in the model.

#![allow(clippy::unwrap_used)]

use crate::support::check_text;
use labspec::finding::Finding;
use serde_json::{Value, json};

/// A double pendulum with a motor.
const ARM: &str = "<mujoco><option timestep='0.001'/><default><geom density='1000' contype='0' conaffinity='0'/></default><worldbody><body name='upper'><joint name='shoulder' axis='0 1 0' damping='0.1'/><geom type='capsule' fromto='0 0 0 .3 0 0' size='.02'/><body name='fore' pos='.3 0 0'><joint name='elbow' axis='0 1 0' damping='0.1'/><geom type='capsule' fromto='0 0 0 .3 0 0' size='.02'/></body></body></worldbody><actuator><motor name='drive' joint='shoulder'/></actuator></mujoco>";

/// The verdicts of the quotes of a lesson, and the findings.
fn check(prose: &str, verify: &Value) -> (Vec<String>, Vec<Finding>) {
    let lab = json!({"title": "Arm", "xml": ARM,
        "controls": [{"label": "damping", "min": 0.1, "max": 1, "step": 0.1, "value": 0.1, "set": "model.dof_damping[0]"}],
        "verify": verify});
    let checked = check_text("arm.md", &format!("{prose}\n\n```lab simlab\n{lab}\n```\n"));
    let quotes = checked.claims.iter().flat_map(|claim| &claim.judgement.quotes);
    (quotes.map(|quote| quote.verdict().to_string()).collect(), checked.findings)
}

/// The values of the measures, by name.
fn measured(verify: &Value) -> Vec<(String, f64)> {
    let lab = json!({"title": "Arm", "xml": ARM,
        "controls": [{"label": "damping", "min": 0.1, "max": 1, "step": 0.1, "value": 0.1, "set": "model.dof_damping[0]"}],
        "verify": verify});
    let checked = check_text("arm.md", &format!("0.1\n\n```lab simlab\n{lab}\n```\n"));
    let measures = checked.claims.iter().flat_map(|claim| &claim.judgement.measures);
    measures.map(|m| (m.name.clone(), m.value)).collect()
}

#[test]
fn a_measure_of_an_array_is_a_list() {
    let whole = measured(&json!({"runs": {"fall": {"until": 0.2}, "stay": {"until": 0.1}},
        "measure": {"q": "final(data.qpos)", "turned": "abs(final(data.qpos) - initial(data.qpos))", "ends": "[max(data.qpos[0]), min(data.qpos[1])]"},
        "says": [["0.1", "fall.q[0]"]]}));
    let single = measured(&json!({"runs": {"fall": {"until": 0.2}, "stay": {"until": 0.1}},
        "measure": {"a": "final(data.qpos[0])", "b": "final(data.qpos[1])", "c": "abs(final(data.qpos[0]))", "d": "abs(final(data.qpos[1]))", "e": "max(data.qpos[0])", "f": "min(data.qpos[1])"},
        "says": [["0.1", "fall.a"]]}));
    let names: Vec<&str> = whole.iter().map(|(name, _)| name.as_str()).take(6).collect();
    assert_eq!(
        names,
        ["fall.q[0]", "fall.q[1]", "fall.turned[0]", "fall.turned[1]", "fall.ends[0]", "fall.ends[1]"]
    );
    assert_eq!(whole.len(), 12);
    for ((name, x), (_, y)) in whole.iter().zip(&single) {
        assert_eq!(x.to_bits(), y.to_bits(), "{name}");
    }
}

/// The mass matrix at the start, by the formulas of two rods: its rows follow each other.
#[test]
fn a_measure_of_a_matrix_follows_row_by_row() {
    let found = measured(&json!({"measure": {"m": "initial(lib.massMatrix())"}, "says": [["0.1", "m[0]"]]}));
    let [a, b, c, d] = found.iter().map(|(_, x)| *x).collect::<Vec<_>>().try_into().unwrap();
    assert_eq!(b, c, "a mass matrix is symmetric");
    // A capsule of the radius 0.02 m and the length 0.3 m, of water.
    let (r, l) = (0.02_f64, 0.3_f64);
    let pi = std::f64::consts::PI;
    let (cylinder, caps) = (1000.0 * pi * r * r * l, 1000.0 * 4.0 / 3.0 * pi * r * r * r);
    let mass = cylinder + caps;
    let across = cylinder * (3.0 * r * r + l * l) / 12.0
        + caps * (2.0 * r * r / 5.0 + l * l / 4.0 + 3.0 * l * r / 8.0);
    let about_end = across + mass * l * l / 4.0;
    for (found, expected) in [
        (a, across + mass * l * l / 4.0 + across + mass * (1.5 * l) * (1.5 * l)),
        (b, across + mass * 0.5 * l * 1.5 * l),
        (d, about_end),
    ] {
        assert!((found - expected).abs() < 1e-12 * expected, "{found} {expected}");
    }
}

/// In a sweep, the elements of all runs follow each other.
#[test]
fn lists_of_a_sweep_follow_each_other() {
    let list = measured(&json!({"runs": {"fall": {"sweep": {"damping": [0.1, 0.5, 1]}, "until": 0.2}},
        "measure": {"q": "final(data.qpos)", "t": "final(data.time)"}, "says": [["0.1", "fall.q[3]"]]}));
    let single = measured(&json!({"runs": {"fall": {"set": {"damping": 0.5}, "until": 0.2}},
        "measure": {"b": "final(data.qpos[1])"}, "says": [["0.1", "b"]]}));
    let third = list.iter().find(|(name, _)| name == "fall.q[3]").unwrap();
    assert_eq!(third.1.to_bits(), single[0].1.to_bits());
    assert!(list.iter().any(|(name, _)| name == "fall.t[2]"), "{list:?}");
    // A line needs one number for each value.
    let sweep = |says: &str| {
        json!({"runs": {"fall": {"sweep": {"damping": [0.1, 0.5, 1]}, "until": 0.2}},
            "measure": {"q": "final(data.qpos)"}, "says": [["0.1", says]]})
    };
    assert_eq!(check("0.1", &sweep("slope(fall.q)")).0, ["failed"]);
    let lines = sweep("slope(fall.q.filter((x, i) => i % 2 === 0), fall.value)");
    assert_eq!(check("0.1", &lines).0, ["refuted"]);
}

/// A list stands for the numbers of a quote in their order; another number of them, and a shifted one, is no match.
#[test]
fn a_quote_states_a_whole_list() {
    let found = measured(
        &json!({"runs": {"a": {"until": 0.1}}, "measure": {"q": "final(data.qpos)"}, "says": [["0.1", "q[0]"]]}),
    );
    let text: Vec<String> = found.iter().map(|(_, x)| format!("{x:.3}")).collect();
    let quote = format!("{} and {} rad", text[0], text[1]);
    let verify = |quote: &str| json!({"runs": {"a": {"until": 0.1}}, "measure": {"q": "final(data.qpos)"}, "says": [[quote, "q"]]});
    let (verdicts, findings) = check(&quote, &verify(&quote));
    assert_eq!(verdicts, ["verified", "verified"], "{findings:#?}");
    let shifted = format!("{:.3} and {} rad", found[0].1 + 0.002, text[1]);
    assert_eq!(check(&shifted, &verify(&shifted)).0, ["refuted", "verified"]);
    let swapped = format!("{} and {} rad", text[1], text[0]);
    assert_eq!(check(&swapped, &verify(&swapped)).0, ["refuted", "refuted"]);
    let short = format!("{} rad", text[0]);
    assert_eq!(check(&short, &verify(&short)).0, ["failed"]);
}

/// What is no list stays the mistake that it was, and a list is no number.
#[test]
fn a_list_is_not_a_number() {
    let of = |measure: &str, says: &str| {
        check("0.1", &json!({"measure": {"q": measure}, "says": [["0.1", says]]})).1
    };
    let codes = |found: Vec<Finding>| found.iter().map(|f| f.code).collect::<Vec<_>>();
    assert!(codes(of("final(data.joint('elbow').qpos)", "q")).contains(&"whole-array"));
    assert!(codes(of("final(data.qpos) + final(data.ctrl)", "q[0]")).contains(&"whole-array"));
    assert_eq!(codes(of("final(data.qpos)", "q + 1")), ["whole-array"]);
    assert_eq!(codes(of("final(data.qpos)", "q[2]")), ["index-out-of-range"]);
}

/// A run replaces an element: the motor becomes a servo, which holds the arm.
#[test]
fn a_run_replaces_an_element() {
    let verify = json!({
        "runs": {"free": {"until": 0.5}, "held": {"model": {"motor drive": "<position joint='shoulder' kp='400' dampratio='1'/>"}, "until": 0.5},
            "light": {"model": {"default geom density": 10}, "until": 0.1}},
        "measure": {"low": "max(abs(data.qpos[0]))", "mass": "initial(model.body_mass[1])"}});
    let found = measured(&{
        let mut all = verify.clone();
        all["says"] = json!([["0.1", "held.low"], ["0.1", "free.low"], ["0.1", "light.mass"]]);
        all
    });
    let value = |name: &str| found.iter().find(|(other, _)| other == name).unwrap().1;
    assert!(value("free.low") > 0.5 && value("held.low") < 0.01, "{found:?}");
    assert!((value("free.mass") / value("light.mass") - 100.0).abs() < 1e-9, "{found:?}");
    let refused = json!({"runs": {"held": {"model": {"motor drive": "<position joint='shoulder' kp='400'"}}},
        "measure": {"low": "max(data.qpos[0])"}, "says": [["0.1", "low"]]});
    let (verdicts, findings) = check("0.1", &refused);
    assert_eq!(verdicts, ["failed"]);
    assert!(
        findings.iter().any(|f| f.code == "run-impossible" && f.message.contains("is not XML")),
        "{findings:#?}"
    );
}

/// A name that is used very often is one finding with few places, and the lists of an object are limited together.
#[test]
fn many_uses_of_a_name_and_many_lists_are_bounded() {
    let readouts: Vec<Value> =
        (0..400).map(|i| json!({"label": format!("r{i}"), "expr": "undeclared_name + 1"})).collect();
    let lab = json!({"xml": ARM, "readouts": readouts});
    let found = check_text("many.md", &format!("```lab simlab\n{lab}\n```\n")).findings;
    let of_name = found.iter().filter(|f| f.code == "unknown-name");
    assert_eq!(of_name.clone().count(), 1);
    assert!(of_name.map(|f| f.related.len()).all(|n| n <= 20));
    let measures: serde_json::Map<String, Value> = (0..3000)
        .map(|i| (format!("m{i}"), json!("[0, 1, 2, 3, 4, 5, 6, 7, 8, 9].map(x => x * max(data.time))")))
        .collect();
    let (verdicts, findings) =
        check("0.1", &json!({"runs": {"a": {"steps": 2}}, "measure": measures, "says": [["0.1", "m0[1]"]]}));
    assert_eq!(verdicts.len(), 1);
    assert!(findings.iter().any(|f| f.code == "whole-array"), "the lists beyond the limit are refused");
}
