//! Methods of lists, typed arrays and arrays of the host (ECMAScript, "Array Objects", "TypedArray Objects").

use super::env::{Env, NativeError, arg, integer, range, relative};
use super::native::{MANY, Native, NativeOutcome, no_method, table};
use crate::heap::HeapObject;
use crate::rules;
use crate::types::Elem;
use crate::value::{Value, View};
use labspec_finding::order;

pub(super) static ROWS: &[Native] = table! {
    "at" List (1, 1) Item Moves at: "[1, 2, 3].at(-1)" => "3",
        "element at an index; a negative index counts from the end";
    "concat" Untyped (0, MANY) List Keeps concat: "[1].concat([2, 3], 4)" => "1,2,3,4",
        "a list of all elements";
    "fill" List changes (1, 3) Receiver Moves fill: "[1, 2, 3].fill(0, 1)" => "1,0,0",
        "stores one value in all elements, or in those from one index up to another";
    "flat" Untyped (0, 1) List Moves flat: "[1, [2, 3]].flat()" => "1,2,3",
        "the elements, with lists among them flattened";
    "includes" List (1, 2) Boolean Looks includes: "[1, 2].includes(2)" => "true",
        "whether the list contains a value";
    "indexOf" List (1, 2) Number Looks index_of: "[5, 6].indexOf(6)" => "1",
        "index of the first element with a value, or -1";
    "join" List (0, 1) String Looks join: "[1, 2].join(' / ')" => "1 / 2",
        "the elements as one text, with a separator between them (a comma by default)";
    "lastIndexOf" List (1, 2) Number Looks last_index_of: "[5, 6, 5].lastIndexOf(5)" => "2",
        "index of the last element with a value, or -1";
    "pop" Growing changes (0, 0) Any Moves pop: "[1, 2].pop()" => "2",
        "removes the last element and returns it";
    "push" Growing changes (0, MANY) Number Keeps push: "[1, 2].push(3)" => "3",
        "appends elements and returns the new length";
    "reverse" List changes (0, 0) Receiver Moves reverse: "[1, 2, 3].reverse()" => "3,2,1",
        "reverses the order of the elements";
    "set" List changes (1, 2) Undefined Moves set: "{array}.slice(0, 2).set([0, 1])" => "undefined",
        "stores values one after the other, from an index on";
    "shift" Growing changes (0, 0) Any Moves shift: "[1, 2].shift()" => "1",
        "removes the first element and returns it";
    "slice" List (0, 2) List Moves slice: "[1, 2, 3].slice(1)" => "2,3",
        "a copy of the elements from one index up to another; negative indexes count from the end";
    "sort" List changes (0, 0) Receiver Looks sort: "[3, 10, 2].sort()" => "10,2,3",
        "sorts the elements: of a list as texts, of an array as numbers; `sort((a, b) => a - b)` sorts by a function";
    "splice" Growing changes (1, MANY) List Moves splice: "[1, 2, 3].splice(1, 1)" => "2",
        "removes elements from an index on, inserts others there, and returns the removed ones";
    "subarray" List (0, 2) Receiver Moves subarray: "{array}.subarray(0, 2).length" => "2",
        "a part of an array of the model, not a copy";
    "toReversed" List (0, 0) List Moves to_reversed: "[1, 2].toReversed()" => "2,1",
        "a copy in reverse order";
    "toSorted" List (0, 0) List Looks to_sorted: "[3, 1, 2].toSorted()" => "1,2,3",
        "a sorted copy, see `sort`";
    "unshift" Growing changes (0, MANY) Number Keeps unshift: "[2].unshift(1)" => "2",
        "inserts elements at the front and returns the new length";
    "with" List (2, 2) List Moves with: "[1, 2].with(0, 5)" => "5,2",
        "a copy with one element replaced";
    "_like" Nothing (2, 2) List Keeps like: "" => "", "";
    "_kind" Nothing (2, 2) List Keeps kind: "" => "", "";
    "_empty" Nothing (0, 0) Element Keeps empty: "" => "", "";
    "_copy" Nothing (1, 1) List Keeps copy: "" => "", "";
    "_list" Nothing (2, 2) Any Keeps only_list: "" => "", "";
    "_untyped" Nothing (1, 1) List Keeps untyped: "" => "", "";
    "_parts" Nothing (1, 1) List Keeps parts: "" => "", "";
};

/// The element type, if the value can only contain numbers: a typed array, or an array of the host.
fn typed(env: &Env<'_>, value: &Value) -> Option<Elem> {
    match value {
        Value::View(view) => Some(env.elem(*view)),
        _ => match env.heap.object(value) {
            HeapObject::Numbers(_, elem) => Some(*elem),
            _ => None,
        },
    }
}

/// Creates a list of the same kind as another.
fn same_kind(env: &mut Env<'_>, as_in: &Value, items: Vec<Value>) -> NativeOutcome {
    match typed(env, as_in) {
        Some(elem) => {
            let mut numbers = Vec::with_capacity(items.len());
            for item in &items {
                numbers.push(elem.keep(env.number(item)?));
            }
            Ok(env.heap.typed(numbers, elem)?)
        }
        None => Ok(env.heap.list(items)?),
    }
}

/// Replaces all elements, whose number must not change.
fn replace(env: &mut Env<'_>, list: &Value, items: Vec<Value>) -> Result<(), NativeError> {
    for (i, item) in items.into_iter().enumerate() {
        store(env, list, i, &item)?;
    }
    Ok(())
}

/// Stores an element that exists.
fn store(env: &mut Env<'_>, list: &Value, index: usize, item: &Value) -> Result<(), NativeError> {
    if let Value::View(view) = list {
        let x = env.number(item)?;
        return env.view_store(*view, index, x);
    }
    let x = if typed(env, list).is_some() { env.number(item)? } else { 0.0 };
    match env.heap.object_mut(list) {
        Some(HeapObject::List(items)) => {
            if let Some(place) = items.get_mut(index) {
                *place = item.clone();
            }
        }
        Some(HeapObject::Numbers(items, elem)) => {
            if let Some(place) = items.get_mut(index) {
                *place = elem.keep(x);
            }
        }
        _ => {}
    }
    Ok(())
}

fn at(env: &mut Env<'_>, list: &Value, args: &[Value]) -> NativeOutcome {
    let n = env.len(list);
    let x = integer(env.number(arg(args, 0))?);
    let index = if x < 0.0 { n as f64 + x } else { x };
    if index < 0.0 || index >= n as f64 {
        return Ok(Value::Undefined);
    }
    Ok(match list {
        Value::View(view) => env.view_item(*view, index as usize),
        _ => env.heap.item(list, index as usize).unwrap_or_default(),
    })
}

fn concat(env: &mut Env<'_>, list: &Value, args: &[Value]) -> NativeOutcome {
    let mut items = env.items(list)?;
    for arg in args {
        // JavaScript flattens lists, but not typed arrays.
        if matches!(env.heap.object(arg), HeapObject::List(_)) {
            items.extend(env.items(arg)?);
        } else {
            items.push(arg.clone());
        }
    }
    Ok(env.heap.list(items)?)
}

fn fill(env: &mut Env<'_>, list: &Value, args: &[Value]) -> NativeOutcome {
    let n = env.len(list);
    let (start, end) = range(env, args, 1, n)?;
    env.spend(end - start)?;
    for i in start..end {
        store(env, list, i, arg(args, 0))?;
    }
    Ok(list.clone())
}

fn flat(env: &mut Env<'_>, list: &Value, args: &[Value]) -> NativeOutcome {
    let depth = match arg(args, 0) {
        Value::Undefined => 1.0,
        depth => integer(env.number(depth)?),
    };
    let mut items = env.items(list)?;
    for _ in 0..depth.clamp(0.0, 16.0) as usize {
        let mut next = Vec::new();
        let mut nested = false;
        for item in items {
            if matches!(env.heap.object(&item), HeapObject::List(_)) {
                nested = true;
                next.extend(env.items(&item)?);
            } else {
                env.spend(1)?;
                next.push(item);
            }
        }
        items = next;
        if !nested {
            break;
        }
    }
    Ok(env.heap.list(items)?)
}

fn includes(env: &mut Env<'_>, list: &Value, args: &[Value]) -> NativeOutcome {
    let items = env.items(list)?;
    let (from, _) = range(env, args.get(..2).unwrap_or(args), 1, items.len())?;
    let searched = arg(args, 0);
    // Unlike `===`, it finds NaN.
    let is = |v: &Value| v.strictly_equals(searched) || is_nan(v) && is_nan(searched);
    Ok(Value::Boolean(items.iter().skip(from).any(is)))
}

fn is_nan(value: &Value) -> bool {
    matches!(value, Value::Number(x) if x.is_nan())
}

fn index_of(env: &mut Env<'_>, list: &Value, args: &[Value]) -> NativeOutcome {
    let items = env.items(list)?;
    let (from, _) = range(env, args.get(..2).unwrap_or(args), 1, items.len())?;
    let found = items.iter().enumerate().skip(from).find(|(_, v)| v.strictly_equals(arg(args, 0)));
    Ok(Value::Number(found.map_or(-1.0, |(i, _)| i as f64)))
}

fn last_index_of(env: &mut Env<'_>, list: &Value, args: &[Value]) -> NativeOutcome {
    let items = env.items(list)?;
    let n = items.len() as f64;
    let last = match args.get(1) {
        Some(from) => {
            let x = integer(env.number(from)?);
            if x < 0.0 { n + x } else { x.min(n - 1.0) }
        }
        None => n - 1.0,
    };
    let found = items.iter().enumerate().rev().filter(|(i, _)| *i as f64 <= last);
    let found = found.into_iter().find(|(_, v)| v.strictly_equals(arg(args, 0)));
    Ok(Value::Number(found.map_or(-1.0, |(i, _)| i as f64)))
}

fn join(env: &mut Env<'_>, list: &Value, args: &[Value]) -> NativeOutcome {
    let between = match arg(args, 0) {
        Value::Undefined => ",".to_owned(),
        other => env.text(other)?,
    };
    let mut text = String::new();
    let mut lists = vec![list.clone()];
    for (i, item) in env.items(list)?.iter().enumerate() {
        if i > 0 {
            text.push_str(&between);
        }
        if !item.is_nothing() {
            text.push_str(&env.text_within(item, &mut lists)?);
        }
        if text.len() > crate::heap::MAX_TEXT {
            return Err(super::env::too_long());
        }
    }
    env.string(text)
}

fn pop(env: &mut Env<'_>, list: &Value, _: &[Value]) -> NativeOutcome {
    Ok(match env.heap.object_mut(list) {
        Some(HeapObject::List(items)) => items.pop().unwrap_or_default(),
        _ => Value::Undefined,
    })
}

fn push(env: &mut Env<'_>, list: &Value, args: &[Value]) -> NativeOutcome {
    for arg in args {
        env.heap.grow(arg)?;
    }
    if let Some(HeapObject::List(items)) = env.heap.object_mut(list) {
        items.extend(args.iter().cloned());
    }
    Ok(Value::Number(env.len(list) as f64))
}

fn reverse(env: &mut Env<'_>, list: &Value, _: &[Value]) -> NativeOutcome {
    let mut items = env.items(list)?;
    items.reverse();
    replace(env, list, items)?;
    Ok(list.clone())
}

/// The values for iteration or for a list pattern: a list unchanged, a string as its characters.
fn parts(env: &mut Env<'_>, _: &Value, args: &[Value]) -> NativeOutcome {
    match arg(args, 0) {
        list @ (Value::List(_) | Value::View(_)) => Ok(list.clone()),
        other => {
            let items = env.spread(other)?;
            Ok(env.heap.list(items)?)
        }
    }
}

fn set(env: &mut Env<'_>, list: &Value, args: &[Value]) -> NativeOutcome {
    let items = env.spread(arg(args, 0))?;
    let offset = integer(env.number(arg(args, 1))?);
    let n = env.len(list);
    if offset < 0.0 || offset + items.len() as f64 > n as f64 {
        let message = format!("{} values from index {offset} on do not fit into {n} elements", items.len());
        return Err(NativeError::new(rules::INDEX_RANGE, message));
    }
    for (i, item) in items.iter().enumerate() {
        store(env, list, offset as usize + i, item)?;
    }
    Ok(Value::Undefined)
}

fn shift(env: &mut Env<'_>, list: &Value, _: &[Value]) -> NativeOutcome {
    let n = env.len(list);
    env.spend(n / 8)?;
    Ok(match env.heap.object_mut(list) {
        Some(HeapObject::List(items)) if !items.is_empty() => items.remove(0),
        _ => Value::Undefined,
    })
}

fn slice(env: &mut Env<'_>, list: &Value, args: &[Value]) -> NativeOutcome {
    let items = env.items(list)?;
    let (start, end) = range(env, args, 0, items.len())?;
    let part = items.get(start..end).unwrap_or(&[]).to_vec();
    same_kind(env, list, part)
}

/// The order of numbers in typed arrays: -0 before 0, NaN last.
fn order_numbers(a: &Value, b: &Value) -> std::cmp::Ordering {
    let (a, b) = (a.to_number(), b.to_number());
    let rank = |x: f64| if x.is_nan() { f64::INFINITY } else { x };
    a.is_nan().cmp(&b.is_nan()).then(rank(a).total_cmp(&rank(b)))
}

/// Sorts the elements of a list as strings, `undefined` last; numbers of typed arrays by value.
fn sorted(env: &mut Env<'_>, list: &Value) -> Result<Vec<Value>, NativeError> {
    let mut items = env.items(list)?;
    env.spend(8 * items.len())?;
    if typed(env, list).is_some() {
        order::sort_by(&mut items, order_numbers);
        return Ok(items);
    }
    let mut keyed = Vec::with_capacity(items.len());
    for item in items {
        let key: Vec<u16> = env.text(&item)?.encode_utf16().collect();
        keyed.push((item == Value::Undefined, key, item));
    }
    order::sort_by(&mut keyed, |a, b| (a.0, &a.1).cmp(&(b.0, &b.1)));
    Ok(keyed.into_iter().map(|(_, _, item)| item).collect())
}

fn sort(env: &mut Env<'_>, list: &Value, _: &[Value]) -> NativeOutcome {
    let items = sorted(env, list)?;
    replace(env, list, items)?;
    Ok(list.clone())
}

fn to_sorted(env: &mut Env<'_>, list: &Value, _: &[Value]) -> NativeOutcome {
    let items = sorted(env, list)?;
    same_kind(env, list, items)
}

fn to_reversed(env: &mut Env<'_>, list: &Value, _: &[Value]) -> NativeOutcome {
    let mut items = env.items(list)?;
    items.reverse();
    same_kind(env, list, items)
}

fn splice(env: &mut Env<'_>, list: &Value, args: &[Value]) -> NativeOutcome {
    let n = env.len(list);
    env.spend(n / 8)?;
    let start = relative(env.number(arg(args, 0))?, n);
    let count = match args.get(1) {
        Some(count) => integer(env.number(count)?).clamp(0.0, (n - start) as f64) as usize,
        None => n - start,
    };
    let new = args.get(2..).unwrap_or(&[]);
    for item in new {
        env.heap.grow(item)?;
    }
    let removed = match env.heap.object_mut(list) {
        Some(HeapObject::List(items)) => items.splice(start..start + count, new.iter().cloned()).collect(),
        _ => Vec::new(),
    };
    Ok(env.heap.list(removed)?)
}

fn subarray(env: &mut Env<'_>, list: &Value, args: &[Value]) -> NativeOutcome {
    let n = env.len(list);
    let (start, end) = range(env, args, 0, n)?;
    match list {
        Value::View(view) => {
            Ok(Value::View(View::new(view.field, view.first as usize + start, Some(end - start))))
        }
        // A part of a copied list is a copy: nothing else refers to its elements.
        _ => slice(env, list, args),
    }
}

fn unshift(env: &mut Env<'_>, list: &Value, args: &[Value]) -> NativeOutcome {
    let n = env.len(list);
    env.spend(n / 8)?;
    for arg in args {
        env.heap.grow(arg)?;
    }
    if let Some(HeapObject::List(items)) = env.heap.object_mut(list) {
        items.splice(0..0, args.iter().cloned());
    }
    Ok(Value::Number((n + args.len()) as f64))
}

fn with(env: &mut Env<'_>, list: &Value, args: &[Value]) -> NativeOutcome {
    let mut items = env.items(list)?;
    let x = integer(env.number(arg(args, 0))?);
    let index = if x < 0.0 { items.len() as f64 + x } else { x };
    match items.get_mut(index as usize).filter(|_| index >= 0.0) {
        Some(place) => *place = arg(args, 1).clone(),
        None => {
            return Err(NativeError::new(
                rules::INDEX_RANGE,
                format!("element {x} does not exist: the list has {}", items.len()),
            ));
        }
    }
    same_kind(env, list, items)
}

/// Creates a list of the same kind as another, with `n` empty elements.
fn like(env: &mut Env<'_>, _: &Value, args: &[Value]) -> NativeOutcome {
    let n = arg(args, 1).to_number() as usize;
    env.spend(n)?;
    let empty = if typed(env, arg(args, 0)).is_some() { Value::Number(0.0) } else { Value::Undefined };
    same_kind(env, arg(args, 0), vec![empty; n])
}

/// Copies the elements of a list into a list of the same kind as another.
fn kind(env: &mut Env<'_>, _: &Value, args: &[Value]) -> NativeOutcome {
    if typed(env, arg(args, 0)).is_none() {
        return Ok(arg(args, 1).clone());
    }
    let items = env.items(arg(args, 1))?;
    same_kind(env, arg(args, 0), items)
}

/// Fails: `reduce` was called on an empty list without an initial value.
fn empty(_: &mut Env<'_>, _: &Value, _: &[Value]) -> NativeOutcome {
    Err(NativeError::new(rules::NO_PARTS, "`reduce` of an empty list needs an initial value"))
}

/// Returns a list or an array unchanged, and fails for other values: the method exists only on lists.
fn only_list(_: &mut Env<'_>, _: &Value, args: &[Value]) -> NativeOutcome {
    match arg(args, 0) {
        list @ (Value::List(_) | Value::View(_)) => Ok(list.clone()),
        other => Err(no_method(other, &arg(args, 1).to_string())),
    }
}

/// Returns a list unchanged, and fails for typed arrays, which have no `flatMap`.
fn untyped(env: &mut Env<'_>, _: &Value, args: &[Value]) -> NativeOutcome {
    let list = arg(args, 0);
    match env.heap.object(list) {
        HeapObject::List(_) => Ok(list.clone()),
        _ => Err(no_method(list, "flatMap")),
    }
}

fn copy(env: &mut Env<'_>, _: &Value, args: &[Value]) -> NativeOutcome {
    let items = env.items(arg(args, 0))?;
    same_kind(env, arg(args, 0), items)
}
