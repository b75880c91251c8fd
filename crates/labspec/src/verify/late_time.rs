//! Finds measures that wait for a time that no run of a claim reaches: `max(data.time > 2 ? height : 0)` in runs of 1.5 s.

use super::bound::BoundVerify;
use super::layout::Slot;
use super::option_numbers::{constant, is_below};
use super::outcome::MeasuredRuns;
use crate::finding::Finding;
use crate::rules;
use crate::spec::Verify;
use labspec_expr::ast::{Expr, ExprKind};
use labspec_expr::{parse_expression, print};

/// Reports them, for the measures that claims read.
pub(super) fn check_times(
    bound: &BoundVerify<'_>,
    outcome: &MeasuredRuns,
    verify: &Verify,
    findings: &mut Vec<Finding>,
) {
    let claims = verify.options.iter().chain(&verify.value).chain(verify.quoted());
    let claims: Vec<_> = claims.filter_map(|text| bound.claim(text)).collect();
    for (name, text) in &verify.measure {
        let slots = claims.iter().flat_map(|claim| &claim.reads).filter_map(|place| {
            let Slot::Measure(run, measure) = *bound.layout().slots.get(*place)? else { return None };
            let measured = outcome.runs.get(run)?;
            (measured.measures.get(measure)?.0 == name.value).then_some(measured.end)
        });
        let Some(end) = slots.reduce(f64::max) else { continue };
        let mut times = Vec::new();
        add_times(&parse_expression(&text.value).tree, &mut times);
        // The last sample may lie a step behind the time that is set.
        let Some((time, condition)) = times.into_iter().find(|(time, _)| *time > end * (1.0 + 1e-9)) else {
            continue;
        };
        findings.push(
            Finding::new(rules::TIME_NOT_REACHED, text.span(), format!("`{condition}` holds at no sample"))
                .why(format!("the runs that a claim reads end at {end} s, so the measure does not depend on what happens then"))
                .help(format!("let the runs last longer (`until` above {time}), or wait for an earlier time")),
        );
    }
}

/// Adds the times after which the conditions of an expression hold, each with its condition.
fn add_times(e: &Expr, times: &mut Vec<(f64, String)>) {
    match &e.kind {
        ExprKind::Binary { op, left, right } => {
            let is_time = |e: &Expr| print(e) == "data.time";
            let after = match (is_below(*op, false), is_below(*op, true)) {
                (Some(false), _) if is_time(left) => constant(right),
                (_, Some(false)) if is_time(right) => constant(left),
                _ => None,
            };
            times.extend(after.map(|time| (time, print(e))));
            add_times(left, times);
            add_times(right, times);
        }
        ExprKind::Logical { left, right, .. } => {
            add_times(left, times);
            add_times(right, times);
        }
        ExprKind::Conditional { test, then, otherwise } => {
            [test, then, otherwise].into_iter().for_each(|e| add_times(e, times));
        }
        ExprKind::Call { args, .. } => args.iter().for_each(|e| add_times(e, times)),
        _ => {}
    }
}

#[cfg(test)]
mod tests {
    /// How many measures of a question about a ball that falls for 0.3 s wait for too late a time.
    fn found(measure: &str, holds: &str) -> usize {
        let xml =
            "<mujoco><worldbody><body pos='0 0 1'><freejoint/><geom size='.05'/></body></worldbody></mujoco>";
        let verify = serde_json::json!({"lab": {"stopAt": 0.3, "xml": xml}, "runs": {"r": {}}, "measure": {"h": measure},
            "options": [holds, format!("!({holds})")]});
        let question = serde_json::json!({"kind": "mcq", "q": "What does the ball do?", "options": ["It falls", "It rises"], "answer": 0, "verify": verify});
        let quiz = serde_json::json!({"id": "q", "questions": [question]}).to_string();
        let report = crate::Checker::new(|_: &str| None::<String>).check("q.json", &quiz);
        report.findings.iter().filter(|finding| finding.code == "time-not-reached").count()
    }

    #[test]
    fn a_time_behind_the_end_is_found() {
        assert_eq!(found("max(data.time > 2 ? data.qpos[2] : 0)", "r.h < 0.5"), 1);
        assert_eq!(found("max(0.5 <= data.time ? data.qpos[2] : 0)", "r.h < 0.5"), 1);
        assert_eq!(found("count(data.time > 0.4 && data.qpos[2] > 0.9)", "r.h < 1"), 1);
        assert_eq!(found("max(data.time > 0.2 ? data.qpos[2] : 0)", "r.h < 0.9"), 0);
        assert_eq!(found("max(data.time < 2 ? data.qpos[2] : 0)", "r.h > 0.9"), 0);
    }
}
