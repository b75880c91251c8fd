//! `labspec trace`: numbers of real lessons are traced to their runs, and its proposals, when accepted, verify.

#![allow(clippy::unwrap_used, clippy::panic)]

use crate::needs::needs;
use crate::support::workspace;
use labspec::bind::scene::Models;
use labspec::check::{self, CheckLevel};
use labspec::lint::{ModelFolder, load_lesson};
use labspec::source::SourceFile;
use labspec::spec::{LabAddress, Lesson};
use labspec::verify::QuoteState;
use labspec_proposals::trace::{Origin, blocks, format_verify, trace};

/// A lesson and its models.
struct Case {
    name: String,
    text: String,
    models: ModelFolder,
}

impl Case {
    fn open(path: &str) -> Option<Case> {
        if !needs("../shared/corpus") {
            return None;
        }
        let shared = workspace().join("../shared");
        let (file, models) = (shared.join(path), shared.join("corpus/models"));
        let text = std::fs::read_to_string(&file).unwrap();
        Some(Case { name: path.to_string(), text, models: ModelFolder::open(&models).unwrap() })
    }

    fn lesson(&self, text: &str) -> Lesson {
        load_lesson(SourceFile::new(self.name.as_str(), text), &self.models)
    }
}

/// A line for each number: its location, its text, and its origin.
fn traced(case: &Case) -> Vec<(usize, String, String)> {
    let lesson = case.lesson(&case.text);
    let models = Models::new(case.models.clone());
    let found = trace(&lesson, &models, &mut |_| ());
    let of = |origin: &Origin| match origin {
        Origin::From(hit) | Origin::Unsteady(hit) => {
            match hit.place.and_then(|(lab, trial)| found.run(lab, trial)) {
                Some((address, words)) => format!("{address} {words}: {}{}", hit.factor, hit.measure),
                None => format!("worked out: {}{}", hit.factor, hit.measure),
            }
        }
        Origin::Setting(words) => format!("set: {words}"),
        Origin::Claimed => "claimed".into(),
        Origin::Chance(_) => "chance".into(),
        Origin::Listed(line) => format!("listed in line {line}"),
        Origin::Unknown => "unknown".into(),
    };
    let line = |start: usize| lesson.file.position(start).line;
    found.numbers.iter().map(|n| (line(n.stated.span.start), n.stated.quote.clone(), of(&n.origin))).collect()
}

/// Accepts all proposals and checks the lesson: the number of right quotes, and the failures.
fn accepted(case: &Case) -> (usize, Vec<String>) {
    let lesson = case.lesson(&case.text);
    let models = Models::new(case.models.clone());
    let mut inserts: Vec<(usize, String)> = blocks(&trace(&lesson, &models, &mut |_| ()))
        .into_iter()
        .map(|(address, block)| {
            let at = match &address {
                LabAddress::Lab(_) => lesson.lab(&address).unwrap().span.start,
                LabAddress::Sim { quiz, question } => {
                    let of = |q: &&labspec::spec::Quiz| q.id.as_ref().is_some_and(|id| id.value == *quiz);
                    let quiz = lesson.quizzes.iter().find(of).unwrap();
                    quiz.questions[question - 1].as_ref().unwrap().span.start
                }
            };
            (at + 1, format!("\"verify\": {}, ", format_verify(&block)))
        })
        .collect();
    inserts.sort();
    let mut text = case.text.clone();
    for (at, insert) in inserts.iter().rev() {
        text.insert_str(*at, insert);
    }
    let lesson = case.lesson(&text);
    assert!(!lesson.has_errors(), "{:?}", lesson.findings);
    let checked = check::check_lesson(lesson, &models, CheckLevel::CLAIMS);
    let quotes = checked.claims.iter().flat_map(|c| &c.judgement.quotes);
    let right = quotes.clone().filter(|q| q.state == QuoteState::Right).count();
    let wrong = quotes.filter(|q| q.state != QuoteState::Right).map(|q| format!("{} {}", q.text, q.reason));
    (right, wrong.collect())
}

/// The expected origins of the numbers of the lesson (`NUMBERS.md`), by line and text: the run, and a part of the measure.
const LESSON: [(usize, &str, &str, &str); 35] = [
    (18, "1.0 m", "#1 as it stands", "max(data.qpos[2])"),
    (27, "0.442 s", "#1 as it stands", "first(contact('floor', 'heavy_geom'))"),
    (27, "0.460 s", "#1 with \"timestep h\" at 0.02", "first(contact('floor', 'heavy_geom'))"),
    (27, "0.37 mm", "#1 as it stands", ".size[0] - final(data.qpos[2])"),
    (27, "0.83 mm", "#1 with \"timestep h\" at 0.02", ".size[0] - final(data.qpos[2])"),
    (34, "9.81 m/s^2", "#1 as it stands", "-model.opt.gravity[2]"),
    (35, "0.95 m", "worked out", "1 - 0.05"),
    (35, "0.4401 s", "worked out", "Math.sqrt"),
    (35, "4.317 m/s", "worked out", "Math.sqrt"),
    (48, "-0.7357", "#2 with \"timestep h\" at 0.0005", "at(data.time >= 0.3"),
    (48, "-0.7358", "#2 with \"timestep h\" at 0.0005", "at(data.time >= 0.3"),
    (49, "-1.4715", "#2 with \"timestep h\" at 0.001", "at(data.time >= 0.3"),
    (50, "-2.9430", "#2 as it stands", "at(data.time >= 0.3"),
    (51, "-7.3575", "#2 with \"timestep h\" at 0.005", "at(data.time >= 0.3"),
    (52, "-14.7150", "#2 with \"timestep h\" at 0.01", "at(data.time >= 0.3"),
    (75, "0.4401 s", "worked out", "Math.sqrt"),
    (75, "4.317 m/s", "worked out", "Math.sqrt"),
    (76, "0.4400 s", "#1 as it stands", "first(contact('floor', 'heavy_geom')) - model.opt.timestep"),
    (76, "4.316 m/s", "#1 as it stands", "data.joint('heavy_free').qvel[2]"),
    (77, "0.4400 s", "#1 as it stands", "first(contact('floor', 'light_geom')) - model.opt.timestep"),
    (77, "4.316 m/s", "#1 as it stands", "data.joint('light_free').qvel[2]"),
    (78, "0.04963 m", "#1 as it stands", "final(data.qpos[2])"),
    (78, "0.367 mm", "#1 as it stands", ".size[0] - final(data.qpos[2])"),
    (79, "0.04963 m", "#1 as it stands", "final(data.qpos[9])"),
    (79, "0.367 mm", "#1 as it stands", ".size[0] - final(data.qpos[9])"),
    (86, "0.367 mm", "#1 as it stands", ".size[0] - final(data.qpos[2])"),
    (88, "4.3 m/s", "#1 as it stands", "before(contact('floor', 'heavy_geom')"),
    (88, "32 mm", "worked out", "4.3 / (50 * 2.718)"),
    (88, "29 mm", "#1 as it stands", ".size[0] - min(data.qpos[2])"),
    (91, "0.4400 s", "#1 as it stands", "first(contact('floor', 'heavy_geom')) - model.opt.timestep"),
    (91, "0.4401 s", "worked out", "Math.sqrt"),
    (98, "29 mm", "#1 as it stands", ".size[0] - min(data.qpos[2])"),
    (107, "12.2625", "#2 with \"timestep h\" at 0.005", "-at(data.time >= 0.5"),
    (108, "0.01226 m", "worked out", "0.5 * 9.81 * 0.005 * 0.5"),
    (108, "12.26 mm", "worked out", "0.5 * 9.81 * 0.005 * 0.5"),
];

/// Numbers with several right origins: constants of the model in the text, with the possible measures.
const OTHERS: [(&str, &str); 5] = [
    ("20 ms", "model.opt.timestep"),
    ("2 ms", "model.opt.timestep"),
    ("0.0020", "model.opt.timestep"),
    ("9.81 m/s^2", "model.opt.gravity[2]"),
    ("1.0 m", "model.body('ball').pos[2]"),
];

#[test]
fn numbers_of_a_real_lesson_are_traced() {
    let Some(case) = Case::open("lesson-0.1/lesson-0.1.md") else { return };
    let all = traced(&case);
    let mut untraced = Vec::new();
    for (line, quote, run, measure) in LESSON {
        let here = all.iter().filter(|(l, q, _)| (*l, q.as_str()) == (line, quote));
        if !here.clone().any(|(_, _, from)| from.contains(run) && from.contains(measure)) {
            untraced.push((line, quote, here.map(|(.., from)| from.as_str()).collect::<Vec<_>>()));
        }
    }
    assert!(untraced.is_empty(), "{untraced:#?}");
    // The other reported origins are right as well.
    for (line, quote, from) in &all {
        let set = ["set: ", "chance", "unknown", "listed"].iter().any(|w| from.starts_with(w));
        let listed = LESSON.iter().any(|(l, q, run, m)| {
            (l, q) == (line, &quote.as_str()) && from.contains(run) && from.contains(m)
        });
        let other = OTHERS.iter().any(|(q, m)| q == quote && from.contains(m));
        let mass = quote.ends_with(" kg") && from.contains(".mass[0]");
        let size = quote == "0.05 m" && from.contains(".size[0]");
        let height = quote == "1.0 m" && from.contains("max(data.qpos[2])");
        assert!(set || listed || other || mass || size || height, "line {line}: {quote} is {from}");
    }
}

#[test]
fn explanations_of_a_real_quiz_are_traced() {
    let Some(case) = Case::open("corpus/quizzes/5.1_01.json") else { return };
    let all = traced(&case);
    for (quote, run, measure) in [
        ("0.526 mrad", "as it stands", "final(1000 * (-1.2 - data.qpos[0]))"),
        ("0.665 mrad", "with \"link 2 mass\" at 1.6", "final(1000 * (-1.2 - data.qpos[0]))"),
        ("2.31", "as it stands", "final(data.qfrc_constraint[0])"),
        ("3.73 N m", "with \"link 2 mass\" at 1.6", "final(data.qfrc_"),
        ("5.886 N m", "worked out", "2 * 9.81 * 0.3"),
    ] {
        let found = all.iter().find(|(_, q, _)| q == quote).map_or("", |(.., from)| from.as_str());
        assert!(found.contains(run) && found.contains(measure), "{quote} is {found}");
    }
}

/// The question's own gripper holds a cube of 1.2 kg; its explanation refers to the cube that the course has used before, which
/// is that of the model file and of the lab.
#[test]
fn changes_of_a_setup_are_undone() {
    let found = |case: &Case, quote: &str| {
        traced(case).into_iter().find(|(_, q, _)| q == quote).map_or(String::new(), |(.., from)| from)
    };
    let Some(quiz) = Case::open("corpus/quizzes/5.3_01.json") else { return };
    assert_eq!(
        found(&quiz, "15.44 N"),
        "#5.3-check.5 after \"Grasp and lift\" is pressed, with the model as in its file: -final(data.actuator_force[3])"
    );
    // The mass is that of the unchanged lab.
    let mass = found(&quiz, "1.2 kg");
    assert!(mass.ends_with("as it stands: model.body('cube').mass[0]"), "1.2 kg is {mass}");

    // Next to the lab of the course, it is a readout of that lab.
    let lab = Case::open("corpus/labs/5.3_01_simlab.json").unwrap();
    let text = format!("# A grasp\n\n```lab simlab\n{}\n```\n\n```quiz\n{}\n```\n", lab.text, quiz.text);
    let both = Case { name: "5.3.md".into(), text, ..quiz };
    assert_eq!(
        found(&both, "15.44 N"),
        "#1 after \"Grasp and lift\" is pressed: final(-data.actuator_force[3])"
    );
}

/// A setting that the sentence names applies to its number.
#[test]
fn a_sentence_that_names_a_setting_prefers_its_run() {
    let Some(case) = Case::open("lesson-0.1/lesson-0.1.md") else { return };
    let all = traced(&case);
    let (.., from) = all.iter().find(|(line, quote, _)| (*line, quote.as_str()) == (88, "29 mm")).unwrap();
    assert_eq!(from, "#1 as it stands: 1000 * model.geom('heavy_geom').size[0] - min(data.qpos[2])");
}

/// The answer of a numeric question is claimed only by its `value`.
#[test]
fn an_answer_that_is_computed_is_claimed() {
    let folder = workspace().join("specs/models");
    let models = ModelFolder::open(&folder).unwrap();
    let quiz = |verify: &str| {
        format!(
            r#"{{"id": "fall", "questions": [{{"kind": "numeric", "q": "How fast is it after 0.3 s?", "answer": 2.943, "tol": 0.01, "unit": "m/s"{verify}}}]}}"#
        )
    };
    for (verify, origin) in [
        (r#", "verify": {"value": "9.81 * 0.3"}"#, "claimed"),
        (r#", "verify": {"says": [["0.3 s", "0.1 * 3"]]}"#, "unknown"),
        ("", "unknown"),
    ] {
        let case = Case { name: "a.json".into(), text: quiz(verify), models: models.clone() };
        let all = traced(&case);
        let answer: Vec<&str> = all.iter().filter(|n| n.1 == "2.943").map(|n| n.2.as_str()).collect();
        assert_eq!(answer, [origin], "{verify}");
    }
}

/// All proposals are true when they are accepted.
#[test]
fn proposals_verify() {
    for (path, least) in [
        ("lesson-0.1/lesson-0.1.md", 20),
        ("corpus/quizzes/5.1_01.json", 5),
        ("corpus/quizzes/5.3_01.json", 2),
        ("corpus/quizzes/2.3_01.json", 0),
        ("corpus/quizzes/4.2_01.json", 0),
        ("corpus/quizzes/9.1_01.json", 0),
        ("corpus/quizzes/9.3_01.json", 0),
    ] {
        let Some(case) = Case::open(path) else { return };
        let (right, wrong) = accepted(&case);
        assert!(wrong.is_empty() && right >= least, "{path}: {right} are right; {wrong:#?}");
    }
}

/// Quoted numbers are claimed, and are not proposed again.
#[test]
fn claimed_numbers_are_listed_as_claimed() {
    let folder = workspace().join("specs");
    let name = "specs/lessons/02-bounce-and-swing.md";
    let text = std::fs::read_to_string(workspace().join(name)).unwrap();
    let models = ModelFolder::open(&folder.join("models")).unwrap();
    let case = Case { name: name.to_string(), text, models };
    let lesson = case.lesson(&case.text);
    let quoted = |quote: &str| {
        let verifies = lesson.all_labs().into_iter().filter_map(|lab| lab.verify.as_ref());
        verifies.flat_map(|v| &v.says).any(|s| s.quote.as_str() == quote)
    };
    let all = traced(&case);
    let claimed = all.iter().filter(|(.., from)| from == "claimed").count();
    assert!(claimed > 5, "{claimed} of {}", all.len());
    for (line, quote, from) in all.iter().filter(|(_, quote, _)| quoted(quote)) {
        assert_eq!(from, "claimed", "line {line}: {quote}");
    }
    // Without quotes, only its answers are claimed.
    let silent = Case { text: case.text.replace("\"says\": [", "\"says\": [], \"was\": ["), ..case };
    let all = traced(&silent);
    let claimed: Vec<&str> = all.iter().filter(|n| n.2 == "claimed").map(|n| n.1.as_str()).collect();
    let lesson = silent.lesson(&silent.text);
    let answers = lesson.quizzes.iter().flat_map(|quiz| quiz.numbered()).filter(|(_, question)| {
        question.numeric().is_some() && question.verify.as_ref().is_some_and(|v| v.value.is_some())
    });
    assert!(claimed.len() == answers.count() && claimed.len() < all.len(), "{claimed:?}");
}
