//! Fields by their names, as lists of numbers.

use crate::arguments::{Buffer, VersionedStruct, c_string, check_pointer, text, write_struct};
use crate::report::item;
use crate::status::{Failure, Outcome, Status, call};
use labspec_core::reflect::{self, Elem, FieldId, Kind, Object, View, ViewMut};
use labspec_finding::nearest;
use std::ffi::{CString, c_char};
use std::sync::LazyLock;

/// The struct of MuJoCo that a field belongs to.
#[derive(Clone, Copy)]
#[repr(C)]
pub enum FieldOwner {
    /// The model: "body_mass".
    LabspecOwnerModel = 0,
    /// Its options: "opt.timestep".
    LabspecOwnerOption = 1,
    /// Its statistics: "stat.extent".
    LabspecOwnerStatistic = 2,
    /// The data: "qpos".
    LabspecOwnerData = 3,
}

/// The type of the elements of a field in the engine. Here all of them are read and written as double, which represents each
/// exactly.
#[derive(Clone, Copy)]
#[repr(C)]
pub enum FieldElement {
    /// A 64-bit float.
    LabspecElementFloat = 0,
    /// A 32-bit integer.
    LabspecElementInteger = 1,
    /// 0 or 1.
    LabspecElementBoolean = 2,
    /// A size or a count.
    LabspecElementSize = 3,
}

/// What the table of fields states about a field. Its texts are valid forever.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct FieldDescription {
    /// sizeof(labspec_field), set by the caller.
    pub struct_size: usize,
    /// Its name as functions take it: "qpos", "body_mass", "opt.timestep".
    pub name: *const c_char,
    /// The struct that it belongs to.
    pub owner: FieldOwner,
    /// The type of its elements.
    pub element: FieldElement,
    /// Its dimensions as sizes of the model, separated by commas: "nbody, 3". Empty for a single number.
    pub shape: *const c_char,
    /// Its unit, or an empty text.
    pub unit: *const c_char,
    /// 1 if it can be written, otherwise 0.
    pub writable: i32,
}

// SAFETY: the size is the first field.
unsafe impl VersionedStruct for FieldDescription {
    const FIRST_SIZE: usize = std::mem::offset_of!(FieldDescription, writable) + size_of::<i32>();
    const NAME: &'static str = "labspec_field";
}

struct FieldTexts {
    id: FieldId,
    name: CString,
    shape: CString,
    unit: CString,
}

static TABLE: LazyLock<Vec<FieldTexts>> = LazyLock::new(|| {
    let row = |id: FieldId| FieldTexts {
        id,
        name: c_string(&name_of(id)),
        shape: c_string(&id.info().shape.join(", ")),
        unit: c_string(id.unit()),
    };
    reflect::fields().map(row).collect()
});

fn name_of(field: FieldId) -> String {
    let info = field.info();
    let prefix = match info.object {
        Object::Option => "opt.",
        Object::Statistic => "stat.",
        Object::Model | Object::Data => "",
    };
    format!("{prefix}{}", info.name)
}

/// The field with this name: "qpos", "body_mass", "opt.timestep", also with `data.` or `model.` before it.
pub(crate) fn by_name(name: &str) -> Outcome<FieldId> {
    let data = |name: &str| reflect::field(Object::Data, name);
    let model = |name: &str| match name.split_once('.') {
        Some(("opt", name)) => reflect::field(Object::Option, name),
        Some(("stat", name)) => reflect::field(Object::Statistic, name),
        Some(_) => None,
        None => reflect::field(Object::Model, name),
    };
    let found = match name.split_once('.') {
        Some(("data", name)) => data(name),
        Some(("model", name)) => model(name),
        _ => data(name).or_else(|| model(name)),
    };
    found.ok_or_else(|| {
        // Data first: of two equally similar names, that of the data is suggested.
        let (data, model): (Vec<FieldId>, Vec<FieldId>) =
            reflect::fields().partition(|f| f.info().object == Object::Data);
        let all: Vec<String> = data.into_iter().chain(model).map(name_of).collect();
        let similar = nearest(name, all.iter().map(String::as_str));
        let help = similar.map_or(String::new(), |name| format!("; did you mean `{name}`?"));
        Failure::new(Status::LabspecErrorName, "unknown-field", format!("there is no field `{name}`{help}"))
    })
}

/// Whether a caller may write a field.
pub(crate) fn is_writable(field: FieldId) -> bool {
    reflect::is_writable(field) && field.info().kind != Kind::Derived
}

/// Copies the elements of a field.
pub(crate) fn copy(view: View<'_>, buffer: Buffer<f64>) -> Outcome {
    match view {
        View::F64(list) => buffer.write(list),
        _ => buffer.write_each(view.len(), |i| view.get(i)),
    }
}

/// Stores numbers, beginning at an element. Nothing is written unless all of them fit and can be represented.
pub(crate) fn store(field: FieldId, view: &mut ViewMut<'_>, start: usize, values: &[f64]) -> Outcome {
    let length = match view {
        ViewMut::F64(v) => v.len(),
        ViewMut::I32(v) => v.len(),
        ViewMut::Bool(v) => v.len(),
        ViewMut::Fixed => 0,
    };
    if start.checked_add(values.len()).is_none_or(|end| end > length) {
        let (name, count) = (field.info().name, values.len());
        let message =
            format!("`{name}` has {length} elements: {count} numbers from element {start} do not fit");
        return Err(Failure::new(Status::LabspecErrorLength, "wrong-length", message));
    }
    let integer = |x: &f64| f64::from(*x as i32) == *x;
    if !matches!(view, ViewMut::F64(_)) && !values.iter().all(integer) {
        return Err(Failure::argument(format!("the elements of `{}` are integers", field.info().name)));
    }
    values.iter().enumerate().for_each(|(i, &x)| {
        view.set(start + i, x);
    });
    Ok(())
}

/// The number of fields in the table: those of models, options, statistics and data.
#[unsafe(no_mangle)]
pub extern "C" fn labspec_field_count() -> usize {
    reflect::fields().count()
}

/// The field with this index, from 0.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn labspec_field_at(index: usize, field: *mut FieldDescription) -> Status {
    // SAFETY: the caller keeps the contract of the header.
    call(|| unsafe {
        check_pointer(field, "the pointer to the field")?;
        write_struct(field, &describe(item(&TABLE, index, "field")?))
    })
}

/// The field with this name: "qpos", "body_mass", "opt.timestep", also with "data." or "model." before it.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn labspec_field_by_name(name: *const c_char, field: *mut FieldDescription) -> Status {
    // SAFETY: the caller keeps the contract of the header.
    call(|| unsafe {
        let found = by_name(text(name, "the name")?)?;
        check_pointer(field, "the pointer to the field")?;
        write_struct(field, &describe(item(&TABLE, found.index(), "field")?))
    })
}

fn describe(row: &FieldTexts) -> FieldDescription {
    let info = row.id.info();
    FieldDescription {
        struct_size: 0,
        name: row.name.as_ptr(),
        owner: match info.object {
            Object::Model => FieldOwner::LabspecOwnerModel,
            Object::Option => FieldOwner::LabspecOwnerOption,
            Object::Statistic => FieldOwner::LabspecOwnerStatistic,
            Object::Data => FieldOwner::LabspecOwnerData,
        },
        element: match info.elem {
            Elem::F64 => FieldElement::LabspecElementFloat,
            Elem::I32 => FieldElement::LabspecElementInteger,
            Elem::Bool => FieldElement::LabspecElementBoolean,
            Elem::Size => FieldElement::LabspecElementSize,
        },
        shape: row.shape.as_ptr(),
        unit: row.unit.as_ptr(),
        writable: i32::from(is_writable(row.id)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_field_is_found_by_its_name() {
        for field in reflect::fields() {
            assert_eq!(by_name(&name_of(field)).unwrap(), field, "{}", name_of(field));
            let prefix = if field.info().object == Object::Data { "data" } else { "model" };
            assert_eq!(by_name(&format!("{prefix}.{}", name_of(field))).unwrap(), field);
        }
    }

    #[test]
    fn a_misspelt_name_is_an_error() {
        for name in ["", ".", "qposs", "opt", "opt.", "data.opt.timestep", "model.qpos", "stat.timestep"] {
            assert!(by_name(name).is_err(), "{name}");
        }
    }
}
