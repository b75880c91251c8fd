//! The types of values, what the elements of arrays are, and the numbers by which a host names its things.

/// An object with members: `model`, `model.opt`, the joint `"hinge"`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct ObjectId(pub u32);

/// Named objects of one sort: what `data.joint(…)` chooses from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct CollectionId(pub u32);

/// A function of the host.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct FunctionId(pub u32);

/// An array or number of the host.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct FieldKey(pub u32);

/// What the elements of a field are, and so what is left of a number that is stored there.
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
    /// What is kept of a number.
    pub fn keep(self, x: f64) -> f64 {
        match self {
            Elem::Double => x,
            Elem::Int => f64::from(crate::number::to_int32(x)),
            Elem::Byte => f64::from(crate::number::to_int32(x) & 0xff),
        }
    }
}

/// What is known of a value before running.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Type {
    /// A double.
    Number,
    /// `true` or `false`
    Boolean,
    /// Text.
    String,
    /// `null`
    Null,
    /// `undefined`
    Undefined,
    /// Known only while running.
    Any,
    /// Nothing: the function is called for its effect.
    Void,
    /// A list.
    List,
    /// A record.
    Record,
    /// A function of the text.
    Function,
    /// An array of the simulation.
    View,
    /// No value ever: what a function gives that never returns.
    Never,
    /// A number, or `undefined`: an element at an index that may be past the end.
    Element,
}

impl Type {
    /// The type of a value that is one or the other.
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

    /// Whether it is nothing but numbers, truth values and nothing: then arithmetic on it can use plain numbers.
    pub fn is_plain(self) -> bool {
        !self.may_have_parts() && self != Type::String
    }

    /// Whether it may be something with parts: a list, a record, an array, a function.
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
