//! `labspec run`.

use super::common::{CommandOutcome, Failure};
use super::lab_args::LabArguments;
use super::output::write_file;
use super::output::{PlannedOutput, requested_outputs, write_png, write_with};
use super::output_kind::OutputKind;
use super::stdio::print;
use super::stdio::stream;
use super::target::LabTarget;
use clap::ValueEnum;
use labspec::report::{printable, printable_path};
use labspec::run::{Cell, RunOptions, Table, final_values, rounded};
use labspec::spec::Lab;
use labspec::stress::{self, ComparedRun};
use labspec_plot::line_chart;
use labspec_site::chart;
use std::borrow::Cow;
use std::fmt::Write;
use std::path::{Path, PathBuf};

/// Arguments of `run`.
#[derive(clap::Args, Debug)]
pub(super) struct RunArguments {
    #[command(flatten)]
    handled: LabArguments,
    /// Length in seconds [default: the lab's stopAt, or 2]
    #[arg(long, value_name = "S")]
    until: Option<f64>,
    /// Length in steps
    #[arg(long, value_name = "N", conflicts_with = "until")]
    steps: Option<usize>,
    /// Sample after every K steps
    #[arg(long, value_name = "K", default_value_t = 1)]
    every: usize,
    /// Compute every field in every step, read or not, as MuJoCo does. The results are the same; the run takes longer
    #[arg(long)]
    full: bool,
    /// Output format
    #[arg(long, value_enum, default_value = "human")]
    format: RunFormat,
    /// Write all samples as comma-separated values
    #[arg(long, value_name = "FILE")]
    csv: Option<PathBuf>,
    /// Write all samples as JSON
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
    /// Write the plots; further plots go to FILE-2.svg, FILE-3.svg, …; into a folder as plot-1.svg, plot-2.svg, …
    #[arg(long, value_name = "FILE|DIR/")]
    svg: Option<PathBuf>,
    /// Write the plots as PNG
    #[arg(long, value_name = "FILE|DIR/")]
    png: Option<PathBuf>,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum RunFormat {
    /// Readouts at the end of the run
    Human,
    /// All samples as JSON
    Json,
    /// All samples as comma-separated values
    Csv,
}

pub(super) fn run(a: &RunArguments) -> Result<CommandOutcome, Failure> {
    let target = a.handled.open()?;
    let options = RunOptions {
        until: a.until,
        steps: a.steps,
        every: a.every,
        set: a.handled.set(&target.lab)?,
        press: a.handled.press(&target.lab)?,
        full: a.full,
    };
    let plots = |file: &Option<PathBuf>, option| {
        file.as_ref()
            .map(|file| plot_files(&target.lab, file, option))
            .transpose()
            .map(Option::unwrap_or_default)
    };
    let (drawn, painted) = (plots(&a.svg, "svg")?, plots(&a.png, "png")?);
    let mut files = requested_outputs(&[(OutputKind::Table, &a.csv), (OutputKind::Run, &a.json)]);
    files.extend(drawn.iter().map(|path| PlannedOutput { kind: OutputKind::Plot, path: path.clone() }));
    files.extend(painted.iter().map(|path| PlannedOutput { kind: OutputKind::Picture, path: path.clone() }));
    a.handled.check_outputs_writable(&target, &files)?;
    let LabTarget { lab, model, programs } = &target;
    let compared = stress::compared_runs(lab, model, programs, &options).map_err(|e| e.to_string())?;
    // What is written has a column for each integrator; what is printed is a table of them.
    let (lab, table) = match &compared {
        Some(runs) => stress::join_runs(lab, runs),
        None => {
            (lab.clone(), stress::watched_run(lab, model, programs, &options).map_err(|e| e.to_string())?)
        }
    };
    if let Some(file) = &a.csv {
        write_with(file, OutputKind::Table, |out| table.write_csv(out))?;
    }
    if let Some(file) = &a.json {
        write_with(file, OutputKind::Run, |out| table.write_json(out).and_then(|()| out.write_all(b"\n")))?;
    }
    let picture = |(i, plot)| line_chart(&chart(&lab, plot, i, &table));
    let pictures = || lab.plots.iter().enumerate().map(picture);
    for (svg, file) in pictures().zip(&drawn) {
        write_file(file, OutputKind::Plot, &svg)?;
    }
    for (svg, file) in pictures().zip(&painted) {
        write_png(file, &svg)?;
    }
    match a.format {
        RunFormat::Human => print(&describe_run(&target.lab, compared.as_deref(), &table))?,
        RunFormat::Json => stream(|out| table.write_json(out).and_then(|()| out.write_all(b"\n")))?,
        RunFormat::Csv => stream(|out| table.write_csv(out))?,
    }
    let clean = table.errors.is_empty() && table.warnings.is_empty() && table.breakdowns.is_empty();
    Ok(if clean { CommandOutcome::Clean } else { CommandOutcome::Findings })
}

/// The output at the end of the run: readouts, traces of labs without readouts, warnings; for a comparison, a table with a
/// column for each integrator.
fn describe_run(lab: &Lab, compared: Option<&[ComparedRun]>, table: &Table) -> String {
    let mut text = String::new();
    let Some(last) = table.rows.last() else { return text };
    let time = last.first().map_or(f64::NAN, Cell::number);
    let title = if lab.title().is_empty() { "the lab" } else { lab.title() };
    let samples = match table.rows.len() {
        1 => "1 sample".to_string(),
        n => format!("{n} samples"),
    };
    let _ = writeln!(text, "{}, after {} s ({samples})", printable(title), rounded(time, 3));
    match compared {
        Some(runs) => text.push_str(&comparison_table(lab, runs)),
        None => text.push_str(&last_lines(lab, table)),
    }
    for (name, n) in &table.warnings {
        let often = if *n == 1 { "once".to_string() } else { format!("{n} times") };
        let _ = writeln!(text, "warning: {name} ({often})");
    }
    for b in &table.breakdowns {
        let _ = writeln!(text, "  {}\n  {}\n  help: {}", printable(&b.what), b.why, printable(&b.help()));
    }
    for error in &table.errors {
        let _ = writeln!(text, "error: {}", printable(error));
    }
    text
}

/// The traces and the readouts at the end of a run, one on each line.
fn last_lines(lab: &Lab, table: &Table) -> String {
    let rows = final_values(lab, table).into_iter();
    aligned(&rows.map(|last| vec![last.label.to_string(), last.value]).collect::<Vec<_>>())
}

/// The table of a comparison, with a column for each integrator.
fn comparison_table(lab: &Lab, runs: &[ComparedRun]) -> String {
    let heads = std::iter::once(String::new()).chain(runs.iter().map(|run| run.name.to_string()));
    let rows = stress::comparison_rows(lab, runs).into_iter();
    let rows = rows.map(|row| std::iter::once(row.label.to_string()).chain(row.values).collect());
    aligned(&std::iter::once(heads.collect()).chain(rows).collect::<Vec<_>>())
}

/// Rows of cells as lines of columns.
fn aligned(rows: &[Vec<String>]) -> String {
    let rows: Vec<Vec<Cow<'_, str>>> =
        rows.iter().map(|row| row.iter().map(|cell| printable(cell)).collect()).collect();
    let columns = rows.iter().map(Vec::len).max().unwrap_or(0);
    let width = |column: usize| {
        let cells = rows.iter().filter_map(|row| row.get(column));
        cells.map(|cell| cell.chars().count()).max().unwrap_or(0)
    };
    let widths: Vec<usize> = (0..columns).map(width).collect();
    let mut text = String::new();
    for row in &rows {
        let mut line = String::new();
        for (cell, width) in row.iter().zip(&widths) {
            let _ = write!(line, "  {cell:<width$}");
        }
        let _ = writeln!(text, "{}", line.trim_end());
    }
    text
}

/// The maximum number of plots written into a folder that contains other files.
const MAX_LOOSE: usize = 50;

/// The files of a lab's plots: FILE, FILE-2.svg, FILE-3.svg, …, or plot-1.svg, plot-2.svg, … in a folder,
/// or with another extension.
fn plot_files(lab: &Lab, file: &Path, ending: &str) -> Result<Vec<PathBuf>, Failure> {
    let count = lab.plots.len();
    if count == 0 {
        return Err("this lab has no plots to write".into());
    }
    let name = printable_path(file);
    if file.is_dir() || name.ends_with(std::path::is_separator) {
        std::fs::create_dir_all(file).map_err(|e| format!("cannot make the folder {name}: {e}"))?;
        return Ok((1..=count).map(|i| file.join(format!("plot-{i}.{ending}"))).collect());
    }
    if count > MAX_LOOSE {
        let folder = printable_path(&file.with_extension(""));
        return Err(format!("this lab has {count} plots; name a folder for them: --{ending} {folder}/"));
    }
    let further = |i: usize| {
        let mut name = file.file_stem().unwrap_or("plot".as_ref()).to_os_string();
        name.push(format!("-{i}.{ending}"));
        file.with_file_name(name)
    };
    Ok((1..=count).map(|i| if i == 1 { file.to_path_buf() } else { further(i) }).collect())
}
