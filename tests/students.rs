//! `labspec stability`: what a student can do to a lab, and the faults that result. Small labs that fail in one way each,
//! and labs that do not fail.

#![allow(clippy::unwrap_used, clippy::panic)]

use crate::program::{run_in, snapshot};
use serde_json::{Value, json};

/// A lab of one second around a model.
pub(crate) fn lab(option: &str, world: &str, more: Value) -> Value {
    let xml = format!("<mujoco><option {option}/><worldbody>{world}</worldbody>ACTUATORS</mujoco>");
    let mut lab = json!({"xml": xml, "stopAt": 1});
    let actuators = more["actuators"].as_str().unwrap_or_default();
    lab["xml"] = json!(xml.replace("ACTUATORS", &format!("<actuator>{actuators}</actuator>")));
    for (key, value) in more.as_object().unwrap().iter().filter(|(key, _)| *key != "actuators") {
        lab[key] = value.clone();
    }
    lab
}

/// The report of a lab, with its exit code.
pub(crate) fn report(lab: &Value, more: &[&str]) -> (i32, Value) {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("lab.json"), lab.to_string()).unwrap();
    let done = run_in(folder.path(), &[&["stability", "lab.json", "--format", "json"], more].concat());
    let report = serde_json::from_str(&done.stdout).unwrap_or_else(|_| panic!("{}", done.stderr));
    (done.code, report)
}

/// The kinds of the findings, with the object concerned.
fn kinds(report: &Value) -> Vec<(String, String)> {
    let text = |f: &Value, key: &str| f[key].as_str().unwrap().to_string();
    report["findings"].as_array().unwrap().iter().map(|f| (text(f, "kind"), text(f, "subject"))).collect()
}

fn evidence(finding: &Value, name: &str) -> f64 {
    let list = finding["evidence"].as_array().unwrap();
    list.iter().find(|e| e["name"] == name).unwrap()["value"].as_f64().unwrap()
}

/// A cart of 1 kg on a rail with a servo whose gain a slider sets.
fn servo(most: f64) -> Value {
    let cart = r#"<body name="cart"><joint name="rail" type="slide"/><geom size=".1" mass="1"/></body>"#;
    let gain = "model.actuator_gainprm[0] = value; model.actuator_biasprm[1] = -value";
    let more = json!({
        "actuators": r#"<position name="servo" joint="rail" kp="100" kv="1"/>"#,
        "controls": [
            {"label": "kp", "apply": gain, "min": 100, "max": most, "value": 100},
            {"label": "target", "set": "data.ctrl[0]", "init": true, "min": 0, "max": 1, "value": 0.1},
        ],
    });
    lab(r#"integrator="implicitfast" gravity="0 0 0""#, cart, more)
}

#[test]
fn a_gain_that_is_too_high_is_found_at_the_end_of_its_slider() {
    // 2/ω is 0.002 s at kp = 1e6 N/m.
    let (code, report) = report(&servo(3e6), &[]);
    assert_eq!((code, &report["fine"]), (1, &json!(false)));
    let first = &report["findings"][0];
    assert_eq!(first["setting"], json!([{"control": "kp", "time": 0.0, "value": 3e6}]));
    assert_eq!(first["subject"], "joint \"rail\"");
    assert!(matches!(first["kind"].as_str().unwrap(), "diverges" | "energyGrows"), "{first}");
    let cause = first["cause"].as_str().unwrap();
    assert!(cause.contains("servo \"servo\"") && cause.contains("0.0012 s"), "{cause}");
    assert!(first["time"].as_f64().unwrap() < 0.1);

    let (code, report) = self::report(&servo(8e5), &[]);
    assert_eq!((code, kinds(&report)), (0, Vec::new()));
    // 1 unchanged, 1 perturbed, 3 at the other ends, 4 corners, 1 with all in turn; each ten times as long as the lab.
    let made: Vec<&Value> = report["tried"].as_array().unwrap().iter().map(|t| &t["made"]).collect();
    assert_eq!(
        (made, &report["length"]),
        (vec![&json!(1), &json!(1), &json!(3), &json!(4), &json!(1)], &json!(10.0))
    );
}

#[test]
fn bodies_in_exact_balance_are_pushed() {
    let mut still = servo(8e5);
    let xml = still["xml"].as_str().unwrap().replace("kp=\"100\"", "kp=\"3e6\"");
    still = json!({"xml": xml, "stopAt": 1});
    let (code, report) = report(&still, &[]);
    let first = &report["findings"][0];
    assert_eq!((code, &first["touched"], &first["setting"]), (1, &json!(true), &json!([])), "{first}");
    assert_eq!(first["subject"], "joint \"rail\"");
}

/// A plate of 1 cm, and a ball of 2 cm that buttons throw at it.
fn thrown(fast: f64, step: f64) -> Value {
    let world = r#"<geom name="plate" type="box" size=".005 1 1" pos="1 0 0"/>
        <body name="ball"><freejoint/><geom name="ball" size=".01"/></body>"#;
    let button = |label: &str, speed: f64| json!({"type": "button", "label": label, "run": format!("data.qvel[0] = {speed}")});
    lab(
        &format!(r#"gravity="0 0 0" timestep="{step}""#),
        world,
        json!({"controls": [button("Roll", 0.5), button("Fire", fast)]}),
    )
}

#[test]
fn a_ball_that_no_step_sees_touch_a_plate_is_found_behind_it() {
    let (code, report) = report(&thrown(300.0, 0.002), &[]);
    assert_eq!((code, kinds(&report)), (1, vec![("tunnelling".into(), "\"ball\" through \"plate\"".into())]));
    let first = &report["findings"][0];
    assert_eq!(first["setting"], json!([{"control": "Fire", "time": 0.1, "value": null}]));
    assert!((evidence(first, "distance in one step") - 0.6).abs() < 1e-9);
    // In the middle of its second step, it is at 0.9 m, and at the end of the step at 1.5 m.
    assert!((first["time"].as_f64().unwrap() - 0.102).abs() < 0.0021, "{}", first["time"]);
    // A slow ball bounces back.
    assert_eq!(kinds(&self::report(&thrown(0.8, 0.002), &[]).1), []);
}

#[test]
fn a_ball_pressed_through_a_soft_plate_is_reported_below_it() {
    let soft = |time: f64| {
        let world = format!(
            r#"<geom name="plate" type="box" size="1 1 .01" pos="0 0 .5" solref="{time} 1"/>
            <body name="ball" pos="0 0 .6"><freejoint/><geom name="ball" size=".05" solref="{time} 1"/></body>"#
        );
        kinds(&report(&lab("", &world, json!({})), &[]).1)
    };
    assert_eq!(soft(0.2), [("tunnelling".into(), "\"ball\" through \"plate\"".into())]);
    assert_eq!(soft(0.02), []);
}

/// A ball on a floor.
fn ball(solref: &str, controls: Value) -> Value {
    let world = format!(
        r#"<geom name="floor" type="plane" size="1 1 1" solref="{solref}"/><body name="ball" pos="0 0 .1"><freejoint/>
        <geom name="ball" size=".1" solref="{solref}"/></body>"#
    );
    lab("", &world, json!({"controls": controls}))
}

#[test]
fn a_ball_that_sinks_into_a_soft_floor_is_found() {
    let set = "for (let g = 0; g < model.ngeom; g++) model.geom_solref[2 * g] = value";
    let slider =
        json!([{"label": "softness", "apply": set, "min": 0.02, "max": 0.5, "value": 0.02, "reset": true}]);
    let (_, report) = report(&ball("0.02 1", slider), &[]);
    assert_eq!(kinds(&report), [("sinksIn".into(), "\"floor\" and \"ball\"".into())]);
    let first = &report["findings"][0];
    assert_eq!(first["setting"], json!([{"control": "softness", "time": 0.0, "value": 0.5}]));
    assert!(evidence(first, "depth") > 0.1 && evidence(first, "force") > 5.0, "{first}");
    assert_eq!(evidence(first, "thickness of the thinner one"), 0.2);
}

#[test]
fn a_contact_that_switches_at_rest_is_reported() {
    let (_, hard) = report(&ball("-4e5 -100", json!([])), &[]);
    assert_eq!(kinds(&hard), [("chatter".into(), "\"floor\" on \"ball\"".into())]);
    assert!(evidence(&hard["findings"][0], "switches in 100 steps") >= 45.0);
    assert_eq!(kinds(&report(&ball("-1e5 -100", json!([])), &[]).1), []);
}

/// A block on a slope of 15°, and other slow motions.
#[test]
fn a_block_that_friction_holds_and_that_creeps_is_found() {
    let block = |option: &str| {
        let world = r#"<body name="ramp" euler="0 15 0"><geom type="box" size="2 1 .1"/></body>
            <body name="block" pos=".0362 0 .135" euler="0 15 0"><freejoint/><geom type="box" size=".05 .05 .04" mass="1"/></body>"#;
        report(&lab(option, world, json!({})), &[]).1
    };
    let creeps = block("");
    assert_eq!(kinds(&creeps), [("drift".into(), "\"block\"".into())]);
    assert!(evidence(&creeps["findings"][0], "speed") > 1e-4);
    // Stiff friction, and a slope on which the block slides.
    assert_eq!(kinds(&block(r#"cone="elliptic" impratio="1000""#)), []);
    // A body that a motor pushes does not creep.
    let pushed = r#"<geom type="plane" size="5 5 1"/><body name="sledge" pos="0 0 .099"><joint type="slide" damping="200"/><joint type="slide" axis="0 0 1"/>
        <geom type="box" size=".1 .1 .1" mass="1"/></body>"#;
    let motor = json!({"actuators": r#"<motor joint="x"/>"#, "setup": "data.ctrl[0] = 11"});
    let pushed = pushed.replacen("<joint type", "<joint name=\"x\" axis=\"1 0 0\" type", 1);
    assert_eq!(kinds(&report(&lab("", &pushed, motor), &[]).1), []);
}

#[test]
fn silent_exponential_growth_is_reported() {
    let cart = r#"<body name="cart"><joint name="rail" type="slide"/><geom size=".1" mass="1"/></body>"#;
    let more = |most: f64| {
        json!({
            "actuators": r#"<motor joint="rail"/>"#,
            "setup": "data.qvel[0] = 0.1",
            "controller": "data.ctrl[0] = ctx.gain * Math.max(-1e4, Math.min(1e4, data.qvel[0]))",
            "controls": [{"label": "gain", "param": "gain", "min": -5, "max": most, "value": 0}],
        })
    };
    let run = |most: f64| kinds(&report(&lab(r#"gravity="0 0 0""#, cart, more(most)), &[]).1);
    assert_eq!(run(60.0), [("silentDivergence".into(), "joint \"rail\"".into())]);
    assert_eq!(run(0.3), []);
    // A body that falls for a long time, or that a constant force drives, is fast without a fault.
    let falls = r#"<body name="stone"><freejoint/><geom size=".01"/></body>"#;
    assert_eq!(kinds(&report(&lab("", falls, json!({"stopAt": 30})), &[]).1), []);
    let driven = json!({"actuators": r#"<motor joint="rail"/>"#, "setup": "data.ctrl[0] = 1000"});
    assert_eq!(kinds(&report(&lab(r#"gravity="0 0 0""#, cart, driven), &[]).1), []);
}

/// The largest value of a margin, and its theoretical bound.
fn margin(report: &Value, parameter: &str, subject: &str) -> (f64, Option<f64>) {
    let all = report["margins"].as_array().unwrap();
    let found =
        all.iter().find(|m| m["parameter"] == parameter && m["subject"].as_str().unwrap().contains(subject));
    let found = found.unwrap_or_else(|| panic!("{all:#?}"));
    (found["largest"].as_f64().unwrap(), found["bound"].as_f64())
}

fn near(a: f64, b: f64, part: f64) {
    assert!((a - b).abs() <= part * b.abs(), "{a} is not {b}");
}

#[test]
fn margins_meet_the_bounds_of_one_degree_of_freedom() {
    let mut still = servo(8e5);
    still["xml"] = json!(
        still["xml"]
            .as_str()
            .unwrap()
            .replace(" kv=\"1\"", "")
            .replace("slide\"", "slide\" stiffness=\"50\"")
    );
    still["stopAt"] = json!(20);
    let (code, report) = report(&still, &["--margins", "--until", "20"]);
    assert_eq!(code, 0);
    // 1 kg on 150 N/m: 2/ω. Then, at 2 ms, 4/h² for all springs together.
    for (parameter, subject, bound) in [
        ("timestep", "lab", 2.0 / 150f64.sqrt()),
        ("gain", "servo", 1e6 - 50.0),
        ("stiffness", "rail", 1e6 - 100.0),
    ] {
        let (largest, theory) = margin(&report, parameter, subject);
        near(largest, bound, 0.02);
        if let Some(theory) = theory {
            near(theory, bound, 0.02);
        }
    }
    assert!(margin(&report, "timestep", "lab").1.is_some());
}

#[test]
fn a_heavy_block_on_a_light_one_has_a_largest_ratio() {
    let block = |name: &str, z: f64| {
        format!(
            r#"<body name="{name}" pos="0 0 {z}"><joint type="slide" axis="0 0 1"/><geom type="box" size=".1 .1 .1" mass="1"/></body>"#
        )
    };
    let world = format!(r#"<geom type="plane" size="1 1 1"/>{}{}"#, block("low", 0.1), block("high", 0.3));
    let (_, report) = report(&lab("", &world, json!({})), &["--margins"]);
    let (heavy_above, _) = margin(&report, "massRatio", "\"high\" to \"low\"");
    let (heavy_below, _) = margin(&report, "massRatio", "\"low\" to \"high\"");
    assert!(heavy_above > 10.0 && heavy_above < 1e4, "{heavy_above}");
    assert!(heavy_below > 10.0 * heavy_above, "{heavy_below}");
}

#[test]
fn suggested_remedies_work() {
    let (_, broken) = report(&servo(3e6), &[]);
    let helps: Vec<&str> = broken["findings"][0]["remedies"]
        .as_array()
        .unwrap()
        .iter()
        .map(|r| r["change"].as_str().unwrap())
        .collect();
    // 2/ω at 3e6 N/m is 1.15 ms: timesteps of 1 ms and a smaller gain are stable, but do not resolve the
    // motion, and neither does `RK4`.
    assert_eq!(helps, ["`integrator=\"discrete\"`"]);
    let mended = |from: &str, to: &str| {
        let mut lab = servo(3e6);
        lab["xml"] = json!(lab["xml"].as_str().unwrap().replace(from, to));
        report(&lab, &[]).0
    };
    assert_eq!(mended("implicitfast", "discrete"), 0);
    assert_eq!(mended("implicitfast", "implicit"), 1);
}

/// A cart of 1 kg that a program pushes with a force.
fn pushed(force: &str) -> Value {
    let cart = r#"<body name="cart"><joint name="rail" type="slide"/><geom size=".1" mass="1"/></body>"#;
    let more = json!({
        "actuators": r#"<motor joint="rail"/>"#, "stopAt": 10, "controller": format!("data.ctrl[0] = {force}"),
        "readouts": [{"label": "x", "expr": "data.qpos[0]", "digits": 3}, {"label": "coarse", "expr": "data.qpos[0]", "digits": 0}],
    });
    lab(r#"gravity="0 0 0""#, cart, more)
}

#[test]
fn the_exponent_and_the_horizon_are_those_of_a_linear_equation() {
    // x¨ = 4 x has the solutions exp(± 2 t).
    let (_, report) = report(&pushed("4 * data.qpos[0]"), &["--until", "10"]);
    let exponent = &report["sensitivity"]["exponent"];
    for key in ["mean", "low", "high"] {
        near(exponent[key].as_f64().unwrap(), 2.0, 0.1);
    }
    // A perturbation of 1e-9 becomes half of that times exp(2 t), which reaches half a unit of the third digit.
    let horizons = &report["sensitivity"]["horizons"];
    near(horizons[0]["until"].as_f64().unwrap(), 1e6f64.ln() / 2.0, 0.01);
    assert_eq!(horizons[1], json!({"label": "coarse", "until": null}));
    // For x¨ = -0.75 x - 2 x˙, exp(-t / 2) decays slowest.
    let (_, damped) = self::report(&pushed("-0.75 * data.qpos[0] - 2 * data.qvel[0]"), &["--until", "10"]);
    assert_eq!(damped["sensitivity"]["exponent"], Value::Null);
    assert!(damped["sensitivity"]["divergence"]["high"].as_f64().unwrap() < 0.1);
    assert_eq!(damped["sensitivity"]["horizons"][0]["until"], Value::Null);
}

#[test]
fn a_map_marks_the_stable_settings_of_a_lab() {
    let mut both = servo(2e6);
    let step = json!({"label": "h, in s", "set": "model.opt.timestep", "min": 0.001, "max": 0.003, "step": 0.0005, "value": 0.002});
    both["controls"].as_array_mut().unwrap().push(step);
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("lab.json"), both.to_string()).unwrap();
    let arguments = ["stability", "lab.json", "--map", "kp,h, in s", "--svg", "map.svg", "--format", "json"];
    let done = run_in(folder.path(), &arguments);
    let report: Value = serde_json::from_str(&done.stdout).unwrap_or_else(|_| panic!("{}", done.stderr));
    let map = &report["map"];
    let (across, up) = (map["values"][0].as_array().unwrap(), map["values"][1].as_array().unwrap());
    assert_eq!((across.len(), up.len()), (21, 5));
    for (row, h) in map["cells"].as_array().unwrap().iter().zip(up) {
        for (cell, kp) in row.as_array().unwrap().iter().zip(across) {
            let [h, kp] = [h, kp].map(|x| x.as_f64().unwrap());
            let stable = h * kp.sqrt() / 2.0;
            if (stable - 1.0).abs() > 0.02 {
                assert_eq!(*cell == "fine", stable < 1.0, "{h} {kp} {cell}");
            }
        }
    }
    assert!(std::fs::read_to_string(folder.path().join("map.svg")).unwrap().starts_with("<svg"));
    for (wrong, says) in [("kp,q", "the lab has no control"), ("kp", "write CONTROL1,CONTROL2")] {
        let done = run_in(folder.path(), &["stability", "lab.json", "--map", wrong]);
        assert!(done.code == 2 && done.stderr.contains(says), "{}", done.stderr);
    }
}

#[test]
fn untestable_settings_are_counted() {
    let many: Vec<Value> = (0..70)
        .map(|k| json!({"label": format!("s{k}"), "param": format!("s{k}"), "min": 0, "max": 1, "value": 0}))
        .collect();
    let (code, report) = report(&ball("0.02 1", json!(many)), &["--until", "0.01"]);
    assert_eq!((code, kinds(&report), &report["fine"]), (1, Vec::new(), &json!(false)));
    // 60 of 70 sliders are combined: 70 · 69 / 2 pairs of sliders minus 60 · 59 / 2, with four settings each.
    assert_eq!(report["pairsLeftOut"], json!(4 * (70 * 69 - 60 * 59) / 2));
}

#[test]
fn a_declared_break_is_accepted() {
    let mut breaks = servo(3e6);
    breaks["expect"] = json!("breaks");
    let (code, report) = report(&breaks, &[]);
    assert_eq!((code, &report["findings"][0]["expected"]), (0, &json!(true)));
}

/// A report without measured times.
fn untimed(text: &str) -> String {
    let parts: Vec<&str> = text.split(" times the time").collect();
    let (last, measured) = parts.split_last().unwrap();
    let before = measured.iter().map(|p| format!("{}N times the time", p.trim_end_matches(|c| c != ' ')));
    before.collect::<String>() + last
}

#[test]
fn findings_for_people() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("servo.json"), servo(3e6).to_string()).unwrap();
    std::fs::write(folder.path().join("thrown.json"), thrown(300.0, 0.002).to_string()).unwrap();
    let report_of = |name: &str| {
        let done = run_in(folder.path(), &["stability", name]);
        format!("exit {}\n{}{}", done.code, untimed(&done.stdout), done.stderr)
    };
    snapshot("stability", ["servo.json", "thrown.json"].map(report_of).join("\n"));
    let done = run_in(folder.path(), &["stability", "servo.json", "--margins", "--map", "kp,target"]);
    snapshot("stability-margins", untimed(&done.stdout));
}

#[test]
fn a_base_is_where_everything_begins() {
    // 2/ω is 0.002 s at kp = 1e6 N/m.
    let (_, report) = report(&servo(2e6), &["--set", "kp=880056", "--margins"]);
    assert_eq!(report["runs"][0]["setting"], json!([{"control": "kp", "time": 0.0, "value": 880056.0}]));
    near(margin(&report, "timestep", "lab").0, 2.0 / 880056f64.sqrt(), 0.02);
    assert_eq!(report["margins"][1]["now"], json!(880056.0));
    let (code, broken) = self::report(&servo(3e6), &["--set", "kp=3000000"]);
    let first = &broken["findings"][0];
    assert_eq!((code, &first["setting"]), (1, &broken["runs"][0]["setting"]), "as it stands now");
    // Every run has the press.
    let (_, thrown) = self::report(&thrown(300.0, 0.002), &["--press", "Fire@0.2"]);
    let presses = |run: &Value| {
        run["setting"].as_array().unwrap().iter().any(|a| a["control"] == "Fire" && a["time"] == 0.2)
    };
    assert!(thrown["runs"].as_array().unwrap().iter().all(presses), "{}", thrown["runs"]);
    for (more, says) in [
        (["--set", "kp=9"], "cannot be chosen"),
        (["--set", "Kp=100"], "the lab has no control"),
        (["--press", "kp@0.1"], "is not a button"),
    ] {
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join("lab.json"), servo(2e6).to_string()).unwrap();
        let done = run_in(folder.path(), &["stability", "lab.json", more[0], more[1]]);
        assert!(done.code == 2 && done.stderr.contains(says), "{}", done.stderr);
    }
}

#[test]
fn a_remedy_states_its_cost() {
    // A cart of 1 kg on a spring of 2e6 N/m, with Euler's method at 2 ms.
    let cart = r#"<body name="cart"><joint name="rail" type="slide" stiffness="100" damping="1"/><geom size=".1" mass="1"/></body>"#;
    let more = json!({
        "setup": "data.qpos[0] = 0.1", "readouts": [{"label": "x (m)", "expr": "data.qpos[0]"}], "stopAt": 0.02,
        "controls": [{"label": "k", "set": "model.jnt_stiffness[0]", "min": 100, "max": 1.1e6, "value": 100}],
    });
    let (_, report) = report(&lab(r#"gravity="0 0 0""#, cart, more), &["--until", "2"]);
    let list = report["findings"][0]["remedies"].as_array().unwrap();
    let of = |words: &str| list.iter().find(|r| r["change"].as_str().unwrap().contains(words)).unwrap();
    // Two radians per step of 1 ms: neither this nor RK4 at 2 ms resolves the phase, and neither is recommended.
    assert!(
        list.iter().all(|r| r["change"] != "a timestep of 0.001 s" && r["change"] != "`integrator=\"RK4\"`")
    );
    let error = |r: &Value| r["error"].as_f64().unwrap();
    for remedy in list {
        assert!(remedy["timeRatio"].as_f64().unwrap() > 0.1, "{remedy}");
        assert!(error(remedy) < 0.5, "{remedy}");
    }
    near(of("timestep of 0.0005 s")["work"].as_f64().unwrap(), 4.0, 0.2);
}

#[test]
fn a_ball_that_falls_through_a_height_field_is_found_below_it() {
    let falls = |height: f64, speed: f64| {
        let world = format!(
            r#"<geom name="hills" type="hfield" hfield="h"/><body name="ball" pos=".1 .1 {height}"><freejoint/><geom name="ball" size=".02"/></body>"#
        );
        let mut lab = lab("", &world, json!({"setup": format!("data.qvel[2] = -{speed}")}));
        let field = r#"<asset><hfield name="h" nrow="3" ncol="3" size="1 1 .1 .01" elevation="1 1 1 1 1 1 1 1 1"/></asset><worldbody>"#;
        lab["xml"] = json!(lab["xml"].as_str().unwrap().replace("<worldbody>", field));
        kinds(&report(&lab, &["--until", "0.5"]).1)
    };
    assert_eq!(falls(0.5, 200.0), [("tunnelling".into(), "\"ball\" through \"hills\"".into())]);
    assert_eq!(falls(0.121, 0.1), []);
}
