//! `labspec scaffold`: proposals for real questions verify without changes, and a wrong key gets none.

#![allow(clippy::unwrap_used, clippy::panic)]

use crate::needs::needs;
use crate::support::workspace;
use labspec::bind::scene::Models;
use labspec::lint::{ModelFolder, load_lesson};
use labspec::source::SourceFile;
use labspec::spec::Lesson;
use labspec::verify::Verdict;
use labspec_proposals::scaffold::{Scaffold, ScaffoldOutcome, scaffold, written};
use serde_json::Value;

fn scaffold_text(name: &str, text: &str, models: &Models) -> (Lesson, Vec<Scaffold>) {
    let lesson = load_lesson(SourceFile::new(name, text), models.folder());
    let all = scaffold(&lesson, models, &mut |_| ());
    (lesson, all)
}

fn outcome_of<'s>(all: &'s [Scaffold], name: &str) -> &'s ScaffoldOutcome {
    &all.iter().find(|one| one.name == name).unwrap_or_else(|| panic!("{name}: {all:?}")).found
}

fn verified(found: &ScaffoldOutcome) -> bool {
    matches!(found, ScaffoldOutcome::Proposed { verdict: Some((Verdict::Verified, _)), .. })
}

/// The `predict` questions of a public course and of a first lesson: each proposal verifies without an edit; with the key moved
/// to any other option, nothing is proposed that would verify it.
#[test]
fn predictions_of_real_lessons_are_scaffolded() {
    if !needs("../shared/corpus") {
        return;
    }
    let shared = workspace().join("../shared");
    let models = Models::new(ModelFolder::open(&shared.join("corpus/models")).unwrap());
    let mut good = 0;
    for (file, names) in [
        ("lesson-0.1/lesson-0.1.md", &["quiz 0.1-predict, question 1", "quiz 0.1-predict, question 2"][..]),
        ("corpus/quizzes/5.1_01.json", &["quiz 5.1-check, question 3"]),
        ("corpus/quizzes/5.3_01.json", &["quiz 5.3-check, question 5"]),
    ] {
        let text = std::fs::read_to_string(shared.join(file)).unwrap();
        let (lesson, all) = scaffold_text(file, &text, &models);
        for name in names {
            assert!(verified(outcome_of(&all, name)), "{name}: {:#?}", outcome_of(&all, name));
            good += 1;
        }
        let with = written(&lesson, &all, &[]);
        for line in text.lines() {
            let is_unchanged = with.lines().any(|new| {
                new == line || new.trim_end_matches(',') == line.trim_end_matches(['}', ']', ' '])
            });
            assert!(is_unchanged || line.contains('}'), "{file}: the line is not kept: {line}");
        }
        let moved =
            text.replace("\"answer\": 1,", "\"answer\": 0,").replace("\"answer\": 2,", "\"answer\": 1,");
        let (_, all) = scaffold_text(file, &moved, &models);
        for name in names {
            assert!(
                matches!(outcome_of(&all, name), ScaffoldOutcome::Contradicted { .. }),
                "{name}: {:#?}",
                outcome_of(&all, name)
            );
        }
    }
    assert_eq!(good, 4);
}

const BALL: &str = "<mujoco><worldbody><geom name='floor' type='plane' size='1 1 1'/><body name='ball' pos='0 0 1'><freejoint/><geom name='ball' size='.05' mass='1'/></body></worldbody></mujoco>";

fn quiz(question: &str) -> String {
    let lab = format!(
        r#"{{"xml": "{BALL}", "stopAt": 0.3, "controls": [{{"label": "gravity", "unit": "m/s^2", "apply": "model.opt.gravity[2] = -value", "min": 1, "max": 20, "step": 1, "value": 10, "reset": true}}], "readouts": [{{"label": "height (m)", "expr": "data.qpos[2]", "digits": 3}}]}}"#
    );
    format!(
        "# Falls\n\n```lab simlab\n{lab}\n```\n\n```quiz\n{{\"id\": \"fall\", \"questions\": [\n  {question}\n]}}\n```\n"
    )
}

fn one(question: &str) -> (Lesson, Vec<Scaffold>) {
    scaffold_text("fall.md", &quiz(question), &Models::new(ModelFolder::unknown()))
}

#[test]
fn words_for_changes_select_a_control() {
    let ask = |answer: usize| {
        format!(
            r#"{{"kind": "mcq", "q": "You halve the gravity. How high is the ball after 0.3 s?", "options": ["Higher than before", "Lower than before", "At the same height"], "answer": {answer}}}"#
        )
    };
    let (lesson, all) = one(&ask(0));
    let ScaffoldOutcome::Proposed { verify, verdict, undecided, values } =
        outcome_of(&all, "quiz fall, question 1")
    else {
        panic!("{all:?}")
    };
    let verify = serde_json::to_value(verify).unwrap();
    assert_eq!(verdict.as_ref().map(|(v, _)| *v), Some(Verdict::Verified), "{verify:#} {verdict:?}");
    assert!(undecided.is_empty() && values.len() == 2 && values[1].1 > values[0].1, "{values:?}");
    assert!(verify["runs"].as_object().unwrap().values().any(|r| r["set"]["gravity"] == 5.0), "{verify:#}");
    // The written objects are parsed, and nothing else has changed.
    let text = written(&lesson, &all, &[]);
    let again = load_lesson(SourceFile::new("fall.md", text.as_str()), &ModelFolder::unknown());
    assert_eq!(
        again.verifies().count(),
        lesson.verifies().count()
            + all.iter().filter(|s| matches!(s.found, ScaffoldOutcome::Proposed { .. })).count()
    );
    let plain: Value =
        serde_json::from_str(text.split("```quiz").nth(1).unwrap().split("```").next().unwrap()).unwrap();
    assert_eq!(plain["questions"][0]["verify"], verify);
    let (_, all) = one(&ask(1));
    assert!(
        matches!(outcome_of(&all, "quiz fall, question 1"), ScaffoldOutcome::Contradicted { option: 0, .. }),
        "{all:?}"
    );
}

#[test]
fn undecidable_proposals_are_omitted_with_the_reason() {
    for (question, why) in [
        (
            r#"{"kind": "mcq", "q": "Why does it fall?", "options": ["Because of its weight", "By chance"], "answer": 0}"#,
            "names no control",
        ),
        (r#"{"kind": "numeric", "q": "How many legs has a spider?", "answer": 8}"#, "no run"),
        (r#"{"kind": "mcq", "q": "What happens?", "options": ["It rises", "It stays the same"]}"#, "no key"),
    ] {
        let (_, all) = one(question);
        let ScaffoldOutcome::Open(reason) = outcome_of(&all, "quiz fall, question 1") else {
            panic!("{question}: {all:?}")
        };
        assert!(reason.contains(why), "{question}: {reason}");
    }
    let numeric = r#"{"kind": "numeric", "q": "With which speed does it fall after 0.3 s?", "answer": 2.943, "tol": 0.01, "unit": "m/s", "explain": "<p>$v = g t = 9.81 \\times 0.3$ = 2.943 m/s.</p>"}"#;
    let (_, all) = one(numeric);
    let ScaffoldOutcome::Proposed { verdict: Some((verdict, _)), .. } =
        outcome_of(&all, "quiz fall, question 1")
    else {
        panic!("{all:?}")
    };
    assert!(matches!(verdict, Verdict::Verified | Verdict::Computed));
}

/// Two carts with springs between them on a rail.
fn carts(question: &str) -> ScaffoldOutcome {
    let carts = "<mujoco><option gravity='0 0 0' timestep='0.0005' integrator='RK4'/><default><joint type='slide' axis='1 0 0'/><geom size='.05' mass='1' condim='1' solref='-20000 0'/></default><worldbody><body name='red' pos='-.5 0 0'><joint name='red'/><geom name='red'/></body><body name='blue'><joint name='blue'/><geom name='blue'/></body></worldbody></mujoco>";
    let lab = format!(
        r#"{{"xml": "{carts}", "stopAt": 1.5, "setup": "data.qvel[0] = ctx.speed", "controls": [
          {{"label": "mass of the blue cart", "unit": "kg", "apply": "model.body_mass[2] = value; mj.mj_setConst(model, data)", "min": 0.5, "max": 4, "step": 0.5, "value": 1, "reset": true}},
          {{"label": "speed of the red cart", "unit": "m/s", "param": "speed", "min": 0.5, "max": 2, "step": 0.5, "value": 1, "reset": true}}],
        "plots": [{{"ylabel": "velocity (m/s)", "traces": [{{"label": "red (m/s)", "expr": "data.joint('red').qvel[0]"}}, {{"label": "blue (m/s)", "expr": "data.joint('blue').qvel[0]"}}]}}],
        "readouts": [{{"label": "momentum (kg m/s)", "expr": "model.body_mass[1] * data.qvel[0] + model.body_mass[2] * data.qvel[1]"}}]}}"#
    );
    let text = format!(
        "# Carts\n\n```lab simlab\n{lab}\n```\n\n```quiz\n{{\"id\": \"carts\", \"questions\": [\n  {question}\n]}}\n```\n"
    );
    let (_, all) = scaffold_text("carts.md", &text, &Models::new(ModelFolder::unknown()));
    outcome_of(&all, "quiz carts, question 1").clone()
}

/// Every form of question: the key is verified, and another key gets no proposal.
#[test]
fn forms_of_questions_are_decided() {
    let options = |words: &[&str]| serde_json::to_string(words).unwrap();
    for (kind, q, choices, key, wrong) in [
        (
            "mcq",
            "The blue cart has 2 kg. Which cart is faster after the collision?",
            options(&["The red one", "The blue one", "Both are equally fast"]),
            "1",
            "0",
        ),
        (
            "mcq",
            "With which mass of the blue cart is the blue cart fastest after the collision?",
            options(&["0.5", "2", "4"]),
            "0",
            "2",
        ),
        (
            "mcq",
            "The mass of the blue cart is raised from 1 kg to 2 kg. How fast is the blue cart after the collision?",
            options(&["Half as fast", "A third slower", "Just as fast", "More than twice as fast"]),
            "1",
            "2",
        ),
        (
            "multiple",
            "Which of these changes make the blue cart slower after the collision?",
            options(&[
                "A larger mass of the blue cart",
                "A smaller mass of the blue cart",
                "A smaller speed of the red cart",
            ]),
            "[0, 2]",
            "[0]",
        ),
        (
            "multiple",
            "The mass of the blue cart is raised from 1 kg to 2 kg. Which of these become smaller?",
            options(&[
                "The momentum",
                "The largest speed of the blue cart",
                "The largest speed of the red cart",
            ]),
            "[1]",
            "[0, 1]",
        ),
    ] {
        let ask = |key: &str| {
            carts(&format!(r#"{{"kind": "{kind}", "q": "{q}", "options": {choices}, "answer": {key}}}"#))
        };
        let found = ask(key);
        assert!(verified(&found), "{q}: {found:#?}");
        let found = ask(wrong);
        assert!(!matches!(found, ScaffoldOutcome::Proposed { .. }), "{q} with the key {wrong}: {found:#?}");
    }
    for (statement, truth) in [
        ("With a blue cart of 2 kg instead of 1 kg, the blue cart is faster after the collision.", false),
        ("With a heavier blue cart, the blue cart is slower after the collision.", true),
    ] {
        let ask =
            |key: bool| carts(&format!(r#"{{"kind": "truefalse", "q": "{statement}", "answer": {key}}}"#));
        let found = ask(truth);
        assert!(verified(&found), "{statement}: {found:#?}");
        assert!(!matches!(ask(!truth), ScaffoldOutcome::Proposed { .. }), "{statement}");
    }
    // A number of a run whose setting the question does not state is no proposal.
    let numeric = |q: &str, answer: &str| {
        carts(&format!(
            r#"{{"kind": "numeric", "q": "{q}", "answer": {answer}, "tol": 0.01, "unit": "m/s"}}"#
        ))
    };
    assert!(verified(&numeric("The blue cart has 3 kg. How fast is it after the collision?", "0.5")));
    let found = numeric("How fast is the blue cart after the collision?", "0.667");
    assert!(!matches!(found, ScaffoldOutcome::Proposed { .. }), "{found:#?}");
}
