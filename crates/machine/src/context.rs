//! The run-time state of programs: variables, lists and registers.

use std::collections::BTreeMap;
use std::sync::Arc;

use crate::global_names::GlobalNames;
use crate::globals::Globals;
use crate::heap::Heap;
use crate::runtime_event::RuntimeEvent;
use crate::value::Value;
use crate::watch::Watch;

/// The state in which programs run: the `ctx` variables, the results of aggregates, and registers. All programs of a lab share
/// one context. A numeric program does not allocate once the registers have grown.
#[derive(Clone, Debug, Default)]
pub struct Context {
    /// The lists, records and functions that values refer to.
    pub heap: Heap,
    pub(crate) globals: Vec<Value>,
    /// Slots of variables by name, for programs that compute a name.
    named: BTreeMap<Arc<str>, u32>,
    /// Variables with computed names that no program mentions literally.
    unnamed: BTreeMap<String, Value>,
    pub(crate) aggregates: Vec<f64>,
    /// Registers of numbers.
    pub numbers: Vec<f64>,
    pub(crate) values: Vec<Value>,
    /// The arguments of a call of the host.
    pub(crate) handed: Vec<Value>,
    /// What happened while programs ran.
    pub events: Vec<RuntimeEvent>,
    /// Records of the runs, if they are watched.
    pub watch: Option<Box<Watch>>,
    /// Work of all runs, without that of the host; `allowed` is the limit for the next run.
    pub(crate) work: u64,
    pub(crate) allowed: Option<u64>,
}

/// Limit on the variables with computed names.
const MAX_UNNAMED: usize = 1000;

/// Limit on the events stored per run.
const MAX_EVENTS: usize = 16;

/// The number of objects above which unreachable ones are freed before the state is copied.
const MAX_COPIED: usize = 16;

impl Context {
    /// A context with all variables `undefined`.
    pub fn new() -> Context {
        Context::default()
    }

    /// A context with all variables `undefined` that already knows their names.
    pub fn for_globals(globals: &Globals) -> Context {
        let mut context = Context::new();
        context.learn(globals.shared_names());
        context
    }

    /// Adds the names of the variables of a program, before it runs, at any time after the context was made. A value that was
    /// stored under a computed name before any program mentioned that name moves to the variable of that name.
    pub fn learn(&mut self, names: &GlobalNames) {
        if names.len() <= self.named.len() {
            return;
        }
        for (slot, name) in names.since(self.named.len()) {
            if let Some(value) = self.unnamed.remove(&*name) {
                self.set(slot, value);
            }
            self.named.insert(name, slot);
        }
    }

    /// Stores a variable for the host, such as the value of a control. Programs find it by name as well.
    pub fn store(&mut self, globals: &Globals, slot: u32, value: Value) {
        self.learn(globals.shared_names());
        self.set(slot, value);
    }

    /// Limits the work of the next run, including work of the host, in units of about a nanosecond. A run also has a fixed
    /// limit, see [`crate::rules::BUDGET`].
    pub fn allow(&mut self, units: u64) {
        self.allowed = Some(units);
    }

    /// Returns the work of all programs in this context, without that of the host. Formulas are too short to be counted.
    pub fn work(&self) -> u64 {
        self.work
    }

    /// Returns a variable by its name.
    pub(crate) fn get_named(&self, name: &str) -> Value {
        match self.named.get(name) {
            Some(slot) => self.get(*slot).clone(),
            None => self.unnamed.get(name).cloned().unwrap_or_default(),
        }
    }

    /// Stores a variable by its name; returns `false` if there are too many.
    pub(crate) fn set_named(&mut self, name: &str, value: Value) -> bool {
        match self.named.get(name) {
            Some(slot) => self.set(*slot, value),
            None if self.unnamed.len() >= MAX_UNNAMED && !self.unnamed.contains_key(name) => return false,
            None => {
                self.unnamed.insert(name.to_owned(), value);
            }
        }
        true
    }

    /// Frees the objects to which no variable, register or input refers.
    pub(crate) fn collect(&mut self, input: Option<&Value>) {
        let Context { heap, globals, unnamed, values, .. } = self;
        heap.collect(globals.iter().chain(unnamed.values()).chain(&*values).chain(input));
    }

    /// A copy of the state, without the lists of expressions that were evaluated earlier: a copy of each of them for each of many runs
    /// would be most of the work.
    pub fn copy(&mut self) -> Context {
        if self.heap.places() > MAX_COPIED {
            self.collect(None);
        }
        self.clone()
    }

    /// Returns a `ctx` variable.
    pub fn get(&self, slot: u32) -> &Value {
        self.globals.get(slot as usize).unwrap_or(&Value::Undefined)
    }

    /// Stores a `ctx` variable of a program whose names have been added.
    pub(crate) fn set(&mut self, slot: u32, value: Value) {
        let i = slot as usize;
        if self.globals.len() <= i {
            self.globals.resize(i + 1, Value::Undefined);
        }
        self.globals[i] = value;
    }

    /// Stores the result of an aggregate for the next runs.
    pub fn set_aggregate(&mut self, slot: usize, value: f64) {
        if self.aggregates.len() <= slot {
            self.aggregates.resize(slot + 1, f64::NAN);
        }
        self.aggregates[slot] = value;
    }

    /// Watches the following runs, or ends the watch with `None`. Returns the previous watch.
    pub fn watch(&mut self, watch: Option<Box<Watch>>) -> Option<Box<Watch>> {
        std::mem::replace(&mut self.watch, watch)
    }

    /// Returns the records of the last run, if runs are watched.
    pub fn watched(&self) -> Option<&Watch> {
        self.watch.as_deref()
    }

    /// Returns the events of the last run, at most one for each location in the program.
    pub fn events(&self) -> &[RuntimeEvent] {
        &self.events
    }

    pub(crate) fn note(&mut self, event: RuntimeEvent) {
        let noted = self.events.iter().any(|e| e.span == event.span && e.kind == event.kind);
        if !noted && self.events.len() < MAX_EVENTS {
            self.events.push(event);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_copy_has_the_variables_and_no_lists_of_earlier_expressions() {
        let mut context = Context::new();
        for i in 0..100 {
            let list = context.heap.numbers(&[f64::from(i), 0.5]).unwrap();
            if i == 40 {
                context.set(2, list);
            }
        }
        assert_eq!(context.clone().heap.places(), 100);
        let mut copy = context.copy();
        assert_eq!(copy.heap.places(), 41);
        assert_eq!(copy.heap.to_numbers(copy.get(2)), Some(vec![40.0, 0.5]));
        // The copy goes on without the original.
        let list = copy.heap.numbers(&[7.0]).unwrap();
        copy.set(2, list);
        assert_eq!(copy.heap.to_numbers(copy.get(2)), Some(vec![7.0]));
        assert_eq!(context.heap.to_numbers(context.get(2)), Some(vec![40.0, 0.5]));
    }
}
