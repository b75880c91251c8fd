//! A row of the table of methods and functions: its name, receiver, arguments, result, meaning and implementation.

use super::env::{Env, NativeError};
use crate::rules;
use crate::types::Type;
use crate::value::Value;

/// The receiver of a method.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ReceiverKind {
    /// Lists, typed arrays and arrays of the host.
    List,
    /// Only lists: methods that change the number of elements.
    Growing,
    /// Only lists: methods that typed arrays do not have.
    Untyped,
    /// Texts.
    Text,
    /// A field: one number or an array.
    Number,
    /// No receiver: `Array.name`, `Number.name`, or a global function if the name has no point.
    Nothing,
}

/// The result of a method.
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
    /// The receiver itself.
    Receiver,
    /// An element of the receiver.
    Item,
}

/// How a method treats NaN, and `undefined` where it is relevant, among the elements of its receiver and its arguments
/// (`Watch`). An inspected NaN counts as lost, unless the result is NaN again.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NanBehaviour {
    /// Elements and arguments determine the result, as in comparisons and conversions to strings.
    Looks,
    /// Elements are moved without being inspected; the arguments determine the positions.
    Moves,
    /// Elements and arguments are passed on.
    Keeps,
    /// The method tests for NaN.
    Asks,
    /// NaN is lost where the definition in the language loses it.
    Source,
}

impl NanBehaviour {
    /// Whether the elements of the receiver are inspected.
    pub fn of_elements(self) -> bool {
        self == NanBehaviour::Looks
    }

    /// Whether the arguments are inspected.
    pub fn of_arguments(self) -> bool {
        matches!(self, NanBehaviour::Looks | NanBehaviour::Moves)
    }
}

/// The implementation of a method.
pub enum Implementation {
    /// A function of the virtual machine, with its smallest and largest number of arguments.
    Run(NativeFunction, usize, usize),
    /// Functions in the language itself, each with its number of arguments; the receiver is the first parameter. The function
    /// is bound as if its source were inlined at the call, so that the types at the call determine how it is evaluated: a sum
    /// over an array of numbers uses only number registers.
    Source(&'static [(usize, &'static str)]),
}

/// A method or a free function.
pub struct Native {
    /// What it is called.
    pub name: &'static str,
    /// What it belongs to.
    pub on: ReceiverKind,
    /// What it gives.
    pub gives: NativeResult,
    /// Whether it changes the elements of its receiver.
    pub changes: bool,
    /// How it treats NaN.
    pub nan: NanBehaviour,
    /// What it means, for people.
    pub doc: &'static str,
    /// An expression and its value as text. `{array}` is replaced by an array of the host.
    pub(super) example: (&'static str, &'static str),
    /// How it is computed.
    pub body: Implementation,
}

pub(super) type NativeFunction = fn(&mut Env<'_>, &Value, &[Value]) -> NativeOutcome;

pub(super) type NativeOutcome = Result<Value, NativeError>;

/// Any number of arguments.
pub(super) const MANY: usize = usize::MAX;

/// Rows as the files of this module write them: name, receiver, number of arguments, result, treatment of NaN,
/// function, example with its value, meaning. For methods that are written in the language, the definitions come last,
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
            doc: labspec_finding::docs($doc),
            example: (labspec_finding::docs($example), labspec_finding::docs($value)),
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
            doc: labspec_finding::docs($doc),
            example: (labspec_finding::docs($example), labspec_finding::docs($value)),
            body: $crate::natives::native::Implementation::Source(&[($first, $text) $(, ($next, $more))?]),
        },)*]
    };
}
pub(super) use table;

impl Native {
    /// Whether a value of this type may have it.
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

    /// The type of its result for a receiver of a type.
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

    /// Its short form: `.map`, `Array.from`.
    pub fn title(&self) -> String {
        let point = if self.on == ReceiverKind::Nothing { "" } else { "." };
        format!("{point}{}", self.name)
    }

    /// The smallest and the largest number of arguments.
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

    /// The example with an array of the host, and its value.
    pub fn example(&self, array: &str) -> (String, &'static str) {
        (self.example.0.replace("{array}", array), self.example.1)
    }

    /// The definitions in the language.
    pub fn texts(&self) -> &'static [(usize, &'static str)] {
        if let Implementation::Source(texts) = self.body { texts } else { &[] }
    }
}

/// The error for a method that the receiver does not have.
pub(super) fn no_method(receiver: &Value, name: &str) -> NativeError {
    let what = receiver.type_of().describe();
    let what = if receiver.is_nothing() { receiver.to_string() } else { what.to_owned() };
    NativeError::new(rules::NOT_CALLABLE, format!("{what} has no method `{name}`"))
}
