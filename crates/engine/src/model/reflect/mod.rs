//! Reflection over the field table: the properties of a field, and its numbers as flat slices.
//!
//! The language, the lints, the reports and the reference pages access the engine only through this module.

mod cell;
mod field_set;

pub use super::stage::Stage;
pub(crate) use cell::Cell;
pub use cell::{Elem, View, ViewMut};
pub use field_set::FieldSet;

use crate::model::bytes::fingerprint;
use crate::model::fields::{data_fields, model_fields, option_fields, statistic_fields};
use crate::model::{Fields, Model};
use cell::Typed;
use labspec_finding::docs;
use labspec_finding::order::sort_by;
use std::sync::LazyLock;

/// The struct that a field belongs to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Object {
    /// `model`
    Model,
    /// `model.opt`
    Option,
    /// `model.stat`
    Statistic,
    /// `data`
    Data,
}

/// The kind of a field, which determines the effect of writing it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Kind {
    /// Size, type or address, fixed when the model compiles. Cannot be written.
    Structure,
    /// Evolves in time. May be written; then `mj_forward` updates the derived fields.
    State,
    /// Set by the user: controls, applied forces, mocap poses.
    Input,
    /// A parameter of the model that takes effect at the next step.
    Constant,
    /// A parameter from which others are computed. After a write, `mj_setConst` must be called.
    Inertial,
    /// Computed by a stage. Writing it has no effect.
    Derived,
}

/// One row of the field table.
#[derive(Debug)]
pub struct FieldInfo {
    /// The struct that contains it.
    pub object: Object,
    /// The name in MuJoCo.
    pub name: &'static str,
    /// Element type.
    pub elem: Elem,
    /// Dimensions, outermost first: names of sizes or literal numbers; empty for a single number.
    pub shape: &'static [&'static str],
    /// The kind of the field.
    pub kind: Kind,
    /// The stage that computes it.
    pub stage: Stage,
}

/// The texts of a field for people. They are a separate table, which is not linked into a program that does not use them.
#[derive(Debug)]
struct FieldTexts {
    unit: &'static str,
    doc: &'static str,
}

/// A field: a row of the table.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct FieldId(pub(crate) u16);

impl FieldId {
    /// The field with this index in the table.
    pub fn new(index: usize) -> Option<FieldId> {
        (index < NFIELD).then_some(FieldId(index as u16))
    }

    /// The index of the field in the table.
    pub fn index(self) -> usize {
        self.0 as usize
    }

    /// The row of the table.
    pub fn info(self) -> &'static FieldInfo {
        FIELDS[self.0 as usize]
    }

    /// The size of the model that gives the number of its rows. `None` for a single number, and if the number of rows changes
    /// with the state.
    pub fn rows(self) -> Option<FieldId> {
        match dimensions(self).first()? {
            FieldDimension::Size(id) => Some(FieldId(*id as u16)),
            FieldDimension::Fixed(_) | FieldDimension::Open => None,
        }
    }

    /// The unit of the field, empty if it is dimensionless.
    pub fn unit(self) -> &'static str {
        FIELD_TEXTS[self.0 as usize].unit
    }

    /// One line of documentation, empty in a build without descriptions ([`labspec_finding::docs`]).
    pub fn doc(self) -> &'static str {
        FIELD_TEXTS[self.0 as usize].doc
    }
}

macro_rules! reflect {
    ($infos:ident, $words:ident, $count:ident, $ids:ident, $object:ident, $struct:ty; $($name:ident: $ty:ty, [$($dim:tt),*], $kind:ident, $stage:ident, $unit:literal, $doc:literal;)*) => {
        const $infos: &[&FieldInfo] = &[$(&FieldInfo {
            object: Object::$object,
            name: stringify!($name),
            elem: <$ty as Typed>::ELEM,
            shape: &[$(stringify!($dim)),*],
            kind: Kind::$kind,
            stage: Stage::$stage,
        }),*];
        const $words: &[&FieldTexts] = &[$(&FieldTexts { unit: $unit, doc: docs($doc) }),*];
        const $count: usize = $infos.len();
        #[allow(non_camel_case_types)] // variants have the names of the fields
        #[derive(Clone, Copy)]
        #[repr(u16)]
        enum $ids { $($name),* }
        impl $ids {
            const ALL: [$ids; $count] = [$($ids::$name),*];
        }
        impl $struct {
            fn cell(&self, id: $ids) -> &dyn Cell { match id { $($ids::$name => &self.$name),* } }
            #[inline(never)] // compiles to a table of addresses; inlined, the code of each operation would be repeated for each field
            fn cell_mut(&mut self, id: $ids) -> &mut dyn Cell { match id { $($ids::$name => &mut self.$name),* } }
        }
    };
}
macro_rules! reflect_model { ($($t:tt)*) => { reflect! { MODEL, MODEL_TEXTS, MODEL_COUNT, ModelId, Model, Model; $($t)* } } }
macro_rules! reflect_option { ($($t:tt)*) => { reflect! { OPTION, OPTION_TEXTS, OPTION_COUNT, OptionId, Option, crate::model::Options; $($t)* } } }
macro_rules! reflect_stat { ($($t:tt)*) => { reflect! { STAT, STAT_TEXTS, STAT_COUNT, StatId, Statistic, crate::model::Statistic; $($t)* } } }
macro_rules! reflect_data { ($($t:tt)*) => { reflect! { DATA, DATA_TEXTS, DATA_COUNT, DataId, Data, Fields; $($t)* } } }
model_fields!(reflect_model);
option_fields!(reflect_option);
statistic_fields!(reflect_stat);
data_fields!(reflect_data);

const OPTION_AT: usize = MODEL_COUNT;
const STAT_AT: usize = OPTION_AT + OPTION_COUNT;
const DATA_AT: usize = STAT_AT + STAT_COUNT;
/// Number of fields.
pub const NFIELD: usize = DATA_AT + DATA_COUNT;

/// The fields as constants with the names of the fields. A misspelt name does not compile.
macro_rules! ids {
    ($module:ident, $doc:literal, $ids:ident, $first:expr; $($name:ident: $ty:ty, [$($dim:tt),*], $kind:ident, $stage:ident, $unit:literal, $fdoc:literal;)*) => {
        #[doc = $doc]
        #[allow(non_upper_case_globals)] // MuJoCo's names
        pub mod $module {
            use super::{FieldId, $ids};
            $(#[doc = $fdoc] pub const $name: FieldId = FieldId($first as u16 + $ids::$name as u16);)*
        }
    };
}
macro_rules! model_ids { ($($t:tt)*) => { ids! { model, "The fields of the model.", ModelId, 0; $($t)* } } }
macro_rules! option_ids { ($($t:tt)*) => { ids! { option, "The options.", OptionId, super::OPTION_AT; $($t)* } } }
macro_rules! statistic_ids { ($($t:tt)*) => { ids! { statistic, "The statistics.", StatId, super::STAT_AT; $($t)* } } }
macro_rules! data_ids { ($($t:tt)*) => { ids! { data, "The fields of the data.", DataId, super::DATA_AT; $($t)* } } }
model_fields!(model_ids);
option_fields!(option_ids);
statistic_fields!(statistic_ids);
data_fields!(data_ids);

/// Concatenates the rows of the four parts of the table.
macro_rules! whole_table {
    ($model:ident, $option:ident, $stat:ident, $data:ident) => {{
        let mut all = [$model[0]; NFIELD];
        let mut i = 0;
        while i < NFIELD {
            all[i] = if i < OPTION_AT {
                $model[i]
            } else if i < STAT_AT {
                $option[i - OPTION_AT]
            } else if i < DATA_AT {
                $stat[i - STAT_AT]
            } else {
                $data[i - DATA_AT]
            };
            i += 1;
        }
        all
    }};
}

/// The whole table: model, options, statistics, data.
pub(crate) static FIELDS: [&FieldInfo; NFIELD] = whole_table!(MODEL, OPTION, STAT, DATA);
static FIELD_TEXTS: [&FieldTexts; NFIELD] = whole_table!(MODEL_TEXTS, OPTION_TEXTS, STAT_TEXTS, DATA_TEXTS);

/// All field ids, in table order.
pub fn fields() -> impl Iterator<Item = FieldId> {
    (0..NFIELD as u16).map(FieldId)
}

/// The field `name` of `object`.
pub fn field(object: Object, name: &str) -> Option<FieldId> {
    let from = BY_NAME.partition_point(|f| f.info().name < name);
    let named = BY_NAME.get(from..)?.iter().take_while(|f| f.info().name == name);
    named.copied().find(|f| f.info().object == object)
}

/// All fields in the order of their names. The texts of a lab look up fields a hundred times.
static BY_NAME: LazyLock<Vec<FieldId>> = LazyLock::new(|| {
    let mut all: Vec<FieldId> = fields().collect();
    sort_by(&mut all, |f, g| (f.info().name, f).cmp(&(g.info().name, g)));
    all
});

/// A field of the model, its options or its statistics; `None` for a field of the data.
fn model_cell(m: &Model, field: FieldId) -> Option<&dyn Cell> {
    let i = field.0 as usize;
    if i < OPTION_AT {
        Some(m.cell(ModelId::ALL[i]))
    } else if i < STAT_AT {
        Some(m.opt.cell(OptionId::ALL[i - OPTION_AT]))
    } else if i < DATA_AT {
        Some(m.stat.cell(StatId::ALL[i - STAT_AT]))
    } else {
        None
    }
}

/// The numbers of a field of the model, its options or its statistics. Empty for a field of the data.
pub fn view_model(m: &Model, field: FieldId) -> View<'_> {
    model_cell(m, field).map_or(View::F64(&[]), |cell| cell.view())
}

/// The numbers of a field of the data. Empty for a field of the model.
pub fn view_data(d: &Fields, field: FieldId) -> View<'_> {
    match (field.0 as usize).checked_sub(DATA_AT) {
        Some(i) => d.cell(DataId::ALL[i]).view(),
        None => View::F64(&[]),
    }
}

/// Like [`view_model`], for writing.
pub fn view_model_mut(m: &mut Model, field: FieldId) -> ViewMut<'_> {
    let i = field.0 as usize;
    if i < OPTION_AT {
        m.cell_mut(ModelId::ALL[i]).view_mut()
    } else if i < STAT_AT {
        m.opt.cell_mut(OptionId::ALL[i - OPTION_AT]).view_mut()
    } else if i < DATA_AT {
        m.stat.cell_mut(StatId::ALL[i - STAT_AT]).view_mut()
    } else {
        ViewMut::Fixed
    }
}

/// Like [`view_data`], for writing.
pub fn view_data_mut(d: &mut Fields, field: FieldId) -> ViewMut<'_> {
    match (field.0 as usize).checked_sub(DATA_AT) {
        Some(i) => d.cell_mut(DataId::ALL[i]).view_mut(),
        None => ViewMut::Fixed,
    }
}

/// The numbers of a field of the model or the data.
pub fn view<'a>(m: &'a Model, d: &'a Fields, field: FieldId) -> View<'a> {
    if (field.0 as usize) < DATA_AT { view_model(m, field) } else { view_data(d, field) }
}

/// Element `i` of a field, or `None` past the end. The same value as from [`view`], in one step.
#[inline]
pub fn element(m: &Model, d: &Fields, field: FieldId, i: usize) -> Option<f64> {
    match (field.0 as usize).checked_sub(DATA_AT) {
        Some(data) => d.cell(*DataId::ALL.get(data)?).get(i),
        None => model_cell(m, field)?.get(i),
    }
}

/// Whether programs may write a field. Structure and computed integers cannot be written, because the engine uses them as
/// indexes.
pub fn is_writable(field: FieldId) -> bool {
    let info = field.info();
    info.kind != Kind::Structure && (info.kind != Kind::Derived || info.elem == Elem::F64)
}

/// The dimensions of a field for this model; `None` for a dimension that changes with the state (`nefc`).
pub fn shape(m: &Model, field: FieldId) -> Vec<Option<usize>> {
    dimensions(field).iter().map(|dim| dim.size_in(m)).collect()
}

/// One dimension of a field.
#[derive(Clone, Copy)]
enum FieldDimension {
    /// The same for every model.
    Fixed(usize),
    /// A size of the model.
    Size(ModelId),
    /// Changes with the state.
    Open,
}

impl FieldDimension {
    /// The length for this model, or `None` if it changes with the state.
    fn size_in(self, m: &Model) -> Option<usize> {
        match self {
            FieldDimension::Fixed(n) => Some(n),
            FieldDimension::Size(id) => match m.cell(id).view() {
                View::Size(n) => Some(n),
                _ => None,
            },
            FieldDimension::Open => None,
        }
    }
}

/// The dimensions of a field. Names are resolved once for all fields, because a reset reads the dimensions of every array.
fn dimensions(field: FieldId) -> &'static [FieldDimension] {
    static ALL: LazyLock<Vec<Vec<FieldDimension>>> = LazyLock::new(|| {
        let named = |dim: &str| match dim.parse() {
            Ok(n) => FieldDimension::Fixed(n),
            Err(_) => size_id(dim).map_or(FieldDimension::Open, FieldDimension::Size),
        };
        fields().map(|f| f.info().shape.iter().map(|dim| named(dim)).collect()).collect()
    });
    ALL.get(field.index()).map_or(&[], Vec::as_slice)
}

/// The field of the model with this name, which may be a size.
fn size_id(name: &str) -> Option<ModelId> {
    ModelId::ALL.get(field(Object::Model, name)?.index()).copied()
}

/// The size of this name (`nq`, `nbody`, …), or `None` if the model has no such size.
pub fn size(m: &Model, name: &str) -> Option<usize> {
    FieldDimension::Size(size_id(name)?).size_in(m)
}

/// Number of elements of a field, computed from the sizes of the model; 0 if a size is not known. Does not allocate, because a
/// reset in the step loop calls it for every array.
pub(crate) fn length(m: &Model, field: FieldId) -> usize {
    dimensions(field).iter().map(|dim| dim.size_in(m).unwrap_or(0)).fold(1, usize::saturating_mul)
}

/// A hash of the names, types and shapes of the fields of the data, or of all other fields. Programs with the same hash
/// have the same table.
pub(crate) fn table(data: bool) -> u64 {
    let mut text = String::new();
    for f in fields().map(FieldId::info).filter(|f| (f.object == Object::Data) == data) {
        let elem = match f.elem {
            Elem::F64 => "F64",
            Elem::I32 => "I32",
            Elem::Bool => "Bool",
            Elem::Size => "Size",
        };
        let shape: Vec<String> = f.shape.iter().map(|dim| format!("\"{dim}\"")).collect();
        text += &format!("{} {elem} [{}]\n", f.name, shape.join(", "));
    }
    fingerprint(text.as_bytes())
}

/// Appends all fields of the data, in the order of the table.
pub(crate) fn write_data(d: &Fields, out: &mut Vec<u8>) {
    for id in DataId::ALL {
        d.cell(id).write(out);
    }
}

/// Reads the bytes of [`write_data`]. Returns `false` if there are too few.
pub(crate) fn read_data(m: &Model, d: &mut Fields, bytes: &mut &[u8]) -> bool {
    (0..DATA_COUNT).all(|i| {
        let dims = DATA[i].shape.iter();
        let n = dims.fold(1, |n: usize, dim| {
            n.saturating_mul(dim.parse().ok().or_else(|| size(m, dim)).or_else(|| count(d, dim)).unwrap_or(0))
        });
        d.cell_mut(DataId::ALL[i]).read(n, bytes)
    })
}

/// The count of this name in the data (such as `nefc`).
pub(crate) fn count(d: &Fields, name: &str) -> Option<usize> {
    let i = DATA.iter().position(|f| f.name == name && f.elem == Elem::Size)?;
    match d.cell(DataId::ALL[i]).view() {
        View::Size(n) => Some(n),
        _ => None,
    }
}

/// Appends the numbers of a field of the model, its options or its statistics.
pub(crate) fn write_model(m: &Model, field: FieldId, out: &mut Vec<u8>) {
    let i = field.0 as usize;
    if i < OPTION_AT {
        m.cell(ModelId::ALL[i]).write(out);
    } else if i < STAT_AT {
        m.opt.cell(OptionId::ALL[i - OPTION_AT]).write(out);
    } else if i < DATA_AT {
        m.stat.cell(StatId::ALL[i - STAT_AT]).write(out);
    }
}

/// Reads the bytes of [`write_model`]. The sizes must be known. Returns `false` if there are too few bytes.
pub(crate) fn read_model(m: &mut Model, field: FieldId, bytes: &mut &[u8]) -> bool {
    let (i, n) = (field.0 as usize, length(m, field));
    if i < OPTION_AT {
        m.cell_mut(ModelId::ALL[i]).read(n, bytes)
    } else if i < STAT_AT {
        m.opt.cell_mut(OptionId::ALL[i - OPTION_AT]).read(n, bytes)
    } else {
        i < DATA_AT && m.stat.cell_mut(StatId::ALL[i - STAT_AT]).read(n, bytes)
    }
}

/// Appends sizes, types and addresses of the model.
pub(crate) fn write_structure(m: &Model, out: &mut Vec<u8>) {
    for i in (0..MODEL_COUNT).filter(|&i| MODEL[i].kind == Kind::Structure) {
        m.cell(ModelId::ALL[i]).write(out);
    }
}

/// Resizes every array of the model to the length of its shape, and fills it with zeros.
pub fn allocate_model(m: &mut Model) {
    for i in 0..MODEL_COUNT {
        let n = length(m, FieldId(i as u16));
        m.cell_mut(ModelId::ALL[i]).allocate(n);
    }
}

/// Resizes every array of the data to the length of its shape, and fills it with zeros. Sets the time and other single numbers to
/// zero. Allocates only at the first call.
pub(crate) fn allocate_data(m: &Model, d: &mut Fields) {
    for i in 0..DATA_COUNT {
        let n = length(m, FieldId((DATA_AT + i) as u16));
        d.cell_mut(DataId::ALL[i]).allocate(n);
    }
}

#[cfg(test)]
mod tests;
