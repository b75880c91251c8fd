//! Plots, their traces and reference lines, and readouts.

use super::fields::Fields;
use super::format::{PLOT, READOUT, REF_LINE, TRACE};
use super::problem::{Mistake, Problem};
use crate::json::{Node, Number};
use crate::source::Text;
use std::ops::Range;

/// A plot over time.
#[derive(Clone, Debug, PartialEq)]
pub struct Plot {
    /// Byte range in the file.
    pub span: Range<usize>,
    /// Label of the vertical axis.
    pub ylabel: Option<Text>,
    /// Label of the horizontal axis, see [`Plot::xlabel`].
    pub xlabel: Option<Text>,
    /// The displayed time span in seconds, see [`Plot::window`].
    pub window: Option<Number>,
    /// Lower end of the vertical axis; `None` means that it follows the data.
    pub ymin: Option<Number>,
    /// Upper end of the vertical axis; `None` means that it follows the data.
    pub ymax: Option<Number>,
    /// In pixels, see [`Plot::height`].
    pub height: Option<Number>,
    /// Horizontal lines.
    pub ref_lines: Vec<RefLine>,
    /// The curves.
    pub traces: Vec<Trace>,
}

/// A horizontal line.
#[derive(Clone, Debug, PartialEq)]
pub struct RefLine {
    /// Its vertical position, in the unit of the axis.
    pub y: Number,
    /// The displayed text.
    pub label: Option<Text>,
}

/// A curve.
#[derive(Clone, Debug, PartialEq)]
pub struct Trace {
    /// Byte range in the file.
    pub span: Range<usize>,
    /// Its name in the legend and in tables of the text.
    pub label: Text,
    /// An expression, evaluated at every sample.
    pub expr: Text,
    /// Whether the curve is dashed.
    pub dash: bool,
}

/// A value displayed as text.
#[derive(Clone, Debug, PartialEq)]
pub struct Readout {
    /// Byte range in the file.
    pub span: Range<usize>,
    /// Its name.
    pub label: Text,
    /// An expression with a number, a text or a boolean as its value.
    pub expr: Text,
    /// The number of decimals, see [`Readout::digits`].
    pub digits: Option<Number>,
}

impl Plot {
    /// The displayed time span, in seconds.
    pub fn window(&self) -> f64 {
        self.window.as_ref().map_or(PLOT.number("window"), |w| w.value)
    }

    /// Height, in pixels.
    pub fn height(&self) -> f64 {
        self.height.as_ref().map_or(PLOT.number("height"), |h| h.value)
    }

    /// Label of the horizontal axis.
    pub fn xlabel(&self) -> &str {
        self.xlabel.as_ref().map_or(PLOT.text("xlabel"), Text::as_str)
    }
}

impl Readout {
    /// The number of displayed decimals.
    pub fn digits(&self) -> u32 {
        super::control::decimals(self.digits.as_ref())
    }
}

/// Reads a plot.
pub(super) fn read(node: &Node, problems: &mut Vec<Problem>) -> Option<Plot> {
    let mut fields = Fields::open(node, &PLOT, problems)?;
    let nodes = fields.list("traces");
    if nodes.is_empty() {
        let mistake = Mistake::NoTraces.at(fields.span());
        fields.problems.push(mistake);
    }
    let plot = Plot {
        span: fields.span(),
        ylabel: fields.text("ylabel"),
        xlabel: fields.text("xlabel"),
        window: fields.number("window"),
        ymin: fields.number("ymin"),
        ymax: fields.number("ymax"),
        height: fields.number("height"),
        ref_lines: fields.list("refLines").iter().filter_map(|n| ref_line(n, fields.problems)).collect(),
        traces: nodes.iter().filter_map(|n| trace(n, fields.problems)).collect(),
    };
    fields.finish();
    Some(plot)
}

fn ref_line(node: &Node, problems: &mut Vec<Problem>) -> Option<RefLine> {
    let mut fields = Fields::open(node, &REF_LINE, problems)?;
    let y = fields.number("y");
    let label = fields.text("label");
    fields.finish();
    Some(RefLine { y: y?, label })
}

fn trace(node: &Node, problems: &mut Vec<Problem>) -> Option<Trace> {
    let mut fields = Fields::open(node, &TRACE, problems)?;
    let label = fields.text("label");
    let expr = fields.text("expr");
    let dash = fields.flag("dash");
    let span = fields.span();
    fields.finish();
    Some(Trace { span, label: label?, expr: expr?, dash })
}

/// Reads a readout.
pub(super) fn readout(node: &Node, problems: &mut Vec<Problem>) -> Option<Readout> {
    let mut fields = Fields::open(node, &READOUT, problems)?;
    let label = fields.text("label");
    let expr = fields.text("expr");
    let digits = fields.whole("digits");
    let span = fields.span();
    fields.finish();
    Some(Readout { span, label: label?, expr: expr?, digits })
}
