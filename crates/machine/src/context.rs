//! Where programs run: variables, lists and registers.

use std::collections::BTreeMap;
use std::sync::Arc;

use crate::global_names::GlobalNames;
use crate::globals::Globals;
use crate::heap::Heap;
use crate::runtime_event::RuntimeEvent;
use crate::value::Value;
use crate::watch::Watch;

/// Where programs run: the `ctx` variables, the results of aggregates and registers. One for all
/// programs of a lab; a numeric program allocates nothing once the registers have grown.
#[derive(Clone, Debug, Default)]
pub struct Context {
    /// The lists, records and functions that values refer to.
    pub heap: Heap,
    pub(crate) globals: Vec<Value>,
    /// Slots of variables, by their names: a program may compute a name.
    named: BTreeMap<Arc<str>, u32>,
    /// Variables with computed names that no text names.
    unnamed: BTreeMap<String, Value>,
    pub(crate) aggregates: Vec<f64>,
    /// Registers of numbers.
    pub numbers: Vec<f64>,
    pub(crate) values: Vec<Value>,
    /// What is handed to a function of the host.
    pub(crate) handed: Vec<Value>,
    /// What happened while programs ran.
    pub events: Vec<RuntimeEvent>,
    /// What runs note, where somebody watches them.
    pub watch: Option<Box<Watch>>,
    /// Work of all runs but that of the host, and what the next run may do.
    pub(crate) work: u64,
    pub(crate) allowed: Option<u64>,
}

/// Variables with computed names.
const MAX_UNNAMED: usize = 1000;

/// Events kept of one run.
const MAX_EVENTS: usize = 16;

impl Context {
    /// All variables `undefined`.
    pub fn new() -> Context {
        Context::default()
    }

    /// All variables `undefined`, and their names known: no later run has to learn them.
    pub fn for_globals(globals: &Globals) -> Context {
        let mut context = Context::new();
        context.learn(globals.shared_names());
        context
    }

    /// Takes in the names of variables before a program runs that was compiled with them, whenever this context was made. What was
    /// stored under a computed name before any text named it is found under that name from now on.
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

    /// Stores a variable for the host, such as what a control gives. Programs find it by its name, too.
    pub fn store(&mut self, globals: &Globals, slot: u32, value: Value) {
        self.learn(globals.shared_names());
        self.set(slot, value);
    }

    /// Lets the next run do so much work and no more, in units of about a nanosecond; work of the host counts too. A run
    /// has a limit of its own besides, see [`crate::rules::BUDGET`].
    pub fn allow(&mut self, units: u64) {
        self.allowed = Some(units);
    }

    /// The work that programs did in this context, without that of the host. Formulas are too short to be counted.
    pub fn work(&self) -> u64 {
        self.work
    }

    /// A variable by its name.
    pub(crate) fn get_named(&self, name: &str) -> Value {
        match self.named.get(name) {
            Some(slot) => self.get(*slot).clone(),
            None => self.unnamed.get(name).cloned().unwrap_or_default(),
        }
    }

    /// Stores a variable by its name; `false` when there are too many.
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

    /// Collects what neither a variable nor a register nor the input refers to.
    pub(crate) fn collect(&mut self, input: Option<&Value>) {
        let Context { heap, globals, unnamed, values, .. } = self;
        heap.collect(globals.iter().chain(unnamed.values()).chain(&*values).chain(input));
    }

    /// A `ctx` variable.
    pub fn get(&self, slot: u32) -> &Value {
        self.globals.get(slot as usize).unwrap_or(&Value::Undefined)
    }

    /// Stores a `ctx` variable of a program whose names are known.
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

    /// Watches the runs that follow; `None` ends that. What was watched until now comes back.
    pub fn watch(&mut self, watch: Option<Box<Watch>>) -> Option<Box<Watch>> {
        std::mem::replace(&mut self.watch, watch)
    }

    /// What the last run noted, if runs are watched.
    pub fn watched(&self) -> Option<&Watch> {
        self.watch.as_deref()
    }

    /// What happened in the last run, one event for each place in the program.
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
