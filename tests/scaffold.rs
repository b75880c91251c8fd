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
        let with = written(&lesson, &all);
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
    let text = written(&lesson, &all);
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
            "words of its options",
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
