//! All numbers that the lesson on two falling balls states are reproduced by our engine to the last printed digit.
//!
//! The numbers were found with MuJoCo 3.14.0. Most of them are written as claims of a lab here and checked like those of a
//! lesson: a note quotes them, and `verify` measures them. The models of the lesson were written anew
//! (`golden/models/free_fall.xml`, `ball_drop.xml`).

#![allow(clippy::unwrap_used)]

use crate::support::{check_text, codes, compile, model_text, numbers, workspace};
use labspec::bind::Programs;
use labspec::check::Checked;
use labspec::lint::ModelFolder;
use labspec::lint::load_lesson;
use labspec::run::{Session, Start};
use labspec::source::SourceFile;
use labspec::verify::QuoteState;
use labspec_core::{self as core, AccessSet, Data, Model, Plan};
use labspec_expr::Value;
use serde_json::{Value as Json, json};

/// Checks a lab whose note quotes numbers: pairs of a printed number and the expression that must give it.
fn check(xml: &str, controls: Json, verify: Json, says: &[(&str, &str)]) -> Checked {
    let quotes: Vec<&str> = says.iter().map(|(quote, _)| *quote).collect();
    let mut verify = verify;
    verify["says"] = json!(says);
    let lab = json!({"xml": xml, "controls": controls, "verify": verify, "note": quotes.join("; ")});
    check_text("lab.json", &serde_json::to_string_pretty(&lab).unwrap())
}

/// The same; every quote must be right.
fn verified(xml: &str, controls: Json, verify: Json, says: &[(&str, &str)]) {
    let checked = check(xml, controls, verify, says);
    // Some of these numbers depend on the timestep, which is noted; and one slider moves the balls back to their start.
    let expected = ["quote-of-timestep", "setconst-jumps"];
    let wrong: Vec<_> = codes(&checked).into_iter().filter(|c| !expected.contains(c)).collect();
    assert_eq!(wrong, [""; 0], "{:#?}", checked.findings);
    let claim = &checked.claims[0];
    let right = claim.judgement.quotes.iter().filter(|q| q.state == QuoteState::Right).count();
    assert_eq!((right, claim.judgement.quotes.len()), (says.len(), says.len()), "{claim:?}");
}

fn timestep() -> Json {
    json!({"label": "h", "set": "model.opt.timestep", "min": 0.0005, "max": 0.02, "step": 0.0005, "value": 0.002, "reset": true})
}

#[test]
fn position_error_of_a_free_fall() {
    let run = |h: f64| json!({"set": {"h": h}, "until": 0.3});
    let says = [
        ("-0.73575 mm", "half.error"),
        ("-1.47150 mm", "one.error"),
        ("-2.94300 mm", "two.error"),
        ("-7.35750 mm", "five.error"),
        ("-14.71500 mm", "ten.error"),
        ("-12.2625 mm", "quiz.error"),
        // The theoretical value: -g h t / 2.
        ("-2.94300 mm", "two.theory"),
    ];
    verified(
        &model_text("free_fall"),
        json!([timestep()]),
        json!({
            "runs": {
                "half": run(0.0005), "one": run(0.001), "two": run(0.002), "five": run(0.005), "ten": run(0.01),
                "quiz": {"set": {"h": 0.005}, "until": 0.5}
            },
            "measure": {
                "error": "final(1000 * (data.qpos[2] - (1 - 0.5 * 9.81 * data.time * data.time)))",
                "theory": "final(-1000 * 0.5 * 9.81 * model.opt.timestep * data.time)"
            }
        }),
        &says,
    );
}

#[test]
fn touchdown_and_rest() {
    verified(
        &model_text("ball_drop"),
        json!([timestep()]),
        json!({
            "runs": {"fine": {"until": 3}, "coarse": {"set": {"h": 0.02}, "until": 5}},
            "measure": {
                "seen": "first(contact('heavy_geom', 'floor'))",
                "seenLight": "first(contact('light_geom', 'floor'))",
                "touch": "before(contact('heavy_geom', 'floor'), data.time)",
                "touchLight": "before(contact('light_geom', 'floor'), data.time)",
                "speed": "before(contact('heavy_geom', 'floor'), -data.qvel[2])",
                "speedLight": "before(contact('light_geom', 'floor'), -data.qvel[8])",
                "ideal": "Math.sqrt(2 * 0.95 / 9.81)",
                "idealSpeed": "Math.sqrt(2 * 9.81 * 0.95)",
                "rest": "final(1000 * (0.05 - data.qpos[2]))",
                "restLight": "final(1000 * (0.05 - data.qpos[9]))",
                // At samples with a contact; at 20 ms, the previous sample is deeper, but has no contact yet.
                "peak": "max(data.ncon > 0 ? 1000 * (0.05 - data.qpos[2]) : 0)",
                "deepest": "max(1000 * (0.05 - data.qpos[2]))",
                "estimate": "1000 * Math.sqrt(2 * 9.81 * 0.95) * 0.02 / Math.E"
            }
        }),
        &[
            ("0.4400 s", "fine.touch"),
            ("0.4400 s", "fine.touchLight"),
            ("4.3164 m/s", "fine.speed"),
            ("4.3164 m/s", "fine.speedLight"),
            ("4.316 m/s", "fine.speed"),
            ("0.4401 s", "fine.ideal"),
            ("4.317 m/s", "fine.idealSpeed"),
            ("0.442 s", "fine.seen"),
            ("0.442 s", "fine.seenLight"),
            ("0.460 s", "coarse.seen"),
            ("0.36718184 mm", "fine.rest"),
            ("0.36718184 mm", "fine.restLight"),
            ("0.367 mm", "fine.rest"),
            ("0.83329071 mm", "coarse.rest"),
            ("0.83 mm", "coarse.rest"),
            ("29 mm", "fine.peak"),
            ("28.858 mm", "fine.peak"),
            ("32.275 mm", "coarse.peak"),
            ("42.772 mm", "coarse.deepest"),
            ("32 mm", "fine.estimate"),
        ],
    );
}

#[test]
fn resting_depth_and_mass_and_gravity() {
    let mass = json!({
        "label": "mass", "apply": "model.body_mass[2] = value; mj.mj_setConst(model, data)",
        "min": 0.01, "max": 5, "step": 0.01, "value": 0.1
    });
    let gravity = json!({"label": "gravity", "set": "model.opt.gravity[2]", "min": -20, "max": 0, "step": 0.005, "value": -9.81});
    verified(
        &model_text("ball_drop"),
        json!([mass, gravity]),
        json!({
            "runs": {
                "tenth": {"until": 3},
                "two": {"set": {"mass": 2}, "until": 3},
                "five": {"set": {"mass": 5}, "until": 3},
                "half": {"set": {"gravity": -4.905}, "until": 4}
            },
            "measure": {"rest": "final(1000 * (0.05 - data.body('light').xpos[2]))"}
        }),
        &[
            ("0.36718184 mm", "tenth.rest"),
            ("0.36718184 mm", "two.rest"),
            ("0.36718184 mm", "five.rest"),
            ("0.20723478 mm", "half.rest"),
        ],
    );
}

#[test]
fn a_mass_without_set_const_sinks_deeper() {
    let mass = json!({"label": "mass", "set": "model.body_mass[2]", "min": 0.01, "max": 5, "step": 0.01, "value": 0.1});
    let checked = check(
        &model_text("ball_drop"),
        json!([mass]),
        json!({
            "runs": {"careless": {"set": {"mass": 5}, "until": 6}},
            "measure": {"rest": "final(1000 * (0.05 - data.qpos[9]))"}
        }),
        &[("9.81 mm", "rest")],
    );
    // The number is right, and the finding explains why it is unexpected.
    assert_eq!(codes(&checked), ["missing-setconst"]);
    assert_eq!(checked.claims[0].judgement.quotes[0].verdict(), "verified");
}

#[test]
fn the_mass_slider_in_mid_run() {
    let lab = json!({
        "xml": model_text("ball_drop"),
        "controls": [{
            "label": "mass of the light ball", "apply": "model.body_mass[2] = value; mj.mj_setConst(model, data)",
            "min": 0.01, "max": 5, "value": 0.1
        }]
    });
    let lesson = load_lesson(SourceFile::new("lab.json", lab.to_string()), &ModelFolder::unknown());
    let lab = lesson.all_labs()[0];
    let model = compile(&lab.xml.as_ref().unwrap().value);
    let mut findings = Vec::new();
    let programs = Programs::compile(lab, &model, &mut findings);
    assert_eq!(findings, []);
    // A plan for any access, and one for exactly the required access: both must agree with the library.
    for access in [programs.access, AccessSet::ANY] {
        let plan = Some(Plan::new(&model, &access));
        let mut session = Session::start(&programs, &model, Start { plan, ..Start::default() });
        let text = std::fs::read_to_string(workspace().join("tests/golden/slider.json")).unwrap();
        let golden: Json = serde_json::from_str(&text).unwrap();
        (0..100).for_each(|_| session.step());
        for (i, row) in golden.as_array().unwrap().iter().enumerate() {
            match i {
                0 => {}
                1 => session.set_control(0, Value::Number(5.0)),
                _ => (0..50).for_each(|_| session.step()),
            }
            let d = session.world.data.fields();
            assert_eq!(d.time, numbers(&row["time"])[0], "row {i}");
            assert_eq!(d.ncon as u64, row["ncon"].as_u64().unwrap(), "row {i}");
            // The tolerance for trajectories with contacts, see `parity`.
            for (computed, recorded) in
                d.qpos.iter().chain(&d.qvel).zip(numbers(&row["qpos"]).iter().chain(&numbers(&row["qvel"])))
            {
                assert!((computed - recorded).abs() <= 1e-10, "row {i}: {computed} {recorded}");
            }
            if i == 1 {
                // Back at the start with its previous speed, a side effect of mj_setConst.
                assert_eq!((d.qpos[9], format!("{:.4}", d.qvel[8])), (1.0, "-1.9620".into()));
            }
        }
        let d = session.world.data.fields();
        assert_eq!(format!("{:.8}", 1000.0 * (0.05 - d.qpos[9])), "0.36718184");
        assert_eq!(format!("{:.8}", 1000.0 * (0.05 - d.qpos[2])), "0.36718184");
    }
}

/// The drop model with contact parameters for the floor and the heavy ball.
fn drop_with(floor: &str, heavy: &str) -> String {
    model_text("ball_drop")
        .replace("size=\"2 2 0.05\"", &format!("size=\"2 2 0.05\" {floor}"))
        .replace("mass=\"2.0\"", &format!("mass=\"2.0\" {heavy}"))
}

#[test]
fn rebound() {
    let soft = "solref=\"0.02 0.2\"";
    let measure = json!({
        // The first sample after the impact at which the ball falls again.
        "apex": "at(data.time > 0.5 && data.qvel[2] < 0, data.qpos[2])",
        "when": "first(data.time > 0.5 && data.qvel[2] < 0)",
        "peak": "max(1000 * (0.05 - data.qpos[2]))"
    });
    let run = json!({"runs": {"drop": {"until": 0.9}}, "measure": measure});
    verified(
        &drop_with(soft, soft),
        json!([]),
        run.clone(),
        &[("0.33402 m", "apex"), ("0.694 s", "when"), ("12.13 mm", "peak")],
    );
    // Only on the floor: the contact mixes (0.02, 0.2) with (0.02, 1).
    verified(&drop_with(soft, ""), json!([]), run, &[("0.08765 m", "apex")]);
    let m = compile(&drop_with(soft, ""));
    let mut d = Data::new(&m);
    while d.ncon == 0 {
        core::step(&m, &mut d).unwrap();
    }
    assert_eq!(d.contact[0].solref, [0.02, 0.6]);
}

/// The penetration depth of the heavy ball at rest, m.
fn depth(m: &Model, timestep: f64) -> f64 {
    let mut m = m.clone();
    *m.edit().opt.timestep = timestep;
    let mut d = Data::new(&m);
    (0..3000).for_each(|_| core::step(&m, &mut d).unwrap());
    0.05 - d.qpos[2]
}

#[test]
fn largest_timestep_that_rests_above_a_height() {
    for floor in ["", "solref=\"0.005 1\""] {
        let m = compile(&drop_with(floor, ""));
        let (mut low, mut high) = (0.002, 0.03);
        assert!(depth(&m, low) < 1e-3 && depth(&m, high) > 1e-3);
        while high - low > 1e-8 {
            let middle = 0.5 * (low + high);
            if depth(&m, middle) < 1e-3 { low = middle } else { high = middle }
        }
        assert_eq!(format!("{low:.6}"), "0.022576", "floor {floor}");
        assert_eq!(format!("{:.4}", 1e3 * depth(&m, low)), "1.0000", "floor {floor}");
        // The contact's time constant is 2 h there, so the depth is 4 h^2 g (1 - dw).
        assert!((low - f64::sqrt(1e-3 / (4.0 * 0.05 * 9.81))).abs() < 1e-7);
    }
}

#[test]
fn touchdown_from_five_heights() {
    let run = |h: f64, z: f64| json!({"set": {"h": h}, "setup": format!("data.qpos[2] = {z}"), "until": 0.8});
    let runs = |h: f64| {
        json!({
            "a": run(h, 0.2), "b": run(h, 0.65), "c": run(h, 1.1), "d": run(h, 1.55), "e": run(h, 2.0)
        })
    };
    let measure = json!({
        "touch": "before(contact('heavy_geom', 'floor'), data.time)",
        "ideal": "initial(Math.sqrt(2 * (data.qpos[2] - 0.05) / 9.81))"
    });
    let xml = model_text("ball_drop");
    verified(
        &xml,
        json!([timestep()]),
        json!({"runs": runs(0.002), "measure": measure}),
        &[
            ("0.1740 s", "a.touch"),
            ("0.3500 s", "b.touch"),
            ("0.4620 s", "c.touch"),
            ("0.5540 s", "d.touch"),
            ("0.6300 s", "e.touch"),
            ("0.1749 s", "a.ideal"),
            ("0.3497 s", "b.ideal"),
            ("0.4627 s", "c.ideal"),
            ("0.5530 s", "d.ideal"),
            ("0.6305 s", "e.ideal"),
        ],
    );
    verified(
        &xml,
        json!([timestep()]),
        json!({"runs": runs(0.01), "measure": measure}),
        &[
            ("0.1700 s", "a.touch"),
            ("0.3500 s", "b.touch"),
            ("0.4600 s", "c.touch"),
            ("0.5500 s", "d.touch"),
            ("0.6300 s", "e.touch"),
        ],
    );
}

#[test]
fn poses_are_old_until_forward() {
    let m = compile(&model_text("ball_drop"));
    for access in [AccessSet::ANY, AccessSet::OBSERVE] {
        let mut d = Data::planned(&m, Plan::new(&m, &access));
        core::forward(&m, &mut d).unwrap();
        d.edit().qpos[2] = 0.5;
        assert_eq!(d.fields().xpos[5], 1.0);
        core::forward(&m, &mut d).unwrap();
        assert_eq!(d.fields().xpos[5], 0.5);
    }
}
