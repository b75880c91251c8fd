//! Models without a lab.

use crate::arguments::{Buffer, check_pointer, list, store, text};
use crate::fields;
use crate::handles::{self, Handle, NewHandle};
use crate::models::{GivenModels, ModelSource};
use crate::status::{Failure, Outcome, Status, call};
use labspec_core::reflect::Object;
use labspec_core::{self as core, Model, Obj};
use std::ffi::c_char;
use std::path::Path;
use std::sync::{Arc, RwLock};

/// A compiled model. Several threads may use it at a time, as long as none of them writes it.
pub struct ModelHandle {
    _opaque: [u8; 0],
}

impl Handle for ModelHandle {
    type Object = Arc<RwLock<Model>>;
    const NAME: &'static str = "labspec_model";
}

/// The object of a new handle.
pub(crate) fn shared(model: Model) -> Arc<RwLock<Model>> {
    Arc::new(RwLock::new(model))
}

/// The findings of a model, with their lines.
fn mistakes(xml: &str, e: core::Error) -> Failure {
    facade::Error::of_model(xml, &e).map_or_else(|| e.into(), Into::into)
}

/// Compiles a model from MJCF. `files` has the files that it includes or refers to, or is NULL.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn labspec_model_from_xml(
    xml: *const c_char,
    files: *const ModelSource,
    model: *mut *mut ModelHandle,
) -> Status {
    // SAFETY: the caller keeps the contract of the header.
    call(|| unsafe {
        let out = NewHandle::new(model)?;
        let (xml, files) = (text(xml, "the MJCF")?, GivenModels::read(files)?.files()?);
        out.set(shared(Model::from_xml_with(xml, &*files).map_err(|e| mistakes(xml, e))?))
    })
}

/// Compiles a model from a file. It may refer to files in the same folder and below.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn labspec_model_from_file(
    path: *const c_char,
    model: *mut *mut ModelHandle,
) -> Status {
    // SAFETY: the caller keeps the contract of the header.
    call(|| unsafe {
        let out = NewHandle::new(model)?;
        out.set(shared(Model::from_file(Path::new(text(path, "the path")?))?))
    })
}

/// Creates a model from the bytes of labspec_model_to_bytes().
#[unsafe(no_mangle)]
pub unsafe extern "C" fn labspec_model_from_bytes(
    bytes: *const u8,
    length: usize,
    model: *mut *mut ModelHandle,
) -> Status {
    // SAFETY: the caller keeps the contract of the header.
    call(|| unsafe {
        let out = NewHandle::new(model)?;
        out.set(shared(Model::from_bytes(list(bytes, length, "the list of bytes")?)?))
    })
}

/// Copies the model as bytes. They are read by the same version of the library only.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn labspec_model_to_bytes(
    model: *const ModelHandle,
    buffer: *mut u8,
    capacity: usize,
    length: *mut usize,
) -> Status {
    // SAFETY: the caller keeps the contract of the header.
    call(|| unsafe {
        let model = handles::find(model)?;
        Buffer::new(buffer, capacity, length)?.write(&handles::read(&model)?.to_bytes())
    })
}

/// Frees a model. Data that were created for it stay usable. Does nothing for NULL.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn labspec_model_free(model: *mut ModelHandle) -> Status {
    call(|| handles::free(model))
}

/// Copies a field of the model ("body_mass", "nv", "opt.gravity"; rows in sequence) to `buffer`, which has `capacity` elements.
/// `length` receives the number of elements in any case. With NULL and 0 for the buffer only the length is returned.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn labspec_model_read(
    model: *const ModelHandle,
    field: *const c_char,
    buffer: *mut f64,
    capacity: usize,
    length: *mut usize,
) -> Status {
    // SAFETY: the caller keeps the contract of the header.
    call(|| unsafe {
        let model = handles::find(model)?;
        let field = fields::by_name(text(field, "the name of the field")?)?;
        let buffer = Buffer::new(buffer, capacity, length)?;
        let model = handles::read(&model)?;
        let view = model.field(field).ok_or_else(|| foreign(field.info().name))?;
        fields::copy(view, buffer)
    })
}

/// Writes `count` numbers into a field of the model, beginning at element `start`. Data that use the model take the new values at
/// their next step. After a change of masses, inertias or poses call labspec_data_set_const().
#[unsafe(no_mangle)]
pub unsafe extern "C" fn labspec_model_write(
    model: *mut ModelHandle,
    field: *const c_char,
    start: usize,
    values: *const f64,
    count: usize,
) -> Status {
    // SAFETY: the caller keeps the contract of the header.
    call(|| unsafe {
        let model = handles::find(model)?;
        let field = fields::by_name(text(field, "the name of the field")?)?;
        let values = list(values, count, "the list of numbers")?;
        let mut model = handles::write(&model)?;
        write_field(&mut model, field, start, values)
    })
}

fn write_field(model: &mut Model, field: core::reflect::FieldId, start: usize, values: &[f64]) -> Outcome {
    if field.info().object == Object::Data {
        return Err(foreign(field.info().name));
    }
    if !fields::is_writable(field) {
        return Err(core::Error::NotWritable(field).into());
    }
    let mut view = model.field_mut(field)?;
    fields::store(field, &mut view, start, values)
}

fn foreign(name: &str) -> Failure {
    let message = format!("`{name}` is a field of data, not of models");
    Failure::new(Status::LabspecErrorName, "unknown-field", message)
}

/// The number of objects of a kind: "body", "jnt", "geom", "site", "cam", "light", "mesh", "skin", "hfield", "tex", "mat", "pair",
/// "exclude", "eq", "tendon", "actuator", "sensor", "numeric", "text", "tuple" or "key".
#[unsafe(no_mangle)]
pub unsafe extern "C" fn labspec_model_object_count(
    model: *const ModelHandle,
    kind: *const c_char,
    count: *mut usize,
) -> Status {
    // SAFETY: the caller keeps the contract of the header.
    call(|| unsafe {
        let (model, kind) = (handles::find(model)?, kind_of(text(kind, "the kind")?)?);
        let model = handles::read(&model)?;
        store(count, count_objects(&model, kind), "the pointer to the count")
    })
}

/// The id of the object of a kind with this name.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn labspec_model_id(
    model: *const ModelHandle,
    kind: *const c_char,
    name: *const c_char,
    id: *mut usize,
) -> Status {
    // SAFETY: the caller keeps the contract of the header.
    call(|| unsafe {
        let model = handles::find(model)?;
        let (kind, name) = (kind_of(text(kind, "the kind")?)?, text(name, "the name")?);
        check_pointer(id, "the pointer to the id")?;
        let model = handles::read(&model)?;
        let all = || (0..).map_while(|id| model.name_of(kind, id));
        // Objects without a name have an empty one.
        let found = all().position(|listed| listed == name && !name.is_empty());
        let found = found.ok_or_else(|| {
            let nearest = labspec_finding::nearest(name, all()).map(String::from);
            core::Error::NoName { kind, name: name.to_string(), nearest }
        })?;
        store(id, found, "the pointer to the id")
    })
}

/// Copies the name of an object, which may be empty. `length` receives its length without the NUL, for which the buffer needs
/// room as well.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn labspec_model_name(
    model: *const ModelHandle,
    kind: *const c_char,
    id: usize,
    buffer: *mut c_char,
    capacity: usize,
    length: *mut usize,
) -> Status {
    // SAFETY: the caller keeps the contract of the header.
    call(|| unsafe {
        let (model, kind) = (handles::find(model)?, kind_of(text(kind, "the kind")?)?);
        let buffer = Buffer::new(buffer, capacity, length)?;
        let model = handles::read(&model)?;
        let name = model.name_of(kind, id);
        let name = name.ok_or_else(|| Failure::index("object", id, count_objects(&model, kind)))?;
        buffer.write_text(name)
    })
}

fn count_objects(model: &Model, kind: Obj) -> usize {
    (0..).map_while(|id| model.name_of(kind, id)).count()
}

fn kind_of(word: &str) -> Outcome<Obj> {
    Obj::from_prefix(word).ok_or_else(|| {
        let words: Vec<&str> = Obj::PREFIXES.iter().map(|(name, _)| *name).collect();
        let message = format!("`{word}` is not a kind of objects: it is one of {}", words.join(", "));
        Failure::new(Status::LabspecErrorName, "unknown-kind", message)
    })
}
