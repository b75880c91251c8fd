//! The table of all methods and functions: lookup by name, and calls by the virtual machine.

use labspec_finding::order;
use std::sync::OnceLock;

use super::env::Env;
use super::native::{Implementation, Native, NativeOutcome, ReceiverKind, no_method};
use super::{each, list, number, object, text};
use crate::heap::{Heap, HeapObject};
use crate::tables::{FreeFunctionId, MethodId};
use crate::types::Type;
use crate::value::Value;

/// All rows, sorted by name.
pub fn all() -> &'static [&'static Native] {
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
    let index = all().partition_point(|row| row.name < text);
    let row = all().get(index).filter(|row| row.name == text)?;
    Some((index as u8, row))
}

/// The rows that authors may use.
pub fn public_rows() -> impl Iterator<Item = &'static Native> {
    all().iter().copied().filter(|row| !row.name.starts_with('_'))
}

/// The method with this name, for any receiver.
pub fn find_method(text: &str) -> Option<MethodId> {
    first(text).filter(|(_, row)| row.on != ReceiverKind::Nothing).map(|(index, _)| MethodId(index))
}

/// The free function with this name.
pub fn find_function(text: &str) -> Option<FreeFunctionId> {
    first(text).filter(|(_, row)| row.on == ReceiverKind::Nothing).map(|(index, _)| FreeFunctionId(index))
}

/// The rows from `index` on that have the same name.
fn of_one_name(index: u8) -> impl Iterator<Item = &'static Native> {
    let rows = all().get(usize::from(index)..).unwrap_or(&[]);
    rows.iter().copied().take_while(|row| row.name == rows[0].name)
}

impl FreeFunctionId {
    /// The row of the function.
    pub fn row(self) -> &'static Native {
        all()[usize::from(self.0)]
    }

    /// The rows with this name.
    pub fn rows(self) -> impl Iterator<Item = &'static Native> {
        of_one_name(self.0)
    }
}

impl MethodId {
    /// The name.
    pub fn text(self) -> &'static str {
        all()[usize::from(self.0)].name
    }

    /// The rows with this name.
    pub fn rows(self) -> impl Iterator<Item = &'static Native> {
        of_one_name(self.0)
    }

    /// The rows for a receiver of this type; all rows if the type is unknown.
    pub fn rows_for(self, ty: Type) -> impl Iterator<Item = &'static Native> {
        self.rows().filter(move |row| row.is_of(ty))
    }
}

/// The row by which the virtual machine evaluates a method of a value, if the value has the method.
pub fn find_row(heap: &Heap, name: MethodId, receiver: &Value) -> Option<&'static Native> {
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
pub fn call(env: &mut Env<'_>, name: MethodId, receiver: &Value, args: &[Value]) -> NativeOutcome {
    match find_row(env.heap, name, receiver).map(|row| &row.body) {
        Some(Implementation::Run(run, ..)) => run(env, receiver, args),
        _ => Err(no_method(receiver, name.text())),
    }
}

/// Calls a free function.
pub fn call_free(env: &mut Env<'_>, function: FreeFunctionId, args: &[Value]) -> NativeOutcome {
    match function.row().body {
        Implementation::Run(run, ..) => run(env, &Value::Undefined, args),
        Implementation::Source(_) => Ok(Value::Undefined), // not reached: the binder writes these out
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_machine_has_the_first_row_of_a_name() {
        // A free function that the virtual machine calls must not be one that is inlined.
        for row in all().iter().filter(|row| row.on == ReceiverKind::Nothing) {
            assert!(!find_function(row.name).unwrap().row().calls(), "{}", row.name);
        }
        assert!(all().len() < 256);
    }
}
