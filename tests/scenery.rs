//! The models of our own lessons (`specs/models`), compared with the results of MuJoCo 3.14.0; recorded by `golden/course.py`.
//!
//! Constants, forward passes and all integrators without constraints, as for the zoo; then runs with all features, with the
//! settings of the lessons. Differences are absolute for numbers up to 1 and relative above.

#![allow(clippy::unwrap_used, clippy::panic)]

use crate::model_results::ModelResults;
use crate::recorded::{compare_with_recording, list, named, objects, start, worst};
use crate::support::{models, numbers, recording, workspace};
use labspec_core::reflect::Object;
use labspec_core::{self as core, Data, Model, xml};
use serde_json::Value;
use std::path::PathBuf;

/// The tolerance of a run. The library's solver stops when an improvement falls below 1e-8.
const RUN: f64 = 1e-6;
/// The tolerance of forces, which a stiff contact derives from the positions.
const FORCE: f64 = 1e-4;

fn folder() -> PathBuf {
    workspace().join("specs/models")
}

#[test]
fn every_model_of_the_lessons_is_as_recorded() {
    let mut results = ModelResults::default();
    let all = models(&folder());
    assert!(all.len() >= 16, "{all:?}");
    for name in all {
        let model = folder().join(format!("{name}.xml"));
        results.add(name.clone(), compare_with_recording(&model, &recording(&format!("course/{name}"))));
    }
    assert_eq!(results.refused(), 0);
    results.check(None, &[]);
}

/// Writes the settings of a run: fields of the model, of its options or of the data.
fn write(m: &mut Model, d: &mut Data, settings: &Value) {
    for setting in settings.as_array().unwrap() {
        let name = setting[0].as_str().unwrap();
        let field = match name.strip_prefix("opt.") {
            Some(option) => named(Object::Option, option),
            None => {
                labspec_core::reflect::field(Object::Model, name).unwrap_or_else(|| named(Object::Data, name))
            }
        };
        let index = setting[1].as_u64().unwrap() as usize;
        core::view_mut(m, d, field).unwrap().set(index, setting[2].as_f64().unwrap());
    }
}

/// Follows a recorded run; returns the differences in words.
fn follow(m: &mut Model, run: &Value) -> Vec<String> {
    let mut d = Data::new(m);
    write(m, &mut d, &run["set"]);
    start(m, &mut d);
    write(m, &mut d, &run["state"]);
    let every = run["every"].as_u64().unwrap();
    let touching = |n: &Value| vec![n[0].as_u64().unwrap(); n[1].as_u64().unwrap() as usize];
    let ncon: Vec<u64> = run["ncon"].as_array().unwrap().iter().flat_map(touching).collect();
    let (mut wrong, mut step) = (Vec::new(), 0);
    for row in run["rows"].as_array().unwrap() {
        for _ in 0..every {
            core::step(m, &mut d).unwrap();
            if d.ncon as u64 != ncon[step] {
                wrong.push(format!("step {step}: {} contacts, theirs {}", d.ncon, ncon[step]));
                return wrong;
            }
            step += 1;
        }
        for (field, values) in objects(row) {
            let (computed, recorded) = (list(m, &d, named(Object::Data, field)), numbers(values));
            let scale = recorded.iter().fold(1.0, |s: f64, x| s.max(x.abs()));
            let (index, difference) = worst(&computed, &recorded, scale);
            if difference > if field == "qfrc_constraint" { FORCE } else { RUN } {
                wrong.push(format!(
                    "step {step}, {field}[{index}]: ours {}, theirs {} ({difference:.1e})",
                    computed[index], recorded[index]
                ));
            }
        }
    }
    wrong
}

#[test]
fn the_runs_of_the_lessons_are_those_of_the_library() {
    let recorded = recording("course");
    let (mut wrong, mut runs) = (Vec::new(), 0);
    for name in models(&folder()) {
        let all = recorded["models"][&name].as_array().unwrap_or_else(|| panic!("{name} is not recorded"));
        assert!(!all.is_empty(), "{name}");
        for run in all {
            let mut m = xml::compile_file(&folder().join(format!("{name}.xml"))).unwrap();
            wrong.extend(
                follow(&mut m, run).into_iter().take(3).map(|w| format!("{name} {}: {w}", run["set"])),
            );
            runs += 1;
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    assert!(runs > 35, "{runs}");
}
