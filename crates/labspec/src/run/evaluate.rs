//! Reads a session between its steps: traces, readouts, and other expressions.

use super::budget::{Budget, End};
use super::cell::Cell;
use super::program_error::ProgramError;
use super::session::Session;
use crate::source::Text;
use labspec_core as core;
use labspec_expr::{Program, Value, rules};

/// The work that a sample of a trace counts in addition to its own.
const SAMPLE: u64 = 100;

impl Session<'_> {
    /// The time and every probe. A probe that throws has no value, as on the page.
    pub fn sample(&mut self) -> Vec<Cell> {
        let mut row = Vec::with_capacity(self.programs.probes.len() + 1);
        row.push(Cell::Number(self.world.data.time()));
        let programs = self.programs.clone();
        for probe in &programs.probes {
            let value = probe.bound.as_ref().and_then(|b| self.evaluate(&b.program, &b.text));
            row.push(value.map_or(Cell::Nothing, Cell::from));
        }
        row
    }

    /// The current value of an expression; `None` when it throws, or when the budget ran out. An expression that exceeded
    /// its budget before is not evaluated again.
    pub fn evaluate(&mut self, program: &Program, text: &Text) -> Option<Value> {
        let endless = |t: &ProgramError| t.rule == rules::BUDGET && t.text == *text;
        if matches!(self.end, Some(End::Budget { .. } | End::Foreign))
            || self.program_errors.iter().any(endless)
        {
            return None;
        }
        self.sampled += SAMPLE;
        let (time, left) = (self.world.data.time(), self.left());
        core::limit(&mut self.world.data, left);
        self.context.allow(left.min(Budget::SAMPLE.left));
        match program.run(&mut self.world, &mut self.context, None) {
            Ok(value) => self.settle(time).then_some(value),
            Err(e) => {
                self.report_error(e, text, time);
                None
            }
        }
    }
}
