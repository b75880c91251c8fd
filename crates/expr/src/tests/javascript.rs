//! Random programs compared with JavaScript: node evaluates the same text, and all bits must agree.

use std::io::Write;
use std::process::{Command, Stdio};

use proptest::prelude::*;
use proptest::strategy::ValueTree;
use proptest::test_runner::{Config, RngAlgorithm, TestRng, TestRunner};

use crate::Value;
use crate::mock::evaluate;
use crate::needs::needs;

const PROGRAMS: usize = 1500;

/// Functions whose result the standard defines exactly. Others may differ by a rounding.
const EXACT: [&str; 13] = [
    "abs", "ceil", "floor", "fround", "max", "min", "round", "sign", "sqrt", "trunc", "clz32", "imul",
    "hypot",
];

const OPERATORS: [&str; 21] = [
    "+", "-", "*", "/", "%", "&", "|", "^", "<<", ">>", ">>>", "<", "<=", ">", ">=", "==", "!=", "===",
    "!==", "&&", "||",
];

fn program() -> impl Strategy<Value = String> {
    let leaf = prop::sample::select(vec![
        "0",
        "1",
        "2.5",
        "0.1",
        "1e21",
        "1e-7",
        "123456789",
        "4294967296",
        "(-0)",
        "(-2.5)",
        "NaN",
        "Infinity",
        "true",
        "false",
        "null",
        "undefined",
        "''",
        "'a'",
        "'10'",
        "' 9 '",
        "'-0'",
        "'0x1f'",
        "'1e3'",
        "'é'",
        "data.time",
        "data.qpos[2]",
        "data.qpos[data.time + 20]",
        "ctx.none",
        "data.qpos.length",
        "Math.PI",
    ])
    .prop_map(str::to_owned);
    leaf.prop_recursive(5, 40, 3, |inner| {
        let two = (inner.clone(), inner.clone());
        prop_oneof![
            4 => (two.clone(), prop::sample::select(OPERATORS.to_vec())).prop_map(|((a, b), op)| format!("({a} {op} {b})")),
            1 => (inner.clone(), two.clone()).prop_map(|(t, (a, b))| format!("({t} ? {a} : {b})")),
            1 => (prop::sample::select(vec!["-", "+", "!", "~"]), inner.clone()).prop_map(|(op, a)| format!("({op}{a})")),
            1 => (prop::sample::select(EXACT.to_vec()), two).prop_map(|(name, (a, b))| {
                let one = matches!(name, "max" | "min" | "imul" | "hypot");
                if one { format!("Math.{name}({a}, {b})") } else { format!("Math.{name}({a})") }
            }),
            1 => inner.prop_map(|a| format!("isNaN({a})")),
        ]
    })
}

/// The value as text that contains all bits.
fn encode(value: &Value) -> String {
    match value {
        Value::Number(x) if x.is_nan() => "number NaN".into(),
        Value::Number(x) => format!("number {:016x}", x.to_bits()),
        Value::String(s) => format!("string {}", s.bytes().map(|b| format!("{b:02x}")).collect::<String>()),
        other => other.to_string(),
    }
}

const PRELUDE: &str = r"
const data = {time: 0, qpos: Float64Array.from({length: 14}, (_, i) => 100 + i)}, ctx = {};
const view = new DataView(new ArrayBuffer(8));
function show(v) {
  if (typeof v === 'string') return 'string ' + Buffer.from(v, 'utf8').toString('hex');
  if (typeof v !== 'number') return String(v);
  if (v !== v) return 'number NaN';
  view.setFloat64(0, v);
  return 'number ' + view.getBigUint64(0).toString(16).padStart(16, '0');
}
";

/// The values that node computes.
fn node(sources: &[String]) -> Vec<String> {
    let mut script = PRELUDE.to_owned();
    for source in sources {
        script += &format!("console.log(show({source}));\n");
    }
    let mut child = Command::new("node").stdin(Stdio::piped()).stdout(Stdio::piped()).spawn().unwrap();
    child.stdin.take().unwrap().write_all(script.as_bytes()).unwrap();
    let output = child.wait_with_output().unwrap();
    assert!(output.status.success());
    String::from_utf8(output.stdout).unwrap().lines().map(str::to_owned).collect()
}

#[test]
fn agrees_with_node() {
    if !needs("node") {
        return;
    }
    let rng = TestRng::from_seed(RngAlgorithm::ChaCha, &[7; 32]);
    let mut runner = TestRunner::new_with_rng(Config::default(), rng);
    let strategy = program();
    let sources: Vec<String> =
        (0..PROGRAMS).map(|_| strategy.new_tree(&mut runner).unwrap().current()).collect();
    let expected = node(&sources);
    assert_eq!(expected.len(), sources.len());
    let wrong = sources
        .iter()
        .zip(&expected)
        .map(|(source, node_result)| (source, encode(&evaluate(source)), node_result));
    let wrong: Vec<_> = wrong.filter(|(_, computed, node_result)| computed != *node_result).take(5).collect();
    assert!(wrong.is_empty(), "text, ours, node's: {wrong:#?}");
}
