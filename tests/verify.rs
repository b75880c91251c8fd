//! The results of verification: one small lesson for every verdict, with all output for the author.

#![allow(clippy::unwrap_used)]

use crate::support::{check_text, codes};
use labspec::check::Checked;
use labspec::report;
use labspec::verify::Verdict;
use serde_json::json;
use std::fmt::Write;

/// A ball above a floor, and a question about it.
pub(crate) fn lesson(prose: &str, question: &str) -> String {
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

/// Checks a lesson, asserts its verdict, and compares all other output with a snapshot.
pub(crate) fn expect(name: &str, verdict: Verdict, prose: &str, question: &str) {
    let text = lesson(prose, question);
    let checked = check_text("fall.md", &text);
    let claim = &checked.claims[0];
    let answer = claim.judgement.answer.as_ref().unwrap();
    let mut output = format!("{}: {} {}\n", claim.name, answer.verdict.as_str(), answer.reason);
    for quote in &claim.judgement.quotes {
        let _ = writeln!(output, "  {}: {} {}", quote.text, quote.verdict(), quote.reason);
    }
    for m in &claim.judgement.measures {
        // Nine digits, because the last bits are not guaranteed.
        let halved = m.halved.map_or(String::new(), |x| format!(", {x:.9} at half the timestep"));
        let _ = writeln!(output, "  {} = {:.9}{halved}", m.name, m.value);
    }
    for weight in &answer.weights {
        let margin = weight.margin.map_or("-".into(), |m| format!("{m:.9}"));
        let _ = writeln!(output, "  option {:?}: {}, margin {margin}", weight.option, weight.describe());
    }
    let _ = write!(output, "\n{}", report::human(&checked.findings, &[&checked.lesson.file], false));
    insta::with_settings!({prepend_module_to_snapshot => false, omit_expression => true}, {
        insta::assert_snapshot!(format!("verify-{name}"), output);
    });
    assert_eq!(answer.verdict, verdict);
    assert_eq!(checked.claims.len(), 1);
}

const TWO_GRAVITIES: &str = r#""runs": {"earth": {"until": 1}, "half": {"set": {"gravity": -4.905}, "until": 1}},
      "measure": {"touch": "first(contact('ball', 'floor'))"}"#;

/// A question about two runs, with an answer and three conditions.
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

/// A question with a numeric answer.
pub(crate) fn numeric(answer: &str, tol: &str, value: &str, says: &str) -> String {
    format!(
        r##"    {{
      "kind": "numeric",
      "q": "The ball falls 0.95 m. When does it first touch the floor?",
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

/// Contacts are detected once per step, so a touchdown time that is more precise than a step is a property of the timestep.
#[test]
fn an_answer_finer_than_the_timestep_is_fragile() {
    expect("fragile", Verdict::Fragile, "Drop it.", &numeric("0.442", "0.0004", "seen", ""));
    let order =
        ["abs(earth.touch - 0.442) < 0.0002", "earth.touch < 0.4", "abs(earth.touch - 0.441) < 0.0002"];
    expect("fragile-choice", Verdict::Fragile, "Drop it.", &choice(0, order));
}

/// The same question is robust if it states its timestep.
#[test]
fn an_answer_that_states_its_timestep_is_not_fragile() {
    let question = numeric("0.442", "0.0004", "seen", "")
        .replace(r#""drop": {"#, r#""drop": {"set": {"timestep": 0.002}, "#);
    expect("not-fragile", Verdict::Verified, "Drop it.", &question);
}

#[test]
fn a_question_without_claims_is_unverified() {
    let question = r#"    {"q": "Is it heavy?", "options": ["yes", "no"], "answer": 1}"#;
    expect("unverified", Verdict::Unverified, "Drop it.", question);
}

/// An option that the runs do not decide is counted as neither refuted nor verified.
#[test]
fn an_undecided_option_is_not_refuted() {
    let lesson = |options: [&str; 3]| {
        let question = json!({"id": "q", "title": "t", "questions": [{
            "kind": "predict", "q": "Where is it after a second?", "options": ["lower", "higher", "because of the moon"], "answer": 0,
            "sim": {"xml": "<mujoco><worldbody><body pos='0 0 9'><freejoint/><geom size='.1'/></body></worldbody></mujoco>",
                "readouts": [{"label": "height (m)", "expr": "data.qpos[2]"}]},
            "verify": {"runs": {"r": {"until": 1}}, "measure": {"z": "final(data.qpos[2])"}, "options": options}}]});
        let checked = check_text("quiz.json", &question.to_string());
        let answer = checked.claims[0].judgement.answer.clone().unwrap();
        (answer.verdict, answer.reason, answer.weights.iter().map(|w| w.holds).collect::<Vec<_>>())
    };
    let (verdict, reason, holds) = lesson(["z < 9", "z > 9", "undecided"]);
    assert_eq!((verdict, holds), (Verdict::Verified, vec![Some(true), Some(false), None]));
    assert!(reason.contains("option 2") && reason.contains("is not decided"), "{reason}");
    assert_eq!(lesson(["z > 9", "z < 9", "undecided"]).0, Verdict::Refuted);
    // An answer that is undecided, or whose alternatives are all undecided, is not verified.
    assert_eq!(lesson(["undecided", "z > 9", "z > 10"]).0, Verdict::Failed);
    assert_eq!(lesson(["z < 9", "undecided", "undecided"]).0, Verdict::Failed);
}

/// A formula needs no lab, and is computed, not verified, because nothing was simulated for it.
#[test]
fn formulas_need_no_lab() {
    let lesson = |verify: serde_json::Value| {
        let question = json!({"id": "q", "title": "t", "questions": [{
            "kind": "numeric", "q": "What torque holds 2 kg at 0.3 m?", "answer": 5.886, "tol": 0.01, "unit": "N m", "verify": verify}]});
        let checked = check_text("quiz.json", &question.to_string());
        let codes: Vec<&str> = checked.findings.iter().map(|f| f.code).collect();
        (checked.claims[0].judgement.answer.clone().unwrap().verdict, codes)
    };
    assert_eq!(lesson(json!({"value": "2 * 9.81 * 0.3"})), (Verdict::Computed, vec![]));
    assert_eq!(
        lesson(json!({"measure": {"g": "9.81 * 1"}, "value": "2 * g * 0.3"})),
        (Verdict::Computed, vec![])
    );
    assert_eq!(lesson(json!({"value": "2 * 9.81 * 0.4"})), (Verdict::Refuted, vec!["answer-refuted"]));
    assert_eq!(lesson(json!({"value": "5.886"})), (Verdict::Failed, vec!["constant-claim"]));
    // A formula that reads a lab needs one.
    for reads in [
        json!({"value": "2 * -model.opt.gravity[2] * 0.3"}),
        json!({"runs": {"r": {"until": 1}}, "value": "2 * 9.81 * 0.3"}),
    ] {
        let (verdict, codes) = lesson(reads);
        assert_eq!((verdict, codes), (Verdict::Failed, vec!["verify-without-lab"]));
    }
}

/// A question about the height after 0.3 s, which decreases with gravity; `over` is a range of gravity.
fn space(over: &str, answer: usize) -> Checked {
    let question = format!(
        r##"{{"kind": "mcq", "q": "How high is it after 0.3 s?", "options": ["above 0.4 m", "below 0.4 m"], "answer": {answer}, "verify": {{
            "lab": "#1", "runs": {{"fall": {{"until": 0.3}}}}, "measure": {{"z": "final(data.qpos[2])"}},
            "options": ["z > 0.4", "z < 0.4"], "over": {over}}}}}"##
    );
    check_text("fall.md", &lesson("", &question))
}

/// An answer that is claimed over a range is tested in the whole range, at values that a student can set.
#[test]
fn an_answer_over_a_range_holds_in_all_of_it_or_has_a_counterexample() {
    let answer = |checked: &Checked| checked.claims[0].judgement.answer.clone().unwrap();
    let holds = space(r#"{"gravity": [-12, -1]}"#, 0);
    assert_eq!(answer(&holds).verdict, Verdict::Verified, "{:?}", holds.findings);
    assert!(answer(&holds).reason.contains("settings over its range"), "{}", answer(&holds).reason);
    // 1 - g t (t + h) / 2 is below 0.4 m from g = 13.25 on.
    let fails = space(r#"{"gravity": [-20, -1]}"#, 0);
    assert_eq!(answer(&fails).verdict, Verdict::Refuted);
    assert!(codes(&fails).contains(&"counterexample"), "{:?}", fails.findings);
    assert!(answer(&fails).reason.contains("with \"gravity\" at -20"), "{}", answer(&fails).reason);
    // A claim that holds only at the lab's own setting is not a claim over a range.
    let off = space(r#"{"gravity": [-20, -12]}"#, 0);
    assert_eq!(answer(&off).verdict, Verdict::Refuted);
    for (wrong, code) in [
        (r#"{"Kick": [0, 1]}"#, "run-impossible"),
        (r#"{"gravity": [-30, -1]}"#, "run-impossible"),
        (r#"{"gravity": [-1, -20]}"#, "wrong-type"),
        (r#"{"gravity": [-1]}"#, "wrong-type"),
    ] {
        let checked = space(wrong, 0);
        assert!(codes(&checked).contains(&code), "{wrong}: {:?}", codes(&checked));
        assert_ne!(
            checked.claims.first().and_then(|c| c.judgement.answer.clone()).map(|a| a.verdict),
            Some(Verdict::Refuted)
        );
    }
}

/// A range of a slider that every run sets itself is never tested, and this is reported.
#[test]
fn a_range_that_no_run_tries_verifies_nothing() {
    let question = r##"{"kind": "mcq", "q": "How high is it?", "options": ["above 0.4 m", "below 0.4 m"], "answer": 0, "verify": {
        "lab": "#1", "runs": {"fall": {"set": {"gravity": -10}, "until": 0.3}}, "measure": {"z": "final(data.qpos[2])"},
        "options": ["z > 0.4", "z < 0.4"], "over": {"gravity": [-20, -1]}}}"##;
    let checked = check_text("fall.md", &lesson("", question));
    let answer = checked.claims[0].judgement.answer.clone().unwrap();
    assert_eq!(answer.verdict, Verdict::Failed, "{answer:?}");
    assert!(codes(&checked).contains(&"run-impossible"), "{:?}", codes(&checked));
}

/// Inside a range whose ends are both fine, the search finds a resonance.
#[test]
fn a_counterexample_between_the_corners_is_found() {
    let lab = r#"{"xml": "<mujoco><option gravity='0 0 0'/><worldbody><body name='cart'><joint name='rail' type='slide' stiffness='1' damping='.1'/><geom size='.1' mass='1'/></body></worldbody><actuator><motor joint='rail'/></actuator></mujoco>",
        "controls": [{"label": "omega", "param": "omega", "min": 0.2, "max": 4, "step": 0.01, "value": 0.2}],
        "controller": "data.ctrl[0] = Math.sin(ctx.omega * data.time)"}"#;
    let question = format!(
        r#"{{"kind": "mcq", "q": "How far does it swing?", "options": ["less than 4 m", "4 m or more"], "answer": 0, "verify": {{
            "lab": {lab}, "runs": {{"swing": {{"until": 60}}}}, "measure": {{"x": "max(abs(data.qpos[0]))"}},
            "options": ["x < 4", "x >= 4"], "over": {{"omega": [0.2, 4]}}}}}}"#
    );
    let checked = check_text(
        "swing.md",
        &format!("# Swings\n\n```quiz\n{{\"id\": \"s\", \"questions\": [{question}]}}\n```\n"),
    );
    let answer = checked.claims[0].judgement.answer.clone().unwrap();
    assert_eq!(answer.verdict, Verdict::Refuted, "{answer:?} {:?}", checked.findings);
    let omega: f64 = answer.reason.split(" at ").nth(1).unwrap().split(':').next().unwrap().parse().unwrap();
    assert!((omega - 1.0).abs() < 0.25, "{}", answer.reason);
}

/// An answer that only the default integrator gives is fragile, unless the run declares its integrator.
#[test]
fn an_answer_of_one_integrator_is_fragile() {
    let of = |run: &str| {
        let lab = r#"{"xml": "<mujoco><option timestep='.02' gravity='0 0 0'/><worldbody><body name='cart'><joint name='rail' type='slide' stiffness='400'/><geom size='.1' mass='1'/></body></worldbody></mujoco>", "setup": "data.qpos[0] = 0.1"}"#;
        let question = format!(
            r#"{{"kind": "mcq", "q": "Does its energy change?", "options": ["by more than 5 %", "by less"], "answer": 0, "verify": {{
                "lab": {lab}, "runs": {{"swing": {run}}}, "measure": {{"e": "max(lib.energy().total) / min(lib.energy().total)"}},
                "options": ["e > 1.05", "e <= 1.05"]}}}}"#
        );
        let checked = check_text(
            "e.md",
            &format!("# E\n\n```quiz\n{{\"id\": \"s\", \"questions\": [{question}]}}\n```\n"),
        );
        checked.claims[0].judgement.answer.clone().unwrap()
    };
    let answer = of(r#"{"until": 2}"#);
    assert_eq!(answer.verdict, Verdict::Fragile, "{answer:?}");
    assert!(answer.reason.contains("RK4"), "{}", answer.reason);
    let stated = of(r#"{"until": 2, "setup": "model.opt.integrator = 0"}"#);
    assert_eq!(stated.verdict, Verdict::Verified, "{stated:?}");
    assert!(stated.weights[0].spread.unwrap() > 0.0, "{stated:?}");
}
