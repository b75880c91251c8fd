//! The programs and the measures of a lab over the fields of another engine: MuJoCo's, which Python runs.
//!
//! Programs run in a world of ours. Its fields are copied from the other engine before, and what programs write is copied back. What
//! the other engine computes (`data.xpos`) is read from copies, the mirror. Functions of the language (`lib.jacobian`) compute with
//! the model and the state of the world.

use crate::error::{error, refused};
use crate::fields::{copied, is_writable, named, numbers};
use crate::models::models;
use crate::source::{LabSource, OpenedLab, open};
use facade::bind::{ActionProgram, Bound as BoundText, ControlProgram, DisplayedLabels, ModelNames};
use facade::bind::{Programs, Scope, World, functions, include};
use facade::spec::Lab as LessonLab;
use facade::{Value, verify};
use labspec_core::reflect::{self, FieldId, FieldSet, Object};
use labspec_core::{self as core, AccessSet, Data, Plan};
use labspec_expr::{Compiler, Context, FieldKey, FunctionId, Globals, Heap, Host, Program};
use pyo3::exceptions::{PyIndexError, PyRuntimeError};
use pyo3::prelude::*;
use std::collections::{BTreeMap, BTreeSet};
use std::sync::{Mutex, MutexGuard, TryLockError};

/// The work limit of one run of a program, in units of about a nanosecond.
const WORK: u64 = 1_000_000_000;

/// The bits of the index in the number that the language passes for an object.
const OBJECT_INDEX: u32 = (1 << 24) - 1;

/// A world whose fields are read from another engine, as far as they were copied.
struct MirroredWorld {
    world: World,
    /// The fields of the other engine, by their number.
    mirror: BTreeMap<u32, Vec<f64>>,
    /// The pairs of geoms in contact in the other engine.
    contacts: Option<Vec<[i32; 2]>>,
    /// The functions that programs have called to compute fields anew.
    passes: BTreeSet<&'static str>,
}

/// Functions that compute fields anew.
fn computes_fields(name: &str) -> bool {
    let reads = ["mj_name2id", "mj_id2name", "mj_contactForce", "mj_jac"];
    let passes = ["forward", "reset", "energy", "massMatrix"];
    (name.starts_with("mj_") && !reads.iter().any(|read| name.starts_with(read))) || passes.contains(&name)
}

impl Host for MirroredWorld {
    fn get(&self, field: FieldKey, index: usize) -> Option<f64> {
        match self.mirror.get(&field.0) {
            Some(values) => values.get(index).copied(),
            None => self.world.get(field, index),
        }
    }

    fn set(&mut self, field: FieldKey, index: usize, value: f64) -> Result<(), String> {
        self.world.set(field, index, value)?;
        let stored = self.world.get(field, index);
        if let Some(place) = self.mirror.get_mut(&field.0).and_then(|values| values.get_mut(index)) {
            *place = stored.unwrap_or(value);
        }
        Ok(())
    }

    fn len(&self, field: FieldKey) -> usize {
        self.mirror.get(&field.0).map_or_else(|| self.world.len(field), Vec::len)
    }

    fn call(&mut self, heap: &mut Heap, function: FunctionId, args: &[Value]) -> Result<Value, String> {
        let name = functions::name(function).unwrap_or_default();
        if let (Some(contacts), "contact") = (&self.contacts, name) {
            // The language passes an object as a number with its index in the lower bits.
            let geom = |i: usize| args.get(i).map(|v| (v.to_number() as u32 & OBJECT_INDEX) as i32);
            let (a, b) = (geom(0).unwrap_or(-1), geom(1));
            let touch = |pair: &[i32; 2]| pair.contains(&a) && b.is_none_or(|b| b != a && pair.contains(&b));
            return Ok(Value::Boolean(contacts.iter().any(touch)));
        }
        let result = self.world.call(heap, function, args);
        if computes_fields(name) {
            self.mirror.clear();
            self.contacts = None;
            self.passes.insert(name);
        }
        result
    }

    fn identity(&self) -> u64 {
        self.world.identity()
    }

    fn work(&self) -> u64 {
        self.world.work()
    }
}

/// The state of an evaluator.
struct State {
    host: MirroredWorld,
    context: Context,
    globals: Globals,
    lab: LessonLab,
    programs: Programs,
    labels: DisplayedLabels,
    /// The compiled measures, and the programs of their arguments.
    measures: Vec<Program>,
    access: AccessSet,
}

/// The programs of a lab over the fields of another engine.
#[pyclass(frozen, module = "labspec._labspec")]
pub(crate) struct Evaluator(Mutex<State>);

impl State {
    fn run(&mut self, program: &Program, value: Option<&Value>) -> Result<Value, String> {
        core::limit(&mut self.host.world.data, WORK);
        self.context.allow(WORK);
        program.run(&mut self.host, &mut self.context, value).map_err(|e| e.message)
    }

    fn run_statements(&mut self, bound: &Option<BoundText>, value: Option<&Value>) -> PyResult<()> {
        let Some(bound) = bound else { return Ok(()) };
        let done = self.run(&bound.program, value);
        done.map(drop).map_err(|message| error("program", &message, &[]))
    }

    /// Adds a program, with those of the arguments of its aggregates.
    fn add(&mut self, program: Program) -> Compiled {
        let aggregates = program.aggregates().to_vec();
        include(program.effects(), &mut self.access);
        let index = self.measures.len();
        self.measures.push(program);
        let one = |aggregate: labspec_expr::Aggregate, state: &mut State| {
            let name = functions::name(aggregate.function).unwrap_or_default();
            let args = aggregate.args.into_iter().map(|arg| state.add(arg)).collect();
            (name, aggregate.slot, args)
        };
        Compiled { index, aggregates: aggregates.into_iter().map(|a| one(a, self)).collect() }
    }
}

/// A control: label, start value, whether it is applied after a reset, whether it resets.
type ControlRow<'py> = (String, Option<Bound<'py, PyAny>>, bool, bool);

/// A compiled text: its number, and its aggregates with their slots and arguments.
#[derive(IntoPyObject)]
pub(crate) struct Compiled {
    index: usize,
    aggregates: Vec<(&'static str, usize, Vec<Compiled>)>,
}

impl Evaluator {
    fn lock(&self) -> PyResult<MutexGuard<'_, State>> {
        match self.0.try_lock() {
            Ok(state) => Ok(state),
            Err(TryLockError::Poisoned(state)) => Ok(state.into_inner()),
            Err(TryLockError::WouldBlock) => Err(PyRuntimeError::new_err("another thread is using this lab")),
        }
    }
}

#[pymethods]
impl Evaluator {
    /// Opens a lab. None of its programs has run.
    #[new]
    #[pyo3(signature = (source, models=None))]
    fn new(source: LabSource, models: Option<&Bound<'_, PyAny>>) -> PyResult<Evaluator> {
        let OpenedLab { lab, model, programs } = open(&source, self::models(models)?)?;
        let world = World {
            data: Data::planned(&model, Plan::new(&model, &AccessSet::ANY)),
            model: (*model).clone(),
            key: lab.keyframe(),
            functions: programs.functions.clone(),
            displayed: Vec::new(),
            numbers: Vec::new(),
            playback: None,
        };
        Ok(Evaluator(Mutex::new(State {
            host: MirroredWorld { world, mirror: BTreeMap::new(), contacts: None, passes: BTreeSet::new() },
            context: Context::for_globals(&programs.globals),
            globals: programs.globals.clone(),
            labels: verify::labels(&lab),
            measures: Vec::new(),
            access: programs.access,
            lab,
            programs,
        })))
    }

    /// The keyframe from which the lab starts.
    #[getter]
    fn key(&self) -> PyResult<Option<usize>> {
        Ok(self.lock()?.lab.keyframe())
    }

    /// The controls: label, start value (`None` for a button), whether it is applied after a reset, and whether it resets.
    fn controls<'py>(&self, py: Python<'py>) -> PyResult<Vec<ControlRow<'py>>> {
        let state = self.lock()?;
        let row = |(label, control): &(String, ControlProgram)| {
            Ok(match control {
                ControlProgram::Change(start, action) => {
                    (label.clone(), Some(python_value(py, start)?), action.init, action.reset)
                }
                ControlProgram::Press(_) => (label.clone(), None, false, false),
            })
        };
        state.programs.controls.iter().map(row).collect()
    }

    /// Compiles a measure, a condition or an expression; or the `setup` of a run, which are statements.
    #[pyo3(signature = (text, statements=false))]
    fn compile(&self, text: &str, statements: bool) -> PyResult<Compiled> {
        let mut state = self.lock()?;
        let mut globals = state.globals.clone();
        let model = state.host.world.model.clone();
        let scope = if statements { Scope::Lab } else { Scope::Measure };
        let names = ModelNames::new(&model, scope).showing(&state.labels);
        let mut compiler = Compiler::new(&names, &mut globals);
        let compiled = if statements { compiler.statements(text) } else { compiler.expression(text) };
        let errors: Vec<_> = compiled.diagnostics.iter().filter(|f| f.is_error()).cloned().collect();
        match compiled.program {
            Some(program) if errors.is_empty() => {
                state.globals = globals;
                Ok(state.add(program))
            }
            _ => {
                let first = errors.first().map_or("it has an error", |f| f.message.as_str());
                let code = errors.first().map_or("call", |f| f.code);
                Err(error(code, &format!("`{text}`: {first}"), &errors))
            }
        }
    }

    /// The fields that programs and measures read.
    fn reads(&self) -> PyResult<Vec<String>> {
        Ok(names(&self.lock()?.access.reads))
    }

    /// The fields that programs and measures may write.
    fn writes(&self) -> PyResult<Vec<String>> {
        Ok(names(&self.lock()?.access.writes))
    }

    /// Copies a field of the other engine. A field that programs may write is also one of ours from now on.
    fn copy(&self, name: &str, values: &Bound<'_, PyAny>) -> PyResult<()> {
        let (field, values) = (full_name(name)?, numbers(values)?);
        let mut state = self.lock()?;
        let host = &mut state.host;
        let World { model, data, .. } = &mut host.world;
        if is_writable(field) && core::length(model, data, field) == values.len() {
            let mut view =
                core::view_mut(model, data, field).map_err(|e| crate::error::refused_by_engine(&e))?;
            values.iter().enumerate().for_each(|(i, x)| {
                view.set(i, *x);
            });
        } else {
            host.mirror.insert(field.index() as u32, values);
        }
        Ok(())
    }

    /// Copies the pairs of geoms in contact.
    fn copy_contacts(&self, pairs: Vec<[i32; 2]>) -> PyResult<()> {
        self.lock()?.host.contacts = Some(pairs);
        Ok(())
    }

    /// The functions that programs have called to compute fields anew, such as "mj_setConst", since the last time.
    fn take_passes(&self) -> PyResult<Vec<&'static str>> {
        Ok(std::mem::take(&mut self.lock()?.host.passes).into_iter().collect())
    }

    /// A field of ours, after programs have written it.
    fn field<'py>(&self, py: Python<'py>, name: &str) -> PyResult<Bound<'py, PyAny>> {
        let field = full_name(name)?;
        let state = self.lock()?;
        let World { model, data, .. } = &state.host.world;
        let view = core::view(model, data, field).map_err(|e| crate::error::refused_by_engine(&e))?;
        copied(py, view, &[view.len()])
    }

    /// Runs the `setup`.
    fn setup(&self) -> PyResult<()> {
        let mut state = self.lock()?;
        let setup = state.programs.setup.clone();
        state.run_statements(&setup, None)
    }

    /// Runs the `controller`. Returns whether there is one.
    fn controller(&self) -> PyResult<bool> {
        let mut state = self.lock()?;
        let controller = state.programs.controller.clone();
        state.run_statements(&controller, None)?;
        Ok(controller.is_some())
    }

    /// Stores the value of a control, and runs its program.
    #[pyo3(signature = (index, value, stores=true))]
    fn apply(&self, index: usize, value: &Bound<'_, PyAny>, stores: bool) -> PyResult<()> {
        let value = crate::numerics::control_value(value)?;
        let mut state = self.lock()?;
        let Some((_, ControlProgram::Change(_, action))) = state.programs.controls.get(index).cloned() else {
            return Err(PyIndexError::new_err("there is no such slider or select"));
        };
        let ActionProgram { param, run, .. } = action;
        if let (Some(slot), true) = (param, stores) {
            let globals = state.globals.clone();
            state.context.store(&globals, slot, value.clone());
        }
        state.run_statements(&run, Some(&value))
    }

    /// Runs the program of a button.
    fn press(&self, index: usize) -> PyResult<()> {
        let mut state = self.lock()?;
        let Some((_, ControlProgram::Press(run))) = state.programs.controls.get(index).cloned() else {
            return Err(PyIndexError::new_err("there is no such button"));
        };
        state.run_statements(&run, None)
    }

    /// Stores the result of an aggregate.
    fn set_aggregate(&self, slot: usize, value: f64) -> PyResult<()> {
        self.lock()?.context.set_aggregate(slot, value);
        Ok(())
    }

    /// The value of a compiled text; `None` where it has none.
    fn value<'py>(&self, py: Python<'py>, index: usize) -> PyResult<Bound<'py, PyAny>> {
        let mut state = self.lock()?;
        let Some(program) = state.measures.get(index).cloned() else {
            return Err(PyIndexError::new_err("there is no such measure"));
        };
        match state.run(&program, None) {
            Ok(value) => python_value(py, &value),
            Err(_) => Ok(py.None().into_bound(py)),
        }
    }

    /// Runs compiled statements.
    fn execute(&self, index: usize) -> PyResult<()> {
        let mut state = self.lock()?;
        let Some(program) = state.measures.get(index).cloned() else {
            return Err(PyIndexError::new_err("there are no such statements"));
        };
        let done = state.run(&program, None);
        done.map(drop).map_err(|message| error("program", &message, &[]))
    }

    /// Evaluates the traces, then the readouts, and displays them to `shown`.
    fn probes<'py>(&self, py: Python<'py>) -> PyResult<Vec<Bound<'py, PyAny>>> {
        let mut state = self.lock()?;
        let programs: Vec<_> =
            state.programs.probes.iter().map(|p| p.bound.as_ref().map(|b| b.program.clone())).collect();
        let evaluate = |state: &mut State, program: &Option<Program>| {
            program.as_ref().and_then(|p| state.run(p, None).ok()).unwrap_or(Value::Undefined)
        };
        let values: Vec<Value> = programs.iter().map(|program| evaluate(&mut state, program)).collect();
        state.host.world.displayed = displayed(&state.lab, &values);
        values.iter().map(|value| python_value(py, value)).collect()
    }

    /// Computes all fields of ours from its state, as the functions of the language need them.
    fn forward(&self) -> PyResult<()> {
        let mut state = self.lock()?;
        let World { model, data, .. } = &mut state.host.world;
        core::limit(data, u64::MAX);
        core::forward(model, data).map_err(|e| refused(&facade::Error::Call(e.to_string())))
    }

    /// Performs a step of ours: the functions of the language then compute with the state before it. The state is copied after it.
    fn follow(&self) -> PyResult<()> {
        let mut state = self.lock()?;
        let World { model, data, .. } = &mut state.host.world;
        core::limit(data, u64::MAX);
        core::step(model, data).map_err(|e| refused(&facade::Error::Call(e.to_string())))
    }
}

/// The displayed values in the order of the labels: readouts with their decimals, traces, both again with their full names.
fn displayed(lab: &LessonLab, values: &[Value]) -> Vec<Value> {
    let (traces, readouts) = values.split_at(lab.traces().count().min(values.len()));
    let round = |(value, readout): (&Value, &facade::spec::Readout)| match value {
        Value::Number(x) if x.is_finite() => Value::Number(facade::run::printed(*x, readout.digits())),
        other => other.clone(),
    };
    let printed: Vec<Value> = readouts.iter().zip(&lab.readouts).map(round).collect();
    printed.iter().chain(traces).chain(traces).chain(&printed).cloned().collect()
}

fn python_value<'py>(py: Python<'py>, value: &Value) -> PyResult<Bound<'py, PyAny>> {
    Ok(match value {
        Value::Number(x) => x.into_pyobject(py)?.into_any(),
        Value::Boolean(b) => b.into_pyobject(py)?.to_owned().into_any(),
        Value::String(text) => text.to_string().into_pyobject(py)?.into_any(),
        _ => py.None().into_bound(py),
    })
}

/// The field "data.qpos", "model.body_mass" or "model.opt.gravity".
fn full_name(name: &str) -> PyResult<FieldId> {
    let (object, field) = name.rsplit_once('.').unwrap_or(("data", name));
    let object = match object {
        "model.opt" => Object::Option,
        "model.stat" => Object::Statistic,
        "model" => Object::Model,
        _ => Object::Data,
    };
    named(&[object], field)
}

fn names(fields: &FieldSet) -> Vec<String> {
    let name = |field: FieldId| {
        let info = field.info();
        let object = match info.object {
            Object::Data => "data",
            Object::Model => "model",
            Object::Option => "model.opt",
            Object::Statistic => "model.stat",
        };
        format!("{object}.{}", info.name)
    };
    let is_declared = |field: &FieldId| reflect::field(field.info().object, field.info().name).is_some();
    fields.iter().filter(is_declared).map(name).collect()
}
