//! Random labs: a few families, each with random parameters, two runs, their measures, and the measures
//! that are known by a formula.

use crate::support::random::Random;
use serde_json::{Value, json};

/// A measure of a run.
#[derive(Clone, Copy)]
pub(super) struct Measure {
    pub(super) name: &'static str,
    pub(super) expr: &'static str,
    /// Its unit; empty for a number without one.
    pub(super) unit: &'static str,
    /// Whether it can never be negative.
    pub(super) positive: bool,
}

const fn measure(name: &'static str, expr: &'static str, unit: &'static str, positive: bool) -> Measure {
    Measure { name, expr, unit, positive }
}

/// Closed forms: the label of a trace, a formula that the trace follows, and formulas that it does not follow.
pub(super) struct Form {
    pub(super) trace: &'static str,
    pub(super) right: String,
    pub(super) wrong: Vec<String>,
}

/// A measure of one run as a formula of one slider: `value = factor * slider ^ power`, over a range of the slider.
pub(super) struct Law {
    pub(super) slider: &'static str,
    pub(super) measure: &'static str,
    pub(super) expr: &'static str,
    pub(super) factor: f64,
    pub(super) power: f64,
    pub(super) range: [f64; 2],
    pub(super) until: f64,
}

pub(super) struct Scene {
    pub(super) family: &'static str,
    pub(super) lab: Value,
    /// The runs `one` and `two`.
    pub(super) runs: Value,
    pub(super) measures: Vec<Measure>,
    pub(super) forms: Vec<Form>,
    pub(super) law: Option<Law>,
}

/// Measures of events that never happen: they and all numbers computed from them are NaN.
pub(super) const NEVER: [Measure; 3] = [
    measure("never", "first(data.time > 1000)", "s", true),
    measure("nowhere", "crossing(data.qpos[0], 1000)", "s", true),
    measure("unseen", "at(data.qvel[0] > 1e6, data.qpos[0])", "", false),
];

fn slider(label: &str, unit: &str, ends: [f64; 2], step: f64, value: f64, apply: &str) -> Value {
    json!({"label": label, "unit": unit, "min": ends[0], "max": ends[1], "step": step, "value": value, "apply": apply, "reset": true})
}

/// A slider that changes only the appearance of a lab.
fn colour() -> Value {
    slider("colour", "", [0.0, 1.0], 0.1, 0.5, "model.geom_rgba[0] = value")
}

/// A slider for gravity, as a positive number.
fn gravity() -> Value {
    slider("g", "m/s^2", [1.0, 20.0], 0.01, 9.81, "model.opt.gravity[2] = -value")
}

pub(super) fn scene(random: &mut Random) -> Scene {
    match random.below(7) {
        0 => fall(random),
        1 => throw(random),
        2 => pendulum(random),
        3 => spring(random, false),
        4 => spring(random, true),
        5 => block(random),
        _ => servo(random),
    }
}

fn lab(title: &str, xml: &str, controls: Value, traces: Value) -> Value {
    json!({"title": title, "xml": xml, "controls": controls, "plots": [{"traces": traces}], "stopAt": 1.5})
}

fn fall(random: &mut Random) -> Scene {
    let height = random.between(0.5, 2.0, 150);
    let mass = random.between(0.2, 3.0, 28);
    let g = random.between(3.0, 8.0, 500);
    let xml = format!(
        "<mujoco><worldbody><geom name='floor' type='plane' size='3 3 1'/><body name='ball' pos='0 0 {height}'><freejoint/>\
         <geom name='ball' type='sphere' size='0.05' mass='{mass}'/></body></worldbody></mujoco>"
    );
    let until = (1.5 * (2.0 * height / g).sqrt()).min(3.0);
    let until = (until * 100.0).round() / 100.0;
    Scene {
        family: "a ball falls",
        lab: lab(
            "A ball falls",
            &xml,
            json!([gravity(), colour()]),
            json!([{"label": "height", "expr": "data.qpos[2]"}]),
        ),
        runs: json!({"one": {"until": until}, "two": {"set": {"g": g}, "until": until}}),
        measures: vec![
            measure("touch", "first(contact('ball', 'floor'))", "s", true),
            measure("speed", "max(-data.qvel[2])", "m/s", false),
            measure("start", "initial(data.qpos[2])", "m", false),
            measure("middle", "mean(data.qpos[2])", "m", false),
            measure("hits", "count(contact('ball', 'floor'))", "", true),
        ],
        forms: Vec::new(),
        law: Some(Law {
            slider: "g",
            measure: "touch",
            expr: "first(contact('ball', 'floor'))",
            factor: (2.0 * (height - 0.05)).sqrt(),
            power: -0.5,
            range: [6.0, 14.0],
            until: 1.5,
        }),
    }
}

fn throw(random: &mut Random) -> Scene {
    let height = random.between(0.5, 2.0, 150);
    let up = random.between(1.0, 4.0, 300);
    let other = random.between(3.0, 18.0, 1500);
    let xml = format!(
        "<mujoco><worldbody><body name='ball' pos='0 0 {height}'><freejoint/><geom name='ball' type='sphere' size='0.05' mass='1'/>\
         </body></worldbody></mujoco>"
    );
    let mut made = lab(
        "A ball is thrown",
        &xml,
        json!([gravity(), colour()]),
        json!([{"label": "height", "expr": "data.qpos[2]"}, {"label": "speed", "expr": "data.qvel[2]"}]),
    );
    made["setup"] = json!(format!("data.qvel[2] = {up}"));
    let height_at = |sign: &str, half: f64, up: f64| {
        format!("{height} + {up} * data.time {sign} {half} * 9.81 * data.time ** 2")
    };
    Scene {
        family: "a ball is thrown",
        lab: made,
        runs: json!({"one": {"until": 1.5}, "two": {"set": {"g": other}, "until": 1.5}}),
        measures: vec![
            measure("top", "max(data.qpos[2])", "m", false),
            measure("when", "crossing(data.qvel[2])", "s", true),
            measure("fast", "max(-data.qvel[2])", "m/s", false),
            measure("low", "final(data.qpos[2])", "m", false),
            measure("mean", "mean(data.qpos[2])", "m", false),
        ],
        forms: vec![
            Form {
                trace: "height",
                right: height_at("-", 0.5, up),
                wrong: vec![
                    height_at("+", 0.5, up),
                    height_at("-", 1.0, up),
                    height_at("-", 0.5, -up),
                    height_at("-", 0.5, 1.1 * up),
                    height_at("-", 0.51, up),
                    "0".into(),
                    format!("{height}"),
                ],
            },
            Form {
                trace: "speed",
                right: format!("{up} - 9.81 * data.time"),
                wrong: vec![
                    format!("{up} + 9.81 * data.time"),
                    format!("{up} - 9.18 * data.time"),
                    format!("-{up} - 9.81 * data.time"),
                    format!("-({up} - 9.81 * data.time)"),
                    "0".into(),
                    format!("{up}"),
                ],
            },
        ],
        law: Some(Law {
            slider: "g",
            measure: "when",
            expr: "crossing(data.qvel[2])",
            factor: up,
            power: -1.0,
            range: [6.0, 14.0],
            until: 1.0,
        }),
    }
}

fn pendulum(random: &mut Random) -> Scene {
    let length = random.between(0.3, 1.0, 70);
    let angle = random.between(0.2, 1.5, 130);
    let g = random.between(3.0, 18.0, 1500);
    let xml = format!(
        "<mujoco><worldbody><body name='rod'><joint name='pin' type='hinge' axis='0 1 0'/>\
         <geom type='capsule' fromto='0 0 0 0 0 -{length}' size='0.02' mass='1'/></body></worldbody></mujoco>"
    );
    let mut made = lab(
        "A pendulum",
        &xml,
        json!([gravity(), colour()]),
        json!([{"label": "angle", "expr": "data.qpos[0]"}]),
    );
    made["setup"] = json!(format!("data.qpos[0] = {angle}"));
    Scene {
        family: "a pendulum swings",
        lab: made,
        runs: json!({"one": {"until": 2.5}, "two": {"set": {"g": g}, "until": 2.5}}),
        measures: vec![
            measure("upright", "crossing(data.qpos[0])", "s", true),
            measure("fastest", "max(abs(data.qvel[0]))", "rad/s", true),
            measure("swing", "initial(data.qpos[0])", "rad", false),
            measure("size", "rms(data.qpos[0])", "rad", true),
            measure("back", "min(data.qvel[0])", "rad/s", false),
        ],
        forms: vec![Form {
            trace: "angle",
            right: String::new(),
            wrong: vec![
                "0".into(),
                format!("{angle}"),
                format!("{angle} * Math.cos(data.time)"),
                format!("-{angle} * Math.cos(9 * data.time)"),
            ],
        }],
        law: None,
    }
}

fn spring(random: &mut Random, damped: bool) -> Scene {
    let mass = random.between(0.5, 2.0, 15);
    let stiffness = random.between(20.0, 120.0, 100);
    let start = random.between(0.1, 0.5, 40);
    let damping = if damped { random.between(0.5, 2.0, 15) } else { 0.0 };
    let other = random.between(10.0, 150.0, 140);
    let xml = format!(
        "<mujoco><option timestep='0.001' gravity='0 0 0'/><worldbody><body name='cart'><joint name='rail' type='slide' axis='1 0 0' \
         stiffness='{stiffness}' damping='{damping}'/><geom type='box' size='0.1 0.1 0.1' mass='{mass}'/></body></worldbody></mujoco>"
    );
    let mut made = lab(
        "A mass on a spring",
        &xml,
        json!([
            slider("stiffness", "N/m", [10.0, 150.0], 1.0, stiffness, "model.jnt_stiffness[0] = value"),
            colour()
        ]),
        json!([{"label": "place", "expr": "data.qpos[0]"}]),
    );
    made["setup"] = json!(format!("data.qpos[0] = {start}"));
    let decay = damping / (2.0 * mass);
    let turn = (stiffness / mass - decay * decay).sqrt();
    let form = |start: f64, turn: f64, decay: f64| {
        format!(
            "{start} * Math.exp(-{decay} * data.time) * (Math.cos({turn} * data.time) + {} * Math.sin({turn} * data.time))",
            decay / turn
        )
    };
    Scene {
        family: if damped { "a mass on a damped spring" } else { "a mass on a spring" },
        lab: made,
        runs: json!({"one": {"until": 1.5}, "two": {"set": {"stiffness": other}, "until": 1.5}}),
        measures: vec![
            measure("through", "crossing(data.qpos[0])", "s", true),
            measure("fastest", "max(abs(data.qvel[0]))", "m/s", true),
            measure("far", "min(data.qpos[0])", "m", false),
            measure("first", "initial(data.qpos[0])", "m", false),
            measure("size", "rms(data.qpos[0])", "m", true),
        ],
        forms: vec![Form {
            trace: "place",
            right: form(start, turn, decay),
            wrong: vec![
                form(-start, turn, decay),
                form(start, 1.1 * turn, decay),
                form(start, 0.5 * turn, decay),
                form(start, 2.0 * turn, decay),
                form(1.1 * start, turn, decay),
                form(start, turn, decay + 0.5),
                format!("{start} * Math.sin({turn} * data.time)"),
                "0".into(),
                format!("{start}"),
            ],
        }],
        law: (!damped).then_some(Law {
            slider: "stiffness",
            measure: "through",
            expr: "crossing(data.qpos[0])",
            factor: std::f64::consts::FRAC_PI_2 * mass.sqrt(),
            power: -0.5,
            range: [20.0, 100.0],
            until: 1.5,
        }),
    }
}

fn block(random: &mut Random) -> Scene {
    let friction = random.between(0.2, 0.6, 40);
    let speed = random.between(1.0, 2.5, 150);
    let other = random.between(0.2, 0.8, 60);
    let xml = format!(
        "<mujoco><worldbody><geom name='floor' type='plane' size='9 9 1' friction='{friction}' /><body name='block' pos='0 0 0.1'>\
         <joint name='x' type='slide' axis='1 0 0'/><joint name='z' type='slide' axis='0 0 1'/>\
         <geom name='block' type='box' size='0.1 0.1 0.1' mass='1' friction='0.01'/></body></worldbody></mujoco>"
    );
    let mut made = lab(
        "A block slides",
        &xml,
        json!([
            slider("friction", "", [0.2, 0.8], 0.01, friction, "model.geom_friction[0] = value"),
            colour()
        ]),
        json!([{"label": "place", "expr": "data.qpos[0]"}]),
    );
    made["setup"] = json!(format!("data.qvel[0] = {speed}"));
    Scene {
        family: "a block slides",
        lab: made,
        runs: json!({"one": {"until": 1.5}, "two": {"set": {"friction": other}, "until": 1.5}}),
        measures: vec![
            measure("way", "final(data.qpos[0])", "m", false),
            measure("begin", "initial(data.qvel[0])", "m/s", false),
            measure("slow", "first(data.qvel[0] < 0.5)", "s", true),
            measure("mean", "mean(data.qvel[0])", "m/s", false),
        ],
        forms: vec![Form {
            trace: "place",
            right: String::new(),
            wrong: vec!["0".into(), format!("{speed} * data.time"), format!("-{speed} * data.time")],
        }],
        law: None,
    }
}

fn servo(random: &mut Random) -> Scene {
    let gain = random.between(20.0, 100.0, 80);
    let target = random.between(0.2, 1.0, 80);
    let other = random.between(-1.0, -0.2, 80);
    let damping = random.between(3.0, 8.0, 50);
    let xml = format!(
        "<mujoco><option gravity='0 0 0'/><worldbody><body name='cart'><joint name='rail' type='slide' axis='1 0 0' damping='{damping}'/>\
         <geom type='box' size='0.1 0.1 0.1' mass='1'/></body></worldbody><actuator><position name='servo' joint='rail' kp='{gain}'/>\
         </actuator></mujoco>"
    );
    Scene {
        family: "a cart with a servo",
        lab: lab(
            "A cart with a servo",
            &xml,
            json!([slider("target", "m", [-1.0, 1.0], 0.01, target, "data.ctrl[0] = value"), colour()]),
            json!([{"label": "place", "expr": "data.qpos[0]"}]),
        ),
        runs: json!({"one": {"until": 1.2}, "two": {"set": {"target": other}, "until": 1.2}}),
        measures: vec![
            measure("final", "final(data.qpos[0])", "m", false),
            measure("fastest", "max(abs(data.qvel[0]))", "m/s", true),
            measure("when", "peak(abs(data.qvel[0]))", "s", true),
            measure("mean", "mean(data.qpos[0])", "m", false),
        ],
        forms: vec![Form {
            trace: "place",
            right: String::new(),
            wrong: vec![
                "0".into(),
                format!("{target}"),
                format!("{target} * data.time"),
                format!("-{target} * (1 - Math.exp(-data.time))"),
            ],
        }],
        law: None,
    }
}
