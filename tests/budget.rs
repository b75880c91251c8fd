//! Every run terminates: the cost of a lab is counted in work, for a run and for a file, and a check states what it
//! covered. These tests also cover the observation of these runs: all displayed values, over the whole time for
//! which they are displayed.

#![allow(clippy::unwrap_used)]

use crate::support::{check_text, codes, compile, thread_time, workspace};
use labspec::bind::scene::Models;
use labspec::check::{self, CheckLevel, Checked, Coverage};
use labspec::lint::ModelFolder;
use labspec::lint::load_lesson;
use labspec::source::SourceFile;
use labspec_core::{self as core, Data};
use serde_json::{Value, json};
use std::fmt::Write;
use std::time::Duration;

/// The processor time of a check in these tests, with few compiler optimizations.
const LONGEST: Duration = Duration::from_secs(60);

/// A pendulum, 1000 steps in 10 s.
const PENDULUM: &str = "<mujoco><option timestep='.01'/><worldbody><body><joint name='swing' type='hinge' axis='0 1 0'/><geom size='.1' pos='.5 0 0' mass='1'/></body></worldbody></mujoco>";

/// There is no contact, so this call fails.
const THROWS: &str = "mj.mj_contactForce(model, data, 0, [0, 0, 0, 0, 0, 0])";

/// The check of a lab over a scene with further keys.
fn check_lab(xml: &str, more: Value) -> Checked {
    let mut lab = json!({"xml": xml});
    for (key, value) in more.as_object().unwrap() {
        lab[key] = value.clone();
    }
    let before = thread_time();
    let checked = check_text("lab.md", &format!("```lab simlab\n{lab}\n```\n"));
    if let (Some(before), Some(after)) = (before, thread_time()) {
        println!("{:?}", after - before);
        assert!(after - before < LONGEST, "{:?}", after - before);
    }
    checked
}

fn coverage(checked: &Checked) -> Coverage {
    checked.labs[0].tried.clone().unwrap()
}

fn messages(checked: &Checked) -> Vec<(&'static str, String)> {
    checked.findings.iter().map(|f| (f.code, f.message.clone())).collect()
}

fn count(checked: &Checked, code: &str) -> usize {
    codes(checked).iter().filter(|c| **c == code).count()
}

#[test]
fn the_first_throw_of_a_controller_ends_the_run() {
    for controller in ["for (;;) {}", "let n = 1; while (n > 0) n++", THROWS] {
        let checked = check_lab(
            PENDULUM,
            json!({"controller": controller, "controls": [{"label": "g", "set": "model.opt.gravity[2]", "min": -10, "max": -1, "value": -9}]}),
        );
        let t = coverage(&checked);
        assert_eq!((t.runs, t.skipped, t.covered, t.broke), (1, 2, 0.0, true), "{controller}: {t:?}");
        assert_eq!(t.ended.as_deref(), Some("frozen after 0 of 10 s"));
        assert_eq!(codes(&checked).len(), 1, "{:?}", messages(&checked));
    }
    // Errors that occur later are reported as well, with the time that was covered.
    let checked =
        check_lab(PENDULUM, json!({"controller": format!("if (data.time > 3.995) {{ {THROWS} }}")}));
    assert_eq!(coverage(&checked).ended.as_deref(), Some("frozen after 4 of 10 s"));
}

#[test]
fn a_setup_that_does_not_end() {
    let checked = check_lab(
        PENDULUM,
        json!({"setup": "let n = 1; while (n > 0) n++", "readouts": [{"label": "t", "expr": "data.time"}]}),
    );
    assert_eq!(coverage(&checked).covered, 0.0);
    assert_eq!(codes(&checked), ["too-many-steps"], "{:?}", messages(&checked));
}

#[test]
fn steps_in_programs_have_the_cost_of_steps() {
    let steps = "for (let i = 0; i < 1e6; i++) mj.mj_step(model, data)";
    let checked = check_lab(PENDULUM, json!({"controller": steps}));
    assert_eq!(codes(&checked), ["too-many-steps"], "{:?}", messages(&checked));
    let checked = check_lab(PENDULUM, json!({"controls": [{"type": "button", "label": "On", "run": steps}]}));
    assert_eq!(count(&checked, "too-many-steps"), 1, "{:?}", messages(&checked));
    // Unchanged, with the button, with a perturbation, and for a long time.
    assert_eq!((coverage(&checked).runs, coverage(&checked).covered), (4, 10.0));
    let readout = format!("(() => {{ {steps}; return data.time }})()");
    let checked = check_lab(PENDULUM, json!({"readouts": [{"label": "t", "expr": readout}]}));
    assert_eq!(count(&checked, "too-many-steps"), 1, "{:?}", messages(&checked));
    // The readout is not evaluated again, so the run continues.
    assert_eq!(coverage(&checked).covered, 10.0);
}

#[test]
fn ten_traces_that_do_not_end() {
    let readouts: Vec<Value> = (0..10)
        .map(|i| json!({"label": i.to_string(), "expr": format!("(() => {{ let n = {i}; while (n >= 0) n++; return n }})()")}))
        .collect();
    let checked = check_lab(PENDULUM, json!({"readouts": readouts}));
    assert_eq!(count(&checked, "too-many-steps"), 10, "{:?}", messages(&checked));
    assert_eq!((coverage(&checked).runs, coverage(&checked).covered), (1, 10.0));
}

#[test]
fn a_hundred_sliders_with_a_slow_loop() {
    let controls = |turns: &str| -> Value {
        (0..100)
            .map(|i| json!({"label": i.to_string(), "min": 0, "max": 1, "value": 0, "apply": format!("let s = value; for (let i = 0; i < {turns}; i++) s += value; ctx.s{i} = s")}))
            .collect()
    };
    let checked = check_lab(PENDULUM, json!({"controls": controls("2e5")}));
    let t = coverage(&checked);
    assert!(t.runs > 1 && t.runs + t.skipped == 201, "{t:?}");
    // Each of these alone exceeds the limit; the run does not reach its start.
    let checked = check_lab(PENDULUM, json!({"controls": controls("1e9")}));
    let t = coverage(&checked);
    assert_eq!((t.runs, t.skipped, t.covered), (1, 200, 0.0), "{t:?}");
}

#[test]
fn two_thousand_balls_in_one_place() {
    let mut xml = String::from("<mujoco><worldbody>");
    for i in 0..2000 {
        let _ = write!(xml, "<body pos='0 0 {}'><freejoint/><geom size='.1'/></body>", f64::from(i) * 1e-6);
    }
    xml.push_str("</worldbody></mujoco>");
    let checked = check_lab(&xml, json!({"stopAt": 20}));
    let t = coverage(&checked);
    println!("{t:?}");
    assert!(t.covered < 1.0 && t.ended.unwrap().starts_with("first "));
    assert!(!codes(&checked).contains(&"simulation-diverges"), "{:?}", messages(&checked));
}

#[test]
fn a_thousand_sensors_of_four_million_pairs() {
    let side = |name: &str, x: f64| {
        let mut body = format!("<body name='{name}' pos='{x} 0 0'>");
        for i in 0..2000 {
            let _ = write!(
                body,
                "<geom type='ellipsoid' size='.1 .2 .3' pos='0 0 {i}' contype='0' conaffinity='0'/>"
            );
        }
        body + "</body>"
    };
    let sensors = "<distance body1='a' body2='b' cutoff='1000'/>".repeat(1000);
    let xml = format!(
        "<mujoco><worldbody>{}{}</worldbody><sensor>{sensors}</sensor></mujoco>",
        side("a", 0.0),
        side("b", 5.0)
    );
    let checked = check_lab(&xml, json!({"readouts": [{"label": "d", "expr": "data.sensordata[0]"}]}));
    let t = coverage(&checked);
    // Sensors for the same pairs start with the best distance so far, so that some steps fit into the budget.
    assert!(t.covered < 0.1, "{t:?}");
    assert!(t.ended.unwrap().starts_with("first 0"));
}

/// A body over a grid of a million cells: the traversal stops when the work limit of the run is reached, within a step.
#[test]
fn a_grid_of_a_million_cells_ends() {
    let xml =
        "<mujoco><asset><hfield name='grid' nrow='1000' ncol='1000' size='500 500 1 1'/></asset><worldbody>
        <geom type='hfield' hfield='grid'/>
        <body pos='0 0 .9'><freejoint/><geom type='ellipsoid' size='600 600 1'/></body>
        </worldbody></mujoco>";
    let checked = check_lab(xml, json!({"readouts": [{"label": "z", "expr": "data.qpos[2]"}]}));
    let t = coverage(&checked);
    println!("{t:?}");
    assert!(t.covered < 0.1 && t.ended.unwrap().starts_with("first 0"));
}

#[test]
fn iterations_with_nan_end() {
    let boxes = |option: &str| {
        let mut xml = format!("<mujoco><option {option}/><worldbody><geom type='plane' size='1 1 1'/>");
        for i in 0..8 {
            let _ = write!(
                xml,
                "<body pos='.0{i} 0 {}'><freejoint/><geom type='box' size='.1 .1 .1' friction='2 .1 .1'/></body>",
                0.1 + 0.199 * f64::from(i)
            );
        }
        xml + "</worldbody></mujoco>"
    };
    for solver in ["PGS", "CG", "Newton"] {
        let many = format!(
            "solver='{solver}' tolerance='0' ls_tolerance='0' iterations='1000000000' ls_iterations='1000000000' noslip_iterations='1000000000' noslip_tolerance='0' ccd_iterations='1000000000' sdf_iterations='1000000000'"
        );
        let t = coverage(&check_lab(&boxes(&many), json!({})));
        println!("{solver} {t:?}");
        assert!(t.covered == t.requested || t.ended.unwrap().starts_with("first "), "{solver}");
    }
    let setup = "model.opt.tolerance = 0; model.opt.noslip_tolerance = 0; model.opt.noslip_iterations = 1e9; model.opt.iterations = 1e9";
    let t = coverage(&check_lab(&boxes(""), json!({"setup": setup})));
    assert!(t.covered == t.requested || t.ended.unwrap().starts_with("first "));
}

#[test]
fn a_lab_runs_for_the_time_that_a_student_watches() {
    let late = |t: f64| json!(format!("if (data.time > {t}) {{ data.qvel[0] = 1e11 }}"));
    for (more, t, found) in [
        (json!({}), 5.01, true),
        (json!({}), 9.9, true),
        (json!({"stopAt": 20}), 19.9, true),
        (json!({"stopAt": 1}), 1.1, false),
        (json!({"plots": [{"window": 30, "traces": [{"label": "q", "expr": "data.qpos[0]"}]}]}), 29.0, true),
        (json!({"plots": [{"traces": [{"label": "q", "expr": "data.qpos[0]"}]}]}), 4.9, true),
        (json!({"plots": [{"traces": [{"label": "q", "expr": "data.qpos[0]"}]}]}), 5.1, true),
        // A page that nothing stops continues, so a run ten times as long is tried.
        (json!({"plots": [{"traces": [{"label": "q", "expr": "data.qpos[0]"}]}]}), 49.9, true),
        (json!({"plots": [{"traces": [{"label": "q", "expr": "data.qpos[0]"}]}]}), 50.1, false),
    ] {
        let mut lab = more.clone();
        lab["controller"] = late(t);
        let checked = check_lab(PENDULUM, lab);
        assert_eq!(
            codes(&checked).contains(&"simulation-diverges"),
            found,
            "{more} {t}: {:?}",
            messages(&checked)
        );
        let t = coverage(&checked);
        assert_eq!((t.covered, t.ended, t.broke), (t.requested, None, found), "{more}");
    }
}

#[test]
fn every_display_is_checked() {
    let readout = |expr: &str| json!({"readouts": [{"label": "x", "expr": expr}]});
    let trace = |expr: &str| json!({"plots": [{"traces": [{"label": "x", "expr": expr}]}]});
    for (lab, expected) in [
        (readout("Math.sqrt(data.time - 5)"), vec!["shows-nan"]),
        (readout("data.time > 9.99 ? Math.sqrt(-1 - data.time) : 1"), vec!["shows-nan"]),
        (trace("1 / (data.time - data.time)"), vec!["shows-infinite"]),
        (trace("data.time.toFixed(2)"), vec!["text-in-plot"]),
        (readout("data.time.toFixed(2)"), vec![]),
        (trace("data.time > 1 ? data.time : NaN"), vec![]),
        (readout("data.time > 1 ? Math.sqrt(-data.time) : NaN"), vec![]),
        (readout("data.time > 1 ? Infinity : 0"), vec![]),
        (trace("data.time"), vec![]),
    ] {
        let checked = check_lab(PENDULUM, lab.clone());
        assert_eq!(codes(&checked), expected, "{lab}: {:?}", messages(&checked));
    }
}

#[test]
fn intended_gaps_are_not_reported() {
    let trace = json!([{"traces": [{"label": "x", "expr": "ctx.x"}]}]);
    // Until a button is pressed, or until a routine reports its end.
    let checked = check_lab(
        PENDULUM,
        json!({"plots": trace, "controls": [{"type": "button", "label": "Go", "run": "ctx.x = data.time"}]}),
    );
    assert_eq!(codes(&checked), Vec::<&str>::new(), "{:?}", messages(&checked));
    let checked = check_lab(
        PENDULUM,
        json!({"plots": trace, "setup": "ctx.x = NaN", "controller": "if (data.time > 3) { ctx.x = 1 }"}),
    );
    assert_eq!(codes(&checked), Vec::<&str>::new(), "{:?}", messages(&checked));
    // A gap that is never filled.
    let checked =
        check_lab(PENDULUM, json!({"plots": trace, "controller": "if (data.time > 300) { ctx.x = 1 }"}));
    assert_eq!(codes(&checked), ["shows-nan"], "{:?}", messages(&checked));
    // A computed value that is always NaN.
    let checked =
        check_lab(PENDULUM, json!({"plots": trace, "controller": "ctx.x = Math.sqrt(-1 - data.time)"}));
    assert_eq!(codes(&checked), ["shows-nan"], "{:?}", messages(&checked));
}

#[test]
fn with_each_setting_of_a_control() {
    let lab = json!({
        "controls": [{"label": "k", "param": "k", "min": 0, "max": 2, "step": 1, "value": 1}],
        "readouts": [{"label": "x", "expr": "1 / ctx.k"}],
    });
    let checked = check_lab(PENDULUM, lab);
    assert_eq!(codes(&checked), ["shows-infinite"]);
    assert!(checked.findings[0].message.contains("with \"k\" at 0"), "{:?}", messages(&checked));
    // Unchanged and at both ends of the slider; with a perturbation, moved during the run, and for a long time.
    assert_eq!((coverage(&checked).runs, coverage(&checked).skipped), (6, 0));
}

#[test]
fn every_warning_of_the_engine_is_a_finding() {
    let checked =
        check_lab(PENDULUM, json!({"setup": "model.body_mass[1] = -1; model.body_inertia.fill(-1)"}));
    assert!(codes(&checked).contains(&"engine-warning"), "{:?}", messages(&checked));
    assert!(coverage(&checked).broke);
}

/// No real lesson exceeds the limit, and none displays values that a student cannot read.
#[test]
fn real_labs_are_covered() {
    let shared = workspace().join("../shared");
    if !shared.exists() {
        println!("skipped: {} is not there", shared.display());
        return;
    }
    let models = Models::new(ModelFolder::open(&shared.join("corpus/models")).unwrap());
    let mut runs = 0;
    for folder in ["corpus/labs", "corpus/quizzes"] {
        for entry in std::fs::read_dir(shared.join(folder)).unwrap() {
            let path = entry.unwrap().path();
            if path.extension().is_none_or(|e| e != "json") {
                continue;
            }
            let lesson = load_lesson(SourceFile::read(&path).unwrap(), models.folder());
            let checked =
                check::check_lesson(lesson, &models, CheckLevel { claims: false, ..CheckLevel::FULL });
            for lab in &checked.labs {
                let t = lab.tried.as_ref().unwrap();
                // Two balls gain energy at the lower end of their damping ratio, in the library as well.
                let breaks = path.ends_with("physics-lab_04_simlab.json");
                assert_eq!(
                    (t.covered, t.skipped, t.broke),
                    (t.requested, 0, breaks),
                    "{}: {t:?}",
                    path.display()
                );
                runs += t.runs;
            }
            let new = ["shows-nan", "shows-infinite", "text-in-plot", "engine-warning", "stiff-for-timestep"];
            let found =
                messages(&checked).into_iter().filter(|(code, _)| new.contains(code)).collect::<Vec<_>>();
            assert_eq!(found, [], "{}", path.display());
        }
    }
    assert!(runs > 50, "{runs}");
}

#[test]
fn counting_changes_no_number() {
    let xml = "<mujoco><worldbody><geom type='plane' size='1 1 1'/><body pos='0 0 .15'><freejoint/><geom type='box' size='.1 .1 .1'/></body></worldbody></mujoco>";
    let m = compile(xml);
    let (mut free, mut limited) = (Data::new(&m), Data::new(&m));
    core::limit(&mut limited, u64::MAX);
    for _ in 0..200 {
        core::step(&m, &mut free).unwrap();
        core::step(&m, &mut limited).unwrap();
    }
    assert_eq!(free.qpos, limited.qpos);
    assert_eq!(core::cost(&free), core::cost(&limited));
    assert!(!core::exhausted(&limited) && core::cost(&free) > 200 * core::cost_of_pass(&free));
    // Beyond the limit, steps cost almost nothing.
    core::limit(&mut limited, 0);
    core::step(&m, &mut limited).unwrap();
    assert!(core::exhausted(&limited));
    let before = core::cost(&limited);
    core::step(&m, &mut limited).unwrap();
    assert!(core::cost(&limited) - before <= 2 * core::cost_of_pass(&limited));
}
