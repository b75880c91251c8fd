//! What an author meets: the first commands, an old course with a baseline and routes, numbers in explanations, shared runs, and
//! advice that ends in a working lesson.

#![allow(clippy::unwrap_used, clippy::panic)]

use crate::program::{folder, run_in};
use crate::support::{check_text, codes};
use labspec::finding::Finding;
use labspec::verify::Verdict;
use serde_json::{Value, json};
use std::path::Path;

pub(crate) const BALL: &str = "<mujoco><worldbody><geom name='floor' type='plane' size='9 9 1'/><body name='ball' pos='0 0 1'><freejoint name='ball'/><geom name='ball' size='0.05' mass='1'/></body></worldbody></mujoco>";

pub(crate) fn write(folder: &Path, name: &str, text: &str) {
    let path = folder.join(name);
    std::fs::create_dir_all(path.parent().unwrap()).unwrap();
    std::fs::write(path, text).unwrap();
}

/// A lesson with a lab that has a question with a verified answer.
fn lesson(id: &str) -> String {
    let lab =
        json!({"xml": BALL, "stopAt": 0.6, "readouts": [{"label": "height (m)", "expr": "data.qpos[2]"}]});
    let quiz = json!({"id": id, "questions": [{"q": "Where does it go?", "options": ["down", "up"], "answer": 0,
        "verify": {"lab": "#1", "measure": {"z": "final(data.qpos[2])"}, "options": ["z < 0.9", "z > 1.1"]}}]});
    format!("# A ball\n\n```lab simlab\n{lab}\n```\n\n```quiz\n{quiz}\n```\n")
}

#[test]
fn the_first_commands() {
    let folder = folder();
    write(folder.path(), "lessons/a.md", &lesson("a"));
    write(folder.path(), "lessons/b.md", &lesson("b"));
    let lessons = folder.path().join("lessons");
    // Without a path, the folder; each clean lesson has one line.
    let done = run_in(&lessons, &["check"]);
    assert_eq!(done.code, 0, "{} {}", done.stdout, done.stderr);
    let lines: Vec<&str> = done.stdout.lines().filter(|line| !line.is_empty()).collect();
    assert_eq!(lines.len(), 3, "{}", done.stdout);
    assert!(lines[0].contains("a.md") && lines[0].contains("1 answer verified"), "{}", lines[0]);
    assert!(
        lines[2].starts_with("2 files, 2 labs run, 2 answers verified: no problems found"),
        "{}",
        lines[2]
    );
    // One line, without the findings.
    write(folder.path(), "lessons/c.md", "# C\n\n[gone](nowhere.md)\n");
    let done = run_in(&lessons, &["check", "-q"]);
    assert_eq!((done.code, done.stdout.lines().count()), (1, 1), "{}", done.stdout);
    assert!(done.stdout.contains("1 warning"), "{}", done.stdout);
    // The workflow's log has the summary.
    let done = run_in(&lessons, &["check", "--format", "github"]);
    let last = done.stdout.lines().last().unwrap();
    assert!(done.stdout.starts_with("::warning") && last.starts_with("3 files, "), "{}", done.stdout);
    let done = run_in(&lessons, &["check", "a.md", "--format", "github"]);
    assert_eq!(done.stdout, "1 file, 1 lab run, 1 answer verified: no problems found\n");
}

#[test]
fn a_baseline_contains_the_findings_of_the_whole_course() {
    let folder = tempfile::tempdir().unwrap();
    write(folder.path(), "a.md", &lesson("same"));
    write(folder.path(), "b.md", &lesson("same"));
    let check =
        |more: &[&str]| run_in(folder.path(), &[&["check", ".", "--baseline", "known.json"], more].concat());
    let first = check(&["--update-baseline"]);
    assert!(first.stdout.contains("duplicate-id"), "{}", first.stdout);
    let again = check(&[]);
    assert_eq!(again.code, 0, "{}", again.stdout);
    assert!(!again.stdout.contains("duplicate-id"), "{}", again.stdout);
    // A new finding is reported.
    write(folder.path(), "c.md", &lesson("same"));
    let new = check(&[]);
    assert!(new.code == 1 && new.stdout.contains("c.md"), "{}", new.stdout);
}

/// A course with a lab that cannot run is adopted: its claims are in the baseline until they, or the reason, change.
#[test]
fn a_baseline_contains_the_claims_of_a_lab_that_cannot_run() {
    let folder = tempfile::tempdir().unwrap();
    let broken = |text: &str| text.replacen(&format!("\"xml\":{}", json!(BALL)), "\"model\":\"gone\"", 1);
    let text = lesson("a");
    assert_ne!(broken(&text), text);
    write(folder.path(), "a.md", &broken(&text));
    let check =
        |more: &[&str]| run_in(folder.path(), &[&["check", ".", "--baseline", "known.json"], more].concat());
    assert_eq!(check(&[]).code, 2, "there is no baseline yet");
    check(&["--update-baseline"]);
    let again = check(&[]);
    assert_eq!(again.code, 0, "{}", again.stdout);
    assert!(again.stdout.contains("no problems outside the baseline"), "{}", again.stdout);
    // A changed claim is new, and so is the claim of another question.
    let changed = broken(&text).replacen("\"answer\":0", "\"answer\":1", 1);
    assert_ne!(changed, broken(&text));
    write(folder.path(), "a.md", &changed);
    assert_eq!(check(&[]).code, 1);
    write(
        folder.path(),
        "a.md",
        &format!("{}\n{}", broken(&text), broken(&lesson("b")).replacen("# ", "## ", 1)),
    );
    assert_eq!(check(&[]).code, 1);
    // The lab runs again, and the claim is checked: true, and false.
    write(folder.path(), "a.md", &text);
    let right = check(&[]);
    assert!(right.code == 0 && right.stdout.contains("1 answer verified"), "{}", right.stdout);
    write(folder.path(), "a.md", &text.replacen("\"answer\":0", "\"answer\":1", 1));
    assert_eq!(check(&[]).code, 1);
}

#[test]
fn routes_of_a_site_are_checked() {
    let folder = folder();
    write(
        folder.path(),
        "lessons/0.1-falling.md",
        "# Falling\n\n[next](#/lesson/0.2) and [home](#/lesson/0.1?tab=1)\n",
    );
    let check = || run_in(folder.path(), &["check", "lessons"]);
    let done = check();
    assert!(done.stdout.contains("`routes` does not state its file"), "{}", done.stdout);
    write(folder.path(), "labspec.toml", "[routes]\n\"#/lesson/{}\" = \"lessons/{}-*.md\"\n");
    let done = check();
    assert_eq!(done.stdout.matches("dead-link").count(), 1, "{}", done.stdout);
    assert!(done.stdout.contains("there is no file `lessons/0.2-*.md`"), "{}", done.stdout);
    write(folder.path(), "lessons/0.2-rolling.md", "# Rolling\n");
    assert!(!check().stdout.contains("dead-link"));
    write(folder.path(), "labspec.toml", "[routes]\n\"/lesson/{}\" = \"lessons/{}.md\"\n");
    assert_eq!(check().code, 2);
}

#[test]
fn the_settings_of_a_lesson_are_shown_with_their_origin() {
    let folder = folder();
    write(folder.path(), "models/ball.xml", BALL);
    write(folder.path(), "drafts/a.md", "# A\n");
    write(
        folder.path(),
        "labspec.toml",
        "ignore = [\"duplicate-readout\"]\nwidgets = [\"playground\"]\n[routes]\n\"#/l/{}\" = \"{}.md\"\n[[paths]]\nmatch = [\"drafts/**\"]\ndeny = [\"warnings\"]\n",
    );
    let done = run_in(folder.path(), &["config", "drafts/a.md", "--ignore", "idle-control"]);
    assert_eq!(done.code, 0, "{}", done.stderr);
    for part in [
        "duplicate-readout  (labspec.toml)",
        "idle-control       (command line)",
        "(labspec.toml, [[paths]] drafts/**)",
        "#/l/{} = {}.md",
        "playground",
        "select   all",
        "models   ",
    ] {
        assert!(done.stdout.contains(part), "{part}: {}", done.stdout);
    }
    assert_eq!(run_in(folder.path(), &["config", "gone.md"]).code, 2);
}

/// How texts are read: the words and the comma of a language, macros, and keys of the front matter.
#[test]
fn settings_state_how_texts_are_read() {
    let folder = folder();
    let check = |settings: &str, text: &str, says: &Value| {
        write(folder.path(), "labspec.toml", settings);
        let verify = json!({"runs": {"run": {"until": 1}}, "measure": {"t": "first(contact('ball', 'floor'))", "z": "initial(data.qpos[2])"}, "says": [says]});
        let lab = json!({"xml": BALL, "stopAt": 1, "readouts": [{"label": "z (m)", "expr": "data.qpos[2]"}], "verify": verify});
        write(
            folder.path(),
            "a.md",
            &format!("---\ntitle: {text}\n---\n\n# A fall\n\n{text}\n\n```lab simlab\n{lab}\n```\n"),
        );
        let done = run_in(folder.path(), &["check", "a.md", "--format", "json"]);
        assert!(done.code < 2, "{}", done.stderr);
        let report: Value = serde_json::from_str(&done.stdout).unwrap();
        let findings = report["findings"].as_array().unwrap().clone();
        findings.iter().map(|f| f["code"].as_str().unwrap().to_string()).collect::<Vec<_>>()
    };
    // The ball lands after 0.44 s.
    let german = "languages = [\"de\"]\n";
    let english = "languages = [\"en\"]\n";
    let about = json!(["etwa 400 ms", "900 * t"]);
    assert_eq!(check(german, "Sie fällt etwa 400 ms.", &about), [""; 0]);
    assert_eq!(check("", "Sie fällt etwa 400 ms.", &about), [""; 0]);
    assert_eq!(check(english, "Sie fällt etwa 400 ms.", &about), ["quote-wrong"]);
    // 1,500 in German is 1.5.
    let comma = |factor: &str| json!(["1,500 m", factor]);
    for (settings, expr, is_right) in [
        (german, "1.5 * z", true),
        (german, "1500 * z", false),
        (english, "1500 * z", true),
        (english, "1.5 * z", false),
    ] {
        let found = check(settings, "Sie fällt 1,500 m.", &comma(expr));
        assert_eq!(
            found.iter().all(|code| !code.starts_with("quote-")),
            is_right,
            "{settings} {expr}: {found:?}"
        );
    }
    // The number is only in a macro, and only in the front matter.
    let quote = json!(["0.44 s", "t"]);
    let in_macro = "{% fall 0.44 s; b %}";
    assert_eq!(check("", in_macro, &quote), [""; 0], "without the setting, it is text");
    assert_eq!(check("macros = [\"{% %}\"]\n", in_macro, &quote), ["quote-not-found"]);
    let head = |settings: &str| {
        write(folder.path(), "labspec.toml", settings);
        let text = std::fs::read_to_string(folder.path().join("a.md")).unwrap();
        write(
            folder.path(),
            "a.md",
            &text
                .replacen("title: {% fall 0.44 s; b %}", "title: \"0.44 s\"", 1)
                .replace("{% fall 0.44 s; b %}", "It falls."),
        );
        run_in(folder.path(), &["check", "a.md", "--format", "concise"])
    };
    assert!(head("").stdout.contains("quote-not-found"));
    let displayed = head("front-matter = [\"title\"]\n");
    assert_eq!(displayed.code, 0, "{}", displayed.stdout);
    let config = run_in(folder.path(), &["config", "a.md"]).stdout;
    assert!(config.contains("front-matter title"), "{config}");
}

/// A question about a fall whose explanation states numbers.
fn explained(explain: &str, says: &Value) -> Vec<Finding> {
    let lab = json!({"xml": BALL, "stopAt": 0.6,
        "controls": [{"label": "height", "unit": "m", "apply": "data.qpos[2] = value", "min": 0.5, "max": 2, "step": 0.1, "value": 1, "init": true}],
        "readouts": [{"label": "z (m)", "expr": "data.qpos[2]"}]});
    let verify = json!({"lab": "#1", "runs": {"run": {"set": {"height": 1.5}}}, "measure": {"t": "first(contact('ball', 'floor'))"},
        "options": ["run.t > 0.5", "run.t < 0.3"], "says": says});
    let quiz = json!({"id": "q", "questions": [{"q": "It falls by 1.45 m. When does it land?", "options": ["late", "early"], "answer": 0,
        "explain": explain, "verify": verify}]});
    let text = format!("```lab simlab\n{lab}\n```\n\n```quiz\n{quiz}\n```\n");
    check_text("a.md", &text).findings
}

#[test]
fn numbers_in_the_explanation_of_a_verified_question_are_checked() {
    let found = explained("It lands after 0.546 s, or after 0.480 s.", &json!([["0.546 s", "run.t"]]));
    let of_rule: Vec<&Finding> = found.iter().filter(|f| f.code == "explanation-unclaimed").collect();
    let [f] = of_rule.as_slice() else { panic!("{found:#?}") };
    assert!(f.message.contains("0.480 s"), "{f:#?}");
    // What the question or a setting gives is no result.
    let found =
        explained("From 1.5 m it falls by 1.45 m and lands after 0.546 s.", &json!([["0.546 s", "run.t"]]));
    assert!(!found.iter().any(|f| f.code == "explanation-unclaimed"), "{found:#?}");
}

#[test]
fn an_inline_lab_is_shared() {
    let quiz = json!({"id": "u", "questions": [
        {"q": "How does it move?", "options": ["down", "up"], "answer": 0, "verify": {"lab": {"xml": BALL, "stopAt": 0.6, "readouts": []},
            "runs": {"fall": {}}, "measure": {"z": "final(data.qpos[2])", "t": "first(contact('ball', 'floor'))"}, "options": ["fall.z < 1", "fall.z > 1"]}},
        {"kind": "numeric", "q": "When does it land?", "answer": 0.44, "tol": 0.01, "unit": "s", "verify": {"use": "#u.1", "value": "fall.t"}}]});
    let checked = check_text("a.md", &format!("```quiz\n{quiz}\n```\n"));
    let verdicts: Vec<Verdict> =
        checked.claims.iter().filter_map(|c| c.judgement.answer.as_ref()).map(|a| a.verdict).collect();
    assert_eq!(verdicts, [Verdict::Verified; 2], "{:#?}", checked.findings);
}

#[test]
fn runs_and_measures_are_defined_once() {
    let lab = json!({"xml": BALL, "stopAt": 0.6, "readouts": []});
    let definition = json!({"lab": "#1", "runs": {"fall": {}}, "measure": {"t": "first(contact('ball', 'floor'))", "z": "final(data.qpos[2])"}});
    let quiz = json!({"id": "q", "questions": [{"kind": "numeric", "q": "When does it land?", "answer": 0.44, "tol": 0.01, "unit": "s", "verify": {"use": "falls", "value": "fall.t"}}]});
    let text = |name: &str, used: &str| {
        let quiz = quiz.to_string().replace("\"falls\"", &format!("\"{used}\""));
        format!(
            "```lab simlab\n{lab}\n```\n\n<!-- labspec define {name} {definition} -->\n\n<!-- labspec verify {{\"use\": \"{used}\", \"says\": [[\"0.442 s\", \"fall.t\"]]}} -->\nIt lands after 0.442 s.\n\n```quiz\n{quiz}\n```\n"
        )
    };
    let checked = check_text("a.md", &text("falls", "falls"));
    let quotes: Vec<&str> =
        checked.claims.iter().flat_map(|c| &c.judgement.quotes).map(|q| q.verdict()).collect();
    assert_eq!(quotes, ["verified"], "{:#?}", checked.findings);
    let answer = checked.claims.iter().find_map(|c| c.judgement.answer.as_ref()).unwrap();
    assert_eq!(answer.verdict, Verdict::Verified);
    // A name that nothing defines is one finding for each object.
    let checked = check_text("a.md", &text("falls", "fals"));
    assert!(codes(&checked).iter().filter(|c| **c == "unknown-lab").count() == 2, "{:#?}", checked.findings);
    // A definition needs a name.
    assert!(codes(&check_text("a.md", &text("", "falls"))).contains(&"wrong-type"));
}

#[test]
fn an_object_with_errors_accuses_nobody() {
    for runs in
        [json!([{"until": 1}]), json!({"run": {"untill": 1}}), json!({"run": {"set": {"nothing": 1}}})]
    {
        let lab = json!({"xml": BALL, "stopAt": 0.6, "note": "It lands after 9 s.", "readouts": [],
            "verify": {"runs": runs, "measure": {"t": "first(contact('ball', 'floor'))"}, "says": [["9 s", "t"]]}});
        let checked = check_text("a.md", &format!("```lab simlab\n{lab}\n```\n"));
        let found = codes(&checked);
        assert!(!found.contains(&"quote-wrong") && found.len() == 1, "{runs}: {:#?}", checked.findings);
    }
}

/// The help of each mistake leads to a lesson without it.
#[test]
fn advice_does_not_lead_in_a_circle() {
    let lab = |control: &str, readout: &str| {
        let lab = json!({"xml": BALL, "stopAt": 0.1, "controls": [{"label": "mass", "unit": "kg", "set": control, "min": 1, "max": 2, "step": 0.5, "value": 1, "reset": true}],
            "readouts": [{"label": "z", "expr": readout}]});
        check_text("a.md", &format!("```lab simlab\n{lab}\n```\n")).findings
    };
    let help = |findings: &[Finding], code: &str| {
        let f = findings.iter().find(|f| f.code == code).unwrap_or_else(|| panic!("{code}: {findings:#?}"));
        format!("{} {} {}", f.message, f.why.clone().unwrap_or_default(), f.help.clone().unwrap_or_default())
    };
    let mass = "model.body('ball').mass";
    assert!(help(&lab(mass, "data.time"), "assign-array").contains("`model.body('ball').mass[0]`"));
    assert!(!lab(&format!("{mass}[0]"), "data.time").iter().any(Finding::is_error));
    let body = help(&lab(&format!("{mass}[0]"), "data.body('ball').qpos[2]"), "unknown-field");
    assert!(body.contains("data.joint('ball').qpos[2]"), "{body}");
    assert!(help(&lab(&format!("{mass}[0]"), "np.sqrt(2)"), "not-in-language").contains("Math.sqrt"));
    let unknown = help(&lab(&format!("{mass}[0]"), "T + 1"), "unknown-name");
    assert!(unknown.contains("`ctx.T = …` in `setup`") && !unknown.contains("const"), "{unknown}");
}

/// A damaged fence explains a missing lab, unless the number is beyond all labs.
#[test]
fn a_damaged_fence_explains_only_its_own_lab() {
    let lesson = |address: &str| {
        let quiz = json!({"id": "q", "questions": [{"kind": "numeric", "q": "How long?", "answer": 1, "verify": {"lab": address, "value": "final(data.time)"}}]});
        format!("```lab simlabb\n{{\"xml\": \"<mujoco/>\"}}\n```\n\n```quiz\n{quiz}\n```\n")
    };
    let codes = |address: &str| -> Vec<&str> {
        check_text("fence.md", &lesson(address)).findings.iter().map(|f| f.code).collect()
    };
    assert!(!codes("#1").contains(&"unknown-lab"), "{:?}", codes("#1"));
    assert!(codes("#7").contains(&"unknown-lab"), "{:?}", codes("#7"));
}

/// The blocks of a widget that the settings declare are checked with its schema, at the place of each mistake.
#[test]
fn blocks_of_widgets_fit_their_schemas() {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, text: &str| std::fs::write(folder.path().join(name), text).unwrap();
    write(
        "map.json",
        r#"{"type": "object", "required": ["place"], "properties": {"place": {"type": "string"}, "zoom": {"type": "number", "minimum": 1}}, "additionalProperties": false}"#,
    );
    write("labspec.toml", "[widgets]\nmap = \"map.json\"\ngallery = true\n");
    let check = |block: &str| {
        write(
            "a.md",
            &format!(
                "# A map\n\n```lab map\n{block}\n```\n\n```lab gallery\n{{\"any\": 1}}\n```\n\n```lab simlab\n{{\"xml\": \"{BALL}\"}}\n```\n"
            ),
        );
        run_in(folder.path(), &["check", "a.md", "--format", "concise"])
    };
    let clean = check(r#"{"place": "Rome", "zoom": 3}"#);
    assert_eq!(clean.code, 0, "{}", clean.stdout);
    let wrong = check("{\"zoom\": 0,\n \"plase\": \"Rome\"}");
    assert_eq!(wrong.code, 1);
    for line in [
        "a.md:4:1: error[widget-schema]: this does not fit the schema of `map`: `place` is missing",
        "a.md:4:10: error[widget-schema]: this does not fit the schema of `map`: 0 is below 1",
        "a.md:5:3: error[widget-schema]: this does not fit the schema of `map`: `plase` is not one of its keys",
    ] {
        assert!(wrong.stdout.contains(line), "{line}: {}", wrong.stdout);
    }
    // A lesson with nothing but such a widget is checked, and so is it where its JSON is damaged or has another schema's keys.
    let alone = |block: &str| {
        write("alone.md", &format!("# A map\n\n```lab map\n{block}\n```\n"));
        let done = run_in(folder.path(), &["check", "alone.md"]);
        (done.code, done.stdout.lines().last().unwrap_or_default().to_string())
    };
    assert_eq!(alone(r#"{"place": "Rome"}"#), (0, "1 file, 1 other widget valid: no problems found".into()));
    for (block, errors) in [("{}", "1 error"), ("{\"place\": ", "")] {
        let (code, last) = alone(block);
        assert!(code == 1 && last.contains("1 other widget invalid") && last.contains(errors), "{last}");
    }
    // A schema that cannot be used is an error of the settings: nothing is checked.
    for (schema, words) in [("{\"pattern\": \"a\"}", "`pattern` is not supported"), ("{", "invalid JSON")] {
        write("map.json", schema);
        let done = check("{}");
        assert!(done.code == 2 && done.stderr.contains(words), "{}", done.stderr);
    }
    std::fs::remove_file(folder.path().join("map.json")).unwrap();
    assert_eq!(check("{}").code, 2);
}

/// A slider for a parameter of one geom: every component is observed, and so is a contact that comes late.
#[test]
fn mixed_parameters_of_contacts_are_observed() {
    let lab = |height: f64, slider: &str| {
        let xml = format!(
            "<mujoco><worldbody><geom name='floor' type='plane' size='9 9 1' solref='0.02 1'/><body pos='0 0 {height}'><freejoint/><geom name='ball' size='0.1' condim='6'/></body></worldbody></mujoco>"
        );
        let lab = json!({"xml": xml, "stopAt": 3, "controls": [slider_of(slider)], "readouts": [{"label": "height (m)", "expr": "data.qpos[2]"}]});
        check_text("a.md", &format!("```lab simlab\n{lab}\n```\n")).findings
    };
    let mixed =
        |findings: &[Finding]| findings.iter().find(|f| f.code == "mixed-away").and_then(|f| f.help.clone());
    // The contact comes after 1.3 s, 650 steps.
    for height in [0.1, 8.5] {
        let help = mixed(&lab(height, "model.geom_solref[3]")).unwrap_or_default();
        assert!(help.contains("model.geom('floor').solref[1] = value"), "{height}: {help}");
        let help = mixed(&lab(height, "model.geom_friction[4]")).unwrap_or_default();
        assert!(help.contains("model.geom('floor').friction[1] = value"), "{height}: {help}");
        let help = mixed(&lab(height, "model.geom_solimp[6]")).unwrap_or_default();
        assert!(help.contains("model.geom('floor').solimp[1] = value"), "{height}: {help}");
    }
}

fn slider_of(target: &str) -> Value {
    // The other geom has 1, 0.005 and 0.95.
    let (min, max, value) = match target.split('[').next().unwrap_or("") {
        "model.geom_solref" => (0.1, 1.0, 0.5),
        "model.geom_friction" => (0.001, 0.004, 0.002),
        _ => (0.91, 0.99, 0.92),
    };
    json!({"label": "parameter", "set": target, "min": min, "max": max, "step": (max - min) / 3.0, "value": value, "init": true})
}

/// A misspelt name in the condition of a search is reported before anything is run.
#[test]
fn conditions_of_searches_are_checked_without_runs() {
    let folder = folder();
    let check = |holds: &str, runs: &Value| {
        let find = json!({"limit": {"largest": "timestep", "from": 0.001, "to": 0.01, "tol": 1e-4, "run": "long", "while": holds}});
        let verify = json!({"runs": runs, "measure": {"low": "min(data.qpos[2])"}, "find": find, "says": [["0.002 s", "limit"]]});
        let lab = json!({"xml": BALL, "stopAt": 0.6, "readouts": [{"label": "z (m)", "expr": "data.qpos[2]"}], "verify": verify});
        write(folder.path(), "a.md", &format!("# A ball\n\nAt 0.002 s.\n\n```lab simlab\n{lab}\n```\n"));
        run_in(folder.path(), &["check", "a.md", "--no-run", "--format", "concise"]).stdout
    };
    let one = json!({"long": {"until": 0.5}});
    let two = json!({"short": {"until": 0.1}, "long": {"until": 0.5}});
    for runs in [one, two] {
        let wrong = check("lwo > 0", &runs);
        assert!(wrong.contains("unknown name `lwo`"), "{wrong}");
        assert_eq!(check("low > 0", &runs), "");
    }
}
