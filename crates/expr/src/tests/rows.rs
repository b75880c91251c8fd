//! Rows of numbers compute what the formulas say.

use crate::host::Host;
use crate::mock::{Mock, World};
use crate::operators::BinaryOp;
use crate::row::*;
use crate::value::Value;
use crate::{Compiler, Context, Globals, Program};

fn program(source: &str) -> Program {
    let mut globals = Globals::new();
    Compiler::new(&Mock, &mut globals).expression(source).program.unwrap()
}

#[test]
fn rows_give_the_results_of_the_machine() {
    let (q, t) = ("data.qpos[2]", "data.time");
    let mut sources: Vec<String> = [
        "data.time",
        "2 * Math.PI",
        "-data.qpos[2] > data.time",
        "data.time * data.time * data.time",
        "(data.qpos[0] + data.qpos[2]) * (data.qpos[3] - data.qpos[2]) / (data.qpos[4] - 7)",
        "(data.qpos[2] + 1) - (data.qpos[2] + 1) * (data.qpos[2] + 1)",
        "data.time > 20 ? data.qpos[2] : data.time > 10 ? -data.qpos[2] : 0.5",
        "(data.qpos[2] || 7) + (data.time < 3 ? NaN : 1)",
        "!(data.qpos[2] > 0) || data.time % 2 < 1",
        "(data.time - 1) ** 2 + 3 ** data.qpos[2] + data.time / 7 + 7 / (data.time - 1)",
        "Math.hypot(data.qpos[2], data.time, data.qpos[1] - 3) + Math.max(data.time, data.qpos[2] * 2, 4)",
        "-0 * data.qpos[2] - 0",
    ]
    .map(String::from)
    .to_vec();
    for op in BinaryOp::ALL.map(BinaryOp::symbol) {
        let sides = [
            (q, t),
            (t, q),
            (q, "3"),
            ("3", q),
            (q, q),
            ("(data.qpos[2] + 1)", t),
            (t, "(1 / data.qpos[2])"),
        ];
        sources.extend(sides.map(|(a, b)| format!("({a} {op} {b})")));
    }
    for name in crate::math::names() {
        sources.push(format!("~Math.{name}(data.qpos[2] / 9, data.time)"));
        sources.push(format!("Math.{name}(data.qpos[2] / 9) - 1"));
    }
    let mut rows = 0;
    for source in sources {
        let mut globals = Globals::new();
        let Some(program) = Compiler::new(&Mock, &mut globals).expression(&source).program else {
            continue;
        };
        let Some(row) = &program.row else { continue };
        rows += 1;
        for i in 0..40 {
            let mut world = World::new();
            world.fields[0][0] = f64::from(i) * 0.37;
            world.fields[1][2] = 3.0 - f64::from(i) / 2.0;
            let bits = |v: Value| (v.type_of(), v.to_number().to_bits());
            let by_row = row.value(|elements, out| world.read(elements, out), &mut Vec::new()).unwrap();
            let by_machine = crate::vm::run(&program.code, &mut world, &mut Context::new(), None).unwrap();
            let nan = by_row.to_number().is_nan() && by_machine.to_number().is_nan();
            assert!(
                nan || bits(by_row.clone()) == bits(by_machine.clone()),
                "{source}: {by_row} and {by_machine}"
            );
        }
    }
    assert!(rows > 200, "only {rows} are formulas");
}

#[test]
fn the_longest_formulas_run_on_the_machine() {
    let sum = |tens: usize| {
        let term = |i: usize| format!("data.qpos[{}] * {i}.5", i % 14);
        let ten = |i: usize| (10 * i..10 * i + 10).map(term).collect::<Vec<_>>().join(" + ");
        (0..tens).map(|i| format!("({})", ten(i))).collect::<Vec<_>>().join(" + ")
    };
    assert!(program(&sum(5)).row.is_some());
    assert!(program(&sum(20)).row.is_none());
    let value = program(&sum(20)).run(&mut World::new(), &mut Context::new(), None).unwrap();
    let expected: f64 = (0..200).map(|i| f64::from(100 + i % 14) * (f64::from(i) + 0.5)).sum();
    assert_eq!(value, Value::Number(expected));
}

#[test]
fn a_missing_element_is_evaluated_by_the_machine() {
    let program = program("data.efc_force[1] + 1");
    let mut world = World::new();
    let mut context = Context::new();
    assert_eq!(program.run(&mut world, &mut context, None).unwrap(), Value::Number(602.0));
    world.fields[6].pop();
    assert!(program.run(&mut world, &mut context, None).unwrap().to_number().is_nan());
    assert_eq!(context.events().len(), 1);
}

#[test]
fn registers_hold_only_results_that_are_read_again() {
    let program = program("1000 * (data.qpos[2] - (1 - 0.5 * 9.81 * data.time * data.time))");
    let row = program.row.unwrap();
    assert_eq!(row.elements.len(), 2);
    assert!(!row.ops.iter().any(|op| matches!(op, RowOp::Keep(_) | RowOp::Put(..))), "{:?}", row.ops);
    assert_eq!(row.ops.len(), 5, "{:?}", row.ops);
}
