//! The measures of the results of methods and free functions: elements of the receiver, or dimensionless numbers.

use crate::dimension::Measure;
use crate::natives::{Native, NativeResult, ReceiverKind};
use crate::tables::{FreeFunctionId, MethodId};

/// The measure of a method's result; the receiver is the first argument. Where lists and strings have methods of the same
/// name, the result joins the measures of both.
pub(super) fn method(name: MethodId, args: &[Measure]) -> Measure {
    name.rows().map(|row| of_row(row, args)).reduce(Measure::or).unwrap_or_default()
}

fn of_row(row: &Native, args: &[Measure]) -> Measure {
    let receiver = args.first().copied().unwrap_or_default();
    match (row.gives, row.on, row.name) {
        (NativeResult::Boolean | NativeResult::Number, ..) => Measure::NUMBER,
        (.., "concat" | "with") => args.iter().copied().reduce(Measure::or).unwrap_or_default(),
        // Digits in another base and assembled strings represent other numbers.
        (.., "toString") if args.len() > 1 => Measure::Unknown,
        (_, ReceiverKind::Text, "repeat" | "padEnd" | "padStart" | "replace" | "replaceAll") => {
            Measure::Unknown
        }
        (NativeResult::Any, ReceiverKind::Growing | ReceiverKind::Text, _) => receiver,
        (NativeResult::Any | NativeResult::Undefined, ..) => Measure::Unknown,
        (
            NativeResult::String
            | NativeResult::List
            | NativeResult::Receiver
            | NativeResult::Item
            | NativeResult::Element,
            ..,
        ) => receiver,
    }
}

/// The measure of the result of a free function.
pub(super) fn free(function: FreeFunctionId, args: &[Measure]) -> Measure {
    let arg = |i: usize| args.get(i).copied().unwrap_or_default();
    match (function.row().gives, function.row().name) {
        (NativeResult::Boolean, _) => Measure::NUMBER,
        (_, "Number" | "parseFloat" | "Number.parseFloat" | "parseInt" | "Number.parseInt" | "String") => {
            arg(0)
        }
        (_, "Array.from" | "Object.values" | "_copy" | "_untyped" | "_list") => arg(0),
        (_, "_kind") => arg(1),
        (_, "_like" | "_empty") => Measure::Anything,
        (_, "Array.of") => args.iter().copied().reduce(Measure::or).unwrap_or(Measure::Anything),
        _ => Measure::Unknown,
    }
}
