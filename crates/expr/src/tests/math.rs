//! Functions of `Math` compared with those of node: the fraction of results with the same bits, and the largest difference in
//! units in the last place (ulp). `LABSPEC_BLESS=1 cargo test -p labspec-expr tests::math` evaluates 100,000 arguments of each
//! function in node and writes `docs/measured/math.md`. A few results of node are stored in `math.txt`, so that our results are
//! compared with the table on every machine.

use std::fmt::Write as _;
use std::io::Write as _;
use std::path::PathBuf;
use std::process::{Command, Stdio};

use crate::math;
use crate::needs::needs;

/// The arguments of a function: half are evenly spaced numbers, half have evenly spaced exponents.
struct Range {
    name: &'static str,
    least: f64,
    most: f64,
    /// The range of the exponent of 2.
    exponents: (f64, f64),
    /// The range of the second argument; both zero if there is none.
    second: (f64, f64),
}

const fn range(name: &'static str, least: f64, most: f64, exponents: (f64, f64)) -> Range {
    Range { name, least, most, exponents, second: (0.0, 0.0) }
}

/// All functions of `Math` of one or two numbers.
const RANGES: &[Range] = &[
    range("abs", -1e3, 1e3, (-40.0, 40.0)),
    range("acos", -1.0, 1.0, (-30.0, 0.0)),
    range("acosh", 1.0, 100.0, (0.0, 60.0)),
    range("asin", -1.0, 1.0, (-30.0, 0.0)),
    range("asinh", -100.0, 100.0, (-30.0, 60.0)),
    range("atan", -10.0, 10.0, (-30.0, 60.0)),
    Range { second: (-10.0, 10.0), ..range("atan2", -10.0, 10.0, (-30.0, 30.0)) },
    range("atanh", -1.0, 1.0, (-30.0, 0.0)),
    range("cbrt", -1e3, 1e3, (-60.0, 60.0)),
    range("ceil", -1e3, 1e3, (-10.0, 60.0)),
    range("clz32", 0.0, 4294967295.0, (0.0, 40.0)),
    range("cos", -100.0, 100.0, (-30.0, 20.0)),
    range("cosh", -20.0, 20.0, (-30.0, 9.0)),
    range("exp", -20.0, 20.0, (-30.0, 9.0)),
    range("expm1", -20.0, 20.0, (-30.0, 9.0)),
    range("floor", -1e3, 1e3, (-10.0, 60.0)),
    range("fround", -1e3, 1e3, (-60.0, 60.0)),
    Range { second: (-100.0, 100.0), ..range("hypot", -100.0, 100.0, (-30.0, 30.0)) },
    Range {
        second: (-4294967296.0, 4294967296.0),
        ..range("imul", -4294967296.0, 4294967296.0, (0.0, 40.0))
    },
    range("log", 0.0, 100.0, (-300.0, 300.0)),
    range("log10", 0.0, 100.0, (-300.0, 300.0)),
    range("log1p", -1.0, 100.0, (-30.0, 0.0)),
    range("log2", 0.0, 100.0, (-300.0, 300.0)),
    Range { second: (-100.0, 100.0), ..range("max", -100.0, 100.0, (-30.0, 30.0)) },
    Range { second: (-100.0, 100.0), ..range("min", -100.0, 100.0, (-30.0, 30.0)) },
    Range { second: (-10.0, 10.0), ..range("pow", 0.0, 100.0, (-30.0, 30.0)) },
    range("round", -1e3, 1e3, (-10.0, 60.0)),
    range("sign", -1e3, 1e3, (-40.0, 40.0)),
    range("sin", -100.0, 100.0, (-30.0, 20.0)),
    range("sinh", -20.0, 20.0, (-30.0, 9.0)),
    range("sqrt", 0.0, 1e3, (-300.0, 300.0)),
    range("tan", -100.0, 100.0, (-30.0, 20.0)),
    range("tanh", -20.0, 20.0, (-30.0, 9.0)),
    range("trunc", -1e3, 1e3, (-10.0, 60.0)),
];

/// Arguments of each function for the table, and those whose results are stored.
const MANY: usize = 100_000;
const KEPT: usize = 60;
/// The largest difference from node allowed for any function, in ulp. A larger one indicates a different function.
const FARTHEST: u64 = 4;

/// A uniform random number from 0 to 1 (SplitMix64; Steele, Lea and Flood 2014).
fn uniform(state: &mut u64) -> f64 {
    *state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
    let mut z = *state;
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
}

/// Pairs of arguments, always the same. They use only products and sums, so that they are equal on every platform.
fn arguments(range: &Range, n: usize) -> Vec<[f64; 2]> {
    let mut state = range.name.bytes().fold(7, |s: u64, b| s.wrapping_mul(31).wrapping_add(u64::from(b)));
    let mut between = |(a, b): (f64, f64)| a + (b - a) * uniform(&mut state);
    let one = |i: usize, between: &mut dyn FnMut((f64, f64)) -> f64| {
        if i.is_multiple_of(2) {
            return between((range.least, range.most));
        }
        let exponent = between(range.exponents);
        let power =
            (0..exponent.abs() as usize).fold(1.0, |p: f64, _| p * if exponent < 0.0 { 0.5 } else { 2.0 });
        let sign = if range.least < 0.0 && between((-1.0, 1.0)) < 0.0 { -1.0 } else { 1.0 };
        (sign * power * between((1.0, 2.0))).clamp(range.least.min(-0.0) - 1e300, 1e300)
    };
    let all = (0..n).map(|i| [one(i, &mut between), between(range.second)]);
    let inside = |x: f64| match range.name {
        "acos" | "asin" | "atanh" => x.abs() <= 1.0,
        "log1p" => x > -1.0,
        _ => true,
    };
    all.filter(|[x, _]| inside(*x)).collect()
}

fn labspec_result(range: &Range, [x, y]: [f64; 2]) -> f64 {
    let function = math::function(range.name).unwrap();
    if range.second == (0.0, 0.0) { function.apply(&[x]) } else { function.apply(&[x, y]) }
}

/// The results of node, which reads pairs and writes numbers, eight bytes each.
fn node(range: &Range, list: &[[f64; 2]]) -> Vec<f64> {
    let arguments = if range.second == (0.0, 0.0) { "v[2 * i]" } else { "v[2 * i], v[2 * i + 1]" };
    let script = format!(
        "const b = require('fs').readFileSync(0), v = new Float64Array(b.buffer, b.byteOffset, b.length / 8);\n\
         const r = Float64Array.from({{length: v.length / 2}}, (_, i) => Math.{}({arguments}));\n\
         require('fs').writeSync(1, process.version.padEnd(16)); \n\
         const o = Buffer.from(r.buffer); let at = 0; while (at < o.length) at += require('fs').writeSync(1, o, at);",
        range.name
    );
    let mut child = Command::new("node")
        .args(["-e", &script])
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .spawn()
        .unwrap();
    let mut input = child.stdin.take().unwrap();
    let bytes: Vec<u8> = list.iter().flatten().flat_map(|x| x.to_le_bytes()).collect();
    let writer = std::thread::spawn(move || input.write_all(&bytes));
    let output = child.wait_with_output().unwrap();
    writer.join().unwrap().unwrap();
    assert!(output.status.success());
    let numbers = output.stdout[16..].as_chunks::<8>().0;
    assert_eq!(numbers.len(), list.len());
    numbers.iter().map(|b| f64::from_le_bytes(*b)).collect()
}

/// The number of units in the last place between two numbers, or the maximum if exactly one is NaN.
fn ulps(a: f64, b: f64) -> u64 {
    if a.is_nan() || b.is_nan() {
        return if a.is_nan() && b.is_nan() { 0 } else { u64::MAX };
    }
    // Maps bits to integers in the order of the numbers; 0 and -0 are neighbours.
    let order =
        |x: f64| if x.is_sign_negative() { -1 - (x.abs().to_bits() as i64) } else { x.to_bits() as i64 };
    order(a).abs_diff(order(b))
}

/// The number of arguments, the number of results with the same bits, the largest difference and its arguments.
struct Measured {
    cases: usize,
    same: usize,
    most: u64,
    arguments: [f64; 2],
}

fn measure(range: &Range, list: &[[f64; 2]], node_results: &[f64]) -> Measured {
    let mut found = Measured { cases: list.len(), same: 0, most: 0, arguments: [f64::NAN; 2] };
    for (args, node_results) in list.iter().zip(node_results) {
        let error = ulps(labspec_result(range, *args), *node_results);
        found.same += usize::from(error == 0);
        if error > found.most {
            (found.most, found.arguments) = (error, *args);
        }
    }
    found
}

fn table(rows: &str) -> String {
    format!(
        "# Functions of `Math` compared with node\n\n\
         Arithmetic (`+ - * / %`), comparisons, conversions and texts agree with JavaScript to the last bit; a test runs random\n\
         programs in both. The JavaScript standard does not specify the last digits of `Math.sin` and similar functions, and engines\n\
         differ. labspec gives the same bits on every machine (`libm`). The table is measured against node 20 by\n\
         `crates/expr/src/tests/math.rs`: half of the arguments are evenly spread, half have evenly spread exponents. One *ulp*\n\
         is the distance to the next number, about 1.1e-16 to 2.2e-16 of the value.\n\n\
         | function | arguments | identical bits | largest difference, ulp |\n|---|---:|---:|---:|\n{rows}"
    )
}

fn place(file: &str) -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join(file)
}

/// The largest difference of each function, from the table.
fn limits() -> impl Fn(&str) -> u64 {
    let table = std::fs::read_to_string(place("../../docs/measured/math.md")).unwrap();
    let row = |line: &str| {
        let cells: Vec<&str> = line.split('|').map(str::trim).collect();
        Some((cells.get(1)?.strip_prefix('`')?.strip_suffix('`')?.to_owned(), cells.get(4)?.parse().ok()?))
    };
    let all: Vec<(String, u64)> = table.lines().filter_map(row).collect();
    move |name: &str| {
        all.iter().find(|(n, _)| n == name).unwrap_or_else(|| panic!("{name} is not in the table")).1
    }
}

/// On every machine: stored results of node differ from ours by no more than the table states.
#[test]
fn functions_are_as_near_to_nodes_as_the_table_says() {
    let limit = limits();
    let recorded = std::fs::read_to_string(place("src/tests/math.txt")).unwrap();
    let mut lines = recorded.lines();
    for range in RANGES {
        let line = lines.next().unwrap();
        let (name, values) = line.split_once(' ').unwrap();
        assert_eq!(name, range.name);
        let node_results: Vec<f64> =
            values.split(' ').map(|w| f64::from_bits(u64::from_str_radix(w, 16).unwrap())).collect();
        let list = arguments(range, KEPT);
        assert_eq!(node_results.len(), list.len());
        let found = measure(range, &list, &node_results);
        assert!(limit(name) <= FARTHEST, "{name}: {} ulp in the table", limit(name));
        assert!(
            found.most <= limit(name),
            "Math.{name}{:?}: {} ulp from node's",
            found.arguments,
            found.most
        );
    }
}

/// With node: the table contains the measured values.
#[test]
fn the_table_equals_the_measured_differences_to_node() {
    if !needs("node") {
        return;
    }
    let bless = std::env::var_os("LABSPEC_BLESS").is_some();
    let (mut rows, mut recorded) = (String::new(), String::new());
    let limit = (!bless).then(limits);
    for range in RANGES {
        let list = arguments(range, if bless { MANY } else { MANY / 10 });
        let node_results = node(range, &list);
        let found = measure(range, &list, &node_results);
        let share = 100.0 * found.same as f64 / found.cases as f64;
        // Rounded down, so that 100 % means all.
        let share = if found.same == found.cases {
            "100 %".into()
        } else {
            format!("{:.2} %", (share * 100.0).floor() / 100.0)
        };
        let _ = writeln!(rows, "| `{}` | {} | {share} | {} |", range.name, found.cases, found.most);
        let few = if bless { node(range, &arguments(range, KEPT)) } else { Vec::new() };
        let few: Vec<String> = few.iter().map(|x| format!("{:x}", x.to_bits())).collect();
        let _ = writeln!(recorded, "{} {}", range.name, few.join(" "));
        if let Some(limit) = &limit {
            let (name, most) = (range.name, found.most);
            assert!(most <= limit(name), "Math.{name}{:?}: {most} ulp from node's", found.arguments);
        }
    }
    if bless {
        std::fs::write(place("../../docs/measured/math.md"), table(&rows)).unwrap();
        std::fs::write(place("src/tests/math.txt"), recorded).unwrap();
    }
}
