//! The environment of methods: the heap, the host and the work budget of a run, and JavaScript's conversions.

use crate::heap::{Full, Heap, HeapObject, MAX_TEXT};
use crate::host::Host;
use crate::rules::{self, Rule};
use crate::tables::ExposedView;
use crate::types::Elem;
use crate::value::{Value, View};

/// The error of a method.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NativeError {
    pub(crate) rule: &'static Rule,
    /// What is wrong, for people.
    pub message: String,
}

impl NativeError {
    pub(crate) fn new(rule: &'static Rule, message: impl Into<String>) -> NativeError {
        NativeError { rule, message: message.into() }
    }
}

impl From<Full> for NativeError {
    fn from(Full: Full) -> NativeError {
        NativeError::new(rules::MEMORY, "the lists take more than 64 MB")
    }
}

/// The environment of a method.
pub struct Env<'a> {
    /// The heap: lists, records and functions.
    pub heap: &'a mut Heap,
    /// The fields.
    pub host: &'a mut dyn Host,
    /// Arrays of the simulation that are values.
    pub views: &'a [ExposedView],
    /// The remaining work budget of the run.
    pub budget: &'a mut u64,
}

/// Limit on the nesting of lists that are converted to a string.
const MAX_DEPTH: usize = 200;

/// The work per element.
const ELEMENT: u64 = 10;

/// Subtracts work from a budget. If the budget is too small, it becomes zero and the call fails.
pub fn charge(budget: &mut u64, units: u64) -> Result<(), NativeError> {
    let rest = budget.checked_sub(units);
    *budget = rest.unwrap_or(0);
    rest.map(|_| ()).ok_or_else(out_of_steps)
}

impl Env<'_> {
    /// Subtracts the work for iterating over elements.
    pub(crate) fn spend(&mut self, elements: usize) -> Result<(), NativeError> {
        charge(self.budget, ELEMENT * elements as u64)
    }

    /// The current number of elements of a view.
    pub(crate) fn view_len(&self, view: View) -> usize {
        view.count().unwrap_or_else(|| self.host.len(view.field).saturating_sub(view.first as usize))
    }

    /// An element of a view.
    pub(crate) fn view_item(&self, view: View, index: usize) -> Value {
        if index >= self.view_len(view) {
            return Value::Undefined;
        }
        self.host.get(view.field, view.first as usize + index).map_or(Value::Undefined, Value::Number)
    }

    /// Stores an element of a view that is used as a value.
    pub(crate) fn view_store(&mut self, view: View, index: usize, x: f64) -> Result<(), NativeError> {
        let exposed = self.views.iter().find(|s| s.view.field == view.field);
        match exposed {
            Some(exposed) if exposed.assignable => {}
            Some(_) => {
                return Err(NativeError::new(
                    rules::ASSIGN_DERIVED,
                    "an assignment stores into a computed array, which is overwritten later",
                ));
            }
            None => {
                return Err(NativeError::new(
                    rules::HOST_STORE,
                    "an assignment stores into an array that another text kept; name the array here instead",
                ));
            }
        }
        if index < self.view_len(view) {
            let stored = self.host.set(view.field, view.first as usize + index, x);
            stored.map_err(|message| NativeError::new(rules::HOST_STORE, message))?;
        }
        Ok(())
    }

    /// The element type of an array.
    pub(crate) fn elem(&self, view: View) -> Elem {
        self.views.iter().find(|s| s.view.field == view.field).map_or(Elem::Double, |s| s.elem)
    }

    /// The number of elements of a list or an array.
    pub(crate) fn len(&self, value: &Value) -> usize {
        match value {
            Value::View(view) => self.view_len(*view),
            _ => self.heap.len(value).unwrap_or(0),
        }
    }

    /// All elements of a list or an array; subtracts the work.
    pub(crate) fn items(&mut self, value: &Value) -> Result<Vec<Value>, NativeError> {
        let n = self.len(value);
        self.spend(n)?;
        Ok(match value {
            Value::View(view) => (0..n).map(|i| self.view_item(*view, i)).collect(),
            _ => match self.heap.object(value) {
                HeapObject::List(items) => items.clone(),
                HeapObject::Numbers(items, _) => items.iter().map(|&x| Value::Number(x)).collect(),
                _ => Vec::new(),
            },
        })
    }

    /// JavaScript's `String(v)`. For a function, JavaScript gives its source; here it is an error.
    pub(crate) fn text(&mut self, value: &Value) -> Result<String, NativeError> {
        self.text_within(value, &mut Vec::new())
    }

    /// As [`Env::text`], inside the lists that are being converted: within its own string, such a list is empty.
    pub(crate) fn text_within(
        &mut self,
        value: &Value,
        lists: &mut Vec<Value>,
    ) -> Result<String, NativeError> {
        if let Value::String(text) = value {
            return Ok(text.to_string());
        }
        let mut text = String::new();
        self.write(value, lists, &mut text)?;
        self.spend(text.len() / 16)?;
        if text.len() > MAX_TEXT { Err(too_long()) } else { Ok(text) }
    }

    fn write(&mut self, value: &Value, lists: &mut Vec<Value>, out: &mut String) -> Result<(), NativeError> {
        match value {
            Value::String(text) => out.push_str(text),
            Value::Function(_) => {
                return Err(NativeError::new(
                    rules::NOT_A_VALUE,
                    "a function is used as a text but not called",
                ));
            }
            Value::List(_) | Value::View(_) => {
                if lists.iter().any(|list| list.strictly_equals(value)) {
                    return Ok(());
                }
                if lists.len() >= MAX_DEPTH {
                    let message = format!("lists are nested more than {MAX_DEPTH} levels deep");
                    return Err(NativeError::new(rules::TEXT_TOO_LONG, message));
                }
                lists.push(value.clone());
                for (i, item) in self.items(value)?.iter().enumerate() {
                    if i > 0 {
                        out.push(',');
                    }
                    if !item.is_nothing() {
                        self.write(item, lists, out)?;
                    }
                    if out.len() > MAX_TEXT {
                        return Err(too_long());
                    }
                }
                lists.pop();
            }
            other => out.push_str(&other.to_string()),
        }
        Ok(())
    }

    /// JavaScript's `Number(v)`.
    pub(crate) fn number(&mut self, value: &Value) -> Result<f64, NativeError> {
        match value {
            Value::List(_) | Value::View(_) => match self.text(value) {
                Ok(text) => Ok(crate::number::from_text(&text)),
                // A function in a list is never a number.
                Err(fault) if fault.rule == rules::NOT_A_VALUE => Ok(f64::NAN),
                Err(fault) => Err(fault),
            },
            other => Ok(other.to_number()),
        }
    }

    /// A string value, unless it is too long.
    pub(crate) fn string(&mut self, text: String) -> Result<Value, NativeError> {
        if text.len() > MAX_TEXT {
            return Err(too_long());
        }
        self.spend(text.len() / 16)?;
        Ok(Value::String(text.into()))
    }

    /// The values of a spread: the elements of a list, or the characters of a string.
    pub(crate) fn spread(&mut self, value: &Value) -> Result<Vec<Value>, NativeError> {
        match value {
            Value::List(_) | Value::View(_) => self.items(value),
            Value::String(text) => {
                let text = text.clone();
                self.spend(text.len())?;
                Ok(text.chars().map(|c| Value::String(c.to_string().into())).collect())
            }
            other => {
                let what =
                    if other.is_nothing() { other.to_string() } else { other.type_of().describe().into() };
                Err(NativeError::new(rules::NO_PARTS, format!("{what} has no elements to iterate over")))
            }
        }
    }
}

/// The error of a text that is too long.
pub fn too_long() -> NativeError {
    NativeError::new(rules::TEXT_TOO_LONG, format!("a string exceeds {MAX_TEXT} bytes"))
}

/// The error of a budget that is used up.
pub fn out_of_steps() -> NativeError {
    NativeError::new(rules::BUDGET, "the step budget ran out, so this text was stopped")
}

/// JavaScript's ToIntegerOrInfinity.
pub(super) fn integer(x: f64) -> f64 {
    if x.is_nan() { 0.0 } else { x.trunc() }
}

/// An index that counts from the end if negative, clamped to `0..=n`.
pub(super) fn relative(x: f64, n: usize) -> usize {
    let x = integer(x);
    let index = if x < 0.0 { n as f64 + x } else { x };
    index.clamp(0.0, n as f64) as usize
}

/// An argument, or `undefined` if it was omitted.
pub(super) fn arg(args: &[Value], i: usize) -> &Value {
    const UNDEFINED: &Value = &Value::Undefined;
    args.get(i).unwrap_or(UNDEFINED)
}

/// A range of indexes from two optional arguments.
pub(super) fn range(
    env: &mut Env<'_>,
    args: &[Value],
    first: usize,
    n: usize,
) -> Result<(usize, usize), NativeError> {
    let start = relative(env.number(arg(args, first))?, n);
    let end = match arg(args, first + 1) {
        Value::Undefined => n,
        end => relative(env.number(end)?, n),
    };
    Ok((start, end.max(start)))
}
