//! The methods of lists, texts and numbers, and the functions of `Array`, `Number`, `String` and `Object`. Each is one row:
//! what it is called, takes, gives and means, an example, and how it is computed. The binder, the machine, what was probably
//! meant by a misspelt name, and the reference page all read the row.

mod each;
mod env;
mod list;
mod number;
mod object;
mod text;

pub(crate) use env::{Env, Trouble, charge, out_of_steps, too_long};
pub(crate) use number::NUMBER_CONSTANTS;
pub use number::to_fixed;
pub(crate) use text::whole;

use std::sync::OnceLock;

use crate::ast::{ExprKind, Function};
use crate::heap::{Heap, Object};
use crate::parse::parse_expression;
use crate::rules;
use crate::schema::Type;
use crate::value::Value;

/// What a method belongs to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum On {
    /// Lists, typed arrays and arrays of the host.
    List,
    /// Lists alone: what changes the number of elements.
    Growing,
    /// Lists alone: typed arrays do not have it.
    Untyped,
    Text,
    Number,
    /// `Array.name`, `Number.name`; a name without a point stands alone.
    Nothing,
}

/// What a method gives.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Gives {
    Any,
    Boolean,
    Number,
    String,
    List,
    Undefined,
    Element,
    /// What it was called on.
    Receiver,
    /// An element of what it was called on.
    Item,
}

/// What becomes of NaN, and of `undefined` where that counts, among the elements of what a method is called on and among its
/// arguments ([`crate::Watch`]). What is looked at is lost, unless the result is NaN again.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Nan {
    /// Elements and arguments decide the result, as comparisons and texts do.
    Looks,
    /// Elements are moved and none is looked at; the arguments say where.
    Moves,
    /// Elements and arguments are handed on.
    Keeps,
    /// Whether something is a number is what is asked for.
    Asks,
    /// It is lost where the text in the language loses it.
    Written,
}

impl Nan {
    /// Whether the elements of what it is called on are looked at.
    pub(crate) fn of_elements(self) -> bool {
        self == Nan::Looks
    }

    /// Whether the arguments are looked at.
    pub(crate) fn of_arguments(self) -> bool {
        matches!(self, Nan::Looks | Nan::Moves)
    }
}

/// How a method is computed.
pub(crate) enum Body {
    /// By the machine, with at least and at most so many arguments.
    Run(Run, usize, usize),
    /// By functions of the language itself, with how many arguments each of them is called: what stands before the point
    /// is the first parameter. Where the method is called, the function is bound as if its text stood there, so that the
    /// types of that place decide how it is computed: a sum over an array of numbers never leaves the number registers.
    Written(&'static [(usize, &'static str)]),
}

/// A method, or a function.
pub(crate) struct Row {
    pub(crate) name: &'static str,
    pub(crate) on: On,
    pub(crate) gives: Gives,
    /// It changes the elements of what it is called on.
    pub(crate) changes: bool,
    /// What becomes of NaN.
    pub(crate) nan: Nan,
    pub(crate) doc: &'static str,
    /// An expression and its value, as text. `{array}` stands for an array of the host.
    example: (&'static str, &'static str),
    pub(crate) body: Body,
}

type Run = fn(&mut Env<'_>, &Value, &[Value]) -> Outcome;
type Outcome = Result<Value, Trouble>;

/// Any number of arguments.
const MANY: usize = usize::MAX;

/// Rows, as they are written in the files beside this one: name, what it belongs to, the number of arguments, what it gives,
/// what becomes of NaN, the function, an example with its value, the meaning. Of those that are written in the language the texts stand last,
/// each with its number of arguments.
macro_rules! table {
    ($($name:literal $on:ident $($changes:ident)? ($least:expr, $most:expr) $gives:ident $nan:ident $run:ident:
        $example:literal => $value:literal, $doc:literal;)*) => {
        &[$(Row {
            name: $name,
            on: super::On::$on,
            gives: super::Gives::$gives,
            changes: !stringify!($($changes)?).is_empty(),
            nan: super::Nan::$nan,
            doc: $doc,
            example: ($example, $value),
            body: super::Body::Run($run, $least, $most),
        },)*]
    };
    ($($name:literal $on:ident $($changes:ident)?: $example:literal => $value:literal, $doc:literal,
        $first:literal => $text:expr $(, $next:literal => $more:expr)?;)*) => {
        &[$(Row {
            name: $name,
            on: super::On::$on,
            gives: super::Gives::Any,
            changes: !stringify!($($changes)?).is_empty(),
            nan: super::Nan::Written,
            doc: $doc,
            example: ($example, $value),
            body: super::Body::Written(&[($first, $text) $(, ($next, $more))?]),
        },)*]
    };
}
use table;

/// A name that is a method of something: the first row that has it. Rows of one name follow each other.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Name(u8);

/// A function that belongs to nothing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Free(u8);

/// All rows, by their names.
fn all() -> &'static [&'static Row] {
    static ALL: OnceLock<Vec<&'static Row>> = OnceLock::new();
    ALL.get_or_init(|| {
        let files = [list::ROWS, each::ROWS, text::ROWS, number::ROWS, object::ROWS, object::WRITTEN];
        let mut all: Vec<&Row> = files.into_iter().flatten().collect();
        all.sort_by_key(|row| row.name);
        all
    })
}

/// Where the rows of a name begin.
fn first(text: &str) -> Option<(u8, &'static Row)> {
    let at = all().partition_point(|row| row.name < text);
    let row = all().get(at).filter(|row| row.name == text)?;
    Some((at as u8, row))
}

/// The rows that a person may use.
pub(crate) fn rows() -> impl Iterator<Item = &'static Row> {
    all().iter().copied().filter(|row| !row.name.starts_with('_'))
}

/// The method of this name, whatever it belongs to.
pub(crate) fn name(text: &str) -> Option<Name> {
    first(text).filter(|(_, row)| row.on != On::Nothing).map(|(at, _)| Name(at))
}

/// The function of this name.
pub(crate) fn free(text: &str) -> Option<Free> {
    first(text).filter(|(_, row)| row.on == On::Nothing).map(|(at, _)| Free(at))
}

/// The rows that begin at a place and have one name.
fn of_one_name(at: u8) -> impl Iterator<Item = &'static Row> {
    let rows = all().get(usize::from(at)..).unwrap_or(&[]);
    rows.iter().copied().take_while(|row| row.name == rows[0].name)
}

impl Free {
    pub(crate) fn row(self) -> &'static Row {
        all()[usize::from(self.0)]
    }

    /// The function of the language that computes it with so many arguments.
    pub(crate) fn written(self, arguments: usize) -> Option<&'static Function> {
        of_one_name(self.0).find_map(|row| row.written(arguments))
    }
}

impl Name {
    pub(crate) fn text(self) -> &'static str {
        all()[usize::from(self.0)].name
    }

    /// The rows of this name.
    pub(crate) fn rows(self) -> impl Iterator<Item = &'static Row> {
        of_one_name(self.0)
    }

    /// The rows for a receiver of this type; all of them when the type is not known.
    pub(crate) fn rows_for(self, ty: Type) -> impl Iterator<Item = &'static Row> {
        self.rows().filter(move |row| row.is_of(ty))
    }
}

impl Row {
    /// Whether a value of this type has it, as far as that is known.
    pub(crate) fn is_of(&self, ty: Type) -> bool {
        matches!(ty, Type::Any | Type::Never)
            || match self.on {
                On::List => matches!(ty, Type::List | Type::View),
                On::Growing | On::Untyped => ty == Type::List,
                On::Text => ty == Type::String,
                On::Number => matches!(ty, Type::Number | Type::Element),
                On::Nothing => false,
            }
    }

    /// The type of its result, called on something of a type.
    pub(crate) fn returns(&self, receiver: Type) -> Type {
        match self.gives {
            Gives::Any => Type::Any,
            Gives::Boolean => Type::Boolean,
            Gives::Number => Type::Number,
            Gives::String => Type::String,
            Gives::List => Type::List,
            Gives::Undefined => Type::Undefined,
            Gives::Element => Type::Element,
            Gives::Receiver => receiver,
            Gives::Item if receiver == Type::View => Type::Element,
            Gives::Item => Type::Any,
        }
    }

    /// How it is called, in short: `.map`, `Array.from`.
    pub(crate) fn title(&self) -> String {
        let point = if self.on == On::Nothing { "" } else { "." };
        format!("{point}{}", self.name)
    }

    /// The least and the largest number of arguments.
    pub(crate) fn arity(&self) -> (usize, usize) {
        match self.body {
            Body::Run(_, least, most) => (least, most),
            Body::Written(texts) => {
                (texts.first().map_or(0, |(n, _)| *n), texts.last().map_or(0, |(n, _)| *n))
            }
        }
    }

    /// Whether it calls a function for every element.
    pub(crate) fn calls(&self) -> bool {
        matches!(self.body, Body::Written(_))
    }

    /// The example and its value, with an array of the host.
    pub(crate) fn example(&self, array: &str) -> (String, &'static str) {
        (self.example.0.replace("{array}", array), self.example.1)
    }

    /// The function of the language that computes it with so many arguments.
    pub(crate) fn written(&self, arguments: usize) -> Option<&'static Function> {
        static READ: OnceLock<Vec<(&str, Function)>> = OnceLock::new();
        let Body::Written(texts) = self.body else { return None };
        let (_, text) = texts.iter().find(|(n, _)| *n == arguments)?;
        let read = READ.get_or_init(|| {
            let texts = all().iter().flat_map(|row| row.texts());
            texts.filter_map(|(_, text)| Some((*text, function(text)?))).collect()
        });
        read.iter().find(|(t, _)| std::ptr::eq(*t, *text)).map(|(_, function)| function)
    }

    /// The texts of the functions that compute it.
    fn texts(&self) -> &'static [(usize, &'static str)] {
        if let Body::Written(texts) = self.body { texts } else { &[] }
    }
}

/// All functions of the language that compute methods.
pub(crate) fn written() -> impl Iterator<Item = &'static Function> {
    all().iter().flat_map(|row| row.texts().iter().filter_map(|(n, _)| row.written(*n)))
}

/// A function, read.
fn function(text: &str) -> Option<Function> {
    match parse_expression(text).tree.kind {
        ExprKind::Function(function) => Some(*function),
        _ => None,
    }
}

/// The row by which the machine computes a method of a value, if it has it.
pub(crate) fn row_of(heap: &Heap, name: Name, receiver: &Value) -> Option<&'static Row> {
    let list = matches!(heap.object(receiver), Object::List(_));
    // A typed array alone has `set` and `subarray`.
    if list && matches!(name.text(), "set" | "subarray") {
        return None;
    }
    name.rows().filter(|row| !row.calls()).find(|row| match (row.on, receiver) {
        (On::List, Value::List(_) | Value::View(_))
        | (On::Text, Value::String(_))
        | (On::Number, Value::Number(_)) => true,
        (On::Growing | On::Untyped, Value::List(_)) => list,
        _ => false,
    })
}

/// Calls a method.
pub(crate) fn call(env: &mut Env<'_>, name: Name, receiver: &Value, args: &[Value]) -> Outcome {
    match row_of(env.heap, name, receiver).map(|row| &row.body) {
        Some(Body::Run(run, ..)) => run(env, receiver, args),
        _ => Err(no_method(receiver, name.text())),
    }
}

/// Why a method is not called.
fn no_method(receiver: &Value, name: &str) -> Trouble {
    let what = receiver.type_of().describe();
    let what = if receiver.is_nothing() { receiver.to_string() } else { what.to_owned() };
    Trouble::new(rules::NOT_CALLABLE, format!("{what} has no method `{name}`"))
}

/// Calls a function.
pub(crate) fn call_free(env: &mut Env<'_>, function: Free, args: &[Value]) -> Outcome {
    match function.row().body {
        Body::Run(run, ..) => run(env, &Value::Undefined, args),
        Body::Written(_) => Ok(Value::Undefined), // not reached: the binder writes these out
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mock::World;

    /// What a row makes of `[9, element, 7]` and these arguments, with `X` in the place of each `element` and `argument`.
    fn outcome(row: &Row, element: f64, argument: f64, args: &[f64]) -> String {
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
        let Body::Run(run, ..) = row.body else { return String::new() };
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
        let displayed = |value: &Value| show(&heap, value, [element, argument]);
        format!("{} {}", result.as_ref().map_or_else(Clone::clone, &displayed), displayed(&receiver))
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
            let lists = matches!(row.on, On::List | On::Growing | On::Untyped);
            // Every function written in the language states it by its text, and those alone.
            assert_eq!(row.nan == Nan::Written, row.calls(), "{}", row.name);
            // Names with an underscore are called with what the texts of methods hand them: a list, and its length.
            if row.calls() || row.name.starts_with('_') || !(lists || row.on == On::Nothing) {
                continue;
            }
            let (least, most) = row.arity();
            let fitting = || arguments.into_iter().filter(|args| (least..=most).contains(&args.len()));
            let of = |element, argument, args: &&[f64]| outcome(row, element, argument, args);
            let elements = lists && fitting().any(|args| of(8.5, 1.5, &args) != of(f64::NAN, 1.5, &args));
            let arguments = fitting().any(|args| of(8.5, 8.0, &args) != of(8.5, f64::NAN, &args));
            let moved = lists
                && fitting().filter(|a| !a.contains(&8.5)).any(|a| of(8.5, 1.5, &a) != of(f64::NAN, 1.5, &a));
            let asks = row.nan == Nan::Asks;
            assert!(row.nan.of_elements() || !moved || asks, "{} looks at elements", row.name);
            assert!(row.nan.of_arguments() || !arguments || asks, "{} looks at arguments", row.name);
            // What is said to look does.
            assert!(!(lists && row.nan.of_elements()) || elements, "{} looks at no element", row.name);
        }
    }

    #[test]
    fn every_method_that_is_written_is_read_without_a_mistake() {
        for (row, (n, text)) in all().iter().flat_map(|row| row.texts().iter().map(move |t| (row, t))) {
            assert!(parse_expression(text).diagnostics.is_empty(), "{}", row.name);
            assert!(row.written(*n).is_some(), "{}", row.name);
        }
    }

    #[test]
    fn the_machine_has_the_first_row_of_a_name() {
        // A function that the machine calls must not be one that is written out.
        for row in all().iter().filter(|row| row.on == On::Nothing) {
            assert!(!free(row.name).unwrap().row().calls(), "{}", row.name);
        }
        assert!(all().len() < 256);
    }
}
