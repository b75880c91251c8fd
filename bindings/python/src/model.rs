//! Models without a lab.

use crate::error::{error, refused, refused_by_engine};
use crate::fields::{copied, is_live, is_writable, live, named, not_writable, numbers};
use labspec_core::reflect::{self, FieldId, Object, View, ViewMut};
use labspec_core::{self as core, Obj};
use labspec_finding::nearest;
use pyo3::exceptions::{PyKeyError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::PyBytes;
use std::path::PathBuf;
use std::sync::{Arc, PoisonError, RwLock, RwLockReadGuard, RwLockWriteGuard};

/// A compiled model, and the fields that Python may write in memory, with their last known contents.
pub(crate) struct SharedModel {
    pub(crate) model: core::Model,
    exposed: Vec<(FieldId, Vec<u64>)>,
}

impl SharedModel {
    fn new(model: core::Model) -> SharedModel {
        SharedModel { model, exposed: Vec::new() }
    }

    /// Whether Python wrote into a view since the last synchronization.
    pub(crate) fn is_stale(&self) -> bool {
        let changed = |(field, held): &(FieldId, Vec<u64>)| {
            self.model.field(*field).is_some_and(|view| !is_same(view, held))
        };
        self.exposed.iter().any(changed)
    }

    /// Takes over the numbers that Python wrote into views: what follows from a field is computed again.
    pub(crate) fn sync(&mut self) -> Result<(), core::Error> {
        for (field, held) in &mut self.exposed {
            let Some(view) = self.model.field(*field) else { continue };
            if is_same(view, held) {
                continue;
            }
            *held = snapshot(view);
            self.model.field_mut(*field)?;
        }
        Ok(())
    }
}

/// The bits of a field.
fn snapshot(view: View<'_>) -> Vec<u64> {
    (0..view.len()).map(|i| view.get(i).unwrap_or(f64::NAN).to_bits()).collect()
}

fn is_same(view: View<'_>, held: &[u64]) -> bool {
    view.len() == held.len()
        && held.iter().enumerate().all(|(i, bits)| view.get(i).map(f64::to_bits) == Some(*bits))
}

/// A compiled model. Its fields are NumPy arrays that show its memory: `model.body_mass[1] = 2`.
#[pyclass(frozen, module = "labspec")]
pub(crate) struct Model {
    pub(crate) shared: Arc<RwLock<SharedModel>>,
}

impl Model {
    pub(crate) fn from_compiled(model: core::Model) -> PyResult<Model> {
        Ok(Model { shared: Arc::new(RwLock::new(SharedModel::new(model))) })
    }

    pub(crate) fn read(&self) -> RwLockReadGuard<'_, SharedModel> {
        self.shared.read().unwrap_or_else(PoisonError::into_inner)
    }

    pub(crate) fn write(&self) -> RwLockWriteGuard<'_, SharedModel> {
        self.shared.write().unwrap_or_else(PoisonError::into_inner)
    }
}

#[pymethods]
impl Model {
    /// Compiles a model from MJCF. `files` are the files that it includes or refers to: a folder, or texts by name.
    #[staticmethod]
    #[pyo3(signature = (xml, files=None))]
    fn from_xml(py: Python<'_>, xml: &str, files: Option<&Bound<'_, PyAny>>) -> PyResult<Model> {
        let files = crate::models::files(files)?;
        let compiled = py.detach(|| core::Model::from_xml_with(xml, &*files));
        Model::from_compiled(compiled.map_err(|e| mistakes(xml, &e))?)
    }

    /// Compiles a model from a file. It may refer to files in the same folder and below.
    #[staticmethod]
    fn from_file(py: Python<'_>, path: PathBuf) -> PyResult<Model> {
        let compiled = py.detach(|| core::Model::from_file(&path));
        Model::from_compiled(compiled.map_err(|e| refused_by_engine(&e))?)
    }

    /// Creates a model from the bytes of `to_bytes`.
    #[staticmethod]
    fn from_bytes(bytes: &[u8]) -> PyResult<Model> {
        Model::from_compiled(core::Model::from_bytes(bytes).map_err(|e| refused_by_engine(&e))?)
    }

    /// The model as bytes. They are read by the same version only.
    fn to_bytes<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyBytes>> {
        let mut shared = self.write();
        shared.sync().map_err(|e| refused_by_engine(&e))?;
        Ok(PyBytes::new(py, &shared.model.to_bytes()))
    }

    /// The name of the model.
    #[getter]
    fn name(&self) -> String {
        self.read().model.names.model.clone()
    }

    /// A field of the model: "body_mass", "nq", "opt.timestep".
    fn field<'py>(slf: &Bound<'py, Self>, name: &str) -> PyResult<Bound<'py, PyAny>> {
        let field = field_of(name)?;
        let py = slf.py();
        let mut shared = slf.get().write();
        let shape: Option<Vec<usize>> = reflect::shape(&shared.model, field).into_iter().collect();
        let shape = shape.unwrap_or_default();
        let view = shared.model.field(field).ok_or_else(|| foreign(name))?;
        let held = (is_live(field) && is_writable(field)).then(|| snapshot(view));
        let found =
            if shape.is_empty() { None } else { live(py, slf.get().shared.clone(), field, view, &shape)? };
        let Some(found) = found else { return copied(py, view, &shape) };
        if let Some(held) = held.filter(|_| shared.exposed.iter().all(|(f, _)| *f != field)) {
            shared.exposed.push((field, held));
        }
        Ok(found)
    }

    /// Writes a field of the model: all its numbers, or one.
    fn set_field(&self, name: &str, value: &Bound<'_, PyAny>) -> PyResult<()> {
        let (field, values) = (field_of(name)?, numbers(value)?);
        if !is_writable(field) {
            return Err(not_writable(field));
        }
        let mut shared = self.write();
        shared.sync().map_err(|e| refused_by_engine(&e))?;
        let SharedModel { model, exposed } = &mut *shared;
        let mut view = model.field_mut(field).map_err(|e| refused_by_engine(&e))?;
        store(field, &mut view, &values)?;
        if let Some((_, held)) = exposed.iter_mut().find(|(f, _)| *f == field)
            && let Some(view) = model.field(field)
        {
            *held = snapshot(view);
        }
        Ok(())
    }

    /// The names of the objects of a kind ("body", "jnt", "geom", …), in the order of their ids. Objects without a name have an empty
    /// one.
    fn names(&self, kind: &str) -> PyResult<Vec<String>> {
        let kind = kind_of(kind)?;
        let shared = self.read();
        Ok((0..).map_while(|id| shared.model.name_of(kind, id)).map(String::from).collect())
    }

    /// The id of an object with this name.
    fn id(&self, kind: &str, name: &str) -> PyResult<usize> {
        let all = self.names(kind)?;
        all.iter().position(|listed| listed == name && !name.is_empty()).ok_or_else(|| {
            let near = nearest(name, all.iter().map(String::as_str));
            let help = near.map_or(String::new(), |near| format!("; did you mean \"{near}\"?"));
            PyKeyError::new_err(format!("the model has no {kind} \"{name}\"{help}"))
        })
    }

    fn __repr__(&self) -> String {
        let shared = self.read();
        let m = &shared.model;
        format!(
            "<labspec.Model \"{}\": {} bodies, nq={}, nv={}, nu={}>",
            m.names.model, m.nbody, m.nq, m.nv, m.nu
        )
    }
}

fn field_of(name: &str) -> PyResult<FieldId> {
    match name.split_once('.') {
        Some(("opt", name)) => named(&[Object::Option], name),
        Some(("stat", name)) => named(&[Object::Statistic], name),
        _ => named(&[Object::Model], name),
    }
}

/// Stores numbers into a whole field.
pub(crate) fn store(field: FieldId, view: &mut ViewMut<'_>, values: &[f64]) -> PyResult<()> {
    let length = match view {
        ViewMut::F64(v) => v.len(),
        ViewMut::I32(v) => v.len(),
        ViewMut::Bool(v) => v.len(),
        ViewMut::Fixed => 0,
    };
    if length != values.len() {
        let name = field.info().name;
        return Err(PyValueError::new_err(format!("`{name}` has {length} numbers, not {}", values.len())));
    }
    for (i, x) in values.iter().enumerate() {
        view.set(i, *x);
    }
    Ok(())
}

/// The kind of objects with this name in MuJoCo.
fn kind_of(word: &str) -> PyResult<Obj> {
    let word = if word == "joint" { "jnt" } else { word };
    Obj::from_prefix(word).ok_or_else(|| {
        let words: Vec<&str> = Obj::PREFIXES.iter().map(|(name, _)| *name).collect();
        let message = format!("`{word}` is not a kind of objects: it is one of {}", words.join(", "));
        error("unknown-kind", &message, &[])
    })
}

fn foreign(name: &str) -> PyErr {
    error("unknown-field", &format!("`{name}` is a field of data, not of models"), &[])
}

/// The error for the findings of a model, with their lines.
fn mistakes(xml: &str, e: &core::Error) -> PyErr {
    facade::Error::of_model(xml, e).map_or_else(|| refused_by_engine(e), |findings| refused(&findings))
}
