//! The samples of a run.

use super::breakdown::{Breakdown, time};
use super::budget::End;
use super::cell::Cell;
use super::diagnose::breakdowns_of;
use super::session::Session;
use crate::spec::Lab;
use labspec_core::Warning;

/// Rows of samples: time, then every trace, then every readout.
#[derive(Clone, Debug)]
pub struct Table {
    /// Length of a step, s.
    pub timestep: f64,
    /// Names of the columns; the first is `time`.
    pub columns: Vec<String>,
    /// The samples.
    pub rows: Vec<Vec<Cell>>,
    /// Warnings of the engine since the last reset: name and number.
    pub warnings: Vec<(&'static str, usize)>,
    /// The breakdowns of the run: explanations of warnings, and silent faults, the worst first.
    pub breakdowns: Vec<Breakdown>,
    /// Errors of programs.
    pub errors: Vec<String>,
}

/// The last value of a trace or a readout, as it is displayed.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FinalValue<'a> {
    /// The label of the trace or the readout.
    pub label: &'a str,
    /// The value with the digits of the readout, or with four.
    pub value: String,
    /// Whether it is a trace, and not a readout.
    pub is_trace: bool,
}

/// The last values of all traces and readouts of a lab, in the order of the columns. A run without samples has no numbers.
pub fn final_values<'a>(lab: &Lab, table: &'a Table) -> Vec<FinalValue<'a>> {
    let last = table.rows.last().map_or(&[][..], Vec::as_slice);
    let named = table.columns.iter().enumerate().skip(1);
    named
        .map(|(i, name)| (name, last.get(i).unwrap_or(&Cell::Nothing)))
        .map(|(name, cell)| match name.strip_prefix("readout/") {
            Some(label) => {
                let readout = lab.readouts.iter().find(|readout| readout.label.value == label);
                let digits = readout.map_or(TRACE_DIGITS, |readout| readout.digits());
                FinalValue { label, value: cell.rounded(digits), is_trace: false }
            }
            None => {
                let label = name.splitn(3, '/').nth(2).unwrap_or(name);
                FinalValue { label, value: cell.rounded(TRACE_DIGITS), is_trace: true }
            }
        })
        .collect()
}

/// Number of decimals of the last value of a trace.
const TRACE_DIGITS: u32 = 4;

/// The error if the programs and the model do not match.
const FOREIGN: &str =
    "the programs belong to another model, so nothing was run; compile the lab for this one";

impl Table {
    pub(crate) fn new(timestep: f64, probes: impl Iterator<Item = String>) -> Table {
        let columns = std::iter::once("time".to_string()).chain(probes).collect();
        Table {
            timestep,
            columns,
            rows: Vec::new(),
            warnings: Vec::new(),
            breakdowns: Vec::new(),
            errors: Vec::new(),
        }
    }

    pub(super) fn finish(&mut self, session: &Session<'_>) {
        let raised =
            Warning::ALL.iter().zip(&session.world.data.fields().warning).filter(|(_, s)| s.number > 0);
        self.warnings = raised.map(|(w, s)| (w.name(), s.number)).collect();
        self.breakdowns = breakdowns_of(session);
        self.errors =
            session.program_errors.iter().map(|t| format!("{}: {}", t.text.value, t.message)).collect();
        match session.ended() {
            Some(End::Budget { time }) => self.errors.push(format!(
                "the run was stopped at t = {time} s: the work budget ran out; simplify the scene or its programs"
            )),
            Some(End::Interrupted) => {
                let time = time(session.world.data.time());
                self.errors.push(format!("stopped by Ctrl-C at t = {time} s, before its end"));
            }
            Some(End::Foreign) => self.errors.push(FOREIGN.to_string()),
            Some(End::Threw) | None => {}
        }
    }

    /// The points of a column over time.
    pub fn series(&self, column: usize) -> Vec<(f64, f64)> {
        let number_at = |row: &[Cell], i: usize| row.get(i).map_or(f64::NAN, Cell::number);
        self.rows.iter().map(|row| (number_at(row, 0), number_at(row, column))).collect()
    }
}
