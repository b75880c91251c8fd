//! Proposals for authors: the origins of numbers without coincidences, and claims for questions.

#![allow(clippy::unwrap_used, clippy::panic)]

use crate::authors::{BALL, write};
use crate::program::{Done, folder, run_in};
use labspec::bind::scene::Models;
use labspec::lint::{ModelFolder, load_lesson};
use labspec::source::SourceFile;
use labspec::verify::Verdict;
use labspec_proposals::scaffold::{Scaffold, ScaffoldOutcome, scaffold};
use labspec_proposals::trace::{Origin, trace};
use serde_json::{Value, json};

/// The origins of the numbers of a text beside a lab with sliders.
fn origins(text: &str) -> Vec<(String, Origin)> {
    let lab = json!({"xml": "<mujoco><worldbody><body name='arm'><joint name='shoulder' type='hinge' axis='0 1 0'/><geom name='arm' type='capsule' fromto='0 0 0 0.5 0 0' size='0.03' mass='1'/></body></worldbody><actuator><motor name='shoulder' joint='shoulder' ctrlrange='-25 25'/></actuator></mujoco>",
        "stopAt": 2, "controls": [
            {"label": "shoulder target", "unit": "rad", "param": "q", "min": -1, "max": 1, "step": 0.01, "value": 0.5},
            {"label": "duration", "unit": "s", "param": "T", "min": 0.05, "max": 3, "step": 0.01, "value": 1}],
        "controller": "data.ctrl[0] = Math.max(-25, Math.min(25, 400 * (ctx.q - data.qpos[0]) - 5 * data.qvel[0])) + 0 * ctx.T",
        "readouts": [{"label": "torque (N m)", "expr": "data.actuator_force[0]"}, {"label": "angle (rad)", "expr": "data.qpos[0]"}]});
    let lesson = load_lesson(
        SourceFile::new("a.md", format!("{text}\n\n```lab simlab\n{lab}\n```\n")),
        &ModelFolder::unknown(),
    );
    let models = Models::new(ModelFolder::unknown());
    let found = trace(&lesson, &models, &mut |_| ());
    found.numbers.into_iter().map(|n| (n.stated.quote, n.origin)).collect()
}

#[test]
fn coincidences_are_no_origins() {
    for text in [
        "Of the speed, 73 % remains.",
        "The first impact comes after 0.45 s.",
        "The motor gives at most 25 N m of torque.",
        "The can has a radius of 30 mm.",
        "The lab runs for 2 s.",
    ] {
        for (quote, origin) in origins(text) {
            assert!(!matches!(origin, Origin::From(_) | Origin::Setting(_)), "{text}: {quote} is {origin:?}");
        }
    }
    let setting =
        |text: &str| origins(text).into_iter().any(|(_, origin)| matches!(origin, Origin::Setting(_)));
    assert!(setting("With a shoulder target of 0.73 rad it rises."));
    assert!(setting("The duration is 0.45 s."));
    assert!(!setting("It takes 0.45 s."));
    let named = origins("The arm has a radius of 30 mm.");
    assert!(matches!(&named[0].1, Origin::From(hit) if hit.measure.contains(".size[0]")), "{named:?}");
}

/// The origins of the lengths of a text beside a falling ball whose height starts at 1 m.
fn lengths(text: &str) -> Vec<Origin> {
    let lab = json!({"xml": BALL, "stopAt": 0.3, "readouts": [{"label": "height (m)", "expr": "data.qpos[2]", "digits": 3}],
        "controls": [{"label": "lift", "unit": "m", "apply": "data.qpos[2] = 1 + value", "min": 0, "max": 1, "step": 0.001, "value": 0, "init": true, "reset": true}]});
    let text = format!("{text}\n\n```lab simlab\n{lab}\n```\n");
    let models = Models::new(ModelFolder::unknown());
    let lesson = load_lesson(SourceFile::new("a.md", text), models.folder());
    let found = trace(&lesson, &models, &mut |_| ());
    found.numbers.into_iter().map(|n| n.origin).collect()
}

/// A length of an object is no height, and of two numbers with the same origin, the coarser one is another quantity.
#[test]
fn numbers_of_objects_and_coarser_numbers_are_no_results() {
    let is_traced = |origin: &Origin| matches!(origin, Origin::From(_));
    assert!(lengths("The ball falls from a height of 1.000 m.").iter().all(is_traced));
    assert!(!lengths("A rod of 1.000 m lies below its height.").iter().any(is_traced));
    assert!(!lengths("Its height is that of the 1.000 m rod.").iter().any(is_traced));
    let both = lengths("At the end its height is 0.556 m, close to the 0.56 m of the formula.");
    assert_eq!(both.iter().map(is_traced).collect::<Vec<_>>(), [true, false], "{both:#?}");
}

#[test]
fn what_a_listing_printed_is_named() {
    let found = origins(
        "The gain is 31.847 here.\n\n```python\nprint(gain)\n```\n\n```text\ngain 31.847 N\n```\n\nIt is 31.847 N.",
    );
    assert!(found.iter().any(|(_, origin)| matches!(origin, Origin::Listed(7))), "{found:?}");
}

const PENDULUM: &str = "<mujoco><worldbody><body name='bob'><joint name='swing' type='hinge' axis='0 1 0'/><geom name='bob' pos='0 0 -0.5' size='0.01' mass='1'/></body></worldbody></mujoco>";

/// The outcome of one question beside a pendulum with three controls.
fn asked(question: &Value) -> Scaffold {
    let lab = json!({"xml": PENDULUM, "stopAt": 6, "setup": "data.qpos[0] = 0.1", "controls": [
        {"label": "mass of the bob", "unit": "kg", "apply": "const m = model.body_mass[1]; model.body_mass[1] = value; for (let i = 3; i < 6; i++) model.body_inertia[i] *= value / m; mj.mj_setConst(model, data)", "min": 0.5, "max": 10, "step": 0.5, "value": 1, "reset": true},
        {"label": "gravity", "unit": "m/s²", "apply": "model.opt.gravity[2] = -value", "min": 1.62, "max": 9.81, "value": 9.81, "reset": true},
        {"type": "select", "label": "start", "options": [["small", 0.1], ["wide", 1.5]], "value": 0.1, "apply": "data.qpos[0] = value", "init": true, "reset": true}],
        "plots": [{"ylabel": "angle (rad)", "traces": [{"label": "angle (rad)", "expr": "data.qpos[0]"}]}],
        "readouts": [{"label": "speed (rad/s)", "expr": "data.qvel[0]"}]});
    let quiz = json!({"id": "sw", "questions": [question]});
    let text = format!("```lab simlab\n{lab}\n```\n\n```quiz\n{quiz}\n```\n");
    let models = Models::new(ModelFolder::unknown());
    let lesson = load_lesson(SourceFile::new("a.md", text), models.folder());
    let all = scaffold(&lesson, &models, &mut |_| ());
    all.into_iter().find(|one| one.name.starts_with("quiz")).unwrap()
}

fn choice(q: &str, options: &[&str], answer: usize) -> Value {
    json!({"kind": "mcq", "q": q, "options": options, "answer": answer})
}

#[test]
fn questions_about_a_control_are_decided_by_it() {
    let period = ["It grows", "It stays the same", "It shrinks"];
    for (question, run, measure) in [
        (
            choice("The bob becomes ten times as heavy. What happens to the period?", &period, 1),
            "mass of the bob",
            "period(",
        ),
        (
            choice(
                "You take the pendulum to the Moon (1.62 m/s²). How does the period change?",
                &[
                    "It is the same",
                    "It is about 2.5 times as long",
                    "It is about 6 times as long",
                    "It is shorter",
                ],
                1,
            ),
            "gravity",
            "period(",
        ),
        (
            choice(
                "You start it wide instead of small. Is the period longer?",
                &["Yes, longer", "No, equal", "No, shorter"],
                0,
            ),
            "start",
            "period(",
        ),
        (
            choice(
                "With a lower gravity, what is the sign of the change of the largest speed?",
                &["positive", "negative"],
                1,
            ),
            "gravity",
            "max(data.qvel[0])",
        ),
    ] {
        let one = asked(&question);
        let ScaffoldOutcome::Proposed { verify, verdict: Some((Verdict::Verified, _)), .. } = &one.found
        else {
            panic!("{question}: {one:#?}")
        };
        let verify = serde_json::to_value(verify).unwrap();
        let sets =
            |key: &str| verify["runs"].as_object().unwrap().values().any(|r| r["set"].get(key).is_some());
        assert!(sets(run), "{question}: {verify:#}");
        assert!(verify["measure"].to_string().contains(measure), "{question}: {verify:#}");
        // Another key is contradicted.
        let mut moved = question.clone();
        moved["answer"] = json!(
            (question["answer"].as_u64().unwrap() + 1) % question["options"].as_array().unwrap().len() as u64
        );
        assert!(matches!(asked(&moved).found, ScaffoldOutcome::Contradicted { .. }), "{question}");
    }
}

/// What the words do not decide is not decided by chance: there is a skeleton, or nothing.
#[test]
fn questions_that_are_not_understood_get_a_skeleton() {
    let skeleton = |question: &Value| match asked(question).found {
        ScaffoldOutcome::Skeleton { verify, why } => Some((serde_json::to_value(verify).unwrap(), why)),
        ScaffoldOutcome::Open(_) => None,
        other => panic!("{question}: {other:#?}"),
    };
    let grows = ["It grows", "It shrinks"];
    // The quantity is unknown: the runs are filled in.
    let (verify, why) =
        skeleton(&choice("The bob becomes ten times as heavy. What happens to the sound?", &grows, 0))
            .unwrap();
    assert!(
        verify["runs"].as_object().unwrap().len() == 2 && why.contains("names no quantity"),
        "{verify:#} {why}"
    );
    assert_eq!(verify["options"], json!(["undecided", "undecided"]));
    // No control is named.
    assert!(skeleton(&choice("The rope gets longer. What happens to the period?", &grows, 0)).is_none());
    // The words of the options state nothing.
    let (verify, why) =
        skeleton(&choice("On the Moon, what happens to the period?", &["It sings", "It dances"], 0)).unwrap();
    assert!(
        verify["measure"].to_string().contains("period(") && why.contains("words of its options"),
        "{verify:#} {why}"
    );
}

#[test]
fn one_object_is_written_in_the_style_of_the_lesson() {
    let folder = folder();
    let lab = json!({"xml": PENDULUM, "stopAt": 6, "setup": "data.qpos[0] = 0.1", "controls": [{"label": "gravity", "unit": "m/s²", "apply": "model.opt.gravity[2] = -value", "min": 1.62, "max": 9.81, "value": 9.81, "reset": true}],
        "readouts": [{"label": "angle (rad)", "expr": "data.qpos[0]"}]});
    let question = |q: &str| {
        format!(
            "        {{\n            \"kind\": \"mcq\",\n            \"q\": \"{q}\",\n            \"options\": [\"longer\", \"shorter\"],\n            \"answer\": 0\n        }}"
        )
    };
    let quiz = format!(
        "{{\n    \"id\": \"sw\",\n    \"questions\": [\n{},\n{}\n    ]\n}}",
        question("With a lower gravity, what happens to the period?"),
        question("With a lower gravity, what happens to the sound?")
    );
    write(folder.path(), "a.md", &format!("```lab simlab\n{lab}\n```\n\n```quiz\n{quiz}\n```\n"));
    let text = || std::fs::read_to_string(folder.path().join("a.md")).unwrap();
    let run =
        |arguments: &[&str]| -> Done { run_in(folder.path(), &[&["scaffold", "a.md"], arguments].concat()) };
    let proposed = run(&[]);
    assert!(
        proposed.stdout.contains("in these runs, the key holds") && !proposed.stdout.contains("verified"),
        "{}",
        proposed.stdout
    );
    assert!(proposed.stdout.contains("a skeleton, which `--write sw.2` inserts"), "{}", proposed.stdout);
    let unknown = run(&["--write", "sw.9"]);
    assert!(unknown.code == 2 && unknown.stderr.contains("did you mean"), "{}", unknown.stderr);
    run(&["--write", "sw.2"]);
    assert_eq!(text().matches("\"verify\"").count(), 1);
    assert!(
        text().contains(
            "\n            \"verify\": {\n                \"lab\": \"#1\",\n                \"runs\": {\n"
        ),
        "{}",
        text()
    );
    run(&["--write"]);
    assert_eq!(text().matches("\"verify\"").count(), 2);
    assert!(text().contains("\"period\": \"period(data.qpos[0])\""), "{}", text());
}
