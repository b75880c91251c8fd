//! What the runs of a lab show about its controls and readouts: sliders that another one overwrites, readouts that cannot change, and
//! decimals that depend on the timestep.

#![allow(clippy::unwrap_used, clippy::panic)]

use labspec::bind::scene::Models;
use labspec::check::{self, CheckLevel};
use labspec::lint::{ModelFolder, load_lesson};
use labspec::source::SourceFile;

/// The findings of a lab with these codes.
fn findings(model: &str, keys: &str, codes: &[&str]) -> Vec<labspec::Finding> {
    let text = format!("```lab simlab\n{{\"xml\": {}, {keys}}}\n```\n", serde_json::json!(model));
    let folder = ModelFolder::unknown();
    let lesson = load_lesson(SourceFile::new("t.md", text), &folder);
    let depth = CheckLevel { programs: true, labs: true, claims: false };
    let found = check::check_lesson(lesson, &Models::new(folder), depth).findings;
    let errors: Vec<_> = found.iter().filter(|f| f.is_error()).collect();
    assert!(errors.is_empty(), "{keys}: {errors:#?}");
    found.into_iter().filter(|f| codes.contains(&f.code)).collect()
}

fn messages(model: &str, keys: &str, codes: &[&str]) -> Vec<String> {
    findings(model, keys, codes).into_iter().map(|f| f.message).collect()
}

const CARTS: &str = "<mujoco><worldbody><body name='one'><joint type='slide' axis='1 0 0'/><geom size='.05' mass='1'/></body>\
    <body name='two' pos='0 1 0'><joint type='slide' axis='1 0 0'/><geom size='.05' mass='1'/></body></worldbody></mujoco>";

/// The second of two sliders overwrites the mass that the first one sets, whatever else both of them do.
#[test]
fn a_second_slider_that_writes_the_same_mass_is_reported() {
    let lab = |first: &str, second: &str| {
        let slider = |label: &str, value: f64, text: &str| serde_json::json!({"label": label, "min": 0.5, "max": 2, "value": value, "apply": text, "reset": true});
        let keys = format!(
            "\"stopAt\": 1, \"setup\": \"data.qfrc_applied[0] = 1; data.qfrc_applied[1] = 2\", \"controls\": [{}, {}], \
             \"readouts\": [{{\"label\": \"speeds\", \"expr\": \"data.qvel[0] + data.qvel[1]\"}}]",
            slider("first", 1.0, first),
            slider("second", 1.5, second)
        );
        messages(CARTS, &keys, &["overruled"])
    };
    let set = |body: usize, more: &str| format!("model.body_mass[{body}] = value{more}");
    for more in ["", "; mj.mj_setConst(model, data)", "; mj.mj_forward(model, data)", "; ctx.last = value"] {
        let found = lab(&set(2, more), &set(2, more));
        assert_eq!(found, ["the lab does not start with the value of \"first\""], "{more}");
        assert_eq!(lab(&set(1, more), &set(2, more)), Vec::<String>::new(), "{more}");
    }
}

const BALL: &str = "<mujoco><worldbody><geom name='floor' type='plane' size='1 1 1'/><body name='ball' pos='0 0 1'><freejoint/>\
    <geom name='ball' size='.05' mass='1'/></body></worldbody></mujoco>";

#[test]
fn readouts_that_can_never_change_are_reported() {
    let readout = |model: &str, label: &str, expr: &str, more: &str| {
        let readout = serde_json::json!({"label": label, "expr": expr});
        messages(model, &format!("\"stopAt\": 0.4, {more}\"readouts\": [{readout}]"), &["constant-readout"])
    };
    for (label, expr) in [
        ("energy (J)", "data.energy[0] + data.energy[1]"),
        ("height of the ball (m)", "data.xpos[2]"),
        ("mass of the ball (kg)", "model.body_mass[0]"),
        ("upright", "data.xmat[8].toFixed(1) * 1"),
    ] {
        assert_eq!(readout(BALL, label, expr, "").len(), 1, "{label}: {expr}");
    }
    let with_energy = BALL.replace("<worldbody>", "<option><flag energy='enable'/></option><worldbody>");
    assert!(readout(&with_energy, "energy (J)", "data.energy[0] + data.energy[1]", "").is_empty());
    let setup = "\"setup\": \"model.opt.enableflags = 2\", ";
    assert!(readout(BALL, "energy (J)", "data.energy[0] + data.energy[1]", setup).is_empty());
    for (label, expr) in [
        ("height of the ball (m)", "data.xpos[5]"),
        ("mass of the ball (kg)", "model.body_mass[1]"),
        // It is constant only because nothing pushes the ball.
        ("x (m)", "data.qpos[0]"),
        ("height of the world (m)", "data.xpos[2]"),
        ("xpos[2]", "data.xpos[2]"),
        ("height above the floor (m)", "data.xpos[5] - data.xpos[2]"),
        ("total mass (kg)", "model.body_subtreemass[0]"),
        ("centre of mass (m)", "data.subtree_com[2]"),
    ] {
        assert_eq!(readout(BALL, label, expr, ""), Vec::<String>::new(), "{label}: {expr}");
    }
}

/// The proposed number of decimals makes the two quoted numbers equal, or nothing is proposed.
#[test]
fn proposed_decimals_hold_for_the_quoted_numbers() {
    let bouncing = "<mujoco><option timestep='0.002' integrator='RK4'/><worldbody><geom name='floor' type='plane' size='1 1 .1'/>\
        <body name='ball' pos='0 0 1'><freejoint name='ball'/><geom name='ball' size='.05' mass='.1' solref='-20000 -10'/></body>\
        </worldbody></mujoco>";
    let mut proposed = 0;
    for (model, stop, expr, digits) in [
        (bouncing, 3.0, "3.6 * Math.abs(data.qvel[2])", 3),
        (bouncing, 3.0, "data.qpos[2]", 6),
        (BALL, 0.4, "data.qpos[2]", 6),
        (BALL, 0.4, "100 * data.qpos[2]", 5),
    ] {
        let readout = serde_json::json!({"label": "x", "expr": expr, "digits": digits});
        let keys = format!("\"stopAt\": {stop}, \"readouts\": [{readout}]");
        let found = findings(model, &keys, &["too-many-digits"]);
        let [finding] = found.as_slice() else { panic!("{expr}: {found:#?}") };
        let why = finding.why.as_deref().unwrap();
        let (first, second) = why.split_once(" it is ").unwrap().1.split_once(", but ").unwrap();
        let [first, second] = [first, second.split(' ').next().unwrap()].map(|x| x.parse::<f64>().unwrap());
        let help = finding.help.as_deref().unwrap();
        let Some(n) = help.split_once("\"digits\": ").map(|(_, rest)| rest.split(',').next().unwrap()) else {
            assert!(finding.message.contains("all of them"), "{}", finding.message);
            continue;
        };
        let n: usize = n.parse().unwrap();
        assert_eq!(format!("{first:.n$}"), format!("{second:.n$}"), "{why}: {help}");
        proposed += 1;
    }
    assert!(proposed >= 2, "{proposed}");
}
