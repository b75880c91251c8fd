//! Fields of models and data by their index in the table.

use crate::error::call_error;
use js_sys::{Float64Array, Int32Array, Uint8Array};
use labspec_core::reflect::{self, Elem, FieldId, Kind, Object, View};
use serde_json::{Value as Json, json};
use wasm_bindgen::prelude::*;

/// The field with this index.
pub(crate) fn by_index(index: usize) -> Result<FieldId, JsValue> {
    FieldId::new(index).ok_or_else(|| call_error("unknown-field", &format!("there is no field {index}")))
}

/// The numbers of a field in a JavaScript typed array that owns them.
pub(crate) fn copied(view: View<'_>) -> JsValue {
    match view {
        View::F64(list) => Float64Array::from(list).into(),
        View::I32(list) => Int32Array::from(list).into(),
        View::Bool(list) => {
            Uint8Array::from(&list.iter().map(|&b| u8::from(b)).collect::<Vec<_>>()[..]).into()
        }
        View::Size(n) => Int32Array::from(&[i32::try_from(n).unwrap_or(i32::MAX)][..]).into(),
    }
}

/// The address and the element count of a field in memory; `None` if it is available only as a copy.
pub(crate) fn place(view: View<'_>) -> Option<[u32; 2]> {
    match view {
        View::F64(list) => Some([list.as_ptr() as usize as u32, list.len() as u32]),
        View::I32(list) => Some([list.as_ptr() as usize as u32, list.len() as u32]),
        View::Bool(_) | View::Size(_) => None,
    }
}

/// Whether the page can view a field in memory: numbers that the engine does not use as indexes, with a count that the model
/// determines. Booleans are excluded, because bytes other than 0 and 1 are not valid.
pub(crate) fn is_live(field: FieldId) -> bool {
    let info = field.info();
    let sized = info.shape.iter().all(|dim| dim.parse::<usize>().is_ok() || is_size(dim));
    match info.elem {
        Elem::F64 => sized && info.kind != Kind::Structure,
        Elem::I32 => sized && reflect::is_writable(field),
        Elem::Bool | Elem::Size => false,
    }
}

fn is_size(dim: &str) -> bool {
    reflect::field(Object::Model, dim).is_some_and(|size| size.info().elem == Elem::Size)
}

/// The table of fields as JSON: object, name, element type, shape, whether the page can view it in memory,
/// whether it can be written.
#[wasm_bindgen(js_name = fieldTable)]
pub fn field_table() -> String {
    let row = |field: FieldId| {
        let info = field.info();
        let object = match info.object {
            Object::Model => "model",
            Object::Option => "opt",
            Object::Statistic => "stat",
            Object::Data => "data",
        };
        let elem = match info.elem {
            Elem::F64 => "f64",
            Elem::I32 => "i32",
            Elem::Bool => "bool",
            Elem::Size => "size",
        };
        let writable = reflect::is_writable(field) && info.kind != Kind::Derived;
        json!([object, info.name, elem, info.shape, is_live(field), writable])
    };
    reflect::fields().map(row).collect::<Json>().to_string()
}

/// The documentation of the fields: unit and description, in the order of the table.
#[cfg(feature = "checker")]
#[wasm_bindgen(js_name = fieldDocs)]
pub fn field_docs() -> String {
    reflect::fields().map(|f| json!([f.unit(), f.doc()])).collect::<Json>().to_string()
}
