//! The `Math` object and the global number functions, as ECMAScript defines them ("Function Properties of the
//! Math Object"). Transcendental functions come from `libm`, so that every platform gives the same bits.

use labspec_finding::DESCRIBED;

/// The maximum number of arguments of a function in a formula.
pub const FEW: usize = 16;

/// A function of `Math`, or one of the global functions on numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct MathFunction(u8);

/// A row: name, smallest and largest number of arguments that make sense, and the function.
struct MathRow {
    name: &'static str,
    least: usize,
    most: Option<usize>,
    apply: MathEvaluation,
}

/// The implementation of a function, by how it takes its arguments.
#[derive(Clone, Copy)]
pub(crate) enum MathEvaluation {
    One(fn(f64) -> f64),
    Two(fn(f64, f64) -> f64),
    Many(fn(&[f64]) -> f64),
}

const fn one(name: &'static str, f: fn(f64) -> f64) -> MathRow {
    MathRow { name, least: 1, most: Some(1), apply: MathEvaluation::One(f) }
}

const fn two(name: &'static str, f: fn(f64, f64) -> f64) -> MathRow {
    MathRow { name, least: 2, most: Some(2), apply: MathEvaluation::Two(f) }
}

const fn many(name: &'static str, f: fn(&[f64]) -> f64) -> MathRow {
    MathRow { name, least: 0, most: None, apply: MathEvaluation::Many(f) }
}

const MATH: &[MathRow] = &[
    one("abs", f64::abs),
    one("acos", libm::acos),
    one("acosh", libm::acosh),
    one("asin", libm::asin),
    one("asinh", libm::asinh),
    one("atan", libm::atan),
    two("atan2", atan2),
    one("atanh", libm::atanh),
    one("cbrt", libm::cbrt),
    one("ceil", f64::ceil),
    one("clz32", |x| f64::from((crate::number::to_int32(x) as u32).leading_zeros())),
    one("cos", libm::cos),
    one("cosh", libm::cosh),
    one("exp", exp),
    one("expm1", libm::expm1),
    one("floor", f64::floor),
    one("fround", |x| f64::from(x as f32)),
    many("hypot", hypot),
    two("imul", |a, b| f64::from(crate::number::to_int32(a).wrapping_mul(crate::number::to_int32(b)))),
    one("log", libm::log),
    one("log10", libm::log10),
    one("log1p", libm::log1p),
    one("log2", libm::log2),
    many("max", max),
    many("min", min),
    two("pow", pow),
    one("round", round),
    one("sign", sign),
    one("sin", libm::sin),
    one("sinh", libm::sinh),
    one("sqrt", f64::sqrt),
    one("tan", libm::tan),
    one("tanh", libm::tanh),
    one("trunc", f64::trunc),
    // Global functions with a boolean result.
    one("isFinite", |x| f64::from(u8::from(x.is_finite()))),
    one("isNaN", |x| f64::from(u8::from(x.is_nan()))),
];

/// The name, the result in words, and an example with its value.
type Doc = (&'static str, &'static str, (&'static str, &'static str));

/// The documentation of the functions, for help and the reference.
pub const DOCS: &[Doc] = &[
    ("abs", "magnitude", ("Math.abs(-2)", "2")),
    ("acos", "angle in rad from 0 to π whose cosine is x", ("Math.acos(-1)", "3.141592653589793")),
    ("acosh", "inverse of the hyperbolic cosine", ("Math.acosh(1)", "0")),
    ("asin", "angle in rad from -π/2 to π/2 whose sine is x", ("Math.asin(1)", "1.5707963267948966")),
    ("asinh", "inverse of the hyperbolic sine", ("Math.asinh(0)", "0")),
    ("atan", "angle in rad from -π/2 to π/2 whose tangent is x", ("Math.atan(1)", "0.7853981633974483")),
    (
        "atan2",
        "atan2(y, x): angle in rad from -π to π of the point (x, y)",
        ("Math.atan2(1, -1)", "2.356194490192345"),
    ),
    ("atanh", "inverse of the hyperbolic tangent", ("Math.atanh(0)", "0")),
    ("cbrt", "cube root", ("Math.cbrt(27)", "3")),
    ("ceil", "smallest integer that is not less than x", ("Math.ceil(1.2)", "2")),
    ("clz32", "leading zero bits of an integer of 32 bits", ("Math.clz32(1)", "31")),
    ("cos", "cosine of an angle in rad", ("Math.cos(Math.PI)", "-1")),
    ("cosh", "hyperbolic cosine", ("Math.cosh(0)", "1")),
    ("exp", "e to the power of x", ("Math.exp(1)", "2.718281828459045")),
    ("expm1", "exp(x) - 1, exact for small x", ("Math.expm1(1e-20)", "1e-20")),
    ("floor", "largest integer that is not greater than x", ("Math.floor(-1.2)", "-2")),
    ("fround", "nearest number of single precision", ("Math.fround(0.1)", "0.10000000149011612")),
    ("hypot", "root of the sum of squares", ("Math.hypot(2, 3, 6)", "7")),
    ("imul", "product of two integers of 32 bits", ("Math.imul(2 ** 16 + 1, 2 ** 16)", "65536")),
    ("log", "natural logarithm", ("Math.log(Math.E)", "1")),
    ("log10", "logarithm to base 10", ("Math.log10(1000)", "3")),
    ("log1p", "log(1 + x), exact for small x", ("Math.log1p(1e-20)", "1e-20")),
    ("log2", "logarithm to base 2", ("Math.log2(8)", "3")),
    ("max", "largest argument; NaN if any is NaN", ("Math.max(1, 3, 2)", "3")),
    ("min", "smallest argument; NaN if any is NaN", ("Math.min(1, NaN)", "NaN")),
    ("pow", "pow(x, y): x to the power of y", ("Math.pow(2, 10)", "1024")),
    ("round", "nearest integer; halves round up", ("Math.round(-2.5)", "-2")),
    ("sign", "1, 0 or -1", ("Math.sign(-9.81)", "-1")),
    ("sin", "sine of an angle in rad", ("Math.sin(Math.PI / 2)", "1")),
    ("sinh", "hyperbolic sine", ("Math.sinh(0)", "0")),
    ("sqrt", "square root", ("Math.sqrt(2)", "1.4142135623730951")),
    ("tan", "tangent of an angle in rad", ("Math.tan(Math.PI / 4).toFixed(3)", "1.000")),
    ("tanh", "hyperbolic tangent", ("Math.tanh(Infinity)", "1")),
    ("trunc", "integer part", ("Math.trunc(-1.7)", "-1")),
    ("isFinite", "whether a number is neither infinite nor NaN", ("isFinite(1 / 0)", "false")),
    ("isNaN", "whether a number is NaN", ("isNaN(0 / 0)", "true")),
];

/// How many rows at the end of [`MATH`] are global names instead of members of `Math`.
const GLOBALS: usize = 2;

/// Constants of `Math`.
const CONSTANTS: &[(&str, f64)] = &[
    ("E", std::f64::consts::E),
    ("LN10", std::f64::consts::LN_10),
    ("LN2", std::f64::consts::LN_2),
    ("LOG10E", std::f64::consts::LOG10_E),
    ("LOG2E", std::f64::consts::LOG2_E),
    ("PI", std::f64::consts::PI),
    ("SQRT1_2", std::f64::consts::FRAC_1_SQRT_2),
    ("SQRT2", std::f64::consts::SQRT_2),
];

/// The function `Math.name`.
pub fn function(name: &str) -> Option<MathFunction> {
    let members = MATH.len() - GLOBALS;
    MATH.iter().take(members).position(|row| row.name == name).map(|i| MathFunction(i as u8))
}

/// The global function `name`.
pub fn global(name: &str) -> Option<MathFunction> {
    let members = MATH.len() - GLOBALS;
    MATH.iter().skip(members).position(|row| row.name == name).map(|i| MathFunction((members + i) as u8))
}

/// The constant `Math.name`.
pub fn constant(name: &str) -> Option<f64> {
    CONSTANTS.iter().find(|(n, _)| *n == name).map(|(_, x)| *x)
}

/// All members of `Math`.
pub fn names() -> impl Iterator<Item = &'static str> {
    let members = MATH.len() - GLOBALS;
    MATH.iter().take(members).map(|row| row.name).chain(CONSTANTS.iter().map(|(name, _)| *name))
}

impl MathFunction {
    fn row(self) -> &'static MathRow {
        &MATH[usize::from(self.0)]
    }

    /// The function as it is written, with `Math.` if it is a member.
    pub fn path(self) -> String {
        let name = self.row().name;
        if self.gives_boolean() { name.into() } else { format!("Math.{name}") }
    }

    /// The name without `Math.`.
    pub fn name(self) -> &'static str {
        self.row().name
    }

    /// The documentation of its result, empty in a build without descriptions ([`labspec_finding::docs`]).
    pub fn doc(self) -> &'static str {
        if !DESCRIBED {
            return "";
        }
        DOCS.iter().find(|(name, ..)| *name == self.row().name).map_or("", |(_, doc, _)| doc)
    }

    /// Whether the result is a boolean.
    pub fn gives_boolean(self) -> bool {
        usize::from(self.0) >= MATH.len() - GLOBALS
    }

    /// The smallest and the largest number of arguments that make sense.
    pub fn arity(self) -> (usize, Option<usize>) {
        (self.row().least, self.row().most)
    }

    /// The implementation.
    pub(crate) fn apply_by(self) -> MathEvaluation {
        self.row().apply
    }

    /// Evaluates the function. A missing argument is `undefined`, hence NaN.
    #[inline]
    pub fn apply(self, args: &[f64]) -> f64 {
        let arg = |i: usize| args.get(i).copied().unwrap_or(f64::NAN);
        match self.row().apply {
            MathEvaluation::One(f) => f(arg(0)),
            MathEvaluation::Two(f) => f(arg(0), arg(1)),
            MathEvaluation::Many(f) => f(args),
        }
    }
}

/// `Math.atan2`. If |y| exceeds |x| by a factor of more than 2^60, the result of `libm` differs by half a unit in the last
/// place depending on the sign of x. JavaScript engines return the number nearest to ±π/2 there.
fn atan2(y: f64, x: f64) -> f64 {
    let exponent = |v: f64| (v.to_bits() >> 52 & 0x7ff) as i32;
    let beyond = x != 0.0 && exponent(y) - exponent(x) > 60 && !x.is_nan() && !y.is_nan();
    if beyond { std::f64::consts::FRAC_PI_2.copysign(y) } else { libm::atan2(y, x) }
}

/// `**` and `Math.pow`: IEEE's pow, except that a NaN exponent and (±1) ** ±Infinity give NaN.
pub(crate) fn pow(base: f64, exponent: f64) -> f64 {
    // The most frequent power. It is exact: every engine rounds the product once.
    if exponent == 2.0 {
        return base * base;
    }
    if exponent.is_nan() || (exponent.is_infinite() && base.abs() == 1.0) {
        return f64::NAN;
    }
    libm::pow(base, exponent)
}

/// The exponential function. For 1 it is `Math.E` in every engine, where libm differs in the last bit.
fn exp(x: f64) -> f64 {
    if x == 1.0 { std::f64::consts::E } else { libm::exp(x) }
}

/// The nearest integer, ties towards +Infinity; keeps the sign of zero.
fn round(x: f64) -> f64 {
    let below = x.floor();
    // `floor(x + 0.5)` would be wrong: the sum rounds 0.49999999999999994 up.
    let nearest = if x - below >= 0.5 { below + 1.0 } else { below };
    nearest.copysign(x)
}

fn sign(x: f64) -> f64 {
    if x.is_nan() || x == 0.0 { x } else { 1f64.copysign(x) }
}

/// The largest argument. NaN if any argument is NaN; 0 is larger than -0.
fn max(args: &[f64]) -> f64 {
    args.iter().fold(f64::NEG_INFINITY, |a, &b| match a.partial_cmp(&b) {
        None => f64::NAN,
        Some(std::cmp::Ordering::Less) => b,
        Some(std::cmp::Ordering::Equal) if a.is_sign_negative() => b,
        _ => a,
    })
}

/// The smallest argument. NaN if any argument is NaN; -0 is smaller than 0.
fn min(args: &[f64]) -> f64 {
    args.iter().fold(f64::INFINITY, |a, &b| match a.partial_cmp(&b) {
        None => f64::NAN,
        Some(std::cmp::Ordering::Greater) => b,
        Some(std::cmp::Ordering::Equal) if b.is_sign_negative() => b,
        _ => a,
    })
}

/// `Math.hypot`: the square root of the sum of squares, scaled by the largest argument to avoid overflow, and summed with
/// Kahan's compensation, as engines do. If any argument is infinite, the result is infinite, even if another one is NaN.
pub fn hypot(args: &[f64]) -> f64 {
    if args.iter().any(|x| x.is_infinite()) {
        return f64::INFINITY;
    }
    if args.iter().any(|x| x.is_nan()) {
        return f64::NAN;
    }
    let largest = args.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
    if largest == 0.0 {
        return 0.0;
    }
    let (mut sum, mut compensation) = (0.0, 0.0);
    for x in args {
        let scaled = x / largest;
        let term = scaled * scaled - compensation;
        let next = sum + term;
        compensation = (next - sum) - term;
        sum = next;
    }
    sum.sqrt() * largest
}

#[cfg(test)]
mod tests {
    use super::*;

    fn call(name: &str, args: &[f64]) -> f64 {
        function(name).unwrap().apply(args)
    }

    /// The same double: equal bits, or both NaN.
    fn same(a: f64, b: f64) -> bool {
        a.to_bits() == b.to_bits() || a.is_nan() && b.is_nan()
    }

    #[test]
    fn corners_of_the_standard() {
        const NAN: f64 = f64::NAN;
        const INF: f64 = f64::INFINITY;
        for (name, args, result) in [
            ("round", &[-2.5][..], -2.0),
            ("round", &[2.5], 3.0),
            ("round", &[-0.5], -0.0),
            ("round", &[-0.2], -0.0),
            ("round", &[0.49999999999999994], 0.0),
            ("round", &[4503599627370497.0], 4503599627370497.0),
            ("round", &[-INF], -INF),
            ("round", &[NAN], NAN),
            ("max", &[], -INF),
            ("min", &[], INF),
            ("max", &[NAN, 1.0], NAN),
            ("max", &[1.0, NAN], NAN),
            ("max", &[-0.0, 0.0], 0.0),
            ("max", &[0.0, -0.0], 0.0),
            ("min", &[0.0, -0.0], -0.0),
            ("min", &[-0.0, 0.0], -0.0),
            ("sign", &[-0.0], -0.0),
            ("sign", &[-7.0], -1.0),
            ("sign", &[NAN], NAN),
            ("pow", &[1.0, NAN], NAN),
            ("pow", &[-1.0, INF], NAN),
            ("pow", &[NAN, 0.0], 1.0),
            ("hypot", &[], 0.0),
            ("hypot", &[3.0, 4.0], 5.0),
            ("hypot", &[NAN, -INF], INF),
            ("hypot", &[NAN, 1.0], NAN),
            ("hypot", &[NAN, 0.0], NAN),
            ("hypot", &[1e300, 1e300], 1.4142135623730952e300),
            ("hypot", &[-0.0], 0.0),
            ("atan2", &[0.0, -0.0], std::f64::consts::PI),
            ("atan2", &[1e21, -113.0], std::f64::consts::FRAC_PI_2),
            ("fround", &[5.5], 5.5),
            ("fround", &[5.05], 5.050000190734863),
            ("trunc", &[-0.9], -0.0),
            ("cbrt", &[27.0], 3.0),
            ("log2", &[8.0], 3.0),
            ("expm1", &[0.0], 0.0),
            ("clz32", &[1.0], 31.0),
            ("imul", &[4294967295.0, 5.0], -5.0),
            ("abs", &[], NAN),
        ] {
            let got = call(name, args);
            assert!(same(got, result), "Math.{name}({args:?}) = {got}, not {result}");
        }
    }

    #[test]
    fn every_name_is_found() {
        assert!(names().all(|n| function(n).is_some() || constant(n).is_some()));
        assert!(function("isNaN").is_none() && global("isNaN").is_some());
    }
}
