//! Watches: which programs lose NaN.

use crate::mock::{Mock, World};
use crate::watch::*;
use crate::{Compiler, Context, Globals, Value};
use proptest::prelude::*;

/// Evaluates an expression with `data.qpos[0]` equal to `x`; returns the value and the records.
fn run(source: &str, x: f64, watch: Watch) -> (Value, Watch) {
    let mut globals = Globals::new();
    let compiled = Compiler::new(&Mock, &mut globals).expression(source);
    let program = compiled.program.unwrap_or_else(|| panic!("{source}: {:?}", compiled.diagnostics));
    let (mut world, mut context) = (World::new(), Context::for_globals(&globals));
    world.fields[1][0] = x;
    context.watch(Some(Box::new(watch)));
    let value = program.run(&mut world, &mut context, None).unwrap();
    (value, *context.watch(None).unwrap())
}

fn loses_nan(source: &str, x: f64) -> bool {
    run(source, x, Watch::comparing(None)).1.lost.is_some()
}

#[test]
fn operations_that_turn_nan_into_a_value_are_recorded() {
    for source in [
        "data.qpos[0] < 1",
        "!(data.qpos[0] < 1)",
        "(data.qpos[0] || 0) < 1",
        "(data.qpos[0] | 0) === 0",
        "~data.qpos[0] < 0",
        "Boolean(data.qpos[0])",
        "!data.qpos[0]",
        "data.qpos[0] ? 1 : 2",
        "data.qpos[0] && 1 > 2",
        "[1, 2].indexOf(data.qpos[0]) < 0",
        "[data.qpos[0], 2].includes(3)",
        "String(data.qpos[0]) === 'NaN'",
        "`${data.qpos[0]}`.length > 0",
        "('' + data.qpos[0]).length === 3",
        "data.qpos[0].toFixed(1) === 'NaN'",
        "[data.qpos[0]].join() === 'NaN'",
        "[data.qpos[0], 1].map(x => 2 * x).some(x => x > 1)",
        "[data.qpos[0]].every(x => x > 1)",
        "[data.qpos[0], 1].filter(x => x > 0).length === 1",
        "[3, data.qpos[0], 1].sort((a, b) => a - b)[0] === 1",
        "[3, data.qpos[0], 1].sort()[0] === 1",
        "data.qpos[0] ** 0 === 1",
        "Math.hypot(data.qpos[0], 1 / 0) > 1",
        "Math.clz32(data.qpos[0]) === 32",
        "[5, 6][data.qpos[0]] === undefined",
        "[5, 6].at(data.qpos[0]) === 5",
        "(() => { if (data.qpos[0] > 1) { return 1 } return 2 })() === 2",
        "Number.isInteger(data.qpos[0])",
        "data.qpos[0] === data.qpos[0]",
        "data.qpos[0] !== data.qpos[0]",
        "Math.max(...[data.qpos[0]].filter(x => false)) < 0",
        "isNaN(data.qpos[1]) || data.qpos[0] < 1",
        "isNaN(data.qpos[0]) && !(data.qpos[0] < 1)",
    ] {
        assert!(loses_nan(source, f64::NAN), "{source}");
        let lost = run(source, 0.5, Watch::comparing(None)).1.lost;
        assert!(
            lost.is_none() || source.contains("=> false"),
            "{source}: {:?}",
            lost.map(|s| s.start..s.end)
        );
        if !source.contains("filter(x => false)") {
            assert!(!loses_nan(source, 0.5), "{source}");
        }
    }
    for source in
        ["holds(!(NaN < -1))".replace("holds", ""), "Math.sqrt(-1) < 5 || true".into(), "0 / 0 > 1".into()]
    {
        assert!(loses_nan(&source, 0.5), "{source}");
    }
}

#[test]
fn arithmetic_and_tests_for_nan_are_not_recorded() {
    for source in [
        "isNaN(data.qpos[0])",
        "!isNaN(data.qpos[0]) && data.qpos[0] < 1",
        "Number.isNaN(data.qpos[0])",
        "Number.isFinite(data.qpos[0]) || 1 > 0",
        "2 * data.qpos[0] + Math.sin(data.qpos[0])",
        "Math.max(data.qpos[0], 1)",
        "[data.qpos[0], 2].slice(1)[0] === 2",
        "[data.qpos[0], 2].map(x => 2 * x)[1] === 4",
        "1 > 0 || data.qpos[0] > 1",
        "Math.max(...[1, data.qpos[0]])",
    ] {
        assert!(!loses_nan(source, f64::NAN), "{source}");
    }
}

#[test]
fn undefined_is_recorded_in_claims_alone() {
    for source in ["[1].find(x => x > 2) || 1", "[1, 2].some(x => { })", "[1].find(x => x > 2) < 1"] {
        assert!(loses_nan(source, 0.5), "{source}");
    }
    assert!(!loses_nan("[1].find(x => x > 2) === undefined", 0.5), "it is asked for");
    let (_, watch) = run("[1].find(x => x > 2) || 1", 0.5, Watch::losses());
    assert_eq!(watch.lost, None);
}

#[test]
fn an_inverted_comparison_shows_whether_it_decides() {
    let (value, watch) = run("data.qpos[0] > 1 && data.qpos[0] < 3", 2.5, Watch::comparing(None));
    assert_eq!(value, Value::Boolean(true));
    assert_eq!(watch.comparisons.iter().map(|c| c.margin).collect::<Vec<_>>(), [1.5, 0.5]);
    for turned in [0, 1] {
        let (value, _) = run("data.qpos[0] > 1 && data.qpos[0] < 3", 2.5, Watch::comparing(Some(turned)));
        assert_eq!(value, Value::Boolean(false), "{turned}");
    }
    let (value, watch) = run("[1, 2].every(x => x > data.qpos[0])", 0.5, Watch::comparing(Some(1)));
    assert_eq!((value, watch.comparisons.len()), (Value::Boolean(false), 2));
}

proptest! {
    /// An expression that needs no watch loses nothing.
    #[test]
    fn losses_are_independent_of_recorded_comparisons(
        tree in crate::tests::roundtrip::expression(), x in prop_oneof![-2f64..2.0, Just(f64::NAN)],
    ) {
        let source = crate::print(&tree);
        let mut globals = Globals::new();
        if let Some(program) = Compiler::new(&Mock, &mut globals).expression(&source).program {
            let lost = |watch: Watch| {
                let (mut world, mut context) = (World::new(), Context::for_globals(&globals));
                world.fields[1][0] = x;
                context.watch(Some(Box::new(watch)));
                let _ = program.run(&mut world, &mut context, None);
                context.watch(None).unwrap().lost
            };
            let both = Watch::comparing(None).without_undefined();
            prop_assert_eq!(lost(Watch::losses()), lost(both), "{}", source);
        }
    }

    /// A watch does not change any value.
    #[test]
    fn a_watched_run_gives_the_same(tree in crate::tests::roundtrip::expression(), x in -2f64..2.0) {
        let source = crate::print(&tree);
        let mut globals = Globals::new();
        if let Some(program) = Compiler::new(&Mock, &mut globals).expression(&source).program {
            let once = |watch: Option<Watch>| {
                let (mut world, mut context) = (World::new(), Context::for_globals(&globals));
                world.fields[1][0] = x;
                context.watch(watch.map(Box::new));
                program.run(&mut world, &mut context, None).map(|v| (v.type_of(), v.to_string()))
            };
            prop_assert_eq!(once(None), once(Some(Watch::comparing(None))), "{}", source);
        }
    }
}
