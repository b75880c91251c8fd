//! `labspec plan`.

use super::common::{CommandOutcome, Failure, ModelOptions, interrupted};
use super::report_json::print_report;
use super::stdio::print;
use super::target;
use clap::ValueEnum;
use labspec::report::printable;
use labspec::verify::significant;
use labspec_core::reflect::FieldSet;
use labspec_numerics::profile::{
    EngineOption, PairSummary, PlanOptions, PlanReport, REPEATS, SensorRow, StageCost, name,
};
use serde::Serialize;
use std::fmt::Write;

/// Arguments of `plan`.
#[derive(clap::Args, Debug)]
pub(super) struct PlanArguments {
    /// LAB.json, LESSON.md#2, LESSON.md#quiz-id.1, or MODEL.xml
    lab: String,
    #[command(flatten)]
    models: ModelOptions,
    /// Show the cost of one more reader: a field (data.sensordata), a sensor, or an expression
    #[arg(long, value_name = "NAME")]
    read: Vec<String>,
    /// Only make the plan; do not run or measure
    #[arg(long)]
    no_run: bool,
    /// Output format
    #[arg(long, value_enum, default_value = "human")]
    format: PlanFormat,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum PlanFormat {
    Human,
    Json,
}

pub(super) fn plan(a: &PlanArguments) -> Result<CommandOutcome, Failure> {
    let target = target::open(&a.lab, &a.models)?;
    let options = PlanOptions { read: a.read.clone(), run: !a.no_run };
    let report = labspec_numerics::profile::plan(&target.lab, &target.model, &target.programs, &options)
        .map_err(|e| e.to_string())?;
    match a.format {
        PlanFormat::Human => print(&human(&report))?,
        PlanFormat::Json => print_report("plan", &machine(&report))?,
    }
    Ok(CommandOutcome::Clean)
}

fn names(set: &FieldSet) -> Vec<&'static str> {
    set.iter().map(|f| f.info().name).collect()
}

/// Formats nanoseconds with the precision of the measurement.
fn ns(x: f64) -> String {
    if x.abs() < 10.0 { format!("{x:.1}") } else { format!("{x:.0}") }
}

fn percent(share: f64) -> String {
    format!("{:.0} %", 100.0 * share)
}

fn human(report: &PlanReport) -> String {
    let mut text = String::new();
    let list = |names: Vec<&str>| if names.is_empty() { "nothing".to_string() } else { names.join(", ") };
    let _ = writeln!(text, "reads   {}", list(names(&report.access.reads)));
    let _ = writeln!(text, "writes  {}\n", list(names(&report.access.writes)));
    let measured = report.step.is_some();
    if measured {
        let _ = writeln!(text, "{:20} {:>6} {:>8}", "", "share", "ns");
    }
    let mut row = |verb: &str, name: &str, share: String, ns: String, reason: &str| {
        let _ = match measured {
            true => writeln!(text, "{verb:<5}  {name:<14} {share:>5} {ns:>8}  {}", printable(reason)),
            false => writeln!(text, "{verb:<5}  {name:<14} {}", printable(reason)),
        };
    };
    let costs = |cost: Option<StageCost>| {
        cost.map_or((String::new(), String::new()), |c| (percent(c.share), ns(c.ns)))
    };
    for r in &report.rows {
        let (share, time) = match r.forced {
            Some(more) => (String::new(), format!("(+{})", ns(more))),
            None => costs(r.cost),
        };
        row(if r.keep { "keep" } else { "leave" }, &name(r.stage), share, time, &r.reason);
    }
    if let Some(step) = &report.step {
        let (share, time) = costs(Some(step.integrator));
        row("", "integrator", share, time, "the next state, the test for NaN, and what a run looks after");
        if let Some(when) = report.controller {
            let (share, time) = costs(step.controller);
            row("", "controller", share, time, when);
        }
    }
    let running = report.rows.iter().filter(|r| r.keep).count();
    let _ = writeln!(text, "\n{running} of {} stages run in every step", report.rows.len());
    if let Some(step) = &report.step {
        let [low, high] = step.quartiles;
        let _ = writeln!(
            text,
            "a step takes {} ns ({} to {}); with everything read, it takes {} ns",
            ns(step.ns),
            ns(low),
            ns(high),
            ns(step.full)
        );
        let _ = writeln!(
            text,
            "measured over {} steps of the run of this lab, {REPEATS} times in turn; in brackets: the cost of a stage that does not run",
            step.steps
        );
    }
    parts(report, &mut text);
    readers(report, &mut text);
    if interrupted() {
        text.push_str("stopped by Ctrl-C: times cover what was finished\n");
    }
    text
}

/// Writes pairs of geoms, the solver, the integrator, and tree algorithms.
fn parts(report: &PlanReport, text: &mut String) {
    let pairs = &report.pairs;
    let _ = writeln!(text, "\npairs of geoms  {} of {} can touch", pairs.can_touch, pairs.all);
    for (shapes, n, searched) in &pairs.tests {
        let how = if *searched { "found by the general algorithm" } else { "in closed form" };
        let _ = writeln!(text, "  keep   {n:>5}  {} and {}, {how}", shapes[0], shapes[1]);
    }
    for (reason, n) in &pairs.excluded {
        let _ = writeln!(text, "  leave  {n:>5}  {reason}");
    }
    if let Some(seen) = pairs.seen.filter(|_| pairs.can_touch > 0) {
        let both = |[mean, most]: [f64; 2]| format!("{} in the mean, {most} at most", significant(mean));
        let _ = writeln!(text, "  bounds within reach  {}", both(seen.in_reach));
        let _ = writeln!(text, "  contacts             {}", both(seen.contacts));
    }
    sensors(report, text);
    list("solver", &report.solvers, text);
    if report.solvers.iter().any(|s| s.keep) {
        let _ = writeln!(text, "  cone {}", report.cone);
        if let Some(seen) = pairs.seen {
            let [rows, most] = seen.rows;
            let [iterations, hardest] = seen.iterations;
            let _ = writeln!(
                text,
                "  rows {} in the mean, {most} at most; iterations {}, {hardest}",
                significant(rows),
                significant(iterations)
            );
        }
    }
    list("integrator", &report.integrators, text);
    tree_algorithms(report, text);
}

/// Writes the sensors; equal ones share a line.
fn sensors(report: &PlanReport, text: &mut String) {
    if report.sensors.is_empty() {
        return;
    }
    let computed = report.sensors.iter().filter(|s| s.keep).count();
    let _ = writeln!(text, "\nsensors  {computed} of {} are computed", report.sensors.len());
    let mut left: Vec<_> = report.sensors.iter().collect();
    while let Some(first) = left.first().copied() {
        let (alike, others): (Vec<_>, Vec<_>) = left.into_iter().partition(|s| s.reason == first.reason);
        let names: Vec<&str> = alike.iter().map(|s| s.name.as_str()).collect();
        let verb = if first.keep { "keep " } else { "leave" };
        let _ = writeln!(text, "  {verb}  {}: {}", printable(&names.join(", ")), first.reason);
        left = others;
    }
}

/// Writes the tree algorithms in use.
fn tree_algorithms(report: &PlanReport, text: &mut String) {
    let _ = writeln!(text, "\ntree algorithms");
    for algorithm in report.tree_algorithms.iter().filter(|w| w.trees != [0; 3]) {
        let [places, forces, factors] = algorithm.trees;
        let parts = [(places, "places"), (forces, "forces"), (factors, "accelerations")];
        let parts: Vec<String> =
            parts.iter().filter(|(n, _)| *n > 0).map(|(n, what)| format!("{what} of {n}")).collect();
        let _ = writeln!(text, "  keep   {}: {}", algorithm.name, parts.join(", "));
    }
    let idle = report.tree_algorithms.iter().filter(|w| w.trees == [0; 3]).map(|w| w.name);
    let idle = idle.collect::<Vec<_>>().join(", ");
    if !idle.is_empty() {
        let _ = writeln!(text, "  leave  {idle}: no tree takes them");
    }
}

/// Writes the options in use, then the others by reason.
fn list(what: &str, codes: &[EngineOption], text: &mut String) {
    let _ = writeln!(text, "\n{what}");
    for verb in ["keep ", "leave"] {
        let mut codes: Vec<&EngineOption> = codes.iter().filter(|c| c.keep == (verb == "keep ")).collect();
        while let Some(first) = codes.first().copied() {
            let alike = codes.iter().filter(|c| c.reason == first.reason).map(|c| c.name);
            let alike = alike.collect::<Vec<_>>().join(", ");
            let _ = writeln!(text, "  {verb}  {alike}: {}", first.reason);
            codes.retain(|c| c.reason != first.reason);
        }
    }
}

/// Writes the cost of additional readers.
fn readers(report: &PlanReport, text: &mut String) {
    if report.readers.is_empty() {
        return;
    }
    let _ = writeln!(text, "\none more reader");
    for reader in &report.readers {
        let cost = match (reader.cost, &report.step) {
            (Some(more), Some(step)) => format!("{:+.0} ns, {:+.0} %", more, 100.0 * more / step.ns),
            _ => String::new(),
        };
        let joins: Vec<String> = reader.joins.iter().map(|s| name(*s)).collect();
        let joins =
            if joins.is_empty() { "no stage joins".into() } else { format!("joins {}", joins.join(", ")) };
        let _ = writeln!(
            text,
            "  {}  {cost}{}{joins}",
            printable(&reader.text),
            if cost.is_empty() { "" } else { "  " }
        );
    }
}

/// The plan of a lab for programs.
#[derive(Serialize)]
struct PlanOutput<'a> {
    reads: Vec<&'static str>,
    writes: Vec<&'static str>,
    stages: Vec<PlanStageRow<'a>>,
    step: Option<Step>,
    pairs: PairRow<'a>,
    sensors: &'a [SensorRow],
    solver: SolverRow<'a>,
    integrators: &'a [EngineOption],
    #[serde(rename = "ways")]
    tree_algorithms: Vec<TreeAlgorithmRow>,
    readers: Vec<ReaderRow<'a>>,
}

/// A stage: its share of a step, its time in ns, its work in units of the engine.
#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
struct PlanStageRow<'a> {
    stage: String,
    keep: bool,
    reason: &'a str,
    share: Option<f64>,
    ns: Option<f64>,
    work: Option<f64>,
    forced_ns: Option<f64>,
}

/// The cost of a step in ns: the median and the quartiles of the repetitions, and the median with everything read.
#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
struct Step {
    steps: usize,
    ns: f64,
    low_ns: f64,
    high_ns: f64,
    full_ns: f64,
    work: f64,
    integrator: CostRow,
    controller: Option<CostRow>,
}

/// A share of a step, and the time in ns.
#[derive(Serialize)]
struct CostRow {
    share: f64,
    ns: f64,
    /// When the lab's controller runs.
    #[serde(skip_serializing_if = "Option::is_none")]
    reason: Option<&'static str>,
}

#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
struct PairRow<'a> {
    all: usize,
    can_touch: usize,
    tests: Vec<SearchTest<'a>>,
    #[serde(rename = "leftOut")]
    excluded: Vec<ExcludedPairs>,
    in_reach: Option<MeanAndMaximum>,
    contacts: Option<MeanAndMaximum>,
}

#[derive(Serialize)]
struct SearchTest<'a> {
    shapes: &'a [&'static str; 2],
    pairs: usize,
    searched: bool,
}

#[derive(Serialize)]
struct ExcludedPairs {
    reason: &'static str,
    pairs: usize,
}

/// The mean and the maximum of a count.
#[derive(Serialize)]
struct MeanAndMaximum {
    mean: f64,
    most: f64,
}

#[derive(Serialize)]
struct SolverRow<'a> {
    cone: &'static str,
    methods: &'a [EngineOption],
    rows: Option<MeanAndMaximum>,
    iterations: Option<MeanAndMaximum>,
}

/// The number of trees that an algorithm computes.
#[derive(Serialize)]
struct TreeAlgorithmRow {
    name: &'static str,
    places: usize,
    forces: usize,
    accelerations: usize,
}

/// An additional reader: the additional time of a step in ns, and as a share of it.
#[derive(Serialize)]
struct ReaderRow<'a> {
    read: &'a str,
    joins: Vec<String>,
    ns: Option<f64>,
    share: Option<f64>,
}

fn cost(cost: StageCost, reason: Option<&'static str>) -> CostRow {
    CostRow { share: cost.share, ns: cost.ns, reason }
}

fn mean_and_maximum([mean, most]: [f64; 2]) -> MeanAndMaximum {
    MeanAndMaximum { mean, most }
}

fn pair_row(summary: &PairSummary) -> PairRow<'_> {
    let tests = summary.tests.iter();
    let excluded = summary.excluded.iter();
    PairRow {
        all: summary.all,
        can_touch: summary.can_touch,
        tests: tests
            .map(|(shapes, pairs, searched)| SearchTest { shapes, pairs: *pairs, searched: *searched })
            .collect(),
        excluded: excluded.map(|&(reason, pairs)| ExcludedPairs { reason, pairs }).collect(),
        in_reach: summary.seen.map(|s| mean_and_maximum(s.in_reach)),
        contacts: summary.seen.map(|s| mean_and_maximum(s.contacts)),
    }
}

fn machine(report: &PlanReport) -> PlanOutput<'_> {
    let stages = report.rows.iter().map(|r| PlanStageRow {
        stage: name(r.stage),
        keep: r.keep,
        reason: &r.reason,
        share: r.cost.map(|c| c.share),
        ns: r.cost.map(|c| c.ns),
        work: r.cost.map(|c| c.work),
        forced_ns: r.forced,
    });
    let step = report.step.as_ref().map(|s| Step {
        steps: s.steps,
        ns: s.ns,
        low_ns: s.quartiles[0],
        high_ns: s.quartiles[1],
        full_ns: s.full,
        work: s.work,
        integrator: cost(s.integrator, None),
        controller: s.controller.map(|c| cost(c, report.controller)),
    });
    let tree_algorithms = report.tree_algorithms.iter().map(|w| {
        let [places, forces, accelerations] = w.trees;
        TreeAlgorithmRow { name: w.name, places, forces, accelerations }
    });
    let readers = report.readers.iter().map(|r| ReaderRow {
        read: &r.text,
        joins: r.joins.iter().map(|s| name(*s)).collect(),
        ns: r.cost,
        share: r.cost.zip(report.step.as_ref()).map(|(more, step)| more / step.ns),
    });
    let seen = report.pairs.seen;
    PlanOutput {
        reads: names(&report.access.reads),
        writes: names(&report.access.writes),
        stages: stages.collect(),
        step,
        pairs: pair_row(&report.pairs),
        sensors: &report.sensors,
        solver: SolverRow {
            cone: report.cone,
            methods: &report.solvers,
            rows: seen.map(|s| mean_and_maximum(s.rows)),
            iterations: seen.map(|s| mean_and_maximum(s.iterations)),
        },
        integrators: &report.integrators,
        tree_algorithms: tree_algorithms.collect(),
        readers: readers.collect(),
    }
}
