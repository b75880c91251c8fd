//! Simulation data of a model.

use crate::arguments::{Buffer, list, store, text};
use crate::fields;
use crate::handles::{self, Handle, NewHandle};
use crate::model::ModelHandle;
use crate::status::{Failure, Outcome, Status, call};
use labspec_core::reflect::Object;
use labspec_core::{self as core, Data, Full, Model};
use std::ffi::c_char;
use std::sync::{Arc, Mutex, RwLock};

/// The state and the results of a simulation. It keeps its model.
pub struct DataHandle {
    _opaque: [u8; 0],
}

impl Handle for DataHandle {
    type Object = Mutex<Simulation>;
    const NAME: &'static str = "labspec_data";
}

/// Data with the model for which they were created.
pub(crate) struct Simulation {
    model: Arc<RwLock<Model>>,
    data: Data<Full>,
}

/// Calls a function with the data and their model.
pub(crate) fn with_data(
    data: *const DataHandle,
    what: impl FnOnce(&Model, &mut Data<Full>) -> Outcome,
) -> Outcome {
    let simulation = handles::find(data)?;
    let mut simulation = handles::lock(&simulation)?;
    let Simulation { model, data } = &mut *simulation;
    let model = Arc::clone(model);
    let model = handles::read(&model)?;
    what(&model, data)
}

/// Creates data for a model, in its default configuration. Nothing is computed yet: call labspec_data_forward() or
/// labspec_data_step().
#[unsafe(no_mangle)]
pub unsafe extern "C" fn labspec_data_new(model: *const ModelHandle, data: *mut *mut DataHandle) -> Status {
    // SAFETY: the caller keeps the contract of the header.
    call(|| unsafe {
        let out = NewHandle::new(data)?;
        let model = Arc::clone(&*handles::find(model)?);
        let data = Data::new(&*handles::read(&model)?);
        out.set(Mutex::new(Simulation { model, data }))
    })
}

/// Frees data. Does nothing for NULL.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn labspec_data_free(data: *mut DataHandle) -> Status {
    call(|| handles::free(data))
}

/// Performs `steps` steps. There is no limit of work: the call returns after all of them.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn labspec_data_step(data: *mut DataHandle, steps: usize) -> Status {
    call(|| with_data(data, |m, d| Ok((0..steps).try_for_each(|_| core::step(m, d))?)))
}

/// Computes all fields from the state and the inputs.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn labspec_data_forward(data: *mut DataHandle) -> Status {
    call(|| with_data(data, |m, d| Ok(core::forward(m, d)?)))
}

/// Computes the forces that result in the acceleration `qacc`: inverse dynamics, to `qfrc_inverse`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn labspec_data_inverse(data: *mut DataHandle) -> Status {
    call(|| with_data(data, |m, d| Ok(core::inverse(m, d)?)))
}

/// Resets the data to the default configuration. The model keeps what was written to it.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn labspec_data_reset(data: *mut DataHandle) -> Status {
    call(|| with_data(data, |m, d| Ok(core::reset_data(m, d)?)))
}

/// Resets the data to a keyframe of the model, from 0.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn labspec_data_reset_keyframe(data: *mut DataHandle, key: usize) -> Status {
    call(|| {
        with_data(data, |m, d| {
            let id = m.keys().nth(key).ok_or_else(|| Failure::index("keyframe", key, m.keys().len()))?;
            Ok(core::reset_data_keyframe(m, d, id)?)
        })
    })
}

/// Computes the constants of the model that depend on masses, inertias and poses. The data are set to the default configuration.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn labspec_data_set_const(data: *mut DataHandle) -> Status {
    call(|| {
        let simulation = handles::find(data)?;
        let mut simulation = handles::lock(&simulation)?;
        let Simulation { model, data } = &mut *simulation;
        Ok(core::set_const(&mut *handles::write(model)?, data)?)
    })
}

/// The simulated time, s.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn labspec_data_time(data: *const DataHandle, time: *mut f64) -> Status {
    // SAFETY: the caller keeps the contract of the header.
    call(|| with_data(data, |_, d| unsafe { store(time, d.time(), "the pointer to the time") }))
}

/// Copies a field of the data ("qpos") or of its model ("body_mass") to `buffer`, like labspec_model_read().
#[unsafe(no_mangle)]
pub unsafe extern "C" fn labspec_data_read(
    data: *const DataHandle,
    field: *const c_char,
    buffer: *mut f64,
    capacity: usize,
    length: *mut usize,
) -> Status {
    // SAFETY: the caller keeps the contract of the header.
    call(|| unsafe {
        let name = text(field, "the name of the field");
        with_data(data, |m, d| {
            let field = fields::by_name(name?)?;
            fields::copy(core::view(m, d, field)?, Buffer::new(buffer, capacity, length)?)
        })
    })
}

/// Writes `count` numbers into a field of the data, beginning at element `start`. Only state and inputs can be written; fields that
/// follow from them are computed by the next step or forward pass.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn labspec_data_write(
    data: *mut DataHandle,
    field: *const c_char,
    start: usize,
    values: *const f64,
    count: usize,
) -> Status {
    // SAFETY: the caller keeps the contract of the header.
    call(|| unsafe {
        let (name, values) =
            (text(field, "the name of the field"), list(values, count, "the list of numbers"));
        with_data(data, |_, d| {
            let (field, values) = (fields::by_name(name?)?, values?);
            if field.info().object != Object::Data {
                let message = format!("`{}` is a field of the model: write the model", field.info().name);
                return Err(Failure::new(Status::LabspecErrorName, "unknown-field", message));
            }
            if !fields::is_writable(field) {
                return Err(core::Error::NotWritable(field).into());
            }
            fields::store(field, &mut d.write(field)?, start, values)
        })
    })
}

/// Copies the complete simulation as bytes: state, inputs and results. They are read by the same version of the library only.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn labspec_data_save(
    data: *const DataHandle,
    buffer: *mut u8,
    capacity: usize,
    length: *mut usize,
) -> Status {
    // SAFETY: the caller keeps the contract of the header.
    call(|| unsafe {
        with_data(data, |m, d| Buffer::new(buffer, capacity, length)?.write(&core::save::save(m, d)?))
    })
}

/// Restores the bytes of labspec_data_save() of the same model. The simulation then continues with equal results, bit for bit.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn labspec_data_restore(
    data: *mut DataHandle,
    bytes: *const u8,
    length: usize,
) -> Status {
    // SAFETY: the caller keeps the contract of the header.
    call(|| unsafe {
        let bytes = list(bytes, length, "the list of bytes");
        with_data(data, |m, d| Ok(core::save::restore(m, d, bytes?)?))
    })
}
