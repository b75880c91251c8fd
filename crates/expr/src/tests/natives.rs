//! What every row of the table of methods states is what the machine does.

use crate::heap::Heap;
use crate::mock::World;
use crate::natives::{Env, Implementation, NanBehaviour, Native, ReceiverKind, all};
use crate::parse::parse_expression;
use crate::source_functions::source_function;
use crate::value::Value;

/// The result of a row for `[9, element, 7]` and these arguments, with `X` in place of each `element` and `argument`.
fn outcome(row: &Native, element: f64, argument: f64, args: &[f64]) -> String {
    fn show(heap: &Heap, value: &Value, unknown: [f64; 2]) -> String {
        match value {
            Value::Number(x) if unknown.iter().any(|u| u.to_bits() == x.to_bits()) => "X".into(),
            Value::List(_) => {
                let items = (0..heap.len(value).unwrap()).map(|i| heap.item(value, i).unwrap());
                format!("[{}]", items.map(|v| show(heap, &v, unknown)).collect::<Vec<_>>().join(" "))
            }
            other => other.to_string(),
        }
    }
    let Implementation::Run(run, ..) = row.body else { return String::new() };
    let (mut heap, mut host, mut budget) = (Heap::default(), World::new(), u64::MAX);
    let items = [9.0, element, 7.0].map(Value::Number);
    let receiver = match row.name {
        "set" => heap.numbers(&[9.0, element, 7.0]).unwrap(),
        _ => heap.list(items.to_vec()).unwrap(),
    };
    let number = |x: &f64| Value::Number(if *x == 8.0 { argument } else { *x });
    let args: Vec<Value> = args.iter().map(number).collect();
    let mut env = Env { heap: &mut heap, host: &mut host, views: &[], budget: &mut budget };
    let result = run(&mut env, &receiver, &args).map_err(|e| e.message);
    let display = |value: &Value| show(&heap, value, [element, argument]);
    format!("{} {}", result.as_ref().map_or_else(Clone::clone, &display), display(&receiver))
}

#[test]
fn every_row_states_how_it_treats_nan() {
    let arguments: [&[f64]; 10] = [
        &[8.5],
        &[],
        &[1.0],
        &[8.0],
        &[0.0, 2.0],
        &[0.0, 8.0],
        &[8.0, 8.0],
        &[8.0, 1.0],
        &[1.0, 1.0, 8.0],
        &[1.0, 2.0, 3.0],
    ];
    for row in all() {
        let lists = matches!(row.on, ReceiverKind::List | ReceiverKind::Growing | ReceiverKind::Untyped);
        // Exactly the functions that are written in the language have this value.
        assert_eq!(row.nan == NanBehaviour::Source, row.calls(), "{}", row.name);
        // Functions with an underscore are called only by definitions in the language, which pass a list and its length.
        if row.calls() || row.name.starts_with('_') || !(lists || row.on == ReceiverKind::Nothing) {
            continue;
        }
        let (least, most) = row.arity();
        let fitting = || arguments.into_iter().filter(|args| (least..=most).contains(&args.len()));
        let of = |element, argument, args: &&[f64]| outcome(row, element, argument, args);
        let elements = lists && fitting().any(|args| of(8.5, 1.5, &args) != of(f64::NAN, 1.5, &args));
        let arguments = fitting().any(|args| of(8.5, 8.0, &args) != of(8.5, f64::NAN, &args));
        let moved = lists
            && fitting().filter(|a| !a.contains(&8.5)).any(|a| of(8.5, 1.5, &a) != of(f64::NAN, 1.5, &a));
        let asks = row.nan == NanBehaviour::Asks;
        assert!(row.nan.of_elements() || !moved || asks, "{} looks at elements", row.name);
        assert!(row.nan.of_arguments() || !arguments || asks, "{} looks at arguments", row.name);
        // A row that declares that it inspects elements must do so.
        assert!(!(lists && row.nan.of_elements()) || elements, "{} looks at no element", row.name);
    }
}

#[test]
fn every_source_method_compiles_without_findings() {
    for (row, (n, text)) in all().iter().flat_map(|row| row.texts().iter().map(move |t| (row, t))) {
        assert!(parse_expression(text).diagnostics.is_empty(), "{}", row.name);
        assert!(source_function(row, *n).is_some(), "{}", row.name);
    }
}
