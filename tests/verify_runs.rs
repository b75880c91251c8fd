//! What a `verify` object may contain besides its quotes: settings of runs, several labs, sweeps, searches and tables.

#![allow(clippy::unwrap_used)]

use crate::support::check_text;
use labspec::check::Checked;
use labspec::verify::{QuoteState, Verdict};
use serde_json::json;

/// Measures over a run, compared with the formula of a fall: z = 9 - ½ g t (t + h).
#[test]
fn measures_over_a_fall_are_those_of_a_fall() {
    let lab = |measure: &str, quote: &str| {
        let lab = json!({"xml": "<mujoco><worldbody><body pos='0 0 9'><freejoint/><geom size='.1'/></body></worldbody></mujoco>",
            "note": quote, "verify": {"runs": {"r": {"until": 1}}, "measure": {"m": measure}, "says": [[quote, "m"]]}});
        let checked = check_text("lab.json", &lab.to_string());
        checked.claims[0].judgement.quotes[0].state
    };
    for (measure, quote) in [
        ("last(data.qpos[2] > 8)", "0.450 s"),
        ("count(data.qpos[2] < 8)", "1 time"),
        ("crossings(data.qpos[2], 8)", "1 time"),
        ("settles(data.qvel[2], -9.81, 1)", "0.900 s"),
        ("peak(data.qpos[2])", "0.000 s"),
        ("holds(data.qpos[2] < 9.001)", "1 time"),
        ("rate(data.qvel[2])", "-9.810 m/s^2"),
        ("integral(data.qvel[2])", "-4.905 m"),
        ("rms(data.qvel[2])", "5.66 m/s"),
    ] {
        assert_eq!(lab(measure, quote), QuoteState::Right, "{measure}");
        assert_ne!(lab(measure, "7.77 m"), QuoteState::Right, "{measure}");
    }
}

/// A lab with this `verify` object about a ball that falls from 1 m onto a floor: the verdicts of its quotes, and the findings.
fn check_drop(
    says: &[[&str; 2]],
    verify: serde_json::Value,
) -> (Vec<&'static str>, Vec<labspec::finding::Finding>) {
    let mut verify = verify;
    verify["says"] = json!(says);
    let quotes: Vec<&str> = says.iter().map(|s| s[0]).collect();
    let lab = json!({
        "xml": "<mujoco><worldbody><geom name='floor' type='plane' size='1 1 1'/><body name='ball' pos='0 0 1'><freejoint/>\
            <geom name='ball' type='sphere' size='0.05' mass='1'/></body></worldbody>\
            <keyframe><key name='low' qpos='0 0 0.5 1 0 0 0'/></keyframe></mujoco>",
        "note": quotes.join("; "), "controller": "data.qfrc_applied[2] = 9.81",
        "controls": [{"label": "start (m)", "apply": "data.qpos[2] = value", "min": 0.1, "max": 2, "step": 0.05, "value": 1, "init": true},
            {"label": "timestep h", "set": "model.opt.timestep", "min": 0.001, "max": 0.05, "step": 0.001, "value": 0.002, "reset": true}],
        "readouts": [{"label": "height (m)", "expr": "data.qpos[2]", "digits": 2}],
        "verify": verify});
    let checked = check_text("lab.json", &lab.to_string());
    let quotes = checked.claims.iter().flat_map(|c| &c.judgement.quotes);
    (quotes.map(|q| q.verdict()).collect(), checked.findings.clone())
}

/// Whether a finding contains these words.
fn says(found: &[labspec::finding::Finding], words: &str) -> bool {
    found.iter().any(|f| f.message.contains(words) || f.help.as_deref().is_some_and(|h| h.contains(words)))
}

/// The model of a run is changed before it is compiled, a run may have its own controller and keyframe, and
/// it ends at its own time.
#[test]
fn a_run_changes_model_keyframe_and_controller() {
    let verify = json!({
        "measure": {"mass": "initial(model.body_mass[1])", "inertia": "1000 * initial(model.body_inertia[3])",
            "z": "final(data.qpos[2])", "t": "final(data.time)", "up": "final(shown('height (m)'))"},
        "runs": {
            "held": {"until": 0.1},
            "heavy": {"model": {"body ball mass": 5}, "until": 0.1},
            "quick": {"model": {"option timestep": 0.0005, "option gravity": [0, 0, -20]}, "controller": "", "until": 0.1},
            "low": {"key": "low", "set": {"start (m)": 0.5}, "controller": "", "until": 0.1},
            "ends": {"controller": "", "until": 3, "stop": "contact('ball', 'floor')"}}});
    let right = [
        ["1.00 m", "held.z"],
        ["5.00 kg", "heavy.mass"],
        ["5.00 g m²", "heavy.inertia"],
        ["0.960 m", "heavy.z"],
        ["0.8995 m", "quick.z"],
        ["0.90 m", "quick.up"],
        ["0.450 m", "low.z"],
        ["0.44 s", "ends.t"],
    ];
    let (verdicts, found) = check_drop(&right, verify.clone());
    // A value that only reads the model is computed.
    assert_eq!(verdicts[1..3], ["computed"; 2], "{found:#?}");
    assert_eq!([&verdicts[..1], &verdicts[3..]].concat(), ["verified"; 6], "{found:#?}");
    let wrong = [["1.00 kg", "heavy.mass"], ["0.95 m", "quick.z"], ["1.0 m", "low.z"], ["3.00 s", "ends.t"]];
    assert_eq!(check_drop(&wrong, verify).0, ["refuted"; 4]);
}

#[test]
fn an_invalid_setting_of_a_run_is_reported_with_similar_names() {
    let run = |run: serde_json::Value| {
        let verify = json!({"runs": {"r": run}, "measure": {"z": "final(data.qpos[2])"}});
        let (verdicts, found) = check_drop(&[["0.95 m", "z"]], verify);
        assert_eq!(verdicts, ["failed"], "{run}");
        found
    };
    for (keys, words) in [
        (json!({"model": {"body bal mass": 5}}), "did you mean `ball`?"),
        (json!({"model": {"geom ball fricton": 5}}), "did you mean `friction`?"),
        (json!({"model": {"geom ball mass": -1}}), "cannot be executed"),
        (json!({"key": "lo"}), "did you mean `low`?"),
        (json!({"key": 3}), "has no keyframe 3"),
        (json!({"controller": "data.qfrc_aplied[2] = 1"}), "qfrc_applied"),
        (json!({"stop": "first(contact('ball', 'floor'))"}), "must look at one sample"),
    ] {
        let found = run(keys.clone());
        assert!(says(&found, words), "{keys}: {found:#?}");
    }
}

/// One object uses several labs by address; a measure is evaluated in the labs where it is valid.
#[test]
fn runs_are_of_several_labs() {
    let lab = |body: &str, z: f64| json!({"xml": format!("<mujoco><worldbody><body name='{body}' pos='0 0 {z}'><freejoint/><geom size='.1'/></body></worldbody></mujoco>")});
    let lesson = |measure: &str, other: &str| {
        let verify = json!({"lab": "#1", "runs": {"a": {"until": 0.2}, "b": {"lab": other, "until": 0.2}, "c": {"lab": lab("three", 30.0), "until": 0.2}},
            "measure": {"z": "final(data.qpos[2])", "two": measure}, "options": ["b.z > a.z && c.z > b.z && b.two > 19", "b.z < a.z"]});
        let quiz = json!({"id": "q", "questions": [{"q": "Which?", "options": ["later", "now"], "answer": 0, "verify": verify}]});
        check_text("labs.json", &json!([lab("one", 10.0), lab("two", 20.0), quiz]).to_string())
    };
    let verdict = |checked: &Checked| checked.claims[0].judgement.answer.clone().unwrap().verdict;
    let right = lesson("final(data.body('two').xpos[2])", "#2");
    assert_eq!(verdict(&right), Verdict::Verified, "{:#?}", right.findings);
    // A misspelt name is valid in no lab, and a lab that does not exist cannot run.
    let wrong = lesson("final(data.body('too').xpos[2])", "#2");
    assert_eq!(verdict(&wrong), Verdict::Failed);
    assert!(says(&wrong.findings, "named \"too\""), "{:#?}", wrong.findings);
    let none = lesson("1 * 1", "#7");
    assert!(
        says(&none.findings, "the lesson has no lab `#7`") || says(&none.findings, "there is no lab"),
        "{:#?}",
        none.findings
    );
    assert_eq!(verdict(&none), Verdict::Failed);
}

/// A sweep is a run for each value; its measures are lists, to which a line or a power law is fitted.
#[test]
fn sweeps_measure_a_law() {
    let verify = json!({
        "measure": {"touch": "first(contact('ball', 'floor'))", "z": "final(data.qpos[2])", "mass": "initial(model.body_mass[1])"},
        "runs": {
            "fall": {"sweep": {"start (m)": {"from": 0.25, "to": 1.25, "count": 5}}, "set": {"timestep h": 0.001}, "controller": "", "until": 1, "stop": "contact('ball', 'floor')"},
            "weigh": {"sweep": {"body ball mass": [1, 2, 4]}, "until": 0.01}}});
    let right = [
        // A fall takes a time proportional to the square root of z - 0.05.
        ["0.50", "slope(fall.touch.map(t => Math.log(t)), fall.value.map(z => Math.log(z - 0.05)))"],
        ["0.451 s", "fall.touch[3] + 0.451 - 0.441"],
        ["5 times", "fall.touch.length"],
        ["1.00 m", "fall.value[3]"],
        ["1.00 kg", "slope(weigh.mass)"],
        ["1.000", "fit(weigh.mass, 'power')"],
        ["4 kg", "max(weigh.mass)"],
        ["2.33 kg", "mean(weigh.mass)"],
    ];
    let (verdicts, found) = check_drop(&right, verify.clone());
    // A value that only reads the model is computed.
    assert_eq!(verdicts[..2], ["verified"; 2], "{found:#?}");
    assert_eq!(verdicts[2..], ["computed"; 6], "{found:#?}");
    let wrong = [["0.60", right[0][1]], ["2.00 kg", "slope(weigh.mass)"], ["0.50 m", "fall.value[3]"]];
    assert_eq!(check_drop(&wrong, verify.clone()).0, ["refuted"; 3]);
    // Values that are not lists, members or laws are reported.
    for (expr, words) in [
        ("fall.touch[5]", "indexes are 0 to 4"),
        ("fit(fall.touch, 'root')", "'power'"),
        ("slope(fall.touch.map(t => t))", "run.value"),
        ("fall.tuoch[1]", "touch"),
    ] {
        let (verdicts, found) = check_drop(&[["0.50 s", expr]], verify.clone());
        assert_eq!(verdicts, ["failed"], "{expr}");
        assert!(says(&found, words), "{expr}: {found:#?}");
    }
}

#[test]
fn an_invalid_sweep_is_refused() {
    for (sweep, words) in [
        (json!({"start (m)": [1]}), "2 to 100 runs; this one has 1"),
        (json!({"start (m)": {"from": 0, "to": 1, "count": 101}}), "2 to 100 runs; this one has 101"),
        (json!({}), "must change 1 to 4 things"),
        (json!({"start (m)": [0.5, 1], "timestep h": [0.1]}), "2 to 100 runs; this one has 1"),
        (
            json!({"start (m)": {"from": 0.3, "to": 1, "count": 20}, "timestep h": {"from": 0.001, "to": 0.01, "count": 10}}),
            "this one has 200",
        ),
        (json!({"strat (m)": [0.5, 1]}), "did you mean `start (m)`?"),
        (json!({"geom bal mass": [0.5, 1]}), "did you mean `ball`?"),
        (json!({"start (m)": [0.5, 3]}), "3 cannot be chosen"),
    ] {
        let verify = json!({"runs": {"r": {"sweep": sweep}}, "measure": {"z": "final(data.qpos[2])"}});
        let found = check_drop(&[["0.95 m", "r.z[0]"]], verify).1;
        assert!(says(&found, words), "{sweep}: {found:#?}");
    }
}

/// The largest timestep with which a ball still rests above 0.049 m; the recorded value is 0.022576 s. It is found through the
/// model, through `timestep`, and through a control, for which it lies outside the range.
#[test]
fn a_limit_is_found_by_halving() {
    let rest = |find: serde_json::Value, says: &[[&str; 2]]| {
        let text: Vec<&str> = says.iter().map(|s| s[0]).collect();
        let lab = json!({"xml": crate::support::model_text("ball_drop"), "note": text.join("; "),
            "controls": [{"label": "timestep h", "set": "model.opt.timestep", "min": 0.001, "max": 0.02, "step": 0.001, "value": 0.002, "reset": true}],
            "verify": {"runs": {"r": {"until": 4}}, "measure": {"z": "final(data.qpos[2])"}, "says": says, "find": {"limit": find}}});
        let checked = check_text("lab.json", &lab.to_string());
        let quotes = checked.claims.iter().flat_map(|c| &c.judgement.quotes);
        (quotes.map(|q| q.verdict()).collect::<Vec<_>>(), checked.findings.clone())
    };
    let search = |what: &str, holds: &str| json!({"largest": what, "from": 0.001, "to": 0.04, "while": holds, "tol": 1e-7});
    for (what, holds) in [
        ("timestep", "final(data.qpos[2]) > 0.049"),
        ("option timestep", "z > 0.049"),
        ("timestep h", "z > 0.049"),
    ] {
        let (verdicts, found) =
            rest(search(what, holds), &[["0.022576 s", "limit"], ["0.0226", "limit + 0 * r.z"]]);
        assert_eq!(verdicts, ["verified"; 2], "{what}: {found:#?}");
        assert_eq!(rest(search(what, holds), &[["0.022676 s", "limit"]]).0, ["refuted"]);
    }
    let with = |key: &str, value: serde_json::Value| {
        let mut find = search("timestep", "z > 0.049");
        find[key] = value;
        find
    };
    for (find, words) in [
        (with("to", json!(0.02)), "at both ends of the range from 0.001 to 0.02"),
        (with("from", json!(0.03)), "at neither end of the range"),
        (with("while", json!("z < 0.049")), "there is a smallest value, but no largest one"),
        (with("while", json!("Math.sin(700 * initial(model.opt.timestep)) > 0.5")), "more than once"),
        (with("largest", json!("timestp h")), "did you mean `timestep h`?"),
        (with("largest", json!("option timestp")), "did you mean `timestep`?"),
        (with("run", json!("s")), "name the run"),
        (with("smallest", json!("timestep")), "either `largest` or `smallest`"),
        (with("from", json!(0.05)), "must be below its `to`"),
        (with("while", json!("zz > 1")), "zz"),
    ] {
        let (verdicts, found) = rest(find.clone(), &[["0.0226 s", "limit"]]);
        assert!(!verdicts.contains(&"verified"), "{find}");
        assert!(says(&found, words), "{find}: {found:#?}");
    }
    let find = json!({"smallest": "timestep", "from": 0.001, "to": 0.04, "while": "z < 0.049", "tol": 1e-7});
    assert_eq!(rest(find, &[["0.022576 s", "limit"]]).0, ["verified"]);
}

/// A column of a table is compared with a sweep, cell by cell, and a single cell with one number; a wrong cell is
/// reported at its location.
#[test]
fn tables_are_compared_with_sweeps() {
    let lesson = |cell: &str, table: serde_json::Value| {
        let verify = json!({
            "runs": {"fall": {"sweep": {"height (m)": [0.5, 1, 1.5]}, "until": 1, "stop": "contact('ball', 'floor')"},
                "slow": {"model": {"option gravity": [0, 0, -1]}, "until": 2, "stop": "contact('ball', 'floor')"}},
            "measure": {"touch": "first(contact('ball', 'floor'))"}, "table": table});
        let lab = json!({
            "xml": "<mujoco><worldbody><geom name='floor' type='plane' size='1 1 1'/><body name='ball' pos='0 0 1'><freejoint/>\
                <geom name='ball' type='sphere' size='0.05' mass='1'/></body></worldbody></mujoco>",
            "controls": [{"label": "height (m)", "apply": "data.qpos[2] = value", "min": 0.5, "max": 2, "step": 0.05, "value": 1, "init": true}],
            "verify": verify});
        let text = format!(
            "| height (m) | **touchdown** (s) | remark |\n|---|---:|---|\n| 0.5 | 0.304 | |\n| 1.00 | {cell} | \\| |\n| 1.5 | 0.546 | |\n\n\
             | gravity | time |\n|:--|:--|\n| Earth | 0.44 s |\n| slow | 1.38 s |\n\n```lab simlab\n{lab}\n```\n"
        );
        let checked = check_text("table.md", &text);
        let verdicts: Vec<_> = checked.claims[0].judgement.quotes.iter().map(|q| q.verdict()).collect();
        let places: Vec<String> = checked
            .findings
            .iter()
            .filter(|f| f.code.starts_with("quote"))
            .map(|f| text[f.span.clone()].to_string())
            .collect();
        (verdicts, places, checked.findings)
    };
    let column =
        |list: &str| json!([{"column": "touchdown (s)", "by": ["height (m)", "fall.value"], "is": list}]);
    let (verdicts, _, found) = lesson("0.442", column("fall.touch"));
    assert_eq!(verdicts, ["verified"; 3], "{found:#?}");
    let (verdicts, places, _) = lesson("0.449", column("fall.touch"));
    assert_eq!(verdicts, ["verified", "refuted", "verified"]);
    assert!(places.contains(&"0.449".to_string()), "{places:?}");
    let cell = json!([{"column": "time", "row": "slow", "is": "slow.touch"}]);
    assert_eq!(lesson("0.442", cell).0, ["verified"]);
    let cell = json!([{"column": "time", "row": "Earth", "is": "slow.touch"}]);
    let (verdicts, places, _) = lesson("0.442", cell);
    assert_eq!((verdicts, places), (vec!["refuted"], vec!["0.44 s".to_string()]));
    for (table, words) in [
        (
            json!([{"column": "tuchdown (s)", "by": ["height (m)", "fall.value"], "is": "fall.touch"}]),
            "did you mean \"touchdown (s)\"?",
        ),
        (
            json!([{"column": "time", "row": "Mars", "is": "slow.touch"}]),
            "no row of this table begins with \"Mars\"",
        ),
        (
            json!([{"column": "touchdown (s)", "by": ["height (m)", "fall.value.map(x => x + 0.1)"], "is": "fall.touch"}]),
            "no run of the sweep matches the row \"0.5\"",
        ),
        (json!([{"column": "time", "is": "slow.touch"}]), "a column needs `by`"),
        (column("slow.touch"), "slow.touch"),
    ] {
        let (verdicts, _, found) = lesson("0.442", table.clone());
        assert!(verdicts.iter().all(|v| *v == "failed" || *v == "verified"), "{table} {verdicts:?}");
        assert!(says(&found, words), "{table}: {found:#?}");
    }
}
