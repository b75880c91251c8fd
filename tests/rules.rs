//! Every rule has two examples, and both are executed: the wrong one violates the rule, the right one violates no rule.

#![allow(clippy::unwrap_used)]

use crate::needs::{is_available, needs};
use crate::program::run_in;
use labspec::rules::{self, Rule, example};
use labspec_finding::{Example, Layer};
use std::ops::Range;

/// A finding: its code, the file, and its byte range.
type Found = (String, String, Range<usize>);

/// The report of a check of the files of an example, the first of which is checked, and all output of the program.
pub(crate) fn report_of(example: &Example, files: &[(String, Vec<u8>)]) -> (serde_json::Value, String) {
    let folder = tempfile::tempdir().unwrap();
    for (name, bytes) in files {
        let path = folder.path().join(name);
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        match name.ends_with('/') {
            true => std::fs::create_dir_all(path).unwrap(),
            false => std::fs::write(path, bytes).unwrap(),
        }
    }
    for model in ["ball", "pendulum"] {
        // Models that lessons use; a rule about models has its own.
        if matches!(example, Example::Lesson(_) | Example::Lab(_) | Example::Quiz(_) | Example::Json(_)) {
            std::fs::create_dir_all(folder.path().join("models")).unwrap();
            std::fs::write(folder.path().join(format!("models/{model}.xml")), example::MODEL).unwrap();
        }
    }
    // A correct lesson next to it, because there is no report if nothing could be read.
    std::fs::write(folder.path().join("other.md"), "A lesson in order.\n").unwrap();
    let mut arguments = vec!["check", "--format", "json", &files[0].0, "other.md"];
    // The recording of the real library is a file that an option names.
    if files.iter().any(|(name, _)| name == "judge.json") {
        arguments.extend(["--judge", "judge.json"]);
    }
    // Listings are run on request only.
    if runs_listings(example) {
        arguments.push("--listings");
        if !is_available("unshare") {
            std::fs::write(folder.path().join("labspec.toml"), "[listings]\nnetwork = true\n").unwrap();
        }
    }
    let out = run_in(folder.path(), &arguments);
    let output = format!("{}{}", out.stdout, out.stderr);
    (serde_json::from_str(&out.stdout).unwrap_or_default(), output)
}

/// Whether an example has a listing with its output.
pub(crate) fn runs_listings(example: &Example) -> bool {
    matches!(example, Example::Lesson(text) if text.contains("```python") && text.contains("\nOutput:\n"))
}

/// The findings of a check of an example, and all output of the program.
fn found(example: &Example) -> (Vec<Found>, String) {
    let (report, output) = report_of(example, &example::files(example));
    let found = |f: &serde_json::Value| {
        let text = |value: &serde_json::Value| value.as_str().unwrap_or("").to_string();
        let byte = |key: &str| f[key].as_u64().unwrap_or(0) as usize;
        (text(&f["code"]), text(&f["file"]), byte("start")..byte("end"))
    };
    (report["findings"].as_array().into_iter().flatten().map(found).collect(), output)
}

fn start(text: &str, most: usize) -> String {
    text.chars().take(most).collect()
}

/// Rules whose finding has no location in the checked file.
const WITHOUT_A_PLACE: [&str; 1] = ["model-unreadable"];

/// Checks the examples of one layer.
fn hold(layer: Layer) {
    let mut wrong = Vec::new();
    for Rule { code, bad, good, .. } in rules::all().filter(|rule| rule.layer == layer) {
        if runs_listings(bad) && !needs("python3") {
            continue;
        }
        let (all, output) = found(bad);
        let file = example::files(bad).swap_remove(0).0;
        let place = example::marked(bad);
        let there =
            |(c, f, at): &Found| c == code && place.as_ref().is_none_or(|place| *f == file && at == place);
        if !all.iter().any(there) {
            wrong.push(format!(
                "{code} at {place:?}: the wrong example gives {all:?}\n{}",
                start(&output, 200)
            ));
        }
        let long = matches!(bad, Example::Repeated(..) | Example::Long(..) | Example::LongModel(..));
        if place.is_none() && !long && !WITHOUT_A_PLACE.contains(code) {
            wrong.push(format!("{code}: the wrong example does not mark its place: {all:?}"));
        }
        let (all, output) = found(good);
        if !all.is_empty() || good.marked().is_some() {
            wrong.push(format!("{code}: the right example gives {all:?}\n{}", start(&output, 900)));
        }
    }
    assert!(wrong.is_empty(), "{}\n{} wrong", wrong.join("\n"), wrong.len());
}

macro_rules! layers {
    ($($name:ident: $layer:ident,)*) => {
        $(#[test] fn $name() { hold(Layer::$layer) })*
    };
}

layers! {
    examples_about_files: Source,
    examples_about_json: Json,
    examples_about_structure: Structure,
    examples_about_models: Model,
    examples_about_programs: Program,
    examples_about_runs: Run,
    examples_about_claims: Claim,
}

#[test]
fn every_rule_says_why() {
    for rule in rules::all() {
        assert!(!rule.summary.is_empty(), "{}", rule.code);
        assert!(!rule.why.is_empty(), "{} does not say why it matters", rule.code);
    }
}

/// A scene with a constant mass matrix is not checked in every step. Still, a negative matrix is reported, as in MuJoCo 3.14.0
/// (101 warnings of inertia in 100 steps).
#[test]
fn a_removed_inertia_is_reported() {
    let lab = |setup: &str| {
        Example::Lab(Box::leak(
            format!(
                "{{\"xml\": \"<mujoco><worldbody><body><joint/><geom size='.1'/></body></worldbody></mujoco>\", \
                 \"setup\": \"{setup}; mj.mj_setConst(model, data)\", \"readouts\": [{{\"label\": \"angle\", \"expr\": \"data.qpos[0]\"}}]}}"
            )
            .into_boxed_str(),
        ))
    };
    let codes = |setup: &str| found(&lab(setup)).0.into_iter().map(|(code, ..)| code).collect::<Vec<_>>();
    assert_eq!(codes("model.dof_armature[0] = -5"), ["engine-warning"]);
    assert_eq!(codes("model.dof_armature[0] = 5"), Vec::<String>::new());
}
