//! Properties of a `verify` object: its labs and its code texts. The type is defined beside that of a lab
//! ([`lab`](super::lab)), because each can contain the other.

use super::claim::Column;
use super::lab::{BreakExpectation, CodeForm, Run, Verify, VerifyLab};
use crate::source::{SourceMap, Text};
use std::ops::Range;

/// Words that refer to a lab.
const OF_A_LAB: [&str; 8] = ["data", "model", "mj", "lib", "sim", "ctx", "contact", "shown"];

impl Verify {
    /// A `verify` object that only measures.
    pub fn measuring(span: Range<usize>, runs: Vec<Run>, measure: Vec<(Text, Text)>) -> Verify {
        Verify {
            span,
            lab: None,
            uses: None,
            runs,
            measure,
            find: Vec::new(),
            options: Vec::new(),
            over: Vec::new(),
            value: None,
            wrong: Vec::new(),
            says: Vec::new(),
            table: Vec::new(),
            exact: Vec::new(),
        }
    }

    /// Whether it states how the answer of its question is checked.
    pub fn claims_answer(&self) -> bool {
        !self.options.is_empty() || self.value.is_some()
    }

    /// Whether it contains only formulas that read nothing from a lab.
    pub fn is_formulas(&self) -> bool {
        let word = |c: char| c.is_alphanumeric() || c == '_';
        let reads = |text: &Text| text.value.split(|c| !word(c)).any(|w| OF_A_LAB.contains(&w));
        self.runs.is_empty()
            && self.find.is_empty()
            && self.exact.is_empty()
            && !self.code().iter().any(|(_, text)| reads(text))
    }

    /// The labs that it refers to: its own, and those of its runs.
    pub fn labs(&self) -> impl Iterator<Item = &VerifyLab> {
        self.lab.iter().chain(self.runs.iter().filter_map(|run| run.lab.as_ref()))
    }

    /// Whether it needs no labs other than those of its runs.
    pub fn every_run_names_its_lab(&self) -> bool {
        !self.runs.is_empty() && self.exact.is_empty() && self.runs.iter().all(|run| run.lab.is_some())
    }

    /// All texts that are code, each with its form.
    pub fn code(&self) -> Vec<(CodeForm, &Text)> {
        self.runs.iter().flat_map(Run::code).chain(self.expressions()).collect()
    }

    /// The expressions for the numbers in the text.
    pub fn quoted(&self) -> impl Iterator<Item = &Text> {
        self.says.iter().flat_map(|s| &s.exprs).chain(self.table.iter().flat_map(Column::expressions))
    }

    /// The measures and the claims about them: all texts that are code, except those of the runs.
    pub fn expressions(&self) -> impl Iterator<Item = (CodeForm, &Text)> {
        let measures = self.measure.iter().map(|(_, expr)| expr).chain(self.exact.iter().map(|e| &e.form));
        let measures = measures.chain(self.find.iter().map(|f| &f.holds));
        let values = self.options.iter().chain(&self.value).chain(&self.wrong).chain(self.quoted());
        measures.chain(values).map(|t| (CodeForm::Expression, t))
    }
}

impl Run {
    /// A run of the lab as loaded.
    pub fn named(name: &str) -> Run {
        Run {
            name: Text { value: name.to_string(), map: SourceMap::point(0) },
            lab: None,
            model: Vec::new(),
            key: None,
            controller: None,
            set: Vec::new(),
            press: Vec::new(),
            setup: None,
            until: None,
            steps: None,
            stop: None,
            sweep: None,
            expect: BreakExpectation::None,
            unread_key: None,
        }
    }

    /// All texts that are code, each with its form.
    pub fn code(&self) -> impl Iterator<Item = (CodeForm, &Text)> {
        let statements = self.setup.iter().chain(&self.controller).map(|t| (CodeForm::Statements, t));
        statements.chain(self.stop.iter().map(|t| (CodeForm::Expression, t)))
    }
}
