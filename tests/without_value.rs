//! A measure without a value: one finding for all claims that read it, with a longer run that was tried.

#![allow(clippy::unwrap_used)]

use crate::support::check_text;
use labspec::finding::Finding;
use serde_json::{Value, json};

const ROD: &str = "<mujoco><worldbody><body><joint name='swing' type='hinge' axis='0 1 0'/><geom type='capsule' fromto='0 0 0 0 0 -0.5' size='0.02' mass='1'/></body></worldbody></mujoco>";

/// A swing of 1.17 s whose period is measured in two runs, and claimed in three sentences and a question.
fn check(until: f64, measure: &str, more: &Value) -> Vec<Finding> {
    let lab = json!({"xml": ROD, "setup": "data.qpos[0] = 0.3", "readouts": [{"label": "angle (rad)", "expr": "data.qpos[0]"}]});
    let mut short = json!({"until": until});
    for (key, value) in more.as_object().into_iter().flatten() {
        short[key] = value.clone();
    }
    let verify = json!({"lab": "#1", "runs": {"long": {"until": 5}, "short": short}, "measure": {"T": measure},
        "options": ["short.T > 1", "short.T < 1"], "says": [["1.2 s", "short.T"], ["2.4 s", "2 * short.T"], ["0.0 s", "short.T - long.T"]]});
    let quiz = json!({"id": "q", "questions": [{"q": "How long?", "options": ["long", "short"], "answer": 0, "verify": verify}]});
    let remark = json!({"use": "#q.1", "says": [["1.17 s", "short.T"]]});
    let text = format!(
        "```lab simlab\n{lab}\n```\n\nIt takes 1.2 s, 2.4 s and 0.0 s.\n\n<!-- labspec verify {remark} -->\nIt takes 1.17 s.\n\n```quiz\n{quiz}\n```\n"
    );
    let mut findings = check_text("a.md", &text).findings;
    findings.retain(|f| f.code != "numbers-unclaimed");
    findings
}

fn only(findings: &[Finding]) -> (&str, String, String) {
    assert_eq!(findings.len(), 1, "{findings:#?}");
    let f = &findings[0];
    assert_eq!(f.code, "measure-without-value");
    (&f.message, f.why.clone().unwrap_or_default(), f.help.clone().unwrap_or_default())
}

#[test]
fn a_run_that_is_too_short_is_one_finding_that_says_how_long_it_must_be() {
    let found = check(1.0, "period(data.qpos[0])", &json!({}));
    let (message, why, help) = only(&found);
    assert_eq!(message, "`short.T` has no value");
    assert!(why.contains("rises through the level only once, and a period needs two passages"), "{why}");
    assert!(why.contains("ends at 1 s"), "{why}");
    // Runs of 2 s have one passage, too.
    assert!(help.contains("\"until\": 4") && help.contains("it is 1.18"), "{help}");
}

#[test]
fn an_event_that_never_happens_is_one_finding() {
    let found = check(1.0, "first(data.qpos[0] > 2)", &json!({}));
    // It does not happen in the long run either, and is still one finding.
    let (message, _, help) = only(&found);
    assert!(
        message.ends_with(".T` has no value") && help.contains("with `\"until\": 8` either"),
        "{message} {help}"
    );
    let found = check(1.0, "first(data.qpos[0] < -0.2)", &json!({"until": 0.4}));
    let (_, why, help) = only(&found);
    assert!(why.contains("the condition never holds"), "{why}");
    assert!(help.contains("\"until\": 0.8"), "{help}");
}

#[test]
fn a_run_that_stops_by_itself_is_not_told_to_be_longer() {
    let found = check(4.0, "period(data.qpos[0])", &json!({"stop": "data.qpos[0] < -0.1"}));
    let (_, _, help) = only(&found);
    assert!(help.contains("where its `stop` holds"), "{help}");
}

/// A wrong sign in the setup: the ball never falls, and two measures wait for the same impact.
#[test]
fn measures_that_wait_for_the_same_event_are_one_finding() {
    let ball = "<mujoco><worldbody><geom name='floor' type='plane' size='1 1 1'/><body pos='0 0 1'><freejoint/><geom name='ball' size='0.05'/></body></worldbody></mujoco>";
    let lesson = |speed: &str| {
        let lab = json!({"xml": ball, "stopAt": 1, "setup": "model.opt.gravity[2] = 9.81",
            "readouts": [{"label": "height (m)", "expr": "data.qpos[2]"}],
            "verify": {"measure": {"lands": "first(contact('ball', 'floor'))", "speed": speed}, "says": [["0.440 s", "lands"], ["4.32 m/s", "speed"]]}});
        check_text("a.md", &format!("It lands after 0.440 s with 4.32 m/s.\n\n```lab simlab\n{lab}\n```\n"))
            .findings
    };
    let found = lesson("before(contact( 'ball', 'floor' ), -data.qvel[2])");
    let (message, ..) = only(&found);
    assert_eq!(message, "`run.lands` has no value");
    let related: Vec<&str> = found[0].related.iter().map(|place| place.label.as_str()).collect();
    assert!(related.contains(&"`run.speed` has no value for the same reason"), "{related:?}");
    // Another event is another finding.
    let found = lesson("at(data.qpos[2] < 0.1, -data.qvel[2])");
    assert_eq!(found.iter().filter(|f| f.code == "measure-without-value").count(), 2, "{found:#?}");
}
