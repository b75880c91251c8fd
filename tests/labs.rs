//! The labs of `../shared` as we run them and as a page runs them on MuJoCo 3.14.0, JavaScript evaluating their
//! expressions: `golden/labs.py` records. Each lab as it opens, with each slider at its ends, with each button pressed.
//!
//! A trace may be off by a millionth of its range, or by less than our own trace moves when the start and gravity move by 1e-14:
//! then the lab is chaotic, and the test prints it. `LABSPEC_LABS` may name a recording with more rows.

#![allow(clippy::unwrap_used, clippy::panic)]

use crate::support::{read_json, workspace};
use labspec::bind::Programs;
use labspec::bind::scene::Models;
use labspec::lint::ModelFolder;
use labspec::run::{self, RunOptions};
use labspec::source::SourceFile;
use labspec::spec::load_lesson;
use labspec_core::Model;
use labspec_expr::Value;
use serde_json::Value as Json;
use std::path::Path;

/// Of the range of a trace.
const TRACE: f64 = 1e-6;
/// The step of a perturbed start.
const NUDGE: f64 = 1e-14;

/// Runs a lab as a recording did. `nudge` moves coordinates and gravity.
fn ours(shared: &Path, recording: &Json, nudge: f64) -> Json {
    let name = recording["lab"].as_str().unwrap();
    let folder = ModelFolder::open(&shared.join("corpus/models")).unwrap();
    let file = SourceFile::read(&shared.join(format!("corpus/labs/{name}.json"))).unwrap();
    let lesson = load_lesson(file, &folder);
    let lab = lesson.addressed()[0].1;
    let mut findings = Vec::new();
    let mut models = Models::new(folder);
    let model =
        models.of(lab, &mut findings).unwrap_or_else(|| panic!("{name}: {:?}", models.take_findings()));
    let mut model: Model = (*model).clone();
    model.qpos0.iter_mut().chain(&mut model.key_qpos).for_each(|q| *q += nudge);
    model.opt.gravity.iter_mut().for_each(|g| *g *= 1.0 + nudge);
    let programs = Programs::compile(lab, &model, &mut findings);
    let pairs = |key: &str| recording[key].as_array().unwrap().clone();
    let options = RunOptions {
        until: None,
        steps: recording["steps"].as_u64().map(|n| n as usize),
        every: recording["every"].as_u64().unwrap() as usize,
        set: pairs("set")
            .iter()
            .map(|p| (p[0].as_str().unwrap().into(), Value::Number(p[1].as_f64().unwrap())))
            .collect(),
        press: pairs("press").iter().map(|p| (p.as_str().unwrap().into(), 0.0)).collect(),
    };
    let table = run::run(lab, &model, &programs, &options).unwrap_or_else(|e| panic!("{name}: {e}"));
    serde_json::from_str(&table.json().to_string()).unwrap()
}

/// The largest difference of a column over its range; infinite where something is not a number on one side, or another text.
fn apart(recording: &Json, column: usize, a: &Json, b: &Json) -> f64 {
    let (a, b) = (a["rows"].as_array().unwrap(), b["rows"].as_array().unwrap());
    if a.len() != b.len() {
        return f64::INFINITY;
    }
    let span = recording["span"][column].as_f64().unwrap();
    let difference = |(x, y): (&Json, &Json)| match (x[column].as_f64(), y[column].as_f64()) {
        (Some(x), Some(y)) => (x - y).abs() / span,
        _ if x[column] == y[column] => 0.0,
        _ => f64::INFINITY,
    };
    a.iter().zip(b).map(difference).fold(0.0, f64::max)
}

#[test]
fn labs_trace_what_they_trace_on_a_page() {
    let shared = workspace().join("../shared");
    if !shared.join("corpus/labs").is_dir() {
        println!("skipped: there are no labs in {}", shared.display());
        return;
    }
    let path = std::env::var_os("LABSPEC_LABS")
        .map_or_else(|| workspace().join("tests/golden/labs.json"), std::path::PathBuf::from);
    let (mut wrong, mut chaotic, mut same) = (Vec::new(), 0, 0.0_f64);
    let recordings = read_json(&path);
    for recording in recordings.as_array().unwrap() {
        let found = ours(&shared, recording, 0.0);
        let what = format!("{} {} {}", recording["lab"], recording["set"], recording["press"]);
        let mut nudged = None;
        if found["warnings"] != recording["warnings"] {
            wrong.push(format!("{what}: warnings {}, theirs {}", found["warnings"], recording["warnings"]));
        }
        let columns = recording["columns"].as_array().unwrap();
        assert_eq!(found["columns"].as_array().unwrap(), columns, "{what}");
        for (i, name) in columns.iter().enumerate() {
            let from_theirs = apart(recording, i, &found, recording);
            if from_theirs <= TRACE {
                same = same.max(from_theirs);
                continue;
            }
            let other = nudged.get_or_insert_with(|| ours(&shared, recording, NUDGE));
            let from_itself = apart(recording, i, &found, other);
            if from_theirs <= from_itself {
                println!("{what} {name}: {from_theirs:.1e} from theirs, {from_itself:.1e} from itself");
                chaotic += 1;
            } else {
                wrong.push(format!(
                    "{what} {name}: {from_theirs:.1e} of its range, {from_itself:.1e} from itself"
                ));
            }
        }
    }
    println!(
        "{} runs, traces within {same:.1e} of their range, {chaotic} chaotic",
        recordings.as_array().unwrap().len()
    );
    assert!(wrong.is_empty(), "labs that trace something else on MuJoCo 3.14.0:\n{}", wrong.join("\n"));
}
