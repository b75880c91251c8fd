//! The methods of lists, texts and numbers, and the functions of `Array`, `Number`, `String` and `Object`: one table
//! with what each takes, gives and means. Methods that call a function for every element are in `prelude`.

mod list;
mod number;
mod text;

pub use number::to_fixed;

use crate::code;
use crate::heap::{Full, Heap, MAX_TEXT, Object};
use crate::ir::Shown;
use crate::program::Host;
use crate::schema::{Elem, Type};
use crate::value::{Value, View};

/// What a method belongs to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum On {
    /// Lists, typed arrays and arrays of the simulation.
    List,
    /// Lists alone: what changes the number of elements.
    Growing,
    Text,
    Number,
    /// `Array.name`, `Number.name`; a name without a point stands alone.
    Nothing,
}

/// A row of the table.
pub(crate) struct Row {
    pub(crate) name: &'static str,
    pub(crate) on: On,
    pub(crate) least: usize,
    pub(crate) most: usize,
    pub(crate) returns: Type,
    /// It changes the elements of what it is called on.
    pub(crate) changes: bool,
    pub(crate) doc: &'static str,
    /// An expression and its value, as text.
    pub(crate) example: (&'static str, &'static str),
    run: Run,
}

type Run = fn(&mut Env<'_>, &Value, &[Value]) -> Result<Value, Trouble>;

/// Why a method fails.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Trouble {
    pub(crate) code: &'static str,
    pub(crate) message: String,
}

impl Trouble {
    pub(crate) fn new(code: &'static str, message: impl Into<String>) -> Trouble {
        Trouble { code, message: message.into() }
    }
}

impl From<Full> for Trouble {
    fn from(Full: Full) -> Trouble {
        Trouble::new(code::MEMORY, "the lists of this lab take more than 64 MB")
    }
}

/// A name that is a method of something: the first row that has it. Rows of one name follow each other.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Name(u8);

/// A function that belongs to nothing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Free(u8);

/// What a method works with.
pub(crate) struct Env<'a> {
    pub(crate) heap: &'a mut Heap,
    pub(crate) host: &'a mut dyn Host,
    pub(crate) views: &'a [Shown],
    /// Steps that the run may still take.
    pub(crate) budget: &'a mut u64,
}

const fn method(
    name: &'static str,
    on: On,
    arity: (usize, usize),
    returns: Type,
    run: Run,
    example: (&'static str, &'static str),
    doc: &'static str,
) -> Row {
    Row { name, on, least: arity.0, most: arity.1, returns, changes: false, doc, example, run }
}

const fn change(row: Row) -> Row {
    Row { changes: true, ..row }
}

/// Any number of arguments.
const MANY: usize = usize::MAX;

use On::{Growing, List, Nothing, Number, Text};
use Type::{Any, Boolean, Element};

/// All of them; rows of one name stand together.
static TABLE: &[Row] = &[
    method(
        "at",
        List,
        (1, 1),
        Any,
        list::at,
        ("[1, 2, 3].at(-1)", "3"),
        "element at an index, which counts from the end when negative",
    ),
    method(
        "at",
        Text,
        (1, 1),
        Any,
        text::at,
        ("'abc'.at(-1)", "c"),
        "character at an index, which counts from the end when negative",
    ),
    method(
        "concat",
        List,
        (0, MANY),
        Type::List,
        list::concat,
        ("[1].concat([2, 3], 4)", "1,2,3,4"),
        "a list of all elements",
    ),
    method(
        "concat",
        Text,
        (0, MANY),
        Type::String,
        text::concat,
        ("'a'.concat('b', 1)", "ab1"),
        "the texts joined",
    ),
    change(method(
        "fill",
        List,
        (1, 3),
        Any,
        list::fill,
        ("[1, 2, 3].fill(0, 1)", "1,0,0"),
        "stores one value in all elements, or in those from one index up to another",
    )),
    method(
        "flat",
        List,
        (0, 1),
        Type::List,
        list::flat,
        ("[1, [2, 3]].flat()", "1,2,3"),
        "the elements, and the elements of the lists among them",
    ),
    method(
        "includes",
        List,
        (1, 2),
        Boolean,
        list::includes,
        ("[1, 2].includes(2)", "true"),
        "whether a value is among the elements",
    ),
    method(
        "includes",
        Text,
        (1, 2),
        Boolean,
        text::includes,
        ("'abc'.includes('bc')", "true"),
        "whether a text stands in it",
    ),
    method(
        "indexOf",
        List,
        (1, 2),
        Type::Number,
        list::index_of,
        ("[5, 6].indexOf(6)", "1"),
        "index of the first element with a value, or -1",
    ),
    method(
        "indexOf",
        Text,
        (1, 2),
        Type::Number,
        text::index_of,
        ("'abc'.indexOf('c')", "2"),
        "index at which a text stands in it, or -1",
    ),
    method(
        "join",
        List,
        (0, 1),
        Type::String,
        list::join,
        ("[1, 2].join(' / ')", "1 / 2"),
        "the elements as one text, with a text between them (a comma)",
    ),
    method(
        "lastIndexOf",
        List,
        (1, 2),
        Type::Number,
        list::last_index_of,
        ("[5, 6, 5].lastIndexOf(5)", "2"),
        "index of the last element with a value, or -1",
    ),
    method(
        "lastIndexOf",
        Text,
        (1, 1),
        Type::Number,
        text::last_index_of,
        ("'abca'.lastIndexOf('a')", "3"),
        "index at which a text stands last, or -1",
    ),
    change(method(
        "pop",
        Growing,
        (0, 0),
        Any,
        list::pop,
        ("[1, 2].pop()", "2"),
        "takes the last element away, and gives it",
    )),
    change(method(
        "push",
        Growing,
        (0, MANY),
        Type::Number,
        list::push,
        ("[1, 2].push(3)", "3"),
        "appends elements, and gives the new length",
    )),
    change(method(
        "reverse",
        List,
        (0, 0),
        Any,
        list::reverse,
        ("[1, 2, 3].reverse()", "3,2,1"),
        "turns the order of the elements around",
    )),
    change(method(
        "set",
        List,
        (1, 2),
        Type::Undefined,
        list::set,
        ("data.qvel.slice(0, 2).set([0, 1])", "undefined"),
        "stores values one after the other, from an index on",
    )),
    change(method(
        "shift",
        Growing,
        (0, 0),
        Any,
        list::shift,
        ("[1, 2].shift()", "1"),
        "takes the first element away, and gives it",
    )),
    method(
        "slice",
        List,
        (0, 2),
        Type::List,
        list::slice,
        ("[1, 2, 3].slice(1)", "2,3"),
        "a copy of the elements from one index up to another; indexes count from the end when negative",
    ),
    method(
        "slice",
        Text,
        (0, 2),
        Type::String,
        text::slice,
        ("'abc'.slice(0, -1)", "ab"),
        "the part from one index up to another; indexes count from the end when negative",
    ),
    change(method(
        "sort",
        List,
        (0, 0),
        Any,
        list::sort,
        ("[3, 10, 2].sort()", "10,2,3"),
        "sorts the elements: of a list as texts, of an array as numbers; `sort((a, b) => a - b)` sorts by a function",
    )),
    change(method(
        "splice",
        Growing,
        (1, MANY),
        Type::List,
        list::splice,
        ("[1, 2, 3].splice(1, 1)", "2"),
        "takes elements away from an index on, puts others there, and gives those that were taken",
    )),
    method(
        "subarray",
        List,
        (0, 2),
        Any,
        list::subarray,
        ("data.qpos.subarray(0, 2).length", "2"),
        "a part of an array of the simulation, not a copy",
    ),
    method(
        "toReversed",
        List,
        (0, 0),
        Type::List,
        list::to_reversed,
        ("[1, 2].toReversed()", "2,1"),
        "a copy in reverse order",
    ),
    method(
        "toSorted",
        List,
        (0, 0),
        Type::List,
        list::to_sorted,
        ("[3, 1, 2].toSorted()", "1,2,3"),
        "a sorted copy, see `sort`",
    ),
    change(method(
        "unshift",
        Growing,
        (0, MANY),
        Type::Number,
        list::unshift,
        ("[2].unshift(1)", "2"),
        "puts elements in front, and gives the new length",
    )),
    method(
        "with",
        List,
        (2, 2),
        Type::List,
        list::with,
        ("[1, 2].with(0, 5)", "5,2"),
        "a copy with one element replaced",
    ),
    method(
        "charAt",
        Text,
        (0, 1),
        Type::String,
        text::char_at,
        ("'abc'.charAt(1)", "b"),
        "character at an index",
    ),
    method(
        "charCodeAt",
        Text,
        (0, 1),
        Type::Number,
        text::char_code_at,
        ("'A'.charCodeAt(0)", "65"),
        "number of the character at an index",
    ),
    method(
        "endsWith",
        Text,
        (1, 1),
        Boolean,
        text::ends_with,
        ("'abc'.endsWith('c')", "true"),
        "whether it ends with a text",
    ),
    method(
        "padEnd",
        Text,
        (1, 2),
        Type::String,
        text::pad_end,
        ("'7'.padEnd(3, '0')", "700"),
        "filled up to a length behind",
    ),
    method(
        "padStart",
        Text,
        (1, 2),
        Type::String,
        text::pad_start,
        ("'7'.padStart(3)", "  7"),
        "filled up to a length in front",
    ),
    method(
        "repeat",
        Text,
        (1, 1),
        Type::String,
        text::repeat,
        ("'ab'.repeat(2)", "abab"),
        "the text several times",
    ),
    method(
        "replace",
        Text,
        (2, 2),
        Type::String,
        text::replace,
        ("'aa'.replace('a', 'b')", "ba"),
        "with the first of a text replaced by another",
    ),
    method(
        "replaceAll",
        Text,
        (2, 2),
        Type::String,
        text::replace_all,
        ("'aa'.replaceAll('a', 'b')", "bb"),
        "with every one of a text replaced by another",
    ),
    method(
        "split",
        Text,
        (0, 2),
        Type::List,
        text::split,
        ("'a,b'.split(',').length", "2"),
        "the parts between a text",
    ),
    method(
        "startsWith",
        Text,
        (1, 2),
        Boolean,
        text::starts_with,
        ("'abc'.startsWith('a')", "true"),
        "whether it starts with a text",
    ),
    method(
        "substring",
        Text,
        (1, 2),
        Type::String,
        text::substring,
        ("'abc'.substring(2, 0)", "ab"),
        "the part between two indexes",
    ),
    method(
        "toLowerCase",
        Text,
        (0, 0),
        Type::String,
        text::to_lower_case,
        ("'ABC'.toLowerCase()", "abc"),
        "in small letters",
    ),
    method(
        "toUpperCase",
        Text,
        (0, 0),
        Type::String,
        text::to_upper_case,
        ("'abc'.toUpperCase()", "ABC"),
        "in capital letters",
    ),
    method(
        "trim",
        Text,
        (0, 0),
        Type::String,
        text::trim,
        ("' a '.trim()", "a"),
        "without white space at both ends",
    ),
    method(
        "trimEnd",
        Text,
        (0, 0),
        Type::String,
        text::trim_end,
        ("'a '.trimEnd()", "a"),
        "without white space at the end",
    ),
    method(
        "trimStart",
        Text,
        (0, 0),
        Type::String,
        text::trim_start,
        ("' a'.trimStart()", "a"),
        "without white space at the start",
    ),
    method(
        "toExponential",
        Number,
        (0, 1),
        Type::String,
        number::to_exponential_method,
        ("(1234).toExponential(1)", "1.2e+3"),
        "in exponential form with so many decimals",
    ),
    method(
        "toFixed",
        Number,
        (0, 1),
        Type::String,
        number::to_fixed_method,
        ("(2.345).toFixed(1)", "2.3"),
        "with so many decimals",
    ),
    method(
        "toPrecision",
        Number,
        (0, 1),
        Type::String,
        number::to_precision_method,
        ("(1234.5).toPrecision(2)", "1.2e+3"),
        "with so many significant digits",
    ),
    method(
        "toString",
        Number,
        (0, 1),
        Type::String,
        number::to_string_method,
        ("(255).toString(16)", "ff"),
        "as text, in base 10 or another base",
    ),
    method(
        "Array.isArray",
        Nothing,
        (1, 1),
        Boolean,
        list::is_array,
        ("Array.isArray([1])", "true"),
        "whether a value is a list; an array of the simulation is none, as in JavaScript",
    ),
    method(
        "Array.of",
        Nothing,
        (0, MANY),
        Type::List,
        list::of,
        ("Array.of(1, 2)", "1,2"),
        "a list of the arguments",
    ),
    method(
        "Array.from",
        Nothing,
        (1, 1),
        Type::List,
        list::from,
        ("Array.from('ab')", "a,b"),
        "a list of the elements of an array, the characters of a text, or as many elements as `{length: n}` says; with a function, what it makes of each",
    ),
    method(
        "Number",
        Nothing,
        (0, 1),
        Type::Number,
        number::number,
        ("Number('12') + 1", "13"),
        "a value as number",
    ),
    method(
        "Number.isFinite",
        Nothing,
        (1, 1),
        Boolean,
        number::is_finite,
        ("Number.isFinite('1')", "false"),
        "whether a value is a number and finite",
    ),
    method(
        "Number.isInteger",
        Nothing,
        (1, 1),
        Boolean,
        number::is_integer,
        ("Number.isInteger(2)", "true"),
        "whether a value is a whole number",
    ),
    method(
        "Number.isNaN",
        Nothing,
        (1, 1),
        Boolean,
        number::is_nan,
        ("Number.isNaN('a')", "false"),
        "whether a value is NaN",
    ),
    method(
        "Number.parseFloat",
        Nothing,
        (1, 1),
        Type::Number,
        number::parse_float,
        ("Number.parseFloat('1.5 m')", "1.5"),
        "the number at the start of a text",
    ),
    method(
        "Number.parseInt",
        Nothing,
        (1, 2),
        Type::Number,
        number::parse_int,
        ("Number.parseInt('12px')", "12"),
        "the whole number at the start of a text",
    ),
    method(
        "parseFloat",
        Nothing,
        (1, 1),
        Type::Number,
        number::parse_float,
        ("parseFloat('1.5 m')", "1.5"),
        "the number at the start of a text",
    ),
    method(
        "parseInt",
        Nothing,
        (1, 2),
        Type::Number,
        number::parse_int,
        ("parseInt('ff', 16)", "255"),
        "the whole number at the start of a text, in base 10 or another base",
    ),
    method(
        "String",
        Nothing,
        (0, 1),
        Type::String,
        text::string,
        ("String([1, 2])", "1,2"),
        "a value as text",
    ),
    method(
        "Boolean",
        Nothing,
        (0, 1),
        Boolean,
        number::boolean,
        ("Boolean('')", "false"),
        "whether a value counts as true",
    ),
    method(
        "Object.keys",
        Nothing,
        (1, 1),
        Type::List,
        list::keys,
        ("Object.keys({b: 1, a: 2}).join()", "b,a"),
        "the keys of a record",
    ),
    method(
        "Object.values",
        Nothing,
        (1, 1),
        Type::List,
        list::values,
        ("Object.values({b: 1, a: 2}).join()", "1,2"),
        "the values of a record",
    ),
    method(
        "Object.entries",
        Nothing,
        (1, 1),
        Type::List,
        list::entries,
        ("Object.entries({a: 1}).join()", "a,1"),
        "lists of key and value of a record",
    ),
    // For the prelude alone.
    method("_like", Nothing, (2, 2), Type::List, list::like, ("", ""), ""),
    method("_kind", Nothing, (2, 2), Type::List, list::kind, ("", ""), ""),
    method("_empty", Nothing, (0, 0), Element, list::empty, ("", ""), ""),
    method("_copy", Nothing, (1, 1), Type::List, list::copy, ("", ""), ""),
];

/// The constants of `Number`.
pub(crate) const NUMBER_CONSTANTS: &[(&str, f64)] = &[
    ("EPSILON", f64::EPSILON),
    ("MAX_SAFE_INTEGER", 9007199254740991.0),
    ("MAX_VALUE", f64::MAX),
    ("MIN_SAFE_INTEGER", -9007199254740991.0),
    ("MIN_VALUE", 5e-324),
    ("NEGATIVE_INFINITY", f64::NEG_INFINITY),
    ("NaN", f64::NAN),
    ("POSITIVE_INFINITY", f64::INFINITY),
];

/// The rows that a person may use.
pub(crate) fn rows() -> impl Iterator<Item = &'static Row> {
    TABLE.iter().filter(|row| !row.doc.is_empty())
}

/// The method of this name, whatever it belongs to.
pub(crate) fn name(text: &str) -> Option<Name> {
    TABLE.iter().position(|row| row.name == text && row.on != Nothing).map(|i| Name(i as u8))
}

/// The function of this name.
pub(crate) fn free(text: &str) -> Option<Free> {
    TABLE.iter().position(|row| row.name == text && row.on == Nothing).map(|i| Free(i as u8))
}

impl Free {
    pub(crate) fn row(self) -> &'static Row {
        &TABLE[usize::from(self.0)]
    }
}

impl Name {
    pub(crate) fn text(self) -> &'static str {
        TABLE[usize::from(self.0)].name
    }

    /// The rows of this name.
    pub(crate) fn rows(self) -> impl Iterator<Item = &'static Row> {
        let first = usize::from(self.0);
        TABLE.iter().skip(first).take_while(move |row| row.name == TABLE[first].name)
    }

    /// The row for a receiver of this type; `None` when it has no such method, or is not known.
    pub(crate) fn row_for(self, ty: Type) -> Option<&'static Row> {
        self.rows().find(|row| match row.on {
            List => matches!(ty, Type::List | Type::View),
            Growing => ty == Type::List,
            Text => ty == Type::String,
            Number => matches!(ty, Type::Number | Element),
            Nothing => false,
        })
    }
}

/// Calls a method.
pub(crate) fn call(
    env: &mut Env<'_>,
    name: Name,
    receiver: &Value,
    args: &[Value],
) -> Result<Value, Trouble> {
    let list = matches!(env.heap.object(receiver), Object::List(_));
    let found = name.rows().find(|row| match (row.on, receiver) {
        (List, Value::List(_) | Value::View(_)) | (Text, Value::String(_)) | (Number, Value::Number(_)) => {
            true
        }
        (Growing, Value::List(_)) => list,
        _ => false,
    });
    match found {
        // A typed array alone has `set` and `subarray`.
        Some(row) if !(list && matches!(row.name, "set" | "subarray")) => (row.run)(env, receiver, args),
        _ => {
            let what = receiver.type_of().describe();
            let what = if receiver.is_nothing() { receiver.to_string() } else { what.to_owned() };
            Err(Trouble::new(code::NOT_CALLABLE, format!("{what} has no method `{}`", name.text())))
        }
    }
}

/// Calls a function.
pub(crate) fn call_free(env: &mut Env<'_>, function: Free, args: &[Value]) -> Result<Value, Trouble> {
    (function.row().run)(env, &Value::Undefined, args)
}

impl Env<'_> {
    /// Counts steps.
    pub(crate) fn spend(&mut self, steps: usize) -> Result<(), Trouble> {
        match self.budget.checked_sub(steps as u64) {
            Some(rest) => {
                *self.budget = rest;
                Ok(())
            }
            None => Err(out_of_steps()),
        }
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
    pub(crate) fn view_store(&mut self, view: View, index: usize, x: f64) -> Result<(), Trouble> {
        let shown = self.views.iter().find(|s| s.view.field == view.field);
        match shown {
            Some(shown) if shown.assignable => {}
            Some(_) => {
                return Err(Trouble::new(
                    code::ASSIGN_DERIVED,
                    "a computed array is assigned: what is stored there would be overwritten",
                ));
            }
            None => {
                return Err(Trouble::new(
                    code::HOST_STORE,
                    "an array that another text kept is assigned; name it here instead",
                ));
            }
        }
        if index < self.view_len(view) {
            let stored = self.host.set(view.field, view.first as usize + index, x);
            stored.map_err(|message| Trouble::new(code::HOST_STORE, message))?;
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

    /// All elements of a list or array, counted as steps.
    pub(crate) fn items(&mut self, value: &Value) -> Result<Vec<Value>, Trouble> {
        let n = self.len(value);
        self.spend(n)?;
        Ok(match value {
            Value::View(view) => (0..n).map(|i| self.view_item(*view, i)).collect(),
            _ => match self.heap.object(value) {
                Object::List(items) => items.clone(),
                Object::Numbers(items, _) => items.iter().map(|&x| Value::Number(x)).collect(),
                _ => Vec::new(),
            },
        })
    }

    /// JavaScript's `String(v)`.
    pub(crate) fn text(&mut self, value: &Value) -> Result<String, Trouble> {
        let text = match value {
            Value::View(_) => {
                let items = self.items(value)?;
                let parts: Vec<String> = items.iter().map(Value::to_string).collect();
                parts.join(",")
            }
            Value::String(text) => return Ok(text.to_string()),
            _ => self.heap.text(value),
        };
        self.spend(text.len() / 16)?;
        if text.len() > MAX_TEXT { Err(too_long()) } else { Ok(text) }
    }

    /// JavaScript's `Number(v)`.
    pub(crate) fn number(&mut self, value: &Value) -> Result<f64, Trouble> {
        match value {
            Value::List(_) | Value::View(_) => Ok(crate::number::from_text(&self.text(value)?)),
            other => Ok(other.to_number()),
        }
    }

    /// A text as a value, when it is not too long.
    pub(crate) fn string(&mut self, text: String) -> Result<Value, Trouble> {
        if text.len() > MAX_TEXT {
            return Err(too_long());
        }
        self.spend(text.len() / 16)?;
        Ok(Value::String(text.into()))
    }

    /// What is spread: the elements of a list, the characters of a text.
    pub(crate) fn spread(&mut self, value: &Value) -> Result<Vec<Value>, Trouble> {
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
                Err(Trouble::new(code::NO_PARTS, format!("{what} has no elements to go through")))
            }
        }
    }
}

pub(crate) fn too_long() -> Trouble {
    Trouble::new(code::TEXT_TOO_LONG, format!("a string grew beyond {MAX_TEXT} bytes"))
}

pub(crate) fn out_of_steps() -> Trouble {
    Trouble::new(
        code::BUDGET,
        "this text does not come to an end: it was stopped, so that the page does not hang",
    )
}

/// JavaScript's ToIntegerOrInfinity.
fn integer(x: f64) -> f64 {
    if x.is_nan() { 0.0 } else { x.trunc() }
}

/// An index that counts from the end when negative, cut to `0..=n`.
fn relative(x: f64, n: usize) -> usize {
    let x = integer(x);
    let at = if x < 0.0 { n as f64 + x } else { x };
    at.clamp(0.0, n as f64) as usize
}

/// An argument; `undefined` when it is left out.
fn arg(args: &[Value], i: usize) -> &Value {
    const UNDEFINED: &Value = &Value::Undefined;
    args.get(i).unwrap_or(UNDEFINED)
}

/// A range of indexes from two optional arguments.
fn range(env: &mut Env<'_>, args: &[Value], first: usize, n: usize) -> Result<(usize, usize), Trouble> {
    let start = relative(env.number(arg(args, first))?, n);
    let end = match arg(args, first + 1) {
        Value::Undefined => n,
        end => relative(env.number(end)?, n),
    };
    Ok((start, end.max(start)))
}
