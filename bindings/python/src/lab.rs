//! A lab: what a student can do to it on a page, and what the page displays.

use crate::error::{error, refused};
use crate::fields::copied;
use crate::model::Model;
use crate::models::models;
use crate::numerics::control_value;
use crate::report::finding_dict;
use facade::player::{ControlKind, DisplayedIn, Saved};
use facade::run::{Cell, Table};
use facade::{Player, Value};
use labspec_core::reflect::{self, Object};
use labspec_core::{self as core};
use labspec_finding::nearest;
use labspec_plot::line_chart;
use pyo3::buffer::PyBuffer;
use pyo3::exceptions::{PyKeyError, PyRuntimeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};
use std::sync::{Mutex, MutexGuard, PoisonError};

/// Simulated steps between two looks at Ctrl-C.
const STEPS_BETWEEN_SIGNALS: usize = 10_000;

/// A lab that is open.
#[pyclass(frozen, module = "labspec")]
pub(crate) struct Lab {
    player: Mutex<Player>,
}

/// A state of a lab, with its model and the values of its controls.
#[pyclass(frozen, module = "labspec")]
pub(crate) struct LabState(Mutex<Saved>);

impl Lab {
    fn from_player(player: Result<Player, facade::Error>) -> PyResult<Lab> {
        Ok(Lab { player: Mutex::new(player.map_err(|e| refused(&e))?) })
    }

    fn lock(&self) -> PyResult<MutexGuard<'_, Player>> {
        match self.player.try_lock() {
            Ok(player) => Ok(player),
            Err(std::sync::TryLockError::Poisoned(player)) => Ok(player.into_inner()),
            Err(std::sync::TryLockError::WouldBlock) => {
                Err(PyRuntimeError::new_err("another thread is using this lab: give each thread its own"))
            }
        }
    }

    /// Calls a function with the lab, without the interpreter.
    fn with<T: Send>(
        &self,
        py: Python<'_>,
        what: impl FnOnce(&mut Player) -> Result<T, facade::Error> + Send,
    ) -> PyResult<T> {
        py.detach(|| what(&mut *self.lock()?).map_err(|e| refused(&e)))
    }
}

#[pymethods]
impl Lab {
    /// Opens a lab from its JSON.
    #[staticmethod]
    #[pyo3(signature = (json, models=None))]
    fn from_json(json: &str, models: Option<&Bound<'_, PyAny>>) -> PyResult<Lab> {
        Lab::from_player(Player::of_lab(json, self::models(models)?))
    }

    /// Opens a lab of a lesson by its address, "#2" or "#quiz-id.1".
    #[staticmethod]
    #[pyo3(signature = (path, text, address, models=None))]
    fn from_lesson(
        path: &str,
        text: &str,
        address: &str,
        models: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Lab> {
        Lab::from_player(Player::of_lesson(path, text, address, self::models(models)?))
    }

    /// Performs steps, whether or not the lab has reached its `stopAt`.
    #[pyo3(signature = (steps=1))]
    fn step(&self, py: Python<'_>, steps: usize) -> PyResult<()> {
        let mut left = steps;
        while left > 0 {
            let now = left.min(STEPS_BETWEEN_SIGNALS);
            self.with(py, |player| (0..now).try_for_each(|_| player.step()))?;
            left -= now;
            if left > 0 {
                py.check_signals()?;
            }
        }
        Ok(())
    }

    /// Plays until a time, s, or until the lab stops by itself. Returns the number of steps.
    fn play_to(&self, py: Python<'_>, time: f64) -> PyResult<usize> {
        if !time.is_finite() {
            return Err(PyValueError::new_err("the time to play to must be finite"));
        }
        let mut steps = 0;
        loop {
            let (now, timestep, is_over) = {
                let player = self.lock()?;
                (player.time(), player.timestep(), player.is_over())
            };
            if is_over || now >= time {
                return Ok(steps);
            }
            let next = time.min(now + timestep * STEPS_BETWEEN_SIGNALS as f64);
            let made = self.with(py, |player| player.play_to(next))?;
            if made == 0 {
                return Ok(steps);
            }
            steps += made;
            py.check_signals()?;
        }
    }

    /// Resets the lab like the button of the page: controls and model keep their values.
    fn reset(&self) -> PyResult<()> {
        self.lock()?.reset();
        Ok(())
    }

    /// The simulated time, s.
    #[getter]
    fn time(&self) -> PyResult<f64> {
        Ok(self.lock()?.time())
    }

    /// The length of a step, s.
    #[getter]
    fn timestep(&self) -> PyResult<f64> {
        Ok(self.lock()?.timestep())
    }

    /// Whether the lab does not continue without a reset.
    #[getter]
    fn is_over(&self) -> PyResult<bool> {
        Ok(self.lock()?.is_over())
    }

    /// The controls as dictionaries.
    fn controls<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyList>> {
        let player = self.lock()?;
        let list = PyList::empty(py);
        for control in player.controls() {
            let dict = PyDict::new(py);
            dict.set_item("label", &control.label)?;
            dict.set_item("start", value_of(py, &control.start)?)?;
            match &control.kind {
                ControlKind::Slider { min, max, step, digits, unit } => {
                    dict.set_item("kind", "slider")?;
                    dict.set_item("unit", unit.as_str())?;
                    dict.set_item("min", *min)?;
                    dict.set_item("max", *max)?;
                    dict.set_item("step", *step)?;
                    dict.set_item("digits", *digits)?;
                }
                ControlKind::Select { options } => {
                    dict.set_item("kind", "select")?;
                    let all = PyList::empty(py);
                    for (text, value) in options {
                        all.append((text, value_of(py, value)?))?;
                    }
                    dict.set_item("options", all)?;
                }
                ControlKind::Button => dict.set_item("kind", "button")?,
            }
            list.append(dict)?;
        }
        Ok(list)
    }

    /// The current value of a control.
    fn value<'py>(&self, py: Python<'py>, label: &str) -> PyResult<Bound<'py, PyAny>> {
        let player = self.lock()?;
        let value = player.value(label).ok_or_else(|| unknown_control(&player, label))?;
        value_of(py, value)
    }

    /// Moves a slider, or selects an option by its displayed text or its value.
    fn set(&self, label: &str, value: &Bound<'_, PyAny>) -> PyResult<()> {
        let mut player = self.lock()?;
        if player.value(label).is_none() {
            return Err(unknown_control(&player, label));
        }
        player.set(label, control_value(value)?).map_err(|e| refused(&e))
    }

    /// Presses a button.
    fn press(&self, label: &str) -> PyResult<()> {
        self.lock()?.press(label).map_err(|e| refused(&e))
    }

    /// The displayed values: label, unit, "trace" or "readout", plot or decimals.
    fn displayed(&self) -> PyResult<Vec<(String, String, &'static str, usize)>> {
        let player = self.lock()?;
        let row = |value: &facade::player::DisplayedValue| {
            let (place, number) = match value.place {
                DisplayedIn::Plot(plot) => ("trace", plot),
                DisplayedIn::Readout(digits) => ("readout", digits as usize),
            };
            (value.label.clone(), value.unit.clone(), place, number)
        };
        Ok(player.displayed().iter().map(row).collect())
    }

    /// The displayed values now: numbers, texts or booleans, in the order of `displayed`.
    fn values<'py>(&self, py: Python<'py>) -> PyResult<Vec<Bound<'py, PyAny>>> {
        let player = self.lock()?;
        let value = |cell: &Cell| -> PyResult<Bound<'py, PyAny>> {
            Ok(match cell {
                Cell::Number(x) => x.into_pyobject(py)?.into_any(),
                Cell::Bool(b) => b.into_pyobject(py)?.to_owned().into_any(),
                Cell::Text(text) => text.into_pyobject(py)?.into_any(),
                Cell::Nothing => py.None().into_bound(py),
            })
        };
        player.values().iter().map(value).collect()
    }

    /// The readouts as the page prints them.
    fn readout_texts(&self) -> PyResult<Vec<String>> {
        Ok(self.lock()?.readout_texts())
    }

    /// Performs steps, and returns a row for the start and for every `every` steps: the time, then the displayed values as numbers. The
    /// rows are bytes of 64-bit floats. The recording ends early if the lab is over.
    fn record<'py>(
        &self,
        py: Python<'py>,
        steps: usize,
        every: usize,
    ) -> PyResult<(usize, Bound<'py, PyAny>)> {
        if every == 0 {
            return Err(PyValueError::new_err("`every` must be at least 1 step"));
        }
        let mut rows: Vec<f64> = Vec::new();
        let width = 1 + self.lock()?.displayed().len();
        let add = |player: &Player, rows: &mut Vec<f64>| {
            rows.push(player.time());
            rows.extend_from_slice(player.numbers());
        };
        add(&*self.lock()?, &mut rows);
        let mut made = 0;
        while made < steps {
            let end = steps.min(made + STEPS_BETWEEN_SIGNALS);
            let is_over = self.with(py, |player| {
                while made < end && !player.is_over() {
                    player.step()?;
                    made += 1;
                    if made % every == 0 {
                        add(player, &mut rows);
                    }
                }
                Ok(player.is_over())
            })?;
            if is_over {
                break;
            }
            py.check_signals()?;
        }
        let shape = [rows.len() / width, width];
        let view = reflect::View::F64(&rows);
        Ok((made, copied(py, view, &shape)?))
    }

    /// Draws the plots as `labspec run --svg` does. The rows are those of `record`, as 64-bit floats.
    fn draw(&self, py: Python<'_>, rows: PyBuffer<f64>) -> PyResult<Vec<String>> {
        let numbers = rows.to_vec(py)?;
        let player = self.lock()?;
        let table = table(&player, &numbers);
        let plots = player.lab().plots.iter().enumerate();
        let svg = plots.map(|(i, plot)| line_chart(&labspec_site::chart(player.lab(), plot, i, &table)));
        Ok(svg.collect())
    }

    /// The title and the kind of the lab.
    fn title(&self) -> PyResult<(String, String)> {
        let player = self.lock()?;
        let lab = player.lab();
        Ok((lab.title().to_string(), lab.kind().to_string()))
    }

    /// A field of the data ("qpos") or of the model as the lab changed it ("body_mass", "opt.gravity"): a copy, as after `mj_forward`.
    fn field<'py>(&self, py: Python<'py>, name: &str) -> PyResult<Bound<'py, PyAny>> {
        let field = match name.split_once('.') {
            Some(("opt", name)) => crate::fields::named(&[Object::Option], name)?,
            Some(("stat", name)) => crate::fields::named(&[Object::Statistic], name)?,
            _ => crate::fields::named(&[Object::Data, Object::Model], name)?,
        };
        let mut player = self.lock()?;
        let (model, scene) = player.model_and_scene().map_err(|e| refused(&e))?;
        let view = core::view(model, scene, field).map_err(|e| crate::error::refused_by_engine(&e))?;
        let dimensions = reflect::shape(model, field);
        let fixed: usize = dimensions.iter().flatten().product();
        let shape: Vec<usize> =
            dimensions.iter().map(|dim| dim.unwrap_or(view.len() / fixed.max(1))).collect();
        copied(py, view, &shape)
    }

    /// A copy of the model with the changes of controls and programs.
    fn model(&self) -> PyResult<Model> {
        Model::from_compiled(self.lock()?.model().clone())
    }

    /// The findings of opening the lab and of its run so far.
    fn findings<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyList>> {
        let list = PyList::empty(py);
        for finding in self.lock()?.findings() {
            list.append(finding_dict(py, &finding)?)?;
        }
        Ok(list)
    }

    /// The state of the lab.
    fn save(&self) -> PyResult<LabState> {
        Ok(LabState(Mutex::new(self.lock()?.save())))
    }

    /// Restores a state of this lab. It then continues with equal results, bit for bit.
    fn restore(&self, state: &LabState) -> PyResult<()> {
        let saved = state.0.lock().unwrap_or_else(PoisonError::into_inner);
        self.lock()?.restore(&saved).map_err(|e| error("foreign-state", &e.to_string(), &[]))
    }
}

/// The samples of a recording as the table of a run.
fn table(player: &Player, numbers: &[f64]) -> Table {
    let name = |value: &facade::player::DisplayedValue| match value.place {
        DisplayedIn::Plot(plot) => format!("plot/{plot}/{}", value.label),
        DisplayedIn::Readout(_) => format!("readout/{}", value.label),
    };
    let names = player.displayed().iter().map(name);
    let columns: Vec<String> = std::iter::once("time".to_string()).chain(names).collect();
    let cells = |row: &[f64]| row.iter().map(|x| Cell::Number(*x)).collect();
    Table {
        timestep: player.timestep(),
        rows: numbers.chunks_exact(columns.len()).map(cells).collect(),
        columns,
        warnings: Vec::new(),
        breakdowns: Vec::new(),
        errors: Vec::new(),
    }
}

fn unknown_control(player: &Player, label: &str) -> PyErr {
    let near = nearest(label, player.controls().iter().map(|c| c.label.as_str()));
    let help = near.map_or(String::new(), |near| format!("; did you mean \"{near}\"?"));
    PyKeyError::new_err(format!("the lab has no control \"{label}\"{help}"))
}

fn value_of<'py>(py: Python<'py>, value: &Value) -> PyResult<Bound<'py, PyAny>> {
    Ok(match value {
        Value::Number(x) => x.into_pyobject(py)?.into_any(),
        Value::Boolean(b) => b.into_pyobject(py)?.to_owned().into_any(),
        other => other.to_string().into_pyobject(py)?.into_any(),
    })
}
