//! What a page needs of the engine, exported: a model, its data, steps, coordinates. `weigh.mjs` says what that weighs.

use labspec_core::{Data, Model, contact_force, forward, inverse, reset_data, save, step};

/// A model and its data, behind one pointer.
pub struct Simulation {
    model: Model,
    data: Data,
}

fn boxed(model: Result<Model, labspec_core::Error>) -> *mut Simulation {
    match model {
        Ok(model) => Box::into_raw(Box::new(Simulation { data: Data::new(&model), model })),
        Err(_) => std::ptr::null_mut(),
    }
}

/// # Safety
///
/// `text` must point to `length` bytes.
#[cfg(feature = "mjcf")]
#[unsafe(no_mangle)]
pub unsafe extern "C" fn from_xml(text: *const u8, length: usize) -> *mut Simulation {
    // SAFETY: guaranteed by the caller.
    let bytes = unsafe { std::slice::from_raw_parts(text, length) };
    std::str::from_utf8(bytes).map_or(std::ptr::null_mut(), |text| boxed(Model::from_xml(text)))
}

/// # Safety
///
/// `bytes` must point to `length` bytes.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn from_bytes(bytes: *const u8, length: usize) -> *mut Simulation {
    // SAFETY: guaranteed by the caller.
    boxed(Model::from_bytes(unsafe { std::slice::from_raw_parts(bytes, length) }))
}

/// # Safety
///
/// `s` must come from `from_xml` or `from_bytes`, and must not be null.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn call(s: *mut Simulation, which: u32) -> i32 {
    // SAFETY: guaranteed by the caller.
    let Simulation { model, data } = unsafe { &mut *s };
    let done = match which {
        0 => step(model, data),
        1 => forward(model, data),
        2 => reset_data(model, data),
        3 => inverse(model, data),
        4 => data.contact.first().map_or(Ok(()), |c| contact_force(model, data, c).map(drop)),
        _ => save::save(model, data).and_then(|bytes| save::restore(model, data, &bytes)),
    };
    i32::from(done.is_ok())
}

/// # Safety
///
/// `s` must come from `from_xml` or `from_bytes`, and must not be null.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn qpos(s: *mut Simulation) -> *mut f64 {
    // SAFETY: guaranteed by the caller.
    unsafe { (*s).data.edit().qpos.as_mut_ptr() }
}

/// The value of an expression over the model of a simulation, at its start; NaN where it is refused.
///
/// # Safety
///
/// `s` comes from `from_xml` or `from_bytes`, and is not null; `text` points at `length` bytes.
#[cfg(feature = "language")]
#[unsafe(no_mangle)]
pub unsafe extern "C" fn evaluate(s: *mut Simulation, text: *const u8, length: usize) -> f64 {
    // SAFETY: guaranteed by the caller.
    let (model, bytes) = unsafe { (&(*s).model, std::slice::from_raw_parts(text, length)) };
    let value = std::str::from_utf8(bytes).ok().and_then(|text| {
        let mut engine = labspec_bind::Engine::with_model(model.clone()).ok()?;
        engine.expression(text).ok()?.number(&mut engine).ok()
    });
    value.unwrap_or(f64::NAN)
}
