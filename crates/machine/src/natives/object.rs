//! Functions of `Array` and `Object` (ECMAScript, "Properties of the Array Constructor", "Properties of the Object Constructor").

use super::env::{Env, NativeError, arg, integer};
use super::native::{MANY, Native, NativeOutcome, table};
use crate::heap::HeapObject;
use crate::rules;
use crate::value::Value;
use labspec_finding::order;

pub(super) static ROWS: &[Native] = table! {
    "Array.isArray" Nothing (1, 1) Boolean Asks is_array: "Array.isArray([1])" => "true",
        "whether a value is a list; an array of the model is not one, as in JavaScript";
    "Array.of" Nothing (0, MANY) List Keeps array_of: "Array.of(1, 2)" => "1,2",
        "a list of the arguments";
    "Array.from" Nothing (1, 1) List Keeps from: "Array.from('ab')" => "a,b",
        "a list of the elements of an array, the characters of a text, or `{length: n}` elements; with a function, its result for each";
    "Object.keys" Nothing (1, 1) List Keeps keys: "Object.keys({b: 1, a: 2}).join()" => "b,a",
        "the keys of a record";
    "Object.values" Nothing (1, 1) List Keeps values: "Object.values({b: 1, a: 2}).join()" => "1,2",
        "the values of a record";
    "Object.entries" Nothing (1, 1) List Keeps entries: "Object.entries({a: 1}).join()" => "a,1",
        "pairs of key and value of a record";
};

/// `Array.from` with a function for every element.
pub(super) static SOURCE_ROWS: &[Native] = table! {
    "Array.from" Nothing: "Array.from([1, 2], x => 2 * x)" => "2,4", "a list of the results of a function for each element",
        2 => "(v, f) => { const l = Array.from(v), n = l.length, r = []; for (let i = 0; i < n; i++) r.push(f(l[i], i)); return r }";
};

fn is_array(env: &mut Env<'_>, _: &Value, args: &[Value]) -> NativeOutcome {
    Ok(Value::Boolean(matches!(env.heap.object(arg(args, 0)), HeapObject::List(_))))
}

fn array_of(env: &mut Env<'_>, _: &Value, args: &[Value]) -> NativeOutcome {
    Ok(env.heap.list(args.to_vec())?)
}

fn from(env: &mut Env<'_>, _: &Value, args: &[Value]) -> NativeOutcome {
    let source = arg(args, 0);
    let items = match source {
        Value::Record(_) => {
            let n = env.heap.get(source, "length").map_or(0.0, |v| integer(v.to_number())).max(0.0);
            if n > 1e6 {
                return Err(NativeError::new(rules::MEMORY, format!("a list of {n} elements is too long")));
            }
            env.spend(n as usize)?;
            vec![Value::Undefined; n as usize]
        }
        other => env.spread(other)?,
    };
    Ok(env.heap.list(items)?)
}

/// The entries of a record in JavaScript's order: keys that are indexes first.
fn ordered(env: &mut Env<'_>, value: &Value) -> Result<Vec<(Value, Value)>, NativeError> {
    let entries = match env.heap.object(value) {
        HeapObject::Record(entries) => {
            let mut entries = entries.clone();
            // Indexes in numeric order, then the other keys in insertion order, because the sort is stable.
            order::sort_by_key(&mut entries, |(k, _)| {
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

fn keys(env: &mut Env<'_>, _: &Value, args: &[Value]) -> NativeOutcome {
    let keys = ordered(env, arg(args, 0))?.into_iter().map(|(k, _)| k).collect();
    Ok(env.heap.list(keys)?)
}

fn values(env: &mut Env<'_>, _: &Value, args: &[Value]) -> NativeOutcome {
    let values = ordered(env, arg(args, 0))?.into_iter().map(|(_, v)| v).collect();
    Ok(env.heap.list(values)?)
}

fn entries(env: &mut Env<'_>, _: &Value, args: &[Value]) -> NativeOutcome {
    let mut lists = Vec::new();
    for (key, value) in ordered(env, arg(args, 0))? {
        lists.push(env.heap.list(vec![key, value])?);
    }
    Ok(env.heap.list(lists)?)
}
