//! Quotes in all forms: several numbers and words in one quote, tables of words, comments before a block, shared
//! runs, labs of other lessons.

#![allow(clippy::unwrap_used, clippy::panic)]

use crate::support::{check_text, codes};
use labspec::bind::scene::Models;
use labspec::check::{self, CheckLevel, Checked};
use labspec::lint::{ModelFolder, load_lesson_file};
use labspec::verify::{Judgement, QuoteState, Verdict};
use serde_json::{Value, json};

/// Runge–Kutta: a fall is exact with any timestep.
const BALL: &str = "<mujoco><option integrator='RK4'/><worldbody><geom name='floor' type='plane' size='1 1 1'/><body name='ball' pos='0 0 1'><freejoint/><geom name='ball' type='sphere' size='0.05' mass='1'/></body></worldbody></mujoco>";

/// A lab with a ball 0.95 m above a floor, with claims.
fn lab(verify: Value) -> String {
    let mut lab = json!({
        "title": "A ball above a floor", "xml": BALL,
        "controls": [{"label": "gravity", "unit": "m/s^2", "set": "model.opt.gravity[2]", "min": -20, "max": -1, "step": 0.01, "value": -9.81, "reset": true}],
        "readouts": [{"label": "height (m)", "expr": "data.qpos[2]", "digits": 3}]
    });
    if !verify.is_null() {
        lab["verify"] = verify;
    }
    format!("\n```lab simlab\n{lab}\n```\n")
}

/// Two falls: on the earth 0.440 s, on the moon 1.083 s.
fn two_falls() -> Value {
    json!({
        "runs": {"earth": {"until": 2}, "moon": {"set": {"gravity": -1.62}, "until": 2}},
        "measure": {"lands": "crossing(data.qpos[2] - 0.05)", "speed": "at(data.time > 0.4, -data.qvel[2])"}
    })
}

fn with(mut object: Value, more: Value) -> Value {
    object.as_object_mut().unwrap().extend(more.as_object().unwrap().clone());
    object
}

/// The state of every quote of the first claim, and the codes of all findings.
fn quotes(prose: &str, says: Value) -> (Vec<QuoteState>, Vec<&'static str>) {
    let checked = check_text("fall.md", &format!("{prose}\n{}", lab(with(two_falls(), says))));
    let states = checked.claims[0].judgement.quotes.iter().map(|q| q.state).collect();
    (states, codes(&checked))
}

const RIGHT: QuoteState = QuoteState::Right;
const WRONG: QuoteState = QuoteState::Wrong;
const UNCLEAR: QuoteState = QuoteState::Unclear;

/// The results of a claim by name.
fn judged(checked: &Checked, name: &str) -> Judgement {
    let claims = checked.claims.iter();
    let names: Vec<&str> = claims.clone().map(|c| c.name.as_str()).collect();
    claims.into_iter().find(|c| c.name == name).unwrap_or_else(|| panic!("{names:?}")).judgement.clone()
}

#[test]
fn one_quote_may_state_several_numbers() {
    let prose = "It takes 0.440 s here and 1.083 s on the moon.";
    let says = |text: &str, exprs: [&str; 2]| json!({"says": [[text, exprs]]});
    let both = ["earth.lands", "moon.lands"];
    assert_eq!(quotes(prose, says("0.440 s here and 1.083 s", both)), (vec![RIGHT, RIGHT], vec![]));
    // In the other order, both are wrong, each at its own number.
    let (states, codes) = quotes(prose, says("0.440 s here and 1.083 s", ["moon.lands", "earth.lands"]));
    assert_eq!((states, codes), (vec![WRONG, WRONG], vec!["quote-wrong", "quote-wrong"]));
    // One expression for two numbers, or two for one, is not a valid claim.
    let (states, codes) = quotes(prose, says("0.440 s", both));
    assert_eq!((states, codes), (vec![UNCLEAR], vec!["quote-unclear"]));
    // A false second number is found.
    let (states, _) =
        quotes("It takes 0.440 s here and 1.093 s on the moon.", says("0.440 s here and 1.093 s", both));
    assert_eq!(states, [RIGHT, WRONG]);
}

#[test]
fn words_are_a_condition() {
    let says = |text: &str, expr: &str| json!({"says": [[text, expr]]});
    let slower = "moon.lands > 2 * earth.lands";
    assert_eq!(quotes("On the moon it is slower by far.", says("slower by far", slower)).0, [RIGHT]);
    let (states, codes) = quotes("On the moon it is faster.", says("faster", "moon.lands < earth.lands"));
    assert_eq!((states, codes), (vec![WRONG], vec!["quote-wrong"]));
    // Whole words, and words that a reader sees.
    let (states, codes) = quotes("On the moon it is much slowerer.", says("much slower", slower));
    assert_eq!((states, codes), (vec![UNCLEAR], vec!["quote-not-found"]));
    // A comparison with NaN proves nothing, and a constant is not evidence.
    let (states, codes) = quotes("It is slow.", says("slow", "!(earth.lands < 0 / 0)"));
    assert!(states == [UNCLEAR] && codes.contains(&"compares-nan"), "{codes:?}");
    let (states, codes) = quotes("It is slow.", says("slow", "true"));
    assert_eq!((states, codes), (vec![UNCLEAR], vec!["constant-claim"]));
    // A number is not checked by a condition.
    let (states, codes) = quotes("It lands after 0.440 s.", says("after 0.440 s", slower));
    assert_eq!((states, codes), (vec![UNCLEAR], vec!["quote-unclear"]));
    // Together with a number in one quote.
    let mixed = json!({"says": [["1.083 s, far slower", ["moon.lands", slower]]]});
    assert_eq!(quotes("It lands after 1.083 s, far slower.", mixed).0, [RIGHT, RIGHT]);
    // If the last digits decide a condition, the words are never right.
    let edge = "earth.speed > 4.316400";
    let (_, codes) = quotes("It is fast.", says("fast", edge));
    assert!(codes.iter().all(|c| ["quote-of-timestep", "quote-wrong"].contains(c)), "{codes:?}");
}

#[test]
fn a_table_may_have_words() {
    let table =
        |second: &str| format!("| gravity | it |\n|---|---|\n| -9.81 | lands |\n| -1.62 | {second} |");
    let claim = json!({
        "runs": {"fall": {"sweep": {"gravity": [-9.81, -1.62]}, "until": 1}},
        "measure": {"touch": "crossing(data.qpos[2] - 0.05)", "low": "min(data.qpos[2])"},
        "table": [{"column": "it", "by": ["gravity", "fall.value"], "is": {
            "lands": "fall.low.map(z => z < 0.05)", "is in the air": "fall.low.map(z => z > 0.06)"}}]
    });
    let states = |text: &str, claim: &Value| -> (Vec<QuoteState>, Vec<&'static str>) {
        let checked = check_text("fall.md", &format!("{text}\n{}", lab(claim.clone())));
        (checked.claims[0].judgement.quotes.iter().map(|q| q.state).collect(), codes(&checked))
    };
    assert_eq!(states(&table("is in the air"), &claim), (vec![RIGHT, RIGHT], vec![]));
    assert_eq!(states(&table("lands"), &claim), (vec![RIGHT, WRONG], vec!["quote-wrong"]));
    // Two words that hold in the same row are ambiguous.
    let mut loose = claim.clone();
    loose["table"][0]["is"]["lands"] = json!("fall.low.map(z => z < 2)");
    assert_eq!(states(&table("is in the air"), &loose).0, [RIGHT, UNCLEAR]);
    let (found, codes) = states(&table("hovers"), &claim);
    assert_eq!((found, codes), (vec![RIGHT, UNCLEAR], vec!["quote-unclear"]));
    let mut counted = claim.clone();
    counted["table"][0]["is"] = json!({"lands 1 time": "fall.low.map(z => z < 0.05)"});
    let text = table("is in the air").replace("| lands |", "| lands 1 time |");
    assert_eq!(states(&text, &counted).0, [UNCLEAR, UNCLEAR]);
    let only = json!({"lands": "fall.low.map(z => z < 0.05)"});
    let mut alone = claim.clone();
    alone["table"][0]["is"] = only;
    assert_eq!(states(&table("lands"), &alone), (vec![RIGHT, WRONG], vec!["quote-wrong"]));
}

#[test]
fn a_comment_is_about_the_block_that_follows() {
    let claim = with(two_falls(), json!({"lab": "#1", "says": [["0.440 s", "earth.lands"]]}));
    let text = |block: &str| format!("{}\n<!-- labspec verify\n{claim}\n-->\n{block}\n", lab(Value::Null));
    for block in [
        "It takes 0.440 s.",
        "| time |\n|---|\n| 0.440 s |",
        "$$t = 0.440\\,\\mathrm{s}$$",
        "```text\nlanded after 0.440 s\n```",
    ] {
        let checked = check_text("fall.md", &text(block));
        assert_eq!(codes(&checked), [] as [&str; 0], "{block}");
        let line = checked.lesson.file.position(checked.lesson.claim_comments[0].span.start).line;
        let judged = judged(&checked, &format!("comment in line {line}"));
        assert_eq!(judged.quotes.iter().map(|q| q.verdict()).collect::<Vec<_>>(), ["verified"], "{block}");
    }
    // Elsewhere, the same text is another claim, which does not exist.
    let far = check_text("fall.md", &text("It falls.\n\nIt takes 0.440 s."));
    assert_eq!(codes(&far), ["quote-not-found"]);
    assert!(labspec::verify::claimed(&far.lesson).is_empty());
    // A false number at the comment is found, even if the right number is elsewhere.
    let lie = check_text("fall.md", &text("It takes 0.450 s.\n\nIt takes 0.440 s."));
    assert_eq!(codes(&lie), ["quote-not-found"]);
    // An error in a comment has a location.
    let broken = check_text("fall.md", &text("x").replace("\"says\"", "says"));
    assert!(codes(&broken).contains(&"json-syntax"), "{:?}", codes(&broken));
    let unknown = check_text("fall.md", &text("It takes 0.440 s.").replace("\"#1\"", "\"#7\""));
    assert!(codes(&unknown).contains(&"unknown-lab"), "{:?}", codes(&unknown));
}

#[test]
fn runs_and_measures_are_shared() {
    let lab = lab(with(two_falls(), json!({"says": [["0.440 s", "earth.lands"]]})));
    let question = |verify: Value| {
        json!({"id": "q", "questions": [{"kind": "numeric", "q": "How long on the moon?", "answer": 1.083, "tol": 0.001, "unit": "s",
            "explain": "1.083 s", "verify": verify}]})
    };
    let text = |verify: Value| format!("It takes 0.440 s.\n{lab}\n```quiz\n{}\n```\n", question(verify));
    let good = json!({"use": "#1", "value": "moon.lands", "says": [["1.083 s", "moon.lands"]]});
    let checked = check_text("fall.md", &text(good));
    assert_eq!(codes(&checked), [] as [&str; 0]);
    let judged = judged(&checked, "quiz q, question 1");
    assert_eq!(judged.answer.unwrap().verdict, Verdict::Verified);
    assert_eq!(judged.runs.iter().map(|r| r.name.as_str()).collect::<Vec<_>>(), ["earth", "moon"]);
    // A name that both objects define has the local meaning.
    let verify = json!({"use": "#1", "runs": {"moon": {"set": {"gravity": -3.24}, "until": 2}}, "value": "moon.lands"});
    let checked = check_text("fall.md", &text(verify));
    assert!(codes(&checked).contains(&"answer-refuted"), "{:?}", codes(&checked));
    // A missing object is reported, and so is one that uses itself.
    let none = json!({"use": "#2", "lab": "#1", "value": "max(data.time)"});
    assert!(codes(&check_text("fall.md", &text(none))).contains(&"unknown-lab"));
    let itself = json!({"use": "#q.1", "lab": "#1", "value": "crossing(data.qpos[2] - 0.05)"});
    let checked = check_text("fall.md", &text(itself));
    assert_eq!(codes(&checked), ["unknown-lab"]);
}

#[test]
fn the_tolerance_rejects_values_of_mistakes() {
    let question = |tol: f64, wrong: &str| {
        let verify = json!({"lab": "#1", "value": "crossing(data.qpos[2] - 0.05)", "wrong": [wrong]});
        let quiz = json!({"id": "q", "questions": [{"kind": "numeric", "q": "How long?", "answer": 0.440, "tol": tol, "unit": "s",
            "verify": verify}]});
        let checked = check_text("fall.md", &format!("{}\n```quiz\n{quiz}\n```\n", lab(Value::Null)));
        let verdict = checked.claims[0].judgement.answer.as_ref().unwrap().verdict;
        (verdict, codes(&checked))
    };
    let forgets_the_radius = "Math.sqrt(2 * 1 / 9.81)";
    assert_eq!(question(0.005, forgets_the_radius), (Verdict::Verified, vec![]));
    assert_eq!(question(0.02, forgets_the_radius), (Verdict::Ambiguous, vec!["answer-ambiguous"]));
    assert_eq!(question(0.005, "no_such_thing").0, Verdict::Failed);
}

#[test]
fn a_claim_can_use_a_lab_of_another_lesson() {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, text: &str| std::fs::write(folder.path().join(name), text).unwrap();
    let claim = |lab: &str| with(two_falls(), json!({"lab": lab, "value": "earth.lands"}));
    let quiz = |lab: &str| {
        let quiz = json!({"id": "q", "questions": [{"kind": "numeric", "q": "How long?", "answer": 0.440, "tol": 0.001, "unit": "s",
            "verify": claim(lab)}]});
        format!("# Quiz\n\n```quiz\n{quiz}\n```\n")
    };
    let models = Models::new(ModelFolder::unknown());
    let check = |name: &str| {
        let lesson = load_lesson_file(&folder.path().join(name), models.folder()).unwrap();
        check::check_lesson(lesson, &models, CheckLevel::FULL)
    };
    write("labs.md", &format!("# Labs\n{}{}", lab(Value::Null), lab(Value::Null)));
    write("quiz.md", &quiz("labs.md#2"));
    let checked = check("quiz.md");
    assert_eq!(codes(&checked), [] as [&str; 0]);
    assert_eq!(judged(&checked, "quiz q, question 1").answer.unwrap().verdict, Verdict::Verified);
    // A change of the other lesson changes the result here, with a finding where it is named.
    write(
        "labs.md",
        &format!("# Labs\n{}{}", lab(Value::Null), lab(Value::Null).replace("0 0 1", "0 0 0.9")),
    );
    assert!(codes(&check("quiz.md")).contains(&"answer-refuted"));
    for (name, says) in [
        ("labs.md#3", "has no lab #3: it has #1, #2"),
        ("none.md#1", "none.md"),
        ("labs.txt#1", "a lab must be in a lesson"),
        ("/labs.md#1", "by its path from this one"),
    ] {
        write("quiz.md", &quiz(name));
        let checked = check("quiz.md");
        let found: Vec<_> = checked.findings.iter().filter(|f| f.code == "unknown-lab").collect();
        assert!(found.len() == 1 && found[0].message.contains(says), "{name}: {:#?}", checked.findings);
        assert_eq!(checked.lesson.file.slice(found[0].span.clone()), format!("\"{name}\"").trim_matches('"'));
        assert_eq!(judged(&checked, "quiz q, question 1").answer.unwrap().verdict, Verdict::Failed);
    }
    // Invalid code in the other lesson is reported there; here, the finding states that nothing could be checked.
    write("quiz.md", &quiz("labs.md#1"));
    write("labs.md", &lab(Value::Null).replace("data.qpos[2]", "data.qpo[2]"));
    let checked = check("quiz.md");
    assert_eq!(judged(&checked, "quiz q, question 1").answer.unwrap().verdict, Verdict::Failed);
    assert!(!checked.findings.is_empty(), "it is said");
}

#[test]
fn a_measure_may_look_at_the_sample_before() {
    // Its speed is largest just before it is slowed down.
    let begins = "first(-data.qvel[2] < previous(-data.qvel[2]))";
    let claim = |expr: &str| {
        json!({"runs": {"earth": {"until": 1}}, "measure": {"slows": expr, "lands": "crossing(data.qpos[2] - 0.05)"},
            "says": [["as it lands", "Math.abs(slows - lands) < 0.003"]]})
    };
    let checked = check_text("fall.md", &format!("It slows as it lands.\n{}", lab(claim(begins))));
    assert_eq!(codes(&checked), [] as [&str; 0], "{:#?}", checked.claims[0].judgement.measures);
    // Inside a condition, another measure has its value so far.
    let far = "crossing(data.qpos[2], max(data.qpos[2]) - 0.1)";
    let claim =
        json!({"runs": {"earth": {"until": 1}}, "measure": {"far": far}, "says": [["0.143 s", "far"]]});
    let checked = check_text("fall.md", &format!("After 0.143 s it has fallen 10 cm.\n{}", lab(claim)));
    assert_eq!(codes(&checked), [] as [&str; 0], "{:#?}", checked.claims[0].judgement.measures);
}

#[test]
fn the_displayed_value_of_a_slider_is_stated() {
    let says = json!({"says": [["-9.810 m/s^2", "model.opt.gravity[2]"]]});
    let checked = check_text("fall.md", &format!("A ball falls.\n{}", lab(says.clone())));
    assert_eq!(codes(&checked), [] as [&str; 0]);
    // The quote does not match if the slider has another value.
    let other = check_text(
        "fall.md",
        &format!("A ball falls.\n{}", lab(says).replace("\"value\":-9.81", "\"value\":-9.8")),
    );
    assert_eq!(codes(&other), ["quote-not-found"]);
}

/// Claims that would take too long or too much memory are reported and not evaluated.
#[test]
fn excessive_claims_are_reported() {
    let began = std::time::Instant::now();
    // Many objects that each use one of a megabyte.
    let long = "1 + ".repeat(250_000) + "1";
    let mut text = lab(json!({"measure": {"long": long}, "says": [["1 m", "long"]]}));
    let users: String = (0..1500)
        .map(|_| "<!-- labspec verify {\"use\": \"#1\", \"says\": [[\"1 m\", \"long\"]]} -->\n\n1 m\n\n")
        .collect();
    text.push_str(&users);
    let checked = check_text("fall.md", &text);
    assert!(codes(&checked).contains(&"unknown-lab"), "{:?}", &codes(&checked)[..9]);
    // More words than the limit, in a long text.
    let words: Vec<Value> =
        (0..5000).map(|i| json!([format!("word {}", "x".repeat(1 + i % 300)), "1 < 2 * height"])).collect();
    let text = format!(
        "{}\n{}",
        "so many words ".repeat(100_000),
        lab(json!({"measure": {"height": "final(data.qpos[2])"}, "says": words}))
    );
    let checked = check_text("fall.md", &text);
    assert!(checked.claims[0].judgement.quotes.iter().all(|q| q.state == UNCLEAR));
    assert!(began.elapsed().as_secs() < 60, "{:?}", began.elapsed());
}
