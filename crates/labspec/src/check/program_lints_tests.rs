//! Lints about what the programs of a lab do together: each mistake has its finding, and correct labs beside it have none.

#![allow(clippy::unwrap_used)]

use super::{CheckLevel, check_lesson};
use crate::bind::scene::Models;
use crate::lint::{ModelFolder, load_lesson};
use crate::source::SourceFile;
use serde_json::{Value, json};

const XML: &str = "<mujoco><worldbody><geom name='floor' type='plane' size='2 2 .1'/><body name='arm' pos='0 0 1'>\
    <joint name='swing' axis='0 1 0' damping='.1'/><geom name='bob' pos='0 0 -.5' size='.05' mass='1'/><site name='tip'/></body></worldbody>\
    <actuator><motor name='m' joint='swing'/></actuator></mujoco>";

/// The codes of these rules in a lab without runs.
fn codes(parts: Value) -> Vec<&'static str> {
    let mut lab = json!({"xml": XML, "stopAt": 1});
    lab.as_object_mut().unwrap().extend(parts.as_object().unwrap().clone());
    let file = SourceFile::new("lab.json", lab.to_string());
    let models = Models::new(ModelFolder::unknown());
    let lesson = load_lesson(file, models.folder());
    let level = CheckLevel { programs: true, labs: false, claims: false };
    let rules = [
        "force-accumulates",
        "force-stays",
        "reset-skips-setup",
        "kept-over-reset",
        "same-target",
        "world-element",
        "local-position",
        "degrees-without-unit",
        "degrees-for-radians",
    ];
    let found = check_lesson(lesson, &models, level).findings;
    found.iter().map(|f| f.code).filter(|code| rules.contains(code)).collect()
}

#[test]
fn forces_that_grow() {
    let controller = |text: &str| codes(json!({"controller": text}));
    for text in [
        "data.qfrc_applied[0] += 0.05",
        "data.joint('swing').qfrc_applied[0] -= 1",
        "data.xfrc_applied[8] = data.xfrc_applied[8] + 2",
        "if (data.time > 0.5) data.ctrl[0] += 0.1",
    ] {
        assert_eq!(controller(text), ["force-accumulates"], "{text}");
    }
    for text in [
        "data.qfrc_applied[0] = 0; data.qfrc_applied[0] += 0.05",
        "data.qfrc_applied.fill(0); data.qfrc_applied[0] += 0.05",
        "data.ctrl[0] += data.qpos[0] * model.opt.timestep",
        "data.qvel[0] += 0.1",
    ] {
        assert_eq!(controller(text), Vec::<&str>::new(), "{text}");
    }
}

#[test]
fn forces_that_stay() {
    let button = |label: &str, run: &str, controller: &str| {
        codes(json!({"controls": [{"type": "button", "label": label, "run": run}], "controller": controller}))
    };
    assert_eq!(button("Kick", "data.qfrc_applied[0] = 3", "ctx.a = 1"), ["force-stays"]);
    assert_eq!(button("Push", "data.xfrc_applied[6] = 3", "data.ctrl[0] = 0"), ["force-stays"]);
    for (label, run, controller) in [
        ("Kick", "data.qfrc_applied[0] = 3; ctx.until = 1", "if (data.time > 1) data.qfrc_applied[0] = 0"),
        ("Kick", "data.qfrc_applied[0] = data.qfrc_applied[0] ? 0 : 3", "ctx.a = 1"),
        ("Stop", "data.qfrc_applied[0] = 0", "ctx.a = 1"),
        ("Wind on", "data.qfrc_applied[0] = 3", "ctx.a = 1"),
        ("Kick", "data.qvel[0] += 3", "ctx.a = 1"),
    ] {
        assert_eq!(button(label, run, controller), Vec::<&str>::new(), "{run}");
    }
}

#[test]
fn resets_without_setup() {
    let button = |run: &str| {
        codes(
            json!({"setup": "data.qpos[0] = 1", "controls": [{"type": "button", "label": "Again", "run": run}]}),
        )
    };
    assert_eq!(button("mj.mj_resetData(model, data)"), ["reset-skips-setup"]);
    assert_eq!(button("mj.mj_resetData(model, data); mj.mj_forward(model, data)"), ["reset-skips-setup"]);
    assert!(button("sim.reset()").is_empty());
    assert!(button("mj.mj_resetData(model, data); data.qpos[0] = 2").is_empty());
}

#[test]
fn variables_that_a_reset_keeps() {
    let lab = |setup: &str, controller: &str| codes(json!({"setup": setup, "controller": controller}));
    for controller in [
        "ctx.peak = Math.max(ctx.peak || 0, data.qvel[0])",
        "if (data.qpos[0] > 0) ctx.n = (ctx.n || 0) + 1",
        "ctx.n = ctx.n || 0; ctx.n++",
    ] {
        assert_eq!(lab("data.qpos[0] = 1", controller), ["kept-over-reset"], "{controller}");
    }
    assert!(lab("ctx.peak = 0", "ctx.peak = Math.max(ctx.peak, data.qvel[0])").is_empty());
    assert!(lab("data.qpos[0] = 1", "if (data.time === 0) ctx.n = 0; ctx.n = (ctx.n || 0) + 1").is_empty());
    assert!(lab("data.qpos[0] = 1", "ctx.last = data.qpos[0]").is_empty());
}

#[test]
fn controls_with_one_target() {
    let slider = |label: &str, key: &str, target: &str| json!({"label": label, "min": 0, "max": 1, "value": 0, key: target});
    let two = |key: &str, a: &str, b: &str| {
        codes(
            json!({"controls": [slider("a", key, a), slider("b", key, b)], "controller": "data.ctrl[0] = (ctx.a || 0) + (ctx.b || 0)"}),
        )
    };
    assert_eq!(two("set", "model.dof_damping[0]", "model.joint('swing').damping[0]"), ["same-target"]);
    assert_eq!(two("param", "a", "a"), ["same-target"]);
    assert!(two("param", "a", "b").is_empty());
    assert!(two("set", "model.dof_damping[0]", "model.jnt_stiffness[0]").is_empty());
}

#[test]
fn elements_of_the_world() {
    let readout = |text: &str| codes(json!({"readouts": [{"label": "quantity", "expr": text}]}));
    assert_eq!(codes(json!({"controller": "data.xfrc_applied[2] = 20"})), ["world-element"]);
    assert_eq!(readout("0.5 * model.body_mass[0] * data.qvel[0] ** 2"), ["world-element"]);
    // Reported once, by the runs in which it is constant: see the examples of `constant-readout`.
    assert_eq!(readout("model.body_mass[0]"), Vec::<&str>::new());
    assert_eq!(readout("data.geom_xpos[2]"), ["local-position"]);
    assert_eq!(readout("model.site('tip').pos[2]"), ["local-position"]);
    for text in
        ["model.body_mass[1]", "data.geom_xpos[5]", "data.site('tip').xpos[2]", "data.geom('floor').xpos[2]"]
    {
        assert_eq!(readout(text), Vec::<&str>::new(), "{text}");
    }
}

#[test]
fn degrees_of_controls() {
    let slider = |parts: Value| {
        let mut control =
            json!({"label": "start", "min": 0, "max": 90, "step": 1, "value": 30, "init": true});
        control.as_object_mut().unwrap().extend(parts.as_object().unwrap().clone());
        codes(json!({"controls": [control], "setup": "data.qpos[0] = ctx.a || 0"}))
    };
    assert_eq!(slider(json!({"set": "data.qpos[0]"})), ["degrees-without-unit"]);
    assert_eq!(slider(json!({"apply": "data.joint('swing').qpos[0] = value"})), ["degrees-without-unit"]);
    assert_eq!(slider(json!({"param": "a"})), ["degrees-without-unit"]);
    assert_eq!(
        slider(json!({"unit": "rad", "apply": "data.qpos[0] = lib.rad(value)"})),
        ["degrees-without-unit"]
    );
    assert_eq!(
        slider(json!({"unit": "deg", "apply": "data.qpos[0] = Math.atan2(Math.sin(value / 2), 1)"})),
        ["degrees-for-radians"]
    );
    assert!(slider(json!({"unit": "deg", "apply": "data.qpos[0] = lib.rad(value)"})).is_empty());
    assert!(slider(json!({"set": "data.qpos[0]", "max": 3})).is_empty());
    assert!(slider(json!({"set": "data.qvel[0]"})).is_empty());
}
