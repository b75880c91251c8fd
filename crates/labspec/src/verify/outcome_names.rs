//! The names of results in conditions: `run.measure`, or the measure alone when there is one run.

use super::layout::{LayoutRun, NumberLayout};
use super::measure_units::RunUnits;
use crate::bind::{ModelNames, NUMBERS, Scope};
use labspec_expr::dimension::Measure;
use labspec_expr::{
    CollectionId, Elem, Entry, Field, FieldKey, FieldKind, FunctionId, FunctionInfo, HostTerms, ObjectId,
    ResultDimension, Role, Schema,
};
use std::cell::Cell;

/// Ids of run objects start here; the ids of the model are below.
const RUNS: u32 = 0x2000;

/// The names in conditions: runs and measures, and with one run also everything that a measure may use.
pub(super) struct OutcomeNames<'a> {
    layout: &'a NumberLayout,
    model: ModelNames<'a>,
    /// Functions that take the numbers of several runs.
    claims: ModelNames<'a>,
    /// The dimensions of the measures, where they are needed.
    units: Option<&'a RunUnits>,
    /// The names that were looked up.
    met: Cell<NamesRead>,
}

/// The names of results of runs in a text.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct NamesRead {
    /// Whether it names a number.
    pub(super) numbers: bool,
    /// Whether it names the list of a sweep.
    pub(super) lists: bool,
}

impl<'a> OutcomeNames<'a> {
    pub(super) fn new(layout: &'a NumberLayout, model: ModelNames<'a>) -> OutcomeNames<'a> {
        let mut claims = model;
        claims.scope = Scope::Claim;
        OutcomeNames { layout, model, claims, units: None, met: Cell::default() }
    }

    /// Adds the dimensions of the measures.
    pub(super) fn measuring(self, units: &'a RunUnits) -> OutcomeNames<'a> {
        OutcomeNames { units: Some(units), ..self }
    }

    /// The names that were looked up by a text compiled with this schema.
    pub(super) fn names_read(&self) -> NamesRead {
        self.met.get()
    }

    /// Whether this is the name of a function over the numbers of several runs.
    fn takes_several(&self, name: &str) -> bool {
        name == "abs" || (self.layout.has_lists() && ["slope", "fit", "min", "max", "mean"].contains(&name))
    }

    fn only_run(&self) -> Option<&LayoutRun> {
        match self.layout.runs.as_slice() {
            [run] => Some(run),
            _ => None,
        }
    }

    fn run(&self, ObjectId(id): ObjectId) -> Option<&LayoutRun> {
        self.layout.runs.get(id.checked_sub(RUNS)? as usize)
    }

    /// The entry of a number of the layout, or of a list of `list` numbers. Records the lookup.
    fn number(&self, path: String, first: usize, list: Option<usize>, of: &str) -> Entry {
        let met = self.met.get();
        let [numbers, lists] = [met.numbers || list.is_none(), met.lists || list.is_some()];
        self.met.set(NamesRead { numbers, lists });
        number(path, first, list, of)
    }

    /// The number, or the list of numbers, of a run with this name.
    fn measured(&self, run: &LayoutRun, name: &str) -> Option<Entry> {
        let result = run.results.iter().find(|result| result.name == name)?;
        let of = match (run.members, result.elements) {
            (Some(members), Some(elements)) => {
                format!("the sweep has {members} values, with {elements} elements of the measure for each")
            }
            (None, Some(elements)) => format!("the measure has {elements} elements"),
            (Some(members), None) => format!("the sweep has {members} values"),
            (None, None) => String::new(),
        };
        Some(self.number(format!("{}.{name}", run.name), result.first, result.list, &of))
    }
}

/// The entry of a number of the layout, or of a list of `list` numbers. `of` says what determines the length of the list.
fn number(path: String, first: usize, list: Option<usize>, of: &str) -> Entry {
    Entry::Field(Field {
        key: NUMBERS,
        path,
        first,
        shape: list.map(Some).into_iter().collect(),
        kind: FieldKind::Structure,
        elem: Elem::Double,
        unit: String::new(),
        doc: if list.is_some() { format!("a list: {of}") } else { String::new() },
        owner: of.to_string(),
    })
}

impl Schema for OutcomeNames<'_> {
    fn identity(&self) -> u64 {
        self.model.identity()
    }

    fn root(&self, name: &str) -> Option<Entry> {
        if let Some((_, place)) = self.layout.found.iter().find(|(n, _)| n == name) {
            return Some(self.number(name.to_string(), *place, None, ""));
        }
        if let Some(i) = self.layout.runs.iter().position(|r| r.name == name) {
            return Some(Entry::Object(ObjectId(RUNS + i as u32)));
        }
        match self.only_run() {
            Some(run) => self.measured(run, name).or_else(|| self.model.root(name)),
            None if self.takes_several(name) => self.claims.root(name),
            None => None,
        }
    }

    fn root_names(&self) -> Vec<String> {
        let found = self.layout.found.iter().map(|(name, _)| name.clone());
        let runs = found.chain(self.layout.runs.iter().map(|r| r.name.clone()));
        match self.only_run() {
            Some(run) => run.names().chain(runs).chain(self.model.root_names()).collect(),
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
            Some(run) => self.measured(run, name),
            None => self.model.member(object, name),
        }
    }

    fn member_names(&self, object: ObjectId) -> Vec<String> {
        match self.run(object) {
            Some(run) => run.names().collect(),
            None => self.model.member_names(object),
        }
    }

    fn describe(&self, object: ObjectId) -> String {
        match self.run(object) {
            Some(run) => format!("the run {}", crate::json::read::named(&run.name)),
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

    fn hint(&self, object: ObjectId, name: &str, index: Option<usize>) -> Option<String> {
        if self.run(object).is_some() { None } else { self.model.hint(object, name, index) }
    }

    fn role(&self, field: FieldKey, index: usize) -> Role {
        self.model.role(field, index)
    }

    fn measure(&self, field: FieldKey, first: usize, count: Option<usize>) -> Measure {
        match self.units {
            Some(units) if field == NUMBERS => self.layout.unit_of(first, units),
            _ => self.model.measure(field, first, count),
        }
    }

    fn gives(&self, function: FunctionId, first: Option<f64>) -> ResultDimension {
        self.model.gives(function, first)
    }

    fn element_help(&self, field: FieldKey, index: usize) -> Option<String> {
        self.model.element_help(field, index)
    }

    fn unit(&self, field: &Field, element: Option<usize>) -> String {
        self.model.unit(field, element)
    }

    fn named_element(&self, field: FieldKey, index: usize) -> Option<String> {
        self.model.named_element(field, index)
    }

    fn result_field(&self, function: FunctionId, object: ObjectId) -> Option<Field> {
        self.model.result_field(function, object)
    }

    fn host_terms(&self) -> &'static HostTerms {
        &labspec_bind::CLAIM_TERMS
    }

    fn refresh(&self) -> Option<String> {
        self.model.refresh()
    }
}
