//! An answer must hold from starts that are perturbed in either direction, as a quote must.

#![allow(clippy::unwrap_used)]

use crate::support::check_text;
use labspec::verify::Verdict;
use serde_json::{Value, json};

/// A rod that stands exactly upright on a hinge, and a question about it.
fn check_rod(question: &Value, verify: &Value) -> (Verdict, String) {
    let lab = json!({"stopAt": 8, "xml": "<mujoco><worldbody><body pos='0 0 1'><joint axis='0 1 0'/>\
        <geom type='capsule' fromto='0 0 0 0 0 .5' size='.02' mass='1'/></body></worldbody></mujoco>"});
    let (mut question, mut verify) = (question.clone(), verify.clone());
    verify["lab"] = lab;
    question["q"] = json!("Where does it go in 8 s?");
    question["verify"] = verify;
    let checked = check_text("quiz.json", &json!({"id": "q", "questions": [question]}).to_string());
    let answer = checked.claims.iter().find_map(|c| c.judgement.answer.as_ref()).unwrap();
    (answer.verdict, answer.reason.clone())
}

#[test]
fn an_answer_that_a_perturbed_start_in_one_direction_changes_is_fragile() {
    for (measure, conditions, how) in [
        ("min(data.qpos[0])", ["x > -0.5", "x <= -0.5"], "with a start moved by -1e-14"),
        ("max(data.qpos[0])", ["x < 0.5", "x >= 0.5"], "with a start moved by 1e-14"),
        // The first direction leaves this measure the same.
        ("count(data.qpos[0] < -0.5)", ["x === 0", "x > 0"], "with a start moved by -1e-14"),
    ] {
        let question = json!({"options": ["it does not fall to this side", "it falls to it"], "answer": 0});
        let (verdict, reason) =
            check_rod(&question, &json!({"measure": {"x": measure}, "options": conditions}));
        assert_eq!(verdict, Verdict::Fragile, "{measure}: {reason}");
        assert!(reason.contains(how), "{measure}: {reason}");
    }
    for (measure, how) in [("min(data.qpos[0])", " -1e-14"), ("max(data.qpos[0])", " 1e-14")] {
        let question = json!({"kind": "numeric", "answer": 0, "tol": 0.1, "unit": "rad"});
        let (verdict, reason) = check_rod(&question, &json!({"measure": {"x": measure}, "value": "x"}));
        assert_eq!(verdict, Verdict::Fragile, "{measure}: {reason}");
        assert!(reason.ends_with(how), "{measure}: {reason}");
    }
}
