//! The watch of a run: it records where a value that is not a number was turned into an ordinary value, and the results of
//! comparisons of numbers. Claims depend on it: a condition that lost a NaN during its evaluation proves nothing, and the
//! comparisons show how far a condition is from the opposite result.
//!
//! NaN and `undefined` mean "there is no number": an event that never happened, or the root of a negative number. Arithmetic
//! propagates NaN. Comparisons, branches, strings, indexes and most methods turn it into an ordinary value, which is a loss.

use crate::operation::truth;
use crate::operators::{BinaryOp, UnaryOp};
use labspec_finding::Span;

/// A comparison of two numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Comparison {
    /// The left operand.
    pub left: f64,
    /// The right operand.
    pub right: f64,
    /// How far the operands are from the opposite result: not negative if the comparison holds, not positive if it does not,
    /// NaN if an operand is not a number.
    pub margin: f64,
    /// Whether it holds.
    pub holds: bool,
}

/// The records of the runs in a [`crate::Context`], after it was passed to [`crate::Context::watch`].
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Watch {
    /// The index of the comparison, in the order of evaluation, whose result is inverted.
    pub turned: Option<usize>,
    /// The comparisons of the last run, if this watch was created by [`Watch::comparing`].
    pub comparisons: Vec<Comparison>,
    /// The first part of the program where a value that is not a number was turned into an ordinary value.
    pub lost: Option<Span>,
    compares: bool,
    loses: bool,
    undefined: bool,
}

/// Limit on the comparisons stored per run.
const MOST: usize = 4096;

impl Watch {
    /// A watch that records only losses of NaN.
    pub fn losses() -> Watch {
        Watch::default()
    }

    /// A watch that records losses of NaN and `undefined`, and comparisons, one of which may be inverted.
    pub fn comparing(turned: Option<usize>) -> Watch {
        Watch { turned, compares: true, undefined: true, ..Watch::default() }
    }

    /// Whether `undefined` counts as not being a number.
    pub(crate) fn counts_undefined(&self) -> bool {
        self.undefined
    }

    /// Whether it records comparisons in addition to losses.
    pub(crate) fn notes_comparisons(&self) -> bool {
        self.compares
    }

    /// Clears the records of the last run.
    pub(crate) fn begin(&mut self) {
        self.comparisons.clear();
        (self.lost, self.loses) = (None, false);
    }

    pub(crate) fn lose(&mut self) {
        self.loses = true;
    }

    /// Records the span of the last operation if it lost a value.
    pub(crate) fn settle(&mut self, span: Span) {
        if std::mem::take(&mut self.loses) {
            self.lost.get_or_insert(span);
        }
    }

    pub(crate) fn loses(&self) -> bool {
        self.loses
    }

    /// The result of an operation on numbers, which is inverted if it is the chosen comparison.
    pub(crate) fn binary(&mut self, op: BinaryOp, a: f64, b: f64) -> f64 {
        let x = op.on_numbers(a, b);
        self.note_result(a.is_nan() || b.is_nan(), x);
        if margin(op, a, b).is_some() { self.compared(op, a, b, x) } else { x }
    }

    pub(crate) fn unary(&mut self, op: UnaryOp, a: f64) -> f64 {
        let x = op.on_number(a);
        self.note_result(a.is_nan(), x);
        x
    }

    /// Records a number that decides a branch.
    pub(crate) fn test(&mut self, x: f64) {
        self.loses |= x.is_nan();
    }

    /// Records a loss if an operand was NaN and the result is not.
    pub(crate) fn note_result(&mut self, nan: bool, result: f64) {
        self.loses |= nan && !result.is_nan();
    }

    /// Records a comparison with the result `x`, and returns the result that the program receives.
    pub(crate) fn compared(&mut self, op: BinaryOp, a: f64, b: f64, x: f64) -> f64 {
        let Some(margin) = margin(op, a, b).filter(|_| self.compares) else { return x };
        let at = self.comparisons.len();
        if at >= MOST {
            return x;
        }
        self.comparisons.push(Comparison { left: a, right: b, margin, holds: x != 0.0 });
        if self.turned == Some(at) { truth(x == 0.0) } else { x }
    }
}

/// How far a comparison is from the opposite result, or `None` if the operator is not a comparison.
fn margin(op: BinaryOp, a: f64, b: f64) -> Option<f64> {
    Some(match op {
        BinaryOp::Less | BinaryOp::LessEqual => b - a,
        BinaryOp::Greater | BinaryOp::GreaterEqual => a - b,
        BinaryOp::Equal | BinaryOp::StrictEqual => -(a - b).abs(),
        BinaryOp::NotEqual | BinaryOp::StrictNotEqual => (a - b).abs(),
        _ => return None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mock::{Mock, World};
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

    fn loses(source: &str, x: f64) -> bool {
        run(source, x, Watch::comparing(None)).1.lost.is_some()
    }

    #[test]
    fn whatever_makes_a_value_of_nothing_loses_it() {
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
            assert!(loses(source, f64::NAN), "{source}");
            let lost = run(source, 0.5, Watch::comparing(None)).1.lost;
            assert!(
                lost.is_none() || source.contains("=> false"),
                "{source}: {:?}",
                lost.map(|s| s.start..s.end)
            );
            if !source.contains("filter(x => false)") {
                assert!(!loses(source, 0.5), "{source}");
            }
        }
        for source in [
            "holds(!(NaN < -1))".replace("holds", ""),
            "Math.sqrt(-1) < 5 || true".into(),
            "0 / 0 > 1".into(),
        ] {
            assert!(loses(&source, 0.5), "{source}");
        }
    }

    #[test]
    fn arithmetic_and_questions_lose_nothing() {
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
            assert!(!loses(source, f64::NAN), "{source}");
        }
    }

    #[test]
    fn undefined_counts_in_claims_alone() {
        for source in ["[1].find(x => x > 2) || 1", "[1, 2].some(x => { })", "[1].find(x => x > 2) < 1"] {
            assert!(loses(source, 0.5), "{source}");
        }
        assert!(!loses("[1].find(x => x > 2) === undefined", 0.5), "it is asked for");
        let (_, watch) = run("[1].find(x => x > 2) || 1", 0.5, Watch::losses());
        assert_eq!(watch.lost, None);
    }

    #[test]
    fn a_turned_comparison_shows_whether_it_decides() {
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
        fn losses_are_the_same_with_comparisons(
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
                let both = Watch { undefined: false, ..Watch::comparing(None) };
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
}
