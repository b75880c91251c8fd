//! What a verified lesson comes to: one small lesson for every verdict, with everything its author reads.

#![allow(clippy::unwrap_used)]

use crate::support::check_text;
use labspec::report;
use labspec::verify::Verdict;
use std::fmt::Write;

/// A ball above a floor, and a question about it.
fn lesson(prose: &str, question: &str) -> String {
    format!(
        r#"# A falling ball

{prose}

```lab simlab
{{
  "title": "A ball above a floor",
  "xml": "<mujoco><worldbody><geom name='floor' type='plane' size='1 1 1'/><body name='ball' pos='0 0 1'><freejoint/><geom name='ball' type='sphere' size='0.05' mass='1'/></body></worldbody></mujoco>",
  "controls": [
    {{"label": "gravity", "unit": "m/s^2", "set": "model.opt.gravity[2]", "min": -20, "max": -1, "step": 0.005, "value": -9.81, "reset": true}},
    {{"label": "timestep", "unit": "s", "set": "model.opt.timestep", "min": 0.001, "max": 0.02, "step": 0.001, "value": 0.002, "reset": true}},
    {{"type": "button", "label": "Kick", "run": "data.qvel[2] = 3"}}
  ],
  "readouts": [{{"label": "height (m)", "expr": "data.qpos[2]"}}]
}}
```

```quiz
{{
  "id": "fall",
  "questions": [
{question}
  ]
}}
```
"#
    )
}

/// Checks a lesson, holds its verdict and shows everything else as a snapshot.
fn expect(name: &str, verdict: Verdict, prose: &str, question: &str) {
    let text = lesson(prose, question);
    let checked = check_text("fall.md", &text);
    let claim = &checked.claims[0];
    let answer = claim.judgement.answer.as_ref().unwrap();
    let mut shown = format!("{}: {} {}\n", claim.name, answer.verdict.as_str(), answer.reason);
    for quote in &claim.judgement.quotes {
        let _ = writeln!(shown, "  {}: {} {}", quote.text, quote.verdict(), quote.reason);
    }
    for m in &claim.judgement.measures {
        // Nine digits: the last bits are no promise to a reader.
        let halved = m.halved.map_or(String::new(), |x| format!(", {x:.9} at half the timestep"));
        let _ = writeln!(shown, "  {} = {:.9}{halved}", m.name, m.value);
    }
    for weight in &answer.weights {
        let margin = weight.margin.map_or("-".into(), |m| format!("{m:.9}"));
        let _ = writeln!(shown, "  option {:?}: {}, margin {margin}", weight.option, weight.words());
    }
    let _ = write!(shown, "\n{}", report::human(&checked.findings, &[&checked.lesson.file], false));
    insta::with_settings!({prepend_module_to_snapshot => false, omit_expression => true}, {
        insta::assert_snapshot!(format!("verify-{name}"), shown);
    });
    assert_eq!(answer.verdict, verdict);
    assert_eq!(checked.claims.len(), 1);
}

const TWO_GRAVITIES: &str = r#""runs": {"earth": {"until": 1}, "half": {"set": {"gravity": -4.905}, "until": 1}},
      "measure": {"touch": "first(contact('ball', 'floor'))"}"#;

/// A question on two runs, with an answer and three conditions.
fn choice(answer: usize, conditions: [&str; 3]) -> String {
    format!(
        r##"    {{
      "q": "Gravity is halved. When does the ball reach the floor?",
      "options": ["Later, by a factor of 1.4", "Later, by a factor of 2", "At the same time"],
      "answer": {answer},
      "verify": {{"lab": "#1", {TWO_GRAVITIES},
        "options": ["{}", "{}", "{}"]}}
    }}"##,
        conditions[0], conditions[1], conditions[2]
    )
}

const RATIO: [&str; 3] = [
    "abs(half.touch / earth.touch - 1.414) < 0.01",
    "abs(half.touch / earth.touch - 2) < 0.01",
    "abs(half.touch - earth.touch) < 0.01",
];

#[test]
fn a_right_answer_is_verified() {
    expect("verified", Verdict::Verified, "Drop it.", &choice(0, RATIO));
}

#[test]
fn a_wrong_answer_is_refuted_and_corrected() {
    expect("refuted", Verdict::Refuted, "Drop it.", &choice(1, RATIO));
}

#[test]
fn an_answer_that_nothing_supports_is_refuted() {
    let never = ["half.touch < 0.1", "half.touch > 10", "half.touch < earth.touch"];
    expect("refuted-by-all", Verdict::Refuted, "Drop it.", &choice(0, never));
}

#[test]
fn two_right_answers_are_ambiguous() {
    let loose = [RATIO[0], "half.touch > 1.2 * earth.touch", RATIO[2]];
    expect("ambiguous", Verdict::Ambiguous, "Drop it.", &choice(0, loose));
}

#[test]
fn a_condition_that_cannot_be_evaluated_fails() {
    let misspelt = ["half.tuoch > earth.touch", RATIO[1], RATIO[2]];
    expect("failed", Verdict::Failed, "Drop it.", &choice(0, misspelt));
}

#[test]
fn a_run_that_cannot_be_made_fails() {
    let question = choice(0, RATIO).replace("\"gravity\": -4.905", "\"gravty\": -4.905");
    expect("failed-run", Verdict::Failed, "Drop it.", &question);
}

/// A question with a number for an answer.
fn numeric(answer: &str, tol: &str, value: &str, says: &str) -> String {
    format!(
        r##"    {{
      "kind": "numeric",
      "q": "When does the ball first touch the floor?",
      "answer": {answer}, "tol": {tol}, "unit": "s",
      "explain": "It falls 0.95 m, which takes 0.440 s.",
      "verify": {{"lab": "#1", "runs": {{"drop": {{"until": 1}}}},
        "measure": {{
          "touch": "before(contact('ball', 'floor'), data.time)", "seen": "first(contact('ball', 'floor'))"}},
        "value": "{value}", "says": [{says}]}}
    }}"##
    )
}

#[test]
fn a_number_is_verified_within_its_tolerance() {
    let question = numeric("0.44", "0.005", "touch", r#"["0.440 s", "touch"], ["0.95 m", "1 - 0.05"]"#);
    expect("numeric-verified", Verdict::Verified, "Drop it.", &question);
}

#[test]
fn a_wrong_number_is_refuted() {
    expect("numeric-refuted", Verdict::Refuted, "Drop it.", &numeric("0.45", "0.005", "touch", ""));
}

/// A contact is looked for once in a step: a time of touchdown finer than a step is a property of the timestep.
#[test]
fn an_answer_finer_than_the_timestep_is_fragile() {
    expect("fragile", Verdict::Fragile, "Drop it.", &numeric("0.442", "0.0004", "seen", ""));
    let order =
        ["abs(earth.touch - 0.442) < 0.0002", "earth.touch < 0.4", "abs(earth.touch - 0.441) < 0.0002"];
    expect("fragile-choice", Verdict::Fragile, "Drop it.", &choice(0, order));
}

/// The same question is sound once it says which timestep it means.
#[test]
fn an_answer_that_states_its_timestep_is_not_fragile() {
    let question = numeric("0.442", "0.0004", "seen", "")
        .replace(r#""drop": {"#, r#""drop": {"set": {"timestep": 0.002}, "#);
    expect("not-fragile", Verdict::Verified, "Drop it.", &question);
}

#[test]
fn a_wrong_quote_is_refuted_at_its_place() {
    let question = numeric("0.44", "0.005", "touch", r#"["0.440 s", "touch + 0.01"]"#);
    expect("quote-wrong", Verdict::Refuted, "Drop it.", &question);
    let question = numeric("0.44", "0.005", "touch", r#"["4.23 m/s", "9.81 * touch"]"#);
    expect("quote-wrong-in-prose", Verdict::Refuted, "It arrives with 4.23 m/s.", &question);
}

#[test]
fn a_quote_that_no_reader_sees_is_reported() {
    let question = numeric("0.44", "0.005", "touch", r#"["4.32 m/s", "9.81 * touch"]"#);
    expect("quote-not-found", Verdict::Verified, "It arrives with 24.32 m/s.", &question);
}

#[test]
fn a_quote_without_a_number_is_reported() {
    let question = numeric("0.44", "0.005", "touch", r#"["about half a second", "touch"]"#);
    expect("quote-without-number", Verdict::Refuted, "It takes about half a second.", &question);
}

#[test]
fn a_question_without_claims_is_unverified() {
    let question = r#"    {"q": "Is it heavy?", "options": ["yes", "no"], "answer": 1}"#;
    expect("unverified", Verdict::Unverified, "Drop it.", question);
}
