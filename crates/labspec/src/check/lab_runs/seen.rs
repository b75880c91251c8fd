//! The values that the traces and readouts of a lab display in its runs: numbers, or values that a student cannot read.
//!
//! A gap may be intended. A text that contains `NaN` itself, or reads a variable that is not stored yet, is reported only
//! when no run fills the gap.

use super::super::PreparedLab;
use super::display::WatchedDisplay;
use crate::finding::Finding;
use crate::rules::{self, Rule, shows_infinite, shows_nan, text_in_plot};
use crate::run::{Cell, ProgramError, Session};
use crate::source::Text;
use std::collections::BTreeSet;

/// All displays of a lab.
pub(super) struct LabDisplays<'a> {
    displays: Vec<WatchedDisplay<'a>>,
    /// Number of traces and readouts.
    width: usize,
    /// Slots of `ctx` to which a text stores `NaN` intentionally.
    gaps: BTreeSet<u32>,
    found: Vec<Finding>,
    /// Errors of programs that were reported before.
    program_errors: Vec<(&'static Rule, Text, std::ops::Range<usize>)>,
}

impl<'a> LabDisplays<'a> {
    /// The displays of a lab before the first run.
    pub(super) fn new(ready: &'a PreparedLab<'a>) -> LabDisplays<'a> {
        let programs = &ready.programs;
        let displays = programs.probes.iter().enumerate().filter_map(|(i, p)| {
            let bound = p.bound.as_ref()?;
            let (kind, label) = p.name.split_once('/').unwrap_or(("", &p.name));
            let trace = kind == "plot";
            // The name has the form `plot/0/label`.
            let label = if trace { label.split_once('/').map_or(label, |(_, l)| l) } else { label };
            let text = &bound.text.value;
            Some(WatchedDisplay {
                bound,
                column: i + 1,
                name: format!("the {} \"{label}\"", if trace { "trace" } else { "readout" }),
                trace,
                mentions_gap: shows_nan::mentions_gap(text),
                says_infinite: shows_nan::contains_word(text, "Infinity"),
                ever: false,
                gap: false,
                reported: Vec::new(),
            })
        });
        let on_purpose = programs.bound().filter(|b| shows_nan::mentions_gap(&b.text.value));
        let gaps = on_purpose.flat_map(|b| b.program.effects().ctx_writes.iter().copied()).collect();
        LabDisplays {
            displays: displays.collect(),
            width: programs.probes.len(),
            gaps,
            found: Vec::new(),
            program_errors: Vec::new(),
        }
    }

    /// Evaluates all displays. Returns the time and the displayed values.
    pub(super) fn observe(&mut self, session: &mut Session<'_>, done: &str) -> Vec<Cell> {
        let mut row = Vec::with_capacity(self.width + 1);
        row.push(Cell::Number(session.world.data.time()));
        row.resize(self.width + 1, Cell::Nothing);
        for display in &mut self.displays {
            let value = session.evaluate(&display.bound.program, &display.bound.text);
            if session.ended().is_some_and(|e| matches!(e, crate::run::End::Budget { .. })) {
                return row;
            }
            // A program that threw has a separate finding.
            let Some(value) = value else { continue };
            if let Some(cell) = row.get_mut(display.column) {
                *cell = Cell::from(value.clone());
            }
            let time = session.world.data.time();
            let checks = [shows_nan::check_cell, shows_infinite::check_cell, text_in_plot::check_cell];
            let Some(finding) = checks.iter().find_map(|check| check(display, &value, time, done)) else {
                display.ever = true;
                continue;
            };
            if finding.code == rules::SHOWS_NAN.code
                && (display.mentions_gap || shows_nan::is_unset(display.bound, session, &self.gaps))
            {
                // An intended gap may be filled by an interaction that no run tests, unless the text is constant.
                display.gap |= !display.mentions_gap || display.bound.program.effects().constant();
            } else if !display.reported.contains(&finding.code) {
                display.reported.push(finding.code);
                self.found.push(finding);
            }
        }
        row
    }

    /// The findings since the last call.
    pub(super) fn take(&mut self) -> Vec<Finding> {
        std::mem::take(&mut self.found)
    }

    /// After all runs: the displays that never had a value.
    pub(super) fn never(&mut self, all: bool) -> Vec<Finding> {
        let empty = self.displays.iter().filter(|s| all && !s.ever && s.reported.is_empty());
        empty.filter(|s| s.gap).map(shows_nan::always_a_gap).collect()
    }

    /// Whether a program has not thrown this error in a run before.
    pub(super) fn is_new(&mut self, t: &ProgramError) -> bool {
        let is_reported = |(code, text, span): &(&'static Rule, Text, std::ops::Range<usize>)| {
            *code == t.rule && *text == t.text && *span == t.span
        };
        let new = !self.program_errors.iter().any(is_reported);
        if new {
            self.program_errors.push((t.rule, t.text.clone(), t.span.clone()));
        }
        new
    }
}
