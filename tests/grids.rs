//! Sweeps over several quantities, tables that are claimed by rows and by several columns at once, and runs that may break.

#![allow(clippy::unwrap_used)]

use crate::support::check_text;
use labspec::finding::Finding;
use serde_json::{Value, json};

const BALL: &str = "<mujoco><worldbody><geom name='floor' type='plane' size='1 1 1'/><body name='ball' pos='0 0 1'><freejoint/><geom name='ball' type='sphere' size='0.05' mass='1'/></body></worldbody></mujoco>";
/// A spring that breaks with long timesteps: ω = 100 rad/s, so that Euler's method is stable below 20 ms.
const SPRING: &str = "<mujoco><option gravity='0 0 0'/><worldbody><body><joint name='j' type='slide' axis='1 0 0' stiffness='10000'/><geom size='0.05' mass='1'/></body></worldbody></mujoco>";

/// The verdicts of the quotes of a lesson, the verdicts of its answers, and the findings.
fn check(text: &str) -> (Vec<String>, Vec<String>, Vec<Finding>) {
    let checked = check_text("grid.md", text);
    let judged = || checked.claims.iter().map(|claim| &claim.judgement);
    let quotes = judged().flat_map(|j| &j.quotes).map(|quote| quote.verdict().to_string()).collect();
    let answers =
        judged().filter_map(|j| j.answer.as_ref()).map(|a| a.verdict.as_str().to_string()).collect();
    (quotes, answers, checked.findings)
}

fn drops(prose: &str, verify: &Value) -> String {
    let lab = json!({"xml": BALL,
        "controls": [{"label": "height (m)", "apply": "data.qpos[2] = value", "min": 0.5, "max": 2, "step": 0.05, "value": 1, "init": true},
            {"label": "gravity", "set": "model.opt.gravity[2]", "min": -20, "max": -1, "step": 0.01, "value": -9.81, "reset": true}],
        "verify": verify});
    format!("{prose}\n\n```lab simlab\n{lab}\n```\n")
}

/// The time of a fall for every combination of a height and a gravity, and for an attribute of the model.
fn grid(more: &Value) -> Value {
    let mut verify = json!({
        "runs": {"fall": {"sweep": {"height (m)": [0.5, 1.5], "gravity": [-9.81, -1.62, -3.72]}, "model": {"option timestep": 0.002}, "until": 2, "stop": "contact('ball', 'floor')"}},
        "measure": {"touch": "first(contact('ball', 'floor'))", "mass": "initial(model.body_mass[1])"}});
    for (key, value) in more.as_object().unwrap() {
        verify[key] = value.clone();
    }
    verify
}

#[test]
fn a_sweep_combines_several_quantities() {
    let right = [
        ["6 runs", "fall.touch.length"],
        ["0.304 s", "fall.touch[0]"],
        ["0.748 s", "fall.touch[1]"],
        ["0.494 s", "fall.touch[2]"],
        ["1.340 s", "fall.touch[4]"],
        ["-1.62 m/s^2", "fall.value2[4]"],
        ["1.5 m", "fall.value[4]"],
    ];
    let quotes: Vec<&str> = right.iter().map(|s| s[0]).collect();
    let (verdicts, _, found) = check(&drops(&quotes.join("; "), &grid(&json!({"says": right}))));
    assert_eq!(verdicts[1..5], ["verified"; 4], "{found:#?}");
    assert!(verdicts.iter().all(|v| v == "verified" || v == "computed"), "{verdicts:?} {found:#?}");
    // The last quantity changes fastest: the neighbour is another combination.
    let wrong = json!({"says": [["0.304 s", "fall.touch[3]"], ["0.748 s", "fall.touch[2]"]]});
    assert_eq!(check(&drops("0.304 s; 0.748 s", &grid(&wrong))).0, ["refuted"; 2]);
}

/// A list of several quantities has no single list of values, so a line through it needs the values.
#[test]
fn a_law_over_several_quantities_names_its_values() {
    let says = json!({"says": [["0.5 s", "slope(fall.touch)"]]});
    let (verdicts, _, found) = check(&drops("0.5 s", &grid(&says)));
    assert_eq!(verdicts, ["failed"]);
    assert!(
        found
            .iter()
            .any(|f| format!("{} {:?} {:?}", f.message, f.why, f.help)
                .contains("slope(run.measure, run.value2)")),
        "{found:#?}"
    );
    let says = json!({"says": [["0.18 s/m", "slope(fall.touch, fall.value)"]]});
    assert_ne!(check(&drops("0.18 s/m", &grid(&says))).0, ["failed"]);
}

/// Controls and attributes of the model are combined; values can be drawn at random, the same for the same seed.
#[test]
fn a_sweep_draws_values_at_random() {
    let verify = |seed: u32| {
        json!({"runs": {"r": {"sweep": {"body ball mass": [1, 2], "height (m)": {"from": 0.5, "to": 2, "count": 3, "seed": seed}}, "until": 0.01}},
            "measure": {"z": "initial(data.qpos[2])", "mass": "initial(model.body_mass[1])"},
            "says": [["0 m", "Math.abs(r.z[0] - r.value2[0])"], ["4 kg", "r.mass[3] + r.mass[5]"]]})
    };
    // Drawn values keep to the steps of the slider.
    let (verdicts, _, found) = check(&drops("0 m; 4 kg", &verify(1)));
    assert_eq!(
        (verdicts, found.len()),
        (vec!["verified".to_string(), "computed".to_string()], 0),
        "{found:#?}"
    );
    let attribute = |seed: u32, quoted: &str| {
        let verify = json!({"runs": {"r": {"sweep": {"body ball mass": {"from": 1, "to": 3, "count": 4, "seed": seed}}, "until": 0.01}},
            "measure": {"mass": "initial(model.body_mass[1])"}, "says": [[quoted, "r.mass[2]"]]});
        check(&drops(quoted, &verify)).0
    };
    // By a program of SplitMix64 in Python, whose state is the bits of the seed: the third number between 1 and 3.
    assert_eq!(attribute(7, "2.758 kg"), ["computed"]);
    assert_eq!(attribute(8, "2.758 kg"), ["refuted"]);
    assert_eq!(attribute(8, "1.288 kg"), ["computed"]);
}

const TABLE: &str = "| height (m) | touchdown (s) | speed (m/s) |\n|---|---|---|\n| 0.5 | 0.304 | 2.96 |\n| 1.0 | 0.442 | 4.32 |\n| 1.5 | CELL | 5.34 |\n";

fn table(cell: &str, table: &Value) -> (Vec<String>, Vec<String>, Vec<Finding>) {
    let verify = json!({
        "runs": {"fall": {"sweep": {"height (m)": [0.5, 1, 1.5]}, "until": 1, "stop": "contact('ball', 'floor')"}},
        "measure": {"touch": "first(contact('ball', 'floor'))", "speed": "before(contact('ball', 'floor'), -data.qvel[2])"}, "table": table});
    check(&drops(&TABLE.replace("CELL", cell), &verify))
}

/// All columns in one entry, and all cells of a row in one entry whose first cell tells the member of the sweep.
#[test]
fn a_table_is_claimed_by_columns_and_by_rows() {
    let columns = json!([{"by": ["height (m)", "fall.value"], "columns": {"touchdown (s)": "fall.touch", "speed (m/s)": "fall.speed"}}]);
    let (verdicts, _, found) = table("0.546", &columns);
    assert_eq!(verdicts, ["verified"; 6], "{found:#?}");
    let rows = json!([{"row": "0.5", "is": ["fall.touch", "fall.speed"]}, {"row": "1.5", "is": ["fall.touch", null]}, {"row": "1.0", "is": [null, "fall.speed[1]"]}]);
    let (verdicts, _, found) = table("0.546", &rows);
    assert_eq!(verdicts, ["verified"; 4], "{found:#?}");
    // A wrong cell is refuted, at its place.
    for claim in [&columns, &rows] {
        let (verdicts, _, found) = table("0.556", claim);
        assert_eq!(verdicts.iter().filter(|v| *v == "refuted").count(), 1, "{found:#?}");
        let text = drops(&TABLE.replace("CELL", "0.556"), &json!({}));
        assert!(found.iter().any(|f| text.get(f.span.clone()) == Some("0.556")), "{found:#?}");
    }
}

#[test]
fn a_wrong_claim_of_a_table_is_explained() {
    for (claim, words) in [
        (json!([{"row": "0.7", "is": ["fall.touch"]}]), "no row of a table begins with \"0.7\""),
        (json!([{"row": "0.5", "is": ["fall.touch", null, "fall.speed"]}]), "has 3 cells"),
        (json!([{"row": "0.5"}]), "needs either `column` with `is`"),
        (json!([{"row": "0.5", "is": "fall.touch"}]), "needs either `column` with `is`"),
        (
            json!([{"columns": {"speed (m/s)": "fall.speed"}, "column": "speed (m/s)", "is": "fall.speed", "by": ["height (m)", "fall.value"]}]),
            "needs either `column` with `is`",
        ),
        (
            json!([{"columns": {"speed": "fall.speed"}, "by": ["height (m)", "fall.value"]}]),
            "no table has the columns",
        ),
    ] {
        let (verdicts, _, found) = table("0.546", &claim);
        assert!(verdicts.iter().any(|v| v == "failed") || verdicts.is_empty(), "{claim}: {verdicts:?}");
        assert!(found.iter().any(|f| f.message.contains(words)), "{claim}: {found:#?}");
    }
}

fn spring(expect: Option<&str>, question: &Value) -> String {
    let mut run = json!({"sweep": {"option timestep": [0.005, 0.01, 0.05]}, "until": 20, "setup": "data.qpos[0] = 0.1"});
    if let Some(word) = expect {
        run["expect"] = json!(word);
    }
    let mut question = question.clone();
    question["verify"]["lab"] = json!("#1");
    question["verify"]["runs"] = json!({"swing": run});
    question["verify"]["measure"] = json!({"far": "max(data.qpos[0])"});
    let lab = json!({"xml": SPRING, "readouts": [{"label": "x (m)", "expr": "data.qpos[0]"}]});
    let quiz = json!({"id": "spring", "questions": [question]});
    format!("A spring.\n\n```lab simlab\n{lab}\n```\n\n```quiz\n{quiz}\n```\n")
}

/// Members of a sweep that break are no mistake where the lesson says that they may, or where a condition reads their warnings.
#[test]
fn runs_may_break() {
    let reads_warnings = json!({"q": "With which timestep does the spring break?", "options": ["5 ms", "10 ms", "50 ms"], "answer": 2,
        "verify": {"options": ["swing.warnings[0] > 0", "swing.warnings[1] > 0", "swing.warnings[2] > 0"]}});
    let broken = |found: &[Finding]| found.iter().filter(|f| f.code == "run-breaks").count();
    let (_, answers, found) = check(&spring(None, &reads_warnings));
    assert_eq!((answers, broken(&found)), (vec!["verified".to_string()], 0), "{found:#?}");
    let reads_measure = json!({"q": "Which timestep keeps the spring within 0.2 m?", "options": ["5 ms", "50 ms"], "answer": 0,
        "verify": {"options": ["swing.far[0] < 0.2", "swing.far[2] < 0.2"]}});
    let (answers_unsaid, answers_said) =
        (check(&spring(None, &reads_measure)), check(&spring(Some("may break"), &reads_measure)));
    assert!(broken(&answers_unsaid.2) > 0 && answers_unsaid.1 == ["failed"], "{:#?}", answers_unsaid);
    assert_eq!(
        (answers_said.1, broken(&answers_said.2)),
        (vec!["verified".to_string()], 0),
        "{:#?}",
        answers_said.2
    );
    // "may break" accepts runs that go well, and "breaks" does not.
    let (_, _, found) = check(&spring(Some("breaks"), &reads_warnings));
    assert!(found.iter().any(|f| f.code == "does-not-break"), "{found:#?}");
    let (_, _, found) = check(&spring(Some("explodes"), &reads_warnings));
    assert!(
        found.iter().any(|f| f.help.as_deref().is_some_and(|help| help.contains("may break"))),
        "{found:#?}"
    );
}

/// The texts of options are values of a sweep, and so are the words of an attribute.
#[test]
fn a_sweep_takes_texts() {
    let lab = |sweep: Value, says: Value| {
        let lab = json!({"xml": SPRING, "setup": "data.qpos[0] = 0.1",
            "controls": [{"type": "select", "label": "method", "set": "model.opt.integrator", "reset": true, "value": 0, "options": [["Euler", 0], ["RK4", 1]]}],
            "readouts": [{"label": "x (m)", "expr": "data.qpos[0]"}],
            "verify": {"runs": {"r": {"sweep": sweep, "until": 0.5}}, "measure": {"method": "final(model.opt.integrator)"}, "says": says}});
        check(&format!("It is 1 or 0.\n\n```lab simlab\n{lab}\n```\n"))
    };
    let says = json!([["1", "r.method[1] - 0 * r.value[0]"], ["0", "r.method[2]"]]);
    let sweep = json!({"option timestep": [0.001, 0.002], "method": ["Euler", "RK4"]});
    let (verdicts, _, found) = lab(sweep, says.clone());
    // The value of an option is no result of a simulation.
    assert_eq!(verdicts, ["computed", "computed"], "{found:#?}");
    // An option that does not exist is named with the others.
    let (_, _, found) = lab(json!({"method": ["Euler", "RK5"]}), says.clone());
    assert!(found.iter().any(|f| f.message.contains("RK5") && f.message.contains("\"RK4\"")), "{found:#?}");
    // The words of an attribute that no control sets: Newton's method is solver 2, and CG is solver 1.
    let lab = json!({"xml": SPRING, "verify": {"runs": {"r": {"sweep": {"option solver": ["CG", "Newton"]}, "until": 0.01}},
        "measure": {"solver": "final(model.opt.solver)"}, "says": [["1", "r.solver[0]"], ["2", "r.solver[1]"]]}});
    let (verdicts, _, found) = check(&format!("It is 1 and 2.\n\n```lab simlab\n{lab}\n```\n"));
    assert_eq!(verdicts, ["computed", "computed"], "{found:#?}");
}
