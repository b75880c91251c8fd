//! Tests of the declaration: it is complete, its examples are correct, and the readers follow it.

use super::*;
use crate::bind::scene::Models;
use crate::check::{self, CheckLevel};
use crate::finding::Finding;
use crate::lint::ModelFolder;
use crate::lint::load_lesson_at;
use crate::source::{SourceFile, Sources};
use crate::spec::{Camera, ControlKind, Lab, Lesson};
use serde_json::{Value, json};
use std::collections::BTreeSet;
use std::path::Path;

/// The lab that the examples of `verify` run. It contains all labels that they use.
const SCENE: &str = r#"{"model": "fall", "stopAt": 1, "controls": [
    {"label": "gravity", "min": -20, "max": 0, "step": 0.01, "value": -9.81, "set": "model.opt.gravity[2]", "reset": true},
    {"type": "button", "label": "Push", "run": "data.joint('ball').qvel[0] = 1"}],
  "plots": [{"traces": [{"label": "height", "expr": "data.joint('ball').qpos[2]"}]}]}"#;

fn parse(text: &str) -> Value {
    serde_json::from_str(text).unwrap_or_else(|e| panic!("{e}: {text}"))
}

/// A value of a type that contains an object; `None` for types that cannot contain it.
fn holding(ty: &Type, object: &Object, value: &Value) -> Option<Value> {
    match ty {
        Type::Object(o) if o.name == object.name => Some(value.clone()),
        Type::OneOf(f) if f.objects.iter().any(|o| o.name == object.name) => Some(value.clone()),
        Type::List(item) => Some(json!([holding(item, object, value)?])),
        Type::Map(map) => Some(json!({"height": holding(&map.ty, object, value)?})),
        Type::Either(a, b) => holding(a, object, value).or_else(|| holding(b, object, value)),
        _ => None,
    }
}

/// The smallest object of its kind with a key added, and without the keys that this one excludes.
fn with_key(object: &Object, name: &str, value: Value) -> Value {
    let mut whole = parse(object.minimal);
    let members = whole.as_object_mut().unwrap();
    for rule in object.key_rules {
        let names: &[&str] = match rule {
            KeyRule::ExactlyOne(names) => names,
            KeyRule::AtMostOne(names) | KeyRule::FirstCounts(names) => names.as_slice(),
            KeyRule::AtLeastOne(_) | KeyRule::OneAdvised(_) => &[],
        };
        if names.contains(&name) {
            names.iter().for_each(|n| drop(members.remove(*n)));
        }
    }
    // `columns` stands for `column` and `is`.
    if (object.name, name) == (COLUMN.name, "columns") {
        ["column", "is"].iter().for_each(|n| drop(members.remove(*n)));
    }
    members.insert(name.into(), value);
    whole
}

/// All labs and quizzes that contain this object in the smallest possible objects, innermost first.
fn roots(object: &'static Object, value: &Value) -> Vec<(&'static Object, Value)> {
    let (mut open, mut all) = (vec![(object, value.clone())], Vec::new());
    let mut seen = BTreeSet::new();
    while let Some((object, value)) = open.pop() {
        if [LAB.name, INTEGRATORS.name, QUIZ.name].contains(&object.name) {
            all.push((object, value));
            continue;
        }
        if !seen.insert(object.name) {
            continue;
        }
        for parent in OBJECTS {
            for key in parent.keys {
                if let Some(held) = holding(&key.ty, object, &value) {
                    open.push((parent, with_key(parent, key.name, held)));
                }
            }
        }
    }
    all
}

/// A lesson with prose, the scene, and a lab or a quiz.
fn lesson_text(object: &Object, value: &Value) -> String {
    let fence = match object.name {
        name if name == LAB.name => "lab simlab",
        name if name == INTEGRATORS.name => "lab integrators",
        _ => "quiz",
    };
    format!(
        "After 1 s the ball falls with 9.81 m/s.\n\n```lab simlab\n{SCENE}\n```\n\n```{fence}\n{value}\n```\n"
    )
}

fn load(object: &Object, value: &Value) -> Lesson {
    load_in(object, value, &ModelFolder::with_names(["fall"]))
}

/// A lesson beside the file with values that the examples name.
fn load_in(object: &Object, value: &Value, models: &ModelFolder) -> Lesson {
    let file = SourceFile::new("t.md", lesson_text(object, value));
    let beside = Sources::given([("masses.csv", "mass (kg)\n0.9\n1.1\n")]);
    load_lesson_at(file, Path::new("t.md"), &beside, models)
}

/// The findings of a check with runs and claims, with the model of the examples, to which a keyframe and a site are added.
fn checked(object: &Object, value: &Value) -> Vec<Finding> {
    let folder = tempfile::tempdir().unwrap();
    let model = include_str!("../../../../../specs/models/fall.xml");
    let model = model.replace(
        "</mujoco>",
        "<worldbody><site name='tip'/></worldbody><keyframe><key qpos='0 0 1 1 0 0 0'/></keyframe></mujoco>",
    );
    std::fs::write(folder.path().join("fall.xml"), model).unwrap();
    let models = Models::new(ModelFolder::open(folder.path()).unwrap());
    let lesson = load_in(object, value, models.folder());
    check::check_lesson(lesson, &models, CheckLevel::FULL).findings
}

/// The objects that are valid in any lab. A listing is valid only in a lab of a `verify` object, and needs a fence.
fn objects() -> impl Iterator<Item = &'static Object> {
    OBJECTS.into_iter().filter(|o| o.name != LISTING.name)
}

fn every_key() -> impl Iterator<Item = (&'static Object, &'static Key)> {
    objects().flat_map(|o| o.keys.iter().map(move |k| (o, k)))
}

#[test]
fn every_object_is_declared_once_and_can_be_reached() {
    let names: BTreeSet<_> = OBJECTS.iter().map(|o| o.name).collect();
    assert_eq!(names.len(), OBJECTS.len());
    for object in OBJECTS {
        let keys: BTreeSet<_> = object.keys.iter().map(|k| k.name).collect();
        assert_eq!(keys.len(), object.keys.len(), "{}", object.name);
        assert!(!roots(object, &parse(object.minimal)).is_empty(), "{}", object.name);
    }
    for family in [&CONTROL, &QUESTION] {
        let tags: Vec<_> = family.objects.iter().filter_map(|o| o.tag).collect();
        let words: Vec<_> = family.words.iter().map(|w| (family.key, w.text)).collect();
        assert_eq!(tags, words);
        for object in family.objects {
            assert!(OBJECTS.iter().any(|o| o.name == object.name));
            let first = family.object(None).unwrap().name == object.name;
            assert_eq!(object.key(family.key).unwrap().required(), !first, "{}", object.name);
        }
    }
}

#[test]
fn every_key_says_what_it_means() {
    let package: Vec<u32> =
        env!("CARGO_PKG_VERSION").split('.').map(|part| part.parse().unwrap()).take(2).collect();
    for (object, key) in every_key() {
        let path = format!("{}.{}", object.name, key.name);
        assert!(key.doc.len() > 8 && !key.doc.ends_with('.'), "{path}");
        let since: Vec<u32> = key.since.split('.').map(|part| part.parse().unwrap()).collect();
        assert!(since.len() == 2 && since <= package, "{path}: since {}", key.since);
        if let Some(Value::Number(n)) = describe::default(key) {
            assert!(key.limits.allow(n.as_f64().unwrap()), "{path}");
        }
    }
}

#[test]
fn every_smallest_object_is_whole_and_every_key_that_must_stand_does() {
    for object in objects() {
        let whole = parse(object.minimal);
        // Some objects fit only a quiz and others only a lab: at least one of the two must have no findings.
        let clean = roots(object, &whole).iter().any(|(root, value)| load(root, value).findings.is_empty());
        assert!(clean, "{}", object.name);
        for key in object.keys {
            let mut without = whole.clone();
            let stood = without.as_object_mut().unwrap().remove(key.name).is_some();
            let needed = key.required() || matches!(key.need, Need::Advised(_));
            assert!(stood || !needed, "{}.{}", object.name, key.name);
            // Without its family key, it is another object, or none.
            if needed && object.tag.is_none_or(|(tag, _)| tag != key.name) {
                for (root, value) in roots(object, &without) {
                    assert!(!load(root, &value).findings.is_empty(), "{}.{}", object.name, key.name);
                }
            }
        }
    }
}

/// An object with the example of a key, and with the other keys that this key needs.
fn with_its_kind(object: &'static Object, key: &Key) -> Value {
    let mut whole = with_key(object, key.name, parse(key.example));
    if (object.name, key.name) == (VERIFY.name, "over") {
        let options = VERIFY.key("options").unwrap();
        whole["options"] = parse(options.example);
    }
    if (object.name, key.name) == (VERIFY.name, "wrong") {
        whole["value"] = parse(VERIFY.key("value").unwrap().example);
    }
    whole
}

#[test]
fn every_example_is_right() {
    for (object, key) in every_key() {
        let whole = with_its_kind(object, key);
        let all = roots(object, &whole);
        // This lesson has no other object.
        if (object.name, key.name) == (VERIFY.name, "use") {
            let is_reported =
                |f: &Finding| f.message.contains("has no `verify`") || f.message.contains("uses itself");
            assert!(all.iter().all(|(root, v)| load(root, v).findings.iter().all(is_reported)));
            continue;
        }
        let clean: Vec<_> = all.iter().filter(|(root, v)| load(root, v).findings.is_empty()).collect();
        assert!(!clean.is_empty(), "{}.{}: {:#?}", object.name, key.name, {
            let (root, value) = &all[0];
            load(root, value).findings
        });
        // Conditions apply only to questions with options, and values only to numeric questions. All other keys apply
        // everywhere.
        let only_some =
            object.name == VERIFY.name && ["options", "value", "wrong", "over"].contains(&key.name);
        assert_eq!(only_some, clean.len() < all.len(), "{}.{}", object.name, key.name);
    }
}

/// Two tests, so that two cores share the work.
#[test]
fn every_example_runs() {
    run_examples(0);
}

#[test]
fn every_other_example_runs() {
    run_examples(1);
}

/// Runs the examples of every second key, from the one with this index on.
fn run_examples(first: usize) {
    let mut wrong = Vec::new();
    for (object, key) in every_key().skip(first).step_by(2) {
        let whole = with_its_kind(object, key);
        let all = roots(object, &whole);
        let found: Vec<Vec<Finding>> = all.iter().map(|(root, value)| checked(root, value)).collect();
        // Nothing breaks here, but `expect` says that something does.
        if key.name == "expect" {
            let is_break = |f: &Vec<Finding>| f.len() == 1 && f.iter().all(|f| f.message.contains("break"));
            assert!(found.iter().all(is_break), "{found:#?}");
            continue;
        }
        // The targets of these keys are missing in this lesson: a measure of a sweep is a list, there is no table, and
        // there is no smallest value.
        let absent = match (object.name, key.name) {
            ("run", "sweep") => Some("speed"),
            ("span" | "fileValues", _) => Some("`height`"),
            ("column", _) | ("verify", "table") => Some("no table has the columns"),
            ("verify", "use") => Some("`verify`"),
            ("find", "smallest") => Some("there is a largest value, but no smallest one"),
            _ => None,
        };
        if let Some(words) = absent {
            let is_expected = |f: &Vec<Finding>| !f.is_empty() && f.iter().all(|f| f.message.contains(words));
            assert!(found.iter().all(is_expected), "{}.{}: {found:#?}", object.name, key.name);
            continue;
        }
        // There are no findings to suppress.
        let unused = |f: &Vec<Finding>| f.len() == 1 && f.iter().all(|f| f.code == "unused-allowance");
        if object.name == "lint" || key.name == "lint" {
            assert!(found.iter().any(unused), "{found:#?}");
            continue;
        }
        if !found.iter().any(Vec::is_empty) {
            wrong.push(format!("{}.{}: {:?}", object.name, key.name, found.first().and_then(|f| f.first())));
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
}

/// Values of other types than this one, each with the part of it that is wrong.
fn wrong(ty: &Type) -> Vec<(Value, Value)> {
    let whole = |all: &[Value]| all.iter().map(|v| (v.clone(), v.clone())).collect::<Vec<_>>();
    let inside = |ty: &Type, hold: &dyn Fn(Value) -> Value| {
        wrong(ty).into_iter().map(|(v, part)| (hold(v), part)).collect::<Vec<_>>()
    };
    match ty {
        Type::Text | Type::Name(_) | Type::Html | Type::Code(_) => {
            whole(&[json!(707), json!(true), json!(["a"])])
        }
        Type::Number => whole(&[json!("seven"), json!(true), json!([707])]),
        Type::Whole => whole(&[json!("seven"), json!(1.5)]),
        Type::Flag => whole(&[json!("yes"), json!(707)]),
        Type::Null => whole(&[json!("null"), json!(707)]),
        Type::Scalar => whole(&[json!([707]), json!(null)]),
        Type::Words(_) => whole(&[json!("no such word"), json!(707)]),
        Type::List(item) => [whole(&[json!(707), json!({"a": 1})]), inside(item, &|v| json!([v]))].concat(),
        Type::Numbers(n) => whole(&[json!(707), json!(vec![0; n + 1])]),
        Type::Pair(parts) => {
            let [first, second] = *parts;
            let mut all = whole(&[json!(707), json!(["a"])]);
            let good = |ty: &Type| if matches!(ty, Type::Number) { json!(1) } else { json!("a") };
            all.extend(inside(&first.ty, &|v| json!([v, good(&second.ty)])));
            all.extend(inside(&second.ty, &|v| json!([good(&first.ty), v])));
            all
        }
        Type::Map(map) => [whole(&[json!(707)]), inside(&map.ty, &|v| json!({"height": v}))].concat(),
        Type::Switches(_) => vec![(json!(707), json!(707)), (json!({"com": 707}), json!(707))],
        Type::Object(_) | Type::OneOf(_) => whole(&[json!(707), json!(["a"])]),
        Type::Either(Type::Scalar, _) => whole(&[json!(null)]),
        Type::Either(..) => whole(&[json!(707)]),
    }
}

#[test]
fn a_wrong_type_is_found_where_it_stands() {
    let mut tried = 0;
    for (object, key) in every_key() {
        for (value, part) in wrong(&key.ty) {
            for (root, whole) in roots(object, &with_key(object, key.name, value.clone())) {
                let lesson = load(root, &whole);
                // The last occurrence, because the scene precedes it.
                let written = format!("\"{}\":{value}", key.name);
                let text = lesson.file.text();
                let start = text.rfind(&written).unwrap_or_else(|| panic!("{written} in {text}"))
                    + key.name.len()
                    + 3;
                let part = start + value.to_string().find(&part.to_string()).unwrap();
                let found = lesson
                    .findings
                    .iter()
                    .any(|f| f.span.start <= part + 1 && f.span.end > part && f.span.start >= start);
                assert!(found, "{}.{} = {value}: {:#?}", object.name, key.name, lesson.findings);
                tried += 1;
            }
        }
    }
    assert!(tried > 500, "{tried}");
}

#[test]
fn a_number_beyond_its_limits_is_found() {
    let mut tried = 0;
    for (object, key) in every_key() {
        let Limits { above, least, most } = key.limits;
        let wrong = [above, least.map(|x| x - 1.0), most.map(|x| x + 1.0)];
        for x in wrong.into_iter().flatten() {
            let value = if matches!(key.ty, Type::List(_)) { json!([x]) } else { describe::number(x) };
            for (root, whole) in roots(object, &with_key(object, key.name, value)) {
                assert!(load(root, &whole).has_errors(), "{}.{} = {x}", object.name, key.name);
                tried += 1;
            }
        }
        if key.items > 0 {
            let few = parse(key.example).as_array().unwrap()[..key.items - 1].to_vec();
            for (root, whole) in roots(object, &with_key(object, key.name, json!(few))) {
                assert!(load(root, &whole).has_errors(), "{}.{}", object.name, key.name);
                tried += 1;
            }
        }
    }
    assert!(tried > 15, "{tried}");
}

fn lab(text: &str) -> Lab {
    load(&LAB, &parse(text)).labs.pop().unwrap().lab.unwrap()
}

/// For every declared default, the reader treats the written value and an absent key alike.
#[test]
fn what_counts_where_a_key_is_left_out_is_what_is_declared() {
    let bare = lab(r#"{"model": "fall", "plots": [{"traces": [{"label": "z", "expr": "data.time"}]}],
        "readouts": [{"label": "t", "expr": "data.time"}],
        "controls": [{"label": "g", "min": 0, "max": 1, "value": 0, "param": "g"}]}"#);
    let default = |object: &Object, key: &str| describe::default(object.key(key).unwrap());
    assert_eq!(Some(json!(bare.title())), default(&LAB, "title"));
    assert_eq!(Some(json!(bare.kind())), default(&LAB, "kind"));
    assert_eq!((bare.height(), bare.force_scale()), (300.0, 0.02));
    assert_eq!(bare.speeds(), [0.1, 0.25, 1.0, 4.0]);
    assert_eq!((bare.camera.azimuth, bare.camera.elevation), (-55.0, 25.0));
    assert_eq!(bare.camera, lab(r#"{"model": "fall", "camera": {"azimuth": -55, "elevation": 25}}"#).camera);
    assert_eq!(bare.camera, Camera::default());
    let plot = &bare.plots[0];
    assert_eq!((plot.window(), plot.height(), plot.xlabel()), (5.0, 140.0, "time (s)"));
    assert_eq!((bare.readouts[0].digits(), bare.controls[0].digits()), (3, Some(3)));
    let flags = (bare.dock, bare.autoplay, plot.traces[0].dash);
    let action = bare.controls[0].action().unwrap();
    assert_eq!((flags, action.init, action.reset), ((false, false, false), false, false));
    assert_eq!(bare.controls[0].step(), Some(0.01));
    assert!(matches!(bare.controls[0].kind, ControlKind::Slider { .. }));
    let quiz = parse(
        r#"{"id": "a", "questions": [{"q": "?", "options": ["a", "b"], "answer": 0}, {"kind": "numeric", "q": "?", "answer": -50}]}"#,
    );
    let quiz = load(&QUIZ, &quiz).quizzes.pop().unwrap();
    assert_eq!(quiz.title(), "Knowledge check");
    let says = |object: &Object, key: &str, what: String| match object.key(key).unwrap().absent {
        Absent::Described(words) => assert!(words.contains(&what), "{words}"),
        other => panic!("{other:?}"),
    };
    says(&NUMERIC, "tol", format!("{} %", 100.0 * TOLERANCE));
    says(&RUN, "until", format!("{RUN_LENGTH} s"));
    assert!(LAB.key("stopAt").unwrap().doc.contains(&format!("{RUN_LENGTH} s")));
    assert_eq!(quiz.questions[1].as_ref().unwrap().numeric(), Some((-50.0, 1.0)));
}

/// Every default that is a number, a list of numbers or a text is read from the declaration, so that no second copy can
/// differ from it.
#[test]
fn declared_defaults_are_of_their_type() {
    for (object, key) in every_key() {
        let path = format!("{}.{}", object.name, key.name);
        let Some(default) = describe::default(key) else { continue };
        let fits = match key.ty {
            Type::Number | Type::Whole => default.is_number() && object.number(key.name).is_finite(),
            Type::Text | Type::Words(_) => default.as_str() == Some(object.text(key.name)),
            Type::Flag => default == json!(false),
            Type::List(_) => default.is_array(),
            _ => default == json!({}),
        };
        assert!(fits, "{path}");
    }
}

/// The rules for combinations of keys match what is reported, with the declared severity.
#[test]
fn what_keys_ask_of_each_other_is_checked() {
    for object in OBJECTS {
        for rule in object.key_rules {
            let (names, without, all): (&[&str], _, _) = match rule {
                KeyRule::ExactlyOne(names) => (names, Some(true), Some(true)),
                KeyRule::AtLeastOne(names) => (names, Some(true), None),
                KeyRule::OneAdvised(names) => (names, Some(false), None),
                KeyRule::AtMostOne(names) => (names.as_slice(), None, Some(true)),
                KeyRule::FirstCounts(names) => (names.as_slice(), None, Some(false)),
            };
            let mut whole = parse(object.minimal);
            names.iter().for_each(|name| drop(whole.as_object_mut().unwrap().remove(*name)));
            let mut both = whole.clone();
            for name in names {
                let example = parse(object.key(name).unwrap().example);
                both.as_object_mut().unwrap().insert((*name).into(), example);
            }
            for (value, is_error) in [(whole, without), (both, all)] {
                let Some(is_error) = is_error else { continue };
                for (root, value) in roots(object, &value) {
                    let lesson = load(root, &value);
                    assert!(!lesson.findings.is_empty(), "{}: {rule:?}", object.name);
                    assert_eq!(lesson.has_errors(), is_error, "{}: {rule:?}", object.name);
                }
            }
        }
    }
}
