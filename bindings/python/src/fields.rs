//! Fields as views of the memory of the engine. A view is a buffer (PEP 3118), of which NumPy makes an array without a copy. It keeps
//! the memory alive that it shows.

use crate::error::error;
use labspec_core::reflect::{self, Elem, FieldId, Kind, Object, View};
use labspec_finding::nearest;
use pyo3::exceptions::{PyBufferError, PyTypeError};
use pyo3::ffi;
use pyo3::prelude::*;
use pyo3::types::PyBytes;
use std::any::Any;
use std::ffi::{CStr, c_int};
use std::sync::Arc;

/// The memory of a model, or of data.
pub(crate) type Owner = Arc<dyn Any + Send + Sync>;

/// A view of a field.
#[pyclass(frozen, module = "labspec._labspec")]
pub(crate) struct FieldView {
    /// What has the memory.
    _owner: Owner,
    address: usize,
    format: &'static CStr,
    size: isize,
    shape: Vec<isize>,
    strides: Vec<isize>,
    writable: bool,
}

#[pymethods]
impl FieldView {
    unsafe fn __getbuffer__(slf: Bound<'_, Self>, view: *mut ffi::Py_buffer, flags: c_int) -> PyResult<()> {
        if view.is_null() {
            return Err(PyBufferError::new_err("the buffer is NULL"));
        }
        let this = slf.get();
        if flags & ffi::PyBUF_WRITABLE == ffi::PyBUF_WRITABLE && !this.writable {
            return Err(PyBufferError::new_err("this field follows from others: it cannot be written"));
        }
        let count: isize = this.shape.iter().product();
        let asks_for = |flag: c_int| flags & flag == flag;
        // SAFETY: the interpreter passes a buffer that can be written. Its pointers are valid as long as `obj`, which is this view.
        unsafe {
            (*view).buf = this.address as *mut _;
            (*view).len = count * this.size;
            (*view).readonly = c_int::from(!this.writable);
            (*view).itemsize = this.size;
            (*view).format = if asks_for(ffi::PyBUF_FORMAT) {
                this.format.as_ptr().cast_mut()
            } else {
                std::ptr::null_mut()
            };
            (*view).ndim = this.shape.len() as c_int;
            (*view).shape =
                if asks_for(ffi::PyBUF_ND) { this.shape.as_ptr().cast_mut() } else { std::ptr::null_mut() };
            (*view).strides = if asks_for(ffi::PyBUF_STRIDES) {
                this.strides.as_ptr().cast_mut()
            } else {
                std::ptr::null_mut()
            };
            (*view).suboffsets = std::ptr::null_mut();
            (*view).internal = std::ptr::null_mut();
            (*view).obj = slf.into_any().into_ptr();
        }
        Ok(())
    }
}

/// Whether a field can be seen in memory: its length follows from the model, and the engine does not use it as an index.
pub(crate) fn is_live(field: FieldId) -> bool {
    let info = field.info();
    let is_size =
        |dim: &str| reflect::field(Object::Model, dim).is_some_and(|size| size.info().elem == Elem::Size);
    let sized = info.shape.iter().all(|dim| dim.parse::<usize>().is_ok() || is_size(dim));
    match info.elem {
        Elem::F64 => sized && info.kind != Kind::Structure,
        Elem::I32 => sized && is_writable(field),
        Elem::Bool | Elem::Size => false,
    }
}

/// Whether a caller may write a field.
pub(crate) fn is_writable(field: FieldId) -> bool {
    reflect::is_writable(field) && field.info().kind != Kind::Derived
}

/// A view of a field in memory, as a NumPy array. `None` if it cannot be seen in memory.
pub(crate) fn live<'py>(
    py: Python<'py>,
    owner: Owner,
    field: FieldId,
    view: View<'_>,
    shape: &[usize],
) -> PyResult<Option<Bound<'py, PyAny>>> {
    let (address, format, size) = match view {
        View::F64(list) => (list.as_ptr() as usize, c"d", size_of::<f64>()),
        View::I32(list) => (list.as_ptr() as usize, c"i", size_of::<i32>()),
        View::Bool(_) | View::Size(_) => return Ok(None),
    };
    if !is_live(field) || shape.iter().product::<usize>() != view.len() {
        return Ok(None);
    }
    let mut strides = Vec::new();
    let mut stride = size;
    for dim in shape.iter().rev() {
        strides.insert(0, stride as isize);
        stride *= dim;
    }
    let shape = shape.iter().map(|dim| *dim as isize).collect();
    let writable = is_writable(field);
    let size = size as isize;
    let seen = FieldView { _owner: owner, address, format, size, shape, strides, writable };
    array(py, Bound::new(py, seen)?.into_any()).map(Some)
}

/// A copy of a field: a number, or a read-only NumPy array.
pub(crate) fn copied<'py>(py: Python<'py>, view: View<'_>, shape: &[usize]) -> PyResult<Bound<'py, PyAny>> {
    if shape.is_empty() {
        return match view {
            View::F64(list) => Ok(list.first().copied().unwrap_or(f64::NAN).into_pyobject(py)?.into_any()),
            View::I32(list) => Ok(list.first().copied().unwrap_or(0).into_pyobject(py)?.into_any()),
            View::Bool(list) => {
                Ok(list.first().copied().unwrap_or(false).into_pyobject(py)?.to_owned().into_any())
            }
            View::Size(n) => Ok(n.into_pyobject(py)?.into_any()),
        };
    }
    let (bytes, format): (Vec<u8>, &str) = match view {
        View::F64(list) => (list.iter().flat_map(|x| x.to_ne_bytes()).collect(), "float64"),
        View::I32(list) => (list.iter().flat_map(|x| x.to_ne_bytes()).collect(), "int32"),
        View::Bool(list) => (list.iter().map(|x| u8::from(*x)).collect(), "bool"),
        View::Size(n) => ((n as u64).to_ne_bytes().to_vec(), "uint64"),
    };
    let flat = py.import("numpy")?.call_method1("frombuffer", (PyBytes::new(py, &bytes), format))?;
    flat.call_method1("reshape", (shape.to_vec(),))
}

/// A NumPy array of a buffer, without a copy.
fn array<'py>(py: Python<'py>, buffer: Bound<'py, PyAny>) -> PyResult<Bound<'py, PyAny>> {
    py.import("numpy")?.call_method1("asarray", (buffer,))
}

/// The numbers of a Python value for a field: a number, or anything that NumPy makes an array of.
pub(crate) fn numbers(value: &Bound<'_, PyAny>) -> PyResult<Vec<f64>> {
    if let Ok(x) = value.extract::<f64>() {
        return Ok(vec![x]);
    }
    let numpy = value.py().import("numpy")?;
    let flat = numpy.call_method1("asarray", (value, "float64"))?.call_method0("ravel")?;
    flat.call_method0("tolist")?
        .extract::<Vec<f64>>()
        .map_err(|_| PyTypeError::new_err("a field takes a number, or a list of numbers"))
}

/// The field of an object with this name.
///
/// # Errors
/// There is none; the message suggests a similar name.
pub(crate) fn named(objects: &[Object], name: &str) -> PyResult<FieldId> {
    let found = objects.iter().find_map(|object| reflect::field(*object, name));
    found.ok_or_else(|| {
        let names = reflect::fields().filter(|f| objects.contains(&f.info().object)).map(|f| f.info().name);
        let help = nearest(name, names).map_or(String::new(), |near| format!("; did you mean `{near}`?"));
        pyo3::exceptions::PyAttributeError::new_err(format!("there is no field `{name}`{help}"))
    })
}

/// The error for a field that cannot be written.
pub(crate) fn not_writable(field: FieldId) -> PyErr {
    error("not-writable", &labspec_core::Error::NotWritable(field).to_string(), &[])
}

/// A row of the table of fields: object, name, unit, description, shape, whether it can be written.
type FieldRow = (&'static str, &'static str, &'static str, &'static str, Vec<&'static str>, bool);

/// The table of fields.
#[pyfunction]
pub(crate) fn field_docs() -> Vec<FieldRow> {
    let row = |field: FieldId| {
        let info = field.info();
        let object = match info.object {
            Object::Model => "model",
            Object::Option => "model.opt",
            Object::Statistic => "model.stat",
            Object::Data => "data",
        };
        (object, info.name, field.unit(), field.doc(), info.shape.to_vec(), is_writable(field))
    };
    reflect::fields().map(row).collect()
}
