//! Coupled parameters of a model: if a program changes one without the other, the finding contains the results of both runs and
//! a tested fix, and a claim that depends on it is not verified.

#![allow(clippy::unwrap_used, clippy::panic)]

use crate::support::check_text;
use labspec::finding::{Finding, Severity};
use labspec::verify::Verdict;
use serde_json::{Value as Json, json};

/// A ball that rolls down a ramp of 30°.
const RAMP: &str = "<mujoco><worldbody><geom type='plane' size='9 9 1' euler='0 30 0'/>
  <body name='ball' pos='.05 0 .0866025'><freejoint/><geom size='.1' mass='1'/></body></worldbody></mujoco>";
/// A cylinder on the same ramp.
const CYLINDER: &str = "<mujoco><worldbody><geom type='plane' size='9 9 1' euler='0 30 0'/>
  <body name='roller' pos='.05 0 .0866025'><freejoint/><geom type='cylinder' size='.1 .2' euler='90 0 0' mass='2'/></body></worldbody></mujoco>";
/// A body of radius R on a massless rod of 1 m.
const PENDULUM: &str = "<mujoco><worldbody><body pos='0 0 2'><joint axis='0 1 0'/>
  <geom size='RADIUS' pos='.6 0 -.8' mass='1'/></body></worldbody></mujoco>";
/// A rod that swings about its end.
const ROD: &str = "<mujoco><worldbody><body pos='0 0 2'><joint axis='0 1 0'/>
  <geom type='capsule' size='.02' fromto='0 0 0 .6 0 -.8' mass='1'/></body></worldbody></mujoco>";
/// A ball above a floor.
const DROP: &str = "<mujoco><worldbody><geom type='plane' size='9 9 1'/>
  <body pos='0 0 1'><freejoint/><geom size='.05' mass='1'/></body></worldbody></mujoco>";
/// A servo that holds an arm.
const SERVO: &str =
    "<mujoco><option gravity='0 0 0'/><worldbody><body><joint name='hinge' axis='0 1 0' damping='3'/>
  <geom type='capsule' size='.02' fromto='0 0 0 .5 0 0' mass='1'/></body></worldbody>
  <actuator><position joint='hinge' kp='10'/></actuator></mujoco>";

const MASS: &str = "model.body_mass[1] = value; mj.mj_setConst(model, data)";
const BOTH: &str = "const f = value / model.body_mass[1]; model.body_mass[1] = value; \
    for (let i = 3; i < 6; i++) model.body_inertia[i] *= f; mj.mj_setConst(model, data)";

/// The rules about coupled parameters and constants.
const RULES: [&str; 7] = [
    "mass-alone",
    "inertia-alone",
    "shape-alone",
    "gain-alone",
    "contype-alone",
    "missing-setconst",
    "claim-of-mismatch",
];

fn lab(xml: &str, controls: &Json, displayed: &str) -> Json {
    json!({"xml": xml, "stopAt": 1, "controls": controls, "readouts": [{"label": "shown (m/s)", "expr": displayed, "digits": 3}]})
}

fn slider(range: [f64; 3], action: &Json) -> Json {
    let mut control = json!({"label": "x", "min": range[0], "max": range[1], "step": 0.05, "value": range[2], "reset": true});
    control.as_object_mut().unwrap().extend(action.as_object().unwrap().clone());
    json!([control])
}

/// The findings of these rules.
fn found(lab: &Json) -> Vec<Finding> {
    let mut all = check_text("lab.json", &lab.to_string()).findings;
    all.retain(|f| RULES.contains(&f.code));
    all
}

fn codes(lab: &Json) -> Vec<&'static str> {
    found(lab).iter().map(|f| f.code).collect()
}

/// The results of both runs: the numbers before and after ", but ".
fn numbers(why: &str) -> (f64, f64) {
    let (before, after) = why.split_once(")\" is ").unwrap().1.split_once(", but ").unwrap();
    let first = |text: &str| {
        let word = text.split(' ').next().unwrap().trim_end_matches(',').replace('\u{2212}', "-");
        word.parse::<f64>().unwrap_or_else(|_| panic!("{why}"))
    };
    (first(before), first(after))
}

/// The only finding is a warning of this rule with a fix that must be requested; after the fix, there is no finding.
fn repaired(lab: &Json, code: &str) -> (f64, f64) {
    let all = found(lab);
    assert_eq!(all.iter().map(|f| f.code).collect::<Vec<_>>(), [code], "{all:#?}");
    let finding = &all[0];
    assert_eq!(finding.severity, Severity::Warning);
    let help = finding.help.as_ref().unwrap();
    assert!(help.contains("; in a test run, the lab then uses "), "{help}");
    let mut text = lab.to_string();
    let fix = finding.fix.clone().unwrap_or_else(|| panic!("no fix: {finding:?}"));
    assert_eq!(fix.applicability.as_str(), "unsafe");
    text.replace_range(fix.span, &fix.text);
    let after: Json = serde_json::from_str(&text).unwrap();
    assert_eq!(found(&after), [], "{text}");
    numbers(finding.why.as_ref().unwrap())
}

#[test]
fn a_ball_of_ten_times_the_mass_rolls_as_any_ball() {
    let lab_of = |apply: &str| {
        let speed = "Math.hypot(data.qvel[0], data.qvel[2])";
        lab(RAMP, &slider([1.0, 10.0, 1.0], &json!({"apply": apply})), speed)
    };
    let (alone, both) = repaired(&lab_of(MASS), "mass-alone");
    // g sin 30° t / (1 + I / (m r²)), with the inertia of one kilogram compared with that of ten.
    let speed = |inertia: f64| 9.81 * 0.5 / (1.0 + inertia);
    assert!((alone - speed(0.04)).abs() < 0.03 && (both - speed(0.4)).abs() < 0.03, "{alone} {both}");
    assert_eq!(codes(&lab_of(BOTH)), Vec::<&str>::new());
    // Independent of how the mass is written.
    for apply in [
        "model.body_mass.fill(value); mj.mj_setConst(model, data)",
        "for (let b = 1; b < model.nbody; b++) { model.body_mass[b] = value } mj.mj_setConst(model, data)",
        "const m = model.body_mass; m[1] = value; mj.mj_setConst(model, data);",
        "model.body('ball').mass[0] = value; mj.mj_setConst(model, data)",
        "if (value > 2) model.body_mass[1] = value; else model.body_mass[1] = 1; mj.mj_setConst(model, data)",
        // Changing only one of three moments does not give the inertia of a ball.
        "const f = value / model.body_mass[1]; model.body_mass[1] = value; model.body_inertia[3] *= f; mj.mj_setConst(model, data)",
    ] {
        assert!(codes(&lab_of(apply)).contains(&"mass-alone"), "{apply}: {:?}", found(&lab_of(apply)));
    }
}

#[test]
fn other_controls_are_checked_too() {
    let mut setup = lab(CYLINDER, &json!([]), "data.qvel[0]");
    setup["setup"] = json!("model.body_mass[1] = 20; mj.mj_setConst(model, data)");
    repaired(&setup, "mass-alone");
    let button = json!([{"type": "button", "label": "Load", "run": "model.body_mass[1] = 20"}]);
    let all = found(&lab(CYLINDER, &button, "data.qvel[0]"));
    let reported: Vec<&str> = all.iter().map(|f| f.code).collect();
    assert_eq!(reported, ["mass-alone", "missing-setconst"], "{all:#?}");
    let mut choice = slider(
        [0.0; 3],
        &json!({"apply": MASS, "type": "select", "options": [["light", 1], ["heavy", 10]], "value": 1}),
    );
    for key in ["min", "max", "step"] {
        choice[0].as_object_mut().unwrap().remove(key);
    }
    repaired(&lab(RAMP, &choice, "data.qvel[0]"), "mass-alone");
    let mut controller = lab(RAMP, &json!([]), "data.qvel[0]");
    controller["controller"] = json!("model.body_mass[1] = 1 + 9 * data.time");
    assert!(codes(&controller).contains(&"mass-alone"), "{:?}", found(&controller));
    // A function that another program has stored.
    let mut stored =
        lab(RAMP, &json!([{"type": "button", "label": "Load", "run": "ctx.heavy(10)"}]), "data.qvel[0]");
    stored["setup"] = json!("ctx.heavy = (m) => { model.body_mass[1] = m; }");
    assert!(codes(&stored).contains(&"mass-alone"), "{:?}", found(&stored));
}

#[test]
fn a_wrong_number_without_setconst_is_not_verified() {
    // The change of the constants alone has a smaller effect than that of the inertia.
    for xml in [RAMP, CYLINDER] {
        let lab = lab(xml, &slider([1.0, 10.0, 1.0], &json!({"set": "model.body_mass[1]"})), "data.qvel[0]");
        let all = found(&lab);
        for finding in &all {
            let help = finding.help.as_ref().unwrap();
            assert!(help.contains("model.body_inertia[i] *= model.body_mass[1] / m"), "{help}");
            assert!(finding.why.as_ref().unwrap().contains("the inertia that this mass has"), "{finding:?}");
        }
        assert!(all.iter().any(|f| f.code == "mass-alone"), "{all:#?}");
        assert!(all.iter().any(|f| f.code == "missing-setconst"), "{all:#?}");
    }
    let apply = json!({"apply": "model.body_mass[1] = value // kg"});
    let lab = lab(RAMP, &slider([1.0, 10.0, 1.0], &apply), "data.qvel[0]");
    let fix = found(&lab).into_iter().find_map(|f| f.fix).unwrap();
    let mut text = lab.to_string();
    text.replace_range(fix.span, &fix.text);
    assert_eq!(found(&serde_json::from_str(&text).unwrap()), [], "{text}");
}

#[test]
fn a_body_that_does_not_turn_has_no_partner_to_miss() {
    let mass = json!({"apply": MASS});
    // It falls without rotation; it spins without contact; its inertia is a thousandth of that of the pendulum.
    assert_eq!(codes(&lab(DROP, &slider([1.0, 10.0, 1.0], &mass), "data.qpos[2]")), Vec::<&str>::new());
    let mut thrown = lab(DROP, &slider([1.0, 10.0, 1.0], &mass), "data.qvel[3]");
    thrown["stopAt"] = json!(0.3);
    thrown["setup"] = json!("data.qvel[4] = 20; data.qvel[0] = 1");
    assert_eq!(codes(&thrown), Vec::<&str>::new());
    // Once it bounces, the spin deflects it.
    thrown["stopAt"] = json!(1);
    thrown["readouts"][0]["expr"] = json!("data.qvel[0]");
    repaired(&thrown, "mass-alone");
    let pendulum = |radius: &str| {
        let xml = PENDULUM.replace("RADIUS", radius);
        lab(&xml, &slider([1.0, 10.0, 1.0], &mass), "data.qpos[0]")
    };
    assert_eq!(codes(&pendulum(".005")), Vec::<&str>::new());
    repaired(&pendulum(".3"), "mass-alone");
    repaired(&lab(ROD, &slider([1.0, 10.0, 1.0], &mass), "data.qpos[0]"), "mass-alone");
}

#[test]
fn a_ramp_that_another_slider_tilts_is_tried() {
    let tilt = json!({"label": "tilt", "min": 0, "max": 30, "step": 1, "value": 0, "reset": true,
        "apply": "model.opt.gravity[0] = 9.81 * Math.sin(value * Math.PI / 180); model.opt.gravity[2] = -9.81 * Math.cos(value * Math.PI / 180)"});
    let mut controls = slider([1.0, 10.0, 1.0], &json!({"apply": MASS}));
    controls.as_array_mut().unwrap().push(tilt);
    let xml = RAMP.replace(" euler='0 30 0'", "").replace("pos='.05 0 .0866025'", "pos='0 0 .1'");
    let lab = lab(&xml, &controls, "data.qvel[0]");
    let why = found(&lab)[0].why.clone().unwrap();
    assert!(why.contains("with \"x\" at 10 and \"tilt\" at 30"), "{why}");
    repaired(&lab, "mass-alone");
}

#[test]
fn an_inertia_that_no_body_has() {
    let of = |apply: &str, max: f64| {
        let apply = json!({"apply": apply});
        codes(&lab(RAMP, &slider([0.004, max, 0.004], &apply), "data.qvel[0]"))
    };
    let all = "for (let i = 3; i < 6; i++) model.body_inertia[i] = value; mj.mj_setConst(model, data)";
    // A hollow ball has two thirds of m r², and a hoop has m r², which is the maximum.
    assert_eq!(of(all, 0.0099), Vec::<&str>::new());
    // A rolling body with a larger inertia needs a larger mass.
    assert_eq!(of(all, 0.5), ["inertia-alone"]);
    // On a hinge with gravity, the mass determines the swing.
    let swing = lab(ROD, &slider([0.1, 5.0, 0.1], &json!({"apply": all})), "data.qpos[0]");
    assert_eq!(codes(&swing), ["inertia-alone"]);
    // A mass and an inertia with separate sliders are chosen independently.
    let mut two = slider([1.0, 10.0, 1.0], &json!({"apply": MASS}));
    let other = json!({"label": "inertia", "min": 0.004, "max": 0.009, "step": 0.001, "value": 0.004, "reset": true, "apply": all.replace("for (let i = 3; i < 6; i++) model.body_inertia[i] = value", "model.body_inertia[3] = value; model.body_inertia[4] = value; model.body_inertia[5] = value")});
    two.as_array_mut().unwrap().push(other);
    assert_eq!(codes(&lab(RAMP, &two, "data.qvel[0]")), Vec::<&str>::new());
}

#[test]
fn a_size_takes_its_bounds_and_its_inertia_along() {
    let size = |xml: &str, apply: &str, displayed: &str| {
        lab(xml, &slider([0.05, 0.3, 0.05], &json!({"apply": apply})), displayed)
    };
    let finding = found(&size(DROP, "model.geom_size[3] = value", "data.qpos[2]")).remove(0);
    assert!(finding.message.contains("but not `model.geom_rbound`"), "{finding:?}");
    let (alone, both) = repaired(&size(DROP, "model.geom_size[3] = value", "data.qpos[2]"), "shape-alone");
    // The ball rests at its radius, or deeper if its bounding volume is too small.
    assert!(both > 0.25 && alone < 0.2, "{alone} {both}");
    let right = "model.geom_size[3] = value; model.geom_rbound[1] = value";
    assert_eq!(codes(&size(DROP, right, "data.qpos[2]")), Vec::<&str>::new());
    // A roller with the same mass and another radius has another inertia.
    let turned = DROP.replace("size='.05' mass='1'", "type='cylinder' size='.05 .1' euler='90 0 0' mass='1'");
    let mut rolls = size(
        &turned,
        "model.geom_size[3] = value; model.geom_rbound[1] = Math.hypot(value, 0.1)",
        "data.qvel[4]",
    );
    rolls["setup"] = json!("data.qpos[2] = model.geom_size[3]; data.qvel[0] = 2");
    rolls["stopAt"] = json!(0.2);
    let finding = found(&rolls).remove(0);
    assert!(finding.message.ends_with("but not `model.body_inertia`"), "{finding:?}");
    repaired(&rolls, "shape-alone");
    // The bob of a pendulum moves the centre of mass.
    let bob = lab(
        &PENDULUM.replace("RADIUS", ".05"),
        &slider([0.3, 0.9, 0.6], &json!({"apply": "model.geom_pos[0] = value; mj.mj_setConst(model, data)"})),
        "data.qpos[0]",
    );
    let finding = found(&bob).remove(0);
    assert!(finding.message.contains("but not `model.body_ipos`"), "{finding:?}");
    repaired(&bob, "shape-alone");
}

#[test]
fn a_geom_that_is_switched_on_takes_its_body_along() {
    let button = |xml: &str, run: &str| {
        lab(xml, &json!([{"type": "button", "label": "solid", "run": run}]), "data.qpos[2]")
    };
    let off = DROP.replace("mass='1'", "mass='1' contype='0' conaffinity='0'");
    for run in ["model.geom_contype[1] = 1", "model.geom_contype.fill(1)", "model.geom_conaffinity[1] = 1"] {
        let (alone, both) = repaired(&button(&off, run), "contype-alone");
        assert!(alone < -2.0 && (both - 0.05).abs() < 0.01, "{run}: {alone} {both}");
    }
    let right = "model.geom_contype[1] = 1; model.body_contype[1] = 1";
    assert_eq!(codes(&button(&off, right)), Vec::<&str>::new());
    // Toggling, and disabling, are complete changes.
    let run = "model.geom_contype[1] = 1 - model.geom_contype[1]; model.geom_conaffinity[1] = model.geom_contype[1]";
    assert_eq!(codes(&button(DROP, run)), Vec::<&str>::new());
    // In a body with several geoms, the bounding volumes of the body matter as well.
    let two = off.replace("</body>", "<geom size='.01' pos='0 0 .1' mass='0'/></body>");
    let (alone, both) = repaired(&button(&two, "model.geom_contype[1] = 1"), "contype-alone");
    assert!(alone < 0.0 && both > 0.0, "{alone} {both}");
}

#[test]
fn a_servo_reaches_its_target_with_every_gain() {
    let servo = |xml: &str, apply: &str| {
        let mut lab = lab(xml, &slider([10.0, 30.0, 10.0], &json!({"apply": apply})), "data.qpos[0]");
        lab["setup"] = json!("data.ctrl[0] = 0.5");
        lab["stopAt"] = json!(2);
        lab
    };
    let (alone, both) = repaired(&servo(SERVO, "model.actuator_gainprm[0] = value"), "gain-alone");
    assert!((both - 0.5).abs() < 0.01 && alone > 1.0, "{alone} {both}");
    repaired(&servo(SERVO, "model.actuator_biasprm[1] = -value"), "gain-alone");
    let right = "model.actuator_gainprm[0] = value; model.actuator_biasprm[1] = -value";
    assert_eq!(codes(&servo(SERVO, right)), Vec::<&str>::new());
    // Damping is not coupled to stiffness.
    assert_eq!(codes(&servo(SERVO, "model.actuator_biasprm[2] = -value")), Vec::<&str>::new());
    let velocity = SERVO.replace("position joint='hinge' kp='10'", "velocity joint='hinge' kv='10'");
    repaired(&servo(&velocity, "model.actuator_gainprm[0] = value"), "gain-alone");
    // A motor has no bias.
    let motor = SERVO.replace("position joint='hinge' kp='10'", "motor joint='hinge'");
    assert_eq!(codes(&servo(&motor, "model.actuator_gainprm[0] = value")), Vec::<&str>::new());
}

/// A lesson about a ball on a ramp, with claims.
fn lesson(apply: &str, lint: &str, verify: &str, question: &str) -> String {
    let mut lab = lab(
        RAMP,
        &slider([1.0, 10.0, 1.0], &json!({"apply": apply})),
        "Math.hypot(data.qvel[0], data.qvel[2])",
    );
    if !lint.is_empty() {
        lab["lint"] = json!({"allow": [lint], "why": "this lesson is about it"});
    }
    format!(
        "The ball reaches 4.72 m/s.\n\n```lab simlab\n{lab}\n```\n\n```quiz\n{{\"id\": \"ramp\", \"title\": \"Ramp\", \"questions\": [{{{question}, \
         \"explain\": \"It weighs more.\", \"verify\": {{\"lab\": \"#1\", {verify}}}}}]}}\n```\n"
    )
}

const KEY: &str = r#""kind": "mcq", "q": "Which ball is faster after a second?", "options": ["The heavy one rolls faster", "Both are as fast"], "answer": 0"#;
const RUNS: &str = r#""runs": {"light": {"set": {"x": 1}}, "heavy": {"set": {"x": 10}}}, "measure": {"v": "final(Math.hypot(data.qvel[0], data.qvel[2]))"}"#;
const FASTER: &str = r#""options": ["heavy.v > 1.2 * light.v", "abs(heavy.v - light.v) < 0.05"]"#;

/// The verdict of the question, and the codes of the findings.
fn judged(text: &str) -> (Verdict, Vec<&'static str>) {
    let checked = check_text("lesson.md", text);
    let mut codes: Vec<&str> = checked.findings.iter().map(|f| f.code).collect();
    codes.retain(|code| RULES.contains(code) || *code == "answer-refuted");
    let answers = checked.claims.iter().filter_map(|c| c.judgement.answer.as_ref());
    (answers.map(|a| a.verdict).next().unwrap(), codes)
}

#[test]
fn a_claim_of_a_body_that_does_not_exist_is_refuted() {
    let verify = format!("{RUNS}, {FASTER}");
    let (verdict, codes) = judged(&lesson(MASS, "", &verify, KEY));
    assert_eq!((verdict, codes), (Verdict::Refuted, vec!["mass-alone", "claim-of-mismatch"]));
    let right = KEY.replace("\"answer\": 0", "\"answer\": 1");
    assert_eq!(judged(&lesson(BOTH, "", &verify, &right)), (Verdict::Verified, vec![]));
    assert_eq!(judged(&lesson(BOTH, "", &verify, KEY)).0, Verdict::Refuted);
    // The finding names the run and the control, and contains both results.
    let checked = check_text("lesson.md", &lesson(MASS, "", &verify, KEY));
    let finding = checked.findings.iter().find(|f| f.code == "claim-of-mismatch").unwrap();
    let why = finding.why.as_ref().unwrap();
    assert!(
        finding.message.contains("\"x\"") && why.contains("in the run `heavy`") && why.contains("4.71"),
        "{finding:?}"
    );
    assert!(why.contains("3.50"), "{why}");
    // A sweep of the control, and the setup of a run.
    let swept = r#""runs": {"run": {"sweep": {"x": [1, 10]}}}, "measure": {"v": "final(data.qvel[0])"}, "options": ["run.v[1] > 1.2 * run.v[0]", "abs(run.v[1] - run.v[0]) < 0.05"]"#;
    let (verdict, codes) = judged(&lesson(MASS, "", swept, KEY));
    assert_eq!(verdict, Verdict::Refuted, "{codes:?}");
    let verify = verify
        .replace(r#""set": {"x": 10}"#, r#""setup": "model.body_mass[1] = 10; mj.mj_setConst(model, data)""#);
    let (verdict, codes) = judged(&lesson(BOTH, "", &verify, KEY));
    assert_eq!((verdict, codes), (Verdict::Refuted, vec!["mass-alone", "claim-of-mismatch"]));
}

#[test]
fn a_change_of_an_explicit_inertia_is_checked_too() {
    let xml = RAMP.replace(
        "<geom size='.1' mass='1'/>",
        "<inertial pos='0 0 0' mass='1' diaginertia='.004 .004 .004'/><geom size='.1'/>",
    );
    let of = |xml: &str, change: &str| {
        let runs = format!(
            r#""runs": {{"light": {{}}, "heavy": {{"model": {change}}}}}, "measure": {{"v": "final(data.qvel[0])"}}"#
        );
        // A slider that does not change the mass.
        let text = lesson("model.opt.gravity[1] = 0 * value", "", &format!("{runs}, {FASTER}"), KEY);
        judged(&text.replace(&serde_json::to_string(RAMP).unwrap(), &serde_json::to_string(xml).unwrap()))
    };
    let codes = vec!["mass-alone", "claim-of-mismatch"];
    assert_eq!(of(&xml, r#"{"inertial mass": 10}"#), (Verdict::Refuted, codes));
    // If the mass of a geom changes, the inertia is computed from it.
    let (verdict, codes) = of(RAMP, r#"{"body ball geom mass": 10}"#);
    assert!(verdict != Verdict::Verified && !codes.contains(&"claim-of-mismatch"), "{codes:?}");
    let both = r#"{"inertial mass": 10, "inertial diaginertia": "0.04 0.04 0.04"}"#;
    assert_eq!(of(&xml, both), (Verdict::Refuted, vec!["answer-refuted"]));
}

#[test]
fn a_claim_that_holds_with_and_without_the_correction_states_it() {
    let verify = format!("{RUNS}, {}", r#""options": ["heavy.v > 3", "heavy.v < 2"]"#);
    let checked = check_text("lesson.md", &lesson(MASS, "", &verify, KEY));
    let answer = checked.claims.iter().find_map(|c| c.judgement.answer.clone()).unwrap();
    assert_eq!(answer.verdict, Verdict::Verified);
    assert!(answer.reason.contains("also true with the inertia that this mass has"), "{}", answer.reason);
}

#[test]
fn quotes_and_closed_forms_are_judged_twice() {
    let says = format!("{RUNS}, {}", r#""says": [["4.72 m/s", "heavy.v"]]"#);
    let open = r#""kind": "open", "q": "How fast is it?""#;
    let of = |apply: &str| {
        let checked = check_text("lesson.md", &lesson(apply, "", &says, open));
        checked.claims.iter().flat_map(|c| c.judgement.quotes.clone()).map(|q| q.verdict()).next().unwrap()
    };
    assert_eq!([of(MASS), of(BOTH)], ["refuted", "refuted"]);
    let right = format!("{RUNS}, {}", r#""says": [["4.72 m/s", "heavy.v"]]"#);
    let allowed = check_text("lesson.md", &lesson(MASS, "mass-alone", &right, open));
    let quote = allowed.claims.iter().flat_map(|c| c.judgement.quotes.clone()).next().unwrap();
    assert_eq!(quote.verdict(), "verified", "{}", quote.reason);
    // A closed form of a lab whose setup makes the ball heavier.
    let mut lab = lab(RAMP, &json!([]), "data.qvel[0]");
    lab["setup"] = json!("model.body_mass[1] = 10; mj.mj_setConst(model, data)");
    lab["plots"] = json!([{"traces": [{"label": "v", "expr": "data.qvel[0]"}]}]);
    lab["verify"] =
        json!({"exact": {"v": {"is": "4.905 * Math.cos(Math.PI / 6) / 1.04 * data.time", "tol": 0.03}}});
    let checked = check_text("lab.json", &lab.to_string());
    let state = checked.claims[0].judgement.exact[0].clone();
    assert!(
        checked.findings.iter().any(|f| f.code == "claim-of-mismatch"),
        "{state:?} {:#?}",
        checked.findings
    );
}

#[test]
fn an_intended_difference_is_not_refuted() {
    let text = "The heavy ball is another one.";
    let runs = format!(
        r#""runs": {{"forgotten": {{"setup": "model.body_mass[1] = 10; mj.mj_setConst(model, data)"}}, "right": {{"setup": "{}"}}}}, "measure": {{"v": "final(data.qvel[0])"}}, "options": ["forgotten.v > 1.2 * right.v", "abs(forgotten.v - right.v) < 0.05"]"#,
        BOTH.replace("value", "10")
    );
    let (verdict, codes) = judged(&lesson(BOTH, "", &runs, KEY));
    assert_eq!((verdict, codes), (Verdict::Verified, vec![]), "{text}");
    // An author who has reviewed it, and suppresses the finding.
    let verify = format!("{RUNS}, {FASTER}");
    assert_eq!(judged(&lesson(MASS, "mass-alone", &verify, KEY)), (Verdict::Verified, vec![]));
}
