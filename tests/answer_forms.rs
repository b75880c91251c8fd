//! Questions with several correct options, with a statement, and with a hash instead of the answer: how they are verified.

#![allow(clippy::unwrap_used)]

use crate::support::{check_text, codes};
use labspec::check::Checked;
use labspec::verify::Verdict;

/// The SHA-256 of `fall:1`, `fall:0,2`, `fall:2` and `fall:false`.
const ONE: &str = "c2b13ffa5d46ef6535899ba40be9e4490faad74ee58ea5aaed7c2eecf7da4cfb";
const TWO: &str = "97da2a75c623e49a83efb57c9effd897a400b1947e459822aa5fc989acb11be9";
const WRONG: &str = "9d5e5f56bdc45112a7a679cf1c58e67fe5920bffa5d1b522b5d09a0c00bc6399";
const FALSE: &str = "e374e430b71d8777e71d0600aa1c6d3df10f72a177e4b636a02fe9f9e9c78b59";

/// A ball that falls from 1 m for 0.4 s, and a question about it.
fn check(question: &str, conditions: &str) -> Checked {
    check_text(
        "fall.md",
        &format!(
            r##"# A falling ball

```lab simlab
{{
  "xml": "<mujoco><worldbody><body name='ball' pos='0 0 1'><freejoint/><geom name='ball' type='sphere' size='0.05' mass='1'/></body></worldbody></mujoco>",
  "readouts": [{{"label": "height (m)", "expr": "data.qpos[2]"}}]
}}
```

```quiz
{{"id": "fall", "questions": [{{{question},
  "verify": {{"lab": "#1", "runs": {{"run": {{"until": 0.4}}}},
    "measure": {{"z": "final(data.qpos[2])", "v": "final(data.qvel[2])"}}, "options": {conditions}}}}}]}}
```
"##
        ),
    )
}

/// The verdict, its reason, and the codes of the findings.
fn verdict(question: &str, conditions: &str) -> (Verdict, String, String) {
    let checked = check(question, conditions);
    let answer = checked.claims[0].judgement.answer.clone().unwrap();
    (answer.verdict, answer.reason, codes(&checked).join(" "))
}

fn multiple(key: &str) -> String {
    format!(
        r#""kind": "multiple", "q": "What does the ball do?", "options": ["it falls", "it rises", "it speeds up"], {key}"#
    )
}

fn statement(key: &str) -> String {
    format!(r#""kind": "truefalse", "q": "The ball falls.", {key}"#)
}

fn hashed(digits: &str) -> String {
    format!(r#""hash": {{"salt": "fall", "sha256": "{digits}"}}"#)
}

const CONDITIONS: &str = r#"["z < 0.9", "z > 1.1", "v < -1"]"#;

#[test]
fn exactly_the_keyed_options_hold() {
    for key in [r#""answer": [0, 2]"#.to_string(), r#""answer": [2, 0]"#.to_string(), hashed(TWO)] {
        let (verdict, reason, codes) = verdict(&multiple(&key), CONDITIONS);
        assert_eq!((verdict, codes.as_str()), (Verdict::Verified, ""), "{key}: {reason}");
    }
}

#[test]
fn a_missing_and_a_wrong_option_refute_the_answer() {
    for (key, says) in [
        (r#""answer": [0]"#, "2 (\"it speeds up\") is true"),
        (r#""answer": [0, 1, 2]"#, "1 (\"it rises\") is not true"),
        (r#""answer": []"#, "0 (\"it falls\") is true, 2"),
    ] {
        let (verdict, reason, codes) = verdict(&multiple(key), CONDITIONS);
        assert_eq!((verdict, codes.as_str()), (Verdict::Refuted, "answer-refuted"), "{key}: {reason}");
        assert!(reason.contains(says), "{reason}");
    }
    let checked = check(&multiple(r#""answer": [0]"#), CONDITIONS);
    let finding = checked.findings.iter().find(|f| f.code == "answer-refuted").unwrap();
    assert!(finding.help.as_ref().unwrap().contains("[0, 2]"), "{finding:?}");
}

#[test]
fn an_undecided_option_decides_nothing() {
    let undecided = |key: &str, conditions: &str| verdict(&multiple(key), conditions).0;
    assert_eq!(undecided(r#""answer": [0, 2]"#, r#"["z < 0.9", "undecided", "v < -1"]"#), Verdict::Failed);
    assert_eq!(undecided(r#""answer": [0]"#, r#"["undecided", "z > 1.1", "v > 1"]"#), Verdict::Failed);
    assert_eq!(undecided(r#""answer": [0]"#, r#"["z < 0.9", "z > 1.1", "undecided"]"#), Verdict::Failed);
    // What is decided can refute the key.
    assert_eq!(undecided(r#""answer": [0]"#, r#"["z < 0.9", "undecided", "v < -1"]"#), Verdict::Refuted);
}

#[test]
fn a_statement_is_true_or_false() {
    for (key, condition, expected) in [
        (r#""answer": true"#.to_string(), r#"["z < 0.9"]"#, Verdict::Verified),
        (r#""answer": false"#.to_string(), r#"["z < 0.9"]"#, Verdict::Refuted),
        (r#""answer": false"#.to_string(), r#"["z > 1.1"]"#, Verdict::Verified),
        (r#""answer": true"#.to_string(), r#"["z > 1.1"]"#, Verdict::Refuted),
        (r#""answer": false"#.to_string(), r#"["undecided"]"#, Verdict::Failed),
        (hashed(FALSE), r#"["z > 1.1"]"#, Verdict::Verified),
        (hashed(FALSE), r#"["z < 0.9"]"#, Verdict::Refuted),
        (hashed(ONE), r#"["z < 0.9"]"#, Verdict::Failed),
    ] {
        let (verdict, reason, codes) = verdict(&statement(&key), condition);
        assert_eq!(verdict, expected, "{key} {condition}: {reason} {codes}");
    }
    let checked = check(&statement(r#""answer": true"#), r#"["z < 0.9", "z > 1.1"]"#);
    assert!(codes(&checked).contains(&"verify-answer"));
}

/// A condition that holds only at the numerics of the lesson is fragile in every kind.
#[test]
fn a_close_condition_is_fragile() {
    let close = r#"["z < 0.21369"]"#;
    let (close_verdict, reason, _) = verdict(&statement(r#""answer": true"#), close);
    assert_ne!(close_verdict, Verdict::Verified, "{reason}");
}

#[test]
fn a_hash_of_one_option_is_verified_and_no_fix_writes_over_it() {
    let question = |digits: &str| {
        format!(r#""q": "What?", "options": ["it falls", "it rises", "it stays"], {}"#, hashed(digits))
    };
    let conditions = r#"["z > 1.1", "z < 0.9", "z == 1"]"#;
    assert_eq!(verdict(&question(ONE), conditions).0, Verdict::Verified);
    let checked = check(&question(WRONG), conditions);
    let finding = checked.findings.iter().find(|f| f.code == "answer-refuted").unwrap();
    assert!(finding.fix.is_none(), "{finding:?}");
    let (verdict, reason, _) = verdict(&question(FALSE), conditions);
    assert_eq!(
        (verdict, reason.as_str()),
        (Verdict::Failed, "no choice that was tried has the hash of the question")
    );
}

/// An answer in percent is the value of an expression in percent, or as a fraction of one.
#[test]
fn an_answer_in_percent_is_a_fraction_or_a_percentage() {
    let verdict = |answer: &str, unit: &str, value: &str| {
        let question = format!(
            r##"{{"kind": "numeric", "q": "How much of the height is left?", "answer": {answer}, "tol": 1.0, "unit": "{unit}",
                "verify": {{"lab": "#1", "runs": {{"run": {{"until": 0.3}}}}, "measure": {{"z": "final(data.qpos[2])", "z0": "initial(data.qpos[2])"}}, "value": "{value}"}}}}"##
        );
        let checked = check_text(
            "fall.md",
            &format!(
                "```lab simlab\n{{\"xml\": \"<mujoco><option timestep='0.0005'/><worldbody><body pos='0 0 1'><freejoint/><geom size='0.05'/></body></worldbody></mujoco>\"}}\n```\n\n```quiz\n{{\"id\": \"q\", \"questions\": [{question}]}}\n```\n"
            ),
        );
        checked.claims[0].judgement.answer.as_ref().unwrap().verdict
    };
    assert_eq!(verdict("55.8", "%", "z / z0"), Verdict::Verified);
    assert_eq!(verdict("55.8", "%", "100 * z / z0"), Verdict::Verified);
    assert_eq!(verdict("558.0", "‰", "z / z0"), Verdict::Verified);
    assert_eq!(verdict("50.8", "%", "z / z0"), Verdict::Refuted);
    assert_eq!(verdict("50.8", "%", "100 * z / z0"), Verdict::Refuted);
    assert_eq!(verdict("5.58", "%", "z / z0"), Verdict::Refuted);
    // Another unit is no percentage.
    assert_eq!(verdict("55.8", "", "z / z0"), Verdict::Refuted);
}
