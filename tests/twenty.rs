//! Labs of twenty kinds (`twenty/labs.md`) with random settings, each also run in MuJoCo 3.14.0 (`golden/twenty.py`): runs that
//! fail there are reported, others are not, and `run`, `check` and `stability` report the same.

#![allow(clippy::unwrap_used, clippy::panic)]

use crate::needs::needs;
use crate::population::{minimum, sample};
use crate::program::run_in;
use crate::support::{compile, for_each, read_json, workspace};
use labspec::bind::Programs;
use labspec::lint::{ModelFolder, load_lesson};
use labspec::run::RunOptions;
use labspec::source::SourceFile;
use labspec::spec::Lab;
use labspec::stress;
use labspec_core::Model;
use labspec_expr::Value;
use serde_json::Value as Json;
use std::collections::BTreeSet;
use std::path::Path;

/// The minimum share of reported faults, and the maximum share of false alarms.
const REPORTED: f64 = 0.99;
const MAX_FALSE_ALARMS: f64 = 0.003;
/// One of this many settings, and one of this many labs, is in a sample.
const SETTINGS_STEP: usize = 20;
const LABS_STEP: usize = 10;

/// A lab with its model and its programs.
struct PreparedLab {
    lab: Lab,
    model: Model,
    programs: Programs,
}

/// The texts of the labs.
fn texts() -> Vec<String> {
    let all = std::fs::read_to_string(workspace().join("tests/twenty/labs.md")).unwrap();
    let blocks = all.split("```lab simlab\n").skip(1);
    blocks.map(|part| part.split("\n```").next().unwrap().to_string()).collect()
}

fn prepare(text: &str) -> PreparedLab {
    let lesson = load_lesson(SourceFile::new("lab.json", text), &ModelFolder::unknown());
    assert_eq!(lesson.findings, [], "the labs are as they should be");
    let lab = lesson.all_labs()[0].clone();
    let model = compile(&lab.xml.as_ref().unwrap().value);
    let programs = Programs::compile(&lab, &model, &mut Vec::new());
    PreparedLab { lab, model, programs }
}

/// The codes that `run` reports for a setting.
fn run(ready: &PreparedLab, set: Vec<(String, Value)>) -> BTreeSet<&'static str> {
    let options = RunOptions { set, every: 100, ..RunOptions::default() };
    let table = stress::watched_run(&ready.lab, &ready.model, &ready.programs, &options).unwrap();
    assert_eq!(table.errors, Vec::<String>::new());
    table.breakdowns.iter().map(|b| b.rule.code).collect()
}

fn given(setting: &Json) -> Vec<(String, Value)> {
    let all = setting["set"].as_object().unwrap();
    all.iter().map(|(label, x)| (label.clone(), Value::Number(x.as_f64().unwrap()))).collect()
}

#[test]
fn broken_settings_are_reported_and_valid_ones_are_not() {
    let labs: Vec<PreparedLab> = texts().iter().map(|text| prepare(text)).collect();
    let golden = read_json(&workspace().join("tests/golden/twenty.json"));
    let settings = sample(golden["settings"].as_array().unwrap().iter().collect(), SETTINGS_STEP);
    let reports = for_each(settings.len(), |i| {
        let setting = settings[i];
        run(&labs[setting["lab"].as_u64().unwrap() as usize], given(setting))
    });
    let (mut broken, mut intact) = ([0usize; 2], [0usize; 2]);
    let mut wrong = Vec::new();
    for (setting, codes) in settings.iter().zip(reports) {
        let reported = codes.iter().any(|code| *code != "creeps");
        let count = match setting["broken"].as_bool() {
            Some(true) => &mut broken,
            Some(false) => &mut intact,
            None => continue,
        };
        count[0] += 1;
        count[1] += usize::from(reported);
        if setting["broken"].as_bool() != Some(reported) {
            wrong.push(format!("{setting}: {codes:?}"));
        }
    }
    println!(
        "{} of {} broken settings are reported, {} of {} sound ones",
        broken[1], broken[0], intact[1], intact[0]
    );
    wrong.iter().for_each(|line| println!("{line}"));
    let [least_broken, least_intact] = [1000, 3000].map(|n| minimum(n, SETTINGS_STEP));
    assert!(broken[0] >= least_broken && intact[0] >= least_intact, "{broken:?} {intact:?}");
    assert!(broken[1] as f64 >= REPORTED * broken[0] as f64, "{broken:?}");
    assert!(intact[1] as f64 <= MAX_FALSE_ALARMS * intact[0] as f64, "{intact:?}");
}

/// The kind in `stability` for a code of `check` and `run`.
fn kind(code: &str) -> Option<&'static str> {
    Some(match code {
        "simulation-diverges" => "diverges",
        "engine-warning" => "engineWarns",
        "energy-grows" | "damper-pushes" => "energyGrows",
        "runs-away" => "silentDivergence",
        "past-limit" => "pastALimit",
        "passes-through" => "tunnelling",
        "sinks-in" => "sinksIn",
        "solver-stops-early" => "solverStopsEarly",
        "pressed-deep" => "penetration",
        "chatters" => "chatter",
        "creeps" => "drift",
        _ => return None,
    })
}

/// The lab with its controls at these values.
fn set(text: &str, values: &Json) -> String {
    let mut lab: Json = serde_json::from_str(text).unwrap();
    for control in lab["controls"].as_array_mut().unwrap() {
        control["value"] = values[control["label"].as_str().unwrap()].clone();
    }
    lab.to_string()
}

/// A lab: its name, its text, and the folder of its model.
type Named = (String, String, Option<&'static str>);

/// The labs of the corpus, if it exists.
fn corpus() -> Vec<Named> {
    if !needs("../shared/corpus") {
        return Vec::new();
    }
    let folder = workspace().join("../shared/corpus/labs");
    let mut files: Vec<_> = std::fs::read_dir(folder).unwrap().map(|e| e.unwrap().path()).collect();
    files.sort();
    let named = |f: &std::path::PathBuf| {
        let name = f.file_stem().unwrap().to_str().unwrap().to_string();
        (name, std::fs::read_to_string(f).unwrap(), Some("../shared/corpus/models"))
    };
    files.iter().map(named).collect()
}

/// The report of a command for a lab.
fn report(command: &str, file: &Path, models: Option<&str>, more: &[&str]) -> Json {
    let mut words = vec![command, file.to_str().unwrap(), "--format", "json"];
    words.extend(more);
    models.iter().for_each(|folder| words.extend(["--models", folder]));
    let done = run_in(&workspace(), &words);
    serde_json::from_str(&done.stdout).unwrap_or_else(|_| panic!("{}: {}", file.display(), done.stderr))
}

/// Compares the reports of the three commands for the unchanged lab.
fn three(folder: &Path, name: &str, text: &str, models: Option<&str>) -> Option<String> {
    let lesson = load_lesson(SourceFile::new("lab.json", text), &ModelFolder::unknown());
    let window = stress::window(lesson.all_labs()[0]).to_string();
    let file = folder.join(format!("{name}.json"));
    std::fs::write(&file, text).unwrap();
    let report = |command: &str, more: &[&str]| report(command, &file, models, more);
    let texts = |list: &Json, key: &str| -> Vec<String> {
        list.as_array().unwrap().iter().map(|x| x[key].as_str().unwrap().to_string()).collect()
    };
    let kinds = |codes: Vec<String>| codes.iter().filter_map(|c| kind(c)).collect::<BTreeSet<&str>>();
    let by_run = kinds(texts(&report("run", &["--until", &window])["breakdowns"], "code"));
    let stability = report("stability", &["--until", &window]);
    let wrong = stability["runs"][0]["wrong"].as_array().unwrap().iter().filter_map(Json::as_str);
    let by_stability: BTreeSet<&str> = wrong.filter(|k| *k != "throws").collect();
    let checked = report("check", &[]);
    let findings = checked["findings"].as_array().unwrap().iter();
    let as_it_stands = |f: &&Json| {
        let message = f["message"].as_str().unwrap();
        message.contains(" as it stands: ") || message.contains(", as it stands (")
    };
    let codes = findings.filter(as_it_stands).map(|f| f["code"].as_str().unwrap().to_string());
    let by_check = kinds(codes.collect());
    (by_run != by_stability || by_run != by_check)
        .then(|| format!("{name}: run {by_run:?}, stability {by_stability:?}, check {by_check:?}\n{text}"))
}

#[test]
fn run_check_and_stability_report_the_same() {
    let blocks = texts();
    let golden = read_json(&workspace().join("tests/golden/twenty.json"));
    // The first settings, the same number for each lab; the last one was found among 700: a control above 1e10.
    let requested = std::env::var("LABSPEC_CASES").ok().and_then(|n| n.parse().ok()).unwrap_or(40);
    let settings = golden["settings"].as_array().unwrap().iter().enumerate();
    let mut labs: Vec<Named> = settings
        .filter(|(i, _)| *i < requested || *i == 545)
        .map(|(i, s)| {
            (format!("setting-{i}"), set(&blocks[s["lab"].as_u64().unwrap() as usize], &s["set"]), None)
        })
        .collect();
    labs.extend(blocks.iter().enumerate().map(|(i, text)| (format!("lab-{i}"), text.to_string(), None)));
    labs.extend(corpus());
    let labs = sample(labs, LABS_STEP);
    let folder = tempfile::tempdir().unwrap();
    let wrong: Vec<String> = for_each(labs.len(), |i| {
        let (name, text, models) = &labs[i];
        three(folder.path(), name, text, *models)
    })
    .into_iter()
    .flatten()
    .collect();
    assert!(wrong.is_empty(), "{} of {}:\n{}", wrong.len(), labs.len(), wrong.join("\n"));
}

/// Compares `precision` and `verify` with `run` for the unchanged lab: the same messages if it fails, otherwise the same
/// bits of the final number.
fn others(folder: &Path, name: &str, text: &str, models: Option<&str>) -> Result<bool, String> {
    let lesson = load_lesson(SourceFile::new("lab.json", text), &ModelFolder::unknown());
    let lab = lesson.all_labs()[0];
    let window = stress::window(lab);
    let mut with: Json = serde_json::from_str(text).unwrap();
    let Some(expr) = with["readouts"][0]["expr"].as_str().map(str::to_string) else { return Ok(false) };
    with["verify"] = serde_json::json!({
        "runs": {"r": {"until": window}}, "measure": {"x": format!("final({expr})")}, "says": []
    });
    let file = folder.join(format!("{name}.json"));
    std::fs::write(&file, with.to_string()).unwrap();
    let report = |command: &str, more: &[&str]| report(command, &file, models, more);
    let until = window.to_string();
    let run = report("run", &["--until", &until]);
    // Faults that only the monitors of `check` and `stability` detect are not expected from the others.
    let loud: BTreeSet<String> = run["breakdowns"]
        .as_array()
        .unwrap()
        .iter()
        .filter(|b| {
            b["help"]
                .as_str()
                .is_some_and(|help| !help.contains("`labspec stability`, which makes these runs"))
        })
        .map(|b| b["what"].as_str().unwrap().to_string())
        .collect();
    // The lab's own setting is among those that are compared, for any list of integrators.
    let precision = report("precision", &["--until", &until, "--integrator", "Euler"]);
    let lab_row = precision["rows"].as_array().unwrap().iter().find(|row| row["own"] == true);
    if let Some(lab_row) = lab_row {
        let reported = lab_row["told"].as_array().unwrap().iter().map(|t| t.as_str().unwrap().to_string());
        let reported: BTreeSet<String> = reported.collect();
        if reported != loud {
            return Err(format!("{name}: run {loud:?}, precision {reported:?}"));
        }
    }
    let checked = report("check", &[]);
    let breaks: Vec<&str> = checked["findings"]
        .as_array()
        .unwrap()
        .iter()
        .filter(|f| f["code"] == "run-breaks")
        .map(|f| f["message"].as_str().unwrap())
        .collect();
    let first = run["breakdown"]["what"].as_str().filter(|what| loud.contains(*what));
    if breaks.is_empty() != first.is_none() || first.is_some_and(|what| !breaks[0].contains(what)) {
        return Err(format!("{name}: run {first:?}, verify {breaks:?}"));
    }
    let measured = checked["lessons"][0]["claims"][0]["measures"]["x"]["value"].as_f64();
    let Some(measured) = measured else { return Ok(false) };
    let column =
        run["columns"].as_array().unwrap().iter().position(|c| c.as_str().unwrap().starts_with("readout/"));
    let last = run["rows"].as_array().unwrap().last().unwrap();
    let displayed = column.and_then(|c| last[c].as_f64());
    if displayed.is_some_and(|displayed| displayed.to_bits() != measured.to_bits()) {
        return Err(format!("{name}: run {displayed:?}, verify {measured}"));
    }
    Ok(displayed.is_some())
}

/// Quotes up to six readouts at the end of a lab's own run in a sentence, with four digits after the point because more would
/// depend on the timestep, and traces them: the measures that `trace` proposes have the values of `verify`, to the bit. Returns
/// the number of measures, and how many of them have the final value of `run`, to the bit.
fn traced(folder: &Path, name: &str, text: &str, models: Option<&str>) -> Result<[usize; 2], String> {
    let report = |command: &str, file: &Path| report(command, file, models, &[]);
    let lab = folder.join(format!("{name}.json"));
    std::fs::write(&lab, text).unwrap();
    let run = report("run", &lab);
    let columns = run["columns"].as_array().unwrap().iter();
    let last = run["rows"].as_array().unwrap().last().unwrap().as_array().unwrap();
    let is_readout = |c: &Json| c.as_str().unwrap().starts_with("readout/");
    let readouts = columns.zip(last).filter(|(column, _)| is_readout(column));
    let ends: Vec<f64> = readouts.filter_map(|(_, end)| end.as_f64()).take(6).collect();
    if ends.is_empty() {
        return Ok([0; 2]);
    }
    let units = ["rad", "m", "m/s", "rad/s", "J", "N", "N m"];
    let units: Vec<String> =
        ends.iter().flat_map(|end| units.map(|unit| format!("{end:.4} {unit}"))).collect();
    let lesson =
        |lab: &str| format!("# A lab\n\n```lab simlab\n{lab}\n```\n\nIt ends at {}.\n", units.join(", "));
    let file = folder.join(format!("{name}.md"));
    std::fs::write(&file, lesson(text)).unwrap();
    let trace = report("trace", &file);
    let Some(proposal) = trace["proposals"].get(0) else { return Ok([0; 2]) };
    let mut with: Json = serde_json::from_str(text).unwrap();
    with["verify"] = proposal["verify"].clone();
    std::fs::write(&file, lesson(&with.to_string())).unwrap();
    let checked = report("check", &file);
    let measures = &checked["lessons"][0]["claims"][0]["measures"];
    let mut found = [0; 2];
    for number in
        trace["numbers"].as_array().unwrap().iter().filter(|n| n["origin"] == "traced" && n["factor"] == "")
    {
        let (value, measure) = (number["value"].as_f64().unwrap(), number["measure"].as_str().unwrap());
        let proposed = proposal["verify"]["measure"].as_object().unwrap();
        let Some((label, _)) = proposed.iter().find(|(_, text)| **text == measure) else { continue };
        let Some(verified) = measures[label]["value"].as_f64() else { continue };
        if verified.to_bits() != value.to_bits() {
            return Err(format!("{name}: {measure} is {value} by trace, {verified} by verify"));
        }
        found[0] += 1;
        found[1] += usize::from(ends.iter().any(|end| value.to_bits() == end.to_bits()));
    }
    Ok(found)
}

#[test]
fn trace_agrees_with_verify() {
    let lab_texts = texts().into_iter().enumerate().map(|(i, text)| (format!("lab-{i}"), text, None));
    let mut labs: Vec<Named> = lab_texts.collect();
    labs.extend(corpus());
    let folder = tempfile::tempdir().unwrap();
    let found = for_each(labs.len(), |i| traced(folder.path(), &labs[i].0, &labs[i].1, labs[i].2));
    let wrong: Vec<String> = found.iter().filter_map(|s| s.clone().err()).collect();
    assert!(wrong.is_empty(), "{} of {}:\n{}", wrong.len(), labs.len(), wrong.join("\n"));
    let [measures, ends] = [0, 1].map(|k| found.iter().flatten().map(|count| count[k]).sum::<usize>());
    assert!(measures >= 20 && ends >= 15, "{measures} measures were compared, {ends} with the end of `run`");
}

#[test]
fn precision_and_verify_agree_with_run() {
    let lab_texts = texts().into_iter().enumerate().map(|(i, text)| (format!("lab-{i}"), text, None));
    let mut labs: Vec<Named> = lab_texts.collect();
    labs.extend(corpus());
    let labs = sample(labs, LABS_STEP);
    let folder = tempfile::tempdir().unwrap();
    let comparisons = for_each(labs.len(), |i| others(folder.path(), &labs[i].0, &labs[i].1, labs[i].2));
    let wrong: Vec<String> = comparisons.iter().filter_map(|s| s.clone().err()).collect();
    assert!(wrong.is_empty(), "{} of {}:\n{}", wrong.len(), labs.len(), wrong.join("\n"));
    let compared = comparisons.iter().filter(|s| **s == Ok(true)).count();
    assert!(compared >= minimum(15, LABS_STEP), "{compared} numbers were compared");
}
