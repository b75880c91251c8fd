//! `labspec record` and `labspec bench`, for engineers of labspec. The crate `labspec-developer` implements them.

use super::common::{CommandOutcome, Failure, ModelOptions};
use super::stdio::print_json;
use super::target;
use labspec::report::report;
use labspec_developer::{bench, record};
use std::path::PathBuf;

/// Arguments of `record`.
#[derive(clap::Args, Debug)]
pub(super) struct RecordArguments {
    /// MODEL.xml
    model: PathBuf,
    #[command(flatten)]
    models: ModelOptions,
    #[command(flatten)]
    options: record::RecordOptions,
}

/// Arguments of `bench`.
#[derive(clap::Args, Debug)]
pub(super) struct BenchArguments {
    /// MODEL.xml, or a lab as for `run`
    lab: String,
    #[command(flatten)]
    models: ModelOptions,
    #[command(flatten)]
    options: bench::BenchOptions,
}

pub(super) fn record(a: &RecordArguments) -> Result<CommandOutcome, Failure> {
    let model = target::load_model(&a.model, &a.models)?;
    let recording = record::record(model, &a.options)?;
    let value = serde_json::to_value(recording).map_err(|e| e.to_string())?;
    print_json(&report("record", value), false)?;
    Ok(CommandOutcome::Clean)
}

pub(super) fn bench(a: &BenchArguments) -> Result<CommandOutcome, Failure> {
    let target = target::open(&a.lab, &a.models)?;
    let time = bench::measure_steps(&target.lab, &target.model, &target.programs, &a.options);
    let value = serde_json::to_value(time).map_err(|e| e.to_string())?;
    print_json(&report("bench", value), false)?;
    Ok(CommandOutcome::Clean)
}
