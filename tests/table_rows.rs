//! A row of a table states one value of a sweep: the value nearest to its number, and never one of several.

#![allow(clippy::unwrap_used)]

use crate::support::check_text;
use labspec::finding::Finding;
use serde_json::{Value, json};

/// A table of falls from the heights of a sweep, with a claim about its column: the verdicts, and the findings about quotes.
fn check_rows(sweep: &Value, rows: &[[&str; 2]], claim: &Value) -> (Vec<&'static str>, Vec<Finding>) {
    let lab = json!({"title": "Fall", "stopAt": 1, "setup": "data.qpos[2] = ctx.h",
        "xml": "<mujoco><option timestep='0.001'/><worldbody><body name='ball' pos='0 0 1'><freejoint/><geom size='.05'/></body></worldbody></mujoco>",
        "controls": [{"label": "height (m)", "param": "h", "min": 0.1, "max": 3, "step": 0.05, "value": 1, "reset": true}],
        "readouts": [{"label": "height (m)", "expr": "data.qpos[2]"}],
        "verify": {"runs": {"fall": {"sweep": {"height (m)": sweep}}}, "measure": {"t": "crossing(data.qpos[2])"}, "table": [claim]}});
    let rows: String = rows.iter().map(|[key, cell]| format!("| {key} | {cell} |\n")).collect();
    let text = format!("```lab simlab\n{lab}\n```\n\n| height (m) | time (s) |\n|---|---|\n{rows}");
    let checked = check_text("lesson.md", &text);
    let verdicts = checked.claims[0].judgement.quotes.iter().map(|q| q.verdict()).collect();
    (verdicts, checked.findings.into_iter().filter(|f| f.code.starts_with("quote")).collect())
}

fn column() -> Value {
    json!({"column": "time (s)", "by": ["height (m)", "fall.value"], "is": "fall.t"})
}

/// 0.5 prints as 1 without decimals, but the row "1" describes the run from 1 m.
#[test]
fn a_row_describes_the_value_nearest_to_its_number() {
    let sweep = json!([0.5, 1]);
    for claim in [column(), json!({"row": "1", "is": ["fall.t"]})] {
        let is_column = claim.get("by").is_some();
        for (cell, verdict) in [("0.451", "verified"), ("0.319", "refuted")] {
            let (verdicts, found) = check_rows(&sweep, &[["0.5", "0.319"], ["1", cell]], &claim);
            let expected = if is_column { vec!["verified", verdict] } else { vec![verdict] };
            assert_eq!(verdicts, expected, "{claim}: {found:#?}");
        }
    }
    // A rounded value is stated by its row, if no other is nearer.
    let (verdicts, found) = check_rows(&json!([0.95, 2]), &[["1", "0.440"], ["2", "0.638"]], &column());
    assert_eq!(verdicts, ["verified"; 2], "{found:#?}");
}

#[test]
fn a_row_that_may_describe_several_runs_is_refused() {
    for (sweep, key, words) in [
        (json!([0.95, 1.05]), "1", "describes several runs: 0.95, 1.05"),
        (json!([0.5, 1]), "0.5 or 1", "describes several runs: 0.5, 1"),
        (json!([0.95, 1]), "about 1", "describes several runs: 0.95, 1"),
        (json!([0.95, 1]), "≈ 1", "describes several runs: 0.95, 1"),
        (json!([0.5, 1]), "0.4 to 1.2", "describes several runs: 0.5, 1"),
        (json!([0.5, 3]), "<2", "no run of the sweep matches the row"),
        (json!([0.5, 1]), "<2", "no run of the sweep matches the row"),
        (json!([0.5, 1]), "2", "no run of the sweep matches the row"),
    ] {
        let (verdicts, found) = check_rows(&sweep, &[[key, "0.319"]], &column());
        assert_eq!(verdicts, ["failed"], "{key}");
        assert!(found.iter().any(|f| f.message.contains(words)), "{key}: {found:#?}");
    }
}
