//! Writes into arrays of numbers compared with JavaScript's typed arrays, bit for bit: every kind of value into doubles,
//! integers and bytes, by every form of assignment.
//!
//! `node.rs` generates random programs with such writes.

use std::collections::BTreeMap;

use super::node::{result_here, results_in_node};
use crate::natives::ReceiverKind;
use crate::needs::needs;

/// The stored values. `n` is a number that depends on the statement, so that every type also occurs as known only at run time.
const VALUES: &[&str] = &[
    "true",
    "false",
    "undefined",
    "null",
    "'3'",
    "' -2.7 '",
    "'x'",
    "''",
    "'0x1f'",
    "[]",
    "[2]",
    "['7']",
    "[1, 2]",
    "{}",
    "{a: 1}",
    "() => 1",
    "(() => 1)()",
    "(() => 'a')()",
    "(() => {})()",
    "NaN",
    "-0",
    "1e400",
    "-Infinity",
    "2.7",
    "-2.7",
    "-0.5",
    "300",
    "-1",
    "255.9",
    "256",
    "2147483647",
    "2147483648",
    "-2147483649",
    "4294967295",
    "4294967301.5",
    "1e21",
    "9007199254740993",
    "-1e-320",
    "data.qpos.slice(2, 3)",
    "data.eq_active.slice(1, 2)",
    "data.qpos",
    "'5' + '0'",
    "`${2}.5`",
    "data.qpos[99]",
    "ctx.none",
    "[3].find(x => x > 5)",
    "Number('a')",
    "typeof 1",
    "1 < 2",
];

/// The targets: statements that come first, and an expression for an element.
const PLACES: &[(&str, &str)] = &[
    ("", "data.qpos[0]"),
    ("", "data.eq_active[1]"),
    ("", "model.geom_contype[2]"),
    ("", "model.opt.iterations"),
    ("const i = data.eq_active.length - 3;", "data.eq_active[i]"),
    ("const i = model.geom_contype.length - 3;", "model.geom_contype[i]"),
    ("const v = data.eq_active;", "v[1]"),
    ("const v = model.geom_contype;", "v[1]"),
    ("const v = data.qpos;", "v[1]"),
    ("const v = data.eq_active.slice();", "v[1]"),
    ("const v = model.geom_contype.slice(1);", "v[1]"),
    ("const v = data.qpos.map(x => x);", "v[1]"),
    ("const v = model.geom_contype.subarray(1, 3);", "v[1]"),
];

/// The forms of assignment: `P` is the target, `X` the value.
const FORMS: &[&str] = &[
    "ctx.k = (P = X)",
    "P = X",
    "ctx.x = X; ctx.k = (P = ctx.x)",
    "const x = X; P = x",
    "const f = x => { P = x }; f(X)",
    "P += X",
    "ctx.x = X; ctx.k = (P += ctx.x)",
    "P -= X",
    "P *= X",
    "P /= X",
    "P %= X",
    "P |= X",
    "P ^= X",
    "P <<= X",
    "P >>>= X",
    "P **= 2; P -= X",
    "P ||= X",
    "P &&= X",
    "ctx.k = (P ??= X)",
    "P = X; ctx.k = P++",
    "P = X; ctx.k = --P",
    "const [x] = [X]; P = x",
    "const {x} = {x: X}; P = x",
    "[X].forEach(x => { P = x })",
    "for (const x of [X]) P += x",
];

/// Writes of whole arrays.
const WHOLE: &[&str] = &[
    "data.qpos.fill(X)",
    "data.eq_active.fill(X)",
    "model.geom_contype.fill(X, 1)",
    "data.eq_active.set([1, X, 3])",
    "model.geom_contype.set([X], 2)",
    "model.geom_contype.set(data.qpos.slice(0, 2).fill(X))",
    "ctx.k = data.eq_active.with(1, X)",
    "ctx.k = model.geom_contype.map(() => X)",
    "ctx.k = data.eq_active.slice().fill(X)",
    "ctx.k = model.geom_contype.indexOf(X)",
    "ctx.k = data.eq_active.slice(1).includes(X)",
];

const SHOWN: &str = "; ctx.out = [ctx.k, data.eq_active.slice(), model.geom_contype.slice()];";

/// Refusals that are intended: an element stores a single value, a known index must be in range, and a function cannot
/// be converted to a string.
const INTENDED_DIFFERENCES: [&str; 4] = ["assign-array", "index-out-of-range", "not-a-value", "whole-array"];

/// The results of programs.
#[derive(Default, Debug)]
struct Count {
    compared: usize,
    refused: BTreeMap<&'static str, usize>,
}

/// Compares programs with node.
fn compare(sources: Vec<String>) -> Count {
    let mut count = Count::default();
    let mut ran = Vec::new();
    for source in sources {
        match result_here(&source) {
            Ok(computed) => ran.push((source, computed)),
            Err(rule) => *count.refused.entry(rule).or_default() += 1,
        }
    }
    let sources: Vec<String> = ran.iter().map(|(source, _)| source.clone()).collect();
    let node_results = results_in_node(&sources);
    assert_eq!(node_results.len(), ran.len());
    let differ =
        ran.iter().zip(&node_results).filter(|((_, computed), node_results)| computed != *node_results);
    let wrong: Vec<String> = differ
        .map(|((source, computed), node_results)| {
            format!("{source}\n here: {computed}\nthere: {node_results}\n")
        })
        .collect();
    let first = wrong.iter().take(6).cloned().collect::<Vec<_>>().join("\n");
    assert!(wrong.is_empty(), "{} of {} differ:\n{first}", wrong.len(), ran.len());
    count.compared = ran.len();
    count
}

#[test]
fn every_value_into_every_kind_of_element() {
    if !needs("node") {
        return;
    }
    let mut sources = Vec::new();
    for value in VALUES {
        for form in FORMS {
            for (before, place) in PLACES {
                let text = form.replace('P', place).replace('X', &format!("({value})"));
                sources.push(format!("{before} {text}{SHOWN}"));
            }
        }
        sources.extend(WHOLE.iter().map(|form| form.replace('X', &format!("({value})")) + SHOWN));
    }
    let count = compare(sources);
    println!("{} programs compared, refused by the compiler: {:?}", count.compared, count.refused);
    assert!(count.refused.keys().all(|code| INTENDED_DIFFERENCES.contains(code)), "{count:?}");
    assert!(count.refused.values().sum::<usize>() * 3 < count.compared, "{count:?}");
}

/// Lists, typed arrays, arrays of the host and other values, on which every method of lists is called.
const RECEIVERS: [&str; 10] = [
    "5",
    "'ab'",
    "({a: 1})",
    "null",
    "[3, 1, 2]",
    "[2, undefined, 'b', [1], null]",
    "data.qpos",
    "data.eq_active.slice()",
    "model.geom_contype.map(x => x)",
    "data.qpos.subarray(1, 4)",
];

const ARGUMENTS: [&str; 6] =
    ["", "1", "1, 2", "x => [x, 1]", "(a, b) => String(a) < String(b) ? 1 : -1", "[1, 2]"];

#[test]
fn every_method_of_every_kind_of_list() {
    if !needs("node") {
        return;
    }
    let names = crate::natives::public_rows()
        .filter(|row| matches!(row.on, ReceiverKind::List | ReceiverKind::Growing | ReceiverKind::Untyped))
        .map(|row| row.name);
    let mut sources = Vec::new();
    for name in names {
        for receiver in RECEIVERS {
            // `ctx` cannot store an array of the host.
            let copy = if receiver.contains("qpos") { ".slice()" } else { "" };
            // The argument of `set` must be a list here.
            for arguments in ARGUMENTS.into_iter().filter(|a| name != "set" || a.starts_with('[')) {
                sources.push(format!(
                    "const v = {receiver}; ctx.k = v.{name}({arguments}); ctx.out = [ctx.k, v];"
                ));
                sources.push(format!("ctx.v = [{receiver}{copy}]; ctx.k = ctx.v[0].{name}({arguments}); ctx.out = [ctx.k, ctx.v[0]];"));
            }
        }
    }
    let count = compare(sources);
    println!("{} programs compared, refused by the compiler: {:?}", count.compared, count.refused);
}

/// Cases that once differed.
const FIXED_DIFFERENCES: [&str; 17] = [
    "let v = 3; ctx.k = -(data.eq_active[1] = v)",
    "let v = 3; ctx.k = [+(data.eq_active[1] += v), typeof (data.qpos[0] = v), +(ctx.x = v)]",
    "const f = v => ~(data.qpos[4] >>>= v); ctx.k = [f(3), -f(1)]",
    "const a = [1]; a.push(a, [2]); ctx.k = [String(a), a.join('-'), Number([a]), `${[a, a]}`]",
    "ctx.k = String([data.qpos.slice(0, 2), [null, [undefined]], {}])",
    "ctx.k = String([data.eq_active, [data.qpos.subarray(1, 2)]])",
    "const a = [[[]]]; let b = a; for (let i = 0; i < 30; i++) b = [b, i]; ctx.k = String(b)",
    "ctx.v = [5]; ctx.k = ctx.v[0].map(x => x)",
    "ctx.v = [{a: 1}]; ctx.k = ctx.v[0].some(x => x)",
    "ctx.v = ['ab']; ctx.k = ctx.v[0].reduce((a, x) => a + x, '')",
    "ctx.v = [data.qpos.slice()]; ctx.k = ctx.v[0].flatMap(x => [x])",
    "ctx.k = [(NaN).toPrecision(0), (1 / 0).toExponential(101)]",
    "ctx.k = [(2 ** 60 * 1.37).toString(36), (-1e100).toString(3), (5e-324).toString(2), (-0).toString(2)]",
    "ctx.k = (-109.00000000000182).toFixed(38)",
    "ctx.k = [(9.96875).toExponential(4), (99.5).toPrecision(2), (995).toPrecision(2), (0.5).toPrecision(1)]",
    "ctx.k = [String(1.20481109619140625), 0.1 + 0.2, 2 ** -1074]",
    "[data.qpos[0], 1].forEach(x => { model.geom_contype[0] += x / 3 })",
];

#[test]
fn former_differences_equal_node() {
    if !needs("node") {
        return;
    }
    let count = compare(FIXED_DIFFERENCES.iter().map(|source| format!("{source}{SHOWN}")).collect());
    assert_eq!(count.compared, FIXED_DIFFERENCES.len(), "{count:?}");
}

#[test]
fn functions_have_no_text() {
    for source in [
        "String(ctx.f)",
        "'' + ctx.f",
        "`${[1, ctx.f]}`",
        "[ctx.f].join()",
        "[ctx.f, 'a'].sort()",
        "ctx.f == 'a'",
    ] {
        let source = format!("ctx.f = () => 1; ctx.out = {source}");
        assert_eq!(result_here(&source), Err("not-a-value"), "{source}");
    }
    for source in ["Number([ctx.f])", "ctx.f === 'a'", "typeof ctx.f", "[ctx.f].length"] {
        let source = format!("ctx.f = () => 1; ctx.out = {source}");
        assert!(result_here(&source).is_ok(), "{source}");
    }
}
