//! A lab as a page uses it, models from any source, and the language without a lab.

#![allow(clippy::unwrap_used)]

use crate::support::{model_text, workspace};
use labspec::lint::ModelFolder;
use labspec::lint::load_lesson;
use labspec::player::{ControlKind, DisplayedIn};
use labspec::run::{self, RunOptions};
use labspec::{Checker, Engine, Error, Models, NoModels, Player, Value};
use labspec_core::xml::FileProblem;
use std::collections::BTreeMap;
use std::ops::ControlFlow;

const LAB: &str = r#"{
  "model": "ball_drop", "setup": "data.qpos[2] = ctx.height",
  "controls": [
    {"label": "height", "unit": "m", "param": "height", "min": 0.5, "max": 2, "step": 0.5, "value": 1, "reset": true},
    {"type": "select", "label": "solver", "set": "model.opt.solver", "options": [["PGS", 0], ["Newton", 2]], "value": 2},
    {"type": "button", "label": "Kick", "run": "data.qvel[2] = 2; ctx.kicks = (ctx.kicks || 0) + 1"}],
  "controller": "ctx.peak = Math.max(ctx.peak || 0, data.qpos[2])",
  "plots": [{"ylabel": "height (m)", "traces": [{"label": "heavy", "expr": "data.qpos[2]"}, {"label": "v (m/s)", "expr": "data.qvel[2]"}]}],
  "readouts": [{"label": "peak (m)", "expr": "ctx.peak || 0", "digits": 4}, {"label": "kicks", "expr": "ctx.kicks || 'none'"}]
}"#;

fn models() -> BTreeMap<String, String> {
    ["ball_drop", "pendulum"].into_iter().map(|name| (name.to_string(), model_text(name))).collect()
}

fn player() -> Player {
    Player::of_lab(LAB, models()).unwrap()
}

fn bits(player: &Player) -> Vec<u64> {
    let d = player.data().fields();
    let all = d.qpos.iter().chain(&d.qvel).chain(&d.qacc).chain(player.numbers());
    std::iter::once(&d.time).chain(all).map(|x| x.to_bits()).collect()
}

/// The scene has all fields of the present state, also after a reset and a restore, and reading it does not affect the lab.
#[test]
fn a_scene_is_the_present_state_and_changes_nothing() {
    let (mut drawn, mut plain) = (player(), player());
    let start = drawn.save();
    let mut has_touched = false;
    for step in 0..1200 {
        let height = drawn.data().fields().qpos[2];
        let scene = drawn.scene().unwrap();
        assert_eq!(scene.xpos[5].to_bits(), height.to_bits(), "step {step}");
        has_touched |= scene.ncon > 0 && scene.efc_force.iter().any(|force| *force > 0.0);
        assert_eq!(drawn.scene().unwrap().time, plain.time());
        for lab in [&mut drawn, &mut plain] {
            if step == 700 {
                lab.press("Kick").unwrap();
            }
            lab.step().unwrap();
        }
    }
    assert!(has_touched);
    assert_eq!(bits(&drawn), bits(&plain));
    drawn.restore(&start).unwrap();
    assert_eq!(drawn.scene().unwrap().time, 0.0);
    drawn.set("height", 1.5).unwrap();
    let height = drawn.data().fields().qpos[2];
    assert_eq!(drawn.scene().unwrap().qpos[2], height);
}

#[test]
fn a_page_draws_the_overlays_of_the_lab() {
    let player = player();
    let labels: Vec<&str> = player.controls().iter().map(|c| c.label.as_str()).collect();
    assert_eq!(labels, ["height", "solver", "Kick"]);
    let ControlKind::Slider { min, max, step, unit, digits } = &player.controls()[0].kind else {
        unreachable!()
    };
    assert_eq!((*min, *max, *step, unit.as_str(), *digits), (0.5, 2.0, 0.5, "m", 3));
    let options = vec![("PGS".to_string(), Value::Number(0.0)), ("Newton".to_string(), Value::Number(2.0))];
    assert_eq!(player.controls()[1].kind, ControlKind::Select { options });
    assert_eq!(player.controls()[2].kind, ControlKind::Button);
    let displayed: Vec<_> =
        player.displayed().iter().map(|s| (s.label.as_str(), s.unit.as_str(), s.place)).collect();
    let expected = [
        ("heavy", "m", DisplayedIn::Plot(0)),
        ("v (m/s)", "m/s", DisplayedIn::Plot(0)),
        ("peak (m)", "m", DisplayedIn::Readout(4)),
        ("kicks", "", DisplayedIn::Readout(3)),
    ];
    assert_eq!(displayed, expected);
    assert_eq!((player.numbers().len(), player.values()[3].rounded(3).as_str()), (4, "none"));
    assert_eq!(player.reads(), ["data.qpos", "data.qvel"]);
    assert_eq!(player.writes(), ["model.opt.solver", "data.qpos", "data.qvel"]);
    assert_eq!(player.findings(), []);
}

/// Names and indexes of one model have no meaning in another: no sample is recorded, and the table contains the reason.
#[test]
fn programs_of_another_model_are_not_run() {
    let lesson = load_lesson(labspec::source::SourceFile::new("lab.json", LAB), &models().into());
    let lab = lesson.all_labs()[0];
    let [model, twin] = [(); 2].map(|()| crate::support::model("ball_drop"));
    let programs = labspec::bind::Programs::compile(lab, &model, &mut Vec::new());
    let options = RunOptions { steps: Some(10), ..RunOptions::default() };
    let table = run::run(lab, &model.clone(), &programs, &options).unwrap();
    assert_eq!((table.rows.len(), table.errors.len()), (11, 0));
    // Another model with the same text has another identity.
    let table = run::run(lab, &twin, &programs, &options).unwrap();
    assert!(table.rows.is_empty(), "{:?}", table.rows);
    assert!(table.errors[0].contains("another model"), "{:?}", table.errors);
}

/// The columns of one model are never filled from a session with another model.
#[test]
fn a_recording_refuses_samples_of_another_model() {
    let lesson = load_lesson(labspec::source::SourceFile::new("lab.json", LAB), &models().into());
    let lab = lesson.all_labs()[0];
    let [model, twin] = [(); 2].map(|()| crate::support::model("ball_drop"));
    let [of_model, of_twin] =
        [&model, &twin].map(|m| labspec::bind::Programs::compile(lab, m, &mut Vec::new()));
    let mut samples = run::Samples::new(&of_model, 4);
    let mut session_of_twin = run::Session::start(&of_twin, &twin, run::Start::default());
    assert_eq!(session_of_twin.ended(), None);
    assert!(samples.take(&mut session_of_twin).is_err());
    let mut session = run::Session::start(&of_model, &model, run::Start::default());
    samples.take(&mut session).unwrap();
    assert_eq!(samples.rows().len(), 1);
}

/// An expression of another model is not evaluated: it fails instead of giving NaN.
#[test]
fn a_session_evaluates_nothing_of_another_model() {
    let lesson = load_lesson(labspec::source::SourceFile::new("lab.json", LAB), &models().into());
    let lab = lesson.all_labs()[0];
    let [model, twin] = [(); 2].map(|()| crate::support::model("ball_drop"));
    let [of_model, of_twin] =
        [&model, &twin].map(|m| labspec::bind::Programs::compile(lab, m, &mut Vec::new()));
    let mut session = run::Session::start(&of_model, &model, run::Start::default());
    for (programs, good) in [(&of_model, true), (&of_twin, false)] {
        let bound = programs.probes[0].bound.as_ref().unwrap();
        assert_eq!(session.evaluate(&bound.program, &bound.text).is_some(), good);
    }
    assert!(
        session.program_errors[0].message.contains("compiled for something else"),
        "{:?}",
        session.program_errors
    );
}

/// A player that is stepped gives the same values as `run`, bit for bit, independent of requests by the frontend in between.
#[test]
fn a_player_repeats_a_run() {
    let lesson = load_lesson(labspec::source::SourceFile::new("lab.json", LAB), &models().into());
    let lab = lesson.all_labs()[0];
    let model = crate::support::model("ball_drop");
    let programs = labspec::bind::Programs::compile(lab, &model, &mut Vec::new());
    let options = RunOptions {
        steps: Some(400),
        set: vec![("height".into(), Value::Number(1.5))],
        press: vec![("Kick".into(), 0.3)],
        ..RunOptions::default()
    };
    let table = run::run(lab, &model, &programs, &options).unwrap();
    let mut player = player();
    player.set("height", 1.5).unwrap();
    for (i, row) in table.rows.iter().enumerate() {
        // A run presses buttons before the step, and its first sample is the start.
        if i > 0 {
            player.step().unwrap();
        }
        let row: Vec<u64> = row[1..].iter().map(|c| c.number().to_bits()).collect();
        assert_eq!(player.numbers().iter().map(|x| x.to_bits()).collect::<Vec<_>>(), row, "row {i}");
        if player.time() >= 0.3 - 1e-12 && player.values()[3].rounded(0) == "none" {
            player.press("Kick").unwrap();
        }
    }
    assert_eq!(player.values()[3].rounded(0), "1");
}

#[test]
fn a_page_gets_every_sample_of_a_curve() {
    let (mut stepped, mut played) = (player(), player());
    let mut curve = Vec::new();
    let steps = played.play_with(0.1, |time, values| curve.push((time, values.to_vec()))).unwrap();
    assert_eq!((steps, curve.len()), (50, 50));
    for (time, values) in curve {
        stepped.step().unwrap();
        assert_eq!((stepped.time(), stepped.values()), (time, values.as_slice()));
    }
}

#[test]
fn pieces_of_a_run_are_the_run() {
    let (mut whole, mut pieces) = (player(), player());
    let steps = whole.play_to(0.3).unwrap();
    let mut made = 0;
    loop {
        let mut seen = 0;
        let piece = pieces.play_while(0.3, 7, |data, values| {
            seen += 1;
            assert!(data.time() > 0.0 && !values.is_empty());
            if seen == 5 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        });
        let piece = piece.unwrap();
        assert!(piece == seen && piece <= 5);
        made += piece;
        if piece == 0 {
            break;
        }
    }
    assert_eq!((made, bits(&pieces)), (steps, bits(&whole)));
    assert!(pieces.play_while(f64::NAN, 7, |_, _| ControlFlow::Continue(())).is_err());
    assert_eq!(pieces.play_while(9.0, 0, |_, _| ControlFlow::Continue(())), Ok(0));
}

#[test]
fn a_saved_state_continues_bit_for_bit() {
    let mut player = player();
    player.set("height", 0.5).unwrap();
    player.play_to(0.3).unwrap();
    let saved = player.save();
    let go_on = |player: &mut Player| {
        player.press(2).unwrap();
        player.set("solver", "PGS").unwrap();
        player.play_to(0.7).unwrap();
        player.reset();
        player.play_to(0.5).unwrap();
        bits(player)
    };
    let first = go_on(&mut player);
    assert_ne!(bits(&player), {
        player.restore(&saved).unwrap();
        bits(&player)
    });
    assert_eq!(player.value("solver"), Some(&Value::Number(2.0)));
    assert_eq!(go_on(&mut player), first);
    // Without the restored model, the solver would be different.
    assert!(matches!(self::player().restore(&saved), Err(Error::Call(_))));
}

#[test]
fn controls_and_resets_keep_the_order_of_the_format() {
    let mut player = player();
    assert_eq!(player.numbers()[0], 1.0);
    player.play_to(0.2).unwrap();
    // `reset: true` restarts with the new value; `ctx` is kept.
    player.set(0, 2.0).unwrap();
    assert_eq!((player.time(), player.numbers()[0], player.numbers()[2]), (0.0, 2.0, 1.0));
    player.press("Kick").unwrap();
    assert_eq!(player.numbers()[1], 2.0);
    player.reset();
    assert_eq!((player.numbers()[1], player.values()[3].rounded(0)), (0.0, "1".into()));
    assert_eq!(player.play_to(0.1).unwrap(), (0.1 / player.timestep()).round() as usize);
    assert_eq!(player.play_to(0.05).unwrap(), 0);
}

#[test]
fn nonsense_is_an_error() {
    let mut player = player();
    let start = bits(&player);
    for label in ["", "Height", "🦀", "kick", &"x".repeat(100_000)] {
        assert!(matches!(player.set(label, 1.0), Err(Error::Call(_))), "{label}");
        assert!(matches!(player.press(label), Err(Error::Call(_))), "{label}");
        assert_eq!(player.value(label), None);
    }
    for index in [3, 4, usize::MAX] {
        assert!(player.set(index, 1.0).is_err() && player.press(index).is_err());
        assert_eq!(player.value(index), None);
    }
    for value in [f64::NAN, f64::INFINITY, -1.0, 0.75, 1e300] {
        assert!(player.set("height", value).is_err(), "{value}");
        assert!(player.set("solver", value).is_err(), "{value}");
    }
    assert!(player.set("height", "1").is_err() && player.set("height", true).is_err());
    assert!(player.set("Kick", 1.0).is_err() && player.press("height").is_err());
    for time in [f64::NAN, f64::INFINITY, 1e300] {
        assert!(player.play_to(time).is_err(), "{time}");
    }
    for time in [f64::NEG_INFINITY, -1.0, 0.0, -0.0] {
        assert_eq!(player.play_to(time).unwrap(), 0, "{time}");
    }
    assert_eq!(bits(&player), start);
    let hint = player.set("heigth", 1.0).unwrap_err().to_string();
    assert!(hint.contains("did you mean \"height\"?"), "{hint}");
    for text in
        ["", "{", "[]", "{\"model\": 1}", "{\"model\": \"nothing\"}", "{\"xml\": \"<mujoco\"}", "\u{0}"]
    {
        let refused = Player::of_lab(text, models()).unwrap_err();
        assert!(!refused.to_string().is_empty(), "{text}");
    }
    for address in ["#2", "", "#", "#0", "#99999999999999999999", "#a.1"] {
        assert!(Player::of_lesson("lab.json", LAB, address, models()).is_err(), "{address}");
    }
}

#[test]
fn a_break_is_a_finding_with_its_time() {
    let broken = |controller: &str| {
        let lab = serde_json::json!({"model": "ball_drop", "controller": controller, "readouts": [{"label": "z", "expr": "data.qpoz[2]"}]});
        Player::of_lab(&lab.to_string(), models()).unwrap()
    };
    // An error in a readout is reported at once, and the readout displays nothing.
    let mut player = broken("data.time > 0.1 ? data.qvel[2] = Infinity : 0");
    let codes = |player: &Player| player.findings().iter().map(|f| f.code).collect::<Vec<_>>();
    let loaded = codes(&player);
    assert!(loaded.contains(&"unknown-field"), "{loaded:?}");
    assert!(player.numbers()[0].is_nan());
    player.play_to(0.2).unwrap();
    let found = player.findings();
    let last = found.iter().find(|f| f.code == "simulation-diverges").unwrap();
    assert!(last.message.contains("at t = 0.1") && last.position.is_some(), "{last}");

    // A controller that fails stops the lab until it is reset.
    let mut player = broken("data.time > 0.1 ? model.opt.timestep = -1 : 0");
    let frozen = player.play_to(0.2).unwrap_err();
    assert_eq!(frozen.findings().len(), 1, "{frozen}");
    assert!(player.is_over() && player.time() < 0.11);
    assert!(player.step().is_err());
    player.reset();
    assert!(!player.is_over() && player.step().is_ok());

    // A controller that never ends stops the lab, not the page.
    let mut player = broken("for (let i = 0; i < 1e9; i++) { ctx.x = i }");
    assert!(player.step().is_err() && player.is_over());
}

#[test]
fn a_lab_stops_at_its_stop_time() {
    let lab = LAB.replacen('{', "{\"stopAt\": 0.25, ", 1);
    let mut player = Player::of_lab(&lab, models()).unwrap();
    player.play_to(10.0).unwrap();
    assert!(player.is_over() && (0.25..0.25 + player.timestep()).contains(&player.time()));
    assert_eq!(player.play_to(10.0).unwrap(), 0);
    player.reset();
    assert!(!player.is_over());
}

#[test]
fn a_player_can_be_sent_to_another_thread() {
    let mut player = player();
    let elsewhere = std::thread::spawn(move || {
        player.play_to(0.5).unwrap();
        bits(&player)
    });
    let mut here = self::player();
    here.play_to(0.5).unwrap();
    assert_eq!(elsewhere.join().unwrap(), bits(&here));
}

/// A lesson of the repository from its folder, from memory, and from a closure: the same findings and the same ledger.
#[test]
fn a_lesson_is_the_same_wherever_its_models_come_from() {
    let folder = workspace().join("specs/models");
    let list: BTreeMap<String, String> = crate::support::models(&folder)
        .into_iter()
        .map(|name| (name.clone(), std::fs::read_to_string(folder.join(format!("{name}.xml"))).unwrap()))
        .collect();
    let text = std::fs::read_to_string(workspace().join("specs/lessons/02-bounce-and-swing.md")).unwrap();
    let text = text.replace("\"0.297 m\"", "\"0.3 m\"");
    let closure = list.clone();
    let all = [
        Checker::new(ModelFolder::open(&folder).unwrap()),
        Checker::new(list),
        Checker::new(move |name: &str| closure.get(name).cloned()),
    ];
    let mut reports = all.map(|mut checker| checker.check("lesson.md", &text)).into_iter();
    let first = reports.next().unwrap();
    assert!(!first.findings.is_empty() && first.entries().len() > 8);
    assert_eq!(first.outcome(), labspec::ledger::Outcome::Findings);
    for report in reports {
        assert_eq!((&report.findings, &report.ledger), (&first.findings, &first.ledger));
    }
}

#[test]
fn a_missing_model_is_reported() {
    let lesson = "```lab\n{\"model\": \"drop\"}\n```\n";
    let codes = |mut checker: Checker| {
        checker.check("a.md", lesson).findings.iter().map(|f| f.code).collect::<Vec<_>>()
    };
    assert_eq!(codes(Checker::new(NoModels)), ["unknown-model"]);
    assert_eq!(codes(Checker::new(|_: &str| None)), ["unknown-model"]);
    assert_eq!(codes(Checker::new(ModelFolder::unknown())), ["no-model-folder"]);
    // The errors of a model have locations in its own text.
    let mut checker = Checker::new([("drop", "<mujoco>\n<bdy/></mujoco>")]);
    let report = checker.check("a.md", lesson);
    let inside = report.findings.iter().find(|f| &*f.path == "models/drop.xml").unwrap();
    assert_eq!(inside.position.map(|p| p.line), Some(2), "{inside}");
    assert!(report.findings.iter().any(|f| f.code == "model-broken"));
}

#[test]
fn models_in_memory_include_each_other() {
    let models = [
        ("a", "<mujoco><include file='b.xml'/></mujoco>"),
        ("b", "<mujoco><worldbody><geom size='1'/></worldbody></mujoco>"),
    ];
    let player = Player::of_lab("{\"model\": \"a\"}", models).unwrap();
    assert_eq!(player.model().ngeom, 1);
    assert_eq!(models.file("b.xml", 3), Err(FileProblem::TooLarge));
    assert_eq!(models.file("c.xml", 1000), Err(FileProblem::Missing));
    assert_eq!(models.file("b.obj", 1000), Err(FileProblem::Missing));
}

#[test]
fn a_text_uses_its_model() {
    let mut drop = Engine::compile(&model_text("ball_drop")).unwrap();
    let mut other = Engine::compile(&model_text("ball_drop")).unwrap();
    let z = drop.expression("data.qpos[2]").unwrap();
    let push = drop.statements("data.qvel[2] = 1; ctx.pushed = true").unwrap();
    assert_eq!(z.number(&mut drop).unwrap(), 1.0);
    // Another model with the same text has another identity.
    for refused in [z.number(&mut other).map(drop_number), push.run(&mut other)] {
        let Err(Error::Call(why)) = refused else { unreachable!("{refused:?}") };
        assert!(why.contains("another model"), "{why}");
    }
    // A copy of the engine has the same model, in another state.
    let mut copy = drop.clone();
    push.run(&mut copy).unwrap();
    copy.step().unwrap();
    assert!(z.number(&mut copy).unwrap() > z.number(&mut drop).unwrap());
    let pushed = drop.expression("ctx.pushed");
    assert_eq!(pushed.unwrap().value(&mut drop).unwrap(), Value::Undefined);
}

fn drop_number(_: f64) {}

#[test]
fn variables_of_an_engine_are_shared_by_its_texts() {
    let mut engine = Engine::compile(&model_text("pendulum")).unwrap();
    engine
        .statements("for (let i = 0; i < 3; i++) { ctx['q' + i] = 10 * i }")
        .unwrap()
        .run(&mut engine)
        .unwrap();
    // A program mentions the name only after the value was stored under a computed name.
    let sum = engine.expression("ctx.q1 + ctx.q2").unwrap();
    assert_eq!(sum.number(&mut engine).unwrap(), 30.0);
    engine.statements("ctx['q' + 1] = 5").unwrap().run(&mut engine).unwrap();
    assert_eq!(sum.number(&mut engine).unwrap(), 25.0);

    let typo = engine.expression("data.qpos[7]").unwrap_err();
    assert_eq!(typo.findings()[0].code, "index-out-of-range");
    assert!(Engine::compile("<mujoco><bdy/></mujoco>").unwrap_err().findings()[0].position.is_some());
    let endless = engine.statements("for (let i = 0; i >= 0; i++) { ctx.x = i }").unwrap();
    assert_eq!(endless.run(&mut engine).unwrap_err().findings().len(), 1);
}

/// A force acts as `xfrc_applied` does, until the lab is reset; what cannot act is refused, and changes nothing.
#[test]
fn a_force_acts_until_the_lab_is_reset() {
    let (mut pulled, mut plain) = (player(), player());
    pulled.apply_force(1, [0.0, 0.0, 30.0, 0.0, 0.0, 0.0]).unwrap();
    for _ in 0..50 {
        pulled.step().unwrap();
        plain.step().unwrap();
    }
    let velocity = |player: &Player| player.data().fields().qvel[2];
    let gained = 30.0 / pulled.model().body_mass[1] * 50.0 * pulled.timestep();
    assert!(
        (velocity(&pulled) - velocity(&plain) - gained).abs() < 1e-9,
        "{}",
        velocity(&pulled) - velocity(&plain)
    );
    let before = bits(&pulled);
    assert!(pulled.apply_force(0, [1.0; 6]).is_err());
    assert!(pulled.apply_force(9, [1.0; 6]).is_err());
    assert!(pulled.apply_force(1, [f64::NAN; 6]).is_err());
    assert_eq!(bits(&pulled), before);
    for lab in [&mut pulled, &mut plain] {
        lab.reset();
        lab.step().unwrap();
    }
    // The variables of the lab are kept over a reset, and with them the peak that the force has led to.
    let state = |player: &Player| {
        player
            .data()
            .fields()
            .qacc
            .iter()
            .chain(&player.data().fields().qpos)
            .map(|x| x.to_bits())
            .collect::<Vec<_>>()
    };
    assert_eq!(state(&pulled), state(&plain));
}

/// Readouts as the page prints them: with their digits, and texts as they are.
#[test]
fn readouts_are_printed_with_their_digits() {
    assert_eq!(player().readout_texts(), ["0.0000", "none"]);
}
