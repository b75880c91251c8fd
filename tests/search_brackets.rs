//! A search knows its limit to its `tol`. A claim that needs it more precisely is not decided.

#![allow(clippy::unwrap_used)]

use crate::support::check_text;
use labspec::finding::Finding;
use labspec::verify::Verdict;
use serde_json::{Value, json};

/// A ball that falls from a height that a control sets, and this `verify` object.
fn fall(verify: &Value) -> Value {
    json!({"title": "Fall", "stopAt": 1, "setup": "data.qpos[2] = ctx.h",
        "xml": "<mujoco><worldbody><body name='ball' pos='0 0 1'><freejoint/><geom size='.05'/></body></worldbody></mujoco>",
        "controls": [{"label": "height (m)", "param": "h", "min": -5, "max": 5, "value": 1, "reset": true}],
        "readouts": [{"label": "height (m)", "expr": "data.qpos[2]"}], "verify": verify})
}

/// The largest height for which the ball stays below 2 m, which is 2 m, to this precision.
fn search(tol: f64) -> Value {
    json!({"limit": {"largest": "height (m)", "from": -5, "to": 5, "while": "top < 2", "tol": tol}})
}

/// The verdict of a quote, and the findings.
fn check_quote(tol: f64, quote: &str, expr: &str, more: &Value) -> (&'static str, Vec<Finding>) {
    let mut verify =
        json!({"measure": {"top": "max(data.qpos[2])"}, "find": search(tol), "says": [[quote, expr]]});
    more.as_object().unwrap().iter().for_each(|(key, value)| verify[key] = value.clone());
    let mut lab = fall(&verify);
    lab["note"] = json!(format!("The ball stays below 2 m up to a start at {quote}."));
    let checked = check_text("lab.json", &lab.to_string());
    (checked.claims[0].judgement.quotes[0].verdict(), checked.findings)
}

/// The value of a control is applied in the only run, whether or not `runs` states it.
#[test]
fn a_search_over_a_control_needs_no_runs() {
    for more in [json!({}), json!({"runs": {"r": {}}})] {
        for (quote, verdict) in [("2.00 m", "verified"), ("1.90 m", "refuted")] {
            let (found, findings) = check_quote(1e-5, quote, "limit", &more);
            assert_eq!(found, verdict, "{more} {quote}: {findings:#?}");
        }
    }
}

#[test]
fn a_quote_finer_than_the_search_could_not_be_checked() {
    for (tol, quote, expr, verdict) in [
        (0.5, "1.923 m", "limit", "failed"),
        (0.5, "2.000 m", "limit", "failed"),
        (0.5, "1.9 m", "limit", "failed"),
        (0.5, "5.0 m", "limit", "refuted"),
        (0.5, "1 to 3 m", "limit", "verified"),
        (1e-5, "1.923 m", "limit", "refuted"),
        (1e-5, "2.000 m", "limit", "verified"),
        (0.5, "a low place", "limit < 1.95", "failed"),
        (0.5, "a low place", "limit < 3", "verified"),
    ] {
        let (found, findings) = check_quote(tol, quote, expr, &json!({}));
        assert_eq!(found, verdict, "{tol} {quote} {expr}: {findings:#?}");
        let coarse = findings.iter().find(|f| f.message.contains("too wide to decide the claim"));
        assert_eq!(coarse.is_some(), verdict == "failed", "{findings:#?}");
        if let Some(help) = coarse.and_then(|f| f.help.as_deref()) {
            assert!(help.contains("`\"tol\": 0."), "{help}");
        }
    }
}

#[test]
fn an_answer_finer_than_the_search_fails() {
    let verdict = |tol: f64, question: Value, claim: Value| {
        let (mut question, mut verify) = (question, claim);
        verify["lab"] = fall(&Value::Null);
        verify["lab"].as_object_mut().unwrap().remove("verify");
        verify["measure"] = json!({"top": "max(data.qpos[2])"});
        verify["find"] = search(tol);
        question["q"] = json!("How high may it start?");
        question["verify"] = verify;
        let checked = check_text("quiz.json", &json!({"id": "q", "questions": [question]}).to_string());
        let answer = checked.claims.iter().find_map(|c| c.judgement.answer.as_ref()).unwrap();
        (answer.verdict, answer.reason.clone())
    };
    let choice = json!({"options": ["below 1.95 m", "above it"], "answer": 0});
    let conditions = json!({"options": ["limit < 1.95", "limit >= 1.95"]});
    let number = |answer: f64| json!({"kind": "numeric", "answer": answer, "tol": 0.02});
    let value = json!({"value": "limit"});
    for (tol, question, claim, expected) in [
        (0.5, choice.clone(), conditions.clone(), Verdict::Failed),
        (1e-4, choice, conditions, Verdict::Refuted),
        (0.5, number(1.92), value.clone(), Verdict::Failed),
        (0.5, number(2.0), value.clone(), Verdict::Failed),
        (1e-4, number(2.0), value.clone(), Verdict::Verified),
        (0.5, number(4.0), value, Verdict::Refuted),
    ] {
        let (found, reason) = verdict(tol, question.clone(), claim);
        assert_eq!(found, expected, "{tol} {question}: {reason}");
        assert!(found != Verdict::Failed || reason.contains("too wide to decide the claim"), "{reason}");
    }
}
