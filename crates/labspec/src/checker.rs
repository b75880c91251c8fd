//! Checks a lesson from memory: the input is a text, the output are findings and the ledger.

use crate::bind::{Functions, scene};
use crate::check::{self, CheckLevel, Checked};
use crate::error::located;
use crate::finding::{self, Finding, InFile};
use crate::ledger::{Entry, Ledger, Outcome};
use crate::lint::{self, ModelFolder, load_lesson_at};
use crate::source::{SourceFile, Sources};
use crate::spec::Lesson;
use std::fmt;
use std::path::Path;

/// Checks lessons one by one. Models are compiled once.
#[derive(Debug)]
pub struct Checker {
    models: scene::Models,
    level: CheckLevel,
    rules: Rules,
    sources: Sources,
}

/// A rule of the embedding program.
type OwnRule = Box<dyn Fn(&Lesson) -> Vec<Finding> + Send + Sync>;

#[derive(Default)]
struct Rules(Vec<OwnRule>);

impl fmt::Debug for Rules {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} rules", self.0.len())
    }
}

/// The result of a check.
#[derive(Debug)]
pub struct Report {
    /// The lesson with the results of its labs and its claims.
    pub checked: Checked,
    /// All errors, warnings and notes, in order, with line and column, including those in its models.
    pub findings: Vec<Finding>,
    /// Every claim with its state.
    pub ledger: Ledger,
}

impl Report {
    /// The overall outcome.
    pub fn outcome(&self) -> Outcome {
        self.ledger.outcome()
    }

    /// Every claim with its state, in order.
    pub fn entries(&self) -> &[Entry] {
        self.ledger.entries()
    }
}

impl Checker {
    /// A checker for lessons whose labs name these models: a map, a closure ([`Models`](crate::Models)), or a folder
    /// ([`ModelFolder`]). Only a folder reads files.
    pub fn new(models: impl Into<ModelFolder>) -> Checker {
        let level = CheckLevel::FULL;
        let (rules, sources) = (Rules::default(), Sources::default());
        Checker { models: scene::Models::new(models.into()), level, rules, sources }
    }

    /// Sets the level of the check: without runs of labs, or without verdicts on claims, it is faster but checks less.
    pub fn level(mut self, level: CheckLevel) -> Checker {
        self.level = level;
        self
    }

    /// Sets the texts of related files by path: lessons whose labs the checked lesson names, and snapshots. They are resolved from the
    /// path of the checked lesson. No files are read.
    pub fn neighbours<P: AsRef<Path>, T: Into<String>>(
        mut self,
        texts: impl IntoIterator<Item = (P, T)>,
    ) -> Checker {
        self.sources = Sources::given(texts);
        self
    }

    /// Sets the functions of the embedding program that the texts of labs may call.
    pub fn functions(mut self, functions: Functions) -> Checker {
        self.models = self.models.with_functions(functions);
        self
    }

    /// Adds a rule of the embedding program, which checks every lesson. Its findings count like all others. Spans are bytes
    /// of the lesson, and a fix must result in valid JSON ([`crate::json`] provides the tools).
    pub fn rule(mut self, rule: impl Fn(&Lesson) -> Vec<Finding> + Send + Sync + 'static) -> Checker {
        self.rules.0.push(Box::new(rule));
        self
    }

    /// Checks a lesson. `path` is its name in findings, and its extension determines the format: Markdown or JSON.
    pub fn check(&mut self, path: &str, text: &str) -> Report {
        let (file, folder) = (SourceFile::new(path, text), self.models.folder());
        let mut lesson = load_lesson_at(file, Path::new(path), &self.sources, folder);
        let mut of_rules: Vec<Finding> = self.rules.0.iter().flat_map(|rule| rule(&lesson)).collect();
        lint::withhold_fixes(&lesson, &mut of_rules);
        lesson.findings.extend(of_rules.into_iter().map(|f| f.at(&lesson.file)));
        finding::sort(&mut lesson.findings);
        let checked = check::check_lesson(lesson, &self.models, self.level);
        let mut findings = lint::check_course(&[&checked.lesson]);
        findings.extend(checked.findings.iter().cloned());
        findings.extend(self.models.take_findings());
        finding::sort(&mut findings);
        let ledger = check::ledger(std::slice::from_ref(&checked), &findings);
        let files = std::iter::once(&checked.lesson.file).chain(self.models.files());
        let files: Vec<&SourceFile> = files.collect();
        let place = |f: Finding| match files.iter().find(|file| *file.path() == f.path) {
            Some(file) => located(f, file),
            None => f,
        };
        let findings = findings.into_iter().map(place).collect();
        Report { checked, findings, ledger }
    }
}
