//! Masses that change without `mj_setConst`, controls that a reset undoes, labs that are meant to fail: each finding depends on
//! a run, and each recommendation was tested in a run.

#![allow(clippy::unwrap_used, clippy::panic)]

use crate::support::{check_text, compile, model_text, workspace};
use labspec::bind::scene::Models;
use labspec::check::{self, CheckLevel};
use labspec::finding::Finding;
use labspec::lint::ModelFolder;
use labspec::lint::load_lesson;
use labspec::source::SourceFile;
use labspec_core::{Data, forward, set_const, state};
use serde_json::{Value as Json, json};

/// An arm of two links whose fore end rests on a floor, posed by a keyframe away from qpos0.
const ARM: &str = "<mujoco><compiler angle='radian'/><worldbody><geom name='floor' type='plane' size='2 2 1'/>
  <body name='upper' pos='0 0 0.5'><joint name='a' axis='0 1 0' damping='1'/><geom type='capsule' fromto='0 0 0 0.4 0 0' size='0.03' mass='1'/>
  <body name='fore' pos='0.4 0 0'><joint name='b' axis='0 1 0' damping='1' range='-1 1' limited='true'/><geom type='capsule' fromto='0 0 0 0.4 0 0' size='0.03' mass='1'/>
  </body></body></worldbody><keyframe><key qpos='0.5 0.3'/></keyframe></mujoco>";

/// A pendulum without contacts.
const PENDULUM: &str = "<mujoco><worldbody><body name='bob' pos='0 0 1'><joint name='hinge' axis='0 1 0'/>
  <geom size='0.05' pos='0.3 0 0' mass='1'/></body></worldbody></mujoco>";

fn slider(more: &Json) -> Json {
    let mut control = json!({"label": "mass", "min": 0.1, "max": 5, "step": 0.1, "value": 1});
    control.as_object_mut().unwrap().extend(more.as_object().unwrap().clone());
    control
}

fn found(lab: &Json) -> Vec<Finding> {
    let mut all = check_text("lab.json", &lab.to_string()).findings;
    // Findings of other rules about masses and stiff springs.
    all.retain(|f| !["mass-alone", "mjcf-too-fast", "verify-nothing"].contains(&f.code));
    all
}

/// The only finding, which is about `mj_setConst`.
fn only_finding(lab: &Json) -> Finding {
    let all = found(lab);
    assert_eq!(all.iter().map(|f| f.code).collect::<Vec<_>>(), ["missing-setconst"], "{all:?}");
    all[0].clone()
}

/// Applies the fix of the only finding: the lab is still valid JSON, and there is no finding left.
fn fixed(lab: &Json) -> String {
    let (mut text, fix) = (lab.to_string(), only_finding(lab).fix.unwrap());
    text.replace_range(fix.span, &fix.text);
    serde_json::from_str::<Json>(&text).unwrap();
    assert_eq!(found(&serde_json::from_str(&text).unwrap()), [], "{text}");
    text
}

fn drop(controls: &Json) -> Json {
    json!({
        "xml": model_text("ball_drop"), "stopAt": 1.5, "controls": controls,
        "readouts": [{"label": "depth (mm)", "expr": "1000 * (0.05 - data.qpos[9])"}]
    })
}

#[test]
fn a_visible_effect_of_a_mass_is_reported_with_evidence() {
    let finding = only_finding(&drop(&json!([slider(&json!({"set": "model.body_mass[2]", "value": 0.1}))])));
    let why = finding.why.unwrap();
    assert!(why.contains("with \"mass\" at 5, \"depth (mm)\" is "), "{why}");
    assert!(why.contains(" with the constants recomputed"), "{why}");
    // A `set` is a target: no statement can be added after it.
    assert_eq!(finding.fix, None);
    let help = finding.help.unwrap();
    assert!(help.contains("\"apply\": \"model.body_mass[2] = value; const q = data.qpos.slice(); mj.mj_setConst(model, data); data.qpos.set(q)\""), "{help}");
}

#[test]
fn invisible_effects_are_not_reported() {
    // Without contacts, limits or friction, no field that depends on an inertia is used.
    for (key, text) in [("set", "model.dof_armature[0]"), ("apply", "model.dof_armature[0] = value")] {
        let lab = json!({
            "xml": PENDULUM, "controls": [slider(&json!({key: text}))],
            "readouts": [{"label": "angle", "expr": "data.qpos[0]"}]
        });
        assert_eq!(found(&lab), []);
    }
    // The same with an arm in the air that a keyframe poses.
    let lab = json!({
        "xml": ARM.replace("type='plane'", "type='plane' pos='0 0 -5'"), "key": 0, "stopAt": 0.2,
        "controls": [slider(&json!({"apply": "model.dof_armature.fill(value); model.body_mass[2] = value"}))]
    });
    assert_eq!(found(&lab), []);
}

#[test]
fn an_arm_in_a_keyframe_keeps_its_pose() {
    let lab = json!({
        "xml": ARM, "key": 0, "controls": [slider(&json!({"apply": "model.body_mass[2] = value", "reset": true}))],
        "plots": [{"traces": [{"label": "elbow", "expr": "data.qpos[1]"}]}]
    });
    let finding = only_finding(&lab);
    assert!(finding.why.clone().unwrap().contains("\"elbow\" is "), "{finding:?}");
    assert!(finding.help.unwrap().contains("data.qpos.slice()"));
    assert!(fixed(&lab).contains("data.qpos.set(q)"));
}

#[test]
fn the_plain_call_is_advised_where_it_gives_the_correct_run() {
    // Starting from the reference pose, and reset after every change, so that qpos cannot be lost.
    let lab =
        drop(&json!([slider(&json!({"apply": "model.body_mass[2] = value;", "value": 0.1, "reset": true}))]));
    let help = only_finding(&lab).help.unwrap();
    assert!(help.starts_with("add `mj.mj_setConst(model, data)`; in a test run"), "{help}");
    assert!(!fixed(&lab).contains("slice"));
    // If it were moved during a run, the ball would jump back to its start.
    let lab = drop(&json!([slider(&json!({"apply": "model.body_mass[2] = value // kg", "value": 0.1}))]));
    assert!(only_finding(&lab).help.unwrap().contains("data.qpos.slice()"));
    fixed(&lab);
}

#[test]
fn a_call_before_the_mass_is_written_does_not_count() {
    let apply = "mj.mj_setConst(model, data); model.body_mass[2] = value";
    let lab = drop(&json!([slider(&json!({"apply": apply, "value": 0.1, "reset": true}))]));
    assert!(only_finding(&lab).message.contains("changes after the last `mj.mj_setConst(model, data)`"));
    fixed(&lab);
    let apply = "model.body_mass[2] = value; mj.mj_setConst(model, data)";
    let lab = drop(&json!([slider(&json!({"apply": apply, "value": 0.1, "reset": true}))]));
    assert_eq!(found(&lab), []);
}

#[test]
fn setups_and_buttons_are_checked_too() {
    let mut lab = drop(&json!([]));
    lab["setup"] = json!("model.body_mass[2] = 5");
    assert!(only_finding(&lab).why.unwrap().contains("as it stands, \"depth (mm)\" is "));
    fixed(&lab);
    let lab = drop(&json!([{"type": "button", "label": "Load", "run": "model.body_mass[2] = 5"}]));
    assert!(only_finding(&lab).why.unwrap().contains("after \"Load\" is pressed"));
    fixed(&lab);
}

#[test]
fn the_setup_of_a_verified_run_is_checked_too() {
    let mut lab = drop(&json!([]));
    lab["verify"] = json!({
        "runs": {"heavy": {"setup": "model.body_mass[2] = 5", "until": 1}},
        "measure": {"z": "final(data.qpos[9])"}, "says": []
    });
    let finding = only_finding(&lab);
    assert!(finding.why.unwrap().contains("in the run `heavy`, "), "{:?}", finding.help);
    fixed(&lab);
    // Compared with the correct run, the difference is intended.
    let right = "model.body_mass[2] = 5; mj.mj_setConst(model, data)";
    lab["verify"]["runs"] = json!({
        "right": {"setup": right, "until": 1}, "forgotten": {"setup": "model.body_mass[2] = 5", "until": 1}
    });
    assert_eq!(found(&lab), []);
    lab["verify"]["runs"]["right"]["setup"] = json!("data.qvel[0] = 1");
    only_finding(&lab);
    // No field that depends on this one is read.
    lab["verify"]["runs"] = json!({});
    lab["xml"] = json!(PENDULUM);
    lab["readouts"] = json!([]);
    lab["verify"]["runs"]["heavy"] = json!({"setup": "model.dof_armature[0] = 5", "until": 1});
    lab["verify"]["measure"] = json!({"q": "final(data.qpos[0])"});
    assert_eq!(found(&lab), []);
}

#[test]
fn an_untested_effect_is_reported_as_such() {
    let mut lab = drop(&json!([]));
    lab["setup"] = json!("model.body_mass[2] = 5; data.qvel[0] = 1e11");
    let all = found(&lab);
    let finding = all.iter().find(|f| f.code == "missing-setconst").unwrap();
    let help = finding.help.as_ref().unwrap();
    assert!(help.contains("could not be tested: as it stands, the simulation breaks"), "{help}");
    assert_eq!(finding.fix, None);
}

/// The recommended code has the same effect as the engine's own state functions.
#[test]
fn restoring_qpos_restores_the_state() {
    for xml in [model_text("ball_drop"), ARM.to_string()] {
        let mut model = compile(&xml);
        let mut data = Data::new(&model);
        (0..100).for_each(|_| labspec_core::step(&model, &mut data).unwrap());
        let mut before = vec![0.0; state::size(&model, state::INTEGRATION).unwrap()];
        state::get(&model, &data, &mut before, state::INTEGRATION).unwrap();
        model.edit().body_mass[2] = 5.0;
        let qpos = data.qpos.clone();
        set_const(&mut model, &mut data).unwrap();
        data.edit().qpos.copy_from_slice(&qpos);
        forward(&model, &mut data).unwrap();
        let mut after = before.clone();
        state::get(&model, &data, &mut after, state::INTEGRATION).unwrap();
        assert_eq!(before, after);
    }
}

fn pushed(more: &Json, lab: &Json) -> Vec<&'static str> {
    let xml = PENDULUM.replace("</worldbody>", "</worldbody><actuator><motor joint='hinge'/></actuator>");
    let mut all = json!({"xml": xml, "controls": [slider(more)]});
    all.as_object_mut().unwrap().extend(lab.as_object().unwrap().clone());
    found(&all).iter().map(|f| f.code).collect()
}

#[test]
fn lost_at_reset_is_not_hidden_by_an_unrelated_call() {
    let lost = |apply: &str| pushed(&json!({"apply": apply}), &json!({}));
    for call in [
        "",
        "; mj.mj_forward(model, data)",
        "; mj.mj_kinematics(model, data)",
        "; mj.mj_setConst(model, data)",
    ] {
        assert_eq!(lost(&format!("data.ctrl[0] = value{call}")), ["lost-at-reset"], "{call}");
    }
    // A separate start, and values that mj_setConst changes and the author restores.
    assert_eq!(lost("mj.mj_resetData(model, data); data.qvel[0] = value"), Vec::<&str>::new());
    let keep = "model.body_mass[1] = value; const q = data.qpos.slice(); mj.mj_setConst(model, data); data.qpos.set(q)";
    assert_eq!(lost(keep), Vec::<&str>::new());
}

#[test]
fn lost_at_reset_is_shown_by_a_run() {
    let again = json!({"setup": "data.ctrl[0] = ctx.k"});
    assert_eq!(pushed(&json!({"apply": "data.ctrl[0] = value", "param": "k"}), &again), Vec::<&str>::new());
    let again = json!({"controller": "data.ctrl[0] = ctx.k"});
    assert_eq!(pushed(&json!({"apply": "data.ctrl[0] = value", "param": "k"}), &again), Vec::<&str>::new());
    let other = json!({"setup": "data.ctrl[0] = 1"});
    assert_eq!(pushed(&json!({"set": "data.ctrl[0]"}), &other), ["lost-at-reset"]);
    // A reset after the change undoes it at once.
    assert_eq!(pushed(&json!({"set": "data.ctrl[0]", "reset": true}), &json!({})), ["lost-at-reset"]);
    assert_eq!(pushed(&json!({"set": "data.ctrl[0]", "init": true}), &json!({})), Vec::<&str>::new());
}

#[test]
fn apply_beside_set_is_dead() {
    let codes =
        pushed(&json!({"set": "model.dof_damping[0]", "apply": "mj.mj_forward(model, data)"}), &json!({}));
    assert_eq!(codes, ["apply-unused"]);
}

/// A spring that is too stiff for this timestep.
fn spring(timestep: &str, more: &Json) -> Vec<&'static str> {
    let xml = format!(
        "<mujoco><option timestep='{timestep}' integrator='Euler'><flag eulerdamp='disable'/></option><worldbody><body><joint type='slide' stiffness='1000'/><geom size='0.1' mass='0.1'/></body></worldbody></mujoco>"
    );
    let mut lab = json!({"xml": xml, "setup": "data.qvel[0] = 1"});
    lab.as_object_mut().unwrap().extend(more.as_object().unwrap().clone());
    found(&lab).iter().map(|f| f.code).collect()
}

#[test]
fn a_lab_that_declares_a_divergence_must_diverge() {
    let [breaks, none] = [json!({"expect": "breaks"}), json!({})];
    assert_eq!(spring("0.1", &none), ["energy-grows"], "until it is no number any more");
    assert_eq!(spring("0.1", &breaks), Vec::<&str>::new());
    assert_eq!(spring("0.0005", &none), Vec::<&str>::new());
    assert_eq!(spring("0.0005", &breaks), ["does-not-break"]);
    assert_eq!(spring("0.0005", &json!({"expect": "break"})), ["wrong-type"]);
    assert_eq!(spring("0.0005", &json!({"expect": 1})), ["wrong-type"]);
}

#[test]
fn real_labs_get_only_warnings_with_evidence() {
    let shared = workspace().join("../shared/corpus");
    if !shared.exists() {
        println!("skipped: {} is not there", shared.display());
        return;
    }
    let mut messages = Vec::new();
    for folder in ["labs", "quizzes"] {
        let mut files: Vec<_> =
            std::fs::read_dir(shared.join(folder)).unwrap().map(|e| e.unwrap().path()).collect();
        files.sort();
        for path in files.iter().filter(|p| p.extension().is_some_and(|e| e == "json")) {
            let name = path.file_stem().unwrap().to_str().unwrap();
            let models = Models::new(ModelFolder::open(&shared.join("models")).unwrap());
            let lesson = load_lesson(SourceFile::read(path).unwrap(), models.folder());
            let checked =
                check::check_lesson(lesson, &models, CheckLevel { programs: true, ..CheckLevel::STATIC });
            for f in &checked.findings {
                let evidence = match f.code {
                    "missing-setconst" => " with the constants recomputed",
                    "lost-at-reset" => " after a reset",
                    "apply-unused" | "wrong-type" => panic!("{name}: {f:?}"),
                    _ => continue,
                };
                assert!(f.why.as_ref().is_some_and(|why| why.contains(evidence)), "{name}: {f:?}");
                messages.push(format!("{name}: {}", f.message));
            }
        }
    }
    insta::assert_snapshot!(messages.join("\n"));
}
