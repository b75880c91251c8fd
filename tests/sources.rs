//! What a claim takes from elsewhere: the values of a sweep from a file beside the lesson, and a model from a listing of the lesson.
//! And lists of runs with names of their own.

#![allow(clippy::unwrap_used)]

use labspec::Checker;
use labspec::finding::Finding;
use labspec::lint::ModelFolder;
use serde_json::{Value, json};

const BALL: &str = "<mujoco><worldbody><geom name='floor' type='plane' size='1 1 1'/><body name='ball' pos='0 0 1'><freejoint/><geom name='ball' type='sphere' size='0.05' mass='1'/></body></worldbody></mujoco>";

/// The verdicts and the findings of a lesson beside other files.
fn check(text: &str, files: &[(&str, &str)]) -> (Vec<String>, Vec<Finding>) {
    let mut checker = Checker::new(ModelFolder::unknown()).neighbours(files.iter().copied());
    let report = checker.check("lesson.md", text);
    let verdicts = report.checked.claims.iter().flat_map(|claim| &claim.judgement.quotes);
    (verdicts.map(|quote| quote.verdict().to_string()).collect(), report.checked.findings.clone())
}

fn drops(prose: &str, verify: &Value) -> String {
    let lab = json!({"xml": BALL,
        "controls": [{"label": "height", "unit": "m", "apply": "data.qpos[2] = value", "min": 0.5, "max": 2, "step": 0.05, "value": 1, "init": true}],
        "verify": verify});
    format!("{prose}\n\n```lab simlab\n{lab}\n```\n")
}

fn lands(runs: &Value, says: &Value) -> Value {
    json!({"runs": runs, "measure": {"lands": "first(contact('ball', 'floor'))"}, "says": says})
}

#[test]
fn a_list_of_names_is_a_run_for_each() {
    let runs = json!({"low, high": {"sweep": {"height": [0.5, 1.5]}, "until": 1}});
    let says =
        json!([["0.304 s", "low.lands"], ["0.546 s", "high.lands"], ["later", "high.lands > low.lands"]]);
    let (verdicts, found) = check(&drops("0.304 s, 0.546 s: later", &lands(&runs, &says)), &[]);
    assert_eq!(verdicts, ["verified"; 3], "{found:#?}");
    // The order of the values counts.
    let swapped = json!([["0.304 s", "high.lands"], ["0.546 s", "low.lands"]]);
    assert_eq!(check(&drops("0.304 s, 0.546 s", &lands(&runs, &swapped)), &[]).0, ["refuted"; 2]);
    // Each of them is a run, not a list of runs.
    let list = json!([["0.304 s", "low.lands[0]"]]);
    assert_eq!(check(&drops("0.304 s", &lands(&runs, &list)), &[]).0, ["failed"]);
}

#[test]
fn lists_of_names_that_fit_no_sweep_are_explained() {
    let says = json!([["0.304 s", "low.lands"]]);
    for (runs, words) in [
        (
            json!({"low, middle, high": {"sweep": {"height": [0.5, 1.5]}}}),
            "this list has 3 names, but the sweep has 2 runs",
        ),
        (json!({"low, low": {"sweep": {"height": [0.5, 1.5]}}}), "there are two runs `low`"),
        (json!({"low, high": {"sweep": {"height": [0.5, 1.5]}}, "high": {}}), "there are two runs `high`"),
    ] {
        let (_, found) = check(&drops("0.304 s", &lands(&runs, &says)), &[]);
        assert!(found.iter().any(|f| f.message.contains(words)), "{runs}: {found:#?}");
    }
}

#[test]
fn the_values_of_a_sweep_are_read_from_a_file() {
    let runs = |values: Value| json!({"fall": {"sweep": {"height": values}, "until": 1}});
    let says = json!([["0.304 s", "fall.lands[0]"], ["0.546 s", "fall.lands[1]"]]);
    let text = |values: Value| drops("0.304 s, 0.546 s", &lands(&runs(values), &says));
    let csv = ("data.csv", "name;height (m)\nlow;0.5\nhigh;1.5\n");
    let column = json!({"file": "data.csv", "column": "height (m)"});
    let (verdicts, found) = check(&text(column.clone()), &[csv]);
    assert_eq!(verdicts, ["verified"; 2], "{found:#?}");
    let (verdicts, found) = check(&text(json!({"file": "plain.txt"})), &[("plain.txt", "0.5\n1.5\n")]);
    assert_eq!(verdicts, ["verified"; 2], "{found:#?}");
    // The values are those of the file: with others, the claims are false.
    let other = ("data.csv", "name;height (m)\nlow;1.0\nhigh;2.0\n");
    assert_eq!(check(&text(column.clone()), &[other]).0, ["refuted"; 2]);
    for (values, files, words) in [
        (json!({"file": "other.csv"}), vec![csv], "`other.csv` cannot be used: "),
        (json!({"file": "data.csv"}), vec![csv], "it has 2 columns: add `column`"),
        (json!({"file": "data.csv", "column": "mass"}), vec![csv], "its columns are `name`, `height (m)`"),
        (json!({"file": "data.csv", "column": "name"}), vec![csv], "row 1 of this column has `low`"),
        (json!({"file": "/etc/passwd"}), vec![csv], "by its path from the lesson"),
        (
            column.clone(),
            vec![("data.csv", "height (m)\n1\n")],
            "a sweep must have 2 to 100 runs; this one has 1",
        ),
        (json!({"file": "data.csv", "colum": "name"}), vec![csv], "did you mean"),
    ] {
        let (verdicts, found) = check(&text(values.clone()), &files);
        let explained = found
            .iter()
            .any(|f| f.message.contains(words) || f.help.as_deref().is_some_and(|help| help.contains(words)));
        assert!(explained, "{values}: {found:#?}");
        assert!(verdicts.iter().all(|v| v == "failed"), "{values}: {verdicts:?}");
    }
}

#[test]
fn a_listing_of_the_lesson_is_the_model_of_a_run() {
    let heavy = BALL.replace("pos='0 0 1'", "pos='0 0 0.5'");
    let verify = |listing: &str| {
        let runs = json!({"shown": {"lab": {"xml": {"listing": listing}}, "until": 1}, "own": {"until": 1}});
        lands(&runs, &json!([["0.304 s", "shown.lands"], ["0.442 s", "own.lands"]]))
    };
    let text = |model: &str, listing: &str| {
        format!("0.304 s, 0.442 s\n\n```xml file=low.xml\n{model}\n```\n\n{}", drops("", &verify(listing)))
    };
    let (verdicts, found) = check(&text(&heavy, "low.xml"), &[]);
    assert_eq!(verdicts, ["verified"; 2], "{found:#?}");
    let (verdicts, _) = check(&text(BALL, "low.xml"), &[]);
    assert_eq!(verdicts, ["refuted", "verified"], "the listing is the model");
    let (_, found) = check(&text(&heavy, "high.xml"), &[]);
    assert!(found.iter().any(|f| f.message.contains("the lesson shows the listings low.xml")), "{found:#?}");
    // A mistake in the model is reported in the listing.
    let broken = text(&heavy.replace("size='0.05'", "size='-1'"), "low.xml");
    let (_, found) = check(&broken, &[]);
    let listing = broken.find("```lab").unwrap();
    assert!(found.iter().any(|f| f.is_error() && f.span.start < listing), "{found:#?}");
    // A lab outside of `verify` is what a page shows, and a page cannot read listings.
    let lab = json!({"xml": {"listing": "low.xml"}});
    let (_, found) = check(&format!("```xml file=low.xml\n{BALL}\n```\n\n```lab simlab\n{lab}\n```\n"), &[]);
    assert!(found.iter().any(|f| f.code == "wrong-type"), "{found:#?}");
}

/// What a controller keeps in `ctx` is a result of the simulation if it depends on it, and else a formula.
#[test]
fn variables_that_a_controller_computes_are_simulated() {
    let lesson = |controller: &str, quote: &str| {
        let lab = json!({"xml": BALL, "controller": controller, "stopAt": 0.4,
            "verify": {"measure": {"kept": "final(ctx.kept)"}, "says": [[quote, "kept"]]}});
        check(&format!("It is {quote}.\n\n```lab simlab\n{lab}\n```\n"), &[])
    };
    let fastest = "ctx.kept = Math.max(ctx.kept || 0, Math.abs(data.qvel[2]))";
    let (verdicts, found) = lesson(fastest, "3.9 m/s");
    assert_eq!(verdicts, ["verified"], "{found:#?}");
    assert_eq!(lesson(fastest, "4.1 m/s").0, ["refuted"]);
    // An indirect result, by way of another variable.
    let (verdicts, found) = lesson("ctx.z = data.qpos[2]; ctx.kept = 2 * ctx.z", "0.44 m");
    assert_eq!(verdicts, ["verified"], "{found:#?}");
    // A constant beside a result is no result.
    assert_eq!(lesson("ctx.z = data.qpos[2]; ctx.kept = 7", "7").0, ["computed"]);
    assert_eq!(lesson("ctx.kept = 2 * data.time", "0.80").0, ["computed"]);
    assert_eq!(lesson("ctx.kept = lib.rad(30)", "0.52").0, ["computed"]);
    // What no run can change says nothing.
    let (verdicts, found) = lesson("ctx.kept = data.qpos[2] > -1e300 ? 7 : 7", "7");
    assert_ne!(verdicts, ["verified"], "{found:#?}");
}
