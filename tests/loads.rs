//! Models that MuJoCo refuses are never called clean, and models that it loads are loaded here: models of the zoo with one
//! unusual attribute, recorded by `tests/golden/loads.py`.

// A test that cannot read its own inputs must fail.
#![allow(clippy::unwrap_used)]

use crate::support::workspace;
use labspec_core::xml;
use std::collections::BTreeMap;

/// Models that we refuse and MuJoCo loads, by the code of the error and a part of its message, because the physics would be
/// wrong or the model is certainly unintended.
const STRICTER: [(&str, &str, &str); 16] = [
    ("mjcf-number", "finite", "a number that is none makes every result none"),
    (
        "mjcf-keyframe",
        "",
        "the rest of a configuration would be filled with angles in degrees and poses outside their frames",
    ),
    (
        "mjcf-unknown-name",
        "",
        "a name that nothing has, of which the library takes no notice: discarded visuals, a target beside another",
    ),
    ("mjcf-value", "`timestep` of option", "time would stand still or go back"),
    ("mjcf-value", "`impratio` of option", "a ratio of impedances"),
    ("mjcf-value", "`density` of option", "a medium that pushes what moves"),
    ("mjcf-value", "`viscosity` of option", "a medium that pushes what moves"),
    ("mjcf-value", "of statistic", "a size"),
    ("mjcf-value", "of compiler", "a lower bound below zero bounds nothing"),
    ("mjcf-value", "`eulerseq`", "letters that are no axes, noticed there only where an angle is read"),
    ("mjcf-actuator", "negative delay", "a control that acts before it is given"),
    ("mjcf-actuator", "zero or more", "a diameter, gain or limit below zero"),
    ("mjcf-actuator", "both `kv` and `dampratio`", "two dampings, of which one is dropped without a word"),
    ("mjcf-actuator", "`dampratio` and a negative `kp`", "the root of a negative number"),
    ("mjcf-tendon", "`divisor`", "a length divided by zero"),
    ("mjcf-copy", "", "a copy that would act on what is not copied"),
];

#[test]
fn models_that_mujoco_refuses_are_refused() {
    let text = std::fs::read_to_string(workspace().join("tests/golden/loads.json")).unwrap();
    let cases: Vec<(String, usize, usize, String, String)> = serde_json::from_str(&text).unwrap();
    let mut models: BTreeMap<String, String> = BTreeMap::new();
    let (mut accepted, mut stricter, mut unnamed) = (Vec::new(), 0, Vec::new());
    for (file, start, end, new, refusal) in &cases {
        let path = workspace().join("specs/models/zoo").join(file);
        let model = models.entry(file.clone()).or_insert_with(|| std::fs::read_to_string(path).unwrap());
        let mut edited = model.clone();
        edited.replace_range(*start..*end, new);
        let edit = || format!("{file}:{start} {new}");
        match xml::compile(&edited) {
            Ok(_) if refusal.is_empty() => {}
            Ok(_) => accepted.push(format!("{}: {refusal}", edit())),
            Err(_) if !refusal.is_empty() => {}
            Err(error) => {
                stricter += 1;
                let is_expected = |d: &xml::Finding| {
                    STRICTER.iter().any(|(code, part, _)| *code == d.code && d.message.contains(part))
                };
                if let Some(d) = error.iter().find(|d| !is_expected(d)) {
                    unnamed.push(format!("{}: {} {}", edit(), d.code, d.message));
                }
            }
        }
    }
    assert!(cases.len() > 2900 && accepted.is_empty(), "loads here:\n{}", accepted.join("\n"));
    assert!(unnamed.is_empty(), "refused here:\n{}", unnamed.join("\n"));
    assert!(stricter < cases.len() / 25, "{stricter} of {} are refused here alone", cases.len());
}
