//! What counts as evidence: the tables of docs/verify.md, row by row, and kinds of claims that earlier versions called verified
//! although no other result was possible.

#![allow(clippy::unwrap_used, clippy::panic)]

use crate::support::{check_text, codes, workspace};
use labspec::check::Checked;
use labspec::verify::{QuoteState, Verdict};
use serde_json::{Value as Json, json};

const BALL: &str = "<mujoco><worldbody><geom name='floor' type='plane' size='1 1 1'/><body name='ball' pos='0 0 1'><freejoint name='j'/><geom name='ball' size='0.05' mass='1'/></body><body name='other' pos='3 0 1'><freejoint/><geom name='other' size='0.05' mass='1'/></body></worldbody></mujoco>";

fn lab() -> Json {
    json!({
        "xml": BALL, "stopAt": 1,
        "controls": [
            {"label": "g", "set": "model.opt.gravity[2]", "min": -20, "max": -1, "step": 0.01, "value": -9.81, "reset": true}
        ],
        "plots": [{"ylabel": "height (m)", "traces": [{"label": "height (m)", "expr": "data.qpos[2]"}]}],
    })
}

fn measures() -> Json {
    json!({
        "z": "final(data.qpos[2])", "t": "first(contact('ball', 'floor'))", "bounces": "count(contact('ball', 'floor'))",
        "never": "first(data.qpos[2] > 3)"
    })
}

fn checked(question: &Json) -> Checked {
    checked_with(&lab(), question)
}

fn checked_with(lab: &Json, question: &Json) -> Checked {
    let quiz = json!({"id": "q", "questions": [question]});
    let text = format!("# A fall\n\n```lab\n{lab}\n```\n\n```quiz\n{quiz}\n```\n");
    check_text("lesson.md", &text)
}

fn verdict(checked: &Checked) -> Verdict {
    checked.claims.iter().rev().find_map(|c| c.judgement.answer.as_ref()).unwrap().verdict
}

/// A question whose first option holds under a condition, and whose second holds under its negation.
fn choice(condition: &str, more: &Json) -> Checked {
    let mut verify = json!({
        "lab": "#1", "runs": {"run": {"until": 1}}, "measure": measures(),
        "options": [condition, "z > 5"],
    });
    for (key, value) in more.as_object().unwrap() {
        verify[key] = value.clone();
    }
    checked(
        &json!({"kind": "mcq", "q": "What happens?", "options": ["this", "that"], "answer": 0, "explain": "So.", "verify": verify}),
    )
}

fn numeric(value: &str, answer: f64, more: &Json) -> Checked {
    let mut verify =
        json!({"lab": "#1", "runs": {"run": {"until": 1}}, "measure": measures(), "value": value});
    for (key, value) in more.as_object().unwrap() {
        verify[key] = value.clone();
    }
    checked(
        &json!({"kind": "numeric", "q": "How much?", "answer": answer, "tol": 0.01, "explain": "So.", "verify": verify}),
    )
}

/// All rows of the tables of a section: the claim, and its result.
fn rows(section: &str) -> Vec<(String, String)> {
    let text = std::fs::read_to_string(workspace().join("docs/verify.md")).unwrap();
    let start = text.find(&format!("\n## {section}\n")).unwrap();
    let end = text[start + 4..].find("\n## ").map_or(text.len(), |n| start + 4 + n);
    let line = |line: &str| {
        let (written, becomes) = line.strip_prefix("| `")?.split_once("` | ")?;
        Some((written.replace("\\|", "|"), becomes.strip_suffix(" |")?.to_string()))
    };
    text[start..end].lines().filter_map(line).collect()
}

#[test]
fn the_tables_of_the_guide_are_so() {
    for section in ["Evidence", "NaN"] {
        let rows = rows(section);
        assert!(rows.len() > 15, "{section}");
        for (condition, becomes) in rows {
            let checked = choice(&condition, &json!({}));
            let (verdict, codes) = (verdict(&checked), codes(&checked));
            match becomes.as_str() {
                "verified" => assert_eq!((verdict, codes), (Verdict::Verified, vec![]), "{condition}"),
                "computed" => assert_eq!((verdict, codes), (Verdict::Computed, vec![]), "{condition}"),
                code => {
                    assert_eq!(verdict, Verdict::Failed, "{condition}: {codes:?}");
                    assert!(codes.contains(&code), "{condition}: {codes:?}");
                }
            }
        }
    }
}

/// All rows of the table of units: the quoted text, the claim, and the result.
#[test]
fn the_table_of_units_is_so() {
    let text = std::fs::read_to_string(workspace().join("docs/verify.md")).unwrap();
    let section = text.split("\n## Units\n").nth(1).unwrap().split("\n## ").next().unwrap();
    let row = |line: &str| {
        let (quoted, rest) = line.strip_prefix("| `")?.split_once("` | `")?;
        let (expr, becomes) = rest.split_once("` | ")?;
        Some((quoted.to_string(), expr.to_string(), becomes.strip_suffix(" |")?.to_string()))
    };
    let rows: Vec<_> = section.lines().filter_map(row).collect();
    assert!(rows.len() > 20);
    for (quoted, expr, becomes) in rows {
        let verify = json!({"lab": "#1", "runs": {"run": {"until": 1}}, "measure": measures(), "says": [[quoted, expr]]});
        let text = format!(
            "# A fall\n\n```lab\n{}\n```\n\n<!-- labspec verify {verify} -->\nIt takes {quoted} here.\n",
            lab()
        );
        let checked = check_text("lesson.md", &text);
        let quote = checked.claims.iter().flat_map(|c| &c.judgement.quotes).next().unwrap();
        let state = match quote.state {
            QuoteState::Right => "right",
            QuoteState::Wrong => "wrong",
            QuoteState::Unclear => "unclear",
        };
        assert_eq!(state, becomes, "{quoted}: {}", quote.reason);
    }
}

#[test]
fn a_value_is_a_number_that_could_be_another_one() {
    let right = numeric("z", 0.05, &json!({}));
    assert_eq!((verdict(&right), codes(&right)), (Verdict::Verified, vec![]));
    for (value, answer) in [
        ("0.05 + 0 * z", 0.05),
        ("z - z", 0.0),
        ("Math.min(z, 0) + 0.05 - Math.min(z, 0)", 0.05),
        ("z < 0.1", 1.0),
        ("0.05 + 1e-12 * z", 0.05),
        ("data.qpos[2]", 1.0),
        ("never", 0.0),
        ("never || 0.05", 0.05),
        ("[z, never].length", 2.0),
        ("'0.05'", 0.05),
    ] {
        let checked = numeric(value, answer, &json!({}));
        assert!(!matches!(verdict(&checked), Verdict::Verified), "{value}: {:?}", codes(&checked));
        assert!(!codes(&checked).is_empty() || verdict(&checked) == Verdict::Computed, "{value}");
    }
    // The result of an invalid distractor is undecided as well.
    for wrong in ["never", "never || 3", "t < 1", "data.qpos[2]"] {
        let checked = numeric("z", 0.05, &json!({"wrong": [wrong]}));
        assert_eq!(verdict(&checked), Verdict::Failed, "{wrong}: {:?}", codes(&checked));
    }
    let checked = numeric("z", 0.05, &json!({"wrong": ["z + 1", "7"]}));
    assert_eq!((verdict(&checked), codes(&checked)), (Verdict::Verified, vec![]));
}

#[test]
fn a_measure_without_numbers_says_how_many_are_missing() {
    let measure = json!({"measure": {"z": "final(data.qpos[2])", "root": "max(Math.sqrt(0.2 - data.time))"}});
    let checked = choice("root < 1", &measure);
    let finding = checked.findings.iter().find(|f| f.code == "measure-without-value").unwrap();
    let why = format!("{:?}", finding);
    assert!(why.contains("samples have no number, the first at t = 0.2 s"), "{why}");
}

#[test]
fn late_decisions_count() {
    for (measure, holds) in [
        ("final(Math.sqrt(data.time - 0.5) + data.qpos[2])", "m > 0.7"),
        ("last(Math.sqrt(data.time - 0.5) > data.qpos[2])", "m > 0.9"),
        ("first(data.qvel[2] < previous(data.qvel[2]))", "m < 0.1"),
        ("at(data.time > 0.6, Math.sqrt(data.time - 0.5) + data.qpos[2])", "m > 0.3"),
        ("settles(data.qpos[2], 0.05, 0.02)", "m < 1"),
    ] {
        let checked = choice(holds, &json!({"measure": {"z": "final(data.qpos[2])", "m": measure}}));
        assert_eq!(verdict(&checked), Verdict::Verified, "{measure}: {:?}", codes(&checked));
    }
    for measure in [
        "min(Math.sqrt(data.time - 0.5))",
        "mean(Math.sqrt(data.time - 0.5))",
        "count(Math.sqrt(data.time - 0.5) > 0.1)",
        "first(Math.sqrt(data.time - 0.5) > 0.1)",
        "holds(!(Math.sqrt(data.time - 0.5) < -1))",
        "peak([1].find(x => x > data.time + 5))",
        "crossings(Math.sqrt(data.time - 0.5), 0.3)",
        "rms(Math.log(-data.time))",
    ] {
        let checked = choice("m > -1e9", &json!({"measure": {"z": "final(data.qpos[2])", "m": measure}}));
        assert_eq!(verdict(&checked), Verdict::Failed, "{measure}: {:?}", codes(&checked));
    }
}

#[test]
fn a_range_covers_the_values_that_were_read() {
    let over = |range: Json, runs: Json| {
        choice("run.z < 0.4", &json!({"over": range, "runs": runs, "options": ["run.z < 0.4", "run.z > 5"]}))
    };
    let runs = || json!({"run": {"until": 1.5}});
    let held = over(json!({"g": [-12, -5]}), runs());
    assert!(matches!(verdict(&held), Verdict::Verified | Verdict::Refuted), "{:?}", codes(&held));
    // A slider that the run sets itself, in the only run that is read.
    let pinned = over(
        json!({"g": [-12, -5]}),
        json!({"run": {"until": 1.5, "set": {"g": -9.81}}, "free": {"until": 0.1}}),
    );
    assert_eq!(verdict(&pinned), Verdict::Failed, "{:?}", codes(&pinned));
    // A slider without an effect.
    let mut with_idle = lab();
    with_idle["controls"] = json!([{"label": "idle", "apply": "data.qvel[3] = 0 * value", "min": 0, "max": 1, "step": 0.1, "value": 0}]);
    let verify = json!({"lab": "#1", "runs": runs(), "measure": measures(), "over": {"idle": [0, 1]}, "options": ["run.z < 0.4", "run.z > 5"]});
    let idle = checked_with(
        &with_idle,
        &json!({"kind": "mcq", "q": "What?", "options": ["this", "that"], "answer": 0, "explain": "So.", "verify": verify}),
    );
    assert_eq!(verdict(&idle), Verdict::Failed, "{:?}", codes(&idle));
    assert!(codes(&idle).contains(&"run-impossible"), "{:?}", codes(&idle));
}

#[test]
fn a_search_finds_a_narrow_band_and_states_its_range() {
    // The condition fails in a band of a hundredth of the range, between two of the values that are tried first.
    let find = |condition: &str| {
        json!({"find": {"limit": {"largest": "g", "from": -20, "to": -2, "while": condition, "tol": 1e-3}},
            "options": ["abs(limit + 8.163) < 0.05", "limit > -7"]})
    };
    let half_way = "crossing(data.qpos[2], 0.5)";
    let clean = choice("", &find(&format!("{half_way} < 0.35")));
    assert_eq!(verdict(&clean), Verdict::Verified, "{:?}", codes(&clean));
    let answer = checked_reason(&clean);
    assert!(answer.contains("`limit` was searched at") && answer.contains("from -20 to -2"), "{answer}");
    let band = choice("", &find(&format!("{half_way} < 0.35 && abs({half_way} - 0.26) > 0.001")));
    assert_eq!(verdict(&band), Verdict::Failed, "{:?}", codes(&band));
}

fn checked_reason(checked: &Checked) -> String {
    checked.claims.iter().rev().find_map(|c| c.judgement.answer.as_ref()).unwrap().reason.clone()
}

#[test]
fn a_closed_form_depends_on_time_alone_and_has_a_small_uncertainty() {
    let spring = |h: &str, form: &str| {
        let xml = format!(
            "<mujoco><option timestep='{h}' gravity='0 0 0'><flag contact='disable'/></option><worldbody><body><joint name='s' type='slide' axis='1 0 0' stiffness='100'/><geom size='0.1' mass='1'/></body></worldbody><keyframe><key qpos='0.1'/></keyframe></mujoco>"
        );
        let lab = json!({"xml": xml, "key": 0, "stopAt": 3, "plots": [{"traces": [{"label": "x", "expr": "data.qpos[0]"}]}], "verify": {"exact": {"x": form}}});
        let checked = check_text("lesson.md", &format!("# A\n\n```lab\n{lab}\n```\n"));
        let form = checked.claims.iter().flat_map(|c| &c.judgement.exact).next().unwrap().clone();
        form.state
    };
    use labspec::ledger::{Evidence, State};
    assert_eq!(spring("0.001", "0.1 * Math.cos(10 * data.time)"), State::True(Evidence::Simulated));
    assert_eq!(spring("0.001", "0.1 * Math.cos(10.1 * data.time)"), State::False);
    // The timestep shifts the phase by 1.5 rad, so the formula cannot be verified.
    for form in ["0", "0.1 * Math.cos(10 * data.time)", "0.1 * Math.cos(11 * data.time)"] {
        assert_ne!(spring("0.15", form), State::True(Evidence::Simulated), "{form}");
    }
    for form in
        ["data.qpos[0]", "0.1 * Math.cos(10 * data.time) + 0 * data.qvel[0]", "data.joint('s').qpos[0]"]
    {
        assert_eq!(spring("0.001", form), State::Unchecked, "{form}");
    }
}

#[test]
fn a_label_of_several_plots_is_ambiguous() {
    let mut two = lab();
    two["plots"] = json!([
        {"traces": [{"label": "x", "expr": "data.qpos[2]"}]}, {"traces": [{"label": "x", "expr": "data.qvel[2]"}]}
    ]);
    for (label, fine) in [("x", false), ("plot/0/x", true), ("plot/1/x", true)] {
        let verify = json!({"lab": two, "measure": {"m": format!("initial(shown('{label}'))")}, "options": ["m > -50 && m < 50", "m > 50"]});
        let checked = checked(
            &json!({"kind": "mcq", "q": "What?", "options": ["this", "that"], "answer": 0, "explain": "So.", "verify": verify}),
        );
        assert_eq!(verdict(&checked) == Verdict::Verified, fine, "{label}: {:?}", codes(&checked));
    }
    // A closed form applies to all traces with the label, but it holds for only one of them.
    two["verify"] = json!({"exact": {"x": {"is": "1 - 0.5 * 9.81 * data.time ** 2", "tol": 0.1}}});
    two["stopAt"] = json!(0.4);
    let checked = check_text("lesson.md", &format!("# A\n\n```lab\n{two}\n```\n"));
    assert!(codes(&checked).contains(&"closed-form-wrong"), "{:?}", codes(&checked));
}

/// An object with errors may have another meaning than intended, so it is not verified. A run is
/// evidence only for what it does.
#[test]
fn an_object_with_errors_is_not_verified() {
    assert_eq!(verdict(&choice("z < 0.1", &json!({}))), Verdict::Verified);
    for more in [
        json!({"says": "0.44 s"}),
        json!({"over": {"g": [-9.81, -9.81]}}),
        json!({"runs": {"run": {"until": 1, "steps": 0}}}),
        json!({"runs": {"run": {"until": 1, "expect": "breaks"}}}),
        json!({"meassure": {"a": "1"}}),
    ] {
        let checked = choice("z < 0.1", &more);
        let errors = checked.findings.iter().any(|f| f.is_error());
        let untrue = matches!(verdict(&checked), Verdict::Failed | Verdict::Refuted);
        assert!(untrue && errors, "{more}: {:?}", codes(&checked));
    }
}

/// An unknown unit, and a unit that belongs to another quantity, in all uses of the number in the text.
#[test]
fn a_unit_is_compared_or_reported_as_not_compared() {
    let asked = |unit: &str, value: &str| {
        let verify =
            json!({"lab": "#1", "runs": {"run": {"until": 1}}, "measure": measures(), "value": value});
        let q = json!({"kind": "numeric", "q": "When?", "answer": 0.442, "tol": 0.01, "unit": unit, "explain": "So.", "verify": verify});
        let checked = checked(&q);
        let answer = checked.claims.iter().find_map(|c| c.judgement.answer.clone()).unwrap();
        (answer.verdict, answer.reason)
    };
    assert_eq!(asked("s", "t"), (Verdict::Verified, String::new()));
    for unit in ["S", "blinks", "x"] {
        assert_eq!(asked(unit, "t").0, Verdict::Failed, "{unit}");
    }
    for value in ["t", "[t][0]", "+t.toFixed(6)", "(x => x)(t)", "Math.exp(Math.log(t))", "Number(String(t))"]
    {
        assert_eq!(asked("kg", value).0, Verdict::Refuted, "{value}");
        assert_eq!(asked("s", value).0, Verdict::Verified, "{value}");
    }
    // A number literal that is a factor may have a dimension.
    for unit in ["kg", "m", "N"] {
        let (verdict, reason) = asked(unit, "1.001 * t");
        assert_eq!(verdict, Verdict::Verified, "{unit}");
        assert!(reason.contains("its unit could not be compared"), "{unit}: {reason}");
    }
    let (verdict, reason) = asked("kg", "t > 0.1 ? 0.442 : 5");
    assert_eq!(verdict, Verdict::Verified);
    assert!(reason.contains("its unit could not be compared"), "{reason}");
}
