//! Stiff and extreme scenes compared with MuJoCo 3.14.0: `golden/stability.py` defines the cases and recorded the library's
//! results; this test writes `docs/measured/stability.md`.
//!
//! The scenes and searches run as a test. Long runs (10 million steps) are shortened there; `LABSPEC_STABILITY=long` with
//! `LABSPEC_BLESS=1` performs them in full, preferably in a release build, and stores their results in
//! `golden/stability_long.json`.

#![allow(clippy::unwrap_used, clippy::panic)]

use crate::fresh::SAMPLE_STEP;
use crate::population::{minimum, takes_all};
use crate::support::{compile, read_json, workspace};
use labspec::monitors::growth::Source;
use labspec::monitors::watch::{self, Observations};
use labspec_core::{self as core, Data, Model, Warning, enable};
use serde_json::{Value as Json, json};
use std::fmt::Write;

/// The number of coordinates that are compared at the end.
const KEPT: usize = 7;
/// The heading of the section that `fresh.rs` writes.
const RANDOM: &str = "\n## A random test set";
/// The number of steps of a long run in a test.
const SHORTENED: u64 = 2_000;

/// The result of a run, in the format of the recording.
fn run(xml: &str, steps: u64, long: u64, keep: &Json) -> Json {
    let mut m = compile(xml);
    let mut d = Data::new(&m);
    if let Some(key) = m.keys().next() {
        core::reset_data_keyframe(&m, &mut d, key).unwrap();
    }
    let start = energy(&mut m, &d);
    let mut reach = largest(&d.qpos);
    let (total, each) = if long > 0 { (long, (long / 1000).max(1)) } else { (steps, 1) };
    let mut done = 0;
    let mut out = outside_bounds(&d, keep, "way");
    let mut watch = watch::watch(&m, &d, false);
    let mut reported = Json::Null;
    while done < total {
        let before = d.time;
        for _ in 0..each {
            core::step(&m, &mut d).unwrap();
            watch::observe(&mut watch, &m, &d);
            if reported.is_null() && watch::observations(&watch).time().is_finite() {
                reported = to_json(watch::observations(&watch));
            }
        }
        done += each;
        for which in [Warning::BadQpos, Warning::BadQvel, Warning::BadQacc] {
            let stat = d.warning[which as usize];
            if stat.number > 0 {
                return json!({"warning": which.name().trim_start_matches("bad"), "time": before, "dof": stat.lastinfo, "told": reported});
            }
        }
        // NaN never occurs silently: the next step would report it.
        reach = reach.max(largest(&d.qpos));
        out = out.max(outside_bounds(&d, keep, "way"));
    }
    assert!(
        d.qpos.iter().chain(&d.qvel).all(|x| x.is_finite()),
        "a number that is none, and no warning:\n{xml}"
    );
    let out = out.max(outside_bounds(&d, keep, "end"));
    let mut out = json!({"reach": reach, "out": out, "speed": largest(&d.qvel), "qpos": d.qpos.iter().take(KEPT).collect::<Vec<_>>()});
    out["told"] = reported;
    if long > 0 {
        let end = energy(&mut m, &d);
        out["energy"] = json!(if start == 0.0 { end } else { (end - start) / start.abs().max(1e-12) });
        if m.nq == 7 {
            out["norm"] = json!(d.qpos[3..7].iter().map(|q| q * q).sum::<f64>().sqrt() - 1.0);
        }
    }
    out
}

/// The fault that was noticed first, and its time.
fn to_json(noticed: &Observations) -> Json {
    let pushed = noticed.growth.is_some_and(|g| matches!(g.source, Source::Damper(_)));
    let grows = if pushed { "a damper pushes" } else { "energy grows" };
    let list = [
        (grows, noticed.growth.map(|x| x.time)),
        ("past a limit", noticed.past.map(|x| x.time)),
        ("went through", noticed.through.map(|x| x.time)),
        ("sunk in", noticed.sunk.map(|x| x.time)),
        ("solver stopped", noticed.unsolved.map(|x| x.time)),
    ];
    let first = list.into_iter().find_map(|(what, time)| Some((what, time?)));
    first.map_or(Json::Null, |(what, time)| json!({"what": what, "time": time}))
}

/// How far a run is outside the bounds of its case.
fn outside_bounds(d: &Data, keep: &Json, when: &str) -> f64 {
    let list = keep.as_array().into_iter().flatten().filter(|k| k["when"] == when);
    let far = list.map(|k| {
        let of = if k["of"] == "qpos" { &d.qpos } else { &d.qvel };
        let x = of[k["i"].as_u64().unwrap() as usize];
        (k["low"].as_f64().unwrap() - x).max(x - k["high"].as_f64().unwrap())
    });
    far.fold(0.0, f64::max)
}

/// The potential and kinetic energy of a state, J.
fn energy(m: &mut Model, d: &Data) -> f64 {
    let mut d = d.clone();
    m.set_enabled(enable::ENERGY, true);
    core::forward(m, &mut d).unwrap();
    m.set_enabled(enable::ENERGY, false);
    d.energy[0] + d.energy[1]
}

fn largest(v: &[f64]) -> f64 {
    v.iter().fold(0.0, |s: f64, x| if x.is_nan() { f64::INFINITY } else { s.max(x.abs()) })
}

/// The result of a run in words. A run outside its bounds has failed silently.
fn describe_outcome(outcome: &Json, bound: f64) -> String {
    if let Some(kind) = outcome["warning"].as_str() {
        return format!("bad {kind} at {} s", short(outcome["time"].as_f64().unwrap()));
    }
    let (Some(reach), Some(speed)) = (outcome["reach"].as_f64(), outcome["speed"].as_f64()) else {
        return "not run".into();
    };
    let out = outcome["out"].as_f64().unwrap_or(0.0);
    if reach > bound || out > 0.0 {
        return format!("**{} off, silently**", short(if reach > bound { reach } else { out }));
    }
    if speed < 1e-3 { "at rest".into() } else { format!("moves at {}", short(speed)) }
}

/// A number with two digits.
fn short(x: f64) -> String {
    if x == 0.0 || (1e-3..1e4).contains(&x.abs()) {
        let digits = (1 - x.abs().max(1e-3).log10().floor() as i32).max(0) as usize;
        format!("{x:.digits$}")
    } else {
        format!("{x:.1e}")
    }
}

/// The largest difference of the coordinates at the end of two runs.
fn largest_difference(a: &Json, b: &Json) -> String {
    if a["warning"].is_string() || b["warning"].is_string() {
        let same = a["warning"].is_string() == b["warning"].is_string();
        return if same { "both say so".into() } else { "**one says so**".into() };
    }
    let list =
        |x: &Json| x["qpos"].as_array().unwrap().iter().map(|q| q.as_f64().unwrap()).collect::<Vec<_>>();
    let far = list(a).iter().zip(&list(b)).fold(0.0, |s: f64, (x, y)| s.max((x - y).abs()));
    if far == 0.0 { "0".into() } else { format!("{far:.0e}") }
}

/// Whether a run has no fault.
fn fine(outcome: &Json, bound: f64) -> bool {
    outcome["reach"].as_f64().is_some_and(|reach| reach <= bound)
        && outcome["out"].as_f64().is_none_or(|out| out == 0.0)
}

/// The results of the runs of a class.
#[derive(Default)]
struct Class {
    name: String,
    runs: usize,
    /// Runs of the library and of our engine without a fault, with a warned fault, and with a silent fault.
    well: [usize; 2],
    loud: [usize; 2],
    silent: [usize; 2],
    /// Silent faults of ours that are reported, and runs without a fault that are reported as wrong.
    reported: usize,
    called: usize,
}

/// All classes, with the false alarms and missed faults.
#[derive(Default)]
struct Classes {
    list: Vec<Class>,
    alarms: Vec<String>,
    undetected: Vec<String>,
}

impl Classes {
    /// Counts a run; the library's result may be missing.
    fn count(&mut self, class: &str, name: &str, outcomes: [Option<&Json>; 2], bound: f64) {
        if self.list.iter().all(|c| c.name != class) {
            self.list.push(Class { name: class.into(), ..Class::default() });
        }
        let Some(c) = self.list.iter_mut().find(|c| c.name == class) else { return };
        c.runs += 1;
        for (side, outcome) in outcomes.into_iter().enumerate() {
            let Some(outcome) = outcome else { continue };
            let of = if fine(outcome, bound) {
                &mut c.well
            } else if outcome["warning"].is_string() {
                &mut c.loud
            } else {
                &mut c.silent
            };
            of[side] += 1;
        }
        let Some(labspec_outcome) = outcomes[1] else { return };
        let reported = labspec_outcome["told"].is_object();
        if fine(labspec_outcome, bound) {
            c.called += usize::from(reported);
            self.alarms.extend(reported.then(|| format!("{class}, {name}: {labspec_outcome}")));
        } else if !labspec_outcome["warning"].is_string() {
            c.reported += usize::from(reported);
            self.undetected.extend((!reported).then(|| format!("{class}, {name}: {labspec_outcome}")));
        }
    }

    /// The sum of all classes.
    fn sum(&self) -> Class {
        let mut sum = Class { name: "**all**".into(), ..Class::default() };
        for c in &self.list {
            (sum.runs, sum.reported, sum.called) =
                (sum.runs + c.runs, sum.reported + c.reported, sum.called + c.called);
            for side in 0..2 {
                sum.well[side] += c.well[side];
                sum.loud[side] += c.loud[side];
                sum.silent[side] += c.silent[side];
            }
        }
        sum
    }

    /// The table of classes.
    fn table(&self) -> String {
        let mut text = String::from(
            "| class | runs | well: MuJoCo | labspec | wrong, with a warning: MuJoCo | labspec | silently wrong: MuJoCo | labspec | reported | false alarms |\n\
             |---|---:|---:|---:|---:|---:|---:|---:|---:|---:|\n",
        );
        for c in self.list.iter().chain([&self.sum()]) {
            let searched = c.name.starts_with("Longest");
            let of = |pair: [usize; 2]| {
                let library = if searched { "–".into() } else { pair[0].to_string() };
                format!("{library} | {}", pair[1])
            };
            let reported =
                if c.silent[1] == 0 { String::new() } else { format!("{} of {}", c.reported, c.silent[1]) };
            let _ = writeln!(
                text,
                "| {} | {} | {} | {} | {} | {reported} | {} |",
                c.name,
                c.runs,
                of(c.well),
                of(c.loud),
                of(c.silent),
                c.called
            );
        }
        text
    }
}

/// The report about a run: the fault and its time, or that there is no report.
fn reported(outcome: &Json, bound: f64) -> String {
    match (outcome["told"]["what"].as_str(), outcome["told"]["time"].as_f64()) {
        (Some(what), Some(time)) => format!("{what}, {} s", short(time)),
        _ if fine(outcome, bound) || outcome["warning"].is_string() => String::new(),
        _ => "**nobody**".into(),
    }
}

/// Cases side by side; adds those that are fine in the library and not here to `wrong`.
fn table(
    cases: &[Json],
    run: impl Fn(&Json) -> Json,
    wrong: &mut Vec<String>,
    classes: &mut Classes,
) -> String {
    let (mut text, mut section) = (String::new(), "");
    for case in cases {
        let name = case["section"].as_str().unwrap();
        if name != section {
            section = name;
            let _ = writeln!(
                text,
                "\n### {section}\n\n| case | MuJoCo | labspec | apart | reported |\n|---|---|---|---:|---|"
            );
        }
        let (bound, library, labspec_outcome) = (case["bound"].as_f64().unwrap(), &case["theirs"], run(case));
        let title = case["case"].as_str().unwrap();
        classes.count(section, title, [Some(library), Some(&labspec_outcome)], bound);
        if fine(library, bound) && !fine(&labspec_outcome, bound) {
            wrong.push(format!("{section}, {title}: {labspec_outcome}, theirs {library}"));
        }
        let describe = |o: &Json| describe_outcome(o, bound);
        let _ = writeln!(
            text,
            "| {title} | {} | {} | {} | {} |",
            describe(library),
            describe(&labspec_outcome),
            largest_difference(library, &labspec_outcome),
            reported(&labspec_outcome, bound)
        );
    }
    text
}

/// The longest timestep at which a family of models, and all shorter ones, stay within the bound.
fn longest(search: &Json, timesteps: &[f64], classes: &mut Classes) -> Option<f64> {
    let xml = search["xml"].as_str().unwrap();
    let of = |key: &str| search[key].as_str().unwrap_or_default();
    let bound = search["bound"].as_f64().unwrap();
    // Within the wide bound of the search, a ball may bounce faster than its fall allows, which counts as a fault.
    let keep = if of("section").starts_with("Contact") {
        let height = Data::new(&compile(&xml.replace("TIMESTEP", "0.001"))).qpos[2];
        let fastest = 1.25 * (2.0 * 9.81 * height).sqrt();
        json!([{"of": "qvel", "i": 2, "when": "way", "low": -1e9, "high": fastest}])
    } else {
        Json::Null
    };
    let mut stays = |h: &f64| {
        let outcome =
            run(&xml.replace("TIMESTEP", &h.to_string()), search["steps"].as_u64().unwrap(), 0, &keep);
        let name = format!("{}, {}, {h} s", of("row"), of("column"));
        let class = format!("Longest stable timestep: {}", of("section").to_lowercase());
        classes.count(&class, &name, [None, Some(&outcome)], bound);
        outcome["reach"].as_f64().is_some_and(|reach| reach <= bound)
    };
    timesteps.iter().copied().take_while(|h| stays(h)).last()
}

/// Searches side by side: a row for each stiffness, a column for each integrator, "theirs / ours" if these differ.
fn searched(searches: &[Json], timesteps: &[f64], differ: &mut Vec<String>, classes: &mut Classes) -> String {
    const COLUMNS: [&str; 5] = ["Euler", "RK4", "implicit", "implicitfast", "discrete"];
    let mut rows: Vec<&[Json]> = searches.chunks(COLUMNS.len()).collect();
    rows.sort_by_key(|row| row[0]["section"].as_str());
    let (mut text, mut section) = (String::new(), "");
    for row in rows {
        let [of, name] = ["section", "row"].map(|key| row[0][key].as_str().unwrap());
        if of != section {
            section = of;
            let lines = "---:|".repeat(COLUMNS.len());
            let _ = writeln!(text, "\n### {section}\n\n| | {} |\n|---|{lines}", COLUMNS.join(" | "));
        }
        let cells = row.iter().map(|search| {
            let (library, labspec_value) = (search["theirs"].as_f64(), longest(search, timesteps, classes));
            let word = |h: Option<f64>| h.map_or("none".into(), |h| format!("{} ms", short(1e3 * h)));
            if library == labspec_value {
                return word(labspec_value);
            }
            differ.push(format!(
                "{of}, {name}, {}: theirs {library:?}, ours {labspec_value:?}",
                search["column"]
            ));
            format!("**{} / {}**", word(library), word(labspec_value))
        });
        let _ = writeln!(text, "| {name} | {} |", cells.collect::<Vec<_>>().join(" | "));
    }
    text
}

/// The subjects of the lines of a page: digits at the level of rounding vary, scenes do not.
fn subjects(page: &str) -> Vec<&str> {
    page.lines()
        .map(|line| line.split('|').nth(1).unwrap_or(line))
        .filter(|s| !s.contains("silently, and"))
        .collect()
}

#[test]
fn stiff_and_extreme_scenes() {
    let golden = workspace().join("tests/golden");
    let recording = read_json(&golden.join("stability.json"));
    let bless = std::env::var_os("LABSPEC_BLESS").is_some();
    let recorded = golden.join("stability_long.json");
    let (long, cases): (Vec<Json>, Vec<Json>) =
        recording["cases"].as_array().unwrap().iter().cloned().partition(|c| c["long"] != 0);
    if bless && std::env::var("LABSPEC_STABILITY").is_ok_and(|v| v == "long") {
        let runs: serde_json::Map<String, Json> = long
            .iter()
            .map(|c| {
                (
                    c["case"].as_str().unwrap().into(),
                    run(c["xml"].as_str().unwrap(), 0, c["long"].as_u64().unwrap(), &Json::Null),
                )
            })
            .collect();
        std::fs::write(&recorded, serde_json::to_string_pretty(&runs).unwrap() + "\n").unwrap();
    }
    for case in &long {
        // The beginning of a long run tests that nothing fails early.
        run(case["xml"].as_str().unwrap(), 0, SHORTENED, &Json::Null);
    }
    let mut wrong = Vec::new();
    let mut classes = Classes::default();
    let sections = table(
        &cases,
        |c| run(c["xml"].as_str().unwrap(), c["steps"].as_u64().unwrap(), 0, &c["keep"]),
        &mut wrong,
        &mut classes,
    );
    let timesteps: Vec<f64> =
        recording["timesteps"].as_array().unwrap().iter().map(|h| h.as_f64().unwrap()).collect();
    let mut differ = Vec::new();
    let searches = recording["searches"].as_array().unwrap();
    let largest = searched(searches, &timesteps, &mut differ, &mut classes);
    let sum = classes.sum();
    let runs = read_json(&recorded);
    let mut text = format!(
        "# Stiff and extreme scenes\n\n`tests/stability.rs` writes this page from the cases of `tests/golden/stability.py`. It compares labspec with MuJoCo 3.14.0.\n\nOf {} runs \
         of labspec, {} go well and {} end with a warning. {} fail without a warning of the engine. labspec reports {} of these, with {} false \
         alarms among the runs that go well. The numbers agree with the library's: labspec fails where the library does. The difference is that \
         labspec reports the failure.\n\n## By class\n\n*Well* is a run that stays within the limits of its case: within bounds, on the floor, \
         before the wall, as fast as its energy allows. *Silently wrong* is a run that does not, without a warning of the engine. Of the searches \
         for the longest timestep, only those of labspec are evaluated step by step.\n\n{}\n## Reported problems\n\n\
         | report | criterion | monitor |\n|---|---|---|\n\
         | energy grows | three times the possible energy (up to ten times near the limit of a spring) in one step, or once that energy for 32 steps; if a step makes half a turn, observed a few times | `monitors/growth` |\n\
         | a damper pushes | the same, caused by a negative damping | `monitors/growth` |\n\
         | past a limit | half the joint's range beyond its limit, or a fifth of it permanently or by one step that is longer | `monitors/limits` |\n\
         | went through | the centre of a body passes through a middle plane of another one | `monitors/through` |\n\
         | sunk in | permanently three tenths of the thickness deep, or completely below a plane | `monitors/sunk` |\n\
         | solver stopped | a quarter of the constraint forces is missing, repeatedly | `monitors/unsolved` |\n\n\
         ## Results by case\n\n*Apart* is the largest difference of the first coordinates at the end (m, rad). Stacks of very unequal boxes jitter by the residual of the \
         solver at its tolerance, in both programs, but not in the same steps. Every step of a run is monitored.\n{sections}\n\
         ## Longest stable timestep\n\nThe longest of the timesteps {} at which 2,000 steps stay within bounds, with all shorter ones as well; **MuJoCo / labspec** where they \
         differ ({} of {}).\n{largest}\n## Long runs\n\nRuns of ten million steps. Energy is the change relative to the start.\n\n\
         | case | MuJoCo | labspec | energy | labspec | norm of the quaternion minus 1 | labspec |\n|---|---|---|---:|---:|---:|---:|\n",
        sum.runs,
        sum.well[1],
        sum.loud[1],
        sum.silent[1],
        sum.reported,
        sum.called,
        classes.table(),
        timesteps.iter().map(|h| format!("{} ms", short(1e3 * h))).collect::<Vec<_>>().join(", "),
        differ.len(),
        searches.len()
    );
    for case in &long {
        let name = case["case"].as_str().unwrap();
        let (library, labspec_outcome, bound) =
            (&case["theirs"], &runs[name], case["bound"].as_f64().unwrap());
        let number = |o: &Json, key: &str| o[key].as_f64().map_or("–".into(), |x| format!("{x:.1e}"));
        let _ = writeln!(
            text,
            "| {name} | {} | {} | {} | {} | {} | {} |",
            describe_outcome(library, bound),
            describe_outcome(labspec_outcome, bound),
            number(library, "energy"),
            number(labspec_outcome, "energy"),
            number(library, "norm"),
            number(labspec_outcome, "norm")
        );
    }
    let (section, rates, mistakes) = crate::fresh::section();
    text.push_str(&section);
    let path = workspace().join("docs/measured/stability.md");
    if bless {
        std::fs::write(&path, &text).unwrap();
    }
    for line in wrong.iter().chain(&differ).chain(&classes.alarms).chain(&classes.undetected).chain(&mistakes)
    {
        println!("{line}");
    }
    // Random scenes: most faults are reported, and almost no run without a fault is.
    let enough = rates.wrong >= minimum(30, SAMPLE_STEP) && rates.well >= minimum(60, SAMPLE_STEP);
    assert!(enough, "{} and {} scenes", rates.wrong, rates.well);
    assert!(4 * rates.reported >= 3 * rates.wrong, "{} of {} are told", rates.reported, rates.wrong);
    // One of fifty; a sample has fewer, of which one may be.
    assert!(50 * rates.alarms <= rates.well.max(50), "{} of {} are called wrong", rates.alarms, rates.well);
    assert!(sum.well[1] > 1000 && sum.silent[1] > 60, "{} and {} runs", sum.well[1], sum.silent[1]);
    assert!(sum.called == 0, "runs that go well, said to go wrong:\n{}", classes.alarms.join("\n"));
    assert!(
        classes.undetected.is_empty(),
        "what goes wrong and nobody tells:\n{}",
        classes.undetected.join("\n")
    );
    assert!(wrong.is_empty(), "scenes that end well with MuJoCo and not here:\n{}", wrong.join("\n"));
    let stored = std::fs::read_to_string(&path).unwrap_or_default();
    // The section about random scenes, the last one, counts all of them.
    let [stored, text] = [&stored, &text]
        .map(|page| if takes_all() { page } else { page.split(RANDOM).next().unwrap_or(page) });
    assert!(
        differ.len() <= searches.len() / 20,
        "longest stable timesteps that are not MuJoCo's:\n{}",
        differ.join("\n")
    );
    assert!(
        subjects(stored) == subjects(text),
        "docs/measured/stability.md is stale: LABSPEC_BLESS=1 cargo test -p labspec-cli --test all stiff"
    );
}
