//! Constant folding: numbers that follow from constants are computed here, and their operations are removed. The binder folds
//! the constants that it needs for type inference, such as indexes and names. This pass finds those that appear only in SSA
//! form: arguments of functions, variables, and values that a loop does not change.

use crate::operation::select;
use crate::ssa::{Num, Op, Operand, SsaFunction};

/// The result of an operation.
enum Folded {
    Constant(f64),
    /// The same value as another name.
    Same(Num),
}

/// Folds the constants of a function.
pub(super) fn fold(unit: &mut SsaFunction) {
    let mut gone: Vec<u32> = Vec::new();
    for i in 0..unit.ops.len() {
        let Some((name, gives)) = unit.ops.get(i).and_then(|op| result(unit, op)) else { continue };
        match gives {
            Folded::Constant(x) => {
                let index = unit.numbers.partition_point(|(n, _)| *n < name);
                unit.numbers.insert(index, (name, x));
            }
            Folded::Same(other) => unit.same.join(Operand::Number(name), Operand::Number(other)),
        }
        gone.push(i as u32);
    }
    if gone.is_empty() {
        return;
    }
    for block in &mut unit.blocks {
        block.first -= gone.partition_point(|i| *i < block.first) as u32;
    }
    let left = |i: usize| gone.binary_search(&(i as u32)).is_err();
    let mut places = 0..;
    unit.ops.retain(|_| places.next().is_none_or(left));
    let mut places = 0..;
    unit.spans.retain(|_| places.next().is_none_or(left));
}

/// The name and the result of a numeric operation, if the result is known.
fn result(unit: &SsaFunction, op: &Op) -> Option<(Num, Folded)> {
    let constant = |n: Num| unit.constant(unit.same.number(n));
    Some(match *op {
        Op::Unary(name, op, a) => (name, unless_nan_lost(&[constant(a)?], op.on_number(constant(a)?))?),
        Op::Binary(name, op, a, b) => {
            let operands = [constant(a)?, constant(b)?];
            (name, unless_nan_lost(&operands, op.on_numbers(operands[0], operands[1]))?)
        }
        Op::Select(_, test, ..) if constant(test)?.is_nan() => return None,
        Op::Select(name, test, a, b) => (name, Folded::Same(select(constant(test)?, a, b))),
        Op::Math(name, function, args) => {
            let numbers: Option<Vec<f64>> =
                args.operands(&unit.args).iter().map(|n| constant(Num(*n))).collect();
            let numbers = numbers?;
            let x = function.apply(&numbers);
            // The minimum or maximum of no arguments is evaluated at run time, where a watch records it.
            let some = !numbers.is_empty();
            (
                name,
                if function.gives_boolean() {
                    Folded::Constant(x)
                } else {
                    unless_nan_lost(&numbers, x).filter(|_| some)?
                },
            )
        }
        _ => return None,
    })
}

/// A known result, unless an operand is NaN and the result is not: a run records where NaN disappears ([`crate::Watch`]).
fn unless_nan_lost(operands: &[f64], x: f64) -> Option<Folded> {
    let lost = operands.iter().any(|x| x.is_nan()) && !x.is_nan();
    (!lost).then_some(Folded::Constant(x))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mock::{Mock, World};
    use crate::operators::BinaryOp;
    use crate::{Compiler, Context, Globals, Value};

    #[test]
    fn constants_of_a_loop_are_computed_before_the_run() {
        let source =
            "let k = 1; k = 3; let s = 0; for (let i = 0; i < 4; i++) { s += Math.max(k * 2, 1) } ctx.a = s";
        let mut globals = Globals::new();
        let program = Compiler::new(&Mock, &mut globals).statements(source).program.unwrap();
        let computed = |op: &&Op| matches!(op, Op::Binary(_, BinaryOp::Multiply, ..) | Op::Math(..));
        assert_eq!(program.code.units[0].ops.iter().filter(computed).count(), 0);
        let mut context = Context::for_globals(&globals);
        program.run(&mut World::new(), &mut context, None).unwrap();
        assert_eq!(*context.get(0), Value::Number(24.0));
    }
}
