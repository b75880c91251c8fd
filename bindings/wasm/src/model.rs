//! Models without a lab.

use crate::error::{call_error, refused, thrown};
use crate::fields::{by_index, copied, is_live, place};
use crate::files::PageModels;
use labspec_core::reflect::{self, FieldId, Object, View, ViewMut};
use labspec_core::{Model, Obj};
use wasm_bindgen::prelude::*;

/// A compiled model, and the fields that the page can view in memory.
#[wasm_bindgen]
pub struct RawModel {
    pub(crate) model: Model,
    /// Fields that the page may write in memory, with their last known contents.
    exposed: Vec<(FieldId, Vec<u64>)>,
}

impl RawModel {
    pub(crate) fn from_model(model: Model) -> RawModel {
        RawModel { model, exposed: Vec::new() }
    }

    /// Synchronizes the model with the values that a page wrote into its views.
    pub(crate) fn sync(&mut self) {
        if self.exposed.is_empty() {
            return;
        }
        for index in 0..self.exposed.len() {
            let (field, held) = &self.exposed[index];
            let Some(view) = self.model.field(*field) else { continue };
            if same(view, held) {
                continue;
            }
            let (field, held) = (*field, snapshot(view));
            self.exposed[index].1 = held;
            // The field is written through the table to update its stamp.
            write(&mut self.model, field, |_| ());
        }
    }
}

#[wasm_bindgen]
impl RawModel {
    /// Compiles a model from MJCF. `files` are the files that it includes or refers to.
    #[wasm_bindgen(js_name = fromXml)]
    pub fn from_xml(xml: &str, files: &JsValue) -> Result<RawModel, JsValue> {
        let files = PageModels::new(files)?;
        Model::from_xml_with(xml, &files).map(RawModel::from_model).map_err(|e| mistakes(xml, &e))
    }

    /// Creates a model from the bytes of `toBytes`.
    #[wasm_bindgen(js_name = fromBytes)]
    pub fn from_bytes(bytes: &[u8]) -> Result<RawModel, JsValue> {
        Model::from_bytes(bytes).map(RawModel::from_model).map_err(|e| refused(&e))
    }

    /// The model as bytes.
    #[wasm_bindgen(js_name = toBytes)]
    #[allow(clippy::wrong_self_convention)] // values that a page wrote are synchronized first
    pub fn to_bytes(&mut self) -> Vec<u8> {
        self.sync();
        self.model.to_bytes()
    }

    /// The address and the element count of a field that the page can view in memory.
    pub fn place(&mut self, field: usize) -> Result<Vec<u32>, JsValue> {
        let field = by_index(field)?;
        let view = self.model.field(field).ok_or_else(|| foreign(field))?;
        let found = place(view).filter(|_| is_live(field)).ok_or_else(|| foreign(field))?;
        if reflect::is_writable(field) && self.exposed.iter().all(|(f, _)| *f != field) {
            let held = snapshot(view);
            self.exposed.push((field, held));
        }
        Ok(found.to_vec())
    }

    /// A copy of a field.
    pub fn field(&self, field: usize) -> Result<JsValue, JsValue> {
        let field = by_index(field)?;
        self.model.field(field).map(copied).ok_or_else(|| foreign(field))
    }

    /// A size or another single number of the model.
    pub fn number(&self, field: usize) -> f64 {
        by_index(field).ok().and_then(|f| self.model.field(f)?.get(0)).unwrap_or(f64::NAN)
    }

    /// Writes numbers into a field, starting at an element.
    pub fn write(&mut self, field: usize, from: usize, values: &[f64]) -> Result<(), JsValue> {
        let field = by_index(field)?;
        if field.info().object == Object::Data {
            return Err(foreign(field));
        }
        if !reflect::is_writable(field) {
            return Err(refused(&labspec_core::Error::NotWritable(field)));
        }
        let mut fits = true;
        write(&mut self.model, field, |view| fits = store(view, from, values));
        if fits { Ok(()) } else { Err(past_the_end(field)) }
    }

    /// The names of all objects of a kind, in the order of their ids.
    pub fn names(&self, kind: &str) -> Result<Vec<String>, JsValue> {
        names(&self.model, kind)
    }

    /// The name of the model.
    pub fn title(&self) -> String {
        self.model.names.model.clone()
    }
}

/// The error for the findings of a model, with their lines.
fn mistakes(xml: &str, e: &labspec_core::Error) -> JsValue {
    labspec::Error::of_model(xml, e).map_or_else(|| refused(e), |findings| thrown(&findings))
}

/// Writes a field of the model through the table.
fn write(model: &mut Model, field: FieldId, what: impl FnOnce(&mut ViewMut<'_>)) {
    if let Ok(mut view) = model.field_mut(field) {
        what(&mut view);
    }
}

/// Stores numbers; returns `false` if there are not enough elements.
pub(crate) fn store(view: &mut ViewMut<'_>, from: usize, values: &[f64]) -> bool {
    let len = match view {
        ViewMut::F64(v) => v.len(),
        ViewMut::I32(v) => v.len(),
        ViewMut::Bool(v) => v.len(),
        ViewMut::Fixed => 0,
    };
    if from.checked_add(values.len()).is_none_or(|end| end > len) {
        return false;
    }
    values.iter().enumerate().all(|(i, &x)| view.set(from + i, x))
}

pub(crate) fn past_the_end(field: FieldId) -> JsValue {
    call_error("wrong-length", &format!("`{}` has fewer elements", field.info().name))
}

fn foreign(field: FieldId) -> JsValue {
    call_error("unknown-field", &format!("`{}` is not a field that can be read here", field.info().name))
}

fn snapshot(view: View<'_>) -> Vec<u64> {
    match view {
        View::F64(list) => list.iter().map(|x| x.to_bits()).collect(),
        View::I32(list) => list.iter().map(|&x| x as u32 as u64).collect(),
        View::Bool(_) | View::Size(_) => Vec::new(),
    }
}

fn same(view: View<'_>, held: &[u64]) -> bool {
    match view {
        View::F64(list) => list.len() == held.len() && list.iter().zip(held).all(|(x, h)| x.to_bits() == *h),
        View::I32(list) => {
            list.len() == held.len() && list.iter().zip(held).all(|(&x, h)| x as u32 as u64 == *h)
        }
        View::Bool(_) | View::Size(_) => true,
    }
}

/// The kind with this prefix.
pub(crate) fn kind(word: &str) -> Result<Obj, JsValue> {
    Obj::from_prefix(word).ok_or_else(|| {
        let words: Vec<&str> = Obj::PREFIXES.iter().map(|(name, _)| *name).collect();
        call_error(
            "unknown-kind",
            &format!("`{word}` is not a kind of objects: it is one of {}", words.join(", ")),
        )
    })
}

/// The names of all objects of a kind.
pub(crate) fn names(model: &Model, word: &str) -> Result<Vec<String>, JsValue> {
    let kind = kind(word)?;
    Ok((0..).map_while(|id| model.name_of(kind, id)).map(String::from).collect())
}
