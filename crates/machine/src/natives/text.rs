//! Methods of strings (ECMAScript, "String Objects"). Indexes count UTF-16 code units, as in JavaScript.

use super::env::{Env, NativeError, arg, integer, range};
use super::native::{MANY, Native, NativeOutcome, table};
use crate::heap::MAX_TEXT;
use crate::number::is_space;
use crate::rules;
use crate::value::Value;

pub(super) static ROWS: &[Native] = table! {
    "at" Text (1, 1) Any Looks at: "'abc'.at(-1)" => "c",
        "character at an index; a negative index counts from the end";
    "concat" Text (0, MANY) String Looks concat: "'a'.concat('b', 1)" => "ab1",
        "the texts joined";
    "includes" Text (1, 2) Boolean Looks includes: "'abc'.includes('bc')" => "true",
        "whether it contains a text";
    "indexOf" Text (1, 2) Number Looks index_of: "'abc'.indexOf('c')" => "2",
        "first index of a text in it, or -1";
    "lastIndexOf" Text (1, 1) Number Looks last_index_of: "'abca'.lastIndexOf('a')" => "3",
        "last index of a text in it, or -1";
    "slice" Text (0, 2) String Looks slice: "'abc'.slice(0, -1)" => "ab",
        "the part from one index up to another; negative indexes count from the end";
    "charAt" Text (0, 1) String Looks char_at: "'abc'.charAt(1)" => "b",
        "character at an index";
    "charCodeAt" Text (0, 1) Number Looks char_code_at: "'A'.charCodeAt(0)" => "65",
        "UTF-16 code of the character at an index";
    "endsWith" Text (1, 1) Boolean Looks ends_with: "'abc'.endsWith('c')" => "true",
        "whether it ends with a text";
    "padEnd" Text (1, 2) String Looks pad_end: "'7'.padEnd(3, '0')" => "700",
        "padded at the end to a length";
    "padStart" Text (1, 2) String Looks pad_start: "'7'.padStart(3)" => "  7",
        "padded at the start to a length";
    "repeat" Text (1, 1) String Looks repeat: "'ab'.repeat(2)" => "abab",
        "the text repeated several times";
    "replace" Text (2, 2) String Looks replace: "'aa'.replace('a', 'b')" => "ba",
        "with the first occurrence of a text replaced";
    "replaceAll" Text (2, 2) String Looks replace_all: "'aa'.replaceAll('a', 'b')" => "bb",
        "with every occurrence of a text replaced";
    "split" Text (0, 2) List Looks split: "'a,b'.split(',').length" => "2",
        "the parts between the occurrences of a separator";
    "startsWith" Text (1, 2) Boolean Looks starts_with: "'abc'.startsWith('a')" => "true",
        "whether it starts with a text";
    "substring" Text (1, 2) String Looks substring: "'abc'.substring(2, 0)" => "ab",
        "the part between two indexes";
    "toLowerCase" Text (0, 0) String Looks to_lower_case: "'ABC'.toLowerCase()" => "abc",
        "in lower case";
    "toUpperCase" Text (0, 0) String Looks to_upper_case: "'abc'.toUpperCase()" => "ABC",
        "in upper case";
    "trim" Text (0, 0) String Looks trim: "' a '.trim()" => "a",
        "without white space at both ends";
    "trimEnd" Text (0, 0) String Looks trim_end: "'a '.trimEnd()" => "a",
        "without white space at the end";
    "trimStart" Text (0, 0) String Looks trim_start: "' a'.trimStart()" => "a",
        "without white space at the start";
};

fn str_of(value: &Value) -> &str {
    if let Value::String(text) = value { text } else { "" }
}

fn units(value: &Value) -> Vec<u16> {
    str_of(value).encode_utf16().collect()
}

fn from_units(env: &mut Env<'_>, units: &[u16]) -> NativeOutcome {
    let text = whole(units)?;
    env.string(text)
}

/// The string of UTF-16 units. Strings contain only whole characters, so half of a surrogate pair is an error.
pub(crate) fn whole(units: &[u16]) -> Result<String, NativeError> {
    String::from_utf16(units).map_err(|_| {
        let message = "an index selects half of a two-unit character, which a text cannot hold; `[...text]` has whole characters";
        NativeError::new(rules::ARGUMENT_TYPE, message)
    })
}

/// The number of UTF-16 units before a byte of a string.
fn units_before(text: &str, byte: usize) -> f64 {
    text.get(..byte).map_or(0, |before| before.encode_utf16().count()) as f64
}

fn at(env: &mut Env<'_>, text: &Value, args: &[Value]) -> NativeOutcome {
    let units = units(text);
    let x = integer(env.number(arg(args, 0))?);
    let index = if x < 0.0 { units.len() as f64 + x } else { x };
    if index < 0.0 || index >= units.len() as f64 {
        return Ok(Value::Undefined);
    }
    let index = index as usize;
    from_units(env, units.get(index..index + 1).unwrap_or(&[]))
}

fn concat(env: &mut Env<'_>, text: &Value, args: &[Value]) -> NativeOutcome {
    let mut all = str_of(text).to_owned();
    for arg in args {
        all.push_str(&env.text(arg)?);
    }
    env.string(all)
}

/// The rest of a string from the start index, in UTF-16 units, on.
fn from_index<'t>(env: &mut Env<'_>, text: &'t str, start: &Value) -> Result<&'t str, NativeError> {
    let start = integer(env.number(start)?).max(0.0);
    let mut seen = 0.0;
    for (byte, c) in text.char_indices() {
        if seen >= start {
            return Ok(text.get(byte..).unwrap_or(""));
        }
        seen += c.len_utf16() as f64;
    }
    Ok("")
}

fn includes(env: &mut Env<'_>, text: &Value, args: &[Value]) -> NativeOutcome {
    let searched = env.text(arg(args, 0))?;
    let rest = from_index(env, str_of(text), arg(args, 1))?;
    Ok(Value::Boolean(rest.contains(&searched)))
}

fn index_of(env: &mut Env<'_>, text: &Value, args: &[Value]) -> NativeOutcome {
    let searched = env.text(arg(args, 0))?;
    let text = str_of(text);
    let rest = from_index(env, text, arg(args, 1))?;
    let skipped = text.len() - rest.len();
    let found = rest.find(&searched).map(|byte| units_before(text, skipped + byte));
    Ok(Value::Number(found.unwrap_or(-1.0)))
}

fn last_index_of(env: &mut Env<'_>, text: &Value, args: &[Value]) -> NativeOutcome {
    let searched = env.text(arg(args, 0))?;
    let text = str_of(text);
    Ok(Value::Number(text.rfind(&searched).map_or(-1.0, |byte| units_before(text, byte))))
}

fn slice(env: &mut Env<'_>, text: &Value, args: &[Value]) -> NativeOutcome {
    let units = units(text);
    let (start, end) = range(env, args, 0, units.len())?;
    from_units(env, units.get(start..end).unwrap_or(&[]))
}

fn substring(env: &mut Env<'_>, text: &Value, args: &[Value]) -> NativeOutcome {
    let units = units(text);
    let n = units.len() as f64;
    let a = integer(env.number(arg(args, 0))?).clamp(0.0, n);
    let b = match arg(args, 1) {
        Value::Undefined => n,
        end => integer(env.number(end)?).clamp(0.0, n),
    };
    from_units(env, units.get(a.min(b) as usize..a.max(b) as usize).unwrap_or(&[]))
}

fn char_at(env: &mut Env<'_>, text: &Value, args: &[Value]) -> NativeOutcome {
    let units = units(text);
    let index = integer(env.number(arg(args, 0))?);
    if index < 0.0 || index >= units.len() as f64 {
        return Ok(Value::from(""));
    }
    let index = index as usize;
    from_units(env, units.get(index..index + 1).unwrap_or(&[]))
}

fn char_code_at(env: &mut Env<'_>, text: &Value, args: &[Value]) -> NativeOutcome {
    let index = integer(env.number(arg(args, 0))?);
    let unit = if index < 0.0 { None } else { str_of(text).encode_utf16().nth(index as usize) };
    Ok(Value::Number(unit.map_or(f64::NAN, f64::from)))
}

fn starts_with(env: &mut Env<'_>, text: &Value, args: &[Value]) -> NativeOutcome {
    let searched = env.text(arg(args, 0))?;
    let rest = from_index(env, str_of(text), arg(args, 1))?;
    Ok(Value::Boolean(rest.starts_with(&searched)))
}

fn ends_with(env: &mut Env<'_>, text: &Value, args: &[Value]) -> NativeOutcome {
    let searched = env.text(arg(args, 0))?;
    Ok(Value::Boolean(str_of(text).ends_with(&searched)))
}

/// The padding that extends a string to a length.
fn padding(env: &mut Env<'_>, text: &Value, args: &[Value]) -> Result<String, NativeError> {
    let filler = match arg(args, 1) {
        Value::Undefined => " ".to_owned(),
        filler => env.text(filler)?,
    };
    let have = str_of(text).encode_utf16().count() as f64;
    let missing = integer(env.number(arg(args, 0))?) - have;
    if missing <= 0.0 || filler.is_empty() {
        return Ok(String::new());
    }
    if missing > MAX_TEXT as f64 {
        return Err(super::too_long());
    }
    let units: Vec<u16> = filler.encode_utf16().cycle().take(missing as usize).collect();
    whole(&units)
}

fn pad_start(env: &mut Env<'_>, text: &Value, args: &[Value]) -> NativeOutcome {
    let padding = padding(env, text, args)?;
    env.string(padding + str_of(text))
}

fn pad_end(env: &mut Env<'_>, text: &Value, args: &[Value]) -> NativeOutcome {
    let padding = padding(env, text, args)?;
    env.string(str_of(text).to_owned() + &padding)
}

fn repeat(env: &mut Env<'_>, text: &Value, args: &[Value]) -> NativeOutcome {
    let count = integer(env.number(arg(args, 0))?);
    if count < 0.0 || count.is_infinite() {
        return Err(NativeError::new(
            rules::ARGUMENT_TYPE,
            format!("a text cannot be repeated {count} times"),
        ));
    }
    let text = str_of(text);
    if text.len() as f64 * count > MAX_TEXT as f64 {
        return Err(super::too_long());
    }
    env.string(if text.is_empty() { String::new() } else { text.repeat(count as usize) })
}

/// The replacement for a match: `$$` is a dollar sign, `$&` the matched string, as in JavaScript.
fn replacement(pattern: &str, found: &str, before: &str, after: &str) -> String {
    let mut out = String::new();
    let mut rest = pattern;
    while let Some(offset) = rest.find('$') {
        out.push_str(rest.get(..offset).unwrap_or(""));
        let (text, length) = match rest.as_bytes().get(offset + 1) {
            Some(b'$') => ("$", 2),
            Some(b'&') => (found, 2),
            Some(b'`') => (before, 2),
            Some(b'\'') => (after, 2),
            _ => ("$", 1),
        };
        out.push_str(text);
        rest = rest.get(offset + length..).unwrap_or("");
    }
    out + rest
}

fn replace(env: &mut Env<'_>, text: &Value, args: &[Value]) -> NativeOutcome {
    let (from, to) = (env.text(arg(args, 0))?, env.text(arg(args, 1))?);
    let text = str_of(text);
    let Some(offset) = text.find(&from) else { return env.string(text.to_owned()) };
    let (before, after) = (text.get(..offset).unwrap_or(""), text.get(offset + from.len()..).unwrap_or(""));
    env.string(format!("{before}{}{after}", replacement(&to, &from, before, after)))
}

fn replace_all(env: &mut Env<'_>, text: &Value, args: &[Value]) -> NativeOutcome {
    let (from, to) = (env.text(arg(args, 0))?, env.text(arg(args, 1))?);
    let text = str_of(text);
    let mut out = String::new();
    let mut last = 0;
    for (start, found) in text.match_indices(&from) {
        out.push_str(text.get(last..start).unwrap_or(""));
        let after = text.get(start + found.len()..).unwrap_or("");
        out.push_str(&replacement(&to, found, text.get(..start).unwrap_or(""), after));
        last = start + found.len();
        if out.len() > MAX_TEXT {
            return Err(super::too_long());
        }
    }
    out.push_str(text.get(last..).unwrap_or(""));
    env.string(out)
}

fn split(env: &mut Env<'_>, text: &Value, args: &[Value]) -> NativeOutcome {
    let limit = match arg(args, 1) {
        Value::Undefined => usize::MAX,
        limit => crate::number::to_int32(env.number(limit)?) as u32 as usize,
    };
    let text_of = str_of(text);
    env.spend(text_of.len())?;
    let parts: Vec<String> = match arg(args, 0) {
        Value::Undefined => vec![text_of.to_owned()],
        separator => {
            let separator = env.text(separator)?;
            if separator.is_empty() {
                text_of.encode_utf16().map(|unit| whole(&[unit])).collect::<Result<_, _>>()?
            } else {
                text_of.split(&separator).map(str::to_owned).collect()
            }
        }
    };
    let parts = parts.into_iter().take(limit).map(|part| Value::String(part.into())).collect();
    Ok(env.heap.list(parts)?)
}

fn to_lower_case(env: &mut Env<'_>, text: &Value, _: &[Value]) -> NativeOutcome {
    env.string(str_of(text).to_lowercase())
}

fn to_upper_case(env: &mut Env<'_>, text: &Value, _: &[Value]) -> NativeOutcome {
    env.string(str_of(text).to_uppercase())
}

fn trim(env: &mut Env<'_>, text: &Value, _: &[Value]) -> NativeOutcome {
    env.string(str_of(text).trim_matches(is_space).to_owned())
}

fn trim_start(env: &mut Env<'_>, text: &Value, _: &[Value]) -> NativeOutcome {
    env.string(str_of(text).trim_start_matches(is_space).to_owned())
}

fn trim_end(env: &mut Env<'_>, text: &Value, _: &[Value]) -> NativeOutcome {
    env.string(str_of(text).trim_end_matches(is_space).to_owned())
}
