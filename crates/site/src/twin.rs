//! A lab or a quiz without JavaScript and on paper: its title, its settings, its readouts at the end of a run, its plots.
//!
//! The run is the one of `labspec run` without options: as the lab loads, until its end.

use crate::html::{Addresses, harmless};
use crate::models::texture_images;
use crate::moments::{Moments, draw_run};
use crate::text::escape;
use labspec::bind::Programs;
use labspec::bind::scene::Models;
use labspec::check;
use labspec::finding::Finding;
use labspec::json::Scalar;
use labspec::run::{Cell, RunOptions, Table, final_values, rounded};
use labspec::source::SourceFile;
use labspec::spec::{ControlKind, Lab, Plot, Question, QuestionKind, Quiz};
use labspec::stress::{ComparedRun, compared_runs, comparison_rows, join_runs, watched_run};
use labspec_core::Model;
use labspec_plot::{Chart, Series, line_chart};
use labspec_scene::Images;
use std::fmt::Write;
use std::sync::Arc;

/// A plot of the lab with the samples of a run.
pub fn chart(lab: &Lab, plot: &Plot, index: usize, table: &Table) -> Chart {
    let series = plot.traces.iter().filter_map(|trace| {
        let name = format!("plot/{index}/{}", trace.label.value);
        let column = table.columns.iter().position(|c| *c == name)?;
        Some(Series { label: trace.label.value.clone(), dash: trace.dash, points: table.series(column) })
    });
    Chart {
        title: lab.title().to_string(),
        xlabel: plot.xlabel().to_string(),
        ylabel: plot.ylabel.as_ref().map_or(String::new(), |t| t.value.clone()),
        width: 640.0,
        height: 320.0,
        xmin: None,
        xmax: None,
        ymin: plot.ymin.as_ref().map(|n| n.value),
        ymax: plot.ymax.as_ref().map(|n| n.value),
        ref_lines: plot
            .ref_lines
            .iter()
            .map(|l| (l.y.value, l.label.as_ref().map(|t| t.value.clone())))
            .collect(),
        series: series.collect(),
    }
}

/// The twin of a lab: its HTML, and the pictures of its run.
pub(crate) struct LabTwin {
    pub(crate) html: String,
    pub(crate) moments: Moments,
}

/// A lab as text and pictures. `address` gives the address of a picture from its page.
pub(crate) fn lab_twin(
    lab: &Lab,
    file: &SourceFile,
    models: Option<&Models>,
    addresses: &mut dyn Addresses,
    address: impl Fn(&str) -> String,
) -> LabTwin {
    let mut out = String::new();
    let mut drawn = Moments::default();
    if !lab.title().is_empty() {
        let _ = write!(out, "<p class=\"twin-title\">{}</p>", escape(lab.title()));
    }
    match run_lab(lab, models) {
        Ok(runs) => {
            drawn = draw_run(lab, file, (&runs.model, runs.images), runs.programs, runs.end);
            out.push_str(&drawn.html(lab.title(), address));
            match runs.tables {
                LabTables::One(table) => out.push_str(&results(lab, &table)),
                LabTables::Compared(runs) => out.push_str(&comparison(lab, &runs)),
            }
        }
        Err(why) => {
            let _ = write!(
                out,
                "<p class=\"twin-failed\">This lab cannot run: {}.</p>",
                escape(why.trim_end_matches('.'))
            );
        }
    }
    if let Some(note) = &lab.note {
        let _ = write!(out, "<p class=\"note\">{}</p>", harmless(note.as_str(), addresses));
    }
    LabTwin { html: out, moments: drawn }
}

/// A lab that has run.
struct LabRuns {
    tables: LabTables,
    model: Arc<Model>,
    /// The pictures of its textures.
    images: Images,
    programs: Programs,
    /// The time at the end of the run, s.
    end: f64,
}

/// The run of a lab as it loads, or a run for each integrator that it compares.
enum LabTables {
    One(Table),
    Compared(Vec<ComparedRun>),
}

/// The runs of a lab as it loads, or the reason that there are none.
fn run_lab(lab: &Lab, models: Option<&Models>) -> Result<LabRuns, String> {
    let models = models.ok_or("its folder of models is not known")?;
    let mut findings: Vec<Finding> = Vec::new();
    let bound = check::bind(lab, models, &mut findings);
    let first = || {
        findings.iter().find(|f| f.is_error()).map_or("its model does not load".into(), |f| f.message.clone())
    };
    let Some((model, programs, 0)) = bound else { return Err(first()) };
    let options = RunOptions::default();
    let tables = match compared_runs(lab, &model, &programs, &options).map_err(|e| e.to_string())? {
        Some(runs) => LabTables::Compared(runs),
        None => LabTables::One(watched_run(lab, &model, &programs, &options).map_err(|e| e.to_string())?),
    };
    let table = match &tables {
        LabTables::One(table) => Some(table),
        LabTables::Compared(runs) => runs.first().map(|run| &run.table),
    };
    let end = table.and_then(|table| table.rows.last()?.first()).map_or(0.0, Cell::number);
    let images = texture_images(lab, models, &model);
    Ok(LabRuns { tables, model, images, programs, end })
}

fn results(lab: &Lab, table: &Table) -> String {
    if table.rows.is_empty() {
        return String::new();
    }
    let mut out = setting_line(lab, table);
    let readouts = final_values(lab, table).into_iter().filter(|last| !last.is_trace);
    let rows: String = readouts
        .map(|last| {
            format!("<div><dt>{}</dt><dd>{}</dd></div>", escape(last.label), escape(&with_minus(&last.value)))
        })
        .collect();
    if !rows.is_empty() {
        let _ = write!(out, "<dl class=\"readouts\">{rows}</dl>");
    }
    out.push_str(&plots(lab, table));
    out
}

/// A table with a column for each integrator, and the plots with a curve for each.
fn comparison(lab: &Lab, runs: &[ComparedRun]) -> String {
    let (joined, table) = join_runs(lab, runs);
    let mut out = setting_line(lab, &table);
    let heads: String =
        runs.iter().map(|run| format!("<th scope=\"col\">{}</th>", escape(run.name))).collect();
    let _ = write!(out, "<table class=\"comparison\"><thead><tr><td></td>{heads}</tr></thead><tbody>");
    for row in comparison_rows(lab, runs).into_iter().filter(|row| !row.is_trace) {
        let cells: String =
            row.values.iter().map(|value| format!("<td>{}</td>", escape(&with_minus(value)))).collect();
        let _ = write!(out, "<tr><th scope=\"row\">{}</th>{cells}</tr>", escape(row.label));
    }
    out.push_str("</tbody></table>");
    out.push_str(&plots(&joined, &table));
    out
}

/// The plots of a lab, and what went wrong in its run.
fn plots(lab: &Lab, table: &Table) -> String {
    let mut out = String::new();
    for (index, plot) in lab.plots.iter().enumerate() {
        let svg = line_chart(&chart(lab, plot, index, table));
        let _ = write!(out, "<div class=\"plot\">{}</div>", svg.trim_end());
    }
    for breakdown in &table.breakdowns {
        let _ = write!(out, "<p class=\"twin-failed\">{}</p>", escape(&breakdown.what));
    }
    out
}

/// A number with the sign that the elements print: a hyphen is not a minus.
fn with_minus(number: &str) -> String {
    match number.strip_prefix('-') {
        Some(rest) if rest.starts_with(|c: char| c.is_ascii_digit()) => format!("\u{2212}{rest}"),
        _ => number.to_string(),
    }
}

/// A unit with its exponents raised: `m/s^2` as the elements print it.
fn raised(unit: &str) -> String {
    const DIGITS: [char; 10] = ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'];
    let mut out = String::new();
    let mut rest = unit.chars().peekable();
    while let Some(c) = rest.next() {
        let is_exponent = c == '^' && rest.peek().is_some_and(|next| *next == '-' || next.is_ascii_digit());
        if !is_exponent {
            out.push(c);
            continue;
        }
        if rest.next_if_eq(&'-').is_some() {
            out.push('⁻');
        }
        while let Some(digit) = rest.next_if(char::is_ascii_digit) {
            out.extend(digit.to_digit(10).and_then(|d| DIGITS.get(d as usize)));
        }
    }
    out
}

/// The length of a run and the values of the controls, as a paragraph.
fn setting_line(lab: &Lab, table: &Table) -> String {
    let time = table.rows.last().and_then(|row| row.first()).map_or(f64::NAN, Cell::number);
    let mut out = format!("<p>The lab after {} s of simulated time", escape(&rounded(time, 3)));
    let settings = settings(lab);
    if !settings.is_empty() {
        let _ = write!(out, ", with {}", escape(&settings));
    }
    out.push_str(".</p>");
    out
}

/// The values of the controls at the start, in words.
fn settings(lab: &Lab) -> String {
    // The table shows what is compared.
    let parts = lab.authored_controls().iter().filter_map(|control| {
        let label = control.label.as_str();
        match &control.kind {
            ControlKind::Slider { unit, value, .. } => {
                let number = Cell::Number(value.value).rounded(control.digits()?);
                let unit = unit.as_ref().map_or(String::new(), |unit| format!(" {}", raised(unit.as_str())));
                Some(format!("{label} {}{unit}", with_minus(&number)))
            }
            ControlKind::Select { options, value, .. } => {
                let chosen = options.iter().find(|choice| is_same(&choice.value, value))?;
                Some(format!("{label} {}", chosen.text.as_str()))
            }
            ControlKind::Button { .. } => None,
        }
    });
    parts.collect::<Vec<_>>().join(", ")
}

/// Whether two values of a select are the same.
fn is_same(a: &Scalar, b: &Scalar) -> bool {
    match (a, b) {
        (Scalar::Number(a), Scalar::Number(b)) => a.value.to_bits() == b.value.to_bits(),
        (Scalar::Text(a), Scalar::Text(b)) => a.value == b.value,
        (Scalar::Bool(a, _), Scalar::Bool(b, _)) => a == b,
        _ => false,
    }
}

/// A quiz as text: its questions and their options.
pub(crate) fn quiz_twin(quiz: &Quiz, addresses: &mut dyn Addresses) -> String {
    let title = quiz.title();
    let mut out = format!("<p class=\"twin-title\">{}</p><ol class=\"questions\">", escape(title));
    for question in &quiz.questions {
        match question {
            Some(question) => out.push_str(&question_twin(question, addresses)),
            None => out.push_str("<li>This question cannot be read.</li>"),
        }
    }
    out.push_str("</ol>");
    out
}

fn question_twin(question: &Question, addresses: &mut dyn Addresses) -> String {
    let mut out = format!("<li><div>{}</div>", harmless(question.q.as_str(), addresses));
    match &question.kind {
        QuestionKind::Choice { options, .. } => {
            out.push_str("<ol class=\"options\">");
            for option in options {
                let _ = write!(out, "<li>{}</li>", harmless(option.as_str(), addresses));
            }
            out.push_str("</ol>");
        }
        QuestionKind::TrueFalse { .. } => out.push_str("<p class=\"blank\">True or false: ________</p>"),
        QuestionKind::Numeric { unit, .. } => {
            let unit =
                unit.as_ref().map_or(String::new(), |unit| format!(" {}", escape(&raised(unit.as_str()))));
            let _ = write!(out, "<p class=\"blank\">Your answer: ________{unit}</p>");
        }
        QuestionKind::Open { .. } => out.push_str("<p class=\"blank\">Your answer:</p>"),
    }
    out.push_str("</li>");
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_and_units_are_printed_as_the_elements_print_them() {
        for (unit, printed) in
            [("m/s^2", "m/s²"), ("kg m^2 s^-10", "kg m² s⁻¹⁰"), ("^", "^"), ("a^b", "a^b"), ("", "")]
        {
            assert_eq!(raised(unit), printed);
        }
        for (number, printed) in [("-9.81", "\u{2212}9.81"), ("0.1", "0.1"), ("-inf", "-inf"), ("-", "-")] {
            assert_eq!(with_minus(number), printed);
        }
    }
}
