//! What the runs gave, and how conditions read it: `run.measure`, or the measure alone when there is one run.

use crate::bind::{ModelNames, NUMBERS, Scope};
use crate::run::Numerics;
use std::cell::RefCell;
use std::collections::BTreeSet;

use labspec_expr::dimension::Measure;
use labspec_expr::{
    CollectionId, Elem, Entry, Field, FieldKey, FieldKind, FunctionId, FunctionInfo, Gives, ObjectId, Role,
    Schema, Value, Words,
};

/// The measures of one run.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct RunOutcome {
    pub(super) name: String,
    /// The value that it has of what is swept, and its place in the sweep.
    pub(super) swept: Option<(usize, f64)>,
    pub(super) measures: Vec<(String, f64)>,
    /// Number of warnings of the engine.
    pub(super) warnings: usize,
    /// What broke in it, in one clause; what it measured is then evidence of nothing.
    pub(super) broke: Option<String>,
}

impl RunOutcome {
    /// How conditions call it: `fall`, `fall[2]`.
    pub(super) fn title(&self) -> String {
        match self.swept {
            Some((i, _)) => format!("{}[{i}]", self.name),
            None => self.name.clone(),
        }
    }
}

/// The measures of all runs.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Outcome {
    pub(super) runs: Vec<RunOutcome>,
    /// Values that were searched for.
    pub(super) found: Vec<(String, f64)>,
    pub(super) numerics: Numerics,
    /// Expressions that look at the samples themselves, measured by somebody else; empty where we measure.
    pub(super) elsewhere: Vec<(String, f64)>,
}

impl Outcome {
    /// The runs of the sweep that begins at a place, with their places; the run itself when there is no sweep.
    pub(super) fn members(&self, place: usize) -> impl Iterator<Item = (usize, &RunOutcome)> {
        let all = self.runs.iter().enumerate().skip(place);
        all.take_while(move |(i, run)| *i == place || matches!(run.swept, Some((n, _)) if n > 0))
    }

    /// What somebody else measured with this expression.
    pub(super) fn measured_elsewhere(&self, text: &str) -> Option<f64> {
        self.elsewhere.iter().find(|(known, _)| known == text).map(|(_, x)| *x)
    }

    /// All measures, named as conditions read them.
    pub(super) fn list(&self) -> Vec<(String, f64)> {
        let short = self.runs.len() == 1;
        let each = |r: &RunOutcome| {
            let name = |m: &str| match r.swept {
                _ if short => m.to_string(),
                Some((i, _)) => format!("{}.{m}[{i}]", r.name),
                None => format!("{}.{m}", r.name),
            };
            r.measures.iter().map(|(m, x)| (name(m), *x)).collect::<Vec<_>>()
        };
        self.runs.iter().flat_map(each).chain(self.found.iter().cloned()).collect()
    }
}

/// What an expression over an outcome looked at.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(super) struct Used {
    /// Runs by their place in the list, and the measures read of each.
    pub(super) measures: BTreeSet<(usize, String)>,
    /// Runs whose warnings it read.
    pub(super) warnings: BTreeSet<usize>,
    /// It read a value that was searched for.
    pub(super) found: bool,
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
    /// What takes the numbers of several runs together.
    claims: ModelNames<'a>,
    /// The lists of sweeps.
    lists: Lists,
    used: RefCell<Used>,
    /// What the measures of each run measure, where that is what is looked for, and no number.
    units: Option<&'a Units>,
    /// What was looked up for that, a place for each number.
    placed: RefCell<Vec<Measure>>,
}

/// What the measures of each run measure, by the place of the run.
pub(super) type Units = Vec<Vec<(String, Measure)>>;

/// The numbers of the measures of sweeps, one list after the other; the values of each measure stand before its numbers.
#[derive(Debug, Default)]
pub(super) struct Lists {
    pub(super) numbers: Vec<f64>,
    /// Of the run at this place, which is the first one of a sweep: a measure, where its numbers begin, and how many there are.
    at: Vec<(usize, String, usize, usize)>,
}

/// What the value of a sweep and the warnings of a run are called.
const VALUE: &str = "value";
const WARNINGS: &str = "warnings";

impl Lists {
    fn of(outcome: &Outcome) -> Lists {
        let mut lists = Lists::default();
        for (place, run) in outcome.runs.iter().enumerate() {
            if !matches!(run.swept, Some((0, _))) {
                continue;
            }
            let members: Vec<&RunOutcome> = outcome.members(place).map(|(_, member)| member).collect();
            let values: Vec<f64> = members.iter().filter_map(|m| Some(m.swept?.1)).collect();
            let of = |name: &str| -> Vec<f64> {
                let number = |m: &&RunOutcome| match name {
                    VALUE => m.swept.map_or(f64::NAN, |(_, x)| x),
                    WARNINGS => m.warnings as f64,
                    _ => m.measures.iter().find(|(n, _)| n == name).map_or(f64::NAN, |(_, x)| *x),
                };
                members.iter().map(number).collect()
            };
            for name in measures(run) {
                let numbers = of(&name);
                lists.at.push((place, name, lists.numbers.len() + values.len(), numbers.len()));
                lists.numbers.extend(values.iter().copied().chain(numbers));
            }
        }
        lists
    }
}

impl<'a> OutcomeNames<'a> {
    pub(super) fn new(outcome: &'a Outcome, model: ModelNames<'a>) -> OutcomeNames<'a> {
        let mut claims = model;
        claims.scope = Scope::Claim;
        let (used, placed) = (RefCell::default(), RefCell::default());
        OutcomeNames { outcome, model, claims, lists: Lists::of(outcome), used, units: None, placed }
    }

    /// The same for a look at what expressions measure: their numbers are none.
    pub(super) fn measuring(self, units: &'a Units) -> OutcomeNames<'a> {
        OutcomeNames { units: Some(units), ..self }
    }

    /// What was looked up until now, and the numbers of the lists.
    pub(super) fn used(self) -> (Used, Vec<f64>) {
        (self.used.into_inner(), self.lists.numbers)
    }

    /// Whether this is the name of a function that is called over the numbers of several runs.
    fn takes_several(&self, name: &str) -> bool {
        let lists = !self.lists.at.is_empty();
        name == "abs" || (lists && ["slope", "fit", "min", "max", "mean"].contains(&name))
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
        if let Some(units) = self.units {
            let own = units.get(place)?.iter().find(|(m, _)| m == name);
            let measure = own.map_or(Measure::Unknown, |(_, measure)| *measure);
            let count = self.outcome.members(place).count();
            return Some(self.unit_of(measure, run.swept.map(|_| count)));
        }
        if run.swept.is_some() {
            return self.list(place, run, name);
        }
        if name == WARNINGS {
            self.used.borrow_mut().warnings.insert(place);
            return Some(Entry::Constant(Value::Number(run.warnings as f64)));
        }
        let (_, x) = run.measures.iter().find(|(m, _)| m == name)?;
        self.used.borrow_mut().measures.insert((place, name.to_string()));
        Some(Entry::Constant(Value::Number(*x)))
    }

    /// Something with this unit: a list of so many numbers, or one.
    fn unit_of(&self, measure: Measure, count: Option<usize>) -> Entry {
        let mut placed = self.placed.borrow_mut();
        let first = placed.len();
        placed.extend(std::iter::repeat_n(measure, count.unwrap_or(1)));
        Entry::Field(Field {
            key: NUMBERS,
            path: String::new(),
            first,
            shape: count.map(Some).into_iter().collect(),
            kind: FieldKind::Structure,
            elem: Elem::Double,
            unit: String::new(),
            doc: String::new(),
            owner: String::new(),
        })
    }

    /// The numbers of a measure in all members of a sweep.
    fn list(&self, place: usize, run: &RunOutcome, name: &str) -> Option<Entry> {
        let (_, _, first, count) = self.lists.at.iter().find(|(of, m, ..)| *of == place && m == name)?;
        for (member, _) in self.outcome.members(place) {
            match name {
                WARNINGS => self.used.borrow_mut().warnings.insert(member),
                _ => self.used.borrow_mut().measures.insert((member, name.to_string())),
            };
        }
        Some(Entry::Field(Field {
            key: NUMBERS,
            path: format!("{}.{name}", run.name),
            first: *first,
            shape: vec![Some(*count)],
            kind: FieldKind::Structure,
            elem: Elem::Double,
            unit: String::new(),
            doc: "a number for each value of the sweep".into(),
            owner: format!("the sweep has {count} values"),
        }))
    }
}

fn measures(run: &RunOutcome) -> impl Iterator<Item = String> + '_ {
    let value = run.swept.map(|_| VALUE.to_string());
    run.measures.iter().map(|(m, _)| m.clone()).chain(value).chain([WARNINGS.into()])
}

impl Schema for OutcomeNames<'_> {
    fn identity(&self) -> u64 {
        self.model.identity()
    }

    fn root(&self, name: &str) -> Option<Entry> {
        if let Some((_, x)) = self.outcome.found.iter().find(|(n, _)| n == name) {
            if self.units.is_some() {
                return Some(self.unit_of(Measure::Unknown, None));
            }
            self.used.borrow_mut().found = true;
            return Some(Entry::Constant(Value::Number(*x)));
        }
        if let Some(i) = self.outcome.runs.iter().position(|r| r.name == name) {
            return Some(Entry::Object(ObjectId(RUNS + i as u32)));
        }
        match self.only() {
            Some(run) => self.measure(0, run, name).or_else(|| self.model.root(name)),
            None if self.takes_several(name) => self.claims.root(name),
            None => None,
        }
    }

    fn root_names(&self) -> Vec<String> {
        let found = self.outcome.found.iter().map(|(name, _)| name.clone());
        let runs = found.chain(self.outcome.runs.iter().map(|r| r.name.clone()));
        match self.only() {
            Some(run) => measures(run).chain(runs).chain(self.model.root_names()).collect(),
            None => {
                let functions = self.claims.root_names().into_iter().filter(|name| self.takes_several(name));
                let mut names: Vec<String> = runs.collect();
                names.dedup();
                names.into_iter().chain(functions).collect()
            }
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
        match self.units {
            Some(_) if field == NUMBERS => self.placed.borrow().get(first).copied().unwrap_or_default(),
            _ => self.model.measure(field, first, count),
        }
    }

    fn gives(&self, function: FunctionId, first: Option<f64>) -> Gives {
        self.model.gives(function, first)
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
