//! The commands that run one lab or model: `run`, `plan`, `precision`, `record`, `bench`. Run times are
//! removed before the comparison.

#![allow(clippy::unwrap_used)]

use crate::program::{folder, json_of, keys, run, run_in, snapshot, stdout_of};
use serde_json::{Value, json};

#[test]
fn run_for_people() {
    snapshot("run", stdout_of(&["run", "clean.md#1", "--until", "1"]));
    snapshot("run-set", stdout_of(&["run", "clean.md#1", "--set", "gravity=-1.6", "--press", "Kick@0.5"]));
    // A question's sim, and a model alone.
    snapshot("run-sim", stdout_of(&["run", "clean.md#drop.1", "--steps", "3"]));
}

#[test]
fn run_for_programs() {
    let table = json_of(&["run", "clean.md#1", "--steps", "500", "--every", "100", "--format", "json"]);
    assert_eq!(
        keys(&table),
        [
            "schemaVersion",
            "report",
            "version",
            "timestep",
            "columns",
            "types",
            "rows",
            "warnings",
            "errors",
            "breakdown",
            "breakdowns"
        ]
    );
    let columns = [
        "time",
        "plot/0/heavy",
        "plot/0/light, say",
        "plot/1/contacts",
        "readout/time (s)",
        "readout/height (m)",
    ];
    assert_eq!(table["columns"], json!(columns));
    let rows = table["rows"].as_array().unwrap();
    assert_eq!(rows.len(), 6);
    assert_eq!(rows[0], json!([0.0, 1.0, 1.0, 0.0, 0.0, 1.0]));
    assert_eq!((&rows[5][3], &table["warnings"], &table["errors"]), (&json!(2.0), &json!({}), &json!([])));

    let csv = run(&["run", "clean.md#1", "--steps", "500", "--every", "250", "--format", "csv"]);
    let lines: Vec<&str> = csv.stdout.lines().collect();
    assert_eq!(
        lines[0],
        "time,plot/0/heavy,\"plot/0/light, say\",plot/1/contacts,readout/time (s),readout/height (m)"
    );
    assert_eq!((lines.len(), lines[1]), (4, "0,1,1,0,0,1"));
    // Both outputs contain the same bits.
    let last: Vec<f64> = lines[3].split(',').map(|x| x.parse().unwrap()).collect();
    let whole = run(&["run", "clean.md#1", "--steps", "500", "--every", "500", "--format", "json"]).stdout;
    let row = format!("{last:?}").replace(' ', "");
    assert!(whole.contains(&row), "{row} is not in {whole}");
}

#[test]
fn run_writes_files() {
    let folder = folder();
    let arguments =
        ["run", "clean.md#1", "--until", "1", "--csv", "a.csv", "--json", "a.json", "--svg", "a.svg"];
    assert_eq!(run_in(folder.path(), &arguments).code, 0);
    let read = |name: &str| std::fs::read_to_string(folder.path().join(name)).unwrap();
    assert_eq!(read("a.csv").lines().count(), 502);
    assert_eq!(
        serde_json::from_str::<Value>(&read("a.json")).unwrap()["rows"].as_array().unwrap().len(),
        501
    );
    for (name, label) in [("a.svg", "heavy"), ("a-2.svg", "contacts")] {
        let svg = read(name);
        assert!(
            svg.starts_with("<svg") && svg.trim_end().ends_with("</svg>") && svg.contains(label),
            "{name}"
        );
    }
}

#[test]
fn a_run_that_breaks_is_a_finding() {
    let folder = folder();
    let lab = json!({"model": "free_fall", "setup": "data.qvel[2] = 1e11"});
    std::fs::write(folder.path().join("breaks.json"), lab.to_string()).unwrap();
    let done = run_in(folder.path(), &["run", "breaks.json", "--steps", "2"]);
    assert_eq!(done.code, 1);
    assert!(done.stdout.contains("warning: badqvel"), "{}", done.stdout);
    assert_eq!(run_in(folder.path(), &["check", "breaks.json"]).code, 1);
}

#[test]
fn plan_prints_reasons() {
    snapshot("plan", stdout_of(&["plan", "fall.json", "--no-run"]));
    let plan = json_of(&["plan", "clean.md#1", "--format", "json"]);
    assert_eq!(keys(&plan)[..5], ["schemaVersion", "report", "reads", "writes", "stages"]);
    assert_eq!(plan["reads"], json!(["time", "qpos", "ncon"]));
    assert_eq!(keys(&plan["stages"][0])[..3], ["stage", "keep", "reason"]);
}

/// The cost of each stage, and the cost of stages that do not run. The times depend on the machine; their sum and the
/// events in the steps do not.
#[test]
fn plan_measures() {
    let arguments =
        ["plan", "clean.md#1", "--read", "data.energy", "--read", "data.qacc", "--format", "json"];
    let [plan, again] = [json_of(&arguments), json_of(&arguments)];
    let number = |value: &Value| value.as_f64().unwrap();
    let (mut shares, mut work) = (number(&plan["step"]["integrator"]["share"]), 0.0);
    assert_eq!(plan["step"]["controller"], Value::Null);
    for (stage, other) in plan["stages"].as_array().unwrap().iter().zip(again["stages"].as_array().unwrap()) {
        assert_eq!((&stage["work"], &stage["reason"]), (&other["work"], &other["reason"]));
        let [share, ns, counted, forced] = ["share", "ns", "work", "forcedNs"].map(|key| stage[key].as_f64());
        if stage["keep"] == true {
            shares += share.unwrap();
            work += counted.unwrap();
            assert!(ns.unwrap() >= 0.0 && forced.is_none(), "{stage}");
        } else {
            assert!(share.is_none() && ns.is_none() && counted.is_none() && forced.is_some(), "{stage}");
        }
    }
    assert!((shares - 1.0).abs() < 1e-9, "{shares}");
    // The work of the solver is counted, and is not the total work.
    assert!(work > 0.0 && work < number(&plan["step"]["work"]), "{work} of {}", plan["step"]["work"]);
    // Two balls and a floor: 1000 steps, in which the balls fall, touch and come to rest.
    assert_eq!(plan["step"]["steps"], 1000);
    assert_eq!((&plan["pairs"]["all"], &plan["pairs"]["canTouch"]), (&json!(3), &json!(3)));
    for key in ["inReach", "contacts"] {
        assert_eq!(plan["pairs"][key], again["pairs"][key]);
        assert_eq!(plan["pairs"][key]["most"], 2.0);
    }
    assert!(
        number(&plan["pairs"]["contacts"]["mean"]) > 1.0 && number(&plan["solver"]["rows"]["most"]) == 8.0
    );
    let readers = plan["readers"].as_array().unwrap();
    assert_eq!(
        readers.iter().map(|r| r["read"].clone()).collect::<Vec<_>>(),
        ["data.energy", "data.qacc", "all of these"]
    );
    let done = run(&["plan", "fall.json", "--read", "data.nothing", "--no-run"]);
    assert_eq!(done.code, 2);
    assert!(done.stderr.contains("`data.nothing` is not a field of the data"), "{}", done.stderr);
}

/// An additional reader adds stages: those that the plan of a lab with this reader keeps.
#[test]
fn plan_prints_the_effect_of_a_reader() {
    let folder = folder();
    let plan = |arguments: &[&str]| -> Value {
        let all = [&["plan", "fall.json", "--no-run", "--format", "json"], arguments].concat();
        serde_json::from_str(&run_in(folder.path(), &all).stdout).unwrap()
    };
    let joins = |name: &str| plan(&["--read", name])["readers"][0]["joins"].clone();
    assert_eq!(joins("xquat"), json!(["kinematics", "orientations"]));
    assert_eq!(joins("data.xpos"), json!(["kinematics"]));
    assert_eq!(joins("data.xpos[5] * 2"), json!(["kinematics"]));
    assert_eq!(joins("qvel"), json!([]));
}

/// A run in which every field is computed gives the same bytes.
#[test]
fn a_full_run_is_the_same_run() {
    let folder = folder();
    for lab in ["clean.md#1", "clean.md#drop.1", "fall.json"] {
        for format in ["human", "json", "csv"] {
            let run = |more: &[&str]| {
                let all = [&["run", lab, "--until", "0.8", "--format", format], more].concat();
                run_in(folder.path(), &all).stdout
            };
            assert_eq!(run(&["--full"]), run(&[]), "{lab}");
        }
    }
}

#[test]
fn precision_against_the_closed_form() {
    let table = stdout_of(&["precision", "fall.json"]);
    // Run times, the mark that depends on them and the recommendations depend on the machine.
    let stripped: Vec<String> = table
        .lines()
        .take_while(|line| !line.starts_with("With the settings of the lab"))
        .map(|line| match line.split_once(" ms") {
            Some((setting, rest)) if line.starts_with("  ") => {
                let errors = rest.split_once('%').map_or(rest, |(_, errors)| errors);
                format!("{setting} ms {}", errors.trim_end_matches([' ', '‹']))
            }
            _ => line.to_string(),
        })
        .collect();
    snapshot("precision", stripped.join("\n"));
    let report = json_of(&["precision", "fall.json", "--format", "json", "--until", "0.2"]);
    assert_eq!(report["truth"], json!(["closedForm"]));
    // Euler's method has order one: the error is g h t / 2.
    let lab_row = report["rows"].as_array().unwrap().iter().find(|row| row["own"] == true).unwrap();
    let error = lab_row["errors"][0].as_f64().unwrap();
    assert!((error - 9.81 * 0.002 * 0.2 / 2.0).abs() < 1e-12, "{error}");

    let folder = folder();
    assert_eq!(
        run_in(folder.path(), &["precision", "fall.json", "--svg", "p.svg", "--csv", "p.csv"]).code,
        0
    );
    assert!(std::fs::read_to_string(folder.path().join("p.svg")).unwrap().starts_with("<svg"));
    let csv = std::fs::read_to_string(folder.path().join("p.csv")).unwrap();
    assert!(
        csv.lines().count() == 1 + 5 * 6 + 2 && csv.lines().all(|line| line.split(',').count() == 17),
        "{csv}"
    );
}

#[test]
fn record_repeats_the_states_of_a_recording() {
    let folder = folder();
    let state = |z: f64| {
        json!({
            "qpos": [-0.2, 0.0, z, 1.0, 0.0, 0.0, 0.0, 0.2, 0.0, 1.0, 1.0, 0.0, 0.0, 0.0], "qvel": vec![0.0; 12],
            "act": [], "ctrl": [], "mocap_pos": [], "mocap_quat": [], "ncon": 0, "contact": [], "xpos": [], "M": []
        })
    };
    let oracle = json!({
        "sizes": {"nq": 0, "nv": 0}, "model": {"body_mass": [], "no_such_field": []}, "forward": [state(1.0), state(0.04)]
    });
    std::fs::write(folder.path().join("states.json"), oracle.to_string()).unwrap();
    let arguments =
        ["record", "models/ball_drop.xml", "--states", "states.json", "--steps", "300", "--every", "50"];
    let done = run_in(folder.path(), &[&arguments[..], &["--tight", "--option", "timestep=0.001"]].concat());
    assert_eq!((done.code, done.stderr.as_str()), (0, ""));
    let record: Value = serde_json::from_str(&done.stdout).unwrap();
    assert_eq!(
        keys(&record),
        [
            "schemaVersion",
            "report",
            "version",
            "sizes",
            "names",
            "model",
            "forward",
            "trajectory",
            "warnings"
        ]
    );
    assert_eq!(record["sizes"], json!({"nq": 14, "nv": 12}));
    assert_eq!(record["model"], json!({"body_mass": [0.0, 2.0, 0.1]}));
    let counts: Vec<&Value> = record["forward"].as_array().unwrap().iter().map(|f| &f["ncon"]).collect();
    assert_eq!(counts, [&json!(0), &json!(1)]);
    let contact = &record["forward"][1]["contact"][0];
    assert_eq!(
        keys(contact),
        ["geom1", "geom2", "dist", "pos", "frame", "friction", "dim", "solref", "solimp"]
    );
    assert!((contact["dist"].as_f64().unwrap() + 0.01).abs() < 1e-15);
    let rows = record["trajectory"].as_array().unwrap();
    assert_eq!(rows.len(), 7);
    assert!((rows[6]["time"].as_f64().unwrap() - 0.3).abs() < 1e-12);
    for (option, why) in
        [("timestp=1", "no field"), ("timestep=fast", "not a number"), ("timestep", "NAME=VALUE")]
    {
        let done = run_in(folder.path(), &[&arguments[..], &["--option", option]].concat());
        assert!(done.code == 2 && done.stderr.contains(why), "{}", done.stderr);
    }
}

/// The bits of a state are preserved in JSON. A reader with an error in the last bit would suggest a
/// difference between the engines.
#[test]
fn record_keeps_every_bit() {
    let folder = folder();
    // A number that needs 17 digits, and correct rounding when it is parsed.
    let z = 0.800_837_999_999_999_9_f64;
    let mut worst = Vec::new();
    for i in 0..200 {
        let z = z + f64::from(i) * 1.234_567_890_123_4e-3;
        let state = json!({
            "qpos": [0.0, 0.0, z, 1.0, 0.0, 0.0, 0.0], "qvel": vec![0.0; 6],
            "act": [], "ctrl": [], "mocap_pos": [], "mocap_quat": [], "xpos": []
        });
        worst.push((z, state));
    }
    let states: Vec<&Value> = worst.iter().map(|(_, s)| s).collect();
    std::fs::write(folder.path().join("s.json"), json!({"forward": states}).to_string()).unwrap();
    let done =
        run_in(folder.path(), &["record", "models/free_fall.xml", "--states", "s.json", "--steps", "0"]);
    assert_eq!(done.code, 0, "{}", done.stderr);
    // Compared as text, because the JSON reader of this test could round as well.
    for (z, _) in worst {
        assert!(done.stdout.contains(&format!("\"xpos\":[0.0,0.0,0.0,0.0,0.0,{z:?}]")), "{z:?}");
    }
}

/// The numbers of a lab are parsed to the last bit as well.
#[test]
fn labs_keep_every_bit() {
    let folder = folder();
    for z in [0.900_837_999_099_995_3_f64, 0.1, 2.2250738585072014e-308, 123_456_789.123_456_79] {
        let lab = format!(
            r#"{{"model": "free_fall", "readouts": [{{"label": "p", "expr": "ctx.p"}}, {{"label": "e", "expr": "{z:?}"}}],
            "controls": [{{"label": "p", "param": "p", "min": 0, "max": 1e9, "value": {z:?}}}]}}"#
        );
        std::fs::write(folder.path().join("p.json"), lab).unwrap();
        let done = run_in(folder.path(), &["run", "p.json", "--steps", "0", "--format", "csv"]);
        let read: Vec<f64> =
            done.stdout.lines().nth(1).unwrap().split(',').map(|x| x.parse().unwrap()).collect();
        assert_eq!(read, [0.0, z, z]);
    }
}

#[test]
fn bench_prints_json() {
    for target in ["models/ball_drop.xml", "clean.md#1"] {
        let bench = json_of(&["bench", target, "--steps", "200", "--warm", "10", "--repeat", "3"]);
        assert_eq!(
            keys(&bench),
            ["schemaVersion", "report", "minNs", "medianNs", "steps", "nv", "ncon", "nefc", "time"]
        );
        assert_eq!((&bench["steps"], &bench["nv"]), (&json!(200), &json!(12)));
        assert!(bench["minNs"].as_f64().unwrap() <= bench["medianNs"].as_f64().unwrap());
    }
}
