//! Random programs compared with JavaScript, bit for bit: generated, run here and in node. Functions whose last digit the
//! standard leaves to the implementation (`sin`, `log`, `**` …) are not used.
//!
//! LABSPEC_NODE_PROGRAMS is the number of programs, LABSPEC_NODE_SEED the first seed.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::io::Write as _;
use std::process::{Command, Stdio};

use super::generator::Generator;
use crate::mock::{Mock, World};
use crate::needs::needs;
use crate::*;

/// Formats a value as `node.js` does.
fn show(world: &World, heap: &Heap, value: &Value, depth: usize, out: &mut String) {
    if depth > 6 {
        out.push('…');
        return;
    }
    let _ = match value {
        Value::Undefined => write!(out, "u"),
        Value::Null => write!(out, "0"),
        Value::Number(x) if x.is_nan() => write!(out, "nNaN"),
        Value::Number(x) => write!(out, "n{:x}", x.to_bits()),
        Value::String(s) => write!(out, "s{}", json(s)),
        Value::Boolean(b) => write!(out, "b{b}"),
        Value::Function(_) => write!(out, "f"),
        Value::View(view) => {
            let all = &world.fields[view.field.0 as usize];
            let first = view.first as usize;
            numbers(&all[first..view.count().map_or(all.len(), |n| first + n)], out);
            Ok(())
        }
        Value::List(_) => {
            out.push('[');
            for i in 0..heap.len(value).unwrap_or(0) {
                if i > 0 {
                    out.push(' ');
                }
                show(world, heap, &heap.item(value, i).unwrap_or_default(), depth + 1, out);
            }
            write!(out, "]")
        }
        Value::Record(_) => {
            out.push('{');
            if let heap::HeapObject::Record(entries) = heap.object(value) {
                for (i, (key, value)) in entries.iter().enumerate() {
                    if i > 0 {
                        out.push(' ');
                    }
                    out.push_str(&format!("{key}:"));
                    show(world, heap, value, depth + 1, out);
                }
            }
            write!(out, "}}")
        }
    };
}

fn json(text: &str) -> String {
    let mut out = String::from("\"");
    for c in text.chars() {
        match c {
            '"' | '\\' => out.extend(['\\', c]),
            '\n' => out.push_str("\\n"),
            c if c < ' ' => out.push_str(&format!("\\u{:04x}", c as u32)),
            c => out.push(c),
        }
    }
    out + "\""
}

fn numbers(list: &[f64], out: &mut String) {
    out.push('[');
    for (i, x) in list.iter().enumerate() {
        let gap = if i > 0 { " " } else { "" };
        let text = if x.is_nan() { "NaN".into() } else { format!("{:x}", x.to_bits()) };
        let _ = write!(out, "{gap}n{text}");
    }
    out.push(']');
}

/// The fields of the host that programs write.
const WRITTEN: [usize; 5] = [1, 2, 13, 14, 15];

/// The result of a program here, or the rule by which the compiler refuses it, or the rule of a limit at which it stops and
/// that JavaScript does not have.
pub(super) fn result_here(source: &str) -> Result<String, &'static str> {
    if std::env::var("LABSPEC_NODE_SHOW").is_ok() {
        eprintln!("{source}");
    }
    let mut globals = Globals::new();
    let slot = globals.define("out");
    globals.define("k");
    let compiled = Compiler::new(&Mock, &mut globals).statements(source);
    let Some(program) = compiled.program else {
        return Err(compiled.diagnostics.iter().find(|d| d.is_error()).map_or("", |d| d.code));
    };
    let (mut world, mut context) = (World::new(), Context::for_globals(&globals));
    let mut out = String::new();
    match program.run(&mut world, &mut context, None) {
        Ok(_) => show(&world, &context.heap, context.get(slot), 0, &mut out),
        // JavaScript has other limits, and converts functions to strings.
        Err(e)
            if [
                rules::TEXT_TOO_LONG,
                rules::MEMORY,
                rules::BUDGET,
                rules::CALL_DEPTH,
                rules::NOT_A_VALUE,
            ]
            .contains(&e.rule) =>
        {
            return Err(e.rule.code);
        }
        Err(_) => out.push('E'),
    }
    out.push_str(" | ");
    for field in WRITTEN {
        numbers(&world.fields[field], &mut out);
    }
    Ok(out)
}

/// The results of programs in node.
pub(super) fn results_in_node(sources: &[String]) -> Vec<String> {
    let script = concat!(env!("CARGO_MANIFEST_DIR"), "/src/tests/node.js");
    let mut child =
        Command::new("node").arg(script).stdin(Stdio::piped()).stdout(Stdio::piped()).spawn().unwrap();
    let mut input = child.stdin.take().unwrap();
    let text: String = sources.iter().map(|s| json(s) + "\n").collect();
    let writer = std::thread::spawn(move || input.write_all(text.as_bytes()));
    let output = child.wait_with_output().unwrap();
    writer.join().unwrap().unwrap();
    String::from_utf8(output.stdout).unwrap().lines().map(str::to_owned).collect()
}

fn from_env(name: &str, default: u64) -> u64 {
    std::env::var(name).ok().and_then(|v| v.parse().ok()).unwrap_or(default)
}

#[test]
fn random_programs_behave_as_in_javascript() {
    if !needs("node") {
        return;
    }
    let count = from_env("LABSPEC_NODE_PROGRAMS", 1500) as usize;
    let seed = from_env("LABSPEC_NODE_SEED", 1);
    let mut generator = Generator::new(seed);
    let (mut done, mut refused) = (0, BTreeMap::new());
    while done < count {
        let batch: Vec<(String, String)> = (0..2000.min(2 * (count - done)))
            .filter_map(|_| {
                let source = generator.program();
                match result_here(&source) {
                    Ok(result) => Some((source, result)),
                    Err(rule) => {
                        *refused.entry(rule).or_insert(0) += 1;
                        None
                    }
                }
            })
            .take(count - done)
            .collect();
        let sources: Vec<String> = batch.iter().map(|(s, _)| s.clone()).collect();
        let results = results_in_node(&sources);
        assert_eq!(results.len(), batch.len());
        for ((source, computed), node_result) in batch.iter().zip(&results) {
            assert!(computed == node_result, "{source}\n here: {computed}\nthere: {node_result}");
        }
        done += batch.len();
    }
    println!("{done} programs compared, refused: {refused:?}");
    let all: usize = refused.values().sum();
    assert!(all * 4 < done, "{all} of {done} programs refused: the generator writes what nobody means");
}
