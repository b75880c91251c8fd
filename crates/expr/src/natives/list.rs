//! Methods of lists, typed arrays and arrays of the simulation (ECMAScript, "Array Objects", "TypedArray Objects").

use super::{Env, Trouble, arg, integer, range, relative};
use crate::heap::Object;
use crate::rules;
use crate::schema::Elem;
use crate::value::{Value, View};

type Outcome = Result<Value, Trouble>;

/// What the elements are when a value holds numbers only: a typed array, or an array of the simulation.
fn typed(env: &Env<'_>, value: &Value) -> Option<Elem> {
    match value {
        Value::View(view) => Some(env.elem(*view)),
        _ => match env.heap.object(value) {
            Object::Numbers(_, elem) => Some(*elem),
            _ => None,
        },
    }
}

/// A new list of the same kind as another.
fn same_kind(env: &mut Env<'_>, as_in: &Value, items: Vec<Value>) -> Outcome {
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

/// Replaces all elements; of arrays of fixed size the number stays.
fn replace(env: &mut Env<'_>, list: &Value, items: Vec<Value>) -> Result<(), Trouble> {
    for (i, item) in items.into_iter().enumerate() {
        store(env, list, i, &item)?;
    }
    Ok(())
}

/// Stores an element that exists.
fn store(env: &mut Env<'_>, list: &Value, index: usize, item: &Value) -> Result<(), Trouble> {
    if let Value::View(view) = list {
        let x = env.number(item)?;
        return env.view_store(*view, index, x);
    }
    let x = if typed(env, list).is_some() { env.number(item)? } else { 0.0 };
    match env.heap.object_mut(list) {
        Some(Object::List(items)) => {
            if let Some(place) = items.get_mut(index) {
                *place = item.clone();
            }
        }
        Some(Object::Numbers(items, elem)) => {
            if let Some(place) = items.get_mut(index) {
                *place = elem.keep(x);
            }
        }
        _ => {}
    }
    Ok(())
}

pub(super) fn at(env: &mut Env<'_>, list: &Value, args: &[Value]) -> Outcome {
    let n = env.len(list);
    let x = integer(env.number(arg(args, 0))?);
    let at = if x < 0.0 { n as f64 + x } else { x };
    if at < 0.0 || at >= n as f64 {
        return Ok(Value::Undefined);
    }
    Ok(match list {
        Value::View(view) => env.view_item(*view, at as usize),
        _ => env.heap.item(list, at as usize).unwrap_or_default(),
    })
}

pub(super) fn concat(env: &mut Env<'_>, list: &Value, args: &[Value]) -> Outcome {
    let mut items = env.items(list)?;
    for arg in args {
        // JavaScript takes lists apart, typed arrays not.
        if matches!(env.heap.object(arg), Object::List(_)) {
            items.extend(env.items(arg)?);
        } else {
            items.push(arg.clone());
        }
    }
    Ok(env.heap.list(items)?)
}

pub(super) fn fill(env: &mut Env<'_>, list: &Value, args: &[Value]) -> Outcome {
    let n = env.len(list);
    let (start, end) = range(env, args, 1, n)?;
    env.spend(end - start)?;
    for i in start..end {
        store(env, list, i, arg(args, 0))?;
    }
    Ok(list.clone())
}

pub(super) fn flat(env: &mut Env<'_>, list: &Value, args: &[Value]) -> Outcome {
    let depth = match arg(args, 0) {
        Value::Undefined => 1.0,
        depth => integer(env.number(depth)?),
    };
    let mut items = env.items(list)?;
    for _ in 0..depth.clamp(0.0, 16.0) as usize {
        let mut next = Vec::new();
        let mut nested = false;
        for item in items {
            if matches!(env.heap.object(&item), Object::List(_)) {
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

pub(super) fn includes(env: &mut Env<'_>, list: &Value, args: &[Value]) -> Outcome {
    let items = env.items(list)?;
    let (from, _) = range(env, args.get(..2).unwrap_or(args), 1, items.len())?;
    let wanted = arg(args, 0);
    // Unlike `===`, it finds NaN.
    let is = |v: &Value| v.strictly_equals(wanted) || is_nan(v) && is_nan(wanted);
    Ok(Value::Boolean(items.iter().skip(from).any(is)))
}

fn is_nan(value: &Value) -> bool {
    matches!(value, Value::Number(x) if x.is_nan())
}

pub(super) fn index_of(env: &mut Env<'_>, list: &Value, args: &[Value]) -> Outcome {
    let items = env.items(list)?;
    let (from, _) = range(env, args.get(..2).unwrap_or(args), 1, items.len())?;
    let found = items.iter().enumerate().skip(from).find(|(_, v)| v.strictly_equals(arg(args, 0)));
    Ok(Value::Number(found.map_or(-1.0, |(i, _)| i as f64)))
}

pub(super) fn last_index_of(env: &mut Env<'_>, list: &Value, args: &[Value]) -> Outcome {
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

pub(super) fn join(env: &mut Env<'_>, list: &Value, args: &[Value]) -> Outcome {
    let between = match arg(args, 0) {
        Value::Undefined => ",".to_owned(),
        other => env.text(other)?,
    };
    let mut text = String::new();
    for (i, item) in env.items(list)?.iter().enumerate() {
        if i > 0 {
            text.push_str(&between);
        }
        if !item.is_nothing() {
            text.push_str(&env.text(item)?);
        }
        if text.len() > crate::heap::MAX_TEXT {
            return Err(super::too_long());
        }
    }
    env.string(text)
}

pub(super) fn pop(env: &mut Env<'_>, list: &Value, _: &[Value]) -> Outcome {
    Ok(match env.heap.object_mut(list) {
        Some(Object::List(items)) => items.pop().unwrap_or_default(),
        _ => Value::Undefined,
    })
}

pub(super) fn push(env: &mut Env<'_>, list: &Value, args: &[Value]) -> Outcome {
    for arg in args {
        env.heap.grow(arg)?;
    }
    if let Some(Object::List(items)) = env.heap.object_mut(list) {
        items.extend(args.iter().cloned());
    }
    Ok(Value::Number(env.len(list) as f64))
}

pub(super) fn reverse(env: &mut Env<'_>, list: &Value, _: &[Value]) -> Outcome {
    let mut items = env.items(list)?;
    items.reverse();
    replace(env, list, items)?;
    Ok(list.clone())
}

pub(super) fn set(env: &mut Env<'_>, list: &Value, args: &[Value]) -> Outcome {
    let items = env.spread(arg(args, 0))?;
    let offset = integer(env.number(arg(args, 1))?);
    let n = env.len(list);
    if offset < 0.0 || offset + items.len() as f64 > n as f64 {
        let message = format!("{} values from index {offset} on do not fit into {n} elements", items.len());
        return Err(Trouble::new(rules::INDEX_RANGE, message));
    }
    for (i, item) in items.iter().enumerate() {
        store(env, list, offset as usize + i, item)?;
    }
    Ok(Value::Undefined)
}

pub(super) fn shift(env: &mut Env<'_>, list: &Value, _: &[Value]) -> Outcome {
    let n = env.len(list);
    env.spend(n / 8)?;
    Ok(match env.heap.object_mut(list) {
        Some(Object::List(items)) if !items.is_empty() => items.remove(0),
        _ => Value::Undefined,
    })
}

pub(super) fn slice(env: &mut Env<'_>, list: &Value, args: &[Value]) -> Outcome {
    let items = env.items(list)?;
    let (start, end) = range(env, args, 0, items.len())?;
    let part = items.get(start..end).unwrap_or(&[]).to_vec();
    same_kind(env, list, part)
}

/// Orders numbers as typed arrays do: -0 before 0, NaN last.
fn order_numbers(a: &Value, b: &Value) -> std::cmp::Ordering {
    let (a, b) = (a.to_number(), b.to_number());
    let rank = |x: f64| if x.is_nan() { f64::INFINITY } else { x };
    a.is_nan().cmp(&b.is_nan()).then(rank(a).total_cmp(&rank(b)))
}

/// Orders elements of a list as texts, `undefined` last.
fn sorted(env: &mut Env<'_>, list: &Value) -> Result<Vec<Value>, Trouble> {
    let mut items = env.items(list)?;
    env.spend(8 * items.len())?;
    if typed(env, list).is_some() {
        items.sort_by(order_numbers);
        return Ok(items);
    }
    let mut keyed = Vec::with_capacity(items.len());
    for item in items {
        let key: Vec<u16> = env.text(&item)?.encode_utf16().collect();
        keyed.push((item == Value::Undefined, key, item));
    }
    keyed.sort_by(|a, b| (a.0, &a.1).cmp(&(b.0, &b.1)));
    Ok(keyed.into_iter().map(|(_, _, item)| item).collect())
}

pub(super) fn sort(env: &mut Env<'_>, list: &Value, _: &[Value]) -> Outcome {
    let items = sorted(env, list)?;
    replace(env, list, items)?;
    Ok(list.clone())
}

pub(super) fn to_sorted(env: &mut Env<'_>, list: &Value, _: &[Value]) -> Outcome {
    let items = sorted(env, list)?;
    same_kind(env, list, items)
}

pub(super) fn to_reversed(env: &mut Env<'_>, list: &Value, _: &[Value]) -> Outcome {
    let mut items = env.items(list)?;
    items.reverse();
    same_kind(env, list, items)
}

pub(super) fn splice(env: &mut Env<'_>, list: &Value, args: &[Value]) -> Outcome {
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
        Some(Object::List(items)) => items.splice(start..start + count, new.iter().cloned()).collect(),
        _ => Vec::new(),
    };
    Ok(env.heap.list(removed)?)
}

pub(super) fn subarray(env: &mut Env<'_>, list: &Value, args: &[Value]) -> Outcome {
    let n = env.len(list);
    let (start, end) = range(env, args, 0, n)?;
    match list {
        Value::View(view) => {
            Ok(Value::View(View::new(view.field, view.first as usize + start, Some(end - start))))
        }
        // A part of a copy is a copy: nothing else refers to the elements.
        _ => slice(env, list, args),
    }
}

pub(super) fn unshift(env: &mut Env<'_>, list: &Value, args: &[Value]) -> Outcome {
    let n = env.len(list);
    env.spend(n / 8)?;
    for arg in args {
        env.heap.grow(arg)?;
    }
    if let Some(Object::List(items)) = env.heap.object_mut(list) {
        items.splice(0..0, args.iter().cloned());
    }
    Ok(Value::Number((n + args.len()) as f64))
}

pub(super) fn with(env: &mut Env<'_>, list: &Value, args: &[Value]) -> Outcome {
    let mut items = env.items(list)?;
    let x = integer(env.number(arg(args, 0))?);
    let at = if x < 0.0 { items.len() as f64 + x } else { x };
    match items.get_mut(at as usize).filter(|_| at >= 0.0) {
        Some(place) => *place = arg(args, 1).clone(),
        None => {
            return Err(Trouble::new(
                rules::INDEX_RANGE,
                format!("there is no element {x}: the list has {}", items.len()),
            ));
        }
    }
    same_kind(env, list, items)
}

pub(super) fn is_array(env: &mut Env<'_>, _: &Value, args: &[Value]) -> Outcome {
    Ok(Value::Boolean(matches!(env.heap.object(arg(args, 0)), Object::List(_))))
}

pub(super) fn of(env: &mut Env<'_>, _: &Value, args: &[Value]) -> Outcome {
    Ok(env.heap.list(args.to_vec())?)
}

pub(super) fn from(env: &mut Env<'_>, _: &Value, args: &[Value]) -> Outcome {
    let source = arg(args, 0);
    let items = match source {
        Value::Record(_) => {
            let n = env.heap.get(source, "length").map_or(0.0, |v| integer(v.to_number())).max(0.0);
            if n > 1e6 {
                return Err(Trouble::new(rules::MEMORY, format!("a list of {n} elements is too long")));
            }
            env.spend(n as usize)?;
            vec![Value::Undefined; n as usize]
        }
        other => env.spread(other)?,
    };
    Ok(env.heap.list(items)?)
}

/// The entries of a record in JavaScript's order: keys that are indexes first.
fn ordered(env: &mut Env<'_>, value: &Value) -> Result<Vec<(Value, Value)>, Trouble> {
    let entries = match env.heap.object(value) {
        Object::Record(entries) => {
            let mut entries = entries.clone();
            // Indexes in order of size, then the others as they came: the sort is stable.
            entries.sort_by_key(|(k, _)| {
                k.parse::<u32>().ok().filter(|i| i.to_string() == **k).map_or(u64::MAX, u64::from)
            });
            entries.into_iter().map(|(k, v)| (Value::String(k), v)).collect()
        }
        _ => {
            let items = env.spread(value)?;
            let keyed = items.into_iter().enumerate();
            keyed.map(|(i, v)| (Value::String(i.to_string().into()), v)).collect::<Vec<_>>()
        }
    };
    env.spend(entries.len())?;
    Ok(entries)
}

pub(super) fn keys(env: &mut Env<'_>, _: &Value, args: &[Value]) -> Outcome {
    let keys = ordered(env, arg(args, 0))?.into_iter().map(|(k, _)| k).collect();
    Ok(env.heap.list(keys)?)
}

pub(super) fn values(env: &mut Env<'_>, _: &Value, args: &[Value]) -> Outcome {
    let values = ordered(env, arg(args, 0))?.into_iter().map(|(_, v)| v).collect();
    Ok(env.heap.list(values)?)
}

pub(super) fn entries(env: &mut Env<'_>, _: &Value, args: &[Value]) -> Outcome {
    let mut lists = Vec::new();
    for (key, value) in ordered(env, arg(args, 0))? {
        lists.push(env.heap.list(vec![key, value])?);
    }
    Ok(env.heap.list(lists)?)
}

/// A list of the same kind as another, with so many elements.
pub(super) fn like(env: &mut Env<'_>, _: &Value, args: &[Value]) -> Outcome {
    let n = arg(args, 1).to_number() as usize;
    env.spend(n)?;
    let empty = if typed(env, arg(args, 0)).is_some() { Value::Number(0.0) } else { Value::Undefined };
    same_kind(env, arg(args, 0), vec![empty; n])
}

/// The elements of a list in a list of the same kind as another.
pub(super) fn kind(env: &mut Env<'_>, _: &Value, args: &[Value]) -> Outcome {
    if typed(env, arg(args, 0)).is_none() {
        return Ok(arg(args, 1).clone());
    }
    let items = env.items(arg(args, 1))?;
    same_kind(env, arg(args, 0), items)
}

/// What `reduce` of nothing does.
pub(super) fn empty(_: &mut Env<'_>, _: &Value, _: &[Value]) -> Outcome {
    Err(Trouble::new(rules::NO_PARTS, "`reduce` of a list without elements needs a first value"))
}

pub(super) fn copy(env: &mut Env<'_>, _: &Value, args: &[Value]) -> Outcome {
    let items = env.items(arg(args, 0))?;
    same_kind(env, arg(args, 0), items)
}
