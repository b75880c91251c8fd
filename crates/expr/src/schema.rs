//! What a host defines at compile time: roots, their members, fields with shape and kind, named objects, and functions with
//! signature and effects. The host assigns the numbers in the ids; this crate only passes them back.

use crate::dimension::{Dimension, Measure};
use crate::host_terms::HostTerms;
use crate::rules::Rule;
use crate::types::{CollectionId, Elem, FieldKey, FunctionId, ObjectId, Type};
use crate::value::Value;

/// The meaning of a name.
#[derive(Clone, Debug, PartialEq)]
pub enum Entry {
    /// An object with members.
    Object(ObjectId),
    /// A field: one number or an array.
    Field(Field),
    /// A collection, which is called with a literal name and returns an object.
    Collection(CollectionId),
    /// A function.
    Function(FunctionId),
    /// A constant.
    Constant(Value),
}

/// A field of the host: a whole array, or the part of it that belongs to one named object.
#[derive(Clone, Debug, PartialEq)]
pub struct Field {
    /// The array.
    pub key: FieldKey,
    /// The path as an author writes it, for messages: `data.qpos`, `data.joint("a").qpos`.
    pub path: String,
    /// The element of the array at which this view starts.
    pub first: usize,
    /// The dimensions, outermost first; empty for a single number. `None` marks a dimension that changes during a run.
    pub shape: Vec<Option<usize>>,
    /// The kind, which determines the effect of an assignment.
    pub kind: FieldKind,
    /// The type of its elements.
    pub elem: Elem,
    /// The unit; empty if there is none.
    pub unit: String,
    /// One line of documentation.
    pub doc: String,
    /// The object that determines its size, as the start of a sentence: `the model has 14 coordinates`. May be empty.
    pub owner: String,
}

impl Field {
    /// The number of elements of the view, or `None` if it changes during a run.
    pub fn len(&self) -> Option<usize> {
        self.shape.iter().try_fold(1usize, |n, dim| n.checked_mul((*dim)?))
    }

    /// Whether it is known to have no elements.
    pub fn is_empty(&self) -> bool {
        self.len() == Some(0)
    }

    /// Whether its elements can be assigned.
    pub fn is_assignable(&self) -> bool {
        !matches!(self.kind, FieldKind::Derived { .. } | FieldKind::Structure)
    }

    /// Whether it is a single number, not an array.
    pub fn is_scalar(&self) -> bool {
        self.shape.is_empty()
    }
}

/// The kind of a field.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum FieldKind {
    /// State, which evolves during a run; can be assigned.
    State,
    /// An input, which is set from outside.
    Input,
    /// A parameter.
    Constant,
    /// A parameter from which others are computed.
    Inertial,
    /// Computed: an assignment would have no lasting effect, so it is refused.
    Derived {
        /// What computes it, as a phrase after "computed by": `the kinematics stage`.
        by: String,
    },
    /// A size, type or address; cannot be assigned.
    Structure,
}

/// The fields that a function of the host reads or writes.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub enum AccessedFields {
    /// No information.
    #[default]
    Nothing,
    /// These fields.
    Fields(Vec<FieldKey>),
    /// Possibly everything.
    Everything,
}

/// Signature, effects and documentation of a function.
#[derive(Clone, Debug, PartialEq)]
pub struct FunctionInfo {
    /// The name as an author writes it: `mj.mj_setConst`.
    pub name: String,
    /// Parameters in order.
    pub params: Vec<Param>,
    /// The number of trailing parameters that are optional.
    pub optional: usize,
    /// Whether all arguments may be omitted, so that the name alone as a statement is a call.
    pub implied: bool,
    /// The type of the result.
    pub returns: Type,
    /// The members of the result, if it is a record with known members.
    pub members: Vec<(String, Type)>,
    /// The number of elements of the result, if it is a list of known length.
    pub length: Option<usize>,
    /// Whether the arguments are programs that the host evaluates over many samples, see [`crate::Aggregate`].
    pub aggregate: bool,
    /// The fields that it reads.
    pub reads: AccessedFields,
    /// The fields that it writes.
    pub writes: AccessedFields,
    /// The dimension of the numbers in its result.
    pub gives: ResultDimension,
    /// One line of documentation.
    pub doc: String,
}

/// The short form of a call: `mj.mj_forward(model, data)`.
pub(crate) fn signature(schema: &dyn Schema, info: &FunctionInfo) -> String {
    format!("{}({})", info.name, parameters(schema, info).join(", "))
}

/// The parameters of a function as a signature names them.
pub(crate) fn parameters(schema: &dyn Schema, info: &FunctionInfo) -> Vec<String> {
    let params = info.params.iter().map(|param| match param {
        Param::Number | Param::Angle | Param::Lazy => "x".to_owned(),
        Param::Text => "\"text\"".to_owned(),
        Param::Boolean => "true".to_owned(),
        Param::Any => "value".to_owned(),
        Param::Numbers => "list".to_owned(),
        Param::Object(id) => schema.describe(*id),
        Param::Name(id) => format!("\"name of a {}\"", schema.noun(*id)),
    });
    params.collect()
}

/// The dimension of the numbers in a result.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum ResultDimension {
    /// Unknown.
    #[default]
    Unknown,
    /// This dimension.
    This(Dimension),
    /// The dimension of this argument, times a dimension.
    Argument(usize, Dimension),
}

impl ResultDimension {
    /// The measure of the result, given the measures of the arguments.
    pub(crate) fn resolve(self, argument: impl Fn(usize) -> Measure) -> Measure {
        match self {
            ResultDimension::Unknown => Measure::Unknown,
            ResultDimension::This(dimension) => Measure::Dimension(dimension),
            ResultDimension::Argument(i, times) => match argument(i) {
                Measure::Dimension(d) => d.product(times).map_or(Measure::Unknown, Measure::Dimension),
                // A literal number may have any dimension, and so may its product.
                other => other,
            },
        }
    }
}

/// The type of a parameter.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Param {
    /// A number; passed as [`Value::Number`].
    Number,
    /// A number that is an angle in radians; passed as [`Value::Number`].
    Angle,
    /// A string; passed as [`Value::String`].
    Text,
    /// Any value, converted to a boolean.
    Boolean,
    /// A list of numbers, or an array of the simulation, of which a copy is passed: always a [`Value::List`].
    Numbers,
    /// Any value, passed unchanged.
    Any,
    /// Exactly this object, checked at compile time. **Not passed** at run time.
    Object(ObjectId),
    /// A string literal that names a member of the collection; passed as the number of its [`ObjectId`].
    Name(CollectionId),
    /// A program; only for aggregate functions.
    Lazy,
}

/// The meaning of a single element of a field, as far as it matters for lints.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Role {
    /// Anything else.
    #[default]
    Other,
    /// An angle in rad.
    Angle,
    /// A number that is easily mistaken for an angle.
    NoAngle(&'static AngleAdvice),
}

/// The host's part of a finding that the language reports.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct AngleAdvice {
    /// The violated rule of the host.
    pub rule: &'static Rule,
    /// What was written.
    pub what: &'static str,
    /// Why it is a mistake.
    pub why: &'static str,
    /// How to correct it.
    pub help: &'static str,
}

/// Help for a part of a source text, for a user who points at it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Help {
    /// The full form, or the signature.
    pub title: String,
    /// The description, in sentences without full stops.
    pub lines: Vec<String>,
}

/// The names of a host at compile time. Lists are used for suggestions and should have a stable order.
pub trait Schema {
    /// The meaning of a name at the start of an expression. `Math`, `NaN`, `Infinity`, `undefined`, `isNaN`, `isFinite`,
    /// `value` and `ctx` belong to the language and are never passed.
    fn root(&self, name: &str) -> Option<Entry>;

    /// All names that [`Schema::root`] knows.
    fn root_names(&self) -> Vec<String>;

    /// The meaning of `object.name`.
    fn member(&self, object: ObjectId, name: &str) -> Option<Entry>;

    /// The names of all members of an object.
    fn member_names(&self, object: ObjectId) -> Vec<String>;

    /// How a message refers to an object: `model.opt`, `the joint "light_free"`.
    fn describe(&self, object: ObjectId) -> String;

    /// The object with this name.
    fn lookup(&self, collection: CollectionId, name: &str) -> Option<ObjectId>;

    /// All names in a collection.
    fn names(&self, collection: CollectionId) -> Vec<String>;

    /// The noun for an object of a collection: `joint`.
    fn noun(&self, collection: CollectionId) -> &str;

    /// Identifies the model to which field numbers and element indexes refer. They have no meaning for a
    /// host with another identity.
    fn identity(&self) -> u64 {
        0
    }

    /// The field whose elements a function of one object returns, so that a single element can be read without the call.
    fn result_field(&self, function: FunctionId, object: ObjectId) -> Option<Field> {
        let _ = (function, object);
        None
    }

    /// Signature and effects of a function.
    fn function(&self, function: FunctionId) -> FunctionInfo;

    /// A remark of the host about a member that does not exist: what authors who write it usually mean. `index` is the index
    /// that follows the member.
    fn hint(&self, object: ObjectId, name: &str, index: Option<usize>) -> Option<String> {
        let _ = (object, name, index);
        None
    }

    /// The description of element `index` of a whole field: `joint light_free (free): z position, m`.
    fn element_help(&self, field: FieldKey, index: usize) -> Option<String> {
        let _ = (field, index);
        None
    }

    /// The unit of a field, or of one of its elements, counted from the start of the field. Where the unit of the field
    /// depends on the object, it is that of these elements, if it is certain. Empty if there is none.
    fn unit(&self, field: &Field, element: Option<usize>) -> String {
        let _ = element;
        field.unit.clone()
    }

    /// The role of element `index` of a whole field.
    fn role(&self, field: FieldKey, index: usize) -> Role {
        let _ = (field, index);
        Role::Other
    }

    /// Whether element `index` of a whole field changes in small steps during a run, so that it rarely equals a number exactly.
    fn is_continuous(&self, field: FieldKey, index: usize) -> bool {
        let _ = (field, index);
        false
    }

    /// A text that every entry of the list contains which a function returns.
    fn entries_contain(&self, function: FunctionId) -> Option<&'static str> {
        let _ = function;
        None
    }

    /// The dimension of the result of a function; `first` is its first argument, if that is a known number or name.
    fn gives(&self, function: FunctionId, first: Option<f64>) -> ResultDimension {
        let _ = first;
        self.function(function).gives
    }

    /// The measure of the elements of a whole field from `first` on, if it is the same for all of them; without
    /// a count, of all of them.
    fn measure(&self, field: FieldKey, first: usize, count: Option<usize>) -> Measure {
        let _ = (field, first, count);
        Measure::Unknown
    }

    /// The expression for element `index` of a whole field by the name of the object to which it belongs:
    /// `data.joint("light_free").qpos[2]`.
    fn named_element(&self, field: FieldKey, index: usize) -> Option<String> {
        let _ = (field, index);
        None
    }

    /// The terms of the host.
    fn host_terms(&self) -> &'static HostTerms {
        &HostTerms::PLAIN
    }

    /// The call by which an author recomputes derived fields, such as `mj_forward`.
    fn refresh(&self) -> Option<String> {
        None
    }
}
