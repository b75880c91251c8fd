//! The state and the results of a simulation.

use crate::error::refused_by_engine;
use crate::fields::{copied, is_writable, live, named, not_writable, numbers};
use crate::model::{Model, store};
use labspec_core::reflect::{self, FieldId, Object};
use labspec_core::{self as core, Data as EngineData, Error, Full};
use pyo3::exceptions::{PyIndexError, PyRuntimeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::PyBytes;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError, RwLock, TryLockError};

/// Steps between two looks at Ctrl-C.
const STEPS_BETWEEN_SIGNALS: usize = 10_000;

/// A simulation of a model. Its fields are NumPy arrays that show its memory: `data.qvel[2] = 1`.
#[pyclass(frozen, module = "labspec")]
pub(crate) struct Data {
    model: Py<Model>,
    /// Replaced by `restore`: views of the data before it keep those.
    data: RwLock<Arc<Mutex<EngineData<Full>>>>,
}

/// Functions of the model and the data, by their names without `mj_`.
type Pass = fn(&core::Model, &mut EngineData<Full>) -> Result<(), Error>;
const PASSES: [(&str, Pass); 11] = [
    ("forward", core::forward),
    ("inverse", core::inverse),
    ("resetData", core::reset_data),
    ("kinematics", core::kinematics),
    ("fwdPosition", core::fwd_position),
    ("fwdVelocity", core::fwd_velocity),
    ("collision", core::collision),
    ("energyPos", core::energy_pos),
    ("energyVel", core::energy_vel),
    ("subtreeVel", core::subtree_vel),
    ("rnePostConstraint", core::rne_post_constraint),
];

impl Data {
    /// The current memory of the data.
    fn memory(&self) -> Arc<Mutex<EngineData<Full>>> {
        Arc::clone(&self.data.read().unwrap_or_else(PoisonError::into_inner))
    }

    /// Calls a function with the model and the data, without the interpreter.
    fn with<T: Send>(
        &self,
        py: Python<'_>,
        what: impl FnOnce(&core::Model, &mut EngineData<Full>) -> Result<T, Error> + Send,
    ) -> PyResult<T> {
        let (model, memory) = (self.model.get(), self.memory());
        // No lock is held while the error is made, which needs the interpreter.
        let result = py.detach(|| -> PyResult<Result<T, Error>> {
            if model.read().is_stale()
                && let Err(e) = model.write().sync()
            {
                return Ok(Err(e));
            }
            let shared = model.read();
            let mut data = lock(&memory)?;
            Ok(what(&shared.model, &mut data))
        });
        result?.map_err(|e| refused_by_engine(&e))
    }
}

/// The data, unless another thread is using them.
fn lock(memory: &Mutex<EngineData<Full>>) -> PyResult<MutexGuard<'_, EngineData<Full>>> {
    match memory.try_lock() {
        Ok(data) => Ok(data),
        Err(TryLockError::Poisoned(data)) => Ok(data.into_inner()),
        Err(TryLockError::WouldBlock) => {
            Err(PyRuntimeError::new_err("another thread is using these data: give each thread its own"))
        }
    }
}

#[pymethods]
impl Data {
    #[new]
    fn new(model: Py<Model>) -> Data {
        let data = EngineData::new(&model.get().read().model);
        Data { model, data: RwLock::new(Arc::new(Mutex::new(data))) }
    }

    /// The model.
    #[getter]
    fn model(&self, py: Python<'_>) -> Py<Model> {
        self.model.clone_ref(py)
    }

    /// Performs steps. Ctrl-C ends them after a step.
    #[pyo3(signature = (steps=1))]
    fn step(&self, py: Python<'_>, steps: usize) -> PyResult<()> {
        let mut left = steps;
        while left > 0 {
            let now = left.min(STEPS_BETWEEN_SIGNALS);
            self.with(py, |m, d| (0..now).try_for_each(|_| core::step(m, d)))?;
            left -= now;
            if left > 0 {
                py.check_signals()?;
            }
        }
        Ok(())
    }

    /// Calls a function of MuJoCo by its name without `mj_`: "forward", "inverse", "kinematics".
    fn call(&self, py: Python<'_>, name: &str) -> PyResult<()> {
        let found = PASSES.iter().find(|(listed, _)| *listed == name);
        let (_, pass) = found.ok_or_else(|| {
            let names: Vec<&str> = PASSES.iter().map(|(name, _)| *name).collect();
            PyValueError::new_err(format!("there is no function `{name}`: use one of {}", names.join(", ")))
        })?;
        self.with(py, pass)
    }

    /// Resets the data to the default configuration, or to a keyframe, from 0.
    #[pyo3(signature = (key=None))]
    fn reset(&self, py: Python<'_>, key: Option<usize>) -> PyResult<()> {
        let Some(key) = key else { return self.with(py, core::reset_data) };
        let (id, count) = {
            let shared = self.model.get().read();
            (shared.model.keys().nth(key), shared.model.nkey)
        };
        let id = id.ok_or_else(|| {
            PyIndexError::new_err(format!("the model has {count} keyframes, counted from 0"))
        })?;
        self.with(py, |m, d| core::reset_data_keyframe(m, d, id))
    }

    /// Computes the constants of the model that depend on masses, inertias and poses. The data are set to the default configuration.
    fn set_const(&self) -> PyResult<()> {
        let mut shared = self.model.get().write();
        shared.sync().map_err(|e| refused_by_engine(&e))?;
        let memory = self.memory();
        let mut data = lock(&memory)?;
        core::set_const(&mut shared.model, &mut data).map_err(|e| refused_by_engine(&e))
    }

    /// A field of the data: "qpos".
    fn field<'py>(slf: &Bound<'py, Self>, name: &str) -> PyResult<Bound<'py, PyAny>> {
        let (py, field) = (slf.py(), named(&[Object::Data], name)?);
        let shared = slf.get().model.get().read();
        let memory = slf.get().memory();
        let data = lock(&memory)?;
        let view = core::view(&shared.model, &data, field).map_err(|e| refused_by_engine(&e))?;
        let shape = shape(&shared.model, field, view.len());
        let seen = match shape.is_empty() {
            true => None,
            false => live(py, memory.clone(), field, view, &shape)?,
        };
        match seen {
            Some(seen) => Ok(seen),
            None => copied(py, view, &shape),
        }
    }

    /// Writes a field of the data: all its numbers, or one.
    fn set_field(&self, name: &str, value: &Bound<'_, PyAny>) -> PyResult<()> {
        let (field, values) = (named(&[Object::Data], name)?, numbers(value)?);
        if !is_writable(field) {
            return Err(not_writable(field));
        }
        let memory = self.memory();
        let mut data = lock(&memory)?;
        let mut view = data.write(field).map_err(|e| refused_by_engine(&e))?;
        store(field, &mut view, &values)
    }

    /// The complete simulation as bytes: state, inputs and results. They are read by the same version only.
    fn save<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyBytes>> {
        let bytes = self.with(py, |m, d| core::save::save(m, d))?;
        Ok(PyBytes::new(py, &bytes))
    }

    /// Restores the bytes of `save` of the same model. The simulation continues with equal results, bit for bit. The data get other
    /// memory: arrays that were taken before keep showing the data before.
    fn restore(&self, py: Python<'_>, bytes: &[u8]) -> PyResult<()> {
        let restored = self.with(py, |m, _| {
            let mut restored = EngineData::new(m);
            core::save::restore(m, &mut restored, bytes).map(|()| restored)
        })?;
        *self.data.write().unwrap_or_else(PoisonError::into_inner) = Arc::new(Mutex::new(restored));
        Ok(())
    }

    fn __repr__(&self) -> PyResult<String> {
        let memory = self.memory();
        let data = lock(&memory)?;
        Ok(format!(
            "<labspec.Data of \"{}\": t = {} s>",
            self.model.get().read().model.names.model,
            data.time()
        ))
    }
}

/// The dimensions of a field. One that changes with the state is that of the numbers that there are.
fn shape(model: &core::Model, field: FieldId, length: usize) -> Vec<usize> {
    let dimensions = reflect::shape(model, field);
    let fixed: usize = dimensions.iter().flatten().product();
    dimensions.iter().map(|dim| dim.unwrap_or(length / fixed.max(1))).collect()
}
