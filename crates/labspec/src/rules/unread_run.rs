use super::Check;
use crate::json::read::named;
use crate::spec::{Lesson, Verify};
use labspec_finding::{Example, Finding, Layer, Rule, Severity};

/// No claim of a `verify` object reads one of its runs.
pub const UNREAD_RUN: &Rule = &Rule {
    code: "unread-run",
    severity: Severity::Warning,
    exceptions: &[],
    layer: Layer::Structure,
    summary: "no claim of a `verify` object reads one of its runs",
    why: "the run is executed, but nothing is compared with it, so what the text says about it is not checked. Usually a condition has the name of another run",
    bad: Example::Quiz(
        r#"{"id": "moon", "questions": [{"q": "On the moon, the ball falls", "options": ["faster", "more slowly"], "answer": 1, "verify": {"lab": {"stopAt": 2, "xml": "<mujoco><worldbody><body pos='0 0 1'><freejoint/><geom size='.05'/></body></worldbody></mujoco>", "controls": [{"label": "gravity (m/s²)", "set": "model.opt.gravity[2]", "min": -20, "max": 0, "step": 0.01, "value": -9.81, "reset": true}]}, "runs": {"⟦earth⟧": {}, "moon": {"set": {"gravity (m/s²)": -1.62}}}, "measure": {"t": "crossing(data.qpos[2])"}, "options": ["moon.t < 0.5", "moon.t > 0.5"]}}]}"#,
    ),
    good: Example::Quiz(
        r#"{"id": "moon", "questions": [{"q": "On the moon, the ball falls", "options": ["faster", "more slowly"], "answer": 1, "verify": {"lab": {"stopAt": 2, "xml": "<mujoco><worldbody><body pos='0 0 1'><freejoint/><geom size='.05'/></body></worldbody></mujoco>", "controls": [{"label": "gravity (m/s²)", "set": "model.opt.gravity[2]", "min": -20, "max": 0, "step": 0.01, "value": -9.81, "reset": true}]}, "runs": {"earth": {}, "moon": {"set": {"gravity (m/s²)": -1.62}}}, "measure": {"t": "crossing(data.qpos[2])"}, "options": ["moon.t < earth.t", "moon.t > earth.t"]}}]}"#,
    ),
};

pub(super) const CHECK: Check = Check::Lesson(check_lesson);

/// Names with members that claims read beside the runs.
const OTHERS: [&str; 6] = ["Math", "lib", "mj", "data", "model", "ctx"];

/// Checks the questions with conditions, which compare. The runs of a lab, or of a number, may be there for an author who reads the report.
fn check_lesson(lesson: &Lesson, findings: &mut Vec<Finding>) {
    let used: Vec<&Verify> = lesson.verifies().flat_map(|verify| lesson.used_by(verify)).collect();
    let questions = lesson.quizzes.iter().flat_map(|quiz| quiz.numbered());
    for verify in questions.filter_map(|(_, question)| question.verify.as_ref()) {
        // An object that uses another one, or is used, has claims elsewhere; a search names its runs in other ways.
        let is_shared = verify.uses.is_some() || used.iter().any(|other| other.span == verify.span);
        if !is_shared && verify.find.is_empty() && !verify.options.is_empty() {
            check_runs(verify, findings);
        }
    }
}

fn check_runs(verify: &Verify, findings: &mut Vec<Finding>) {
    let claims = verify.options.iter().chain(&verify.value).chain(&verify.wrong).chain(verify.quoted());
    let claims: Vec<&str> = claims.map(|text| text.as_str()).collect();
    let existing: Vec<&str> = verify.runs.iter().map(|run| run.name.as_str()).chain(OTHERS).collect();
    // Another rule reports a name that nothing has.
    let is_misspelt = claims.iter().flat_map(|claim| heads(claim)).any(|head| !existing.contains(&head));
    if verify.runs.len() < 2 || claims.is_empty() || is_misspelt {
        return;
    }
    for run in &verify.runs {
        let name = run.name.as_str();
        // That a run breaks, or does not, is a claim; a sweep is a table in the report.
        if run.expect.requires() || run.sweep.is_some() || claims.iter().any(|claim| names(claim, name)) {
            continue;
        }
        findings.push(
            Finding::new(UNREAD_RUN, run.name.span(), format!("no claim reads the run {}", named(name)))
                .help(format!("compare with it in a condition (`{name}.…`), or delete the run")),
        );
    }
}

/// The names before a dot, and before an index with a dot behind it: `earth` of `earth.t` and of `earth[1].t`.
fn heads(expr: &str) -> impl Iterator<Item = &str> {
    let is_part = |c: char| c.is_alphanumeric() || c == '_' || c == '$';
    expr.match_indices('.').filter_map(move |(dot, _)| {
        let before = expr.get(..dot)?;
        let start = before.rfind(|c: char| !is_part(c)).map_or(0, |i| i + 1);
        let is_member = before.get(..start)?.ends_with(['.', ']']);
        let head = before.get(start..)?;
        (!is_member && head.starts_with(|c: char| c.is_alphabetic() || c == '_' || c == '$')).then_some(head)
    })
}

/// Whether an expression contains a name as a whole word.
fn names(expr: &str, name: &str) -> bool {
    let is_part = |c: char| c.is_alphanumeric() || c == '_' || c == '$';
    let mut places = expr.match_indices(name);
    places.any(|(start, found)| {
        let before = expr.get(..start).and_then(|text| text.chars().next_back());
        let behind = expr.get(start + found.len()..).and_then(|text| text.chars().next());
        !before.is_some_and(is_part) && !behind.is_some_and(is_part)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_whole_words() {
        assert!(names("moon.t > earth.t", "earth"));
        assert!(names("all[2].t", "all"));
        assert!(!names("moon.t > earthly.t", "earth"));
        assert!(!names("a.small < 1", "mall"));
        assert_eq!(heads("moon.t > 1.5 * earth.t + a[1].b").collect::<Vec<_>>(), ["moon", "earth"]);
    }
}
