//! All fixes of findings, applied to the bytes of the file: the JSON stays valid, the finding disappears,
//! and no new error appears.

// A test that cannot read its own inputs must fail.
#![allow(clippy::unwrap_used, clippy::panic)]

use crate::support::{check_text, workspace};
use labspec::bind::scene::Models;
use labspec::check::{self, CheckLevel};
use labspec::finding::{Applicability, Finding, Fix, Severity};
use labspec::lint::ModelFolder;
use labspec::lint::load_lesson;
use labspec::repair::{Traces, traces};
use labspec::rules;
use labspec::source::SourceFile;
use proptest::prelude::*;
use std::path::{Path, PathBuf};

/// A file, and the models that it may use.
struct Case {
    name: String,
    text: String,
    models: ModelFolder,
}

impl Case {
    fn new(name: &str, text: &str) -> Case {
        Case {
            name: name.into(),
            text: text.into(),
            models: ModelFolder::with_names(["ball", "incline", "pendulum"]),
        }
    }

    /// The displayed values of the labs.
    fn traces_of(&self, text: &str) -> Traces {
        let lesson = load_lesson(SourceFile::new(self.name.as_str(), text), &self.models);
        traces(&lesson, &Models::new(self.models.clone()))
    }

    /// All findings without runs, and the number of broken blocks.
    fn findings(&self, text: &str) -> (Vec<Finding>, usize) {
        let lesson = load_lesson(SourceFile::new(self.name.as_str(), text), &self.models);
        let broken = lesson.broken.len();
        let models = Models::new(self.models.clone());
        let checked =
            check::check_lesson(lesson, &models, CheckLevel { programs: true, ..CheckLevel::STATIC });
        (checked.findings, broken)
    }
}

/// Fixes that make a second error in the same text visible: the fixed code, and the code of the second error.
const REVEALED: [(&str, &str); 8] = [
    // 2x becomes 2 * x, and x is unknown as well.
    ("bad-number", "unknown-name"),
    // [1, 2 is closed, and becomes a list.
    ("unclosed", "whole-array"),
    // The name is corrected, but its use is also wrong.
    ("unknown-object", "assign-array"),
    ("unknown-field", "whole-array"),
    ("unknown-function", "unknown-object"),
    // The value becomes a number that does not fit the tolerance.
    ("wrong-type", "impossible-tolerance"),
    // `energy()` becomes `sim.energy()`, which is a record with members.
    ("unknown-function", "not-a-value"),
    ("unknown-function", "unknown-field"),
];

fn apply(text: &str, fix: &Fix) -> String {
    let mut text = text.to_string();
    text.replace_range(fix.span.clone(), &fix.text);
    text
}

/// What is wrong with a fix, or `None` if it works as intended.
fn fault(case: &Case, finding: &Finding, before: &(Vec<Finding>, usize)) -> Option<String> {
    let fix = finding.fix.as_ref()?;
    let repaired = apply(&case.text, fix);
    let (after, broken) = case.findings(&repaired);
    let describe_finding = |f: &Finding| format!("{} {}", f.code, f.message);
    let describe = || {
        let list: Vec<String> = after.iter().map(describe_finding).collect();
        format!(
            "{}: {}\nfix {:?} -> {:?}\nbefore:\n{}\nafter:\n{repaired}\nleft: {list:#?}",
            case.name,
            describe_finding(finding),
            case.text.get(fix.span.clone()),
            fix.text,
            case.text
        )
    };
    if broken > before.1 {
        return Some(format!("breaks the JSON\n{}", describe()));
    }
    if repaired == case.text {
        return Some(format!("changes nothing\n{}", describe()));
    }
    // Maps a position of the old text to the new one.
    let shift = |at: usize| {
        if at >= fix.span.end { at - fix.span.len() + fix.text.len() } else { at }
    };
    let gone = !after.iter().any(|f| {
        f.code == finding.code
            && f.message == finding.message
            && (f.span.start == shift(finding.span.start) || f.span.start == finding.span.start)
    });
    // The same finding may remain legitimately: after deleting one of two equal commas, the other one is at its position.
    let is_syntax = |f: &&Finding| matches!(f.code, "json-syntax" | "typographic-quote");
    let syntax = |list: &[Finding]| list.iter().filter(is_syntax).count();
    let of_syntax = is_syntax(&finding);
    let fewer = if of_syntax { syntax(&after) < syntax(&before.0) } else { after.len() < before.0.len() };
    if !gone && !fewer {
        return Some(format!("does not go away\n{}", describe()));
    }
    let errors = |list: &[Finding]| list.iter().filter(|f| f.severity == Severity::Error).count();
    // Errors that were hidden before may appear: after broken JSON, any error; otherwise those in the list.
    let new = after.iter().find(|f| {
        f.severity == Severity::Error
            && (!of_syntax || is_syntax(f))
            && !REVEALED.contains(&(finding.code, f.code))
            && !before.0.iter().any(|b| b.code == f.code && b.message == f.message)
    });
    if let Some(new) = new
        && (of_syntax || errors(&after) >= errors(&before.0))
    {
        return Some(format!("a new error: {}\n{}", describe_finding(new), describe()));
    }
    None
}

/// What a safe fix changes in the displayed values of the labs, or `None` if it changes nothing.
fn unproven(case: &Case, finding: &Finding, before: &Traces) -> Option<String> {
    let fix = finding.fix.as_ref().filter(|fix| fix.applicability == Applicability::Safe)?;
    // The finding includes a run that shows the effect of the fix.
    if finding.code == "missing-setconst" {
        return None;
    }
    let repaired = apply(&case.text, fix);
    let same = before.is_subset(&case.traces_of(&repaired));
    (!same).then(|| format!("{} is called safe and changes a trace\n{}\n{repaired}", finding.code, case.text))
}

/// Tries all fixes of a file; returns their number, and what is wrong with them.
fn try_all(case: &Case) -> (usize, Vec<String>) {
    let before = case.findings(&case.text);
    let with_fix: Vec<&Finding> = before.0.iter().filter(|f| f.fix.is_some()).collect();
    let before_fix = if with_fix.is_empty() { Traces::new() } else { case.traces_of(&case.text) };
    let faults =
        with_fix.iter().filter_map(|f| fault(case, f, &before).or_else(|| unproven(case, f, &before_fix)));
    (with_fix.len(), faults.collect())
}

fn check_fixes(cases: impl IntoIterator<Item = Case>, at_least: usize) {
    let (mut tried, mut wrong) = (0, Vec::new());
    for case in cases {
        let (n, faults) = try_all(&case);
        tried += n;
        wrong.extend(faults);
    }
    assert!(wrong.is_empty(), "{} of {tried} fixes:\n\n{}", wrong.len(), wrong.join("\n\n----\n\n"));
    assert!(tried >= at_least, "only {tried} fixes were tried");
}

fn files(folder: &Path) -> Vec<PathBuf> {
    let mut all: Vec<PathBuf> =
        std::fs::read_dir(folder).into_iter().flatten().flatten().map(|e| e.path()).collect();
    all.sort();
    all.retain(|p| p.extension().is_some_and(|e| e == "md" || e == "json"));
    all
}

#[test]
fn fixes_of_the_wrong_lessons_hold() {
    let lessons = files(&workspace().join("tests/lessons"));
    let case = |p: PathBuf| {
        Case::new(p.file_name().unwrap().to_str().unwrap(), &std::fs::read_to_string(&p).unwrap())
    };
    check_fixes(lessons.into_iter().map(case), 30);
}

#[test]
fn fixes_of_the_bad_examples_of_rules_hold() {
    let examples = rules::LESSONS.iter().map(|rule| Case::new(rule.bad.name(), &rule.bad.text()));
    check_fixes(examples, 10);
}

#[test]
fn fixes_of_real_lessons_hold() {
    let shared = workspace().join("../shared");
    if !shared.join("corpus/models").exists() {
        println!("skipped: {} is not there", shared.display());
        return;
    }
    let mut cases = Vec::new();
    let corpus = ModelFolder::open(&shared.join("corpus/models")).unwrap();
    let specs = ModelFolder::open(&workspace().join("specs/models")).unwrap();
    for (folder, models) in [
        (shared.join("lesson-0.1"), &corpus),
        (shared.join("corpus/labs"), &corpus),
        (shared.join("corpus/quizzes"), &corpus),
        (workspace().join("specs/lessons"), &specs),
    ] {
        for path in files(&folder) {
            let name = path.file_name().unwrap().to_str().unwrap().to_string();
            cases.push(Case { name, text: std::fs::read_to_string(&path).unwrap(), models: models.clone() });
        }
    }
    check_fixes(cases, 10);
}

/// Two balls and an arm, with names of every kind.
const MODEL: &str = "<mujoco><worldbody><geom name='floor' type='plane' size='1 1 .1'/>\
<body name='heavy' pos='0 0 1'><freejoint name='heavy_free'/><geom name='heavy_geom' size='.1'/><site name='top'/></body>\
<body name='arm' pos='1 0 1'><joint name='hinge' axis='0 1 0'/><geom name='arm_geom' size='.05' pos='.2 0 0'/></body>\
</worldbody><actuator><motor name='push' joint='hinge'/></actuator></mujoco>";

/// A lab with one expression and one statement.
fn lab(expr: &str, run: &str) -> Case {
    let value = serde_json::json!({
        "xml": MODEL,
        "controls": [{"type": "button", "label": "go", "run": run}],
        "readouts": [{"label": "x", "expr": expr}],
    });
    Case::new("lab.json", &serde_json::to_string_pretty(&value).unwrap())
}

/// Correct expressions of authors, and similar wrong ones.
const EXPRESSIONS: [&str; 60] = [
    "data.body('hevy').xpos[2]",
    "data.body(\"hevy\").xpos[2]",
    "data.body(heavy).xpos[2]",
    "data.bdy('heavy').xpos[2]",
    "data.body('heavy').xpso[2]",
    "data.body('heavy').xpos[3]",
    "data.body('heavy').xpos",
    "data.body('heavy').xpos.z",
    "data.body(‘heavy’).xpos[2]",
    "data.body(“heavy”).xpos[2]",
    "‘a’ + “b”",
    "data.joint('hinge').qpos",
    "data.joint('higne').qpos[0]",
    "data.joint('hinge').qpos[1]",
    "data.qpso[0]",
    "data.qpos[99]",
    "data.qpos",
    "qpos[0]",
    "model.gravity[2]",
    "model.opt.gravty[2]",
    "model.opt.timestpe",
    "model.mass[1]",
    "mat.sin(1)",
    "math.sin(1)",
    "Math.sine(1)",
    "Math.Sin(1)",
    "sin(1)",
    "Math.max([1, 2])",
    "Math.max(data.qpos)",
    "1,5",
    "01",
    "1_000 + 0x1g",
    "2x",
    "2 data.time",
    "x²",
    "data.time²",
    "√data.time",
    "data.time ≥ 1",
    "1 × 2",
    "1 − 2",
    "1 ÷ 2",
    "data.time = 1",
    "data.time == 1 and 2",
    "not data.time",
    "if data.time then 1",
    "data.time;",
    "(data.time",
    "data.time)",
    "[1, 2",
    "lib.sitepos('top')[0]",
    "lib.sitePos('tpo')[0]",
    "lib.norm(1, 2)",
    "lib.energy.total",
    "lib.energy().totl",
    "ctx.peek",
    "sim.tim",
    "const a = 1; a",
    "data.time.toFixed(2).lenght",
    "data.sensor('x').data",
    "data.body['heavy'].xpos[0]",
];

const STATEMENTS: [&str; 36] = [
    "data.qvel[0] = 1",
    "data.qvel[0] == 1",
    "data.qvel = 1",
    "data.qvel = [1, 2]",
    "data.qvell[0] = 1",
    "data.qvel[0] =+ 1",
    "data.qvel[0] := 1",
    "var a = 1; ctx.b = a",
    "a = 1; ctx.b = a",
    "for (i = 0; i < 3; i++) { data.qvel[i] = 0 }",
    "for (let i = 0, i < 3, i++) { data.qvel[i] = 0 }",
    "mj_forward(model, data)",
    "mj.mj_foward(model, data)",
    "mj.mj_forward(data, model)",
    "mj.mj_forward()",
    "mj.mj_step",
    "mj.mj_resetDataKeyframe(model, data)",
    "data.ctrl[\"push\"] = 1",
    "data.actuator('psh').ctrl[0] = 1",
    "data.actuator(\"psh\").ctrl = 1",
    "model.opt.gravity = -9.81",
    "model.opt.timestep = '0.01'",
    "model.nq = 3",
    "model.opt.disableflags |= 1",
    "if (data.time > 1) { data.time = 0 } }",
    "if data.time > 1 { data.time = 0 }",
    "const f = (a) => { const b = 2; return a * c }; ctx.a = f(1)",
    "const f = function (x) { return x }; ctx.a = f(1)",
    "ctx.q = data.qpos",
    "ctx.q = data.qpos; ctx.q[0] = 1",
    "console.log(1)",
    "let a = 1; let a = 2; ctx.b = a",
    "data.xpos[0] = 1",
    "ctx.a = \"x\" ctx.b = 2",
    "ctx.a = data.body(‘heavy’).xpos[0]",
    "return 1",
];

#[test]
fn fixes_of_the_language_hold_inside_of_json() {
    let expressions = EXPRESSIONS.iter().map(|e| lab(e, "data.qvel[0] = 1"));
    let statements = STATEMENTS.iter().map(|s| lab("data.time", s));
    check_fixes(expressions.chain(statements), 35);
}

/// The source texts in the tests of the language's errors, as far as they can be extracted.
#[test]
fn fixes_of_the_mistakes_of_the_language_hold() {
    let source = std::fs::read_to_string(workspace().join("crates/expr/src/tests/mistakes.rs")).unwrap();
    let mut cases = Vec::new();
    for line in source.lines() {
        let Some((kind, rest)) = line.split_once(": ").and_then(|(_, call)| call.split_once("(\"")) else {
            continue;
        };
        let Some((literal, _)) = rest.rsplit_once("\")") else { continue };
        let Ok(text) = serde_json::from_str::<String>(&format!("\"{literal}\"")) else { continue };
        match kind {
            "expression" => cases.push(lab(&text, "data.qvel[0] = 1")),
            "statements" => cases.push(lab("data.time", &text)),
            _ => {}
        }
    }
    assert!(cases.len() > 100, "{}", cases.len());
    check_fixes(cases, 40);
}

/// A correct lab and a correct quiz, in every layout in which JSON can be written.
fn right(layout: usize) -> (String, String) {
    let json = r#"{
  "model": "ball",
  "title": "Falling, \"slowly\"",
  "stopAt": 2.5,
  "dock": true,
  "note": "the time constant $\\tau$ of [a] {b}: 1, 2",
  "camera": {"azimuth": 90, "target": [0, 0, 0.5]},
  "controls": [{"label": "mass", "min": 1, "max": 5, "value": 2, "set": "model.body_mass[1]"},
    {"type": "select", "label": "which", "options": [["a", 1], ["b", 2]], "value": 1, "param": "w"}],
  "plots": [{"ylabel": "z", "traces": [{"label": "z", "expr": "data.body('ball').xpos[2]"}]}],
  "readouts": [{"label": "t", "expr": "data.time", "digits": 2}]
}"#;
    let prefixed =
        |prefix: &str, lines: &str| lines.lines().map(|l| format!("{prefix}{l}\n")).collect::<String>();
    let fence = format!("```lab simlab\n{json}\n```\n");
    match layout {
        0 => ("lab.json".into(), json.into()),
        1 => ("lab.md".into(), format!("# A\n\n{fence}\nText.\n")),
        2 => ("lab.md".into(), format!("# A\n\n{}\nText.\n", prefixed("> ", &fence))),
        3 => ("lab.md".into(), format!("1. A\n\n{}\nText.\n", prefixed("   ", &fence))),
        _ => ("lab.md".into(), format!("# A\n\n{fence}\nText.\n").replace('\n', "\r\n")),
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(600))]
    /// One character deleted, doubled, replaced or inserted: every offered fix works.
    #[test]
    fn fixes_of_random_damage_hold(
        layout in 0usize..5,
        at in any::<prop::sample::Index>(),
        what in prop::sample::select(vec!["", "\"", "'", ",", ":", "{", "}", "[", "]", "\\", "\n", " ", "x", "5", ".", "“", "’", "=", ";", "//", "\u{a0}", "-", "True"]),
        replace in any::<bool>(),
    ) {
        let (name, mut text) = right(layout);
        let inside = text.find('{').unwrap()..text.rfind('}').unwrap() + 1;
        let places: Vec<usize> = inside.filter(|i| text.is_char_boundary(*i)).collect();
        let at = places[at.index(places.len())];
        let length = text[at..].chars().next().map_or(0, char::len_utf8);
        text.replace_range(at..if replace || what.is_empty() { at + length } else { at }, what);
        let case = Case::new(&name, &text);
        let (_, faults) = try_all(&case);
        prop_assert!(faults.is_empty(), "{}", faults.join("\n\n"));
    }
}

/// Broken JSON is always an error, and the readable part is still checked.
#[test]
fn a_broken_block_is_still_checked() {
    let text = "```lab simlab\n{\"xml\": \"<mujoco/>\", \"dock\": True,\n \"readouts\": [{\"label\": \"t\", \"expr\": \"data.tiem\"},]}\n```\n";
    let checked = check_text("a.md", text);
    let found: Vec<&str> = checked.findings.iter().map(|f| f.code).collect();
    assert_eq!(found, ["json-syntax", "unknown-field", "json-syntax"]);
    assert!(checked.lesson.labs[0].broken && checked.lesson.labs[0].lab.is_some());
}

/// Errors in labs that run, whose fixes change the displayed values: none of these fixes is applied without a request.
#[test]
fn repairs_that_change_displays_are_guesses() {
    let statements = [
        "data.qvel[6] == 2",
        "data.qvel[6] === 2",
        "let i = 0; while (i > 5); data.qvel[6] = 2",
        "for (let i = 0; i < 3; i++); data.qvel[6] = 2",
        "if (data.time < 0); data.qvel[6] = 2",
        "data.qvel[6] = Math.sin(90)",
        "data.qvel[6] = 2 ^ 2 * data.time + 1",
        "data.qvel[6] = 0 < data.time < 1 ? 2 : 3",
        "data.qvel[6] = data.time == NaN ? 2 : 3",
        "data.qpos[7] = 90",
    ];
    let expressions =
        ["Math.sin(90)", "2 ^ 2 * data.time", "0 < data.time < 5", "data.time == NaN", "data.time * 3 ^ 2"];
    let cases = expressions.iter().map(|e| (*e, lab(e, "data.qvel[0] = 1")));
    let cases = cases.chain(statements.iter().map(|s| (*s, lab("data.qvel[6]", s))));
    let mut changed = 0;
    for (mistake, case) in cases {
        let traces = case.traces_of(&case.text);
        assert!(!traces.is_empty(), "{mistake} does not run");
        let found = case.findings(&case.text).0;
        for (finding, fix) in found.iter().filter_map(|f| Some((f, f.fix.as_ref()?))) {
            let same = traces.is_subset(&case.traces_of(&apply(&case.text, fix)));
            changed += usize::from(!same);
            let guess = fix.applicability != Applicability::Safe;
            assert!(same || guess, "{mistake}: {} changes what is shown, unasked", finding.code);
        }
        // Fixes that are applied without a request do not change the displayed values.
        let look = |text: &str| {
            let (findings, broken) = case.findings(text);
            labspec::repair::CheckedText::new(text.to_string(), findings, broken)
        };
        let (safe, _) = labspec::repair::repair(look(&case.text), false, &look, &|text| case.traces_of(text));
        assert!(traces.is_subset(&case.traces_of(&safe)), "{mistake}");
    }
    assert!(changed >= 8, "only {changed} repairs change anything: nothing is tried here");
}
