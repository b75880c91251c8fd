//! The dimensions of all expressions of real labs, or `unknown`. No correct label of these labs is reported as wrong.

#![allow(clippy::unwrap_used, clippy::panic)]

use crate::mutants::material::{self, PieceKind};
use crate::needs::needs;
use labspec::bind::scene::Models;
use labspec::bind::{ModelNames, Programs, Scope};
use labspec::check::{self, CheckLevel};
use labspec::lint::{ModelFolder, load_lesson};
use labspec::source::SourceFile;
use labspec_bind::units::written;
use labspec_expr::Schema;
use labspec_expr::dimension::Measure;
use std::fmt::Write;

const CODES: [&str; 5] =
    ["label-unit", "mixed-dimensions", "label-names-another", "degrees-for-radians", "quaternion-as-angle"];

fn word(measure: &Measure) -> String {
    match measure {
        Measure::Anything => "a number of the text".into(),
        Measure::Dimension(d) => written(d),
        Measure::Unknown => "unknown".into(),
    }
}

#[test]
fn every_expression_has_a_dimension_or_is_unknown() {
    if !needs("../shared/corpus") {
        return;
    }
    let models = material::models();
    let (mut page, mut certain, mut loose, mut literal, mut unknown) = (String::new(), 0, 0, 0, 0);
    for piece in material::pieces().iter().filter(|p| p.what == PieceKind::Lab) {
        let models = &models[piece.models];
        let (name, text) = piece.file(&piece.json);
        let lesson = load_lesson(SourceFile::new(name, text), models.folder());
        let lab = lesson.all_labs()[0].clone();
        let mut findings = Vec::new();
        let Some(model) = models.model_of_lab(&lab, &mut findings) else { panic!("{}", piece.name) };
        let programs = Programs::compile(&lab, &model, &mut findings);
        let names = ModelNames::new(&model, Scope::Lab);
        let found = labspec::bind::dimensions(&lab, &model, &programs);
        writeln!(page, "{}", piece.name).unwrap();
        for (probe, measured) in programs.probes.iter().zip(&found.probes) {
            let measure = measured.as_ref().unwrap().value;
            match measure {
                Measure::Dimension(d) if d.factor.is_nan() => loose += 1,
                Measure::Dimension(_) => certain += 1,
                Measure::Anything => literal += 1,
                Measure::Unknown => unknown += 1,
            }
            let text = &probe.bound.as_ref().unwrap().text.value;
            writeln!(page, "  {}: {}  <- {text}", probe.name, word(&measure)).unwrap();
        }
        let labels = programs.controls.iter().map(|(label, _)| label.as_str()).chain(["setup", "controller"]);
        for (label, measured) in labels.zip(found.controls.iter().chain(&found.others)) {
            let Some(measured) = measured else { continue };
            for stored in &measured.stores {
                let a = stored.access;
                let field = labspec_core::reflect::FieldId::new(a.field.0 as usize).unwrap().info().name;
                let expected = word(&names.measure(a.field, a.first, a.count));
                let what = word(&stored.measure);
                writeln!(page, "  {label}: {field}[{}], {expected}, is set to {what}", a.first).unwrap();
            }
            for (slot, measure) in &measured.variables {
                let name = programs.globals.name(*slot);
                writeln!(page, "  {label}: ctx.{name} is set to {}", word(measure)).unwrap();
            }
        }
        let depth = CheckLevel { programs: true, labs: false, claims: false };
        for f in check::check_lesson(lesson, models, depth).findings {
            if CODES.contains(&f.code) {
                writeln!(page, "  told: {} {}", f.code, f.message).unwrap();
            }
        }
    }
    writeln!(
        page,
        "\n{certain} known, {loose} known but for a factor, {literal} numbers of the text, {unknown} unknown"
    )
    .unwrap();
    insta::assert_snapshot!(page);
}

/// The findings of a lab with a model with two slides, `left` and `right`, a hinge `door` and a ball `ball`.
fn reported(keys: &str) -> Vec<String> {
    checked(keys).into_iter().filter(|f| CODES.contains(&f.code)).map(|f| f.message).collect()
}

/// All findings of such a lab, none of which may be an error.
fn checked(keys: &str) -> Vec<labspec::Finding> {
    let body = |name: &str, joint: &str| {
        format!(
            "<body name='{name}'><joint name='{name}' type='{joint}' axis='0 1 0'/><geom size='.1'/></body>"
        )
    };
    let model = format!(
        "<mujoco><worldbody>{}{}{}<body name='ball' pos='0 0 1'><freejoint/><geom size='.1'/></body></worldbody>\
         <actuator><motor name='push' joint='left'/><position name='servo' joint='door' kp='7'/></actuator>\
         <sensor><jointvel joint='door'/><accelerometer site='tip'/></sensor></mujoco>",
        body("left", "slide"),
        body("right", "slide"),
        body("door", "hinge"),
    )
    .replacen("<geom size='.1'/>", "<geom size='.1'/><site name='tip'/>", 1);
    let text = format!("```lab simlab\n{{\"xml\": {}, {keys}}}\n```\n", serde_json::json!(model));
    let folder = ModelFolder::unknown();
    let lesson = load_lesson(SourceFile::new("t.md", text), &folder);
    let depth = CheckLevel { programs: true, labs: false, claims: false };
    let checked = check::check_lesson(lesson, &Models::new(folder), depth);
    let errors: Vec<_> = checked.findings.iter().filter(|f| f.is_error()).collect();
    assert!(errors.is_empty(), "{keys}: {errors:#?}");
    checked.findings
}

fn readout(label: &str, expr: &str) -> Vec<String> {
    reported(&format!("\"readouts\": [{}]", serde_json::json!({"label": label, "expr": expr})))
}

#[test]
fn contradicting_units_are_reported() {
    for (label, expr, unit) in [
        ("x (mm)", "data.qpos[0]", "m"),
        ("x (m)", "1000 * data.qpos[0]", "mm"),
        ("x (m/s)", "data.qpos[0]", "m"),
        ("v (mm/s)", "Math.hypot(data.qvel[0], data.qvel[1])", "m/s"),
        ("angle (deg)", "data.qpos[2]", "rad"),
        ("angle (rad)", "data.qpos[2] * 180 / Math.PI", "deg"),
        ("angle (rad)", "lib.deg(data.joint('door').qpos[0])", "deg"),
        ("angle [°]", "Math.atan2(data.qpos[0], data.qpos[1])", "rad"),
        ("angle (deg)", "lib.deg(data.qvel[2])", "deg/s"),
        ("angle (deg)", "data.qvel[2] * 180 / Math.PI", "deg/s"),
        ("rate (deg/s)", "lib.deg(data.qpos[2])", "deg"),
        ("turns (Hz)", "data.qvel[2]", "rad/s"),
        ("height (m)", "data.qpos[6]", "1"),
        ("speed (m/s)", "data.qvel[2]", "rad/s"),
        ("p (kg m/s)", "model.body_mass[1] * data.qpos[0]", "kg m"),
        ("g (m/s^2)", "Math.sqrt(model.opt.gravity[2] * data.qpos[0])", "m/s"),
        ("E (N)", "lib.energy().total", "N m"),
        ("turning (rad)", "data.sensordata[0]", "rad/s"),
        ("a (m/s)", "data.sensordata[1]", "m/s^2"),
        ("F (N m)", "data.actuator_force[0]", "N"),
        ("M (N)", "data.actuator_force[1]", "N m"),
        ("t (ms)", "data.time > 1 ? data.time : 0", "s"),
        ("x (mm)", "Math.max(0, 0.3 - data.qpos[0])", "m"),
        ("height (mm)", "lib.bodyPos('ball')[2]", "m"),
        ("x (mm)", "2 * data.qpos[0]", "m, times 2"),
    ] {
        let found = readout(label, expr);
        let [message] = found.as_slice() else { panic!("{label}, {expr}: {found:?}") };
        assert!(message.ends_with(&format!(", but the expression gives {unit}")), "{message}");
    }
}

#[test]
fn possibly_correct_units_are_not_reported() {
    for (label, expr) in [
        ("x (mm)", "1000 * data.qpos[0]"),
        ("x (m)", "data.qpos[0] - 0.3"),
        ("x (m)", "1 - Math.cos(data.qpos[2])"),
        ("v (m/s)", "9.81 * data.time"),
        ("F (N)", "1000 * data.qpos[0]"),
        ("arc (m)", "data.qpos[2] * data.qpos[0]"),
        ("angle (deg)", "180 / Math.PI * data.qpos[2]"),
        ("angle (deg)", "lib.deg(data.qpos[2])"),
        ("rate (deg/s)", "lib.deg(data.qvel[2])"),
        ("angle (deg)", "lib.deg(2 * data.time)"),
        ("angle (deg)", "180 / Math.PI * data.time"),
        ("E (J)", "0.5 * model.body_mass[1] * data.qvel[0] ** 2"),
        ("E (J)", "lib.energy().total"),
        ("ball(s)", "data.qpos[0]"),
        ("of the car (A)", "data.qpos[0]"),
        ("slope (coarse)", "data.qpos[0]"),
        ("torque (N m)", "data.actuator_force[1]"),
        ("set point (rad)", "data.ctrl[1]"),
        ("force (N)", "data.ctrl[0]"),
        ("x (m)", "ctx.kept || 0"),
        ("x, v", "data.qpos[0] + 0.1 * data.qvel[0]"),
    ] {
        let setup = "\"setup\": \"ctx.kept = data.qpos[0]; ctx.kept = data.time\"";
        let readouts = serde_json::json!([{"label": label, "expr": expr}]);
        assert_eq!(
            reported(&format!("{setup}, \"readouts\": {readouts}")),
            Vec::<String>::new(),
            "{label}, {expr}"
        );
    }
}

#[test]
fn variables_and_loops_keep_dimensions() {
    for (setup, expr, found) in [
        ("ctx.x = data.qpos[0]", "ctx.x", true),
        ("ctx.x = null", "ctx.x", false),
        ("const late = data.qpos[0]; ctx.x = late", "ctx.x", true),
        ("for (let i = 0; i < 2; i++) ctx.x = data.xpos[i]", "ctx.x", true),
        ("ctx.x = data.qpos[0]; ctx.y = ctx.x", "ctx.y", true),
        ("ctx.x = data.qpos[0]; ctx['x'] = data.time", "ctx.x", false),
        ("ctx.x = 0; for (let i = 0; i < 3; i++) ctx.x += data.xpos[i % 2]", "ctx.x", true),
        ("let x = 1; for (let i = 0; i < 3; i++) x *= data.qpos[0]; ctx.x = x", "ctx.x", false),
    ] {
        let readouts = serde_json::json!([{"label": "x (mm)", "expr": expr}]);
        let setup = serde_json::json!(setup);
        let all = reported(&format!("\"setup\": {setup}, \"readouts\": {readouts}"));
        assert_eq!(!all.is_empty(), found, "{setup}: {all:?}");
    }
}

/// Lists, strings, functions and loops preserve the dimension of a quantity; if it is mixed with others,
/// the dimension is uncertain.
#[test]
fn lists_texts_and_functions_keep_dimensions() {
    let mut wrong = Vec::new();
    for (expr, found) in [
        ("[data.time][0]", true),
        ("[data.time, data.time].slice(1)[0]", true),
        ("[data.time, 0].reduce((a, b) => a + b, 0)", true),
        ("[3].map(i => data.time + i)[0]", true),
        ("Math.max(...[data.time, 1])", true),
        ("(x => x)(data.time)", true),
        ("(() => { const twice = x => x + x; return twice(twice(data.time)) })()", true),
        ("(() => { let s = 0; for (const x of [data.time]) { s += x } return s })()", true),
        ("(() => { let u = 0; const f = () => { u = data.time }; f(); return u })()", true),
        ("(() => { const all = []; all.push(data.time); return all[0] })()", true),
        ("+data.time.toFixed(3)", true),
        ("parseFloat(String(data.time))", true),
        ("Number(`${data.time}`)", true),
        ("({t: data.time}).t", true),
        ("[data.time, data.qpos[0]][0]", false),
        ("(() => { const all = [data.time]; all.push(data.qpos[0]); return all[0] })()", false),
        ("(() => { let u = data.time; const f = [() => { u = data.qpos[0] }]; f[0](); return u })()", false),
        ("(() => { let u = data.time; const f = () => { u = data.qpos[0] }; f(); return u })()", false),
        ("(() => { const f = n => n < 1 ? data.time : f(n - 1); return f(3) })()", false),
        ("(() => { let x = data.time; for (let i = 0; i < 2; i++) { x = data.qpos[0] } return x })()", false),
        ("data.time.toString(2) * 1", false),
    ] {
        let all = readout("x (kg)", expr);
        if all.is_empty() == found {
            wrong.push((expr, all));
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
}

#[test]
fn controls_are_compared_with_the_fields_that_they_set() {
    let slider = |unit: &str, key: &str, text: &str| {
        reported(&format!(
            "\"controls\": [{}]",
            serde_json::json!({"label": "c", "unit": unit, key: text, "min": 0, "max": 1, "value": 0})
        ))
    };
    for (unit, key, text) in [
        ("mm", "set", "data.qpos[0]"),
        ("deg", "set", "data.qpos[2]"),
        ("deg", "apply", "const a = value; data.qpos[2] = a"),
        ("g", "apply", "model.body_mass[1] = value; mj_setConst"),
        ("kg", "set", "model.opt.gravity[2]"),
        ("m/s", "set", "data.qpos[0]"),
        ("N m", "set", "data.ctrl[0]"),
    ] {
        let found = slider(unit, key, text);
        // A single `g` is ambiguous: it may be gram or gravity.
        assert_eq!(found.len(), usize::from(unit != "g"), "{unit} {text}: {found:?}");
    }
    for (unit, key, text) in [
        ("m", "set", "data.qpos[0]"),
        ("mm", "apply", "data.qpos[0] = value / 1000"),
        ("mm", "apply", "data.qpos[0] = 1e-3 * value"),
        ("deg", "apply", "data.qpos[2] = value * Math.PI / 180"),
        ("deg", "apply", "data.qpos[2] = lib.rad(value)"),
        ("N", "set", "data.ctrl[0]"),
        ("rad", "set", "data.ctrl[1]"),
        ("s", "set", "model.geom_solref[0]"),
        ("times", "set", "model.body_mass[1]"),
    ] {
        assert_eq!(slider(unit, key, text), Vec::<String>::new(), "{unit} {text}");
    }
}

/// A conversion is proposed only where it gives what the label says.
#[test]
fn only_a_scaled_quantity_is_converted() {
    for (label, expr, converts) in [
        ("angle (deg)", "data.qpos[2]", true),
        ("angle (deg)", "data.qvel[2]", false),
        ("x (mm)", "data.qpos[0]", true),
    ] {
        let checked =
            checked(&format!("\"readouts\": [{}]", serde_json::json!({"label": label, "expr": expr})));
        let found = checked.iter().find(|f| f.code == "label-unit").unwrap();
        let help = found.help.as_deref().unwrap();
        assert_eq!(help.contains("which converts the number"), converts, "{label}, {expr}: {help}");
    }
}

/// A control that stores its value in `ctx` is compared with what other programs make of it.
#[test]
fn parameters_are_compared_with_the_fields_that_programs_set() {
    let slider = |unit: &str, key: &str, text: &str| {
        let control =
            serde_json::json!({"label": "c", "unit": unit, "param": "a", "min": 0, "max": 1, "value": 0});
        reported(&format!("\"controls\": [{control}], {key}: {}", serde_json::json!(text)))
    };
    for (unit, key, text) in [
        ("°", "\"setup\"", "data.qpos[2] = ctx.a"),
        ("°", "\"setup\"", "data.qpos[2] = -ctx.a"),
        ("°", "\"controller\"", "data.ctrl[1] = ctx.a"),
        ("mm", "\"setup\"", "data.qpos[0] = ctx.a"),
        ("km/h", "\"setup\"", "data.qvel[0] = ctx.a"),
        ("°", "\"setup\"", "data.qvel[0] = 3 * Math.sin(ctx.a)"),
        ("°", "\"controller\"", "data.ctrl[0] = Math.cos(ctx.a + 0.1)"),
        ("°/s", "\"controller\"", "data.ctrl[0] = Math.sin(ctx.a * data.time)"),
        ("°", "\"setup\"", "ctx.b = lib.deg(ctx.a)"),
    ] {
        let found = slider(unit, key, text);
        assert_eq!(found.len(), 1, "{unit} {text}: {found:?}");
    }
    for (unit, key, text) in [
        ("°", "\"setup\"", "data.qpos[2] = lib.rad(ctx.a)"),
        ("°", "\"setup\"", "data.qpos[2] = ctx.a * Math.PI / 180"),
        ("°", "\"setup\"", "const a = ctx.a / 180 * Math.PI; data.qpos[2] = a; data.qvel[0] = Math.sin(a)"),
        (
            "°",
            "\"setup\"",
            "ctx.a = ctx.a * Math.PI / 180; data.qpos[2] = ctx.a; data.qvel[0] = Math.sin(ctx.a)",
        ),
        ("rad", "\"setup\"", "data.qpos[2] = ctx.a; data.qvel[0] = Math.sin(ctx.a)"),
        ("mm", "\"setup\"", "data.qpos[0] = ctx.a / 1000"),
        ("m", "\"setup\"", "data.qpos[0] = 0.001 * ctx.a"),
        ("rad", "\"controller\"", "data.ctrl[0] = ctx.a - data.qpos[2]"),
        ("%", "\"controller\"", "data.ctrl[0] = ctx.a"),
        ("Hz", "\"controller\"", "data.ctrl[0] = Math.sin(2 * Math.PI * ctx.a * data.time)"),
    ] {
        assert_eq!(slider(unit, key, text), Vec::<String>::new(), "{unit} {text}");
    }
}

/// A control that takes degrees must not pass them to `Math.sin`, nor an angle to a quaternion.
#[test]
fn angles_of_controls_are_used_as_angles() {
    let slider = |unit: &str, text: &str| {
        let control =
            serde_json::json!({"label": "c", "unit": unit, "apply": text, "min": 0, "max": 1, "value": 0});
        reported(&format!("\"controls\": [{control}]"))
    };
    for (unit, text, count) in [
        ("°", "data.qvel[0] = 3 * Math.sin(value)", 1),
        ("°", "data.qvel[0] = 3 * Math.sin(lib.rad(value))", 0),
        ("rad", "data.qvel[0] = 3 * Math.sin(value)", 0),
        ("rad", "data.qpos[7] = value", 1),
        ("°", "data.qpos[7] = value", 1),
        ("rad", "data.qpos[7] = Math.sin(value / 2)", 0),
        ("rad", "data.qpos[7] = 0.5 * value", 0),
        ("rad", "data.qpos[2] = value", 0),
    ] {
        let found = slider(unit, text);
        assert_eq!(found.len(), count, "{unit} {text}: {found:?}");
    }
}

#[test]
fn controls_with_exchanged_bodies_are_reported() {
    let sliders = |a: (&str, &str), b: (&str, &str)| {
        let control = |(label, text): (&str, &str)| serde_json::json!({"label": label, "apply": text, "min": 1, "max": 2, "value": 1});
        reported(&format!("\"controls\": [{}, {}]", control(a), control(b)))
    };
    let (left, right) =
        ("model.body_mass[1] = value; mj.mj_setConst(model, data)", "model.body_mass[2] = value");
    let found = sliders(("mass left", right), ("mass right", left));
    assert_eq!(found, ["the label names the body \"left\", but the control sets the body \"right\""]);
    for (a, b) in [
        (("mass left", left), ("mass right", right)),
        (("mass left", right), ("mass right", right)),
        (("mass left", right), ("size right", left)),
        (("mass of this", right), ("mass of that", left)),
        (("push left", "data.xfrc_applied[12] = value"), ("push right", "data.xfrc_applied[6] = value")),
    ] {
        assert_eq!(sliders(a, b), Vec::<String>::new(), "{a:?} {b:?}");
    }
}

#[test]
fn sums_of_different_dimensions_are_reported() {
    for (expr, count) in [
        ("data.qpos[0] + data.time", 1),
        ("data.qpos[0] > data.qvel[0]", 1),
        ("Math.min(data.qpos[0], data.time)", 1),
        ("Math.hypot(data.qvel[0], data.qpos[1])", 1),
        ("data.qpos[0] + data.qvel[0] * data.time", 0),
        ("data.qpos[0] + 2 * data.time", 0),
        ("data.qpos[0] + data.qpos[1]", 0),
    ] {
        let found = readout("sum", expr);
        assert_eq!(found.len(), count, "{expr}: {found:?}");
    }
}

#[test]
fn labels_that_name_another_quantity_are_reported() {
    let both = |readouts: &[(&str, &str)]| {
        let list: Vec<_> = readouts.iter().map(|(l, e)| serde_json::json!({"label": l, "expr": e})).collect();
        reported(&format!("\"readouts\": {}", serde_json::json!(list)))
    };
    let (l, r) = ("data.qpos[0]", "data.qpos[1]");
    for (readouts, count) in [
        (&[("left (m)", r)][..], 1),
        (&[("left (m)", l), ("right (m)", r)], 0),
        (&[("left (m)", r), ("right (m)", l)], 2),
        (&[("place of left (m)", r), ("place of right (m)", l)], 2),
        (&[("place of left (m)", r), ("place of right (m)", r)], 1),
        // The name may be a reference point from which something is measured.
        (&[("behind left (m)", r)], 0),
        (&[("left against right (m)", r)], 0),
        (&[("left (m)", "data.qpos[1] - data.qpos[0]")], 0),
        (&[("left (m)", "ctx.x || data.qpos[1]")], 0),
        (&[("left (s)", "data.time")], 0),
        (&[("left (m)", "data.site('tip').xpos[0]")], 0),
        // Each label contains the name of the object that its value belongs to.
        (&[("end of left", "data.xpos[6]"), ("end of right", "data.xpos[9]")], 0),
    ] {
        let found = both(readouts);
        assert_eq!(found.len(), count, "{readouts:?}: {found:?}");
    }
}
