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
    CONES, EngineOption, PairSummary, PlanOptions, PlanReport, REPEATS, SensorRow, StageCost, name,
};
use schemars::JsonSchema;
use serde::Serialize;
use std::fmt::Write;

/// Arguments of `plan`.
#[derive(clap::Args, Debug)]
pub(super) struct PlanArguments {
    /// LAB.json, LESSON.md#2, LESSON.md#quiz-id.1, or MODEL.xml
    lab: String,
    #[command(flatten)]
    models: ModelOptions,
    /// Show the cost of reading one more value: a field (data.sensordata), a sensor, or an expression
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

/// What counts as the work of the integrator.
const OF_INTEGRATOR: &str = "the next state, the test for NaN, and the work of the run between steps";

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
        row(if r.keep { "keep" } else { "skip" }, &name(r.stage), share, time, &r.reason);
    }
    if let Some(step) = &report.step {
        let (share, time) = costs(Some(step.integrator));
        row("", "integrator", share, time, OF_INTEGRATOR);
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
        let _ = writeln!(text, "  skip   {n:>5}  {reason}");
    }
    if let Some(seen) = pairs.seen.filter(|_| pairs.can_touch > 0) {
        let both = |[mean, most]: [f64; 2]| format!("{} on average, {most} at most", significant(mean));
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
                "  rows: {} on average, {most} at most; iterations: {} on average, {hardest} at most",
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
        let verb = if first.keep { "keep " } else { "skip " };
        let _ = writeln!(text, "  {verb}  {}: {}", printable(&names.join(", ")), first.reason);
        left = others;
    }
}

/// Writes the tree algorithms in use.
fn tree_algorithms(report: &PlanReport, text: &mut String) {
    let _ = writeln!(text, "\ntree algorithms");
    for algorithm in report.tree_algorithms.iter().filter(|w| w.trees != [0; 3]) {
        let [places, forces, factors] = algorithm.trees;
        let parts = [(places, "poses"), (forces, "forces"), (factors, "accelerations")];
        let parts: Vec<String> =
            parts.iter().filter(|(n, _)| *n > 0).map(|(n, what)| format!("{what} of {n}")).collect();
        let _ = writeln!(text, "  keep   {}: {}", algorithm.name, parts.join(", "));
    }
    let idle = report.tree_algorithms.iter().filter(|w| w.trees == [0; 3]).map(|w| w.name);
    let idle = idle.collect::<Vec<_>>().join(", ");
    if !idle.is_empty() {
        let _ = writeln!(text, "  skip   {idle}: no tree uses them");
    }
}

/// Writes the options in use, then the others by reason.
fn list(what: &str, codes: &[EngineOption], text: &mut String) {
    let _ = writeln!(text, "\n{what}");
    for verb in ["keep ", "skip "] {
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

/// Which stages of the engine a lab or a model needs, why, and what they cost. Times are measured: they differ from run to run; with
/// --no-run nothing is run, and what would be seen in a run is null.
#[derive(Serialize, JsonSchema)]
pub(super) struct PlanOutput<'a> {
    /// Fields that are read, by MuJoCo's names.
    reads: Vec<&'static str>,
    /// Fields that are written.
    writes: Vec<&'static str>,
    /// Every stage, in the order of a step.
    stages: Vec<PlanStageRow<'a>>,
    /// What a step of the lab's own run costs; null where nothing was run.
    step: Option<Step>,
    /// The pairs of geoms.
    pairs: PairRow<'a>,
    /// Every sensor of the model, in model order. A sensor whose values are not read is not computed.
    sensors: &'a [SensorRow],
    /// The constraint solver.
    solver: SolverRow<'a>,
    /// The integrators.
    integrators: &'a [EngineOption],
    /// The tree algorithms, and the number of trees that use each.
    #[serde(rename = "ways")]
    tree_algorithms: Vec<TreeAlgorithmRow>,
    /// The cost of each additional reader (`--read`); with several, the last row is the cost of all of them together.
    readers: Vec<ReaderRow<'a>>,
}

/// A stage.
#[derive(Serialize, JsonSchema)]
#[serde(rename_all = "camelCase")]
#[schemars(rename = "stage")]
struct PlanStageRow<'a> {
    /// Its name.
    stage: String,
    /// It runs in every step.
    keep: bool,
    /// Why, or why not.
    reason: &'a str,
    /// Its share of the time of a step, from 0 to 1; null if it does not run.
    share: Option<f64>,
    /// Its nanoseconds of a step.
    ns: Option<f64>,
    /// The work of a step that it counts itself, in units of about a nanosecond: the same on every machine.
    work: Option<f64>,
    /// What a step would take longer if it ran with all that it uses, in nanoseconds, as the difference of two measured runs; null where
    /// it runs.
    forced_ns: Option<f64>,
}

/// What a step of the lab's own run costs.
#[derive(Serialize, JsonSchema)]
#[serde(rename_all = "camelCase")]
struct Step {
    /// The steps that were measured, from the start on.
    #[schemars(range(min = 1))]
    steps: usize,
    /// Nanoseconds of a step: the median of the repeats.
    ns: f64,
    /// The first quartile of the repeats, in nanoseconds.
    low_ns: f64,
    /// The third quartile of the repeats, in nanoseconds.
    high_ns: f64,
    /// Nanoseconds of a step that computes every field.
    full_ns: f64,
    /// The work of a step as the engine counts it: the same on every machine.
    work: f64,
    /// The next state, the test for NaN, and the work of the run between steps.
    integrator: CostRow,
    /// The lab's own program before the steps; null where it has none.
    controller: Option<ControllerRow>,
}

/// What something costs.
#[derive(Serialize, JsonSchema)]
struct CostRow {
    /// Its part of a step, of one.
    share: f64,
    /// Nanoseconds of a step.
    ns: f64,
}

/// What the lab's own program costs.
#[derive(Serialize, JsonSchema)]
struct ControllerRow {
    /// Its part of a step, of one.
    share: f64,
    /// Nanoseconds of a step.
    ns: f64,
    /// When it runs.
    reason: &'static str,
}

/// The pairs of geoms.
#[derive(Serialize, JsonSchema)]
#[serde(rename_all = "camelCase")]
#[schemars(rename = "pairs")]
struct PairRow<'a> {
    /// All pairs that there are.
    all: usize,
    /// Those that can ever touch.
    can_touch: usize,
    /// How those that can touch are tested.
    tests: Vec<SearchTest<'a>>,
    /// Those that cannot.
    #[serde(rename = "leftOut")]
    excluded: Vec<ExcludedPairs>,
    /// Pairs of a step whose bounds are within reach of each other: the others cost one comparison.
    in_reach: Option<MeanAndMaximum>,
    /// Contacts of a step.
    contacts: Option<MeanAndMaximum>,
}

/// Pairs of two shapes.
#[derive(Serialize, JsonSchema)]
struct SearchTest<'a> {
    /// The two.
    shapes: &'a [&'static str; 2],
    /// How many.
    #[schemars(range(min = 1))]
    pairs: usize,
    /// Contacts are searched for by the general algorithm of convex shapes, not found in closed form.
    searched: bool,
}

/// Pairs that are left out for one reason.
#[derive(Serialize, JsonSchema)]
struct ExcludedPairs {
    /// Why they never touch.
    reason: &'static str,
    /// How many.
    #[schemars(range(min = 1))]
    pairs: usize,
}

/// A number of each step.
#[derive(Serialize, JsonSchema)]
struct MeanAndMaximum {
    /// In the mean of the steps.
    mean: f64,
    /// In the step with most.
    most: f64,
}

/// The constraint solver.
#[derive(Serialize, JsonSchema)]
struct SolverRow<'a> {
    /// The cone of friction.
    #[schemars(extend("enum" = CONES))]
    cone: &'static str,
    /// Its methods.
    methods: &'a [EngineOption],
    /// Rows of constraints of a step.
    rows: Option<MeanAndMaximum>,
    /// Iterations of a step.
    iterations: Option<MeanAndMaximum>,
}

/// A way of computing trees.
#[derive(Serialize, JsonSchema)]
struct TreeAlgorithmRow {
    /// Its name.
    name: &'static str,
    /// Trees that take it for where their bodies are.
    places: usize,
    /// For their inertia and forces.
    forces: usize,
    /// For their accelerations.
    accelerations: usize,
}

/// A further reader.
#[derive(Serialize, JsonSchema)]
struct ReaderRow<'a> {
    /// As it was asked for.
    read: &'a str,
    /// Stages that run with it and not without.
    joins: Vec<String>,
    /// What a step takes longer, in nanoseconds; null where nothing was run.
    ns: Option<f64>,
    /// The same as a part of the step without it, of one.
    share: Option<f64>,
}

fn cost(cost: StageCost) -> CostRow {
    CostRow { share: cost.share, ns: cost.ns }
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
        integrator: cost(s.integrator),
        controller: s.controller.zip(report.controller).map(|(cost, reason)| ControllerRow {
            share: cost.share,
            ns: cost.ns,
            reason,
        }),
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
