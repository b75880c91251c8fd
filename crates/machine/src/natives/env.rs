//! What methods work with: the lists of a run, its host, its budget, and JavaScript's conversions.

use crate::heap::{Full, Heap, HeapObject, MAX_TEXT};
use crate::host::Host;
use crate::rules::{self, Rule};
use crate::tables::ExposedView;
use crate::types::Elem;
use crate::value::{Value, View};

/// Why a method fails.
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

/// What a method works with.
pub struct Env<'a> {
    /// Lists, records and functions.
    pub heap: &'a mut Heap,
    /// The fields.
    pub host: &'a mut dyn Host,
    /// Arrays of the simulation that are values.
    pub views: &'a [ExposedView],
    /// Work that the run may still do.
    pub budget: &'a mut u64,
}

/// Lists inside of each other whose text is made.
const MAX_DEPTH: usize = 200;

/// What an element counts.
const ELEMENT: u64 = 10;

/// Counts work. Where it is too much, nothing is left.
pub fn charge(budget: &mut u64, units: u64) -> Result<(), NativeError> {
    let rest = budget.checked_sub(units);
    *budget = rest.unwrap_or(0);
    rest.map(|_| ()).ok_or_else(out_of_steps)
}

impl Env<'_> {
    /// Counts elements that are gone through.
    pub(crate) fn spend(&mut self, elements: usize) -> Result<(), NativeError> {
        charge(self.budget, ELEMENT * elements as u64)
    }

    /// Number of elements of a view, now.
    pub(crate) fn view_len(&self, view: View) -> usize {
        view.count().unwrap_or_else(|| self.host.len(view.field).saturating_sub(view.first as usize))
    }

    /// Element of a view.
    pub(crate) fn view_item(&self, view: View, index: usize) -> Value {
        if index >= self.view_len(view) {
            return Value::Undefined;
        }
        self.host.get(view.field, view.first as usize + index).map_or(Value::Undefined, Value::Number)
    }

    /// Stores an element of a view that became a value.
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

    /// What the elements of an array are.
    pub(crate) fn elem(&self, view: View) -> Elem {
        self.views.iter().find(|s| s.view.field == view.field).map_or(Elem::Double, |s| s.elem)
    }

    /// Number of elements of a list or array.
    pub(crate) fn len(&self, value: &Value) -> usize {
        match value {
            Value::View(view) => self.view_len(*view),
            _ => self.heap.len(value).unwrap_or(0),
        }
    }

    /// All elements of a list or array, counted.
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

    /// JavaScript's `String(v)`. A function has a text there, that of its source, and none here.
    pub(crate) fn text(&mut self, value: &Value) -> Result<String, NativeError> {
        self.text_within(value, &mut Vec::new())
    }

    /// As [`Env::text`], inside of lists whose texts are being made: in their own text they are empty.
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
                // The text of a function is never that of a number.
                Err(trouble) if trouble.rule == rules::NOT_A_VALUE => Ok(f64::NAN),
                Err(trouble) => Err(trouble),
            },
            other => Ok(other.to_number()),
        }
    }

    /// A text as a value, when it is not too long.
    pub(crate) fn string(&mut self, text: String) -> Result<Value, NativeError> {
        if text.len() > MAX_TEXT {
            return Err(too_long());
        }
        self.spend(text.len() / 16)?;
        Ok(Value::String(text.into()))
    }

    /// What is spread: the elements of a list, the characters of a text.
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

/// An index that counts from the end when negative, cut to `0..=n`.
pub(super) fn relative(x: f64, n: usize) -> usize {
    let x = integer(x);
    let at = if x < 0.0 { n as f64 + x } else { x };
    at.clamp(0.0, n as f64) as usize
}

/// An argument; `undefined` when it is left out.
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
