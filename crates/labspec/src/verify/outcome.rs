//! What the runs gave, and how conditions read it: `run.measure`, or the measure alone when there is one run.

use crate::bind::ModelNames;
use crate::run::Numerics;
use std::cell::RefCell;
use std::collections::BTreeSet;

use labspec_expr::dimension::Measure;
use labspec_expr::{
    CollectionId, Entry, Field, FieldKey, FunctionId, FunctionInfo, ObjectId, Role, Schema, Value, Words,
};

/// The measures of one run.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct RunOutcome {
    pub(super) name: String,
    pub(super) measures: Vec<(String, f64)>,
    /// Number of warnings of the engine.
    pub(super) warnings: usize,
    /// What broke in it, in one clause; what it measured is then evidence of nothing.
    pub(super) broke: Option<String>,
}

/// The measures of all runs.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Outcome {
    pub(super) runs: Vec<RunOutcome>,
    pub(super) numerics: Numerics,
}

impl Outcome {
    /// All measures, named as conditions read them.
    pub(super) fn list(&self) -> Vec<(String, f64)> {
        let short = self.runs.len() == 1;
        let each = |r: &RunOutcome| {
            let name = |m: &str| if short { m.to_string() } else { format!("{}.{m}", r.name) };
            r.measures.iter().map(|(m, x)| (name(m), *x)).collect::<Vec<_>>()
        };
        self.runs.iter().flat_map(each).collect()
    }
}

/// What an expression over an outcome looked at.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(super) struct Used {
    /// Runs by their place in the list, and the measures read of each.
    pub(super) measures: BTreeSet<(usize, String)>,
    /// Runs whose warnings it read.
    pub(super) warnings: BTreeSet<usize>,
}

impl Used {
    /// The runs that it depends on.
    pub(super) fn runs(&self) -> BTreeSet<usize> {
        self.measures.iter().map(|(run, _)| *run).collect()
    }
}

/// Numbers of run objects start here: below are the model's own.
const RUNS: u32 = 0x2000;

/// The names of conditions: runs and measures; with one run also everything that a measure may use.
pub(super) struct OutcomeNames<'a> {
    outcome: &'a Outcome,
    model: ModelNames<'a>,
    used: RefCell<Used>,
}

impl<'a> OutcomeNames<'a> {
    pub(super) fn new(outcome: &'a Outcome, model: ModelNames<'a>) -> OutcomeNames<'a> {
        OutcomeNames { outcome, model, used: RefCell::default() }
    }

    /// What was looked up until now.
    pub(super) fn used(self) -> Used {
        self.used.into_inner()
    }

    fn only(&self) -> Option<&RunOutcome> {
        match self.outcome.runs.as_slice() {
            [run] => Some(run),
            _ => None,
        }
    }

    /// The place of a run in the list, and the run.
    fn run(&self, ObjectId(id): ObjectId) -> Option<(usize, &RunOutcome)> {
        let place = id.checked_sub(RUNS)? as usize;
        Some((place, self.outcome.runs.get(place)?))
    }

    fn measure(&self, place: usize, run: &RunOutcome, name: &str) -> Option<Entry> {
        if name == "warnings" {
            self.used.borrow_mut().warnings.insert(place);
            return Some(Entry::Constant(Value::Number(run.warnings as f64)));
        }
        let (_, x) = run.measures.iter().find(|(m, _)| m == name)?;
        self.used.borrow_mut().measures.insert((place, name.to_string()));
        Some(Entry::Constant(Value::Number(*x)))
    }
}

fn measures(run: &RunOutcome) -> impl Iterator<Item = String> + '_ {
    run.measures.iter().map(|(m, _)| m.clone()).chain(["warnings".into()])
}

impl Schema for OutcomeNames<'_> {
    fn identity(&self) -> u64 {
        self.model.identity()
    }

    fn root(&self, name: &str) -> Option<Entry> {
        if let Some(i) = self.outcome.runs.iter().position(|r| r.name == name) {
            return Some(Entry::Object(ObjectId(RUNS + i as u32)));
        }
        match self.only() {
            Some(run) => self.measure(0, run, name).or_else(|| self.model.root(name)),
            None if name == "abs" => self.model.root(name),
            None => None,
        }
    }

    fn root_names(&self) -> Vec<String> {
        let runs = self.outcome.runs.iter().map(|r| r.name.clone());
        match self.only() {
            Some(run) => measures(run).chain(runs).chain(self.model.root_names()).collect(),
            None => runs.chain(["abs".into()]).collect(),
        }
    }

    fn member(&self, object: ObjectId, name: &str) -> Option<Entry> {
        match self.run(object) {
            Some((place, run)) => self.measure(place, run, name),
            None => self.model.member(object, name),
        }
    }

    fn member_names(&self, object: ObjectId) -> Vec<String> {
        match self.run(object) {
            Some((_, run)) => measures(run).collect(),
            None => self.model.member_names(object),
        }
    }

    fn describe(&self, object: ObjectId) -> String {
        match self.run(object) {
            Some((_, run)) => format!("the run {}", crate::json::read::named(&run.name)),
            None => self.model.describe(object),
        }
    }

    fn lookup(&self, collection: CollectionId, name: &str) -> Option<ObjectId> {
        self.model.lookup(collection, name)
    }

    fn names(&self, collection: CollectionId) -> Vec<String> {
        self.model.names(collection)
    }

    fn noun(&self, collection: CollectionId) -> &str {
        self.model.noun(collection)
    }

    fn function(&self, function: FunctionId) -> FunctionInfo {
        self.model.function(function)
    }

    fn hint(&self, object: ObjectId, name: &str) -> Option<String> {
        if self.run(object).is_some() { None } else { self.model.hint(object, name) }
    }

    fn role(&self, field: FieldKey, index: usize) -> Role {
        self.model.role(field, index)
    }

    fn measure(&self, field: FieldKey, first: usize, count: Option<usize>) -> Measure {
        self.model.measure(field, first, count)
    }

    fn element_help(&self, field: FieldKey, index: usize) -> Option<String> {
        self.model.element_help(field, index)
    }

    fn named_element(&self, field: FieldKey, index: usize) -> Option<String> {
        self.model.named_element(field, index)
    }

    fn result_field(&self, function: FunctionId, object: ObjectId) -> Option<Field> {
        self.model.result_field(function, object)
    }

    fn words(&self) -> &'static Words {
        self.model.words()
    }

    fn refresh(&self) -> Option<String> {
        self.model.refresh()
    }
}
