//! The table of all methods and functions: lookup by name, and calls by the virtual machine.

use labspec_finding::order;
use std::sync::OnceLock;

use super::env::Env;
use super::native::{Implementation, Native, NativeOutcome, ReceiverKind, no_method};
use super::{each, list, number, object, text};
use crate::ast::{ExprKind, Function};
use crate::heap::{Heap, HeapObject};
use crate::ir::{FreeFunctionId, MethodId};
use crate::parse::parse_expression;
use crate::types::Type;
use crate::value::Value;

/// All rows, sorted by name.
fn all() -> &'static [&'static Native] {
    static ALL: OnceLock<Vec<&'static Native>> = OnceLock::new();
    ALL.get_or_init(|| {
        let files = [list::ROWS, each::ROWS, text::ROWS, number::ROWS, object::ROWS, object::SOURCE_ROWS];
        let mut all: Vec<&Native> = files.into_iter().flatten().collect();
        order::sort_by_key(&mut all, |row| row.name);
        all
    })
}

/// The first row of a name, and its index.
fn first(text: &str) -> Option<(u8, &'static Native)> {
    let at = all().partition_point(|row| row.name < text);
    let row = all().get(at).filter(|row| row.name == text)?;
    Some((at as u8, row))
}

/// The rows that authors may use.
pub(crate) fn public_rows() -> impl Iterator<Item = &'static Native> {
    all().iter().copied().filter(|row| !row.name.starts_with('_'))
}

/// The method with this name, for any receiver.
pub(crate) fn find_method(text: &str) -> Option<MethodId> {
    first(text).filter(|(_, row)| row.on != ReceiverKind::Nothing).map(|(at, _)| MethodId(at))
}

/// The free function with this name.
pub(crate) fn find_function(text: &str) -> Option<FreeFunctionId> {
    first(text).filter(|(_, row)| row.on == ReceiverKind::Nothing).map(|(at, _)| FreeFunctionId(at))
}

/// The rows from index `at` on that have the same name.
fn of_one_name(at: u8) -> impl Iterator<Item = &'static Native> {
    let rows = all().get(usize::from(at)..).unwrap_or(&[]);
    rows.iter().copied().take_while(|row| row.name == rows[0].name)
}

impl FreeFunctionId {
    pub(crate) fn row(self) -> &'static Native {
        all()[usize::from(self.0)]
    }

    /// The definition in the language for this number of arguments, if there is one.
    pub(crate) fn source_function(self, arguments: usize) -> Option<&'static Function> {
        of_one_name(self.0).find_map(|row| row.source_function(arguments))
    }
}

impl MethodId {
    pub(crate) fn text(self) -> &'static str {
        all()[usize::from(self.0)].name
    }

    /// The rows with this name.
    pub(crate) fn rows(self) -> impl Iterator<Item = &'static Native> {
        of_one_name(self.0)
    }

    /// The rows for a receiver of this type; all rows if the type is unknown.
    pub(crate) fn rows_for(self, ty: Type) -> impl Iterator<Item = &'static Native> {
        self.rows().filter(move |row| row.is_of(ty))
    }
}

impl Native {
    /// The definition in the language for this number of arguments, if there is one.
    pub(crate) fn source_function(&self, arguments: usize) -> Option<&'static Function> {
        static READ: OnceLock<Vec<(&str, Function)>> = OnceLock::new();
        let Implementation::Source(texts) = self.body else { return None };
        let (_, text) = texts.iter().find(|(n, _)| *n == arguments)?;
        let read = READ.get_or_init(|| {
            let texts = all().iter().flat_map(|row| row.texts());
            texts.filter_map(|(_, text)| Some((*text, function(text)?))).collect()
        });
        read.iter().find(|(t, _)| std::ptr::eq(*t, *text)).map(|(_, function)| function)
    }
}

/// All definitions of methods in the language.
pub(crate) fn source_functions() -> impl Iterator<Item = &'static Function> {
    all().iter().flat_map(|row| row.texts().iter().filter_map(|(n, _)| row.source_function(*n)))
}

/// Parses a function.
fn function(text: &str) -> Option<Function> {
    match parse_expression(text).tree.kind {
        ExprKind::Function(function) => Some(*function),
        _ => None,
    }
}

/// The row by which the virtual machine evaluates a method of a value, if the value has the method.
pub(crate) fn find_row(heap: &Heap, name: MethodId, receiver: &Value) -> Option<&'static Native> {
    let list = matches!(heap.object(receiver), HeapObject::List(_));
    // Only typed arrays have `set` and `subarray`.
    if list && matches!(name.text(), "set" | "subarray") {
        return None;
    }
    name.rows().filter(|row| !row.calls()).find(|row| match (row.on, receiver) {
        (ReceiverKind::List, Value::List(_) | Value::View(_))
        | (ReceiverKind::Text, Value::String(_))
        | (ReceiverKind::Number, Value::Number(_)) => true,
        (ReceiverKind::Growing | ReceiverKind::Untyped, Value::List(_)) => list,
        _ => false,
    })
}

/// Calls a method.
pub(crate) fn call(env: &mut Env<'_>, name: MethodId, receiver: &Value, args: &[Value]) -> NativeOutcome {
    match find_row(env.heap, name, receiver).map(|row| &row.body) {
        Some(Implementation::Run(run, ..)) => run(env, receiver, args),
        _ => Err(no_method(receiver, name.text())),
    }
}

/// Calls a free function.
pub(crate) fn call_free(env: &mut Env<'_>, function: FreeFunctionId, args: &[Value]) -> NativeOutcome {
    match function.row().body {
        Implementation::Run(run, ..) => run(env, &Value::Undefined, args),
        Implementation::Source(_) => Ok(Value::Undefined), // unreachable: the binder inlines these
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mock::World;
    use crate::natives::native::NanBehaviour;

    /// The result of a row for `[9, element, 7]` and these arguments, with `X` in place of each `element` and `argument`.
    fn outcome(row: &Native, element: f64, argument: f64, args: &[f64]) -> String {
        fn show(heap: &Heap, value: &Value, unknown: [f64; 2]) -> String {
            match value {
                Value::Number(x) if unknown.iter().any(|u| u.to_bits() == x.to_bits()) => "X".into(),
                Value::List(_) => {
                    let items = (0..heap.len(value).unwrap()).map(|i| heap.item(value, i).unwrap());
                    format!("[{}]", items.map(|v| show(heap, &v, unknown)).collect::<Vec<_>>().join(" "))
                }
                other => other.to_string(),
            }
        }
        let Implementation::Run(run, ..) = row.body else { return String::new() };
        let (mut heap, mut host, mut budget) = (Heap::default(), World::new(), u64::MAX);
        let items = [9.0, element, 7.0].map(Value::Number);
        let receiver = match row.name {
            "set" => heap.numbers(&[9.0, element, 7.0]).unwrap(),
            _ => heap.list(items.to_vec()).unwrap(),
        };
        let number = |x: &f64| Value::Number(if *x == 8.0 { argument } else { *x });
        let args: Vec<Value> = args.iter().map(number).collect();
        let mut env = Env { heap: &mut heap, host: &mut host, views: &[], budget: &mut budget };
        let result = run(&mut env, &receiver, &args).map_err(|e| e.message);
        let display = |value: &Value| show(&heap, value, [element, argument]);
        format!("{} {}", result.as_ref().map_or_else(Clone::clone, &display), display(&receiver))
    }

    #[test]
    fn every_row_states_what_becomes_of_nan() {
        let arguments: [&[f64]; 10] = [
            &[8.5],
            &[],
            &[1.0],
            &[8.0],
            &[0.0, 2.0],
            &[0.0, 8.0],
            &[8.0, 8.0],
            &[8.0, 1.0],
            &[1.0, 1.0, 8.0],
            &[1.0, 2.0, 3.0],
        ];
        for row in all() {
            let lists = matches!(row.on, ReceiverKind::List | ReceiverKind::Growing | ReceiverKind::Untyped);
            // Exactly the functions that are written in the language have this value.
            assert_eq!(row.nan == NanBehaviour::Source, row.calls(), "{}", row.name);
            // Functions with an underscore are called only by definitions in the language, which pass a list and its length.
            if row.calls() || row.name.starts_with('_') || !(lists || row.on == ReceiverKind::Nothing) {
                continue;
            }
            let (least, most) = row.arity();
            let fitting = || arguments.into_iter().filter(|args| (least..=most).contains(&args.len()));
            let of = |element, argument, args: &&[f64]| outcome(row, element, argument, args);
            let elements = lists && fitting().any(|args| of(8.5, 1.5, &args) != of(f64::NAN, 1.5, &args));
            let arguments = fitting().any(|args| of(8.5, 8.0, &args) != of(8.5, f64::NAN, &args));
            let moved = lists
                && fitting().filter(|a| !a.contains(&8.5)).any(|a| of(8.5, 1.5, &a) != of(f64::NAN, 1.5, &a));
            let asks = row.nan == NanBehaviour::Asks;
            assert!(row.nan.of_elements() || !moved || asks, "{} looks at elements", row.name);
            assert!(row.nan.of_arguments() || !arguments || asks, "{} looks at arguments", row.name);
            // A row that declares that it inspects elements must do so.
            assert!(!(lists && row.nan.of_elements()) || elements, "{} looks at no element", row.name);
        }
    }

    #[test]
    fn every_method_that_is_written_is_read_without_a_mistake() {
        for (row, (n, text)) in all().iter().flat_map(|row| row.texts().iter().map(move |t| (row, t))) {
            assert!(parse_expression(text).diagnostics.is_empty(), "{}", row.name);
            assert!(row.source_function(*n).is_some(), "{}", row.name);
        }
    }

    #[test]
    fn the_machine_has_the_first_row_of_a_name() {
        // A free function that the virtual machine calls must not be one that is inlined.
        for row in all().iter().filter(|row| row.on == ReceiverKind::Nothing) {
            assert!(!find_function(row.name).unwrap().row().calls(), "{}", row.name);
        }
        assert!(all().len() < 256);
    }
}
