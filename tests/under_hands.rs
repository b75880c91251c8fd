//! Labs with interactions of a student, compared with MuJoCo 3.14.0: all runs that `labspec stability --margins` performs for
//! the labs of `stability/labs.md` and of `../shared`, and the library's results for the same settings (recorded by
//! `stability/theirs.mjs` in `golden/stability_labs.json`). Writes `docs/measured/stability-labs.md`.

#![allow(clippy::unwrap_used, clippy::panic)]

use crate::needs::needs;
use crate::population::{minimum, sample, takes_all};
use crate::program::run_in;
use crate::support::{recording, workspace};
use serde_json::Value as Json;
use std::collections::BTreeSet;
use std::fmt::Write;

/// If searches of the library differ by more than this factor among themselves, the margin is random.
const CHANCE: f64 = 1.5;
/// The tolerance of margins, relative to the library's.
const CLOSE: f64 = 0.1;
/// The tolerance if the contacts of a stack at rest switch in a step, which depends on the remaining error of
/// the solver on both sides.
const CHATTERS: f64 = 0.5;
/// One of this many labs is in a sample.
const STEP: usize = 8;

/// Our report of a lab.
fn labspec_report(lab: &str) -> Json {
    let target = match lab.split_once('#') {
        Some(("labs.md", _)) => format!("tests/stability/{lab}"),
        Some(("twenty.md", number)) => format!("tests/twenty/labs.md#{number}"),
        Some(_) => format!("../shared/lesson-0.1/{lab}"),
        None => format!("../shared/corpus/labs/{lab}.json"),
    };
    let mut words = vec!["stability", &target, "--margins", "--format", "json"];
    if target.starts_with("../shared") {
        words.extend(["--models", "../shared/corpus/models"]);
    }
    if target.starts_with("../shared/corpus") {
        words.extend(["--until", "5"]);
    }
    let done = run_in(&workspace(), &words);
    serde_json::from_str(&done.stdout).unwrap_or_else(|_| panic!("{lab}: {}", done.stderr))
}

/// The reports of all labs in their order; two are computed at a time.
fn reports(labs: &[&str]) -> Vec<Json> {
    let half = |k: usize| labs.iter().skip(k).step_by(2).map(|lab| labspec_report(lab)).collect::<Vec<_>>();
    let (even, odd) = std::thread::scope(|scope| {
        let odd = scope.spawn(|| half(1));
        (half(0), odd.join().unwrap())
    });
    let (mut even, mut odd) = (even.into_iter(), odd.into_iter());
    (0..labs.len()).map(|i| if i % 2 == 0 { even.next() } else { odd.next() }.unwrap()).collect()
}

fn texts(list: &Json) -> BTreeSet<&str> {
    list.as_array().unwrap().iter().map(|x| x.as_str().unwrap()).collect()
}

/// Whether two settings are equal; JavaScript writes 0 where we write 0.0.
fn same(a: &Json, b: &Json) -> bool {
    match (a, b) {
        (Json::Number(a), Json::Number(b)) => a.as_f64() == b.as_f64(),
        (Json::Array(a), Json::Array(b)) => a.len() == b.len() && a.iter().zip(b).all(|(a, b)| same(a, b)),
        (Json::Object(a), Json::Object(b)) => {
            a.len() == b.len() && a.iter().all(|(k, v)| b.get(k).is_some_and(|w| same(v, w)))
        }
        _ => a == b,
    }
}

/// The results of the runs of a lab.
#[derive(Default)]
struct Count {
    runs: usize,
    /// Runs in which the library warns, and those of them for which we report a fault.
    warned: usize,
    heard: usize,
    /// Runs with a fault by the same criteria in the library, and here; and those with a fault only here.
    wrong: [usize; 2],
    alarms: usize,
}

/// Compares our runs with the library's; differences are added to `list`.
fn runs(lab: &str, recorded: &Json, computed: &Json, list: &mut Vec<String>) -> Count {
    let [there, here] = [recorded, computed].map(|x| x["runs"].as_array().unwrap());
    assert_eq!(
        there.len(),
        here.len(),
        "{lab}: the recording is of other runs: run tests/stability/theirs.mjs"
    );
    let mut count = Count { runs: here.len(), ..Count::default() };
    for (there, here) in there.iter().zip(here) {
        assert!(
            same(&there["setting"], &here["setting"]),
            "{lab}: a recording of other settings: {there} {here}"
        );
        let [mut a, b] = [there, here].map(|x| texts(&x["wrong"]));
        // The library warns of a control that is NaN or exceeds 1e10, but `watch.mjs` only inspects the state.
        if there["warnings"].get("badctrl").is_some() {
            a.insert("diverges");
        }
        // Faults without a criterion in `watch.mjs`; `sinksIn` corresponds to its permanent deep penetration.
        let other = ["engineWarns", "throws", "solverStopsEarly"];
        let renamed = b.into_iter().filter(|k| !other.contains(k));
        let b: BTreeSet<&str> = renamed.map(|k| if k == "sinksIn" { "penetration" } else { k }).collect();
        let warned = !there["warnings"].as_object().unwrap().is_empty();
        count.warned += usize::from(warned);
        count.heard += usize::from(warned && !texts(&here["wrong"]).is_empty());
        count.wrong[0] += usize::from(!a.is_empty());
        count.wrong[1] += usize::from(!b.is_empty());
        count.alarms += usize::from(a.is_empty() && !warned && !b.is_empty());
        if a != b || warned && b.is_empty() {
            list.push(format!(
                "{lab}, {}: MuJoCo {a:?} {}, labspec {b:?}",
                there["setting"], there["warnings"]
            ));
        }
    }
    count
}

/// A number with four significant digits or more.
fn short(x: Option<f64>) -> String {
    x.map_or("none".into(), |x| if (1e-3..1e4).contains(&x) { format!("{x:.4}") } else { format!("{x:.3e}") })
}

/// Margins side by side; those that differ are added to `far`.
fn margins(lab: &str, recorded: &Json, computed: &Json, far: &mut Vec<String>) -> (String, [usize; 2]) {
    let [there, here] = [recorded, computed].map(|x| x["margins"].as_array().unwrap());
    assert_eq!(
        there.len(),
        here.len(),
        "{lab}: the recording is of other margins: run tests/stability/theirs.mjs"
    );
    let (mut text, mut chances) = (String::new(), 0);
    for (a, b) in there.iter().zip(here) {
        let name =
            |m: &Json| format!("{} of {}", m["parameter"].as_str().unwrap(), m["subject"].as_str().unwrap());
        assert_eq!(name(a), name(b), "{lab}");
        let [x, y] = [a, b].map(|m| m["largest"].as_f64());
        let ratio = x.zip(y).map(|(x, y)| y / x);
        let bounded = [a, b].map(|m| m["breaks"].is_number());
        // If a perturbation of 1e-9 at the start changes the library's own margin, the margin is an interval.
        let ends = a["spread"].as_array().map(|s| [0, 1].map(|k| s[k].as_f64().unwrap()));
        let chance = ends.is_some_and(|[low, high]| high > CHANCE * low);
        let chatters = [&a["how"], &b["how"]["kind"]].iter().any(|how| **how == "chatter");
        let part = if chatters { CHATTERS } else { CLOSE };
        let close = match (x, y, ends) {
            _ if chance => true,
            (_, Some(y), Some([low, high])) => y >= low * (1.0 - part) && y <= high * (1.0 + part),
            (Some(x), Some(y), None) => (y / x - 1.0).abs() <= part && bounded[0] == bounded[1],
            (x, y, _) => x.is_none() && y.is_none(),
        };
        chances += usize::from(chance);
        if !close {
            far.push(format!("{lab}, {}: there {a}, here {b}", name(b)));
        }
        let largest =
            |x: Option<f64>, bounded: bool| if bounded { short(x) } else { format!("> {}", short(x)) };
        let _ = writeln!(
            text,
            "| {lab} | {} | {} | {} | {} | {} | {} |",
            name(b),
            ends.map_or(largest(x, bounded[0]), |[low, high]| format!(
                "{} to {}",
                short(Some(low)),
                short(Some(high))
            )),
            largest(y, bounded[1]),
            ratio.map_or("–".into(), |r| if chance { "chance".into() } else { format!("{r:.3}") }),
            a["how"].as_str().unwrap_or("–"),
            b["how"]["kind"].as_str().unwrap_or("–")
        );
    }
    (text, [there.len(), chances])
}

/// The subjects of the lines of a page; the last digits may come from another machine.
fn subjects(page: &str) -> Vec<String> {
    page.lines().map(|l| l.split('|').take(3).collect::<Vec<_>>().join("|")).collect()
}

#[test]
fn warnings_and_margins_agree_with_the_library() {
    let recorded = recording("stability_labs");
    let shared = needs("../shared/corpus");
    let all = recorded["labs"].as_array().unwrap();
    let from_course = |l: &&Json| {
        shared
            || l["lab"].as_str().unwrap().contains(".md#")
                && !l["lab"].as_str().unwrap().starts_with("lesson")
    };
    let labs: Vec<&Json> = sample(all.iter().filter(from_course).collect(), STEP);
    let names: Vec<&str> = labs.iter().map(|l| l["lab"].as_str().unwrap()).collect();
    let (mut differ, mut far) = (Vec::new(), Vec::new());
    let (mut table, mut largest, mut many) = (String::new(), String::new(), [0; 2]);
    let mut sum = Count::default();
    let mut row = |name: &str, c: &Count| {
        let _ = writeln!(
            table,
            "| {name} | {} | {} | {} | {} | {} | {} |",
            c.runs, c.warned, c.heard, c.wrong[0], c.wrong[1], c.alarms
        );
    };
    for ((lab, library_report), computed) in names.iter().zip(&labs).zip(reports(&names)) {
        let c = runs(lab, library_report, &computed, &mut differ);
        row(lab, &c);
        sum.runs += c.runs;
        sum.warned += c.warned;
        sum.heard += c.heard;
        sum.alarms += c.alarms;
        sum.wrong = [sum.wrong[0] + c.wrong[0], sum.wrong[1] + c.wrong[1]];
        let (text, number) = margins(lab, library_report, &computed, &mut far);
        largest.push_str(&text);
        many = [many[0] + number[0], many[1] + number[1]];
    }
    row("**all**", &sum);
    for line in differ.iter().chain(&far) {
        println!("{line}");
    }
    assert!(
        sum.warned >= minimum(8, STEP) && sum.wrong[0] >= minimum(20, STEP),
        "{} runs that warn, {} that go wrong",
        sum.warned,
        sum.wrong[0]
    );
    assert_eq!(sum.heard, sum.warned, "warnings that nobody hears:\n{}", differ.join("\n"));
    assert_eq!(sum.alarms, 0, "runs that are well there:\n{}", differ.join("\n"));
    assert!(far.is_empty(), "margins that are not the library's:\n{}", far.join("\n"));
    // The page is that of all labs.
    if !shared || !takes_all() {
        return;
    }
    let mut page = format!(
        "# Labs under a student's hands\n\n\
         `tests/under_hands.rs` writes this page. It compares every run that `labspec stability --margins` makes of a lab with MuJoCo 3.14.0 at the \
         same settings, where JavaScript runs the lab's programs (`tests/stability/theirs.mjs`). The labs are those of a public course and of a \
         first lesson, ten labs of our own that can be broken (`tests/stability/labs.md`), and twenty of as many kinds \
         (`tests/twenty/labs.md`).\n\nThe library warns in {} of {} runs, and labspec reports {} of these. The same criteria, implemented a second \
         time on the library's own numbers (`tests/stability/watch.mjs`), find a failure in {} runs of the library and in {} runs of labspec. {} \
         runs fail in labspec only, and in {} runs the failures differ. Of {} margins, each found by increasing and bisecting a value in runs of the \
         library (the lab as it stands, and with a small perturbation), {} differ by more than {} % from those of labspec (by more than half for the \
         contacts of a stack that chatter, because chatter depends on the residual of the solver at its tolerance); {} do not exist. If the library \
         finds a different margin for a perturbation that differs by a millionth of itself (with steps so long that chance decides whether a swing \
         breaks), the table lists the smallest and the largest of ten searches. If these differ by more than half, there is no margin, but \
         chance.\n\n\
         ## Runs\n\n\
         | lab | runs | MuJoCo warns | of these reported | MuJoCo fails | labspec fails | labspec only |\n|---|---:|---:|---:|---:|---:|---:|\n{table}",
        sum.warned,
        sum.runs,
        sum.heard,
        sum.wrong[0],
        sum.wrong[1],
        sum.alarms,
        differ.len(),
        many[0],
        far.len(),
        100.0 * CLOSE,
        many[1],
    );
    if !differ.is_empty() {
        page.push_str("\nRuns with different failures:\n\n");
        differ.iter().for_each(|line| page.push_str(&format!("* {line}\n")));
    }
    let _ = write!(
        page,
        "\n## Margins\n\n| lab | margin | MuJoCo | labspec | ratio | failure in MuJoCo | in labspec |\n|---|---|---:|---:|---:|---|---|\n{largest}"
    );
    let path = workspace().join("docs/measured/stability-labs.md");
    if std::env::var_os("LABSPEC_BLESS").is_some() {
        std::fs::write(&path, &page).unwrap();
    }
    assert_eq!(
        subjects(&std::fs::read_to_string(&path).unwrap_or_default()),
        subjects(&page),
        "docs/measured/stability-labs.md is stale: LABSPEC_BLESS=1 cargo test -p labspec-cli --test all what_the_library"
    );
}
