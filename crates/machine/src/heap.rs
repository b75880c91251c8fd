//! The heap of one lab: lists, records and functions. Values refer to heap objects by index, so that a value is small and can
//! be sent between threads, and cycles of lists do not leak: unreachable objects are collected (mark and sweep; McCarthy,
//! "Recursive functions of symbolic expressions", 1960).

use std::fmt::Write;
use std::sync::Arc;

use crate::code::MachineCode;
use crate::number;
use crate::types::Elem;
use crate::value::{Ref, Value};

/// An object to which a value refers.
#[derive(Clone, Debug, Default)]
pub enum HeapObject {
    /// A place that is free.
    #[default]
    Free,
    /// A JavaScript array.
    List(Vec<Value>),
    /// A typed array: its length is fixed, and it contains only numbers.
    Numbers(Vec<f64>, Elem),
    /// The entries are in the order in which the keys were first stored.
    Record(Vec<(Arc<str>, Value)>),
    /// A function of a text, with its variables.
    Closure {
        /// The code that has the function.
        code: Arc<MachineCode>,
        /// Which function of the code it is.
        unit: u32,
        /// Values of the variables of the functions around it.
        captures: Vec<Value>,
    },
    /// A variable that several functions share; `None` before its declaration is executed.
    Cell(Option<Value>),
}

/// Limit on the bytes of all lists, records and strings of a lab.
const MAX_BYTES: usize = 64 << 20;
/// The bytes of one value in a list.
const VALUE: usize = size_of::<Value>();
/// Bytes in use below which nothing is collected.
const MIN_COLLECTION: usize = 1 << 20;
/// Limit on the depth of nested lists that are printed.
const MAX_PRINT_DEPTH: usize = 32;
/// The longest string that a program can build, in bytes. A string that grows with every step must not
/// exhaust the memory of the page.
pub(crate) const MAX_TEXT: usize = 1 << 20;

/// The heap is full.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Full;

/// The heap: lists, records and functions.
#[derive(Clone, Debug, Default)]
pub struct Heap {
    objects: Vec<HeapObject>,
    free: Vec<u32>,
    /// Bytes in use, approximately.
    bytes: usize,
    /// The number of bytes at which the next collection happens.
    threshold: usize,
}

impl Heap {
    /// Creates a list.
    ///
    /// # Errors
    /// The lists of the lab exceed the memory limit.
    pub fn list(&mut self, items: Vec<Value>) -> Result<Value, Full> {
        let bytes = items.iter().map(weight).sum();
        self.add(HeapObject::List(items), bytes).map(Value::List)
    }

    /// Creates a list of numbers.
    ///
    /// # Errors
    /// As [`Heap::list`].
    pub fn numbers(&mut self, items: &[f64]) -> Result<Value, Full> {
        self.list(items.iter().map(|&x| Value::Number(x)).collect())
    }

    /// Creates a record.
    ///
    /// # Errors
    /// As [`Heap::list`].
    pub fn record(&mut self, entries: Vec<(Arc<str>, Value)>) -> Result<Value, Full> {
        let bytes = entries.iter().map(|(_, v)| 2 * VALUE + weight(v)).sum();
        self.add(HeapObject::Record(entries), bytes).map(Value::Record)
    }

    /// Creates a typed array.
    pub(crate) fn typed(&mut self, items: Vec<f64>, elem: Elem) -> Result<Value, Full> {
        let bytes = items.len() * size_of::<f64>();
        self.add(HeapObject::Numbers(items, elem), bytes).map(Value::List)
    }

    pub(crate) fn closure(
        &mut self,
        code: Arc<MachineCode>,
        unit: u32,
        captures: Vec<Value>,
    ) -> Result<Value, Full> {
        let bytes = captures.iter().map(weight).sum();
        self.add(HeapObject::Closure { code, unit, captures }, bytes).map(Value::Function)
    }

    /// Creates a shared variable. The value refers to it as if it were a list; only the virtual machine sees that value.
    pub(crate) fn cell(&mut self, value: Option<Value>) -> Result<Value, Full> {
        self.add(HeapObject::Cell(value), VALUE).map(Value::List)
    }

    /// Returns the number of elements of a list.
    pub fn len(&self, value: &Value) -> Option<usize> {
        match self.object(value) {
            HeapObject::List(items) => Some(items.len()),
            HeapObject::Numbers(items, _) => Some(items.len()),
            _ => None,
        }
    }

    /// Returns an element of a list, or `None` past the end or if the value is not a list.
    pub fn item(&self, value: &Value, index: usize) -> Option<Value> {
        match self.object(value) {
            HeapObject::List(items) => items.get(index).cloned(),
            HeapObject::Numbers(items, _) => items.get(index).map(|&x| Value::Number(x)),
            _ => None,
        }
    }

    /// Returns all elements of a list as numbers, or `None` if the value is not a list.
    pub fn to_numbers(&self, value: &Value) -> Option<Vec<f64>> {
        match self.object(value) {
            HeapObject::List(items) => Some(items.iter().map(|v| self.number(v)).collect()),
            HeapObject::Numbers(items, _) => Some(items.clone()),
            _ => None,
        }
    }

    /// Overwrites the first elements of a list with numbers. Returns `false` and writes nothing if the value is not a list, is
    /// shorter, or contains integers.
    pub fn overwrite(&mut self, value: &Value, numbers: &[f64]) -> bool {
        match self.object_mut(value) {
            Some(HeapObject::List(items)) if items.len() >= numbers.len() => {
                for (item, x) in items.iter_mut().zip(numbers) {
                    *item = Value::Number(*x);
                }
                true
            }
            Some(HeapObject::Numbers(items, Elem::Double)) if items.len() >= numbers.len() => {
                items.iter_mut().zip(numbers).for_each(|(item, x)| *item = *x);
                true
            }
            _ => false,
        }
    }

    /// Returns a member of a record.
    pub fn get(&self, value: &Value, key: &str) -> Option<Value> {
        match self.object(value) {
            HeapObject::Record(entries) => entries.iter().find(|(k, _)| **k == *key).map(|(_, v)| v.clone()),
            _ => None,
        }
    }

    /// JavaScript's `String(v)`. For an array of the simulation, the text only describes the array.
    pub fn text(&self, value: &Value) -> String {
        let mut out = String::new();
        self.write(value, 0, &mut out);
        out
    }

    /// JavaScript's `Number(v)`.
    pub fn number(&self, value: &Value) -> f64 {
        match value {
            Value::List(_) => number::from_text(&self.text(value)),
            other => other.to_number(),
        }
    }

    fn write(&self, value: &Value, depth: usize, out: &mut String) {
        if depth > MAX_PRINT_DEPTH || out.len() > MAX_TEXT {
            return;
        }
        let mut first = true;
        let mut comma = |out: &mut String| {
            if !std::mem::take(&mut first) {
                out.push(',');
            }
        };
        match self.object(value) {
            HeapObject::List(items) => {
                for item in items {
                    comma(out);
                    if !item.is_nothing() {
                        self.write(item, depth + 1, out);
                    }
                }
            }
            HeapObject::Numbers(items, _) => {
                for x in items {
                    comma(out);
                    out.push_str(&number::to_text(*x));
                }
            }
            _ => {
                // Writing to a `String` cannot fail.
                let _ = write!(out, "{value}");
            }
        }
    }

    /// Returns the object to which a value refers.
    pub fn object(&self, value: &Value) -> &HeapObject {
        const NOTHING: &HeapObject = &HeapObject::Free;
        match value {
            Value::List(r) | Value::Record(r) | Value::Function(r) => {
                self.objects.get(r.0 as usize).unwrap_or(NOTHING)
            }
            _ => NOTHING,
        }
    }

    /// As [`Heap::object`], for modification. A caller that enlarges the object must call [`Heap::grow`].
    pub(crate) fn object_mut(&mut self, value: &Value) -> Option<&mut HeapObject> {
        match value {
            Value::List(r) | Value::Record(r) | Value::Function(r) => self.objects.get_mut(r.0 as usize),
            _ => None,
        }
    }

    /// Records that an object grows by a value.
    pub(crate) fn grow(&mut self, value: &Value) -> Result<(), Full> {
        self.take(VALUE + weight(value))
    }

    fn take(&mut self, bytes: usize) -> Result<(), Full> {
        self.bytes = self.bytes.saturating_add(bytes);
        if self.bytes > MAX_BYTES { Err(Full) } else { Ok(()) }
    }

    fn add(&mut self, object: HeapObject, bytes: usize) -> Result<Ref, Full> {
        self.take(size_of::<HeapObject>() + bytes)?;
        if let Some(index) = self.free.pop() {
            if let Some(place) = self.objects.get_mut(index as usize) {
                *place = object;
            }
            return Ok(Ref(index));
        }
        let index = u32::try_from(self.objects.len()).map_err(|_| Full)?;
        self.objects.push(object);
        Ok(Ref(index))
    }

    /// Whether enough memory was allocated since the last collection to make another one worthwhile.
    pub(crate) fn needs_collection(&self) -> bool {
        self.bytes > self.threshold.max(MIN_COLLECTION)
    }

    /// The number of places for objects.
    pub(crate) fn places(&self) -> usize {
        self.objects.len()
    }

    /// Frees all objects that are unreachable from the roots.
    pub(crate) fn collect<'a>(&mut self, roots: impl Iterator<Item = &'a Value>) {
        let mut reached = vec![false; self.objects.len()];
        let mut waiting: Vec<Ref> = Vec::new();
        let mut reach = |value: &Value, waiting: &mut Vec<Ref>| {
            if let Value::List(r) | Value::Record(r) | Value::Function(r) = value
                && let Some(mark) = reached.get_mut(r.0 as usize)
                && !std::mem::replace(mark, true)
            {
                waiting.push(*r);
            }
        };
        for root in roots {
            reach(root, &mut waiting);
        }
        let mut bytes = 0;
        while let Some(r) = waiting.pop() {
            bytes += size_of::<HeapObject>();
            match self.objects.get(r.0 as usize) {
                Some(HeapObject::List(items) | HeapObject::Closure { captures: items, .. }) => {
                    for item in items {
                        bytes += weight(item);
                        reach(item, &mut waiting);
                    }
                }
                Some(HeapObject::Record(entries)) => {
                    for (_, value) in entries {
                        bytes += 2 * VALUE + weight(value);
                        reach(value, &mut waiting);
                    }
                }
                Some(HeapObject::Cell(Some(value))) => {
                    bytes += weight(value);
                    reach(value, &mut waiting);
                }
                Some(HeapObject::Numbers(items, _)) => bytes += items.len() * size_of::<f64>(),
                _ => {}
            }
        }
        self.free.clear();
        self.objects.truncate(reached.iter().rposition(|reached| *reached).map_or(0, |last| last + 1));
        for (index, (object, reached)) in self.objects.iter_mut().zip(&reached).enumerate() {
            if !reached {
                *object = HeapObject::Free;
                self.free.push(index as u32);
            }
        }
        self.bytes = bytes;
        self.threshold = 2 * bytes;
    }
}

/// The bytes of a value in a list, including its string.
fn weight(value: &Value) -> usize {
    VALUE + value.text_len()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn unreferenced_objects_are_freed() {
        let mut heap = Heap::default();
        let rooted = heap.numbers(&[1.0, 2.0]).unwrap();
        let ring = heap.list(Vec::new()).unwrap();
        if let Some(HeapObject::List(items)) = heap.object_mut(&ring) {
            items.push(ring.clone());
        }
        heap.collect([&rooted].into_iter());
        assert_eq!(heap.text(&rooted), "1,2");
        assert_eq!(heap.len(&ring), None);
        let again = heap.list(vec![Value::Null, Value::from("a")]).unwrap();
        assert_eq!((again == ring, heap.text(&again)), (true, ",a".into()));
    }

    #[test]
    fn lists_inside_themselves_print() {
        let mut heap = Heap::default();
        let ring = heap.list(vec![Value::Number(1.0)]).unwrap();
        if let Some(HeapObject::List(items)) = heap.object_mut(&ring) {
            items.push(ring.clone());
        }
        assert!(heap.text(&ring).starts_with("1,1,1"));
    }

    #[test]
    fn a_full_heap_is_an_error() {
        let mut heap = Heap::default();
        let large = || vec![Value::Null; 1 << 20];
        assert!((0..10).any(|_| heap.list(large()).is_err()));
    }
}
