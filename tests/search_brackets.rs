//! A search knows its limit to its `tol`. A claim that needs it more precisely is not decided.

#![allow(clippy::unwrap_used)]

use crate::support::check_text;
use labspec::finding::Finding;
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
