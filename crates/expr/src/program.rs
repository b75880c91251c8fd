//! What a host needs to run programs: itself as a [`Host`], a [`Context`] to run in, and the compiled [`Program`].

use std::collections::BTreeMap;
use std::fmt;
use std::sync::Arc;

use crate::Span;
use crate::dimension::Measure;
use crate::effects::{Access, Effects};
use crate::form::measure::{Given, Measured, measured};
use crate::form::order::Order;
use crate::form::{self, Form, pure};
use crate::formula::Formula;
use crate::globals::Globals;
use crate::heap::Heap;
use crate::ir::Tree;
use crate::known::Known;
use crate::row::Row;
use crate::rules::{self, Rule};
use crate::schema::{FieldKey, FunctionId, Schema, Type};
use crate::value::Value;
use crate::vm::{self, Code};
use crate::watch::Watch;

/// The host while a program runs. Indexes count from the start of the whole field, as [`crate::Field::first`].
pub trait Host {
    /// Element `index`; `None` past the end.
    fn get(&self, field: FieldKey, index: usize) -> Option<f64>;

    /// Several elements at once, into as many numbers; `false` when one of them does not exist. This is how an
    /// expression reads everything that it needs, sorted by field and index.
    fn read(&self, elements: &[(FieldKey, u32)], out: &mut [f64]) -> bool {
        out.iter_mut().zip(elements).all(|(x, &(field, index))| match self.get(field, index as usize) {
            Some(now) => {
                *x = now;
                true
            }
            None => false,
        })
    }

    /// Stores an element that exists.
    ///
    /// # Errors
    /// The host refuses: the text becomes the message of a [`RuntimeError`].
    fn set(&mut self, field: FieldKey, index: usize, value: f64) -> Result<(), String>;

    /// Number of elements of the whole field, now.
    fn len(&self, field: FieldKey) -> usize;

    /// Calls a function. Lists and records among the arguments and the result live in `heap`. Arguments for [`crate::Param::Object`] are not passed; parameters that were left out
    /// make the list shorter.
    ///
    /// # Errors
    /// The call fails: the text becomes the message of a [`RuntimeError`].
    fn call(&mut self, heap: &mut Heap, function: FunctionId, args: &[Value]) -> Result<Value, String>;

    /// What the numbers of fields and elements are of here, as [`crate::Schema::identity`] says of programs. Hosts of one kind need not
    /// tell.
    fn identity(&self) -> u64 {
        0
    }

    /// The work that calls did so far, in units of about a nanosecond: it counts as work of the program that calls.
    fn work(&self) -> u64 {
        0
    }
}

/// Why a run ended early.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RuntimeError {
    /// What was broken, one of [`rules::ALL`].
    pub rule: &'static Rule,
    /// The part of the program that failed.
    pub span: Span,
    /// What happened.
    pub message: String,
}

impl fmt::Display for RuntimeError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.message)
    }
}

impl std::error::Error for RuntimeError {}

/// What happened that JavaScript passes over in silence.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EventKind {
    /// An element that does not exist was read: it is `undefined`.
    ReadPastEnd,
    /// An element that does not exist was assigned: nothing happened.
    StorePastEnd,
}

/// Something noteworthy of the last run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RuntimeEvent {
    /// What.
    pub kind: EventKind,
    /// The part of the program.
    pub span: Span,
    /// The field.
    pub field: FieldKey,
    /// The index as written, in the view; may be negative, fractional or NaN.
    pub index: f64,
    /// How many elements the view had.
    pub len: usize,
}

impl RuntimeEvent {
    /// What was broken, one of [`rules::ALL`]. To read past the end breaks nothing: it gives `undefined`, which may be meant.
    pub fn rule(&self) -> Option<&'static Rule> {
        match self.kind {
            EventKind::ReadPastEnd => None,
            EventKind::StorePastEnd => Some(rules::STORE_PAST_END),
        }
    }
}

impl fmt::Display for RuntimeEvent {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let index = crate::number::to_text(self.index);
        let outcome = match self.kind {
            EventKind::ReadPastEnd => "was read: the value is `undefined`",
            EventKind::StorePastEnd => "was assigned: nothing was stored",
        };
        let count = match self.len {
            0 => "there are none now".to_owned(),
            1 => "there is one element now, index 0".to_owned(),
            n => format!("there are {n} elements now, indexes 0 to {}", n - 1),
        };
        write!(f, "element {index} {outcome}; {count}")
    }
}

/// Where programs run: the `ctx` variables, the results of aggregates and room for computing. One for all
/// programs of a lab; a numeric program allocates nothing once the room has grown.
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
    pub(crate) numbers: Vec<f64>,
    pub(crate) values: Vec<Value>,
    /// What is handed to a function of the host.
    pub(crate) handed: Vec<Value>,
    pub(crate) events: Vec<RuntimeEvent>,
    /// What runs note, where somebody watches them.
    pub(crate) watch: Option<Box<Watch>>,
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
        context.learn(globals.stored());
        context
    }

    /// Takes in the names of variables before a program runs that was compiled with them, whenever this context was made. What was
    /// stored under a computed name before any text named it is found under that name from now on.
    fn learn(&mut self, stored: &Known) {
        if stored.len() <= self.named.len() {
            return;
        }
        for (slot, name) in stored.since(self.named.len()) {
            if let Some(value) = self.unnamed.remove(&*name) {
                self.set(slot, value);
            }
            self.named.insert(name, slot);
        }
    }

    /// Stores a variable for the host, such as what a control gives. Programs find it by its name, too.
    pub fn store(&mut self, globals: &Globals, slot: u32, value: Value) {
        self.learn(globals.stored());
        self.set(slot, value);
    }

    /// Lets the next run do so much work and no more, in units of about a nanosecond; work of the host counts too. A run
    /// has a limit of its own besides, see [`rules::BUDGET`].
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
        let is_repeated = self.events.iter().any(|e| e.span == event.span && e.kind == event.kind);
        if !is_repeated && self.events.len() < MAX_EVENTS {
            self.events.push(event);
        }
    }
}

/// The call of an aggregate function in a program: `first(contact('a', 'b'))`, `max(x)`. The host runs `args` over
/// many samples, stores what it makes of them with [`Context::set_aggregate`], then runs the program.
#[derive(Clone, Debug)]
pub struct Aggregate {
    /// Which function.
    pub function: FunctionId,
    /// Its arguments, each a program. They may hold aggregates of their own.
    pub args: Vec<Program>,
    /// Where the result goes; no two aggregates of one source text share a slot.
    pub slot: usize,
    /// Where the call stands.
    pub span: Span,
}

impl Aggregate {
    /// What its result measures.
    fn measure(&self, schema: &dyn Schema, given: &Given) -> Measure {
        let arg = |i: usize| self.args.get(i).map_or(Measure::Unknown, |p| p.measured(schema, given).value);
        schema.function(self.function).gives.result_of(arg)
    }
}

/// A compiled text.
#[derive(Clone, Debug)]
pub struct Program {
    pub(crate) code: Arc<Code>,
    pub(crate) effects: Effects,
    pub(crate) result: Type,
    pub(crate) aggregates: Vec<Aggregate>,
    pub(crate) order: Order,
    /// The variables that were named when it was compiled.
    pub(crate) stored: Known,
    /// What the numbers of its fields and elements are of ([`crate::Schema::identity`]).
    pub(crate) identity: u64,
    /// What it computes, if it is a numeric expression without effects.
    pub(crate) formula: Option<Arc<Formula>>,
    /// The shorter way to run that.
    pub(crate) row: Option<Arc<Row>>,
}

impl Program {
    /// The code of a tree that was bound to a schema, with the variables that are named by then.
    pub(crate) fn new(
        tree: &Tree,
        schema: &dyn Schema,
        result: Type,
        aggregates: Vec<Aggregate>,
        globals: &Globals,
    ) -> Program {
        let form = Form::from_tree(tree);
        let effects = form::effects(&form, schema);
        let formula = form.units.first().and_then(pure::whole).map(Arc::new);
        let row = formula.as_deref().and_then(Row::from_formula).map(Arc::new);
        let order = Order::from_form(&form, &effects);
        Program {
            code: Code::from_form(form, row.is_none()).into(),
            effects,
            result,
            aggregates,
            order,
            stored: globals.stored().clone(),
            identity: schema.identity(),
            formula,
            row,
        }
    }

    /// What it was compiled for: the [`crate::Schema::identity`] of then.
    pub fn identity(&self) -> u64 {
        self.identity
    }

    /// What it touches.
    pub fn effects(&self) -> &Effects {
        &self.effects
    }

    /// What its numbers measure. `schema` is what it was compiled for; it may know more of the units by now.
    pub fn measured(&self, schema: &dyn Schema, given: &Given) -> Measured {
        let aggregates = self.aggregates.iter().map(|a| (a.slot, a.measure(schema, given))).collect();
        measured(&self.code.form, schema, given, &aggregates).of_type(self.result)
    }

    /// What every run stores after the last call of a function of the host that it may make; `None` when it never
    /// calls it. What some way through the text passes by is not certain and left out.
    pub fn writes_after(&self, function: FunctionId) -> Option<Vec<Access>> {
        self.order.writes_after(function)
    }

    /// What the text may store itself, rather than a function of the host that it calls.
    pub fn own_writes(&self) -> Vec<Access> {
        self.order.own_writes()
    }

    /// The type of its value; [`Type::Void`] for statements.
    pub fn result_type(&self) -> Type {
        self.result
    }

    /// The aggregates whose results it needs before it runs.
    pub fn aggregates(&self) -> &[Aggregate] {
        &self.aggregates
    }

    /// Runs it once. `value` is what the control gives, if any. Statements give `undefined`.
    ///
    /// # Errors
    /// The host is of something else than what the program was compiled for, as another model: nothing is run. A function of the
    /// host fails, the host refuses to store a value, or a string grows beyond its limit. What was stored before stays stored,
    /// as in JavaScript.
    pub fn run(
        &self,
        host: &mut dyn Host,
        context: &mut Context,
        value: Option<&Value>,
    ) -> Result<Value, RuntimeError> {
        if host.identity() != self.identity {
            return Err(foreign());
        }
        if let Some(row) = &self.row
            && let Some(value) = self.quick(row, host, context)
        {
            context.events.clear();
            return Ok(value);
        }
        context.learn(&self.stored);
        vm::run(&self.code, host, context, value)
    }

    /// The value of a formula; `None` where the machine has to run it: an element does not exist, or a watch needs places.
    #[inline]
    fn quick(&self, row: &Row, host: &dyn Host, context: &mut Context) -> Option<Value> {
        match &mut context.watch {
            None => row.value(host, &mut context.numbers),
            Some(watch) => {
                watch.begin();
                row.watched_value(host, &mut context.numbers, watch).filter(|_| !watch.loses())
            }
        }
    }
}

#[cold]
fn foreign() -> RuntimeError {
    let message = "the program was compiled for something else; compile it for what it runs on".to_string();
    RuntimeError { rule: rules::HOST_CALL, span: Span::default(), message }
}
