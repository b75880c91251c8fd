//! Nothing is called verified or clean that was not checked. Each test covers a verdict that an earlier
//! version gave without evidence.

#![allow(clippy::unwrap_used)]

use crate::program::{folder, run_in};
use crate::support::{check_text, codes};
use labspec::check::{self, Checked};
use labspec::ledger::{Entry, Evidence, Outcome, State, Subject};
use labspec::verify::{Answer, Verdict};
use serde_json::{Value as Json, json};

const FALL: &str = "<mujoco><worldbody><body name='ball' pos='0 0 2'><freejoint/><geom name='ball' size='0.05'/></body></worldbody></mujoco>";

/// A lab of a falling ball, with further keys.
fn lab(more: Json) -> Json {
    let mut lab = json!({
        "xml": FALL, "stopAt": 0.5,
        "controls": [{"label": "h", "set": "model.opt.timestep", "min": 0.001, "max": 0.02, "step": 0.001, "value": 0.002, "reset": true}],
        "plots": [{"ylabel": "height (m)", "traces": [{"label": "b", "expr": "data.qpos[2]"}]}],
        "readouts": [{"label": "height (m)", "expr": "data.qpos[2]"}],
    });
    for (key, value) in more.as_object().unwrap() {
        lab[key] = value.clone();
    }
    lab
}

fn check_json(value: &Json) -> Checked {
    check_text("lesson.json", &serde_json::to_string_pretty(value).unwrap())
}

/// A question about the fall with two options.
fn question(answer: usize, verify: Json) -> Json {
    json!({"id": "q", "questions": [{
        "kind": "predict", "q": "How far in 0.5 s: 1.231 m?", "options": ["not far", "far"], "answer": answer, "sim": lab(json!({})), "verify": verify,
    }]})
}

fn answer(checked: &Checked) -> &Answer {
    let claims = checked.claims.iter();
    claims.rev().find_map(|c| c.judgement.answer.as_ref()).unwrap()
}

fn entries(checked: &Checked, subject: Subject) -> Vec<Entry> {
    let all = check::ledger(std::slice::from_ref(checked), &checked.findings);
    all.entries().iter().filter(|e| e.subject == subject).cloned().collect()
}

fn outcome(checked: &Checked) -> Outcome {
    check::ledger(std::slice::from_ref(checked), &checked.findings).outcome()
}

/// Line 1: the README's lessons copied without their models; a wrong folder; a misspelt model.
#[test]
fn a_lab_that_did_not_run_is_a_finding() {
    let folder = folder();
    let here = folder.path();
    std::fs::create_dir(here.join("alone")).unwrap();
    std::fs::copy(here.join("clean.md"), here.join("alone/clean.md")).unwrap();
    std::fs::rename(here.join("models"), here.join("alone/elsewhere")).unwrap();
    std::fs::create_dir(here.join("alone/wrong")).unwrap();
    for command in ["check", "verify"] {
        for extra in [&[][..], &["--models", "alone/wrong"]] {
            let done = run_in(here, &[&[command, "alone/clean.md"], extra].concat());
            assert_eq!(done.code, 1, "{}", done.stdout);
            assert!(!done.stdout.contains("no problems found"), "{}", done.stdout);
            assert!(done.stdout.contains("could not be checked"), "{}", done.stdout);
            let json = run_in(here, &[&[command, "alone/clean.md", "--format", "json"], extra].concat());
            let json: Json = serde_json::from_str(&json.stdout).unwrap();
            assert!(!json["findings"].as_array().unwrap().is_empty());
            assert_eq!(json["summary"]["outcome"], "findings");
            assert_eq!(json["summary"]["claims"]["answer"]["unchecked"], 1);
        }
    }
    let good = run_in(here, &["check", "alone/clean.md", "--models", "alone/elsewhere"]);
    assert_eq!(good.code, 0, "{}", good.stdout);
    let text =
        std::fs::read_to_string(here.join("clean.md")).unwrap().replace("\"ball_drop\"", "\"ball_dorp\"");
    std::fs::write(here.join("alone/typo.md"), text).unwrap();
    let typo = run_in(here, &["check", "alone/typo.md", "--models", "alone/elsewhere"]);
    assert_eq!(typo.code, 1, "{}", typo.stdout);
    assert!(typo.stdout.contains("unknown-model") && typo.stdout.contains("not run"), "{}", typo.stdout);
}

/// Line 2: a wrong closed form, one for no trace, one that does not compile; a right one; one within a tolerance.
#[test]
fn closed_forms_are_compared_with_their_traces() {
    let exact = |exact: Json| check_json(&lab(json!({"verify": {"exact": exact}})));
    let state = |checked: &Checked| entries(checked, Subject::ClosedForm)[0].state;
    let right = "2 - 0.5 * 9.81 * data.time * data.time";
    let good = exact(json!({"b": right}));
    assert_eq!(
        (codes(&good), state(&good)),
        (vec![], State::True(Evidence::Simulated)),
        "{:#?}",
        good.findings
    );
    for (form, code) in [
        (json!({"b": "2 - 0.5 * 9.71 * data.time * data.time"}), "closed-form-wrong"),
        (json!({"b": "2 - 0.5 * 9.8099 * data.time * data.time"}), "closed-form-wrong"),
        (json!({"b": "2.00001 - 0.5 * 9.81 * data.time * data.time"}), "closed-form-wrong"),
        (json!({"b": "0"}), "closed-form-wrong"),
        (json!({"b": {"is": right, "tol": 1e-6}}), "closed-form-wrong"),
    ] {
        let wrong = exact(form.clone());
        assert_eq!((codes(&wrong), state(&wrong)), (vec![code], State::False), "{form}");
        assert_eq!(outcome(&wrong), Outcome::Findings);
    }
    let within = exact(json!({"b": {"is": right, "tol": 0.01}}));
    assert_eq!((codes(&within), state(&within)), (vec![], State::True(Evidence::Simulated)));
    for (form, code) in [
        (json!({"c": right}), "unknown-trace"),
        (json!({"b": "2 - 0.5 * gravity"}), "unknown-name"),
        (json!({"b": "Math.sqrt(-1)"}), "closed-form-untried"),
    ] {
        let untried = exact(form.clone());
        assert_eq!((codes(&untried), state(&untried)), (vec![code], State::Unchecked), "{form}");
        assert_eq!(outcome(&untried), Outcome::Findings);
    }
}

/// The tolerance for a fourth-order method follows from its order, and an exact trace must agree up to rounding.
#[test]
fn closed_forms_are_judged_at_the_order_of_the_integrator() {
    let xml = "<mujoco><option integrator='RK4' timestep='0.01'><flag contact='disable'/></option><worldbody><body><joint name='s' type='slide' axis='1 0 0' stiffness='10'/><geom size='0.1' mass='1'/></body></worldbody><keyframe><key qpos='0.1'/></keyframe></mujoco>";
    let exact = |form: &str| {
        let lab = lab(
            json!({"xml": xml, "key": 0, "controls": [], "stopAt": 2, "plots": [{"traces": [{"label": "b", "expr": "data.qpos[0]"}]}], "readouts": [], "verify": {"exact": {"b": form}}}),
        );
        entries(&check_json(&lab), Subject::ClosedForm)[0].state
    };
    assert_eq!(exact("0.1 * Math.cos(Math.sqrt(10) * data.time)"), State::True(Evidence::Simulated));
    assert_eq!(exact("0.1 * Math.cos(Math.sqrt(10.0001) * data.time)"), State::False);
    // A value that the same run computes is not an independent formula, in any form.
    for form in [
        "data.qpos[0]",
        "data.time + 0 * data.qvel[0]",
        "data.joint('s').qpos[0]",
        "model.key_qpos[0] + data.energy[0]",
    ] {
        assert_eq!(exact(form), State::Unchecked, "{form}");
    }
}

/// Line 3: only `says`: the numbers are verified, the answer is not, and the report distinguishes them.
#[test]
fn numbers_do_not_verify_an_answer() {
    let verify = json!({"runs": {"run": {"set": {"h": 0.002}, "until": 0.5}}, "measure": {"fall": "2 - final(data.qpos[2])"}, "says": [["1.231 m", "fall"]]});
    let checked = check_json(&question(1, verify));
    assert_eq!(codes(&checked), [""; 0], "{:#?}", checked.findings);
    assert_eq!(answer(&checked).verdict, Verdict::Unverified);
    assert_eq!(entries(&checked, Subject::Answer)[0].state, State::NotClaimed);
    assert_eq!(entries(&checked, Subject::Quote)[0].state, State::True(Evidence::Simulated));
}

/// Line 4: constants, formulas without simulation, and comparisons with NaN.
#[test]
fn constants_and_nan_are_evidence_of_nothing() {
    let judged = |options: Json, measure: Json| {
        let verify = json!({"runs": {"run": {"until": 0.5}}, "measure": measure, "options": options});
        let checked = check_json(&question(0, verify));
        (answer(&checked).verdict, codes(&checked))
    };
    let fall = json!({"fall": "2 - final(data.qpos[2])"});
    let constants = judged(json!(["true", "false"]), fall.clone());
    assert_eq!(constants, (Verdict::Failed, vec!["constant-claim"; 2]));
    assert_eq!(judged(json!(["fall < 2", "false"]), fall.clone()), (Verdict::Failed, vec!["constant-claim"]));
    assert_eq!(judged(json!(["fall < 2", "fall >= 2"]), fall.clone()), (Verdict::Verified, vec![]));
    let formula = judged(json!(["0.5 * 9.81 * 0.5 * 0.5 < 2", "0.5 * 9.81 * 0.5 * 0.5 >= 2"]), fall.clone());
    assert_eq!(formula, (Verdict::Computed, vec![]));
    let measured = judged(json!(["five < 6", "five >= 6"]), json!({"five": "final(2 + 3)"}));
    assert_eq!(measured, (Verdict::Computed, vec![]), "a measure that looks at nothing is no simulation");
    let never = json!({"never": "first(data.qpos[2] < -99)"});
    for options in
        [json!(["!(never < 1)", "never < 1"]), json!(["abs(never - 1) >= 0 ? false : true", "never < 1"])]
    {
        let (verdict, found) = judged(options, never.clone());
        assert_eq!(verdict, Verdict::Failed);
        assert!(found.contains(&"measure-without-value"), "{found:?}");
    }
    assert_eq!(judged(json!(["isNaN(never)", "never < 1"]), never).0, Verdict::Failed);
    let asked = judged(
        json!(["isNaN(never)", "!isNaN(never) && never < 1"]),
        json!({"never": "first(data.qpos[2] < -99)"}),
    );
    assert_eq!(asked, (Verdict::Verified, vec![]));
}

/// The same for numeric answers.
#[test]
fn a_numeric_answer_needs_a_simulated_value() {
    let judged = |value: &str| {
        let quiz = json!({"id": "q", "questions": [{"kind": "numeric", "q": "How far?", "answer": 1.23, "unit": "m", "verify": {"lab": lab(json!({})), "value": value}}]});
        let checked = check_json(&quiz);
        (answer(&checked).verdict, codes(&checked))
    };
    assert_eq!(judged("1.23"), (Verdict::Failed, vec!["constant-claim"]));
    assert_eq!(judged("0.5 * 9.81 * 0.5 * 0.5"), (Verdict::Computed, vec![]));
    assert_eq!(judged("2 - final(data.qpos[2])"), (Verdict::Verified, vec![]));
    assert_eq!(judged("first(data.qpos[2] < -99)"), (Verdict::Failed, vec!["measure-without-value"]));
}

/// Line 5: a run that fails verifies nothing, unless a condition reads its warnings, or the lesson states that it fails.
#[test]
fn a_run_that_breaks_verifies_nothing() {
    let judged = |options: Json, expect: Option<&str>| {
        let mut verify = json!({"runs": {"run": {"until": 0.5, "setup": "data.qvel[0] = 1e11"}}, "measure": {"z": "final(data.qpos[2])"}, "options": options});
        if let Some(expect) = expect {
            verify["runs"]["run"]["expect"] = json!(expect);
        }
        let checked = check_json(&question(0, verify));
        (answer(&checked).verdict, codes(&checked))
    };
    let heights = json!(["z > -1", "z <= -1"]);
    assert_eq!(judged(heights.clone(), None), (Verdict::Failed, vec!["run-breaks"]));
    let warned = judged(json!(["warnings > 0", "warnings === 0"]), None);
    assert_eq!(warned.0, Verdict::Verified);
    assert_eq!(judged(heights.clone(), Some("breaks")), (Verdict::Verified, vec![]));
    let calm = json!({"runs": {"run": {"until": 0.5, "expect": "breaks"}}, "measure": {"z": "final(data.qpos[2])"}, "options": heights});
    assert_eq!(codes(&check_json(&question(0, calm))), ["does-not-break"]);
}

/// A claim that fails at run time is a claim that could not be checked.
#[test]
fn a_claim_that_throws_is_not_true() {
    let verify = json!({"runs": {"run": {"until": 0.5}}, "measure": {"z": "final(data.qpos[2])"}, "options": ["z.toFixed(101) < 2", "z > 3"]});
    let checked = check_json(&question(0, verify));
    assert_eq!(answer(&checked).verdict, Verdict::Failed);
    assert_eq!(outcome(&checked), Outcome::Findings);
    assert!(!checked.findings.is_empty());
}

/// Line 9: the report contains the measures, also at half the timestep, and the margin of each condition.
#[test]
fn doubtful_answers_print_their_measures() {
    let folder = folder();
    let verify = json!({"runs": {"run": {"until": 0.5}}, "measure": {"fall": "2 - final(data.qpos[2])"}, "options": ["fall < 1", "fall >= 1"]});
    std::fs::write(folder.path().join("q.json"), question(0, verify).to_string()).unwrap();
    let stdout = run_in(folder.path(), &["check", "q.json"]).stdout;
    for part in [
        "refuted",
        "fall = 1.23116   (1.2287",
        "at half the timestep)",
        "option 0 does not hold, by 0.231",
        "option 1 holds, by 0.231",
    ] {
        assert!(stdout.contains(part), "{part} is not in\n{stdout}");
    }
}

/// If nothing can be checked, the exit code is 2, for any arguments.
#[test]
fn nothing_to_check_is_no_success() {
    let folder = folder();
    std::fs::write(folder.path().join("prose.md"), "# Only prose\n").unwrap();
    for arguments in
        [&["check", "prose.md"][..], &["verify", "prose.md"], &["verify", "models/free_fall.xml"]]
    {
        let done = run_in(folder.path(), arguments);
        assert_eq!(done.code, 2, "{arguments:?}: {}{}", done.stdout, done.stderr);
        assert!(!done.stdout.contains("no problems found"), "{}", done.stdout);
    }
    assert_eq!(run_in(folder.path(), &["check", "models/free_fall.xml"]).code, 0);
    assert_eq!(run_in(folder.path(), &["check", "broken/models/ball_drop.xml"]).code, 1);
}

/// A file that cannot be read does not affect the others.
#[test]
fn an_unreadable_file_hides_nothing() {
    let folder = folder();
    std::fs::write(folder.path().join("latin.md"), b"# Caf\xe9\n").unwrap();
    let done = run_in(folder.path(), &["check", "latin.md", "wrong.md", "nowhere.md", "clean.md"]);
    assert_eq!(done.code, 1);
    for part in ["unreadable-file", "latin.md", "nowhere.md", "quote-wrong", "clean.md"] {
        assert!(done.stdout.contains(part), "{part} is not in\n{}", done.stdout);
    }
}

/// Claims that would take too long stop at the work limit of a check, and this is reported.
#[test]
fn claims_are_checked_within_a_budget() {
    let start = std::time::Instant::now();
    // 2,000 measures over 900,000 steps, and the same number for each numerical variant.
    let measure: Json = (0..2000)
        .map(|i| (format!("m{i}"), json!(format!("final(data.qpos[2]) + {i}"))))
        .collect::<serde_json::Map<_, _>>()
        .into();
    let long =
        json!({"runs": {"run": {"steps": 900_000}}, "measure": measure, "options": ["m1 < 2", "m1 >= 2"]});
    let checked = check_json(&question(0, long));
    assert_eq!(answer(&checked).verdict, Verdict::Failed);
    assert!(codes(&checked).contains(&"run-breaks"), "{:?}", codes(&checked));
    assert!(entries(&checked, Subject::Run)[0].remark.contains("the work budget ran out"));
    // 400 quotes in a lesson of megabytes, each found at its location.
    let says: Vec<Json> = (0..400).map(|i| json!([format!("{i}.25 m"), format!("{i} + 0.25")])).collect();
    let verify = json!({"runs": {"run": {"until": 0.1}}, "measure": {"fall": "2 - final(data.qpos[2])"}, "says": says});
    let prose: String = (0..400)
        .map(|i| format!("It is {i}.25 m away. {}\n\n", "Words and no numbers. ".repeat(400)))
        .collect();
    let text = format!("{prose}```lab\n{}\n```\n", lab(json!({"verify": verify})));
    assert!(text.len() > 3 << 20);
    let checked = check_text("lesson.md", &text);
    let right =
        entries(&checked, Subject::Quote).iter().filter(|e| matches!(e.state, State::True(_))).count();
    assert_eq!(right, 400, "{:?}", codes(&checked));
    // Two cases with at most twenty seconds of processor time each; the machine may be busy.
    assert!(start.elapsed().as_secs() < 120, "{:?}", start.elapsed());
}

/// A lab in broken JSON is still parsed, but nothing about it is called true, because a page cannot read it.
#[test]
fn broken_json_is_never_clean() {
    let text = format!("```lab\n{}\n```\n", lab(json!({})).to_string().replacen(',', " ", 1));
    let checked = check_text("lesson.md", &text);
    assert_eq!(entries(&checked, Subject::Lab)[0].state, State::Unchecked);
    assert_eq!(outcome(&checked), Outcome::Findings);
}

/// A control for whose end no run is possible: the lab was not run completely.
#[test]
fn a_control_that_cannot_be_tried_is_no_whole_run() {
    let slider =
        json!([{"label": "h", "set": "model.opt.timestep", "min": 1e-9, "max": 0.02, "value": 0.002}]);
    let checked = check_json(&lab(json!({"controls": slider})));
    assert!(codes(&checked).contains(&"run-impossible"), "{:?}", codes(&checked));
    let found = &entries(&checked, Subject::Lab)[0];
    assert_eq!(found.state, State::Unchecked, "{found:?}");
    assert!(found.remark.contains("1 run not made"), "{found:?}");
}
