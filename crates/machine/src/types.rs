//! The types of values, the element types of arrays, and the ids of a host's objects, functions and fields.

/// An object with members: `model`, `model.opt`, the joint `"hinge"`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct ObjectId(pub u32);

/// A collection of named objects of one kind, such as `data.joint(…)`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct CollectionId(pub u32);

/// A function of the host.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct FunctionId(pub u32);

/// A field of the host: an array or a number.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct FieldKey(pub u32);

/// The element type of a field, which determines how a stored number is converted.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Elem {
    /// Doubles.
    #[default]
    Double,
    /// Integers of 32 bits.
    Int,
    /// Bytes.
    Byte,
}

impl Elem {
    /// Converts a number as storing it does.
    pub fn keep(self, x: f64) -> f64 {
        match self {
            Elem::Double => x,
            Elem::Int => f64::from(crate::number::to_int32(x)),
            Elem::Byte => f64::from(crate::number::to_int32(x) & 0xff),
        }
    }
}

/// The type of a value, as known before the run.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Type {
    /// A double.
    Number,
    /// `true` or `false`
    Boolean,
    /// A string.
    String,
    /// `null`
    Null,
    /// `undefined`
    Undefined,
    /// Known only at run time.
    Any,
    /// No value: the function is called for its effect.
    Void,
    /// A list.
    List,
    /// A record.
    Record,
    /// A function of a program.
    Function,
    /// An array of the simulation.
    View,
    /// No value exists: the result of a function that never returns.
    Never,
    /// A number, or `undefined`: an element at an index that may be past the end.
    Element,
}

impl Type {
    /// The type of a value that has one of two types.
    pub fn or(self, other: Type) -> Type {
        match (self, other) {
            (Type::Never, one) | (one, Type::Never) => one,
            (a, b) if a == b => a,
            (
                Type::Number | Type::Undefined | Type::Element,
                Type::Number | Type::Undefined | Type::Element,
            ) => Type::Element,
            _ => Type::Any,
        }
    }

    /// Whether the value is a number, a boolean, `null` or `undefined`, so that arithmetic can use plain numbers.
    pub fn is_plain(self) -> bool {
        !self.may_have_parts() && self != Type::String
    }

    /// Whether the value may be a list, a record, an array or a function.
    pub fn may_have_parts(self) -> bool {
        matches!(self, Type::List | Type::Record | Type::View | Type::Function | Type::Any)
    }

    /// In words, with an article.
    pub fn describe(self) -> &'static str {
        match self {
            Type::Number => "a number",
            Type::Boolean => "a boolean (true or false)",
            Type::String => "a string",
            Type::Null => "null",
            Type::Undefined => "undefined",
            Type::Any => "a value of any type",
            Type::Void => "nothing",
            Type::List => "a list",
            Type::Record => "a record",
            Type::Function => "a function",
            Type::View => "an array",
            Type::Never => "no value",
            Type::Element => "a number, or undefined past the end",
        }
    }
}
