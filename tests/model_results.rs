//! The number of models that are compared with MuJoCo, and the results: the tables `golden/zoo.md` and `golden/conformance.md`.
//! `LABSPEC_BLESS=1 cargo test` writes them; a test fails if they are out of date.

// A failing test states the reason.
#![allow(clippy::panic, clippy::unwrap_used)]

use crate::recorded::{ASPECTS, Outcome, Verdict};
use crate::support::workspace;
use labspec_core::xml::rules;
use std::fmt::Write;

/// A known difference: model (`*` for any), aspect (`load` or one of [`ASPECTS`]), cause.
pub(crate) type Exception = (&'static str, &'static str, &'static str);

/// Models and their results.
#[derive(Default)]
pub(crate) struct ModelResults(Vec<(String, Outcome)>);

impl ModelResults {
    pub(crate) fn add(&mut self, name: String, outcome: Outcome) {
        self.0.push((name, outcome));
    }

    /// The number of models that do not load.
    pub(crate) fn refused(&self) -> usize {
        self.0.iter().filter(|(_, outcome)| outcome.is_err()).count()
    }

    /// Fails if a model differs without a listed exception, if an exception no longer applies, or if the table is out of date.
    ///
    /// An unsupported feature is not a failure: the table lists it, and shows when it changes.
    pub(crate) fn check(&self, table: Option<&str>, exceptions: &[Exception]) {
        let covers = |e: &Exception, model: &str, aspect: &str| (e.0 == "*" || e.0 == model) && e.1 == aspect;
        let cause =
            |model: &str, aspect: &str| exceptions.iter().find(|e| covers(e, model, aspect)).map(|e| e.2);
        let mut wrong = String::new();
        for (name, aspect, what) in self.failures() {
            if cause(&name, aspect).is_none() {
                let _ = writeln!(wrong, "{name}, {aspect}: {what}");
            }
        }
        for e in exceptions {
            if !self.failures().iter().any(|f| covers(e, &f.0, f.1)) {
                let _ = writeln!(wrong, "{}, {}: is listed as an exception and is right", e.0, e.1);
            }
        }
        self.print();
        if let Some(table) = table {
            let text = self.table(cause);
            let path = workspace().join(format!("tests/golden/{table}.md"));
            if std::env::var_os("LABSPEC_BLESS").is_some() {
                std::fs::write(&path, &text).unwrap();
            } else if std::fs::read_to_string(&path).unwrap_or_default() != text {
                let _ = writeln!(
                    wrong,
                    "tests/golden/{table}.md is stale: LABSPEC_BLESS=1 cargo test -p labspec-cli {table}"
                );
            }
        }
        assert!(wrong.is_empty(), "differences from MuJoCo 3.14.0:\n{wrong}");
    }

    /// Prints the largest differences, for `cargo test -- --nocapture`.
    fn print(&self) {
        for (i, aspect) in ASPECTS.into_iter().enumerate() {
            let mut same = (0.0, "");
            for (name, outcome) in &self.0 {
                match outcome.as_ref().map(|verdicts| &verdicts[i]) {
                    Ok(Verdict::Same(difference)) if *difference >= same.0 => same = (*difference, name),
                    Ok(Verdict::Sensitive(difference, spread)) => {
                        println!(
                            "{aspect}, {name}: {difference:.1e} from the library, which is {spread:.1e} from itself"
                        );
                    }
                    _ => {}
                }
            }
            println!("{aspect}: at most {:.1e} apart ({})", same.0, same.1);
        }
    }

    /// The model, the aspect and the failure.
    fn failures(&self) -> Vec<(String, &'static str, String)> {
        let mut all = Vec::new();
        for (name, outcome) in &self.0 {
            match outcome {
                Err(reason) if reason.starts_with(rules::NOT_SUPPORTED.code) => {}
                Err(reason) => all.push((name.clone(), "load", reason.clone())),
                Ok(verdicts) => {
                    for (aspect, verdict) in ASPECTS.into_iter().zip(verdicts) {
                        if let Verdict::Differs(list) = verdict {
                            let lines: Vec<String> = list.iter().map(|d| format!("\n    {d}")).collect();
                            all.push((name.clone(), aspect, lines.concat()));
                        }
                    }
                }
            }
        }
        all
    }

    fn table(&self, cause: impl Fn(&str, &str) -> Option<&'static str>) -> String {
        let loaded = self.0.iter().filter_map(|(_, o)| o.as_ref().ok());
        let mut text = String::from(
            "# Models held against MuJoCo 3.14.0\n\nWritten by `tests/model_results.rs`; constraints are switched off on both sides.\n\n",
        );
        let _ = writeln!(text, "{} models, {} load.\n", self.0.len(), loaded.clone().count());
        text.push_str("| aspect | the same | sensitive | refused there | differs |\n|---|---|---|---|---|\n");
        for (i, aspect) in ASPECTS.into_iter().enumerate() {
            let mut counts = [0; 4];
            for verdicts in loaded.clone() {
                let kind = match &verdicts[i] {
                    Verdict::Same(_) => 0,
                    Verdict::Sensitive(..) => 1,
                    Verdict::Refused(_) => 2,
                    Verdict::Differs(_) => 3,
                };
                counts[kind] += 1;
            }
            let [same, sensitive, refused, differs] = counts;
            let _ = writeln!(text, "| {aspect} | {same} | {sensitive} | {refused} | {differs} |");
        }
        text.push_str(
            "\n*Sensitive*: a trajectory apart by more than 1e-9, and by less than MuJoCo is from itself when the start moves by\n\
             1e-14; a forward pass by more than 1e-10, and by less than MuJoCo is from itself when positions move by their\n\
             last bit.\n\
             All others are in no list below.\n",
        );
        let lines = self.exceptional(cause);
        if !lines.is_empty() {
            text.push_str("\n| model | aspect | outcome | cause |\n|---|---|---|---|\n");
            text.push_str(&lines);
        }
        text
    }

    /// A line for every result other than equality.
    fn exceptional(&self, cause: impl Fn(&str, &str) -> Option<&'static str>) -> String {
        let mut text = String::new();
        for (name, outcome) in &self.0 {
            let mut line = |aspect: &str, outcome: &str, why: &str| {
                let why = cause(name, aspect).unwrap_or(why);
                let _ = writeln!(text, "| {name} | {aspect} | {outcome} | {} |", why.replace('|', "\\|"));
            };
            match outcome {
                Err(reason) => line("load", "refused", reason),
                Ok(verdicts) => {
                    for (aspect, verdict) in ASPECTS.into_iter().zip(verdicts) {
                        match verdict {
                            Verdict::Same(_) => {}
                            Verdict::Sensitive(..) => {
                                line(aspect, "sensitive", "the library parts from itself as far")
                            }
                            Verdict::Refused(message) => line(aspect, "refused there", message),
                            Verdict::Differs(_) => line(aspect, &verdict.to_string(), ""),
                        }
                    }
                }
            }
        }
        text
    }
}
