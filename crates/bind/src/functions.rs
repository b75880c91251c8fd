//! The table of all functions that programs can call: signature, effects, documentation and implementation.

pub(super) mod access;
mod lib;
mod measure;
mod mj;
mod over;
mod sim;

use std::sync::LazyLock;

use super::displayed::LABELS;
use super::handle::{self, FieldOwner};
use super::units;
use labspec_core::Obj;
use labspec_core::reflect::{self, FieldId, Kind, Object, Stage, data, option};
use labspec_expr::dimension::Dimension;
use labspec_expr::{AccessedFields, FieldKey, FunctionId, FunctionInfo, Param, ResultDimension, Type, Value};
use labspec_finding::order;

/// The objects that contain functions.
pub(super) const OBJECTS: [&str; 3] = ["mj", "sim", "lib"];

/// Where a function can be called.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum FunctionPlace {
    /// In labs and in measures.
    Everywhere,
    /// Only in the measures of `verify`; a page does not have it.
    Measures,
    /// Only in claims of `verify` about several runs: the function combines the members of a sweep.
    Claims,
}

/// The type of a parameter, independent of a model.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Arg {
    Model,
    Data,
    Number,
    /// An angle in radians.
    Angle,
    Text,
    /// A list of numbers.
    Numbers,
    /// Any value.
    Any,
    /// The name of an object of this kind.
    Name(Obj),
    /// A label under which a value is displayed.
    Label,
    /// The program of an argument of an aggregate.
    Lazy,
}

/// The part of the simulation that a function reads or writes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum AccessedPart {
    Nothing,
    /// The derived fields of the data.
    Derived,
    /// The state and inputs.
    State,
    /// The coordinates.
    Coordinates,
    /// Contacts and their forces.
    Contacts,
    /// Energies.
    Energy,
    /// The option flags that are enabled.
    Flags,
    /// Positions and orientations of bodies and sites.
    Places,
    /// All fields on which a Jacobian depends.
    Motion,
    /// The mass matrix.
    Mass,
    /// Displayed values, whose programs declare what they read.
    DisplayedLabels,
}

/// The dimension of the numbers in a result.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Unit {
    /// Not fixed.
    Unknown,
    /// This unit.
    Of(&'static str),
    /// The dimension of the argument, for numbers that are larger by this factor.
    Argument(f64),
    /// The dimension of this argument, times this unit.
    Times(usize, &'static str),
}

/// A row of the table.
pub(super) struct Function {
    /// The object that contains it; empty for a global function.
    pub(super) object: &'static str,
    pub(super) name: &'static str,
    pub(super) args: &'static [Arg],
    pub(super) optional: usize,
    pub(super) returns: Type,
    /// The members of the result, if it is a record.
    pub(super) members: &'static [(&'static str, Type)],
    /// The number of elements of the result, if it is a list.
    pub(super) length: Option<usize>,
    /// The field of the data of which it returns the part of one object of this kind.
    pub(super) gives: Option<(FieldId, Obj)>,
    pub(super) reads: AccessedPart,
    pub(super) writes: &'static [AccessedPart],
    pub(super) place: FunctionPlace,
    pub(super) aggregate: bool,
    /// The dimension of the numbers in the result.
    pub(super) unit: Unit,
    pub(super) doc: &'static str,
    /// Statements and a last expression for `specs/models/pendulum.xml`, or a measure over 0.1 s of it, and the value.
    pub(super) example: (&'static str, &'static str),
    pub(super) run: access::Run,
}

/// Default values for the rows below; not a function itself.
pub(super) const ROW: Function = Function {
    object: "",
    name: "",
    args: &[],
    optional: 0,
    returns: Type::Number,
    members: &[],
    length: None,
    gives: None,
    reads: AccessedPart::Nothing,
    writes: &[],
    place: FunctionPlace::Everywhere,
    aggregate: false,
    unit: Unit::Unknown,
    doc: "",
    example: ("", ""),
    run: |_, _, _| NOTHING,
};

/// All functions. The id of a function is its index in this list.
pub(super) static TABLE: LazyLock<Vec<&'static Function>> = LazyLock::new(|| {
    [mj::ROWS, lib::ROWS, sim::ROWS, measure::ROWS, over::ROWS].into_iter().flatten().collect()
});

/// The indexes of [`TABLE`] by object and name. Several functions with one name keep the order of the table.
static BY_NAME: LazyLock<Vec<usize>> = LazyLock::new(|| {
    let mut indexes: Vec<usize> = (0..TABLE.len()).collect();
    order::sort_by(&mut indexes, |&a, &b| (key_of(a), a).cmp(&(key_of(b), b)));
    indexes
});

/// The object and the name of a function of [`TABLE`].
fn key_of(i: usize) -> (&'static str, &'static str) {
    TABLE.get(i).map_or(("", ""), |f| (f.object, f.name))
}

/// The functions of an object (empty for global functions) that have a name, with their indexes in [`TABLE`].
pub(super) fn named(object: &str, name: &str) -> impl Iterator<Item = (usize, &'static Function)> {
    let key = (object, name);
    let first = BY_NAME.partition_point(|&i| key_of(i) < key);
    let from_here = BY_NAME.get(first..).unwrap_or_default().iter();
    from_here.take_while(move |&&i| key_of(i) == key).filter_map(|&i| Some((i, *TABLE.get(i)?)))
}

/// The result of a function that returns nothing.
const NOTHING: Result<Value, String> = Ok(Value::Undefined);

/// The result of a function that runs a pass of the engine.
fn pass_result(result: Result<(), access::Failed>) -> Result<Value, String> {
    result?;
    NOTHING
}

/// The index of the object whose name is the first argument.
fn index(args: &[Value]) -> Result<usize, String> {
    args.first().map(|v| handle::index_of(v.to_number())).ok_or_else(|| "a name is missing".into())
}

/// Whether a function reads the simulation; `abs`, for example, does not.
pub fn reads(FunctionId(f): FunctionId) -> bool {
    TABLE.get(f as usize).is_some_and(|function| function.reads != AccessedPart::Nothing)
}

fn number(args: &[Value]) -> Result<f64, String> {
    args.first().map(Value::to_number).ok_or_else(|| "a number is missing".into())
}

/// The signatures and effects of all functions, in the order of the table.
pub(super) static INFO: LazyLock<Vec<FunctionInfo>> =
    LazyLock::new(|| TABLE.iter().map(|f| info(f)).collect());

/// A placeholder for an unknown function.
pub(super) fn none() -> FunctionInfo {
    info(&ROW)
}

/// The signature and effects in the types of the language.
fn info(f: &Function) -> FunctionInfo {
    let param = |arg: &Arg| match arg {
        Arg::Model => Param::Object(handle::encode(handle::HandleTarget::Struct(Object::Model))),
        Arg::Data => Param::Object(handle::encode(handle::HandleTarget::Struct(Object::Data))),
        Arg::Number => Param::Number,
        Arg::Angle => Param::Angle,
        Arg::Text => Param::Text,
        Arg::Numbers => Param::Numbers,
        Arg::Any => Param::Any,
        Arg::Name(kind) => Param::Name(handle::collection(FieldOwner::Data, *kind)),
        Arg::Label => Param::Name(LABELS),
        Arg::Lazy => Param::Lazy,
    };
    FunctionInfo {
        name: path(f),
        params: f.args.iter().map(param).collect(),
        optional: f.optional,
        implied: f.name == "mj_setConst",
        returns: f.returns,
        members: f.members.iter().map(|(name, ty)| (name.to_string(), *ty)).collect(),
        length: f.length,
        aggregate: f.aggregate,
        reads: accessed_fields(&[f.reads]),
        writes: accessed_fields(f.writes),
        gives: match f.unit {
            Unit::Of(unit) => units::parse(unit).map_or(ResultDimension::Unknown, ResultDimension::This),
            Unit::Argument(factor) => ResultDimension::Argument(0, Dimension::NUMBER.times(factor)),
            Unit::Times(i, unit) => {
                units::parse(unit).map_or(ResultDimension::Unknown, |d| ResultDimension::Argument(i, d))
            }
            Unit::Unknown => ResultDimension::Unknown,
        },
        doc: f.doc.to_string(),
    }
}

/// The name as an author writes it.
fn path(f: &Function) -> String {
    if f.object.is_empty() { f.name.to_string() } else { format!("{}.{}", f.object, f.name) }
}

/// The fields on which the Jacobian of a site depends.
const MOTION: [FieldId; 5] = [data::xanchor, data::xaxis, data::xmat, data::xpos, data::site_xpos];

fn accessed_fields(touches: &[AccessedPart]) -> AccessedFields {
    let is = |f: &FieldId, t: &AccessedPart| {
        let i = f.info();
        match t {
            AccessedPart::Nothing | AccessedPart::DisplayedLabels => false,
            AccessedPart::Derived => i.kind == Kind::Derived,
            AccessedPart::State => i.object == Object::Data && matches!(i.kind, Kind::State | Kind::Input),
            AccessedPart::Coordinates => *f == data::qpos,
            AccessedPart::Contacts => i.stage == Stage::Collision || *f == data::efc_force,
            AccessedPart::Energy => *f == data::energy,
            AccessedPart::Flags => *f == option::enableflags,
            AccessedPart::Places => [data::xpos, data::site_xpos].contains(f),
            AccessedPart::Motion => MOTION.contains(f),
            AccessedPart::Mass => i.stage == Stage::MassMatrix,
        }
    };
    let fields: Vec<FieldKey> = reflect::fields()
        .filter(|f| touches.iter().any(|t| is(f, t)))
        .map(|f| FieldKey(f.index() as u32))
        .collect();
    if fields.is_empty() { AccessedFields::Nothing } else { AccessedFields::Fields(fields) }
}

/// A text that every entry of the list contains which a function returns.
pub(super) fn entries_contain(f: u32) -> Option<&'static str> {
    (TABLE.get(f as usize)?.name == "contactPairs").then_some(" / ")
}

/// The name of a function without the object that contains it.
pub fn name(FunctionId(f): FunctionId) -> Option<&'static str> {
    TABLE.get(f as usize).map(|f| f.name)
}

/// A function for the reference.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FunctionDoc {
    /// The name and the parameters.
    pub signature: String,
    /// A line of documentation.
    pub doc: &'static str,
    /// Whether it exists only in the measures of `verify`.
    pub measure: bool,
    /// Whether it exists only in claims of `verify` about several runs.
    pub claim: bool,
    /// An example and its value.
    pub example: (&'static str, &'static str),
}

/// Returns all functions in the order of the table.
pub fn reference() -> Vec<FunctionDoc> {
    let word = |f: &Function, arg: &Arg| match arg {
        Arg::Model => "model",
        Arg::Data => "data",
        Arg::Number | Arg::Angle => "x",
        Arg::Text => "text",
        Arg::Numbers => "list",
        Arg::Any if f.place == FunctionPlace::Claims => "list",
        Arg::Any => "options",
        Arg::Name(_) => "name",
        Arg::Label => "label",
        Arg::Lazy => "expression",
    };
    let one = |f: &Function| {
        let args: Vec<_> = f.args.iter().map(|arg| word(f, arg)).collect();
        FunctionDoc {
            signature: format!("{}({})", path(f), args.join(", ")),
            doc: f.doc,
            measure: f.place == FunctionPlace::Measures,
            claim: f.place == FunctionPlace::Claims,
            example: f.example,
        }
    };
    TABLE.iter().map(|f| one(f)).collect()
}

/// Whether a name at the start of an expression has a meaning for every model.
pub(crate) fn is_taken(name: &str) -> bool {
    ["model", "data", "mj_setConst"].contains(&name)
        || OBJECTS.contains(&name)
        || TABLE.iter().any(|f| f.object.is_empty() && f.name == name)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn jacobians_read_the_fields_that_the_engine_states() {
        let engine = labspec_core::JACOBIAN_READS.into_iter().chain([data::site_xpos]);
        assert_eq!(engine.collect::<Vec<_>>(), MOTION);
    }

    #[test]
    fn every_accessed_part_has_fields() {
        use AccessedPart::*;
        let all = [Derived, State, Coordinates, Contacts, Energy, Flags, Places, Motion, Mass];
        assert!(all.iter().all(|t| matches!(accessed_fields(&[*t]), AccessedFields::Fields(_))));
    }
}
