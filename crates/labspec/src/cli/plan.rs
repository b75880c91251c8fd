//! `labspec plan`.

use super::stdio::print_json;
use super::{Failure, ModelOptions, Outcome, print, target};
use crate::report::{printable, report};
use clap::ValueEnum;
use labspec_core::Plan;
use serde_json::{Value, json};
use std::fmt::Write;

/// Arguments of `plan`.
#[derive(clap::Args, Debug)]
pub(super) struct Arguments {
    /// LAB.json, LESSON.md#2, LESSON.md#quiz-id.1, or MODEL.xml
    lab: String,
    #[command(flatten)]
    models: ModelOptions,
    /// How to print
    #[arg(long, value_enum, default_value = "human")]
    format: Format,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum Format {
    Human,
    Json,
}

pub(super) fn plan(a: &Arguments) -> Result<Outcome, Failure> {
    let target = target::open(&a.lab, &a.models)?;
    let demand = &target.programs.demand;
    let plan = Plan::new(&target.model, demand);
    let list = |set: &labspec_core::reflect::FieldSet| -> Vec<&'static str> {
        set.iter().map(|f| f.info().name).collect()
    };
    match a.format {
        Format::Human => {
            let mut text = String::new();
            let names =
                |names: Vec<&str>| if names.is_empty() { "nothing".to_string() } else { names.join(", ") };
            let _ = writeln!(text, "reads   {}", names(list(&demand.reads)));
            let _ = writeln!(text, "writes  {}\n", names(list(&demand.writes)));
            for d in plan.decisions() {
                let _ = writeln!(
                    text,
                    "{}  {:<14} {}",
                    if d.keep { "keep " } else { "leave" },
                    stage(d.stage),
                    printable(&d.reason)
                );
            }
            let kept = plan.decisions().iter().filter(|d| d.keep).count();
            let _ = writeln!(text, "\n{kept} of {} stages run in every step", plan.decisions().len());
            print(&text)?;
        }
        Format::Json => {
            let stages: Vec<Value> = plan
                .decisions()
                .iter()
                .map(|d| json!({"stage": stage(d.stage), "keep": d.keep, "reason": d.reason}))
                .collect();
            let value =
                json!({"reads": list(&demand.reads), "writes": list(&demand.writes), "stages": stages});
            print_json(&report("plan", value), true)?;
        }
    }
    Ok(Outcome::Clean)
}

/// A stage's name in lower case with hyphens.
fn stage(stage: labspec_core::reflect::Stage) -> String {
    let mut name = String::new();
    for c in format!("{stage:?}").chars() {
        if c.is_uppercase() && !name.is_empty() {
            name.push('-');
        }
        name.extend(c.to_lowercase());
    }
    name
}
