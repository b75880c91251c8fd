//! One row of the table of methods and functions: what it is called, takes, gives and means, and how it is computed.

use super::env::{Env, NativeError};
use crate::rules;
use crate::types::Type;
use crate::value::Value;

/// What a method belongs to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ReceiverKind {
    /// Lists, typed arrays and arrays of the host.
    List,
    /// Lists alone: what changes the number of elements.
    Growing,
    /// Lists alone: typed arrays do not have it.
    Untyped,
    /// Texts.
    Text,
    /// Numbers.
    Number,
    /// `Array.name`, `Number.name`; a name without a point stands alone.
    Nothing,
}

/// What a method gives.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NativeResult {
    /// A value of a type that is not known.
    Any,
    /// A boolean.
    Boolean,
    /// A number.
    Number,
    /// A text.
    String,
    /// A list.
    List,
    /// Nothing.
    Undefined,
    /// A number, or `undefined`.
    Element,
    /// What it was called on.
    Receiver,
    /// An element of what it was called on.
    Item,
}

/// What becomes of NaN, and of `undefined` where that counts, among the elements of what a method is called on and among its
/// arguments ([`crate::watch::Watch`]). What is looked at is lost, unless the result is NaN again.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NanBehaviour {
    /// Elements and arguments decide the result, as comparisons and texts do.
    Looks,
    /// Elements are moved and none is looked at; the arguments say where.
    Moves,
    /// Elements and arguments are handed on.
    Keeps,
    /// Whether something is a number is what is asked for.
    Asks,
    /// It is lost where the text in the language loses it.
    Source,
}

impl NanBehaviour {
    /// Whether the elements of what it is called on are looked at.
    pub fn of_elements(self) -> bool {
        self == NanBehaviour::Looks
    }

    /// Whether the arguments are looked at.
    pub fn of_arguments(self) -> bool {
        matches!(self, NanBehaviour::Looks | NanBehaviour::Moves)
    }
}

/// How a method is computed.
pub enum Implementation {
    /// By the machine, with at least and at most so many arguments.
    Run(NativeFunction, usize, usize),
    /// By functions of the language itself, with how many arguments each of them is called: what stands before the point
    /// is the first parameter. Where the method is called, the function is bound as if its text stood there, so that the
    /// types of that place decide how it is computed: a sum over an array of numbers never leaves the number registers.
    Source(&'static [(usize, &'static str)]),
}

/// A method, or a function.
pub struct Native {
    /// What it is called.
    pub name: &'static str,
    /// What it belongs to.
    pub on: ReceiverKind,
    /// What it gives.
    pub gives: NativeResult,
    /// It changes the elements of what it is called on.
    pub changes: bool,
    /// What becomes of NaN.
    pub nan: NanBehaviour,
    /// What it means, for people.
    pub doc: &'static str,
    /// An expression and its value, as text. `{array}` stands for an array of the host.
    pub(super) example: (&'static str, &'static str),
    /// How it is computed.
    pub body: Implementation,
}

pub(super) type NativeFunction = fn(&mut Env<'_>, &Value, &[Value]) -> NativeOutcome;

pub(super) type NativeOutcome = Result<Value, NativeError>;

/// Any number of arguments.
pub(super) const MANY: usize = usize::MAX;

/// Rows, as they are written in the files beside this one: name, what it belongs to, the number of arguments, what it gives,
/// what becomes of NaN, the function, an example with its value, the meaning. Of those that are written in the language the texts stand last,
/// each with its number of arguments.
macro_rules! table {
    ($($name:literal $on:ident $($changes:ident)? ($least:expr, $most:expr) $gives:ident $nan:ident $run:ident:
        $example:literal => $value:literal, $doc:literal;)*) => {
        &[$(Native {
            name: $name,
            on: $crate::natives::native::ReceiverKind::$on,
            gives: $crate::natives::native::NativeResult::$gives,
            changes: !stringify!($($changes)?).is_empty(),
            nan: $crate::natives::native::NanBehaviour::$nan,
            doc: $doc,
            example: ($example, $value),
            body: $crate::natives::native::Implementation::Run($run, $least, $most),
        },)*]
    };
    ($($name:literal $on:ident $($changes:ident)?: $example:literal => $value:literal, $doc:literal,
        $first:literal => $text:expr $(, $next:literal => $more:expr)?;)*) => {
        &[$(Native {
            name: $name,
            on: $crate::natives::native::ReceiverKind::$on,
            gives: $crate::natives::native::NativeResult::Any,
            changes: !stringify!($($changes)?).is_empty(),
            nan: $crate::natives::native::NanBehaviour::Source,
            doc: $doc,
            example: ($example, $value),
            body: $crate::natives::native::Implementation::Source(&[($first, $text) $(, ($next, $more))?]),
        },)*]
    };
}
pub(super) use table;

impl Native {
    /// Whether a value of this type has it, as far as that is known.
    pub fn is_of(&self, ty: Type) -> bool {
        matches!(ty, Type::Any | Type::Never)
            || match self.on {
                ReceiverKind::List => matches!(ty, Type::List | Type::View),
                ReceiverKind::Growing | ReceiverKind::Untyped => ty == Type::List,
                ReceiverKind::Text => ty == Type::String,
                ReceiverKind::Number => matches!(ty, Type::Number | Type::Element),
                ReceiverKind::Nothing => false,
            }
    }

    /// The type of its result, called on something of a type.
    pub fn returns(&self, receiver: Type) -> Type {
        match self.gives {
            NativeResult::Any => Type::Any,
            NativeResult::Boolean => Type::Boolean,
            NativeResult::Number => Type::Number,
            NativeResult::String => Type::String,
            NativeResult::List => Type::List,
            NativeResult::Undefined => Type::Undefined,
            NativeResult::Element => Type::Element,
            NativeResult::Receiver => receiver,
            NativeResult::Item if receiver == Type::View => Type::Element,
            NativeResult::Item => Type::Any,
        }
    }

    /// How it is called, in short: `.map`, `Array.from`.
    pub fn title(&self) -> String {
        let point = if self.on == ReceiverKind::Nothing { "" } else { "." };
        format!("{point}{}", self.name)
    }

    /// The least and the largest number of arguments.
    pub fn arity(&self) -> (usize, usize) {
        match self.body {
            Implementation::Run(_, least, most) => (least, most),
            Implementation::Source(texts) => {
                (texts.first().map_or(0, |(n, _)| *n), texts.last().map_or(0, |(n, _)| *n))
            }
        }
    }

    /// Whether it calls a function for every element.
    pub fn calls(&self) -> bool {
        matches!(self.body, Implementation::Source(_))
    }

    /// The example and its value, with an array of the host.
    pub fn example(&self, array: &str) -> (String, &'static str) {
        (self.example.0.replace("{array}", array), self.example.1)
    }

    /// The texts of the functions that compute it.
    pub fn texts(&self) -> &'static [(usize, &'static str)] {
        if let Implementation::Source(texts) = self.body { texts } else { &[] }
    }
}

/// Why a method is not called.
pub(super) fn no_method(receiver: &Value, name: &str) -> NativeError {
    let what = receiver.type_of().describe();
    let what = if receiver.is_nothing() { receiver.to_string() } else { what.to_owned() };
    NativeError::new(rules::NOT_CALLABLE, format!("{what} has no method `{name}`"))
}
