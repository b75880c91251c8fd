//! The plots of the labs in the runs of a claim.

use crate::check::VerifyCurves;
use crate::printable::counted;
use crate::printable::printable;
use crate::spec::Plot;
use crate::verify::Curves;
use labspec_plot::{Chart, Series, line_chart};
use std::fmt::Write;

/// Size of a plot, pixels: two fit side by side on a screen, one on a phone.
const SIZE: (f64, f64) = (430.0, 270.0);
/// Maximum number of curves of a plot, one for each colour.
const CURVES: usize = 7;
/// Maximum number of plots of one claim.
const PICTURES: usize = 12;

/// One plot of a lab in several runs.
struct Picture<'a> {
    plot: &'a Plot,
    /// The index of its first trace among those of the lab.
    first: usize,
    runs: Vec<&'a Curves>,
}

/// Writes the plots of a claim; empty where its labs have no plots.
pub(super) fn plots(drawn: &VerifyCurves) -> String {
    let all = pictures(&drawn.runs);
    let alone = drawn.runs.len() == 1;
    let mut out = String::new();
    for picture in all.iter().take(PICTURES) {
        let svg = line_chart(&chart(picture, alone));
        let lines: Vec<&str> = svg.lines().map(str::trim_start).collect();
        let _ = writeln!(out, "<figure>{}</figure>", lines.join("\n"));
    }
    if out.is_empty() {
        return out;
    }
    let left = all.len().saturating_sub(PICTURES);
    let more = if left > 0 {
        format!("<p class=\"soft\">{} not drawn</p>", counted(left, "more plot"))
    } else {
        String::new()
    };
    format!("<div class=\"plots\">\n{out}</div>{more}\n")
}

/// Groups the same plot of the same lab in several runs, as many as fit into one picture.
fn pictures(runs: &[Curves]) -> Vec<Picture<'_>> {
    let mut labs: Vec<Vec<&Curves>> = Vec::new();
    for run in runs {
        match labs.iter_mut().find(|lab| lab.iter().all(|other| other.lab == run.lab)) {
            Some(lab) => lab.push(run),
            None => labs.push(vec![run]),
        }
    }
    let mut all = Vec::new();
    for lab in labs {
        let Some(model) = lab.first() else { continue };
        let mut first = 0;
        for plot in &model.plots {
            let together = CURVES / plot.traces.len().max(1);
            let parts = lab.chunks(together.max(1)).map(|runs| Picture { plot, first, runs: runs.to_vec() });
            all.extend(parts.filter(|p| !p.plot.traces.is_empty()));
            first += plot.traces.len();
        }
    }
    all
}

fn chart(picture: &Picture<'_>, alone: bool) -> Chart {
    let Picture { plot, first, runs } = picture;
    let several = runs.len() > 1;
    let series = runs.iter().flat_map(|run| {
        plot.traces.iter().zip(run.values.iter().skip(*first)).map(move |(trace, values)| Series {
            label: match (several, plot.traces.len()) {
                (false, _) => label(&trace.label.value),
                (true, 1) => label(&run.run),
                (true, _) => label(&format!("{}: {}", run.run, trace.label.value)),
            },
            dash: trace.dash,
            points: run.times.iter().copied().zip(values.iter().copied()).collect(),
        })
    });
    Chart {
        title: match runs.as_slice() {
            [run] if !alone => label(&run.run),
            _ => String::new(),
        },
        xlabel: label(plot.xlabel()),
        ylabel: plot.ylabel.as_ref().map_or(String::new(), |t| label(t.as_str())),
        width: SIZE.0,
        height: SIZE.1,
        ymin: plot.ymin.as_ref().map(|n| n.value),
        ymax: plot.ymax.as_ref().map(|n| n.value),
        xmin: None,
        xmax: None,
        ref_lines: plot
            .ref_lines
            .iter()
            .map(|l| (l.y.value, l.label.as_ref().map(|t| label(t.as_str()))))
            .collect(),
        series: series.collect(),
    }
}

/// A label of a plot, with invisible characters written as escapes.
fn label(text: &str) -> String {
    printable(text).into_owned()
}
