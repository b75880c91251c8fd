//! What a host offers at compile time: roots, their members, fields with shape and kind, named objects,
//! functions with signature and effects. The numbers in the ids are the host's own; this crate only hands
//! them back.

use crate::dimension::{Dimension, Measure};
use crate::host_terms::HostTerms;
use crate::rules::Rule;
use crate::types::{CollectionId, Elem, FieldKey, FunctionId, ObjectId, Type};
use crate::value::Value;

/// What a name stands for.
#[derive(Clone, Debug, PartialEq)]
pub enum Entry {
    /// Something with members.
    Object(ObjectId),
    /// Numbers.
    Field(Field),
    /// Called with a literal name, gives an object.
    Collection(CollectionId),
    /// A function.
    Function(FunctionId),
    /// A fixed value.
    Constant(Value),
}

/// Numbers of the host: a whole array, or the part of it that belongs to one named object.
#[derive(Clone, Debug, PartialEq)]
pub struct Field {
    /// Which array.
    pub key: FieldKey,
    /// How an author writes it, for messages: `data.qpos`, `data.joint("a").qpos`.
    pub path: String,
    /// Element of the array at which this view starts.
    pub first: usize,
    /// Dimensions, outermost first; empty for one number, `None` for one that changes while running.
    pub shape: Vec<Option<usize>>,
    /// What it is, and so what assigning means.
    pub kind: FieldKind,
    /// What its elements are.
    pub elem: Elem,
    /// Unit, empty when it has none.
    pub unit: String,
    /// One line of documentation.
    pub doc: String,
    /// Whose index it is, as the start of a sentence on its size: `the model has 14 coordinates`. May be empty.
    pub owner: String,
}

impl Field {
    /// Number of elements of the view; `None` when it changes while running.
    pub fn len(&self) -> Option<usize> {
        self.shape.iter().try_fold(1usize, |n, dim| n.checked_mul((*dim)?))
    }

    /// Whether it is known to have no elements.
    pub fn is_empty(&self) -> bool {
        self.len() == Some(0)
    }

    /// Whether its elements may be set.
    pub fn is_assignable(&self) -> bool {
        !matches!(self.kind, FieldKind::Derived { .. } | FieldKind::Structure)
    }

    /// Whether it is one number rather than an array.
    pub fn is_scalar(&self) -> bool {
        self.shape.is_empty()
    }
}

/// What a field is.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum FieldKind {
    /// Evolves while running; may be set.
    State,
    /// Set from outside.
    Input,
    /// A parameter.
    Constant,
    /// A parameter that others are computed from.
    Inertial,
    /// Computed: assigning has no lasting effect, so it is refused.
    Derived {
        /// What computes it, as the object of "computed by": `the kinematics stage`.
        by: String,
    },
    /// Size, type or address: cannot be assigned.
    Structure,
}

/// What a function of the host touches.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub enum AccessedFields {
    /// Nothing.
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
    /// How an author writes it: `mj.mj_setConst`.
    pub name: String,
    /// Parameters in order.
    pub params: Vec<Param>,
    /// How many trailing parameters may be left out.
    pub optional: usize,
    /// All arguments may be left out, and the bare name as a statement is a call.
    pub implied: bool,
    /// Type of the result.
    pub returns: Type,
    /// Members of the result, when it is a record of known members.
    pub members: Vec<(String, Type)>,
    /// Number of elements of the result, when it is a list of known length.
    pub length: Option<usize>,
    /// The arguments are sub-programs that the host evaluates over many samples, see [`crate::Aggregate`].
    pub aggregate: bool,
    /// What it reads.
    pub reads: AccessedFields,
    /// What it writes.
    pub writes: AccessedFields,
    /// What the numbers that it gives measure.
    pub gives: ResultDimension,
    /// One line of documentation.
    pub doc: String,
}

/// How a function is called, in short: `mj.mj_forward(model, data)`.
pub(crate) fn signature(schema: &dyn Schema, info: &FunctionInfo) -> String {
    let params = info.params.iter().map(|param| match param {
        Param::Number | Param::Angle | Param::Lazy => "x".to_owned(),
        Param::Text => "\"text\"".to_owned(),
        Param::Boolean => "true".to_owned(),
        Param::Any => "value".to_owned(),
        Param::Numbers => "list".to_owned(),
        Param::Object(id) => schema.describe(*id),
        Param::Name(id) => format!("\"name of a {}\"", schema.noun(*id)),
    });
    format!("{}({})", info.name, params.collect::<Vec<_>>().join(", "))
}

/// What the numbers of a result measure.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum ResultDimension {
    /// That is not known.
    #[default]
    Unknown,
    /// This.
    This(Dimension),
    /// What this argument measures, times this dimension.
    Argument(usize, Dimension),
}

impl ResultDimension {
    /// What a result measures whose arguments measure this.
    pub(crate) fn resolve(self, argument: impl Fn(usize) -> Measure) -> Measure {
        match self {
            ResultDimension::Unknown => Measure::Unknown,
            ResultDimension::This(dimension) => Measure::Known(dimension),
            ResultDimension::Argument(i, times) => match argument(i) {
                Measure::Known(d) => d.product(times).map_or(Measure::Unknown, Measure::Known),
                // A number of the text may stand for anything, and so may what it is multiplied with.
                other => other,
            },
        }
    }
}

/// What a parameter takes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Param {
    /// A number; passed as [`Value::Number`].
    Number,
    /// A number that is an angle in radians; passed as [`Value::Number`].
    Angle,
    /// Text; passed as [`Value::String`].
    Text,
    /// Anything, converted to true or false.
    Boolean,
    /// A list of numbers, or an array of the simulation, which is passed as a copy: always a [`Value::List`].
    Numbers,
    /// Any value, as it is.
    Any,
    /// Exactly this object, checked when compiling. **Not passed** at run time.
    Object(ObjectId),
    /// A literal string that names a member of the collection; passed as the number of its [`ObjectId`].
    Name(CollectionId),
    /// A sub-program; only of aggregate functions.
    Lazy,
}

/// What a single element of a field measures, as far as mistakes about it are known.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Role {
    /// Anything else.
    #[default]
    Other,
    /// An angle in rad.
    Angle,
    /// A number that is easily taken for an angle and is none.
    NoAngle(&'static AngleAdvice),
}

/// What a host says of a mistake that the language finds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct AngleAdvice {
    /// The rule of the host that is broken.
    pub rule: &'static Rule,
    /// What it is that was written.
    pub what: &'static str,
    /// Why it is a mistake.
    pub why: &'static str,
    /// What to do.
    pub help: &'static str,
}

/// What a place in a text is, for a person who points at it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Help {
    /// How it is written in full, or its signature.
    pub title: String,
    /// What it is, in sentences without full stops.
    pub lines: Vec<String>,
}

/// Names to things, at compile time. Lists are for suggestions and should have a stable order.
pub trait Schema {
    /// What a name at the start of an expression stands for. `Math`, `NaN`, `Infinity`, `undefined`, `isNaN`,
    /// `isFinite`, `value` and `ctx` belong to the language and are not asked for.
    fn root(&self, name: &str) -> Option<Entry>;

    /// All such names.
    fn root_names(&self) -> Vec<String>;

    /// What `object.name` stands for.
    fn member(&self, object: ObjectId, name: &str) -> Option<Entry>;

    /// All members of an object.
    fn member_names(&self, object: ObjectId) -> Vec<String>;

    /// How to call an object in a message: `model.opt`, `the joint "light_free"`.
    fn describe(&self, object: ObjectId) -> String;

    /// The object of this name.
    fn lookup(&self, collection: CollectionId, name: &str) -> Option<ObjectId>;

    /// All names of a collection.
    fn names(&self, collection: CollectionId) -> Vec<String>;

    /// What one of its objects is called: `joint`.
    fn noun(&self, collection: CollectionId) -> &str;

    /// What the numbers of its fields and elements are of. They mean nothing to a host that says something else.
    fn identity(&self) -> u64 {
        0
    }

    /// The field whose elements a function of one object gives, so that a single one can be read without the call.
    fn result_field(&self, function: FunctionId, object: ObjectId) -> Option<Field> {
        let _ = (function, object);
        None
    }

    /// Signature and effects of a function.
    fn function(&self, function: FunctionId) -> FunctionInfo;

    /// A remark of the host on a member that does not exist: what people who write it usually mean.
    fn hint(&self, object: ObjectId, name: &str) -> Option<String> {
        let _ = (object, name);
        None
    }

    /// What element `index` of a whole field is: `joint light_free (free): z position, m`.
    fn element_help(&self, field: FieldKey, index: usize) -> Option<String> {
        let _ = (field, index);
        None
    }

    /// What element `index` of a whole field measures.
    fn role(&self, field: FieldKey, index: usize) -> Role {
        let _ = (field, index);
        Role::Other
    }

    /// What the result of a function measures; `first` is its first argument, where that is a known number or name.
    fn gives(&self, function: FunctionId, first: Option<f64>) -> ResultDimension {
        let _ = first;
        self.function(function).gives
    }

    /// What the elements of a whole field from `first` on measure, where they all measure the same; without a count, all of them.
    fn measure(&self, field: FieldKey, first: usize, count: Option<usize>) -> Measure {
        let _ = (field, first, count);
        Measure::Unknown
    }

    /// How an author writes element `index` of a whole field by the name of the object that it belongs to:
    /// `data.joint("light_free").qpos[2]`.
    fn named_element(&self, field: FieldKey, index: usize) -> Option<String> {
        let _ = (field, index);
        None
    }

    /// What the host calls its things.
    fn host_terms(&self) -> &'static HostTerms {
        &HostTerms::PLAIN
    }

    /// What an author writes to have derived fields computed again, as `mj_forward`.
    fn refresh(&self) -> Option<String> {
        None
    }
}
