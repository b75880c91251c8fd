//! `labspec stability`.

use super::stdio::print_json;
use super::{Failure, ModelOptions, Outcome, complain, interrupted, print, target};
use crate::bind::Programs;
use crate::report::{key, printable, set_number};
use crate::run::two_digits;
use crate::stability::{Evidence, Fault, Found, Handling, Options, Report, probe};
use clap::ValueEnum;
use serde_json::{Value, json};
use std::fmt::Write;
use std::io::IsTerminal;

/// Arguments of `stability`.
#[derive(clap::Args, Debug)]
pub(super) struct Arguments {
    /// LAB.json, LESSON.md#2, LESSON.md#quiz-id.1, or MODEL.xml
    lab: String,
    #[command(flatten)]
    models: ModelOptions,
    /// Length of each run in seconds [default: ten times the lab's stopAt or the window of its plots]
    #[arg(long, value_name = "S")]
    until: Option<f64>,
    /// How to print
    #[arg(long, value_enum, default_value = "human")]
    format: Format,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Format {
    Human,
    Json,
}

pub(super) fn stability(a: &Arguments) -> Result<Outcome, Failure> {
    let target = target::open(&a.lab, &a.models)?;
    let options = Options { until: a.until };
    let progress = a.format == Format::Human && std::io::stderr().is_terminal();
    let mut tell = |text: &str| {
        if progress {
            complain(&format!("\r\x1b[K{text}"));
        }
    };
    let report = probe(&target.lab, &target.model, &target.programs, &options, &mut tell).map_err(|e| e.0);
    if progress {
        complain("\r\x1b[K");
    }
    let report = report?;
    match a.format {
        Format::Human => print(&human(&report, &target.programs))?,
        Format::Json => print_json(&value(&report, &target.programs), true)?,
    }
    Ok(if report.fine() { Outcome::Clean } else { Outcome::Findings })
}

fn human(report: &Report, programs: &Programs) -> String {
    let mut text = String::new();
    let runs: usize = report.tried.iter().map(|t| t.made + t.cut).sum();
    let kinds: Vec<String> =
        report.tried.iter().map(|t| format!("{} {}", t.made + t.cut, t.kind.words())).collect();
    let _ = writeln!(
        text,
        "{runs} run{} of {} s: {}.",
        if runs == 1 { "" } else { "s" },
        crate::verify::significant(report.length),
        kinds.join(", ")
    );
    for found in &report.found {
        finding(found, programs, &mut text);
    }
    for line in left_out(report) {
        let _ = writeln!(text, "Not tried: {line}.");
    }
    if report.found.is_empty() {
        text.push_str("Nothing went wrong.\n");
    }
    if interrupted() {
        text.push_str("stopped by Ctrl-C: what stands above are the runs that were finished\n");
    }
    text
}

fn finding(found: &Found, programs: &Programs, text: &mut String) {
    let Found { fault, handling, settings, worst, expected } = found;
    let expected = if *expected { " (as the lab says it does)" } else { "" };
    let _ = writeln!(
        text,
        "\n{}{expected}: {}, at t = {} s, {}",
        fault.kind.words(),
        printable(&fault.who),
        crate::run::time(fault.time),
        printable(&handling.words(programs))
    );
    let _ = writeln!(text, "  {}", measured(fault));
    let _ = writeln!(text, "  cause: {}", printable(&fault.cause));
    if *settings > 1 {
        let _ = write!(text, "  also in {} other settings", settings - 1);
        let _ = match worst {
            Some((handling, fault)) => {
                writeln!(text, "; worst {}: {}", printable(&handling.words(programs)), measured(fault))
            }
            None => writeln!(text),
        };
    }
}

/// The evidence in a line.
fn measured(fault: &Fault) -> String {
    let one = |e: &Evidence| {
        let unit = if e.unit.is_empty() { String::new() } else { format!(" {}", e.unit) };
        format!("{} {}{unit}", e.name, two_digits(e.value))
    };
    fault.evidence.iter().map(one).collect::<Vec<_>>().join(", ")
}

/// Everything that was not tried, or not to its end.
fn left_out(report: &Report) -> Vec<String> {
    let mut list = Vec::new();
    for t in &report.tried {
        if t.left_out > 0 {
            list.push(format!("{} of {}", t.left_out, t.kind.words()));
        }
    }
    let cut: usize = report.tried.iter().map(|t| t.cut).sum();
    if let Some(shortest) = report.shortest {
        list.push(format!(
            "the end of {cut} run{}, which took more work than they may; the shortest covers {} s",
            if cut == 1 { "" } else { "s" },
            two_digits(shortest)
        ));
    }
    if report.pairs_left_out > 0 {
        list.push(format!("{} pairs of settings, as there are too many", report.pairs_left_out));
    }
    list.extend(report.left_out.iter().cloned());
    list
}

fn value(report: &Report, programs: &Programs) -> Value {
    let tried = |t: &crate::stability::Tried| json!({"kind": key(t.kind.words()), "made": t.made, "cut": t.cut, "leftOut": t.left_out});
    let found: Vec<Value> = report.found.iter().map(|f| found_value(f, programs)).collect();
    crate::report::report(
        "stability",
        json!({
            "length": report.length,
            "tried": report.tried.iter().map(tried).collect::<Vec<_>>(),
            "shortest": report.shortest,
            "pairsLeftOut": report.pairs_left_out,
            "leftOut": left_out(report),
            "findings": found,
            "work": report.work,
            "fine": report.fine(),
        }),
    )
}

fn found_value(found: &Found, programs: &Programs) -> Value {
    let mut value = fault_value(&found.fault);
    value["setting"] = handling_value(&found.handling, programs);
    value["settings"] = json!(found.settings);
    value["expected"] = json!(found.expected);
    value["worst"] = found.worst.as_ref().map_or(Value::Null, |(handling, fault)| {
        let mut value = fault_value(fault);
        value["setting"] = handling_value(handling, programs);
        value
    });
    value
}

fn fault_value(fault: &Fault) -> Value {
    let evidence = |e: &Evidence| {
        let mut value = json!({"name": e.name});
        set_number(&mut value, "value", e.value);
        value["unit"] = json!(e.unit);
        value
    };
    json!({
        "kind": key(fault.kind.words()), "time": fault.time, "who": fault.who, "cause": fault.cause,
        "evidence": fault.evidence.iter().map(evidence).collect::<Vec<_>>(),
    })
}

/// What a student does: a list of changes, each with its time.
fn handling_value(handling: &Handling, programs: &Programs) -> Value {
    let label = |i: usize| programs.controls.get(i).map_or("", |(label, _)| label.as_str());
    let one = |a: &crate::stability::Action| {
        let value = a.value.as_ref().map_or(Value::Null, |v| match v {
            labspec_expr::Value::Number(x) => json!(x),
            labspec_expr::Value::Boolean(b) => json!(b),
            other => json!(other.to_string()),
        });
        json!({"control": label(a.control), "time": a.time, "value": value})
    };
    handling.actions.iter().map(one).collect()
}
