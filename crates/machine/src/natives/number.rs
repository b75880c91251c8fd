//! Methods of numbers, and functions that create numbers, strings and booleans (ECMAScript, "Number Objects",
//! "parseFloat", "parseInt").

use super::env::{Env, NativeError, arg, integer};
use super::native::{Native, NativeOutcome, table};
use crate::number;
use crate::rules;
use crate::value::Value;

pub(super) static ROWS: &[Native] = table! {
    "toExponential" Number (0, 1) String Looks to_exponential_method: "(1234).toExponential(1)" => "1.2e+3",
        "in exponential form with this many decimals";
    "toFixed" Number (0, 1) String Looks to_fixed_method: "(2.345).toFixed(1)" => "2.3",
        "with this many decimals";
    "toPrecision" Number (0, 1) String Looks to_precision_method: "(1234.5).toPrecision(2)" => "1.2e+3",
        "with this many significant digits";
    "toString" Number (0, 1) String Looks to_string_method: "(255).toString(16)" => "ff",
        "as text, in base 10 or another base";
    "Number" Nothing (0, 1) Number Looks number: "Number('12') + 1" => "13",
        "converts a value to a number";
    "Number.isFinite" Nothing (1, 1) Boolean Asks is_finite: "Number.isFinite('1')" => "false",
        "whether a value is a number and finite";
    "Number.isInteger" Nothing (1, 1) Boolean Looks is_integer: "Number.isInteger(2)" => "true",
        "whether a value is an integer";
    "Number.isNaN" Nothing (1, 1) Boolean Asks is_nan: "Number.isNaN('a')" => "false",
        "whether a value is NaN";
    "Number.parseFloat" Nothing (1, 1) Number Looks parse_float: "Number.parseFloat('1.5 m')" => "1.5",
        "the number at the start of a text";
    "Number.parseInt" Nothing (1, 2) Number Looks parse_int: "Number.parseInt('12px')" => "12",
        "the integer at the start of a text";
    "parseFloat" Nothing (1, 1) Number Looks parse_float: "parseFloat('1.5 m')" => "1.5",
        "the number at the start of a text";
    "parseInt" Nothing (1, 2) Number Looks parse_int: "parseInt('ff', 16)" => "255",
        "the integer at the start of a text, in base 10 or another base";
    "String" Nothing (0, 1) String Looks string: "String([1, 2])" => "1,2",
        "converts a value to a text";
    "Boolean" Nothing (0, 1) Boolean Looks boolean: "Boolean('')" => "false",
        "converts a value to true or false";
};

/// The constants of `Number`.
pub const NUMBER_CONSTANTS: &[(&str, f64)] = &[
    ("EPSILON", f64::EPSILON),
    ("MAX_SAFE_INTEGER", 9007199254740991.0),
    ("MAX_VALUE", f64::MAX),
    ("MIN_SAFE_INTEGER", -9007199254740991.0),
    ("MIN_VALUE", 5e-324),
    ("NEGATIVE_INFINITY", f64::NEG_INFINITY),
    ("NaN", f64::NAN),
    ("POSITIVE_INFINITY", f64::INFINITY),
];

/// The number on which a method is called.
fn this_number(value: &Value) -> f64 {
    value.to_number()
}

/// An argument that is a number of digits, from `least` to 100.
fn digits(env: &mut Env<'_>, args: &[Value], least: f64) -> Result<Option<usize>, NativeError> {
    if *arg(args, 0) == Value::Undefined {
        return Ok(None);
    }
    let x = integer(env.number(arg(args, 0))?);
    if !(least..=100.0).contains(&x) {
        let message = format!("{x} digits are not allowed: the range is {least} to 100");
        return Err(NativeError::new(rules::ARGUMENT_TYPE, message));
    }
    Ok(Some(x as usize))
}

/// The number of binary places after the point of a finite number.
fn fraction_bits(x: f64) -> i64 {
    let bits = x.to_bits();
    let exponent = (bits >> 52 & 0x7ff) as i64;
    let mantissa = bits & ((1 << 52) - 1);
    let (mantissa, exponent) =
        if exponent == 0 { (mantissa, -1074) } else { (mantissa | 1 << 52, exponent - 1075) };
    if mantissa == 0 { 0 } else { (-exponent - i64::from(mantissa.trailing_zeros())).max(0) }
}

/// JavaScript's `x.toFixed(digits)`: the exact value rounded, ties away from zero.
pub fn to_fixed(x: f64, digits: usize) -> String {
    if !x.is_finite() || x.abs() >= 1e21 {
        return number::to_text(x);
    }
    let sign = if x < 0.0 { "-" } else { "" };
    let x = x.abs();
    // A number with k binary places has k decimal places, the last of which is 5. So rounding to k - 1 digits is a tie.
    if fraction_bits(x) != digits as i64 + 1 {
        return format!("{sign}{x:.digits$}");
    }
    let exact = format!("{x:.*}", digits + 1);
    format!("{sign}{}", without_last(&exact))
}

/// A decimal number without its last digit 5, rounded up.
fn without_last(exact: &str) -> String {
    let trimmed = exact.strip_suffix('5').unwrap_or(exact);
    let mut out: Vec<char> = trimmed.strip_suffix('.').unwrap_or(trimmed).chars().collect();
    for c in out.iter_mut().rev() {
        match c {
            '9' => *c = '0',
            '.' => {}
            c => {
                *c = char::from_digit(c.to_digit(10).unwrap_or(0) + 1, 10).unwrap_or('0');
                return out.into_iter().collect();
            }
        }
    }
    out.insert(0, '1');
    out.into_iter().collect()
}

/// The mantissa with this number of decimals, and the exponent; ties are rounded away from zero.
fn scientific(x: f64, digits: usize) -> (String, i32) {
    let x = x.abs();
    let longer = format!("{x:.*e}", digits + 1);
    let (mantissa, exponent) = longer.split_once('e').unwrap_or((&longer, "0"));
    let exponent = exponent.parse().unwrap_or(0);
    // 800 digits represent every double exactly.
    let tie = mantissa.ends_with('5')
        && format!("{x:.800e}")
            .split('e')
            .next()
            .and_then(|m| m.strip_prefix(mantissa))
            .is_some_and(|rest| rest.bytes().all(|b| b == b'0'));
    if tie {
        let rounded = without_last(mantissa);
        // 9.95 becomes 10.0, which is 1.00 with the next exponent.
        return match rounded.strip_prefix("10") {
            Some(rest) if digits == 0 || rest.starts_with('.') => {
                let zeros = "0".repeat(digits);
                (if digits == 0 { "1".into() } else { format!("1.{zeros}") }, exponent + 1)
            }
            _ => (rounded, exponent),
        };
    }
    let text = format!("{x:.digits$e}");
    let (mantissa, exponent) = text.split_once('e').unwrap_or((&text, "0"));
    (mantissa.to_owned(), exponent.parse().unwrap_or(0))
}

fn exponential(sign: &str, mantissa: &str, exponent: i32) -> String {
    let e = if exponent < 0 { '-' } else { '+' };
    format!("{sign}{mantissa}e{e}{}", exponent.abs())
}

fn to_fixed_method(env: &mut Env<'_>, x: &Value, args: &[Value]) -> NativeOutcome {
    let digits = digits(env, args, 0.0)?.unwrap_or(0);
    env.string(to_fixed(this_number(x), digits))
}

fn to_exponential_method(env: &mut Env<'_>, x: &Value, args: &[Value]) -> NativeOutcome {
    let x = this_number(x);
    if !x.is_finite() {
        return env.string(number::to_text(x));
    }
    let digits = digits(env, args, 0.0)?;
    let sign = if x < 0.0 { "-" } else { "" };
    let (mantissa, exponent) = match digits {
        Some(digits) => scientific(x, digits),
        None => {
            let text = format!("{:e}", x.abs());
            let (mantissa, exponent) = text.split_once('e').unwrap_or((&text, "0"));
            (mantissa.to_owned(), exponent.parse().unwrap_or(0))
        }
    };
    env.string(exponential(sign, &mantissa, exponent))
}

fn to_precision_method(env: &mut Env<'_>, x: &Value, args: &[Value]) -> NativeOutcome {
    let x = this_number(x);
    if !x.is_finite() {
        return env.string(number::to_text(x));
    }
    let Some(precision) = digits(env, args, 1.0)? else { return env.string(number::to_text(x)) };
    let sign = if x < 0.0 { "-" } else { "" };
    let (mantissa, exponent) = scientific(x, precision - 1);
    if exponent < -6 || exponent >= precision as i32 {
        return env.string(exponential(sign, &mantissa, exponent));
    }
    let digits: String = mantissa.chars().filter(|c| *c != '.').collect();
    let text = if exponent < 0 {
        format!("0.{}{digits}", "0".repeat((-exponent - 1) as usize))
    } else {
        let (whole, fraction) = digits.split_at((exponent as usize + 1).min(digits.len()));
        if fraction.is_empty() { whole.to_owned() } else { format!("{whole}.{fraction}") }
    };
    env.string(format!("{sign}{text}"))
}

fn to_string_method(env: &mut Env<'_>, x: &Value, args: &[Value]) -> NativeOutcome {
    let radix = match arg(args, 0) {
        Value::Undefined => 10.0,
        radix => integer(env.number(radix)?),
    };
    if !(2.0..=36.0).contains(&radix) {
        let message = format!("base {} is not allowed: the range is 2 to 36", number::to_text(radix));
        return Err(NativeError::new(rules::ARGUMENT_TYPE, message));
    }
    let x = this_number(x);
    if radix == 10.0 || !x.is_finite() {
        return env.string(number::to_text(x));
    }
    let sign = if x < 0.0 { "-" } else { "" };
    let (fraction, carries) = fraction_in(x.abs(), radix);
    let whole = whole_in(x.abs().trunc() + if carries { 1.0 } else { 0.0 }, radix);
    env.string(format!("{sign}{whole}{fraction}"))
}

fn digit_in(digit: f64, radix: f64) -> char {
    char::from_digit(digit as u32, radix as u32).unwrap_or('0')
}

/// An integer in another base. Digits beyond the precision of a double are zeros. The standard leaves open which digits these
/// are; they are the same as in node.
fn whole_in(x: f64, radix: f64) -> String {
    let (mut rest, mut digits) = (x, Vec::new());
    while rest / radix >= 9007199254740992.0 {
        rest /= radix;
        digits.push('0');
    }
    loop {
        let digit = rest % radix;
        digits.push(digit_in(digit, radix));
        rest = (rest - digit) / radix;
        if rest <= 0.0 {
            return digits.iter().rev().collect();
        }
    }
}

/// The fraction of a number in another base, such as `.1`: the fewest digits that identify the number (G. L. Steele and J. L.
/// White 1990, fixed-point fractions). The flag states whether it rounds up to the next integer.
fn fraction_in(x: f64, radix: f64) -> (String, bool) {
    let (mut rest, mut digits) = (x.fract(), Vec::new());
    let mut unsure = 0.5 * (x.next_up() - x);
    unsure = unsure.max(0f64.next_up());
    if rest < unsure {
        return (String::new(), false);
    }
    while rest >= unsure {
        (rest, unsure) = (rest * radix, unsure * radix);
        let digit = rest.floor();
        digits.push(digit);
        rest -= digit;
        if (rest > 0.5 || rest == 0.5 && digit % 2.0 == 1.0) && rest + unsure > 1.0 {
            // Rounds up, with a carry to the left as long as a digit has the maximum value.
            while let Some(last) = digits.pop() {
                if last + 1.0 < radix {
                    digits.push(last + 1.0);
                    break;
                }
            }
            break;
        }
    }
    if digits.is_empty() {
        return (String::new(), true);
    }
    let text: String = digits.iter().map(|d| digit_in(*d, radix)).collect();
    (format!(".{text}"), false)
}

fn number(env: &mut Env<'_>, _: &Value, args: &[Value]) -> NativeOutcome {
    Ok(Value::Number(match args.first() {
        Some(value) => env.number(value)?,
        None => 0.0,
    }))
}

fn string(env: &mut Env<'_>, _: &Value, args: &[Value]) -> NativeOutcome {
    match args.first() {
        Some(value) => {
            let text = env.text(value)?;
            env.string(text)
        }
        None => Ok(Value::from("")),
    }
}

fn boolean(_: &mut Env<'_>, _: &Value, args: &[Value]) -> NativeOutcome {
    Ok(Value::Boolean(arg(args, 0).truthy()))
}

fn is_finite(_: &mut Env<'_>, _: &Value, args: &[Value]) -> NativeOutcome {
    Ok(Value::Boolean(matches!(arg(args, 0), Value::Number(x) if x.is_finite())))
}

fn is_integer(_: &mut Env<'_>, _: &Value, args: &[Value]) -> NativeOutcome {
    Ok(Value::Boolean(matches!(arg(args, 0), Value::Number(x) if x.is_finite() && x.fract() == 0.0)))
}

fn is_nan(_: &mut Env<'_>, _: &Value, args: &[Value]) -> NativeOutcome {
    Ok(Value::Boolean(matches!(arg(args, 0), Value::Number(x) if x.is_nan())))
}

fn parse_float(env: &mut Env<'_>, _: &Value, args: &[Value]) -> NativeOutcome {
    let text = env.text(arg(args, 0))?;
    let text = text.trim_start_matches(number::is_space);
    let unsigned = text.strip_prefix(['-', '+']).unwrap_or(text);
    if unsigned.starts_with("Infinity") {
        return Ok(Value::Number(if text.starts_with('-') { f64::NEG_INFINITY } else { f64::INFINITY }));
    }
    // The longest prefix that is a decimal number.
    let (mut point, mut exponent, mut digit) = (false, false, false);
    let mut end = 0;
    let mut before = ' ';
    for (i, c) in text.char_indices() {
        match c {
            '0'..='9' => digit = true,
            '+' | '-' if i == 0 || matches!(before, 'e' | 'E') => {}
            '.' if !point && !exponent => point = true,
            'e' | 'E' if digit && !exponent => exponent = true,
            _ => break,
        }
        before = c;
        if digit && (c.is_ascii_digit() || c == '.') {
            end = i + 1;
        }
    }
    Ok(Value::Number(text.get(..end).and_then(|t| t.parse().ok()).unwrap_or(f64::NAN)))
}

fn parse_int(env: &mut Env<'_>, _: &Value, args: &[Value]) -> NativeOutcome {
    let text = env.text(arg(args, 0))?;
    let text = text.trim_start_matches(number::is_space);
    let (sign, text) = match text.strip_prefix('-') {
        Some(rest) => (-1.0, rest),
        None => (1.0, text.strip_prefix('+').unwrap_or(text)),
    };
    let mut radix = number::to_int32(env.number(arg(args, 1))?);
    let prefixed = text.strip_prefix("0x").or_else(|| text.strip_prefix("0X"));
    let text = match prefixed {
        Some(rest) if radix == 0 || radix == 16 => {
            radix = 16;
            rest
        }
        _ => text,
    };
    let radix = if radix == 0 { 10 } else { radix };
    if !(2..=36).contains(&radix) {
        return Ok(Value::Number(f64::NAN));
    }
    let length = text.find(|c: char| !c.is_digit(radix as u32)).unwrap_or(text.len());
    let digits = text.get(..length).unwrap_or("");
    let x = match radix {
        _ if digits.is_empty() => f64::NAN,
        10 => digits.parse().unwrap_or(f64::NAN),
        2 | 4 | 8 | 16 | 32 => number::from_digits(digits, radix as u32).unwrap_or(f64::NAN),
        _ => digits
            .chars()
            .fold(0.0, |x, c| x * f64::from(radix) + f64::from(c.to_digit(radix as u32).unwrap_or(0))),
    };
    Ok(Value::Number(sign * x))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ties_go_away_from_zero() {
        for (x, digits, text) in [
            (0.5, 0, "1"),
            (1.5, 0, "2"),
            (2.5, 0, "3"),
            (-2.5, 0, "-3"),
            (1.005, 2, "1.00"),
            (1.25, 1, "1.3"),
            (1.35, 1, "1.4"),
            (0.0, 2, "0.00"),
            (-0.0, 1, "0.0"),
            (-109.00000000000182, 38, "-109.00000000000181898940354585647583007813"),
            (99.5, 0, "100"),
            (9.96875, 4, "9.9688"),
            (-1e-9, 2, "-0.00"),
            (1e21, 2, "1e+21"),
            (f64::NAN, 1, "NaN"),
        ] {
            assert_eq!(to_fixed(x, digits), text, "{x} {digits}");
        }
    }
}
